"""Programs in and out by folder and USB stick. On a worker.

What is there already is replaced only when that was allowed, and its text is kept as a version first. A copy
is told as done when it has been written, brought to the disk and read back.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from app.desk.editing.files import SavingError, present, write_whole
from app.desk.files.changes import FileError, good_name, taken
from app.desk.keep import Keep
from core.language.source import SourceError, load_source
from core.store.errors import StoreError

LARGEST = 50_000_000  # bytes: no program is larger

Check = Callable[[Path], str]  # the first error that proving finds in a program; empty: none


@dataclass(frozen=True, slots=True)
class Moved:
    """What has come of it: names copied, names that stand there and differ, and what proving found."""

    done: tuple[str, ...] = ()
    standing: tuple[str, ...] = ()
    found: tuple[str, ...] = ()


def brought_in(sources: Sequence[Path], folder: Path, keep: Keep, check: Check, *, replace: bool) -> Moved:
    """Programs into the operator's folder, each proved. Raises FileError.

    Nothing is written as long as one stands there that differs and ``replace`` is not allowed.
    """
    texts = {good_name(path.name, path): _program(path) for path in sources}
    standing = _differing(texts, folder)
    if standing and not replace:
        return Moved(standing=standing)
    found = []
    for name, text in texts.items():
        target = folder / (taken(folder, name) or name)
        _keep_old(target, keep, text)
        _save(target, text)
        if trouble := check(target):
            found.append(f"{target.name}: {trouble}")
    return Moved(tuple(texts), (), tuple(found))


def taken_out(sources: Sequence[Path], folder: Path, *, replace: bool) -> Moved:
    """Programs to a folder or stick, whole and on the medium when this comes back. Raises FileError."""
    texts = {path.name: _bytes(path) for path in sources}
    standing = _differing(texts, folder)
    if standing and not replace:
        return Moved(standing=standing)
    for name, text in texts.items():
        _put(folder / (taken(folder, name) or name), text)
    _settle(folder)
    return Moved(tuple(texts))


def _program(path: Path) -> bytes:
    """The text, read as a program first: what is none does not come in."""
    data = _bytes(path)
    try:
        load_source(path)
    except SourceError as error:
        raise FileError(f"{path.name} IS NO PROGRAM: {error}") from error
    return data


def _bytes(path: Path) -> bytes:
    try:
        if path.stat().st_size > LARGEST:
            raise FileError(f"{path.name} IS LARGER THAN ANY PROGRAM ({LARGEST // 1_000_000} MB)")
        return path.read_bytes()
    except OSError as error:
        raise FileError(f"{path.name} CANNOT BE READ: {error.strerror}") from error


def _differing(texts: dict[str, bytes], folder: Path) -> tuple[str, ...]:
    """The names that stand in the folder with another text."""
    found = []
    for name, text in texts.items():
        other = taken(folder, name)
        if other and _bytes(folder / other) != text:
            found.append(other)
    return tuple(found)


def _keep_old(target: Path, keep: Keep, text: bytes) -> None:
    try:
        old = present(target)
        if old is not None and old != text:
            keep.keep_text(target.name, old, "replaced by an import")
    except (StoreError, SavingError) as error:
        raise FileError(f"{target.name} IS NOT REPLACED, BECAUSE ITS TEXT CANNOT BE KEPT: {error}") from error


def _save(target: Path, text: bytes) -> None:
    try:
        write_whole(target, text)
    except SavingError as error:
        raise FileError(str(error)) from error


def _put(target: Path, text: bytes) -> None:
    """The old file or the new one, whole, at every moment; also where a stick is pulled out."""
    try:
        handle, name = tempfile.mkstemp(prefix=".", suffix=".part", dir=target.parent)
        beside = Path(name)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            if beside.read_bytes() != text:
                raise FileError(f"{target.name} DOES NOT READ BACK AS IT WAS WRITTEN: TAKE ANOTHER STICK")
            beside.replace(target)
        finally:
            beside.unlink(missing_ok=True)
    except OSError as error:
        raise FileError(f"{target} CANNOT BE WRITTEN: {error.strerror}") from error


def _settle(folder: Path) -> None:
    """Until the folder itself is on the medium."""
    try:
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
    except OSError as error:
        raise FileError(f"{folder} CANNOT BE BROUGHT TO THE DISK: {error.strerror}") from error
    os.sync()
