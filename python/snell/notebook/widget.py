"""What Python and the front end of a view tell each other. Only here anywidget is needed."""

import anywidget
import traitlets

from .._native import viewer_script


class ViewWidget(anywidget.AnyWidget):
    """The model of the widget in ``viewer/src/widget.ts``."""

    # The viewer is a classic script with one global; anywidget loads modules.
    _esm = f"{viewer_script()}\nexport default SnellViewer.widget;\n"
    #: As `snell::explain::ViewScene` writes it.
    scene = traitlets.Dict().tag(sync=True)
    #: The JSON form of an explanation.
    tree = traitlets.Dict(default_value=None, allow_none=True).tag(sync=True)
    #: PNG.
    picture = traitlets.Bytes().tag(sync=True)
    title = traitlets.Unicode().tag(sync=True)
    height = traitlets.Unicode().tag(sync=True)
