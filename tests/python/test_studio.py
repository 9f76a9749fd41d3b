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
    [(name, model)] = studio._files.items()
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
    assert studio._page_name == "scenes/mine.toml"
    assert read(studio, "scene/models/four.obj") == OBJ
    assert studio.scene == scene


def test_nothing_but_the_page_and_the_scene_is_served() -> None:
    studio = snell.scenes["lecture/default"].studio()
    for file in ("page/../studio.py", "page//etc/passwd", "/etc/passwd", "scene/../../etc/passwd", "scene/", ""):
        assert read(studio, file) is None, file


def test_what_the_page_says_is_the_scene_and_files_stay_in_their_folder(tmp_path: Path) -> None:
    studio = snell.scenes["lecture/default"].studio()
    text = studio._text.replace("eta = 2.0", "eta = 1.5")
    assert text != studio._text
    studio._hear(FrontEnd(), {"kind": "scene", "name": "default.toml", "text": text, "files": None}, [])
    assert studio.scene.plain()["material"]["glass"]["eta"] == 1.5
    assert studio.scene.folder == "."

    outside = tmp_path / "outside.obj"
    files = ["../../../../../.." + str(outside), str(outside), "models/four.obj"]
    message = {"kind": "scene", "name": "../../x/dropped.toml", "text": text, "files": files}
    studio._hear(FrontEnd(), message, [OBJ, memoryview(OBJ), OBJ])
    assert not outside.exists()
    folder = Path(studio.scene.folder)
    assert (folder.parent / "models/four.obj").read_bytes() == OBJ
    assert repr(studio) == "<Studio of dropped>"
    del studio
    assert not folder.exists(), "copies go with the studio"


@pytest.mark.parametrize(
    "message", [None, {}, {"kind": "read"}, {"kind": "read", "file": 1, "from": "x"}, {"kind": "scene", "text": 3}]
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
