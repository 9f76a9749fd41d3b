"""Why a pixel has its colour: the tree of its rays. ``docs/explain.md`` describes its form."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _native
from .errors import PictureError
from .files import ending, replacing
from .values import whole

if TYPE_CHECKING:
    from .notebook.view import View
    from .picture import Picture

Numbers = tuple[float, float, float]


@dataclass(frozen=True)
class Hit:
    """What a ray met.

    Attributes
    ----------
    object : str
        The name of the object.
    primitive : int
        The number of the sphere or triangle, from 0, in the order of the scene.
    t : float
        How far the ray went, in scene units; not negative.
    point, normal : (float, float, float)
        Where, in scene units; and the normal there, of unit length, towards the ray.
    angle_in : float
        Between the ray and the normal, in degrees, 0 to 90.
    angle_out : float or None
        Between the refracted ray and the normal behind the surface, in degrees; None where nothing goes on there.
    eta_before, eta_behind : float
        Indices of refraction on the side of the ray and behind the surface.
    total_reflection : bool
        Is all light reflected, as the angle is beyond the critical one?
    material : str
        The name of the material.
    throughput : (float, float, float)
        What of each unit of radiance from here reaches the sample, in red, green, blue.
    """

    object: str
    primitive: int
    t: float
    point: Numbers
    normal: Numbers
    angle_in: float
    angle_out: float | None
    eta_before: float
    eta_behind: float
    total_reflection: bool
    material: str
    throughput: Numbers


@dataclass(frozen=True)
class LightAtHit:
    """What a light does at a surface.

    Attributes
    ----------
    name : str
        The name of the light, or ``light`` and its number from 1.
    facing : bool
        Is the surface turned towards the light? Otherwise the light adds nothing.
    transmittance : (float, float, float)
        The share of the light that arrives: 1 where nothing is in its way, 0 where it is blocked.
    blocked_by : str or None
        The object that blocks it.
    block_point : (float, float, float) or None
        Where that does so, in scene units.
    through : tuple of str
        The objects that it comes through.
    diffuse, highlight : (float, float, float)
        What it adds, linear, before opacity and throughput weigh it.
    point : (float, float, float)
        Where the light stands, in scene units; at infinity, a direction towards it.
    at_infinity : bool
        Does it come from infinity?
    """

    name: str
    facing: bool
    transmittance: Numbers
    blocked_by: str | None
    block_point: Numbers | None
    through: tuple[str, ...]
    diffuse: Numbers
    highlight: Numbers
    point: Numbers
    at_infinity: bool


@dataclass(frozen=True)
class Local:
    """The light that a surface itself sends out, before opacity and throughput weigh it.

    Attributes
    ----------
    ambient, emission : (float, float, float)
        Ambient light, and what the surface sends out by itself, linear.
    lights : tuple of LightAtHit
        What each light of the scene does here, in the order of the scene.
    """

    ambient: Numbers
    emission: Numbers
    lights: tuple[LightAtHit, ...]


@dataclass(frozen=True)
class Node:
    """A ray. The contributions of a sample's nodes, added one by one, are its colour to the bit.

    Attributes
    ----------
    id : int
        Its place in `Sample.nodes`, from 0.
    parent : int or None
        That of the ray before it; None for the camera ray.
    depth : int
        Bounces before it; 0 for the camera ray.
    kind : {"camera", "mirror", "refracted", "inside"}
        From the camera; mirrored in the open; out of something transparent, or through a thin pane; within a solid.
    origin, dir : (float, float, float)
        Where it starts, in scene units, and its direction, of unit length.
    medium : str
        The object that it is in, or ``outside``.
    eta : float
        The index of refraction there.
    band_nm : float or None
        Its wavelength in nm, if dispersion has split it.
    throughput : (float, float, float)
        What of each unit of radiance reaches the sample where the ray starts, in red, green, blue.
    hit : Hit or None
        What it met; None for nothing.
    local : Local or None
        The light that the surface itself sends along it; None where it met nothing, or something from within.
    contribution : (float, float, float)
        What its end adds to the sample, linear.
    subtotal : (float, float, float)
        The same with everything behind it.
    ended : {"missed", "depth", "threshold", "rays", "absorbed"} or None
        Why no ray follows: nothing met, too many bounces, too little carried, too many rays of the pixel, nothing sent
        on; None if one follows.
    bound : (float, float, float) or None
        The most that it could still have added within ten more bounces, where it was not followed.
    """

    id: int
    parent: int | None
    depth: int
    kind: str
    origin: Numbers
    dir: Numbers
    medium: str
    eta: float
    band_nm: float | None
    throughput: Numbers
    hit: Hit | None
    local: Local | None
    contribution: Numbers
    subtotal: Numbers
    ended: str | None
    bound: Numbers | None


@dataclass(frozen=True)
class Sample:
    """A sample of the pixel.

    Attributes
    ----------
    color : (float, float, float)
        Its colour, linear: the sum of the contributions of its nodes.
    lost : (float, float, float)
        The throughput of the rays that were not followed.
    nodes : tuple of Node
        Its rays, parents before their children.
    """

    color: Numbers
    lost: Numbers
    nodes: tuple[Node, ...]


class Figure:
    """A drawing, which notebooks show; `svg` is its text."""

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it as .svg.

        Raises
        ------
        PictureError
            If its name ends otherwise, or it cannot be written; what was there before stays.
        """
        ending(path, "figure", [".svg"])
        with replacing(path) as beside:
            beside.write_text(self.svg, encoding="utf-8")

    def _repr_svg_(self) -> str:
        return self.svg


