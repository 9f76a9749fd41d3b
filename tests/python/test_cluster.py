"""Parts of pictures, and pictures of a Dask cluster: always the bits of one process, whatever happens to workers."""

from __future__ import annotations

import importlib.util
import os
import pickle
import random
import signal
import subprocess
import sys
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import cluster_work
import dask
import numpy as np
import pytest
from distributed import Client, LocalCluster

import snell
from snell.cluster import plan
from snell.cluster.engine import Cluster, Engine, Job

ROOT = Path(__file__).resolve().parents[2]
#: Glass on glass with lost light, in an odd size, which no number of bands divides.
HOW: dict[str, Any] = {"width": 61, "height": 43, "spp": 21, "depth": 3}


def scene() -> snell.Scene:
    return snell.scenes["gallery/bubbles"]


def same(one: snell.Picture, other: snell.Picture) -> bool:
    """Are all numbers the same, and what they took?"""
    told = [picture._native.warnings() for picture in (one, other)]
    return np.array_equal(one.array, other.array) and one.rays == other.rays and told[0] == told[1]


@pytest.fixture(scope="module")
def whole() -> snell.Picture:
    return scene().render(progress=False, **HOW)


@pytest.fixture(scope="module", params=[1, 2])
def client(request: pytest.FixtureRequest) -> Iterator[Any]:
    """A cluster of one worker with two threads, and one of two with one each."""
    threads = 3 - request.param
    cluster = LocalCluster(n_workers=request.param, threads_per_worker=threads, dashboard_address=":0")
    with cluster, Client(cluster) as client:
        yield client


def test_parts_make_the_picture_in_any_order_and_as_trees(whole: snell.Picture) -> None:
    cuts = [((0, 17), (0, 8)), ((17, 43), (0, 21)), ((0, 9), (8, 21)), ((9, 17), (13, 21)), ((9, 17), (8, 13))]
    parts = [scene().render_part(rows=rows, samples=samples, progress=False, **HOW) for rows, samples in cuts]
    assert same(scene().merge(parts), whole)
    assert same(scene().merge(parts[::-1]), whole)
    sent = [pickle.loads(pickle.dumps(part)) for part in parts]
    tree = snell.Part.join([snell.Part.join(sent[:2]), snell.Part.join(sent[2:])])
    assert same(scene().merge([pickle.loads(pickle.dumps(tree))]), whole)
    assert repr(parts[0]) == "<Part: rows 0 to 16, samples 0 to 7>"
    assert parts[0].rays > 0 and parts[0].seconds > 0


def test_a_part_of_the_picture_is_in_parts_too() -> None:
    how = {**HOW, "crop": (5, 6, 30, 20)}
    parts = [scene().render_part(rows=rows, progress=False, **how) for rows in ((6, 11), (11, 26))]
    assert same(scene().merge(parts), scene().render(progress=False, **how))


def test_what_does_not_make_the_picture_is_named() -> None:
    def part(**what: Any) -> snell.Part:
        return scene().render_part(progress=False, **{**HOW, **what})

    upper = part(rows=(0, 20))
    with pytest.raises(snell.PictureError, match=r"missing: rows 20 to 42, columns 0 to 60, samples 0 to 20"):
        scene().merge([upper])
    with pytest.raises(snell.PictureError, match="the samples 4 to 7 are there twice"):
        scene().merge([upper, part(rows=(19, 30), samples=(4, 8))])
    with pytest.raises(snell.PictureError, match="of another scene, or made with other settings"):
        scene().with_("material.water.eta", 1.5).merge([upper])
    with pytest.raises(snell.PictureError, match="different pictures"):
        snell.Part.join([upper, part(rows=(20, 43), depth=2)])
    for nothing in ([], [None], None, "parts"):
        with pytest.raises(snell.PictureError):
            scene().merge(nothing)  # type: ignore[arg-type]
    wrong: dict[str, dict[str, Any]] = {
        "rows": {"rows": (0, 44)},
        "samples": {"samples": (20, 22)},
        "crop": {"crop": (60, 0, 2, 2)},
    }
    for place, what in wrong.items():
        with pytest.raises(snell.SceneError) as caught:
            part(**what)
        assert caught.value.place == place
    for rows in ((3, 3), (4, 3), (1,), 5, (-1, 2), (0, 1 << 40), "ab"):
        with pytest.raises(snell.SceneError, match="rows"):
            part(rows=rows)


