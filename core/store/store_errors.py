"""Errors of the data store, with causes derived from the error codes of SQLite and the system."""

from __future__ import annotations

import errno
import sqlite3
from enum import Enum
from pathlib import Path

from core.message import CodedError, Message


class StoreError(CodedError):
    """Error raised if the store cannot perform a requested operation.

    The text contains the reason, the file and a remedy. ``is_temporary`` is True if the obstacle may
    disappear without intervention, such as a full disk or another program's lock.
    """

    is_temporary = False


_TRIAL_FILE_BYTES = 64 * 1024  # bytes, more than SQLite's index needs
_FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
_MISSING_ERRNOS = frozenset({errno.ENOENT, errno.ENOTDIR})
_FORBIDDEN = frozenset({errno.EACCES, errno.EPERM, errno.EROFS})


class StoreErrorCause(Enum):
    """The cause of a store error; its value is the template of the message."""

    FULL = "the disk is full, so nothing more can be written to {path}; free up space on that disk"
    LOCKED = "{path} is locked by another program; close that program, then try again"
    FORBIDDEN = (
        "this user does not have the required permission for {path} ({error}); check its "
        "permissions and the permissions of its folder"
    )
    MISSING = "{path} was not found: check the name, or put the file back and start turndesk again"
    FAILING = "{path}: the disk is failing ({error}); check that it is connected and in good condition"
    NOT_RESPONDING = (
        "the disk does not respond: changes are waiting to be written to {path}; check the disk and its cable"
    )
    DAMAGED = "{path} is damaged ({error}) and was not changed. Restore a backup: turndesk store restore FILE"
    OTHER = "{path} cannot be used ({error}) and was not changed"

    @property
    def error_code(self) -> str:
        """Return the code of the error, such as ``disk-full``."""
        return _CODES[self]

    def make_error(self, path: Path, error: object) -> StoreError:
        """Return a StoreError with this cause for the file ``path``."""
        made = StoreError(Message(self.value, path=path, error=" ".join(str(error).split())), self.error_code)
        made.is_temporary = self in {StoreErrorCause.FULL, StoreErrorCause.LOCKED}
        return made


_CODES = {
    StoreErrorCause.FULL: "disk-full",
    StoreErrorCause.LOCKED: "locked",
    StoreErrorCause.FORBIDDEN: "forbidden",
    StoreErrorCause.MISSING: "not-found",
    StoreErrorCause.FAILING: "disk-failing",
    StoreErrorCause.NOT_RESPONDING: "disk-hangs",
    StoreErrorCause.DAMAGED: "damaged",
    StoreErrorCause.OTHER: "unusable",
}

_BY_CODE = {
    sqlite3.SQLITE_FULL: StoreErrorCause.FULL,
    sqlite3.SQLITE_BUSY: StoreErrorCause.LOCKED,
    sqlite3.SQLITE_LOCKED: StoreErrorCause.LOCKED,
    sqlite3.SQLITE_PERM: StoreErrorCause.FORBIDDEN,
    sqlite3.SQLITE_AUTH: StoreErrorCause.FORBIDDEN,
    sqlite3.SQLITE_READONLY: StoreErrorCause.FORBIDDEN,
    sqlite3.SQLITE_CANTOPEN: StoreErrorCause.FORBIDDEN,
    sqlite3.SQLITE_IOERR: StoreErrorCause.FAILING,
    sqlite3.SQLITE_CORRUPT: StoreErrorCause.DAMAGED,
    sqlite3.SQLITE_NOTADB: StoreErrorCause.DAMAGED,
}


# SQLite has no error codes for these messages
_DAMAGED_WORDS = ("Could not decode to UTF-8", "unsupported file format")


def find_store_error_cause(path: Path, error: sqlite3.Error | OSError) -> StoreErrorCause:
    """Return the cause of an error that SQLite or the operating system reported.

    If the SQLite error code is ambiguous, the function writes a test file to the folder to find the error
    of the operating system.
    """
    if isinstance(error, OSError):
        return _of_system(error)
    if any(words in str(error) for words in _DAMAGED_WORDS):
        return StoreErrorCause.DAMAGED
    code = getattr(error, "sqlite_errorcode", None)
    if code == sqlite3.SQLITE_READONLY_DBMOVED:
        return StoreErrorCause.MISSING
    cause = (
        _BY_CODE.get(code & 0xFF, StoreErrorCause.OTHER) if isinstance(code, int) else StoreErrorCause.OTHER
    )
    if cause in {StoreErrorCause.FAILING, StoreErrorCause.FORBIDDEN}:
        tried = _trial(path.parent)
        return _of_system(tried) if tried is not None else cause
    return cause


def why(path: Path, error: sqlite3.Error | OSError) -> StoreError:
    """Return a StoreError that explains an SQLite or system error with the store in ``path``."""
    return find_store_error_cause(path, error).make_error(path, get_system_error_text(error))


def get_system_error_text(error: Exception) -> str:
    """Return the system's text for an error, without the error number and the file name."""
    return (isinstance(error, OSError) and error.strerror) or str(error)


def _trial(folder: Path) -> OSError | None:
    """Write a test file to ``folder`` and return the system's error, or None if writing succeeds.

    The test is necessary because SQLite does not report the error of the operating system.
    """
    from tempfile import TemporaryFile  # noqa: PLC0415  rarely wanted, and slow to load

    try:
        with TemporaryFile(dir=folder) as file:
            file.write(bytes(_TRIAL_FILE_BYTES))
            file.flush()
    except OSError as error:
        return error
    return None


def _of_system(error: OSError) -> StoreErrorCause:
    if error.errno in _FULL:
        return StoreErrorCause.FULL
    if error.errno in _FORBIDDEN:
        return StoreErrorCause.FORBIDDEN
    if error.errno in _MISSING_ERRNOS:
        return StoreErrorCause.MISSING
    return StoreErrorCause.FAILING if error.errno == errno.EIO else StoreErrorCause.OTHER
