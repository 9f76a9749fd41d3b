"""Plots with two logarithmic axes, as SVG."""

from __future__ import annotations

import math
from dataclasses import dataclass

WIDTH, HEIGHT = 430, 330  # of a panel, in pixels
LEFT, RIGHT, TOP, BOTTOM = 70, 14, 40, 54
COLORS = ("#1f5a94", "#c2571a", "#6b6b6b")
FONT = "font-family='Helvetica, Arial, sans-serif' fill='#222'"


@dataclass
class Series:
    name: str
    points: list[tuple[float, float]]
    dashed: bool = False  # not measured


@dataclass
class Panel:
    title: str
    x: str
    y: str
    series: list[Series]
    ticks: list[tuple[float, str]] | None = None  # of the x axis; powers of ten if not given


def decades(values: list[float]) -> tuple[int, int]:
    low, high = math.floor(math.log10(min(values)) + 1e-9), math.ceil(math.log10(max(values)) - 1e-9)
    return low, max(high, low + 1)


def power(exponent: int) -> str:
    """A power of ten as people write it."""
    if -3 <= exponent <= 3:
        return f"{10.0**exponent:g}"
    return "10" + str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def text(x: float, y: float, content: str, anchor: str = "middle", size: int = 12, extra: str = "") -> str:
    place = f"x='{x:.1f}' y='{y:.1f}' text-anchor='{anchor}'"
    return f"<text {place} font-size='{size}' {FONT}{extra}>{content}</text>"


def line(x1: float, y1: float, x2: float, y2: float, color: str) -> str:
    return f"<line x1='{x1:.1f}' y1='{y1:.1f}' x2='{x2:.1f}' y2='{y2:.1f}' stroke='{color}'/>"


def draw(panel: Panel) -> str:
    points = [point for series in panel.series for point in series.points]
    xs = [math.log10(x) for x, _ in points]
    x_low, x_high = min(xs), max(xs)
    y_low, y_high = decades([y for _, y in points])
    right, bottom = WIDTH - RIGHT, HEIGHT - BOTTOM
    inset = 12  # keeps the first and last mark off the frame

    def px(x: float) -> float:
        return LEFT + inset + (math.log10(x) - x_low) / (x_high - x_low) * (right - LEFT - 2 * inset)

    def py(y: float) -> float:
        return bottom - (math.log10(y) - y_low) / (y_high - y_low) * (bottom - TOP)

    out = [text(LEFT, 22, panel.title, "start", 14, " font-weight='bold'")]
    for exponent in range(y_low, y_high + 1):
        at = py(10.0**exponent)
        out += [line(LEFT, at, right, at, "#ddd"), text(LEFT - 6, at + 4, power(exponent), "end")]
    ticks = panel.ticks or [(10.0**n, power(n)) for n in range(math.ceil(x_low), math.floor(x_high) + 1)]
    for value, label in ticks:
        out += [line(px(value), TOP, px(value), bottom, "#ddd"), text(px(value), bottom + 18, label)]
    out.append(f"<rect x='{LEFT}' y='{TOP}' width='{right - LEFT}' height='{bottom - TOP}' fill='none' stroke='#888'/>")
    out.append(text((LEFT + right) / 2, HEIGHT - 14, panel.x))
    middle = (TOP + bottom) / 2
    out.append(text(18, middle, panel.y, extra=f" transform='rotate(-90 18 {middle:.1f})'"))
    for number, (series, color) in enumerate(zip(panel.series, COLORS)):
        path = " ".join(f"{px(x):.1f},{py(y):.1f}" for x, y in series.points)
        dash = " stroke-dasharray='5 4'" if series.dashed else ""
        out.append(f"<polyline points='{path}' fill='none' stroke='{color}' stroke-width='1.6'{dash}/>")
        if not series.dashed:
            out += [f"<circle cx='{px(x):.1f}' cy='{py(y):.1f}' r='3' fill='{color}'/>" for x, y in series.points]
        y, length = TOP + 18 + 17 * number, 40 + 6.3 * len(series.name)
        out.append(f"<rect x='{LEFT + 8}' y='{y - 12}' width='{length:.0f}' height='16' fill='#fff'/>")
        key = f"x1='{LEFT + 12}' y1='{y - 4}' x2='{LEFT + 36}' y2='{y - 4}'"
        out.append(f"<line {key} stroke='{color}' stroke-width='1.6'{dash}/>")
        out.append(text(LEFT + 42, y, series.name, "start"))
    return "".join(f"{element}\n" for element in out)


def svg(panels: list[Panel]) -> str:
    """Two panels in a row."""
    width, height = 2 * WIDTH, HEIGHT * ((len(panels) + 1) // 2)
    out = f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}' width='{width}' height='{height}'>\n"
    out += f"<rect width='{width}' height='{height}' fill='#fff'/>\n"
    for number, panel in enumerate(panels):
        out += f"<g transform='translate({number % 2 * WIDTH} {number // 2 * HEIGHT})'>\n{draw(panel)}</g>\n"
    return out + "</svg>\n"
