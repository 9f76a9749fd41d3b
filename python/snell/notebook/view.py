"""The scene in 3D, in a notebook: `viewer/` as a widget, with a still picture where no front end answers."""

from __future__ import annotations

import json
from typing import Any

from ..errors import PictureError, SnellError
from ..picture import Picture
from ..tree import RayTree
from .still import Still, open_cell, show

_CSS_HEIGHT = "34rem"


class View:
    """A scene in 3D: objects, lights, and the camera with the picture in front of it.

    It is looked at from anywhere, through the scene's camera, or from a light. A click on a pixel of the picture draws
    the tree of its rays. A saved notebook keeps a still picture of it.

    Parameters
    ----------
    picture : Picture
        A whole one; `Scene.view`, `Picture.view` and `RayTree.view` supply it.
    tree : RayTree, optional
        Whose rays are drawn.
    css_height : str, optional
        Like ``"40rem"``.

    Attributes
    ----------
    picture : Picture
    tree : RayTree or None
        Of the pixel that was clicked on last.

    Raises
    ------
    PictureError
        If the picture is a part of one, or the height no text.

    Examples
    --------
    >>> import snell
    >>> snell.scenes["lecture/default"].view(width=64)
    <View of lecture/default, 64 x 64>
    """

    def __init__(self, picture: Picture, tree: RayTree | None = None, *, css_height: str | None = None) -> None:
        if picture.region != (0, 0, *picture.full_size):
            raise PictureError([("view", "only a whole picture fits in front of the camera", "view it before crop")])
        if not isinstance(css_height, str | None):
            raise PictureError([("css_height", f'expected a length like "40rem", read {css_height!r}', None)])
        self._picture = picture
        self._css_height = css_height or _CSS_HEIGHT
        self._stills: list[Still] = []
        self._widget: Any = None
        self.tree = tree

    @property
    def picture(self) -> Picture:
        """What hangs in front of the camera."""
        return self._picture

    @property
    def tree(self) -> RayTree | None:
        """Whose rays are drawn."""
        return self._tree

    @tree.setter
    def tree(self, tree: RayTree | None) -> None:
        if not isinstance(tree, RayTree | None) or (tree and tree._picture._native is not self.picture._native):
            raise PictureError([("view.tree", f"expected a tree of this picture, read {tree!r}", None)])
        self._tree = tree
        if self._widget is not None:
            self._widget.tree = _plain(tree)
            self._widget.send_state("tree")  # also if it is the same: the front end waits for it

    def explain(self, x: int, y: int) -> RayTree:
        """Draw the rays of a pixel, as a click on it does."""
        self.tree = tree = self.picture.explain(x, y)
        return tree

    def _ipython_display_(self) -> None:
        if not open_cell(self, self._stills, self.picture._repr_png_(), "The view in 3D needs"):
            return
        from .widget import ViewWidget  # noqa: PLC0415 # anywidget is an extra

        if self._widget is None:
            self._widget = ViewWidget(
                scene=json.loads(self.picture._native.view()),
                picture=self.picture._repr_png_(),
                tree=_plain(self.tree),
                title=self.picture.name,
                height=self._css_height,
            )
            self._widget.on_msg(self._hear)
        show(self._widget, "(run the cell for the view in 3D)")

    def _hear(self, widget: Any, message: Any, buffers: list[Any]) -> None:
        """Answer the front end: a pixel was clicked on, or it has drawn something."""
        match message:
            case {"kind": "explain", "pixel": [x, y]}:
                try:
                    self.explain(x, y)
                except SnellError as error:
                    widget.send({"kind": "error", "message": str(error)})
            case {"kind": "explain"}:
                widget.send({"kind": "error", "message": f"expected a pixel, read {message.get('pixel')!r}"})
            case {"kind": "still"} if buffers and isinstance(buffers[0], bytes | memoryview):
                png = bytes(buffers[0])
                if png.startswith(b"\x89PNG"):
                    for still in self._stills:
                        still.show(png)

    def __repr__(self) -> str:
        return f"<View of {self.picture.name}, {self.picture.width} x {self.picture.height}>"


def _plain(tree: RayTree | None) -> dict[str, Any] | None:
    return None if tree is None else json.loads(tree.to_json())
