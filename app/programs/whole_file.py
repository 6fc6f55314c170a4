"""A program file is replaced whole or not at all, and only by what reads back as it was written."""

from __future__ import annotations

import os
import shutil
import tempfile
from pathlib import Path

from core.language.source import SourceError, load_source


class SavingError(Exception):
    """The file is as it was; the sentence says why."""


def write_whole(path: Path, data: bytes) -> None:
    """Put ``data`` in the place of the file, which is the old or the new one at every moment.

    It is written beside it first, read back as a program, and taken over in one step, its rights kept.
    Raises SavingError.
    """
    target = path.resolve()  # what a link names is replaced, not the link
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        beside = Path(tempfile.mkdtemp(prefix=".saving-", dir=target.parent))
    except OSError as error:
        raise SavingError(f"{target.parent} CANNOT BE WRITTEN: {error.strerror}") from error
    try:
        _through(beside / target.name, target, data)
    except OSError as error:
        raise SavingError(f"{target.name} CANNOT BE WRITTEN: {error.strerror}") from error
    except SourceError as error:
        raise SavingError(f"NOT SAVED: {error}") from error
    finally:
        shutil.rmtree(beside, ignore_errors=True)


def present(path: Path) -> bytes | None:
    """What the file holds now; None where there is none. Raises SavingError when it cannot be read."""
    try:
        return path.read_bytes()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise SavingError(f"{path.name} CANNOT BE READ: {error.strerror}") from error


def _through(draft: Path, target: Path, data: bytes) -> None:
    with draft.open("wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    if load_source(draft).text.encode("utf-8", "replace") != data:
        raise SavingError("NOT SAVED: THE TEXT HOLDS SIGNS THAT NO PROGRAM FILE CAN KEEP")
    if target.exists():
        shutil.copymode(target, draft)
    draft.replace(target)
    folder = os.open(target.parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)
