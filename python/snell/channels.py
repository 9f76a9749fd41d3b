"""What is not colour: how far away things are, which way they face, what they are, how many surfaces a pixel takes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from . import _native
from .errors import PictureError
from .progress import watcher

_LISTED = 30


@dataclass(frozen=True, eq=False, repr=False)
class Channels:
    """What the rays of each pixel met; notebooks show it as four pictures. Of several samples the first one counts.

    Attributes
    ----------
    depth : ndarray, (height, width)
        How far the camera ray goes, in scene units: from the eye in `whitted`, from the image plane in the models of
        the lecture and the course; infinite where it meets nothing.
    normal : ndarray, (height, width, 3)
        The normal there, of unit length, towards the ray; zero where nothing is.
    object : ndarray of int, (height, width)
        The number of the object in `names`; -1 where nothing is (which Python would take for the last one).
    names : list of str
        The objects, in the order of the scene.
    hits : ndarray of int, (height, width)
        Surfaces that all rays of the pixel met; traced when it is first asked for.

    Examples
    --------
    >>> import snell
    >>> channels = snell.scenes["lecture/default"].render(width=64).channels
    >>> channels.names[channels.object[32, 32]], float(channels.depth[32, 32].round(2))
    ('glass', 36.01)
    >>> int(channels.mask("glass").sum()), int(channels.hits.max())
    (648, 4)
    """

    depth: NDArray[np.float64]
    normal: NDArray[np.float64]
    object: NDArray[np.int32]
    names: list[str]
    # Not the picture: it knows its channels, and would never be freed.
    _native: _native.NativePicture
    _name: str

    @cached_property
    def hits(self) -> NDArray[np.uint32]:
        """Surfaces that all rays of the pixel met, those to lights apart."""
        with watcher(True, self._name) as watch:
            return self._native.hits(watch)

    def mask(self, name: str) -> NDArray[np.bool_]:
        """Return where the camera sees an object directly; `Scene.find` also knows mirrors and glass.

        Raises
        ------
        PictureError
            If no object is called so.
        """
        numbers = [number for number, known in enumerate(self.names) if known == name]
        if not numbers:
            known = ", ".join(list(dict.fromkeys(self.names))[:_LISTED])
            raise PictureError([("mask", f"no object is called `{name}`", f"objects: {known}")])
        return np.isin(self.object, numbers)

    def __repr__(self) -> str:
        height, width = self.depth.shape
        return f"<Channels of {self._name}, {width} x {height}>"

    def _repr_png_(self) -> bytes:
        seen = np.isfinite(self.depth)
        near, far = (self.depth[seen].min(), self.depth[seen].max()) if seen.any() else (1.0, 1.0)
        # Logarithms tell near things apart, however far the floor goes, whatever the unit.
        near = max(near, 1e-3 * far)
        share = np.log(np.maximum(np.where(seen, self.depth, far), near) / near) / (np.log(far / near) or 1.0)
        depth = np.where(seen, 1 - 0.85 * share, 0)[..., None].repeat(3, axis=2)
        normal = np.where(seen[..., None], (self.normal + 1) / 2, 0)
        objects = np.where(seen[..., None], _hues(self.object), 0)
        hits = _heat(np.log1p(self.hits) / np.log1p(max(1, self.hits.max(initial=1))))
        return _native.png(np.ascontiguousarray(np.concatenate([depth, normal, objects, hits], axis=1)))


def _hues(numbers: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return a colour for each number: hues a golden angle apart, so that neighbours differ."""
    hue = (numbers[..., None] * 0.6180339887) + np.array([0, 2 / 3, 1 / 3])
    colors: NDArray[np.float64] = 0.55 + 0.4 * np.cos(2 * np.pi * hue)
    return colors


def _heat(share: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return black, red, yellow, white for 0 to 1."""
    colors: NDArray[np.float64] = np.clip(3 * share[..., None] - np.array([0, 1, 2]), 0, 1)
    return colors
