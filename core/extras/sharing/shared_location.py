"""Interface of a location where machines share programs, and the errors of sharing.

Versions are added to a location and never changed. Each error has one cause and a remedy.
"""

from __future__ import annotations

import errno
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple, Protocol

from core.extras.sharing.shared_versions import SharedVersion
from core.extras.sharing.version_record import PublishedMachineState
from core.input_file import NotAFileError, TooLargeError
from core.message import CodedError, Message


class PublishedVersion(NamedTuple):
    """A program version together with its text."""

    version: SharedVersion
    program_text: bytes


@dataclass(frozen=True, slots=True)
class Found:
    """Contents of a shared location.

    ``stored_ids`` are the ids of all versions, and ``unknown_versions`` are the versions that the caller
    did not know. ``foreign_item_names`` are the names of other items, such as damaged or incomplete files.
    """

    stored_ids: frozenset[str]
    unknown_versions: tuple[SharedVersion, ...] = ()
    machine_states: tuple[PublishedMachineState, ...] = ()
    foreign_item_names: tuple[str, ...] = ()


class SharedLocation(Protocol):
    """A location where machines share programs.

    Calls may take long, so they are made only in a worker thread. They raise SharingError on failure.
    """

    name: str  # the name in messages

    def set_up(self) -> None:
        """Set up the location. Parts that are already set up remain unchanged."""
        ...

    def read_contents(self, known_versions: Mapping[str, SharedVersion]) -> Found:
        """Return the contents of the location.

        The result contains the records of the versions that are not in ``known_versions``, whose keys are
        ids.
        """
        ...

    def publish_versions(self, versions: Sequence[PublishedVersion], state: PublishedMachineState) -> None:
        """Add versions and the state of this machine, and return when they are stored permanently.

        Versions that already exist remain unchanged. After a failure, some versions may have been added
        completely. Repeating the call then adds the other versions.
        """
        ...

    def read_text(self, version: SharedVersion) -> bytes:
        """Return the text of a version, after checking it against its checksum."""
        ...


def make_folder_label(folder: object) -> str:
    """Return the label of a folder for messages."""
    return Message("the folder {folder}", folder=folder)


def make_database_label(address: str) -> str:
    """Return the label of a database for messages; ``address`` must not contain a password."""
    return Message("the database {address}", address=address)


_FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})
_NO_RIGHT = frozenset({errno.EACCES, errno.EPERM, errno.EROFS})
_NOT_THERE = frozenset({errno.ENOENT, errno.ENOTDIR})


class SharingErrorCause(Enum):
    """Cause of a sharing error. The value of each member is its message template."""

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
    def error_code(self) -> str:
        """Return the code of the error, which is the name in kebab case, such as ``no-right``."""
        return "disk-full" if self is SharingErrorCause.FULL else self.name.lower().replace("_", "-")

    def make_error(self, location: str, reason: object = "") -> SharingError:
        """Return a SharingError with this cause and with the reason on one line."""
        made = SharingError(
            Message(self.value, place=location, why=" ".join(str(reason).split())), self.error_code
        )
        made.cause = self
        return made


class SharingError(CodedError):
    """An error raised if a sharing operation fails. Versions already shared remain unchanged."""

    cause: SharingErrorCause


def make_sharing_error(location: str, error: OSError) -> SharingError:
    """Return the SharingError for an error of the operating system."""
    why = error.strerror or str(error)
    if error.errno in _FULL:
        return SharingErrorCause.FULL.make_error(location)
    if error.errno in _NO_RIGHT:
        return SharingErrorCause.NO_RIGHT.make_error(location, why)
    if error.errno in _NOT_THERE:
        return SharingErrorCause.NOT_THERE.make_error(location, why)
    if isinstance(error, NotAFileError | TooLargeError):
        return SharingErrorCause.DAMAGED.make_error(location, why)
    return SharingErrorCause.AWAY.make_error(location, why)
