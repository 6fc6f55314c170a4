"""An exclusive lock on an open file, and unfinished files, which are locked until they get their name.

A kill, or the mains, ends a process between the first byte and the name. What it wrote so far is nobody's:
the next one that writes in that folder takes it away. The kernel gives the lock of a killed process back.

Windows renames no file that somebody has open, so nothing is locked there, and what a kill left stays.
"""

from __future__ import annotations

import os
import shutil
import struct
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

_RECORD = "hhqqi4x"  # type, whence, start, length, process
_FAR = 1 << 30  # where Windows locks a byte: none that is read or written
_ENDING = ".unfinished"
_BESIDE = ("-journal", "-wal", "-shm")  # SQLite's, of a copy of a store


def lock(file: int) -> None:
    """Take it at once, for as long as the file is open. Raises OSError while somebody else has it.

    A system that has neither lock goes without.
    """
    if sys.platform == "win32":
        import msvcrt  # noqa: PLC0415

        os.lseek(file, _FAR, os.SEEK_SET)
        msvcrt.locking(file, msvcrt.LK_NBLCK, 1)
        os.lseek(file, 0, os.SEEK_SET)
        return
    try:
        import fcntl  # noqa: PLC0415  not on every system
    except ImportError:
        return
    fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def mark_locked(file: int) -> None:
    """Let ``is_locked`` see the lock of ``file``; never for a file of SQLite, which locks the same byte."""
    if sys.platform == "win32":
        return
    try:
        import fcntl  # noqa: PLC0415  not on every system
    except ImportError:
        return
    if hasattr(fcntl, "F_OFD_SETLK"):
        with suppress(OSError):  # a network drive may not have it
            fcntl.fcntl(file, fcntl.F_OFD_SETLK, _record(fcntl.F_WRLCK))


def is_locked(file: int) -> bool:
    """Return whether another open file holds the lock of ``file``; do not take it if the system can tell.

    Linux reports a record lock that belongs to the open file; flock has no such query. Elsewhere the lock is
    taken for an instant: who wants it at that instant tries again.
    """
    found = _asked(file)
    if found is not None:
        return found
    try:
        lock(file)
    except OSError:
        return True
    return False


def _asked(file: int) -> bool | None:
    """The answer of the system; None where it has none."""
    if sys.platform == "win32":
        return None
    try:
        import fcntl  # noqa: PLC0415  not on every system
    except ImportError:
        return False
    if not hasattr(fcntl, "F_OFD_GETLK"):
        return None
    try:
        answer = fcntl.fcntl(file, fcntl.F_OFD_GETLK, _record(fcntl.F_WRLCK))
    except OSError:
        return None
    return bool(struct.unpack(_RECORD, answer)[0] != fcntl.F_UNLCK)


def _record(kind: int) -> bytes:
    """A record lock on one byte far from what is written, as the system's ``struct flock``."""
    return struct.pack(_RECORD, kind, os.SEEK_SET, _FAR, 1, 0)


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
