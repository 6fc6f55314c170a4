"""What a change of offsets does to the path: the loaded program drawn with the offsets before and after.

A tool whose offset changes moves its real tip, so both pictures stand in the frame of the offsets before:
there the path after lies beside the path before by as much as the tip will.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from app.desk.latest import AbandonedError, Watch
from core.executor.job import Job
from core.interpreter.job_setup import SecondaryOffset, ToolOffset

if TYPE_CHECKING:
    from app.desk.picture import Picture

NOUGHT = 1e-9  # mm


@dataclass(frozen=True, slots=True)
class Tables:
    """Both tables of offsets, as the interpreter gets them."""

    tools: Mapping[int, ToolOffset] = field(default_factory=dict)
    secondary: Mapping[int, SecondaryOffset] = field(default_factory=dict)


# Job, the tools in whose frame it is drawn, and whether anybody still wants it.
Draw = Callable[[Job, Mapping[int, ToolOffset], Watch], "Picture"]


@dataclass(frozen=True, slots=True)
class Compared:
    """Two pictures in one frame."""

    before: Picture
    after: Picture
    furthest: float = 0.0  # mm between two points of the same number; infinite where the paths differ in kind

    @property
    def same(self) -> bool:
        """Whether the change does nothing to this program."""
        return self.furthest <= NOUGHT


def compared(before: Picture, after: Picture) -> Compared:
    """The pair, and how far the paths lie apart."""
    if len(before.z) != len(after.z) or not np.array_equal(before.stroke, after.stroke):
        return Compared(before, after, float("inf"))
    if not len(before.z):
        return Compared(before, after)
    apart = np.hypot(after.z - before.z, after.x - before.x)
    return Compared(before, after, float(apart.max()))


@dataclass(slots=True)
class Effect:
    """Draws on a worker; the screen only looks at ``now``, ``busy`` and ``trouble``."""

    draw: Draw
    now: Compared | None = None
    trouble: str = ""
    _ticket: int = 0
    _future: Future[None] | None = None
    _lock: threading.Lock = field(default_factory=threading.Lock)
    _pool: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="effect")
    )

    @property
    def busy(self) -> bool:
        """Whether the worker is still at it; what went wrong there is ``trouble`` afterwards."""
        future = self._future
        if future is None or not future.done():
            return future is not None
        self._future = None
        error = future.exception()
        if error is not None and not isinstance(error, AbandonedError):
            self.trouble = str(error) or type(error).__name__
        return False

    def ask(self, job: Job, before: Tables, after: Tables) -> None:
        """Draw this program both ways; what was being drawn before is given up."""
        with self._lock:
            self._ticket += 1
            ticket = self._ticket
            self.now, self.trouble = None, ""
        self._future = self._pool.submit(self._work, ticket, job, before, after)

    def settled(self, timeout: float) -> Compared | None:
        """Wait until it is drawn and look; for scripts and tests, never for the screen."""
        if self._future is not None:
            wait([self._future], timeout)
        return None if self.busy else self.now

    def forget(self) -> None:
        """Nobody looks any more."""
        with self._lock:
            self._ticket += 1
            self.now, self.trouble = None, ""

    def close(self) -> None:
        """Give up whatever is being drawn and end the worker."""
        self.forget()
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _work(self, ticket: int, job: Job, before: Tables, after: Tables) -> None:
        def watch(_count: float) -> None:
            if ticket != self._ticket:
                raise AbandonedError

        pictures = [self.draw(_with(job, tables), before.tools, watch) for tables in (before, after)]
        pair = compared(*pictures)
        with self._lock:
            if ticket != self._ticket:
                raise AbandonedError
            self.now = pair


def _with(job: Job, tables: Tables) -> Job:
    return replace(job, setup=replace(job.setup, tools=tables.tools, secondary=tables.secondary))
