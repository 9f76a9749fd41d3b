"""The notebook of the lecture: ``from snell.lecture import *`` in front of its cell, and ``render()`` behind it.

Examples
--------
>>> from snell.lecture import *
>>> cam1 = Camera((50, 50, 100), (50, 50, 10), (0, 1, 0), (-2.0, 2.0, -2.0, 2.0), -5, -100, 8, 8)
>>> mats = [Material((0.2, 0.2, 0.2), (0.6, 0.6, 0.6), (0.5, 0.5, 0.5), (0.9, 0.9, 0.9), (0.5, 0.5, 0.5), 64, 2.0)]
>>> lgts = [Light((20, 100, 100), (0.75, 0.75, 0.75))]
>>> ambi = vector(RR, 3, (0.2, 0.2, 0.2))
>>> objs = [Globe((50, 50, 50), 9, 0)]
>>> render()
<Picture of lecture, 8 x 8>
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Mapping
from copy import copy
from typing import Any

from .errors import SceneError
from .parts import Box, Camera, Disc, Globe, Lathe, Light, Material, Mesh, Plane, Render, Sphere
from .picture import Picture
from .scene import Scene

__all__ = ["RR", "Camera", "Globe", "Light", "Material", "copy", "render", "scene", "vector"]

#: Sage's field of real numbers: here those of Python.
RR = float

_CAMERAS = ("cam2", "cam1", "cam")


def vector(ring: type[float], degree: int, values: Iterable[float]) -> tuple[float, ...]:
    """Return a vector, as Sage writes it.

    Examples
    --------
    >>> vector(RR, 3, (0.2, 0.2, 0.2))
    (0.2, 0.2, 0.2)
    """
    try:
        numbers = tuple(ring(value) for value in values)
    except (TypeError, ValueError):
        raise SceneError([("vector", f"expected {degree} numbers, read {values!r}", None)]) from None
    if len(numbers) != degree:
        raise SceneError([("vector", f"expected {degree} numbers, read {len(numbers)}", None)])
    return numbers


def scene() -> Scene:
    """Return the scene of the variables that the lecture's cell sets.

    They are ``cam2``, or else ``cam1`` or ``cam``; ``mats``, ``lgts``, ``ambi``, ``objs``; and, where they are set,
    ``eta_outside`` (1.0) and ``trace_depth`` (6).

    Raises
    ------
    SceneError
        If one of them is missing.
    """
    return _scene(_variables())


def render(**how: Any) -> Picture:
    """Render the scene of the lecture's cell; `how` is what `Scene.render` takes."""
    return _scene(_variables()).render(**how)


def _variables() -> Mapping[str, Any]:
    """Return the variables where a function of this module is called."""
    caller = sys._getframe(2)
    return {**caller.f_globals, **caller.f_locals}


def _scene(variables: Mapping[str, Any]) -> Scene:
    def get(*names: str) -> Any:
        found = next((name for name in names if name in variables), None)
        if found is None:
            raise SceneError([(names[0], "the cell does not set it", "run the lecture's cell first")])
        return variables[found]

    objects = get("objs")
    objects = list(objects) if isinstance(objects, Iterable) else [objects]
    if not all(isinstance(thing, Sphere | Mesh | Plane | Box | Disc | Lathe) for thing in objects):
        raise SceneError([("objs", "expected globes, meshes, planes, boxes, discs and lathes", None)])
    return Scene(
        settings=Render("lecture", max_depth=variables.get("trace_depth", 6), transfer="linear", shadows="opaque"),
        camera=get(*_CAMERAS),
        ambient=get("ambi"),
        eta_outside=variables.get("eta_outside", 1.0),
        lights=get("lgts"),
        materials=get("mats"),
        name="lecture",
        spheres=[thing for thing in objects if isinstance(thing, Sphere)],
        meshes=[thing for thing in objects if isinstance(thing, Mesh)],
        planes=[thing for thing in objects if isinstance(thing, Plane)],
        boxes=[thing for thing in objects if isinstance(thing, Box)],
        discs=[thing for thing in objects if isinstance(thing, Disc)],
        lathes=[thing for thing in objects if isinstance(thing, Lathe)],
    )
