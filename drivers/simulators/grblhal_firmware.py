"""Simulated grblHAL controller: buffers, real-time bytes, states, alarms, resets and status reports."""

from __future__ import annotations

import math
from dataclasses import dataclass

from core.ports import Clock
from drivers.simulators.grblhal_program import Modes, Program
from drivers.simulators.grblhal_settings import Quirks, Registers
from drivers.simulators.grblhal_slides import PlannedBlock, Slides
from drivers.simulators.plant_config import SimSpindle
from drivers.simulators.spindle_motor import SpindleMotor, TurnedSpindle

# --- Effects of the real-time bytes in all states.


_STEPS = {0x91: 10, 0x92: -10, 0x93: 1, 0x94: -1}


def act(m: Firmware, byte: int) -> None:
    """Execute a real-time byte immediately."""
    if byte == 0x18:
        m.reset()
    elif byte == 0x19:
        _stop(m)
    elif m.waits:
        return  # The firmware reads its flags after the wait; here they are discarded.
    elif byte in {0x80, 0x87}:
        m.say(m.reports.text(m, full=byte == 0x87) + "\r\n")
    elif byte == 0x83:
        m.say(m.program.told() + "\r\n")
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
    """Stop without deceleration and clear most alarms; while a thread waits for its index, reset instead."""
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
    elif byte == 0x9E and m.hold and m.rpm and not (m.quirks.toggle_broken or m.program.wait):
        m.paused = not m.paused
    m.turn(m.rpm)


# --- One step of the machine: homing, the wait for an index, motion and stops.


STEP = 0.001  # s
_INDEX = 5.0  # Seconds that a thread waits for the index.


def step(m: Firmware) -> None:
    """Advance the controller by ``STEP``."""
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


def _wants_index(m: Firmware, block: PlannedBlock) -> bool:
    """Return whether a thread still waits for its start, which is at the second index after the request.

    No byte is processed during the wait. A missing index raises alarm 14 after 5 s.
    """
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


# --- Status reports and their contents.


_OFFSETS_BUSY, _OFFSETS_IDLE = 30, 10  # Intervals in reports.
_OVERRIDES_BUSY, _OVERRIDES_IDLE = 20, 10
_BUSY = frozenset(("Run", "Hold", "Jog", "Home", "Door"))


@dataclass(slots=True)
class Reports:
    """Generator of status reports that decides when offsets and overrides are included.

    Both are included at intervals and after a change. If both are due, the offsets wait for the next report.
    A full report has both. Firmware of 2023 delayed the overrides and never put them into a full report.
    """

    offsets_in: int = 0
    overrides_in: int = 0
    offsets_due: bool = False
    overrides_due: bool = False
    accessories_due: bool = False

    def text(self, m: Firmware, *, full: bool) -> str:
        """Return one report without its line end."""
        busy = m.state.partition(":")[0] in _BUSY
        overrides = self._overrides(full, busy)
        offsets = self._offsets(full, overrides, busy)
        text = f"<{m.told_state(full)}{_motion(m)}{_extras(m, offsets, overrides, full)}>"
        self.accessories_due = False
        return text

    def _overrides(self, full: bool, busy: bool) -> bool:
        told = full or self.overrides_due or self.overrides_in == 0
        self.overrides_in = (
            (_OVERRIDES_BUSY if busy else _OVERRIDES_IDLE) - 1 if told else self.overrides_in - 1
        )
        self.overrides_due = False
        return told

    def _offsets(self, full: bool, overrides: bool, busy: bool) -> bool:
        wanted = full or self.offsets_due or self.offsets_in == 0
        self.offsets_in = (_OFFSETS_BUSY if busy else _OFFSETS_IDLE) - 1 if wanted else self.offsets_in - 1
        self.offsets_due = wanted and overrides and not full
        return wanted and not self.offsets_due


def _stepped(place: float, steps: float) -> float:
    """Round a position to whole steps."""
    return round(place * steps) / steps


def _motion(m: Firmware) -> str:
    scale = 2.0 if m.program.modes.radius == "G7" else 1.0
    x, z = (
        _stepped(place, m.registers[number]) for place, number in zip(m.slides.place, (100, 102), strict=True)
    )
    text = f"|MPos:{x * scale:.3f},0.000,{z:.3f}|Bf:{m.slides.free},{m.rx_free}"
    if m.slides.queue and m.slides.queue[0].number:
        text += f"|Ln:{m.slides.queue[0].number}"
    text += f"|FS:{60.0 * m.slides.v:.0f},{abs(m.commanded):.0f}"
    if m.quirks.encoder:
        text += f",{abs(m.spindle.speed):.0f}"
    return text + (f"|Pn:{m.pins}" if m.pins else "")


