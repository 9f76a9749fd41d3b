"""The published JSON Schema accepts what Snell accepts and refuses what it refuses."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest
from test_lecture import ROOT, tomllib

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
