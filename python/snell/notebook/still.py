"""Is this a notebook, are the packages for widgets there; and a picture that can change, which a notebook keeps."""

from __future__ import annotations

import importlib.util
import sys
from base64 import b64encode
from typing import Any

#: What to do where the packages for widgets are missing.
INSTALL = "pip install 'snell[notebook]'"


def in_notebook() -> bool:
    """Does a front end show what is displayed? IPython on a terminal has none; nothing is loaded to find out."""
    ipython = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")


def has_widgets() -> bool:
    """Are the packages there that sliders and the view in 3D need?"""
    return importlib.util.find_spec("anywidget") is not None


def open_cell(thing: object, stills: list[Still], png: bytes, what: str) -> bool:
    """Show a picture in this cell, which joins those of other cells; say whether the widget of the thing can follow.

    The still comes first: where the widget answers it may hide what stands before it.
    """
    if not in_notebook():
        print(repr(thing))
        return False
    stills.append(Still())
    stills[-1].show(png)
    if not has_widgets():
        print(f"{what}: {INSTALL}", file=sys.stderr)
        return False
    return True


def show(widget: Any, otherwise: str) -> None:
    """Show a widget; `otherwise` is what stands there where it is only read."""
    bundle = widget._repr_mimebundle_()
    data = bundle[0] if isinstance(bundle, tuple) else bundle
    _display({**data, "text/plain": otherwise}, raw=True)


class Still:
    """A picture in the output of a cell that can be changed later. A saved notebook keeps it as an ordinary picture."""

    def __init__(self) -> None:
        self._handle: Any = None

    def show(self, png: bytes) -> None:
        """Show a picture, in place of the one before."""
        bundle = {"image/png": b64encode(png).decode("ascii"), "text/plain": "<picture>"}
        if self._handle is None:
            self._handle = _display(bundle, raw=True, display_id=True)
        else:
            self._handle.update(bundle, raw=True)


def _display(data: dict[str, Any], **how: Any) -> Any:
    import IPython.display  # noqa: PLC0415 # only where there is a notebook

    display: Any = IPython.display.display
    return display(data, **how)
