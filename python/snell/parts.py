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
    eye, look_at : (3,)
        Where the eye is, and a point that it looks at, in scene units.
    up : (3,)
        A direction that is up in the picture, of any length; not parallel to the view.
    bounds : (4,), optional
        Left, right, bottom and top of the picture on the image plane, in scene units. Give this or `fov`.
    near : float, optional
        Where the image plane is, in scene units: negative, in front of the eye. Needed with `bounds`; with `fov` a
        tenth of the way from `eye` to `look_at` if left out.
    far : float, optional
        Ignored, as in the lecture.
    width, height : int, optional
        Size of the picture in pixels, at least 1; left out: ``settings.size``, which is what a file has.
    fov : float, optional
        Degrees between the highest and the lowest row of pixels, which are square then: 0.001 to 179.

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
    ka, kd, ks : float or (3,)
        The shares of the ambient light and of the diffusely reflected light, and the colour of the highlight; linear,
        usually 0 to 1, by default 0.
    kr : float or (3,)
        The share that the mirror ray carries on, 0 to 1; by default 0.
    ko : float or (3,)
        Opacity, 0 to 1: the share ``1 - ko`` of the light goes through; by default 1.
    spow : float
        Exponent of the highlight, not negative; by default 16.
    eta : float
        Index of refraction, 0.001 to 1000; by default 1.
    glass : str, optional
        A glass of the catalogue (`snell.optics.glasses`) instead of `eta`: its index at 587.56 nm, and with `whitted`
        its colours.
    abbe : float, optional
        `whitted`: the Abbe number, above 0, of the glass whose index at 587.56 nm is `eta`; left out or infinite: no
        dispersion.
    cauchy : (3,), optional
        `whitted`: Cauchy's A, B, C instead of `eta`: the index at λ µm is A + B/λ² + C/λ⁴.
    sellmeier : sequence of (2,), optional
        `whitted`: one to eight of Sellmeier's pairs B, C (in µm²) instead of `eta`: the index squared at λ µm is
        1 + Σ Bλ²/(λ² − C).
    texture : str, optional
        Name of one of the scene's textures, by which `ka` and `kd` are multiplied, and with `whitted` `ko` and
        `emission` by its alpha.
    thickness : float, optional
        `whitted`: each face is a whole pane so thick, in scene units, and need not belong to a solid; not negative.
    emission : float or (3,)
        `whitted`: light that the outer side sends out by itself; by default 0.
    attenuation_color : float or (3,), optional
        `whitted`: the colour of white light after `attenuation_distance` inside, 0 to 1.
    attenuation_distance : float, optional
        `whitted`: after which way `attenuation_color` is seen, in scene units, above 0.
    sigma_a : float or (3,), optional
        `whitted`: absorption per scene unit, not negative, instead of a colour at a distance.
    priority : int
        `whitted`: where solids overlap, the one of the highest priority is there, among equals the one that was
        entered last; by default 0.
    tinted_transmission : bool
        `whitted`: what goes through the surface takes its diffuse colour `kd`; by default it does not.

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
    tinted_transmission: bool = field(default=False, kw_only=True)

    colors: ClassVar[frozenset[str]] = frozenset(
        {"ka", "kd", "ks", "kr", "ko", "emission", "attenuation_color", "sigma_a"}
    )

    def plain(self, place: str = "") -> dict[str, Any]:
        """Return the form of the file. An infinite Abbe number is no dispersion, and left out: JSON has no infinity."""
        return Value.plain(self.replace(abbe=None) if self.abbe == math.inf else self, place)


