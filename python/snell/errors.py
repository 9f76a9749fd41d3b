"""What can go wrong, and where."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence

Finding = tuple["str | None", str, "str | None"]


class SnellError(ValueError):
    """Something is wrong with what was given.

    Parameters
    ----------
    findings
        Place, message and help of each thing that is wrong, the first one first.

    Attributes
    ----------
    place : str or None
        Where the first of them is: a key like ``sphere[2].radius``, or a line of a file.
    help : str or None
        What to do about it.

    Examples
    --------
    >>> error = SnellError([("sphere[0].radius", "a radius must not be negative, read -9", None)])
    >>> error.place
    'sphere[0].radius'
    >>> print(error)
    sphere[0].radius: a radius must not be negative, read -9
    """

    def __init__(self, findings: Sequence[Finding]) -> None:
        self.findings = list(findings)
        self.place, self.message, self.help = self.findings[0]
        super().__init__("\n".join(_line(*finding) for finding in self.findings))

    def __reduce__(self) -> tuple[type[SnellError], tuple[list[Finding]]]:
        return type(self), (self.findings,)


def _line(place: str | None, message: str, help: str | None) -> str:
    return (f"{place}: " if place else "") + message + (f" ({help})" if help else "")


class SceneError(SnellError):
    """A scene, or a file of one, cannot be drawn."""


class RenderError(SnellError):
    """A picture cannot be rendered: it does not fit into memory."""


class PictureError(SnellError):
    """A picture has no such pixel, or cannot be written or compared."""


class OpticsError(SnellError):
    """A formula has no value for this, or no glass is called so."""


class SnellWarning(UserWarning):
    """Something is probably not meant; the picture is made all the same."""


def warn(message: str) -> None:
    """Warn where someone has called this package, however deep in it the reason is."""
    frame, level = sys._getframe(1), 3
    while (caller := frame.f_back) is not None and caller.f_globals.get("__name__", "").split(".")[0] == "snell":
        frame, level = caller, level + 1
    warnings.warn(message, SnellWarning, stacklevel=level)
