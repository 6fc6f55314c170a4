"""Why a store cannot be read or written: a full disk is called full, a locked file locked, damage damage."""

from __future__ import annotations

import errno
import os
import sqlite3
from enum import Enum
from pathlib import Path

from core.store.errors import StoreError

_ROOM = 64 * 1024  # bytes: with less than that SQLite cannot even make its index
_FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
_FORBIDDEN = frozenset({errno.EACCES, errno.EPERM, errno.EROFS})


class Cause(Enum):
    """What is wrong, and what to do about it."""

    FULL = "the disk is full: {path} takes nothing more; make room on that disk"
    LOCKED = "{path} is locked by another program; close that one, then try again"
    FORBIDDEN = "{path} may not be used so by this user ({error}); check its rights and those of its folder"
    GONE = "{path} was moved or deleted while it was in use; put it back, then start turndesk again"
    FAILING = "{path}: the disk fails ({error}); check that it is there and sound"
    DAMAGED = (
        "{path} is damaged ({error}); it is left as it is. Restore a backup: turndesk store restore FILE"
    )
    OTHER = "{path} cannot be used ({error}); it is left as it is"

    def told(self, path: Path, error: object) -> StoreError:
        """The sentence for it."""
        made = StoreError(self.value.format(path=path, error=" ".join(str(error).split())))
        made.passing = self in {Cause.FULL, Cause.LOCKED}
        return made


_BY_CODE = {
    sqlite3.SQLITE_FULL: Cause.FULL,
    sqlite3.SQLITE_BUSY: Cause.LOCKED,
    sqlite3.SQLITE_LOCKED: Cause.LOCKED,
    sqlite3.SQLITE_PERM: Cause.FORBIDDEN,
    sqlite3.SQLITE_AUTH: Cause.FORBIDDEN,
    sqlite3.SQLITE_READONLY: Cause.FORBIDDEN,
    sqlite3.SQLITE_CANTOPEN: Cause.FORBIDDEN,
    sqlite3.SQLITE_IOERR: Cause.FAILING,
    sqlite3.SQLITE_CORRUPT: Cause.DAMAGED,
    sqlite3.SQLITE_NOTADB: Cause.DAMAGED,
}


def cause_of(path: Path, error: sqlite3.Error | OSError) -> Cause:
    """What has made SQLite or the system refuse; where that tells too little, the disk is looked at."""
    if isinstance(error, OSError):
        return _of_system(error)
    code = getattr(error, "sqlite_errorcode", None)
    if code == sqlite3.SQLITE_READONLY_DBMOVED:
        return Cause.GONE
    cause = _BY_CODE.get(code & 0xFF, Cause.OTHER) if isinstance(code, int) else Cause.OTHER
    if cause in {Cause.FAILING, Cause.FORBIDDEN} and room_beside(path) < _ROOM:
        return Cause.FULL
    if cause is Cause.FORBIDDEN and not path.exists():
        return Cause.GONE if path.parent.exists() else Cause.OTHER
    return cause


def why(path: Path, error: sqlite3.Error | OSError) -> StoreError:
    """The sentence for what went wrong with the store in ``path``."""
    said = error.strerror or str(error) if isinstance(error, OSError) else str(error)
    return cause_of(path, error).told(path, said)


def room_beside(path: Path) -> int:
    """Bytes that a user may still write where ``path`` lies; much, where nobody can tell."""
    try:
        found = os.statvfs(path.parent)
    except OSError:
        return 2**62
    return found.f_bavail * found.f_frsize


def _of_system(error: OSError) -> Cause:
    if error.errno in _FULL:
        return Cause.FULL
    if error.errno in _FORBIDDEN:
        return Cause.FORBIDDEN
    return Cause.FAILING if error.errno == errno.EIO else Cause.OTHER
