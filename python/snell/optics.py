"""The formulas of the library on numbers and NumPy arrays, which broadcast as usual.

Angles are in degrees. ``eta`` is the index behind the surface divided by that before it, ``mu`` the other way round.
What does not exist is NaN.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from .errors import OpticsError

Floats = NDArray[np.float64]

__all__ = [
    "Glass",
    "brewster_angle",
    "critical_angle",
    "fresnel",
    "glass",
    "glasses",
    "reflect",
    "refract",
    "slab_offset",
]


def _numbers(name: str, value: ArrayLike) -> Floats:
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise OpticsError([(name, f"expected numbers, read {value!r}", None)]) from error


def _columns(f: Callable[..., Floats], **values: ArrayLike) -> Any:
    """Calls a function of columns: a float for floats, an array of the common shape for arrays."""
    arrays = [_numbers(name, value) for name, value in values.items()]
    try:
        columns = np.broadcast_arrays(*arrays)
    except ValueError as error:
        raise OpticsError([(", ".join(values), str(error), None)]) from error
    result = f(*(np.require(column, requirements=["C", "A"]).reshape(-1) for column in columns)).reshape(
        columns[0].shape
    )
    return result if result.ndim else float(result)


def _vectors(name: str, value: ArrayLike) -> Floats:
    array = _numbers(name, value)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise OpticsError([(name, f"expected vectors of three numbers, read an array of shape {array.shape}", None)])
    return array


def refract(wo: ArrayLike, n: ArrayLike, mu: ArrayLike) -> Floats:
    """Return the refracted direction, by Snell's law in the lecture's vector form.

    Parameters
    ----------
    wo : array_like, (..., 3)
        Towards where the ray came from, of unit length.
    n : array_like, (..., 3)
        The normal, on the side of ``wo``, of unit length.
    mu : array_like, (...)
        Index before the surface divided by that behind it.

    Returns
    -------
    ndarray, (..., 3)
        Where the ray goes on; NaN where everything is reflected.

    Examples
    --------
    >>> refract((0.6, 0, 0.8), (0, 0, 1), 1.0)
    array([-0.6,  0. , -0.8])
    >>> refract((0.8, 0, 0.6), (0, 0, 1), 1.5)
    array([nan, nan, nan])
    """
    rows, normals, ratio = _vectors("wo", wo), _vectors("n", n), _numbers("mu", mu)
    try:
        shape = np.broadcast_shapes(rows.shape[:-1], normals.shape[:-1], ratio.shape)
    except ValueError as error:
        raise OpticsError([("wo, n, mu", str(error), None)]) from error
    rows, normals = (np.broadcast_to(a, (*shape, 3)).reshape(-1, 3) for a in (rows, normals))
    return _native.refract(rows, normals, np.broadcast_to(ratio, shape).reshape(-1)).reshape(*shape, 3)


def reflect(wo: ArrayLike, n: ArrayLike) -> Floats:
    """Return the mirror direction ``2 (n·wo) n − wo``.

    Parameters
    ----------
    wo, n : array_like, (..., 3)
        As for `refract`.

    Returns
    -------
    ndarray, (..., 3)

    Examples
    --------
    >>> reflect((0.6, 0, 0.8), (0, 0, 1))
    array([-0.6,  0. ,  0.8])
    """
    rows, normals = _vectors("wo", wo), _vectors("n", n)
    try:
        rows, normals = np.broadcast_arrays(rows, normals)
    except ValueError as error:
        raise OpticsError([("wo, n", str(error), None)]) from error
    return _native.reflect(rows.reshape(-1, 3), normals.reshape(-1, 3)).reshape(rows.shape)


@overload
def fresnel(theta_i: float, eta: float) -> float: ...
@overload
def fresnel(theta_i: ArrayLike, eta: ArrayLike) -> Floats | float: ...
def fresnel(theta_i: ArrayLike, eta: ArrayLike) -> Floats | float:
    """Return the part of unpolarised light that a smooth face reflects (Fresnel 1823).

    Parameters
    ----------
    theta_i : array_like
        Angle of incidence in degrees, 0 to 90.
    eta : array_like
        Index behind the face divided by that before it.

    Returns
    -------
    float or ndarray
        0 to 1; exactly 1 for total reflection.

    Examples
    --------
    >>> round(fresnel(0, 1.5), 4)
    0.04
    >>> fresnel([0, 60, 90], 1 / 1.5).round(4)
    array([0.04, 1.  , 1.  ])
    """
    result: Floats | float = _columns(_native.fresnel, theta_i=theta_i, eta=eta)
    return result


@overload
def critical_angle(eta: float) -> float: ...
@overload
def critical_angle(eta: ArrayLike) -> Floats | float: ...
def critical_angle(eta: ArrayLike) -> Floats | float:
    """Return the angle in degrees from which on everything is reflected: ``asin(eta)``.

    Parameters
    ----------
    eta : array_like
        Index behind the face divided by that before it.

    Returns
    -------
    float or ndarray
        NaN above 1, where something always goes through.

    Examples
    --------
    >>> round(critical_angle(1 / 1.5), 2)
    41.81
    >>> critical_angle(1.5)
    nan
    """
    result: Floats | float = _columns(_native.critical_angle, eta=eta)
    return result


@overload
def brewster_angle(eta: float) -> float: ...
@overload
def brewster_angle(eta: ArrayLike) -> Floats | float: ...
def brewster_angle(eta: ArrayLike) -> Floats | float:
    """Return the angle at which light that swings in the plane of incidence is not reflected (Brewster 1815).

    Parameters
    ----------
    eta : array_like
        Index behind the face divided by that before it.

    Returns
    -------
    float or ndarray

    Examples
    --------
    >>> round(brewster_angle(1.5), 2)
    56.31
    """
    result: Floats | float = _columns(_native.brewster_angle, eta=eta)
    return result


@overload
def slab_offset(thickness: float, theta_i: float, eta: float) -> float: ...
@overload
def slab_offset(thickness: ArrayLike, theta_i: ArrayLike, eta: ArrayLike) -> Floats | float: ...
def slab_offset(thickness: ArrayLike, theta_i: ArrayLike, eta: ArrayLike) -> Floats | float:
    """Return how far aside a plane-parallel pane moves a ray: ``t sin(θ − θ_t) / cos θ_t``.

    Parameters
    ----------
    thickness : array_like
        Of the pane, in any unit of length.
    theta_i : array_like
        Angle of incidence in degrees.
    eta : array_like
        Index of the pane divided by that around it.

    Returns
    -------
    float or ndarray
        In the unit of ``thickness``; NaN where nothing goes through.

    Examples
    --------
    >>> round(slab_offset(10.0, 45.0, 1.5), 3)
    3.291
    """
    result: Floats | float = _columns(_native.slab_offset, thickness=thickness, theta_i=theta_i, eta=eta)
    return result


class Glass:
    """A glass of the catalogue (``docs/glasses.md``), by name or alias.

    Raises
    ------
    OpticsError
        For an unknown name, with those that are most like it.

    Examples
    --------
    >>> bk7 = glass("BK7")
    >>> round(bk7.eta(589.3), 5)
    1.51673
    >>> bk7
    glass('N-BK7')
    """

    def __init__(self, name: str) -> None:
        self._native = _native.NativeGlass(name)
        self.name: str = self._native.name
        #: Who measured it.
        self.source: str = self._native.source
        #: Shortest and longest wavelength that its formula holds for, in nm.
        self.range_nm: tuple[float, float] = self._native.range_nm
        #: ``(n_d − 1) / (n_F − n_C)``; None where the formula does not hold for these lines.
        self.abbe_number: float | None = self._native.abbe_number

    @overload
    def eta(self, wavelength_nm: float) -> float: ...
    @overload
    def eta(self, wavelength_nm: ArrayLike) -> Floats | float: ...
    def eta(self, wavelength_nm: ArrayLike) -> Floats | float:
        """Return the index of refraction at a wavelength in nm.

        Raises
        ------
        OpticsError
            Outside `range_nm`.
        """
        result: Floats | float = _columns(self._native.eta, wavelength_nm=wavelength_nm)
        return result

    def __repr__(self) -> str:
        return f"glass({self.name!r})"


def glass(name: str) -> Glass:
    """Return the glass of this name; see `Glass`."""
    return Glass(name)


def glasses() -> list[str]:
    """Return the names of all glasses of the catalogue.

    Examples
    --------
    >>> glasses()[:2]
    ['N-BK7', 'N-BAK1']
    """
    return _native.glass_names()
