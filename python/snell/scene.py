"""A whole scene: from files, from Python, to pictures."""

from __future__ import annotations

import functools
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from . import _native
from . import how as how_of
from .errors import Finding, PictureError, SceneError, warn
from .how import How, Settings
from .part import Part, joinable
from .parts import Box, Camera, Disc, Lathe, Light, Material, Mesh, Plane, Render, Sky, Sphere, Texture
from .picture import Picture, Sightings, no_pixel
from .progress import watcher
from .tree import RayTree
from .values import Color, Value, plain, whole

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from .notebook.studio import Studio
    from .notebook.view import View

_LISTS: Mapping[str, type[Value]] = {
    "light": Light, "sphere": Sphere, "mesh": Mesh, "plane": Plane, "box": Box, "disc": Disc,
    "lathe": Lathe,
}  # fmt: skip
_TABLES: Mapping[str, type[Value]] = {"render": Render, "camera": Camera, "sky": Sky}
_NAMED: Mapping[str, type[Value]] = {"material": Material, "texture": Texture}
#: Keys of a file, and the fields that are called otherwise: of many things a file has one table each, a scene a list.
_FIELDS = {
    "render": "settings", "light": "lights", "material": "materials", "texture": "textures", "sphere": "spheres",
    "mesh": "meshes", "plane": "planes", "box": "boxes", "disc": "discs", "lathe": "lathes",
}  # fmt: skip
_REMARKS = ("W202 lost-light", "W203 black-picture")  # told by the picture, which may be meant so


