"""Safe stop, which brakes the axes, stops the spindle and switches the outputs to their safe states.

Failed steps are repeated until they succeed. A driver that rejects one step, or fails in it, does not
prevent the other steps.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial

from core.alarms import AlarmReaction
from core.executor.machine_context import MachineContext
from core.executor.raised_alarm import ErrorCatcher
from core.message import Message
from core.ports import DriverError, StopMode

_log = logging.getLogger(__name__)
_AXES_STEP_NAME = "the axes"
_RETRY_INTERVAL_S = 0.1  # s until a failed step is repeated

StopStep = tuple[str, Callable[[], None]]


class SafeStop:
    """The steps of a safe stop.

    ``run_steps`` runs all steps, and ``retry_failed_steps`` repeats the steps that failed. No exception
    except KeyboardInterrupt reaches the caller.
    """

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._failed: list[StopStep] = []
        self._tried_at = 0.0
        self._tries = 0

    @property
    def failed_steps_text(self) -> str:
        """Return the names of the steps that failed repeatedly as text, or an empty string."""
        return ", ".join(name for name, _ in self._failed) if self._tries > 1 else ""

    def run_steps(self, reaction: AlarmReaction) -> None:
        """Brake all axes, stop the spindle and switch the outputs to their safe states."""
        off = reaction is AlarmReaction.DRIVES_OFF
        brake = partial(self._brake, StopMode.RAMP_OFF if off else StopMode.RAMP_HOLD)
        self._begin([(_AXES_STEP_NAME, brake), *self._functions(coast=off)])

    def switch_functions_off(self) -> None:
        """Stop the spindle and switch the outputs to their safe states, without stopping the axes."""
        self._begin(self._functions(coast=False))

    def _functions(self, *, coast: bool) -> list[StopStep]:
        return [
            *self._context.spindle.prepare_safe_stop(should_coast=coast),
            ("the outputs", self._switch_outputs_safe),
        ]

    def _begin(self, steps: list[StopStep]) -> None:
        self._tries = 0
        self._carry_out(steps)

    def retry_failed_steps(self) -> None:
        """Repeat the failed steps at intervals of 0.1 s.

        The function is called once per tick.
        """
        if self._failed and self._context.now - self._tried_at >= _RETRY_INTERVAL_S:
            self._carry_out(self._failed)

    def make_final_retry(self) -> None:
        """Repeat the failed steps a last time. Switch off the drives if the axes cannot be braked."""
        if self._failed:
            self._carry_out(self._failed)
        if any(name == _AXES_STEP_NAME for name, _ in self._failed):
            self._run_step("the drives", partial(self._context.ports.axes.enable, False))

    def discard_failed_steps(self) -> None:
        """Discard failed steps because the operator has acknowledged the alarm."""
        self._failed = []

    def _carry_out(self, steps: list[StopStep]) -> None:
        self._tried_at, self._tries = self._context.now, self._tries + 1
        self._failed = [step for step in steps if not self._run_step(*step)]

    def _run_step(self, name: str, step: Callable[[], None]) -> bool:
        """Run one step and return whether it succeeded. An error does not prevent the next step."""
        with ErrorCatcher() as trial:
            step()
        error = trial.error
        if error is not None and self._tries == 1:
            if not isinstance(error, DriverError):
                _log.error("while stopping %s", name, exc_info=error)
            self._context.log_text(
                "alarm",
                Message(
                    "fault while stopping {name}: {error}",
                    name=name,
                    error=str(error) or type(error).__name__,
                ),
            )
        return error is None

    def _brake(self, mode: StopMode) -> None:
        """Brake the axes, or switch the drives off if braking fails unexpectedly."""
        axes = self._context.ports.axes
        with ErrorCatcher() as trial:
            axes.stop(mode)
        if trial.error is not None:
            if not isinstance(trial.error, DriverError):
                axes.enable(False)
            raise trial.error

    def _switch_outputs_safe(self) -> None:
        """Switch all outputs to their safe states together, or one by one if that fails."""
        io = self._context.ports.io
        with ErrorCatcher() as trial:
            io.switch_to_safe_state()
        if trial.error is not None:
            for output in self._context.machine.outputs.values():
                if output.safe_state is not None:
                    self._run_step(output.name, partial(io.write, output.name, output.safe_state))
            raise trial.error
