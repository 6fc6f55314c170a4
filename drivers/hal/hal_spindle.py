"""Spindle on HAL: speed, index, orientation, and C axis on the spindle drive.

For orientation, the angle is sent to the pins of LinuxCNC's component ``orient``. The HAL file defines how
the spindle turns to this angle and when ``is_oriented`` turns on.

For C, the drive changes to position mode at standstill. ``hal.spindle.position_mode`` requests this mode.
``in_position_mode`` confirms it, if the machine file names this pin. While C is released, its count does
not change. While C is engaged, it is an additional axis with the spindle encoder as feedback (360 degrees
per revolution).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import Enum

from core.ports import DriverError, Fault
from drivers.hal.hal_axes import HalAxes
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_link import HalLink
from drivers.port_checks import require_free_spindle_drive, require_spindle_ready, require_stopped_spindle
from drivers.setpoint_queue import plan_axis_move

_MODES = {0: 0, 1: 1, -1: 2}
_ANGLE_SETTLING_S = (
    0.05  # Seconds from the rise of the pin ``orient`` until ``is_oriented`` refers to the new angle.
)
_STANDSTILL_RPM = 2.0  # rpm


class HalOrientingSpindle:
    """Port that orients the spindle on HAL (``core.ports.OrientingSpindle``).

    ``update`` is called once per cycle.
    """

    def __init__(self, axes: HalAxes, spindle: HalSpindle, link: HalLink) -> None:
        self._axes, self._spindle, self._link = axes, spindle, link
        self._order: int | None = None
        self._since: float | None = None  # Time when HAL was first detected to orient.

    def orient_spindle(self, angle: float, direction: int = 0) -> None:
        """Orient the spindle to an angle in degrees.

        Raises DriverError if a fault is active or the E-stop chain is open. Also raises DriverError while
        the spindle turns, unless it is already being oriented.
        """
        self._spindle.require_spindle_ready()
        require_stopped_spindle(self._order is None and _is_turning(self._spindle))
        self._since = None
        self._order = self._link.send_command("orient", on=True, angle=angle, mode=_MODES[direction])

    def release_spindle(self) -> None:
        """Cancel the orientation of the spindle."""
        self._order = self._since = None
        if not self._link.failure:
            self._link.send_command("orient", on=False)

    def is_oriented(self) -> bool:
        """Return whether HAL reports that the spindle has reached the last commanded angle."""
        since = self._since
        if since is None or self._axes.now() < since + _ANGLE_SETTLING_S:
            return False
        return self._link.read_bit_pin("spindle.is_oriented")

    def update_orientation(self) -> None:
        """Detect when HAL starts to orient the spindle, and when the orientation has been canceled."""
        if self._order is None or not self._link.is_command_executed(self._order):
            return
        goes = self._link.last_report.get("orients") is True
        if goes and self._since is None:
            self._since = self._axes.now()
        elif not goes and self._since is not None:
            self._order = self._since = None


# --- Spindle.


class HalSpindle:
    """Spindle port on HAL (``core.ports.Spindle``).

    After an E-stop, the spindle does not restart automatically.
    """

    def __init__(self, config: HalConfig, link: HalLink, axes: HalAxes) -> None:
        self._config = config.spindle
        self._link = link
        self._axes = axes
        self.commanded_rpm = 0.0  # rpm
        self.is_used_as_c = False  # The drive is used as C, so its rotation is not the spindle speed.
        self.spindle_index = SpindleIndex(axes, link, wired=bool(config.spindle.pins.index_enable))
        self._unknown: tuple[float, float] | None = None  # Angle reported before the index is known.

    def update_spindle(self) -> None:
        """Cancel the commanded speed if the E-stop chain is open, and update the index."""
        if self._link.last_report.get("ok") is not True:
            self.commanded_rpm = 0.0
        self.spindle_index.update_index()

    def set_speed(self, rpm: float) -> None:
        """Run the spindle at the signed speed ``rpm``; 0 stops it.

        A speed other than 0 raises DriverError if a fault is active or the chain is open.
        """
        if rpm:
            self.require_spindle_ready()
        limit = self._config.max_rpm
        self.commanded_rpm = min(max(rpm, -limit), limit)
        if not self._link.failure:
            self._link.send_command("spindle", rpm=self.commanded_rpm, on=bool(self.commanded_rpm))

    def require_spindle_ready(self) -> None:
        """Raise DriverError if the spindle has a fault or the E-stop chain is open."""
        require_spindle_ready(self.read_fault() or self._axes.fault)
        if self._link.last_report.get("ok") is not True:
            raise DriverError(
                "the spindle stays off because the E-stop chain is open; press Reset", "spindle-off"
            )

    def start_coasting(self) -> None:
        """Command speed 0 and switch off the spindle.

        The drive determines how the spindle stops.
        """
        self.set_speed(0.0)

    def speed(self) -> float:
        """Return the measured speed in rpm, with its sign, or 0 while the drive is used as C.

        Without position or velocity feedback, the result is the commanded speed as soon as the spindle is
        at speed.
        """
        return 0.0 if self.is_used_as_c else self.get_encoder_rpm()

    def get_encoder_rpm(self) -> float:
        """Return the measured speed in rpm, with its sign, even while the drive is used as C."""
        pins = self._config.pins
        if pins.position or pins.velocity:
            return 60.0 * self._axes.spindle_rev_per_s
        return self.commanded_rpm if self._link.read_bit_pin("spindle.at_speed") else 0.0

    def read_angle(self) -> tuple[float, float] | None:
        """Return the time and the revolutions of the spindle encoder, or None without an encoder.

        With an index, the number of revolutions is whole at the index. Before the index is known, an old
        reading is returned, so that a threading pass waits for a new reading.
        """
        if not self._config.has_encoder or self._axes.spindle_sample is None:
            return None
        if not self.spindle_index.is_known:
            self._unknown = self._unknown or self._axes.spindle_sample
            return self._unknown
        self._unknown = None
        t, turns = self._axes.spindle_sample
        return t, turns - self._axes.index_rev

    def read_fault(self) -> str:
        """Return the fault of the spindle, or an empty string if there is no fault."""
        if why := self._link.failure_reason:
            return why
        if self.spindle_index.failure:
            return self.spindle_index.failure
        wrong = self._link.read_bit_pin("spindle.fault")
        return Fault("the spindle drive reports a fault", "spindle") if wrong else ""


def _is_turning(spindle: HalSpindle) -> bool:
    """Return whether the spindle is commanded to turn, or turns according to its measured speed."""
    return bool(spindle.commanded_rpm) or abs(spindle.get_encoder_rpm()) >= _STANDSTILL_RPM


# --- Index: requested with the first revolution of a session, so that a thread can be resumed.


_PIN = "spindle-index"
_TURNING = 0.1  # turns/s
_TURNS = 3.0  # Revolutions within which the index must pass.
_SETTLING_TIME_S = 0.02  # Seconds until the compensated jump is also reported.


class SpindleIndex:
    """Index of the spindle encoder.

    ``is_known`` becomes True when the index has passed, or immediately if the encoder has no index.
    """

    def __init__(self, axes: HalAxes, link: HalLink, *, wired: bool) -> None:
        self._axes, self._link, self._wired = axes, link, wired
        self.discard_index()

    def discard_index(self) -> None:
        """Discard the index position, because HAL has been loaded again."""
        self.is_known = not self._wired
        self.failure: Fault | str = ""
        self._order: int | None = None
        self._from = 0.0  # Revolutions at the request.
        self._fell: float | None = None  # Time when the index was detected.
        self._axes.index_rev = 0.0

    def clear_fault(self) -> None:
        """Clear a fault, so that the index is requested again."""
        if self.failure:
            self.discard_index()

    def update_index(self) -> None:
        """Request the index when the spindle turns, and evaluate its position.

        This method is called once per cycle.
        """
        reading = self._axes.spindle_sample
        if self.is_known or self.failure or self._link.is_state_unknown or reading is None:
            return
        t, turns = reading
        if self._order is None:
            if abs(self._axes.spindle_rev_per_s) > _TURNING:
                self._from, self._order = turns, self._link.send_command("index", pin=_PIN, on=True)
        elif self._fell is None:
            self._wait(t, turns)
        elif t > self._fell + _SETTLING_TIME_S:
            self._axes.index_rev = self._link.read_number_pin(f"{_PIN}-at")
            self.is_known = True

    def _wait(self, t: float, turns: float) -> None:
        if (
            self._order is not None
            and self._link.is_command_executed(self._order)
            and not self._link.read_bit_pin(_PIN)
        ):
            self._fell = t
        elif abs(turns - self._from) > _TURNS:
            self.failure = Fault(
                "no spindle index pulse was detected in {revolutions} revolutions; check phase Z of the "
                "spindle encoder, and check that hal.spindle.index_enable belongs to the same encoder",
                "spindle-encoder",
                revolutions=f"{_TURNS:g}",
            )


# --- C on the spindle drive.


_SEARCH = 60.0  # Rpm for the index search.
_INDEX, _CHANGE = 15.0, 2.0  # s
_DEGREES_PER_REV = 360.0
_SLOW = 0.25  # Fraction of C's speed for the move to its position.
_STOP_TIME_S = 0.05  # Seconds after a motion until it counts as complete.


class HalCAxisChangeStep(Enum):
    """Step of the change between spindle mode and C axis mode."""

    SPINDLE_MODE = "the drive is running as the spindle drive"
    FIND_INDEX = "searching for the encoder index"
    STOP = "the spindle stops after the index pulse"
    CHANGE_MODE = "changing the spindle drive to position mode"
    TURN_TO_POSITION = "turning the spindle to its C-axis position"
    ENGAGED = "is C"


class HalSpindleCAxis:
    """Port that runs the spindle drive as the C axis (``core.ports.SpindleCAxis``).

    ``update`` is called once per cycle.
    """

    def __init__(
        self, axes: HalAxes, spindle: HalSpindle, link: HalLink, axis: int, position_mode_pin: str
    ) -> None:
        """Create the C axis.

        ``position_mode_pin`` is the bridge bit that reports position mode, or an empty string without such
        a pin.
        """
        self._axes, self._spindle, self._link = axes, spindle, link
        self._axis, self._told = axis, position_mode_pin
        self.step = HalCAxisChangeStep.SPINDLE_MODE
        self._orient = False
        self._since = 0.0
        self._order = 0

    # --- the port -----------------------------------------------------------------------------------------

    def set_c_mode(self, is_enabled: bool, should_orient: bool = False) -> None:
        """Engage the spindle drive as C, or release it.

        Raises DriverError if C cannot be engaged now.
        """
        if not is_enabled:
            self._let_go()
            return
        if self.step is not HalCAxisChangeStep.SPINDLE_MODE:
            return
        require_free_spindle_drive(self._axes.sample().enabled, _is_turning(self._spindle))
        self._orient = should_orient
        if should_orient and not self._spindle.spindle_index.is_known:
            self._spindle.set_speed(_SEARCH)
            self._enter(HalCAxisChangeStep.FIND_INDEX)
        else:
            self._change()

    def is_c_ready(self) -> bool:
        """Return whether the C axis is engaged and may move."""
        return self.step is HalCAxisChangeStep.ENGAGED

    # --- each cycle ---------------------------------------------------------------------------------------

    def continue_mode_change(self) -> None:
        """Continue the change between spindle and C that is in progress."""
        if self.step is HalCAxisChangeStep.SPINDLE_MODE:
            return
        if self._link.is_state_unknown or not self._axes.sample().enabled:
            self._let_go()
            return
        acts: dict[HalCAxisChangeStep, Callable[[], None]] = {
            HalCAxisChangeStep.FIND_INDEX: self._search,
            HalCAxisChangeStep.STOP: self._brake,
            HalCAxisChangeStep.CHANGE_MODE: self._engage_c,
            HalCAxisChangeStep.TURN_TO_POSITION: self._arrive,
        }
        if self.step in acts:
            acts[self.step]()

    def _search(self) -> None:
        if self._spindle.spindle_index.is_known:
            self._spindle.set_speed(0.0)
            self._enter(HalCAxisChangeStep.STOP)
        elif self._late(_INDEX):
            self._fail("no spindle index pulse was detected")

    def _brake(self) -> None:
        if abs(self._spindle.get_encoder_rpm()) < _STANDSTILL_RPM:
            self._change()
        elif self._late(_INDEX):
            self._fail("the spindle does not stop")

    def _change(self) -> None:
        self._order = self._link.send_command("c", on=True)
        self._enter(HalCAxisChangeStep.CHANGE_MODE)

    def _engage_c(self) -> None:
        """Engage C as soon as HAL plays the spindle position as its setpoint and the drive follows."""
        c_position = (
            self._link.last_report.get("c_at") if self._link.is_command_executed(self._order) else None
        )
        if isinstance(c_position, float | int) and (not self._told or self._link.read_bit_pin(self._told)):
            self._hold_at(float(c_position))
        elif self._late(_CHANGE):
            self._fail("the signal hal.spindle.in_position_mode does not turn on")

    def _hold_at(self, raw: float) -> None:
        count = self._axes.sample().demand[self._axis]
        off = self._angle_to_position(count) if self._orient else 0.0
        self._axes.transfer_c_axis(None, raw, count - off)
        if abs(off) <= self._axes.config.axes[self._axis].count:
            self._enter(HalCAxisChangeStep.ENGAGED)
            return
        axis_config, now = self._axes.config.axes[self._axis], self._axes.now()
        place, _ = self._axes.demand_at(now)
        speed, begins = _SLOW * axis_config.vmax, now + self._axes.commit + 0.005
        self._axes.splice_homing_move(
            plan_axis_move(begins, place, self._axis, target=count, speed=speed, accel=axis_config.amax)
        )
        self._enter(HalCAxisChangeStep.TURN_TO_POSITION)

    def _arrive(self) -> None:
        if self._axes.is_at_rest and self._axes.now() > self._since + _STOP_TIME_S:
            self._enter(HalCAxisChangeStep.ENGAGED)

    def _angle_to_position(self, count: float) -> float:
        """Return the shortest angle, in degrees, through which the spindle must turn to the C count."""
        reading = self._spindle.read_angle()
        phase = _DEGREES_PER_REV * reading[1] if reading is not None else count
        return math.remainder(count - phase, _DEGREES_PER_REV)

    def _let_go(self) -> None:
        if self.step is HalCAxisChangeStep.SPINDLE_MODE:
            return
        if self.step in {HalCAxisChangeStep.FIND_INDEX, HalCAxisChangeStep.STOP} and not self._link.failure:
            self._spindle.set_speed(0.0)
        self._axes.transfer_c_axis(self._axis)
        if not self._link.failure:
            self._link.send_command("c", on=False)
        self._enter(HalCAxisChangeStep.SPINDLE_MODE)

    def _fail(self, why: str) -> None:
        self._let_go()
        self._axes.fault = self._axes.fault or Fault("C: {why}", "c-coupling", why=why)

    def _late(self, longest: float) -> bool:
        return self._axes.now() > self._since + longest

    def _enter(self, step: HalCAxisChangeStep) -> None:
        self.step, self._since = step, self._axes.now()
        self._spindle.is_used_as_c = step is not HalCAxisChangeStep.SPINDLE_MODE
        self._axes.is_c_turning = step is HalCAxisChangeStep.TURN_TO_POSITION
