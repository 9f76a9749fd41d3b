"""Many pictures of one scene, with values that change."""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import how as how_of
from ._native import NativeWorld, __version__
from .errors import Finding, PictureError, SceneError
from .files import replacing
from .how import How
from .movie import png
from .movie.frames import Sweep
from .picture import Picture
from .progress import Note, Watch, duration, watcher
from .scene import Scene, pictured, warn_of
from .values import plain

if TYPE_CHECKING:
    from typing_extensions import Unpack

_NOTES = "sweep.json"
_LIBRARY = re.compile(rb"^[ \t]*mtllib[ \t]+(.*\S)", re.MULTILINE)


def sweep(
    scene: Scene,
    values: Mapping[str, Iterable[object]],
    out: str | os.PathLike[str],
    *,
    progress: bool | Watch = True,
    client: object = None,
    task_seconds: float = 4.0,
    **how: Unpack[How],
) -> Sweep:
    """Render a frame for each step of some values, and skip finished frames.

    The folder remembers in ``sweep.json`` what each frame was made from: a stopped sweep continues where it was,
    one of a changed scene, or of changed models and images, starts again, and a frame that is gone or damaged is
    rendered again. ^C stops it and raises KeyboardInterrupt. Each warning is issued once, not for every frame.

    Parameters
    ----------
    scene : Scene
        What all frames have in common.
    values : dict of str to sequence
        By the keys of `Scene.with_`; all of one length, and they advance together.
    out : path
        The folder of the frames, ``0000.png`` and so on; it is made if need be.
    progress : bool or callable
        A bar over all frames; or a function that is called with pixels done, pixels in all (of all frames), and rays.
    client, task_seconds : distributed.Client, float, optional
        Render on a Dask cluster, as for `Scene.render`. Quick frames are one task each; the folder is on this
        machine.
    **how
        What else `Scene.render` takes: width, height, crop, spp, depth, seed, integrator, shadows, threads.

    Returns
    -------
    Sweep
        The frames: a sequence of paths with `Sweep.sheet` and `Sweep.save`.

    Raises
    ------
    SceneError
        If the values are not of one length, `Scene.render` has no such parameter, or a scene is wrong.
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
    if not isinstance(values, Mapping):
        message = f"expected a dict of keys, each with a list of values, read {values!r}"
        raise SceneError([("values", message, 'like {"material.glass.eta": [1.0, 1.5]}')])
    said = how_of.said(how, How)
    columns = {key: _column(key, column) for key, column in values.items()}
    lengths = {len(column) for column in columns.values()}
    if len(lengths) > 1:
        counts = ", ".join(f"{key} has {len(column)}" for key, column in columns.items())
        raise SceneError([("values", f"expected as many values of each: {counts}", None)])

    def changed(index: int) -> Scene:
        frame = scene
        for key, column in columns.items():
            frame = frame.with_(key, column[index])
        return frame

    folder = Path(out)
    frames = tuple(folder / f"{index:04}.png" for index in range(lengths.pop() if lengths else 1))
    triangles, contents = _triangles(scene), _Contents()
    # A wrong value is found now, before there is a folder.
    made_of = [_digest(changed(index), triangles, contents, said) for index in range(len(frames))]
    _make(folder)
    notes = _read(folder / _NOTES)
    missing = [
        index
        for index, frame in enumerate(frames)
        if notes.get(frame.name) != made_of[index] or not png.is_whole(frame)
    ]
    known: set[Finding] = set()
    done, rays = len(frames) - len(missing), 0
    most = (0, 0)
    with watcher(progress, scene.name, _note(len(frames), done)) as watch:

        def within(pixels: int, total: int, more: int) -> None:
            nonlocal most
            # With a cluster several frames are under way, and what was counted once stays counted.
            most = (max(most[0], done * total + pixels), max(most[1], rays + more))
            if watch:
                watch(most[0], len(frames) * total, most[1])

        drawn = (
            _one_by_one((missing, changed), known, within if watch else None, said)
            if client is None
            else _on_cluster((missing, changed), known, within, said, (client, task_seconds))
        )
        with closing(drawn):
            for index, picture in drawn:
                picture.save(frames[index])
                notes[frames[index].name] = made_of[index]
                with replacing(folder / _NOTES) as beside:  # a note that is half written would cost all frames
                    beside.write_text(json.dumps(notes))
                done, rays = done + 1, rays + picture.rays
                within(0, picture.width * picture.height, 0)
    return Sweep(frames, columns)


def _one_by_one(
    frames: tuple[Sequence[int], Callable[[int], Scene]],
    known: set[Finding],
    watch: Watch | None,
    said: Mapping[str, Any],
) -> Generator[tuple[int, Picture]]:
    """Render frames here."""
    missing, changed = frames
    for index in missing:
        picture = changed(index)._rendered(known, watch or False, said)
        if not picture.finished:
            raise KeyboardInterrupt
        yield index, picture


def _on_cluster(
    frames: tuple[Sequence[int], Callable[[int], Scene]],
    known: set[Finding],
    watch: Watch,
    said: Mapping[str, Any],
    cluster: tuple[object, float],
) -> Generator[tuple[int, Picture]]:
    """Render frames on a cluster, in the order in which they are done."""
    from .cluster.engine import Cluster  # noqa: PLC0415 # Dask is not needed otherwise
    from .cluster.pictures import render_all  # noqa: PLC0415 # Dask is not needed otherwise

    if how_of.threads(said) != 0:
        raise SceneError([("threads", "a task of a cluster has one thread", "leave it out")])
    (missing, changed), names = frames, dict[int, str]()

    def worlds() -> Iterator[tuple[int, NativeWorld]]:
        for index in missing:
            frame = changed(index)
            names[index] = frame.name
            world = frame._compiled(said)
            warn_of(world.warnings(), known)
            yield index, world

    for index, native in render_all(worlds(), len(missing), how_of.region(said), watch, Cluster(*cluster)):
        yield index, pictured(native, names[index], known)


def _column(key: str, column: Iterable[object]) -> list[Any]:
    """Return the values of a key as JSON has them."""
    try:
        each = None if isinstance(column, str | bytes | Mapping) else iter(column)
    except TypeError:  # of an array without dimensions, too
        each = None
    if each is None:
        raise SceneError([(key, f"expected a list of values, one for each frame, read {column!r}", None)])
    return [plain(value, f"{key}, frame {index}") for index, value in enumerate(each)]


def _make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (OSError, ValueError) as error:  # a NUL in a path is a ValueError
        reason = getattr(error, "strerror", None) or error
        place = str(folder).replace("\0", r"\0")
        raise PictureError([(place, f"is no folder for frames: {reason}", None)]) from error


def _note(count: int, before: int) -> Note:
    """Return what the bar of a sweep says, where some frames were there before."""

    def note(pixels: int, total: int, rays: int, seconds: float) -> str:
        del rays
        fresh = pixels * count / total - before
        left = f"  {duration(seconds / fresh * (count - before - fresh))} left" if fresh > 0 else ""
        return f"frame {min(count, pixels * count // total + 1)} of {count}{left}"

    return note


def _read(path: Path) -> dict[str, str]:
    try:
        notes = json.loads(path.read_text())
    except (OSError, ValueError, RecursionError):  # someone else's, however deep: no notes
        return {}
    return notes if isinstance(notes, dict) else {}


def _triangles(scene: Scene) -> str:
    """Return a digest of the triangles that no value of a sweep changes."""
    digest = hashlib.sha256()
    for arrays in (mesh.arrays("mesh") for mesh in scene.meshes):
        for array in arrays or ():
            digest.update(array.tobytes())
    return digest.hexdigest()


class _Contents:
    """What is in the files of models and images, each read once in a sweep."""

    def __init__(self) -> None:
        self._known: dict[Path, list[str]] = {}

    def of(self, table: Mapping[str, Any], folder: Path) -> list[list[str]]:
        """Return digests of the files that a scene names; what is not there, or no name, is left to the renderer."""
        named = [*table["mesh"], *table["texture"].values(), table.get("sky", {})]
        names = [entry.get(key) for entry in named for key in ("file", "image")]
        return [self._digests(folder / name) for name in names if isinstance(name, str)]

    def _digests(self, path: Path) -> list[str]:
        """Return those of a file and, if it is a model, of its libraries of materials."""
        if path not in self._known:
            data = _bytes(path)
            names = _LIBRARY.findall(data) if path.suffix.lower() == ".obj" else []
            all_of_it = [data, *(_bytes(path.parent / os.fsdecode(name)) for name in names)]
            self._known[path] = [hashlib.sha256(each).hexdigest() for each in all_of_it]
        return self._known[path]


def _bytes(path: Path) -> bytes:
    try:
        return path.read_bytes() if path.is_file() else b""
    except (OSError, ValueError):
        return b""


def _digest(scene: Scene, triangles: str, contents: _Contents, how: Mapping[str, Any]) -> str:
    """Return what decides the bits of a frame."""
    table = scene.plain()
    files = contents.of(table, Path(scene.folder))
    bits = {key: value for key, value in how.items() if key != "threads"}
    said = json.dumps([__version__, scene.folder, table, triangles, files, bits])
    return hashlib.sha256(said.encode()).hexdigest()
