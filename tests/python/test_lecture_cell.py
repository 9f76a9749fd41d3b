"""The lecture's cell, as typed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from common import CELL, film

import snell


def run(code: str) -> dict[str, Any]:
    variables: dict[str, Any] = {}
    exec("from snell.lecture import *\n" + code, variables)
    return variables


def test_the_cell_is_the_default_picture_bit_for_bit(tmp_path: Path) -> None:
    picture = run(CELL + "picture = render()")["picture"]
    assert picture.array.shape == (512, 512, 3)
    assert picture.array.tobytes() == film("lecture/default", tmp_path).tobytes()
    assert picture.array.max() > 0.5
    assert picture.array.tobytes() == snell.scenes["lecture/default"].render(threads=1).array.tobytes()


def test_the_cell_is_the_scene_of_the_file_but_for_names() -> None:
    typed = run(CELL + "typed = scene()")["typed"]
    known = snell.scenes["lecture/default"]
    assert list(typed._materials().values()) == list(known._materials().values())
    assert typed.camera.eye == (50, 50, 100)
    assert typed.plain()["render"] == known.plain()["render"]


def test_what_is_missing_is_named() -> None:
    with pytest.raises(snell.SceneError, match="lgts: the cell does not set it"):
        run(CELL.replace("lgts =", "lights =") + "render()")
    with pytest.raises(snell.SceneError) as error:
        run(CELL.replace("9, 3)]", "9, 4)]") + "render()")
    assert error.value.place == "sphere[3].material"
