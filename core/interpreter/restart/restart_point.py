"""Results of the search for a restart line: the restart point, or the refusal with its reason."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.tool_retract import Retract, ToolSituation
from core.interpreter.shared.checkpoint import Checkpoint


class LoopPass(NamedTuple):
    """One execution of a program loop, with LS on ``first_line`` and LF on ``last_line``."""

    first_line: int
    last_line: int
    pass_number: int
    pass_count: int


class ActiveCall(NamedTuple):
    """An active subroutine call, with the line of the call and the number of the subroutine."""

    call_line: int
    subroutine_number: int


class LineVisit(NamedTuple):
    """One execution of a line in a complete run, with the loops and calls that are active."""

    visit_number: int = 1
    visit_count: int = 1
    enclosing_levels: tuple[LoopPass | ActiveCall, ...] = ()


class Interruption(NamedTuple):
    """The point at which a program was interrupted: elementary block, tool, and machine position in mm.

    All blocks up to ``last_started_block`` were started. ``was_power_lost`` means that the control lost
    power. The tool may then have moved for up to a second after this point.
    """

    block_number: int
    tool_number: int
    machine_position: tuple[float, ...]
    last_started_block: int
    was_power_lost: bool = False

    @property
    def last_complete_block(self) -> int:
        """Return the number of the last block that was certainly cut completely."""
        return (
            max(self.last_started_block, self.block_number)
            if self.block_number <= self.last_started_block + 1
            else self.last_started_block
        )


@dataclass(frozen=True, slots=True)
class RestartPoint:
    """A line at which a program can be restarted, in one particular execution of this line.

    The point contains the state that the line inherits and the retract from the start of the line.
    ``skipped_lines`` are the first and last line of the cuts that the restart would skip, or (0, 0) if it
    skips none.
    """

    line_number: int
    checkpoint: Checkpoint
    retract: Retract = field(default_factory=lambda: Retract(ToolSituation.CLEAR))
    cut_record: CutRecord | None = None
    visit: LineVisit = field(default_factory=LineVisit)
    interrupted_visit: LineVisit | None = None  # the interrupted pass if the line is executed more than once
    skipped_lines: tuple[int, int] = (0, 0)
    axis_positions: tuple[
        float | None, ...
    ] = ()  # axis positions of a mill, with None for an axis that never moved


@dataclass(frozen=True, slots=True)
class RestartRejection:
    """The reason why a restart at a line is not possible, with the nearest suitable lines.

    A line number is 0 if no suitable line exists in that direction.
    """

    line_number: int
    why: str
    nearest_line_before: int = 0
    nearest_line_after: int = 0
