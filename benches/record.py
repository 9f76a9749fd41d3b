"""What the runners have in common: programs that take turns, the machine, and the file that keeps results.

`docs/performance.json` has a section for each runner, with its date, machine and command; `report.py` makes the page of
it.
"""

from __future__ import annotations

import json
import os
import platform
import resource
import shlex
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "docs" / "performance.json"
WORKER = ROOT / "target" / "ci" / "bench-worker"
SCRATCH = ROOT / "target" / "bench"

Answer = dict[str, float]


class Worker:
    """A program that stays alive, reads a line and answers with a line of JSON."""

    def __init__(self, *command: str | Path) -> None:
        self.command = [str(part) for part in command]
        self.process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def ask(self, line: str) -> Answer:
        assert self.process.stdin and self.process.stdout
        print(line, file=self.process.stdin, flush=True)
        said = self.process.stdout.readline()
        answer = json.loads(said) if said else {"error": f"{self.command[0]} ended at `{line}`"}
        if "error" in answer:
            raise RuntimeError(answer["error"])
        return answer

    def close(self) -> None:
        assert self.process.stdin
        self.process.stdin.close()
        self.process.wait()


def busy_and_all() -> tuple[float, float]:
    """Seconds that the machine's cores have worked, and have been there, since it started."""
    fields = [int(v) for v in Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:9]]
    ticks = os.sysconf("SC_CLK_TCK")
    return (sum(fields) - fields[3] - fields[4]) / ticks, sum(fields) / ticks


def quiet(limit: float = 1.0) -> None:
    """Waits until other jobs leave the machine nearly idle, at most `limit` seconds."""
    end = time.monotonic() + limit
    while time.monotonic() < end:
        before = busy_and_all()
        time.sleep(0.1)
        after = busy_and_all()
        if after[0] - before[0] < 0.1 * (after[1] - before[1]):
            return


class Others:
    """How much of the machine other jobs took meanwhile. Ask when all children have ended."""

    def __init__(self) -> None:
        self.start, self.own_start = busy_and_all(), self.own()

    @staticmethod
    def own() -> float:
        usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        return sum(usage.ru_utime + usage.ru_stime for usage in usages)

    def cores(self) -> float:
        """Cores that they kept busy, on average."""
        (busy, there), own = busy_and_all(), self.own() - self.own_start
        wall = (there - self.start[1]) / (os.cpu_count() or 1)
        return max(0.0, busy - self.start[0] - own) / wall


def cpu_model() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith(("model name", "Model")):
            return line.split(":", 1)[1].strip()
    return platform.machine()


def output_of(*command: str) -> str:
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout.strip()


def origin() -> dict[str, str]:
    """When, where and by which command."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    changed = output_of("git", "status", "--porcelain", "--", "crates", "benches", "Cargo.lock")
    return {
        "date": time.strftime("%Y-%m-%d"),
        "machine": f"{cpu_model()}, {os.cpu_count()} cores, {memory:.0f} GiB, {platform.system()} {platform.release()}",
        "snell": output_of("git", "rev-parse", "--short", "HEAD") + (" with changes" if changed else ""),
        "rustc": output_of("rustc", "--version"),
        "command": os.environ.get("BENCH_COMMAND") or shlex.join(["python3", *sys.argv]),
    }


def results() -> dict:
    return json.loads(RESULTS.read_text()) if RESULTS.exists() else {}


def save(section: str, content: dict) -> None:
    """Replaces one section of the results."""
    RESULTS.write_text(json.dumps(results() | {section: content}, indent=1, sort_keys=True) + "\n")
