"""Load of the CAN bus: bits that go over the wire between two SYNCs, and whether they have room there.

A frame of 11-bit identifier and n bytes is at most 47 + 8 n + (34 + 8 n - 1) / 4 bits long: with all that
stuffing can add, and the three bits to the next frame.
"""

from __future__ import annotations

from typing import NamedTuple

_COMMAND, _ANSWER, _MORE = 7, 7, 8  # bytes: of RPDO1, TPDO1, and of PDOs that are seldom sent
_MOST = 0.75  # of the time; the rest is for SDO, heartbeats, emergencies, and a frame that is under way


class Load(NamedTuple):
    """Bits from SYNC to SYNC that are sent each time, and those that are sent seldom, in the mean."""

    each: float
    seldom: float
    room: float  # bits that fit between two SYNCs

    @property
    def share(self) -> float:
        """Of the bus."""
        return (self.each + self.seldom) / self.room

    @property
    def fits(self) -> bool:
        """With what has to stay free."""
        return self.share <= _MOST


def frame_bits(size: int) -> int:
    """The longest that a frame with ``size`` bytes can be."""
    return 47 + 8 * size + (34 + 8 * size - 1) // 4


def cyclic_load(slides: int, others: int, bitrate: int, sync: float, seldom: int) -> Load:
    """``slides`` are told and answer at each SYNC; ``others`` and second answers come every ``seldom``."""
    told = frame_bits(_COMMAND) + frame_bits(_ANSWER)
    each = frame_bits(0) + slides * told
    rare = slides * frame_bits(_MORE) + others * 2 * frame_bits(_MORE)
    return Load(each, rare / seldom, bitrate * sync)
