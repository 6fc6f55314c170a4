"""What a change of offsets does to the path: the loaded program drawn with the offsets before and after.

A tool whose offset changes moves its real tip, so both pictures stand in the frame of the offsets before:
there the path after lies beside the path before by as much as the tip will.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from app.desk.latest import Latest, Watch
from core.executor.job import Job
from core.interpreter.job_setup import SecondaryOffset, ToolOffset

if TYPE_CHECKING:
    from app.path.path_picture import Picture

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
    _worker: Latest = field(default_factory=lambda: Latest("effect"))

    @property
    def busy(self) -> bool:
        """Whether the worker is still at it; what went wrong there is ``trouble`` afterwards."""
        self._worker.poll()
        return self._worker.busy

    def ask(self, job: Job, before: Tables, after: Tables) -> None:
        """Draw this program both ways; what was being drawn before is given up."""

        def pair(watch: Watch) -> Compared:
            return compared(*(self.draw(_with(job, each), before.tools, watch) for each in (before, after)))

        self.now, self.trouble = None, ""
        self._worker.ask(pair, self._drawn, self._failed)

    def _drawn(self, pair: Compared) -> None:
        self.now = pair

    def _failed(self, why: str) -> None:
        self.trouble = why

    def settled(self, timeout: float) -> Compared | None:
        """Wait until it is drawn and look; for scripts and tests, never for the screen."""
        self._worker.settle(timeout)
        return self.now

    def forget(self) -> None:
        """Nobody looks any more."""
        self._worker.give_up()
        self.now, self.trouble = None, ""

    def close(self) -> None:
        """Give up whatever is being drawn and end the worker."""
        self._worker.close()


def _with(job: Job, tables: Tables) -> Job:
    return replace(job, setup=replace(job.setup, tools=tables.tools, secondary=tables.secondary))
