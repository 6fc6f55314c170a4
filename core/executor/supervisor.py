"""Looks after the machine every tick: one place for all drivers."""

from __future__ import annotations

from core.executor.alarms import TroubleError
from core.executor.bench import Bench
from core.ports import code_of

_HOST = 0.1  # s beyond the drive's own time after which the control itself trips on a following error


class Supervisor:
    """Sees faults and raises them as TroubleError."""

    def __init__(self, bench: Bench) -> None:
        self._bench = bench
        self._off_since: list[float | None] = [None] * len(bench.machine.axes)
        self.max_following_error = 0.0

    def look(self) -> None:
        """Raises TroubleError for the first thing that must stop the machine."""
        sample, bench = self._bench.sample, self._bench
        if sample.fault:
            raise TroubleError(code_of(sample.fault, "axis"), sample.fault)
        self._following()
        turning = not bench.spindle.stopped and bench.spindle.asked
        gripped = bench.inputs.get("collet_closed", True) or not bench.ports.io.outputs().get("collet", True)
        if turning and not gripped and not bench.machine.interlocks.spindle_with_collet_open:
            self._collet_lost()
        else:
            self._open_since = None

    def _following(self) -> None:
        """The control's own check behind the drives'."""
        bench = self._bench
        for i, (axis, error) in enumerate(zip(bench.machine.axes, bench.sample.following_error, strict=True)):
            if i < 2:
                self.max_following_error = max(self.max_following_error, abs(error))
            if abs(error) <= axis.following_window:
                self._off_since[i] = None
                continue
            since = self._off_since[i]
            self._off_since[i] = since = bench.now if since is None else since
            if bench.now - since > axis.following_time + _HOST:
                raise TroubleError("following", f"{axis.name} is {abs(error):.3f} off its setpoint")

    def _collet_lost(self) -> None:
        """The switch may bounce while the collet closes; it must be off for its closing time."""
        now = self._bench.now
        self._open_since = now if self._open_since is None else self._open_since
        if now - self._open_since > 2.0 * self._bench.machine.timing.collet_close:
            raise TroubleError("collet-lost")

    _open_since: float | None = None
