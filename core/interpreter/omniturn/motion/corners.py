"""Corners with C and R, and the stages from the moves of the lines to blocks: corners, then compensation."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from core.geometry.chamfer_and_rounding import CornerError, chamfer, rounding
from core.geometry.lines_and_arcs import Element
from core.interpreter.omniturn.codes.code_rules import check_together, check_when, checked
from core.interpreter.omniturn.codes.code_table import LETTERS
from core.interpreter.omniturn.motion.move_words import WordedMoves
from core.interpreter.omniturn.motion.nose_compensation import (
    Compensation,
    check_approach,
    check_under_nose,
    nose_radius,
)
from core.interpreter.omniturn.motion.straight_moves import on_step
from core.interpreter.omniturn.omniturn_state import CompensationSwitch, Corner, Item, State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.actions import AskInput, Preset, ProgramEnd, ToolChange
from core.interpreter.shared.contour_stage import STRAIGHT, AdjustedMoves, CornerStage, HeldMove, element_of
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.language.diagnostics import ProgramError, program_error
from core.language.omniturn import Word
from core.message import Message

_PARTS = ProgramEnd | ToolChange | Preset | AskInput
"""Actions across which no corner reaches: the program ends, its numbers mean another
point, or all motion before it must have ended."""


def read_corner(state: State, statement: Statement) -> None:
    """Store the corner of a line after its straight move. Raises ProgramError for an invalid size.

    A C word is a corner unless C is an axis.
    """
    chamfers = None if state.modal.c_locked else statement.words.get("C")
    word = statement.words.get("R") or chamfers
    if word is None:
        return
    if chamfers is not None:
        check_together(statement, LETTERS["C"])
    size = corner_size(state, statement, word)
    state.contour.corner = Corner(word.letter, size, word.column)
    state.contour.active, state.fast = True, False


def corner_size(state: State, statement: Statement, word: Word) -> float:
    """Return the size of a corner in mm. Raises ProgramError if it is invalid."""
    size = on_step(state, statement, word.letter)
    return checked(state, statement, word.letter, size or 0.0, LETTERS[word.letter]) or 0.0


def refuse_radius(state: State, statement: Statement) -> None:
    """Raise ProgramError for R on a line without a straight move of only X and Z."""
    word = statement.words.get("R")
    if word is not None:
        check_when(state, statement, LETTERS["R"], word=word)


_Held = HeldMove[Corner, CompensationSwitch]


class Corners(CornerStage[Corner, CompensationSwitch]):
    """Corner stage for corners between two straight moves."""

    def __init__(self, log: Log, moves: AdjustedMoves) -> None:
        super().__init__(moves)
        self._log = log

    def check(self, statement: Statement) -> None:
        """Raise ProgramError if a corner waits for a move and the line does not begin with a plain move."""
        held = self._held
        if held is not None and statement.one_shot is not None and not statement.entry.before_corner:
            what = statement.code.text if statement.code is not None else "the motion"
            text = Message("{what} on line {line} is not a straight move", what=what, line=statement.line)
            raise _refused(held, "corner-next", text)

    def end(self) -> None:
        """Check the end of the program. Raises ProgramError if a corner remains."""
        held, self._held = self._held, None
        if held is not None:
            raise _refused(held, "corner-next", "no move follows the corner")

    def _waits(self, held: _Held, item: Item) -> bool:
        if isinstance(item, CompensationSwitch):
            if item.code == 40:
                raise _refused(held, "corner-next", "nose compensation ends before the next move")
            return True
        if isinstance(item.action, _PARTS):
            text = Message("no move is programmed between the corner and {item}", item=item.text)
            raise _refused(held, "corner-next", text)
        return item.action is not None

    def _meets(self, held: _Held, after: Block) -> bool:
        if after.kind in STRAIGHT and after.c == after.c0:
            return True
        template = (
            "the next move, on line {line}, is an arc"
            if after.kind is Kind.ARC
            else "the next move, on line {line}, is not a straight line"
        )
        raise _refused(held, "corner-next", Message(template, line=after.line))

    def _elements(self, corner: Corner, first: Element, last: Element) -> Sequence[Element]:
        return (chamfer if corner.letter == "C" else rounding)(first, last, corner.size)

    def _tell_straight(self, held: _Held, after: Block) -> None:
        text = Message(
            "The moves on lines {line} and {line2} are in the same direction, so they do not form a corner.",
            line=held.block.line,
            line2=after.line,
        )
        self._warn(held, text)

    def _warn(self, held: _Held, text: str) -> None:
        hint = "Remove C or R."
        self._log.warn(held.block.line, held.corner.column, "corner-straight", text, hint)

    def _too_large(self, held: _Held, of: Block, needed: float) -> ProgramError:
        if not needed:
            text = Message("the move on line {line} has zero length", line=of.line)
            return _refused(held, "corner-too-large", text)
        modal = held.block.modal
        text = Message(
            "the corner needs {needed} of the move on line {line}, but only {left} remains",
            needed=modal.length_text(needed),
            line=of.line,
            left=modal.length_text(element_of(of).length),
        )
        return _refused(held, "corner-too-large", text)

    def _impossible(self, held: _Held, after: Block, problem: CornerError) -> ProgramError:
        text = Message("{problem} (line {line})", problem=problem, line=after.line)
        return _refused(held, "corner-next", text)


class ContourCorners(Corners):
    """Corner stage for the contour of a cycle."""

    def cut(self, moves: Iterable[tuple[Block, Corner | None]]) -> list[Block]:
        """Return the moves with their corners inserted. Raises ProgramError if a corner is not possible."""
        found = [each for move in moves for each in self.take(*move) if isinstance(each, Block)]
        if self._held is not None:
            raise _refused(self._held, "corner-next", "the contour ends at this corner")
        return found

    def _meets(self, held: _Held, after: Block) -> bool:
        if after.kind is Kind.ARC:
            raise _refused(held, "corner-next", "the next move is an arc")
        return True

    def _tell_straight(self, held: _Held, after: Block) -> None:
        del after
        self._warn(held, "The two moves are in the same direction, so they do not form a corner.")

    def _too_large(self, held: _Held, of: Block, needed: float) -> ProgramError:
        template = (
            "the corner needs {needed} of this move, but only {left} remains"
            if of is held.block
            else "the corner needs {needed} of the next move, but only {left} remains"
        )
        shown, left = (held.block.modal.length_text(each) for each in (needed, element_of(of).length))
        return _refused(held, "corner-too-large", Message(template, needed=shown, left=left))

    def _impossible(self, held: _Held, after: Block, problem: CornerError) -> ProgramError:
        del after
        return _refused(held, "corner-next", str(problem))


def _refused(held: _Held, code: str, why: str) -> ProgramError:
    hint = (
        "Use a smaller chamfer or radius."
        if code == "corner-too-large"
        else "A chamfer or corner radius needs two consecutive straight moves."
    )
    text = Message("Corner {letter} is not possible: {why}.", letter=held.corner.letter, why=why)
    return program_error(held.block.line, held.corner.column, code, text, hint)


class ContourModifier:
    """Buffer of blocks while a corner waits for its second move or nose compensation is on.

    It buffers at most one corner and the moves that compensation looks ahead. The returned blocks are
    numbered without a gap.
    """

    def __init__(self, state: State) -> None:
        self._state = state
        moves = WordedMoves(state.setup.limits.max_rpm)
        self._corners = Corners(state.log, moves)
        self._nose = Compensation(state.log, moves)
        self._count: int | None = None  # number of the last returned block while the modifier is active

    def take(self, block: Block) -> Iterator[Block]:
        """Accept a block, and yield the blocks that no later line can change.

        Raises ProgramError if the corner or the compensation is not possible.
        """
        state = self._state
        corner, state.contour.corner = state.contour.corner, None
        self._begin(block.n - 1)
        if block.moves and state.contour.approach:
            check_approach(state, block)
            self._nose.radius = nose_radius(state)
        yield from self._put(block, corner)

    def check(self, statement: Statement) -> None:
        """Raise ProgramError if a line is not allowed after the buffered moves."""
        if self._state.contour.active:
            self._corners.check(statement)
            check_under_nose(self._state, statement)

    def switch(self, switch: CompensationSwitch) -> Iterator[Block]:
        """Process G41, G42 or G40, and yield the blocks that no later line can change.

        Raises ProgramError if compensation is not possible.
        """
        self._begin(self._state.blocks)
        yield from self._put(switch, None)

    def end(self) -> Iterator[Block]:
        """Process the end of the program. Raises ProgramError if a corner still waits for its second move."""
        self._corners.end()
        yield from ()

    def drop(self) -> None:
        """Discard all buffered blocks after an error."""
        self._corners.drop()
        self._nose.drop()
        self._count = None
        self._state.contour.active = False
        self._state.contour.corner = None
        self._state.contour.approach = 0

    def _begin(self, count: int) -> None:
        if self._count is None:
            self._count = count

    def _put(self, item: Item, corner: Corner | None) -> Iterator[Block]:
        state = self._state
        count = self._count or 0
        for item_cut in self._corners.take(item, corner):
            for block in self._nose.take(item_cut):
                count += 1
                block.n = count
                self._count = count
                yield block
        state.contour.active = self._corners.holds or self._nose.active
        if not state.contour.active:
            state.blocks = count
            state.contour.approach = 0  # A T may have canceled compensation before its approach.
            self._count = None
