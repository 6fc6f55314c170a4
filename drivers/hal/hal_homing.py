"""Homing and probing on HAL.

To home, an axis moves to its switch, then slowly off the switch, and then to the index if the homing method
uses an index.
"""

from __future__ import annotations

import math
from enum import Enum
from typing import Protocol

from core.ports import DriverError, MotionSegments, TouchLatch, is_queue_finished
from drivers.hal.hal_config import HalAxis
from drivers.hal.hal_table import PRESENT_POSITION_METHODS, REQUIRED_PINS_BY_HOMING_METHOD
from drivers.port_checks import FirstTouchLatch
from drivers.setpoint_queue import plan_axis_move

_SEARCH_DOWN_METHODS = frozenset((1, 17, 5, 21, 33))  # Methods that search in the negative direction.
_INDEX_ONLY_METHODS = frozenset((33, 34))
_TRAVEL_FACTOR = 1.2  # Factor of the travel.
_SLOW_FACTOR = 10.0  # Factor by which the slow speed is below the search speed by default.
_STOP_TIME_S = 0.2  # Seconds until braking of the bridge is reported.
_INDEX_TRAVEL = 30.0  # Mm or degrees within which an index must occur.


class HomingAxes(Protocol):
    """Axis functions that homing uses.

    Positions are as HAL counts them.
    """

    def now(self) -> float:
        """Return the time of the machine's clock in seconds."""
        ...

    def horizon(self) -> float:
        """Return the end time of the setpoint queue in seconds.

        Returns the current time if the queue is empty.
        """
        ...

    def demand_at(self, time_s: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the queued positions and velocities at ``time_s``."""
        ...

    def read_bit_pin(self, name: str) -> bool:
        """Return a bit of the bridge by the name of its pin, or False for an unknown pin."""
        ...

    def read_number_pin(self, name: str) -> float:
        """Return a number of the bridge by the name of its pin, or 0 for an unknown pin."""
        ...

    def splice_homing_move(self, segments: MotionSegments) -> None:
        """Splice the setpoints of a homing move into the queue.

        Raises DriverError if the bridge does not accept them.
        """
        ...

    def brake_axes(self) -> None:
        """Brake all axes to rest as soon as possible."""
        ...

    def request_encoder_index(self, pin: str, enabled: bool) -> None:
        """Request the index of an encoder, or cancel the request if ``enabled`` is False."""
        ...

    def set_limit_switch_ignored(self, axis: str, ignored: bool) -> None:
        """Select whether the limit switch of an axis is ignored.

        It must be ignored while the axis homes on this switch.
        """
        ...

    def read_hal_position(self, index: int) -> float:
        """Return the position of an axis as HAL counts it."""
        ...

    def set_home_position(self, index: int, hal_position: float) -> None:
        """Set the home position of an axis to ``hal_position``, as HAL counts it."""
        ...

    commit: float


class _Step(Enum):
    START = "begins"
    SEARCH = "the axis searches for its homing switch"
    STOP = "the axis stops on its homing switch"
    LEAVE = "the axis moves off its homing switch slowly"
    INDEX = "the axis searches for the index pulse"
    FINISH = "the axis stops after the home mark"
    PARK = "the axis moves to its home position"
    DONE = "found"


class HalHoming:
    """The homing of one axis.

    Call ``continue_homing`` once per tick and ``add_sample`` for each sample, until ``is_done``.
    ``continue_homing`` raises DriverError if homing fails.
    """

    def __init__(self, axis: HalAxis, index: int, axes: HomingAxes) -> None:
        self.name = axis.name
        self._axis, self.axis_index, self._slides = axis, index, axes
        method = axis.home_method
        self._way = -1.0 if method in _SEARCH_DOWN_METHODS else 1.0
        self._switch = axis.switch_key
        self._to_index = "index_enable" in REQUIRED_PINS_BY_HOMING_METHOD.get(method, ())
        self._slow = axis.home_latch_speed or axis.home_speed / _SLOW_FACTOR
        self._step = _Step.START
        self._since = 0.0
        self._on: bool | None = None  # Switch in the newest sample.
        self._mark: float | None = None
        axes.set_limit_switch_ignored(axis.name, True)

    @property
    def is_done(self) -> bool:
        """Return whether home has been found and the axis is at rest."""
        return self._step is _Step.DONE

    def add_switch_sample(self, hal_position: float, is_switch_on: bool) -> None:
        """Add a sample of the position and the switch.

        The home position is where the switch turns off.
        """
        if self._step is _Step.LEAVE and self._on and not is_switch_on and self._mark is None:
            self._mark = hal_position
        self._on = is_switch_on

    def continue_homing(self, now: float) -> None:
        """Start the next step of the homing if the current step is complete."""
        rests = is_queue_finished(self._slides.horizon(), now)
        acts = {
            _Step.START: self._begin,
            _Step.SEARCH: self._search,
            _Step.STOP: self._stop,
            _Step.LEAVE: self._leave,
            _Step.INDEX: self._search_index,
            _Step.FINISH: self._end,
            _Step.PARK: self._park,
        }
        if self._step in acts:
            acts[self._step](now, rests)

    def _begin(self, now: float, _rests: bool) -> None:
        if self._axis.home_method in PRESENT_POSITION_METHODS:
            self._mark = self._slides.read_hal_position(self.axis_index)
            self._enter(_Step.FINISH, now)
        elif self._axis.home_method in _INDEX_ONLY_METHODS:
            self._seek_index(now)
        elif self._on is None:
            if now - (self._since or now) > 1.0:
                raise self._failed("the homing switch is not being sampled", "not-sampled")
            self._since = self._since or now
        elif self._on:
            self._go(-self._way, self._slow, _Step.LEAVE, now)
        else:
            self._go(self._way, self._axis.home_speed, _Step.SEARCH, now)

    def _search(self, now: float, rests: bool) -> None:
        if self._on:
            self._slides.brake_axes()
            self._enter(_Step.STOP, now)
        elif rests and now > self._since + _STOP_TIME_S:
            raise self._failed("no home switch was found within the axis travel", "no-switch")

    def _stop(self, now: float, rests: bool) -> None:
        if rests and now > self._since + _STOP_TIME_S:
            if not self._on:
                raise self._failed(
                    "the axis has overrun its homing switch; use a longer switch cam or a lower search speed",
                    "ran-over",
                )
            self._go(-self._way, self._slow, _Step.LEAVE, now)

    def _leave(self, now: float, rests: bool) -> None:
        if self._mark is not None and self._to_index:
            self._slides.request_encoder_index(f"{self.name}.index", True)
            self._enter(_Step.INDEX, now)
        elif self._mark is not None:
            self._slides.brake_axes()
            self._enter(_Step.FINISH, now)
        elif rests and now > self._since + _STOP_TIME_S:
            raise self._failed("the homing switch does not turn off", "stays-on")

    def _seek_index(self, now: float) -> None:
        self._go(self._way, self._slow, _Step.INDEX, now, _INDEX_TRAVEL)
        self._slides.request_encoder_index(f"{self.name}.index", True)

    def _search_index(self, now: float, rests: bool) -> None:
        """Wait until the index request turns off, which happens when the encoder passes its index.

        The count then jumps, and HAL compensates the jump. The size of the jump is the position of the
        index.
        """
        if now > self._since + 0.1 and not self._slides.read_bit_pin(f"{self.name}.index"):
            self._mark = self._slides.read_number_pin(f"{self.name}.index-at")
            self._slides.brake_axes()
            self._enter(_Step.FINISH, now)
        elif rests and now > self._since + _STOP_TIME_S:
            self._slides.request_encoder_index(f"{self.name}.index", False)
            raise self._failed("no index pulse was detected", "no-index")

    def _end(self, now: float, rests: bool) -> None:
        if rests and now > self._since + _STOP_TIME_S:
            assert self._mark is not None
            self._slides.set_limit_switch_ignored(self.name, False)
            self._slides.set_home_position(self.axis_index, self._mark + self._axis.home_offset)
            place, _ = self._slides.demand_at(now)
            if self._axis.home_method in PRESENT_POSITION_METHODS or place[self.axis_index] == 0.0:
                self._enter(_Step.DONE, now)
            else:
                travel = -place[self.axis_index]
                self._go(math.copysign(1.0, travel), self._axis.home_speed, _Step.PARK, now, abs(travel))

    def _park(self, now: float, rests: bool) -> None:
        if rests and now > self._since + _STOP_TIME_S:
            self._enter(_Step.DONE, now)

    def _go(self, direction: float, speed: float, step: _Step, now: float, length: float = 0.0) -> None:
        low, high = self._axis.travel or (-180.0, 180.0)
        length = length or _TRAVEL_FACTOR * (high - low)
        place, _ = self._slides.demand_at(now)
        begins = now + self._slides.commit + 0.005
        to = place[self.axis_index] + direction * length
        segments = plan_axis_move(
            begins, place, self.axis_index, target=to, speed=speed, accel=self._axis.amax
        )
        self._slides.splice_homing_move(segments)
        self._mark = None
        self._enter(step, now)

    def _enter(self, step: _Step, now: float) -> None:
        self._step, self._since = step, now

    def _failed(self, why: str, reason: str) -> DriverError:
        self._slides.set_limit_switch_ignored(self.name, False)
        return DriverError("{name}: homing failed: {why}", "homing", reason=reason, name=self.name, why=why)


# --- Probe: HAL samples its input and the axis positions in the same period.


class HalTouchInput(FirstTouchLatch):
    """Probe input (``core.ports.TouchInput``) that evaluates HAL's samples."""

    def __init__(self, period: float, *, active_low: bool) -> None:
        super().__init__()
        self._period, self._low = period, active_low

    def add_sample(self, time_s: float, position: tuple[float, ...], is_input_on: bool) -> None:
        """Add the input and the axis positions of one period of the servo thread."""
        if self._is_first_touch(is_input_on is not self._low):
            self._kept = TouchLatch(time_s, position, self._period)