def test_numbers_that_lie_anywhere_are_read(whole: snell.Picture) -> None:
    """Dask hands over arrays at any address (pickle's protocol 5, out of band), which processors need not read."""

    def moved(buffer: pickle.PickleBuffer) -> memoryview:
        raw = buffer.raw()
        return memoryview(b"x" + raw.tobytes())[1:]

    triangle = snell.Mesh(np.eye(3), np.array([(0, 1, 2)]), "water", open="opaque")
    part = scene().render_part(progress=False, **HOW)
    for value in (whole, part, scene().replace(meshes=[triangle])):
        buffers: list[pickle.PickleBuffer] = []
        text = pickle.dumps(value, protocol=5, buffer_callback=buffers.append)
        assert buffers, "the numbers go beside the text"
        back = pickle.loads(text, buffers=[moved(buffer) for buffer in buffers])
        if isinstance(back, snell.Scene):
            assert back == value and back.render(progress=False, **HOW).finished
        else:
            assert same(back if isinstance(back, snell.Picture) else scene().merge([back]), whole)


def test_a_part_that_was_tampered_with_is_refused() -> None:
    native = scene().render_part(rows=(0, 4), progress=False, **HOW)._native
    (state,) = native.__getnewargs__()
    for change in (
        {"sums": state["sums"][:-1]},
        {"lost": state["lost"][:-1]},
        {"spp": 0},
        {"size": (0, 0)},
        {"crop": (0, 0, 1 << 31, 1 << 31)},
        {"pieces": [((0, 0, 61, 5), [(0, 21)])]},
        {"pieces": [((0, 0, 61, 4), [(3, 2)])]},
        {"statistics": "{}"},
    ):
        with pytest.raises(snell.PictureError):
            type(native)({**state, **change})


@pytest.mark.parametrize("task_seconds", [4, 0.02, 0.002])
def test_a_cluster_makes_the_same_picture(client: Any, whole: snell.Picture, task_seconds: float) -> None:
    seen: list[tuple[int, int, int]] = []
    picture = scene().render(client=client, task_seconds=task_seconds, progress=lambda *now: seen.append(now), **HOW)
    assert same(picture, whole)
    assert seen == sorted(seen) and seen[-1] == (61 * 43, 61 * 43, whole.rays)


@pytest.mark.parametrize("spp", [1, 2])
def test_few_samples_and_a_part_of_the_picture(client: Any, spp: int) -> None:
    how = {**HOW, "spp": spp, "crop": (3, 40, 50, 3)}
    assert same(scene().render(client=client, progress=False, **how), scene().render(progress=False, **how))


def test_one_worker_is_killed_and_one_comes_late(whole: snell.Picture) -> None:
    with (
        # So long Dask waits for an answer of the dead, sometimes.
        dask.config.set({"distributed.comm.timeouts.connect": "3s"}),
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
        Client(cluster) as client,
    ):
        victims = dict(client.run(os.getpid))
        killed: list[float] = []

        first = set(victims)

        def progress(pixels: int, total: int, rays: int) -> None:
            del rays
            if not killed and pixels > total * random.random():
                killed.append(pixels / total)
                cluster.scale(3)
                os.kill(random.choice(list(victims.values())), signal.SIGKILL)

        for _ in range(int(os.environ.get("SNELL_SOAK_KILLS", "1"))):
            killed.clear()
            victims = dict(client.run(os.getpid))
            picture = scene().render(client=client, task_seconds=0.05, progress=progress, **HOW)
            assert same(picture, whole)
            assert killed and killed[0] < 1, "it was killed before the end"
        client.wait_for_workers(3, timeout=30)
        late = set(client.run(os.getpid)) - first
        assert late, "somebody came late"
        assert same(scene().render(client=client, task_seconds=0.05, progress=False, **HOW), whole)


def test_stopped_it_is_the_picture_so_far(client: Any, whole: snell.Picture) -> None:
    def progress(pixels: int, total: int, rays: int) -> None:
        del rays
        if pixels > total / 2:
            signal.raise_signal(signal.SIGINT)

    with pytest.warns(snell.SnellWarning, match="stopped"):
        picture = scene().render(client=client, task_seconds=0.02, progress=progress, **HOW)
    assert not picture.finished and picture.array.any()
    assert picture.array.shape == whole.array.shape and not np.array_equal(picture.array, whole.array)
    # More than half of the samples are there, the first ones of all rows among them: what is missing is noise, of which
    # the mean of a picture has little. A black band would be a quarter of it: there are four.
    assert abs(picture.array.mean() / whole.array.mean() - 1) < 0.1, "what is there is shown"
    # Nothing is left behind, and it goes on.
    deadline = time.monotonic() + 20
    while client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert client.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)) == 0
    assert same(scene().render(client=client, progress=False, **HOW), whole)


