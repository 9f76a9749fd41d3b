"""How a picture of a scene is to be made: what `Scene.render` takes, in the form of the library."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, TypedDict

import numpy as np

from .errors import SceneError
from .values import plain, whole

_MOST_THREADS = 4096
#: Parameters, and the keys of the scene that they take the place of.
_KEYS = {
    "spp": "render.spp",
    "depth": "render.max_depth",
    "seed": "render.seed",
    "integrator": "render.integrator",
    "shadows": "render.shadows",
}

Change = tuple[str, str]
Region = tuple[int, int, int, int]


class Settings(TypedDict, total=False):
    """What changes the picture. `Scene.render` says what each means."""

    width: int | None
    height: int | None
    spp: int | None
    depth: int | None
    seed: int | None
    integrator: str | None
    shadows: str | None


class How(Settings, total=False):
    """The same, with what cuts a part out of it, and what only says how it is made."""

    crop: Sequence[int] | None
    threads: int


def said(how: Mapping[str, Any], known: type[Settings]) -> dict[str, Any]:
    """Return what is said of how to render, in one form of all that mean the same.

    Raises
    ------
    SceneError
        For what is no parameter, or has no form in JSON.
    """
    names = known.__annotations__
    for name in how:
        if name not in names:
            help = f"known are {', '.join(names)}, progress"
            raise SceneError([(name, "there is no such parameter", help)])
    return {name: plain(how[name], name) for name in names if how.get(name) is not None}


def text(value: object, place: str) -> str:
    """Return a value as the library reads it behind a key: in TOML."""
    return _toml(plain(value, place))


def _toml(value: Any) -> str:
    match value:
        case list():
            return f"[{', '.join(map(_toml, value))}]"
        case dict():
            return f"{{{', '.join(f'{_toml(key)} = {_toml(inner)}' for key, inner in value.items())}}}"
    return json.dumps(value, ensure_ascii=False)  # TOML has no surrogates


def changes(how: Mapping[str, Any]) -> list[Change]:
    """Return the settings of the scene that others take the place of, each with its value."""
    return [(key, text(how[name], name)) for name, key in _KEYS.items() if how.get(name) is not None]


def size(how: Mapping[str, Any]) -> tuple[int | None, int | None]:
    """Return width and height, either of which may be left out."""
    sides = how.get("width"), how.get("height")
    for place, side in zip(("width", "height"), sides, strict=True):
        if side is not None and not (_is_whole(side) and 0 < side < 2**32):
            raise SceneError([(place, f"expected a number of pixels, at least 1, read {side!r}", None)])
    width, height = (side if side is None else int(side) for side in sides)
    return width, height


def region(how: Mapping[str, Any]) -> Region | None:
    """Return the part that is to be rendered; None for all of it."""
    crop = how.get("crop")
    if crop is None:
        return None
    numbers = [whole(n, "crop", SceneError) for n in crop] if isinstance(crop, Collection) else []
    if len(numbers) != 4 or not all(0 <= number < 2**32 for number in numbers):
        message = f"expected left, top, width and height in pixels, read {crop!r}"
        raise SceneError([("crop", message, "like (0, 0, 64, 64), the upper left corner")])
    left, top, width, height = numbers
    return left, top, width, height


def range_of(value: object, place: str) -> tuple[int, int] | None:
    """Return the first number of a range, and the one behind its last; None for all."""
    if value is None:
        return None
    numbers = [whole(n, place, SceneError) for n in value] if isinstance(value, Collection) else []
    if len(numbers) != 2 or not all(0 <= number < 2**32 for number in numbers):
        message = f"expected the first number and the one behind the last, read {value!r}"
        raise SceneError([(place, message, "like (0, 64)")])
    return numbers[0], numbers[1]


def threads(how: Mapping[str, Any]) -> int:
    """Return the number of threads; 0 for those by default."""
    number = how.get("threads", 0)
    if not (_is_whole(number) and 0 <= number <= _MOST_THREADS):
        raise SceneError([("threads", f"expected 0 to {_MOST_THREADS}, read {number!r}", None)])
    return int(number)


@contextmanager
def naming_parameters(how: Mapping[str, Any]) -> Iterator[None]:
    """Let errors name the parameter where that, and not the scene, says the value."""
    name_of = {key: name for name, key in _KEYS.items() if how.get(name) is not None}
    try:
        yield
    except SceneError as error:
        if not any(place in name_of for place, _, _ in error.findings):
            raise
        named = [(name_of.get(place or "", place), message, help) for place, message, help in error.findings]
        raise SceneError(named) from None


def _is_whole(value: object) -> bool:
    return isinstance(value, int | np.integer) and not isinstance(value, bool)
