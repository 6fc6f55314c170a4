"""Nose compensation (G40 to G42) with NORM or KONT, and with G450 or G451 at corners.

The contour is buffered until the move that leaves the contour is known. The output is the path of the tip.
The nose center is one radius away from the contour, and the tip quadrant determines the position of the
tip.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import cos, dist, pi, sin
from typing import NamedTuple

from core.geometry.lines_and_arcs import (
    SAME_POINT_TOLERANCE_MM,
    Arc,
    Element,
    Line,
    Point,
    compute_min_distance,
    compute_turn_angle,
    find_tangent_point,
)
from core.interpreter.shared.actions import ProgramEnd, ToolChange
from core.interpreter.shared.contour_stage import (
    CONTOUR_KINDS,
    STRAIGHT_KINDS,
    ContourMove,
    ContourStage,
    is_gouging_contour,
    make_element,
)
from core.interpreter.shared.diagnostic_log import DiagnosticLog
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.sinumerik.motion.linear_moves import PlainMoveFactory
from core.interpreter.sinumerik.sinumerik_state import SinumerikState
from core.language.diagnostics import ProgramError
from core.language.sinumerik.sinumerik_alarms import make_alarm_diagnostic
from core.message import Message
from core.tool_edges import TIP_DIRECTIONS

_CONTACT_TOLERANCE_MM = 0.002  # mm
_MAX_CORNER_TURN_RAD = 2.0 * pi / 3.0  # rad; largest turn at which G451 uses the intersection


class CompensationStage:
    """Stage that compensates the blocks of a program while G41 or G42 is active.

    The stage accepts the blocks in order.
    """

    def __init__(
        self, state: SinumerikState, log: DiagnosticLog, *, is_in_transformed_plane: bool = False
    ) -> None:
        self._state, self._log = state, log
        self._in_plane = (
            is_in_transformed_plane  # in TRANSMIT or TRACYL, C of a block is its depth, which may change
        )
        self._contour: _Contour | None = None

    @property
    def has_open_contour(self) -> bool:
        """Return whether a contour is active, so that no other pass can start here."""
        return self._contour is not None

    def discard_contour(self) -> None:
        """Discard the buffered contour after an error."""
        self._contour = None

    def accept_block(self, block: Block) -> Iterator[Block]:
        """Accept a block, and yield the blocks that no later block can change.

        Raises ProgramError if compensation is not possible.
        """
        contour, code = self._contour, block.modal.compensation_code
        ends = isinstance(block.action, ProgramEnd)
        if contour is None:
            if block.moves and code != 40:
                self._begin(block)
            else:
                yield block
        elif block.action is not None and not (ends and code == 40):
            self._store_motionless(contour, block)
        elif code == 40:
            self._contour = None
            yield from self._close(contour, block)
        else:
            self._add_move(contour, block)

    def check_program_end(self) -> Iterator[Block]:
        """Process the end of the program. Raises ProgramError if a contour is unfinished."""
        contour, self._contour = self._contour, None
        if contour is not None:
            raise _open(contour.last_move.block)
        yield from ()

    def _begin(self, block: Block) -> None:
        """Start the contour with its approach move."""
        state, code = self._state, block.modal.compensation_code
        if block.kind not in STRAIGHT_KINDS or self._turns(block):
            text = Message("the first move with G{code} is not a straight line.", code=code)
            raise _fault(block, "comp-approach", text, "Approach with G0 or G1, then begin the contour.")
        if not state.modal.edge:
            text = Message("G{code} needs an active tool with a cutting edge (D number).", code=code)
            raise _fault(block, "comp-no-edge", text, "Write T and D before this block.")
        edge = state.edge
        if not edge.nose_radius:
            text = Message("the nose radius of the tool is 0, so G{code} does not compensate.", code=code)
            self._warn(block, "comp-no-radius", text, "Enter the nose radius on the TOOL OFFSETS page (F8).")
        elif not edge.quadrant:
            text = Message(
                "the tool has no tip quadrant, so G{code} applies the tool offset to the nose center.",
                code=code,
            )
            self._warn(
                block, "comp-no-quadrant", text, "Enter the tip quadrant (F8); 9 means the nose center."
            )
        # G42 is to the right with X up. In the frame of blocks, with X down, it is to the left.
        side = 1.0 if (code == 42) is not state.programmed_frame.is_mirrored else -1.0
        z, x = TIP_DIRECTIONS[edge.quadrant]
        tip = x * edge.nose_radius, z * edge.nose_radius
        self._contour = _Contour(state, block, side * edge.nose_radius, tip)

    def _store_motionless(self, contour: _Contour, block: Block) -> None:
        """Store a block without motion at the compensated end point of the previous move."""
        if isinstance(block.action, ProgramEnd):
            raise _open(block)
        if isinstance(block.action, ToolChange):
            text = "T or D is programmed before the move that leaves the contour."
            raise _fault(block, "comp-with", text, "After G40, program a move before T or D.")
        contour.last_move.following_blocks.append(block)

    def _add_move(self, contour: _Contour, block: Block) -> None:
        """Add a move to the contour."""
        first, code = contour.approach_move.block, block.modal.compensation_code
        if code != first.modal.compensation_code:
            text = Message(
                "G{nose_comp} cannot change to G{code} within the same contour.",
                code=code,
                nose_comp=first.modal.compensation_code,
            )
            raise _fault(block, "comp-with", text, "Leave the contour with G40 before this block.")
        if block.kind not in CONTOUR_KINDS or self._turns(block):
            template = (
                "the C axis turns while G{code} is active."
                if self._turns(block)
                else "a thread is cut while G{code} is active."
            )
            raise _fault(block, "comp-with", Message(template, code=code), "Write G40 before this line.")
        if (block.offset_x, block.offset_z) != (first.offset_x, first.offset_z):
            text = Message("the zero point changes while G{code} is active.", code=code)
            raise _fault(block, "comp-with", text, "Write G40 and a move before this block.")
        if (block.x, block.z) == (block.x0, block.z0) and block.kind is not BlockKind.ARC:
            contour.last_move.following_blocks.append(block)
        else:
            contour.last_move = ContourMove(block)
            contour.moves.append(contour.last_move)

    def _close(self, contour: _Contour, block: Block) -> Iterator[Block]:
        """Yield the blocks of the contour and the departure move of G40.

        If ``block`` is the program end instead of a move, the nose does not move.
        """
        code = contour.approach_move.block.modal.compensation_code
        if block.moves and (block.kind not in STRAIGHT_KINDS or self._turns(block)):
            text = "the first move with G40 is not a straight line."
            raise _fault(block, "comp-departure", text, "Leave the contour with G0 or G1.")
        if block.moves and (block.offset_x, block.offset_z) != (
            contour.approach_move.block.offset_x,
            contour.approach_move.block.offset_z,
        ):
            text = "the zero point changes in the move that leaves the contour."
            raise _fault(block, "comp-departure", text, "Leave the contour before you change the zero point.")
        if not contour.moves:
            text = Message("no contour move follows G{code}.", code=code)
            raise _fault(contour.approach_move.block, "comp-empty", text, "Write the contour before G40.")
        yield from contour.close_contour(block)

    def _turns(self, block: Block) -> bool:
        return block.c != block.c0 and not self._in_plane

    def _warn(self, block: Block, code: str, text: str, hint: str) -> None:
        self._log.add_warning(block.line, 0, code, f"channel 1 block in line {block.line}: {text}", hint)


class _ContourEnd(NamedTuple):
    """One end of the contour, at the point ``corner``.

    The nose center moves from ``nose_start`` to ``nose_end``. From ``corner``, ``nose_end`` is in the
    direction perpendicular to the contour. ``contour`` starts with the element at this end.
    """

    name: str  # approach or departure
    block: Block
    nose_start: Point
    nose_end: Point
    corner: Point
    contour: Sequence[Element]


class _Contour(ContourStage):
    """The contour from the G41 or G42 move to the move after G40."""

    def __init__(
        self, state: SinumerikState, approach: Block, left_offset_mm: float, tip_offset: Point
    ) -> None:
        super().__init__(PlainMoveFactory(state), approach, left_offset_mm, tip_offset)
        self.has_rounded_corners, self.has_rounded_ends = state.rounded, state.round_ends
        self.moves: list[ContourMove] = []
        self._elements: list[Element] = []

    def close_contour(self, departure: Block) -> Iterator[Block]:
        """Yield the compensated moves of the contour and the departure move.

        Raises ProgramError if compensation is not possible.
        """
        self._elements = [make_element(move.block) for move in self.moves]
        both = zip(self.moves, self._elements, strict=True)
        pieces = [piece for move, element in both for piece in self._add_move(move, element)]
        pieces += self._remaining_pieces()
        contour_blocks = list(self._yield_pieces(pieces))
        out = self._departure_path(departure, pieces[-1].element.end) if departure.moves else []
        yield from contour_blocks
        yield from self._depart(ContourMove(departure), out)
        if not departure.moves:
            yield from self._standing(ContourMove(departure, [departure]))

    def _corner(self, block: Block, element: Element) -> Sequence[Element]:
        """Return the path around an outside corner.

        The path is an arc or, under G451, the tangents up to their intersection. A rapid also uses the
        tangents. If the intersection is too far away, each half of the corner has its own tangents.
        """
        if not isinstance(element, Arc):
            return [element]
        angle = compute_turn_angle(element.start_direction, element.end_direction)
        sharp = abs(element.sweep_rad) > _MAX_CORNER_TURN_RAD
        if block.kind is BlockKind.RAPID and sharp:
            middle = element.get_point(element.length / 2.0)
            halves = (
                element.cut_section(element.start, middle),
                element.cut_section(middle, element.end),
            )
            return [each for half in halves for each in self._corner(block, half)]
        if sharp or (self.has_rounded_corners and block.kind is not BlockKind.RAPID):
            return [element]
        reach = element.radius * abs(sin(angle) / (1.0 + cos(angle)))
        ux, uz = element.start_direction
        meet = element.start[0] + ux * reach, element.start[1] + uz * reach
        return [Line(element.start, meet), Line(meet, element.end)]

    def _approach_path(self, to: Point) -> Sequence[Element]:
        block, first = self.approach_move.block, self._elements[0]
        at = self._centre((block.x0, block.z0))
        return self._path_to_end(_ContourEnd("approach", block, at, to, first.start, self._elements))

    def _departure_path(self, block: Block, start: Point) -> Sequence[Element]:
        """Return the departure path, which is calculated like an approach and then reversed."""
        last = self._elements[-1]
        at = self._centre((block.x, block.z))
        back = self._path_to_end(_ContourEnd("departure", block, at, start, last.end, self._elements[::-1]))
        return [element.make_reversed() for element in reversed(back)]

    def _path_to_end(self, end: _ContourEnd) -> list[Element]:
        """Return the path of the nose center from outside to one end of the contour.

        The path is straight or, with KONT, leads around the end if necessary. Raises ProgramError if the
        path cuts the contour, or if a path around the end starts closer to the end than the nose radius.
        """
        radius, direct_line = self.nose_radius_mm, Line(end.nose_start, end.nose_end)
        if not radius or not is_gouging_contour(direct_line, end.contour, radius):
            return [direct_line] if direct_line.length > SAME_POINT_TOLERANCE_MM else []
        text = Message(
            "during the {end}, the nose radius of {radius} mm cuts into the contour.",
            end=end.name,
            radius=f"{radius:g}",
        )
        if not self.has_rounded_ends:
            hint = "Choose another point for this move, or write KONT to go around the end of the contour."
            raise _fault(end.block, "comp-gouge", text, hint)
        if dist(end.nose_start, end.corner) < radius - SAME_POINT_TOLERANCE_MM:
            text = Message(
                "with KONT, the distance from the {end} point to the end of the contour is "
                "less than the nose radius.",
                end=end.name,
            )
            raise _fault(
                end.block, f"comp-{end.name}-short", text, "Choose a point farther away from the contour."
            )
        around = self._tangent_arc(end)
        straight = Line(end.nose_start, around.start)
        if any(compute_min_distance(straight, each) < radius - _CONTACT_TOLERANCE_MM for each in end.contour):
            raise _fault(end.block, "comp-gouge", text, "Choose another point for this move.")
        detour = [straight, *self._corner(end.block, around)]
        return [element for element in detour if element.length > SAME_POINT_TOLERANCE_MM]

    def _tangent_arc(self, end: _ContourEnd) -> Arc:
        """Return the arc about the end of the contour that is tangent to the straight approach."""
        # An approach with the arc center on its right is clockwise. A departure is calculated in reverse.
        clockwise = (self.left_offset_mm < 0.0) is (end.name == "departure")
        touch = find_tangent_point(end.nose_start, end.corner, self.nose_radius_mm, is_clockwise=clockwise)
        return Arc(touch, end.nose_end, end.corner, clockwise=clockwise)

    def _centre(self, tip: Point) -> Point:
        return tip[0] - self.tip_offset[0], tip[1] - self.tip_offset[1]

    def _make_gouge_error(self, block: Block, reason: str) -> ProgramError:
        text = Message(
            "a nose radius of {radius} mm does not fit this contour: {why}.",
            radius=f"{self.nose_radius_mm:g}",
            why=reason,
        )
        return _fault(block, "comp-gouge", text, "Use a smaller nose radius, or change the contour.")


def _open(block: Block) -> ProgramError:
    text = "the program ends while G41 or G42 is active."
    return _fault(block, "comp-open", text, "Move off the part with G40 before the program ends.")


def _fault(block: Block, code: str, text: str, hint: str) -> ProgramError:
    return ProgramError(
        make_alarm_diagnostic(block.line, 1, code, Message("in line {line}", line=block.line), text, hint)
    )
