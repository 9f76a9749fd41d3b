"""POV-Ray's side of the comparison: the same scenes in its language, and the trace times that it reports itself.

`max_trace_level` counts the camera ray, so that 7 means depth 6. `right -x` makes its world right-handed.
"""

from __future__ import annotations

import math
import re
import shutil
import subprocess
from pathlib import Path

HEAD = """#version 3.7;
global_settings {{ assumed_gamma 1.0 max_trace_level {level} ambient_light rgb {ambient} }}
background {{ rgb {background} }}
"""

Vector = tuple[float, float, float]


def default_scene() -> str:
    """The lecture's default scene, `ko` read as opacity: POV-Ray's own optics, so not the same picture."""
    text = HEAD.format(level=7, ambient=0.2, background=0)
    # Half the picture is 2 wide at a distance of 5.
    angle = math.degrees(2 * math.atan(2 / 5))
    text += f"""camera {{ perspective location <50,50,100> right -x up y angle {angle:.12f} sky y look_at <50,50,10> }}
light_source {{ <20,100,100> rgb 0.75 }}
light_source {{ <80,100,100> rgb 0.75 }}
"""
    # POV-Ray multiplies `ambient` by the pigment, hence 0.2/0.6 for the glass.
    text += """sphere { <50,50,50>, 9 pigment { rgb .6 transmit .5 }
  finish { ambient 0.33333 diffuse 1 phong .5 phong_size 64 reflection { .9 } } interior { ior 2.0 } }
"""
    for color, center in (("<1,0,0>", "<35,60,20>"), ("<0,1,0>", "<65,60,20>"), ("<0,0,1>", "<50,35,20>")):
        text += f"""sphere {{ {center}, 9 pigment {{ rgb {color} }}
  finish {{ ambient 1 diffuse 1 phong 1 phong_size 32 reflection {{ .9 }} }} interior {{ ior 1.3 }} }}
"""
    return text


def turned(v: Vector, axis: Vector) -> Vector:
    """The vector under the smallest rotation that takes +z to `axis`."""
    cos = axis[2]
    if cos <= -1:
        return -v[0], v[1], -v[2]
    if cos >= 1:
        return v
    kx, ky = -axis[1], axis[0]
    along = (kx * v[0] + ky * v[1]) / (1 + cos)
    return v[0] * cos + ky * v[2] + kx * along, v[1] * cos - kx * v[2] + ky * along, v[2] * cos + kx * v[1] - ky * v[0]


def flake(levels: int) -> list[tuple[Vector, float]]:
    """Centres and radii as in `src/flake.rs`."""
    spots = [(15 + 60 * i, 0.0) for i in range(6)] + [(45 + 120 * i, math.asin(2 / math.sqrt(6))) for i in range(3)]
    around = [(math.radians(azimuth), elevation) for azimuth, elevation in spots]
    outward = [(math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)) for a, e in around]
    balls: list[tuple[Vector, float]] = []

    def grow(level: int, center: Vector, radius: float, axis: Vector) -> None:
        balls.append((center, radius))
        if level > 0:
            x, y, z = center
            for direction in outward:
                out = turned(direction, axis)
                s = radius * 4 / 3
                grow(level - 1, (x + s * out[0], y + s * out[1], z + s * out[2]), radius / 3, out)

    grow(levels, (0.0, 0.0, 0.0), 0.5, (0.0, 0.0, 1.0))
    return balls


def sphereflake(levels: int) -> str:
    text = HEAD.format(level=5, ambient=0, background=0)
    text += "camera { perspective location <2.1,1.3,1.7> right -x up y angle 45 sky z look_at <0,0,0> }\n"
    for light in ("<4,3,2>", "<1,-4,4>", "<-3,1,5>"):
        text += f"light_source {{ {light} rgb {1 / math.sqrt(3):.9f} }}\n"
    text += """polygon { 5, <12,12,-.5>, <-12,12,-.5>, <-12,-12,-.5>, <12,-12,-.5>, <12,12,-.5>
  pigment { rgb <1,.75,.33> } finish { ambient 0 diffuse .8 } }
#declare T = texture { pigment { rgb <1,.9,.7> }
  finish { ambient 0 diffuse .5 phong .5 phong_size 37 reflection { .5 } } }
"""
    lines = [f"sphere{{<{x:.9f},{y:.9f},{z:.9f}>,{r:.9f} texture{{T}}}}\n" for (x, y, z), r in flake(levels)]
    return text + "".join(lines)


