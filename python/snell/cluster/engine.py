"""Handing tasks out to a cluster, and collecting what comes back."""

from __future__ import annotations

import math
import pickle
import queue
import threading
import time
import uuid
import weakref
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from numbers import Real
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeVar

from .._native import NativePart, NativeWorld
from ..errors import RenderError, SceneError, SnellError, warn
from ..how import Region
from . import plan, tasks
from .plan import Band, Range

if TYPE_CHECKING:
    from distributed import Client, Future

T = TypeVar("T")

#: So many answers should be waited for, for each thread.
_AHEAD = 2
_SHORTEST, _LONGEST = 1e-3, 1e6
#: How long something is waited for that may not come, in seconds.
_PATIENCE = 5.0
#: Bytes of a scene in one task.
_PIECE = 1 << 22
#: A picture is cut into so many tasks for each thread, if none is shorter than that then, in seconds.
_SHARES, _SHORT = 16, 0.2
#: So many bands more than threads make up for those that are quick.
_SPARE = 16


class Cluster:
    """Workers, and how they are used.

    Parameters
    ----------
    client : distributed.Client
        Not an asynchronous one.
    task_seconds : float
        How long a task should take: 0.001 to 1000000.

    Raises
    ------
    SceneError
        If the client is none, or the time is none.
    """

    def __init__(self, client: object, task_seconds: float) -> None:
        self.client = _checked(client)
        is_number = isinstance(task_seconds, Real) and not isinstance(task_seconds, bool)
        if not (is_number and _SHORTEST <= task_seconds <= _LONGEST):
            message = f"expected {_SHORTEST:g} to {_LONGEST:g} seconds, read {task_seconds!r}"
            raise SceneError([("task_seconds", message, None)])
        self.task_seconds = float(task_seconds)


@dataclass(eq=False)
class Job:
    """A picture that is wanted."""

    world: NativeWorld
    crop: Region | None = None
    #: What has come back: parts that have no sample in common.
    parts: list[NativePart] = field(default_factory=list)
    samples_done: int = 0
    rays: int = 0
    bands: list[Band] = field(default_factory=list)
    #: How many answers are waited for.
    open: int = 0
    scene: Future | None = None
    started: float = 0.0

    @property
    def region(self) -> Region:
        """Left, top, width and height."""
        return self.crop or (0, 0, *self.world.size)

    @property
    def pixels(self) -> int:
        """How many pixels."""
        return self.region[2] * self.region[3]


