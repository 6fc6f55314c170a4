"""Block search with calculation for Klartext and SINUMERIK programs.

All blocks before the restart line are interpreted as in a run. The tool, spindle, datum, plane, parameters,
loops and calls are therefore the same as in the run. A second pass starts at other axis positions. If the
two passes end with an axis at different positions, the program has not positioned this axis. The line is
then rejected, unless the axis has never moved.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf, isclose

from core.interpreter.dialects import SharedProgram
from core.interpreter.restart.cut_record import CutRecord, record_all_cuts
from core.interpreter.restart.path_distances import PATH_TOLERANCE_MM
from core.interpreter.restart.restart_point import Interruption, LineVisit, RestartPoint, RestartRejection
from core.interpreter.restart.state_rebuild import make_lathe_restart_point, make_skipped_cuts_message
from core.interpreter.restart.tool_retract import Retract, ToolSituation
from core.interpreter.shared.actions import ProgramEnd
from core.interpreter.shared.checkpoint import Checkpoint
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import InterpreterPass
from core.interpreter.shared.job_setup import InterpreterSetup, read_no_input
from core.message import Message

ProgressCallback = Callable[[float], None]

_SECOND_START_SHIFT = (
    7.3  # mm or degrees; shift of the second start position, which no program positions by chance
)
_SAME = 1e-6
_MAX_CANDIDATES = 5  # number of lines that are tried on each side of an unsuitable line
_LINEAR_AXIS_COUNT = 3  # number of linear axes of a mill, which precede its rotary axes
_PROGRESS_INTERVAL = 2000  # number of blocks between two calls of ``report_progress``


@dataclass(slots=True)
class _RunVisits:
    """All executions of all lines in a complete run, each with the number of blocks before it."""

    visits: dict[int, list[int]] = field(default_factory=dict)
    blocking_reasons: dict[int, str] = field(
        default_factory=dict
    )  # reason why a line is unsuitable at its first visit
    end_line: int = 0  # line of the program end


class RestartLineSearch:
    """Search for restart lines in one program with a fixed setup.

    ``report_progress`` is called with the number of blocks and may raise an exception to cancel the search.
    """

    def __init__(
        self, program: SharedProgram, setup: InterpreterSetup, report_progress: ProgressCallback
    ) -> None:
        self._reading = program
        self._setup = replace(setup, begin=None, inputs=read_no_input)
        self.report_progress = report_progress
        self._count = 0

    @cached_property
    def cut_record(self) -> CutRecord:
        """Return the record of all cuts of a lathe program; the record is calculated on first use."""
        return record_all_cuts(self._pass().generate_series(), self.report_progress)

    def find_restart_point(
        self, line: int, visit: int = 0, interruption: Interruption | None = None
    ) -> RestartPoint | RestartRejection:
        """Return the restart point of a line at its ``visit``-th execution, or the rejection.

        A ``visit`` of 0 selects the interrupted execution, or the first execution if the program was not
        interrupted. ``interruption`` describes where the program was interrupted.
        """
        found = self._search(line, visit, interruption)
        if isinstance(found, RestartPoint):
            return found
        return RestartRejection(
            line, found, self._nearest(line, -1, interruption), self._nearest(line, 1, interruption)
        )

    # --- going through the program ------------------------------------------------------------------------

    def _pass(self, aside: float = 0.0) -> InterpreterPass:
        start = tuple(at + aside for at in self._setup.start)
        return self._reading.start_pass(replace(self._setup, start=start))

    def _watched(self, blocks: Iterator[Block]) -> Iterator[Block]:
        for block in blocks:
            self._count += 1
            if self._count % _PROGRESS_INTERVAL == 0:
                self.report_progress(self._count)
            yield block

    @cached_property
    def _run(self) -> _RunVisits:
        run_visits, run, made = _RunVisits(), self._pass(), 0

        def record_visit(line: int) -> bool:
            run_visits.visits.setdefault(line, []).append(made)
            run_visits.blocking_reasons.setdefault(line, run.blocking_reason)
            return False

        run.stop_condition = record_visit
        for block in self._watched(run.generate_blocks(stops_at_first_error=True)):
            made = block.n
            if isinstance(block.action, ProgramEnd):
                run_visits.end_line = block.line
        return run_visits

    def _run_to_line(
        self, line: int, number: int, offset: float, interruption: Interruption | None
    ) -> _PassState:
        """Return the state of a pass at the ``number``-th execution of a line."""
        run, stand, left = self._pass(offset), _PassState(), number

        def is_stop_reached(at: int) -> bool:
            nonlocal left
            left -= at == line
            return not left

        run.stop_condition = is_stop_reached
        for block in self._watched(run.generate_blocks(stops_at_first_error=True)):
            stand.process_block(block, uncut=interruption is not None and _is_uncut(block, interruption))
        stand.has_failed = run.has_errors or not run.has_stopped_before_line
        stand.blocking_reason = run.blocking_reason
        if not stand.has_failed and not stand.blocking_reason:
            stand.checkpoint = run.checkpoint
        return stand

    # --- the result ---------------------------------------------------------------------------------------

    def _search(self, line: int, visit: int, broken: Interruption | None) -> RestartPoint | str:
        lines = self._reading.source.lines
        if not 1 <= line <= len(lines):
            return Message(
                "Line {line} does not exist; the last line of the program is {lines_count}.",
                line=line,
                lines_count=len(lines),
            )
        visits = self._run.visits.get(line, [])
        if not visits:
            return self._why_never(line)
        number = visit or max(
            1, sum(made < broken.block_number for made in visits) if broken is not None else 1
        )
        if number > len(visits):
            return Message(
                "The program reaches line {line} only {visits_count} times.",
                line=line,
                visits_count=len(visits),
            )
        here = self._run_to_line(line, number, 0.0, broken)
        other = self._run_to_line(line, number, _SECOND_START_SHIFT, None)
        if here.has_failed or here.checkpoint is None:
            return Message(
                "The program cannot resume at line {line}: {waits}.",
                line=line,
                waits=here.blocking_reason or "the program has errors before this line",
            )
        at = self._machine_positions(here.checkpoint, other.checkpoint)
        if isinstance(at, str):
            return Message("The program cannot resume at line {line}: {position}", line=line, position=at)
        return self._good(line, here, at, LineVisit(number, len(visits)), broken)

    def _why_never(self, line: int) -> str:
        ended = self._run.end_line
        if ended and line > ended:
            return Message("The program ends on line {ended}, before line {line}.", ended=ended, line=line)
        return Message(
            "Line {line} is empty, is a comment, is part of the previous block, or is never "
            "reached by the program.",
            line=line,
        )

    def _machine_positions(
        self, here: Checkpoint, other: Checkpoint | None
    ) -> tuple[float | None, ...] | str:
        """Return the machine positions for a restart, or the reason why they are unknown.

        The position of an axis that has not moved is None.
        """
        if other is None:
            return "the program before this line depends on the axis positions at Cycle Start."
        found: list[float | None] = []
        for place, start in enumerate(self._setup.start):
            a, b = _axis_positions(here)[place], _axis_positions(other)[place]
            if isclose(a, b, abs_tol=_SAME):
                found.append(a)
            elif isclose(a, start, abs_tol=_SAME) and isclose(b, start + _SECOND_START_SHIFT, abs_tol=_SAME):
                found.append(None)
            else:
                axis = self._axes[place]
                return Message(
                    "the position of {axis} at this line depends on its position at Cycle Start.", axis=axis
                )
        if all(each is None for each in found):
            return "no axis has moved before this line; start the program from its first line."
        return tuple(found)

    @property
    def _axes(self) -> tuple[str, ...]:
        kinematics = self._setup.kinematics
        return ("X", "Z", "C") if kinematics is None else kinematics.axis_names

    def _good(
        self,
        line: int,
        here: _PassState,
        at: tuple[float | None, ...],
        visit: LineVisit,
        broken: Interruption | None,
    ) -> RestartPoint | str:
        assert here.checkpoint is not None
        point = here.checkpoint
        if self._setup.kinematics is None:
            free = (place for place, each in zip("xzc", at, strict=True) if each is None and place != "c")
            if lost := next(free, ""):
                return Message(
                    "The program cannot resume at line {line} because {lost} is not positioned before "
                    "that line.",
                    line=line,
                    lost=lost.upper(),
                )
            own_c = at[2] is not None and not self._setup.limits.is_spindle_c_axis
            turned = point._replace(at=_axis_positions(point)) if own_c else point
            return make_lathe_restart_point(line, turned, self.cut_record, visit, broken)
        skipped = here.skipped_lines or (0, 0)
        first, last = min(skipped), max(skipped)  # a loop can end on an earlier line
        if here.skipped_lines and not here.is_above_skipped_cuts(point):
            return make_skipped_cuts_message(line, first, last)
        clear = Retract(ToolSituation.CLEAR)
        return RestartPoint(line, point, clear, None, visit, skipped_lines=(first, last), axis_positions=at)

    def _nearest(self, line: int, direction: int, interruption: Interruption | None) -> int:
        """Return the nearest line in one direction at which a restart is possible.

        Each candidate line must pass the same checks as a line that the operator selects. Returns 0 if none
        of the first few lines is suitable.
        """
        near = [
            each
            for each, why in self._run.blocking_reasons.items()
            if not why and (each - line) * direction > 0
        ]
        near.sort(key=lambda each: abs(each - line))
        good = (
            each
            for each in near[:_MAX_CANDIDATES]
            if isinstance(self._search(each, 0, interruption), RestartPoint)
        )
        return next(good, 0)


@dataclass(slots=True)
class _PassState:
    """The state of an interpreter pass during a block search.

    ``is_cutting`` is True if the last move was a feed move. ``skipped_lines`` are the first and last line
    of skipped cuts.
    """

    checkpoint: Checkpoint | None = None
    blocking_reason: str = ""
    has_failed: bool = False
    is_cutting: bool = False
    tool_length_mm: float = 0.0  # tool length, mm
    max_skipped_z: float = -inf  # machine Z of the tip at the start of the highest skipped cut, mm
    moves_rotary_axes: bool = False  # a skipped cut moves rotary axes, so that heights cannot be compared
    skipped_lines: tuple[int, int] | None = None

    def process_block(self, block: Block, *, uncut: bool) -> None:
        """Update the state with the next block.

        ``uncut`` means that the interruption prevented the block's cut or left it incomplete.
        """
        if block.swivel is not None:
            self.tool_length_mm = block.swivel.system.tool_length_mm
        if not block.moves:
            return
        self.is_cutting = not block.rapid
        if self.is_cutting and uncut:
            first = self.skipped_lines[0] if self.skipped_lines is not None else block.line
            self.skipped_lines = first, block.line
            if block.travel is not None:
                self.moves_rotary_axes = (
                    self.moves_rotary_axes or block.has_angular_feed or block.travel.curved_move is not None
                )
                tip = block.travel.start[2] - self.tool_length_mm
                self.max_skipped_z = max(self.max_skipped_z, tip)

    def is_above_skipped_cuts(self, point: Checkpoint) -> bool:
        """Return whether a position is at or above the start of all skipped cuts.

        The result is False if the position was not reached at rapid, or if a skipped cut moves rotary axes.
        """
        return (
            not (self.is_cutting or self.moves_rotary_axes)
            and point.at[2] - self.tool_length_mm >= self.max_skipped_z - _SAME
        )


def _is_uncut(block: Block, interruption: Interruption) -> bool:
    """Return whether the interruption prevented the cut of a block or left it incomplete.

    A closed block, such as a full circle, counts as uncut, because its end point does not show how far the
    cut had progressed.
    """
    if block.n != interruption.block_number or block.travel is None:
        return block.n > interruption.last_complete_block
    travel = block.travel
    if travel.length > PATH_TOLERANCE_MM and _is_same_position(travel.start, travel.end):
        return True
    return block.n > interruption.last_complete_block or not _is_same_position(
        interruption.machine_position, travel.end
    )


def _is_same_position(one: Sequence[float], other: Sequence[float]) -> bool:
    """Return whether two machine positions agree, ignoring whole revolutions of rotary axes."""
    offs = [b - a for a, b in zip(one, other, strict=False)]
    turned = [(each + 180.0) % 360.0 - 180.0 for each in offs[_LINEAR_AXIS_COUNT:]]
    return all(abs(each) <= PATH_TOLERANCE_MM for each in (*offs[:_LINEAR_AXIS_COUNT], *turned))


def _axis_positions(point: Checkpoint) -> tuple[float, ...]:
    """Return the machine positions of all axes at a checkpoint."""
    return point.at or (*point.machine, point.c + point.modal.offset_c)
