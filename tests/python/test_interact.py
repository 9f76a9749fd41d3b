"""Sliders and views, without a notebook around them; `tests/jupyterlab` has one."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from IPython.core.interactiveshell import InteractiveShell
from test_copies import everything, remove_files

import snell
from snell.notebook.view import View

SCENE = snell.scenes["lecture/default"]


def test_a_slider_changes_scene_and_picture() -> None:
    ball = snell.interact(SCENE, eta=(1.0, 4.0), width=32)
    assert ball.values == {"material.glass.eta": 2.0}
    assert ball.picture.array.tobytes() == SCENE.render(width=32).array.tobytes()
    ball.set("material.glass.eta", 2.42)
    assert ball.scene == SCENE.with_("material.glass.eta", 2.42)
    assert ball.picture.array.tobytes() == ball.scene.render(width=32).array.tobytes()


def test_all_kinds_of_controls() -> None:
    controls = {
        "render.integrator": ["lecture", "whitted"],
        "sphere.glass.radius": (5, 9),
        "light.left.color": (0.0, 1.0, 0.25),
        "material.glass.tinted_transmission": [False, True],
    }
    ball = snell.interact(SCENE, controls, max_depth=(0, 8), width=8)
    assert ball.values == {
        "render.integrator": "lecture",
        "sphere.glass.radius": 9,
        "light.left.color": 0.75,
        "material.glass.tinted_transmission": False,
        "render.max_depth": 6,
    }


@pytest.mark.parametrize(
    ("control", "said"),
    [
        ({"eta": 3}, "expected (low, high), (low, high, step) or a list, read 3"),
        ({"eta": (4.0, 1.0)}, "expected a low number, a higher one"),
        ({"eta": (1.0, 2.0, 0.0)}, "and a step above 0"),
        ({"eta": (1.0, float("nan"))}, "read nan"),
        ({"eta": []}, "read []"),
        ({"eta": (None, 1)}, "read (None, 1)"),
        ({"kd": (0.0, 1.0)}, "several keys end with it: material.glass.kd, material.red.kd"),
        ({"etaa": (1.0, 2.0)}, "did you mean eta"),
        ({"eta_outside": (-1e308, 1e308)}, "expected a low number"),
        ({"eta_outside": (1.0, 10**400)}, "expected a low number"),
    ],
)
def test_odd_controls_are_named(control: dict[str, Any], said: str) -> None:
    with pytest.raises(snell.SceneError) as caught:
        snell.interact(SCENE, **control)
    assert said in str(caught.value)


def test_what_is_no_scene_or_has_no_such_index_is_said() -> None:
    odd: list[Any] = ["lecture/default", None, SCENE.render(width=8)]
    for scene in odd:
        with pytest.raises(snell.SceneError, match="expected a Scene"):
            snell.interact(scene, eta=(1.0, 2.0))
    keys: Any = ["eta"]
    with pytest.raises(snell.SceneError, match="expected keys with their values"):
        snell.interact(SCENE, keys)
    odd_glass: Any = "x"
    with pytest.raises(snell.SceneError):
        snell.interact(SCENE.replace(materials={"glass": snell.Material(ko=odd_glass)}), eta=(1.0, 2.0))
    opaque = SCENE.with_("material.glass.ko", 1.0)
    for scene in (opaque, snell.scenes["gallery/prism"]):  # glass by name has no index of its own
        with pytest.raises(snell.SceneError, match="no material is transparent and has an index of its own"):
            snell.interact(scene, eta=(1.0, 2.0), width=8)


#: Two values of every kind of thing.
MOVED: dict[str, list[Any]] = {
    "material.red.kd": [0.5, [0.2, 0.7, 0.1]],
    "material.glass.eta": [1.5, 1.9],
    "light.1.color": [1.0, 0.4],
    "light.1.position": [[1, 2, 3], [-3, 1, 4]],
    "camera.eye": [[0, 0, 5], [1, 0.5, 6]],
    "camera.fov": [40, 55],
    "ambient": [0.2, 0.7],
    "sky.rotate": [0, 40],
    "sky.brightness": [1, 2],
    "render.max_depth": [32, 1],
    "render.seed": [0, 9],
    "render.size": [[24, 18], [20, 10]],
    "render.shadows": ["opaque", "off"],
    "sphere.ball.radius": [0.7, 0.4],
    "mesh.tetra.transform": [[], [{"move": [0.4, 0, 0]}]],
    "mesh.again.transform": [[{"move": [1, 0, -2]}], [{"move": [-1, 0, -2]}]],
    "mesh.quad.instances": [[], [[{"move": [0, 1, 0]}], [{"move": [0, -1, 0]}]]],
    "mesh.tetra.smooth_angle": [0, 90],
    "texture.leaf.repeat": [[2, 2], [3, 1]],
    "plane.leaf.size": [[1, 1], [2, 1]],
}
#: And of what decides which files are read, and how.
READING: dict[str, list[Any]] = {
    "texture.leaf.linear": [False, True],
    "texture.leaf.image": ["leaf.png", "tiles.png"],
    "sky.image": ["sky.png", "tiles.png"],
    "mesh.again.material": ["red", "leaf"],
    "mesh.quad.file": ["quad.obj", "./quad.obj"],
    "render.integrator": ["whitted", "course2020"],
}


@pytest.mark.filterwarnings("ignore::snell.SnellWarning")
def test_a_slider_shows_what_the_scene_is_rendered_anew(tmp_path: Path) -> None:
    controls = MOVED | READING
    moving = snell.interact(everything(tmp_path), controls, width=12, spp=2)
    start = moving.picture.array.tobytes()
    for key, (first, second) in controls.items():
        moving.set(key, second)
        expected = moving.scene.render(width=12, spp=2)
        assert moving.picture.array.tobytes() == expected.array.tobytes(), key
        assert moving.picture._repr_png_() == expected._repr_png_(), f"{key}: and the recipe"
        moving.set(key, first)
        assert moving.picture.array.tobytes() == start, key


@pytest.mark.filterwarnings("ignore::snell.SnellWarning")
def test_a_slider_reads_no_file_again(tmp_path: Path) -> None:
    moving = snell.interact(everything(tmp_path), MOVED | READING, width=12)
    remove_files(tmp_path)
    for key, (_, second) in MOVED.items():
        moving.set(key, second)
    before = moving.picture
    for key, (_, second) in READING.items():
        with pytest.raises(snell.SceneError, match="is not there"):
            moving.set(key, second)
    assert moving.picture is before


def test_what_has_one_value_is_a_setting_and_no_slider() -> None:
    settings: dict[str, Any] = {"spp": 2, "seed": 3, "integrator": "whitted", "shadows": "off"}
    assert snell.interact(SCENE, width=8, eta=(1.0, 2.0), **settings).values == {"material.glass.eta": 2.0}
    sliders: dict[str, Any] = {"shadows": ["opaque", "off"], "integrator": ["lecture", "whitted"]}
    assert set(snell.interact(SCENE, width=8, **sliders).values) == {"render.shadows", "render.integrator"}


def test_a_value_that_cannot_be_drawn_changes_nothing() -> None:
    ball = snell.interact(SCENE, {"sphere.glass.radius": (-5.0, 9.0)}, width=8)
    before = ball.picture
    with pytest.raises(snell.SceneError, match="radius"):
        ball.set("sphere.glass.radius", -1.0)
    assert (ball.picture, ball.values) == (before, {"sphere.glass.radius": 9.0})
    with pytest.raises(snell.SceneError, match="there is no such slider"):
        ball.set("eta", 2)


class Kernel:
    """What displays messages in a notebook: here they are written down, and nothing is shown."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.shown: list[tuple[str, bool]] = []
        make: Any = InteractiveShell
        shell = make()
        shell.kernel = None  # it is what a notebook has and a terminal has not
        monkeypatch.setattr(InteractiveShell, "_instance", shell)
        monkeypatch.setattr(InteractiveShell, "initialized", classmethod(lambda cls: True))
        monkeypatch.setattr(InteractiveShell, "instance", classmethod(lambda cls: shell))
        monkeypatch.setattr("IPython.get_ipython", lambda: shell)
        shell.display_pub = self

    def publish(self, data: dict[str, Any], *_: Any, update: bool = False, **__: Any) -> None:
        kinds = ("image/png", "application/vnd.jupyter.widget-view+json", "text/plain")
        self.shown.append((next(kind for kind in kinds if kind in data).split("/")[1].split(".")[-1], update))

    def take(self) -> list[tuple[str, bool]]:
        shown, self.shown = self.shown, []
        return shown