class Engine:
    """Renders pictures on the workers of a cluster.

    Nothing here waits in Dask's own `sync`: ^C in there would break the client.

    Parameters
    ----------
    cluster : Cluster
        Who does it.
    watch : callable, optional
        Called whenever something has come back, and once a second.
    work : module
        What the workers do; a simulation has others.
    """

    def __init__(
        self, cluster: Cluster, watch: Callable[[], object] | None = None, work: ModuleType | Any = tasks
    ) -> None:
        from distributed import as_completed  # noqa: PLC0415 # it is there, as there is a client

        self.client = cluster.client
        self._wanted = cluster.task_seconds
        self._watch = watch or (lambda: None)
        self._work = work
        self._run = uuid.uuid4().hex[:8]
        #: How many tasks have been handed out; workers, and what they run at a time.
        self.tasks = self.workers = self.threads = 0
        #: What happens when something has come back, by its key; the futures are held until then.
        self._waiting: dict[str, _Waiting] = {}
        self._arrivals = as_completed(loop=self.client.loop)
        self._futures: weakref.WeakSet[Future] = weakref.WeakSet()
        self._running: list[Job] = []
        #: Seconds for a sample of one pixel, as the pictures before were.
        self._known: float | None = None
        self._looked = self._alone_since = -math.inf

    def finished(self, jobs: Iterable[Job], count: int = 1) -> Iterator[Job]:
        """Render pictures, and yield each when all of it has come back. `count` is how many there are.

        Raises
        ------
        RenderError
            If the cluster gives up; what workers raise is raised here.
        """
        with _out_of_the_way():
            yield from self._finished(iter(jobs), count)

    def _finished(self, jobs: Iterator[Job], count: int) -> Iterator[Job]:
        running, is_empty = self._running, False
        self._look_around()
        while True:
            while not is_empty and len(self._waiting) < _AHEAD * max(self.threads, 1):
                job = next(jobs, None)
                is_empty = job is None
                if job is not None:
                    running.append(job)
                    bands = min(2 * self.threads, self.threads + _SPARE)
                    self._start(job, math.ceil(max(bands, 1) / count))
            if not running:
                return
            while not (is_done := [job for job in running if not job.open]):
                for future in self._next():
                    self._take(future)
            for job in is_done:
                running.remove(job)
                self._learn(job)
                _let_go(job)
                yield job

    def so_far(self, job: Job) -> list[NativePart]:
        """Return what there is of a picture, if it comes back soon."""
        there = [part for band in job.bands for part in band.parts if part.status == "finished"]
        back: list[NativePart] | None = _elsewhere(lambda: self.client.gather(there, errors="skip"), _PATIENCE)
        return [*job.parts, *(back or [])]

    def cancel(self) -> None:
        """Give up what is under way. Tasks that run already come to their end, which nobody waits for."""
        self._waiting.clear()
        for job in self._running:
            _let_go(job)
        # Dask forgets what nobody wants. Whatever goes wrong here, something has gone wrong before, which is said.
        with suppress(Exception):
            self._arrivals.clear()
            for future in list(self._futures):
                future.release()

    def _next(self) -> list[Future]:
        """Wait for what comes back next."""
        while not (batch := self._arrivals.next_batch(block=False)):
            if time.monotonic() > self._looked + 1:
                self._look_around()
                self._watch()
            time.sleep(0.005)
        return list(batch)

    def _look_around(self) -> None:
        """See who is there."""
        workers = _elsewhere(self.client.nthreads, _PATIENCE) or {}
        now = time.monotonic()
        self.workers, self.threads, self._looked = len(workers), sum(workers.values()), now
        if self.workers or self._alone_since < 0:
            self._alone_since = now
        elif now > self._alone_since + 2 * _PATIENCE:
            warn("the cluster has no workers; the picture goes on when there are some")
            self._alone_since = math.inf

    def _start(self, job: Job, count: int) -> None:
        """Hand out the first tasks of a picture."""
        job.started = time.monotonic()
        # In tasks, and not scattered: Dask makes again what a lost worker had only if a task had made it. In pieces, as
        # it warns of large ones.
        scene = pickle.dumps(job.world, protocol=5)
        pieces = [scene[at : at + _PIECE] for at in range(0, len(scene), _PIECE)]
        if len(pieces) > 1:
            pieces = [self._submit("piece", bytes, piece) for piece in pieces]
        job.scene = self._submit("scene", self._work.load, pieces)
        _, top, _, height = job.region
        known = None if self._known is None else self._known * job.pixels * job.world.spp
        if known is not None:
            # Pictures like the ones before need no trials, and no more tasks than are worth it.
            count = min(count, math.ceil(known / self._wanted))
        job.bands += [Band(rows, job.world.spp) for rows in plan.bands(top, top + height, count)]
        for band in job.bands:
            if self._known is None:
                self._try(job, band)
            else:
                pixels = job.region[2] * (band.rows[1] - band.rows[0])
                band.measured((0, 1), self._known * pixels, math.inf)
                self._finish(job, band)

    def _learn(self, job: Job) -> None:
        """Take what a picture took as what the next ones will."""
        seconds = sum(part.seconds for part in job.parts)
        self._known = max(seconds / (job.pixels * job.world.spp), 1e-12)

    def _try(self, job: Job, band: Band) -> None:
        """Render some samples to see how long they take."""
        samples = band.trial(self._wanted)
        part = self._render(job, band.rows, samples, 0)
        cost = self._submit("cost", self._work.cost, part)

        def arrived(measured: tuple[float, int]) -> None:
            seconds, rays = measured
            _count(job, band.rows, samples)
            job.rays += rays
            band.rays += rays
            band.parts.append(part)
            band.asked = samples[1]
            band.measured(samples, seconds, self._wanted)
            if band.rest == 0:
                self._collect(job, band, self._join(band.parts, 0))
            elif not band.is_sure:
                self._try(job, band)
            else:
                smaller = band.split(self._wanted)
                if smaller != [band]:
                    job.bands += smaller
                    self._collect(job, band, self._join(band.parts, 0))
                for each in smaller:
                    self._finish(job, each)

        self._wait(job, cost, arrived)

    def _finish(self, job: Job, band: Band) -> None:
        """Hand out all that is left of a band, and how it is joined: pass by pass, in trees."""
        assert band.seconds is not None, "it has been measured"
        there = list(band.parts)
        # Whoever is done first waits for the last task: where there is less to do, tasks are shorter.
        left = band.seconds * band.rest * len(job.bands)
        wanted = min(self._wanted, max(left / (_SHARES * max(self.threads, 1)), _SHORT))
        of_task = wanted / max(band.seconds, 1e-12)
        for number, samples in enumerate(plan.passes((band.asked, band.spp), of_task / 2)):
            leaves = []
            for chunk in plan.chunks(samples, of_task):
                part = self._render(job, band.rows, chunk, -number)
                leaves.append(part)
                self._wait(job, part, partial(_count, job, band.rows, chunk), fetch=False)
            while len(leaves) > plan.FAN_IN:
                leaves = [
                    self._join(leaves[at : at + plan.FAN_IN], -number) for at in range(0, len(leaves), plan.FAN_IN)
                ]
            there = [self._join([*there, *leaves], -number)]
            if samples[1] < band.spp:
                self._wait(job, there[0], partial(_take_over, band, there[0]), fetch=False)
        band.asked = band.spp
        self._collect(job, band, there[0])

    def _collect(self, job: Job, band: Band, part: Future) -> None:
        """Fetch a band when it is done."""

        def arrived(back: NativePart) -> None:
            # In this order ^C between the two can lose a band of the picture so far, and never have it twice.
            band.parts = []
            job.parts.append(back)
            job.rays += back.rays - band.rays

        self._wait(job, part, arrived)

    def _render(self, job: Job, rows: Range, samples: Range, priority: int) -> Future:
        return self._submit("render", self._work.render, job.scene, job.crop, rows, samples, priority=priority)

    def _join(self, parts: Sequence[Any], priority: int) -> Future:
        return parts[0] if len(parts) == 1 else self._submit("join", self._work.join, list(parts), priority=priority)

    def _submit(self, what: str, function: Callable[..., Any], *arguments: Any, priority: int = 0) -> Future:
        self.tasks += 1
        key = f"snell-{what}-{self._run}-{self.tasks}"
        future = self.client.submit(function, *arguments, key=key, priority=priority)
        self._futures.add(future)
        return future

    def _wait(self, job: Job, future: Future, arrived: Callable[[Any], object], *, fetch: bool = True) -> None:
        """Do something when a task is done, with its result if that is to be fetched."""
        job.open += 1
        if future.key not in self._waiting:
            self._waiting[future.key] = _Waiting(job, future)
            self._arrivals.add(future)
        self._waiting[future.key].arrived.append((arrived, fetch))

    def _take(self, future: Future) -> None:
        """Do what is to be done with what has come back."""
        if future.status in ("lost", "pending"):
            # It was on a worker that is no more: it is done again.
            self._arrivals.add(future)
            return
        if future.status == "error":
            raise _failed(_elsewhere(future.exception))
        if future.status != "finished":
            message = f"the cluster has let go of a task: it is {future.status}"
            raise RenderError([(None, message, "was it restarted, or cancelled by somebody else?")])
        waiting = self._waiting.pop(future.key)
        result = None
        if any(fetch for _, fetch in waiting.arrived):
            try:
                result = _elsewhere(future.result)
            except Exception as error:
                raise _failed(error) from error
        for arrived, _ in waiting.arrived:
            arrived(result)
            waiting.job.open -= 1
        self._watch()