class RayTree:
    """Why a pixel has its colour, as `Picture.explain` says it. A pickled tree takes its picture with it.

    Attributes
    ----------
    scene, integrator : str
        The name of the scene, and its model of light.
    pixel, size : (int, int)
        Column and row; width and height of the whole picture.
    color : (float, float, float)
        As in the film, linear.
    sentence : str
        What a person would say first.
    samples : tuple of Sample
        As many as ``spp``, in their order.

    Examples
    --------
    >>> import snell
    >>> tree = snell.scenes["lecture/default"].render().explain(327, 163)
    >>> print(tree.sentence)
    Yellow because 52 % of this pixel is the sphere `red`, seen in the mirror of `green`; 48 % is the sphere `green`
    itself.
    >>> [node.hit.object for node in tree.nodes if node.hit]
    ['green', 'red']
    """

    def __init__(self, native: _native.NativeTree, picture: Picture) -> None:
        self._native = native
        self._picture = picture
        table = json.loads(native.json())
        self.scene: str = table["scene"]
        self.integrator: str = table["integrator"]
        self.pixel: tuple[int, int] = tuple(table["pixel"])
        self.size: tuple[int, int] = tuple(table["size"])
        self.color: Numbers = tuple(table["color"])
        self.sentence: str = table["sentence"]
        self.samples = tuple(_sample(sample) for sample in table["samples"])

    @property
    def nodes(self) -> tuple[Node, ...]:
        """The rays of the first sample, which is the only one where ``spp`` is 1."""
        return self.samples[0].nodes

    def text(self, *, top: int | None = None, depth: int | None = None) -> str:
        """Return the tree of the command line, with the strongest `top` branches and `depth` bounces."""
        top, depth = (number and whole(number, "text", PictureError) for number in (top, depth))
        for number in (top, depth):
            if number is not None and not 0 <= number < 2**32:
                raise PictureError([("text", f"expected a number from 0 to 4294967295, read {number}", None)])
        return self._native.text(top, depth)

    def to_json(self) -> str:
        """Return the JSON form, version 1."""
        return self._native.json()

    def to_html(self) -> str:
        """Return a page with the tree and its rays in 3D, which needs no network."""
        return self._native.html()

    def figure(self) -> Figure:
        """Draw the strongest light path: at each surface the normal, the rays with their angles, the critical angle."""
        return Figure(self._native.figure())

    def view(self, *, css_height: str | None = None) -> View:
        """Show its rays in the scene in 3D: `snell.View`."""
        from .notebook.view import View  # noqa: PLC0415 # a view has a tree, and a tree can be viewed

        return View(self._picture, self, css_height=css_height)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it as .html, .json, .svg, or else as text.

        Raises
        ------
        PictureError
            If it cannot be written; what was there before stays.
        """
        forms = {".html": self.to_html, ".json": self.to_json, ".svg": self._native.figure}
        text = forms.get(Path(path).suffix.lower(), self.text)()
        with replacing(path) as beside:
            beside.write_text(text, encoding="utf-8")

    def __reduce__(self) -> tuple[Callable[[Picture, int, int], RayTree], tuple[Picture, int, int]]:
        # Traced again, it has the same bits, and is smaller until then.
        left, top = self._picture.region[:2]
        return _explained, (self._picture, self.pixel[0] - left, self.pixel[1] - top)

    def __str__(self) -> str:
        return self.text()

    def __repr__(self) -> str:
        return f"<RayTree of pixel {self.pixel[0]},{self.pixel[1]} of {self.scene}>"

    def _repr_html_(self) -> str:
        return self._native.text_html()


def _explained(picture: Picture, x: int, y: int) -> RayTree:
    return picture.explain(x, y)


def _tuples(table: Mapping[str, Any]) -> dict[str, Any]:
    return {key: tuple(value) if isinstance(value, list) else value for key, value in table.items()}


def _sample(table: Mapping[str, Any]) -> Sample:
    return Sample(tuple(table["color"]), tuple(table["lost"]), tuple(_node(node) for node in table["nodes"]))


def _node(table: dict[str, Any]) -> Node:
    hit, local = table.pop("hit"), table.pop("local")
    return Node(
        **_tuples(table),
        hit=hit and Hit(**_tuples(hit)),
        local=local
        and Local(**_tuples(local | {"lights": [LightAtHit(**_tuples(light)) for light in local["lights"]]})),
    )
