"""Independent closing steps that run when TurnDesk closes.

A step that fails or hangs does not prevent the other steps. Each step runs in its own daemon thread for a
limited time. A step that exceeds its limit continues until the process ends.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterable
from typing import NamedTuple

_log = logging.getLogger(__name__)
DEFAULT_LIMIT_S = 3.0  # s, default limit of a step

WaitFunction = Callable[[str, threading.Event, float], bool]
"""Function that waits for the step with this name to end, up to a timeout in seconds.

It returns whether the step has ended.
"""


def wait_for_step_end(_name: str, end_event: threading.Event, seconds: float) -> bool:
    """Wait in real time for at most ``seconds`` for a step to end; return whether it has ended."""
    return end_event.wait(seconds)


class ClosingStep(NamedTuple):
    """A function that runs when TurnDesk closes, with its name for the log and its time limit in seconds."""

    name: str
    run_step: Callable[[], object]
    timeout_s: float = DEFAULT_LIMIT_S


def run_steps_in_order(steps: Iterable[ClosingStep], wait: WaitFunction = wait_for_step_end) -> list[str]:
    """Run the steps one after another; return the names of the steps that failed or timed out."""
    return [step.name for step in steps if not _RunningStep(step).wait_for_success(step.timeout_s, wait)]


def run_steps_in_parallel(steps: Iterable[ClosingStep], wait: WaitFunction = wait_for_step_end) -> list[str]:
    """Run all steps at the same time; return the names of the steps that failed or timed out.

    If several steps hang, the total wait is the longest time limit, not the sum of the limits.
    """
    begun = [_RunningStep(step) for step in steps]
    failed: list[str] = []
    hung = 0.0  # s already spent on a step that hangs; the limits of all steps run at the same time
    for each in begun:
        limit = max(each.step.timeout_s - hung, 0.0)
        if not each.wait_for_success(limit, wait):
            failed.append(each.step.name)
            hung = hung if each.has_ended else max(hung, each.step.timeout_s)
    return failed


class _RunningStep:
    """A closing step that is running or has ended."""

    def __init__(self, step: ClosingStep) -> None:
        self.step = step
        self._done = threading.Event()
        self._failed = False
        threading.Thread(target=self._run, name=f"closing {step.name}", daemon=True).start()

    @property
    def has_ended(self) -> bool:
        """Return whether the step has ended, successfully or not."""
        return self._done.is_set()

    def wait_for_success(self, seconds: float, wait: WaitFunction) -> bool:
        """Wait until the step ends; return whether it succeeded within its time limit."""
        if not wait(self.step.name, self._done, seconds):
            _log.error("closing: %s does not end within %g s", self.step.name, self.step.timeout_s)
            return False
        return not self._failed

    def _run(self) -> None:
        try:
            self.step.run_step()
        except BaseException as error:  # noqa: BLE001 - whatever it is, the other steps are carried out
            self._failed = True
            _log.error("closing: %s has failed", self.step.name, exc_info=error)
        finally:
            self._done.set()
