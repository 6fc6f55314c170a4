"""Corners with C and R, and the stages between the moves of lines and the final blocks.

The first stage inserts corners, and the second stage applies nose compensation.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from core.geometry.chamfer_and_rounding import CornerError, chamfer, make_rounding
from core.geometry.lines_and_arcs import Element
from core.interpreter.omniturn.codes.code_rules import check_conditions, check_word_groups, check_word_number
from core.interpreter.omniturn.codes.code_table import LETTER_ENTRIES
from core.interpreter.omniturn.motion.move_words import OmniturnMoveFactory
from core.interpreter.omniturn.motion.nose_compensation import (
    CompensationStage,
    check_approach_move,
    check_compensated_line,
    get_nose_radius_mm,
)
from core.interpreter.omniturn.motion.straight_moves import round_to_resolution
from core.interpreter.omniturn.omniturn_state import CompensationSwitch, Corner, StageItem, State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.actions import InputRead, Preset, ProgramEnd, ToolChange
from core.interpreter.shared.contour_stage import (
    STRAIGHT_KINDS,
    AdjustedMoveFactory,
    BufferedMove,
    CornerStage,
    make_element,
)
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.diagnostics import ProgramError, make_program_error
from core.language.omniturn import Word
from core.message import Message

_PARTS = ProgramEnd | ToolChange | Preset | InputRead
"""Actions that a corner cannot span.

