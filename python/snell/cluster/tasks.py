"""What a worker does. Workers find these functions by their names, and need nothing but the package."""

from __future__ import annotations

import pickle
from collections.abc import Sequence

from dask.sizeof import sizeof

from .._native import NativePart, NativeWorld
from ..how import Region
from .plan import Range


def load(pieces: Sequence[bytes]) -> NativeWorld:
    """Return a scene, which is compiled when its first rays are traced."""
    world: NativeWorld = pickle.loads(b"".join(pieces))
    return world


def render(world: NativeWorld, crop: Region | None, rows: Range, samples: Range) -> NativePart:
    """Render some samples on one thread: Dask runs as many tasks at a time as a worker has threads."""
    return world.render_part(1, crop, rows, samples, None)


def cost(part: NativePart) -> tuple[float, int]:
    """Return seconds and rays of a part, which stays where it is."""
    return part.seconds, part.rays


def join(parts: Sequence[NativePart]) -> NativePart:
    """Return all that some parts have."""
    return NativePart.join(list(parts))


# How much memory a part takes, so that Dask spills what does not fit.
sizeof.register(NativePart, lambda part: part.bytes)
