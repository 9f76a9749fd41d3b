"""Notebooks: are the packages for widgets there, and how a picture is shown that can change and is kept."""

from __future__ import annotations

import importlib.util
import sys
from base64 import b64encode
from typing import Any

#: What to do where the packages for widgets are missing.
INSTALL = "pip install 'snell[notebook]'"


def has_widgets() -> bool:
    """Are the packages there that sliders and the view in 3D need?"""
    return importlib.util.find_spec("anywidget") is not None


def show(widget: Any, otherwise: str) -> None:
    """Show a widget; `otherwise` is what stands there where it is only read."""
    bundle = widget._repr_mimebundle_()
    data = bundle[0] if isinstance(bundle, tuple) else bundle
    sys.modules["IPython"].display.display({**data, "text/plain": otherwise}, raw=True)


class Still:
    """A picture in the output of a cell that can be changed later. A saved notebook keeps it as an ordinary picture."""

    def __init__(self) -> None:
        self._handle: Any = None

    def show(self, png: bytes) -> None:
        """Show a picture, in place of the one before."""
        bundle = {"image/png": b64encode(png).decode("ascii"), "text/plain": "<picture>"}
        if self._handle is None:
            self._handle = sys.modules["IPython"].display.display(bundle, raw=True, display_id=True)
        else:
            self._handle.update(bundle, raw=True)
