"""Pictures: their numbers, files, and what is behind a pixel."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from . import _native
from .channels import Channels
from .errors import PictureError
from .progress import watcher
from .tree import RayTree
from .values import whole

if TYPE_CHECKING:
    from .notebook.view import View


@dataclass(frozen=True, eq=False)
class Sightings:
    """Where an object is seen, as `Scene.find` says it; notebooks show the mask.

    Attributes
    ----------
    paths : list of (str, int)
        Light paths, like ``camera → glass(refract) → green``, each with its number of pixels, the most first; a pixel
        counts once for each path that it has.
    mask : ndarray, (height, width)
        Which share of each pixel is the object, 0 to 1.
    """

    paths: list[tuple[str, int]]
    mask: NDArray[np.float64]

    def _repr_png_(self) -> bytes:
        return _native.png(self.mask[..., None].repeat(3, axis=2))


@dataclass(frozen=True, eq=False)
class Difference:
    """What two pictures differ in, as `Picture.diff` says it; notebooks show where, the largest difference in white.

    Attributes
    ----------
    pixels, total : int
        So many pixels differ in any bit, of so many.
    largest : float
        The largest difference of a number, linear, without its sign.
    array : ndarray, (height, width, 3)
        First minus second, linear.
    """

    pixels: int
    total: int
    largest: float
    array: NDArray[np.float64]

    def __repr__(self) -> str:
        return f"{self.pixels} of {self.total} pixels differ, by {self.largest:g} at most"

    def _repr_png_(self) -> bytes:
        return _native.png(np.abs(self.array) / (self.largest or 1.0))


class Picture:
    """A picture, as `Scene.render` makes it; notebooks show it as PNG.

    ``np.asarray(picture)`` is `Picture.array`. A pickled picture takes with it all that it is made of, also what was
    read from files, so that it can be explained and saved anywhere; only the same version of Snell reads it.

    Examples
    --------
    >>> import snell
    >>> picture = snell.scenes["lecture/default"].render()
    >>> picture
    <Picture of lecture/default, 512 x 512>
    >>> picture.explain(190, 300).sentence[:29]
    'Green because 53 % of this pi'
    >>> picture.diff(picture)
    0 of 262144 pixels differ, by 0 at most
    """

    def __init__(self, native: _native.NativePicture, name: str) -> None:
        self._native = native
        self.name = name
        #: Linear colour, height x width x 3, row 0 on top: the film itself, not a copy; read-only.
        self.array: NDArray[np.float64] = native.array

    @property
    def width(self) -> int:
        """Columns."""
        return self._native.region[2]

    @property
    def height(self) -> int:
        """Rows."""
        return self._native.region[3]

    @property
    def region(self) -> tuple[int, int, int, int]:
        """Left, top, width and height in the whole picture."""
        return self._native.region

    @property
    def full_size(self) -> tuple[int, int]:
        """Width and height of the whole picture, of which this may be a part."""
        return self._native.full_size

    @property
    def finished(self) -> bool:
        """Is every pixel done? False after ^C."""
        return self._native.finished

    @property
    def seconds(self) -> float:
        """Seconds that rendering took, without reading and compiling the scene."""
        return self._native.seconds

    @property
    def rays(self) -> int:
        """Rays of all kinds that were traced."""
        return self._native.rays

    @property
    def remarks(self) -> list[str]:
        """What rendering has come upon, in words: light that was not followed, solids that overlap or are open.

        ``docs/warnings.md`` lists them. Of all but lost light (W202) and black pictures (W203) `Scene.render` warns,
        too.
        """
        return [text for _, text in self._native.warnings()]

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        wanted = self.array.dtype if dtype is None else np.dtype(dtype)
        if wanted == self.array.dtype and not copy:
            return self.array
        if copy is False:
            raise ValueError(f"numbers of {wanted} need a copy: those of a picture are {self.array.dtype}")
        return self.array.astype(wanted)

    def __reduce__(self) -> tuple[type[Picture], tuple[_native.NativePicture, str]]:
        return Picture, (self._native, self.name)

    def save(self, path: str | os.PathLike[str], *, bits: int = 8, binary: bool = False) -> None:
        """Write it as .png, .ppm, .exr or .npy; PNG and EXR remember how it was made (``snell render --from``).

        Parameters
        ----------
        path : path
            Where to; its ending is the format.
        bits : {8, 16}
            Of a PNG.
        binary : bool
            P6 instead of P3, for PPM.

        Raises
        ------
        PictureError
            If it cannot be written; what was there before stays.
        """
        if bits not in (8, 16):
            raise PictureError([("bits", f"expected 8 or 16, read {bits!r}", None)])
        self._native.save(Path(path), int(bits), bool(binary))

    def diff(self, other: Picture | NDArray[np.floating[Any]]) -> Difference:
        """Compare with another picture, or an array of its shape.

        Raises
        ------
        PictureError
            If they are of different shapes.
        """
        theirs = np.asarray(other.array if isinstance(other, Picture) else other)
        if theirs.dtype.kind not in "buif":
            raise PictureError([(None, f"expected a picture or an array of numbers, read {other!r}", None)])
        if theirs.shape != self.array.shape:
            raise PictureError([(None, f"an array of shape {theirs.shape} is none of {self.array.shape}", None)])
        array = self.array - theirs
        different = int(np.any(self.array != theirs, axis=2).sum())
        return Difference(different, self.width * self.height, float(np.abs(array).max()), array)

    def crop(self, x: int, y: int, width: int, height: int) -> Picture:
        """Return a part, a copy: left column, top row, and size in pixels.

        Raises
        ------
        PictureError
            If it does not lie within.
        """
        left, top = self._native.region[:2]
        x, y, width, height = (whole(number, "crop", PictureError) for number in (x, y, width, height))
        numbers = (left + x, top + y, width, height)
        part = self._native.part(*numbers) if all(0 <= number < 2**32 for number in numbers) else None
        if part is None or x < 0 or y < 0:
            message = f"{width} x {height} pixels at ({x}, {y}) do not lie within {self.width} x {self.height}"
            raise PictureError([("crop", message, None)])
        return Picture(part, self.name)

    @cached_property
    def channels(self) -> Channels:
        """Depth, normals, objects, and how many surfaces each pixel takes; traced when they are first asked for."""
        with watcher(True, self.name) as watch:
            return Channels(*self._native.channels(watch), self._native, self.name)

    def view(self, *, css_height: str | None = None) -> View:
        """Show the scene in 3D, the picture in front of its camera: `snell.View`."""
        from .notebook.view import View  # noqa: PLC0415 # a view has a picture, and a picture can be viewed

        return View(self, css_height=css_height)

    def explain(self, x: int, y: int) -> RayTree:
        """Say why a pixel has its colour.

        Parameters
        ----------
        x, y : int
            Column and row, from the top left.

        Raises
        ------
        PictureError
            If there is no such pixel.
        """
        x, y = (whole(number, "explain", PictureError) for number in (x, y))
        if not (0 <= x < self.width and 0 <= y < self.height):
            raise no_pixel(x, y, self.width, self.height)
        left, top = self._native.region[:2]
        tree = self._native.explain(left + x, top + y)
        assert tree is not None, "the pixel is there"
        return RayTree(tree, self)

    def _repr_png_(self) -> bytes:
        return self._native.png()

    def __repr__(self) -> str:
        state = "" if self.finished else ", unfinished"
        return f"<Picture of {self.name}, {self.width} x {self.height}{state}>"


def no_pixel(x: int, y: int, width: int, height: int) -> PictureError:
    """Return the error of who asks for a pixel that is not there."""
    help = f"columns are 0 to {width - 1}, rows 0 to {height - 1}, from the top left"
    return PictureError([("explain", f"there is no pixel {x},{y}", help)])
