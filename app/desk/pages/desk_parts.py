"""Interfaces of pages, start handlers and watchers attached to TurnDesk, and the order of closing."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Protocol

from app.desk.programs.program_loading import Loaded
from core.closing import ClosingStep, Wait, close_in_order, close_together, wait_for
from core.executor.snapshot import Snapshot

DRIVERS_CLOSE = 10.0  # Seconds for stopping an inverter and for a driver process to end.


class Attached(Protocol):
    """The model of a page or a background worker, which is closed with TurnDesk."""

    def close(self) -> None: ...


class OwnStart(Protocol):
    """A page that uses the start buttons while it is open, such as MDI or restart."""

    open: bool

    def barred(self) -> str:
        """Return why the start buttons have no effect now. Empty if they can start a cycle."""
        ...


class Watcher(Protocol):
    """An object that sees every frame and may add a reminder to the prompt line."""

    def see(self, snapshot: Snapshot, loaded: Loaded) -> None: ...

    def due(self) -> str:
        """Return what the operator must do soon. Empty if there is nothing to do."""
        ...


@dataclass(slots=True)
class Closing:
    """The steps that close TurnDesk.

    Every step has a time limit, and no step depends on another. See ``core/closing.py``.
    """

    stops: list[ClosingStep] = field(default_factory=list)  # Close the machine before everything else.
    shut: Callable[[], None] = field(default=lambda: None)  # Closes the drivers.
    # Closed at the same time as the attached models.
    workers: list[ClosingStep] = field(default_factory=list)
    # Close the targets that the workers write to, in this order.
    ends: list[ClosingStep] = field(default_factory=list)
    wait: Wait = wait_for  # Waits for one closing step.

    def close(self, attached: Iterable[ClosingStep]) -> None:
        """Stop the machine and close its drivers, then close all workers at once, then execute ``ends``."""
        close_in_order([*self.stops, ClosingStep("drivers", self.shut, DRIVERS_CLOSE)], self.wait)
        close_together([*attached, *self.workers], self.wait)
        close_in_order(self.ends, self.wait)