@dataclass(eq=False, repr=False, kw_only=True)
class Scene(Value):
    """Everything that a picture depends on.

    Its fields are the keys of a scene file, but lists have plural names, and the table ``render`` is `settings`, as
    `render` is what one does with a scene. The keys of the file (``sphere=``) are taken as parameters, too.

    Parameters
    ----------
    settings : Render
        How the picture is made.
    camera : Camera
        Where it is seen from.
    ambient : float or (3,)
        Light that comes from everywhere alike, linear, 1 for white; by default 0.
    background : float or (3,)
        `whitted`: light that comes from where nothing is; by default 0.
    sky : Sky, optional
        `whitted`: light that depends on the direction, instead of `background`.
    eta_outside : float
        Index of refraction of the space between the objects, 0.001 to 1000; by default 1.
    lights : sequence of Light
        Where light comes from; by default from nowhere.
    materials : dict of str to Material, or sequence of Material
        What things are made of. Those of a sequence are called by their number from 0.
    textures : dict of str to Texture
        Patterns on surfaces, by name.
    spheres : sequence of Sphere
        By default none, as of the other shapes.
    meshes : sequence of Mesh
        Triangles.
    planes : sequence of Plane
        Rectangles.
    boxes : sequence of Box
        Boxes along the axes.
    discs : sequence of Disc
        Discs and ellipses.
    lathes : sequence of Lathe
        What turns around an axis.
    folder : str or path
        What the names of files are relative to; by default the working directory.
    name : str
        For titles and explanations; by default ``"scene"``.

    Raises
    ------
    SceneError
        If a list is given by both of its names. What is wrong with a scene is found when it is rendered.

    Examples
    --------
    >>> import snell
    >>> scene = snell.scenes["lecture/default"]
    >>> diamond = scene.with_("material.glass.eta", 2.42)
    >>> diamond.materials["glass"].eta, diamond == scene
    (2.42, False)
    >>> [sphere.name for sphere in scene.spheres]
    ['glass', 'red', 'green', 'blue']
    """

    settings: Render
    camera: Camera
    ambient: Color = 0.0
    background: Color = 0.0
    sky: Sky | None = None
    eta_outside: float = 1.0
    lights: Sequence[Light] = ()
    materials: Mapping[str, Material] | Sequence[Material] = field(default_factory=dict)
    textures: Mapping[str, Texture] = field(default_factory=dict)
    spheres: Sequence[Sphere] = ()
    meshes: Sequence[Mesh] = ()
    planes: Sequence[Plane] = ()
    boxes: Sequence[Box] = ()
    discs: Sequence[Disc] = ()
    lathes: Sequence[Lathe] = ()
    folder: str | os.PathLike[str] = "."
    name: str = "scene"

    beside: ClassVar[frozenset[str]] = frozenset({"folder", "name"})
    called: ClassVar[Mapping[str, str]] = {field: key for key, field in _FIELDS.items()}
    colors: ClassVar[frozenset[str]] = frozenset({"ambient", "background"})

    def replace(self, **changes: Any) -> Scene:
        """Return a copy of its own with some fields changed, by their names or by the keys of a file."""
        return super().replace(**_by_field(changes))

    def _no_field(self, name: str) -> AttributeError:
        if name in _FIELDS:
            message = f"a Scene has no field `{name}`, which is a key of scene files: it is `{_FIELDS[name]}` here"
            return AttributeError(message, name=name, obj=self)
        return super()._no_field(name)

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
    def of(cls, table: Mapping[str, Any], *, folder: str | os.PathLike[str] = ".", name: str = "scene") -> Scene:
        """Make one of the form that a scene file has, as `json.load` and `tomllib.load` read it.

        Parameters
        ----------
        table : dict
            With the keys of the file.
        folder, name
            As for `Scene`.

        Raises
        ------
        SceneError
            Naming the key that is wrong.

        Examples
        --------
        >>> camera = {"eye": (0, 0, 5), "look_at": (0, 0, 0), "up": (0, 1, 0), "fov": 40}
        >>> Scene.of({"snell": 1, "render": {"integrator": "whitted", "size": (32, 24)}, "camera": camera}).spheres
        ()
        """
        if not isinstance(table, Mapping):
            raise SceneError([("table", f"expected a dict, read {table!r}", None)])
        return cls._of(*_native.parsed(json.dumps(plain(table, ""))), folder, name)

    @classmethod
    def _of(cls, text: str, arrays: _native.Arrays, folder: str | os.PathLike[str], name: str) -> Scene:
        table = json.loads(text)
        fields: dict[str, Any] = {"folder": folder, "name": name}
        for key, value in table.items():
            if key in _LISTS:
                fields[key] = [_LISTS[key].of(element) for element in value]
            elif key in _NAMED:
                fields[key] = {name: _NAMED[key].of(element) for name, element in value.items()}
            elif key in _TABLES:
                fields[key] = _TABLES[key].of(value)
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
            value = getattr(self, _FIELDS[key])
            if not isinstance(value, Sequence | Mapping) or isinstance(value, str):
                raise SceneError([(key, f"expected a list, read {value!r}", None)])
        for key in sorted(self.beside):
            if not isinstance(getattr(self, key), str | os.PathLike):
                raise SceneError([(key, f"expected a text, read {getattr(self, key)!r}", None)])
        materials = self._materials()
        table: dict[str, Any] = {"snell": 1, **super().plain()}
        table["material"] = {name: material.plain(f"material.{name}") for name, material in materials.items()}
        for key, kind in _LISTS.items():
            for index, element in enumerate(list(getattr(self, _FIELDS[key]))):
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
        given = self.materials
        named = list(given.items()) if isinstance(given, Mapping) else [(str(i), m) for i, m in enumerate(list(given))]
        for name, material in named:
            self._check(f"material.{name}", material, Material)
        return {str(name): material for name, material in named}

    def _arrays(self) -> _native.Arrays:
        return [mesh.arrays(f"mesh[{index}]") for index, mesh in enumerate(list(self.meshes))]

    def _text(self) -> str:
        return json.dumps(self.plain())

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        same = self.plain() == other.plain()  # and as many meshes
        return same and all(map(Mesh.same_triangles, self.meshes, other.meshes))

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
        text = _native.changed(self._text(), key, how_of.text(value, key))
        return self._of(text, self._arrays(), self.folder, self.name)

    def _described(self) -> _native.NativeScene:
        return _native.NativeScene(self.name, self._text(), self._arrays(), Path(self.folder).absolute())

    def _compiled(self, how: Mapping[str, Any]) -> _native.NativeWorld:
        width, height = how_of.size(how)
        with how_of.naming_parameters(how):
            return self._described().compiled(how_of.changes(how), width, height, None)

    def render(
        self,
        *,
        width: int | None = None,
        height: int | None = None,
        crop: Sequence[int] | None = None,
        spp: int | None = None,
        depth: int | None = None,
        seed: int | None = None,
        integrator: str | None = None,
        shadows: str | None = None,
        threads: int = 0,
        progress: bool | Callable[[int, int, int], object] = True,
        client: object = None,
        task_seconds: float = 4.0,
    ) -> Picture:
        """Render the picture. Python's lock is free meanwhile, and the scene may be changed.

        What is left out is as `settings` and `camera` say; they stay as they are. ^C, or Stop in a notebook, ends it
        with the picture so far: `Picture.finished` is False then.

        Parameters
        ----------
        width, height : int, optional
            Another size in pixels, at least 1; one alone keeps the shape. Pixels stay square: the view is widened if
            need be.
        crop : (4,) of int, optional
            Only a part: left column, top row, width and height in pixels of the whole picture. Its numbers are those
            of `Picture.crop`.
        spp : int, optional
            Samples per pixel, 1 to 65536.
        depth : int, optional
            How many bounces may follow the camera ray, 0 to 1000: the ``max_depth`` of a file.
        seed : int, optional
            Another number spreads the samples otherwise, 0 to 4294967295.
        integrator : {"whitted", "lecture", "course2018", "course2020"}, optional
            Another model of light.
        shadows : {"off", "opaque", "tinted"}, optional
            What stands between a surface and a light.
        threads : int
            0 to 4096. 0, the default, takes SNELL_THREADS, OMP_NUM_THREADS or SLURM_CPUS_PER_TASK, or else all
            available cores. It changes no bit of the picture. With a `client` it must be 0.
        progress : bool or callable
            By default a bar, on a terminal and in notebooks, for what takes longer; False for none; or what is called
            with pixels done, pixels in all, and rays (with a `client` those that have come back).
        client : distributed.Client, optional
            Render on the workers of this Dask cluster, to the same bits. A worker runs one task per thread.
            Notebooks show the picture so far. It needs ``pip install '.[cluster]'``, from a clone.
        task_seconds : float
            With a `client`: how long a task should take at most, in seconds, 0.001 to 1000000; by default 4. Longer
            tasks have less overhead, but lose more work with a lost worker.

        Raises
        ------
        SceneError
            Naming the field or the parameter that is wrong.
        RenderError
            If the picture does not fit into memory, or a cluster gives up.

        Examples
        --------
        >>> scene = Scene.load("lecture/default")
        >>> picture = scene.render(width=64, spp=4, depth=2)
        >>> picture.array.shape, picture.array.dtype
        ((64, 64, 3), dtype('float64'))
        >>> scene.render(width=64, crop=(16, 24, 32, 8))
        <Picture of lecture/default, 32 x 8>
        """
        how: How = {"width": width, "height": height, "crop": crop, "spp": spp, "depth": depth, "seed": seed,
                    "integrator": integrator, "shadows": shadows, "threads": threads}  # fmt: skip
        if client is None:
            return warned_if_stopped(self._rendered(set(), progress, how))
        if threads != 0:
            message = f"a task of a cluster has one thread, read {threads!r}"
            raise SceneError([("threads", message, "the workers say how many tasks they run at a time")])
        from .cluster.engine import Cluster  # noqa: PLC0415 # Dask is not needed otherwise
        from .cluster.pictures import render  # noqa: PLC0415 # Dask is not needed otherwise

        cluster = Cluster(client, task_seconds)
        world, region = self._compiled(how), how_of.region(how)
        known: set[Finding] = set()
        warn_of(world.warnings(), known)
        native = render(world, self.name, region, progress, cluster)
        return warned_if_stopped(pictured(native, self.name, known))

    def render_part(
        self,
        *,
        rows: Sequence[int] | None = None,
        samples: Sequence[int] | None = None,
        progress: bool | Callable[[int, int, int], object] = True,
        **how: Unpack[How],
    ) -> Part:
        """Render some samples of some rows, for `merge`, in any process on any machine.

        ^C ends it with KeyboardInterrupt.

        Parameters
        ----------
        rows : (2,) of int, optional
            The first row and the one after the last, in the whole picture; by default all.
        samples : (2,) of int, optional
            The first sample of each pixel and the one after the last; by default all ``spp`` of them.
        progress, **how
            What `render` takes: width, height, crop, spp, depth, seed, integrator, shadows, threads.

        Raises
        ------
        SceneError
            Naming the field or the parameter that is wrong.

        Examples
        --------
        >>> Scene.load("lecture/default").render_part(rows=(0, 8), samples=(2, 4), width=64, spp=4)
        <Part: rows 0 to 7, samples 2 to 3>
        """
        said = how_of.said(how, How)
        world, region, threads = self._compiled(said), how_of.region(said), how_of.threads(said)
        warn_of(world.warnings(), set())
        of_rows, of_samples = how_of.range_of(rows, "rows"), how_of.range_of(samples, "samples")
        with watcher(progress, self.name) as watch:
            return Part(world.render_part(threads, region, of_rows, of_samples, watch), said)

    def merge(self, parts: Iterable[Part]) -> Picture:
        """Return the picture that parts add up to, with the same bits as from `render`.

        Parameters
        ----------
        parts : iterable of Part
            Parts of this scene, rendered with the same settings, in any order.

        Raises
        ------
        PictureError
            If something is missing, duplicated, or of another picture.
        """
        native, how = joinable(parts)
        world, region = self._compiled(how), how_of.region(how)
        known: set[Finding] = set()
        warn_of(world.warnings(), known)
        seconds = sum(part.seconds for part in native)
        return pictured(world.merge(region, native, False, seconds), self.name, known)

    def view(
        self,
        *,
        css_height: str | None = None,
        progress: bool | Callable[[int, int, int], object] = True,
        **how: Unpack[How],
    ) -> View:
        """Show the scene in 3D, in a notebook: objects, lights, the camera with its picture, and rays of pixels.

        Parameters
        ----------
        css_height : str, optional
            Of the view, like ``"40rem"``.
        progress, **how
            What `render` takes.

        Examples
        --------
        >>> Scene.load("gallery/ball").view(width=64)
        <View of gallery/ball, 64 x 43>
        """
        return self.render(progress=progress, **how).view(css_height=css_height)

    def studio(self, *, css_height: str | None = None) -> Studio:
        """Open the scene in Snell Studio, in a notebook: drag things, move sliders, ask pixels.

        The scene stays as it is; `Studio.scene` is the one that was edited.

        Parameters
        ----------
        css_height : str, optional
            Of the page, like ``"50rem"``.

        Raises
        ------
        SceneError
            If the scene cannot be drawn.

        Examples
        --------
        >>> Scene.load("gallery/ball").studio()
        <Studio of gallery/ball>
        """
        from .notebook.studio import Studio  # noqa: PLC0415 # only where there is a notebook

        return Studio(self, css_height)

    def explain(self, x: int, y: int, **settings: Unpack[Settings]) -> RayTree:
        """Say why a pixel has its colour, without rendering the others.

        To see its rays in 3D, render the picture: ``scene.render().explain(x, y).view()``.

        Parameters
        ----------
        x, y : int
            Column and row, from the top left.
        **settings
            What `render` takes, but for `crop`, `threads` and `progress`.

        Raises
        ------
        SceneError
            Naming the field or the parameter that is wrong.
        PictureError
            If there is no such pixel.

        Examples
        --------
        >>> Scene.load("lecture/default").explain(190, 300, depth=1).sentence[:20]
        'Green because 53 % o'
        """
        x, y = (whole(number, "explain", PictureError) for number in (x, y))
        world = self._compiled(how_of.said(settings, Settings))
        width, height = world.size
        if not (0 <= x < width and 0 <= y < height):
            raise no_pixel(x, y, width, height)
        return picture_of(world, self.name, set(), False, {"crop": (x, y, 1, 1)}).explain(0, 0)

    def _rendered(
        self, known: set[Finding], progress: bool | Callable[[int, int, int], object], how: Mapping[str, Any]
    ) -> Picture:
        """Render, and warn of what is not known yet."""
        how_of.threads(how)
        how_of.region(how)
        return picture_of(self._compiled(how), self.name, known, progress, how)

    def find(
        self,
        name: str,
        *,
        progress: bool | Callable[[int, int, int], object] = True,
        **settings: Unpack[Settings],
    ) -> Sightings:
        """Return where an object is seen, and along which paths.

        Parameters
        ----------
        name : str
            The object.
        progress, **settings
            What `render` takes, but for `crop` and `threads`.

        Raises
        ------
        SceneError
            If no object is called so, or naming the field or the parameter that is wrong.

        Examples
        --------
        >>> found = Scene.load("study/quarter-view").find("green")
        >>> found.paths[0]
        ('camera → glass(refract) → green', 12448)
        """
        if not isinstance(name, str):
            raise SceneError([("name", f"expected the name of an object, read {name!r}", None)])
        world = self._compiled(how_of.said(settings, Settings))
        warn_of(world.warnings(), set())
        with watcher(progress, self.name) as watch:
            paths, mask = world.find(name, watch)
        return Sightings(paths, mask)


