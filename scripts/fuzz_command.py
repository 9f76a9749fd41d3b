"""Give the command files that are nearly right, for so many seconds, and look at what it says.

    python3 scripts/fuzz_command.py target/ci/snell SECONDS [SEED]

Files are the seeds of the fuzz targets and the scenes, with bytes changed, cut, repeated and put together. Whatever they are: the
command ends with 0, or with 1 to 3 and a line on stderr that begins with "error" (but for `check` and `diff`, whose 1 is an
answer); it does not panic, take longer than 20 seconds, or print a character that steers a terminal; and no input is changed.
"""

import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).parent.parent
VERBS = [
    ["render", "IN", "-o", "out.png", "--size", "4x4"],
    ["render", "-q", "IN", "-o", "out.exr", "--size", "4x4", "--paths", "2"],
    ["render", "--from", "IN", "-o", "out.png", "--size", "4x4"],
    ["explain", "IN", "1,1", "--size", "4x4"],
    ["explain", "IN", "--find", "ball", "--size", "4x4"],
    ["info", "IN"],
    ["convert", "IN"],
    ["convert", "IN", "-o", "out.toml", "--force"],
    ["check", "IN"],
    ["check", "IN", "--repair", "-o", "out.obj", "--force"],
    ["diff", "IN", "IN"],
]
WORDS = [b"nan", b"inf", b"-1", b"0", b"1e308", b"1e-320", b"\xff\xfe", b"\xef\xbb\xbf", b"\x1b[31m", b"\x00", b"\r", b"[[", b"=", b"# "]


def changed(draw: random.Random, seeds: list[bytes]) -> bytes:
    """Return some seed with some damage."""
    data = bytearray(draw.choice(seeds))
    for _ in range(draw.randrange(4)):
        at = draw.randrange(len(data) + 1)
        match draw.randrange(6):
            case 0 if data:
                data[at % len(data)] = draw.randrange(256)
            case 1:
                del data[at : at + draw.randrange(40)]
            case 2:
                data[at:at] = draw.choice(WORDS)
            case 3:
                data[at:at] = data[at : at + draw.randrange(200)] * draw.randrange(1, 30)
            case 4:
                data = data[:at]
            case 5:
                other = draw.choice(seeds)
                data[at:] = other[draw.randrange(len(other) + 1) :]
    text = bytes(data[: 1 << 16])
    return text.decode("latin-1").encode("utf-16") if draw.randrange(30) == 0 else text


def fault(verb: str, code: int, out: bytes, err: bytes) -> str | None:
    """Return what is wrong with an answer."""
    said = err.decode("utf-8", "replace")
    if b"panicked" in err or code not in (0, 1, 2, 3):
        return f"ends with {code}"
    answers = verb in ("check", "diff") and code == 1 and out
    if code != 0 and not answers and not any(line.startswith("error") for line in said.splitlines()):
        return f"ends with {code} and no error"
    text = out.decode("utf-8", "replace") + said
    odd = next((c for c in text if ord(c) < 32 and c not in "\n\t" or 127 <= ord(c) < 160), None)
    return f"prints {odd!r}" if odd else None


def main() -> int:
    """Run until the time is over, or something is found."""
    command, seconds = Path(sys.argv[1]).resolve(), float(sys.argv[2])
    draw = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else None)
    files = [p for p in (ROOT / "fuzz/seeds").rglob("*") if p.is_file()]
    files += [*(ROOT / "scenes/lecture").glob("*.toml"), ROOT / "docs/pictures/default.png"]
    seeds = [path.read_bytes() for path in files]
    endings = ["", ".toml", ".json", ".txt", ".nff", ".obj", ".ply", ".stl", ".png", ".ppm", ".exr", ".npy", ".mtl"]
    end, count = time.monotonic() + seconds, 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for path in files:
            if path.suffix in (".obj", ".mtl", ".ply", ".stl"):
                (folder / path.name).write_bytes(path.read_bytes())
        while time.monotonic() < end:
            count += 1
            data = changed(draw, seeds)
            given = folder / f"in{draw.choice(endings)}"
            given.write_bytes(data)
            verb = [given.name if word == "IN" else word for word in draw.choice(VERBS)]
            try:
                ran = subprocess.run([command, *verb], cwd=folder, capture_output=True, timeout=20, check=False)
                wrong = fault(verb[0], ran.returncode, ran.stdout, ran.stderr)
            except subprocess.TimeoutExpired:
                wrong = "takes longer than 20 s"
            if wrong is None and given.read_bytes() != data:
                wrong = "changes its input"
            if wrong:
                kept = Path(tempfile.mkdtemp()) / given.name
                kept.write_bytes(data)
                print(f"snell {' '.join(verb)} {wrong}: {kept}")
                return 1
            given.unlink()
    print(f"{count} commands, none wrong")
    return 0


if __name__ == "__main__":
    sys.exit(main())
