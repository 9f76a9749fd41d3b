"""The folders of the engine are rooms in an order: each may use those above it in this list, and none below."""

import re
from pathlib import Path

ENGINE = Path(__file__).resolve().parent.parent / "crates/snell/src"

ROOMS = [
    "lanes",
    "color",
    "memory",
    "threads",
    "geometry",
    "optics",
    "film",
    "texture",
    "scene",
    "world",
    "trace",
    "integrate",
    "render",
    "rays",
    "explain",
]

COMMENT = re.compile(r"//.*")
TESTS = re.compile(r"#\[cfg\(test\)\]\n(?:pub(?:\(crate\))? )?mod (\w+)(;| \{)")


def code(path: Path) -> str:
    """What a file is compiled of, without comments and its own tests, which may use everything."""
    text = path.read_text(encoding="utf-8")
    inner = [match for match in TESTS.finditer(text) if match.group(2) == " {"]
    # Tests within a file stand at its end.
    return COMMENT.sub("", text[: inner[0].start()] if inner else text)


def only_for_tests() -> set[Path]:
    """Modules that are compiled for tests only."""
    found: set[Path] = set()
    for path in ENGINE.rglob("*.rs"):
        folder = path.parent if path.name in ("mod.rs", "lib.rs") else path.with_suffix("")
        for match in TESTS.finditer(path.read_text(encoding="utf-8")):
            if match.group(2) == ";":
                found |= {folder / f"{match.group(1)}.rs"} | set((folder / match.group(1)).rglob("*.rs"))
    return found


def room_of(path: Path) -> str:
    return path.relative_to(ENGINE).parts[0].removesuffix(".rs")


def test_no_arrow_points_up() -> None:
    wrong, arrows = [], 0
    for path in sorted(set(ENGINE.rglob("*.rs")) - only_for_tests() - {ENGINE / "lib.rs"}):
        room = room_of(path)
        assert room in ROOMS, f"{path}: {room} has no place in the list"
        for used in sorted(set(re.findall(r"\bcrate::(\w+)", code(path))) - {room}):
            arrows += 1
            if used not in ROOMS or ROOMS.index(used) > ROOMS.index(room):
                wrong.append(f"{path.relative_to(ENGINE)} uses {used}, which stands above {room}")
    assert not wrong, "\n".join(wrong)
    assert arrows > 100, f"only {arrows} uses were found: is the list of what to look for still right?"
