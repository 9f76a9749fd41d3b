"""What sliders and menus stand for: keys of a scene, where they may go, and where they start."""

from __future__ import annotations

import difflib
import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import SceneError
from ..scene import Scene
from ..values import LARGEST, plain

_STEPS = 100


def key_of(scene: Scene, name: str) -> str:
    """Return the key that ends with a name. An index matters only where light goes through, and no glass says it.

    Raises
    ------
    SceneError
        If there is no such key, or several.
    """
    keys = [key for key, _ in _leaves(scene) if key == name or key.endswith(f".{name}")]
    if name == "eta":
        clear = [_part(key) for key, material in scene._materials().items() if _has_index(material)]
        keys = [key for key in keys if key in {f"material.{material}.eta" for material in clear}]
        if not keys:
            help = "interact(scene, {…}) takes any key"
            raise SceneError([(name, "no material is transparent and has an index of its own", help)])
    if len(keys) == 1:
        return keys[0]
    if keys:
        help = f'say which: interact(scene, {{"{keys[0]}": …}})'
        raise SceneError([(name, f"several keys end with it: {', '.join(keys[:12])}", help)])
    near = difflib.get_close_matches(name, {key.rsplit(".", 1)[-1] for key, _ in _leaves(scene)}, 3)
    meant = f"did you mean {' or '.join(near)}?" if near else None
    raise SceneError([(name, "no key of the scene ends with it", meant)])


def value_at(scene: Scene, key: str) -> Any:
    """Return the value of a key, which may name things or number them from 1; None if it has none."""
    found: Any = scene.plain()
    for part in re.findall(r'"(?:[^"\\]|\\.)*"|[^."]+', key):
        name = json.loads(part) if part.startswith('"') else part
        if isinstance(found, list):
            named = [entry for entry in found if isinstance(entry, Mapping) and entry.get("name") == name]
            numbered = found[int(name) - 1 : int(name)] if name.isdecimal() else []
            found = (named or numbered or [None])[0]
        else:
            found = found.get(name) if isinstance(found, Mapping) else None
    return found


def checked(key: str, control: Any, now: Any) -> Sequence[Any]:
    """Return a list to choose from; or lowest, highest and step, whole numbers if the value is one.

    Raises
    ------
    SceneError
        If it is neither.
    """
    if isinstance(control, list | range | np.ndarray) or (
        isinstance(control, tuple) and any(isinstance(choice, str) for choice in control)
    ):
        choices = [plain(choice, key) for choice in (control.tolist() if isinstance(control, np.ndarray) else control)]
        if choices:
            return choices
    numbers = control if isinstance(control, tuple) and len(control) in (2, 3) else ()
    if not numbers or any(isinstance(n, bool) or not isinstance(n, int | float | np.number) for n in numbers):
        raise SceneError([(key, f"expected (low, high), (low, high, step) or a list, read {control!r}", None)])
    low, high, *step = (plain(number, key) for number in numbers)
    if not (-LARGEST <= low < high <= LARGEST and (not step or 0 < step[0] <= LARGEST)):
        raise SceneError([(key, f"expected a low number, a higher one, and a step above 0, read {control!r}", None)])
    if all(isinstance(number, int) and not isinstance(number, bool) for number in (low, high, now, *step)):
        return low, high, step[0] if step else 1
    by = step[0] if step else _round_step((high - low) / _STEPS)
    return float(low), float(high), float(by)


def start(control: Sequence[Any], now: Any) -> Any:
    """Return the value where it starts: that of the scene, if it can be reached."""
    if isinstance(control, list):
        return now if now in control else control[0]
    low, high, _ = control
    return type(low)(min(max(now, low), high)) if isinstance(now, int | float) else low


def _round_step(step: float) -> float:
    """Return 1, 2 or 5 times a power of ten, not above the step: round values are where the slider stops."""
    power = 10.0 ** math.floor(math.log10(max(step, 1e-12)))
    return max(digit * power for digit in (1, 2, 5) if digit * power <= max(step, power) * (1 + 1e-9))


def _has_index(material: Any) -> bool:
    ko = np.asarray(material.ko)  # not checked yet: it may be anything
    other = (material.glass, material.cauchy, material.sellmeier)
    return ko.dtype.kind in "iuf" and bool(ko.mean() < 1) and all(said is None for said in other)


def _leaves(scene: Scene) -> Iterator[tuple[str, Any]]:
    """Give all keys of a scene, as `Scene.with_` has them, with their values."""

    def walk(key: str, value: Any) -> Iterator[tuple[str, Any]]:
        if isinstance(value, Mapping):
            for name, inner in value.items():
                yield from walk(f"{key}.{_part(name)}" if key else _part(name), inner)
        elif isinstance(value, list) and value and all(isinstance(entry, Mapping) for entry in value):
            for number, entry in enumerate(value, 1):
                name = entry.get("name")
                yield from walk(f"{key}.{_part(name) if name else number}", entry)
        else:
            yield key, value

    return walk("", scene.plain())


def _part(name: str) -> str:
    """Return a part of a key, in quotes if it needs them."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else json.dumps(name)