def test_a_client_stays_usable_however_often_it_is_stopped() -> None:
    """In a cluster that is not the default one, as in a notebook with two; stopped while it waits for workers, too."""
    with (
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
        Client(cluster, set_as_default=False) as client,
    ):
        mine = client.submit(sum, [1, 2, 3])
        # One that falls into a destructor Python swallows: then it is some seconds until the picture is done.
        for stop in range(12):
            timer = threading.Timer(0.01 + 0.02 * stop, signal.raise_signal, [signal.SIGINT])
            timer.start()
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore")
                    scene().render(client=client, task_seconds=0.01, progress=False, **{**HOW, "spp": 400})
            except KeyboardInterrupt:  # before there was anything to return
                pass
            timer.join()
        assert mine.result(timeout=10) == 6, "futures of others are let alone"
        cluster.scale(0)
        while client.nthreads():
            time.sleep(0.05)
        timer = threading.Timer(1, signal.raise_signal, [signal.SIGINT])
        timer.start()
        with pytest.warns(snell.SnellWarning, match="stopped"):
            assert not scene().render(client=client, progress=False, **HOW).finished
        cluster.scale(1)
        assert scene().render(client=client, progress=False, **HOW).finished


def test_frames_of_a_cluster_are_those_of_one_process(client: Any, tmp_path: Path) -> None:
    values = {"material.water.eta": [1.1, 1.2, 1.3, 1.4, 1.5]}
    how = {**HOW, "spp": 3}
    here = snell.sweep(scene(), values, tmp_path / "here", progress=False, **how)
    seen: list[tuple[int, int, int]] = []
    there = snell.sweep(scene(), values, tmp_path / "there", client=client, progress=lambda *n: seen.append(n), **how)
    assert [a.read_bytes() for a in here] == [b.read_bytes() for b in there] and len(there) == 5
    assert seen[-1][0] == seen[-1][1] == 5 * 61 * 43
    times = [frame.stat().st_mtime_ns for frame in there]
    again = snell.sweep(scene(), values, tmp_path / "there", client=client, progress=False, **how)
    assert [frame.stat().st_mtime_ns for frame in again] == times, "nothing is drawn twice"


def test_what_is_no_cluster_is_refused(client: Any) -> None:
    def refused(place: str, **what: Any) -> None:
        with pytest.raises(snell.SceneError) as caught:
            scene().render(progress=False, **{**HOW, **what})
        assert caught.value.place == place

    refused("client", client="tcp://127.0.0.1:8786")
    refused("client", client=Client.current)
    refused("threads", client=client, threads=2)
    for seconds in (0, -1, float("nan"), float("inf"), "4"):
        refused("task_seconds", client=client, task_seconds=seconds)
    refused("crop", client=client, crop=(0, 0, 62, 1))


def _job() -> Job:
    return Job(scene()._compiled(HOW))


@pytest.mark.parametrize(
    "work, message",
    [
        (cluster_work.Deadly(0), "given up.*ended 1 workers"),
        (cluster_work.Greedy(0), "given up.*ended 1 workers"),
        (cluster_work.Failing(0), "a task failed: ModuleNotFoundError"),
    ],
)
def test_a_task_that_cannot_be_done_ends_with_its_reason(work: Any, message: str) -> None:
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 0}),
        LocalCluster(n_workers=1, threads_per_worker=1, memory_limit="700MB", dashboard_address=":0") as cluster,
        Client(cluster) as client,
    ):
        engine = Engine(Cluster(client, 1.0), work=work)
        with pytest.raises(snell.RenderError, match=message) as caught:
            list(engine.finished([_job()]))
        assert caught.value.help


def test_a_cluster_that_is_restarted_says_so() -> None:
    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=":0") as cluster, Client(cluster) as client:
        other = Client(cluster)
        timer = threading.Timer(1.5, other.restart)
        engine = Engine(Cluster(client, 0.2), work=cluster_work.Work(0.02))
        timer.start()
        with pytest.raises(snell.RenderError, match="let go of a task"):
            list(engine.finished([_job()]))
        timer.join()
        other.close()


