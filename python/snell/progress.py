"""Showing how far a render is: on a terminal, and in notebooks."""

from __future__ import annotations

import html
import sys
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Protocol

from .notebook.still import in_notebook

Watch = Callable[[int, int, int], object]
#: What a bar says beside its share: of pixels, pixels in all, rays, and seconds.
Note = Callable[[int, int, int, float], str]

_DELAY = 0.4  # what is over sooner needs no bar
_INTERVAL = 0.1
_WIDTH = 40


class _Screen(Protocol):
    """Where a bar is seen."""

    def show(self, name: str, share: float, note: str) -> None: ...
    def clear(self) -> None: ...


class _Terminal:
    def show(self, name: str, share: float, note: str) -> None:
        full = "━" * round(_WIDTH * share)
        print(f"\r\x1b[K{name} {full:╌<{_WIDTH}} {note}", end="", file=sys.stderr, flush=True)

    def clear(self) -> None:
        print("\r\x1b[K", end="", file=sys.stderr, flush=True)


class _Notebook:
    """An output of its own in the cell. Jupyter cannot take one away: what stays is an empty one, which nobody sees.

    To clear the cell would take away what the cell has shown before, too.
    """

    def __init__(self, display: Any) -> None:
        self._display = display
        self._id: str | None = None

    def show(self, name: str, share: float, note: str) -> None:
        page = _HTML.format(name=html.escape(name), percent=100 * share, note=html.escape(note))
        self._put({"text/html": page})

    def clear(self) -> None:
        self._put({})

    def _put(self, content: dict[str, str]) -> None:
        again = self._id is not None
        self._id = self._id or uuid.uuid4().hex
        self._display.publish_display_data(content, transient={"display_id": self._id}, update=again)


# Colours of the theme around it, so that it is as good on dark.
_HTML = (
    '<div role="progressbar" aria-valuenow="{percent:.0f}" style="display: flex; align-items: center; gap: 0.8em">'
    "<span>{name}</span>"
    '<span style="flex: 0 1 16em; height: 0.35em; border-radius: 1em; background: rgba(128, 128, 128, 0.3)">'
    '<span style="display: block; width: {percent:.1f}%; height: 100%; border-radius: 1em; background: #3b82f6"></span>'
    '</span><span style="opacity: 0.7; font-variant-numeric: tabular-nums; white-space: pre">{note}</span></div>'
)


class Bar:
    """A bar that is redrawn at most ten times a second."""

    def __init__(self, screen: _Screen, name: str, note: Note) -> None:
        self._screen = screen
        self._name = name
        self._note = note
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
        self._screen.show(self._name, pixels / total, self._note(pixels, total, rays, now - self._started))

    def close(self) -> None:
        """Take it away."""
        if self._visible:
            self._screen.clear()


def rate(pixels: int, total: int, rays: int, seconds: float) -> str:
    """Say how fast one picture is."""
    return f"{100 * pixels / total:3.0f} %  {rays / seconds / 1e6:.1f} M rays/s"


def duration(seconds: float) -> str:
    """Say a time in words."""
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {seconds:02} s" if minutes else f"{seconds} s"


@contextmanager
def watcher(progress: bool | Watch, name: str, note: Note = rate) -> Iterator[Watch | None]:
    """Give what a render calls while it lasts."""
    if callable(progress):
        yield progress
    elif progress and (screen := _screen()) is not None:
        bar = Bar(screen, name, note)
        try:
            yield bar
        finally:
            bar.close()
    else:
        yield None


def _screen() -> _Screen | None:
    if in_notebook():
        return _Notebook(sys.modules["IPython"].display)
    return _Terminal() if sys.stderr is not None and sys.stderr.isatty() else None
