"""What several tests need."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

ROOT = Path(__file__).resolve().parents[2]
SNELL = os.environ.get("SNELL", str(ROOT / "target" / "ci" / "snell"))

#: As typed on the slide.
CELL = """
cam1 = Camera((50,50,100),(50,50,10),(0,1,0),(-2.0,2.0,-2.0,2.0),-5,-100,8,8)
cam2 = copy(cam1);
cam2.width = 512
cam2.height = 512
mats = [Material((0.2, 0.2, 0.2),(0.6, 0.6, 0.6),(0.5, 0.5, 0.5),(0.9, 0.9, 0.9),(0.5, 0.5, 0.5), 64, 2.0),
        Material((1.0, 0.0, 0.0),(1.0, 0.0, 0.0),(1.0, 1.0, 1.0),(0.9, 0.9, 0.9),(1.0, 1.0, 1.0), 32, 1.3),
        Material((0.0, 1.0, 0.0),(0.0, 1.0, 0.0),(1.0, 1.0, 1.0),(0.9, 0.9, 0.9),(1.0, 1.0, 1.0), 32, 1.3),
        Material((0.0, 0.0, 1.0),(0.0, 0.0, 1.0),(1.0, 1.0, 1.0),(0.9, 0.9, 0.9),(1.0, 1.0, 1.0), 32, 1.3)]
lgts = [Light((20,100,100),(0.75, 0.75, 0.75)),Light((80,100,100),(0.75, 0.75, 0.75))]
ambi = vector(RR, 3, (0.2, 0.2, 0.2))
objs = [Globe((50,50,50), 9, 0), Globe((35,60,20), 9, 1), Globe((65,60,20), 9, 2), Globe((50,35,20), 9, 3)]
eta_outside = 1.0
trace_depth = 6
"""


def snell(*arguments: str) -> str:
    """Run the command line."""
    return subprocess.run([SNELL, *arguments], check=True, capture_output=True, text=True).stdout


def film(scene: str, folder: Path, *arguments: str) -> NDArray[np.float64]:
    """Render by the command line."""
    output = folder / "film.npy"
    snell("render", "--quiet", scene, "-o", str(output), *arguments)
    loaded: NDArray[np.float64] = np.load(output)
    return loaded


def own_kernel(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Let notebooks run in this interpreter's kernel, without what a person may have set up for it."""
    for variable in ("JUPYTER_DATA_DIR", "JUPYTER_CONFIG_DIR", "JUPYTER_RUNTIME_DIR", "IPYTHONDIR"):
        monkeypatch.setenv(variable, str(folder / variable))
    monkeypatch.setenv("JUPYTER_PREFER_ENV_PATH", "1")
