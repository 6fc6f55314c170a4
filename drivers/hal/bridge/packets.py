"""Packets between the driver and its bridge, and the configuration of the bridge."""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from drivers.process_messages import MessageHead, encode_message
from drivers.setpoint_pieces import MotionPiece

MAX_PACKET_NUMBERS = 8000  # Maximum number of doubles in a packet, limited by the packet socket.

PacketHead = MessageHead


def pack_packet(head: Mapping[str, object], numbers: Iterable[float] = ()) -> bytes:
    """Return a packet encoded as bytes."""
    return encode_message(head, array("d", numbers).tobytes())


def flatten_pieces(pieces: Iterable[MotionPiece]) -> Iterable[float]:
    """Yield the times, positions, velocities and accelerations of all motion pieces as one sequence."""
    for piece in pieces:
        yield from (
            piece.start_time_s,
            piece.duration_s,
            *piece.positions,
            *piece.velocities,
            *piece.accelerations,
        )


def parse_pieces(numbers: Sequence[float], axis_count: int) -> list[MotionPiece]:
    """Return the motion pieces from a sequence of numbers that ``flatten_pieces`` has created."""
    width = 2 + 3 * axis_count
    made = []
    for at in range(0, len(numbers), width):
        row = tuple(numbers[at : at + width])
        p, v, a = row[2 : 2 + axis_count], row[2 + axis_count : 2 + 2 * axis_count], row[2 + 2 * axis_count :]
        made.append(MotionPiece(row[0], row[1], p, v, a))
    return made


def build_piece_packets(
    head: Mapping[str, object], pieces: Sequence[MotionPiece], axis_count: int
) -> Iterable[bytes]:
    """Yield the packets that transfer any number of motion pieces.

    The header of every packet except the last contains ``more``.
    """
    most = MAX_PACKET_NUMBERS // (2 + 3 * axis_count)
    for first in range(0, len(pieces), most):
        part = pieces[first : first + most]
        more = {"more": True} if first + most < len(pieces) else {}
        yield pack_packet({**head, **more}, flatten_pieces(part))


def number(head: Mapping[str, object], key: str, default: float = 0.0) -> float:
    """Return a number from the head of a packet, or ``default`` if it is missing or too large."""
    value = head.get(key)
    try:
        return float(value) if isinstance(value, int | float) else default
    except OverflowError:  # a whole number beyond the range of a double
        return default


@dataclass(frozen=True, slots=True)
class BridgeAxis:
    """Axis of the bridge, with its deceleration and the limit and duration for a following error."""

    name: str
    amax: float
    window: float
    time: float
    is_spindle: bool = False  # Follows setpoints only while the spindle drive is C.


@dataclass(frozen=True, slots=True)
class BridgeConfig:
    """The configuration of the bridge.

    ``outputs`` contains the safe states, where None leaves an output unchanged. ``turns`` and ``speed`` are
    True if the samples contain these values after the axes. ``bits`` are pins that are reported unchanged.
    """

    axes: tuple[BridgeAxis, ...]
    period: float
    ahead: float
    outputs: Mapping[str, bool | None] = field(default_factory=dict)
    lamps: tuple[str, ...] = ()  # Outputs that indicate an open chain.
    inputs: tuple[str, ...] = ()
    analog: tuple[str, ...] = ()
    bits: tuple[str, ...] = ()
    spindle: tuple[str, ...] = ()  # Written pins.
    turns: bool = False
    speed: bool = False
    marks: int = 0  # Bits at the end of each sample: home switches and the probe.
    figures: tuple[str, ...] = ()  # Pins with numbers.
