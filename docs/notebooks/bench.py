"""An optical bench for the notebooks: single rays of Snell's, sent where one wants them."""

from __future__ import annotations

import numpy as np
from snell import Camera, Material, Render, Scene


def bench(materials: dict[str, Material], **shapes) -> Scene:
    """Return a scene of which only the rays matter; it has no light, and needs none."""
    return Scene(settings=Render("whitted"), camera=Camera((0, 0, 0), (1, 0, 0), (0, 0, 1)), materials=materials, **shapes)


def ray(scene: Scene, start, degrees: float = 0.0, depth: int = 3, least: float = 0.0, bands: int = 16):
    """Send one ray from `start`, at an angle to the x axis in the plane of x and y, and return its tree.

    It is the only ray of a picture of 1 x 1 pixel, whose camera looks along it.
    """
    start, angle = np.asarray(start, dtype=float), np.radians(degrees)
    ahead = np.array((np.cos(angle), np.sin(angle), 0.0))
    camera = Camera(start, start + ahead, (0, 0, 1), fov=1, width=1, height=1)
    settings = Render("whitted", max_depth=depth, min_throughput=least, bands=bands)
    return scene.replace(camera=camera, settings=settings).render(progress=False).explain(0, 0)


def ways(tree, *kinds: str) -> list:
    """Return the ways from the camera by rays of these kinds, one after the other; dispersion makes several."""
    found = [[tree.nodes[0]]]
    for kind in kinds:
        found = [[*way, node] for way in found for node in tree.nodes if node.parent == way[-1].id and node.kind == kind]
    return found
