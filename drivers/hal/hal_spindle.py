"""Spindle on HAL: speed, index, orientation, and C on the spindle drive.

An angle is sent to the pins of LinuxCNC's component ``orient``. The HAL file alone defines how the spindle
turns there and when ``is_oriented`` turns on.

The drive changes to position mode at standstill. ``hal.spindle.position_mode`` requests C, and
``in_position_mode`` reports it if that pin is named. While C is released, its count does not change. While it
is engaged, it is one more axis, whose feedback is the spindle encoder with 360 per revolution.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import Enum

from core.ports import DriverError, Fault
from drivers.hal.hal_axes import HalAxes
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_link import HalLink
from drivers.port_parts import demand_free_drive, demand_spindle
from drivers.setpoint_queue import straight

_MODES = {0: 0, 1: 1, -1: 2}
_ANGLE_SETTLES = 0.05  # Seconds from the rise of ``orient`` until ``is_oriented`` refers to the new angle.
_STANDS = 2.0  # rpm


class HalOrientation:
    """``core.ports.SpindleOrientation`` on HAL; ``tick`` is called once per cycle."""

    def __init__(self, axes: HalAxes, spindle: HalSpindle, link: HalLink) -> None:
        self._axes, self._spindle, self._link = axes, spindle, link
        self._order: int | None = None
        self._since: float | None = None  # Time when HAL was first detected to orient.

    def orient(self, angle: float, sense: int = 0) -> None:
        """Turn the spindle to an angle. Raises DriverError while it turns, with a fault or an open chain."""
        self._spindle.demand_ready()
        if self._order is None and _is_turning(self._spindle):
            raise DriverError(
                "the spindle cannot be oriented while it is turning; stop it first", "spindle-off"
            )
        self._since = None
        self._order = self._link.say("orient", on=True, angle=angle, mode=_MODES[sense])

    def release(self) -> None:
        """Cancel the orientation."""
        self._order = self._since = None
        if not self._link.lost:
            self._link.say("orient", on=False)

    def oriented(self) -> bool:
        """Return whether HAL reports the angle that was commanded last as reached."""
        since = self._since
        if since is None or self._axes.now() < since + _ANGLE_SETTLES:
            return False
        return self._link.bit("spindle.is_oriented")

    def tick(self) -> None:
        """Detect when HAL starts to orient, and when the orientation has been canceled."""
        if self._order is None or not self._link.done(self._order):
            return
        goes = self._link.told.get("orients") is True
        if goes and self._since is None:
            self._since = self._axes.now()
        elif not goes and self._since is not None:
            self._order = self._since = None


# --- Spindle.


class HalSpindle:
    """``core.ports.Spindle`` on HAL; after an E-stop, it does not restart automatically."""

    def __init__(self, config: HalConfig, link: HalLink, axes: HalAxes) -> None:
        self._config = config.spindle
        self._link = link
        self._axes = axes
        self.ordered = 0.0  # rpm
        self.lent = False  # The drive is used as C, so its rotation is not the spindle speed.
        self.index = SpindleIndex(axes, link, wired=bool(config.spindle.pins.index_enable))
        self._unknown: tuple[float, float] | None = None  # Angle reported before the index is known.

    def tick(self) -> None:
        """Clear the command while the chain is open, and update the index."""
        if self._link.told.get("ok") is not True:
            self.ordered = 0.0
        self.index.look()

    def run(self, rpm: float) -> None:
        """Turn the spindle at ``rpm``, signed; 0 stops it.

        Raises DriverError with a fault or an open chain if the speed is not 0.
        """
        if rpm:
            self.demand_ready()
        limit = self._config.rpm_max
        self.ordered = min(max(rpm, -limit), limit)
        if not self._link.lost:
            self._link.say("spindle", rpm=self.ordered, on=bool(self.ordered))

    def demand_ready(self) -> None:
        """Raise DriverError with a fault or an open chain."""
        demand_spindle(self.fault() or self._axes.fault)
        if self._link.told.get("ok") is not True:
            raise DriverError(
                "the spindle stays off because the E-stop chain is open; press Reset", "spindle-off"
            )

    def coast(self) -> None:
        """Command speed 0 and switch off; the drive determines how the spindle stops."""
        self.run(0.0)

    def speed(self) -> float:
        """Return the measured speed in rpm, signed, or 0 while the drive is C.

        Without position or velocity feedback, it is the commanded speed as soon as the spindle is at speed.
        """
        return 0.0 if self.lent else self.measured()

    def measured(self) -> float:
        """Return the same speed, independent of the use as C."""
        pins = self._config.pins
        if pins.position or pins.velocity:
            return 60.0 * self._axes.rps
        return self.ordered if self._link.bit("spindle.at_speed") else 0.0

    def angle(self) -> tuple[float, float] | None:
        """Return a (time, revolutions) pair of the encoder, or None without an encoder.

        With an index, whole revolutions are at the index. Before the index is known, an old reading is
        returned, so that a thread waits for a new one.
        """
        if not self._config.encoder or self._axes.spindle_at is None:
            return None
        if not self.index.known:
            self._unknown = self._unknown or self._axes.spindle_at
            return self._unknown
        self._unknown = None
        t, turns = self._axes.spindle_at
        return t, turns - self._axes.index_at

    def fault(self) -> str:
        """Return the fault of the spindle, or an empty text."""
        if why := self._link.trouble:
            return why
        if self.index.trouble:
            return self.index.trouble
        wrong = self._link.bit("spindle.fault")
        return Fault("the spindle drive reports a fault", "spindle") if wrong else ""


def _is_turning(spindle: HalSpindle) -> bool:
    """Return whether the spindle is commanded to turn, or turns by its measured speed."""
    return bool(spindle.ordered) or abs(spindle.measured()) >= _STANDS


# --- Index: requested with the first revolution of a session, so that a thread can be resumed.


_PIN = "spindle-index"
_TURNING = 0.1  # turns/s
_TURNS = 3.0  # Revolutions within which the index must pass.
_SETTLES = 0.02  # Seconds until the compensated jump is also reported.


class SpindleIndex:
    """Index of the spindle; ``known`` becomes True when it has passed, or at once without an index."""

    def __init__(self, axes: HalAxes, link: HalLink, *, wired: bool) -> None:
        self._axes, self._link, self._wired = axes, link, wired
        self.forget()

    def forget(self) -> None:
        """Discard the index after HAL was loaded again."""
        self.known = not self._wired
        self.trouble: Fault | str = ""
        self._order: int | None = None
        self._from = 0.0  # Revolutions at the request.
        self._fell: float | None = None  # Time when the index was detected.
        self._axes.index_at = 0.0

    def clear(self) -> None:
        """Clear a fault, so that the index is requested again."""
        if self.trouble:
            self.forget()

    def look(self) -> None:
        """Request the index when the spindle turns, and evaluate it; called once per cycle."""
        reading = self._axes.spindle_at
        if self.known or self.trouble or self._link.blind or reading is None:
            return
        t, turns = reading
        if self._order is None:
            if abs(self._axes.rps) > _TURNING:
                self._from, self._order = turns, self._link.say("index", pin=_PIN, on=True)
        elif self._fell is None:
            self._wait(t, turns)
        elif t > self._fell + _SETTLES:
            self._axes.index_at = self._link.figure(f"{_PIN}-at")
            self.known = True

    def _wait(self, t: float, turns: float) -> None:
        if self._order is not None and self._link.done(self._order) and not self._link.bit(_PIN):
            self._fell = t
        elif abs(turns - self._from) > _TURNS:
            self.trouble = Fault(
                "no spindle index pulse was detected in {revolutions} revolutions; check phase Z of the "
                "spindle encoder, and check that hal.spindle.index_enable belongs to the same encoder",
                "spindle-encoder",
                revolutions=f"{_TURNS:g}",
            )


# --- C on the spindle drive.


_SEARCH = 60.0  # Rpm for the index search.
_INDEX, _CHANGE = 15.0, 2.0  # s
_TURN = 360.0
_SLOW = 0.25  # Fraction of C's speed for the move to its position.
_AFTER = 0.05  # Seconds after a motion until it counts as complete.


class Step(Enum):
    """Steps of the change between spindle and C."""

    FREE = "the drive is running as the spindle drive"
    INDEX = "searching for the encoder index"
    STOP = "the spindle stops after the index pulse"
    CHANGE = "changing the spindle drive to position mode"
    TURN = "turning the spindle to its C-axis position"
    HELD = "is C"


class HalSpindleC:
    """``core.ports.SpindleHold`` of the spindle drive; ``tick`` is called once per cycle."""

    def __init__(self, axes: HalAxes, spindle: HalSpindle, link: HalLink, axis: int, told: str) -> None:
        """Create the C axis.

        The last argument is the bridge bit that reports position mode, or an empty text without such a pin.
        """
        self._axes, self._spindle, self._link = axes, spindle, link
        self._axis, self._told = axis, told
        self.step = Step.FREE
        self._orient = False
        self._since = 0.0
        self._order = 0

    # --- the port -----------------------------------------------------------------------------------------

    def hold(self, on: bool, orient: bool = False) -> None:
        """Engage the drive as C, or release it. Raises DriverError if C cannot be engaged now."""
        if not on:
            self._let_go()
            return
        if self.step is not Step.FREE:
            return
        demand_free_drive(self._axes.sample().enabled, _is_turning(self._spindle))
        self._orient = orient
        if orient and not self._spindle.index.known:
            self._spindle.run(_SEARCH)
            self._enter(Step.INDEX)
        else:
            self._change()

    def held(self) -> bool:
        """Return whether C is engaged and may move."""
        return self.step is Step.HELD

    # --- each cycle ---------------------------------------------------------------------------------------

    def tick(self) -> None:
        """Continue the change that is in progress."""
        if self.step is Step.FREE:
            return
        if self._link.blind or not self._axes.sample().enabled:
            self._let_go()
            return
        acts: dict[Step, Callable[[], None]] = {
            Step.INDEX: self._search,
            Step.STOP: self._brake,
            Step.CHANGE: self._take,
            Step.TURN: self._arrive,
        }
        if self.step in acts:
            acts[self.step]()

    def _search(self) -> None:
        if self._spindle.index.known:
            self._spindle.run(0.0)
            self._enter(Step.STOP)
        elif self._late(_INDEX):
            self._fail("no spindle index pulse was detected")

    def _brake(self) -> None:
        if abs(self._spindle.measured()) < _STANDS:
            self._change()
        elif self._late(_INDEX):
            self._fail("the spindle does not stop")

    def _change(self) -> None:
        self._order = self._link.say("c", on=True)
        self._enter(Step.CHANGE)

    def _take(self) -> None:
        """Engage C when HAL plays its setpoint at the position of the spindle and the drive follows it."""
        told = self._link.told.get("c_at") if self._link.done(self._order) else None
        if isinstance(told, float | int) and (not self._told or self._link.bit(self._told)):
            self._hold_at(float(told))
        elif self._late(_CHANGE):
            self._fail("the signal hal.spindle.in_position_mode does not turn on")

    def _hold_at(self, raw: float) -> None:
        count = self._axes.sample().demand[self._axis]
        off = self._beside(count) if self._orient else 0.0
        self._axes.lend(None, raw, count - off)
        if abs(off) <= self._axes.config.axes[self._axis].count:
            self._enter(Step.HELD)
            return
        figures, now = self._axes.config.axes[self._axis], self._axes.now()
        place, _ = self._axes.demand_at(now)
        speed, begins = _SLOW * figures.vmax, now + self._axes.commit + 0.005
        self._axes.move(straight(begins, place, self._axis, to=count, speed=speed, accel=figures.amax))
        self._enter(Step.TURN)

    def _arrive(self) -> None:
        if self._axes.resting and self._axes.now() > self._since + _AFTER:
            self._enter(Step.HELD)

    def _beside(self, count: float) -> float:
        """Return the shortest angle in degrees to the position at which the index matches ``count``."""
        reading = self._spindle.angle()
        phase = _TURN * reading[1] if reading is not None else count
        return math.remainder(count - phase, _TURN)

    def _let_go(self) -> None:
        if self.step is Step.FREE:
            return
        if self.step in {Step.INDEX, Step.STOP} and not self._link.lost:
            self._spindle.run(0.0)
        self._axes.lend(self._axis)
        if not self._link.lost:
            self._link.say("c", on=False)
        self._enter(Step.FREE)

    def _fail(self, why: str) -> None:
        self._let_go()
        self._axes.fault = self._axes.fault or Fault("C: {why}", "c-coupling", why=why)

    def _late(self, longest: float) -> bool:
        return self._axes.now() > self._since + longest

    def _enter(self, step: Step) -> None:
        self.step, self._since = step, self._axes.now()
        self._spindle.lent = step is not Step.FREE
        self._axes.c_turns = step is Step.TURN
