"""What the desk asks of the pages, starts and watchers attached to it, and how all of it is closed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Protocol

from app.desk.programs.program_loading import Loaded
from core.closing import ClosingStep, Wait, close_in_order, close_together, wait_for
from core.executor.snapshot import Snapshot

DRIVERS_CLOSE = 10.0  # s: an inverter is stopped, a driver process ends


class Attached(Protocol):
    """The model of a page, or a worker of the desk: it ends with the desk."""

    def close(self) -> None: ...


class OwnStart(Protocol):
    """A page that starts something of its own while it is open: a line of MDI, a restart."""

    open: bool

    def barred(self) -> str:
        """Why the palms start nothing now; empty when they may."""
        ...


class Watcher(Protocol):
    """What looks at every frame, and has something to tell beside the standing prompt."""

    def see(self, snapshot: Snapshot, loaded: Loaded) -> None: ...

    def due(self) -> str:
        """What the operator is to do some time soon; empty while there is nothing."""
        ...


@dataclass(slots=True)
class Closing:
    """The steps that close a desk.

    No step waits without a limit, and none depends on another: see ``core/closing.py``.
    """

    stops: list[ClosingStep] = field(default_factory=list)  # close the machine: before everything else
    shut: Callable[[], None] = field(default=lambda: None)  # closes the drivers
    workers: list[ClosingStep] = field(default_factory=list)  # closed together, with what is attached
    ends: list[ClosingStep] = field(default_factory=list)  # close what the workers write to, in this order
    wait: Wait = wait_for  # of closing, for a step

    def close(self, attached: Iterable[ClosingStep]) -> None:
        """Stop the machine and close its drivers; then end the workers, all at once; then ``ends``."""
        close_in_order([*self.stops, ClosingStep("drivers", self.shut, DRIVERS_CLOSE)], self.wait)
        close_together([*attached, *self.workers], self.wait)
        close_in_order(self.ends, self.wait)
