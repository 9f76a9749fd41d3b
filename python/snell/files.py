"""Files that are written whole or not at all, by names whose endings are known."""

from __future__ import annotations

import os
import secrets
import shutil
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from .errors import PictureError


def ending(path: str | os.PathLike[str], what: str, known: Collection[str]) -> str:
    """Return the ending of a file's name in lower case, which is its format.

    Raises
    ------
    PictureError
        If it is none of those known.
    """
    found = Path(path).suffix.lower()
    if found not in known:
        help = f"known {'is' if len(known) == 1 else 'are'} {', '.join(known)}"
        raise PictureError([(_place(path), f"no {what} has this ending", help)])
    return found


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a name beside a file to write to; it takes the file's place at the end, unless something went wrong.

    Raises
    ------
    PictureError
        If the file cannot be written; what was there before stays.
    """
    given = Path(path)
    if "\0" in str(given):
        raise _unwritable(path, "no file's name has a NUL")
    try:
        if given.exists() and not given.is_file():  # a pipe or a device cannot be replaced; a folder says so itself
            yield given
            return
        target = Path(os.path.realpath(given))  # a link stays a link
        old = target.exists()
        if old and not target.stat().st_mode & 0o222:  # to replace it, the folder's permission would do
            raise _unwritable(path, "it is read-only")
        # Not by tempfile, whose files are for their owner only; and the umask cannot be asked for without changing it.
        beside = target.with_name(f".snell-{secrets.token_hex(8)}.tmp")
        try:
            yield beside
            if old:
                shutil.copymode(target, beside)
            beside.replace(target)
        finally:
            with suppress(OSError):
                beside.unlink()
    except OSError as error:
        raise _unwritable(path, error.strerror or str(error)) from error


def _unwritable(path: str | os.PathLike[str], reason: str) -> PictureError:
    return PictureError([(_place(path), f"cannot be written: {reason}", None)])


def _place(path: str | os.PathLike[str]) -> str:
    return os.fspath(path).replace("\0", r"\0")