@dataclass(eq=False, repr=False)
class Light(Value):
    """A light at a point, at infinity, or in a cone. It does not fade with distance.

    Parameters
    ----------
    position : (3,), optional
        Where it stands, in scene units. Give this or `direction`.
    color : float or (3,)
        Its intensity, linear, 1 for white; there is no default.
    name : str, optional
        For messages and explanations, and for the keys of `Scene.with_`.
    direction : (3,), optional
        Towards a light at infinity, of any length.
    target : (3,), optional
        What a spot light shines at; it needs `position` and `cone`.
    cone : float, optional
        Degrees between the middle of a spot light and its edge, above 0 and at most 180.
    edge : float, optional
        Degrees within `cone` over which a spot light fades, 0 to `cone`; left out: 0, a sharp edge.

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
    """A sphere.

    Parameters
    ----------
    center : (3,)
        In scene units.
    radius : float
        In scene units, not negative; one of radius 0 is invisible.
    material : int or str
        A name, or a number from 0 in the order of the scene's materials, as in the lecture.
    name : str, optional
        For messages and explanations, and for the keys of `Scene.with_`.
    transform : sequence of steps
        What puts it in its place, one after the other: ``{"move": (x, y, z)}``, ``{"scale": (x, y, z)}``, ``{"rotate":
        {"axis": (x, y, z), "degrees": angle}}``, right-handed about an axis through the origin; by default none. It
        must stay a sphere.
    instances : sequence of sequences of steps
        The places where it stands, each a list of steps after those of `transform`; by default it stands there once.

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
    vertices : (n, 3), float64, optional
        Positions in scene units; they and `faces`, or a `file`.
    faces : (m, 3), integers, optional
        Three vertices each, counted from 0, counter-clockwise seen from outside.
    material : int or str, optional
        Of all faces, as for `Sphere`; left out: what the model file says.
    file : path, optional
        A model file (.obj, .ply, .stl) instead of both, relative to the scene's `folder`.
    name : str, optional
        For messages and explanations, and for the keys of `Scene.with_`.
    materials : dict of str to str, optional
        Which material of the scene stands for which name in the model file, where `material` is left out.
    smooth_angle : float
        Normals are smoothed over edges up to this angle in degrees, not negative; by default 0, which is flat.
    open : {"fill", "opaque"}, optional
        `whitted`: what becomes of a transparent mesh that is not closed: its holes are filled, or nothing goes through
        it; left out: it is refused.
    inside : int or str, optional
        `whitted`: the material of what is behind the faces, which then are interfaces and need not be closed.
    outside : int or str, optional
        `whitted`: with `inside`, the material of what the faces look at; left out: the space between the objects.
    transform : sequence of steps
        What puts it in its place, one after the other: ``{"move": (x, y, z)}``, ``{"scale": (x, y, z)}``, ``{"rotate":
        {"axis": (x, y, z), "degrees": angle}}``, right-handed about an axis through the origin; by default none.
    instances : sequence of sequences of steps
        The places where it stands, each a list of steps after those of `transform`; by default it stands there once.

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
        # Aligned, too: arrays that come over a network (pickle, Dask) may lie anywhere.
        rows = np.require(() if value is None else value, np.float64, ["C", "A"])
    except (TypeError, ValueError) as error:
        raise SceneError([(place, f"expected rows of three numbers: {error}", None)]) from error
    if rows.size == 0:
        rows = rows.reshape(0, 3)
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise SceneError([(place, f"expected rows of three numbers, read an array of shape {rows.shape}", None)])
    return rows


