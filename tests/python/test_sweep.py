"""Sweeps go on where they stopped, and start again where something has changed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import snell


def pixels(path: Path) -> bytes:
    with Image.open(path) as picture:
        return picture.tobytes()


def test_what_is_done_is_skipped(tmp_path: Path) -> None:
    scene = snell.scenes["lecture/default"]
    eta = {"material.glass.eta": np.linspace(1, 2, 3)}
    frames = snell.sweep(scene, eta, tmp_path, width=16)
    made = [frame.stat().st_mtime_ns for frame in frames]
    assert len({frame.read_bytes() for frame in frames}) == 3
    frames[1].unlink()
    assert snell.sweep(scene, eta, tmp_path, width=16) == frames
    again = [frame.stat().st_mtime_ns for frame in frames]
    assert [before == after for before, after in zip(made, again, strict=True)] == [True, False, True]
    snell.sweep(scene.replace(ambient=0.5), eta, tmp_path, width=16)
    assert all(frame.stat().st_mtime_ns > before for frame, before in zip(frames, again, strict=True))


def test_values_go_together(tmp_path: Path) -> None:
    scene = snell.scenes["lecture/default"]
    with pytest.raises(snell.SceneError, match=r"eta has 2, eta_outside has 1"):
        snell.sweep(scene, {"material.glass.eta": [1, 2], "eta_outside": [1]}, tmp_path)
    with pytest.raises(snell.SceneError, match="Known here: glass"):
        snell.sweep(scene, {"material.gals.eta": [1]}, tmp_path)


def test_what_is_damaged_is_rendered_anew(tmp_path: Path) -> None:
    scene = snell.scenes["lecture/default"]
    eta = {"material.glass.eta": [1, 1.5, 2]}
    frames = snell.sweep(scene, eta, tmp_path, width=16)
    whole = [frame.read_bytes() for frame in frames]
    frames[0].write_bytes(whole[0][:-20])
    frames[1].write_bytes(whole[1].replace(b"IDATx", b"IDATy"))
    frames[2].write_bytes(b"")
    snell.sweep(scene, eta, tmp_path, width=16)
    assert [frame.read_bytes() for frame in frames] == whole
    (tmp_path / "sweep.json").write_text("{")
    snell.sweep(scene, eta, tmp_path, width=16)
    assert [frame.read_bytes() for frame in frames] == whole


def test_stopped_it_goes_on_where_it_was(tmp_path: Path) -> None:
    scene = snell.scenes["lecture/default"]
    eta = {"material.glass.eta": [1, 1.5, 2]}
    seen: list[tuple[int, int]] = []

    def stop(pixels: int, total: int, rays: int) -> None:
        seen.append((pixels, total))
        if pixels == 2 * 256:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        snell.sweep(scene, eta, tmp_path, width=16, progress=stop)
    assert seen[-1] == (2 * 256, 3 * 256)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["0000.png", "0001.png", "sweep.json"]
    made = (tmp_path / "0001.png").stat().st_mtime_ns
    seen.clear()
    frames = snell.sweep(scene, eta, tmp_path, width=16, progress=lambda *now: seen.append(now[:2]))
    assert seen[0][0] >= 2 * 256
    assert seen[-1] == (3 * 256, 3 * 256)
    assert frames[1].stat().st_mtime_ns == made


def test_each_warning_comes_once(tmp_path: Path) -> None:
    scene = snell.scenes["lecture/default"].with_("sphere.red.radius", 0)
    with pytest.warns(snell.SnellWarning, match="radius") as warned:
        snell.sweep(scene, {"material.glass.eta": [1, 1.5, 2]}, tmp_path, width=16)
    assert [warning.filename for warning in warned] == [__file__]
    with pytest.warns(snell.SnellWarning, match="radius") as warned:
        scene.render(width=16)
        scene.find("green")
    assert [warning.filename for warning in warned] == [__file__, __file__]


def test_values_of_all_kinds(tmp_path: Path) -> None:
    scene = snell.scenes["lecture/default"]
    values: dict[str, Any] = {
        "camera.eye": np.array([[50, 50, 100], [60, 50, 100.0]]),
        "render.integrator": ["lecture", "whitted"],
        "light.1.color": [0.5, (1, 0.5, 0)],
    }
    frames = snell.sweep(scene, values, tmp_path, width=16)
    assert repr(frames) == (
        "<Sweep of 2 frames, eye 50, 50, 100 to 60, 50, 100, integrator lecture to whitted, color 0.5 to 1.0, 0.5, 0.0>"
    )
    last = scene.with_("camera.eye", (60, 50, 100)).with_("light.1.color", (1, 0.5, 0))
    last.render(width=16, integrator="whitted").save(tmp_path / "last.png")
    assert pixels(frames[1]) == pixels(tmp_path / "last.png")
    assert frames == snell.sweep(scene, values, tmp_path, width=16)
    assert list(frames[1:]) == [frames[1]]
    wrong: Any
    for wrong in ("lecture", 2.0, {"a": 1}):
        with pytest.raises(snell.SceneError, match=r"expected a list of values, one for each frame") as error:
            snell.sweep(scene, {"render.integrator": wrong}, tmp_path)
        assert error.value.place == "render.integrator"


def test_a_wrong_value_is_found_before_the_first_frame(tmp_path: Path) -> None:
    scene = snell.scenes["lecture/default"]
    with pytest.raises(snell.SceneError) as error:
        snell.sweep(scene, {"material.glass.eta": [1, 1.5, float("nan")]}, tmp_path / "frames")
    assert error.value.place == "material.glass.eta, frame 2"
    (tmp_path / "file").write_text("mine")
    with pytest.raises(snell.PictureError, match="no folder"):
        snell.sweep(scene, {}, tmp_path / "file")
    assert (tmp_path / "file").read_text() == "mine"


def made(frames: snell.Sweep) -> list[int]:
    return [frame.stat().st_mtime_ns for frame in frames]


def test_a_changed_file_is_a_changed_scene(tmp_path: Path) -> None:
    model, library, image, sky = (tmp_path / name for name in ("a.obj", "a.mtl", "tiles.png", "sky.png"))
    model.write_text("mtllib a.mtl\nv 40 40 30\nv 60 40 30\nv 50 60 30\nusemtl paint\nf 1 2 3\n")
    library.write_text("newmtl paint\nKd 1 0 0\n")
    for path in (image, sky):
        Image.new("RGB", (2, 2), "#ff8000").save(path)
    scene = snell.scenes["lecture/default"].replace(
        settings=snell.Render("whitted", size=(16, 16)),
        meshes=[snell.Mesh(file="a.obj")],
        textures={"tiles": snell.Texture(image="tiles.png")},
        sky=snell.Sky(image="sky.png"),
        folder=str(tmp_path),
    )
    eta = {"material.glass.eta": [1, 1.5]}
    frames = snell.sweep(scene, eta, tmp_path / "frames")
    before = made(frames)
    snell.sweep(scene, eta, tmp_path / "frames")
    assert made(frames) == before
    for path in (model, library, image, sky):
        if path.suffix == ".png":
            Image.new("RGB", (2, 2), "#0080ff").save(path)
        else:
            path.write_text(path.read_text().replace("60", "70").replace("1 0 0", "0 1 0"))
        snell.sweep(scene, eta, tmp_path / "frames")
        assert all(now > then for now, then in zip(made(frames), before, strict=True)), path
        before = made(frames)


def test_files_of_each_frame(tmp_path: Path) -> None:
    for name in ("a.png", "b.png"):
        Image.new("RGB", (2, 2), "#ff8000").save(tmp_path / name)
    scene = snell.scenes["lecture/default"].replace(
        settings=snell.Render("whitted", size=(16, 16)), sky=snell.Sky(image="a.png"), folder=str(tmp_path)
    )
    skies = {"sky.image": ["a.png", "b.png"]}
    frames = snell.sweep(scene, skies, tmp_path / "frames")
    before = made(frames)
    Image.new("RGB", (2, 2), "#0080ff").save(tmp_path / "b.png")
    snell.sweep(scene, skies, tmp_path / "frames")
    assert [now == then for now, then in zip(made(frames), before, strict=True)] == [True, False]
    (tmp_path / "b.png").unlink()
    with pytest.raises(snell.SceneError, match=r"b\.png"):
        snell.sweep(scene, skies, tmp_path / "frames")
    wrong: Any = 3
    with pytest.raises(snell.SceneError, match=r"sky\.image"):
        snell.sweep(scene.replace(sky=snell.Sky(image=wrong)), {}, tmp_path / "frames")


def test_the_same_in_other_words_is_the_same(tmp_path: Path) -> None:
    scene = snell.scenes["lecture/default"]
    eta = {"material.glass.eta": [1, 1.5]}
    frames = snell.sweep(scene, eta, tmp_path, width=8, spp=2)
    before = made(frames)
    same: list[dict[str, Any]] = [
        {"spp": 2, "width": 8},
        {"width": np.int64(8), "spp": np.uint8(2)},
        {"width": 8, "spp": 2, "height": None, "integrator": None, "threads": np.int64(1)},
    ]
    for how in same:
        snell.sweep(scene, eta, tmp_path, **how)
        assert made(frames) == before, how


def test_what_is_no_sweep_is_said(tmp_path: Path) -> None:
    scene = snell.scenes["lecture/default"]
    wrong: Any
    for wrong in (3, None, [1, 2]):
        with pytest.raises(
            snell.SceneError, match=r"values: expected a dict of keys, each with a list of values, read"
        ):
            snell.sweep(scene, wrong, tmp_path / "frames")
    with pytest.raises(snell.SceneError, match=r"material\.glass\.eta: expected a list of values, one for each frame"):
        snell.sweep(scene, {"material.glass.eta": np.array(1.5)}, tmp_path / "frames")
    how: dict[str, Any]
    for how, said in (
        ({"colour": 1}, r"colour: there is no such parameter \(known are width, height, .*, progress\)"),
        ({"width": object()}, "width: expected a number, a text or a list"),
    ):
        with pytest.raises(snell.SceneError, match=said):
            snell.sweep(scene, {}, tmp_path / "frames", **how)
    with pytest.raises(snell.SceneError, match="Known here: glass"):
        snell.sweep(scene, {"material.gals.eta": [1]}, tmp_path / "frames")
    assert not (tmp_path / "frames").exists()
    with pytest.raises(snell.PictureError, match="is no folder for frames"):
        snell.sweep(scene, {}, str(tmp_path / "fra\0mes"))


def test_notes_of_someone_else_are_none(tmp_path: Path) -> None:
    (tmp_path / "sweep.json").write_text("[" * 100_000)
    frames = snell.sweep(snell.scenes["lecture/default"], {}, tmp_path, width=8)
    assert len(frames) == 1
