"""Interfaces of the pages, start handlers and frame watchers that are attached to TurnDesk.

The module also defines the order in which these objects close.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Protocol

from app.desk.programs.program_loading import LoadedProgram
from app.desk.status.interrupted_notice import NoticeRow
from core.closing_steps import (
    ClosingStep,
    WaitFunction,
    run_steps_in_order,
    run_steps_in_parallel,
    wait_for_step_end,
)
from core.executor.snapshot import Snapshot

DRIVERS_CLOSE_TIMEOUT_S = 10.0  # Seconds for stopping an inverter and for a driver process to end.


class AttachedModel(Protocol):
    """Page model or background worker that is closed when TurnDesk closes."""

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
    """Object that is notified of every screen frame and may add a reminder to the prompt line."""

    def observe_frame(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Update the watcher from the snapshot and the loaded program, once per frame."""
        ...

    def find_reminder(self) -> str:
        """Return a reminder of an action that the operator must soon take, or an empty string."""
        ...


class GuidanceCard(Protocol):
    """Card that guides the operator on every page, in place of the card of the first job."""

    def make_row(self) -> NoticeRow | None:
        """Return the row of the card, or None if the card is closed."""
        ...

    def close_card(self) -> bool:
        """Close the card, and return False if it was closed already."""
        ...


@dataclass(frozen=True, slots=True)
class ControlClosing:
    """Steps that close the control of the machine.

    ``stop_steps`` stop the machine before everything else. ``close_drivers`` then closes the drivers.
    ``worker_steps`` run at the same time as those of the services.
    """

    stop_steps: tuple[ClosingStep, ...] = ()
    close_drivers: Callable[[], None] = lambda: None
    worker_steps: tuple[ClosingStep, ...] = ()


@dataclass(frozen=True, slots=True)
class ClosingSequence:
    """Steps that close TurnDesk.

    Every step has a time limit, and the steps do not depend on each other. See ``core/closing_steps.py``.
    ``list_service_steps`` returns the steps of the services that have started. ``storage_steps`` close the
    targets to which the services write, in this order.
    """

    control: ControlClosing = field(default_factory=ControlClosing)
    list_service_steps: Callable[[], Iterable[ClosingStep]] = tuple
    storage_steps: tuple[ClosingStep, ...] = ()
    wait_for_step: WaitFunction = wait_for_step_end  # Waits for one closing step.

    def close(self, model_steps: Iterable[ClosingStep]) -> None:
        """Stop the machine and close its drivers, then close all workers together, and then the storage."""
        drivers = ClosingStep("drivers", self.control.close_drivers, DRIVERS_CLOSE_TIMEOUT_S)
        run_steps_in_order((*self.control.stop_steps, drivers), self.wait_for_step)
        workers = (*model_steps, *self.control.worker_steps, *self.list_service_steps())
        run_steps_in_parallel(workers, self.wait_for_step)
        run_steps_in_order(self.storage_steps, self.wait_for_step)