@dataclass
class _Waiting:
    """What is waited for, and what happens then."""

    job: Job
    future: Future
    #: With the result, if it is to be fetched.
    arrived: list[tuple[Callable[[Any], object], bool]] = field(default_factory=list)


@contextmanager
def _out_of_the_way() -> Iterator[None]:
    """Leave the place of a task that renders to other tasks, which it waits for."""
    from distributed import get_worker, rejoin, secede  # noqa: PLC0415 # it is there, as there is a client

    try:
        get_worker()
        secede()
    except (ValueError, KeyError):  # it is no task, or has left its place already, as `worker_client` does
        yield
        return
    try:
        yield
    finally:
        rejoin()


def _elsewhere(wait: Callable[[], T], seconds: float = math.inf) -> T | None:
    """Wait in a thread of its own, for so long at most, so that ^C ends only the waiting; None if it took longer."""
    result: queue.SimpleQueue[tuple[T | None, BaseException | None]] = queue.SimpleQueue()

    def work() -> None:
        try:
            result.put((wait(), None))
        except BaseException as error:
            result.put((None, error))

    threading.Thread(target=work, daemon=True, name="snell-waits").start()
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        with suppress(queue.Empty):
            value, error = result.get(timeout=0.1)
            if error is not None:
                raise error
            return value
    return None


