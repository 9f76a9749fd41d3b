"""What a cluster takes, and where its limit is: ``python benches/cluster.py``, ``pip install '.[cluster]'`` done.

Measures what Dask and parts cost on this machine, and prints from that what a large picture takes on 10, 100 and 1000
threads. ``--simulate 200`` checks the model: that many workers of the real scheduler, with tasks that only wait.
``--overhead 5`` compares pictures of a cluster of two workers with those of two threads, so many times in turns.
"""

from __future__ import annotations

import argparse
import math
import pickle
import statistics
import time
from dataclasses import dataclass
from typing import Any

import dask
from distributed import Client, LocalCluster, as_completed

import snell
from snell.cluster.engine import Cluster, Engine, Job

#: Bands of rows for each thread, and tasks that each takes besides: two trials, what they cost, a join for each pass.
BANDS, TASKS_OF_BAND = 1, 8
#: Tasks of Dask for one that renders: itself, and its share of joins of eight and of those above.
TASKS_OF_ONE = 1 + 1 / 7
#: Bytes of a pixel in a part: three sums, and what was lost.
BYTES = 32


@dataclass
class Constants:
    """What was measured."""

    #: Seconds for a sample of a pixel, on one thread.
    sample: float
    #: Seconds that the scheduler and the client take for a task, in which they do nothing else.
    task: float
    #: Bytes of parts in a second: joined, and pickled and read again.
    join: float
    pickle: float


@dataclass
class Prediction:
    """What a picture takes."""

    task_seconds: float
    tasks: float
    #: Seconds: until all have work; all that is rendered, shared out; all that the scheduler does; what comes to the
    #: client; the last tasks.
    beginning: float
    rendering: float
    scheduling: float
    collecting: float
    tail: float

    @property
    def seconds(self) -> float:
        """Rendering and scheduling go on at the same time once all have work; the slower one counts."""
        return max(self.beginning + self.rendering, self.scheduling) + self.collecting + self.tail

    @property
    def limit(self) -> str:
        """Say what takes longest."""
        parts = {"rays": self.rendering, "scheduler": self.scheduling, "network": self.collecting}
        return max(parts, key=lambda name: parts[name])


def predict(
    samples: tuple[float, int], threads: int, known: Constants, network: float, task_seconds: float | None = None
) -> Prediction:
    """Return what a picture of so many pixels and samples takes on so many threads.

    `network` is in bytes a second, into the client.

    A task should take so long that the scheduler is busy for at most a third of the time, and at least four seconds.
    """
    pixels, spp = samples
    work = pixels * spp * known.sample
    task_seconds = task_seconds or max(4.0, 3 * threads * TASKS_OF_ONE * known.task)
    bands = BANDS * threads
    renders = max(work / task_seconds, bands)
    tasks = renders * TASKS_OF_ONE + bands * TASKS_OF_BAND
    # A join reads and writes each part once, and most of them come from another worker.
    joining = renders * pixels / bands * BYTES * (1 / known.join + 2 / known.pickle)
    return Prediction(
        task_seconds=task_seconds,
        tasks=tasks,
        beginning=bands * TASKS_OF_BAND * known.task,
        rendering=(work + joining) / threads,
        scheduling=tasks * known.task,
        collecting=pixels * BYTES * (1 / network + 1 / known.pickle),
        tail=min(task_seconds, work / threads),
    )


def seconds_of_a_task(client: Any, count: int = 2000) -> float:
    """Return what Dask takes for a task that does nothing, among many."""
    started = time.perf_counter()
    futures = [client.submit(abs, number, key=f"nothing-{started}-{number}") for number in range(count)]
    for _ in as_completed(futures):
        pass
    return (time.perf_counter() - started) / count


def measured(client: Any, scene: snell.Scene) -> Constants:
    """Measure what a table needs."""
    halves = [
        scene.render_part(rows=rows, width=1024, height=1024, spp=2, threads=1, progress=False)
        for rows in ((0, 512), (512, 1024))
    ]
    size = 1024 * 1024 * BYTES
    started = time.perf_counter()
    whole = snell.Part.join(halves)
    joined = time.perf_counter() - started
    started = time.perf_counter()
    pickle.loads(pickle.dumps(whole, protocol=5))
    pickled = time.perf_counter() - started
    sample = sum(part.seconds for part in halves) / (2 * 1024 * 1024)
    return Constants(sample, seconds_of_a_task(client), size / joined, size / pickled)


def table(known: Constants, network: float, size: int = 8192, spp: int = 4096) -> str:
    """Return what a picture takes on more and more threads, in Markdown."""
    lines = [
        "| threads | seconds of a task | tasks | rays | scheduler | into the client | all | limit |",
        "| ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- |",
    ]
    for threads in (10, 100, 1000, 10_000):
        said = predict((size * size, spp), threads, known, network)
        times = (said.rendering, said.scheduling, said.collecting, said.seconds)
        shown = " | ".join(_time(seconds) for seconds in times)
        lines.append(f"| {threads} | {said.task_seconds:.0f} | {said.tasks:.3g} | {shown} | {said.limit} |")
    return "\n".join(lines)


