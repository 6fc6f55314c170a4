"""Interpreter of SINUMERIK turning programs: generates the elementary blocks of a program for a setup."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property, partial

from core.interpreter.shared.actions import Dwell, ProgramEnd, ProgramStop
from core.interpreter.shared.checkpoint import Begin, Checkpoint
from core.interpreter.shared.control_flow import ENDLESS
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.interpretation import MOST_BLOCKS, MOST_LINES, LinePass, approach_blocks
from core.interpreter.shared.job_setup import Setup
from core.interpreter.shared.modal_state import Modal
from core.interpreter.sinumerik.cycles.cycle_calls import cycle_blocks
from core.interpreter.sinumerik.cycles.drilling_cycles import PATTERNS, no_cycle, places
from core.interpreter.sinumerik.cycles.tapping_cycles import tap
from core.interpreter.sinumerik.flow.block_search import Parts, checkpoint_of, needs_others, take_up
from core.interpreter.sinumerik.flow.subprogram_flow import Flow, ends_main
from core.interpreter.sinumerik.flow.variables import place_name
from core.interpreter.sinumerik.motion.chamfers_and_rounds import Corner, Corners, corner_of
from core.interpreter.sinumerik.motion.fixed_points import fixed_point, home
from core.interpreter.sinumerik.motion.linear_moves import straight
from core.interpreter.sinumerik.motion.radius_compensation import Compensation
from core.interpreter.sinumerik.motion.sinumerik_arcs import arc
from core.interpreter.sinumerik.motion.sinumerik_feeds import feed_words
from core.interpreter.sinumerik.motion.thread_moves import thread
from core.interpreter.sinumerik.motion.transformations import transform
from core.interpreter.sinumerik.motion.transformed_plane import Transformation
from core.interpreter.sinumerik.setup.m_functions import check_m, functions_after, functions_before
from core.interpreter.sinumerik.setup.modes_and_offsets import (
    check_y,
    frame_block,
    leave_offsets,
    modes,
    programmed_frame,
    tell_idle_words,
)
from core.interpreter.sinumerik.setup.spindle_and_dwell import (
    dwell,
    live_tool,
    live_words,
    spindle_words,
    turns_spindle,
)
from core.interpreter.sinumerik.setup.tools_and_edges import tool_words
from core.interpreter.sinumerik.sinumerik_state import ARCS, TAPS, THREADS, State
from core.interpreter.sinumerik.sinumerik_statement import Statement, statement_of
from core.language.diagnostics import Diagnostic, ProgramError, Severity
from core.language.sinumerik.control_differences import lacking
from core.language.sinumerik.cycle_names import CYCLES, CYCLES_TAKEN, SWIVELS
from core.language.sinumerik.sinumerik_alarms import NOT_DEFINED
from core.language.sinumerik.sinumerik_words import ARC, Line, Word
from core.language.sinumerik.subprogram_files import HEADER
from core.language.sinumerik.word_table import (
    BLOCKWISE,
    DWELL,
    EXACT_ONCE,
    IDLE,
    SUPPRESSION,
    TRANSFORMATION,
)
from core.language.source import Source
from core.message import Message

# Codes of findings that depend on position and modal state, which are unknown after an invalid block.
_ENDS = frozenset({2, 17, 30})
_NO_AXIS = re.compile(r"this lathe has no (?:axis )?([A-Z][0-9]?)\b")
_ARC_IN_Y = re.compile(r": J: an arc in G18 uses I and K")
_BEHIND_ERROR = 20_000
"""Lines that are gone through behind the first error, for others that it may hide."""

_BY_STATE = frozenset(
    {
        *("14040", "arc-radius", "arc-no-chord", "10720", "corner-too-large", "corner-next"),
        *("10860", "g95-spindle-stopped", "dwell-spindle-stopped", "speed-missing", "surface-speed-missing"),
        *("word-unused", str(NOT_DEFINED)),
    }
)


class Interpreter(LinePass[Line]):
    """One pass through a SINUMERIK program and its subprograms."""

    def __init__(self, source: Source, setup: Setup) -> None:
        super().__init__(Log())
        self._source = source
        self._state = State(setup, self._log)
        self._corners = Corners(self._state, self._log)
        self._compensation = Compensation(self._state, self._log)
        self._flow = Flow(source, self._state)
        self._setup = setup
        self._no_axis: set[str] = set()  # missing axes that were already reported
        if setup.begin is not None:
            self._go_on_from(setup.begin)

    @cached_property
    def source_blocks(self) -> int:
        """Number of lines that contain more than a comment."""
        return sum(
            bool(line.split(";", 1)[0].strip()) and HEADER.fullmatch(line) is None
            for line in self._source.lines
        )

    @property
    def modal(self) -> Modal:
        """Modal state after the last generated block."""
        return self._state.modal

    def blocks(self, *, to_first_error: bool = False) -> Iterator[Block]:
        """Return an iterator that generates the elementary blocks. Call this method once."""
        yield from self._approach
        for block in self._pass():
            if not self._stopped:
                self._made += 1
                block.n = self._made
                yield block
            elif to_first_error:
                return

    # --- start from a saved state: MDI and block search
    # ------------------------------------------------------

    @property
    def checkpoint(self) -> Checkpoint:
        """State that the next block inherits."""
        parts = Parts(self._state, self._corners, self._flow, self._taken)
        return checkpoint_of(parts, (self._setup, self._log, *self._flow.routines), self._made)

    @property
    def _transformed(self) -> Transformation | None:
        """The active TRANSMIT or TRACYL, or None."""
        plane = self._state.transformation
        return plane if isinstance(plane, Transformation) else None

    @property
    def waits_for(self) -> str:
        """Reason why no other pass can continue from here; empty if one can."""
        if self._transformed is not None:
            where = Message(
                "the line is part of a corner or a contour in {transformed}; start before the approach",
                transformed=self._transformed.name,
            )
            return where if self._transformed.holds else ""
        if self._compensation.holds:
            return "the line is part of a G41 or G42 contour; start before the approach"
        return "the previous block is part of an unfinished corner" if self._corners.holds else ""

    def _go_on_from(self, begin: Begin) -> None:
        """Restore the state that the block of ``begin`` inherits."""
        kept = begin.checkpoint.kept
        if kept is not None:
            parts: Parts = kept.parts(self._setup, self._log)
            self._state, self._corners = parts.state, parts.corners
            self._compensation = Compensation(self._state, self._log)
            if not begin.single:
                self._flow, self._taken = parts.flow, parts.taken
        take_up(self._state, begin)
        if self._transformed is not None:
            self._transformed.stand()
        self._made = 0 if begin.single else begin.checkpoint.blocks
        if begin.single:
            problem = needs_others(self._source, self._setup.limits.third_axis)
            if problem is not None:
                self._log.add(problem)
                self._flow.end_all()
        state = self._state
        self._approach = approach_blocks(begin, state.modal, state.setup.start, state.rpm_at)

    def _can_stop(self, line: Line) -> bool:
        return line.executable and not self._flow.outside and not self._deleted(line)

    def _deleted(self, line: Line) -> bool:
        return line.skip is not None and self._state.setup.block_delete

    def _pass(self) -> Iterator[Block]:
        for line in self._lines(self._flow.next):
            if line.executable and not self._deleted(line):
                yield from self._line(line)
            if self._log.full:
                break
        if not self.stopped_before and self._left >= 0:
            yield from self._ended()

    def _line(self, line: Line) -> Iterator[Block]:
        """Yield the blocks of a line; no blocks follow an error."""
        for found in line.errors:
            self._refuse(found)
        if line.errors:
            return
        try:
            self._check_control(line)
            if line.call or line.modal_call:
                yield from self._call(line)
                return
            if line.jump is not None:
                self._flow.steer(line, line.jump, self._state)
                return
            statement = statement_of(line)
            ends = ends_main(statement, called=self._flow.called)
            yield from self._with_corners(statement)
            if state_call := self._modal_call(statement):
                yield from self._call(state_call, modal=True)
        except ProgramError as problem:
            if (
                problem.diagnostic.code != ENDLESS or not self._stopped
            ):  # otherwise, it may be a consequence of an earlier error
                self._refuse(problem.diagnostic)
            ends = False
            if problem.diagnostic.code in {"recursion", ENDLESS}:
                self._flow.end_all()
        self._steer(line, ends=ends)

    def _check_control(self, line: Line) -> None:
        """Raise ProgramError for a function that the control of the machine file lacks."""
        control = self._setup.limits.control
        if found := lacking(control, line):
            name, column = found
            text = Message(
                "{name} is not a function of the SINUMERIK {control} on this machine.",
                name=name,
                control=control.upper(),
            )
            hint = 'Use a different function, or correct "control" under [machine] in the machine file.'
            raise line.refuse(column, "not-in-control", text, hint)

    def _call(self, line: Line, *, modal: bool = False) -> Iterator[Block]:
        """Yield the blocks of a cycle, or enter a subprogram.

        MCALL only stores the call. Raises ProgramError.
        """
        if line.modal_call and not modal:
            self._state.modal_call = line if line.call else None
            return
        if line.call in CYCLES_TAKEN and not self._flow.knows(line.call):
            self._taken_cycle(line)
            return
        if line.call not in CYCLES or self._flow.knows(line.call):
            self._flow.call(line, modal=modal)
            return
        if line.call in PATTERNS:
            yield from self._pattern(line)
            return
        place = self._flow.shown_line(line.number)
        for block in cycle_blocks(self._state, line, self._flow):
            yield from self._through(block if place == line.number else replace(block, line=place), None)

    def _taken_cycle(self, line: Line) -> None:
        """Note once that a cycle has no effect here.

        Raises ProgramError if its parameters are not supported.
        """
        if line.call == SWIVELS and any(each.given for each in line.arguments or ()):
            text = "CYCLE800: this lathe has no swivel head."
            raise line.refuse(line.call_column, "not-in-subset", text, "Remove this text from the program.")
        if line.call not in self._state.told:
            self._state.told.add(line.call)
            why = Message("{name} has no effect because {why}.", name=line.call, why=CYCLES_TAKEN[line.call])
            found = line.refuse(line.call_column, "no-effect", why, "").diagnostic
            self._log.add(replace(found, severity=Severity.NOTE))

    def _pattern(self, line: Line) -> Iterator[Block]:
        """Yield the blocks of HOLES1 or HOLES2: the cycle of MCALL at each position. Raises ProgramError."""
        state, called = self._state, self._state.modal_call
        if called is None or called.call not in CYCLES or self._flow.knows(called.call):
            raise no_cycle(line)
        place = self._flow.shown_line(line.number)
        for over in places(state, line):
            yield from self._through(replace(over, line=place), None)
            yield from self._call(called, modal=True)

    def _modal_call(self, statement: Statement) -> Line | None:
        """Return the line of MCALL that acts after this block; None without MCALL or without a motion."""
        return None if self._flow.by_modal_call or not statement.axes else self._state.modal_call

    def _steer(self, line: Line, *, ends: bool) -> None:
        """Execute M2, M17 and M30 after all other words of their block."""
        if ends:
            self._flow.end_all()
        elif self._flow.called and any(word.name == "M" and word.value in _ENDS for word in line.words):
            self._flow.back()

    def _with_corners(self, statement: Statement) -> Iterator[Block]:
        """Yield the blocks of a statement, with all corners that are complete."""
        number = statement.line.number
        place = self._flow.shown_line(number)
        if TRANSFORMATION in statement.g:
            yield from self._nothing_held()
        for block in self._blocks(statement):
            corner, plane = None, self._transformed
            if block.moves:
                corner = corner_of(self._state, statement, block) if plane is None else plane.corner(block)
            yield from self._through(block if place == number else replace(block, line=place), corner)

    def _through(self, block: Block, corner: Corner | None) -> Iterator[Block]:
        """Yield the results of a block after the corner and compensation stages of the active plane."""
        if self._transformed is not None:
            yield from self._transformed.take(block, corner)
            return
        for cut in self._corners.take(block, corner):
            yield from self._compensation.take(cut)

    def _nothing_held(self) -> Iterator[Block]:
        """Yield the buffered blocks, because no move follows for their corner."""
        if self._transformed is not None:
            yield from self._transformed.settle()
            return
        for cut in self._corners.end():
            yield from self._compensation.take(cut)

    def _blocks(self, statement: Statement) -> Iterator[Block]:
        """Yield the blocks of a statement in the order of execution: modes, tool, spindle, motion, stops."""
        state = self._state
        _set_parameters(state, statement)
        check_y(state, statement)
        if statement.frame_key is not None:
            if self._transformed is not None:
                self._transformed.frame(statement)
            else:
                programmed_frame(state, statement)
            return
        live_words(state, statement)
        check_m(state, statement, self._lacking)
        if statement.g:
            modes(state, statement)
        if statement.g or not IDLE.keys().isdisjoint(statement.words):
            tell_idle_words(state, statement)
        feed_words(state, statement)
        if DWELL in statement.g:
            yield dwell(state, statement)
            return
        if statement.words:
            yield from tool_words(state, statement, self._tools)
        yield from live_tool(state, statement)
        if turns_spindle(statement):
            yield from spindle_words(state, statement)
        if statement.m:
            yield from functions_before(state, statement)
        yield from self._motion(statement)
        if statement.m:
            yield from functions_after(state, statement)
            yield from self._stops(statement)

    def _motion(self, statement: Statement) -> Iterator[Block]:
        """Yield the move of a statement."""
        state = self._state
        if TRANSFORMATION in statement.g:
            yield from transform(state, self._log, statement)
        elif self._transformed is not None:
            yield from self._transformed.moves(statement)
        else:
            yield from self._of_slides(statement)

    def _of_slides(self, statement: Statement) -> Iterator[Block]:
        """Yield the move of a statement with the lathe's axes, without a transformation."""
        state = self._state
        if frame_block(state, statement):
            return
        if statement.code(BLOCKWISE) == 74:
            yield home(state, statement)
        elif statement.code(BLOCKWISE) == 75:
            yield fixed_point(state, statement)
        elif word := statement.words.get("FP") or statement.words.get("OFFN"):
            of = "G75" if word.name == "FP" else "TRANSMIT"
            raise statement.refuse(
                word,
                "word-unused",
                Message("{word} can be used only with {total}.", word=word.text, total=of),
                "Remove this text from the program.",
            )
        elif statement.moves or (ARC & statement.words.keys()):
            yield from self._move(statement)
        elif word := statement.g.get(SUPPRESSION):
            text = Message("{word} is effective only in a block that moves an axis.", word=word.text)
            raise statement.refuse(word, "word-unused", text, "Add the axes to the block.")
        else:
            return
        if state.exact or EXACT_ONCE in statement.g:
            yield state.action(statement.line.number, "G60" if state.exact else "G9", Dwell(0.0))

    def _move(self, statement: Statement) -> Iterator[Block]:
        state = self._state
        if state.motion in THREADS:
            yield from thread(state, statement)
            return
        state.threads = ()
        if state.motion in TAPS:
            yield tap(state, statement)
        else:
            yield arc(state, statement) if state.motion in ARCS else straight(state, statement)

    def _stops(self, statement: Statement) -> Iterator[Block]:
        """Yield the blocks of M0, M1 and the program end."""
        state, line = self._state, statement.line
        for code in (0, 1):
            if code in statement.m:
                yield state.action(line.number, f"M{code}", ProgramStop(optional=code == 1))
        if statement.ends and not self._flow.called:
            leave_offsets(state)
            state.adopt(state.modal._replace(spindle=0, oriented=None))
            code = next(code for code in (2, 17, 30) if code in statement.m)
            yield state.action(line.number, f"M{code}", ProgramEnd(reset=True))

    def _ended(self) -> Iterator[Block]:
        """Yield the last blocks after the last line."""
        try:
            yield from self._nothing_held()
            if self._transformed is not None:
                yield from self._transformed.end()
            yield from self._compensation.end()
        except ProgramError as problem:
            self._refuse(problem.diagnostic)

    def _refuse(self, found: Diagnostic) -> None:
        """Log the error, unless it is only a consequence of an earlier error."""
        follows = found.code in _BY_STATE or found.code.startswith("comp-")
        if not (self._stopped and follows) and not self._axis_is_told(found):
            self._log.add(self._flow.located(found))
        self._stopped = True
        self._left = min(self._left, _BEHIND_ERROR + 1)
        self._corners.drop()
        self._compensation.drop()
        if self._transformed is not None:
            self._transformed.drop()

    def _axis_is_told(self, found: Diagnostic) -> bool:
        """Return whether a finding reports a missing axis that was already reported.

        A program for a mill names this axis in many lines. J belongs to arcs in Y.
        """
        match = _NO_AXIS.search(found.message)
        axis = "Y" if _ARC_IN_Y.search(found.message) else match[1] if match else ""
        if not axis:
            return False
        told = axis in self._no_axis
        self._no_axis.add(axis)
        return told

    def _never_ends(self, line: Line) -> None:
        if self._stopped and self._left < 0:
            return  # A loop with an invalid condition does not end, and its error is already reported.
        text = Message(
            "the program exceeds the limit of {most_blocks} blocks or {most_lines} executed lines.",
            most_blocks=f"{MOST_BLOCKS:,}",
            most_lines=f"{MOST_LINES:,}",
        )
        hint = "Check the loops, and reduce the repeat counts of the calls."
        self._refuse(line.refuse(0, "too-many-blocks", text, hint).diagnostic)