def warned_if_stopped(picture: Picture) -> Picture:
    """Return a picture, with a warning if it is not finished."""
    if not picture.finished:
        warn("stopped: the picture is what was done by then")
    return picture


def _by_field(parts: Mapping[str, Any]) -> dict[str, Any]:
    """Return the parts of a scene by the names of its fields, where some may be keys of a file."""
    found: dict[str, Any] = {}
    for key, value in parts.items():
        name = _FIELDS.get(key, key)
        if name in found:
            message = f"given twice: as `{Scene.called[name]}` and as `{name}`"
            raise SceneError([(name, message, "leave one of them out")])
        found[name] = value
    return found


def _taking_keys(init: Callable[..., None]) -> Callable[..., None]:
    """Let the parameters of a scene have the keys of a file, too."""

    @functools.wraps(init)
    def taking_keys(self: Scene, **parts: Any) -> None:
        init(self, **_by_field(parts))

    return taking_keys


Scene.__init__ = _taking_keys(Scene.__init__)  # type: ignore[method-assign]


def picture_of(
    world: _native.NativeWorld,
    name: str,
    known: set[Finding],
    progress: bool | Callable[[int, int, int], object],
    how: Mapping[str, Any],
) -> Picture:
    """Render what is compiled, and warn of what is not known yet."""
    warn_of(world.warnings(), known)
    with watcher(progress, name) as watch:
        return pictured(world.render(how_of.threads(how), how_of.region(how), watch), name, known)


def pictured(native: _native.NativePicture, name: str, known: set[Finding]) -> Picture:
    """Return a picture, and warn of what is odd about it and not known yet."""
    picture = Picture(native, name)
    # Lost light is nothing odd: every hall of mirrors has some.
    found = [text for code, text in picture._native.warnings() if code not in _REMARKS]
    warn_of([(None, text, None) for text in found], known)
    return picture


def warn_of(findings: Sequence[Finding], known: set[Finding]) -> None:
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
