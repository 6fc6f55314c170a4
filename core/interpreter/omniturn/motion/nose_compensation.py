"""Nose compensation with G41, G42 and G40: permitted words, and the path of the nose along the contour."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from math import dist
from typing import NamedTuple

from core.geometry.contour_offset import WINDOW
from core.geometry.lines_and_arcs import SAME_POINT, Element, Line, Point, distance
from core.interpreter.omniturn.codes.code_rules import check_when
from core.interpreter.omniturn.codes.code_table import FLOW_CODES, G_CODES
from core.interpreter.omniturn.omniturn_state import CompensationSwitch, Item, State
from core.interpreter.omniturn.omniturn_statement import Statement
from core.interpreter.shared.actions import ToolChange
from core.interpreter.shared.contour_stage import (
    FOLLOWED,
    STRAIGHT,
    AdjustedMoves,
    ContourMove,
    ContourStage,
    cuts_in,
    element_of,
)
from core.interpreter.shared.diagnostic_log import Log
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.language.diagnostics import ProgramError, program_error
from core.message import Message, worded

# --- approach and departure: distance from the part, and clearance


class ApproachOrDeparture(NamedTuple):
    """An approach or departure; ``contour`` are the adjacent moves of the contour, the nearest first."""

    block: Block
    departs: bool
    code: int  # 41 or 42
    radius: float  # of the nose, mm
    contour: Sequence[Element]

    @property
    def name(self) -> str:
        """Name for messages: approach or departure."""
        return "departure" if self.departs else "approach"

    def refused(self, why: str, text: str, hint: str, /, **values: object) -> ProgramError:
        """Return the error for this approach or departure; ``why`` is the end of the diagnostic code."""
        return _refused(self.block, f"comp-{self.name}{why}", text, hint, **values)

    def check(self, way: Line, free: Point, corner: Point, log: Log) -> None:
        """Check the distance of its free end from the part, and that the move does not cut the part.

        A distance below the nose radius is an error, and below twice the radius a warning. ``free`` is the
        free end as programmed, and ``corner`` is the end of the contour. Raises ProgramError.
        """
        if dist(free, corner) < self.radius - SAME_POINT:
            raise self.refused(
                "-short",
                "The {lead} move is {length} long, which is less than the nose radius of {nose}.",
                "Move farther away from the part.",
                lead=self.name,
                length=self.block.modal.length_text(dist(free, corner)),
                nose=self.block.modal.length_text(self.radius),
            )
        self._check_distance(min(distance(element, free) for element in self.contour), log)
        if cuts_in(way, self.contour, self.radius):
            text = "With G{code}, the tool nose cuts into the part during the {lead}."
            hint = "Choose a different path for the {lead}, or switch between G41 and G42."
            raise _refused(self.block, "comp-gouge", text, hint, code=self.code, lead=self.name)

    def _check_distance(self, off: float, log: Log) -> None:
        if off >= 2 * self.radius - SAME_POINT:
            return
        length = self.block.modal.length_text
        near = off < self.radius - SAME_POINT
        text = Message(_NEAR[self.departs, near], value=length(off), nose=length(self.radius))
        hint = "Start the approach, or end the departure, at least twice the nose radius away from the part."
        if near:
            raise self.refused("-near", text, hint)
        log.warn(self.block.line, 0, f"comp-{self.name}-near", text, hint)


_NEAR = {  # key: whether it is a departure, and whether it is closer than R
    (True, True): "The departure ends {value} from the part, which is less than the nose radius of {nose}.",
    (False, True): "The approach starts {value} from the part, which is less than the nose radius of {nose}.",
    (True, False): "The departure ends {value} from the part, which is less than twice the nose radius of "
    "{nose}.",
    (False, False): "The approach starts {value} from the part, which is less than twice the nose radius of "
    "{nose}.",
}


class _Contour(ContourStage):
    """The contour between G41 or G42 and G40.

    The contour includes the secondary offset, and so does the compensated path.
    """

    def __init__(
        self, moves: AdjustedMoves, log: Log, mark: CompensationSwitch, approach: Block, radius: float
    ) -> None:
        super().__init__(moves, approach, radius if mark.code == 41 else -radius)
        self._log, self._mark = log, mark
        self._first: list[Element] = []  # of the contour, near the approach
        self._recent: deque[Element] = deque(maxlen=WINDOW)

    def move(self, block: Block) -> Iterator[Block]:
        """Add a move, which is the departure if no other move follows. Raises ProgramError."""
        if block.kind is not Kind.ARC and dist((block.x0, block.z0), (block.x, block.z)) < SAME_POINT:
            self.last.after.append(block)
            return
        last, self.last = self.last, ContourMove(block)
        if last is self.approach:
            return
        element = element_of(last.block)
        if len(self._first) < WINDOW:
            self._first.append(element)
        self._recent.append(element)
        yield from self._hand_out(self._follow(last, element))

    def close(self) -> Iterator[Block]:
        """Process G40, so that the last move is the departure. Raises ProgramError."""
        if not self.count:
            text = "{name} has no contour move between its approach and its departure."
            hint = "Write the contour between the approach and the departure."
            raise _refused(self.last.block, "comp-empty", text, hint, name=self._mark.name)
        pieces = self._rest()
        way = Line(pieces[-1].element.end, (self.last.block.x, self.last.block.z))
        self._check_departure(way)  # This check precedes the output of buffered blocks.
        yield from self._hand_out(pieces)
        yield from self._leave(self.last, [way])

    def _way_in(self, to: Point) -> Sequence[Element]:
        block, mark, modal = self.approach.block, self._mark, self.approach.block.modal
        begun = block.x0 - mark.dx + modal.secondary_x, block.z0 - mark.dz + modal.secondary_z
        way = Line((block.x0, block.z0), to)
        lead = ApproachOrDeparture(block, False, mark.code, self.radius, self._first)
        lead.check(way, begun, (block.x, block.z), self._log)
        return [way]

    def _check_departure(self, way: Line) -> None:
        block, after = self.last.block, self.last.after
        contour = list(reversed(self._recent))
        lead = ApproachOrDeparture(block, True, self._mark.code, self.radius, contour)
        if any(each.moves for each in after):
            text = "The departure, the last move before G40, has zero length."
            raise lead._replace(block=after[-1]).refused("-short", text, "Move off the part.")
        if block.kind not in STRAIGHT:
            text = "The departure, the move before G40, is not a straight line."
            raise lead.refused("", text, "Move off the part in a straight line.")
        lead.check(way, way.end, (block.x0, block.z0), self._log)

    def _gouges(self, block: Block, why: str) -> ProgramError:
        text = Message(
            "{name} with a nose radius of {nose} cannot compensate this move: {why}.",
            name=self._mark.name,
            nose=block.modal.length_text(self.radius),
            why=why,
        )
        return _refused(block, "comp-gouge", text, "Use a smaller nose radius, or change the contour.")


class Compensation:
    """Stage that buffers moves until their compensated paths are final."""

    def __init__(self, log: Log, moves: AdjustedMoves) -> None:
        self._log, self._moves = log, moves
        self.drop()

    @property
    def active(self) -> bool:
        """Whether G41 or G42 is active."""
        return self._mark is not None

    def drop(self) -> None:
        """Discard buffered moves and turn compensation off."""
        self._mark: CompensationSwitch | None = None
        self.radius = 0.0  # nose radius in mm, set at the approach
        self._contour: _Contour | None = None

    def take(self, item: Item) -> Iterator[Block]:
        """Accept an item, and yield the blocks that no later item can change.

        Raises ProgramError if compensation is not possible.
        """
        mark, contour = self._mark, self._contour
        if isinstance(item, CompensationSwitch):
            if mark is not None:
                yield from self._close()
            self._mark = None if item.code == 40 else item
        elif mark is None:
            yield item
        elif isinstance(item.action, ToolChange):
            yield from self._close()
            yield item
        elif item.action is not None:
            if contour is None:
                yield item
            else:
                contour.last.after.append(item)
        elif item.kind not in FOLLOWED or item.c != item.c0:
            text = "{name} cannot compensate this move."
            raise _refused(item, "comp-with", text, "Write G40 before this line.", name=mark.name)
        elif contour is None:
            self._contour = _Contour(self._moves, self._log, mark, item, self.radius)
        else:
            yield from contour.move(item)

    def _close(self) -> Iterator[Block]:
        if self._contour is not None:
            yield from self._contour.close()
        self.drop()


def _refused(block: Block, code: str, text: str, hint: str, /, **values: object) -> ProgramError:
    return program_error(block.line, 0, code, worded(text, values), worded(hint, values))


# --- words: where they are allowed, and words that they exclude


NOSE = frozenset({40, 41, 42})
_TURNS_C = frozenset({"CA", "CI"})


def nose_code(statement: Statement) -> int:
    """Return the G40, G41 or G42 of a line, or 0."""
    return next((code for code in statement.modal if code in NOSE), 0)


def switch(state: State, statement: Statement, code: int, *, called: bool) -> CompensationSwitch | None:
    """Return the mark for G41, G42 or G40; None for a G40 without active compensation.

    ``called`` means that the line is in a subroutine. Raises ProgramError if the code is not allowed.
    """
    on = state.modal.nose_comp
    if code == 40 and on == 40:
        return None
    check_when(state, statement, G_CODES[code])
    text = "G{code} is not allowed in a subroutine."
    hint = "Write the compensated contour in the main program."
    statement.check(not called, 1, "comp-subroutine", text, hint, code=code)
    state.adopt(state.modal._replace(nose_comp=code))
    state.contour.approach = 0 if code == 40 else statement.line
    state.contour.active, state.fast = True, False
    return CompensationSwitch(code, statement.line, state.x - state.px, state.z - state.pz)


def check_under_nose(state: State, statement: Statement) -> None:
    """Raise ProgramError for a line that is not allowed while nose compensation is active."""
    on = state.modal.nose_comp
    if on == 40:
        return
    if statement.ends_program:
        hint = "Move off the part, and write G40 before the end of the program."
        raise statement.refuse(1, "comp-open", "The program ends while G{state} is active.", hint, state=on)
    if statement.flow and statement.flow not in FLOW_CODES:
        text = "The plane commands (~PLXC) and (~PLZC) are not allowed while G{state} is active."
        raise statement.refuse(1, "comp-with", text, "Write G40 before this line.", state=on)
    text = "A subroutine cannot be called while G{state} is active."
    hint = "Write the compensated contour in the main program."
    statement.check(not statement.calls, 1, "comp-subroutine", text, hint, state=on)
    refused = statement.one_shot is not None and not statement.entry.under_nose
    if refused or statement.locks or _TURNS_C & statement.words.keys():
        word = statement.code or statement.m_word
        what = word.text if word is not None else "C"
        text = "{what} is not allowed while G{state} is active."
        raise statement.refuse(1, "comp-with", text, "Write G40 before this line.", what=what, state=on)
    other = statement.value("D") not in {None, state.modal.secondary}
    if other and "T" not in statement.words and not state.contour.approach:
        hint = "Write D only on the first move after G41 or G42."
        raise statement.refuse("D", "comp-d", "D cannot change while G{state} is active.", hint, state=on)


def check_approach(state: State, block: Block) -> None:
    """Check that the first move after G41 or G42 is a straight line with D. Raises ProgramError."""
    line, state.contour.approach = state.contour.approach, 0
    if not line:
        return
    on = state.modal.nose_comp
    if block.kind not in STRAIGHT:
        text = "The first move after G{state} on line {line} is not a straight line."
        hint = "Program the approach as a straight line with D."
        raise _refused(block, "comp-approach", text, hint, state=on, line=line)
    if state.contour.d_line != block.line or not state.modal.secondary:
        text = "The first move after G{state} on line {line} has no D."
        hint = "Write Dn on the first move after G41 or G42; R of Dn is the nose radius."
        raise _refused(block, "comp-approach", text, hint, state=on, line=line)
    radius = state.setup.secondary[state.modal.secondary].r if _known(state) else 0.0
    if radius < 0:
        text = "R of D{secondary} is negative."
        hint = "Enter the nose radius without a sign; G41 and G42 set the side."
        raise _refused(block, "comp-radius", text, hint, secondary=state.modal.secondary)
    if not radius:
        template = "R of D{secondary} is 0, so G{state} does not compensate."
        hint, told = (
            "Enter the nose radius in the offset table.",
            {"secondary": state.modal.secondary, "state": on},
        )
        state.log.warn(block.line, 0, "comp-no-radius", template, hint, **told)


def nose_radius(state: State) -> float:
    """Return the nose radius (R) of the active secondary offset, in mm."""
    return max(state.setup.secondary[state.modal.secondary].r, 0.0) if _known(state) else 0.0


def _known(state: State) -> bool:
    return state.modal.secondary in state.setup.secondary
