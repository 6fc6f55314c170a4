"""Looks after the machine every tick: one place for all drivers."""

from __future__ import annotations

import math

from core.executor.alarms import TroubleError
from core.executor.axis_watch import AxisWatch
from core.executor.bench import Bench
from core.executor.snapshot import State
from core.ports import AxisSample, code_of


class Supervisor:
    """Sees faults and raises them as TroubleError."""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        self._axes = AxisWatch(bench.machine.axes)
        self.max_following_error = 0.0

    def acknowledged(self) -> None:
        """An axis that stands elsewhere now may stand there."""
        self._axes.forget()

    def look(self, state: State) -> None:
        """Raises TroubleError for the first thing that must stop the machine."""
        sample, bench = self._bench.sample, self._bench
        if sample.fault:
            raise TroubleError(code_of(sample.fault, "axis"), sample.fault)
        self._numbers(sample)
        self.max_following_error = max(self.max_following_error, *map(abs, sample.following_error[:2]))
        self._axes.look(sample, unpowered=state is State.DISABLED)
        turning = not bench.spindle.stopped and bench.spindle.asked
        gripped = bench.inputs.get("collet_closed", True) or not bench.ports.io.outputs().get("collet", True)
        if turning and not gripped and not bench.machine.interlocks.spindle_with_collet_open:
            self._collet_lost()
        else:
            self._open_since = None

    def _numbers(self, sample: AxisSample) -> None:
        """No comparison ever trips on what is no number."""
        each = zip(
            self._bench.machine.axes, sample.demand, sample.actual, sample.following_error, strict=True
        )
        for axis, *told in each:
            if not all(map(math.isfinite, told)):
                raise TroubleError("axis", f"{axis.name}: its drive tells a position that is no number")

    def _collet_lost(self) -> None:
        """The switch may bounce while the collet closes; it must be off for its closing time."""
        now = self._bench.now
        self._open_since = now if self._open_since is None else self._open_since
        if now - self._open_since > 2.0 * self._bench.machine.timing.collet_close:
            raise TroubleError("collet-lost")

    _open_since: float | None = None
