"""Reconstruction of the state at a program line by interpreting the program up to that line.

The positions at Cycle Start and the inputs of the run are unknown. Therefore, a second pass with another
start position and other inputs runs in parallel. While the states of both passes differ, no line is
suitable for a restart.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import replace
from math import hypot

from core.interpreter.omniturn.omniturn_interpreter import Interpreter, StoppablePass
from core.interpreter.omniturn.omniturn_program import Program, read_program
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.restart.cut_record import FACE, SIDE, CutRecord, record_all_cuts
from core.interpreter.restart.loop_passes import LineVisits, find_line_visits
from core.interpreter.restart.path_distances import PATH_TOLERANCE_MM
from core.interpreter.restart.restart_lines import RestartSuitability
from core.interpreter.restart.restart_point import Interruption, LineVisit, RestartPoint, RestartRejection
from core.interpreter.restart.restart_retract import plan_retract
from core.interpreter.restart.tool_retract import Retract, ToolPosition, ToolSituation
from core.interpreter.shared.actions import InputRead, ProgramEnd
from core.interpreter.shared.checkpoint import Checkpoint, PassStart
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.source import ProgramSource
from core.message import Message

ProgressCallback = Callable[[float], None]

_SECOND_START_SHIFT = (
    7.3,
    -11.9,
    0.0,
)  # mm; shift of the second start position, which no program positions by chance
_SAME = 1e-7  # mm
_PROGRESS_INTERVAL = 2000  # number of blocks between two calls of ``report_progress``
_NEAR = 64  # number of lines after each of which the passes are compared
_UP, _DOWN = 3, 100  # number of lines that are tried upward and downward


class OmniturnRestartSearch:
    """Search for restart lines in one OmniTurn program with a fixed setup.

    The search for a later line continues from an earlier line. ``report_progress`` is called with the
    number of blocks and may raise an exception to cancel the search.
    """

    def __init__(
        self, source: ProgramSource, setup: InterpreterSetup, report_progress: ProgressCallback
    ) -> None:
        self._setup = replace(setup, begin=None, inputs=lambda _terminal: False)
        self.report_progress = report_progress
        self._program: Program = read_program(source, setup.strict)
        self.line_suitability = RestartSuitability(self._program)
        self._asks = _input_lines(self._program, self.line_suitability)
        self._cut: CutRecord | None = None
        self._visits: tuple[int, LineVisits] | None = None
        self._begin_anew()

    @property
    def cut_record(self) -> CutRecord:
        """Return the record of all cuts of the program; the record is calculated on first use."""
        if self._cut is None:
            self._cut = record_all_cuts(
                Interpreter(self._program, replace(self._setup, start=_SECOND_START_SHIFT)).generate_series(),
                self.report_progress,
            )
        return self._cut

    def find_restart_point(
        self, line: int, visit: int = 0, interruption: Interruption | None = None
    ) -> RestartPoint | RestartRejection:
        """Return the restart point of a line, or the rejection of the restart with its reason.

        ``visit`` selects the execution of the line, from 1. With 0, it is the interrupted execution, or the
        first execution if the program was not interrupted. ``interruption`` is the interruption of the
        program.
        """
        found = self._search(line, visit, interruption)
        if isinstance(found, RestartPoint):
            return found
        return RestartRejection(
            line, found, self._find_nearest(line, -1, interruption), self._find_nearest(line, 1, interruption)
        )

    def _search(self, line: int, visit: int, broken: Interruption | None) -> RestartPoint | str:
        why = self.line_suitability.explain_unsuitable_line(line)
        if why:
            return why
        if not self.line_suitability.is_repeated_line(line):
            return self._pass_to_line(line) or self._found(line, self._walk, LineVisit(), broken)
        visits = self._visits_of(line)
        number = visit or visits.find_visit_number(broken.block_number if broken is not None else 0)
        why = visits.explain_missing_visit(line, number)
        anchor, nth = visits.find_main_program_visit(number) if not why else (0, 0)
        why = why or self._pass_to_line(anchor, position_known=False)
        if why:
            return why.replace(
                Message("line {line}", line=anchor), Message("line {line}", line=line)
            ).replace(Message("Line {line}", line=anchor), Message("Line {line}", line=line))
        found = self._search_in_loop(line, anchor, nth, visits.make_line_visit(number), broken)
        if isinstance(found, RestartPoint) and broken is not None:
            return replace(
                found, interrupted_visit=visits.make_line_visit(visits.find_visit_number(broken.block_number))
            )
        return found

    def _visits_of(self, line: int) -> LineVisits:
        if self._visits is None or self._visits[0] != line:
            self._visits = line, find_line_visits(self._program, self._setup, line, self.report_progress)
        return self._visits[1]

    def _search_in_loop(
        self, line: int, anchor: int, nth: int, visit: LineVisit, interruption: Interruption | None
    ) -> RestartPoint | str:
        """Return the restart point of a line in a loop or subroutine, or the reason for its rejection.

        The search starts at the main program line from which the loop or subroutine is entered.
        """
        walks = [self._walk_from(self._walk, anchor)]
        if self._other is not None:
            walks.append(self._walk_from(self._other, anchor))
        moved = self._moved
        for walk in walks:
            lost, has_moved = self._run_to_visit(walk, line, nth)
            if lost:
                return Message(
                    "The program cannot resume at line {line}: {position}", line=line, position=lost
                )
            moved = moved or has_moved
        walk, known = walks[0], self._other is None or _same_state(*walks)
        why = self._why_not(line, walk, known=known, moved=moved)
        return why or self._found(line, walk, visit, interruption)

    def _walk_from(self, walk: StoppablePass, anchor: int) -> StoppablePass:
        setup = replace(walk.setup, begin=PassStart(walk.checkpoint, anchor))
        return StoppablePass(self._program, setup)

    def _run_to_visit(self, line_pass: StoppablePass, line: int, nth: int) -> tuple[str, bool]:
        """Run to the ``nth`` execution of a line.

        Returns the reason why the state is unknown, or an empty string if it is known. Also returns whether
        an axis has moved.
        """
        moved = False
        for number in range(nth):
            for block in line_pass.run_to_next_visit(line) if number else line_pass.run_to_line(line):
                self._count_block()
                moved = moved or block.action is None
                if isinstance(block.action, InputRead):
                    asks = block.action.terminal
                    return Message(
                        "line {line} depends on input {terminal}, and the state of this input is unknown.",
                        terminal=asks,
                        line=block.line,
                    ), moved
        return "", moved

    def _count_block(self) -> None:
        self._count += 1
        if self._count % _PROGRESS_INTERVAL == 0:
            self.report_progress(self._count)

    def _found(
        self, line: int, walk: StoppablePass, visit: LineVisit, broken: Interruption | None
    ) -> RestartPoint | str:
        return make_lathe_restart_point(line, walk.checkpoint, self.cut_record, visit, broken)

    def _find_nearest(self, line: int, direction: int, interruption: Interruption | None) -> int:
        """Return the nearest suitable line, confirmed by a pass up to it, or 0 if no line is found.

        Only a few lines are tried backward, because each of these lines needs another pass.
        """
        for _ in range(_DOWN if direction > 0 else _UP):
            line = self.line_suitability.find_nearest_line(line, direction)
            if not line or isinstance(self._search(line, 0, interruption), RestartPoint):
                return line
        return 0

    def _begin_anew(self) -> None:
        self._at, self._count = 1, 0
        self._moved = False
        self._ended = 0
        self._asked = 0  # line whose input has another state in the second pass
        self._lost = ""  # reason why the state is unknown
        self._walk = StoppablePass(self._program, self._setup)
        self._other: StoppablePass | None = StoppablePass(
            self._program, replace(self._setup, start=_SECOND_START_SHIFT)
        )

    def _pass_to_line(self, line: int, *, position_known: bool = True) -> str:
        """Run to a line, and return the reason why the program cannot resume there.

        The result is an empty string if the program can resume. Two passes with different start positions
        run to the line. If their states differ at the line, the state is unknown. This is a reason only if
        ``position_known`` is True. Otherwise later blocks may still determine the position.
        """
        if line < self._at:
            self._begin_anew()
        while self._at < line and not (self._ended or self._lost or self._walk.has_errors):
            if self._at in self._asks:
                self._start_second_pass()
            self._run_passes_to(self._stop(line))
            other = self._other
            if other is not None and not other.has_errors and _same_state(self._walk, other):
                self._other = None
        known = self._other is None or not position_known
        return self._why_not(line, self._walk, known=known, moved=self._moved)

    def _stop(self, line: int) -> int:
        """Return the line at which the states of both passes are compared next.

        While the state is unknown, the passes are compared at each line and at each input.
        """
        near = self._at + (1 if self._at < _NEAR else self._at) if self._other is not None else line
        if self._at in self._asks:
            return self._at + 1
        place = bisect_right(self._asks, self._at)
        ask = self._asks[place] if place < len(self._asks) else line
        return min(line, near, ask)

    def _run_passes_to(self, line: int) -> None:
        """Run both passes to the line, and record the motion, program end and inputs of the first pass."""
        asked, self._at = self._at, line
        for block in self._walk.run_to_line(line):
            self._count_block()
            if block.action is None:
                self._moved = True
            elif isinstance(block.action, ProgramEnd):
                self._ended = block.line
            elif isinstance(block.action, InputRead) and (self._walk.is_in_subroutine or block.line != asked):
                self._lost = Message(
                    "line {line} depends on input {terminal}, and the state of this input is unknown.",
                    terminal=block.action.terminal,
                    line=block.line,
                )
        if self._other is not None:
            for _ in self._other.run_to_line(line):
                pass

    def _start_second_pass(self) -> None:
        """Start a second pass, in which the input that this line reads has the opposite state."""
        if self._other is not None:
            self._lost = Message(
                "line {position} depends on an input, and the state of this input is unknown.",
                position=self._at,
            )
            return
        begin = PassStart(self._walk.checkpoint, self._at)
        self._asked = self._at
        self._other = StoppablePass(
            self._program, replace(self._setup, begin=begin, inputs=lambda _terminal: True)
        )

    def _why_not(self, line: int, walk: StoppablePass, *, known: bool, moved: bool) -> str:
        reasons = (
            (walk.has_errors, Message("The program has errors before line {line}.", line=line)),
            (
                self._ended,
                Message(
                    "The program ends on line {ended}, before line {line}.", ended=self._ended, line=line
                ),
            ),
            (
                self._lost,
                Message(
                    "The program cannot resume at line {line}: {position}", line=line, position=self._lost
                ),
            ),
            (
                walk.has_buffered_moves,
                Message(
                    "The program cannot resume at line {line}, because that line uses nose compensation "
                    "or is part of a corner.",
                    line=line,
                ),
            ),
            (
                walk.checkpoint.modal.mill,
                Message(
                    "The program cannot resume at line {line}, because the plane command (~PLXC) or "
                    "(~PLZC) is active there.",
                    line=line,
                ),
            ),
            (
                not known and self._asked,
                (
                    Message(
                        "The program cannot resume at line {line}, because that line depends on an input "
                        "that is read on line {requested}.",
                        line=line,
                        requested=self._asked,
                    )
                ),
            ),
            (
                not known and not moved,
                Message(
                    "No axis has moved before line {line}; start the program from its first line.", line=line
                ),
            ),
            (
                not known,
                (
                    Message(
                        "The program cannot resume at line {line}, because the axis positions there depend "
                        "on the axis positions at Cycle Start.",
                        line=line,
                    )
                ),
            ),
        )
        return next((why for wrong, why in reasons if wrong), "")


def make_lathe_restart_point(
    line: int,
    checkpoint: Checkpoint,
    cut_record: CutRecord,
    visit: LineVisit,
    interruption: Interruption | None,
) -> RestartPoint | str:
    """Return the restart point with the retract from its start, or a message if no safe path exists."""
    done = _complete_blocks(cut_record, interruption) if interruption is not None else checkpoint.blocks
    back = _plan_retract(cut_record, checkpoint)
    if back.tool_situation is ToolSituation.CLEAR or (back.is_known and checkpoint.blocks <= done):
        return RestartPoint(
            line,
            checkpoint,
            back,
            cut_record,
            visit,
            skipped_lines=_skipped_lines(cut_record, done, checkpoint.blocks),
        )
    if checkpoint.blocks > done:
        return make_skipped_cuts_message(line, *_skipped_lines(cut_record, done, checkpoint.blocks))
    how = _RETRACT_TEXTS.get(back.tool_situation, "")
    return Message(
        "At the start of line {line}, the tool is inside the part, and a safe path to that "
        "point does not exist. {method}",
        line=line,
        method=how,
    ).strip()


def make_skipped_cuts_message(line: int, first: int, last: int) -> Message:
    """Return the message that the restart would skip the cuts on the lines ``first`` to ``last``."""
    which = (
        Message("line {line}", line=first)
        if first == last
        else Message("lines {first} to {last}", first=first, last=last)
    )
    return Message(
        "At the start of line {line}, the tool is in material that {which} should have cut.",
        line=line,
        which=which,
    )


def _complete_blocks(cut_record: CutRecord, interruption: Interruption) -> int:
    """Return the last block whose cut is complete.

    The interrupted block is complete only if the tool is at its end. Otherwise, a restart after that block
    would leave the rest of its cut in the part. A closed milled block, such as a full circle, never counts
    as complete, because its end point does not show how much was cut.
    """
    row = cut_record.find_last_row(interruption.block_number)
    off = cut_record.tool_offsets.get(interruption.tool_number)
    if (
        interruption.last_complete_block != interruption.block_number
        or row < 0
        or off is None
        or int(cut_record.block_numbers[row]) != interruption.block_number
    ):
        return interruption.last_complete_block
    x, z = interruption.machine_position[0] - off[0], interruption.machine_position[1] - off[1]
    feeds = bool(int(cut_record.move_kinds[row]) & 1)
    at_end = hypot(x - float(cut_record.end_x[row]), z - float(cut_record.end_z[row])) <= PATH_TOLERANCE_MM
    begin = cut_record.get_end_points(cut_record.find_first_row(row))
    closed = (
        hypot(begin[0] - float(cut_record.end_x[row]), begin[1] - float(cut_record.end_z[row]))
        <= PATH_TOLERANCE_MM
    )
    milled = bool(int(cut_record.move_kinds[row]) & (SIDE | FACE))
    return (
        interruption.block_number - 1
        if feeds and ((closed and milled) or not at_end)
        else interruption.last_complete_block
    )


_RETRACT_TEXTS = {
    ToolSituation.IN_TAPPED_HOLE: "The tap is in the thread at the start of the requested line.",
    ToolSituation.IN_THREAD: "The threading tool is in the thread at the start of the requested line.",
}


def _plan_retract(cut_record: CutRecord, point: Checkpoint) -> Retract:
    """Return the retract from the start of the line.

    A new tool starts at the end position of the previous tool.
    """
    row = cut_record.find_last_row(point.blocks)
    if row < 0:
        return Retract(ToolSituation.CLEAR)
    tool = int(cut_record.tool_numbers[row])
    off_x, off_z = cut_record.tool_offsets[tool]
    x, z = point.machine
    return plan_retract(cut_record, ToolPosition(point.blocks, tool, x - off_x, z - off_z), point.blocks)


def _skipped_lines(cut_record: CutRecord, last_complete_block: int, blocks: int) -> tuple[int, int]:
    """Return the lines of the first and last cut that would be skipped, the lower line first.

    These cuts are between the executed blocks and the restart line. Both lines are 0 if no cut is skipped.
    """
    rows = (
        (cut_record.block_numbers > last_complete_block)
        & (cut_record.block_numbers <= blocks)
        & ((cut_record.move_kinds & 1) != 0)
    )
    if not rows.any():
        return 0, 0
    ends = int(cut_record.line_numbers[rows][0]), int(cut_record.line_numbers[rows][-1])
    return min(ends), max(ends)  # a loop can end on an earlier line


def _input_lines(program: Program, lines: RestartSuitability) -> list[int]:
    """Return the lines of the main program outside of loops that read an input, in ascending order."""
    steps = enumerate(program.executable_lines, start=1)
    asking = [n for n, step in steps if isinstance(step, Statement) and step.flow_code in {"M95", "M97"}]
    return [number for number in asking if not lines.explain_unsuitable_line(number)]


def _same_state(one: StoppablePass, other: StoppablePass) -> bool:
    """Return whether both passes are at the same line in the same state, and so continue identically."""
    a, b = one.checkpoint, other.checkpoint
    if (
        one.next_line != other.next_line
        or one.has_buffered_moves
        or other.has_buffered_moves
        or a.modal != b.modal
    ):
        return False
    near = all(abs(p - q) < _SAME for p, q in zip(a.machine, b.machine, strict=True))
    near = near and abs(a.px - b.px) < _SAME and abs(a.pz - b.pz) < _SAME
    return near and _without_position(a) == _without_position(b)


def _without_position(point: Checkpoint) -> Checkpoint:
    """Return the checkpoint with position and block count set to 0."""
    return point._replace(x=0.0, z=0.0, c=0.0, px=0.0, pz=0.0, blocks=0)
