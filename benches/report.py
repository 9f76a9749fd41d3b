"""Writes docs/performance.md and its plot from docs/performance.json:   python3 benches/report.py"""

from __future__ import annotations

import statistics

from plot import Panel, Series, svg
from record import ROOT, results

PAGE = ROOT / "docs" / "performance.md"
PLOT = ROOT / "docs" / "pictures" / "growth.svg"

HEAD = """# Performance
"""

FOOT = """## How to measure it yourself

    make bench         # kernels, trees, rays and pictures
    make bench-peers   # against other programs, and how cost grows

Each section says on which machine, when, and with which command it was measured. `make bench-peers` compares with POV-Ray and Embree 3
if they are installed (Debian 12: `sudo apt-get install povray g++ libembree-dev`), and leaves out the rest. Both record their
measurements in `docs/performance.json`, and `benches/report.py` generates this page from it: no number is typed by hand. Times depend on
the machine, ratios less so; mind their spread. `snell render` reports the time of each picture.
"""

HOW = """\
A ratio is taken within a round, in which every program runs once; the table shows the median over the rounds, the smallest
and the largest, and the ratio of the best times, which other jobs disturb least. For "times as fast" more is better, for "times
as long" and "times as much" less. Programs are compared one thread against one. The time of POV-Ray is the trace time that it
reports itself, that of Snell is `render::render_into` with an existing film, which excludes the allocation of its memory.
For rays it is the time from arrays of rays to arrays of hits; both programs get the same rays and the same mesh, in
numbers that `f32` can represent. Embree computes in `f32`, Snell in `f64`.
"""

FLAKES = """\
The sphereflake is the same picture in both programs, but for a few pixels at silhouettes and edges of shadows.
`snell diff`: {flakes}.
The background is black in both, the ground a polygon in POV-Ray and two triangles in Snell; POV-Ray stops following a
branch that weighs less than 1/255, Snell follows all. The default scene is not the same picture: POV-Ray has no model
like the lecture's, and uses its own glass and mirrors with the same coefficients and depth.
"""

GLASS = """\
The glass knot (`whitted`, index 1.5, no branch below 1/255) without shadows is the same picture in both programs, but for pixels
in which the chessboard is strongly minified. `snell diff`: {glass}.
The board is a polygon with a pattern in POV-Ray and 8192 triangles in Snell. Where light falls through the glass, both send
their shadow rays straight through it: in POV-Ray they lose nothing, in Snell the Fresnel reflectance at each face.
"""


def disturbed(about: dict) -> bool:
    """Did other jobs take so much of the machine that times mean little?"""
    return about["others"] > 0.1


def heading(about: dict) -> str:
    lines = [f"{about['date']}, {about['machine']}.", f"Snell {about['snell']}, {about['rustc']}."]
    if about.get("peers"):
        lines.append(f"{', '.join(about['peers'])}; {about['rounds']} rounds.")
    if "others" in about:
        verdict = ": **too much, measure again**" if disturbed(about) else ""
        lines.append(f"Other jobs kept {about['others']:.2f} cores busy meanwhile{verdict}.")
    return "\n".join(lines) + f" Command: `{about['command']}`\n"


