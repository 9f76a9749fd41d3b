"""What Python and the studio in a notebook tell each other. Only here anywidget is needed."""

from pathlib import Path

import anywidget
import traitlets


class StudioWidget(anywidget.AnyWidget):
    """The model of the widget in ``studio/src/notebook/widget.ts``."""

    _esm = Path(__file__).parent / "page" / "widget.js"
    #: Its name, its text, and the names of its files.
    scene = traitlets.Dict().tag(sync=True)
    height = traitlets.Unicode().tag(sync=True)
