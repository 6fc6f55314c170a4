"""G41, G42 and G40: where they may stand, and the nose's path beside the programmed contour between them."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from math import dist
from typing import NamedTuple

from core.geometry.contour_offset import WINDOW, GougeError, Offset, Piece
from core.geometry.intersections import distance
from core.geometry.lines_and_arcs import SAME_POINT, Element, Line, Point
from core.interpreter.actions import ToolChange
from core.interpreter.adjusted_moves import element_of, inserted_after, moved_along, standstill_at
from core.interpreter.diagnostic_log import Log
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.nose_clearance import cuts_in
from core.interpreter.omniturn.code_rules import check_when
from core.interpreter.omniturn.code_table import FLOW_CODES, G_CODES
from core.interpreter.omniturn.corners import STRAIGHT
from core.interpreter.omniturn.omniturn_state import CompensationSwitch, Item, State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.language.diagnostics import ProgramError, program_error
from core.message import Message

# --- approach and departure: far enough from the part, and clear of it


class ApproachOrDeparture(NamedTuple):
    """An approach or a departure. ``contour``: the moves that it leads to or from, the nearest first."""

    block: Block
    departs: bool
    code: int  # 41 or 42
    radius: float  # of the nose, mm
    contour: Sequence[Element]

    @property
    def name(self) -> str:
        """What messages call it."""
        return "departure" if self.departs else "approach"

    def refused(self, why: str, text: str, hint: str) -> ProgramError:
        """The error to raise for this approach or departure; ``why`` ends the diagnostic's code."""
        return program_error(self.block.line, 0, f"comp-{self.name}{why}", text, hint)


def check_distance(lead: ApproachOrDeparture, free: Point, corner: Point, log: Log) -> None:
    """The end off the part, as programmed, must be R or more from it, and better 2R: else a warning.

    ``corner`` is where the contour begins or ends. Raises ProgramError.
    """
    radius = lead.radius
    nose = lead.block.modal.length_text(radius)
    if dist(free, corner) < radius - SAME_POINT:
        length = lead.block.modal.length_text(dist(free, corner))
        text = Message(
            "The {lead} move is {length} long, which is less than the nose radius of {nose}.",
            lead=lead.name,
            length=length,
            nose=nose,
        )
        raise lead.refused("-short", text, "Move farther away from the part.")
    off = min(distance(element, free) for element in lead.contour)
    shown = lead.block.modal.length_text(off)
    hint = "Start the approach, or end the departure, at least twice the nose radius away from the part."
    if off < radius - SAME_POINT:
        template = (
            "The departure ends {value} from the part, which is less than the nose radius of {nose}."
            if lead.departs
            else "The approach starts {value} from the part, which is less than the nose radius of {nose}."
        )
        raise lead.refused("-near", Message(template, value=shown, nose=nose), hint)
    if off < 2 * radius - SAME_POINT:
        template = (
            "The departure ends {value} from the part, which is less than twice the nose radius of {nose}."
            if lead.departs
            else "The approach starts {value} from the part, which is less than twice the nose radius of "
            "{nose}."
        )
        text = Message(template, value=shown, nose=nose)
        log.warn(lead.block.line, 0, f"comp-{lead.name}-near", text, hint)


def check_clear(lead: ApproachOrDeparture, way: Line) -> None:
    """The nose on its way must not cut the part. Raises ProgramError."""
    if cuts_in(way, lead.contour, lead.radius):
        text = Message(
            "With G{code}, the tool nose cuts into the part during the {lead}.",
            code=lead.code,
            lead=lead.name,
        )
        hint = Message(
            "Choose a different path for the {lead}, or switch between G41 and G42.", lead=lead.name
        )
        raise program_error(lead.block.line, 0, "comp-gouge", text, hint)


_FOLLOWED = STRAIGHT | {Kind.ARC}


@dataclass(slots=True)
class _Move:
    """A programmed move and what stands still after it."""

    block: Block
    after: list[Block] = field(default_factory=list)


