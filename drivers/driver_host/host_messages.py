"""Messages of the driver host, and the values in them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, get_args

import numpy as np

from core.faults import get_fault_code
from core.ports import Cam, DriverError, Fault, FaultCode, FloatArray, MotionSegments
from drivers import process_messages
from drivers.process_messages import ReceivedMessage, text

_MAX_NUMBER = 1e300  # Larger numbers and NaN are invalid.
PROTOCOL_VERSION = 5  # Version of the protocol, which both sides exchange first.


class Message(NamedTuple):
    """Request or reply: a header of named values, and a flat array of numbers."""

    header: Mapping[str, object]
    numbers: FloatArray


NO_NUMBERS: FloatArray = np.empty(0)


def encode_message(message: Message) -> bytes:
    """Return a message encoded as bytes."""
    return process_messages.encode_message(
        message.header, np.ascontiguousarray(message.numbers, dtype="<f8").tobytes()
    )


def convert_messages(received: Iterable[ReceivedMessage]) -> Iterator[Message]:
    """Yield the received messages.

    Raises DriverError for invalid data.
    """
    try:
        for head, numbers in received:
            yield Message(head, np.frombuffer(numbers))
    except ValueError as error:
        words = "the driver host's socket received an invalid message"
        raise DriverError(words, "feeder-silent", reason="no-message") from error


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
    """Return the fault in a message header with its code.

    The fault's text is empty if there is no fault.
    """
    code = next((each for each in get_args(FaultCode) if each == head.get(f"{key}_code")), default_code)
    return Fault(text(head, key), code)


def make_fault_entries(key: str, fault: str, default_code: FaultCode) -> Mapping[str, str]:
    """Return the header entries that describe a fault and its code."""
    return {key: fault, f"{key}_code": get_fault_code(fault, default_code)}


def parse_strings(value: object) -> list[str]:
    """Return the strings of a JSON list, ignoring other values."""
    return [one for one in parse_list(value) if isinstance(one, str)]
