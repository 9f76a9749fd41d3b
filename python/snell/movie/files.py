"""Files that are written whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ..errors import PictureError


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a name beside a file to write to; it takes the file's place at the end, unless something went wrong."""
    target = Path(os.path.realpath(path))  # a link stays a link
    beside = target.with_name(f".{target.name}.{os.getpid()}.new")
    try:
        yield beside
        beside.replace(target)
    except OSError as error:
        raise PictureError([(os.fspath(path), f"cannot be written: {error.strerror or error}", None)]) from error
    finally:
        with suppress(OSError):
            beside.unlink()
