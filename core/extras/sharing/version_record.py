"""Functions that encode and check the records of shared versions and of machine states."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from hashlib import sha256

from core.extras.sharing.shared_versions import SharedVersion
from core.message import CodedError, Message
from core.store.program_records import check_program_name
from core.store.store_errors import StoreError

FORMAT_VERSION = 1
MAX_PROGRAM_BYTES = 32 * 1024 * 1024  # bytes; larger programs are not shared
MAX_STATE_BYTES = 4 * 1024 * 1024  # bytes, largest state of a machine
MAX_RECORD_BYTES = 64 * 1024
_TEXTS = ("program", "text", "desk", "saved", "why")
_HEX = frozenset("0123456789abcdef")


class RecordError(CodedError):
    """An error raised if a record is invalid: not written by TurnDesk, incomplete or damaged."""


def make_version(
    program: str, text: bytes, parent_ids: tuple[str, ...], machine: str, saved: str, why: str
) -> SharedVersion:
    """Return a new version of a program with this text.

    The id of the version is the SHA-256 of its other values.
    """
    bare = SharedVersion("", program, sha256(text).hexdigest(), len(text), parent_ids, machine, saved, why)
    return bare._replace(id=sha256(encode_version(bare)).hexdigest())


def encode_version(version: SharedVersion) -> bytes:
    """Return the record of a version as bytes. Equal versions have identical records."""
    values = version._asdict()
    del values["id"]
    return _plain({"format": FORMAT_VERSION, **values})


def decode_version(name: str, record: bytes) -> SharedVersion:
    """Return the version in a record that is stored under the id ``name``.

    Raises RecordError if the record is invalid.
    """
    if sha256(record).hexdigest() != name:
        raise RecordError("the record does not match the checksum in the record name", "not-as-published")
    values = _object(record)
    texts = [values.get(key) for key in _TEXTS]
    size, follows = values.get("size"), values.get("follows")
    if values.get("format") != FORMAT_VERSION or not isinstance(size, int) or not isinstance(follows, list):
        raise RecordError(
            "the record is in a format that this TurnDesk version does not support", "not-this-format"
        )
    if not all(isinstance(each, str) and each.isprintable() for each in texts) or not all(
        map(is_version_id, follows)
    ):
        raise RecordError("the record is not a valid version record", "not-a-version")
    program, text, desk, saved, why = map(str, texts)
    try:
        check_program_name(program)
    except StoreError as error:
        raise RecordError(str(error), "invalid-name") from error
    if not is_version_id(text) or not 0 <= size <= MAX_PROGRAM_BYTES:
        raise RecordError("the version record has an invalid text ID or size", "not-a-text")
    return SharedVersion(name, program, text, size, tuple(follows), desk, saved, why)


def verify_text(version: SharedVersion, text: bytes) -> bytes:
    """Return the text if it matches the version; otherwise raise RecordError."""
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


# --- State of a machine ---------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class PublishedMachineState:
    """The program versions on one machine, as version ids by program name.

    ``machine_id`` identifies the machine, because two machines may have the same name.
    """

    machine_id: str
    machine_name: str
    reported_at: str  # UTC, by the machine's clock
    version_ids: Mapping[str, str] = field(default_factory=dict)

    def encode_state(self) -> bytes:
        """Return the state encoded as JSON bytes."""
        return _plain(
            {
                "format": FORMAT_VERSION,
                "desk": self.machine_name,
                "at": self.reported_at,
                "has": dict(self.version_ids),
            }
        )


def decode_machine_state(machine_id: str, data: bytes) -> PublishedMachineState:
    """Return the state that a machine has published.

    Raises RecordError if the record or the machine id is invalid.
    """
    values = _object(data)
    desk, at, has = values.get("desk"), values.get("at"), values.get("has")
    if (
        not is_machine_id(machine_id)
        or not isinstance(desk, str)
        or not isinstance(at, str)
        or not isinstance(has, dict)
    ):
        raise RecordError("the record is not a valid status record of a control", "not-a-desk")
    if not desk.isprintable() or not at.isprintable():
        raise RecordError("the record is not a valid status record of a control", "not-a-desk")
    return PublishedMachineState(
        machine_id, desk, at, {name: each for name, each in has.items() if is_version_id(each)}
    )


def is_machine_id(text: str) -> bool:
    """Return whether a text is a valid identifier of a machine."""
    return len(text) == 32 and set(text) <= _HEX


def is_version_id(value: object) -> bool:
    """Return whether a value is a valid id of a version."""
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
