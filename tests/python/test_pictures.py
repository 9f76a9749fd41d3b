"""Pictures: numbers without a copy, files, memory, explanations."""

from __future__ import annotations

import gc
import json
import resource
import struct
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from common import ROOT
from common import snell as command

import snell
from snell import Scene


def lecture(width: int = 64) -> snell.Picture:
    return snell.scenes["lecture/default"].render(width=width)


def test_the_film_is_not_copied_and_outlives_its_picture() -> None:
    picture = lecture()
    assert np.shares_memory(picture.array, picture._native.array)
    assert np.asarray(picture) is picture.array
    array, copy = picture.array, picture.array.copy()
    assert not array.flags.writeable
    assert not array.flags.owndata
    with pytest.raises(ValueError, match="WRITEABLE"):
        array.flags.writeable = True
    del picture
    gc.collect()
    lecture()
    assert array.tobytes() == copy.tobytes()


def test_a_large_film_is_held_once() -> None:
    """4096 x 4096 pixels are 403 MB of numbers: a copy would show."""
    script = (
        "import resource, snell\n"
        "picture = snell.scenes['lecture/default'].render(width=4096)\n"
        "print(picture.array.nbytes, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024)\n"
    )
    run = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    film, peak = map(int, run.stdout.split())
    assert film == 4096 * 4096 * 24
    assert peak < film + 200e6, f"{peak / 1e6:.0f} MB"


def test_many_renders_do_not_grow() -> None:
    def resident() -> int:
        return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()

    scene = snell.scenes["lecture/default"]
    for _ in range(20):
        scene.render(width=128).explain(1, 1)
    before = resident()
    for _ in range(1000):
        scene.render(width=128).explain(1, 1)
    for _ in range(100):
        assert scene.render(width=128).channels.names
    # Films that are kept would be 400 MB; an allocator may hold some pages.
    assert resident() - before < 8e6


def test_files_are_those_of_the_command_line(tmp_path: Path) -> None:
    picture = lecture()
    for ending in ("png", "exr", "ppm", "npy"):
        picture.save(tmp_path / f"python.{ending}")
        command("render", "--quiet", "lecture/default", "--size", "64x64", "-o", str(tmp_path / f"command.{ending}"))
        said = command("diff", str(tmp_path / f"python.{ending}"), str(tmp_path / f"command.{ending}"))
        assert " 0 of 4096 pixels differ" in said, said
    assert np.load(tmp_path / "python.npy").tobytes() == picture.array.tobytes()
    picture.save(tmp_path / "deep.png", bits=16)
    assert (tmp_path / "deep.png").read_bytes()[24] == 16


def test_a_picture_remembers_how_it_was_made(tmp_path: Path) -> None:
    part = lecture().crop(10, 20, 30, 25)
    for name, picture in (("whole", lecture()), ("part", part)):
        picture.save(tmp_path / f"{name}.png")
        # It fails if the film is another one.
        command("render", "--quiet", "--from", str(tmp_path / f"{name}.png"), "-o", str(tmp_path / "again.npy"))
        assert np.load(tmp_path / "again.npy").tobytes() == picture.array.tobytes()


def test_notebooks_get_a_png() -> None:
    png = lecture()._repr_png_()
    assert png.startswith(b"\x89PNG")
    assert struct.unpack(">II", png[16:24]) == (64, 64)


def test_parts_and_differences() -> None:
    picture = lecture()
    part = picture.crop(10, 20, 30, 25).crop(5, 5, 10, 10)
    assert part.array.tobytes() == picture.array[25:35, 15:25].tobytes()
    assert part.explain(3, 4).pixel == (18, 29)
    other = snell.scenes["lecture/diamond"].render(width=64)
    difference = picture.diff(other)
    assert 0 < difference.pixels < difference.total == 4096
    assert difference.largest == np.abs(picture.array - other.array).max()
    assert picture.diff(picture.array).pixels == 0


