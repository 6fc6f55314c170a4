"""What is being written beside its place: locked meanwhile, so what a kill has left there is known and goes.

A kill, or the mains, ends a process between the first byte and the name. What it wrote so far is nobody's:
the next one that writes in that folder takes it away. The kernel gives the lock of a killed process back.

Windows renames no file that somebody has open, so nothing is locked there, and what a kill left stays.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from core.file_lock import lock

_ENDING = ".unfinished"
_BESIDE = ("-journal", "-wal", "-shm")  # SQLite's, of a copy of a store


@contextmanager
def unfinished_file(target: Path) -> Iterator[Path]:
    """An empty file beside ``target``, to be written and renamed; gone afterwards. Raises OSError."""
    forget_killed(target.parent)
    handle, name = tempfile.mkstemp(prefix=f".{target.name}.", suffix=_ENDING, dir=target.parent)
    if sys.platform == "win32":
        os.close(handle)
        handle = -1
    try:
        with _locked(handle):
            yield Path(name)
    finally:
        Path(name).unlink(missing_ok=True)


@contextmanager
def unfinished_folder(target: Path) -> Iterator[Path]:
    """A folder beside ``target``, for what gets its name when it is whole; gone afterwards.

    Raises OSError.
    """
    forget_killed(target.parent)
    folder = tempfile.mkdtemp(prefix=f".{target.name}.", suffix=_ENDING, dir=target.parent)
    try:
        with _locked(_opened(Path(folder))):
            yield Path(folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def forget_killed(folder: Path) -> None:
    """Take away what writers that were killed have left in a folder; what is being written stays."""
    if sys.platform == "win32":
        return
    with suppress(OSError):
        for leftover in folder.glob(f".*{_ENDING}"):
            if not _is_held(leftover):
                _remove(leftover)
        for ending in _BESIDE:
            for beside in folder.glob(f".*{_ENDING}{ending}"):
                if not beside.with_name(beside.name.removesuffix(ending)).exists():
                    _remove(beside)


def _opened(path: Path) -> int:
    """For its lock; below nought where a system opens no folders."""
    try:
        return os.open(path, os.O_RDONLY)
    except OSError:
        return -1


@contextmanager
def _locked(handle: int) -> Iterator[None]:
    try:
        if handle >= 0:
            lock(handle)
        yield
    finally:
        if handle >= 0:
            os.close(handle)


def _is_held(path: Path) -> bool:
    """Whether somebody writes it; also where nobody can tell."""
    handle = _opened(path)
    if handle < 0:
        return True
    try:
        lock(handle)
    except OSError:
        return True
    finally:
        os.close(handle)
    return False


def _remove(path: Path) -> None:
    if path.is_dir():
        shutil.rmtree(path, ignore_errors=True)
    else:
        path.unlink(missing_ok=True)
