"""The record of a shared version and of what a desk has; and what a place must offer that takes them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from hashlib import sha256
from typing import NamedTuple, Protocol

from core.extras.sharing.shared_versions import SharedVersion
from core.message import CodedError, Message
from core.store.program_records import check_name
from core.store.store_errors import StoreError

FORMAT = 1
MOST_BYTES = 32 * 1024 * 1024  # of a program: more is not shared
LONGEST_STATE = 4 * 1024 * 1024  # bytes of what a desk says it has
LONGEST_RECORD = 64 * 1024
_TEXTS = ("program", "text", "desk", "saved", "why")
_HEX = frozenset("0123456789abcdef")


class RecordError(CodedError):
    """It is no record of ours: garbage, half written, or damaged."""


def new_version(
    program: str, text: bytes, follows: tuple[str, ...], desk: str, saved: str, why: str
) -> SharedVersion:
    """The version that a text becomes; its id follows from all the rest."""
    bare = SharedVersion("", program, sha256(text).hexdigest(), len(text), follows, desk, saved, why)
    return bare._replace(id=sha256(written(bare)).hexdigest())


def written(version: SharedVersion) -> bytes:
    """The record as bytes, always the same for the same version; its id is their SHA-256."""
    values = version._asdict()
    del values["id"]
    return _plain({"format": FORMAT, **values})


def read_version(name: str, record: bytes) -> SharedVersion:
    """The version whose record is kept under this id. Raises RecordError."""
    if sha256(record).hexdigest() != name:
        raise RecordError("the record does not match the checksum in the record name", "not-as-published")
    values = _object(record)
    texts = [values.get(key) for key in _TEXTS]
    size, follows = values.get("size"), values.get("follows")
    if values.get("format") != FORMAT or not isinstance(size, int) or not isinstance(follows, list):
        raise RecordError(
            "the record is in a format that this TurnDesk version does not support", "not-this-format"
        )
    if not all(isinstance(each, str) and each.isprintable() for each in texts) or not all(
        map(is_id, follows)
    ):
        raise RecordError("the record is not a valid version record", "not-a-version")
    program, text, desk, saved, why = map(str, texts)
    try:
        check_name(program)
    except StoreError as error:
        raise RecordError(str(error), "invalid-name") from error
    if not is_id(text) or not 0 <= size <= MOST_BYTES:
        raise RecordError("the version record has an invalid text ID or size", "not-a-text")
    return SharedVersion(name, program, text, size, tuple(follows), desk, saved, why)


def checked_text(version: SharedVersion, text: bytes) -> bytes:
    """The text, when it is that of the version. Raises RecordError."""
    if sha256(text).hexdigest() != version.text:
        raise RecordError(
            Message(
                "the text of {program} from {machine} does not match the checksum in the version record",
                program=version.program,
                machine=version.desk,
            ),
            "text-not-as-published",
        )
    return text


# --- what a desk has ------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class DeskState:
    """Which version of each program a desk has: ids by name. ``home`` tells desks of one name apart."""

    home: str
    desk: str
    at: str  # by its own clock, UTC
    has: Mapping[str, str] = field(default_factory=dict)

    def written(self) -> bytes:
        """As bytes."""
        return _plain({"format": FORMAT, "desk": self.desk, "at": self.at, "has": dict(self.has)})


def read_state(home: str, data: bytes) -> DeskState:
    """What a desk has told of itself. Raises RecordError."""
    values = _object(data)
    desk, at, has = values.get("desk"), values.get("at"), values.get("has")
    if not is_home(home) or not isinstance(desk, str) or not isinstance(at, str) or not isinstance(has, dict):
        raise RecordError("the record is not a valid status record of a control", "not-a-desk")
    if not desk.isprintable() or not at.isprintable():
        raise RecordError("the record is not a valid status record of a control", "not-a-desk")
    return DeskState(home, desk, at, {name: each for name, each in has.items() if is_id(each)})


def is_home(text: str) -> bool:
    """Whether it can tell a desk from others."""
    return len(text) == 32 and set(text) <= _HEX


def is_id(value: object) -> bool:
    """Whether it can be the id of a version."""
    return isinstance(value, str) and len(value) == 64 and set(value) <= _HEX


def _object(data: bytes) -> dict[str, object]:
    try:
        values = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise RecordError("the record was not written by TurnDesk", "not-ours") from error
    if not isinstance(values, dict):
        raise RecordError("the record was not written by TurnDesk", "not-ours")
    return values


def _plain(values: object) -> bytes:
    return json.dumps(values, sort_keys=True, separators=(",", ":"), ensure_ascii=True).encode()


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
