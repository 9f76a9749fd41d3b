"""Counts instructions with valgrind's callgrind, next to the committed baseline:   python3 benches/counts.py

`BASELINE=1` makes what was counted the new baseline; `ONLY=gallery` counts only commands with this text in them;
`LIMIT=3` fails where a count has grown by more than 3 % (without it, no count is a failure).
"""

from __future__ import annotations

import json
import os
import platform
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

from record import ROOT, WORKER, origin, output_of

RUNNER = WORKER.with_name("bench-counts")
BASELINE = ROOT / "benches" / "counts.json"
# While this function of the runner is running; names of Rust have a hash behind them.
CALLGRIND = ["--tool=callgrind", "--toggle-collect=*count_instructions_of*", "--callgrind-out-file=/dev/null"]


def valgrind(*arguments: str) -> subprocess.CompletedProcess[str]:
    done = subprocess.run(["valgrind", *arguments], capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"valgrind {' '.join(arguments)}\nended with {done.returncode}:\n{done.stderr}")
    return done


def commands() -> list[str]:
    """What the runner can do with the instructions that valgrind knows."""
    return valgrind("--quiet", "--tool=none", str(RUNNER)).stdout.splitlines()


def count(command: str) -> int:
    said = valgrind(*CALLGRIND, str(RUNNER), *command.split()).stderr
    collected = re.search(r"Collected *: *(\d+)", said)
    if not collected or collected[1] == "0":
        sys.exit(f"callgrind counted nothing for `{command}`: has `count_instructions_of` been inlined?\n{said}")
    return int(collected[1])


def about() -> dict[str, str]:
    """What counts depend on."""
    one_of_a_kind = {"x86_64": "1 lane: scalar, 2: SSE2, 4: AVX2", "aarch64": "1 lane: scalar, 2: NEON"}
    instructions = one_of_a_kind.get(platform.machine(), platform.machine())
    libc = " ".join(platform.libc_ver())
    return origin() | {"instructions": instructions, "libc": libc, "valgrind": output_of("valgrind", "--version")}


def table(counts: dict[str, int], baseline: dict[str, int]) -> str:
    lines = [f"{'':26}{'instructions':>15}{'baseline':>15}{'change':>10}"]
    for command, now in counts.items():
        then = baseline.get(command)
        compared = f"{then:15,}{100 * (now / then - 1):+8.2f} %" if then else f"{'none':>15}"
        lines.append(f"{command:26}{now:15,}{compared}")
    return "\n".join(lines)


def main() -> None:
    only, limit = os.environ.get("ONLY", ""), os.environ.get("LIMIT")
    renew = bool(os.environ.get("BASELINE"))
    if renew and only:
        sys.exit("BASELINE counts everything: leave ONLY out")
    asked = [command for command in commands() if only in command]
    if not asked:
        sys.exit(f"no command has `{only}` in it; `{RUNNER.relative_to(ROOT)}` lists them")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        counts = dict(zip(asked, pool.map(count, asked)))

    saved = json.loads(BASELINE.read_text()) if BASELINE.exists() else {"about": {}, "counts": {}}
    now, then, baseline = about(), saved["about"], saved["counts"]
    print(table(counts, baseline))
    for key in ["rustc", "instructions", "libc", "valgrind"]:
        if then and now[key] != then[key]:
            print(f"Not comparable: {key} is {now[key]}, and was {then[key]} for the baseline.", file=sys.stderr)
    if renew:
        BASELINE.write_text(json.dumps({"about": now, "counts": counts}, indent=1) + "\n")
        print(f"Saved as {BASELINE.relative_to(ROOT)}.")
    elif limit:
        grown = [c for c, n in counts.items() if c in baseline and n > baseline[c] * (1 + float(limit) / 100)]
        if grown:
            sys.exit(f"Grown by more than {limit} %: {', '.join(grown)}.")


if __name__ == "__main__":
    main()
