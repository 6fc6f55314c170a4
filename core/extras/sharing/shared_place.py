"""What a place must offer in which desks share programs, and why programs cannot be shared just now.

Versions are added to a place, never changed. Each cause is one sentence, with what to do.
"""

from __future__ import annotations

import errno
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple, Protocol

from core.extras.sharing.shared_versions import SharedVersion
from core.extras.sharing.version_record import DeskState
from core.input_file import NotAFileError, TooLargeError
from core.message import CodedError, Message


class Published(NamedTuple):
    """A version with its text."""

    version: SharedVersion
    text: bytes


@dataclass(frozen=True, slots=True)
class Found:
    """What a look at the place has found. ``there``: ids of all its versions; ``fresh``: the unknown ones.

    ``strays`` are things in it that are no version and no desk, by name: garbage, damaged, half written.
    """

    there: frozenset[str]
    fresh: tuple[SharedVersion, ...] = ()
    desks: tuple[DeskState, ...] = ()
    strays: tuple[str, ...] = ()


class SharedPlace(Protocol):
    """Each call may take its time and raise SharingError with one cause; it is made on a worker only."""

    name: str  # as sentences call it

    def begin(self) -> None:
        """Lay the place out; what is laid out already stays as it is."""
        ...

    def look(self, known: Mapping[str, SharedVersion]) -> Found:
        """What is there, with the records of versions that are not ``known`` (by id)."""
        ...

    def put(self, versions: Sequence[Published], state: DeskState) -> None:
        """Add versions, and say what this desk has. All is there to stay when this is back.

        A version that is there already is left as it is. After a failure some of them may be there, each
        whole: the same call again adds the rest.
        """
        ...

    def text(self, version: SharedVersion) -> bytes:
        """The text of a version, checked."""
        ...


def folder_at(folder: object) -> str:
    """What sentences call a folder."""
    return Message("the folder {folder}", folder=folder)


def database_at(address: str) -> str:
    """What they call a database; ``address`` without a password."""
    return Message("the database {address}", address=address)


_FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
_NO_RIGHT = frozenset({errno.EACCES, errno.EPERM, errno.EROFS})
_NOT_THERE = frozenset({errno.ENOENT, errno.ENOTDIR})


class Cause(Enum):
    """What is in the way, and what to do about it."""

    AWAY = (
        "{place} does not respond ({why}); this control continues to work, and will "
        "share programs again when the connection is restored"
    )
    NO_RIGHT = (
        "this user does not have permission for this action in {place} ({why}); ask the "
        "administrator for permission"
    )
    NOT_THERE = "{place} was not found ({why}); check that it is mounted and that its name is right"
    NOT_BEGUN = (
        "{place} contains no shared programs; check that it is mounted and that its "
        "name is right. To set up a new location, run: turndesk share begin"
    )
    NEWER = "{place} was set up by a newer TurnDesk (format {why}); update TurnDesk on this control"
    OTHER = "{place} is not set up for shared programs ({why}); specify another location"
    FULL = "the disk of {place} is full; free up space on that disk"
    DAMAGED = "{place}: {why}"
    UNREADABLE = (
        "[sharing] postgresql is not a valid connection string; put a value that contains "
        "spaces in quotation marks, and write / and @ in the password of an address as %2F "
        "and %40"
    )
    WRONG_PASSWORD = (
        "{place} rejects the user name or the password ({why}); correct the user name "
        "or the password in [sharing] postgresql"
    )
    NOT_TRUSTED = (
        "the certificate of {place} cannot be verified ({why}); set sslrootcert=FILE in "
        "[sharing] postgresql to the certificate of its issuer"
    )
    NO_TLS = (
        "{place} does not support TLS ({why}); turn on TLS at that server, or, on a network "
        "where you trust every user, write sslmode=disable in [sharing] postgresql"
    )
    TLS_ONLY = "{place} accepts only TLS connections ({why}); remove sslmode from [sharing] postgresql"
    NO_PSYCOPG = "[sharing] postgresql needs psycopg, which is not installed; install turndesk[postgresql]"
    NAME_TAKEN = (
        "{place}: another control is also named {why}; give this control a name that "
        "no other control uses (desk in [sharing]) or, if the other computer no longer "
        "exists, run: turndesk share publish --claim"
    )

    @property
    def code(self) -> str:
        """Return the code of the error: the name in kebab case, such as ``no-right``."""
        return "disk-full" if self is Cause.FULL else self.name.lower().replace("_", "-")

    def error(self, place: str, why: object = "") -> SharingError:
        """The sentence for it, on one line."""
        made = SharingError(Message(self.value, place=place, why=" ".join(str(why).split())), self.code)
        made.cause = self
        return made


class SharingError(CodedError):
    """Sharing cannot do what it was asked; nothing that was there has changed."""

    cause: Cause


def of_system(place: str, error: OSError) -> SharingError:
    """The sentence for what the system says."""
    why = error.strerror or str(error)
    if error.errno in _FULL:
        return Cause.FULL.error(place)
    if error.errno in _NO_RIGHT:
        return Cause.NO_RIGHT.error(place, why)
    if error.errno in _NOT_THERE:
        return Cause.NOT_THERE.error(place, why)
    if isinstance(error, NotAFileError | TooLargeError):
        return Cause.DAMAGED.error(place, why)
    return Cause.AWAY.error(place, why)
