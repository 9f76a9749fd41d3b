"""Sliders and views, without a notebook around them; `tests/jupyterlab` has one."""

from __future__ import annotations

import json
from typing import Any

import pytest

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
        "material.glass.dyed": [False, True],
    }
    ball = snell.interact(SCENE, controls, max_depth=(0, 8), width=8)
    assert ball.values == {
        "render.integrator": "lecture",
        "sphere.glass.radius": 9,
        "light.left.color": 0.75,
        "material.glass.dyed": False,
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
        ({"eta": ("a", "b")}, "read ('a', 'b')"),
        ({"kd": (0.0, 1.0)}, "several keys end with it: material.glass.kd, material.red.kd"),
        ({"etaa": (1.0, 2.0)}, "did you mean eta"),
    ],
)
def test_odd_controls_are_named(control: dict[str, Any], said: str) -> None:
    with pytest.raises(snell.SceneError) as caught:
        snell.interact(SCENE, **control)
    assert said in str(caught.value)


def test_a_value_that_cannot_be_drawn_changes_nothing() -> None:
    ball = snell.interact(SCENE, {"sphere.glass.radius": (-5.0, 9.0)}, width=8)
    before = ball.picture
    with pytest.raises(snell.SceneError, match="radius"):
        ball.set("sphere.glass.radius", -1.0)
    assert (ball.picture, ball.values) == (before, {"sphere.glass.radius": 9.0})
    with pytest.raises(snell.SceneError, match="there is no such slider"):
        ball.set("eta", 2)


def test_a_view_explains_pixels() -> None:
    picture = SCENE.render(width=64)
    view = picture.view()
    assert view.tree is None
    assert view.explain(24, 37) is view.tree
    assert picture.explain(24, 37).view().tree is not None
    with pytest.raises(snell.PictureError, match="only a whole picture"):
        picture.crop(0, 0, 8, 8).view()


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
    odd: list[Any] = [None, {}, [], {"kind": "explain"}, {"kind": "explain", "pixel": "a"}, {"kind": "still"}]
    for nonsense in odd:
        view._hear(widget, nonsense, [])
    assert widget.tree["pixel"] == [24, 37]


def test_the_viewer_knows_the_scene() -> None:
    shown = json.loads(SCENE.render(width=8)._native.view())
    assert [sphere["name"] for sphere in shown["spheres"]] == ["glass", "red", "green", "blue"]
    assert [light["name"] for light in shown["lights"]] == ["left", "right"]
    assert (shown["snell_view"], shown["transfer"]) == (1, "linear")