def knot(nu: int, nv: int, r: float) -> tuple[list[Vector], list[Vector], list[tuple[int, int, int]]]:
    """Positions, normals and faces as in `src/knot.rs`."""

    def cross(a: Vector, b: Vector) -> Vector:
        return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]

    def unit(v: Vector) -> Vector:
        return tuple(c / math.hypot(*v) for c in v)

    positions, normals, faces = [], [], []
    for i in range(nu):
        u = 2 * math.pi * i / nu
        sin, cos = math.sin(2 * u), math.cos(2 * u)
        a, da = 2 + math.cos(3 * u), -3 * math.sin(3 * u)
        center = (a * cos, a * sin, math.sin(3 * u))
        tangent = (da * cos - 2 * a * sin, da * sin + 2 * a * cos, 3 * math.cos(3 * u))
        b = unit(cross(tangent, center))
        n = unit(cross(b, tangent))
        for j in range(nv):
            v = 2 * math.pi * j / nv
            normals.append(tuple(nk * math.cos(v) + bk * math.sin(v) for nk, bk in zip(n, b)))
            positions.append(tuple(c + r * k for c, k in zip(center, normals[-1])))
            p, q, s, t = ((i + k) % nu * nv + (j + m) % nv for k, m in ((0, 0), (1, 0), (1, 1), (0, 1)))
            faces += [(p, q, s), (p, s, t)]
    return positions, normals, faces


def glass_knot(shadows: str) -> str:
    """Glass without highlights, like that of Snell. It takes nothing from light that goes through: `no_shadow` leaves
    the picture as it is, and only spares the work."""
    text = HEAD.format(level=8, ambient=0, background="<.4,.55,.8>")
    text += "camera { perspective location <6,-5,4.5> right -x up y angle 50 sky z look_at <0,0,0> }\n"
    text += "light_source { <8,-2,9> rgb .8 }\nlight_source { <-4,-8,7> rgb .5 }\n"
    text += """polygon { 5, <32,32,-1.6>, <-32,32,-1.6>, <-32,-32,-1.6>, <32,-32,-1.6>, <32,32,-1.6>
  pigment { checker rgb <.9,.9,.9> rgb <.15,.15,.2> } finish { ambient 0 diffuse .8 } }
"""
    parts = zip(("vertex_vectors", "normal_vectors", "face_indices"), knot(500, 100, 0.45))
    rows = "\n".join(f"{name} {{ {len(rows)}, {','.join(map(vector, rows))} }}" for name, rows in parts)
    return text + f"""mesh2 {{ {rows} inside_vector z {shadows}
  texture {{ pigment {{ rgbt 1 }} finish {{ ambient 0 diffuse 0 reflection {{ 0, 1 fresnel on }} conserve_energy }} }}
  interior {{ ior 1.5 }} }}
"""


def vector(v: Vector) -> str:
    return "<" + ",".join(f"{c:.9g}" for c in v) + ">"


SCENES = {
    "default": default_scene,
    "flake:5": lambda: sphereflake(5),
    "glass:off": lambda: glass_knot("no_shadow"),
    "glass:tinted": lambda: glass_knot(""),
}


class PovRay:
    """Answers to `frame SCENE SIZE THREADS` as the other workers do."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        for name, write in SCENES.items():
            self.file(name).write_text(write())

    @staticmethod
    def version() -> str | None:
        """What it calls itself, or nothing if it is not installed."""
        if not shutil.which("povray"):
            return None
        said = subprocess.run(["povray", "--version"], capture_output=True, text=True, errors="replace").stderr
        found = re.search(r"POV-Ray (\d\S*)", said)
        return f"POV-Ray {found[1]}" if found else "POV-Ray"

    def file(self, scene: str) -> Path:
        return self.folder / f"{scene.replace(':', '-')}.pov"

    def ask(self, line: str) -> dict[str, float]:
        _, scene, size, threads = line.split()
        source = self.file(scene)
        command = ["povray", f"+I{source.name}", f"+O{source.stem}.png", f"+W{size}", f"+H{size}", "-A", "-D", "-V"]
        command.append(f"+WT{threads}")
        done = subprocess.run(command, cwd=self.folder, capture_output=True, text=True, errors="replace")
        found = re.search(r"Trace Time:\s.*?\(([\d.]+) seconds\)", done.stderr + done.stdout, re.S)
        if done.returncode or not found:
            raise RuntimeError(f"{' '.join(done.args)} failed:\n{done.stderr[-2000:]}")
        return {"seconds": float(found[1])}
