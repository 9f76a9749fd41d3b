"""Showing how far a render is."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Watch = Callable[[int, int, int], object]

_DELAY = 0.4  # what is over sooner needs no bar
_INTERVAL = 0.1
_WIDTH = 40


class Bar:
    """A bar on stderr, redrawn at most ten times a second."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._started = time.monotonic()
        self._drawn = self._started + _DELAY - _INTERVAL
        self._visible = False

    def __call__(self, pixels: int, total: int, rays: int) -> None:
        """Draw it, if it is time."""
        now = time.monotonic()
        if now - self._drawn < _INTERVAL:
            return
        self._drawn = now
        self._visible = True
        share = pixels / total
        full = "━" * round(_WIDTH * share)
        rate = rays / (now - self._started)
        text = f"{self._name} {full:╌<{_WIDTH}} {100 * share:3.0f} %  {rate / 1e6:.1f} M rays/s"
        print(f"\r\x1b[K{text}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """Take it away."""
        if self._visible:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


@contextmanager
def watcher(progress: bool | Watch, name: str) -> Iterator[Watch | None]:
    """Give what a render calls while it lasts."""
    if callable(progress):
        yield progress
    elif progress and sys.stderr is not None and sys.stderr.isatty():
        bar = Bar(name)
        try:
            yield bar
        finally:
            bar.close()
    else:
        yield None
