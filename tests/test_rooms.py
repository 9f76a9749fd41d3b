"""The folders of kernels and engine are rooms in an order: each may use those above it in this list, and none below."""

import re
from pathlib import Path

import pytest

CRATES = Path(__file__).resolve().parent.parent / "crates"

ROOMS = {
    "snell-kernels": ["lanes", "color", "geometry", "optics", "texture", "settings", "stage", "trace", "integrate"],
    # Those of the kernels first; where it has a room of the same name, that adds to theirs.
    "snell": [
        "lanes",
        "color",
        "texture",
        "settings",
        "stage",
        "trace",
        "integrate",
        "memory",
        "threads",
        "geometry",
        "optics",
        "film",
        "scene",
        "world",
        "render",
        "rays",
        "explain",
    ],
}

COMMENT = re.compile(r"//.*")
TESTS = re.compile(r"#\[cfg\(test\)\]\n(?:pub(?:\(crate\))? )?mod (\w+)(;| \{)")


def code(path: Path) -> str:
    """What a file is compiled of, without comments and its own tests, which may use everything."""
    text = path.read_text(encoding="utf-8")
    inner = [match for match in TESTS.finditer(text) if match.group(2) == " {"]
    # Tests within a file stand at its end.
    return COMMENT.sub("", text[: inner[0].start()] if inner else text)


def only_for_tests(source: Path) -> set[Path]:
    """Modules that are compiled for tests only."""
    found: set[Path] = set()
    for path in source.rglob("*.rs"):
        folder = path.parent if path.name in ("mod.rs", "lib.rs") else path.with_suffix("")
        for match in TESTS.finditer(path.read_text(encoding="utf-8")):
            if match.group(2) == ";":
                found |= {folder / f"{match.group(1)}.rs"} | set((folder / match.group(1)).rglob("*.rs"))
    return found


@pytest.mark.parametrize("crate", ROOMS)
def test_no_arrow_points_up(crate: str) -> None:
    source, rooms = CRATES / crate / "src", ROOMS[crate]
    wrong, arrows = [], 0
    for path in sorted(set(source.rglob("*.rs")) - only_for_tests(source) - {source / "lib.rs"}):
        room = path.relative_to(source).parts[0].removesuffix(".rs")
        assert room in rooms, f"{path}: {room} has no place in the list"
        for used in sorted(set(re.findall(r"\bcrate::(\w+)", code(path))) - {room}):
            arrows += 1
            if used not in rooms or rooms.index(used) > rooms.index(room):
                wrong.append(f"{path.relative_to(source)} uses {used}, which stands above {room}")
    assert not wrong, "\n".join(wrong)
    assert arrows > 50, f"only {arrows} uses were found: is the list of what to look for still right?"
