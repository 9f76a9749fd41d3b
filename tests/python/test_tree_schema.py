"""The classes of a tree have the keys and types of its JSON Schema, which is made of the types in Rust."""

from __future__ import annotations

import json
from dataclasses import fields
from types import GenericAlias
from typing import Any, get_type_hints

import pytest
from common import ROOT

from snell import tree

SCHEMA = json.loads((ROOT / "docs" / "ray-tree.schema.json").read_text(encoding="utf-8"))
CLASSES = {
    "ExplainedSample": tree.Sample,
    "ExplainedNode": tree.Node,
    "ExplainedHit": tree.Hit,
    "LocalLight": tree.Local,
    "LightAtHit": tree.LightAtHit,
}
SIMPLE = {"string": str, "number": float, "integer": int, "boolean": bool, "null": type(None)}


def python_type(form: dict[str, Any]) -> Any:
    """What Python makes of a value: lists are tuples, and words of a list of words are texts."""
    if "$ref" in form:
        name = form["$ref"].removeprefix("#/$defs/")
        return CLASSES.get(name, str)
    if "anyOf" in form:
        first, second = (python_type(choice) for choice in form["anyOf"])
        return first | second
    kinds = form["type"] if isinstance(form["type"], list) else [form["type"]]
    if kinds[0] == "array":
        item = python_type(form["items"])
        made: Any = GenericAlias(tuple, (item,) * form["minItems"] if "minItems" in form else (item, ...))
    else:
        made = SIMPLE[kinds[0]]
    return made | None if "null" in kinds else made


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_has_the_keys_and_types_of_the_schema(name: str) -> None:
    form, own = SCHEMA["$defs"][name], CLASSES[name]
    hints = get_type_hints(own)
    assert {field.name for field in fields(own)} == set(form["properties"]) == set(form["required"])
    for key, value in form["properties"].items():
        assert hints[key] == python_type(value), key


def test_no_part_of_the_tree_is_left_out() -> None:
    objects = {name for name, form in SCHEMA["$defs"].items() if form.get("type") == "object"}
    assert objects == set(CLASSES)
