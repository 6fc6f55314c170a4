"""Exclusive locks on open files, and temporary files that are locked until they receive their final name.

If a process is killed while it writes such a file, the next writer in the folder removes the file, because
the kernel has released its lock. Windows cannot rename open files, so temporary files are not locked there
and remain after a crash.
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
_FAR = 1 << 30  # position of the byte that Windows locks, outside the data that is read or written
_ENDING = ".unfinished"
_BESIDE = ("-journal", "-wal", "-shm")  # files that SQLite creates for a copy of a store


def lock_file(file: int) -> None:
    """Lock an open file without waiting, until the file is closed.

    Raises OSError if the file is locked through another open file, in this process or another, or if the
    file system does not support locks. On systems without file locks the function does nothing.
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
    """Make the lock of ``file`` visible to ``is_locked``.

    Do not call it for a SQLite file, because SQLite locks the same byte.
    """
    if sys.platform == "win32":
        return
    try:
        import fcntl  # noqa: PLC0415  not on every system
    except ImportError:
        return
    if hasattr(fcntl, "F_OFD_SETLK"):
        with suppress(OSError):  # a network drive may not support record locks
            fcntl.fcntl(file, fcntl.F_OFD_SETLK, _record(fcntl.F_WRLCK))


def is_locked(file: int) -> bool:
    """Return whether the file is locked through another open file.

    Linux reports record locks without taking the lock, but has no query for ``flock``. On other systems the
    function locks the file for an instant, so a process that tries to lock the file at that instant must
    try again.
    """
    found = _read_lock_info(file)
    if found is not None:
        return found
    try:
        lock_file(file)
    except OSError:
        return True
    return False


def _read_lock_info(file: int) -> bool | None:
    """Return whether the system reports a lock on the file, or None if the system has no such query."""
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
    """Return the ``struct flock`` that describes a lock on one byte outside the data."""
    return struct.pack(_RECORD, kind, os.SEEK_SET, _FAR, 1, 0)


@contextmanager
def create_unfinished_file(target: Path) -> Iterator[Path]:
    """Create an empty temporary file next to ``target``, and delete it at the end of the context.

    The caller writes the file and renames it to ``target``. Raises OSError if the file cannot be created or
    locked.
    """
    remove_abandoned_files(target.parent)
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
def create_unfinished_folder(target: Path) -> Iterator[Path]:
    """Create a temporary folder next to ``target``, and delete it at the end of the context.

    The caller fills the folder and renames it to ``target``. Raises OSError if the folder cannot be created
    or locked.
    """
    remove_abandoned_files(target.parent)
    folder = tempfile.mkdtemp(prefix=f".{target.name}.", suffix=_ENDING, dir=target.parent)
    try:
        with _locked(_opened(Path(folder))):
            yield Path(folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def remove_abandoned_files(folder: Path) -> None:
    """Remove from a folder the temporary files of processes that were killed.

    Files that another process is still writing remain.
    """
    if sys.platform == "win32":
        return
    with suppress(OSError):
        for leftover in folder.glob(f".*{_ENDING}"):
            if not is_written_elsewhere(leftover):
                _remove(leftover)
        for ending in _BESIDE:
            for companion_file in folder.glob(f".*{_ENDING}{ending}"):
                if not companion_file.with_name(companion_file.name.removesuffix(ending)).exists():
                    _remove(companion_file)


def _opened(path: Path) -> int:
    """Return a file descriptor for locking the path, or -1 if the system cannot open the file."""
    try:
        return os.open(path, os.O_RDONLY)
    except OSError:
        return -1


@contextmanager
def _locked(handle: int) -> Iterator[None]:
    try:
        if handle >= 0:
            lock_file(handle)
        yield
    finally:
        if handle >= 0:
            os.close(handle)


def is_written_elsewhere(path: Path) -> bool:
    """Return whether another process is writing the file, or True if this is unknown."""
    handle = _opened(path)
    if handle < 0:
        return True
    try:
        lock_file(handle)
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
