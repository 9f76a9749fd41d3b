"""A contact sheet: frames side by side, each with what is its own below it. By Pillow."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from PIL import Image, ImageDraw, ImageFont

from .png import damaged

_MOST = 60  # frames; more could not be told apart on a slide
_SHAPE = 16 / 9
_GAP = 0.07  # of the width of a picture
_PAPER, _NAME, _TEXT = "#ffffff", "#8a8f98", "#1f2328"
_SMALLEST_TEXT, _LARGEST_TEXT = 10, 28

Label = Sequence[tuple[str, str]]


@dataclass(frozen=True)
class _Grid:
    """Where everything is, in pixels; `text` is the size of the font."""

    columns: int
    rows: int
    picture: tuple[int, int]
    text: float
    lines: int

    @property
    def gap(self) -> int:
        return round(self.picture[0] * _GAP)

    @property
    def step(self) -> tuple[int, int]:
        label = (0.5 + 1.3 * self.lines) * self.text if self.lines else 0
        return self.picture[0] + self.gap, self.picture[1] + round(label) + self.gap

    @property
    def size(self) -> tuple[int, int]:
        return self.gap + self.columns * self.step[0], self.gap + self.rows * self.step[1]


def sheet(frames: Sequence[Path], labels: Sequence[Label], columns: int | None, width: int) -> Image.Image:
    """Draw all frames, or `_MOST` of them evenly, on a sheet of that width, or less if they are small."""
    count = min(len(frames), _MOST)
    shown = [round(place * (len(frames) - 1) / max(1, count - 1)) for place in range(count)]  # first and last are
    grid = _grid([labels[index] for index in shown], _size(frames[0]), columns, width)
    paper = Image.new("RGB", grid.size, _PAPER)
    draw = ImageDraw.Draw(paper)
    font = ImageFont.load_default(grid.text)
    for place, index in enumerate(shown):
        left = grid.gap + place % grid.columns * grid.step[0]
        top = grid.gap + place // grid.columns * grid.step[1]
        picture = _thumbnail(frames[index], grid.picture)
        spare = [(room - side) // 2 for room, side in zip(grid.picture, picture.size, strict=True)]
        paper.paste(picture, (left + spare[0], top + spare[1]))
        baseline = top + grid.picture[1] + 1.5 * grid.text
        for name, text in labels[index]:
            fitted = _fitted(font, name, text, grid.picture[0] + 0.6 * grid.gap)
            start = left + (grid.picture[0] - font.getlength(_line(name, fitted))) / 2
            draw.text((start, baseline), name, _NAME, font, anchor="ls")
            draw.text((start + font.getlength(_line(name, "")), baseline), fitted, _TEXT, font, anchor="ls")
            baseline += 1.3 * grid.text
    return paper


def _grid(labels: Sequence[Label], frame: tuple[int, int], columns: int | None, width: int) -> _Grid:
    """Return the grid that is closest to the shape of a slide, with few empty places, where all labels fit."""
    count = len(labels)
    lines = max(map(len, labels))
    font = ImageFont.load_default(100)
    longest = max((font.getlength(_line(*value)) / 100 for label in labels for value in label), default=1)

    def grid(columns: int) -> _Grid:
        room = width / (columns * (1 + _GAP) + _GAP)
        scale = min(1, room / frame[0])
        label = min(room, longest * _SMALLEST_TEXT)  # there is room for it below the smallest frame
        picture = (math.floor(max(label, frame[0] * scale)), max(1, round(frame[1] * scale)))
        text = min(_LARGEST_TEXT, 0.12 * picture[0], picture[0] / longest)
        return _Grid(columns, math.ceil(count / columns), picture, max(_SMALLEST_TEXT, text), lines)

    def cost(grid: _Grid) -> float:
        empty = 1 - count / (grid.columns * grid.rows)
        too_long = max(0, longest * grid.text / grid.picture[0] - 1)
        shape = grid.size[0] / grid.size[1]
        return abs(math.log(shape / _SHAPE)) + 2 * empty + 10 * too_long

    return grid(min(columns, count)) if columns else min(map(grid, range(1, count + 1)), key=cost)


def _size(path: Path) -> tuple[int, int]:
    return _thumbnail(path, None).size


def _thumbnail(path: Path, room: tuple[int, int] | None) -> Image.Image:
    """Read a frame, made smaller to fit into some room."""
    try:
        with Image.open(path) as image:
            picture = image.convert("RGB")
    except (OSError, SyntaxError, ValueError) as error:
        raise damaged(path, f"cannot be read: {error}") from error
    if room is not None:
        picture.thumbnail(room, Image.Resampling.LANCZOS)
    return picture


def _line(name: str, text: str) -> str:
    return f"{name}  {text}"


def _fitted(font: ImageFont.FreeTypeFont | ImageFont.ImageFont, name: str, text: str, room: float) -> str:
    """Return a text that ends in dots where it is too long."""
    while font.getlength(_line(name, text)) > room and len(text) > 2:
        text = text[:-2] + "…"
    return text
