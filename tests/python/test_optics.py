"""The formulas: vectors give the bits of scalars, and both the textbook's numbers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from snell import OpticsError, optics

THETA = np.linspace(0, 90, 91)
ETA = np.array([[0.5], [1 / 1.5], [1.0], [1.33], [2.42]])


def test_arrays_have_the_bits_of_scalars() -> None:
    cases: list[tuple[Callable[..., Any], tuple[Any, ...]]] = [
        (optics.fresnel, (THETA, ETA)),
        (optics.critical_angle, (ETA,)),
        (optics.brewster_angle, (ETA,)),
        (optics.slab_offset, (2.0, THETA, ETA)),
    ]
    for function, arguments in cases:
        whole = np.asarray(function(*arguments))
        columns = [np.broadcast_to(a, whole.shape).ravel() for a in arguments]
        one_by_one = np.array([function(*map(float, row)) for row in zip(*columns, strict=True)])
        assert whole.ravel().tobytes() == one_by_one.tobytes()


def test_refract_is_snells_law_both_ways() -> None:
    theta = np.radians(THETA[:-1])
    wo = np.stack([-np.sin(theta), 0 * theta, np.cos(theta)], axis=-1)
    wi = optics.refract(wo, (0, 0, 1), 1 / 1.5)
    assert wi.shape == (90, 3)
    # Each is rounded a few times.
    assert np.abs(wi[:, 0] - np.sin(theta) / 1.5).max() < 4e-16
    assert np.abs(optics.refract(wi, (0, 0, -1), 1.5) - wo).max() < 1e-13
    assert optics.refract(wo[3], (0, 0, 1), 1 / 1.5).tobytes() == wi[3].tobytes()
    assert optics.reflect(wo, (0, 0, 1)).shape == (90, 3)
    assert np.isnan(optics.refract(wo, (0, 0, 1), 1.5)[60]).all()


def test_known_numbers() -> None:
    assert np.isclose(optics.fresnel(0.0, 1.5), 0.04)
    assert optics.fresnel(90.0, 1.5) == optics.fresnel(89.0, 0.5) == 1
    assert np.isclose(optics.critical_angle(1 / 1.5), 41.8103)
    theta, behind = np.radians(30), np.arcsin(np.sin(np.radians(30)) / 1.5)
    assert np.isclose(optics.slab_offset(2.0, 30.0, 1.5), 2 * np.sin(theta - behind) / np.cos(behind))
    bk7 = optics.glass("bk7")
    assert bk7.name == "N-BK7"
    assert np.isclose(bk7.eta(587.5618), 1.5168, atol=1e-5)
    assert np.diff(bk7.eta(np.arange(400, 700, 10))).max() < 0
    assert "diamond" in optics.glasses()


def test_what_is_wrong_is_named() -> None:
    with pytest.raises(OpticsError, match="did you mean"):
        optics.glass("BK9")
    with pytest.raises(OpticsError, match="nm"):
        optics.glass("BK7").eta(10.0)
    with pytest.raises(OpticsError, match="theta_i: expected numbers"):
        optics.fresnel("steep", 1.5)
    with pytest.raises(OpticsError, match="vectors of three"):
        optics.refract((0, 1), (0, 0, 1), 1)
    with pytest.raises(OpticsError, match="theta_i, eta"):
        optics.fresnel([1, 2], [1, 2, 3])
    assert np.isnan(optics.fresnel(np.nan, 1.5))