PICTURE, WIDGET, CHANGED = ("png", False), ("widget-view+json", False), ("png", True)


def test_each_cell_that_shows_sliders_has_its_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    kernel = Kernel(monkeypatch)
    ball = snell.interact(SCENE, {"render.size": [[8, 8], [16, 16]]}, eta=(1.0, 4.0))
    ball._ipython_display_()
    assert kernel.take() == [PICTURE, WIDGET]
    ball._ipython_display_()
    assert kernel.take() == [PICTURE, WIDGET]
    # From Python: both pictures, once, and the slider moves.
    ball.set("material.glass.eta", 3.0)
    assert kernel.take() == [CHANGED, CHANGED]
    slider = ball._widgets["material.glass.eta"]
    assert slider.value == 3.0
    # From the front end, and what cannot be drawn.
    slider.value = 2.5
    assert kernel.take() == [CHANGED, CHANGED]
    assert ball.scene == SCENE.with_("material.glass.eta", 2.5).with_("render.size", [8, 8])
    assert "million rays" in ball._says.value
    ball._widgets["render.size"].value = [16, 16]
    assert (ball.picture.width, kernel.take()) == (16, [CHANGED, CHANGED])


def test_each_cell_that_shows_a_view_has_its_still(monkeypatch: pytest.MonkeyPatch) -> None:
    kernel = Kernel(monkeypatch)
    view = SCENE.view(width=16, height=12, css_height="20rem")
    assert view.picture.height == 12
    for _ in range(2):
        view._ipython_display_()
        assert kernel.take() == [PICTURE, WIDGET]
    view._hear(view._widget, {"kind": "still"}, [memoryview(view.picture._repr_png_())])
    assert kernel.take() == [CHANGED, CHANGED]