@dataclass(eq=False, repr=False)
class Plane(Value):
    """A rectangle; nothing is infinite here.

    Parameters
    ----------
    center : (3,)
        Its middle, in scene units; by default the origin.
    normal : (3,)
        Where its front looks, of any length but 0; by default up, (0, 1, 0).
    size : (2,)
        Width and height in scene units, above 0; there is no default.
    material : int or str
        As for `Sphere`; there is no default.
    name : str, optional
        For messages and explanations, and for the keys of `Scene.with_`.
    inside : int or str, optional
        `whitted`: the material of what is behind the faces, which then are interfaces and need not be closed.
    outside : int or str, optional
        `whitted`: with `inside`, the material of what the faces look at; left out: the space between the objects.
    transform : sequence of steps
        What puts it in its place, one after the other: ``{"move": (x, y, z)}``, ``{"scale": (x, y, z)}``, ``{"rotate":
        {"axis": (x, y, z), "degrees": angle}}``, right-handed about an axis through the origin; by default none.
    instances : sequence of sequences of steps
        The places where it stands, each a list of steps after those of `transform`; by default it stands there once.

    Examples
    --------
    >>> Plane(size=(40, 40), material="floor")
    Plane(size=(40, 40), material='floor')
    """

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
    """A box along the axes.

    Parameters
    ----------
    min, max : (3,)
        Its corners of the smallest and of the largest coordinates, in scene units; `min` is below `max` in each.
    material : int or str
        As for `Sphere`.
    name : str, optional
        For messages and explanations, and for the keys of `Scene.with_`.
    transform : sequence of steps
        What puts it in its place, one after the other: ``{"move": (x, y, z)}``, ``{"scale": (x, y, z)}``, ``{"rotate":
        {"axis": (x, y, z), "degrees": angle}}``, right-handed about an axis through the origin; by default none.
    instances : sequence of sequences of steps
        The places where it stands, each a list of steps after those of `transform`; by default it stands there once.

    Examples
    --------
    >>> Box((0, 0, 0), (1, 2, 3), "glass")
    Box(min=(0, 0, 0), max=(1, 2, 3), material='glass')
    """

    min: Vector
    max: Vector
    material: int | str
    name: str | None = field(default=None, kw_only=True)
    transform: Steps = field(default=(), kw_only=True)
    instances: Sequence[Steps] = field(default=(), kw_only=True)


@dataclass(eq=False, repr=False)
class Disc(Value):
    """A disc; a `transform` that stretches it makes it an ellipse.

    Parameters
    ----------
    center : (3,)
        Its middle, in scene units; by default the origin.
    normal : (3,)
        Where its front looks, of any length but 0; by default up, (0, 1, 0).
    radius : float
        In scene units, above 0; there is no default.
    material : int or str
        As for `Sphere`; there is no default.
    name : str, optional
        For messages and explanations, and for the keys of `Scene.with_`.
    inside : int or str, optional
        `whitted`: the material of what is behind the faces, which then are interfaces and need not be closed.
    outside : int or str, optional
        `whitted`: with `inside`, the material of what the faces look at; left out: the space between the objects.
    transform : sequence of steps
        What puts it in its place, one after the other: ``{"move": (x, y, z)}``, ``{"scale": (x, y, z)}``, ``{"rotate":
        {"axis": (x, y, z), "degrees": angle}}``, right-handed about an axis through the origin; by default none.
    instances : sequence of sequences of steps
        The places where it stands, each a list of steps after those of `transform`; by default it stands there once.

    Examples
    --------
    >>> Disc(radius=2, material="mirror")
    Disc(radius=2, material='mirror')
    """

    center: Vector = (0.0, 0.0, 0.0)
    normal: Vector = (0.0, 1.0, 0.0)
    radius: float | None = None
    material: int | str | None = None
    name: str | None = field(default=None, kw_only=True)
    inside: int | str | None = field(default=None, kw_only=True)
    outside: int | str | None = field(default=None, kw_only=True)
    transform: Steps = field(default=(), kw_only=True)
    instances: Sequence[Steps] = field(default=(), kw_only=True)


