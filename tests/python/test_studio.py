"""What the studio in a notebook is given, and what becomes of what it says; the page itself is tested in JupyterLab."""

from pathlib import Path

import numpy as np
import pytest

import snell
from snell.notebook.studio import Studio

OBJ = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"


class FrontEnd:
    """Stands for the widget."""

    def __init__(self) -> None:
        self.heard: list[tuple[dict[str, object], list[bytes]]] = []

    def send(self, message: dict[str, object], buffers: list[bytes] | None = None) -> None:
        """Take what Python says."""
        self.heard.append((message, buffers or []))


def read(studio: Studio, file: str) -> bytes | None:
    """Return a file as the page puts it together."""
    front, data = FrontEnd(), b""
    while True:
        studio._hear(front, {"kind": "read", "file": file, "from": len(data)}, [])
        said, buffers = front.heard[-1]
        if "size" not in said:
            return None
        data += buffers[0]
        if len(data) >= int(str(said["size"])):
            return data


@pytest.mark.parametrize("name", snell.scenes)
def test_a_scene_that_nobody_touched_comes_back_as_it_was(name: str) -> None:
    scene = snell.scenes[name]
    assert scene.studio().scene == scene


def test_triangles_without_a_file_travel_as_a_model_and_come_back_as_triangles() -> None:
    corners = np.random.default_rng(7).standard_normal((3600, 3)) * 1e-9
    faces = np.arange(3600).reshape(-1, 3)
    ball = snell.scenes["gallery/ball"]
    mesh = snell.Mesh(corners, faces, "glass", name="cloud")
    scene = ball.replace(meshes=[*ball.meshes, mesh])
    studio = scene.studio()
    [(name, model)] = studio._opened["first"].files.items()
    assert read(studio, f"scene/{name}") == model
    assert len(studio._text) < len(ball.studio()._text) + 200, "the triangles are not in the text"
    assert studio.scene == scene


def test_models_beside_and_above_the_scene_are_served(tmp_path: Path) -> None:
    (tmp_path / "models").mkdir()
    (tmp_path / "scenes").mkdir()
    (tmp_path / "models/four.obj").write_bytes(OBJ)
    ball = snell.scenes["gallery/ball"]
    mesh = snell.Mesh(file="../models/four.obj", material="glass")
    scene = ball.replace(meshes=[mesh], folder=tmp_path / "scenes", name="scenes/mine.toml")
    studio = scene.studio()
    assert studio._opened["first"].name == "scenes/mine.toml"
    assert read(studio, "scene/models/four.obj") == OBJ
    assert studio.scene == scene


def test_nothing_but_the_page_and_the_scene_is_served() -> None:
    studio = snell.scenes["lecture/default"].studio()
    for file in ("page/../studio.py", "page//etc/passwd", "/etc/passwd", "scene/../../etc/passwd", "scene/", ""):
        assert read(studio, file) is None, file


def say(studio: Studio, opened: str, name: str, text: str, files: dict[str, bytes] | None = None) -> str:
    """Tell a studio what the page tells it; return what it complains about."""
    front = FrontEnd()
    names = None if files is None else list(files)
    message = {"kind": "scene", "opened": opened, "name": name, "text": text, "files": names}
    studio._hear(front, message, [memoryview(data) for data in (files or {}).values()])
    return " ".join(str(said["message"]) for said, _ in front.heard)


def test_what_the_page_says_is_the_scene() -> None:
    studio = snell.scenes["lecture/default"].studio()
    text = studio._text.replace("eta = 2.0", "eta = 1.5")
    assert text != studio._text
    assert say(studio, "first", "default.toml", text) == ""
    assert studio.scene.plain()["material"]["glass"]["eta"] == 1.5
    assert studio.scene.folder == "."


