"""Short names for the values of a sweep: ``eta 1.52``."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

_MOST_DECIMALS = 6
_WIDE = 1e4  # where the largest number is so many times the smallest, decimals do not suit both


def labels(values: Mapping[str, Sequence[Any]]) -> list[list[tuple[str, str]]]:
    """Return, for each frame, a name and a text of each value.

    Names are as much of the end of a key as tells them apart. Numbers of one key have the same decimals: as many as
    they need, or, where that would be many, as tell them apart.

    Examples
    --------
    >>> labels({"material.glass.eta": [1.0, 1.5, 2.42], "render.integrator": ["lecture", "lecture", "whitted"]})[2]
    [('eta', '2.42'), ('integrator', 'whitted')]
    >>> labels({"light.1.color": [[1, 0.5, 0]], "light.2.color": [0.25]})
    [[('1.color', '1.0, 0.5, 0.0'), ('2.color', '0.25')]]
    >>> [text for [(_, text)] in labels({"eta_outside": [1, 4 / 3, 5 / 3]})]
    ['1.00', '1.33', '1.67']
    """
    names = _names(list(values))
    columns = [[(name, text) for text in _texts(column)] for name, column in zip(names, values.values(), strict=True)]
    return [list(row) for row in zip(*columns, strict=True)]


def _names(keys: list[str]) -> list[str]:
    parts = [key.split(".") for key in keys]
    longest = max(map(len, parts), default=0)
    endings = ([".".join(part[-count:]) for part in parts] for count in range(1, longest + 1))
    return next((names for names in endings if len(set(names)) == len(names)), keys)


def _texts(column: Sequence[Any]) -> list[str]:
    # Numbers that differ by rounding only are the same.
    form = _form(sorted({float(f"{number:.9g}") for value in column for number in _numbers(value)}))
    return [_text(value, form) for value in column]


def _numbers(value: Any) -> Iterator[float]:
    if isinstance(value, list):
        for inner in value:
            yield from _numbers(inner)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield value


def _form(numbers: list[float]) -> str:
    """Return how to write numbers, which are different ones."""
    sizes = [abs(number) for number in numbers]
    largest = max(sizes, default=0)
    smallest = min((size for size in sizes if size > 1e-12 * largest), default=largest)  # less is what rounding left
    if largest > _WIDE * smallest or largest >= 1e7:
        return ".4g"
    fewest = min(2, max(0, 2 - math.floor(math.log10(largest)))) if largest else 0  # of what is not exact
    for decimals in range(_MOST_DECIMALS + 1):
        rounded = [round(number, decimals) for number in numbers]
        exact = all(abs(a - b) <= 1e-9 * largest for a, b in zip(numbers, rounded, strict=True))
        if (exact and decimals < 4) or (decimals >= fewest and len(set(rounded)) == len(numbers)):
            return f".{decimals}f"
    return ".4g"


def _text(value: Any, form: str) -> str:
    match value:
        case bool() | dict():
            return json.dumps(value)
        case int() | float():
            text = format(value, form)
            return text if float(text) else text.lstrip("-")
        case list():
            return ", ".join(_text(inner, form) for inner in value)
    return str(value)
