"""Sliders in a notebook that render a scene anew while they move."""

from __future__ import annotations

import difflib
import json
import math
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from ..errors import SceneError, SnellError
from ..picture import Picture
from ..scene import Scene
from ..values import plain
from .still import INSTALL, Still, has_widgets, show

#: Where a slider may go: lowest and highest, perhaps with a step; or a list to choose from; or False and True.
Control = Sequence[Any]
_STEPS = 100


def interact(
    scene: Scene,
    controls: Mapping[str, Control] | None = None,
    /,
    *,
    width: int | None = None,
    height: int | None = None,
    integrator: str | None = None,
    spp: int | None = None,
    **named: Control,
) -> Interactive:
    """Show a picture with sliders under it, which change the scene and render it anew.

    Parameters
    ----------
    scene : Scene
        Where the sliders start.
    controls : dict of str to sequence, optional
        By the keys of `Scene.with_`. ``(low, high)`` or ``(low, high, step)`` is a slider, of whole numbers if all are;
        a list is a menu, or a tick if it is ``[False, True]``.
    width, height, integrator, spp
        As for `Scene.render`.
    **named
        More of them, by the last part of their key where only one has it: ``eta`` is ``material.glass.eta`` if only the
        material ``glass`` is transparent.

    Returns
    -------
    Interactive
        What a notebook shows; it knows the `Interactive.scene` and the `Interactive.picture` as they are now.

    Raises
    ------
    SceneError
        If there is no such key, or several.

    Examples
    --------
    >>> import snell
    >>> ball = snell.interact(snell.scenes["lecture/default"], eta=(1.0, 4.0), width=64)
    >>> ball
    <Interactive material.glass.eta=2.0>
    >>> ball.set("material.glass.eta", 2.42)
    >>> ball.scene.material["glass"].eta
    2.42
    """
    given = {**(controls or {}), **{_key(scene, name): control for name, control in named.items()}}
    how = {"width": width, "height": height, "integrator": integrator, "spp": spp}
    return Interactive(scene, given, how)


class Interactive:
    """A picture and its sliders, made by `interact`.

    Attributes
    ----------
    scene : Scene
    picture : Picture
    values : dict of str to value
        By key, as they are now.
    """

    def __init__(self, scene: Scene, controls: Mapping[str, Control], how: Mapping[str, Any]) -> None:
        now = dict(_leaves(scene))
        self._controls = {key: _checked(key, control) for key, control in controls.items()}
        self._how = how
        self._start = scene
        self._still = Still()
        self._says: Any = None
        self.values: dict[str, Any] = {}
        for key, control in self._controls.items():
            self.values[key] = _within(control, now.get(key))
        self._render()

    def set(self, key: str, value: object) -> None:
        """Move a slider: change a value, and the picture."""
        if key not in self._controls:
            raise SceneError([(key, "there is no such slider", f"there are: {', '.join(self._controls)}")])
        before = self.values
        self.values = {**before, key: value}
        try:
            self._render()
        except SnellError:
            self.values = before
            raise

    def _render(self) -> None:
        scene = self._start
        for key, value in self.values.items():
            scene = scene.with_(key, value)
        self.picture: Picture = scene.render(**self._how, progress=False)
        self.scene = scene

    def _ipython_display_(self) -> None:
        self._still.show(self.picture._repr_png_())
        if not has_widgets():
            print(f"Sliders need: {INSTALL}", file=sys.stderr)
            return
        import ipywidgets  # noqa: PLC0415 # it is an extra

        sliders = [self._slider(ipywidgets, key, control) for key, control in self._controls.items()]
        self._says = ipywidgets.Label()
        show(ipywidgets.VBox([*sliders, self._says]), "(run the cell for its sliders)")

    def _slider(self, ipywidgets: Any, key: str, control: Control) -> Any:
        """Return the widget of a key; its front end sends only the newest value while a picture is rendered."""
        look = {
            "description": key,
            "value": self.values[key],
            "style": {"description_width": "initial"},
            "layout": {"width": "32rem"},
        }
        if isinstance(control, list):
            widget = ipywidgets.Checkbox(**look) if _is_tick(control) else ipywidgets.Dropdown(options=control, **look)
        else:
            low, high, step = control
            if isinstance(step, int):
                widget = ipywidgets.IntSlider(min=low, max=high, step=step, **look)
            else:
                digits = max(0, -math.floor(math.log10(step)))
                widget = ipywidgets.FloatSlider(min=low, max=high, step=step, readout_format=f".{digits}f", **look)
        widget.observe(lambda change: self._moved(key, change["new"]), names="value")
        return widget

    def _moved(self, key: str, value: object) -> None:
        try:
            self.set(key, value)
        except SnellError as error:
            self._says.value = str(error)
            return
        self._still.show(self.picture._repr_png_())
        self._says.value = f"{1e3 * self.picture.seconds:.0f} ms, {self.picture.rays / 1e6:.2f} million rays"

    def __repr__(self) -> str:
        return f"<Interactive {', '.join(f'{key}={value}' for key, value in self.values.items())}>"


def _checked(key: str, control: Control) -> Control:
    """Return a list to choose from, or lowest, highest and step."""
    if isinstance(control, list) and control:
        return [plain(value, key) for value in control]
    numbers = control if isinstance(control, tuple) and len(control) in (2, 3) else ()
    if not numbers or any(isinstance(n, bool) or not isinstance(n, int | float | np.number) for n in numbers):
        raise SceneError([(key, f"expected (low, high), (low, high, step) or a list, read {control!r}", None)])
    low, high, *step = (plain(number, key) for number in numbers)
    whole = all(isinstance(number, int) for number in (low, high, *step))
    if not low < high or (step and step[0] <= 0):
        raise SceneError([(key, f"expected a low number, a higher one, and a step above 0, read {control!r}", None)])
    return low, high, step[0] if step else 1 if whole else _round_step((high - low) / _STEPS)


def _round_step(step: float) -> float:
    """Return 1, 2 or 5 times a power of ten, not above the step: round values are where the slider stops."""
    power = 10.0 ** math.floor(math.log10(step))
    return max(digit * power for digit in (1, 2, 5) if digit * power <= step * (1 + 1e-9))


def _within(control: Control, now: Any) -> Any:
    """Return the value where a slider starts: that of the scene, if it can be reached."""
    if isinstance(control, list):
        return now if now in control else control[0]
    low, high, _ = control
    if isinstance(now, bool) or not isinstance(now, int | float):
        return low
    return type(low)(min(max(now, low), high))


def _is_tick(control: list[Any]) -> bool:
    return len(control) == 2 and all(isinstance(value, bool) for value in control) and control[0] != control[1]


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


def _key(scene: Scene, name: str) -> str:
    """Return the key that ends with a name. The index of a material matters only where light goes through it."""
    keys = [key for key, _ in _leaves(scene) if key == name or key.endswith(f".{name}")]
    if name == "eta":
        clear = [_part(key) for key, material in scene._materials().items() if np.mean(material.ko) < 1]
        keys = [key for key in keys if any(key == f"material.{material}.eta" for material in clear)]
    if len(keys) == 1:
        return keys[0]
    if keys:
        help = f'say which: interact(scene, {{"{keys[0]}": …}})'
        raise SceneError([(name, f"several keys end with it: {', '.join(keys[:12])}", help)])
    near = difflib.get_close_matches(name, {key.rsplit(".", 1)[-1] for key, _ in _leaves(scene)}, 3)
    meant = f"did you mean {' or '.join(near)}?" if near else None
    raise SceneError([(name, "no key of the scene ends with it", meant)])
