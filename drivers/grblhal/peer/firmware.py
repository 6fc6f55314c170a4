"""The look-alike's wire side: buffers, real-time bytes, reports, alarms, resets that lose modes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from core.ports import Clock
from drivers.grblhal.peer.program import Modes, Program
from drivers.grblhal.peer.slides import PeerBlock, Slides
from drivers.simulated.config import SimSpindle
from drivers.simulated.drive_spindle import SpindleMotor

_STEP = 0.001  # s
_BANNER = "\r\nGrblHAL 1.1f ['$' or '$HELP' for help]\r\n"
_INDEX = 5.0  # s that a thread waits for the index, answering nothing


@dataclass(slots=True)
class Quirks:
    """What the real one does, or is made to do by a bad cable; each can be switched."""

    encoder: bool = True
    diameter: bool = False  # comes up in G7, as $N0=G7 would make it
    index_missing: bool = False
    outputs: int = 16
    inputs: int = 8
    lathe: bool = True
    homing: bool = False
    deaf: bool = False  # answers nothing
    garble: list[bytes] = field(default_factory=list)  # instead of the next ``ok``s
    stop_broken: bool = False  # 0x19 does nothing


class Firmware:
    """Bytes in by ``feed``, bytes out by ``take``; ``advance`` brings it up to the clock."""

    def __init__(self, clock: Clock, quirks: Quirks | None = None, accel: float = 3000.0) -> None:
        self.clock = clock
        self.quirks = quirks or Quirks()
        self.slides = Slides(accel, 100)
        self.spindle = SpindleMotor(SimSpindle())
        self.program = Program(self)
        self.outputs: dict[str, bool] = {}
        self.pins = ""
        self.inputs: dict[int, bool] = {}
        self.read: int | None = None  # what the last M66 has found
        self.alarm = 11 if self.quirks.homing else 0
        self.homed = not self.quirks.homing
        self.overflowed = 0  # bytes that did not fit
        self.feed_percent, self.rapid_percent, self.spindle_percent = 100, 100, 100
        self.rpm = 0.0
        self._rx = bytearray()
        self._out = bytearray()
        self._k = clock.now()
        self._hold = False
        self._stop = False
        self.jogs = False
        self._index_since: float | None = None
        self._homing_until: float | None = None

    # --- the wire -----------------------------------------------------------------------------------------

    def feed(self, data: bytes) -> None:
        """Bytes from the host: real-time ones act at once, others wait their turn."""
        self.advance()
        for byte in data:
            if byte >= 0x80 or byte in {0x18, 0x19}:
                self._realtime(byte)
            elif len(self._rx) < 1024:
                self._rx.append(byte)
            else:
                self.overflowed += 1
        self.program.pump()

    def take(self) -> bytes:
        """Bytes for the host."""
        self.advance()
        data, self._out = bytes(self._out), bytearray()
        return b"" if self.quirks.deaf else data

    def advance(self) -> None:
        """Up to the clock."""
        now = self.clock.now()
        while self._k + _STEP <= now + 1e-9:
            self._k += _STEP
            self.spindle.advance(self._k)
            self._turn()
            self.program.pump()

    @property
    def state(self) -> str:
        """As the report says it."""
        if self.alarm:
            return f"Alarm:{self.alarm}"
        if self._homing_until is not None:
            return "Home"
        if self._hold:
            return f"Hold:{int(self.slides.moving)}"
        if self.slides.queue:
            return "Jog" if self.jogs else "Run"
        return "Idle"

    def reset(self, *, by_host: bool = True) -> None:
        """0x18, or its power: modes are lost, a moving slide's position too."""
        moved = self.slides.moving or self._homing_until is not None
        self._halt()
        self.program.modes = Modes()
        self._rx.clear()
        if not by_host:
            moved = False
        self.alarm = 3 if moved else 11 if self.alarm == 11 else 0
        self.say(_BANNER)
        if moved:
            self.say("ALARM:3\r\n")

    def raise_alarm(self, number: int) -> None:
        """Stops at once; the block stays in the planner."""
        self.alarm = number
        self.slides.v = 0.0
        self.say(f"ALARM:{number}\r\n")

    # --- for the program ----------------------------------------------------------------------------------

    @property
    def homing(self) -> bool:
        """Whether it looks for its switches: no line is carried out."""
        return self._homing_until is not None

    def begin_homing(self) -> None:
        """It takes half a second here."""
        self._homing_until = self._k + 0.5

    def next_line(self) -> str | None:
        """The next whole line of the buffer."""
        if b"\n" not in self._rx:
            return None
        line, _, rest = bytes(self._rx).partition(b"\n")
        self._rx = bytearray(rest)
        return line.decode("ascii", "replace").strip()

    def queue(self, block: PeerBlock) -> None:
        """Into the planner."""
        if block.length > 0.0:
            self.slides.queue.append(block)
            self.jogs = block.jog

    # --- inside -------------------------------------------------------------------------------------------

    def say(self, text: str) -> None:
        self._out += text.encode("ascii")

    def answer(self, error: int = 0) -> None:
        if not error and self.quirks.garble:
            self._out += self.quirks.garble.pop(0) + b"\r\n"
        else:
            self.say(f"error:{error}\r\n" if error else "ok\r\n")

    def _halt(self) -> None:
        self.slides.drop()
        self.program.drop()
        self._hold = self._stop = self.jogs = self.slides.held = False
        self._index_since = self._homing_until = None
        self.turn(0.0)
        self.outputs.update(flood=False, mist=False)
        self.feed_percent = self.rapid_percent = self.spindle_percent = 100

    def turn(self, rpm: float) -> None:
        self.rpm = rpm
        self.spindle.order(self._k, rpm * self.spindle_percent / 100.0)

    def _turn(self) -> None:
        """One step of the machine."""
        slides = self.slides
        if self._homing_until is not None:
            if self._k >= self._homing_until:
                self._homing_until, self.alarm, self.homed = None, 0, True
                self.answer()
            return
        if self.alarm:
            return
        slides.feed, slides.rapid = self.feed_percent / 100.0, self.rapid_percent / 100.0
        first = slides.queue[0] if slides.queue else None
        if first is not None and self._wants_index(first):
            return
        if first is not None and first.per_rev and not first.thread and abs(self.spindle.speed) < 1.0:
            self.raise_alarm(14)
            return
        slides.held = (self._hold or self._stop) and not (first is not None and first.thread)
        slides.step(_STEP, abs(self.spindle.speed) / 60.0)
        if self._stop and not slides.moving:
            self._halt()
            self.program.modes = Modes(radius=self.program.modes.radius)
            self.say("[MSG:Stop]\r\n")
        if not slides.queue:
            self.jogs = False

    def _wants_index(self, block: PeerBlock) -> bool:
        """A thread begins at the second index from now; without one an alarm comes, and no answer before."""
        if not block.thread or self.slides.v > 0.0:
            return False
        if self._index_since is None:
            self._index_since, self._index_at = self._k, math.floor(abs(self.spindle.turns)) + 2
        seen = not self.quirks.index_missing and abs(self.spindle.turns) >= self._index_at
        if seen:
            self._index_since = None
            return False
        if self._k - self._index_since > _INDEX:
            self._index_since = None
            self.raise_alarm(14)
        return True

    def _realtime(self, byte: int) -> None:
        if byte in {0x80, 0x87}:
            if self._index_since is None:
                self._report(full=byte == 0x87)
        elif byte == 0x18:
            self.reset()
        elif byte == 0x19 and not self.quirks.stop_broken:
            self._rx.clear()
            self.program.drop()
            self._stop = not self.alarm
        elif byte == 0x82:
            self._hold = not self.alarm
        elif byte == 0x81:
            self._hold = self._hold and self.slides.moving
        elif byte == 0x85:
            self._rx.clear()
            self._stop = self.jogs
        elif 0x90 <= byte <= 0x9E:
            self._override(byte)

    def _override(self, byte: int) -> None:
        tens = {0x91: 10, 0x92: -10, 0x93: 1, 0x94: -1}
        if byte == 0x90:
            self.feed_percent = 100
        elif byte in tens:
            self.feed_percent = min(max(self.feed_percent + tens[byte], 10), 200)
        elif byte in {0x95, 0x96, 0x97}:
            self.rapid_percent = {0x95: 100, 0x96: 50, 0x97: 25}[byte]
        elif byte == 0x99:
            self.spindle_percent = 100
        elif byte - 9 in tens:
            self.spindle_percent = min(max(self.spindle_percent + tens[byte - 9], 10), 200)
        self.turn(self.rpm)

    def _report(self, *, full: bool) -> None:
        scale = 2.0 if self.program.modes.radius == "G7" else 1.0
        x, z = self.slides.place
        text = (
            f"<{self.state}|MPos:{x * scale:.3f},0.000,{z:.3f}|Bf:{self.slides.free},{1024 - len(self._rx)}"
        )
        if self.slides.queue and self.slides.queue[0].number:
            text += f"|Ln:{self.slides.queue[0].number}"
        text += f"|FS:{60.0 * self.slides.v:.0f},{abs(self.rpm) * self.spindle_percent / 100.0:.0f}"
        if self.quirks.encoder:
            text += f",{abs(self.spindle.speed):.0f}"
        text += f"|Pn:{self.pins}" if self.pins else ""
        if full:
            text += (
                f"|WCO:0.000,0.000,0.000|Ov:{self.feed_percent},{self.rapid_percent},{self.spindle_percent}"
            )
            text += "" if self.read is None else f"|In:{self.read}"
            text += f"|D:{int(self.program.modes.radius == 'G7')}|H:{int(self.homed)}|T:0|FW:grblHAL"
        self.say(text + ">\r\n")
