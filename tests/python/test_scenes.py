"""Scenes as values, and as files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from common import ROOT, film

import snell
from snell import Camera, Light, Material, Mesh, Plane, Render, Scene, Sphere

TETRAHEDRON = ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])


def small(**parts: object) -> Scene:
    scene = Scene(
        settings=Render("lecture", (16, 12)),
        camera=Camera((0, 0, 5), (0, 0, 0), (0, 1, 0), fov=40),
        lights=[Light((1, 2, 3), 1)],
        materials={"red": Material(kd=(1, 0, 0)), "glass": Material(ko=0, eta=1.5)},
    )
    return scene.replace(**parts)


@pytest.mark.parametrize("name", [*snell.scenes, "tests/polygons.toml"])
@pytest.mark.parametrize("ending", ["toml", "json"])
def test_every_scene_comes_back(name: str, ending: str, tmp_path: Path) -> None:
    scene = Scene.load(ROOT / name if name.endswith(".toml") else name)
    scene.save(tmp_path / f"again.{ending}")
    again = Scene.load(tmp_path / f"again.{ending}")
    assert again == scene
    assert eval(repr(scene), dict(vars(snell))) == scene
    assert scene.replace() == scene


def test_a_saved_scene_has_the_same_picture(tmp_path: Path) -> None:
    scene = snell.scenes["gallery/window"]
    scene.save(tmp_path / "window.toml")
    picture = scene.render(width=40)
    size = f"{picture.width}x{picture.height}"
    assert picture.array.tobytes() == film(str(tmp_path / "window.toml"), tmp_path, "--size", size).tobytes()


def test_meshes_are_arrays(tmp_path: Path) -> None:
    vertices, faces = map(np.array, TETRAHEDRON)
    scene = small(meshes=[Mesh(vertices, faces, "red"), Mesh(*TETRAHEDRON, 0, transform=[{"move": (1, 0, 0)}])])
    assert scene == small(meshes=[Mesh(*TETRAHEDRON, 0), Mesh(*TETRAHEDRON, "red", transform=[{"move": [1, 0, 0]}])])
    assert scene != small(meshes=[Mesh(vertices * 2, faces, "red"), scene.meshes[1]])
    assert scene.render().array.max() > 0
    scene.save(tmp_path / "mesh.toml")
    assert Scene.load(tmp_path / "mesh.toml") == scene
    assert scene.render().array.tobytes() == film(str(tmp_path / "mesh.toml"), tmp_path).tobytes()
    assert eval(repr(scene), dict(vars(snell))) == scene


def test_large_meshes_go_beside_a_saved_scene(tmp_path: Path) -> None:
    draw = np.random.default_rng(0)
    vertices = draw.uniform(-1, 1, (3000, 3))
    scene = small(meshes=[Mesh(vertices, np.arange(4500).reshape(-1, 3) % 3000, "red")])
    for name in ("large.toml", "large.json"):
        scene.save(tmp_path / name)
        assert (tmp_path / name).stat().st_size < 4000
        assert scene.render().array.tobytes() == film(str(tmp_path / name), tmp_path).tobytes()
    (mesh,) = tmp_path.glob("*.ply")
    mesh.write_text("mine")
    with pytest.raises(snell.SceneError, match="is something else"):
        scene.save(tmp_path / "large.toml")
    assert mesh.read_text() == "mine"


def test_an_infinite_abbe_number_is_no_dispersion() -> None:
    def picture(abbe: float | None) -> bytes:
        material = {"glass": Material(ko=0, eta=1.5, abbe=abbe), "red": Material(kd=(1, 0, 0))}
        scene = small(
            materials=material,
            spheres=[Sphere((0, 0, 0), 1, "glass")],
            planes=[Plane((2, 0, -3), (0, 0, 1), (3, 9), "red")],
            settings=Render("whitted", (16, 12)),
            background=(0.2, 0.9, 0.4),
        )
        return scene.render().array.tobytes()

    assert picture(float("inf")) == picture(None) != picture(30.0)


def test_what_is_missing_is_named_and_not_what_is_changed() -> None:
    scene = small(settings=Render("lecture"))
    with pytest.raises(snell.SceneError) as caught:
        scene.with_("camera.fov", 30)
    assert "size" in str(caught.value) and "camera.fov" not in str(caught.value)
    with pytest.raises(snell.SceneError, match="fow"):
        small().with_("camera.fow", 30)


def test_a_glass_says_where_it_is_known() -> None:
    material = {"glass": Material(ko=0, glass="germanium"), "red": Material()}
    scene = small(materials=material, spheres=[Sphere((0, 0, 0), 1, "glass")], settings=Render("whitted", (4, 4)))
    with pytest.raises(snell.SceneError, match="`germanium` is known from 2000 to 14000 nm"):
        scene.render()


def test_a_black_picture_says_why() -> None:
    scene = small(lights=[], spheres=[Sphere((0, 0, 0), 1, "red")])
    remark = scene.render().remarks[-1]
    assert remark.startswith("W203") and "nothing sends out light" in remark


def test_models_are_found_from_where_a_scene_is_saved(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    (tmp_path / "a" / "face.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    scene = small(meshes=[Mesh(file="face.obj", material="red")], folder=str(tmp_path / "a"))
    scene.save(tmp_path / "b" / "scene.toml")
    again = Scene.load(tmp_path / "b" / "scene.toml")
    assert scene.render().array.tobytes() == again.render().array.tobytes()


def test_scenes_are_values() -> None:
    scene = snell.scenes["lecture/default"]
    diamond = scene.with_("material.glass.eta", 2.42)
    assert isinstance(diamond.materials, dict)
    assert diamond.materials["glass"].eta == 2.42
    assert scene == snell.scenes["lecture/default"] != diamond
    moved = scene.with_("sphere.glass.center", (1, 2, 3)).with_("light.2.color", [1, 0, 0])
    assert (moved.spheres[0].center, moved.lights[1].color) == ((1, 2, 3), (1, 0, 0))
    steps = [{"rotate": {"axis": (0, 1, 0), "degrees": 30}}, {"move": (1, 2, 3)}]
    assert scene.with_("sphere.glass.transform", steps) == scene.replace(
        spheres=[scene.spheres[0].replace(transform=steps), *scene.spheres[1:]]
    )
    named = scene.with_("sphere.glass.name", "Glas 🔮")
    assert named.spheres[0].name == "Glas 🔮"
    other = scene.replace(eta_outside=1.33)
    other.camera.eye = (0, 0, 0)
    assert scene.camera.eye == (50, 50, 100), "a copy has its own parts"
    with pytest.raises(snell.SceneError, match="did you mean `glass`"):
        scene.with_("material.glas.eta", 2)


def test_numbers_and_names_of_materials_are_the_same() -> None:
    materials = [Material(kd=1), Material(ka=1)]
    by_number = small(materials=materials, spheres=[Sphere((0, 0, 0), 1, 1)])
    assert by_number == small(materials=materials, spheres=[Sphere([0, 0, 0], 1.0, "1")])


def test_defaults_are_those_of_the_library(tmp_path: Path) -> None:
    """What the file leaves out is read as what the classes have."""
    path = tmp_path / "bare.toml"
    path.write_text(
        'snell = 1\n[render]\nintegrator = "lecture"\nsize = [4, 4]\n'
        "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\nfov = 40\n[material.m]\n"
        '[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = "m"\n[[plane]]\nsize = [1, 1]\nmaterial = "m"\n'
        '[[disc]]\nradius = 1\nmaterial = "m"\n'
        '[[lathe]]\nprofile = [[0, 0], [1, 0], [0, 1]]\nmaterial = "m"\n[texture.t]\nchecker = [0, 1]\n'
        "[sky]\nhorizon = 1\n"
    )
    bare = Scene(
        settings=Render("lecture", (4, 4)),
        camera=Camera((0, 0, 5), (0, 0, 0), (0, 1, 0), fov=40),
        materials={"m": Material()},
        spheres=[Sphere((0, 0, 0), 1, "m")],
        planes=[Plane(size=(1, 1), material="m")],
        discs=[snell.Disc(radius=1, material="m")],
        lathes=[snell.Lathe([(0, 0), (1, 0), (0, 1)], "m")],
        textures={"t": snell.Texture([0, 1])},
        sky=snell.Sky(1),
    )
    assert Scene.load(path) == bare


def test_lists_have_plural_names_and_keys_of_files_are_taken() -> None:
    sphere, light = Sphere((0, 0, 0), 1, "red"), Light((1, 2, 3), 1)
    camera, material = Camera((0, 0, 5), (0, 0, 0), (0, 1, 0), fov=40), {"red": Material(kd=(1, 0, 0))}
    plural = Scene(
        settings=Render("lecture", (4, 4)), camera=camera, spheres=[sphere], lights=[light], materials=material
    )
    by_keys: Any = {"render": Render("lecture", (4, 4)), "sphere": [sphere], "light": [light], "material": material}
    assert Scene(camera=camera, **by_keys) == plural == small().replace(**by_keys)
    assert Scene.of(plural.plain()) == plural
    assert Scene.of(plural.plain()).render().array.tobytes() == plural.render().array.tobytes()
    with pytest.raises(snell.SceneError, match="spheres: given twice: as `sphere` and as `spheres`"):
        plural.replace(spheres=[], sphere=[])
    for old, new in (("sphere", "spheres"), ("box", "boxes"), ("material", "materials")):
        with pytest.raises(
            AttributeError, match=f"no field `{old}`, which is a key of scene files: it is `{new}` here"
        ):
            getattr(plural, old)
        with pytest.raises(AttributeError, match=f"it is `{new}` here"):
            setattr(plural, old, [])


def test_a_scene_is_made_of_what_a_file_holds() -> None:
    text = (ROOT / "tests" / "polygons.toml").read_text()
    table = tomli(text)
    assert Scene.of(table, folder=ROOT / "tests") == Scene.load(ROOT / "tests" / "polygons.toml")
    with pytest.raises(snell.SceneError) as error:
        Scene.of({**table, "spheers": []})
    assert "spheers" in str(error.value)
    wrong: Any
    for wrong in ([], None, "snell = 1"):
        with pytest.raises(snell.SceneError, match="table: expected a dict"):
            Scene.of(wrong)


def tomli(text: str) -> dict[str, Any]:
    tomllib = pytest.importorskip("tomllib")  # from Python 3.11 on
    table: dict[str, Any] = tomllib.loads(text)
    return table


def test_a_misspelt_field_is_none() -> None:
    scene = small(spheres=[Sphere((0, 0, 0), 1, "red")])
    sphere: Any = scene.spheres[0]
    with pytest.raises(AttributeError, match="a Sphere has no field `raduis`; did you mean `radius`"):
        sphere.raduis = 2
    with pytest.raises(AttributeError, match="a Scene has no field `ambinet`; did you mean `ambient`"):
        scene.ambinet  # type: ignore[attr-defined] # noqa: B018
