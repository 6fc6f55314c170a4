"""The main spindle: what the program asks for, what the operator allows, what it really does.

Also where it will be: its angle in the next moments, from the last readings of the encoder.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from core.executor.raised_alarm import AlarmError
from core.executor.spindle_orientation import Orientation
from core.faults import code_of
from core.geometry.surface_speed import surface_rpm
from core.interpreter.shared.elementary_blocks import Block
from core.machine.machine_model import SpindleModel
from core.message import Message
from core.ports import Spindle, SpindleHold, SpindleOrientation

# --- the angle of the spindle ---------------------------------------------------------------------------


_WINDOW = 0.2  # s of readings that count; longer is quieter, shorter follows a changing speed better
_DEGREE = 3
_CURVED = 0.06  # s beyond the last reading for which a change of speed is taken to go on
_LEAST_READINGS = 8  # readings


class SpindleAngle:
    """A cubic through the encoder's readings of the last moments; revolutions, signed, and seconds.

    A reading every 10 ms in 4096 steps a turn tells the angle 45 ms ahead within .25 degree, and with a speed
    that swings by 2 % in two seconds within .2 degree.
    """

    def __init__(self) -> None:
        self._reads: deque[tuple[float, float]] = deque()
        self._fit: tuple[list[float], float] | None = None

    def note(self, read: tuple[float, float] | None) -> None:
        """A reading (time, revolutions), None from a spindle without encoder."""
        if read is None:
            self._reads.clear()
        elif not self._reads or read[0] > self._reads[-1][0]:
            self._reads.append(read)
            while self._reads[0][0] < read[0] - _WINDOW:
                self._reads.popleft()
        else:
            return
        self._fit = None

    @property
    def turns(self) -> float:
        """Revolutions by the last reading; no number without one."""
        return self._reads[-1][1] if self._reads else math.nan

    @property
    def known(self) -> bool:
        """Whether enough was read of late: not right after the control was away, never without encoder."""
        return len(self._reads) >= _LEAST_READINGS

    def at(self, t: float) -> tuple[float, float] | None:
        """(revolutions, revolutions per second) at ``t``; None as long as too little has been read."""
        if not self.known:
            return None
        if self._fit is None:
            self._fit = self._fitted()
        shape, base = self._fit
        u = t - self._reads[-1][0]
        near = min(u, _CURVED)
        turns = speed = 0.0
        for factor in reversed(shape):
            turns, speed = turns * near + factor, speed * near + turns
        return base + turns + speed * (u - near), speed

    def turning_at(self, t: float) -> tuple[float, float]:
        """The same of a spindle that turns. Raises AlarmError for one that stands or is not measured."""
        state = self.at(t)
        if state is None:
            raise AlarmError("thread-no-encoder", "the spindle encoder does not count")
        if state[1] == 0.0:
            raise AlarmError("thread-no-encoder", "the spindle does not turn")
        return state

    def _fitted(self) -> tuple[list[float], float]:
        """Factors of the cubic from the last reading on, and that reading."""
        last, base = self._reads[-1]
        times, turns = zip(*self._reads, strict=True)
        return _least_squares([t - last for t in times], [each - base for each in turns], _DEGREE), base


def _least_squares(u: list[float], y: list[float], degree: int) -> list[float]:
    """Factors of the polynomial nearest to ``y`` at ``u``, the constant first.

    By polynomials orthogonal on these places (Forsythe 1957), each from the two before it: for a score of
    readings a tenth of what a solver of matrices takes, and readings close together harm it no more.
    """
    shape = [0.0] * (degree + 1)
    factors, factors_before = [1.0], [0.0]
    values, values_before = [1.0] * len(u), [0.0] * len(u)
    norm_before = math.inf
    for _ in shape:
        norm = sum([v * v for v in values])
        part = sum([v * each for v, each in zip(values, y, strict=True)]) / norm
        for k, factor in enumerate(factors):
            shape[k] += part * factor
        mean = sum([x * v * v for x, v in zip(u, values, strict=True)]) / norm
        ratio, norm_before = norm / norm_before, norm
        each = zip(u, values, values_before, strict=True)
        values, values_before = [(x - mean) * v - ratio * before for x, v, before in each], values
        shifted = zip([0.0, *factors], [*factors, 0.0], [*factors_before, 0.0], strict=True)
        factors, factors_before = [up - mean * f - ratio * b for up, f, b in shifted], [*factors, 0.0]
    return shape


_GRACE = 1.0  # s in which a drive must have begun to obey another speed,
_REACTS = 0.5  # of which its own delay takes at most so much; the rest is for an ordinary wire
_OVER = 0.1  # fraction and
_OVER_RPM = 50.0  # rpm above what ought to be
_STOOD = 0.2  # s of standing still although it was told to turn: it has stopped, and
_GONE = 2.0  # s after which its command is withdrawn; until then its drive can still tell why


class SpindleDemand(NamedTuple):
    """Signed rpm of M03 and M04, or a surface speed in mm/s with the clamps of G76 and G77 in force."""

    rpm: float
    surface: float | None = None
    lowest: float = 0.0
    highest: float | None = None

    @classmethod
    def of(cls, block: Block) -> SpindleDemand:
        """What is in force in a block."""
        return cls(block.rpm, block.css, block.modal.css_min, block.modal.css_max)


class SpindleControl:
    """Turns the program's word into a command, every tick, and watches the drive obey it.

    Nothing in here starts a spindle but ``ask`` and ``permit``: after ``stop`` it stays still until the
    program asks again. One that was asked for and stands, because of the switch, the pot or by itself, waits:
    it keeps what it was asked, its command is withdrawn, and it starts when it is permitted to.
    """

    def __init__(
        self,
        port: Spindle,
        model: SpindleModel,
        lock: SpindleHold | None = None,
        lay_out: Callable[[float], None] = lambda _: None,
        orientation: SpindleOrientation | None = None,
        lag: Callable[[], float] = float,
    ) -> None:
        """``lay_out`` hears before each speed up to how many rpm the radius may take it; ``lag`` returns the
        seconds by which the wire delays a command and the speed that shows it.
        """
        self._port = port
        self._lay_out, self._lag = lay_out, lag
        self._lock = lock
        self.orientation = Orientation(orientation, model.orient_rpm)
        self._model = model
        self.limit: float | None = None  # F10, until restart
        self.command = 0.0  # signed rpm as sent
        self.measured = 0.0
        self.known = True  # else ``measured`` is the last that was heard of it
        self.angle = SpindleAngle()
        self.override = 1.0
        self.auto = True
        self.guard_open = False  # at a machine whose guard stops the spindle
        self.waits = ""  # why it stands although it is asked to turn: it starts when it is permitted to
        self._ask: SpindleDemand | None = None
        self._turned = False  # it has turned since its command was given
        self._stands: float | None = None  # since when it stands, commanded and after it has turned
        self._withdrawn = False  # what waits has no command any more
        self._again = False  # the command is sent although it is the same: a driver may have dropped it
        self._coasting = False
        self._in_band_since: float | None = None
        self._fell: tuple[float, float] = (0.0, 0.0)  # when, and from what speed, the command fell
        self._rose: tuple[float, float] = (0.0, 0.0)  # the same of a rise

    @property
    def highest(self) -> float:
        """The highest speed allowed now, rpm."""
        return min(self._model.rpm_max, self.limit or self._model.rpm_max)

    @property
    def asked(self) -> bool:
        """Whether the program wants it to turn."""
        return self._ask is not None

    @property
    def asked_rpm(self) -> float:
        """Signed speed that is wanted of it; under G96 at the tool's present radius, with its clamps."""
        ask = self._ask
        if ask is None:
            return 0.0
        return math.copysign(self._rpm_of(ask, self._model.rpm_max), ask.rpm)

    @property
    def stopped(self) -> bool:
        """Whether it stands still, measured; of one that nobody hears nobody knows that."""
        return self.known and abs(self.measured) < self._model.stop_below

    @property
    def stands_or_orients(self) -> bool:
        """Whether it stands, or its drive turns it to an angle and nothing else does."""
        return self.known and (self.stopped or self.orientation.turns_at > 0.0)

    @property
    def lost(self) -> bool:
        """Less than half of what an obedient drive turns by now, or the other way: feeding must stop."""
        along = math.copysign(1.0, self.command) * self.measured
        return self.command == 0.0 or along < 0.5 * min(abs(self.command), self._owed(self._now))

    @property
    def fails(self) -> bool:
        """It is asked to turn, and is slower by half than a drive that obeys: nothing may be cut."""
        return self._ask is not None and self.lost

    @property
    def why_slow(self) -> str:
        """What keeps it from turning, when that is the operator."""
        if self._ask is None:
            return "SPINDLE STOPPED"
        return self.start_barred or self.waits

    @property
    def start_barred(self) -> str:
        """What keeps it from being started at all, at the station."""
        if self.guard_open:
            return "GUARD OPEN"
        if not self.auto:
            return "SPINDLE SWITCH OFF"
        return "SPINDLE OVERRIDE AT 0" if self.override <= 0.0 else ""

    @property
    def would_turn(self) -> float:
        """Signed rpm with which it starts when it is permitted to; 0 where it does not wait for that.

        The switch is not asked here: it may be what permits.
        """
        return self._obeying() if self.waits else 0.0

    def permit(self) -> None:
        """Both palms, or the switch by hand: what waits may turn again."""
        if self._ask is not None and not self.start_barred:
            self._forget_waiting()
            self._again, self._in_band_since = True, None

    def dropped(self, why: str) -> None:
        """What is between control and drive has stopped it: it waits, and has no command any more."""
        if self._ask is not None:
            self.waits, self._withdrawn = why, True

    def ask(self, ask: SpindleDemand) -> None:
        """M03, M04, S."""
        self._let_go()
        self._ask = ask
        self._forget_waiting()
        self._in_band_since = None

    def follow(self, block: Block) -> None:
        """The block being played may say G96 or G97: that changes the speed, it never starts a spindle."""
        if self._ask is not None and block.rpm != 0.0:
            self._ask = SpindleDemand.of(block)

    def stop(self) -> None:
        """M05, and every stop of the control: the word is forgotten."""
        self._ask = None
        self._forget_waiting()
        self._let_go()
        self._send(0.0, self._now)

    def safe_steps(self, *, coast: bool) -> list[tuple[str, Callable[[], None]]]:
        """What a safe stop does about it, each to be done whatever the others raise: the word is forgotten, C
        is let go, the drive is told to stop, also one that is believed to have been told.
        """
        self._ask, self._in_band_since = None, None
        self._forget_waiting()
        if coast:
            self._coasting = True
        return [
            ("C", self._free_c),
            ("the spindle orientation", self.orientation.let_go),
            ("the spindle", partial(self._tell_off, coast=coast)),
        ]

    def _tell_off(self, *, coast: bool) -> None:
        if coast:
            self.command = 0.0
            self._port.coast()
        else:
            if self.command != 0.0:  # told again, it has no more time to obey
                self._note_fall(0.0, self._now)
            self.command = 0.0
            self._port.run(0.0)

    def hold(self, *, orient: bool) -> bool:
        """M19 and M89: as C; True once it is. Raises DriverError."""
        if self._lock is None:
            return True
        if not self._lock.held():
            self._lock.hold(True, orient)
        return self._lock.held()

    def orient(self, angle: float, sense: int) -> bool:
        """M19 and SPOS of a drive that orients: True once it is held there. What keeps the spindle from being
        started keeps it from turning to an angle. Raises AlarmError, DriverError.
        """
        if self.start_barred and self.orientation.at is None:
            self.orientation.let_go()
            return False
        return self.orientation.bring(angle, sense)

    def break_off(self) -> None:
        """Feed hold: a change-over or a way to an angle that is under way ends; what waits asks again."""
        if not self.held:
            self._free_c()
        if self.orientation.at is None:
            self.orientation.let_go()

    @property
    def held(self) -> bool:
        """Whether C may move, as far as the spindle's drive decides that."""
        return self._lock is None or self._lock.held()

    def _let_go(self) -> None:
        self.orientation.let_go()
        self._free_c()

    def _free_c(self) -> None:
        if self._lock is not None:
            self._lock.hold(False)

    def look(self) -> None:
        """First thing in a tick: read the encoder."""
        self.angle.note(self._port.angle())

    def update(self, now: float, radius: float) -> None:
        """Once a tick: send what has changed, and see what the drive does.

        ``radius`` (mm) of the tool decides under constant surface speed. Raises AlarmError
        when the drive has tripped or does not obey.
        """
        self._now = now
        measured = self._port.speed()
        if not math.isfinite(measured):  # the last speed stays: what is not known does not stand
            raise AlarmError("spindle-encoder", "the spindle drive reports a speed that is not a number")
        self.measured = measured
        self._radius = radius
        self._watch_standing(now)
        self._send(self._wanted(), now)
        self._watch_band(now)
        fault = self._port.fault()
        if fault:
            self._coasting = True
            raise AlarmError(code_of(fault, "spindle"), fault)
        self._coasting = self._coasting and not self.stopped and self.command == 0.0
        self.orientation.look()
        if not self._coasting and abs(self.measured) > self._allowed(now):
            turns = Message(
                "the spindle turns at {measured} rpm; the commanded speed is {command} rpm",
                measured=f"{self.measured:.0f}",
                command=f"{self.command:.0f}",
            )
            raise AlarmError("ignores-stop", turns)

    def at_speed(self, now: float) -> bool:
        """Within its band for long enough, and turning at all when it ought to."""
        if self._ask is None:
            return True
        if self.command == 0.0 or self._in_band_since is None:
            return False
        return now - self._in_band_since >= self._model.at_speed_time - 1e-9

    def _wanted(self) -> float:
        return 0.0 if self._withdrawn or not self.auto else self._obeying()

    def _obeying(self) -> float:
        ask = self._ask
        if ask is None:
            return 0.0
        rpm = min(self._rpm_of(ask, self.highest), self.highest) * self.override
        if 0.0 < rpm < self._model.rpm_min:
            rpm = self._model.rpm_min
        return rpm if ask.rpm >= 0.0 else -rpm

    def _rpm_of(self, ask: SpindleDemand, highest: float) -> float:
        """Unsigned; ``highest`` as G77 knows it."""
        if ask.surface is None:
            return abs(ask.rpm)
        return surface_rpm(ask.surface, self._radius, ask.lowest, min(ask.highest or highest, highest))

    def _send(self, rpm: float, now: float) -> None:
        same = abs(rpm - self.command) <= 0.002 * abs(rpm) and (rpm == 0.0) == (self.command == 0.0)
        if same and not self._again:
            return
        self._again = False
        self._note_fall(rpm, now)
        if abs(rpm - self.command) > self._model.at_speed * abs(rpm):
            self._in_band_since = None
        if rpm * self.command <= 0.0:
            self._turned, self._stands = False, None
        self.command = rpm
        self._lay_out(self._highest_by_radius())
        self._port.run(rpm)

    def _highest_by_radius(self) -> float:
        """rpm; 0 without a surface speed."""
        ask = self._ask
        if ask is None or ask.surface is None:
            return 0.0
        return min(min(ask.highest or self.highest, self.highest) * self.override, self._model.rpm_max)

    def _note_fall(self, rpm: float, now: float) -> None:
        """From where another speed begins; measured, since it may still coast from an E-stop."""
        fastest = max(abs(self.measured), abs(self.command))
        if abs(rpm) < fastest or rpm * self.command < 0.0 or rpm * self.measured < 0.0:
            self._fell = (now, fastest)
        elif abs(rpm) > abs(self.command) <= self._owed(now):  # else it is still on its way up
            self._rose = (now, min(abs(self.measured), abs(self.command)))

    def _watch_standing(self, now: float) -> None:
        """A spindle that stands although it is asked to turn must not start when its cause goes away."""
        if self._ask is None:
            return
        if self.start_barred:
            self.dropped(self.start_barred)
        elif not self.stopped or abs(self.command) < 2.0 * self._model.stop_below:
            self._turned, self._stands = self._turned or not self.stopped, None
        elif self._turned:
            self._stands = now if self._stands is None else self._stands
            if now - self._stands >= _STOOD:
                self.waits = self.waits or "SPINDLE STOPPED UNEXPECTEDLY"
            self._withdrawn = self._withdrawn or now - self._stands >= _GONE

    def _forget_waiting(self) -> None:
        self.waits, self._withdrawn, self._turned, self._stands = "", False, False, None

    def _watch_band(self, now: float) -> None:
        if abs(self.measured - self.command) > self._model.at_speed * abs(self.command):
            self._in_band_since = None
        elif self._in_band_since is None:
            self._in_band_since = now

    def _owed(self, now: float) -> float:
        """Speed that an obeying drive has at least after the command rose, rpm."""
        since, speed = self._rose
        return speed + self._model.accel * max(now - since - self._grace, 0.0)

    def _allowed(self, now: float) -> float:
        """Highest speed that an obeying drive can still have after the command fell."""
        since, speed = self._fell
        ramp = speed - self._model.decel * max(now - since - self._grace, 0.0)
        return max(abs(self.command), ramp, self.orientation.turns_at) * (1.0 + _OVER) + _OVER_RPM

    @property
    def _grace(self) -> float:
        """Seconds after a command in which the measured speed need not show it."""
        return max(_GRACE, self._lag() + _REACTS)

    _now = 0.0
    _radius = 0.0
