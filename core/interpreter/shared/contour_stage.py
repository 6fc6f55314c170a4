"""Stages that convert the moves of lines to final blocks: corner rounding, then nose compensation.

The dialects whose moves are blocks use these stages. A dialect defines its corners, the start and end of
compensation, and its errors. A stage buffers moves until later moves can no longer change them.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Generic, TypeVar

from core.geometry.chamfer_and_rounding import CornerError, CornerTooLargeError, SameDirectionError
from core.geometry.contour_offset import OFFSET_TOLERANCE_MM, GougeError, OffsetBuilder, OffsetPiece
from core.geometry.lines_and_arcs import (
    SAME_POINT_TOLERANCE_MM,
    Arc,
    Element,
    Line,
    Point,
    compute_min_distance,
    make_arc,
    shift_element,
)
from core.interpreter.shared.actions import SpindleRun
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.diagnostics import ProgramError


def make_element(block: Block) -> Element:
    """Return the line or arc of a move in the program frame, including the secondary offset."""
    start, end = (block.x0, block.z0), (block.x, block.z)
    if block.kind is BlockKind.ARC:
        return make_arc(start, end, (block.cx, block.cz), is_clockwise=block.clockwise)
    return Line(start, end)


class AdjustedMoveFactory(ABC):
    """Factory of the blocks for moves that a stage has changed; each dialect has its own factory."""

    @property
    @abstractmethod
    def max_rpm(self) -> float:
        """Return the speed limit of the spindle in rpm."""

    @abstractmethod
    def replace_element(self, block: Block, element: Element) -> Block:
        """Return the block with its line or arc replaced by another element of the same kind."""

    @abstractmethod
    def insert_move(self, block: Block, element: Element) -> Block:
        """Return a new move along an element, to be inserted after ``block``.

        The move has the line, feed and state of ``block``.
        """

    def make_motionless_block(self, block: Block, point: Point) -> Block:
        """Return a block without motion, copied to another point."""
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
                block, kind=BlockKind.ARC, text=text, x0=x0, z0=z0, x=x, z=z, rpm=rpm,
                cx=element.center[0], cz=element.center[1], clockwise=element.clockwise,
            )  # fmt: skip
        kind = BlockKind.FEED if block.kind is BlockKind.ARC else block.kind
        return replace(block, kind=kind, text=text, x0=x0, z0=z0, x=x, z=z, rpm=rpm)

    def _rpm(self, block: Block, x: float) -> float:
        if block.css is None or not block.modal.spindle:
            return block.rpm
        return block.modal.compute_surface_rpm(x, self.max_rpm)


STRAIGHT_KINDS = frozenset({BlockKind.RAPID, BlockKind.FEED})
CONTOUR_KINDS = STRAIGHT_KINDS | {BlockKind.ARC}
"""Block kinds that can meet in a corner and that nose compensation can follow."""

# --- corners


CornerType = TypeVar("CornerType")
MarkerType = TypeVar("MarkerType")


@dataclass(slots=True)
class BufferedMove(Generic[CornerType, MarkerType]):
    """A buffered move that ends with a corner, and the blocks without motion that follow the move."""

    block: Block
    corner: CornerType
    blocks_between: list[Block | MarkerType] = field(default_factory=list)


class CornerStage(ABC, Generic[CornerType, MarkerType]):
    """Stage that buffers a move with a corner until the next move is known, and then trims both moves.

    Markers can be among the blocks and are passed through unchanged.
    """

    def __init__(self, moves: AdjustedMoveFactory) -> None:
        self._moves = moves
        self._held: BufferedMove[CornerType, MarkerType] | None = None

    @property
    def has_buffered_move(self) -> bool:
        """Return whether a move is buffered until the next move is known."""
        return self._held is not None

    def discard_move(self) -> None:
        """Discard the buffered move after an error."""
        self._held = None

    def accept_item(
        self, item: Block | MarkerType, corner: CornerType | None
    ) -> Iterator[Block | MarkerType]:
        """Accept a block or marker, and yield all items that no later item can change.

        Raises ProgramError if the corner is not possible.
        """
        held = self._held
        if held is None:
            if corner is None or not isinstance(item, Block):
                yield item
            else:
                self._held = BufferedMove(item, corner)
        elif self._keeps_waiting(held, item) or not isinstance(item, Block):
            held.blocks_between.append(item)
        else:
            self._held = None
            yield from self._cut(held, item, corner)

    def _cut(
        self, held: BufferedMove[CornerType, MarkerType], after: Block, corner: CornerType | None
    ) -> Iterator[Block | MarkerType]:
        # Convert the second move to the frame of the first move, because an offset may have changed between
        # them.
        dx, dz = after.offset_x - held.block.offset_x, after.offset_z - held.block.offset_z
        made = self._made(held, after, shift_element(make_element(after), dx, dz))
        if made is None:
            yield from (held.block, *held.blocks_between)
        else:
            cut, between, rest = made
            yield self._moves.replace_element(held.block, cut)
            yield self._inserted(held, between)
            for each in held.blocks_between:
                yield (
                    self._moves.make_motionless_block(each, between.end) if isinstance(each, Block) else each
                )
            after = self._moves.replace_element(after, shift_element(rest, -dx, -dz))
        yield from self.accept_item(after, corner)

    def _made(
        self, held: BufferedMove[CornerType, MarkerType], after: Block, last: Element
    ) -> Sequence[Element] | None:
        if not self._forms_corner(held, after):
            return None
        try:
            return self._elements(held.corner, make_element(held.block), last)
        except SameDirectionError:
            self._report_straight(held, after)
            return None
        except CornerTooLargeError as problem:
            raise self._make_size_error(
                held, held.block if problem.is_first_move else after, problem.needed_length
            ) from None
        except CornerError as problem:
            raise self._make_corner_error(held, after, problem) from None

    def _inserted(self, held: BufferedMove[CornerType, MarkerType], between: Element) -> Block:
        return self._moves.insert_move(held.block, between)

    @abstractmethod
    def _keeps_waiting(
        self, buffered: BufferedMove[CornerType, MarkerType], item: Block | MarkerType
    ) -> bool:
        """Return whether the corner still needs a second move, because the item is not a move.

        Raises ProgramError if the item is not allowed at this point.
        """

    @abstractmethod
    def _forms_corner(self, buffered: BufferedMove[CornerType, MarkerType], after: Block) -> bool:
        """Return whether the next block forms a corner with the buffered move.

        Returns False if no corner is programmed. Raises ProgramError if the corner is not possible.
        """

    @abstractmethod
    def _elements(self, corner: CornerType, first: Element, last: Element) -> Sequence[Element]:
        """Return the trimmed first element, the corner, and the trimmed last element.

        Raises CornerError if the corner is not possible.
        """

    @abstractmethod
    def _report_straight(self, buffered: BufferedMove[CornerType, MarkerType], after: Block) -> None:
        """Report that both moves have the same direction, so that no corner is between them."""

    @abstractmethod
    def _make_size_error(
        self, buffered: BufferedMove[CornerType, MarkerType], block: Block, needed_mm: float
    ) -> ProgramError:
        """Return the error for a corner that needs ``needed_mm`` of the move ``block``."""

    @abstractmethod
    def _make_corner_error(
        self, buffered: BufferedMove[CornerType, MarkerType], after: Block, problem: CornerError
    ) -> ProgramError:
        """Return the error for a corner that is not possible."""


# --- compensation

# An approach of one nose radius along the first move passes its start at 0.71 of the radius.
_END_CLEARANCE_RATIO = 0.5


def is_gouging_contour(path: Element, contour: Iterable[Element], nose_radius_mm: float) -> bool:
    """Return whether the tool nose would gouge the contour on this approach or retract path.

    ``contour`` contains the elements in order, starting at the end of the contour to which the path is
    connected. An approach that is not perpendicular always comes closer to this end than the nose radius.
    Within two nose radii of the end, the minimum distance is therefore only ``_END_CLEARANCE_RATIO`` times
    the radius.
    """
    if path.length < SAME_POINT_TOLERANCE_MM:
        return False
    far = 0.0
    for element in contour:
        least = (
            nose_radius_mm * _END_CLEARANCE_RATIO
            if far < 2 * nose_radius_mm
            else nose_radius_mm - OFFSET_TOLERANCE_MM
        )
        far += element.length
        if compute_min_distance(path, element) < least - SAME_POINT_TOLERANCE_MM:
            return True
    return False


@dataclass(slots=True)
class ContourMove:
    """A programmed move, and the blocks without motion that follow it."""

    block: Block
    following_blocks: list[Block] = field(default_factory=list)


class ContourStage(ABC):
    """Stage that offsets one contour by the nose radius.

    The nose center is ``left_offset_mm`` to the left of the contour. ``tip_offset`` is the position in mm
    of the programmed tip relative to the nose center.
    """

    def __init__(
        self,
        moves: AdjustedMoveFactory,
        approach: Block,
        left_offset_mm: float,
        tip_offset: Point = (0.0, 0.0),
    ) -> None:
        self.approach_move = self.last_move = ContourMove(approach)
        self.move_count = 0
        self.left_offset_mm, self.tip_offset = left_offset_mm, tip_offset
        self.nose_radius_mm = abs(left_offset_mm)
        self._moves = moves
        self._offset = OffsetBuilder(left_offset_mm)
        # moves of the contour by index, until their blocks are yielded
        self._held: dict[int, ContourMove] = {}
        self._index = 0  # index of the move whose pieces are being yielded
        self._at: Point | None = None  # position of the tip at the end of the yielded blocks

    def _add_move(self, move: ContourMove, element: Element) -> list[OffsetPiece]:
        """Add a move to the contour, and return the moves that later moves can no longer change.

        Raises ProgramError if the move cannot be offset.
        """
        self._held[self.move_count] = move
        self.move_count += 1
        return self._sure(self._offset.add(element))

    def _remaining_pieces(self) -> list[OffsetPiece]:
        """Return the moves that are still buffered after the last move of the contour.

        Raises ProgramError if a move cannot be offset.
        """
        return self._sure(self._offset.finish_contour())

    def _sure(self, pieces: Iterator[OffsetPiece]) -> list[OffsetPiece]:
        try:
            return list(pieces)
        except GougeError as problem:
            raise self._make_gouge_error(
                self._held[min(problem.element_index, self.move_count - 1)].block, problem.reason
            ) from None

    def _yield_pieces(self, pieces: Iterable[OffsetPiece]) -> Iterator[Block]:
        """Yield the blocks of these pieces; the approach precedes the first block of the contour.

        Raises ProgramError if the approach is not possible.
        """
        for piece in pieces:
            if self._at is None:
                approach_path = self._approach_path(piece.element.start)
                self._at = (
                    piece.element.start[0] + self.tip_offset[0],
                    piece.element.start[1] + self.tip_offset[1],
                )
                yield from self._lead(self.approach_move, approach_path)
            while self._index < piece.source_index:
                yield from self._standing(self._held.pop(self._index))
                self._index += 1
            block = self._held[piece.source_index].block
            make = self._moves.insert_move if piece.is_corner else self._moves.replace_element
            for element in self._corner(block, piece.element) if piece.is_corner else [piece.element]:
                yield self._arrived(make(block, shift_element(element, *self.tip_offset)))

    def _depart(self, move: ContourMove, path: Sequence[Element]) -> Iterator[Block]:
        """Yield the departure, preceded by the remaining blocks of the contour."""
        yield from self._standing(self._held.pop(self._index))
        yield from self._lead(move, path)

    def _lead(self, move: ContourMove, path: Sequence[Element]) -> Iterator[Block]:
        for element in path:
            yield self._arrived(
                self._moves.replace_element(move.block, shift_element(element, *self.tip_offset))
            )
        yield from self._standing(move)

    def _standing(self, move: ContourMove) -> Iterator[Block]:
        assert self._at is not None
        for block in move.following_blocks:
            yield self._moves.make_motionless_block(block, self._at)

    def _arrived(self, block: Block) -> Block:
        self._at = block.x, block.z
        return block

    def _corner(self, block: Block, element: Element) -> Sequence[Element]:
        """Return the path of the nose center around an outside corner; by default, the given arc."""
        del block
        return [element]

    @abstractmethod
    def _approach_path(self, to: Point) -> Sequence[Element]:
        """Return the path of the nose center from the approach to the contour.

        Raises ProgramError if the approach is not possible.
        """

    @abstractmethod
    def _make_gouge_error(self, block: Block, reason: str) -> ProgramError:
        """Return the error for a move along which the nose would gouge the contour."""