def _time(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.1f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


@dataclass
class Waited:
    """A part of a simulation: nothing but how many samples it has, and what they took."""

    samples: int
    seconds: float
    rays: int = 0


class Waiting:
    """What workers do in a simulation: each sample of a row takes so long, and needs no processor."""

    def __init__(self, seconds_of_row: float) -> None:
        self.seconds_of_row = seconds_of_row

    def load(self, pieces: list[bytes]) -> int:
        return sum(map(len, pieces))

    def render(self, scene: int, crop: object, rows: tuple[int, int], samples: tuple[int, int]) -> Waited:
        del scene, crop
        count = (rows[1] - rows[0]) * (samples[1] - samples[0])
        time.sleep(count * self.seconds_of_row)
        return Waited(count, count * self.seconds_of_row)

    def cost(self, part: Waited) -> tuple[float, int]:
        return part.seconds, part.rays

    def join(self, parts: list[Waited]) -> Waited:
        return Waited(sum(part.samples for part in parts), sum(part.seconds for part in parts))


def simulate(workers: int, task_seconds: float = 2.0, seconds: float = 20.0) -> tuple[float, Prediction]:
    """Return what a picture takes on so many workers that wait instead of rendering, and what was predicted.

    All of them, the scheduler and the client share one process, so that a task costs more than in a cluster; that cost
    is measured here, too.
    """
    size, spp = 4096, 1024
    scene = snell.scenes["lecture/default"]
    world = scene._compiled({"width": size, "height": size, "spp": spp})
    work = seconds * workers
    # What each worker does for itself, all day long, would be done by its own machine.
    quiet = {"distributed.worker.profile.enabled": False, "distributed.admin.system-monitor.interval": "20s"}
    with (
        dask.config.set(quiet),
        LocalCluster(
            n_workers=workers, threads_per_worker=1, processes=False, dashboard_address=":0", memory_limit=0
        ) as cluster,
        Client(cluster) as client,
    ):
        known = Constants(work / (size * size * spp), seconds_of_a_task(client, 20 * workers), math.inf, math.inf)
        job = Job(world)
        engine = Engine(Cluster(client, task_seconds), work=Waiting(work / (size * spp)))
        started = time.perf_counter()
        (done,) = engine.finished([job])
        taken = time.perf_counter() - started
        assert sum(part.samples for part in done.parts) == size * spp  # type: ignore[attr-defined]
    return taken, predict((size * size, spp), workers, known, math.inf, task_seconds)


def overhead(rounds: int) -> None:
    """Compare two workers with two threads on the same work, in turns."""
    scene = snell.scenes["gallery/ball"]
    how: dict[str, Any] = {"width": 900, "spp": 64, "progress": False}
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
        Client(cluster) as client,
    ):
        ratios = []
        for number in range(rounds + 1):
            started = time.perf_counter()
            plain = scene.render(threads=2, **how)
            middle = time.perf_counter()
            spread = scene.render(client=client, **how)
            ended = time.perf_counter()
            assert (plain.array == spread.array).all()
            if number:  # the first one starts everything
                ratios.append((ended - middle) / (middle - started))
                print(f"  {middle - started:.2f} s on two threads, {ended - middle:.2f} s on two workers", flush=True)
    print(f"Dask: {statistics.median(ratios):.3f} of the time, {min(ratios):.3f} to {max(ratios):.3f}")


def main() -> None:
    """Do what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--simulate", metavar="WORKERS", type=int, help="check the model with workers that wait")
    parser.add_argument("--overhead", metavar="ROUNDS", type=int, help="compare a cluster with threads, so many times")
    parser.add_argument("--scene", default="gallery/ball", help="what is rendered")
    parser.add_argument("--network", metavar="GBIT/S", type=float, default=1.0, help="of the client; by default 1")
    asked = parser.parse_args()
    if asked.simulate:
        taken, said = simulate(asked.simulate)
        print(
            f"{asked.simulate} workers: {taken:.1f} s, predicted {said.seconds:.1f} s: start {said.beginning:.1f} s, "
            f"rendering {said.rendering:.1f} s, scheduling {said.scheduling:.1f} s, {said.tasks:.0f} tasks"
        )
    if asked.overhead:
        overhead(asked.overhead)
    if not (asked.simulate or asked.overhead):
        with (
            LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
            Client(cluster) as client,
        ):
            known = measured(client, snell.scenes[asked.scene])
        print(
            f"{asked.scene}: {known.sample * 1e9:.0f} ns for a sample on one thread; a task of Dask "
            f"{known.task * 1e3:.2f} ms; parts of {BYTES} bytes a pixel are joined at {known.join / 1e6:.0f} MB/s, "
            f"pickled and read at {known.pickle / 1e6:.0f} MB/s\n\n"
            f"8192 x 8192 pixels with 4096 samples, {asked.network:g} Gbit/s:\n"
        )
        print(table(known, asked.network * 1e9 / 8))


if __name__ == "__main__":
    main()
