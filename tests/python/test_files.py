"""What is written is written whole, and never costs what was there."""

from __future__ import annotations

import errno
import os
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import snell
from snell.files import replacing


@pytest.fixture(scope="module")
def tree() -> snell.RayTree:
    """Why one pixel has its colour."""
    return snell.scenes["lecture/default"].render(width=16).explain(8, 8)


def test_trees_and_figures_are_written_by_their_endings(tree: snell.RayTree, tmp_path: Path) -> None:
    written = {"a.HTML": tree.to_html(), "a.Json": tree.to_json(), "a.SVG": tree.figure().svg, "a.txt": tree.text()}
    for name, text in written.items():
        tree.save(tmp_path / name)
        assert (tmp_path / name).read_text(encoding="utf-8") == text
    tree.figure().save(tmp_path / "b.SVG")
    assert (tmp_path / "b.SVG").read_text(encoding="utf-8") == written["a.SVG"]
    with pytest.raises(snell.PictureError, match=r"no figure has this ending \(known is \.svg\)") as error:
        tree.figure().save(tmp_path / "b.png")
    assert error.value.place == str(tmp_path / "b.png")
    assert len(list(tmp_path.iterdir())) == 5


def full(path: Path, text: str, **how: Any) -> None:
    """Write some of a text, like a disk that is full then."""
    path.write_bytes(text[:10].encode())
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_a_full_disk_leaves_what_was_there(
    tree: snell.RayTree, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "mine.svg"
    path.write_text("mine")
    monkeypatch.setattr(Path, "write_text", full)
    saves: list[Callable[[Path], None]] = [tree.save, tree.figure().save]
    for save in saves:
        with pytest.raises(snell.PictureError, match="cannot be written: No space left on device") as error:
            save(path)
        assert error.value.place == str(path)
    assert path.read_bytes() == b"mine"
    assert list(tmp_path.iterdir()) == [path]


def test_paths_that_cannot_be_written_are_named(tree: snell.RayTree, tmp_path: Path) -> None:
    (tmp_path / "folder.svg").mkdir()
    for save in (tree.save, tree.figure().save):
        for path in (tmp_path / "folder.svg", tmp_path / "no" / "a.svg", tmp_path / f"{'a' * 300}.svg"):
            with pytest.raises(snell.PictureError, match="cannot be written: ") as error:
                save(path)
            assert error.value.place == str(path)
        with pytest.raises(snell.PictureError, match=r"a\\0b.svg: cannot be written: no file's name has a NUL"):
            save(str(tmp_path / "a\0b.svg"))
    assert [path.name for path in tmp_path.iterdir()] == ["folder.svg"]


def test_threads_do_not_meet(tmp_path: Path) -> None:
    path = tmp_path / "file"
    together = threading.Barrier(8)
    failed: list[Exception] = []

    def work(text: str) -> None:
        try:
            with replacing(path) as beside:
                together.wait(10)
                beside.write_text(text)
                together.wait(10)
                assert beside.read_text() == text
        except Exception as error:
            failed.append(error)

    threads = [threading.Thread(target=work, args=(str(number) * 1000,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failed == []
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(os.name != "posix", reason="others have other permissions")
def test_permissions_are_those_of_any_file(tmp_path: Path) -> None:
    (tmp_path / "usual").write_text("")
    with replacing(tmp_path / "new") as beside:
        beside.write_text("")
    assert (tmp_path / "new").stat().st_mode == (tmp_path / "usual").stat().st_mode
    (tmp_path / "new").chmod(0o600)
    with replacing(tmp_path / "new") as beside:
        beside.write_text("kept to oneself")
    assert (tmp_path / "new").stat().st_mode & 0o777 == 0o600
    (tmp_path / "new").chmod(0o400)
    with pytest.raises(snell.PictureError, match="it is read-only"), replacing(tmp_path / "new") as beside:
        beside.write_text("other")
    assert (tmp_path / "new").read_text() == "kept to oneself"


@pytest.mark.skipif(os.name != "posix", reason="others have no links and pipes for everyone")
def test_links_stay_links_and_pipes_stay_pipes(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "file")
    with replacing(tmp_path / "link") as beside:
        beside.write_text("text")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "file").read_text() == "text"
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    end = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
    with replacing(pipe) as beside:
        beside.write_text("through")
    assert os.read(end, 100) == b"through"
    os.close(end)
    assert pipe.is_fifo()
