"""The frames of a sweep: a sheet of them, and movies."""

from __future__ import annotations

import importlib
import io
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from ..errors import PictureError
from . import png
from .files import replacing
from .labels import labels

if TYPE_CHECKING:
    from PIL.Image import Image

_SLIDE, _CELL = 1920, 1280  # pixels across a sheet
_SLOWEST, _FASTEST = 0.1, 240
_FASTEST_GIF = 50  # browsers take a delay below 2/100 s for 1/10 s
#: Module and function that write a movie.
_MOVIES = {
    ".mp4": ("video", "mp4"),
    ".gif": ("video", "gif"),
    ".webp": ("video", "webp"),
    ".apng": ("png", "animate"),
    ".png": ("png", "animate"),
}


@dataclass(frozen=True, eq=True, repr=False)
class Sweep(Sequence[Path]):
    """The frames of a sweep: a sequence of their files, which notebooks show as a contact sheet. A slice is one, too.

    Sheets and movies need Pillow and PyAV: ``pip install 'snell[movie]'``.

    Attributes
    ----------
    frames : tuple of Path
    values : dict of str to list
        For each key, the value of each frame.

    Examples
    --------
    >>> import snell, tempfile
    >>> folder = tempfile.TemporaryDirectory()
    >>> eta = {"material.glass.eta": [1.0, 1.25, 1.5]}
    >>> frames = snell.sweep(snell.scenes["lecture/default"], eta, folder.name, width=64)
    >>> frames
    <Sweep of 3 frames, eta 1.00 to 1.50>
    >>> frames[-1].name, frames[1:].values
    ('0002.png', {'material.glass.eta': [1.25, 1.5]})
    >>> frames.save(folder.name + "/ball.mp4", fps=10)
    >>> frames.sheet().size
    (208, 90)
    >>> folder.cleanup()
    """

    frames: tuple[Path, ...]
    values: Mapping[str, list[Any]]

    def __len__(self) -> int:
        return len(self.frames)

    @overload
    def __getitem__(self, index: int) -> Path: ...
    @overload
    def __getitem__(self, index: slice) -> Sweep: ...
    def __getitem__(self, index: int | slice) -> Path | Sweep:
        if isinstance(index, slice):
            return Sweep(self.frames[index], {key: column[index] for key, column in self.values.items()})
        return self.frames[index]

    def sheet(self, path: str | os.PathLike[str] | None = None, *, columns: int | None = None) -> Image:
        """Draw the frames side by side, with the values below them; of more than 60 frames, 60 evenly.

        Parameters
        ----------
        path : path, optional
            Where to write it as PNG.
        columns : int, optional
            So many frames in a row; left out: as suits a slide.

        Returns
        -------
        PIL.Image.Image
            The sheet, 1920 pixels wide, or less if the frames are small.

        Raises
        ------
        PictureError
            If there are no frames, one cannot be read, the sheet cannot be written, or Pillow is not installed.
        """
        if not (columns is None or (isinstance(columns, int | np.integer) and columns > 0)):
            raise PictureError([("columns", f"expected a number of columns, at least 1, read {columns!r}", None)])
        sheet = self._drawn(columns, _SLIDE)
        if path is not None:
            with replacing(path) as beside:
                sheet.save(beside, "PNG", optimize=True)
        return sheet

    def save(self, path: str | os.PathLike[str], *, fps: float = 20) -> None:
        """Write a movie: .mp4 (H.264), .gif, .webp or .apng (also .png); all but .mp4 repeat for ever.

        The pixels of WebP and APNG are those of the frames. GIF has 256 colours, and MP4 half the resolution in colour.

        Parameters
        ----------
        path : path
            Where to; its ending is the format.
        fps : float
            Frames per second.

        Raises
        ------
        PictureError
            If there are no frames, they are not of one size, one cannot be read, the movie cannot be written (what was
            there before stays), or PyAV is not installed.
        """
        place, ending = os.fspath(path), Path(path).suffix.lower()
        if ending not in _MOVIES:
            raise PictureError([(place, "no movie has this ending", f"known are {', '.join(_MOVIES)}")])
        fastest = _FASTEST_GIF if ending == ".gif" else _FASTEST
        if not (isinstance(fps, int | float | np.integer | np.floating) and _SLOWEST <= fps <= fastest):
            message = f"expected {_SLOWEST} to {fastest} frames per second, read {fps!r}"
            raise PictureError([("fps", message, "a GIF cannot be faster" if ending == ".gif" else None)])
        self._check_some()
        png.check_alike(self.frames)
        module, function = _MOVIES[ending]
        write = getattr(_optional(module), function)
        with replacing(path) as beside:
            write(self.frames, beside, Fraction(float(fps)).limit_denominator(250))  # APNG has 16 bits for each number

    def _drawn(self, columns: int | None, width: int) -> Image:
        self._check_some()
        sheet: Image = _optional("sheet").sheet(self.frames, self._labels(), columns, width)
        return sheet

    def _labels(self) -> list[list[tuple[str, str]]]:
        return labels(self.values) or [[] for _ in self.frames]

    def _check_some(self) -> None:
        if not self.frames:
            raise PictureError([(None, "there are no frames", None)])

    def _repr_png_(self) -> bytes | None:
        try:
            sheet = self._drawn(None, _CELL)
        except PictureError:  # without Pillow, or frames, the text will do
            return None
        file = io.BytesIO()
        sheet.save(file, "PNG")
        return file.getvalue()

    def __repr__(self) -> str:
        said = self._labels()
        ends = zip(said[0], said[-1], strict=True) if said else ()
        listed = (f", {name} {first} to {last}" for (name, first), (_, last) in ends)
        return f"<Sweep of {len(self)} frame{'s' * (len(self) != 1)}{''.join(listed)}>"


def _optional(module: str) -> Any:
    """Load what needs a library that need not be there."""
    try:
        return importlib.import_module(f".{module}", __package__)
    except ImportError as error:
        raise PictureError([(None, f"this needs Pillow and PyAV: {error}", "pip install 'snell[movie]'")]) from error
