"""A received program becomes a new file, whole or not at all; nothing that is there is ever touched."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from app.programs.file_changes import FileError, good_name, taken

ENDING = ".nc"


def stored(text: bytes, folder: Path, name: str) -> Path:
    """The new file. Raises FileError: the name is none, or is taken, or the disk does not take it."""
    name = good_name(name, Path(f"x{ENDING}"))
    if other := taken(folder, name):
        raise FileError(f"{other} IS THERE ALREADY; TAKE ANOTHER NAME")
    target = folder / name
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{folder} CANNOT BE WRITTEN: {error.strerror}") from error
    try:
        _put(target, text)
    except FileExistsError as error:
        raise FileError(f"{name} IS THERE ALREADY; TAKE ANOTHER NAME") from error
    except OSError as error:
        raise FileError(f"{target} CANNOT BE WRITTEN: {error.strerror}") from error
    return target


def free_name(folder: Path, name: str) -> str:
    """``name``, or the first of ``name-2``, ``name-3`` … that is not taken."""
    base = Path(name or "RECEIVED")
    suffix = base.suffix or ENDING
    tried, number = f"{base.stem}{suffix}", 1
    while taken(folder, tried):
        number += 1
        tried = f"{base.stem}-{number}{suffix}"
    return tried


def _put(target: Path, text: bytes) -> None:
    """Written beside, then given its name by a link: that fails where the name is taken, whoever took it."""
    handle, name = tempfile.mkstemp(prefix=".", suffix=".part", dir=target.parent)
    beside = Path(name)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        beside.chmod(0o644)
        target.hardlink_to(beside)
    finally:
        beside.unlink(missing_ok=True)
