"""Snell Studio in a notebook: the page of ``studio/`` in a cell, which hands back the scene that was edited in it."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
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
        self._name: str = scene.name
        self._folder: str | os.PathLike[str] = scene.folder
        name, self._text, files, meshes = scene._described().packed(PurePosixPath(scene.name).stem or "scene")
        above = str(PurePosixPath(name).parent)
        self._packed = meshes
        self._files = dict(files) | {f"{above}/{mesh}" if above != "." else mesh: data for mesh, data in meshes}
        self._page_name = name
        self._dropped: tempfile.TemporaryDirectory[str] | None = None
        self._stills: list[Still] = []
        self._widget: Any = None

    @property
    def scene(self) -> Scene:
        """The scene as it is in the studio now."""
        return type(self._start)._of(*_native.unpacked(self._text, self._packed), self._folder, self._name)

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
        self._widget.scene = {"name": self._page_name, "text": self._text, "files": list(self._files)}
        show(self._widget, "(run the cell for Snell Studio)")

    def _hear(self, widget: Any, message: Any, buffers: Sequence[Any]) -> None:
        """Answer the front end: it needs a file, has changed the scene, or has finished a picture."""
        match message:
            case {"kind": "read", "file": str(file), "from": int(start)}:
                data = self._served(file)
                if data is None:
                    widget.send({"kind": "bytes", "file": file, "from": start})
                else:
                    piece = data[start : start + _PIECE]
                    widget.send({"kind": "bytes", "file": file, "from": start, "size": len(data)}, [piece])
            case {"kind": "scene", "name": str(name), "text": str(text), "files": files}:
                if files is not None:
                    self._take_files(name, dict(zip(files, map(bytes, buffers), strict=False)))
                self._text = text
            case {"kind": "still"} if buffers:
                png = bytes(buffers[0])
                if png.startswith(b"\x89PNG"):
                    for still in self._stills:
                        still.show(png)

    def _served(self, file: str) -> bytes | None:
        """Return a file of the page or of the scene."""
        if file.startswith("scene/"):
            return self._files.get(file.removeprefix("scene/"))
        known = {f"page/{path.name}": path for path in _PAGE.glob("*.gz")}
        return known[file].read_bytes() if file in known else None

    def _take_files(self, name: str, files: Mapping[str, bytes]) -> None:
        """Another scene was opened in the page: its files get a folder."""
        self._files, self._packed = dict(files), []
        self._page_name, self._name = name, PurePosixPath(name).stem
        self._dropped = tempfile.TemporaryDirectory(prefix="snell-studio-")
        for file, data in files.items():
            path = self._dropped_path(file)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(data)
        self._folder = self._dropped_path(name).parent
        self._folder.mkdir(parents=True, exist_ok=True)

    def _dropped_path(self, name: str) -> Path:
        """Return where a file goes: nowhere but into that folder, whatever it is called."""
        assert self._dropped is not None
        parts = [part for part in PurePosixPath(name).parts if part not in ("/", "..")]
        return Path(self._dropped.name).joinpath(*parts)

    def __repr__(self) -> str:
        return f"<Studio of {self._name}>"
