"""Bad input is answered with an exception that names the field, and nothing crashes."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, cast

import numpy as np
import pytest
from test_scenes import TETRAHEDRON, small

import snell
from snell import Box, Camera, Light, Material, Mesh, Render, Scene, SceneError, Sphere

NAN = float("nan")
VERTICES, FACES = TETRAHEDRON

BAD: list[tuple[str, dict[str, Any]]] = [
    ("sphere[0].radius", {"spheres": [Sphere((0, 0, 0), -9, "red")]}),
    ("sphere[0].radius", {"spheres": [Sphere((0, 0, 0), NAN, "red")]}),
    ("sphere[0].radius", {"spheres": [Sphere((0, 0, 0), "nine", "red")]}),  # type: ignore[arg-type]
    ("sphere[0].radius", {"spheres": [Sphere((0, 0, 0), 1j, "red")]}),  # type: ignore[arg-type]
    ("sphere[0].center[2]", {"spheres": [Sphere((0, 0, np.inf), 1, "red")]}),
    ("sphere[0].center", {"spheres": [Sphere((0, 0), 1, "red")]}),
    ("sphere[0].center", {"spheres": [Sphere(np.zeros((3, 3)), 1, "red")]}),
    ("sphere[1].material", {"spheres": [Sphere((0, 0, 0), 1, 0), Sphere((0, 0, 0), 1, 7)]}),
    ("sphere[0].material", {"spheres": [Sphere((0, 0, 0), 1, -1)]}),
    ("sphere[0].material", {"spheres": [Sphere((0, 0, 0), 1, "rde")]}),
    ("sphere[0]", {"spheres": [Light((0, 0, 0), 1)]}),
    ("sphere[0]", {"spheres": [42]}),
    ("camera.eye", {"camera": Camera("eye", (0, 0, 0), (0, 1, 0), fov=40)}),  # type: ignore[arg-type]
    ("camera", {"camera": None}),
    ("camera.width", {"camera": Camera((0, 0, 5), (0, 0, 0), (0, 1, 0), fov=40, width=7, height=7)}),
    ("render.integrator", {"settings": Render("lectrue", (4, 4))}),
    ("render.size", {"settings": Render("lecture", (0, 4))}),
    ("render.spp", {"settings": Render("lecture", (4, 4), spp=-1)}),
    ("light[0]", {"lights": [Light((0, 0, 0))]}),
    ("material.red.kd", {"materials": {"red": Material(kd=(1, 2))}}),
    ("material.red.eta", {"materials": {"red": Material(eta=0)}}),
    ("material.red", {"materials": {"red": 3}}),
    ("eta_outside", {"eta_outside": 0}),
    ("box[0].max", {"boxes": [Box((0, 0, 0), (1, 1, "x"), "red")]}),  # type: ignore[arg-type]
    ("mesh[0].vertices", {"meshes": [Mesh(np.zeros((4, 2)), FACES, "red")]}),
    ("mesh[0].vertices", {"meshes": [Mesh("corners", FACES, "red")]}),
    ("mesh[0].vertices[0]", {"meshes": [Mesh([(NAN, 0, 0), *VERTICES[1:]], FACES, "red")]}),
    ("mesh[0].faces", {"meshes": [Mesh(VERTICES, [(0, 1, 2.5)], "red")]}),
    ("mesh[0].faces", {"meshes": [Mesh(VERTICES, [(0, 1, -2)], "red")]}),
    ("mesh[0].faces", {"meshes": [Mesh(VERTICES, [(0, 1, NAN)], "red")]}),
    ("mesh[0].faces[0]", {"meshes": [Mesh(VERTICES, [(0, 1, 9)], "red")]}),
    ("mesh[0].file", {"meshes": [Mesh(file="nowhere.obj", material="red")]}),
]


@pytest.mark.parametrize(("place", "parts"), BAD, ids=lambda value: value if isinstance(value, str) else "")
def test_the_field_is_named(place: str, parts: dict[str, Any]) -> None:
    with pytest.raises(SceneError) as error:
        small(**parts).render()
    assert error.value.place is not None
    assert error.value.place.startswith(place), str(error.value)
    assert isinstance(error.value, ValueError)


@pytest.mark.parametrize(
    "how", [{"width": 0}, {"width": "x"}, {"height": -1}, {"width": 2**40}, {"threads": -1}, {"integrator": "x"}]
)
def test_settings_of_a_render_are_named(how: dict[str, Any]) -> None:
    with pytest.raises(SceneError) as error:
        small().render(**how)
    assert next(iter(how)) in str(error.value.place)


def test_what_does_not_fit_into_memory() -> None:
    with pytest.raises(snell.RenderError, match="bytes of memory"):
        small().render(width=2**31, height=2**31)


def test_files_are_named_with_their_line(tmp_path: Any) -> None:
    with pytest.raises(SceneError, match="no file"):
        snell.Scene.load("nowhere.toml")
    path = tmp_path / "bad.toml"
    path.write_text("snell = 1\nambient = 'much'\n")
    with pytest.raises(SceneError) as error:
        snell.Scene.load(path)
    assert error.value.place == f"{path}:2:11"
    with pytest.raises(KeyError):
        snell.scenes["lecture/nothing"]


def test_pictures_say_what_they_have_not(tmp_path: Any) -> None:
    picture = small().render()
    for wrong in [(16, 0), (0, 12), (-1, 0)]:
        with pytest.raises(snell.PictureError, match="columns are 0 to 15"):
            picture.explain(*wrong)
    for part in [(0, 0, 17, 1), (0, 0, 0, 1), (-1, 0, 2, 2), (15, 11, 2, 1)]:
        with pytest.raises(snell.PictureError, match="do not lie within"):
            picture.crop(*part)
    with pytest.raises(snell.PictureError, match=r"did you mean \.png"):
        picture.save(tmp_path / "a.pgn")
    with pytest.raises(snell.PictureError, match="shape"):
        picture.diff(np.zeros((1, 1, 3)))
    with pytest.raises(SceneError, match="Known here: none"):
        small().find("nobody")


def test_a_scene_may_change_while_it_is_rendered() -> None:
    scene = snell.scenes["lecture/default"]
    expected = scene.render(width=256).array.tobytes()
    pictures: list[bytes] = []

    def work() -> None:
        for _ in range(10):
            pictures.append(scene.render(width=256).array.tobytes())

    thread = threading.Thread(target=work)
    thread.start()
    while thread.is_alive():
        scene.ambient = 0.3
        scene.spheres = [*scene.spheres, Sphere((0, 0, 0), 1, 0)][:4]
        scene.ambient = 0.2
    thread.join()
    changed = scene.replace(ambient=0.3).render(width=256).array.tobytes()
    assert len(pictures) == 10
    assert set(pictures) <= {expected, changed}, "each picture is of one state"


def test_arguments_of_another_kind_are_named() -> None:
    scene, anything = snell.scenes["lecture/default"], cast(Any, object())
    picture = scene.render(width=8)
    tree = picture.explain(1, 1)
    told: list[tuple[type[snell.SnellError], str, Callable[[], object]]] = [
        (snell.SceneError, "spp", lambda: scene.render(spp=anything)),
        (snell.SceneError, "integrator", lambda: scene.render(integrator=anything)),
        (snell.SceneError, "threads", lambda: scene.render(threads=anything)),
        (snell.SceneError, "light", lambda: scene.replace(lights=None).render()),
        (snell.SceneError, "sphere", lambda: scene.replace(spheres=3).render()),
        (snell.SceneError, "material", lambda: scene.replace(materials="glass").render()),
        (snell.SceneError, "folder", lambda: scene.replace(folder=3).render()),
        (snell.SceneError, "name", lambda: scene.find(anything)),
        (snell.SceneError, "path", lambda: Scene.load(cast(Any, b"a"))),
        (snell.SceneError, "material.glass.eta", lambda: scene.with_("material.glass.eta", "a")),
        (snell.SceneError, "material.glas.eta", lambda: scene.with_("material.glas.eta", 2)),
        (snell.PictureError, "explain", lambda: picture.explain(cast(Any, 1.5), 1)),
        (snell.PictureError, "explain", lambda: picture.explain(anything, 1)),
        (snell.PictureError, "crop", lambda: picture.crop(0, 0, cast(Any, 2.0), 2)),
        (snell.PictureError, "text", lambda: tree.text(top=-1)),
        (snell.PictureError, "text", lambda: tree.text(depth=2**40)),
    ]
    for error, place, act in told:
        with pytest.raises(error) as caught:
            act()
        assert caught.value.place == place
    eight, two = cast(Any, np.int64(8)), cast(Any, np.int64(2))
    numbers = scene.render(width=eight, spp=two, threads=two)
    assert numbers.array.tobytes() == scene.render(width=8, spp=2).array.tobytes()