def table(head: list[str], rows: list[list[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)


def digits(value: float, count: int = 3) -> str:
    """So many digits, without an exponent."""
    return f"{value:#.{count}g}".rstrip(".") if value < 10**count - 0.5 else f"{value:.0f}"


def seconds(value: float) -> str:
    for factor, unit in ((1, "s"), (1e3, "ms"), (1e6, "µs")):
        if value * factor >= 1:
            return f"{digits(value * factor)} {unit}"
    return f"{digits(value * 1e9)} ns"


def spread(values: list[float], show=digits) -> str:
    return f"{show(min(values))} to {show(max(values))}"


def measured(peers: dict) -> str:
    rows = []
    for row in peers["rows"]:
        if values := row["ratios"]:
            more = "times as long" if row["value"] == "seconds" else "times as much"
            unit = "times as fast" if row["sense"] == "at least" else more
            result = [f"**{digits(statistics.median(values))}** {unit}", spread(values), digits(row["best"])]
        else:
            result = [row["missing"], "", ""]
        against = "Snell, one thread" if row["peer"] == "Snell" else row["peer"]
        what = row["what"].replace("two threads against one:", "two threads:")
        rows.append([what, against, *result])
    return table(["what", "compared with", "Snell is, or takes", "spread", "best times"], rows)


def goals(peers: dict) -> str:
    rows = []
    for row in peers["rows"]:
        goal = f"{row['sense']} {row['goal']:g}"
        if values := row["ratios"]:
            median = statistics.median(values)
            reached = median >= row["goal"] if row["sense"] == "at least" else median <= row["goal"]
            # Bytes do not mind other jobs.
            verdict = "disturbed" if disturbed(peers) and row["value"] == "seconds" else "yes" if reached else "not yet"
            result = [digits(median), verdict]
        else:
            result = [row["missing"], ""]
        rows.append([row["what"], row["peer"], goal, *result])
    reached = sum(row[-1] == "yes" for row in rows)
    head = f"<details><summary>Goals, of which {reached} of {len(rows)} are reached</summary>\n"
    return "\n".join([head, table(["what", "compared with", "goal", "measured", "reached"], rows), "</details>\n"])


def times(peers: dict) -> str:
    rows = []
    for timing in peers["timings"]:
        taken = [answer["seconds"] for answer in timing["answers"]]
        rays = timing["answers"][0].get("rays")
        rate = f"{digits(rays / statistics.median(taken) / 1e6)} million rays/s" if rays else ""
        median = seconds(statistics.median(taken))
        rows.append([timing["program"], f"`{timing['question']}`", median, spread(taken, seconds), rate])
    return table(["program", "command (last number: threads)", "median", "spread", ""], rows)


def agreement(peers: dict) -> str:
    rows = []
    for pair in peers["agreement"]:
        cells = [pair["kind"]]
        for answer in (pair["snell"], pair["embree"]):
            mean = f"{answer['mean_t']:.6f}" if answer["mean_t"] else ""
            cells += [f"{100 * answer['hits'] / answer['rays']:.3f} %", mean]
        rows.append([*cells, "yes" if pair["agree"] else "**no**"])
    return table(["rays", "Snell: hits", "mean distance", "Embree: hits", "mean distance", "agree"], rows)


def compared(peers: dict) -> str:
    parts = ["## Against peers\n", measured(peers), heading(peers), HOW, goals(peers)]
    if peers["agreement"]:
        parts += ["Do Snell and Embree find the same hits?\n", agreement(peers)]
    if "flakes" in peers:
        parts.append(FLAKES.format(flakes=peers["flakes"]))
    if "glass" in peers:
        parts.append(GLASS.format(glass=peers["glass"]))
    return "\n".join([*parts, "All times:", "", times(peers)])


def grown(growth: dict) -> str:
    def of(section: str, x, y) -> list[tuple[float, float]]:
        return [(x(point), y(point)) for point in growth[section]]

    def count(point: dict) -> float:
        return point["x"]

    def area(point: dict) -> float:
        return point["x"] ** 2

    def picture(point: dict) -> float:
        return point["frame"]["seconds"]

    size_ticks = [(area(point), f"{point['x']}²") for point in growth["pixels"]]
    depth_ticks = [(point["x"] + 1.0, str(point["x"] + 1)) for point in growth["depth"]]
    first = growth["pixels"][0]
    panels = [
        Panel("Spheres: scattered, 512 × 512, depth 2", "spheres", "time [s]", [
            Series("picture", of("spheres", count, picture)),
            Series("building", of("spheres", count, lambda p: p["build"]["seconds"])),
        ]),
        Panel("Pixels: default scene, depth 6", "pixels", "time [s]", [
            Series("picture", of("pixels", area, picture)),
            Series("in proportion", of("pixels", area, lambda p: picture(first) * area(p) / area(first)), dashed=True),
        ], size_ticks),
        Panel("Depth: 100 000 spheres, 512 × 512", "generations of rays (depth + 1)", "time [s]", [
            Series("picture", of("depth", lambda p: p["x"] + 1, picture)),
        ], depth_ticks),
        Panel("Memory: default scene, depth 6", "pixels", "memory [MB]", [
            Series("peak of the process", of("pixels", area, lambda p: p["frame"]["peak_bytes"] / 1e6)),
            Series("film alone", of("pixels", area, lambda p: p["film_bytes"] / 1e6), dashed=True),
        ], size_ticks),
    ]
    PLOT.write_text(svg(panels))
    spheres = []
    for p in growth["spheres"]:
        each = digits(p["build"]["bytes"] / p["x"])
        spheres.append([f"{p['x']}", seconds(p["build"]["seconds"]), seconds(picture(p)), each])
    pixels = []
    for p in growth["pixels"]:
        peak, film = p["frame"]["peak_bytes"], p["film_bytes"]
        memory = [f"{size / 1e6:.1f} MB" for size in (peak, film, peak - film)]
        pixels.append([f"{p['x']} x {p['x']}", seconds(picture(p)), seconds(picture(p) / area(p)), *memory])
    depth = [[f"{p['x']}", seconds(picture(p)), f"{p['frame']['rays']:.0f}"] for p in growth["depth"]]
    return "\n".join([
        "## Scaling\n",
        heading(growth),
        "One thread; the best of up to five times.",
        "",
        f"![Time against spheres, pixels and depth; memory against pixels](pictures/{PLOT.name})",
        "",
        table(["spheres", "building", "picture", "bytes per sphere"], spheres),
        table(["picture", "time", "per pixel", "peak memory", "film", "difference"], pixels),
        table(["depth", "time", "rays"], depth),
    ])


def kernels(section: dict) -> str:
    rows = []
    for bench in section["criterion"]:
        low, high = (seconds(v * 1e-9) for v in bench["interval"])
        each = seconds(bench["nanoseconds"] * 1e-9 / bench["elements"]) if bench["elements"] else ""
        rows.append([bench["name"], seconds(bench["nanoseconds"] * 1e-9), f"{low} to {high}", each])
    parts = [
        "## Kernels, trees, rays, pictures\n",
        heading(section),
        "One thread. Median, its 95 % confidence interval, and the time per ray, primitive or pixel. A kernel\n"
        "processes 1024 rays per call.",
        "",
        table(["what", "median", "95 %", "per item"], rows),
    ]
    counted = section["instructions"]
    if isinstance(counted, str):
        parts.append(f"Instructions are not counted: {counted}.\n")
    else:
        lines = [[f"`{question}`", digits(n / 1e6, 4)] for question, n in counted.items()]
        parts.append(table(["command", "million instructions"], lines))
    return "\n".join(parts)


def main() -> None:
    found = results()
    sections = {"peers": compared, "growth": grown, "kernels": kernels}
    PAGE.write_text("\n".join([HEAD, *(write(found[name]) for name, write in sections.items() if name in found), FOOT]))
    print(f"written: {PAGE.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
