"""Sweeps go on where they stopped, and start again where something has changed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import snell


def test_what_is_done_is_skipped(tmp_path: Path) -> None:
    scene = snell.scenes["lecture/default"]
    eta = {"material.glass.eta": np.linspace(1, 2, 3)}
    frames = snell.sweep(scene, eta, tmp_path, width=16)
    made = [frame.stat().st_mtime_ns for frame in frames]
    assert len({frame.read_bytes() for frame in frames}) == 3
    frames[1].unlink()
    assert snell.sweep(scene, eta, tmp_path, width=16) == frames
    again = [frame.stat().st_mtime_ns for frame in frames]
    assert [before == after for before, after in zip(made, again, strict=True)] == [True, False, True]
    snell.sweep(scene.replace(ambient=0.5), eta, tmp_path, width=16)
    assert all(frame.stat().st_mtime_ns > before for frame, before in zip(frames, again, strict=True))


def test_values_go_together(tmp_path: Path) -> None:
    scene = snell.scenes["lecture/default"]
    with pytest.raises(snell.SceneError, match=r"eta has 2, eta_outside has 1"):
        snell.sweep(scene, {"material.glass.eta": [1, 2], "eta_outside": [1]}, tmp_path)
    with pytest.raises(snell.SceneError, match="known here: glass"):
        snell.sweep(scene, {"material.gals.eta": [1]}, tmp_path)
