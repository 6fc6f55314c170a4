"""What a place must offer in which desks share programs: versions are added to it, never changed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from core.extras.sharing.shared_versions import SharedVersion
from core.extras.sharing.version_record import DeskState
from core.message import Message


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
