"""What the search for a line of a restart answers: the line in one of its passes, or why it cannot be."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_retract import Retract, ToolPlace
from core.interpreter.shared.checkpoint import Checkpoint


class LoopPass(NamedTuple):
    """One pass of a loop; ``first`` and ``last`` are its lines, LS and LF."""

    first: int
    last: int
    number: int
    of: int


class Called(NamedTuple):
    """A call under way: the line that calls, and the number of the subroutine."""

    line: int
    subroutine: int


class LineVisit(NamedTuple):
    """The ``number``-th time, of ``of`` in the whole run, that the program comes to a line, and in what."""

    number: int = 1
    of: int = 1
    within: tuple[LoopPass | Called, ...] = ()


class Interruption(NamedTuple):
    """Where the program was interrupted: elementary block, machine point, mm; blocks begun without a gap.

    ``stale``: the control was cut off, so that the tool may have gone on for a second behind that.
    """

    block: int
    tool: int
    at: tuple[float, ...]
    begun: int
    stale: bool = False

    @property
    def done(self) -> int:
        """Up to this block the material is known to be cut."""
        return max(self.begun, self.block) if self.block <= self.begun + 1 else self.begun


@dataclass(frozen=True, slots=True)
class RestartPoint:
    """A good line in one of its passes, what it inherits, and the way back from its place out of the work.

    ``left_out``: lines that were not cut and would be left out, as (first, last); (0, 0): none.
    """

    line: int
    checkpoint: Checkpoint
    back: Retract = field(default_factory=lambda: Retract(ToolPlace.CLEAR))
    cut: CutRecord | None = None
    visit: LineVisit = field(default_factory=LineVisit)
    was: LineVisit | None = None  # the pass that was interrupted, where the line is run more than once
    left_out: tuple[int, int] = (0, 0)
    axes: tuple[float | None, ...] = ()  # of a mill: where its axes stand there; None: one that never moved


@dataclass(frozen=True, slots=True)
class NoRestart:
    """Why a program cannot go on from a line, and the nearest lines from which it can; 0: there is none."""

    line: int
    why: str
    before: int = 0
    after: int = 0
