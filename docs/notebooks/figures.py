"""What the notebooks draw with: pictures in a row, and curves. Only NumPy is needed."""

from __future__ import annotations

import struct
import zlib
from html import escape

import numpy as np
from IPython.display import SVG, display


class Image:
    """An array of linear colour, which a notebook shows as the lecture does: 0 to 1 becomes 0 to 255."""

    def __init__(self, array):
        array = np.asarray(array, dtype=float)
        self.array = array if array.ndim == 3 else np.repeat(array[..., None], 3, axis=2)

    def _repr_png_(self) -> bytes:
        height, width, _ = self.array.shape
        levels = np.rint(255 * np.clip(self.array, 0, 1)).astype(np.uint8).reshape(height, 3 * width)
        rows = np.pad(levels, ((0, 0), (1, 0)))  # each row of a PNG begins with its filter: 0, none

        def chunk(kind: bytes, data: bytes) -> bytes:
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        head = struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)
        body = chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + chunk(b"IEND", b"")
        return b"\x89PNG\r\n\x1a\n" + body


def srgb(picture):
    """Return a picture by the curve of screens, which all scenes but the lecture's are made for."""
    linear = np.clip(picture, 0, 1)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def row(pictures: dict, zoom: int = 1) -> None:
    """Show pictures of one height beside each other, and under them what they are, from left to right."""
    arrays = [Image(picture).array for picture in pictures.values()]
    gap = np.ones((arrays[0].shape[0], 6, 3))
    strip = np.concatenate([part for array in arrays for part in (array, gap)][:-1], axis=1)
    display(Image(strip.repeat(zoom, axis=0).repeat(zoom, axis=1)))
    print("from left to right:  " + "  |  ".join(pictures))


def curves(x, ys: dict, xlabel: str, ylabel: str, top: float, marks: dict | None = None) -> None:
    """Draw curves over x, which breaks where they are NaN, and vertical lines at the marks."""
    width, height, left, foot = 560, 300, 60, 50
    right, head = 15, 15
    x = np.asarray(x, dtype=float)
    colors = ("#1f5fa8", "#c2410c", "#2f7d32", "#7b2d8b", "#555555")

    def across(value):
        return left + (value - x.min()) / (x.max() - x.min()) * (width - left - right)

    def up(value):
        return height - foot - value / top * (height - foot - head)

    parts = [f'<rect width="{width}" height="{height}" fill="white"/>']
    for value in np.linspace(x.min(), x.max(), 7 if np.ptp(x) == 300 else 10):
        parts.append(f'<text x="{across(value):.1f}" y="{height - foot + 16}" text-anchor="middle">{value:g}</text>')
    for value in np.linspace(0, top, 7 if top == 60 else 6):
        parts.append(f'<path d="M{left} {up(value):.1f}H{width - right}" stroke="#dddddd"/>')
        parts.append(f'<text x="{left - 6}" y="{up(value) + 4:.1f}" text-anchor="end">{value:.3g}</text>')
    for label, value in (marks or {}).items():
        parts.append(f'<path d="M{across(value):.1f} {head}V{height - foot}" stroke="#888888" stroke-dasharray="4 3"/>')
        parts.append(f'<text x="{across(value) - 4:.1f}" y="{head + 12}" text-anchor="end">{escape(label)}</text>')
    for index, (label, values) in enumerate(ys.items()):
        y = np.asarray(values, dtype=float)
        runs = np.split(np.arange(len(x)), np.flatnonzero(np.diff(np.isfinite(y))) + 1)
        for run in (run for run in runs if np.isfinite(y[run[0]])):
            points = " ".join(f"{across(x[i]):.1f},{up(y[i]):.1f}" for i in run)
            parts.append(f'<polyline points="{points}" fill="none" stroke="{colors[index]}" stroke-width="2"/>')
        low = head + 34 + 18 * index
        parts.append(f'<text x="{left + 10}" y="{low}" fill="{colors[index]}">{escape(label)}</text>')
    parts.append(f'<text x="{(left + width) / 2}" y="{height - 12}" text-anchor="middle">{escape(xlabel)}</text>')
    turned = f"translate(16 {(height - foot) / 2}) rotate(-90)"
    parts.append(f'<text transform="{turned}" text-anchor="middle">{escape(ylabel)}</text>')
    start = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif"'
    display(SVG(f'{start} font-size="12">{"".join(parts)}</svg>'))


def ball(paths: list, radius: float, extent: tuple, labels: dict) -> None:
    """Draw rays, each an array of points (x, y), with a ball around the origin, and points with their names."""

    def circle(at, scale):
        x, y = at((0, 0)).split(",")
        return f'<circle cx="{x}" cy="{y}" r="{radius * scale:.1f}" fill="#dbe8f4" stroke="#1f5fa8"/>'

    _rays(paths, circle, extent, labels)


def prism(paths: list, corners, extent: tuple, labels: dict, colors: list) -> None:
    """Draw rays, each in its colour, with a piece of glass between corners."""

    def polygon(at, scale):
        return f'<polygon points="{" ".join(map(at, corners))}" fill="#dbe8f4" stroke="#1f5fa8"/>'

    _rays(paths, polygon, extent, labels, colors)


def _rays(paths: list, glass, extent: tuple, labels: dict, colors: list | None = None) -> None:
    left, right, low, high = extent
    scale = 640 / (right - left)
    width, height = 640, round((high - low) * scale)

    def at(point):
        return f"{(point[0] - left) * scale:.1f},{(high - point[1]) * scale:.1f}"

    parts = [f'<rect width="{width}" height="{height}" fill="white"/>', glass(at, scale)]
    for path, color in zip(paths, colors or ["#c2410c"] * len(paths)):
        points = " ".join(map(at, path))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="1.2"/>')
    for label, point in labels.items():
        x, y = at(point).split(",")
        parts.append(f'<circle cx="{x}" cy="{y}" r="3"/><text x="{x}" y="{float(y) - 8:.1f}">{escape(label)}</text>')
    start = f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif"'
    display(SVG(f'{start} font-size="12">{"".join(parts)}</svg>'))