Each action ends the program, changes the reference point, or waits until all earlier motion has ended.
"""


def read_corner(state: State, statement: Statement) -> None:
    """Store the corner that a line programs at the end of its straight move.

    A C word is a corner unless C is an axis. Raises ProgramError for an invalid size, or if the line has
    both C and R as corners.
    """
    chamfers = None if state.modal.c_locked else statement.words.get("C")
    word = statement.words.get("R") or chamfers
    if word is None:
        return
    if chamfers is not None:
        check_word_groups(statement, LETTER_ENTRIES["C"])
    size = read_corner_size_mm(state, statement, word)
    state.contour.pending_corner = Corner(word.letter, size, word.column)
    state.contour.is_buffering, state.fast = True, False


def read_corner_size_mm(state: State, statement: Statement, word: Word) -> float:
    """Return the size of a corner in mm. Raises ProgramError if the size is invalid."""
    size = round_to_resolution(state, statement, word.letter)
    return check_word_number(state, statement, word.letter, size or 0.0, LETTER_ENTRIES[word.letter]) or 0.0


def check_radius_word(state: State, statement: Statement) -> None:
    """Raise ProgramError if R of a line would have to be a corner but cannot be one.

    Call this function only for lines that are not a straight move of only X and Z.
    """
    word = statement.words.get("R")
    if word is not None:
        check_conditions(state, statement, LETTER_ENTRIES["R"], word=word)


_BufferedMove = BufferedMove[Corner, CompensationSwitch]


class LineCornerStage(CornerStage[Corner, CompensationSwitch]):
    """Stage that inserts corners between two straight moves."""

    def __init__(self, log: DiagnosticLog, moves: AdjustedMoveFactory) -> None:
        super().__init__(moves)
        self._log = log

    def check_line(self, statement: Statement) -> None:
        """Raise ProgramError if a line must not follow a move with a corner.

        A corner may need a following move. A line with a one-shot code that is not allowed there is then an
        error.
        """
        held = self._held
        if (
            held is not None
            and statement.one_shot_code is not None
            and not statement.code_entry.is_allowed_after_corner
        ):
            what = statement.code_word.text if statement.code_word is not None else "the motion"
            text = Message("{what} on line {line} is not a straight move", what=what, line=statement.line)
            raise _refused(held, "corner-next", text)

    def check_program_end(self) -> None:
        """Raise ProgramError if the program ends before the second move of a corner."""
        held, self._held = self._held, None
        if held is not None:
            raise _refused(held, "corner-next", "no move follows the corner")

    def _keeps_waiting(self, buffered: _BufferedMove, item: StageItem) -> bool:
        if isinstance(item, CompensationSwitch):
            if item.g_code == 40:
                raise _refused(buffered, "corner-next", "nose compensation ends before the next move")
            return True
        if isinstance(item.action, _PARTS):
            text = Message("no move is programmed between the corner and {item}", item=item.text)
            raise _refused(buffered, "corner-next", text)
        return item.action is not None

    def _forms_corner(self, buffered: _BufferedMove, after: Block) -> bool:
        if after.kind in STRAIGHT_KINDS and after.c == after.c0:
            return True
        template = (
            "the next move, on line {line}, is an arc"
            if after.kind is BlockKind.ARC
            else "the next move, on line {line}, is not a straight line"
        )
        raise _refused(buffered, "corner-next", Message(template, line=after.line))

    def _elements(self, corner: Corner, first: Element, last: Element) -> Sequence[Element]:
        return (chamfer if corner.letter == "C" else make_rounding)(first, last, corner.size_mm)

    def _report_straight(self, buffered: _BufferedMove, after: Block) -> None:
        text = Message(
            "The moves on lines {line} and {line2} are in the same direction, so they do not form a corner.",
            line=buffered.block.line,
            line2=after.line,
        )
        self._warn(buffered, text)

    def _warn(self, held: _BufferedMove, text: str) -> None:
        hint = "Remove C or R."
        self._log.add_warning(held.block.line, held.corner.column, "corner-straight", text, hint)

    def _make_size_error(self, buffered: _BufferedMove, block: Block, needed_mm: float) -> ProgramError:
        if not needed_mm:
            text = Message("the move on line {line} has zero length", line=block.line)
            return _refused(buffered, "corner-too-large", text)
        modal = buffered.block.modal
        text = Message(
            "the corner needs {needed} of the move on line {line}, but only {left} remains",
            needed=modal.format_length(needed_mm),
            line=block.line,
            left=modal.format_length(make_element(block).length),
        )
        return _refused(buffered, "corner-too-large", text)

    def _make_corner_error(self, buffered: _BufferedMove, after: Block, problem: CornerError) -> ProgramError:
        text = Message("{problem} (line {line})", problem=problem, line=after.line)
        return _refused(buffered, "corner-next", text)


class ContourCornerStage(LineCornerStage):
    """Stage that inserts corners into the contour of a cycle."""

    def insert_corners(self, moves: Iterable[tuple[Block, Corner | None]]) -> list[Block]:
        """Return the moves with their corners inserted. Raises ProgramError if a corner is not possible."""
        found = [each for move in moves for each in self.accept_item(*move) if isinstance(each, Block)]
        if self._held is not None:
            raise _refused(self._held, "corner-next", "the contour ends at this corner")
        return found

    def _forms_corner(self, buffered: _BufferedMove, after: Block) -> bool:
        if after.kind is BlockKind.ARC:
            raise _refused(buffered, "corner-next", "the next move is an arc")
        return True

    def _report_straight(self, buffered: _BufferedMove, after: Block) -> None:
        del after
        self._warn(buffered, "The two moves are in the same direction, so they do not form a corner.")

    def _make_size_error(self, buffered: _BufferedMove, block: Block, needed_mm: float) -> ProgramError:
        template = (
            "the corner needs {needed} of this move, but only {left} remains"
            if block is buffered.block
            else "the corner needs {needed} of the next move, but only {left} remains"
        )
        shown, left = (
            buffered.block.modal.format_length(each) for each in (needed_mm, make_element(block).length)
        )
        return _refused(buffered, "corner-too-large", Message(template, needed=shown, left=left))

    def _make_corner_error(self, buffered: _BufferedMove, after: Block, problem: CornerError) -> ProgramError:
        del after
        return _refused(buffered, "corner-next", str(problem))


def _refused(held: _BufferedMove, code: str, why: str) -> ProgramError:
    hint = (
        "Use a smaller chamfer or radius."
        if code == "corner-too-large"
        else "A chamfer or corner radius needs two consecutive straight moves."
    )
    text = Message("Corner {letter} is not possible: {why}.", letter=held.corner.letter, why=why)
    return make_program_error(held.block.line, held.corner.column, code, text, hint)


class ContourBuffer:
    """Buffer of blocks that later lines may still change, because of a corner or nose compensation.

    It contains at most one corner, and the moves that compensation needs to look ahead. The returned blocks
    are numbered consecutively.
    """

    def __init__(self, state: State) -> None:
        self._state = state
        moves = OmniturnMoveFactory(state.setup.limits.max_rpm)
        self._corners = LineCornerStage(state.log, moves)
        self._nose = CompensationStage(state.log, moves)
        self._count: int | None = None  # number of the last returned block while the modifier is active

    def accept_block(self, block: Block) -> Iterator[Block]:
        """Accept a block, and yield the blocks that no later line can change.

        Raises ProgramError if the corner or the compensation is not possible.
        """
        state = self._state
        corner, state.contour.pending_corner = state.contour.pending_corner, None
        self._begin(block.n - 1)
        if block.moves and state.contour.approach_line:
            check_approach_move(state, block)
            self._nose.nose_radius_mm = get_nose_radius_mm(state)
        yield from self._put(block, corner)

    def check_line(self, statement: Statement) -> None:
        """Raise ProgramError if a line must not follow the buffered moves."""
        if self._state.contour.is_buffering:
            self._corners.check_line(statement)
            check_compensated_line(self._state, statement)

    def switch_compensation(self, switch: CompensationSwitch) -> Iterator[Block]:
        """Process G41, G42 or G40, and yield the blocks that no later line can change.

        Raises ProgramError if compensation is not possible.
        """
        self._begin(self._state.blocks)
        yield from self._put(switch, None)

    def check_program_end(self) -> Iterator[Block]:
        """Process the end of the program. Raises ProgramError if a corner has no second move."""
        self._corners.check_program_end()
        yield from ()

    def discard_blocks(self) -> None:
        """Discard all buffered blocks after an error."""
        self._corners.discard_move()
        self._nose.discard_moves()
        self._count = None
        self._state.contour.is_buffering = False
        self._state.contour.pending_corner = None
        self._state.contour.approach_line = 0

    def _begin(self, count: int) -> None:
        if self._count is None:
            self._count = count

    def _put(self, item: StageItem, corner: Corner | None) -> Iterator[Block]:
        state = self._state
        count = self._count or 0
        for item_cut in self._corners.accept_item(item, corner):
            for block in self._nose.accept_item(item_cut):
                count += 1
                block.n = count
                self._count = count
                yield block
        state.contour.is_buffering = self._corners.has_buffered_move or self._nose.is_active
        if not state.contour.is_buffering:
            state.blocks = count
            state.contour.approach_line = 0  # A T may have canceled compensation before its approach.
            self._count = None
