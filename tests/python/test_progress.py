"""A bar shows how far a long render is, at most ten times a second, and nothing of it stays."""

from __future__ import annotations

import os
import pty
import subprocess
import sys
from pathlib import Path
from typing import Any

import nbformat
import pytest
from common import own_kernel
from nbclient import NotebookClient

# About 1.5 s on any machine.
LONG = """
import snell
scene = snell.scenes["lecture/default"]
spp = max(1, int(4 * 1.5 / scene.render(spp=4, progress=False).seconds))
"""
STOP = """
import os, signal, threading
threading.Timer(0.9, os.kill, (os.getpid(), signal.SIGINT)).start()
"""


class Client(NotebookClient):
    """Keeps the messages of the bar: when it was drawn, and what is drawn, None where it was taken away."""

    def process_message(self, msg: Any, cell: Any, cell_index: int) -> Any:
        self.bars: list[tuple[float, str | None]] = getattr(self, "bars", [])
        if "display_data" in msg["msg_type"]:
            self.bars.append((msg["header"]["date"].timestamp(), msg["content"]["data"].get("text/html")))
        return super().process_message(msg, cell, cell_index)


def run(code: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[list[tuple[float, str | None]], list[Any]]:
    """Run a cell, and return the messages of its bar and what stays below the cell."""
    own_kernel(folder, monkeypatch)
    cell = nbformat.v4.new_code_cell(code)  # type: ignore[no-untyped-call]
    notebook = nbformat.v4.new_notebook(cells=[cell])  # type: ignore[no-untyped-call]
    client = Client(notebook, timeout=120, kernel_name="python3", coalesce_streams=True)
    client.execute()
    return client.bars, notebook.cells[0].outputs


def test_a_notebook_shows_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bars, outputs = run(LONG + "print('mine')\nscene.render(spp=spp)", tmp_path, monkeypatch)
    drawn = [when for when, page in bars if page is not None]
    assert len(drawn) >= 2
    assert len(drawn) - 1 <= 10 * (drawn[-1] - drawn[0]) + 1, "one more, as messages are dated a little later"
    assert all("lecture/default" in page for _, page in bars[:-1] if page is not None)
    assert bars[-1][1] is None
    # Jupyter has no message that takes an output away: an empty one stays, which has no place on the page.
    assert [output for output in outputs if output.get("data") == {}] == [outputs[1]]
    mine, _, picture = outputs
    assert mine.text == "mine\n"
    assert "image/png" in picture.data


def test_stop_in_a_notebook_takes_it_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bars, outputs = run(LONG + STOP + "scene.render(spp=20 * spp).finished", tmp_path, monkeypatch)
    assert bars[0][1] is not None
    assert bars[-1][1] is None
    assert outputs[-1].data == {"text/plain": "False"}
    assert not any("text/html" in output.get("data", {}) for output in outputs)


def test_what_is_short_has_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bars, outputs = run("import snell\nsnell.scenes['lecture/default'].render(width=64)", tmp_path, monkeypatch)
    assert bars == []
    assert ["image/png" in output.data for output in outputs] == [True]


def terminal(code: str) -> str:
    """Run a script whose stderr is a terminal, and return what came there."""
    ours, theirs = pty.openpty()
    with subprocess.Popen([sys.executable, "-c", code], stderr=theirs) as process:
        os.close(theirs)
        written = b""
        try:
            while more := os.read(ours, 65536):
                written += more
        except OSError:  # Linux says so where the other end has gone
            pass
        finally:
            os.close(ours)
    assert process.returncode == 0
    return written.decode()


def test_a_terminal_shows_it() -> None:
    written = terminal(LONG + "scene.render(spp=spp)")
    assert "lecture/default ━" in written
    assert written.endswith("\r\x1b[K")


def test_a_sweep_has_one_for_all_frames(tmp_path: Path) -> None:
    some = f"snell.sweep(scene, {{'material.glass.eta': [1, 1.5, 2]}}, {str(tmp_path)!r}, spp=spp // 2)"
    written, again = terminal(f"{LONG}{some}\nimport sys; sys.stderr.write('again')\n{some}").split("again")
    assert "frame 2 of 3  " in written
    assert " s left" in written
    assert written.endswith("\r\x1b[K")
    assert "\r\x1b[K\r\x1b[K" not in written, "it was taken away between the frames"
    assert again == "", "all frames are there"