def test_without_a_front_end_it_is_said_in_a_line(capsys: pytest.CaptureFixture[str]) -> None:
    SCENE.view(width=8)._ipython_display_()
    snell.interact(SCENE, eta=(1.0, 2.0), width=8)._ipython_display_()
    said = "<View of lecture/default, 8 x 8>\n<Interactive material.glass.eta=2.0>\n"
    assert capsys.readouterr().out == said


def test_sliders_start_where_the_scene_is() -> None:
    controls = {"light.1.color": (0.0, 1.0), "sphere.1.radius": (1, 20), "material.glass.eta": (1, 3)}
    ball = snell.interact(SCENE.with_("material.glass.eta", 1.5), controls, width=8)
    assert ball.values == {"light.1.color": 0.75, "sphere.1.radius": 9, "material.glass.eta": 1.5}


def test_changing_the_scene_afterwards_changes_no_slider() -> None:
    scene = SCENE.replace()
    ball = snell.interact(scene, eta=(1.0, 4.0), width=8)
    scene.eta_outside = 3.0
    ball.set("material.glass.eta", 1.5)
    assert ball.scene == SCENE.with_("material.glass.eta", 1.5)


def test_a_view_explains_pixels() -> None:
    picture = SCENE.render(width=64)
    view = picture.view()
    assert view.tree is None
    assert view.explain(24, 37) is view.tree
    assert picture.explain(24, 37).view().tree is not None
    with pytest.raises(snell.PictureError, match="only a whole picture"):
        picture.crop(0, 0, 8, 8).view()
    other: list[Any] = ["x", SCENE.render(width=64).explain(1, 1)]
    for tree in other:
        with pytest.raises(snell.PictureError, match="expected a tree of this picture"):
            view.tree = tree
    height: Any = 300
    with pytest.raises(snell.PictureError, match="expected a length"):
        picture.view(css_height=height)


class FrontEnd:
    """What a widget is to a view: traits, and messages to the front end."""

    def __init__(self) -> None:
        self.tree: Any = None
        self.sent: list[Any] = []

    def send(self, message: Any) -> None:
        self.sent.append(message)

    def send_state(self, name: str) -> None:
        self.sent.append(name)


def test_a_view_answers_clicks_and_survives_nonsense() -> None:
    view = View(SCENE.render(width=64))
    widget = view._widget = FrontEnd()
    view._hear(widget, {"kind": "explain", "pixel": [24, 37]}, [])
    assert widget.tree["pixel"] == [24, 37]
    assert widget.tree == json.loads(view.picture.explain(24, 37).to_json())
    view._hear(widget, {"kind": "explain", "pixel": [64, 0]}, [])
    assert widget.sent[-1]["kind"] == "error"
    assert "there is no pixel 64,0" in widget.sent[-1]["message"]
    nothing: list[Any] = [None, {}, [], {"kind": "still"}]
    for unknown in nothing:
        view._hear(widget, unknown, [])
    # Whoever asks for a pixel waits for an answer.
    for pixel in (None, "a", [1.5, 2], ["a", 0], [10**40, 0], [1]):
        widget.sent.clear()
        view._hear(widget, {"kind": "explain", "pixel": pixel}, [])
        assert [message["kind"] for message in widget.sent] == ["error"]
    for buffer in ("x", None, 5, b"no png"):
        view._hear(widget, {"kind": "still"}, [buffer])
    assert widget.tree["pixel"] == [24, 37]


def test_the_viewer_knows_the_scene() -> None:
    shown = json.loads(SCENE.render(width=8)._native.view())
    assert [sphere["name"] for sphere in shown["spheres"]] == ["glass", "red", "green", "blue"]
    assert [light["name"] for light in shown["lights"]] == ["left", "right"]
    assert (shown["snell_view"], shown["transfer"]) == (1, "linear")
