"""A second, slow tracer of the lecture and the course, written from their formulas and sharing no code with Snell.

It is recursive where Snell goes by generations, tests every shape against every ray, meets triangles by Cramer's rule
(Möller and Trumbore 1997) where Snell compares edges, and calls NumPy's elementary functions. Agreement between the two
is therefore no accident.
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


def rotation(axis: Array, degrees: float) -> Array:
    """Rodrigues' formula."""
    x, y, z = unit(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def placed(mesh: dict) -> Array:
    """The corners of all faces, faces x 3 x 3, after the steps of the mesh's transform."""
    vertices = np.array(mesh["vertices"], float)
    for step in mesh.get("transform", []):
        if "rotate" in step:
            vertices = vertices @ rotation(np.array(step["rotate"]["axis"], float), step["rotate"]["degrees"]).T
        elif "scale" in step:
            vertices = vertices * np.array(step["scale"], float)
        else:
            vertices = vertices + np.array(step["move"], float)
    return vertices[np.array(mesh["faces"])]


def corner_normals(mesh: dict, corners: Array) -> Array:
    """For each corner the mean normal of the faces around its vertex that lie within the limit of its own face."""
    flat = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    limit = np.cos(np.radians(mesh.get("smooth_angle", 0)))
    normals = np.repeat(flat[:, None], 3, axis=1)
    if mesh.get("smooth_angle", 0) > 0:
        faces = np.array(mesh["faces"])
        for f, face in enumerate(faces):
            for c, vertex in enumerate(face):
                around = flat[(faces == vertex).any(axis=1)]
                normals[f, c] = around[around @ flat[f] >= limit].mean(axis=0)
    return normals


class Tracer:
    """The recursion of one of the three models over a scene as TOML has it."""

    def __init__(self, scene: dict, model: str | None = None) -> None:
        self.model = model or scene["render"]["integrator"]
        self.shadows = scene["render"].get("shadows", "opaque") == "opaque"
        self.depth = scene["render"]["max_depth"]
        self.camera = scene["camera"]
        self.ambient = color(scene["ambient"])
        self.eta_outside = float(scene.get("eta_outside", 1.0))
        self.lights = [
            (np.array(light.get("position", light.get("direction")), float), "position" in light, color(light["color"]))
            for light in scene["light"]
        ]
        spheres, meshes = scene.get("sphere", []), scene.get("mesh", [])
        self.spheres = len(spheres)
        self.center = np.array([sphere["center"] for sphere in spheres], float).reshape(-1, 3)
        self.radius = np.array([sphere["radius"] for sphere in spheres], float)
        self.corners = np.concatenate([placed(mesh) for mesh in meshes] or [np.zeros((0, 3, 3))])
        normals = [corner_normals(mesh, placed(mesh)) for mesh in meshes]
        self.normals = np.concatenate(normals or [np.zeros((0, 3, 3))])
        names = [s["material"] for s in spheres] + [m["material"] for m in meshes for _ in m["faces"]]
        materials = [scene["material"][name] for name in names]
        for name, missing in (("ka", 0), ("kd", 0), ("ks", 0), ("kr", 0), ("ko", 1)):
            setattr(self, name, np.array([color(material.get(name, missing)) for material in materials]))
        self.spow = np.array([material.get("spow", 16) for material in materials], float)
        self.eta = np.array([material.get("eta", 1) for material in materials], float)
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
        """Distance of the nearest hit (infinite if there is none), and which shape it is."""
        to_center = self.center[None] - origin[:, None]
        v = dot(to_center, direction[:, None])
        disc = self.radius**2 - (dot(to_center, to_center) - v**2)
        t = np.where(disc > 0, v - np.sqrt(np.maximum(disc, 0)), np.inf)
        t = np.concatenate([t, self.triangles(origin, direction)[0]], axis=1)
        t = np.where(t > NEAREST, t, np.inf)
        return t.min(axis=1), t.argmin(axis=1)

    def triangles(self, origin: Array, direction: Array) -> tuple[Array, Array, Array]:
        """Distance, β and γ of every ray on every triangle: β ≥ 0, γ ≥ 0, β + γ ≤ 1."""
        a, b, c = (self.corners[None, :, i] for i in range(3))
        across = np.cross(direction[:, None], c - a)
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = 1 / dot(b - a, across)
            offset = origin[:, None] - a
            beta = dot(offset, across) * scale
            turned = np.cross(offset, b - a)
            gamma = dot(direction[:, None], turned) * scale
            t = dot(c - a, turned) * scale
        inside = (beta >= 0) & (gamma >= 0) & (beta + gamma <= 1)
        return np.where(inside, t, np.inf), beta, gamma

    def normal(self, p: Array, direction: Array, origin: Array, k: NDArray[np.intp]) -> Array:
        """Outward on spheres; interpolated and turned to face the ray on triangles."""
        n = np.zeros_like(p)
        on_sphere = k < self.spheres
        n[on_sphere] = p[on_sphere] - self.center[k[on_sphere]]
        rays = np.flatnonzero(~on_sphere)
        if rays.size:
            face = k[rays] - self.spheres
            _, beta, gamma = self.triangles(origin[rays], direction[rays])
            beta, gamma = beta[np.arange(rays.size), face], gamma[np.arange(rays.size), face]
            weights = np.stack([1 - beta - gamma, beta, gamma], axis=1)
            smooth = (weights[:, :, None] * self.normals[face]).sum(axis=1)
            a, b, c = (self.corners[face, i] for i in range(3))
            away = dot(np.cross(b - a, c - a), direction[rays]) > 0
            n[rays] = np.where(away[:, None], -smooth, smooth)
        return unit(n)

    def local(self, p: Array, n: Array, c: Array, k: NDArray[np.intp]) -> Array:
        """Ambient light, and each light that is in front and not in shadow."""
        total = self.ambient * self.ka[k]
        for at, is_point, intensity in self.lights:
            way = at - p if is_point else np.broadcast_to(at, p.shape)
            distance = np.sqrt(dot(way, way)) if is_point else np.full(len(p), np.inf)
            to_light = unit(way)
            nl = dot(n, to_light)
            lit = nl > 0
            if self.shadows:
                blocker, _ = self.nearest(p, to_light)
                lit &= ~(blocker < distance)
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
        n = self.normal(p, direction, origin, k)
        c = -direction
        kr, ko = self.kr[k], self.ko[k]
        # What the parent multiplies the local colour, the mirror ray and the exit ray with.
        if self.model == "lecture":
            own, by_mirror, by_exit, exit_a = a * ko, a * ko, a * (1 - ko), kr * a
        else:
            own, by_mirror, by_exit, exit_a = a, np.ones_like(a), np.ones_like(a), (1 - kr) * a
        light = own * self.local(p, n, c, k)
        if level > 0:
            mirror = 2 * dot(n, c)[:, None] * n - c
            light += by_mirror * self.trace(p, mirror, kr * a, level - 1)
            glass = np.flatnonzero((ko.sum(axis=1) < 3) & (k < self.spheres) & (self.model != "course2018"))
            if glass.size:
                exit_point, leaving, leaves = self.through(p[glass], n[glass], c[glass], k[glass])
                glass = glass[leaves]
                beyond = self.trace(exit_point[leaves], leaving[leaves], exit_a[glass], level - 1)
                light[glass] += by_exit[glass] * beyond
        result[hit] = light
        return result

    def through(self, p: Array, n: Array, c: Array, k: NDArray[np.intp]) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Where a ray leaves the sphere again, in which direction, and whether it does."""
        mu = self.eta_outside / self.eta[k]
        t1, enters = refract(c, n, mu)
        exit_point = p + 2 * dot(self.center[k] - p, t1)[:, None] * t1
        t2, leaves = refract(-t1, unit(self.center[k] - exit_point), 1 / mu)
        return exit_point, t2, enters & leaves
