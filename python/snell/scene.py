"""A whole scene: from files, from Python, to pictures."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from . import _native
from .errors import Finding, SceneError, warn
from .parts import Box, Camera, Lathe, Light, Material, Mesh, Plane, Render, Sky, Sphere, Texture
from .picture import Picture, Sightings
from .progress import watcher
from .values import Color, Value, plain

if TYPE_CHECKING:
    from .notebook.view import View

_LISTS: Mapping[str, type[Value]] = {
    "light": Light, "sphere": Sphere, "mesh": Mesh, "plane": Plane, "box": Box, "lathe": Lathe,
}  # fmt: skip
_TABLES: Mapping[str, type[Value]] = {"render": Render, "camera": Camera, "sky": Sky}
_NAMED: Mapping[str, type[Value]] = {"material": Material, "texture": Texture}
_MOST_THREADS = 4096
_REMARKS = ("W202 lost-light", "W203 black-picture")  # told by the picture, which may be meant so


@dataclass(eq=False, repr=False, kw_only=True)
class Scene(Value):
    """Everything that a picture depends on. Its fields are the keys of a scene file, but for `settings`.

    Parameters
    ----------
    settings : Render
        The table ``render`` of a file.
    camera : Camera
    light, sphere, mesh, plane, box, lathe : sequences
    material : dict of str to Material, or a sequence of Material
        Those of a sequence are called by their number from 0.
    texture : dict of str to Texture
    ambient, background : float or (3,)
    sky : Sky, optional
    eta_outside : float
    folder : str
        What file names are relative to.
    name : str
        For titles.

    Examples
    --------
    >>> import snell
    >>> scene = snell.scenes["lecture/default"]
    >>> diamond = scene.with_("material.glass.eta", 2.42)
    >>> diamond.material["glass"].eta, diamond == scene
    (2.42, False)
    """

    settings: Render
    camera: Camera
    ambient: Color = 0.0
    background: Color = 0.0
    sky: Sky | None = None
    eta_outside: float = 1.0
    light: Sequence[Light] = ()
    material: Mapping[str, Material] | Sequence[Material] = field(default_factory=dict)
    texture: Mapping[str, Texture] = field(default_factory=dict)
    sphere: Sequence[Sphere] = ()
    mesh: Sequence[Mesh] = ()
    plane: Sequence[Plane] = ()
    box: Sequence[Box] = ()
    lathe: Sequence[Lathe] = ()
    folder: str = "."
    name: str = "scene"

    beside: ClassVar[frozenset[str]] = frozenset({"folder", "name"})
    colors: ClassVar[frozenset[str]] = frozenset({"ambient", "background"})

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Scene:
        """Read a scene file (TOML, JSON), a driver of the course, an NFF file, or a built-in scene.

        Raises
        ------
        SceneError
            With the line of the file.

        Examples
        --------
        >>> Scene.load("lecture/default").camera.eye
        (50.0, 50.0, 100.0)
        """
        name = os.fspath(path)
        if not isinstance(name, str):
            raise SceneError([("path", f"expected a text or a path, read {path!r}", None)])
        text, arrays, folder = _native.read(name)
        return cls._of(text, arrays, str(folder), name)

    @classmethod
    def _of(cls, text: str, arrays: _native.Arrays, folder: str, name: str) -> Scene:
        table = json.loads(text)
        fields: dict[str, Any] = {"folder": folder, "name": name}
        for key, value in table.items():
            if key in _LISTS:
                fields[key] = [_LISTS[key].of(element) for element in value]
            elif key in _NAMED:
                fields[key] = {name: _NAMED[key].of(element) for name, element in value.items()}
            elif key in _TABLES:
                fields["settings" if key == "render" else key] = _TABLES[key].of(value)
            elif key not in ("snell", "$schema"):
                fields[key] = tuple(value) if isinstance(value, list) else value
        for mesh, triangles in zip(fields.get("mesh", []), arrays, strict=True):
            if triangles is not None:
                mesh.vertices, mesh.faces = triangles
        return cls(**fields)

    def plain(self, place: str = "") -> dict[str, Any]:
        """Return the scene as JSON has it, without the triangles of its meshes.

        Raises
        ------
        SceneError
            For what JSON cannot say, and for materials that are not there.
        """
        del place  # it is the root
        self._check("render", self.settings, Render)
        self._check("camera", self.camera, Camera)
        if self.sky is not None:
            self._check("sky", self.sky, Sky)
        for key in ("material", *_LISTS):
            value = getattr(self, key)
            if not isinstance(value, Sequence | Mapping) or isinstance(value, str):
                raise SceneError([(key, f"expected a list, read {value!r}", None)])
        for key in sorted(self.beside):
            if not isinstance(getattr(self, key), str | os.PathLike):
                raise SceneError([(key, f"expected a text, read {getattr(self, key)!r}", None)])
        materials = self._materials()
        table: dict[str, Any] = {"snell": 1, **super().plain()}
        table = {("render" if key == "settings" else key): value for key, value in table.items()}
        table["material"] = {name: material.plain(f"material.{name}") for name, material in materials.items()}
        for key, kind in _LISTS.items():
            for index, element in enumerate(list(getattr(self, key))):
                self._check(f"{key}[{index}]", element, kind)
            for index, element in enumerate(table[key]):
                for reference in ("material", "inside", "outside"):
                    if reference in element:
                        at = f"{key}[{index}].{reference}"
                        element[reference] = _material_name(element[reference], list(materials), at)
        size = [table["camera"].pop(side, None) for side in ("width", "height")]
        if None not in size and table["render"].setdefault("size", size) != size:
            message = f"the camera has {size[0]} x {size[1]} pixels, settings.size says {table['render']['size']}"
            raise SceneError([("camera.width", message, "leave one of them out")])
        return table

    @staticmethod
    def _check(place: str, value: object, kind: type[Value]) -> None:
        if type(value) is not kind:
            raise SceneError([(place, f"expected a {kind.__name__}, read {value!r}", None)])

    def _materials(self) -> dict[str, Material]:
        given = self.material
        named = list(given.items()) if isinstance(given, Mapping) else [(str(i), m) for i, m in enumerate(list(given))]
        for name, material in named:
            self._check(f"material.{name}", material, Material)
        return {str(name): material for name, material in named}

    def _arrays(self) -> _native.Arrays:
        return [mesh.arrays(f"mesh[{index}]") for index, mesh in enumerate(list(self.mesh))]

    def _text(self) -> str:
        return json.dumps(self.plain())

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        same = self.plain() == other.plain()  # and as many meshes
        return same and all(map(Mesh.same_triangles, self.mesh, other.mesh))

    __hash__ = None

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a scene file: JSON if its name ends so, else TOML.

        Names of model files that are found from `folder` are written so that they are found from there.

        Raises
        ------
        SceneError
            If the scene has no form in a file, or the file cannot be written; what was there before stays.
        """
        target = Path(path)
        table = self.plain()
        for entry in (*table["mesh"], *table["texture"].values(), table.get("sky", {})):
            for key in ("file", "image"):
                if key in entry and (Path(self.folder) / entry[key]).is_file():
                    entry[key] = os.path.relpath(Path(self.folder) / entry[key], target.parent)
        _native.write(target, json.dumps(table), self._arrays())

    def with_(self, key: str, value: object) -> Scene:
        """Return the scene with one value changed, by the key that `--set` has.

        Parameters
        ----------
        key : str
            Like ``material.glass.eta``, ``sphere.glass.radius`` (by name) or ``light.2.color`` (by number from 1).
        value : number, text or list
            What it is now.

        Raises
        ------
        SceneError
            If there is no such key.
        """
        said = json.dumps(plain(value, key))
        text = _native.changed(self._text(), key, said)
        return self._of(text, self._arrays(), self.folder, self.name)

    def _compiled(
        self, width: int | None = None, height: int | None = None, integrator: str | None = None, spp: int | None = None
    ) -> _native.NativeScene:
        table = self.plain()
        for key, setting in (("integrator", integrator), ("spp", spp)):
            if setting is not None:
                table["render"][key] = plain(setting, f"render.{key}")
        text = json.dumps(table)
        size = table["render"].get("size")
        if (width, height) != (None, None) and isinstance(size, list) and len(size) == 2:
            text = _native.resized(text, _size(width, height, size))
        return _native.NativeScene(self.name, text, self._arrays(), Path(self.folder).absolute())

    def render(
        self,
        *,
        width: int | None = None,
        height: int | None = None,
        integrator: str | None = None,
        spp: int | None = None,
        threads: int = 0,
        progress: bool | Callable[[int, int, int], object] = True,
    ) -> Picture:
        """Render the picture. Python's lock is free meanwhile, and the scene may be changed.

        ^C, or Stop in a notebook, ends it with the picture so far: `Picture.finished` is False then.

        Parameters
        ----------
        width, height : int, optional
            Another size in pixels; one alone keeps the shape. Pixels stay square: the view is widened if need be.
        integrator : str, optional
            Another model of light.
        spp : int, optional
            Samples per pixel.
        threads : int
            0 for as many as the machine has.
        progress : bool or callable
            A bar, on a terminal and in notebooks, for what takes longer; or what is called with pixels done, pixels in
            all, and rays.

        Raises
        ------
        SceneError
            Naming the field that is wrong.
        RenderError
            If the picture does not fit into memory.

        Examples
        --------
        >>> picture = Scene.load("lecture/default").render(width=64)
        >>> picture.array.shape, picture.array.dtype
        ((64, 64, 3), dtype('float64'))
        """
        how = {"width": width, "height": height, "integrator": integrator, "spp": spp}
        picture = self._rendered(set(), threads=threads, progress=progress, **how)
        if not picture.finished:
            warn("stopped: the picture is what was done by then")
        return picture

    def view(self, *, css_height: str | None = None, **how: Any) -> View:
        """Show the scene in 3D, in a notebook: objects, lights, the camera with its picture, and rays of pixels.

        Parameters
        ----------
        css_height : str, optional
            Of the view, like ``"40rem"``.
        **how
            What `render` takes.

        Examples
        --------
        >>> Scene.load("gallery/ball").view(width=64)
        <View of gallery/ball, 64 x 43>
        """
        return self.render(**how).view(css_height=css_height)

    def _rendered(
        self,
        known: set[Finding],
        *,
        threads: int = 0,
        progress: bool | Callable[[int, int, int], object] = True,
        **how: Any,
    ) -> Picture:
        """Render, and warn of what is not known yet."""
        if not (isinstance(threads, int | np.integer) and 0 <= threads <= _MOST_THREADS):
            raise SceneError([("threads", f"expected 0 to {_MOST_THREADS}, read {threads!r}", None)])
        compiled = self._compiled(**how)
        _warn(compiled.warnings(), known)
        with watcher(progress, self.name) as watch:
            picture = Picture(compiled.render(int(threads), watch), self.name)
        # Lost light is nothing odd: every hall of mirrors has some.
        found = [text for code, text in picture._native.warnings() if code not in _REMARKS]
        _warn([(None, text, None) for text in found], known)
        return picture

    def find(self, name: str, *, progress: bool | Callable[[int, int, int], object] = True) -> Sightings:
        """Return where an object is seen, and by which ways.

        Parameters
        ----------
        name : str
            The object.
        progress
            As for `render`.

        Raises
        ------
        SceneError
            If no object is called so.

        Examples
        --------
        >>> found = Scene.load("study/quarter-view").find("green")
        >>> found.paths[0]
        ('camera → glass(refract) → green', 12448)
        """
        if not isinstance(name, str):
            raise SceneError([("name", f"expected the name of an object, read {name!r}", None)])
        compiled = self._compiled()
        _warn(compiled.warnings(), set())
        with watcher(progress, self.name) as watch:
            paths, mask = compiled.find(name, watch)
        return Sightings(paths, mask)


