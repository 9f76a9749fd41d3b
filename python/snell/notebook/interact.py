"""Sliders in a notebook that render a scene anew while they move."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .. import _native
from .. import how as how_of
from ..errors import SceneError, SnellError
from ..how import How
from ..picture import Picture
from ..scene import Scene, picture_of, warned_if_stopped
from . import controls as control_of
from .still import Still, open_cell, show

_SETTINGS = ("spp", "seed", "integrator", "shadows")  # of a render, and keys of a scene
_SINGLE = (str, int, np.integer)

#: Where a slider may go: lowest and highest, perhaps with a step; or a list to choose from; or False and True.
Control = Sequence[Any]


def interact(
    scene: Scene,
    controls: Mapping[str, Control] | None = None,
    /,
    *,
    width: int | None = None,
    height: int | None = None,
    crop: Sequence[int] | None = None,
    depth: int | None = None,
    threads: int = 0,
    **named: Control | int | str,
) -> Interactive:
    """Show a picture with sliders under it, which change the scene and render it anew.

    Parameters
    ----------
    scene : Scene
        Where the sliders start.
    controls : dict of str to sequence, optional
        By the keys of `Scene.with_`. ``(low, high)`` or ``(low, high, step)`` is a slider, of whole numbers if the
        value is one; a list is a menu, or a tick if it is ``[False, True]``.
    width, height, crop, depth, threads
        As for `Scene.render`.
    **named
        More sliders, by the last part of their key where only one has it: ``eta`` is ``material.glass.eta`` if only the
        material ``glass`` is transparent. With a single value ``spp``, ``seed``, ``integrator`` and ``shadows`` are
        what they are for `Scene.render`: ``spp=4`` is a setting, ``spp=(1, 16)`` a slider.

    Files of models and images are read once, when it starts.

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
    >>> ball.scene.materials["glass"].eta
    2.42
    """
    if not isinstance(scene, Scene):
        raise SceneError([("scene", f"expected a Scene, read {scene!r}", "snell.scenes and Scene.load have some")])
    if not (controls is None or (isinstance(controls, Mapping) and all(isinstance(key, str) for key in controls))):
        raise SceneError([("controls", f"expected keys with their values, read {controls!r}", None)])
    how: dict[str, Any] = {"width": width, "height": height, "crop": crop, "depth": depth, "threads": threads}
    how |= {name: named.pop(name) for name in _SETTINGS if isinstance(named.get(name), _SINGLE)}
    sliders: dict[str, Any] = {control_of.key_of(scene, name): control for name, control in named.items()}
    return Interactive(scene.replace(), {**(controls or {}), **sliders}, how)


class Interactive:
    """A picture and its sliders, made by `interact`.

    Attributes
    ----------
    picture : Picture
        As it is now.
    values : dict of str to value
        By key, as they are now.
    """

    picture: Picture
    values: dict[str, Any]

    def __init__(self, scene: Scene, controls: Mapping[str, Control], how: Mapping[str, Any]) -> None:
        now = {key: control_of.value_at(scene, key) for key in controls}
        self._controls = {key: control_of.checked(key, control, now[key]) for key, control in controls.items()}
        self._how = how_of.said(how, How)
        self._start = scene
        self._native = scene._described()
        self._world: _native.NativeWorld | None = None
        self._stills: list[Still] = []
        self._widgets: dict[str, Any] = {}
        self._box: Any = None
        self._says: Any = None
        self._render({key: control_of.start(control, now[key]) for key, control in self._controls.items()})

    @property
    def scene(self) -> Scene:
        """The scene as it is now."""
        scene = self._start
        for key, value in self.values.items():
            scene = scene.with_(key, value)
        return scene

    def set(self, key: str, value: object) -> None:
        """Move a slider: change a value, and the picture.

        Raises
        ------
        SceneError
            If there is no such slider, or the scene cannot be drawn so; all stays as it was then.
        """
        if not isinstance(key, str) or key not in self._controls:
            raise SceneError([(str(key), "there is no such slider", f"there are: {', '.join(self._controls)}")])
        self._render({**self.values, key: value})
        for still in self._stills:
            still.show(self.picture._repr_png_())
        if key in self._widgets:
            self._says.value = f"{1e3 * self.picture.seconds:.0f} ms, {self.picture.rays / 1e6:.2f} million rays"
            self._widgets[key].value = value

    def _render(self, values: dict[str, Any]) -> None:
        changes = [(key, how_of.text(value, key)) for key, value in values.items()]
        width, height = how_of.size(self._how)
        with how_of.naming_parameters(self._how):
            changes += how_of.changes(self._how)
            world = self._native.compiled(changes, width, height, self._world)
        picture = picture_of(world, self._start.name, set(), False, self._how)
        self._world, self.picture, self.values = world, warned_if_stopped(picture), values

    def _ipython_display_(self) -> None:
        if not open_cell(self, self._stills, self.picture._repr_png_(), "Sliders need"):
            return
        if self._box is None:
            import ipywidgets  # noqa: PLC0415 # it is an extra

            self._widgets = {key: self._widget(ipywidgets, key, control) for key, control in self._controls.items()}
            self._says = ipywidgets.Label()
            self._box = ipywidgets.VBox([*self._widgets.values(), self._says])
        show(self._box, "(run the cell for its sliders)")

    def _widget(self, ipywidgets: Any, key: str, control: Control) -> Any:
        """Return the widget of a key; its front end sends only the newest value while a picture is rendered."""
        look = {
            "description": key,
            "value": self.values[key],
            "style": {"description_width": "initial"},
            "layout": {"width": "32rem"},
        }
        if isinstance(control, list):
            choices = [(str(choice), choice) for choice in control]
            widget = ipywidgets.Checkbox(**look) if _is_tick(control) else ipywidgets.Dropdown(options=choices, **look)
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
        if value == self.values[key]:  # it was moved from Python
            return
        try:
            self.set(key, value)
        except SnellError as error:
            self._says.value = str(error)

    def __repr__(self) -> str:
        return f"<Interactive {', '.join(f'{key}={value}' for key, value in self.values.items())}>"


def _is_tick(control: list[Any]) -> bool:
    return len(control) == 2 and all(isinstance(value, bool) for value in control) and control[0] != control[1]
