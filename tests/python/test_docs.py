"""What `help()` and editors show: every field of what people handle is documented, and so is every parameter."""

from __future__ import annotations

import dataclasses
import inspect
import re
from collections.abc import Callable, Iterator
from typing import Any

import pytest

import snell
from snell import optics

KINDS: list[Any] = [kind for name in snell.__all__ if dataclasses.is_dataclass(kind := getattr(snell, name))]


def documented(doc: str, section: str) -> set[str]:
    """Return the names of a section that are followed by a type and a description."""
    text = inspect.cleandoc(doc)
    _, _, rest = text.partition(f"{section}\n{'-' * len(section)}\n")
    rest = re.split(r"\n\S[^\n]*\n-{3,}\n", rest)[0]
    entries = re.findall(r"^(\*{0,2}\w[\w ,*]*?)(?: : ([^\n]+))?\n(?=    \S)", rest, re.MULTILINE)
    return {name.strip("* ") for names, _ in entries for name in names.split(",")}


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_every_field_is_documented(kind: Any) -> None:
    doc = kind.__doc__ or ""
    fields = {field.name for field in dataclasses.fields(kind) if not field.name.startswith("_")}
    assert fields, kind
    said = documented(doc, "Attributes") | documented(doc, "Parameters")
    assert fields <= said, f"without a line: {sorted(fields - said)}"
    known = fields | {name for name in dir(kind) if not name.startswith("_")}
    assert said <= known, f"not there any more: {sorted(said - known)}"


def test_all_kinds_are_looked_at() -> None:
    assert {"Scene", "Camera", "Sphere", "Mesh", "Node", "Hit", "Channels", "Difference"} <= {k.__name__ for k in KINDS}


def functions() -> Iterator[tuple[str, Callable[..., object]]]:
    for name in snell.__all__:
        thing = getattr(snell, name)
        if inspect.isfunction(thing):
            yield name, thing
        elif (inspect.isclass(thing) and not dataclasses.is_dataclass(thing)) or name == "Scene":
            for method, inner in inspect.getmembers(thing, callable):
                if not method.startswith("_") and inspect.isroutine(inner) and method != "with_traceback":
                    yield f"{name}.{method}", inner
    for name in optics.__all__:
        if inspect.isfunction(thing := getattr(optics, name)):
            yield f"optics.{name}", thing


@pytest.mark.parametrize(("name", "function"), [pytest.param(*each, id=each[0]) for each in functions()])
def test_every_public_function_says_what_it_does(name: str, function: Callable[..., object]) -> None:
    doc = inspect.getdoc(function)
    assert doc and len(doc) > 10, name
    if said := documented(doc, "Parameters"):
        taken = set(inspect.signature(function).parameters) - {"self"}
        assert said == taken, f"{name} takes {sorted(taken)}, and speaks of {sorted(said)}"