@dataclass(eq=False, repr=False)
class Lathe(Value):
    """What turns around the y axis: a bottle, a lens, a pencil.

    Parameters
    ----------
    profile : (n, 2)
        Points (radius, height) in scene units, at least two, no radius negative. Along a profile that leads up, the
        outer side is away from the axis. It encloses a solid if it starts and ends on the axis, or ends where it
        starts.
    material : int or str
        As for `Sphere`.
    segments : int
        Corners of a ring, at least 3; by default 64.
    smooth_angle : float
        Normals are smoothed over edges up to this angle in degrees, not negative; by default 0, which is flat.
    name : str, optional
        For messages and explanations, and for the keys of `Scene.with_`.
    inside : int or str, optional
        `whitted`: the material of what is behind the faces, which then are interfaces and need not be closed.
    outside : int or str, optional
        `whitted`: with `inside`, the material of what the faces look at; left out: the space between the objects.
    transform : sequence of steps
        What puts it in its place, one after the other: ``{"move": (x, y, z)}``, ``{"scale": (x, y, z)}``, ``{"rotate":
        {"axis": (x, y, z), "degrees": angle}}``, right-handed about an axis through the origin; by default none.
    instances : sequence of sequences of steps
        The places where it stands, each a list of steps after those of `transform`; by default it stands there once.

    Examples
    --------
    >>> Lathe([(0, 0), (1, 0), (0, 2)], "glass", name="cone")
    Lathe(profile=[(0, 0), (1, 0), (0, 2)], material='glass', name='cone')
    """

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
    """A pattern on a surface: squares of two colours, or an image.

    Parameters
    ----------
    checker : (2,) of float or (3,), optional
        The two colours of the squares, linear. Give this or `image`.
    image : path, optional
        A PNG, PPM or EXR, relative to the scene's `folder`. With `whitted` the surface is not there where its alpha is
        0.
    repeat : (2,)
        How many squares, or images, lie beside and above each other; by default (1, 1).
    linear : bool
        Are the numbers of a PNG or PPM linear light, and not those of the sRGB curve? By default they are not.

    Examples
    --------
    >>> Texture(checker=[(0.9, 0.9, 0.8), 0.3], repeat=(20, 20))
    Texture(checker=[(0.9, 0.9, 0.8), 0.3], repeat=(20, 20))
    """

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
    """`whitted`: what is seen where nothing is: a gradient, or a picture of all directions.

    Parameters
    ----------
    horizon : float or (3,), optional
        The colour at the horizon, linear. Give this or `image`.
    zenith : float or (3,), optional
        The colour straight up; between, it goes by the sine of the elevation. Left out: that of the horizon.
    nadir : float or (3,), optional
        The colour straight down; left out: that of the horizon.
    image : path, optional
        A picture of all directions by longitude and latitude, EXR or PNG, relative to the scene's `folder`; −z is in
        its middle.
    brightness : float
        By what the picture is multiplied, not negative; by default 1.
    rotate : float
        Degrees by which the picture is turned about the y axis, right-handed; by default 0.

    Examples
    --------
    >>> Sky(horizon=1, zenith=(0.3, 0.5, 0.9))
    Sky(horizon=1, zenith=(0.3, 0.5, 0.9))
    """

    horizon: Color | None = None
    zenith: Color | None = None
    nadir: Color | None = None
    image: str | os.PathLike[str] | None = None
    brightness: float = 1.0
    rotate: float = 0.0

    colors: ClassVar[frozenset[str]] = frozenset({"horizon", "zenith", "nadir"})


@dataclass(eq=False, repr=False)
class Render(Value):
    """How the picture is made. `Scene.render` can make one otherwise without changing it.

    Parameters
    ----------
    integrator : {"whitted", "lecture", "course2018", "course2020"}
        The model of light; there is no default.
    size : (2,) of int, optional
        Width and height in pixels, at least 1; left out: those of the camera.
    spp : int
        Samples per pixel, 1 to 65536; by default 1, which looks through the point of the grid. More are spread over
        half a step around it.
    seed : int
        Another number spreads the samples otherwise, 0 to 4294967295; by default 0.
    max_depth : int
        How many bounces may follow the camera ray, 0 to 1000; by default 32.
    min_throughput : float
        `whitted`: branches that carry less than this part of what they could are not followed, and count as lost
        light; not negative, by default 1/4096.
    bands : int
        `whitted`: into how many wavelengths a ray splits at its first dispersive face, 1 to 64; by default 16, and 1
        for no colours.
    shadows : {"off", "opaque", "tinted"}, optional
        What stands between a surface and a light; left out: tinted in `whitted`, opaque in the other models.
    transfer : {"srgb", "linear"}
        The curve to 8 and 16 bit; by default srgb.
    rounding : {"round", "truncate"}
        What becomes of the fraction in 8 and 16 bit; by default it is rounded.

    Examples
    --------
    >>> Render("whitted", (640, 480), spp=16)
    Render(integrator='whitted', size=(640, 480), spp=16)
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
