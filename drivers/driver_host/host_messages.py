"""One message on the socket: two lengths, a JSON head, and numbers as they lie in memory."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple, get_args

import numpy as np

from core.faults import code_of
from core.ports import Cam, DriverError, Fault, FaultCode, FloatArray, Segments

_LENGTHS = struct.Struct("<II")  # of the head, of the numbers, in bytes
LARGEST = 64_000_000  # bytes; more is no message
_HUGE = 1e300  # a number beyond is none, and NaN neither
_NO_MESSAGE: tuple[str, FaultCode] = "the driver host's socket received an invalid message", "feeder-silent"
VERSION = 5  # of what is asked and answered; both sides say it in their first words


class Message(NamedTuple):
    """What is asked or answered, and the numbers that belong to it, one flat row."""

    head: Mapping[str, object]
    numbers: FloatArray


NOTHING: FloatArray = np.empty(0)


def packed(message: Message) -> bytes:
    """The bytes of one message."""
    head = json.dumps(message.head).encode()
    numbers = np.ascontiguousarray(message.numbers, dtype="<f8").tobytes()
    return _LENGTHS.pack(len(head), len(numbers)) + head + numbers


class Inbox:
    """Bytes in, whole messages out."""

    def __init__(self) -> None:
        self._bytes = bytearray()

    def feed(self, data: bytes) -> Iterator[Message]:
        """Every message that is whole now. Raises DriverError for what is none."""
        self._bytes += data
        while len(self._bytes) >= _LENGTHS.size:
            head, numbers = _LENGTHS.unpack_from(self._bytes)
            end = _LENGTHS.size + head + numbers
            if end > LARGEST or numbers % 8:
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


def rows(segments: Segments | None) -> FloatArray:
    """Segments in one row: t, dt, p, v, a."""
    return NOTHING if segments is None else np.concatenate([part.ravel() for part in segments])


def segments(numbers: FloatArray, axes: int) -> Segments:
    """The segments of one row. Raises DriverError for a row of another length."""
    width = 2 + 3 * axes
    count, left = divmod(len(numbers), width)
    if left or not count or not np.isfinite(numbers).all():
        raise DriverError(
            "setpoints were corrupted during the transfer to the driver host",
            "feeder-silent",
            reason="damaged",
        )
    cuts = np.cumsum([count, count, count * axes, count * axes])
    t, dt, p, v, a = np.split(numbers, cuts)
    return Segments(t, dt, p.reshape(count, axes), v.reshape(count, axes), a.reshape(count, axes))


def cam_message(cam: Cam) -> Message:
    """A request to follow the spindle."""
    way = rows(cam.way)
    head = {"do": "mesh", "zero": cam.zero, "sign": cam.sign, "way": len(way)}
    return Message(head, np.concatenate([way, rows(cam.then)]))


def number(head: Mapping[str, object], key: str) -> float:
    """A finite number of the head. Raises DriverError where there is none."""
    value = head.get(key)
    if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < _HUGE:
        raise DriverError(
            "the driver host received an invalid number for {key}",
            "feeder-silent",
            reason="no-number",
            key=key,
        )
    return float(value)


def text(head: Mapping[str, object], key: str) -> str:
    """A text of the head; empty where there is none."""
    value = head.get(key)
    return value if isinstance(value, str) else ""


def cam_of(message: Message, axes: int) -> Cam:
    """The cam of a request. Raises DriverError."""
    split = int(number(message.head, "way"))
    way, then = message.numbers[:split], message.numbers[split:]
    return Cam(
        number(message.head, "zero"),
        number(message.head, "sign"),
        segments(way, axes),
        segments(then, axes) if len(then) else None,
    )


def floats(values: object) -> tuple[float, ...]:
    """A list of numbers as it comes out of JSON. Raises DriverError."""
    if not isinstance(values, Sequence) or not all(isinstance(v, int | float) for v in values):
        raise DriverError(
            "the driver host returned values that are not numbers", "feeder-silent", reason="no-numbers"
        )
    return tuple(float(v) for v in values)


def items(value: object) -> list[object]:
    """A list as it comes out of JSON; an empty one for anything else."""
    return value if isinstance(value, list) else []


def fault_of(head: Mapping[str, object], key: str, otherwise: FaultCode) -> Fault:
    """A fault of the head, its code beside it; empty where there is none."""
    code = next((each for each in get_args(FaultCode) if each == head.get(f"{key}_code")), otherwise)
    return Fault(text(head, key), code)


def with_code(key: str, fault: str, otherwise: FaultCode) -> Mapping[str, str]:
    """A fault as it goes into a head."""
    return {key: fault, f"{key}_code": code_of(fault, otherwise)}


def texts(value: object) -> list[str]:
    """The texts of a list."""
    return [one for one in items(value) if isinstance(one, str)]
