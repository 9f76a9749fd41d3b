"""The frames of a sweep: a sheet of them, and movies."""

from __future__ import annotations

import importlib
import io
import numbers
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from ..errors import PictureError
from ..files import ending, replacing
from . import png
from .labels import labels

if TYPE_CHECKING:
    from PIL.Image import Image

_SLIDE, _CELL = 1920, 1280  # pixels across a sheet
_SLOWEST, _FASTEST = 0.1, 240
_FASTEST_GIF = 50  # browsers take a delay below 2/100 s for 1/10 s
_NEEDS = {"sheet": "Pillow", "video": "PyAV"}
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
        The files, in the order of the values.
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

    __hash__ = None  # type: ignore[assignment] # the values can be changed

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
            If there are no frames, one cannot be read, the sheet cannot be written (what was there before stays), its
            name does not end in .png or is that of a frame, or Pillow is not installed.
        """
        number = isinstance(columns, int | np.integer) and not isinstance(columns, bool)
        if not (columns is None or (number and columns > 0)):
            raise PictureError([("columns", f"expected a number of columns, at least 1, read {columns!r}", None)])
        if path is not None:
            ending(path, "sheet", [".png"])
            self._check_no_frame(path)
        sheet = self._drawn(columns, _SLIDE)
        if path is not None:
            with replacing(path) as beside:
                sheet.save(beside, "PNG", optimize=True)
        return sheet

    def save(self, path: str | os.PathLike[str], *, fps: float | Fraction = 20) -> None:
        """Write a movie: .mp4 (H.264), .gif, .webp or .apng (also .png); all but .mp4 repeat for ever.

        The pixels of WebP and APNG are those of the frames. GIF has 256 colours, and MP4 half the resolution in colour.

        Parameters
        ----------
        path : path
            Where to; its ending is the format.
        fps : float or Fraction
            Frames per second.

        Raises
        ------
        PictureError
            If there are no frames, they are not of one size, one cannot be read, the movie cannot be written (what was
            there before stays), its name is that of a frame, or PyAV is not installed.
        """
        form = ending(path, "movie", _MOVIES)
        fastest = _FASTEST_GIF if form == ".gif" else _FASTEST
        number = isinstance(fps, numbers.Real) and not isinstance(fps, bool)
        if not (number and _SLOWEST <= fps <= fastest):
            message = f"expected {_SLOWEST} to {fastest} frames per second, read {fps!r}"
            raise PictureError([("fps", message, "a GIF cannot be faster" if form == ".gif" else None)])
        self._check_no_frame(path)
        self._check_some()
        png.check_alike(self.frames)
        module, function = _MOVIES[form]
        write = getattr(_optional(module), function)
        with replacing(path) as beside:
            write(self.frames, beside, _rate(fps))

    def _drawn(self, columns: int | None, width: int) -> Image:
        self._check_some()
        sheet: Image = _optional("sheet").sheet(self.frames, self._labels(), columns, width)
        return sheet

    def _labels(self) -> list[list[tuple[str, str]]]:
        return labels(self.values) or [[] for _ in self.frames]

    def _check_some(self) -> None:
        if not self.frames:
            raise PictureError([(None, "there are no frames", None)])

    def _check_no_frame(self, path: str | os.PathLike[str]) -> None:
        """Check that a file to write is none of the frames, which would be lost."""
        there = (frame for frame in self.frames if os.path.exists(path) and frame.exists())
        if any(frame.samefile(path) for frame in there):
            raise PictureError([(os.fspath(path), "is a frame of this very sweep", "choose another name")])

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


def _rate(fps: float | Fraction) -> Fraction:
    """Return frames per second as two numbers of 16 bits, which APNG has; exactly, if that can be."""
    rate = fps if isinstance(fps, Fraction) else Fraction(float(fps))
    return rate if max(rate.numerator, rate.denominator) < 2**16 else rate.limit_denominator(250)


def _optional(module: str) -> Any:
    """Load what needs a library that need not be there."""
    try:
        return importlib.import_module(f".{module}", __package__)
    except ImportError as error:
        raise PictureError([(None, f"this needs {_NEEDS[module]}: {error}", "pip install 'snell[movie]'")]) from error
