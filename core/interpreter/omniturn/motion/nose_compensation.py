"""Nose compensation with G41, G42 and G40.

This module checks the permitted words and calculates the path of the tool nose along the contour.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from math import dist
from typing import NamedTuple

from core.geometry.contour_offset import GOUGE_CHECK_ELEMENT_COUNT
from core.geometry.lines_and_arcs import (
    SAME_POINT_TOLERANCE_MM,
    Element,
    Line,
    Point,
    compute_distance_to_point,
)
from core.interpreter.omniturn.codes.code_rules import check_conditions
from core.interpreter.omniturn.codes.code_table import FLOW_CODES, G_CODES
from core.interpreter.omniturn.omniturn_state import CompensationSwitch, StageItem, State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.actions import ToolChange
from core.interpreter.shared.contour_stage import (
    CONTOUR_KINDS,
    STRAIGHT_KINDS,
    AdjustedMoveFactory,
    ContourMove,
    ContourStage,
    is_gouging_contour,
    make_element,
)
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.diagnostics import ProgramError, make_program_error
from core.message import Message, fill_template

# --- approach and departure: distance from the part, and clearance


class ApproachOrDeparture(NamedTuple):
    """An approach to or departure from a contour.

    ``contour`` contains the adjacent moves of the contour, from the nearest to the farthest.
    """

    block: Block
    is_departure: bool
    compensation_code: int  # 41 or 42
    nose_radius_mm: float  # of the nose, mm
    contour: Sequence[Element]

    @property
    def name(self) -> str:
        """Return the name for messages, which is ``approach`` or ``departure``."""
        return "departure" if self.is_departure else "approach"

    def make_error(self, code_suffix: str, text: str, hint: str, /, **values: object) -> ProgramError:
        """Return an error for this approach or departure.

        ``code_suffix`` is the end of the diagnostic code.
        """
        return _refused(self.block, f"comp-{self.name}{code_suffix}", text, hint, **values)

    def check_path(self, path: Line, free_end: Point, corner: Point, log: DiagnosticLog) -> None:
        """Raise ProgramError if the move cuts the part or its free end is too close to the part.

        A distance below the nose radius is an error, and a distance below twice the radius is a warning.
        ``free_end`` is the programmed end of the move away from the contour. ``corner`` is its end on the
        contour.
        """
        if dist(free_end, corner) < self.nose_radius_mm - SAME_POINT_TOLERANCE_MM:
            raise self.make_error(
                "-short",
                "The {lead} move is {length} long, which is less than the nose radius of {nose}.",
                "Move farther away from the part.",
                lead=self.name,
                length=self.block.modal.format_length(dist(free_end, corner)),
                nose=self.block.modal.format_length(self.nose_radius_mm),
            )
        self._check_distance(
            min(compute_distance_to_point(element, free_end) for element in self.contour), log
        )
        if is_gouging_contour(path, self.contour, self.nose_radius_mm):
            text = "With G{code}, the tool nose cuts into the part during the {lead}."
            hint = "Choose a different path for the {lead}, or switch between G41 and G42."
            raise _refused(self.block, "comp-gouge", text, hint, code=self.compensation_code, lead=self.name)

    def _check_distance(self, off: float, log: DiagnosticLog) -> None:
        if off >= 2 * self.nose_radius_mm - SAME_POINT_TOLERANCE_MM:
            return
        length = self.block.modal.format_length
        near = off < self.nose_radius_mm - SAME_POINT_TOLERANCE_MM
        text = Message(
            _DISTANCE_TEXTS[self.is_departure, near], value=length(off), nose=length(self.nose_radius_mm)
        )
        hint = "Start the approach, or end the departure, at least twice the nose radius away from the part."
        if near:
            raise self.make_error("-near", text, hint)
        log.add_warning(self.block.line, 0, f"comp-{self.name}-near", text, hint)


_DISTANCE_TEXTS = {  # key: whether it is a departure, and whether it is closer than R
    (True, True): "The departure ends {value} from the part, which is less than the nose radius of {nose}.",
    (False, True): "The approach starts {value} from the part, which is less than the nose radius of {nose}.",
    (True, False): "The departure ends {value} from the part, which is less than twice the nose radius of "
    "{nose}.",
    (False, False): "The approach starts {value} from the part, which is less than twice the nose radius of "
    "{nose}.",
}


class _Contour(ContourStage):
    """Stage for the contour from G41 or G42 to G40.

    Both the contour and the compensated path include the secondary offset.
    """

    def __init__(
        self,
        moves: AdjustedMoveFactory,
        log: DiagnosticLog,
        switch: CompensationSwitch,
        approach: Block,
        radius: float,
    ) -> None:
        super().__init__(moves, approach, radius if switch.g_code == 41 else -radius)
        self._log, self._mark = log, switch
        self._first: list[Element] = []  # of the contour, near the approach
        self._recent: deque[Element] = deque(maxlen=GOUGE_CHECK_ELEMENT_COUNT)

    def add_move(self, block: Block) -> Iterator[Block]:
        """Add a move to the contour, and yield the blocks that no later move can change.

        The last move becomes the departure. Raises ProgramError if compensation is not possible.
        """
        if (
            block.kind is not BlockKind.ARC
            and dist((block.x0, block.z0), (block.x, block.z)) < SAME_POINT_TOLERANCE_MM
        ):
            self.last_move.following_blocks.append(block)
            return
        last, self.last_move = self.last_move, ContourMove(block)
        if last is self.approach_move:
            return
        element = make_element(last.block)
        if len(self._first) < GOUGE_CHECK_ELEMENT_COUNT:
            self._first.append(element)
        self._recent.append(element)
        yield from self._yield_pieces(self._add_move(last, element))

    def close_contour(self) -> Iterator[Block]:
        """Close the contour at G40, with the last move as the departure, and yield its blocks.

        Raises ProgramError if compensation is not possible.
        """
        if not self.move_count:
            text = "{name} has no contour move between its approach and its departure."
            hint = "Write the contour between the approach and the departure."
            raise _refused(self.last_move.block, "comp-empty", text, hint, name=self._mark.name)
        pieces = self._remaining_pieces()
        departure_path = Line(pieces[-1].element.end, (self.last_move.block.x, self.last_move.block.z))
        self._check_departure(departure_path)  # This check precedes the output of buffered blocks.
        yield from self._yield_pieces(pieces)
        yield from self._depart(self.last_move, [departure_path])

    def _approach_path(self, to: Point) -> Sequence[Element]:
        block, mark, modal = self.approach_move.block, self._mark, self.approach_move.block.modal
        begun = (
            block.x0 - mark.secondary_offset_x + modal.secondary_offset_x,
            block.z0 - mark.secondary_offset_z + modal.secondary_offset_z,
        )
        approach_path = Line((block.x0, block.z0), to)
        lead = ApproachOrDeparture(block, False, mark.g_code, self.nose_radius_mm, self._first)
        lead.check_path(approach_path, begun, (block.x, block.z), self._log)
        return [approach_path]

    def _check_departure(self, departure_path: Line) -> None:
        block, after = self.last_move.block, self.last_move.following_blocks
        contour = list(reversed(self._recent))
        lead = ApproachOrDeparture(block, True, self._mark.g_code, self.nose_radius_mm, contour)
        if any(each.moves for each in after):
            text = "The departure, the last move before G40, has zero length."
            raise lead._replace(block=after[-1]).make_error("-short", text, "Move off the part.")
        if block.kind not in STRAIGHT_KINDS:
            text = "The departure, the move before G40, is not a straight line."
            raise lead.make_error("", text, "Move off the part in a straight line.")
        lead.check_path(departure_path, departure_path.end, (block.x0, block.z0), self._log)

    def _make_gouge_error(self, block: Block, reason: str) -> ProgramError:
        text = Message(
            "{name} with a nose radius of {nose} cannot compensate this move: {why}.",
            name=self._mark.name,
            nose=block.modal.format_length(self.nose_radius_mm),
            why=reason,
        )
        return _refused(block, "comp-gouge", text, "Use a smaller nose radius, or change the contour.")


class CompensationStage:
    """Stage that buffers moves until their compensated paths are final."""

    def __init__(self, log: DiagnosticLog, moves: AdjustedMoveFactory) -> None:
        self._log, self._moves = log, moves
        self.discard_moves()

    @property
    def is_active(self) -> bool:
        """Return whether G41 or G42 is active."""
        return self._mark is not None

    def discard_moves(self) -> None:
        """Discard buffered moves and turn compensation off."""
        self._mark: CompensationSwitch | None = None
        self.nose_radius_mm = 0.0  # nose radius in mm, set at the approach
        self._contour: _Contour | None = None

    def accept_item(self, item: StageItem) -> Iterator[Block]:
        """Accept a block or a compensation code, and yield the blocks that cannot change any more.

        Raises ProgramError if compensation is not possible.
        """
        mark, contour = self._mark, self._contour
        if isinstance(item, CompensationSwitch):
            if mark is not None:
                yield from self._close()
            self._mark = None if item.g_code == 40 else item
        elif mark is None:
            yield item
        elif isinstance(item.action, ToolChange):
            yield from self._close()
            yield item
        elif item.action is not None:
            if contour is None:
                yield item
            else:
                contour.last_move.following_blocks.append(item)
        elif item.kind not in CONTOUR_KINDS or item.c != item.c0:
            text = "{name} cannot compensate this move."
            raise _refused(item, "comp-with", text, "Write G40 before this line.", name=mark.name)
        elif contour is None:
            self._contour = _Contour(self._moves, self._log, mark, item, self.nose_radius_mm)
        else:
            yield from contour.add_move(item)

    def _close(self) -> Iterator[Block]:
        if self._contour is not None:
            yield from self._contour.close_contour()
        self.discard_moves()


def _refused(block: Block, code: str, text: str, hint: str, /, **values: object) -> ProgramError:
    return make_program_error(block.line, 0, code, fill_template(text, values), fill_template(hint, values))


# --- words: where they are allowed, and words that they exclude


NOSE_CODES = frozenset({40, 41, 42})
_TURNS_C = frozenset({"CA", "CI"})


def get_compensation_code(statement: Statement) -> int:
    """Return the code number of G40, G41 or G42 on a line, or 0 if the line has none of these codes."""
    return next((code for code in statement.modal_codes if code in NOSE_CODES), 0)


def execute_compensation_code(
    state: State, statement: Statement, code: int, *, is_in_subroutine: bool
) -> CompensationSwitch | None:
    """Execute G41, G42 or G40, and return the compensation switch for the stages.

    Returns None for a G40 without active compensation. ``is_in_subroutine`` means that the line is in a
    subroutine. Raises ProgramError if the code is not allowed.
    """
    on = state.modal.compensation_code
    if code == 40 and on == 40:
        return None
    check_conditions(state, statement, G_CODES[code])
    text = "G{code} is not allowed in a subroutine."
    hint = "Write the compensated contour in the main program."
    statement.check_condition(not is_in_subroutine, 1, "comp-subroutine", text, hint, code=code)
    state.set_modal(state.modal._replace(compensation_code=code))
    state.contour.approach_line = 0 if code == 40 else statement.line
    state.contour.is_buffering, state.fast = True, False
    return CompensationSwitch(code, statement.line, state.x - state.px, state.z - state.pz)


def check_compensated_line(state: State, statement: Statement) -> None:
    """Raise ProgramError for a line that is not allowed while nose compensation is active."""
    on = state.modal.compensation_code
    if on == 40:
        return
    if statement.ends_program:
        hint = "Move off the part, and write G40 before the end of the program."
        raise statement.make_error(
            1, "comp-open", "The program ends while G{state} is active.", hint, state=on
        )
    if statement.flow_code and statement.flow_code not in FLOW_CODES:
        text = "The plane commands (~PLXC) and (~PLZC) are not allowed while G{state} is active."
        raise statement.make_error(1, "comp-with", text, "Write G40 before this line.", state=on)
    text = "A subroutine cannot be called while G{state} is active."
    hint = "Write the compensated contour in the main program."
    statement.check_condition(not statement.calls_subroutine, 1, "comp-subroutine", text, hint, state=on)
    refused = statement.one_shot_code is not None and not statement.code_entry.is_allowed_with_compensation
    if refused or statement.locks_spindle or _TURNS_C & statement.words.keys():
        word = statement.code_word or statement.m_word
        what = word.text if word is not None else "C"
        text = "{what} is not allowed while G{state} is active."
        raise statement.make_error(1, "comp-with", text, "Write G40 before this line.", what=what, state=on)
    other = statement.get_value("D") not in {None, state.modal.secondary}
    if other and "T" not in statement.words and not state.contour.approach_line:
        hint = "Write D only on the first move after G41 or G42."
        raise statement.make_error("D", "comp-d", "D cannot change while G{state} is active.", hint, state=on)


def check_approach_move(state: State, block: Block) -> None:
    """Raise ProgramError unless the first move after G41 or G42 is a straight line with D.

    The nose radius of D must not be negative. If it is 0, a warning is logged.
    """
    line, state.contour.approach_line = state.contour.approach_line, 0
    if not line:
        return
    on = state.modal.compensation_code
    if block.kind not in STRAIGHT_KINDS:
        text = "The first move after G{state} on line {line} is not a straight line."
        hint = "Program the approach as a straight line with D."
        raise _refused(block, "comp-approach", text, hint, state=on, line=line)
    if state.contour.secondary_offset_line != block.line or not state.modal.secondary:
        text = "The first move after G{state} on line {line} has no D."
        hint = "Write Dn on the first move after G41 or G42; R of Dn is the nose radius."
        raise _refused(block, "comp-approach", text, hint, state=on, line=line)
    radius = state.setup.secondary[state.modal.secondary].nose_radius if _known(state) else 0.0
    if radius < 0:
        text = "R of D{secondary} is negative."
        hint = "Enter the nose radius without a sign; G41 and G42 set the side."
        raise _refused(block, "comp-radius", text, hint, secondary=state.modal.secondary)
    if not radius:
        template = "R of D{secondary} is 0, so G{state} does not compensate."
        hint, message_values = (
            "Enter the nose radius in the offset table.",
            {"secondary": state.modal.secondary, "state": on},
        )
        state.log.add_warning(block.line, 0, "comp-no-radius", template, hint, **message_values)


def get_nose_radius_mm(state: State) -> float:
    """Return the nose radius (R) of the active secondary offset, in mm."""
    return max(state.setup.secondary[state.modal.secondary].nose_radius, 0.0) if _known(state) else 0.0


def _known(state: State) -> bool:
    return state.modal.secondary in state.setup.secondary
