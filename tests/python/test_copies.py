"""Scenes, pictures and trees are pickled and copied, to the bit; pictures also where the files of a scene are gone."""

from __future__ import annotations

import copy
import multiprocessing
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from test_scenes import TETRAHEDRON, small

import snell
from snell import Material, Mesh, Plane, Render, Scene, Sky, Sphere, Texture

QUAD = "mtllib quad.mtl\nv -2 -2 -1\nv 2 -2 -1\nv 2 2 -1\nv -2 2 -1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl tiles\n"


def everything(folder: Path) -> Scene:
    """Return a scene with triangles from arrays and from files, a library, pictures with alpha and a panorama."""
    (folder / "quad.obj").write_text(QUAD + "f 1/1 2/2 3/3 4/4\n")
    (folder / "quad.mtl").write_text("newmtl tiles\nKa 0.5 0.5 0.5\nKd 0.8 0.8 0.8\nmap_Kd tiles.png\n")
    draw = np.random.default_rng(0)
    for name, mode in (("tiles.png", "RGB"), ("leaf.png", "RGBA"), ("sky.png", "RGB")):
        Image.fromarray(draw.integers(0, 256, (4, 8, len(mode)), dtype=np.uint8), mode).save(folder / name)
    return small(
        settings=Render("whitted", (24, 18), spp=2),
        ambient=0.2,
        materials={
            "glass": Material(ko=0, eta=1.5),
            "leaf": Material(ka=1, kd=1, texture="leaf"),
            "red": Material(kd=1),
        },
        textures={"leaf": Texture(image="leaf.png", repeat=(2, 2))},
        sky=Sky(image="sky.png"),
        spheres=[Sphere((-0.6, 0, 0.5), 0.7, "glass", name="ball")],
        meshes=[
            Mesh(np.array(TETRAHEDRON[0], dtype=float), np.array(TETRAHEDRON[1]), "glass", name="tetra"),
            Mesh(file="quad.obj", name="quad"),
            Mesh(file="quad.obj", name="again", transform=[{"move": (1, 0, -2)}]),
        ],
        planes=[Plane((0.8, 0.6, 1), (0, 0, 1), (1, 1), "leaf", name="leaf")],
        folder=str(folder),
    )


def remove_files(folder: Path) -> None:
    for path in folder.iterdir():
        path.unlink()


def looked_at(picture: snell.Picture) -> dict[str, Any]:
    """Return all that a picture says, as plain values."""
    tree = picture.explain(12, 9)
    return {
        "film": picture.array.tobytes(),
        "shape": (picture.array.shape, picture.region, picture.full_size, picture.name, picture.finished),
        "writeable": picture.array.flags.writeable,
        "statistics": (picture.seconds, picture.rays, picture.remarks),
        "png with its recipe": picture._repr_png_(),
        "tree": (tree.to_json(), tree.text(), tree.figure().svg),
        "channels": [
            picture.channels.depth.tobytes(),
            picture.channels.object.tobytes(),
            picture.channels.hits.tobytes(),
        ],
        "view": picture._native.view(),
    }


def sent(pickled: bytes, pipe: Any) -> None:
    """Look at a picture in another process."""
    picture, tree = pickle.loads(pickled)
    added = np.zeros(3)
    for node in tree.samples[0].nodes:
        added += node.contribution
    assert tree._picture is picture
    pipe.send((looked_at(picture), tree.to_json(), tuple(added) == tree.samples[0].color, pickle.dumps(picture)))


def test_a_picture_comes_back_in_another_process_without_its_files(tmp_path: Path) -> None:
    picture = everything(tmp_path).render()
    tree = picture.explain(12, 9)
    said = looked_at(picture)
    pickled = pickle.dumps((picture, tree))
    remove_files(tmp_path)
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=sent, args=(pickled, there))
    process.start()
    assert here.poll(60), "it answers"
    theirs, their_tree, adds_up, back = here.recv()
    process.join()
    assert theirs == said
    assert their_tree == tree.to_json()
    assert adds_up
    assert looked_at(pickle.loads(back)) == said, "and once more"


