"""Interfaces of the pages, start handlers and frame watchers that are attached to TurnDesk.

The module also defines the order in which these objects close.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Protocol

from app.desk.programs.program_loading import LoadedProgram
from core.closing_steps import ClosingStep, WaitFunction, close_in_order, close_together, wait_for_end
from core.executor.snapshot import Snapshot

DRIVERS_CLOSE_TIMEOUT_S = 10.0  # Seconds for stopping an inverter and for a driver process to end.


class AttachedModel(Protocol):
    """Model of a page or of a background worker. It is closed together with TurnDesk."""

    def close(self) -> None:
        """End the work of the model when TurnDesk closes."""
        ...


class StartHandler(Protocol):
    """Page that uses the start buttons while it is open, such as MDI or restart."""

    is_open: bool

    def barred(self) -> str:
        """Return the reason why the start buttons are disabled, or an empty string if they are enabled."""
        ...


class FrameWatcher(Protocol):
    """Object that observes every frame and may add a reminder to the prompt line."""

    def observe(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Update the watcher from the snapshot and the loaded program, once per frame."""
        ...

    def find_reminder(self) -> str:
        """Return a reminder of an action that the operator must soon take, or an empty string."""
        ...


@dataclass(slots=True)
class ClosingSequence:
    """Steps that close TurnDesk.

    Every step has a time limit, and the steps do not depend on each other. See ``core/closing_steps.py``.
    """

    stop_steps: list[ClosingStep] = field(default_factory=list)  # Close the machine before everything else.
    close_drivers: Callable[[], None] = field(default=lambda: None)  # Closes the drivers.
    # Closed at the same time as the attached models.
    worker_steps: list[ClosingStep] = field(default_factory=list)
    # Close the targets that the workers write to, in this order.
    final_steps: list[ClosingStep] = field(default_factory=list)
    wait_for_step: WaitFunction = wait_for_end  # Waits for one closing step.

    def close(self, model_steps: Iterable[ClosingStep]) -> None:
        """Stop the machine and close its drivers, and then close all workers together.

        After that, the steps in ``final_steps`` are executed.
        """
        close_in_order(
            [*self.stop_steps, ClosingStep("drivers", self.close_drivers, DRIVERS_CLOSE_TIMEOUT_S)],
            self.wait_for_step,
        )
        close_together([*model_steps, *self.worker_steps], self.wait_for_step)
        close_in_order(self.final_steps, self.wait_for_step)