def test_other_scenes_come_with_their_files_and_the_first_one_stays_what_it_was(tmp_path: Path) -> None:
    (tmp_path / "four.obj").write_bytes(OBJ)
    ball = snell.scenes["gallery/ball"]
    corners = np.random.default_rng(3).standard_normal((3600, 3))
    cloud = snell.Mesh(corners, np.arange(3600).reshape(-1, 3), "glass", name="cloud", open="opaque")
    meshes = [snell.Mesh(file="four.obj", material="glass"), cloud]
    scene = ball.replace(meshes=meshes, folder=tmp_path, name="mine")
    studio = scene.studio()
    first = studio._text
    text = first.split("[[mesh]]", maxsplit=1)[0] + '[[mesh]]\nfile = "../a/four.obj"\nmaterial = "glass"\n'
    assert say(studio, "1-2", "b/other.toml", text, {"a/four.obj": OBJ}) == ""
    one = studio.scene
    assert repr(studio) == "<Studio of other>"
    assert say(studio, "3-4", "b/another.toml", text, {"a/four.obj": OBJ}) == ""
    for taken in (one, studio.scene):
        assert taken.render(width=8, progress=False).array.shape[1] == 8, "the files of each are still there"
    # Back by undo, or from another view of the same studio: as if nothing had been.
    assert say(studio, "first", "mine.toml", first) == ""
    assert studio.scene == scene
    assert (studio.scene.folder, studio.scene.name) == (tmp_path, "mine")
    folder = Path(one.folder)
    del studio
    assert not folder.exists(), "copies go with the studio"


@pytest.mark.parametrize(
    "name", ["../../../../../../{}", "{}", "/{}", "//{}", "x/../../../../../../../{}", "..\\..\\{}", "C:\\{}"]
)
def test_no_name_leads_out_of_the_folder_of_copies(tmp_path: Path, name: str) -> None:
    outside = tmp_path / "precious.txt"
    outside.write_text("precious")
    studio = snell.scenes["lecture/default"].studio()
    where = name.format(str(outside).lstrip("/"))
    assert say(studio, "1", where, studio._text, {where: b"gone", name.format(outside): b"gone"}) == ""
    assert outside.read_text() == "precious"
    assert studio._copies is not None
    assert Path(studio.scene.folder).is_relative_to(studio._copies.name)


@pytest.mark.parametrize("files", [{"n" * 300: b""}, {"": b""}, {"..": b""}, {"a\0b": b""}, {"d": b"", "d/e": b""}])
def test_files_that_cannot_be_kept_are_refused_and_nothing_changes(files: dict[str, bytes]) -> None:
    scene = snell.scenes["lecture/default"]
    studio = scene.studio()
    assert "could not take this scene" in say(studio, "1", "x.toml", "snell = 1", files)
    assert studio.scene == scene
    assert repr(studio) == "<Studio of lecture/default>"
    front = FrontEnd()
    for names in (7, [1], ["a", "b"], None):
        message = {"kind": "scene", "opened": "2", "name": "x.toml", "text": "snell = 1", "files": names}
        studio._hear(front, message, [b""])
    assert len(front.heard) == 4
    assert studio.scene == scene


@pytest.mark.parametrize(
    "message",
    [
        None,
        {},
        {"kind": "read"},
        {"kind": "read", "file": 1, "from": "x"},
        {"kind": "read", "file": "scene/a", "from": -1},
        {"kind": "scene", "text": 3},
    ],
)
def test_what_is_no_message_changes_nothing(message: object) -> None:
    studio = snell.scenes["lecture/default"].studio()
    studio._hear(FrontEnd(), message, [b"", memoryview(b"no PNG")])
    assert studio.scene == snell.scenes["lecture/default"]


def test_what_cannot_be_shown_is_refused_at_once(tmp_path: Path) -> None:
    ball = snell.scenes["gallery/ball"]
    with pytest.raises(snell.SceneError, match=r"missing\.obj"):
        ball.replace(meshes=[snell.Mesh(file="missing.obj", material="glass")], folder=tmp_path).studio()
    with pytest.raises(snell.SceneError, match="css_height"):
        ball.studio(css_height=40)  # type: ignore[arg-type]
