"""Some samples of a picture, rendered wherever there is time."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ._native import NativePart
from .errors import PictureError

Range = tuple[int, int]
Rectangle = tuple[int, int, int, int]


class Part:
    """Some samples of some rows of a picture: what `Scene.render_part` returns and `Scene.merge` takes.

    It can be pickled and sent to other processes and machines. It does not contain the scene.

    Examples
    --------
    >>> import snell
    >>> scene = snell.scenes["lecture/default"]
    >>> parts = [scene.render_part(samples=(start, start + 2), width=64, spp=4) for start in (0, 2)]
    >>> bool((scene.merge(parts).array == scene.render(width=64, spp=4).array).all())
    True
    """

    def __init__(self, native: NativePart, how: dict[str, Any]) -> None:
        self._native = native
        self._how = how

    @classmethod
    def join(cls, parts: Iterable[Part]) -> Part:
        """Return one part with all samples of several parts of one picture.

        Raises
        ------
        PictureError
            If there are none, they are of different pictures, or have samples in common.
        """
        native, how = joinable(parts)
        return cls(NativePart.join(native), how)

    @property
    def pieces(self) -> list[tuple[Rectangle, list[Range]]]:
        """What it contains: rectangles (left, top, width, height in pixels), each with its ranges of samples."""
        return self._native.pieces()

    @property
    def seconds(self) -> float:
        """Seconds that it took to render; for a joined part, the sum."""
        return self._native.seconds

    @property
    def rays(self) -> int:
        """Rays that were traced for it."""
        return self._native.rays

    def __repr__(self) -> str:
        def words(first: int, end: int) -> str:
            return f"{first} to {end - 1}"

        pieces = [
            f"rows {words(top, top + height)}, samples {' and '.join(words(*each) for each in samples)}"
            for (_, top, _, height), samples in self.pieces
        ]
        return f"<Part: {'; '.join([*pieces[:3], *(['…'] if len(pieces) > 3 else [])])}>"


def joinable(parts: Iterable[Part]) -> tuple[list[NativePart], dict[str, Any]]:
    """Return what parts have in common: all of them as the library has them, and how they were made.

    Raises
    ------
    PictureError
        If there are none, or something else is among them.
    """
    each = list(parts) if isinstance(parts, Iterable) else [parts]
    for part in each:
        if not isinstance(part, Part):
            raise PictureError([("parts", f"expected parts of pictures, read {part!r}", None)])
    if not each:
        raise PictureError([("parts", "there are none", None)])
    return [part._native for part in each], each[0]._how