@pytest.mark.parametrize(("name", "width"), [("lecture/default", 512), ("gallery/prism", 64), ("gallery/bubbles", 64)])
def test_contributions_add_up_to_the_pixel(name: str, width: int) -> None:
    picture = snell.scenes[name].render(width=width)
    for x, y in [(width // 3, picture.height // 2), (width // 2, picture.height // 2), (0, 0)]:
        tree = picture.explain(x, y)
        for sample in tree.samples:
            total = np.zeros(3)
            for node in sample.nodes:
                total += node.contribution
            assert tuple(total) == sample.color
        assert tree.color == tuple(picture.array[y, x])


def test_a_tree_has_all_forms(tmp_path: Path) -> None:
    tree = snell.scenes["lecture/default"].render().explain(190, 300)
    few = tree.text(top=1, depth=1).replace("text(top=N, depth=N) shows", "--top N and --depth N show")
    assert tree.text() == command("explain", "lecture/default", "190,300")
    assert few == command("explain", "lecture/default", "190,300", "--top", "1", "--depth", "1")
    assert tree.to_json() == command("explain", "lecture/default", "190,300", "--json").strip()
    command("explain", "lecture/default", "190,300", "--html", str(tmp_path / "command.html"))
    tree.save(tmp_path / "python.html")
    assert (tmp_path / "python.html").read_bytes() == (tmp_path / "command.html").read_bytes()
    tree.save(tmp_path / "tree.json")
    assert json.loads((tmp_path / "tree.json").read_text())["pixel"] == [190, 300]
    assert "refracted → green" in tree._repr_html_()
    assert tree.nodes[0].hit is not None
    assert tree.nodes[0].hit.object == "glass"
    assert {node.kind for node in tree.nodes} == {"camera", "refracted", "mirror"}


def test_a_tree_is_drawn(tmp_path: Path) -> None:
    tree = snell.scenes["gallery/pencil"].render(spp=1).explain(300, 500)
    figure = tree.figure()
    command("explain", "gallery/pencil", "300,500", "--spp", "1", "--svg", str(tmp_path / "command.svg"))
    assert figure.svg == (tmp_path / "command.svg").read_text(encoding="utf-8")
    assert figure._repr_svg_() == figure.svg
    for save, name in ((figure.save, "figure.svg"), (tree.save, "tree.svg")):
        save(tmp_path / name)
        assert (tmp_path / name).read_text(encoding="utf-8") == figure.svg


def test_a_tree_is_shown_with_its_colours() -> None:
    tree = snell.scenes["lecture/default"].render().explain(190, 300)
    page = tree._repr_html_()
    assert "\x1b" not in page
    # The pixel itself, and the camera ray, whose light it is: #1d7d1d.
    assert page.count("rgb(29,125,29)") == 2


def test_channels_are_what_a_sphere_is() -> None:
    """Depth, normal and object of the glass ball, by the lecture's formulas in NumPy."""
    picture = snell.scenes["lecture/default"].render(width=64)
    channels = picture.channels
    line = np.linspace(-2.0, 2.0, 64)
    plane = np.stack(np.broadcast_arrays(50 + line, 50 - line[:, None], 95.0), axis=2)
    away = plane - (50, 50, 100)
    away /= np.linalg.norm(away, axis=2, keepdims=True)
    towards = np.array((50.0, 50, 50)) - plane
    along = (towards * away).sum(axis=2)
    half = 81 - ((towards**2).sum(axis=2) - along**2)
    glass = half > 0  # nothing is in front of it
    depth = along[glass] - np.sqrt(half[glass])
    assert np.array_equal(channels.mask("glass"), glass)
    # Distances near 40 with 16 digits, of which squares and roots lose two.
    assert np.abs(channels.depth[glass] - depth).max() < 1e-12
    normal = (plane + channels.depth[..., None] * away - (50, 50, 50))[glass] / 9
    assert np.abs(channels.normal[glass] - normal).max() < 1e-12
    nothing = ~np.isfinite(channels.depth)
    assert nothing[0, 0]
    assert np.array_equal(nothing, channels.object == -1)
    assert not channels.normal[nothing].any()
    assert not channels.hits[nothing].any()


def test_channels_of_a_part_are_a_part_of_them() -> None:
    picture = lecture()
    part = picture.crop(20, 10, 30, 25)
    for name in ("depth", "normal", "object", "hits"):
        assert np.array_equal(getattr(part.channels, name), getattr(picture.channels, name)[10:35, 20:50])
    x, y = 24, 37  # the green ball in the glass
    assert picture.channels.hits[y, x] == sum(node.hit is not None for node in picture.explain(x, y).nodes)
    assert struct.unpack(">II", picture.channels._repr_png_()[16:24]) == (4 * 64, 64)
    with pytest.raises(snell.PictureError, match="objects: glass, red, green, blue"):
        picture.channels.mask("gras")


def test_what_rendering_comes_upon_is_said() -> None:
    water, glass = snell.Material(eta=1.33, ko=0), snell.Material(eta=1.5, ko=0)
    camera = snell.Camera((0, 0, 10), (0, 0, 0), (0, 1, 0), (-0.3, 0.3, -0.3, 0.3), near=-1, width=24, height=24)
    drop = snell.Sphere((-0.5, 0, 0), 1.5, "water", name="drop")
    ball = snell.Sphere((0.5, 0, 0), 1.5, "glass", name="ball")
    scene = Scene(
        settings=snell.Render("whitted", max_depth=8),
        camera=camera,
        background=1.0,
        materials={"water": water, "glass": glass},
        spheres=[drop, ball],
    )
    with pytest.warns(snell.SnellWarning, match="W008 overlap: `ball` and `drop` overlap"):
        picture = scene.render()
    assert any("W008" in remark for remark in picture.remarks)
    # What is known before is said before: the lecture's ball, cut open by an image plane that stands in its middle.
    with pytest.warns(snell.SnellWarning, match="W009 before-image-plane: .* something of `glass`, which"):
        snell.scenes["lecture/default"].with_("camera.near", -50).render(width=8)
    # Lost light is nothing to be warned of, and is known.
    mirrors = snell.scenes["lecture/diamond-depth-1"].render(width=64)
    assert [remark[:15] for remark in mirrors.remarks] == ["W202 lost-light"]


def test_sightings_are_those_of_the_command_line() -> None:
    found = snell.scenes["lecture/default"].replace(camera=snell.scenes["study/quarter-view"].camera).find("green")
    assert found.mask.shape == (512, 512)
    said = command("explain", "study/quarter-view", "--find", "green")
    assert all(f"{pixels:9} px  {path}\n" in said for path, pixels in found.paths[:5])
    assert f"{(found.mask > 0).sum():9} px  together" in said


def test_another_shape_keeps_pixels_square(tmp_path: Path) -> None:
    wide = snell.scenes["lecture/default"].render(width=60, height=30)
    command("render", "--quiet", "lecture/default", "--size", "60x30", "-o", str(tmp_path / "wide.npy"))
    assert wide.array.tobytes() == np.load(tmp_path / "wide.npy").tobytes()


def test_progress_is_told_and_may_fail() -> None:
    scene = snell.scenes["gallery/brilliant"]
    told: list[tuple[int, int, int]] = []
    picture = scene.render(width=300, spp=2, progress=lambda *done: told.append(done))
    assert told
    assert all(0 <= pixels <= total == picture.width * picture.height for pixels, total, _ in told)
    assert told == sorted(told)

    def fail(*_: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        scene.render(width=2000, spp=64, progress=fail)

    # Whoever counts is told the end, however short it was.
    told.clear()
    scene.render(width=8, spp=1, progress=lambda *done: told.append(done))
    assert told[-1][0] == told[-1][1] > 0


def test_the_readme_is_right(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    blocks = (ROOT / "README.md").read_text().split("```python\n")[1:]
    assert blocks
    variables: dict[str, object] = {}
    for block in blocks:
        exec(block.split("```")[0], variables)
    assert any(tmp_path.iterdir())


def test_odd_scenes_warn() -> None:
    scene = snell.scenes["lecture/default"].with_("material.glass.tinted_transmission", True)
    draw: list[Callable[[], object]] = [
        lambda: scene.render(width=8),
        lambda: scene.view(width=8),
        lambda: snell.interact(scene, eta=(1.0, 2.0), width=8),
        lambda: scene.find("green"),
    ]
    for act in draw:
        with pytest.warns(snell.SnellWarning, match="W006") as caught:
            act()
        assert [Path(warning.filename).name for warning in caught] == ["test_pictures.py"]