class Compensation:
    """Takes moves and marks in order, holds them until their compensated places are sure.

    The contour has the secondary offset in it, so the path has, too: an offset of the moved contour is the
    moved offset of the contour.
    """

    def __init__(self, log: Log, max_rpm: float) -> None:
        self._log = log
        self._max_rpm = max_rpm
        self.drop()

    @property
    def active(self) -> bool:
        """Whether G41 or G42 is on."""
        return self._mark is not None

    def drop(self) -> None:
        """Forget what is held; compensation is off."""
        self._mark: CompensationSwitch | None = None
        self.radius = 0.0  # of the nose, mm; to be set when the approach comes
        self._approach: _Move | None = None
        self._last: _Move | None = None  # the departure, if no other move comes
        self._moves: dict[int, _Move] = {}  # of the contour, by index
        self._count = 0
        self._first: list[Element] = []  # of the contour, near the approach
        self._recent: deque[Element] = deque(maxlen=WINDOW)
        self._at: Point | None = None  # end of what has been handed out
        self._index = 0  # of the move whose pieces are being handed out
        self._offset = Offset(0.0)

    def take(self, item: Item) -> Iterator[Block]:
        """Yields what no later item can change. Raises ProgramError where the nose cannot follow."""
        if isinstance(item, CompensationSwitch):
            if self._mark is not None:
                yield from self._close()
            self._mark = None if item.code == 40 else item
        elif self._mark is None:
            yield item
        elif isinstance(item.action, ToolChange):
            yield from self._close()
            yield item
        elif item.action is not None:
            yield from self._rest(item)
        else:
            yield from self._move(item)

    def _rest(self, block: Block) -> Iterator[Block]:
        """A block in which nothing moves: at the compensated end of the move before it."""
        holder = self._last or self._approach
        if holder is None:
            yield block
        else:
            holder.after.append(block)

    def _move(self, block: Block) -> Iterator[Block]:
        if block.kind not in _FOLLOWED or block.c != block.c0:
            raise _refused(
                block,
                "comp-with",
                Message("{name} cannot compensate this move.", name=self._name),
                "Write G40 before this line.",
            )
        move = _Move(block)
        if self._approach is None:
            self._approach = move
            self._offset = Offset(self.radius if self._code == 41 else -self.radius)
            return
        if block.kind is not Kind.ARC and dist((block.x0, block.z0), (block.x, block.z)) < SAME_POINT:
            (self._last or self._approach).after.append(block)
            return
        last, self._last = self._last, move
        if last is not None:
            yield from self._follow(last)

    def _follow(self, move: _Move) -> Iterator[Block]:
        """One more move of the contour."""
        element = element_of(move.block)
        self._moves[self._count] = move
        self._count += 1
        if len(self._first) < WINDOW:
            self._first.append(element)
        self._recent.append(element)
        try:
            for piece in self._offset.add(element):
                yield from self._hand_out(piece)
        except GougeError as problem:
            raise self._gouge(problem) from None

    def _hand_out(self, piece: Piece) -> Iterator[Block]:
        if self._at is None:
            yield from self._approached(piece.element.start)
        while self._index < piece.source:
            yield from self._standing(self._moves.pop(self._index))
            self._index += 1
        make = inserted_after if piece.corner else moved_along
        self._at = piece.element.end
        yield make(self._moves[piece.source].block, piece.element, self._max_rpm)

    def _standing(self, move: _Move) -> Iterator[Block]:
        if self._at is not None:
            for block in move.after:
                yield standstill_at(block, self._at, self._max_rpm)

    def _approached(self, to: Point) -> Iterator[Block]:
        approach = self._approach
        assert approach is not None
        assert self._mark is not None
        block, modal = approach.block, approach.block.modal
        begun = (
            block.x0 - self._mark.dx + modal.secondary_x,
            block.z0 - self._mark.dz + modal.secondary_z,
        )
        way = Line((block.x0, block.z0), to)
        lead = ApproachOrDeparture(block, False, self._code, self.radius, self._first)
        check_distance(lead, begun, (block.x, block.z), self._log)
        check_clear(lead, way)
        self._at = to
        yield moved_along(block, way, self._max_rpm)
        yield from self._standing(approach)

    def _close(self) -> Iterator[Block]:
        """G40: the last move departs."""
        approach, last = self._approach, self._last
        if approach is None:
            self.drop()
            return
        if last is None or not self._count:
            text = Message(
                "{name} has no contour move between its approach and its departure.", name=self._name
            )
            raise _refused(
                (last or approach).block,
                "comp-empty",
                text,
                "Write the contour between the approach and the departure.",
            )
        try:
            pieces = list(self._offset.close())
        except GougeError as problem:
            raise self._gouge(problem) from None
        way = Line(pieces[-1].element.end, (last.block.x, last.block.z))
        self._check_departure(last, way)  # before anything that was held comes out
        for piece in pieces:
            yield from self._hand_out(piece)
        yield from self._standing(self._moves.pop(self._index))
        yield moved_along(last.block, way, self._max_rpm)
        yield from last.after
        self.drop()

    def _check_departure(self, move: _Move, way: Line) -> None:
        block = move.block
        lead = ApproachOrDeparture(block, True, self._code, self.radius, list(reversed(self._recent)))
        if any(each.moves for each in move.after):
            text = "The departure, the last move before G40, has zero length."
            raise lead._replace(block=move.after[-1]).refused("-short", text, "Move off the part.")
        if block.kind not in STRAIGHT:
            text = "The departure, the move before G40, is not a straight line."
            raise lead.refused("", text, "Move off the part in a straight line.")
        check_distance(lead, way.end, (block.x0, block.z0), self._log)
        check_clear(lead, way)

    def _gouge(self, problem: GougeError) -> ProgramError:
        block = self._moves[problem.index].block
        nose = block.modal.length_text(self.radius)
        text = Message(
            "{name} with a nose radius of {nose} cannot compensate this move: {why}.",
            name=self._name,
            nose=nose,
            why=problem.why,
        )
        return _refused(block, "comp-gouge", text, "Use a smaller nose radius, or change the contour.")

    @property
    def _code(self) -> int:
        return self._mark.code if self._mark is not None else 40

    @property
    def _name(self) -> str:
        return f"G{self._code}"


