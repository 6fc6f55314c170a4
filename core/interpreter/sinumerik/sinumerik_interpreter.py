"""The interpreter of SINUMERIK turning programs: text and circumstances → elementary blocks, one by one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property

from core.interpreter.actions import Coolant, ProgramEnd, ProgramStop
from core.interpreter.diagnostic_log import Log
from core.interpreter.elementary_blocks import Block
from core.interpreter.interpretation import MOST_BLOCKS, MOST_LINES, MOST_LINES_WITHOUT_BLOCK, Interpretation
from core.interpreter.job_setup import Setup
from core.interpreter.modal_state import Modal
from core.interpreter.sinumerik.chamfers_and_rounds import Corners, corner_of
from core.interpreter.sinumerik.linear_moves import feed_words, straight
from core.interpreter.sinumerik.modes_and_offsets import leave_offsets, modes, programmed_offset
from core.interpreter.sinumerik.sinumerik_arcs import arc
from core.interpreter.sinumerik.sinumerik_state import State
from core.interpreter.sinumerik.sinumerik_statement import Statement, statement_of
from core.interpreter.sinumerik.spindle_and_dwell import dwell, spindle_words
from core.interpreter.sinumerik.subprogram_flow import Flow, ends_main
from core.language.diagnostics import Diagnostic, ProgramError
from core.language.sinumerik.sinumerik_alarms import fault
from core.language.sinumerik.sinumerik_words import ARC, SPINDLE, Line
from core.language.sinumerik.subprogram_files import HEADER
from core.language.source import Source

# Codes of findings that follow from where the machine stands and what is in force: behind a bad block nobody
# knows either.
_BY_STATE = frozenset(
    {
        *("arc-radius", "arc-no-chord", "10720", "corner-too-large", "corner-next"),
        *("10860", "g95-spindle-stopped", "dwell-spindle-stopped", "speed-missing", "surface-speed-missing"),
        *("r-unset", "word-unused"),
    }
)


class Interpreter(Interpretation):
    """One pass through a SINUMERIK program and its subprograms."""

    def __init__(self, source: Source, setup: Setup) -> None:
        super().__init__(Log())
        self._source = source
        self._state = State(setup, self._log)
        self._corners = Corners(self._state, self._log)
        self._flow = Flow(source)
        self._count = 0

    @cached_property
    def source_blocks(self) -> int:
        """Lines that hold more than a comment."""
        return sum(
            bool(line.split(";", 1)[0].strip()) and HEADER.fullmatch(line) is None
            for line in self._source.lines
        )

    @property
    def modal(self) -> Modal:
        """The state after the last block that was taken."""
        return self._state.modal

    def blocks(self, *, to_first_error: bool = False) -> Iterator[Block]:
        """The elementary blocks, made as they are asked for. To be called once."""
        for block in self._pass():
            if not self._stopped:
                self._count += 1
                block.n = self._count
                yield block
            elif to_first_error:
                return

    def _pass(self) -> Iterator[Block]:
        left, idle, made = MOST_LINES, 0, 0
        while not self._log.full and (line := self._flow.next()) is not None:
            left -= 1
            idle, made = (idle + 1, made) if self._count == made else (0, self._count)
            if left < 0 or idle > MOST_LINES_WITHOUT_BLOCK or self._count >= MOST_BLOCKS:
                self._never_ends(line)
                return
            if line.skip is not None and self._state.setup.block_delete:
                continue
            if line.executable:
                yield from self._line(line)
        yield from self._ended()

    def _line(self, line: Line) -> Iterator[Block]:
        """The blocks of a line; an error is kept, and no block comes after it."""
        for found in line.errors:
            self._refuse(found)
        if line.errors:
            return
        try:
            if line.call:
                self._flow.call(line)
                return
            if line.jump is not None:
                self._flow.steer(line, line.jump, self._state)
                return
            statement = statement_of(line)
            ends = ends_main(statement, called=self._flow.called)
            yield from self._with_corners(statement)
        except ProgramError as problem:
            self._refuse(problem.diagnostic)
            ends = False
            if problem.diagnostic.code == "recursion":
                self._flow.end()
        self._steer(line, ends=ends)

    def _steer(self, line: Line, *, ends: bool) -> None:
        """M2, M17 and M30, behind everything else of their block."""
        if ends:
            self._flow.end()
        elif self._flow.called and any(word.name == "M" and word.value == 17 for word in line.words):
            self._flow.back()

    def _with_corners(self, statement: Statement) -> Iterator[Block]:
        """The blocks of a statement, with the corners cut that are known by now."""
        number = statement.line.number
        place = self._flow.shown_line(number)
        for block in self._blocks(statement):
            corner = corner_of(self._state, statement, block) if block.moves else None
            yield from self._corners.take(block if place == number else replace(block, line=place), corner)

    def _blocks(self, statement: Statement) -> Iterator[Block]:
        """What a block does, in the order in which it does it: states, spindle, motion, stops."""
        state = self._state
        _set_parameters(state, statement)
        if statement.offset_key is not None:
            programmed_offset(state, statement)
            return
        if statement.g or statement.keys:
            modes(state, statement)
        if statement.g or "F" in statement.words:
            feed_words(state, statement)
        if "dwell" in statement.g:
            yield dwell(state, statement)
            return
        if statement.m or not SPINDLE.isdisjoint(statement.words) or "kind of spindle speed" in statement.g:
            yield from spindle_words(state, statement)
        yield from _coolant(state, statement, {7, 8})
        if statement.axes or ARC & statement.words.keys():
            yield arc(state, statement) if state.motion in {2, 3} else straight(state, statement)
        elif "suppression of offsets" in statement.g:
            text = "G53 acts in a block that moves an axis."
            raise statement.refuse(
                statement.g["suppression of offsets"], "word-unused", text, "Add the axes."
            )
        if statement.m:
            yield from self._stops(statement)

    def _stops(self, statement: Statement) -> Iterator[Block]:
        """M9, M0, M1, and the end."""
        state, line = self._state, statement.line
        yield from _coolant(state, statement, {9})
        for code in (0, 1):
            if code in statement.m:
                yield state.action(line.number, f"M{code}", ProgramStop(optional=code == 1))
        if statement.ends and not self._flow.called:
            leave_offsets(state)
            state.adopt(state.modal._replace(spindle=0))
            code = next(code for code in (2, 17, 30) if code in statement.m)
            yield state.action(line.number, f"M{code}", ProgramEnd(reset=True))

    def _ended(self) -> Iterator[Block]:
        """No line comes any more."""
        try:
            self._corners.end()
        except ProgramError as problem:
            self._refuse(problem.diagnostic)
        yield from ()

    def _refuse(self, found: Diagnostic) -> None:
        """Keep the error; what may come of it says nothing new."""
        if not (self._stopped and found.code in _BY_STATE):
            self._log.add(self._flow.located(found))
        self._stopped = True
        self._corners.drop()

    def _never_ends(self, line: Line) -> None:
        text = f"the program makes more than {MOST_BLOCKS:,} blocks or {MOST_LINES:,} executed lines."
        hint = "Look at its loops, and lower the passes of its calls."
        self._refuse(fault(line.number, 0, "too-many-blocks", line.block, text, hint))


def _set_parameters(state: State, statement: Statement) -> None:
    """R parameters and variables that the block sets. Raises ProgramError for a name that no DEF has told."""
    for word in statement.sets:
        if not state.keep(word.name, state.number(statement, word)):
            text = f"{word.name} is no word, and no variable of this program."
            raise statement.refuse(word, "unknown-name", text, f"Write DEF REAL {word.name} before it.")


def _coolant(state: State, statement: Statement, codes: set[int]) -> Iterator[Block]:
    """M7 and M8 before the motion of their block, M9 behind it."""
    code = next((code for code in sorted(codes) if code in statement.m), None)
    if code is not None:
        state.adopt(state.modal._replace(coolant=code != 9))
        yield state.action(statement.line.number, f"M{code}", Coolant(code != 9))