def test_a_part_and_one_of_arrays_come_back(tmp_path: Path) -> None:
    part = everything(tmp_path).render().crop(4, 3, 16, 12)
    assert looked_at(pickle.loads(pickle.dumps(part))) == looked_at(part)
    alone = small(settings=Render("whitted", (24, 18)), meshes=[Mesh(*TETRAHEDRON, "red")]).render()
    assert looked_at(pickle.loads(pickle.dumps(alone))) == looked_at(alone)
    sightings, channels = everything(tmp_path).find("quad"), part.channels
    assert pickle.loads(pickle.dumps(sightings)).mask.tobytes() == sightings.mask.tobytes()
    assert pickle.loads(pickle.dumps(channels)).hits.tobytes() == channels.hits.tobytes()


@pytest.mark.parametrize("duplicate", [copy.copy, copy.deepcopy])
def test_copies_of_pictures_share_what_nobody_can_change(duplicate: Callable[[Any], Any], tmp_path: Path) -> None:
    picture = everything(tmp_path).render()
    tree = picture.explain(12, 9)
    again, tree_again = duplicate(picture), duplicate(tree)
    assert again is not picture
    assert np.shares_memory(again.array, picture.array)
    assert looked_at(again) == looked_at(picture)
    again.name = "another"
    assert picture.name == "scene"
    assert (tree_again.to_json(), tree_again.samples) == (tree.to_json(), tree.samples)
    assert duplicate(picture.channels).mask("ball").any()


def test_a_stopped_picture_stays_one() -> None:
    def stop(pixels: int, total: int, rays: int) -> None:
        if pixels:
            raise KeyboardInterrupt

    with pytest.warns(snell.SnellWarning, match="stopped"):
        picture = snell.scenes["gallery/brilliant"].render(width=1200, spp=16, progress=stop)
    again = pickle.loads(pickle.dumps(picture))
    assert not again.finished
    assert again.array.tobytes() == picture.array.tobytes()


def drawn(scene: Scene) -> bytes:
    return scene.render(progress=False).array.tobytes()


@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda scene: pickle.loads(pickle.dumps(scene))])
def test_a_scene_comes_back(duplicate: Callable[[Scene], Scene], tmp_path: Path) -> None:
    scene = everything(tmp_path)
    before = drawn(scene)
    again = duplicate(scene)
    assert again == scene
    assert drawn(again) == before
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(drawn, (scene,)) == before
    again.meshes[0].vertices[0] = 5.0  # type: ignore[index]
    again.camera.eye = (0, 0, 9)
    again.materials["red"].kd = 0.5  # type: ignore[call-overload]
    assert scene == everything(tmp_path), "nothing is shared"
    # It names its files; only what has read them, like a picture, can do without.
    remove_files(tmp_path)
    with pytest.raises(snell.SceneError, match=r"quad\.obj"):
        scene.render()


def test_a_shallow_copy_is_the_same_scene(tmp_path: Path) -> None:
    scene = everything(tmp_path)
    again = copy.copy(scene)
    again.ambient = 0.9
    assert again.meshes is scene.meshes
    assert scene.ambient == 0.2


def test_another_version_is_refused() -> None:
    picture = snell.scenes["lecture/default"].render(width=8)
    (state,) = picture._native.__getnewargs__()
    state["ready"]["version"] = "0.0.1"
    with pytest.raises(snell.PictureError, match=r"pickled by Snell 0\.0\.1, and this is"):
        type(picture._native)(state)


@pytest.mark.parametrize("array", ["numbers", "finished"])
def test_a_film_that_is_cut_off_is_refused(array: str) -> None:
    picture = snell.scenes["lecture/default"].render(width=8)
    (state,) = picture._native.__getnewargs__()
    state[array] = state[array][:-1]
    with pytest.raises(snell.PictureError, match="expected 8 x 8 pixels"):
        type(picture._native)(state)
