"""What a grblHAL look-alike is in: alarms, holds, spindle, outputs, and the lines that wait for it."""

from __future__ import annotations

import math

from core.ports import Clock
from drivers.lookalikes.grblhal_settings import Quirks, Registers
from drivers.lookalikes.grblhal_slides import PlannedBlock, Slides
from drivers.lookalikes.plant_config import SimSpindle
from drivers.lookalikes.spindle_motor import SpindleMotor

_BUFFER = 1023  # bytes for lines; one of the 1024 stays free
_CRITICAL = frozenset((1, 2, 10, 17))


class ControllerState:
    """``out`` is what waits for the host, ``rx`` what it has sent and nobody has read."""

    def __init__(self, clock: Clock, quirks: Quirks | None = None) -> None:
        self.clock = clock
        self.quirks = quirks or Quirks()
        self.registers = Registers(self.quirks)
        self.slides = Slides(self.registers, 100)
        self.spindle = SpindleMotor(SimSpindle())
        self.outputs: dict[str, bool] = {}
        self.pins = ""
        self.inputs: dict[int, bool] = {}
        self.read: int | None = None  # what the last M66 has found
        self.homed = 0  # bit by axis
        self.alarm = 11 if int(self.registers[22]) & 5 == 5 else 0
        self.blocking = False  # behind a critical alarm: nothing but a reset
        self.door = False
        self.overflowed = 0  # bytes that did not fit
        self.torn = 0  # how often moving slides have been stopped dead
        self.feed_percent, self.rapid_percent, self.spindle_percent = 100, 100, 100
        self.rpm = 0.0
        self.jogs = False
        self.hold = False
        self.paused = False  # spindle stopped in a hold
        self.rx = bytearray()
        self.out = bytearray()
        self.k = clock.now()
        self.cancels = False  # a jog
        self.index_since: float | None = None
        self.index_at = 0
        self.homing: tuple[float, int] | None = None  # until, axes

    @property
    def rx_free(self) -> int:
        """Bytes that still fit."""
        return _BUFFER - len(self.rx)

    @property
    def state(self) -> str:
        """What it is in."""
        if self.alarm:
            return f"Alarm:{self.alarm}"
        if self.homing is not None:
            return "Home"
        if self.door:
            return "Door:2" if self.slides.moving else "Door:1"
        if self.hold:
            return f"Hold:{int(self.slides.moving)}"
        if self.slides.queue:
            return "Jog" if self.jogs else "Run"
        return "Idle"

    def told_state(self, full: bool) -> str:
        """As a report tells it: the number of an alarm is a matter of $10."""
        numbered = full or int(self.registers[10]) & 0x400
        return self.state if numbered else self.state.replace(f"Alarm:{self.alarm}", "Alarm")

    @property
    def waits(self) -> bool:
        """Whether a thread waits for its index."""
        return self.index_since is not None

    @property
    def reads(self) -> bool:
        """Whether lines are read now."""
        held = (self.hold or self.door) and not self.alarm
        return not (self.waits or self.homing is not None or held)

    @property
    def commanded(self) -> float:
        """Signed rpm that the spindle is told, within its settings."""
        if not self.rpm or self.paused:
            return 0.0
        rpm = abs(self.rpm) * self.spindle_percent / 100.0
        return math.copysign(min(max(rpm, self.registers[31]), self.registers[30]), self.rpm)

    def raise_alarm(self, number: int) -> None:
        """Stops at once; the block stays in the planner."""
        self.alarm = number
        self.torn += self.slides.moving
        self.slides.v = 0.0
        self.index_since = None
        self.blocking = number in _CRITICAL
        if self.blocking:
            self.rx.clear()
        self.say(f"ALARM:{number}\r\n")

    def begin_homing(self, axes: int) -> None:
        """It takes half a second here."""
        self.homing = self.k + 0.5, axes

    def next_line(self) -> str | None:
        """The next whole line of the buffer."""
        if b"\n" not in self.rx:
            return None
        line, _, rest = bytes(self.rx).partition(b"\n")
        self.rx = bytearray(rest)
        return line.decode("ascii", "replace").strip()

    def queue(self, block: PlannedBlock) -> None:
        """Into the planner; nothing for a block without length."""
        if block.length > 0.0:
            self.slides.queue.append(block)
            self.jogs = block.jog

    def say(self, text: str) -> None:
        """Out."""
        self.out += text.encode("ascii")

    def answer(self, error: int = 0) -> None:
        """The answer for a line."""
        if not error and self.quirks.garble:
            self.out += self.quirks.garble.pop(0) + b"\r\n"
        else:
            self.say(f"error:{error}\r\n" if error else "ok\r\n")

    def turn(self, rpm: float) -> None:
        """Command the spindle."""
        self.rpm = rpm
        self.spindle.order(self.k, self.commanded)
