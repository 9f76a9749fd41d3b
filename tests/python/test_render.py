"""What `Scene.render` and its kin can be told, and that it changes no scene."""

from __future__ import annotations

import copy
import inspect
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_scenes import small

import snell
from snell.how import How, Settings
from snell.scene import Scene

GLASS = small(
    settings=snell.Render("whitted", (16, 12), spp=2),
    spheres=[snell.Sphere((0, 0, 0), 1, "glass"), snell.Sphere((0.8, 0.3, -3), 1, "red")],
    ambient=0.5,
)

#: Each parameter with another value, and the same said by the scene's own settings.
SAID: list[tuple[dict[str, Any], dict[str, Any]]] = [
    ({"spp": 3}, {"render.spp": 3}),
    ({"depth": 1}, {"render.max_depth": 1}),
    ({"seed": 7}, {"render.seed": 7}),
    ({"integrator": "lecture"}, {"render.integrator": "lecture"}),
    ({"shadows": "off"}, {"render.shadows": "off"}),
    ({"width": 8, "height": 6}, {"render.size": [8, 6]}),
]


@pytest.mark.parametrize(("how", "keys"), SAID, ids=",".join)
def test_a_parameter_is_the_setting_of_the_scene(how: dict[str, Any], keys: dict[str, Any]) -> None:
    scene, changed = GLASS.replace(), GLASS
    for key, value in keys.items():
        changed = changed.with_(key, value)
    told = scene.render(**how)
    assert told.array.tobytes() == changed.render().array.tobytes() != GLASS.render().array.tobytes()
    assert scene == GLASS, "it is as it was"
    assert scene.explain(3, 4, **how).to_json() == told.explain(3, 4).to_json()


def test_a_part_is_a_part_of_the_picture(tmp_path: Path) -> None:
    whole = GLASS.render(width=40)
    corner: Any = np.array((10, 5, 20, 9))
    part = GLASS.render(width=40, crop=corner)
    assert (part.region, part.full_size) == ((10, 5, 20, 9), (40, 30))
    assert part.array.tobytes() == whole.crop(10, 5, 20, 9).array.tobytes()
    assert part.explain(2, 3).to_json() == whole.explain(12, 8).to_json()
    assert np.array_equal(part.channels.hits, whole.channels.hits[5:14, 10:30])
    told: list[tuple[int, int, int]] = []
    GLASS.render(width=40, crop=(10, 5, 20, 9), progress=lambda *now: told.append(now))
    assert told[-1][:2] == (180, 180)
    frames = snell.sweep(GLASS, {}, tmp_path, width=40, crop=(10, 5, 20, 9))
    assert frames[0].stat().st_size > 0
    assert snell.interact(GLASS, eta=(1.0, 2.0), width=40, crop=(10, 5, 20, 9)).picture.width == 20


def test_one_pixel_is_explained_without_the_others() -> None:
    tree = GLASS.explain(8, 6, spp=1)
    assert tree.color == tuple(GLASS.render(spp=1).array[6, 8])
    assert tree.size == (16, 12)
    with pytest.raises(snell.PictureError, match=r"there is no pixel 16,0 \(columns are 0 to 15, rows 0 to 11"):
        GLASS.explain(16, 0)


@pytest.mark.parametrize(
    ("how", "place"),
    [
        ({"crop": (0, 0, 0, 4)}, "crop"),
        ({"crop": (0, 0, 17, 12)}, "crop"),
        ({"crop": (-1, 0, 4, 4)}, "crop"),
        ({"crop": (0, 0, 4)}, "crop"),
        ({"crop": 4}, "crop"),
        ({"crop": "0,0,4,4"}, "crop"),
        ({"crop": (0.5, 0, 4, 4)}, "crop"),
        ({"spp": 0}, "spp"),
        ({"spp": 2.0}, "spp"),
        ({"depth": -1}, "depth"),
        ({"depth": 1001}, "depth"),
        ({"seed": 2**32}, "seed"),
        ({"integrator": "lectrue"}, "integrator"),
        ({"shadows": "soft"}, "shadows"),
        ({"shadows": "tinted", "integrator": "lecture"}, "shadows"),
    ],
)
def test_a_parameter_that_is_wrong_is_named(how: dict[str, Any], place: str) -> None:
    with pytest.raises(snell.SceneError) as error:
        GLASS.render(**how)
    assert error.value.place == place, str(error.value)


def test_what_the_scene_says_keeps_its_place() -> None:
    wrong = GLASS.replace(settings=snell.Render("whitted", (4, 4), spp=0))
    with pytest.raises(snell.SceneError) as error:
        wrong.render(depth=2)
    assert error.value.place == "render.spp"
    assert wrong.render(spp=1).finished, "another value takes its place"


def test_all_that_render_have_the_same_parameters(tmp_path: Path) -> None:
    taken = set(inspect.signature(Scene.render).parameters) - {"self", "progress", "client", "task_seconds"}
    assert taken == set(How.__annotations__)
    assert set(How.__annotations__) - set(Settings.__annotations__) == {"crop", "threads"}
    settings: dict[str, Any] = {
        "width": 8,
        "spp": 2,
        "depth": 3,
        "seed": 1,
        "integrator": "whitted",
        "shadows": "opaque",
    }
    picture = GLASS.render(**settings).array.tobytes()
    assert GLASS.view(**settings).picture.array.tobytes() == picture
    assert snell.interact(GLASS, eta=(1.0, 2.0), **settings).picture.array.tobytes() == picture
    assert GLASS.find("sphere 1", **settings).mask.shape == (6, 8)
    first = snell.sweep(GLASS, {}, tmp_path, **settings)
    assert snell.sweep(GLASS, {}, tmp_path, threads=1, **settings) == first
    wrong: Any = {"colour": 1}
    for act in (GLASS.find, lambda name, **how: GLASS.explain(0, 0, **how)):
        with pytest.raises(snell.SceneError, match="colour: there is no such parameter"):
            act("sphere 1", **wrong)


def test_a_picture_is_an_array() -> None:
    picture = GLASS.render()
    assert np.asarray(picture) is picture.array
    assert np.asarray(picture, dtype=np.float64) is picture.array
    assert np.asarray(picture, dtype=np.float32).dtype == np.float32
    mine = np.array(picture)
    assert mine.flags.writeable
    assert not np.shares_memory(mine, picture.array)
    assert picture.__array__(copy=False) is picture.array
    assert picture.__array__(np.dtype("f4"), copy=True).dtype == np.float32
    mine = picture.__array__(copy=True)
    assert mine.flags.writeable
    assert not np.shares_memory(mine, picture.array)
    with pytest.raises(ValueError, match="numbers of float32 need a copy"):
        picture.__array__(np.float32, copy=False)
    assert np.abs(picture).max() == picture.array.max()
    assert np.allclose(picture, copy.copy(picture), rtol=0, atol=0)
