"""One picture of a cluster, watched while it is made."""

from __future__ import annotations

import base64
import sys
import time
import uuid
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from .. import _native
from ..how import Region
from ..notebook.still import in_notebook
from ..progress import Watch, duration, watcher
from .engine import Cluster, Engine, Job

#: Between two looks at the picture so far, in seconds; and so many times longer than a look takes.
_LOOK, _RARELY = 2.0, 20


def render(
    world: _native.NativeWorld,
    name: str,
    crop: Region | None,
    progress: bool | Watch,
    cluster: Cluster,
) -> _native.NativePicture:
    """Render a picture on a cluster; ^C ends it with what has come back."""
    started, job = time.monotonic(), Job(world, crop)

    def note(pixels: int, total: int, rays: int, seconds: float) -> str:
        del rays  # most are still with the workers
        workers = engine.workers
        left = f"{duration(seconds * (total - pixels) / pixels)} left  " if pixels else ""
        return f"{100 * pixels / total:3.0f} %  {left}{workers} worker{'s' if workers != 1 else ''}"

    def made(parts: list[_native.NativePart], unfinished: bool) -> _native.NativePicture:
        return world.merge(crop, parts, unfinished, time.monotonic() - started)

    with watcher(progress, name, note) as watch, _looks(progress is True) as look:

        def come_back() -> None:
            if watch:
                watch(job.samples_done // world.spp, job.pixels, job.rays)
            look(lambda: made(engine.so_far(job), True))

        engine = Engine(cluster, come_back)
        try:
            for _ in engine.finished([job]):
                pass
        except KeyboardInterrupt:
            return made(engine.so_far(job), True)
        finally:
            engine.cancel()
    return made(job.parts, False)


def render_all(
    worlds: Iterable[tuple[int, _native.NativeWorld]],
    count: int,
    crop: Region | None,
    watch: Watch,
    cluster: Cluster,
) -> Iterator[tuple[int, _native.NativePicture]]:
    """Render many pictures on a cluster, and yield each when it is done, by the number that it came with."""
    numbers: dict[Job, int] = {}

    def jobs() -> Iterator[Job]:
        for number, world in worlds:
            job = Job(world, crop)
            numbers[job] = number
            yield job

    def come_back() -> None:
        pixels = sum(job.samples_done / job.world.spp for job in numbers)
        if numbers:
            watch(int(pixels), next(iter(numbers)).pixels, sum(job.rays for job in numbers))

    engine = Engine(cluster, come_back)
    try:
        for job in engine.finished(jobs(), count):
            number = numbers.pop(job)
            yield number, job.world.merge(crop, job.parts, False, time.monotonic() - job.started)
    finally:
        engine.cancel()


@contextmanager
def _looks(wanted: bool) -> Iterator[Callable[[Callable[[], _native.NativePicture]], None]]:
    """Give what shows the picture so far in a notebook, from time to time, until it is done."""
    if not (wanted and in_notebook()):
        yield lambda picture: None
        return
    display: Any = sys.modules["IPython"].display
    identity, is_shown, due = uuid.uuid4().hex, False, time.monotonic() + _LOOK

    def show(content: dict[str, str]) -> None:
        nonlocal is_shown
        display.publish_display_data(content, transient={"display_id": identity}, update=is_shown)
        is_shown = True

    def look(picture: Callable[[], _native.NativePicture]) -> None:
        nonlocal due
        began = time.monotonic()
        if began < due:
            return
        show({"image/png": base64.b64encode(picture().png()).decode()})
        due = time.monotonic() + max(_LOOK, _RARELY * (time.monotonic() - began))

    try:
        yield look
    finally:
        if is_shown:
            show({})
