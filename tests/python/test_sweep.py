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
    with pytest.raises(snell.SceneError, match="known here: glass"):
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
