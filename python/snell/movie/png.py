"""PNG by its chunks: is a file whole, and many of them as one that moves (APNG), without a pixel being decoded."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import BinaryIO

from ..errors import PictureError

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_ALIKE = (b"IHDR", b"PLTE", b"tRNS", b"gAMA", b"cHRM", b"sRGB", b"iCCP", b"cICP")  # what frames must share


def chunks(path: Path) -> Iterator[tuple[bytes, bytes]]:
    """Give type and content of each chunk, IHDR first.

    Raises
    ------
    PictureError
        If the file cannot be read, is no PNG, is cut off, has no pixels, or a chunk does not match its checksum.
    """
    try:
        with path.open("rb") as file:
            size = path.stat().st_size
            seen: set[bytes] = set()
            if file.read(8) != _SIGNATURE:
                raise damaged(path, "is no PNG")
            while b"IEND" not in seen:
                head = file.read(8)
                length, kind = struct.unpack(">I4s", head) if len(head) == 8 else (size, b"")
                content = file.read(length) if length < size else b""
                if file.read(4) != _checksum(kind, content):
                    raise damaged(path, "is cut off or damaged")
                if not seen and (kind, length) != (b"IHDR", 13):
                    raise damaged(path, "does not begin with the size of a picture (IHDR)")
                seen.add(kind)
                yield kind, content
            if b"IDAT" not in seen:
                raise damaged(path, "has no pixels (IDAT)")
    except OSError as error:
        raise damaged(path, f"cannot be read: {error.strerror}") from error


def damaged(path: Path, message: str) -> PictureError:
    """Return the error of a frame that is not as `sweep` left it."""
    return PictureError([(str(path), message, "the same sweep again renders it anew")])


def is_whole(path: Path) -> bool:
    """Say whether a file is a PNG from its first byte to its last."""
    try:
        return all(chunks(path))
    except PictureError:
        return False


def check_alike(frames: Sequence[Path]) -> None:
    """Check that frames are whole, and of one size and kind.

    Raises
    ------
    PictureError
        Naming the first one that is not.
    """
    first = None
    for frame in frames:
        alike = [part for part in chunks(frame) if part[0] in _ALIKE]
        first = first or alike
        if alike != first:
            sizes = [struct.unpack(">II", parts[0][1][:8]) for parts in (alike, first)]
            (width, height), (other_width, other_height) = sizes
            message = f"has {width} x {height} pixels, the first frame has {other_width} x {other_height}"
            raise PictureError([(str(frame), message, "a movie has one size")])


def animate(frames: Sequence[Path], path: Path, fps: Fraction) -> None:
    """Write an APNG that repeats for ever, with the very pixels of the frames, which are alike."""
    with path.open("wb") as file:
        file.write(_SIGNATURE)
        number = 0
        for index, frame in enumerate(frames):
            parts = list(chunks(frame))
            if index == 0:
                for kind, content in parts:
                    if kind in _ALIKE:
                        _write(file, kind, content)
                _write(file, b"acTL", struct.pack(">II", len(frames), 0))
            delay = struct.pack(">HHBB", fps.denominator, fps.numerator, 0, 0)
            size = parts[0][1][:8]
            _write(file, b"fcTL", struct.pack(">I", number) + size + bytes(8) + delay)
            number += 1
            for content in (content for kind, content in parts if kind == b"IDAT"):
                if index == 0:
                    _write(file, b"IDAT", content)
                else:
                    _write(file, b"fdAT", struct.pack(">I", number) + content)
                    number += 1
        _write(file, b"IEND", b"")


def _write(file: BinaryIO, kind: bytes, content: bytes) -> None:
    file.write(struct.pack(">I", len(content)) + kind + content + _checksum(kind, content))


def _checksum(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", zlib.crc32(content, zlib.crc32(kind)))
