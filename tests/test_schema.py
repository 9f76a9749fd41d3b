"""The published JSON Schemas accept what Snell reads and writes, and refuse what it refuses."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import jsonschema
import pytest
from test_lecture import ROOT, SNELL, tomllib

SCENES = sorted((ROOT / "scenes").glob("*/*.toml"))

SCHEMA = json.loads((ROOT / "docs" / "scene.schema.json").read_text())
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_built_in_scenes_fit(path: Path) -> None:
    VALIDATOR.validate(tomllib.loads(path.read_text()))


@pytest.mark.parametrize(
    ("key", "value"),
    [("camera", {}), ("colour", 1), ("ambient", [1, 2]), ("sphere", [{"radius": 1}]), ("snell", "one")],
)
def test_wrong_scenes_do_not(key: str, value: object) -> None:
    scene = tomllib.loads(SCENES[0].read_text())
    scene[key] = value
    assert not VALIDATOR.is_valid(scene)


TREE = jsonschema.Draft202012Validator(json.loads((ROOT / "docs" / "ray-tree.schema.json").read_text()))
VIEW = jsonschema.Draft202012Validator(json.loads((ROOT / "docs" / "view.schema.json").read_text()))
# A light behind another object, and one through glass; bands of light; total reflection; nothing met.
PIXELS = [("lecture/default", "256,400"), ("gallery/prism", "300,300"), ("gallery/brilliant", "256,256"), ("gallery/ball", "0,0")]


@pytest.mark.parametrize(("scene", "pixel"), PIXELS)
def test_trees_and_views_fit(scene: str, pixel: str, tmp_path: Path) -> None:
    command = [SNELL, "explain", scene, pixel]
    tree = json.loads(subprocess.run([*command, "--json"], check=True, capture_output=True).stdout)
    TREE.validate(tree)
    page = tmp_path / "page.html"
    subprocess.run([*command, "--html", str(page)], check=True)
    # The page holds the same two as literals: `{ scene: …, tree: … }`.
    text = page.read_text(encoding="utf-8").split("{ scene: ")[-1]
    view, end = json.JSONDecoder().raw_decode(text)
    VIEW.validate(view)
    assert json.JSONDecoder().raw_decode(text[end:].removeprefix(", tree: "))[0] == tree


@pytest.mark.parametrize(("key", "value"), [("snell_ray_tree", 2), ("pixel", [1]), ("colour", 1), ("samples", [{}])])
def test_wrong_trees_do_not(key: str, value: object) -> None:
    command = [SNELL, "explain", "lecture/default", "190,300", "--json"]
    tree = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    tree[key] = value
    # What a later version adds may be there.
    assert TREE.is_valid(tree) == (key == "colour")
