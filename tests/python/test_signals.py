"""^C gives control back within a second, with the picture so far; and other threads run meanwhile."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
import time

import pytest

import snell

SCRIPT = """
import time, warnings, snell
warnings.simplefilter("ignore")
scene = snell.scenes["gallery/brilliant"]
print("ready", flush=True)
picture = scene.render(width=2000, spp=64)
print("back", flush=True)
print(picture.finished, picture.array.shape[1], picture.array.max() > 0)
"""


SEARCHES = """
import snell
scene = snell.scenes["gallery/brilliant"].with_("render.spp", 64)
large = scene.render(width=600, spp=1)
print("ready", flush=True)
try:
    {search}
except KeyboardInterrupt:
    print("back", flush=True)
    print("stopped", flush=True)
"""


@pytest.mark.parametrize(
    ("script", "after", "then"),
    [
        (SCRIPT, 1.5, "False 2000 True"),
        # Sooner: on a machine of many cores they take a second or two in all.
        (SEARCHES.format(search='scene.find("diamond")'), 0.3, "stopped"),
        (SEARCHES.format(search="large.channels.hits"), 0.3, "stopped"),
    ],
    ids=["render", "find", "hits"],
)
def test_interrupted_within_a_second(script: str, after: float, then: str) -> None:
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        time.sleep(after)
        process.send_signal(signal.SIGINT)
        started = time.monotonic()
        assert process.stdout.readline() == "back\n"
        waited = time.monotonic() - started
        assert process.stdout.readline() == f"{then}\n"
    assert waited < 1, f"{waited:.2f} s"
    assert process.returncode == 0


def test_other_threads_run_while_it_renders() -> None:
    scene = snell.scenes["gallery/brilliant"]
    over = threading.Event()

    def render() -> None:
        scene.render(width=200, threads=1)
        over.set()

    thread = threading.Thread(target=render)
    thread.start()
    ticks = 0
    while not over.wait(0.001):
        ticks += 1
    thread.join()
    assert ticks > 5
