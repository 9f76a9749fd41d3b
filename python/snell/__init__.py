"""Snell: a ray tracer that shows its work.

Examples
--------
>>> import snell
>>> picture = snell.scenes["lecture/default"].render()
>>> print(picture.explain(190, 300).sentence)
Green because 53 % of this pixel is the sphere `green`, seen through `glass` (in at 43.1° → 20.0°); 47 % is the sphere
`glass` itself.
"""

from . import optics
from ._native import __version__
from .channels import Channels
from .errors import OpticsError, PictureError, RenderError, SceneError, SnellError, SnellWarning
from .movie.frames import Sweep
from .notebook.interact import Interactive, interact
from .notebook.studio import Studio
from .notebook.view import View
from .part import Part
from .parts import Box, Camera, Disc, Globe, Lathe, Light, Material, Mesh, Plane, Render, Sky, Sphere, Texture
from .picture import Difference, Picture, Sightings
from .scene import Scene, scenes
from .sweep import sweep
from .tree import Figure, Hit, LightAtHit, Local, Node, RayTree, Sample

__all__ = [
    "Box", "Camera", "Channels", "Difference", "Disc", "Figure", "Globe", "Hit", "Interactive", "Lathe", "Light",
    "LightAtHit", "Local", "Material", "Mesh", "Node", "OpticsError", "Part", "Picture", "PictureError", "Plane",
    "RayTree", "Render", "RenderError", "Sample", "Scene", "SceneError", "Sightings", "Sky", "SnellError",
    "SnellWarning", "Sphere", "Studio", "Sweep", "Texture", "View", "__version__", "interact", "optics", "scenes",
    "sweep",
]  # fmt: skip
