"""Which rows and samples make one task."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

Range = tuple[int, int]

#: So many parts are joined at a time.
FAN_IN = 8
#: A measured time says enough about the time of a task if it is at least this share of it.
_TELLING = 1 / 16


def bands(first: int, end: int, count: int) -> list[Range]:
    """Cut rows into at most `count` bands that differ by one row at most."""
    count = max(1, min(count, end - first))
    edges = [first + (end - first) * number // count for number in range(count + 1)]
    return list(pairwise(edges))


def chunks(samples: Range, count: float) -> list[Range]:
    """Cut samples at the multiples of a power of two, of about so many: each chunk but the last is one sum."""
    first, end = samples
    size = 2 ** round(math.log2(max(1.0, min(count, 2.0**16))))
    edges = [first, *range((first // size + 1) * size, end, size), end]
    return list(pairwise(edges))


def passes(samples: Range, least: float) -> list[Range]:
    """Cut samples at powers of two: after each pass there are twice as many as before, which is worth a look.

    Only the last pass may have less than `least` samples.
    """
    first, end = samples
    edges = [first]
    while edges[-1] < end:
        enough = math.ceil(min(edges[-1] + max(least, 1), end))
        edges.append(min(end, 2 ** (max(enough, 2 * edges[-1]) - 1).bit_length()))
    return list(pairwise(edges))


@dataclass
class Band:
    """Some rows, and what is known of their cost."""

    rows: Range
    #: Samples per pixel that are wanted, and that have been asked for.
    spp: int
    asked: int = 0
    #: Seconds per sample of all its pixels, as far as they are known.
    seconds: float | None = None
    #: Is that measured for long enough to go by it?
    is_sure: bool = False
    #: Rays of its trials.
    rays: int = 0
    #: What is joined with what it gets next.
    parts: list[Any] = field(default_factory=list)

    def measured(self, samples: Range, seconds: float, wanted: float) -> None:
        """Take into account what some samples took; a task should take `wanted` seconds."""
        self.seconds = seconds / (samples[1] - samples[0])
        self.is_sure = self.is_sure or seconds >= _TELLING * wanted or self.rest * self.seconds <= wanted

    @property
    def rest(self) -> int:
        """How many samples have not been asked for."""
        return self.spp - self.asked

    def trial(self, wanted: float) -> Range:
        """Return the samples that are to be measured next: the first, then those that may take a quarter of a task."""
        if self.seconds is None:
            return 0, 1
        count = 2 ** int(math.log2(max(2.0, min(wanted / 4 / max(self.seconds, 1e-9), 2.0**16))))
        return self.asked, min(self.spp, max(count, 2 * self.asked))

    def split(self, wanted: float) -> list[Band]:
        """Return itself, or bands of fewer rows if even one sample takes longer than a task should."""
        assert self.seconds is not None, "it has been measured"
        count = math.ceil(self.seconds / wanted)
        rows = bands(*self.rows, count)
        if len(rows) == 1:
            return [self]
        height = self.rows[1] - self.rows[0]
        return [
            Band(each, self.spp, self.asked, self.seconds * (each[1] - each[0]) / height, is_sure=True) for each in rows
        ]
