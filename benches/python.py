"""What Python adds to a render: ``python benches/python.py``, the package installed, the command in ``SNELL``.

Prints how long the lecture's picture takes by the command line's own clock, from Python, in the slow tracer of the
tests (NumPy, all rays of a generation at a time), and in the tracer that the first notebook writes down as the
lecture does: a function that calls itself for each ray.
"""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import snell

ROOT = Path(__file__).resolve().parents[1]
SNELL = os.environ.get("SNELL", str(ROOT / "target" / "ci" / "snell"))
TIMES = 25


def best(times: int, run: Callable[[], object]) -> float:
    """Return the shortest time in seconds."""
    taken = []
    for _ in range(times):
        started = time.perf_counter()
        run()
        taken.append(time.perf_counter() - started)
    return min(taken)


def command(folder: str) -> float:
    """Return the render time that the command line says, in seconds."""
    arguments = [SNELL, "render", "lecture/default", "--progress", "json", "-o", f"{folder}/film.npy"]
    said = subprocess.run(arguments, capture_output=True, text=True, check=True).stderr
    return float(json.loads(said.splitlines()[-1])["seconds"])


def oracle() -> float:
    """Return the time of the plain-Python tracer, once: NumPy, all rays of a generation at a time."""
    sys.path.insert(0, str(ROOT / "tests"))
    import tomllib  # noqa: PLC0415 # from 3.11 on, and only here
    from lecture_oracle import Tracer  # type: ignore[import-not-found] # noqa: PLC0415

    scene = tomllib.loads((ROOT / "scenes" / "lecture" / "default.toml").read_text())
    return best(1, lambda: Tracer(scene).picture(512, 512))


def notebook() -> float:
    """Return the time of the first notebook's tracer for 512 x 512 pixels, as 16 times that for a sixteenth of them."""
    path = ROOT / "docs" / "notebooks" / "1-the-lecture-retold.ipynb"
    cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
    functions: dict[str, Any] = {"np": np}
    for source in ("".join(cell["source"]) for cell in cells):
        if "draw(scene, 32)" in source:  # all that it needs is defined above
            break
        defined: list[ast.stmt] = [node for node in ast.parse(source).body if isinstance(node, ast.FunctionDef)]
        exec(compile(ast.Module(defined, []), path.name, "exec"), functions)
    scene = snell.scenes["lecture/default"]
    return 16 * best(1, lambda: functions["draw"](scene, 128))


def main() -> None:
    """Measure and print."""
    scene = snell.scenes["lecture/default"]
    scene.render()
    with TemporaryDirectory() as folder:
        by_command = min(command(folder) for _ in range(TIMES))
    by_python = best(TIMES, scene.render)
    own = min(scene.render().seconds for _ in range(TIMES))
    by_oracle = oracle()
    print(f"command line, its own render time   {1e3 * by_command:9.2f} ms")
    print(f"Python, scene.render()              {1e3 * by_python:9.2f} ms   of which rendering {1e3 * own:.2f} ms")
    print(f"Python adds                         {1e3 * (by_python - by_command):9.2f} ms")
    print(f"NumPy, a generation at a time       {1e3 * by_oracle:9.0f} ms   {by_oracle / by_python:.0f} times as long")
    by_notebook = notebook()
    print(
        f"the notebook, one ray at a time     {1e3 * by_notebook:9.0f} ms   {by_notebook / by_python:.0f} times as long"
    )


if __name__ == "__main__":
    main()
