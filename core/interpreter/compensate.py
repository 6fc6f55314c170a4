"""The tool nose's path beside the programmed contour: moves between G41 or G42 and G40."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from math import dist

from core.geometry.arcs import Point
from core.geometry.contour import Element, Line
from core.geometry.extent import SAME_POINT
from core.geometry.offset import WINDOW, GougeError, Offset, Piece
from core.interpreter import units
from core.interpreter.actions import ToolChange
from core.interpreter.blocks import Block, Kind
from core.interpreter.corners import STRAIGHT
from core.interpreter.lead import Lead, check_clear, check_distance
from core.interpreter.log import Log, refusal
from core.interpreter.remade import element_of, follow, insert, stand
from core.interpreter.shaping import Item, Mark
from core.language.diagnostics import ProgramError

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
        self._mark: Mark | None = None
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
        """Passes on what is sure. Raises ProgramError where the nose cannot follow."""
        if isinstance(item, Mark):
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
                block, "comp-with", f"{self._name} cannot follow this move.", "Write G40 before it."
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
        make = insert if piece.corner else follow
        self._at = piece.element.end
        yield make(self._moves[piece.source].block, piece.element, self._max_rpm)

    def _standing(self, move: _Move) -> Iterator[Block]:
        if self._at is not None:
            for block in move.after:
                yield stand(block, self._at, self._max_rpm)

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
        lead = Lead(block, False, self._code, self.radius, self._first)
        check_distance(lead, begun, (block.x, block.z), self._log)
        check_clear(lead, way)
        self._at = to
        yield follow(block, way, self._max_rpm)
        yield from self._standing(approach)

    def _close(self) -> Iterator[Block]:
        """G40: the last move departs."""
        approach, last = self._approach, self._last
        if approach is None:
            self.drop()
            return
        if last is None or not self._count:
            text = f"No move follows the contour between the approach and the departure of {self._name}."
            raise _refused((last or approach).block, "comp-empty", text, "Write the contour between them.")
        try:
            pieces = list(self._offset.close())
        except GougeError as problem:
            raise self._gouge(problem) from None
        way = Line(pieces[-1].element.end, (last.block.x, last.block.z))
        self._check_departure(last, way)  # before anything that was held comes out
        for piece in pieces:
            yield from self._hand_out(piece)
        yield from self._standing(self._moves.pop(self._index))
        yield follow(last.block, way, self._max_rpm)
        yield from last.after
        self.drop()

    def _check_departure(self, move: _Move, way: Line) -> None:
        block = move.block
        lead = Lead(block, True, self._code, self.radius, list(reversed(self._recent)))
        if any(each.moves for each in move.after):
            text = "The departure, the last move before G40, has no length."
            raise lead._replace(block=move.after[-1]).refused("-short", text, "Move off the part.")
        if block.kind not in STRAIGHT:
            text = "The departure, the move before G40, is no straight line."
            raise lead.refused("", text, "Move off the part on a straight line.")
        check_distance(lead, way.end, (block.x0, block.z0), self._log)
        check_clear(lead, way)

    def _gouge(self, problem: GougeError) -> ProgramError:
        block = self._moves[problem.index].block
        nose = units.length(self.radius, metric=block.modal.metric)
        text = f"{self._name} with a nose radius of {nose} cannot follow this move: {problem.why}."
        return _refused(block, "comp-gouge", text, "Take a smaller nose, or change the contour.")

    @property
    def _code(self) -> int:
        return self._mark.code if self._mark is not None else 40

    @property
    def _name(self) -> str:
        return f"G{self._code}"


def _refused(block: Block, code: str, text: str, hint: str) -> ProgramError:
    return ProgramError(refusal(block.line, 0, code, text, hint))
