"""Homing and probing on HAL.

An axis moves to its switch, slowly off the switch again, and then to the index if the method uses one.
"""

from __future__ import annotations

import math
from enum import Enum
from typing import Protocol

from core.ports import DriverError, Latch, Segments, at_rest
from drivers.hal.hal_config import HalAxis
from drivers.hal.hal_table import HERE, NEEDS
from drivers.port_parts import FirstTouch
from drivers.setpoint_queue import straight

_DOWN = frozenset((1, 17, 5, 21, 33))  # Methods that search in the negative direction.
_INDEX_ONLY = frozenset((33, 34))
_SPARE = 1.2  # Factor of the travel.
_SLOWER = 10.0  # Factor by which the slow speed is below the search speed by default.
_AFTER = 0.2  # Seconds until braking of the bridge is reported.
_INDEX_WAY = 30.0  # Mm or degrees within which an index must occur.


class Slides(Protocol):
    """Functions of the axes that homing needs; positions are in HAL's count."""

    def now(self) -> float: ...
    def horizon(self) -> float: ...
    def demand_at(self, t: float) -> tuple[tuple[float, ...], tuple[float, ...]]: ...
    def bit(self, name: str) -> bool: ...
    def figure(self, name: str) -> float: ...
    def move(self, segments: Segments) -> None: ...
    def halt(self) -> None: ...
    def ask_index(self, pin: str, on: bool) -> None: ...
    def let_limit(self, axis: str, on: bool) -> None: ...
    def raw(self, index: int) -> float: ...
    def found(self, index: int, zero: float) -> None: ...

    commit: float


class _Step(Enum):
    BEGIN = "begins"
    SEARCH = "the axis searches for its homing switch"
    STOP = "the axis stops on its homing switch"
    LEAVE = "the axis moves off its homing switch slowly"
    INDEX = "the axis searches for the index pulse"
    END = "the axis stops after the home mark"
    PARK = "the axis moves to its home position"
    DONE = "found"


class Homing:
    """Homing of one axis: ``step`` must be called once per tick and ``see`` for each sample, until ``done``.

    ``step`` raises DriverError if the homing fails.
    """

    def __init__(self, axis: HalAxis, index: int, slides: Slides) -> None:
        self.name = axis.name
        self._axis, self.index, self._slides = axis, index, slides
        method = axis.home_method
        self._way = -1.0 if method in _DOWN else 1.0
        self._switch = axis.switch
        self._to_index = "index_enable" in NEEDS.get(method, ())
        self._slow = axis.home_latch or axis.home_speed / _SLOWER
        self._step = _Step.BEGIN
        self._since = 0.0
        self._on: bool | None = None  # Switch in the newest sample.
        self._mark: float | None = None
        slides.let_limit(axis.name, True)

    @property
    def done(self) -> bool:
        """Whether home is found and the axis is at rest."""
        return self._step is _Step.DONE

    def see(self, raw: float, on: bool) -> None:
        """Add a sample of position and switch; home is the position at which the switch turns off."""
        if self._step is _Step.LEAVE and self._on and not on and self._mark is None:
            self._mark = raw
        self._on = on

    def step(self, now: float) -> None:
        """Continue the homing."""
        rests = at_rest(self._slides.horizon(), now)
        acts = {
            _Step.BEGIN: self._begin,
            _Step.SEARCH: self._search,
            _Step.STOP: self._stop,
            _Step.LEAVE: self._leave,
            _Step.INDEX: self._look_for_index,
            _Step.END: self._end,
            _Step.PARK: self._park,
        }
        if self._step in acts:
            acts[self._step](now, rests)

    def _begin(self, now: float, _rests: bool) -> None:
        if self._axis.home_method in HERE:
            self._mark = self._slides.raw(self.index)
            self._enter(_Step.END, now)
        elif self._axis.home_method in _INDEX_ONLY:
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
            self._slides.halt()
            self._enter(_Step.STOP, now)
        elif rests and now > self._since + _AFTER:
            raise self._failed("no home switch was found within the axis travel", "no-switch")

    def _stop(self, now: float, rests: bool) -> None:
        if rests and now > self._since + _AFTER:
            if not self._on:
                raise self._failed(
                    "the axis has overrun its homing switch; use a longer switch cam or a lower search speed",
                    "ran-over",
                )
            self._go(-self._way, self._slow, _Step.LEAVE, now)

    def _leave(self, now: float, rests: bool) -> None:
        if self._mark is not None and self._to_index:
            self._slides.ask_index(f"{self.name}.index", True)
            self._enter(_Step.INDEX, now)
        elif self._mark is not None:
            self._slides.halt()
            self._enter(_Step.END, now)
        elif rests and now > self._since + _AFTER:
            raise self._failed("the homing switch does not turn off", "stays-on")

    def _seek_index(self, now: float) -> None:
        self._go(self._way, self._slow, _Step.INDEX, now, _INDEX_WAY)
        self._slides.ask_index(f"{self.name}.index", True)

    def _look_for_index(self, now: float, rests: bool) -> None:
        """Wait until the bit falls at the index; the compensated jump is then the position of the index."""
        if now > self._since + 0.1 and not self._slides.bit(f"{self.name}.index"):
            self._mark = self._slides.figure(f"{self.name}.index-at")
            self._slides.halt()
            self._enter(_Step.END, now)
        elif rests and now > self._since + _AFTER:
            self._slides.ask_index(f"{self.name}.index", False)
            raise self._failed("no index pulse was detected", "no-index")

    def _end(self, now: float, rests: bool) -> None:
        if rests and now > self._since + _AFTER:
            assert self._mark is not None
            self._slides.let_limit(self.name, False)
            self._slides.found(self.index, self._mark + self._axis.home_offset)
            place, _ = self._slides.demand_at(now)
            if self._axis.home_method in HERE or place[self.index] == 0.0:
                self._enter(_Step.DONE, now)
            else:
                way = -place[self.index]
                self._go(math.copysign(1.0, way), self._axis.home_speed, _Step.PARK, now, abs(way))

    def _park(self, now: float, rests: bool) -> None:
        if rests and now > self._since + _AFTER:
            self._enter(_Step.DONE, now)

    def _go(self, way: float, speed: float, step: _Step, now: float, length: float = 0.0) -> None:
        low, high = self._axis.travel or (-180.0, 180.0)
        length = length or _SPARE * (high - low)
        place, _ = self._slides.demand_at(now)
        begins = now + self._slides.commit + 0.005
        to = place[self.index] + way * length
        segments = straight(begins, place, self.index, to=to, speed=speed, accel=self._axis.amax)
        self._slides.move(segments)
        self._mark = None
        self._enter(step, now)

    def _enter(self, step: _Step, now: float) -> None:
        self._step, self._since = step, now

    def _failed(self, why: str, reason: str) -> DriverError:
        self._slides.let_limit(self.name, False)
        return DriverError("{name}: homing failed: {why}", "homing", reason=reason, name=self.name, why=why)


# --- Probe: HAL samples its input and the axis positions in the same period.


class HalTouch(FirstTouch):
    """Touch input that is based on HAL's samples."""

    def __init__(self, period: float, *, active_low: bool) -> None:
        super().__init__()
        self._period, self._low = period, active_low

    def see(self, t: float, place: tuple[float, ...], raw: bool) -> None:
        """Add the input and the axis positions of one period of the servo thread."""
        if self._touches(raw is not self._low):
            self._kept = Latch(t, place, self._period)