def _extras(m: Firmware, offsets: bool, overrides: bool, full: bool) -> str:
    text = "|WCO:" + ",".join(f"{value:.3f}" for value in m.program.offset) if offsets else ""
    text += "|WCS:G54" if full else ""
    text += f"|Ov:{m.feed_percent},{m.rapid_percent},{m.spindle_percent}" if overrides else ""
    accessories = "" if not m.commanded else "S" if m.commanded > 0.0 else "C"
    accessories += "F" * m.outputs.get("flood", False) + "M" * m.outputs.get("mist", False)
    told = full or m.reports.accessories_due or (overrides and accessories)
    text += f"|A:{accessories}" if told else ""
    if not full:
        return text
    homed = f"|H:{int(m.homed & 5 == 5)}" + (f",{m.homed}" if int(m.registers[22]) & 2 else "")
    read = "" if m.read is None else f"|In:{m.read}"
    lathe = f"|D:{int(m.program.modes.radius == 'G7')}" if m.registers.lathe else ""
    return f"{text}|Sc:|MPG:0{homed}{lathe}|T:0|P:0|TLR:0{read}|FW:grblHAL"


_STEP = 0.001  # s
_BUFFER = 1023  # Bytes for lines; one of the 1024 stays free.
_CRITICAL = frozenset((1, 2, 10, 17))
_BANNER = "\r\nGrblHAL 1.1f ['$' or '$HELP' for help]\r\n"
_GATE = 100  # With this many free bytes or fewer, the simulator reads nothing from its socket.


