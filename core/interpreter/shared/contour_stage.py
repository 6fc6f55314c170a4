"""Stages between the moves of the lines and the final blocks: corner rounding, then nose compensation.

All languages whose moves are blocks use these stages. A language specifies its corners, the start and end of
compensation, and its errors. A stage buffers moves until no later move can change them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Generic, TypeVar

from core.geometry.chamfer_and_rounding import CornerError, CornerTooLargeError, NoCornerError
from core.geometry.contour_offset import NEARER, GougeError, Offset, Piece
from core.geometry.lines_and_arcs import (
    SAME_POINT,
    Arc,
    Element,
    Line,
    Point,
    arc_between,
    clearance,
    shifted,
)
from core.interpreter.shared.actions import SpindleRun
from core.interpreter.shared.elementary_blocks import Block, Kind
from core.language.diagnostics import ProgramError


def element_of(block: Block) -> Element:
    """Return the line or arc of a move in the program frame, including the secondary offset."""
    start, end = (block.x0, block.z0), (block.x, block.z)
    if block.kind is Kind.ARC:
        return arc_between(start, end, (block.cx, block.cz), clockwise=block.clockwise)
    return Line(start, end)


class AdjustedMoves(ABC):
    """Factory of the blocks for adjusted moves, implemented by each language."""

    @property
    @abstractmethod
    def highest_rpm(self) -> float:
        """The speed limit of the spindle in rpm."""

    @abstractmethod
    def along(self, block: Block, element: Element) -> Block:
        """Return the block with its move along another element of the same kind."""

    @abstractmethod
    def inserted(self, block: Block, element: Element) -> Block:
        """Return a new move along an element, to follow ``block`` with the same line, feed and state."""

    def standing(self, block: Block, point: Point) -> Block:
        """Return a block without motion at another point."""
        x, z = point
        rpm = self._rpm(block, x)
        action = block.action
        if isinstance(action, SpindleRun) and action.surface_speed is not None:
            action = SpindleRun(rpm, action.surface_speed)
        return replace(block, x0=x, z0=z, x=x, z=z, rpm=rpm, action=action)

    def _placed(self, block: Block, element: Element, text: str) -> Block:
        (x0, z0), (x, z) = element.start, element.end
        rpm = self._rpm(block, x)
        if isinstance(element, Arc):
            return replace(
                block, kind=Kind.ARC, text=text, x0=x0, z0=z0, x=x, z=z, rpm=rpm,
                cx=element.centre[0], cz=element.centre[1], clockwise=element.clockwise,
            )  # fmt: skip
        kind = Kind.FEED if block.kind is Kind.ARC else block.kind
        return replace(block, kind=kind, text=text, x0=x0, z0=z0, x=x, z=z, rpm=rpm)

    def _rpm(self, block: Block, x: float) -> float:
        if block.css is None or not block.modal.spindle:
            return block.rpm
        return block.modal.surface_rpm_at(x, self.highest_rpm)


STRAIGHT = frozenset({Kind.RAPID, Kind.FEED})
FOLLOWED = STRAIGHT | {Kind.ARC}
"""What may meet in a corner, and what a nose can be beside."""

# --- corners


C = TypeVar("C")
M = TypeVar("M")


@dataclass(slots=True)
class HeldMove(Generic[C, M]):
    """A buffered move with a corner, and the blocks between it and the next move."""

    block: Block
    corner: C
    between: list[Block | M] = field(default_factory=list)


class CornerStage(ABC, Generic[C, M]):
    """Stage that buffers a move with a corner C until the next move is known, and then trims both moves.

    Marks M may be among the blocks. They pass through unchanged.
    """

    def __init__(self, moves: AdjustedMoves) -> None:
        self._moves = moves
        self._held: HeldMove[C, M] | None = None

    @property
    def holds(self) -> bool:
        """Whether a move is buffered until the next move is known."""
        return self._held is not None

    def drop(self) -> None:
        """Discard the buffered move after an error."""
        self._held = None

    def take(self, item: Block | M, corner: C | None) -> Iterator[Block | M]:
        """Accept a block or mark, and yield all items that no later item can change.

        Raises ProgramError if the corner is not possible.
        """
        held = self._held
        if held is None:
            if corner is None or not isinstance(item, Block):
                yield item
            else:
                self._held = HeldMove(item, corner)
        elif self._waits(held, item) or not isinstance(item, Block):
            held.between.append(item)
        else:
            self._held = None
            yield from self._cut(held, item, corner)

    def _cut(self, held: HeldMove[C, M], after: Block, corner: C | None) -> Iterator[Block | M]:
        # Convert the second move to the frame of the first move, because an offset may have changed between
        # them.
        dx, dz = after.offset_x - held.block.offset_x, after.offset_z - held.block.offset_z
        made = self._made(held, after, shifted(element_of(after), dx, dz))
        if made is None:
            yield from (held.block, *held.between)
        else:
            cut, between, rest = made
            yield self._moves.along(held.block, cut)
            yield self._inserted(held, between)
            for each in held.between:
                yield self._moves.standing(each, between.end) if isinstance(each, Block) else each
            after = self._moves.along(after, shifted(rest, -dx, -dz))
        yield from self.take(after, corner)

    def _made(self, held: HeldMove[C, M], after: Block, last: Element) -> Sequence[Element] | None:
        if not self._meets(held, after):
            return None
        try:
            return self._elements(held.corner, element_of(held.block), last)
        except NoCornerError:
            self._tell_straight(held, after)
            return None
        except CornerTooLargeError as problem:
            raise self._too_large(held, held.block if problem.first else after, problem.needed) from None
        except CornerError as problem:
            raise self._impossible(held, after, problem) from None

    def _inserted(self, held: HeldMove[C, M], between: Element) -> Block:
        return self._moves.inserted(held.block, between)

    @abstractmethod
    def _waits(self, held: HeldMove[C, M], item: Block | M) -> bool:
        """Return whether the item is not a move, so that the corner remains open. Raises ProgramError."""

    @abstractmethod
    def _meets(self, held: HeldMove[C, M], after: Block) -> bool:
        """Return whether the next block forms the corner, or no corner is programmed. Raises ProgramError."""

    @abstractmethod
    def _elements(self, corner: C, first: Element, last: Element) -> Sequence[Element]:
        """Return the first element trimmed, the corner, and the last element trimmed. Raises CornerError."""

    @abstractmethod
    def _tell_straight(self, held: HeldMove[C, M], after: Block) -> None:
        """Report that both moves have the same direction."""

    @abstractmethod
    def _too_large(self, held: HeldMove[C, M], of: Block, needed: float) -> ProgramError:
        """Return the error for a corner that needs ``needed`` mm of the move ``of``."""

    @abstractmethod
    def _impossible(self, held: HeldMove[C, M], after: Block, problem: CornerError) -> ProgramError:
        """Return the error for a corner that is not possible."""


# --- compensation

# An approach of one nose radius along the first move passes its start at 0.71 of the radius.
_BESIDE = 0.5


def cuts_in(way: Element, contour: Iterable[Element], radius: float) -> bool:
    """Return whether the center of a nose of ``radius`` mm comes too close to the contour.

    The elements of the contour begin with the nearest one.

    Near the end of the contour, an approach that is not perpendicular always comes closer than the radius.
    There, only ``_BESIDE`` times the radius is required.
    """
    if way.length < SAME_POINT:
        return False
    far = 0.0
    for element in contour:
        least = radius * _BESIDE if far < 2 * radius else radius - NEARER
        far += element.length
        if clearance(way, element) < least - SAME_POINT:
            return True
    return False


@dataclass(slots=True)
class ContourMove:
    """A programmed move and the blocks without motion that follow the move."""

    block: Block
    after: list[Block] = field(default_factory=list)


class ContourStage(ABC):
    """Stage that offsets one contour for the nose radius.

    The nose center is ``left`` mm to the left of the contour.

    ``tip`` is the position in mm of the programmed tip relative to the center.
    """

    def __init__(self, moves: AdjustedMoves, approach: Block, left: float, tip: Point = (0.0, 0.0)) -> None:
        self.approach = self.last = ContourMove(approach)
        self.count = 0
        self.left, self.tip = left, tip
        self.radius = abs(left)
        self._moves = moves
        self._offset = Offset(left)
        # moves of the contour by index, until their blocks are yielded
        self._held: dict[int, ContourMove] = {}
        self._index = 0  # index of the move whose pieces are being yielded
        self._at: Point | None = None  # position of the tip at the end of the yielded blocks

    def _follow(self, move: ContourMove, element: Element) -> list[Piece]:
        """Add a move of the contour, and return the pieces that are final. Raises ProgramError."""
        self._held[self.count] = move
        self.count += 1
        return self._sure(self._offset.add(element))

    def _rest(self) -> list[Piece]:
        """Return the remaining pieces after the last move. Raises ProgramError."""
        return self._sure(self._offset.close())

    def _sure(self, pieces: Iterator[Piece]) -> list[Piece]:
        try:
            return list(pieces)
        except GougeError as problem:
            raise self._gouges(self._held[min(problem.index, self.count - 1)].block, problem.why) from None

    def _hand_out(self, pieces: Iterable[Piece]) -> Iterator[Block]:
        """Yield the blocks of these pieces, preceded by the approach at the start. Raises ProgramError."""
        for piece in pieces:
            if self._at is None:
                way = self._way_in(piece.element.start)
                self._at = piece.element.start[0] + self.tip[0], piece.element.start[1] + self.tip[1]
                yield from self._lead(self.approach, way)
            while self._index < piece.source:
                yield from self._standing(self._held.pop(self._index))
                self._index += 1
            block = self._held[piece.source].block
            make = self._moves.inserted if piece.corner else self._moves.along
            for element in self._corner(block, piece.element) if piece.corner else [piece.element]:
                yield self._arrived(make(block, shifted(element, *self.tip)))

    def _leave(self, move: ContourMove, way: Sequence[Element]) -> Iterator[Block]:
        """Yield the departure after the remaining blocks of the contour."""
        yield from self._standing(self._held.pop(self._index))
        yield from self._lead(move, way)

    def _lead(self, move: ContourMove, way: Sequence[Element]) -> Iterator[Block]:
        for element in way:
            yield self._arrived(self._moves.along(move.block, shifted(element, *self.tip)))
        yield from self._standing(move)

    def _standing(self, move: ContourMove) -> Iterator[Block]:
        assert self._at is not None
        for block in move.after:
            yield self._moves.standing(block, self._at)

    def _arrived(self, block: Block) -> Block:
        self._at = block.x, block.z
        return block

    def _corner(self, block: Block, element: Element) -> Sequence[Element]:
        """Return the path around an outside corner, by default the given arc."""
        del block
        return [element]

    @abstractmethod
    def _way_in(self, to: Point) -> Sequence[Element]:
        """Return the path of the nose center from the approach to the contour. Raises ProgramError."""

    @abstractmethod
    def _gouges(self, block: Block, why: str) -> ProgramError:
        """Return the error for a move that the nose would gouge."""
