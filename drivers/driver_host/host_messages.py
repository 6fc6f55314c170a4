"""Socket messages of the driver host: two length fields, a JSON header and binary numbers."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple, get_args

import numpy as np

from core.faults import get_fault_code
from core.ports import Cam, DriverError, Fault, FaultCode, FloatArray, MotionSegments

_LENGTHS = struct.Struct("<II")  # Lengths of the head and of the numbers in bytes.
MAX_MESSAGE_BYTES = 64_000_000  # Maximum size of a message in bytes.
_MAX_NUMBER = 1e300  # Larger numbers and NaN are invalid.
_NO_MESSAGE: tuple[str, FaultCode] = "the driver host's socket received an invalid message", "feeder-silent"
PROTOCOL_VERSION = 5  # Version of the protocol, which both sides exchange first.


class Message(NamedTuple):
    """Request or reply: a header of named values, and a flat array of numbers."""

    header: Mapping[str, object]
    numbers: FloatArray


NO_NUMBERS: FloatArray = np.empty(0)


def encode_message(message: Message) -> bytes:
    """Return a message encoded as bytes."""
    head = json.dumps(message.header).encode()
    numbers = np.ascontiguousarray(message.numbers, dtype="<f8").tobytes()
    return _LENGTHS.pack(len(head), len(numbers)) + head + numbers


class MessageDecoder:
    """A decoder that extracts messages from received bytes."""

    def __init__(self) -> None:
        self._bytes = bytearray()

    def decode(self, data: bytes) -> Iterator[Message]:
        """Add received bytes, and yield every complete message.

        Raises DriverError for invalid data.
        """
        self._bytes += data
        while len(self._bytes) >= _LENGTHS.size:
            head, numbers = _LENGTHS.unpack_from(self._bytes)
            end = _LENGTHS.size + head + numbers
            if end > MAX_MESSAGE_BYTES or numbers % 8:
                raise DriverError(*_NO_MESSAGE, reason="no-message")
            if len(self._bytes) < end:
                return
            text = bytes(self._bytes[_LENGTHS.size : _LENGTHS.size + head])
            row = np.frombuffer(bytes(self._bytes[_LENGTHS.size + head : end]), dtype="<f8")
            del self._bytes[:end]
            yield Message(_head(text), row)


def _head(text: bytes) -> Mapping[str, object]:
    try:
        head = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise DriverError(*_NO_MESSAGE, reason="no-message") from error
    if not isinstance(head, dict):
        raise DriverError(*_NO_MESSAGE, reason="no-message")
    return head


def flatten_segments(segments: MotionSegments | None) -> FloatArray:
    """Return motion segments as a flat array: times, durations, positions, velocities, accelerations."""
    return NO_NUMBERS if segments is None else np.concatenate([part.ravel() for part in segments])


def parse_segments(numbers: FloatArray, axis_count: int) -> MotionSegments:
    """Return the motion segments in a flat array that ``flatten_segments`` has created.

    Raises DriverError for an invalid length or value.
    """
    width = 2 + 3 * axis_count
    count, left = divmod(len(numbers), width)
    if left or not count or not np.isfinite(numbers).all():
        raise DriverError(
            "setpoints were corrupted during the transfer to the driver host",
            "feeder-silent",
            reason="damaged",
        )
    cuts = np.cumsum([count, count, count * axis_count, count * axis_count])
    t, dt, p, v, a = np.split(numbers, cuts)
    return MotionSegments(
        t, dt, p.reshape(count, axis_count), v.reshape(count, axis_count), a.reshape(count, axis_count)
    )


def encode_cam(cam: Cam) -> Message:
    """Return the request to move the axes on a cam, which is a path over spindle revolutions."""
    path_numbers = flatten_segments(cam.segments)
    head = {"do": "mesh", "zero": cam.start_revolutions, "sign": cam.sign, "way": len(path_numbers)}
    return Message(head, np.concatenate([path_numbers, flatten_segments(cam.following_segments)]))


def number(head: Mapping[str, object], key: str) -> float:
    """Return the number with the name ``key`` in the header of a message.

    Raises DriverError if the number is missing or invalid.
    """
    value = head.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < _MAX_NUMBER:
        raise DriverError(
            "the driver host received an invalid number for {key}",
            "feeder-silent",
            reason="no-number",
            key=key,
        )
    return float(value)


def text(head: Mapping[str, object], key: str) -> str:
    """Return the string named ``key`` in a message header, or an empty string if it is missing."""
    value = head.get(key)
    return value if isinstance(value, str) else ""


def decode_cam(message: Message, axis_count: int) -> Cam:
    """Return the cam that a request contains.

    Raises DriverError if the cam is invalid.
    """
    split = int(number(message.header, "way"))
    path_numbers, then = message.numbers[:split], message.numbers[split:]
    return Cam(
        number(message.header, "zero"),
        number(message.header, "sign"),
        parse_segments(path_numbers, axis_count),
        parse_segments(then, axis_count) if len(then) else None,
    )


def parse_floats(values: object) -> tuple[float, ...]:
    """Return a JSON list of numbers as a tuple.

    Raises DriverError if the list is invalid.
    """
    if not isinstance(values, Sequence) or not all(isinstance(v, int | float) for v in values):
        raise DriverError(
            "the driver host returned values that are not numbers", "feeder-silent", reason="no-numbers"
        )
    return tuple(float(v) for v in values)


def parse_list(value: object) -> list[object]:
    """Return a JSON list, or an empty list for any other value."""
    return value if isinstance(value, list) else []


def read_fault(head: Mapping[str, object], key: str, default_code: FaultCode) -> Fault:
    """Return the fault in a message header with its code; its text is empty if there is no fault."""
    code = next((each for each in get_args(FaultCode) if each == head.get(f"{key}_code")), default_code)
    return Fault(text(head, key), code)


def make_fault_entries(key: str, fault: str, default_code: FaultCode) -> Mapping[str, str]:
    """Return the header entries that describe a fault and its code."""
    return {key: fault, f"{key}_code": get_fault_code(fault, default_code)}


def parse_texts(value: object) -> list[str]:
    """Return the strings of a JSON list, ignoring other values."""
    return [one for one in parse_list(value) if isinstance(one, str)]
