"""Why a pixel has its colour: the tree of its rays. ``docs/explain.md`` describes its form."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
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
    """What a ray met. Angles are in degrees, to the normal, before and behind the surface."""

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
class LightThere:
    """What a light does at a surface."""

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
    """The light that a surface itself sends out, before opacity and throughput weigh it."""

    ambient: Numbers
    emission: Numbers
    lights: tuple[LightThere, ...]


@dataclass(frozen=True)
class Node:
    """A ray. The contributions of a sample's nodes, added one by one, are its colour to the bit."""

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
    """A sample of the pixel: its colour, the throughput of rays that were not followed, and its rays, parents first."""

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
    """Why a pixel has its colour, as `Picture.explain` says it.

    Attributes
    ----------
    scene, integrator : str
    pixel, size : (int, int)
        Column and row; width and height of the whole picture.
    color : (float, float, float)
        As in the film.
    sentence : str
        What a person would say first.
    samples : tuple of Sample

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
        """Draw the strongest way: at each surface the normal, the rays with their angles, the critical angle."""
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

    def __str__(self) -> str:
        return self.text()

    def __repr__(self) -> str:
        return f"<RayTree of pixel {self.pixel[0]},{self.pixel[1]} of {self.scene}>"

    def _repr_html_(self) -> str:
        return self._native.text_html()


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
        and Local(**_tuples(local | {"lights": [LightThere(**_tuples(light)) for light in local["lights"]]})),
    )
