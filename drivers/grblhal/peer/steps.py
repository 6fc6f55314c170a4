"""One step of the look-alike's machine: homing, the wait for an index, slides that move and stop."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from drivers.grblhal.peer.slides import PeerBlock

if TYPE_CHECKING:
    from drivers.grblhal.peer.firmware import Firmware

STEP = 0.001  # s
_INDEX = 5.0  # s that a thread waits for the index


def step(m: Firmware) -> None:
    """Let ``STEP`` pass."""
    if m.homing is not None:
        _home(m, *m.homing)
        return
    if m.alarm:
        return
    slides = m.slides
    slides.feed, slides.rapid = m.feed_percent / 100.0, m.rapid_percent / 100.0
    first = slides.queue[0] if slides.queue else None
    resting = (m.hold or m.door) and not slides.moving
    if first is not None and not resting and _wants_index(m, first):
        return
    if first is not None and first.per_rev and not first.thread and abs(m.spindle.speed) < 1.0:
        m.raise_alarm(14)
        return
    slides.held = m.hold or m.door or m.cancels
    slides.step(STEP, abs(m.spindle.speed) / 60.0)
    if m.cancels and not slides.moving:
        m.cancels = False
        slides.drop()
        m.program.end = slides.place
    if not slides.queue:
        m.jogs = False


def _home(m: Firmware, until: float, axes: int) -> None:
    if m.k >= until:
        m.homing, m.homed = None, m.homed | axes
        m.alarm = 11 if int(m.registers[22]) & 4 and m.homed & 5 != 5 else 0
        m.say("[MSG:]\r\n")
        m.answer()


def _wants_index(m: Firmware, block: PeerBlock) -> bool:
    """A thread begins at the second index from now; until then nothing is heard and nothing is said."""
    if not block.thread or m.slides.begun:
        return False
    if m.index_since is None:
        m.index_since, m.index_at = m.k, math.floor(abs(m.spindle.turns)) + 2
    if not m.quirks.index_missing and abs(m.spindle.turns) >= m.index_at:
        m.index_since = None
        return False
    if m.k - m.index_since > _INDEX:
        m.raise_alarm(14)
    return True
