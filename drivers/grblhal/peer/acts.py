"""What the look-alike's real-time bytes do, in whatever state it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from drivers.grblhal.peer.program import Modes

if TYPE_CHECKING:
    from drivers.grblhal.peer.firmware import Firmware

_STEPS = {0x91: 10, 0x92: -10, 0x93: 1, 0x94: -1}


def act(m: Firmware, byte: int) -> None:
    """At once."""
    if byte == 0x18:
        m.reset()
    elif byte == 0x19:
        _stop(m)
    elif m.waits:
        return  # flags are looked at when the wait is over; here they are gone
    elif byte in {0x80, 0x87}:
        m.say(m.reports.text(m, full=byte == 0x87) + "\r\n")
    elif byte == 0x82:
        m.hold = m.hold or not (m.alarm or m.jogs or m.quirks.hold_broken)
    elif byte == 0x81:
        _go_on(m)
    elif byte == 0x85:
        m.rx.clear()
        m.program.error = 0
        m.cancels = m.jogs and bool(m.slides.queue)
    elif 0x90 <= byte <= 0x9E:
        _override(m, byte)


def _stop(m: Firmware) -> None:
    """0x19 ends the steps where they are, and unlocks most alarms; in the wait for an index it is a reset."""
    if m.blocking:
        return
    if m.waits:
        m.restart(False)
        return
    m.torn += m.slides.moving
    m.halt()
    m.rx.clear()
    m.program.modes = Modes()
    if m.alarm not in {11, 12}:
        m.alarm = 0
        m.say("[MSG:Stop]\r\n")


def _go_on(m: Firmware) -> None:
    if m.slides.moving or m.alarm or not (m.hold or m.door):
        return
    m.hold = m.door = False
    if m.paused and not int(m.registers[63]) & 2:
        m.rpm = 0.0
    m.paused = False
    m.turn(m.rpm)


def _override(m: Firmware, byte: int) -> None:
    if m.quirks.stubborn:
        return
    m.reports.overrides_due = True
    if byte == 0x90:
        m.feed_percent = 100
    elif byte in _STEPS:
        m.feed_percent = min(max(m.feed_percent + _STEPS[byte], 10), 200)
    elif byte in {0x95, 0x96, 0x97}:
        m.rapid_percent = {0x95: 100, 0x96: 50, 0x97: 25}[byte]
    elif byte == 0x99:
        m.spindle_percent = 100
    elif byte - 9 in _STEPS:
        m.spindle_percent = min(max(m.spindle_percent + _STEPS[byte - 9], 10), 200)
    elif byte == 0x9E and m.hold and m.rpm and not m.quirks.toggle_broken:
        m.paused = not m.paused
    m.turn(m.rpm)
