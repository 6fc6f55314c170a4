"""C on the spindle's own drive behind HAL: changed over at standstill to positions and back.

``hal.spindle.position_mode`` asks for it, ``in_position_mode`` tells it where that is named. Free, C keeps
its count whatever the spindle does; held, it is one more axis. Its feedback counts the spindle's encoder,
360 a turn.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from enum import Enum

from core.message import Message
from core.ports import DriverError, Fault
from drivers.hal.hal_axes import HalAxes
from drivers.hal.hal_link import HalLink
from drivers.hal.hal_terminals import HalSpindle
from drivers.setpoint_queue import straight

_STANDS = 2.0  # rpm
_SEARCH = 60.0  # rpm to look for the index
_INDEX, _CHANGE = 15.0, 2.0  # s
_TURN = 360.0
_SLOW = 0.25  # of C's own speed, for the way to its place
_AFTER = 0.05  # s behind a motion until it is taken for over


class Step(Enum):
    """How far the change-over is."""

    FREE = "the drive is running as the spindle drive"
    INDEX = "searching for the encoder index"
    STOP = "the spindle stops after the index pulse"
    CHANGE = "changing the spindle drive to position mode"
    TURN = "turning the spindle to its C-axis position"
    HELD = "is C"


class HalSpindleC:
    """``core.ports.SpindleHold``. ``tick`` with the rounds of the loop."""

    def __init__(self, axes: HalAxes, spindle: HalSpindle, link: HalLink, axis: int, told: str) -> None:
        """``told``: the bridge's bit that it is C now; empty where nothing tells."""
        self._axes, self._spindle, self._link = axes, spindle, link
        self._axis, self._told = axis, told
        self.step = Step.FREE
        self._orient = False
        self._since = 0.0
        self._order = 0

    # --- the port -----------------------------------------------------------------------------------------

    def hold(self, on: bool, orient: bool = False) -> None:
        """Hold it as C, or let it turn again. Raises DriverError where it cannot be held now."""
        if not on:
            self._let_go()
            return
        if self.step is not Step.FREE:
            return
        if not self._axes.sample().enabled:
            raise DriverError(
                "C uses the spindle drive, and the drives are off; switch them on first",
                "c-coupling",
                reason="drives-off",
            )
        if self._spindle.ordered or abs(self._spindle.measured()) >= _STANDS:
            raise DriverError(
                "C uses the spindle drive, and the spindle is turning; stop the spindle first",
                "c-coupling",
                reason="spindle-turns",
            )
        self._orient = orient
        if orient and not self._spindle.index.known:
            self._spindle.run(_SEARCH)
            self._enter(Step.INDEX)
        else:
            self._change()

    def held(self) -> bool:
        """Whether C may move."""
        return self.step is Step.HELD

    # --- every round --------------------------------------------------------------------------------------

    def tick(self) -> None:
        """Go on with what is under way."""
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
        """HAL plays C's setpoint where the spindle stands, and the drive follows it from now on."""
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
        """Degrees by the short way from where it stands to where its place from the index is its count."""
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
        self._axes.fault = self._axes.fault or Fault(Message("C: {why}", why=why), "c-coupling")

    def _late(self, longest: float) -> bool:
        return self._axes.now() > self._since + longest

    def _enter(self, step: Step) -> None:
        self.step, self._since = step, self._axes.now()
        self._spindle.lent = step is not Step.FREE
        self._axes.c_turns = step is Step.TURN
