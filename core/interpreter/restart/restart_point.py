"""Results of the search for a restart line: the restart point, or why it is not possible."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_retract import Retract, ToolPlace
from core.interpreter.shared.checkpoint import Checkpoint


class LoopPass(NamedTuple):
    """One pass of a loop; ``first`` and ``last`` are the lines of LS and LF."""

    first: int
    last: int
    number: int
    of: int


class Called(NamedTuple):
    """An active call: the line of the call, and the number of the subroutine."""

    line: int
    subroutine: int


class LineVisit(NamedTuple):
    """The ``number``-th of ``of`` executions of a line in the whole run, with its loop passes and calls."""

    number: int = 1
    of: int = 1
    within: tuple[LoopPass | Called, ...] = ()


class Interruption(NamedTuple):
    """Point of interruption of a program: elementary block, tool, and machine point in mm.

    All blocks up to ``begun`` were begun. ``stale`` means that the control lost power, so that the tool may
    have moved for up to a second after this point.
    """

    block: int
    tool: int
    at: tuple[float, ...]
    begun: int
    stale: bool = False

    @property
    def done(self) -> int:
        """Last block whose cut is known to be complete."""
        return max(self.begun, self.block) if self.block <= self.begun + 1 else self.begun


@dataclass(frozen=True, slots=True)
class RestartPoint:
    """A suitable line in one of its passes, with its inherited state and the retract from its start.

    ``left_out`` are the first and last line of cuts that would be skipped, or (0, 0).
    """

    line: int
    checkpoint: Checkpoint
    back: Retract = field(default_factory=lambda: Retract(ToolPlace.CLEAR))
    cut: CutRecord | None = None
    visit: LineVisit = field(default_factory=LineVisit)
    was: LineVisit | None = None  # the interrupted pass if the line is executed more than once
    left_out: tuple[int, int] = (0, 0)
    axes: tuple[float | None, ...] = ()  # axis positions of a mill, with None for an axis that never moved


@dataclass(frozen=True, slots=True)
class NoRestart:
    """Reason why a restart at a line is not possible, and the nearest suitable lines (0 for none)."""

    line: int
    why: str
    before: int = 0
    after: int = 0