def _count(job: Job, rows: Range, samples: Range, _: object = None) -> None:
    """Count what has been rendered."""
    job.samples_done += (rows[1] - rows[0]) * job.region[2] * (samples[1] - samples[0])


def _let_go(job: Job) -> None:
    """Let the cluster forget what it made for a picture, now and not when somebody collects garbage."""
    job.scene = None
    job.bands.clear()


def _take_over(band: Band, joined: Future, _: object = None) -> None:
    """Let what a pass has come to stand for all before it."""
    band.parts = [joined]


def _checked(client: object) -> Client:
    """Return a client that can be waited for.

    Raises
    ------
    SceneError
        If it is none.
    """
    try:
        from distributed import Client  # noqa: PLC0415 # nobody else needs it
    except ImportError as error:
        help = "python -m pip install distributed"
        raise SceneError([("client", f"Dask is not installed: {error}", help)]) from None
    if not isinstance(client, Client):
        help = "like distributed.Client(), which starts a cluster of this machine's processors"
        raise SceneError([("client", f"expected a client of Dask, read {client!r}", help)])
    if client.status != "running":
        raise SceneError([("client", f"the client is {client.status}", "make another one")])
    if client.asynchronous:
        raise SceneError(
            [("client", "an asynchronous client cannot be waited for", "use one without asynchronous=True")]
        )
    return client


def _failed(error: BaseException | None) -> BaseException:
    """Return what is said of a task that failed."""
    from distributed import KilledWorker  # noqa: PLC0415 # it is there

    if isinstance(error, SnellError):
        return error
    if isinstance(error, KilledWorker):
        message = (
            f"a task was given up: it has ended {error.allowed_failures + 1} workers, the last one {error.last_worker}"
        )
        help = "most often their memory was full, which their logs say: give them more, or fewer threads"
        return RenderError([(None, message, help)])
    is_other = isinstance(error, ImportError | AttributeError)
    help_of_version = "all workers need Snell, and the same version of it" if is_other else None
    return RenderError([(None, f"a task failed: {type(error).__name__}: {error}", help_of_version)])