def test_the_recipe_of_the_documentation_is_run_as_it_stands_there(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "scale.md").read_text()
    recipe = page[page.index("With Dask, on the processors of this machine") :].split("```python\n")[1].split("```")[0]
    (tmp_path / "recipe.py").write_text(recipe)
    subprocess.run([sys.executable, "recipe.py"], cwd=tmp_path, check=True, timeout=120, capture_output=True)
    snell.scenes["gallery/ball"].render(width=320, spp=64, progress=False).save(tmp_path / "here.exr")
    assert (tmp_path / "ball.exr").read_bytes() == (tmp_path / "here.exr").read_bytes()


def test_plans_have_each_sample_once() -> None:
    for first, end, most in [(0, 1, 9), (1, 64, 0.1), (5, 37, 9.7), (0, 65536, 1e12), (3, 100, 1), (7, 8, 4)]:
        chunks = plan.chunks((first, end), most)
        assert [sample for chunk in chunks for sample in range(*chunk)] == list(range(first, end))
        assert all(b - a <= max(1.5 * most, 1) for a, b in chunks), "√2 times what was asked for, at most"
        passes = plan.passes((first, end), most)
        assert [sample for each in passes for sample in range(*each)] == list(range(first, end))
        assert all(b & (b - 1) == 0 for _, b in passes[:-1]) and all(b - a >= most for a, b in passes[:-1])
    for count in (1, 3, 10, 99):
        bands = plan.bands(4, 14, count)
        assert [row for band in bands for row in range(*band)] == list(range(4, 14)) and len(bands) == min(count, 10)


def measure(client: Any, work: Any, job: Job, task_seconds: float) -> tuple[float, int, list[int]]:
    """Return seconds of a run, how many tasks it had, and how many samples were done whenever somebody looked."""
    looks: list[int] = []
    engine = Engine(Cluster(client, task_seconds), lambda: looks.append(job.samples_done), work)
    started = time.monotonic()
    (done,) = engine.finished([job])
    seconds = time.monotonic() - started
    cells = [cell for part in done.parts for cell in part.cells]  # type: ignore[attr-defined]
    width, height = done.world.size
    assert len(cells) == len(set(cells)) == height * done.world.spp and done.samples_done == width * len(cells)
    return seconds, engine.tasks, looks


def test_tasks_take_the_time_that_they_should(client: Callable[..., Any]) -> None:
    """43 rows of 21 samples of 5 ms: 4.5 seconds of work, on two threads, in tasks of 0.3 s at most."""
    seconds, tasks, looks = measure(client, cluster_work.Work(0.005), _job(), 0.3)
    assert looks == sorted(looks)
    # Twice as long as the work alone: the machine may be busy.
    assert seconds < 2 * (43 * 21 * 0.005 / 2) + 1, f"{tasks} tasks in {seconds:.1f} s"
    # Four bands, each with some trials and joins, and 23 tasks of 0.2 s, the shortest: far from one for each of the 903
    # samples of a row.
    assert tasks < 200


def test_a_plan_for_many_workers_is_what_they_take() -> None:
    """The same with 200 workers is `python benches/cluster.py --simulate 200`, which takes a minute."""
    spec = importlib.util.spec_from_file_location("snell_plan", ROOT / "benches" / "cluster.py")
    assert spec and spec.loader
    sys.modules[spec.name] = bench = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(bench)
    taken, said = bench.simulate(20, task_seconds=0.3, seconds=2.0)
    # Half as long again and a second: this machine may be busy.
    assert said.rendering <= taken < 1.5 * said.seconds + 1, f"{taken:.1f} s, predicted {said}"
    known = bench.Constants(1e-6, 1e-3, 3e8, 3e8)
    times = [bench.predict((8192**2, 4096), threads, known, 1e8) for threads in (10, 100, 1000, 10_000)]
    # 275 000 s of rays; a task takes 1 ms, so that 10 000 threads wait for the scheduler.
    assert [each.limit for each in times] == ["rays", "rays", "rays", "scheduler"]
    # Ten times the threads, less what the last tasks and the network take.
    assert times[0].seconds > 5 * times[1].seconds > 25 * times[2].seconds
