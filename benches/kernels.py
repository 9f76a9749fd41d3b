"""Keeps what criterion found and counts instructions where the machine can:   python3 benches/kernels.py

Reads `target/criterion`, and asks `perf` how many instructions the worker needs for a question asked once more.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys

from record import ROOT, WORKER, origin, save

CRITERION = ROOT / "target" / "criterion"
FRAMES = ["frame default 256 6 1", "frame flake:4 256 4 1"]
QUESTIONS = [*FRAMES, "build flake:5 1", "rays primary 1", "rays shadow 1", "rays bounce 1"]


def criterion() -> list[dict]:
    found = []
    for path in sorted(CRITERION.glob("**/new/estimates.json")):
        about = json.loads((path.parent / "benchmark.json").read_text())
        median = json.loads(path.read_text())["median"]
        interval = median["confidence_interval"]
        found.append({
            "name": about["full_id"],
            "nanoseconds": median["point_estimate"],
            "interval": [interval["lower_bound"], interval["upper_bound"]],
            "elements": (about.get("throughput") or {}).get("Elements"),
        })
    return found


def count(questions: list[str], event: str) -> int | None:
    """How often the event happens while the worker answers; nothing where the machine does not say."""
    command = ["perf", "stat", "-x", ",", "-e", event, WORKER]
    done = subprocess.run(command, input="".join(f"{q}\n" for q in questions), capture_output=True, text=True)
    for line in done.stderr.splitlines():
        value, _, name = line.split(",")[:3] if line.count(",") > 2 else ("", "", "")
        if name == event and value.isdigit():
            return int(value)
    return None


def instructions(event: str = "instructions:u") -> dict[str, int] | str:
    """Instructions of each question, the second time: preparing is not counted. Or why there are none."""
    if not shutil.which("perf"):
        return "`perf` is not installed"
    counts = {}
    for question in QUESTIONS:
        once, thrice = count([question], event), count([question] * 3, event)
        if once is None or thrice is None:
            return f"this machine does not count `{event}`"
        counts[question] = (thrice - once) // 2
    return counts


def main() -> None:
    counted = instructions(*sys.argv[1:])
    if isinstance(counted, str):
        print(f"No instructions are counted: {counted}.", file=sys.stderr)
    save("kernels", origin() | {"criterion": criterion(), "instructions": counted})


if __name__ == "__main__":
    main()