class Firmware:
    """Simulated controller: ``feed`` takes received bytes, ``take`` returns bytes for the host.

    ``out`` buffers bytes for the host. ``rx`` buffers received bytes that are not yet interpreted.
    """

    def __init__(self, clock: Clock, quirks: Quirks | None = None) -> None:
        self.clock = clock
        self.quirks = quirks or Quirks()
        self.registers = Registers(self.quirks)
        self.slides = Slides(self.registers, 100)
        self.spindle: TurnedSpindle = SpindleMotor(SimSpindle())
        self.outputs: dict[str, bool] = {}
        self.pins = ""
        self.inputs: dict[int, bool] = {}
        self.read: int | None = None  # Result of the last M66.
        self.homed = 0  # One bit per axis.
        self.alarm = 11 if int(self.registers[22]) & 5 == 5 else 0
        self.blocking = False  # After a critical alarm, only a reset is accepted.
        self.door = False
        self.overflowed = 0  # Number of bytes lost because the buffer was full.
        self.torn = 0  # Number of stops without deceleration.
        self.feed_percent, self.rapid_percent, self.spindle_percent = 100, 100, 100
        self.rpm = 0.0
        self.jogs = False
        self.hold = False
        self.paused = False  # The spindle is stopped during a feed hold.
        self.rx = bytearray()
        self.out = bytearray()
        self.k = clock.now()
        self.cancels = False  # A jog is being canceled.
        self.index_since: float | None = None
        self.index_at = 0
        self.homing: tuple[float, int] | None = None  # End time and axes.
        self.reports = Reports()
        self.program = Program(self)
        self._wire = bytearray()  # Bytes not yet read from the socket.
        self._next_byte = 0.0

    # --- the wire -----------------------------------------------------------------------------------------

    def feed(self, data: bytes) -> None:
        """Receive bytes from the host; real-time bytes take effect immediately, others are buffered."""
        self.advance()
        self._wire += data
        self._take_in()
        self.program.pump()

    def take(self) -> bytes:
        """Return the buffered bytes for the host."""
        self.advance()
        data, self.out = bytes(self.out), bytearray()
        return b"" if self.quirks.deaf else data

    def advance(self) -> None:
        """Advance the controller to the present time of the clock."""
        now, idle = self.clock.now(), self._idle
        while self.k + _STEP <= now + 1e-9:
            self.k += _STEP
            if idle:
                continue
            self.spindle.advance(self.k)
            step(self)
            self._take_in()
            self.program.pump()
        if idle:
            self.spindle.advance(self.k)

    def reset(self) -> None:
        """Perform the reset 0x18: modes are lost, and also the position if an axis moves."""
        if "E" in self.pins:
            return
        moved = self.slides.moving or self.homing is not None or self.index_since is not None
        self.restart(moved)

    def power_cycle(self) -> None:
        """Switch the power off and on: the position becomes 0 and homing is lost."""
        self.alarm, self.homed = 0, 0
        self.door = self.blocking = False
        self.slides.place = (0.0, 0.0)
        self.restart(False)
        self.alarm = 11 if int(self.registers[22]) & 5 == 5 else 0

    # --- inside -------------------------------------------------------------------------------------------

    @property
    def _idle(self) -> bool:
        """Whether only the spindle changes until the host sends something."""
        busy = self.slides.queue or self.homing is not None or not self.program.reads_on
        return not (busy or self.rx or self._wire)

    def _take_in(self) -> None:
        while self._wire and self.rx_free > _GATE and not (self.waits and self.quirks.mute):
            if self.k < self._next_byte:
                return
            self._next_byte = self.k + self.quirks.drip if self.quirks.drip else 0.0
            byte = self._wire.pop(0)
            if byte >= 0x80 or byte in {0x18, 0x19}:
                act(self, byte)
            else:
                self.rx.append(byte)

    def restart(self, moved: bool) -> None:
        """Restart the controller; with ``moved``, the position is lost and alarm 3 is raised."""
        self.torn += self.slides.moving
        self.halt()
        self.blocking = False
        self.program.modes = Modes()
        self.rx.clear()
        self.feed_percent = self.rapid_percent = self.spindle_percent = 100
        self.reports = Reports()
        if moved:
            self.alarm, self.homed = 3, 0
            self.say("ALARM:3\r\n")
        self.say(_BANNER)
        if self.alarm:
            self.say("[MSG:'$H'|'$X' to unlock]\r\n")

    def halt(self) -> None:
        """Stop motion, spindle, coolant and program immediately."""
        self.slides.drop()
        self.program.drop()
        self.hold = self.cancels = self.jogs = self.slides.held = self.paused = False
        self.index_since = self.homing = None
        self.turn(0.0)
        self.outputs.update(flood=False, mist=False)

    # --- state: alarms, holds, spindle and pending lines ------------------------------------------------

    @property
    def rx_free(self) -> int:
        """The free bytes of the receive buffer."""
        return _BUFFER - len(self.rx)

    @property
    def state(self) -> str:
        """The state as in a status report."""
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
        """Return the state as it is reported; ``$10`` decides whether an alarm has its number."""
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
        """The commanded spindle speed in rpm, signed, after override and limits."""
        if not self.rpm or self.paused:
            return 0.0
        rpm = abs(self.rpm) * self.spindle_percent / 100.0
        return math.copysign(min(max(rpm, self.registers[31]), self.registers[30]), self.rpm)

    def raise_alarm(self, number: int) -> None:
        """Stop immediately and raise an alarm; the present block stays in the planner."""
        self.alarm = number
        self.torn += self.slides.moving
        self.slides.v = 0.0
        self.index_since = None
        self.blocking = number in _CRITICAL
        if self.blocking:
            self.rx.clear()
        self.say(f"ALARM:{number}\r\n")

    def begin_homing(self, axes: int) -> None:
        """Start homing of the axes in a bit mask, which takes 0.5 s in the simulator."""
        self.homing = self.k + 0.5, axes

    def next_line(self) -> str | None:
        """Return the next complete line of the buffer, or None."""
        if b"\n" not in self.rx:
            return None
        line, _, rest = bytes(self.rx).partition(b"\n")
        self.rx = bytearray(rest)
        return line.decode("ascii", "replace").strip()

    def queue(self, block: PlannedBlock) -> None:
        """Append a block to the planner; a block without length is ignored."""
        if block.length > 0.0:
            self.slides.queue.append(block)
            self.jogs = block.jog

    def say(self, text: str) -> None:
        """Send text to the host."""
        self.out += text.encode("ascii")

    def answer(self, error: int = 0) -> None:
        """Acknowledge a line with ``ok`` or an error code."""
        if not error and self.quirks.garble:
            self.out += self.quirks.garble.pop(0) + b"\r\n"
        else:
            self.say(f"error:{error}\r\n" if error else "ok\r\n")

    def turn(self, rpm: float) -> None:
        """Command the spindle speed in rpm, signed."""
        self.reports.accessories_due = self.reports.accessories_due or (rpm > 0.0) - (rpm < 0.0) != (
            self.rpm > 0.0
        ) - (self.rpm < 0.0)
        self.rpm = rpm
        self.spindle.order(self.k, self.commanded)
