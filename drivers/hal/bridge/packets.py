"""Packets between the driver and its bridge, and what the bridge has to know of the machine.

A packet is the length of a JSON head, the head, and doubles.
"""

from __future__ import annotations

import json
import struct
from array import array
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from drivers.setpoint_pieces import Piece

_LENGTH = struct.Struct("<I")
MOST = 8000  # doubles that one packet carries: a socket of packets takes no longer ones

Head = dict[str, object]


def pack(head: Mapping[str, object], numbers: Iterable[float] = ()) -> bytes:
    """The bytes of one packet."""
    text = json.dumps(head, separators=(",", ":")).encode()
    return _LENGTH.pack(len(text)) + text + array("d", numbers).tobytes()


def unpack(data: bytes) -> tuple[Head, Sequence[float]]:
    """Head and numbers. Raises ValueError or struct.error for what is none."""
    (length,) = _LENGTH.unpack_from(data)
    head: Head = json.loads(data[_LENGTH.size : _LENGTH.size + length])
    numbers = array("d")
    numbers.frombytes(data[_LENGTH.size + length :])
    return head, numbers


def flat(pieces: Iterable[Piece]) -> Iterable[float]:
    """Pieces one behind the other."""
    for piece in pieces:
        yield from (piece.t, piece.dt, *piece.p, *piece.v, *piece.a)


def pieces_of(numbers: Sequence[float], axes: int) -> list[Piece]:
    """The pieces of such a row."""
    width = 2 + 3 * axes
    made = []
    for at in range(0, len(numbers), width):
        row = tuple(numbers[at : at + width])
        p, v, a = row[2 : 2 + axes], row[2 + axes : 2 + 2 * axes], row[2 + 2 * axes :]
        made.append(Piece(row[0], row[1], p, v, a))
    return made


def packets_of(head: Mapping[str, object], pieces: Sequence[Piece], axes: int) -> Iterable[bytes]:
    """Pieces in as many packets as they need; the last has no ``more``."""
    most = MOST // (2 + 3 * axes)
    for first in range(0, len(pieces), most):
        part = pieces[first : first + most]
        more = {"more": True} if first + most < len(pieces) else {}
        yield pack({**head, **more}, flat(part))


def number(head: Mapping[str, object], key: str, otherwise: float = 0.0) -> float:
    """A number of a head."""
    value = head.get(key)
    return float(value) if isinstance(value, int | float) else otherwise


def text(head: Mapping[str, object], key: str) -> str:
    """A text of a head."""
    value = head.get(key)
    return value if isinstance(value, str) else ""


@dataclass(frozen=True, slots=True)
class BridgeAxis:
    """One axis: what it brakes with, and how far it may be off its setpoint for how long."""

    name: str
    amax: float
    window: float
    time: float
    is_spindle: bool = False  # it follows only while the spindle's drive is C


@dataclass(frozen=True, slots=True)
class BridgeConfig:
    """What the bridge has to know of the machine. ``outputs``: their safe states, None keeps.

    ``turns`` and ``speed``: the samples have them, behind the axes. ``bits``: pins that are told as they are.
    """

    axes: tuple[BridgeAxis, ...]
    period: float
    ahead: float
    outputs: Mapping[str, bool | None] = field(default_factory=dict)
    lamps: tuple[str, ...] = ()  # of the outputs: they tell of an open chain
    inputs: tuple[str, ...] = ()
    analog: tuple[str, ...] = ()
    bits: tuple[str, ...] = ()
    spindle: tuple[str, ...] = ()  # pins that are written
    turns: bool = False
    speed: bool = False
    marks: int = 0  # bits at the end of each sample: switches for homing, the probe
    figures: tuple[str, ...] = ()  # pins with numbers
