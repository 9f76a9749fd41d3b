"""Many pictures of one scene, with values that change."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ._native import __version__
from .errors import SceneError
from .scene import Scene

_NOTES = "sweep.json"


def sweep(scene: Scene, values: Mapping[str, Iterable[object]], out: str | os.PathLike[str], **how: Any) -> list[Path]:
    """Render a frame for each step of some values, and skip what is done already.

    The folder remembers in ``sweep.json`` of what each frame was made: a sweep that was stopped goes on where it was,
    one of a changed scene starts again. ^C stops it, and raises KeyboardInterrupt.

    Parameters
    ----------
    scene : Scene
        What all frames have in common.
    values : dict of str to sequence
        By the keys of `Scene.with_`; all of one length, and they go on together.
    out : path
        The folder of the frames, ``0000.png`` and so on; it is made if need be.
    **how
        What `Scene.render` takes.

    Returns
    -------
    list of Path
        The frames.

    Raises
    ------
    SceneError
        If the values are not of one length, or a scene is wrong.

    Examples
    --------
    >>> import snell, tempfile
    >>> folder = tempfile.TemporaryDirectory()
    >>> frames = sweep(snell.scenes["lecture/default"], {"material.glass.eta": [1.0, 1.5]}, folder.name, width=32)
    >>> [frame.name for frame in frames]
    ['0000.png', '0001.png']
    >>> folder.cleanup()
    """
    columns = {key: list(column) for key, column in values.items()}
    lengths = {len(column) for column in columns.values()}
    if len(lengths) > 1:
        said = ", ".join(f"{key} has {len(column)}" for key, column in columns.items())
        raise SceneError([("values", f"expected as many values of each: {said}", None)])
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    notes = _read(folder / _NOTES)
    frames = []
    for index in range(lengths.pop() if lengths else 1):
        changed = scene
        for key, column in columns.items():
            changed = changed.with_(key, column[index])
        frame = folder / f"{index:04}.png"
        made_of = _digest(changed, how)
        if notes.get(frame.name) != made_of or not frame.is_file():
            picture = changed.render(**how)
            if not picture.finished:
                raise KeyboardInterrupt
            picture.save(frame)
            notes[frame.name] = made_of
            # Under another name first: a note that is half written would cost all frames.
            (folder / f"{_NOTES}.new").write_text(json.dumps(notes))
            (folder / f"{_NOTES}.new").replace(folder / _NOTES)
        frames.append(frame)
    return frames


def _read(path: Path) -> dict[str, str]:
    try:
        notes = json.loads(path.read_text())
    except (OSError, ValueError):
        return {}
    return notes if isinstance(notes, dict) else {}


def _digest(scene: Scene, how: Mapping[str, Any]) -> str:
    """Return what decides the bits of a frame, but for the files of models."""
    bits = {key: value for key, value in how.items() if key not in ("threads", "progress")}
    digest = hashlib.sha256(json.dumps([__version__, scene.folder, scene.plain(), bits], default=str).encode())
    for arrays in (mesh.arrays("mesh") for mesh in scene.mesh):
        for array in arrays or ():
            digest.update(array.tobytes())
    return digest.hexdigest()
