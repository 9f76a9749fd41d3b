"""What workers do in tests instead of rendering. It is a module of its own, so that they find it."""

from __future__ import annotations

import os
import time
from typing import Any, NamedTuple

from snell.cluster.plan import Range


class Fake(NamedTuple):
    """A part that nobody rendered: rows and samples that it stands for."""

    cells: frozenset[tuple[int, int]]
    seconds: float
    rays: int


class Work:
    """Tasks that take `seconds` for a sample of a row."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds

    def load(self, pieces: list[bytes]) -> int:
        return sum(map(len, pieces))

    def render(self, world: int, crop: object, rows: Range, samples: Range) -> Fake:
        del world, crop
        cells = frozenset((row, sample) for row in range(*rows) for sample in range(*samples))
        seconds = self.seconds * len(cells)
        time.sleep(seconds)
        return Fake(cells, seconds, len(cells))

    def cost(self, part: Fake) -> tuple[float, int]:
        return part.seconds, part.rays

    def join(self, parts: list[Fake]) -> Fake:
        cells = frozenset[tuple[int, int]]().union(*(part.cells for part in parts))
        assert len(cells) == sum(len(part.cells) for part in parts), "a sample is there twice"
        return Fake(cells, sum(part.seconds for part in parts), sum(part.rays for part in parts))


class Deadly(Work):
    """Tasks that end their worker."""

    def render(self, world: int, crop: object, rows: Range, samples: Range) -> Fake:
        del world, crop, rows, samples
        os._exit(1)


class Greedy(Work):
    """Tasks that take more and more memory, which their nanny sees."""

    def render(self, world: int, crop: object, rows: Range, samples: Range) -> Fake:
        del world, crop, rows, samples
        taken: list[Any] = []
        for _ in range(600):
            taken.append(bytearray(os.urandom(1 << 14)) * 256)  # 4 MiB that no kernel can share
            time.sleep(0.005)
        raise AssertionError("nobody minded 2.4 GiB")


class Failing(Work):
    """Tasks that fail."""

    def render(self, world: int, crop: object, rows: Range, samples: Range) -> Fake:
        raise ModuleNotFoundError("No module named 'snell_of_yesterday'")
