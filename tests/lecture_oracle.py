"""A second, slow tracer of the lecture, written from its formulas and sharing no code with Snell.

It is recursive where Snell goes by generations, tests every sphere against every ray, and calls NumPy's
elementary functions. Agreement between the two is therefore no accident.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

NEAREST = 1e-5  # the lecture's own: a hit nearer than this is none


def dot(a: Array, b: Array) -> Array:
    return (a * b).sum(axis=-1)


def unit(v: Array) -> Array:
    return v / np.sqrt(dot(v, v))[..., None]


def color(value: float | list[float]) -> Array:
    return np.broadcast_to(np.asarray(value, dtype=float), 3)


def refract(w: Array, n: Array, mu: Array) -> tuple[Array, NDArray[np.bool_]]:
    """T = αW + βN with α = −μ, β = μ(W·N) − √(1 − μ² + μ²(W·N)²); and where it exists."""
    wn = dot(w, n)
    radicand = 1 - mu**2 + mu**2 * wn**2
    beta = mu * wn - np.sqrt(np.maximum(radicand, 0))
    return -mu[..., None] * w + beta[..., None] * n, radicand >= 0


class Lecture:
    """The lecture's recursion over a scene as TOML has it."""

    def __init__(self, scene: dict) -> None:
        self.shadows = scene["render"].get("shadows", "opaque") == "opaque"
        self.depth = scene["render"]["max_depth"]
        self.camera = scene["camera"]
        self.ambient = color(scene["ambient"])
        self.eta_outside = float(scene["eta_outside"])
        self.lights = [(np.array(light["position"], float), color(light["color"])) for light in scene["light"]]
        materials = [scene["material"][sphere["material"]] for sphere in scene["sphere"]]
        self.center = np.array([sphere["center"] for sphere in scene["sphere"]], float)
        self.radius = np.array([sphere["radius"] for sphere in scene["sphere"]], float)
        for name in ("ka", "kd", "ks", "kr", "ko"):
            setattr(self, name, np.array([color(material[name]) for material in materials]))
        self.spow = np.array([material["spow"] for material in materials], float)
        self.eta = np.array([material["eta"] for material in materials], float)

    def picture(self, width: int, height: int) -> Array:
        camera = self.camera
        eye = np.array(camera["eye"], float)
        left, right, bottom, top = camera["bounds"]
        w = unit(eye - np.array(camera["look_at"], float))
        u = unit(np.cross(np.array(camera["up"], float), w))
        v = np.cross(w, u)
        j, i = np.meshgrid(np.arange(height), np.arange(width), indexing="ij")
        px = left + i / (width - 1) * (right - left)
        py = top - j / (height - 1) * (top - bottom)
        p = eye + camera["near"] * w + px[..., None] * u + py[..., None] * v
        p = p.reshape(-1, 3)
        ones = np.ones((len(p), 3))
        return self.trace(p, unit(p - eye), ones, self.depth).reshape(height, width, 3)

    def nearest(self, origin: Array, direction: Array) -> tuple[Array, NDArray[np.intp]]:
        """Distance of the nearest hit (infinite if there is none), and which sphere it is."""
        to_center = self.center[None] - origin[:, None]
        v = dot(to_center, direction[:, None])
        disc = self.radius**2 - (dot(to_center, to_center) - v**2)
        t = v - np.sqrt(np.maximum(disc, 0))
        t = np.where((disc > 0) & (t > NEAREST), t, np.inf)
        return t.min(axis=1), t.argmin(axis=1)

    def local(self, p: Array, n: Array, c: Array, k: NDArray[np.intp]) -> Array:
        """Ambient light, and each light that is in front and not in shadow."""
        total = self.ambient * self.ka[k]
        for position, intensity in self.lights:
            to_light = unit(position - p)
            nl = dot(n, to_light)
            lit = nl > 0
            if self.shadows:
                blocker, _ = self.nearest(p, to_light)
                lit &= ~(blocker < np.sqrt(dot(position - p, position - p)))
            mirror = 2 * nl[:, None] * n - to_light
            cr = dot(c, mirror)
            highlight = np.where(lit & (cr > 0), np.maximum(cr, 0) ** self.spow[k], 0.0)
            total = total + np.where(lit, nl, 0.0)[:, None] * self.kd[k] * intensity
            total = total + highlight[:, None] * self.ks[k] * intensity
        return total

    def trace(self, origin: Array, direction: Array, a: Array, level: int) -> Array:
        result = np.zeros_like(origin)
        t, k = self.nearest(origin, direction)
        hit = np.flatnonzero(np.isfinite(t))
        if hit.size == 0:
            return result
        origin, direction, a, t, k = origin[hit], direction[hit], a[hit], t[hit], k[hit]
        p = origin + t[:, None] * direction
        n = unit(p - self.center[k])
        c = -direction
        ko = self.ko[k]
        light = a * ko * self.local(p, n, c, k)
        if level > 0:
            mirror = 2 * dot(n, c)[:, None] * n - c
            light += a * ko * self.trace(p, mirror, self.kr[k] * a, level - 1)
            glass = np.flatnonzero(ko.sum(axis=1) < 3)
            if glass.size:
                exit_point, leaving, leaves = self.through(p[glass], n[glass], c[glass], k[glass])
                glass = glass[leaves]
                beyond = self.trace(exit_point[leaves], leaving[leaves], self.kr[k[glass]] * a[glass], level - 1)
                light[glass] += a[glass] * (1 - ko[glass]) * beyond
        result[hit] = light
        return result

    def through(self, p: Array, n: Array, c: Array, k: NDArray[np.intp]) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Where a ray leaves the sphere again, in which direction, and whether it does."""
        mu = self.eta_outside / self.eta[k]
        t1, enters = refract(c, n, mu)
        exit_point = p + 2 * dot(self.center[k] - p, t1)[:, None] * t1
        t2, leaves = refract(-t1, unit(self.center[k] - exit_point), 1 / mu)
        return exit_point, t2, enters & leaves
