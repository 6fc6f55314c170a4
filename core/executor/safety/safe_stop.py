"""The safe stop: axes braked, spindle off, outputs safe. Failed steps are repeated until they succeed.

A driver that rejects one step, or fails in it, does not prevent the other steps.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial

from core.alarms import Reaction
from core.executor.machine_context import MachineContext
from core.executor.raised_alarm import Attempt
from core.message import Message
from core.ports import DriverError, Stop

_log = logging.getLogger(__name__)
_SLIDES = "the axes"
_AGAIN = 0.1  # s until a failed step is repeated

Step = tuple[str, Callable[[], None]]


class SafeStop:
    """Runs all steps of a safe stop with ``react`` and repeats failed steps with ``again``.

    Only KeyboardInterrupt passes through.
    """

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._failed: list[Step] = []
        self._tried_at = 0.0
        self._tries = 0

    @property
    def undone(self) -> str:
        """The steps that failed more than once, as a text; empty if all steps succeeded."""
        return ", ".join(name for name, _ in self._failed) if self._tries > 1 else ""

    def react(self, reaction: Reaction) -> None:
        """Brake all axes, stop the spindle and switch the outputs to their safe states."""
        off = reaction is Reaction.OFF
        brake = partial(self._brake, Stop.RAMP_OFF if off else Stop.RAMP_HOLD)
        self._begin([(_SLIDES, brake), *self._functions(coast=off)])

    def functions_off(self) -> None:
        """Stop the spindle and switch the outputs to their safe states, without stopping the axes."""
        self._begin(self._functions(coast=False))

    def _functions(self, *, coast: bool) -> list[Step]:
        return [*self._context.spindle.safe_steps(coast=coast), ("the outputs", self._outputs_safe)]

    def _begin(self, steps: list[Step]) -> None:
        self._tries = 0
        self._carry_out(steps)

    def again(self) -> None:
        """Repeat failed steps, ten times per second. Called once per tick."""
        if self._failed and self._context.now - self._tried_at >= _AGAIN:
            self._carry_out(self._failed)

    def finish(self) -> None:
        """Repeat failed steps a last time, and switch off drives that cannot be braked."""
        if self._failed:
            self._carry_out(self._failed)
        if any(name == _SLIDES for name, _ in self._failed):
            self._done("the drives", partial(self._context.ports.axes.enable, False))

    def forget(self) -> None:
        """Discard failed steps because the operator has acknowledged the alarm."""
        self._failed = []

    def _carry_out(self, steps: list[Step]) -> None:
        self._tried_at, self._tries = self._context.now, self._tries + 1
        self._failed = [step for step in steps if not self._done(*step)]

    def _done(self, name: str, step: Callable[[], None]) -> bool:
        """Run one step and return whether it succeeded. An error does not prevent the next step."""
        with Attempt() as trial:
            step()
        error = trial.error
        if error is not None and self._tries == 1:
            if not isinstance(error, DriverError):
                _log.error("while stopping %s", name, exc_info=error)
            self._context.log(
                "alarm",
                Message(
                    "fault while stopping {name}: {error}",
                    name=name,
                    error=str(error) or type(error).__name__,
                ),
            )
        return error is None

    def _brake(self, how: Stop) -> None:
        """Brake the axes, or switch the drives off if braking fails unexpectedly."""
        axes = self._context.ports.axes
        with Attempt() as trial:
            axes.stop(how)
        if trial.error is not None:
            if not isinstance(trial.error, DriverError):
                axes.enable(False)
            raise trial.error

    def _outputs_safe(self) -> None:
        """Switch all outputs to their safe states together, or one by one if that fails."""
        io = self._context.ports.io
        with Attempt() as trial:
            io.safe()
        if trial.error is not None:
            for output in self._context.machine.outputs.values():
                if output.safe is not None:
                    self._done(output.name, partial(io.write, output.name, output.safe))
            raise trial.error
