"""Closing in steps that do not depend on each other: a step that raises or hangs keeps no other from running.

Each step runs on a daemon thread of its own and is waited for within a limit. A step that takes longer is
left running and ends with the process.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterable
from typing import NamedTuple

_log = logging.getLogger(__name__)
LIMIT = 3.0  # s for a step that has no limit of its own

Wait = Callable[[str, threading.Event, float], bool]
"""Wait for the end of the step of this name for so many seconds at most; returns whether it has ended."""


def wait_for(_name: str, ended: threading.Event, seconds: float) -> bool:
    """Wait on the real clock."""
    return ended.wait(seconds)


class ClosingStep(NamedTuple):
    """One thing to close: ``name`` for the log, and how many seconds it may take."""

    name: str
    run: Callable[[], object]
    limit: float = LIMIT


def close_in_order(steps: Iterable[ClosingStep], wait: Wait = wait_for) -> list[str]:
    """Run the steps one after the other. Returns the names of those that failed or did not end."""
    return [step.name for step in steps if not _Running(step).ends_within(step.limit, wait)]


def close_together(steps: Iterable[ClosingStep], wait: Wait = wait_for) -> list[str]:
    """Begin all steps at once, so that several that hang cost the limit of one. Returns as the other."""
    begun = [_Running(step) for step in steps]
    failed: list[str] = []
    hung = 0.0  # s that a step has used up already: the limits run side by side
    for each in begun:
        limit = max(each.step.limit - hung, 0.0)
        if not each.ends_within(limit, wait):
            failed.append(each.step.name)
            hung = hung if each.ended else max(hung, each.step.limit)
    return failed


class _Running:
    """A step that has begun."""

    def __init__(self, step: ClosingStep) -> None:
        self.step = step
        self._done = threading.Event()
        self._failed = False
        threading.Thread(target=self._run, name=f"closing {step.name}", daemon=True).start()

    @property
    def ended(self) -> bool:
        """Whether it has ended, in good order or not."""
        return self._done.is_set()

    def ends_within(self, seconds: float, wait: Wait) -> bool:
        """Whether it ends in good order within so many seconds."""
        if not wait(self.step.name, self._done, seconds):
            _log.error("closing: %s does not end within %g s", self.step.name, self.step.limit)
            return False
        return not self._failed

    def _run(self) -> None:
        try:
            self.step.run()
        except BaseException as error:  # noqa: BLE001 - whatever it is, the other steps are carried out
            self._failed = True
            _log.error("closing: %s has failed", self.step.name, exc_info=error)
        finally:
            self._done.set()
