"""Rebuilding of the state at a program line by interpreting the program up to that line.

The positions at Cycle Start and the inputs of the run are unknown. A second pass with another start position
and other inputs runs in parallel until both agree. While they differ, no line is suitable for a restart.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable
from dataclasses import replace
from math import hypot

from core.interpreter.omniturn.omniturn_interpreter import Interpreter, PassToLine
from core.interpreter.omniturn.omniturn_program import Program, read_program
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.restart.cut_record import FACE, SIDE, CutRecord, record_cuts
from core.interpreter.restart.loop_passes import Visits, visits_of
from core.interpreter.restart.restart_lines import RestartLines
from core.interpreter.restart.restart_point import Interruption, LineVisit, NoRestart, RestartPoint
from core.interpreter.restart.restart_retract import NEAR, Place, Retract, ToolPlace, retract
from core.interpreter.shared.actions import AskInput, ProgramEnd
from core.interpreter.shared.checkpoint import Begin, Checkpoint
from core.interpreter.shared.job_setup import Setup
from core.language.source import Source
from core.message import Message

Watch = Callable[[float], None]

_ELSEWHERE = (7.3, -11.9, 0.0)  # mm; shift of the second start position, which no program positions by chance
_SAME = 1e-7  # mm
_WATCHED = 2000  # number of blocks between two calls of ``watch``
_NEAR = 64  # number of lines after each of which the passes are compared
_UP, _DOWN = 3, 100  # number of lines that are tried upward and downward


class StateRebuild:
    """Search in one OmniTurn program with a fixed setup; a later line continues from an earlier one.

    ``watch`` receives the number of blocks and may raise an exception to cancel the search.
    """

    def __init__(self, source: Source, setup: Setup, watch: Watch) -> None:
        self._setup = replace(setup, begin=None, inputs=lambda _terminal: False)
        self.watch = watch
        self._program: Program = read_program(source, setup.strict)
        self.lines = RestartLines(self._program)
        self._asks = _asks(self._program, self.lines)
        self._cut: CutRecord | None = None
        self._visits: tuple[int, Visits] | None = None
        self._begin_anew()

    @property
    def cut(self) -> CutRecord:
        """Record of all cuts of the program, calculated on first use."""
        if self._cut is None:
            self._cut = record_cuts(
                Interpreter(self._program, replace(self._setup, start=_ELSEWHERE)).series(), self.watch
            )
        return self._cut

    def find(self, line: int, visit: int = 0, broken: Interruption | None = None) -> RestartPoint | NoRestart:
        """Return the restart point of a line at its ``visit``-th execution, or why a restart is not possible.

        A ``visit`` of 0 is the interrupted pass, or the first one. ``broken`` is the interruption of the
        program.
        """
        found = self._search(line, visit, broken)
        if isinstance(found, RestartPoint):
            return found
        return NoRestart(
            line, found, self._nearest_good(line, -1, broken), self._nearest_good(line, 1, broken)
        )

    def _search(self, line: int, visit: int, broken: Interruption | None) -> RestartPoint | str:
        why = self.lines.why_not(line)
        if why:
            return why
        if not self.lines.repeats(line):
            return self._pass_to_line(line) or self._found(line, self._walk, LineVisit(), broken)
        visits = self._visits_of(line)
        number = visit or visits.at(broken.block if broken is not None else 0)
        why = visits.why_not(line, number)
        anchor, nth = visits.anchor(number) if not why else (0, 0)
        why = why or self._pass_to_line(anchor, position_known=False)
        if why:
            return why.replace(
                Message("line {line}", line=anchor), Message("line {line}", line=line)
            ).replace(Message("Line {line}", line=anchor), Message("Line {line}", line=line))
        found = self._within(line, anchor, nth, visits.line_visit(number), broken)
        if isinstance(found, RestartPoint) and broken is not None:
            return replace(found, was=visits.line_visit(visits.at(broken.block)))
        return found

    def _visits_of(self, line: int) -> Visits:
        if self._visits is None or self._visits[0] != line:
            self._visits = line, visits_of(self._program, self._setup, line, self.watch)
        return self._visits[1]

    def _within(
        self, line: int, anchor: int, nth: int, visit: LineVisit, broken: Interruption | None
    ) -> RestartPoint | str:
        """Return the restart point of a line in a loop or subroutine, or why it is not possible.

        The search begins at the main program line that contains the visit.
        """
        walks = [self._walk_from(self._walk, anchor)]
        if self._other is not None:
            walks.append(self._walk_from(self._other, anchor))
        moved = self._moved
        for walk in walks:
            lost, has_moved = self._to_visit(walk, line, nth)
            if lost:
                return Message(
                    "The program cannot resume at line {line}: {position}", line=line, position=lost
                )
            moved = moved or has_moved
        walk, known = walks[0], self._other is None or _same_state(*walks)
        why = self._why_not(line, walk, known=known, moved=moved)
        return why or self._found(line, walk, visit, broken)

    def _walk_from(self, walk: PassToLine, anchor: int) -> PassToLine:
        setup = replace(walk.setup, begin=Begin(walk.checkpoint, anchor))
        return PassToLine(self._program, setup)

    def _to_visit(self, walk: PassToLine, line: int, nth: int) -> tuple[str, bool]:
        """Run to the ``nth`` visit of a line.

        Return why its state is unknown (empty if known), and whether an axis has moved.
        """
        moved = False
        for number in range(nth):
            for block in walk.once_more(line) if number else walk.before(line):
                self._count_block()
                moved = moved or block.action is None
                if isinstance(block.action, AskInput):
                    asks = block.action.terminal
                    return Message(
                        "line {line} depends on input {terminal}, and the state of this input is unknown.",
                        terminal=asks,
                        line=block.line,
                    ), moved
        return "", moved

    def _count_block(self) -> None:
        self._count += 1
        if self._count % _WATCHED == 0:
            self.watch(self._count)

    def _found(
        self, line: int, walk: PassToLine, visit: LineVisit, broken: Interruption | None
    ) -> RestartPoint | str:
        return found_on_lathe(line, walk.checkpoint, self.cut, visit, broken)

    def _nearest_good(self, line: int, way: int, broken: Interruption | None) -> int:
        """Return the nearest line that a pass confirms, or 0.

        Only a few lines are tried upward, because each needs another pass.
        """
        for _ in range(_DOWN if way > 0 else _UP):
            line = self.lines.nearest(line, way)
            if not line or isinstance(self._search(line, 0, broken), RestartPoint):
                return line
        return 0

    def _begin_anew(self) -> None:
        self._at, self._count = 1, 0
        self._moved = False
        self._ended = 0
        self._asked = 0  # line whose input has another state in the second pass
        self._lost = ""  # reason why the state is unknown
        self._walk = PassToLine(self._program, self._setup)
        self._other: PassToLine | None = PassToLine(self._program, replace(self._setup, start=_ELSEWHERE))

    def _pass_to_line(self, line: int, *, position_known: bool = True) -> str:
        """Run to the line, and return why it is unsuitable; empty if it is suitable.

        Without ``position_known``, the position may still depend on the start, because later blocks may
        determine it.
        """
        if line < self._at:
            self._begin_anew()
        while self._at < line and not (self._ended or self._lost or self._walk.failed):
            if self._at in self._asks:
                self._ask()
            self._pass_to(self._stop(line))
            other = self._other
            if other is not None and not other.failed and _same_state(self._walk, other):
                self._other = None
        known = self._other is None or not position_known
        return self._why_not(line, self._walk, known=known, moved=self._moved)

    def _stop(self, line: int) -> int:
        """Return the line of the next comparison: each line while the state is unknown, and each input."""
        near = self._at + (1 if self._at < _NEAR else self._at) if self._other is not None else line
        if self._at in self._asks:
            return self._at + 1
        place = bisect_right(self._asks, self._at)
        ask = self._asks[place] if place < len(self._asks) else line
        return min(line, near, ask)

    def _pass_to(self, line: int) -> None:
        """Run both passes to the line, and record motion, program end and inputs of the first one."""
        asked, self._at = self._at, line
        for block in self._walk.before(line):
            self._count_block()
            if block.action is None:
                self._moved = True
            elif isinstance(block.action, ProgramEnd):
                self._ended = block.line
            elif isinstance(block.action, AskInput) and (self._walk.called or block.line != asked):
                self._lost = Message(
                    "line {line} depends on input {terminal}, and the state of this input is unknown.",
                    terminal=block.action.terminal,
                    line=block.line,
                )
        if self._other is not None:
            for _ in self._other.before(line):
                pass

    def _ask(self) -> None:
        """Start a second pass in which the input of this line has the other state."""
        if self._other is not None:
            self._lost = Message(
                "line {position} depends on an input, and the state of this input is unknown.",
                position=self._at,
            )
            return
        begin = Begin(self._walk.checkpoint, self._at)
        self._asked = self._at
        self._other = PassToLine(
            self._program, replace(self._setup, begin=begin, inputs=lambda _terminal: True)
        )

    def _why_not(self, line: int, walk: PassToLine, *, known: bool, moved: bool) -> str:
        reasons = (
            (walk.failed, Message("The program has errors before line {line}.", line=line)),
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
                walk.holds_moves,
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


def found_on_lathe(
    line: int, point: Checkpoint, cut: CutRecord, visit: LineVisit, broken: Interruption | None
) -> RestartPoint | str:
    """Return the restart point with the retract from its start; a message if no safe path exists."""
    done = _complete_blocks(cut, broken) if broken is not None else point.blocks
    back = _retract_from(cut, point)
    if back.tool_place is ToolPlace.CLEAR or (back.known and point.blocks <= done):
        return RestartPoint(line, point, back, cut, visit, left_out=_left_out(cut, done, point.blocks))
    if point.blocks > done:
        return in_uncut_material(line, *_left_out(cut, done, point.blocks))
    how = _HOW.get(back.tool_place, "")
    return Message(
        "At the start of line {line}, the tool is inside the part, and a safe path to that "
        "point does not exist. {method}",
        line=line,
        method=how,
    ).strip()


def in_uncut_material(line: int, first: int, last: int) -> Message:
    """Return the message that a line follows cuts that were skipped, from line ``first`` to ``last``."""
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


def _complete_blocks(cut: CutRecord, broken: Interruption) -> int:
    """Return the last block whose cut is complete.

    The interrupted block is complete only if the tool is at its end. Otherwise, a restart after that block
    would leave the rest of its cut in the part. A closed milled block, such as a full circle, never counts as
    complete, because its end does not show how far it was cut.
    """
    row = cut.row_behind(broken.block)
    off = cut.offsets.get(broken.tool)
    if broken.done != broken.block or row < 0 or off is None or int(cut.n[row]) != broken.block:
        return broken.done
    x, z = broken.at[0] - off[0], broken.at[1] - off[1]
    feeds = bool(int(cut.how[row]) & 1)
    at_end = hypot(x - float(cut.x[row]), z - float(cut.z[row])) <= NEAR
    begin = cut.ends(cut.first_row(row))
    closed = hypot(begin[0] - float(cut.x[row]), begin[1] - float(cut.z[row])) <= NEAR
    milled = bool(int(cut.how[row]) & (SIDE | FACE))
    return broken.block - 1 if feeds and ((closed and milled) or not at_end) else broken.done


_HOW = {
    ToolPlace.TAP: "The tap is in the thread at the start of the requested line.",
    ToolPlace.THREAD: "The threading tool is in the thread at the start of the requested line.",
}


def _retract_from(cut: CutRecord, point: Checkpoint) -> Retract:
    """Return the retract from the start of the line; a new tool starts where the previous tool stopped."""
    row = cut.row_behind(point.blocks)
    if row < 0:
        return Retract(ToolPlace.CLEAR)
    tool = int(cut.tool[row])
    off_x, off_z = cut.offsets[tool]
    x, z = point.machine
    return retract(cut, Place(point.blocks, tool, x - off_x, z - off_z), point.blocks)


def _left_out(cut: CutRecord, done: int, blocks: int) -> tuple[int, int]:
    """Return the lines of the first and last cut between the executed blocks and the line, lower first."""
    rows = (cut.n > done) & (cut.n <= blocks) & ((cut.how & 1) != 0)
    if not rows.any():
        return 0, 0
    ends = int(cut.line[rows][0]), int(cut.line[rows][-1])
    return min(ends), max(ends)  # a loop can end on an earlier line


def _asks(program: Program, lines: RestartLines) -> list[int]:
    """Return the lines of the main program, outside of loops, that read an input, in order."""
    steps = enumerate(program.ready, start=1)
    asking = [n for n, step in steps if isinstance(step, Statement) and step.flow in {"M95", "M97"}]
    return [number for number in asking if not lines.why_not(number)]


def _same_state(one: PassToLine, other: PassToLine) -> bool:
    """Return whether both passes are at the same point with the same state, so that they continue equally."""
    a, b = one.checkpoint, other.checkpoint
    if one.next_line != other.next_line or one.holds_moves or other.holds_moves or a.modal != b.modal:
        return False
    near = all(abs(p - q) < _SAME for p, q in zip(a.machine, b.machine, strict=True))
    near = near and abs(a.px - b.px) < _SAME and abs(a.pz - b.pz) < _SAME
    return near and _rest(a) == _rest(b)


def _rest(point: Checkpoint) -> Checkpoint:
    """Return the checkpoint without position and block count."""
    return point._replace(x=0.0, z=0.0, c=0.0, px=0.0, pz=0.0, blocks=0)
