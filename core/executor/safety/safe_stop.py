"""The safe stop: slides braked, spindle off, outputs safe; each on its own, and again until it is done.

A driver that refuses one of them, or breaks over it, keeps none of the others from being done.
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
_AGAIN = 0.1  # s until a step that could not be done is tried again

Step = tuple[str, Callable[[], None]]


class SafeStop:
    """``react`` does every step, ``again`` those that failed. Ctrl-C is all that they let through."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._failed: list[Step] = []
        self._tried_at = 0.0
        self._tries = 0

    @property
    def undone(self) -> str:
        """In words, what was tried more than once and could not be done; empty when all is."""
        return ", ".join(name for name, _ in self._failed) if self._tries > 1 else ""

    def react(self, reaction: Reaction) -> None:
        """Brake all axes, spindle off, outputs safe."""
        off = reaction is Reaction.OFF
        brake = partial(self._brake, Stop.RAMP_OFF if off else Stop.RAMP_HOLD)
        self._begin([(_SLIDES, brake), *self._functions(coast=off)])

    def functions_off(self) -> None:
        """Spindle off and outputs safe; the slides are somebody else's."""
        self._begin(self._functions(coast=False))

    def _functions(self, *, coast: bool) -> list[Step]:
        return [*self._context.spindle.safe_steps(coast=coast), ("the outputs", self._outputs_safe)]

    def _begin(self, steps: list[Step]) -> None:
        self._tries = 0
        self._carry_out(steps)

    def again(self) -> None:
        """Once a tick: what could not be done is tried again, ten times a second."""
        if self._failed and self._context.now - self._tried_at >= _AGAIN:
            self._carry_out(self._failed)

    def finish(self) -> None:
        """Before nobody tries again: once more, and slides that cannot be braked lose their power."""
        if self._failed:
            self._carry_out(self._failed)
        if any(name == _SLIDES for name, _ in self._failed):
            self._done("the drives", partial(self._context.ports.axes.enable, False))

    def forget(self) -> None:
        """The operator has acknowledged it."""
        self._failed = []

    def _carry_out(self, steps: list[Step]) -> None:
        self._tried_at, self._tries = self._context.now, self._tries + 1
        self._failed = [step for step in steps if not self._done(*step)]

    def _done(self, name: str, step: Callable[[], None]) -> bool:
        """Whether it could be done. Whatever it raises is no reason to leave the next one out."""
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
        """Drives that break over being asked to brake lose their power."""
        axes = self._context.ports.axes
        with Attempt() as trial:
            axes.stop(how)
        if trial.error is not None:
            if not isinstance(trial.error, DriverError):
                axes.enable(False)
            raise trial.error

    def _outputs_safe(self) -> None:
        """All at once; where that fails each by itself."""
        io = self._context.ports.io
        with Attempt() as trial:
            io.safe()
        if trial.error is not None:
            for output in self._context.machine.outputs.values():
                if output.safe is not None:
                    self._done(output.name, partial(io.write, output.name, output.safe))
            raise trial.error
