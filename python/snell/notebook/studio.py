"""Snell Studio in a notebook: the page of ``studio/`` in a cell, which hands back the scene that was edited in it."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any

from .. import _native
from ..errors import SceneError
from .still import Still, in_notebook, open_cell, show

if TYPE_CHECKING:
    from ..scene import Scene

_CSS_HEIGHT = "46rem"
_PAGE = Path(__file__).parent / "page"
#: Bytes at a time: a notebook's server drops what comes faster than a million a second.
_PIECE = 1 << 18
#: Width of the still picture at the start, in pixels.
_STILL = 320
#: The scene at the start.
_FIRST = "first"
_ENDINGS = (".toml", ".json", ".nff", ".txt")


class Studio:
    """A scene in Snell Studio, in the cell of a notebook. What is changed there comes back to Python.

    The picture is rendered in the browser, with the same bits as here.

    Parameters
    ----------
    scene : Scene
        Where it starts; `Scene.studio` supplies it. It stays as it is.
    css_height : str, optional
        Like ``"40rem"``.

    Attributes
    ----------
    scene : Scene
        As it is in the studio now; while its text there has an error, as it was before. Models that were dropped on the
        page have copies on the disk as long as this object lives.

    Raises
    ------
    SceneError
        If the scene cannot be drawn, or the height is not a string; and when it is shown, if this installation lacks
        the page of the studio.

    Examples
    --------
    >>> import snell
    >>> studio = snell.scenes["lecture/default"].studio()
    >>> studio
    <Studio of lecture/default>
    >>> studio.scene == snell.scenes["lecture/default"]
    True
    """

    def __init__(self, scene: Scene, css_height: str | None = None) -> None:
        if not isinstance(css_height, str | None):
            raise SceneError([("css_height", f'expected a length like "40rem", read {css_height!r}', None)])
        self._css_height = css_height or _CSS_HEIGHT
        self._start = scene.replace()
        name, self._text, files, meshes = scene._described().packed(_stem(scene.name))
        above = PurePosixPath(name).parent
        packed = {str(above / mesh): data for mesh, data in meshes}
        self._opened = {_FIRST: _Opened(name, scene.name, scene.folder, dict(files) | packed, meshes)}
        self._current = _FIRST
        self._copies: tempfile.TemporaryDirectory[str] | None = None
        self._stills: list[Still] = []
        self._widget: Any = None

    @property
    def scene(self) -> Scene:
        """The scene as it is in the studio now."""
        now = self._opened[self._current]
        return type(self._start)._of(*_native.unpacked(self._text, now.packed), now.folder, now.title)

    def _ipython_display_(self) -> None:
        still = b""
        if in_notebook():
            still = self.scene.render(width=_STILL, spp=1, progress=False)._repr_png_()
        if not open_cell(self, self._stills, still, "The studio needs"):
            return
        if not (_PAGE / "widget.js").is_file():
            help = "run `make studio` in the clone that it was installed from, and install it again"
            raise SceneError([("studio", "this installation has no page of the studio", help)])
        if self._widget is None:
            from .studio_widget import StudioWidget  # noqa: PLC0415 # anywidget is an extra

            self._widget = StudioWidget(height=self._css_height)
            self._widget.on_msg(self._hear)
        now = self._opened[self._current]
        self._widget.scene = {"name": now.name, "text": self._text, "files": list(now.files), "opened": self._current}
        show(self._widget, "(run the cell for Snell Studio)")

    def _hear(self, widget: Any, message: Any, buffers: Sequence[Any]) -> None:
        """Answer the front end: it needs a file, has changed the scene, or has finished a picture."""
        match message:
            case {"kind": "read", "file": str(file), "from": int(start)} if start >= 0:
                data = self._served(file)
                if data is None:
                    widget.send({"kind": "bytes", "file": file, "from": start})
                else:
                    piece = data[start : start + _PIECE]
                    widget.send({"kind": "bytes", "file": file, "from": start, "size": len(data)}, [piece])
            case {"kind": "scene", "name": str(name), "text": str(text), "opened": str(opened), "files": files}:
                try:
                    if opened not in self._opened:
                        self._opened[opened] = self._copied(name, dict(zip(files, map(bytes, buffers), strict=True)))
                except (OSError, TypeError, ValueError) as error:
                    widget.send({"kind": "error", "message": f"Python could not take this scene: {error}"})
                else:
                    self._current, self._text = opened, text
            case {"kind": "still"} if buffers:
                png = bytes(buffers[0])
                if png.startswith(b"\x89PNG"):
                    for still in self._stills:
                        still.show(png)

    def _served(self, file: str) -> bytes | None:
        """Return a file of the page or of the scene."""
        if file.startswith("scene/"):
            return self._opened[self._current].files.get(file.removeprefix("scene/"))
        known = {f"page/{path.name}": path for path in _PAGE.glob("*.gz")}
        return known[file].read_bytes() if file in known else None

    def _copied(self, name: str, files: Mapping[str, bytes]) -> _Opened:
        """Give the files of a scene that was opened in the page a folder of their own: others still need theirs."""
        if self._copies is None:
            self._copies = tempfile.TemporaryDirectory(prefix="snell-studio-")
        place = Path(self._copies.name) / str(len(self._opened))
        for file, data in files.items():
            parts = _parts(file) if isinstance(file, str) else []
            if not parts:
                raise ValueError(f"{file!r} is no name of a file")
            path = place.joinpath(*parts)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        folder = place.joinpath(*_parts(name)[:-1])
        folder.mkdir(parents=True, exist_ok=True)
        return _Opened(name, _stem(name), folder, dict(files), [])

    def __repr__(self) -> str:
        return f"<Studio of {self._opened[self._current].title}>"


@dataclass(frozen=True)
class _Opened:
    """What was opened: the scene at the start, or another one, in the page."""

    #: What it is called in the page, and in Python.
    name: str
    title: str
    folder: str | os.PathLike[str]
    files: Mapping[str, bytes]
    #: Those of the files that are arrays in Python.
    packed: Sequence[tuple[str, bytes]]


def _parts(name: str) -> list[str]:
    """Return the parts of a name that lead into a folder, whatever it is: not out of it, and nowhere else."""
    parts = name.replace("\\", "/").split("/")
    return [part.replace(":", "_") for part in parts if part not in ("", ".", "..")]


def _stem(name: str) -> str:
    """Return what a scene is called, without folders and without the ending of a file."""
    last = PurePosixPath(name).name
    return next((last.removesuffix(ending) for ending in _ENDINGS if last.endswith(ending)), last) or "scene"