def _warn(findings: Sequence[Finding], known: set[Finding]) -> None:
    """Warn of what is not known yet."""
    for finding in findings:
        if finding not in known:
            known.add(finding)
            place, message, _ = finding
            warn(f"{place}: {message}" if place else message)


def _material_name(reference: object, names: list[str], place: str) -> object:
    """Return the name behind a number, as the lecture's globes have them."""
    if isinstance(reference, bool) or not isinstance(reference, int):
        return reference
    if 0 <= reference < len(names):
        return names[reference]
    have = f"there are {len(names)}, counted from 0" if names else "there are none"
    raise SceneError([(place, f"no material has the number {reference}: {have}", None)])


def _size(width: int | None, height: int | None, before: list[int]) -> tuple[int, int]:
    """Return a size of which one side may be left out."""
    for place, side in (("width", width), ("height", height)):
        fine = side is None or (isinstance(side, int | np.integer) and 0 < side < 2**32)
        if not fine:
            raise SceneError([(place, f"expected a number of pixels, at least 1, read {side!r}", None)])
    old_width, old_height = (max(1, int(side)) for side in before)
    if width is None and height is not None:
        width = max(1, round(height * old_width / old_height))
    if height is None and width is not None:
        height = max(1, round(width * old_height / old_width))
    return int(width or old_width), int(height or old_height)


class Scenes(Mapping[str, Scene]):
    """The built-in scenes by name; each is made anew when it is asked for.

    Examples
    --------
    >>> import snell
    >>> len(snell.scenes), "gallery/ball" in snell.scenes
    (25, True)
    """

    _names = tuple(name for name, _ in _native.builtin_scenes())

    def __getitem__(self, name: str) -> Scene:
        if name not in self._names:
            raise KeyError(name)
        return Scene.load(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<built-in scenes: {', '.join(self._names)}>"


#: All built-in scenes.
scenes = Scenes()