def _refused(block: Block, code: str, text: str, hint: str) -> ProgramError:
    return program_error(block.line, 0, code, text, hint)


# --- words: where they may stand, and what may not stand under them


NOSE = frozenset({40, 41, 42})
_TURNS_C = frozenset({"CA", "CI"})


def nose_code(statement: Statement) -> int:
    """The G40, G41 or G42 of a line, 0 where there is none."""
    return next((code for code in statement.modal if code in NOSE), 0)


def switch(state: State, statement: Statement, code: int, *, called: bool) -> CompensationSwitch | None:
    """G41, G42 or G40; None for a G40 with nothing to end. ``called``: the line is in a subroutine.

    Raises ProgramError where the code may not stand.
    """
    on = state.modal.nose_comp
    if code == 40 and on == 40:
        return None
    check_when(state, statement, G_CODES[code])
    if called:
        text = Message("G{code} is not allowed in a subroutine.", code=code)
        raise statement.refuse(
            1, "comp-subroutine", text, "Write the compensated contour in the main program."
        )
    state.adopt(state.modal._replace(nose_comp=code))
    state.contour.approach = 0 if code == 40 else statement.line
    state.contour.active, state.fast = True, False
    return CompensationSwitch(code, statement.line, state.x - state.px, state.z - state.pz)


def check_under_nose(state: State, statement: Statement) -> None:
    """Refuse what nose compensation cannot follow. Raises ProgramError."""
    on = state.modal.nose_comp
    if on == 40:
        return
    if statement.ends_program:
        text = Message("The program ends while G{state} is active.", state=on)
        raise statement.refuse(
            1, "comp-open", text, "Move off the part, and write G40 before the end of the program."
        )
    if statement.flow and statement.flow not in FLOW_CODES:
        raise statement.refuse(
            1,
            "comp-with",
            Message(
                "The plane commands (~PLXC) and (~PLZC) are not allowed while G{state} is active.", state=on
            ),
            "Write G40 before this line.",
        )
    if statement.calls:
        text = Message("A subroutine cannot be called while G{state} is active.", state=on)
        raise statement.refuse(
            1, "comp-subroutine", text, "Write the compensated contour in the main program."
        )
    refused = statement.one_shot is not None and not statement.entry.under_nose
    if refused or statement.locks or _TURNS_C & statement.words.keys():
        word = statement.code or statement.m_word
        what = word.text if word is not None else "C"
        raise statement.refuse(
            1,
            "comp-with",
            Message("{what} is not allowed while G{state} is active.", what=what, state=on),
            "Write G40 before this line.",
        )
    other = statement.value("D") not in {None, state.modal.secondary}
    if other and "T" not in statement.words and not state.contour.approach:
        text = Message("D cannot change while G{state} is active.", state=on)
        hint = "Write D only on the first move after G41 or G42."
        raise statement.refuse("D", "comp-d", text, hint)


def check_approach(state: State, block: Block) -> None:
    """The first move after G41 or G42: a straight line with D. Raises ProgramError."""
    line, state.contour.approach = state.contour.approach, 0
    if not line:
        return
    on = state.modal.nose_comp
    if block.kind not in STRAIGHT:
        text = Message(
            "The first move after G{state} on line {line} is not a straight line.", state=on, line=line
        )
        raise _refused(block, "comp-approach", text, "Program the approach as a straight line with D.")
    if state.contour.d_line != block.line or not state.modal.secondary:
        text = Message("The first move after G{state} on line {line} has no D.", state=on, line=line)
        raise _refused(
            block,
            "comp-approach",
            text,
            "Write Dn on the first move after G41 or G42; R of Dn is the nose radius.",
        )
    radius = state.setup.secondary[state.modal.secondary].r if _known(state) else 0.0
    if radius < 0:
        text = Message("R of D{secondary} is negative.", secondary=state.modal.secondary)
        raise _refused(
            block, "comp-radius", text, "Enter the nose radius without a sign; G41 and G42 set the side."
        )
    if not radius:
        text = Message(
            "R of D{secondary} is 0, so G{state} does not compensate.",
            secondary=state.modal.secondary,
            state=on,
        )
        state.log.warn(block.line, 0, "comp-no-radius", text, "Enter the nose radius in the offset table.")


def nose_radius(state: State) -> float:
    """R of the secondary offset in force, mm."""
    return max(state.setup.secondary[state.modal.secondary].r, 0.0) if _known(state) else 0.0


def _known(state: State) -> bool:
    return state.modal.secondary in state.setup.secondary