def _set_parameters(state: State, statement: Statement) -> None:
    """Set the R parameters and variables of a block. Raises ProgramError for an undefined name."""
    for word in statement.sets:
        name = _place(state, statement, word)
        if word.values is not None:
            _fill(state, statement, word, name)
        elif not state.variables.keep(name, state.number(statement, word)):
            raise _no_place(state, statement, word, name)


def _no_place(state: State, statement: Statement, word: Word, name: str) -> ProgramError:
    if word.name in state.variables.scope.sizes:
        return statement.refuse(word, *state.variables.missing(word.name, name))
    text = Message(
        "the name {name} is not defined: it is neither a word nor a variable of this program.", name=name
    )
    return statement.refuse(
        word, NOT_DEFINED, text, Message("Write DEF REAL {word} before this block.", word=word.name)
    )


def _fill(state: State, statement: Statement, word: Word, name: str) -> None:
    """Execute SET and REP from an element on. Raises ProgramError if the array is too short."""
    letters = "R" if word.name == "R0" else word.name
    if name not in state.variables.scope.numbers and letters != "R":
        raise _no_place(state, statement, word, name)

    assert word.values is not None
    refuse = partial(statement.refuse, word)
    left = state.variables.fill(letters, name, word.values, lambda asked: state.worth(asked, refuse))
    if left:
        text = Message(
            "{word}: the array needs {left} more elements for this list.", word=word.text, left=left
        )
        raise refuse("array-values", text, "Shorten the list.")


def _place(state: State, statement: Statement, word: Word) -> str:
    """Return the name that the word assigns: R7, LENGTH, or an element of an array."""
    if word.element is None:
        return word.name
    refuse = partial(statement.refuse, word)
    letters = "R" if word.name == "R0" else word.name
    return place_name(letters, word.element, lambda index: state.worth(index, refuse), refuse)
