"""Looks after the machine every tick, and stops it: one place for all drivers."""

from __future__ import annotations

from collections.abc import Callable

from core.alarms import Reaction
from core.executor.alarms import TroubleError
from core.executor.bench import Bench
from core.ports import DriverError, Stop, code_of

_HOST = 0.1  # s beyond the drive's own time after which the control itself trips on a following error


class Supervisor:
    """Sees faults and raises them as TroubleError; ``react`` stops the machine."""

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

    def react(self, reaction: Reaction) -> None:
        """Brake all axes, spindle off, outputs safe. A driver that refuses does not keep the others alive."""
        ports = self._bench.ports
        how = Stop.RAMP_OFF if reaction is Reaction.OFF else Stop.RAMP_HOLD
        steps: list[Callable[[], None]] = [
            lambda: ports.axes.stop(how),
            self._bench.spindle.coast if reaction is Reaction.OFF else self._bench.spindle.stop,
            ports.io.safe,
        ]
        for step in steps:
            self._carefully(step)

    def _carefully(self, step: Callable[[], None]) -> None:
        try:
            step()
        except DriverError as error:
            self._bench.say("alarm", f"while stopping: {error}")

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
