"""The parts of a scene. Their fields are the keys of the scene file, which ``docs/scenes.md`` explains."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import SceneError
from .values import Color, Steps, Value, Vector, gray


@dataclass(eq=False, repr=False)
class Camera(Value):
    """A pinhole camera, in the order of the lecture.

    Parameters
    ----------
    eye, look_at, up : (3,)
        Where the eye is, a point that it looks at, and a direction that is up in the picture.
    bounds : (4,), optional
        Left, right, bottom and top of the picture on the image plane; or `fov`.
    near : float, optional
        Where the image plane is: negative, in front of the eye. Needed with `bounds`; with `fov` a tenth of the way to
        `look_at` if left out.
    far : float, optional
        Ignored, as in the lecture.
    width, height : int, optional
        Size of the picture in pixels, which a file has as ``render.size``.
    fov : float, optional
        Degrees between the highest and the lowest row of pixels, which are square then.

    Examples
    --------
    >>> camera = Camera((50, 50, 100), (50, 50, 10), (0, 1, 0), (-2.0, 2.0, -2.0, 2.0), -5, -100, 8, 8)
    >>> camera.width = 512
    >>> camera == eval(repr(camera))
    True
    """

    eye: Vector
    look_at: Vector
    up: Vector
    bounds: Vector | None = None
    near: float | None = None
    far: float | None = None
    width: int | None = None
    height: int | None = None
    fov: float | None = field(default=None, kw_only=True)


@dataclass(eq=False, repr=False)
class Material(Value):
    """What a surface does with light: the lecture's coefficients in its order, the others by name.

    Parameters
    ----------
    ka, kd, ks, kr, ko : float or (3,)
        Ambient, diffuse, highlight, mirror, opacity.
    spow : float
        Exponent of the highlight.
    eta : float
        Index of refraction.

    Examples
    --------
    >>> Material(kd=(1, 0, 0), glass="BK7")
    Material(kd=(1, 0, 0), glass='BK7')
    """

    ka: Color = 0.0
    kd: Color = 0.0
    ks: Color = 0.0
    kr: Color = 0.0
    ko: Color = 1.0
    spow: float = 16.0
    eta: float = 1.0
    glass: str | None = field(default=None, kw_only=True)
    abbe: float | None = field(default=None, kw_only=True)
    cauchy: Vector | None = field(default=None, kw_only=True)
    sellmeier: Sequence[Vector] | None = field(default=None, kw_only=True)
    texture: str | None = field(default=None, kw_only=True)
    thickness: float | None = field(default=None, kw_only=True)
    emission: Color = field(default=0.0, kw_only=True)
    attenuation_color: Color | None = field(default=None, kw_only=True)
    attenuation_distance: float | None = field(default=None, kw_only=True)
    sigma_a: Color | None = field(default=None, kw_only=True)
    priority: int = field(default=0, kw_only=True)
    dyed: bool = field(default=False, kw_only=True)

    colors: ClassVar[frozenset[str]] = frozenset(
        {"ka", "kd", "ks", "kr", "ko", "emission", "attenuation_color", "sigma_a"}
    )

    def plain(self, place: str = "") -> dict[str, Any]:
        """Return the form of the file. An infinite Abbe number is no dispersion, and left out: JSON has no infinity."""
        return Value.plain(self.replace(abbe=None) if self.abbe == math.inf else self, place)


@dataclass(eq=False, repr=False)
class Light(Value):
    """A light at a point, at infinity (`direction`), or in a cone (`target`, `cone`, `edge`).

    Examples
    --------
    >>> Light((20, 100, 100), (0.75, 0.75, 0.75)) == Light(position=[20, 100, 100], color=0.75)
    True
    """

    position: Vector | None = None
    color: Color | None = None
    name: str | None = field(default=None, kw_only=True)
    direction: Vector | None = field(default=None, kw_only=True)
    target: Vector | None = field(default=None, kw_only=True)
    cone: float | None = field(default=None, kw_only=True)
    edge: float | None = field(default=None, kw_only=True)

    colors: ClassVar[frozenset[str]] = frozenset({"color"})


@dataclass(eq=False, repr=False)
class Sphere(Value):
    """A sphere. Its material is a name, or a number from 0 in the order of the scene's materials, as in the lecture.

    Examples
    --------
    >>> Globe((50, 50, 50), 9, 0)
    Sphere(center=(50, 50, 50), radius=9, material=0)
    """

    center: Vector
    radius: float
    material: int | str
    name: str | None = field(default=None, kw_only=True)
    transform: Steps = field(default=(), kw_only=True)
    instances: Sequence[Steps] = field(default=(), kw_only=True)


Globe = Sphere


@dataclass(eq=False, repr=False)
class Mesh(Value):
    """Triangles, of a file or written out.

    Parameters
    ----------
    vertices : (n, 3), float64
        Positions.
    faces : (m, 3), integers
        Three vertices each, counted from 0, counter-clockwise seen from outside.
    material : int or str, optional
        As for `Sphere`; left out: what the model file says.
    file : path, optional
        Instead of both, a model file, relative to the scene's `folder`.

    Examples
    --------
    >>> Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)], "glass").arrays("mesh[0]")[1].dtype
    dtype('uint32')
    """

    vertices: ArrayLike | None = None
    faces: ArrayLike | None = None
    material: int | str | None = None
    file: str | os.PathLike[str] | None = field(default=None, kw_only=True)
    name: str | None = field(default=None, kw_only=True)
    materials: Mapping[str, str] | None = field(default=None, kw_only=True)
    smooth_angle: float = field(default=0.0, kw_only=True)
    open: str | None = field(default=None, kw_only=True)
    inside: int | str | None = field(default=None, kw_only=True)
    outside: int | str | None = field(default=None, kw_only=True)
    transform: Steps = field(default=(), kw_only=True)
    instances: Sequence[Steps] = field(default=(), kw_only=True)

    # They do not go through the text.
    beside: ClassVar[frozenset[str]] = frozenset({"vertices", "faces"})

    def arrays(self, place: str) -> tuple[NDArray[np.float64], NDArray[np.uint32]] | None:
        """Return its triangles as the library takes them."""
        if self.vertices is None and self.faces is None:
            return None
        vertices = _rows(self.vertices, f"{place}.vertices")
        faces = _rows(self.faces, f"{place}.faces")
        if (faces.size and not (np.mod(faces, 1) == 0).all()) or (faces < 0).any() or (faces >= 2**32).any():
            raise SceneError([(f"{place}.faces", "expected numbers of vertices, counted from 0", None)])
        return vertices, faces.astype(np.uint32)

    def same_triangles(self, other: Mesh) -> bool:
        """Say whether another mesh has the same triangles written out, or neither has any."""
        mine, theirs = self.arrays("mesh"), other.arrays("mesh")
        if mine is None or theirs is None:
            return mine is theirs
        return np.array_equal(mine[0], theirs[0]) and np.array_equal(mine[1], theirs[1])

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Mesh):
            return NotImplemented
        return self.plain() == other.plain() and self.same_triangles(other)

    __hash__ = None


def _rows(value: ArrayLike | None, place: str) -> NDArray[np.float64]:
    """Return rows of three numbers."""
    try:
        rows = np.ascontiguousarray(() if value is None else value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise SceneError([(place, f"expected rows of three numbers: {error}", None)]) from error
    if rows.size == 0:
        rows = rows.reshape(0, 3)
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise SceneError([(place, f"expected rows of three numbers, read an array of shape {rows.shape}", None)])
    return rows


@dataclass(eq=False, repr=False)
class Plane(Value):
    """A rectangle of `size` (width, height); nothing is infinite here."""

    center: Vector = (0.0, 0.0, 0.0)
    normal: Vector = (0.0, 1.0, 0.0)
    size: Vector | None = None
    material: int | str | None = None
    name: str | None = field(default=None, kw_only=True)
    inside: int | str | None = field(default=None, kw_only=True)
    outside: int | str | None = field(default=None, kw_only=True)
    transform: Steps = field(default=(), kw_only=True)
    instances: Sequence[Steps] = field(default=(), kw_only=True)


@dataclass(eq=False, repr=False)
class Box(Value):
    """A box between its corners of the smallest and of the largest coordinates."""

    min: Vector
    max: Vector
    material: int | str
    name: str | None = field(default=None, kw_only=True)
    transform: Steps = field(default=(), kw_only=True)
    instances: Sequence[Steps] = field(default=(), kw_only=True)


@dataclass(eq=False, repr=False)
class Lathe(Value):
    """What turns around the y axis: `profile` has points (radius, height)."""

    profile: Sequence[Vector] | NDArray[np.floating[Any]]
    material: int | str
    segments: int = 64
    smooth_angle: float = 0.0
    name: str | None = field(default=None, kw_only=True)
    inside: int | str | None = field(default=None, kw_only=True)
    outside: int | str | None = field(default=None, kw_only=True)
    transform: Steps = field(default=(), kw_only=True)
    instances: Sequence[Steps] = field(default=(), kw_only=True)


@dataclass(eq=False, repr=False)
class Texture(Value):
    """A pattern on a surface: squares of two colours (`checker`), or an `image`."""

    checker: Sequence[Color] | None = None
    image: str | os.PathLike[str] | None = None
    repeat: Vector = (1.0, 1.0)
    linear: bool = False

    def plain(self, place: str = "") -> dict[str, Any]:
        """Return the form of the file."""
        table = super().plain(place)
        if isinstance(table.get("checker"), list):
            table["checker"] = [gray(color) for color in table["checker"]]
        return table


@dataclass(eq=False, repr=False)
class Sky(Value):
    """What is seen where nothing is: a gradient, or a picture of all directions."""

    horizon: Color | None = None
    zenith: Color | None = None
    nadir: Color | None = None
    image: str | os.PathLike[str] | None = None
    brightness: float = 1.0
    rotate: float = 0.0

    colors: ClassVar[frozenset[str]] = frozenset({"horizon", "zenith", "nadir"})


@dataclass(eq=False, repr=False)
class Render(Value):
    """How the picture is made; there is no default model of light. The camera's width and height can give `size`.

    Where it names no `shadows`, they are tinted in `whitted` and opaque in the other models.
    """

    integrator: str
    size: Sequence[int] | None = None
    spp: int = 1
    seed: int = 0
    max_depth: int = 32
    min_throughput: float = 1 / 4096
    bands: int = 16
    shadows: str | None = None
    transfer: str = "srgb"
    rounding: str = "round"
