"""Every scene of the lecture, and polygons in every model, against the slow oracle, every pixel."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from lecture_oracle import Tracer

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).resolve().parent.parent
SNELL = os.environ.get("SNELL", str(ROOT / "target" / "ci" / "snell"))
SCENES = sorted((ROOT / "scenes" / "lecture").glob("*.toml"))
SIZE = 64


def render(scene: str, folder: Path, *arguments: str) -> np.ndarray:
    output = folder / "film.npy"
    command = [SNELL, "render", "--quiet", scene, "--size", f"{SIZE}x{SIZE}", "-o", str(output), *arguments]
    subprocess.run(command, check=True)
    return np.load(output)


def test_all_pictures_of_the_lecture_are_here() -> None:
    assert len(SCENES) == 15


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_film_equals_the_oracle(path: Path, tmp_path: Path) -> None:
    film = render(f"lecture/{path.stem}", tmp_path)
    expected = Tracer(tomllib.loads(path.read_text())).picture(SIZE, SIZE)
    assert film.shape == expected.shape == (SIZE, SIZE, 3)
    assert film.max() > 0.5, "a black picture proves nothing"
    # Both round each step to 53 bits in another order; six bounces off spheres magnify that by some 1e4.
    difference = np.abs(film - expected).max()
    print(f"{path.stem}: {difference:.1e}")
    assert difference <= 1e-9


@pytest.mark.parametrize("model", ["lecture", "course2018", "course2020"])
@pytest.mark.parametrize("shadows", ["off", "opaque"])
def test_polygons_equal_the_oracle(model: str, shadows: str, tmp_path: Path) -> None:
    path = ROOT / "tests" / "polygons.toml"
    film = render(str(path), tmp_path, "--integrator", model, "--shadows", shadows)
    scene = tomllib.loads(path.read_text())
    scene["render"]["shadows"] = shadows
    expected = Tracer(scene, model).picture(SIZE, SIZE)
    difference = np.abs(film - expected)
    print(f"{model} {shadows}: {difference.max():.1e}")
    assert difference.max() <= 1e-9


def test_the_oracle_can_fail(tmp_path: Path) -> None:
    """A different index is seen: the comparison is not blind."""
    scene = tomllib.loads((ROOT / "scenes" / "lecture" / "default.toml").read_text())
    film = render("lecture/default", tmp_path, "--set", "material.glass.eta=2.001")
    assert np.abs(film - Tracer(scene).picture(SIZE, SIZE)).max() > 1e-3
