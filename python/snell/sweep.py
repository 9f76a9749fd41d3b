"""Many pictures of one scene, with values that change."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from ._native import __version__
from .errors import Finding, PictureError, SceneError
from .movie import png
from .movie.files import replacing
from .movie.frames import Sweep
from .progress import Note, Watch, watcher
from .scene import Scene
from .values import plain

_NOTES = "sweep.json"


def sweep(
    scene: Scene,
    values: Mapping[str, Iterable[object]],
    out: str | os.PathLike[str],
    *,
    progress: bool | Watch = True,
    **how: Any,
) -> Sweep:
    """Render a frame for each step of some values, and skip what is done already.

    The folder remembers in ``sweep.json`` of what each frame was made: a sweep that was stopped goes on where it was,
    one of a changed scene starts again, and a frame that is gone or damaged is rendered anew. ^C stops it, and raises
    KeyboardInterrupt. What is odd is warned of once, not with each frame.

    Parameters
    ----------
    scene : Scene
        What all frames have in common.
    values : dict of str to sequence
        By the keys of `Scene.with_`; all of one length, and they go on together.
    out : path
        The folder of the frames, ``0000.png`` and so on; it is made if need be.
    progress : bool or callable
        A bar over all frames; or what is called with the pixels of all frames that are done, that there are, and rays.
    **how
        What else `Scene.render` takes.

    Returns
    -------
    Sweep
        The frames: a sequence of paths with `Sweep.sheet` and `Sweep.save`.

    Raises
    ------
    SceneError
        If the values are not of one length, or a scene is wrong.
    PictureError
        If a frame cannot be written.

    Examples
    --------
    >>> import snell, tempfile
    >>> folder = tempfile.TemporaryDirectory()
    >>> frames = sweep(snell.scenes["lecture/default"], {"material.glass.eta": [1.0, 1.5]}, folder.name, width=32)
    >>> [frame.name for frame in frames]
    ['0000.png', '0001.png']
    >>> folder.cleanup()
    """
    columns = {key: _column(key, column) for key, column in values.items()}
    lengths = {len(column) for column in columns.values()}
    if len(lengths) > 1:
        said = ", ".join(f"{key} has {len(column)}" for key, column in columns.items())
        raise SceneError([("values", f"expected as many values of each: {said}", None)])

    def changed(index: int) -> Scene:
        frame = scene
        for key, column in columns.items():
            frame = frame.with_(key, column[index])
        return frame

    folder = Path(out)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise PictureError([(str(folder), f"is no folder for frames: {error.strerror}", None)]) from error
    frames = tuple(folder / f"{index:04}.png" for index in range(lengths.pop() if lengths else 1))
    notes = _read(folder / _NOTES)
    triangles = _triangles(scene)
    made_of = [_digest(changed(index), triangles, how) for index in range(len(frames))]  # a wrong value is found now
    missing = [
        index
        for index, frame in enumerate(frames)
        if notes.get(frame.name) != made_of[index] or not png.is_whole(frame)
    ]
    known: set[Finding] = set()
    done, rays = len(frames) - len(missing), 0
    with watcher(progress, scene.name, _note(len(frames), done)) as watch:
        for index in missing:
            within = watch and _within(watch, done, len(frames), rays)
            picture = changed(index)._rendered(known, progress=within or False, **how)
            if not picture.finished:
                raise KeyboardInterrupt
            picture.save(frames[index])
            notes[frames[index].name] = made_of[index]
            with replacing(folder / _NOTES) as beside:  # a note that is half written would cost all frames
                beside.write_text(json.dumps(notes))
            done, rays = done + 1, rays + picture.rays
            if watch:
                pixels = picture.width * picture.height
                watch(done * pixels, len(frames) * pixels, rays)
    return Sweep(frames, columns)


def _column(key: str, column: Iterable[object]) -> list[Any]:
    """Return the values of a key as JSON has them."""
    if isinstance(column, str | bytes | Mapping) or not isinstance(column, Iterable):
        raise SceneError([(key, f"expected a list of values, one for each frame, read {column!r}", None)])
    return [plain(value, f"{key}, frame {index}") for index, value in enumerate(column)]


def _within(watch: Watch, done: int, count: int, rays: int) -> Watch:
    """Return what watches one frame, where `done` of `count` are done."""
    return lambda pixels, total, more: watch(done * total + pixels, count * total, rays + more)


def _note(count: int, before: int) -> Note:
    """Return what the bar of a sweep says, where some frames were there before."""

    def note(pixels: int, total: int, rays: int, seconds: float) -> str:
        del rays
        fresh = pixels * count / total - before
        left = f"  {_duration(seconds / fresh * (count - before - fresh))} left" if fresh > 0 else ""
        return f"frame {min(count, pixels * count // total + 1)} of {count}{left}"

    return note


def _duration(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours} h {minutes:02} min" if hours else f"{minutes} min {seconds:02} s" if minutes else f"{seconds} s"


def _read(path: Path) -> dict[str, str]:
    try:
        notes = json.loads(path.read_text())
    except (OSError, ValueError):
        return {}
    return notes if isinstance(notes, dict) else {}


def _triangles(scene: Scene) -> str:
    """Return a digest of the triangles that no value of a sweep changes."""
    digest = hashlib.sha256()
    for arrays in (mesh.arrays("mesh") for mesh in scene.mesh):
        for array in arrays or ():
            digest.update(array.tobytes())
    return digest.hexdigest()


def _digest(scene: Scene, triangles: str, how: Mapping[str, Any]) -> str:
    """Return what decides the bits of a frame, but for the files of models."""
    bits = {key: value for key, value in how.items() if key != "threads"}
    said = json.dumps([__version__, scene.folder, scene.plain(), triangles, bits], default=str)
    return hashlib.sha256(said.encode()).hexdigest()
