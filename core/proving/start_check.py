"""Check of the moves from Cycle Start to the first known position of a program.

The proof of a program starts at its first known position. The moves before this position depend on the axis
positions at Cycle Start. For example, after an E-stop in a bore, the straight line to the first position
passes through the wall of the bore. The check compares these moves with the current part, the chuck and the
tailstock, and runs on a worker thread.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from itertools import pairwise

from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ToolOffset
from core.part.cutter import SolidTool, make_solid_tool
from core.part.swept_edge import FloatArray, Point
from core.part.tool_outline import make_nose_circle, make_tool_outline
from core.part.turned_part import NO_CUT, Cut, TurnedPart
from core.proving.part_history import CheckCanceled, PartHistory
from core.proving.part_simulation import PartSimulation
from core.proving.tip_moves import StepConverter, TipMove

TOUCH_TOLERANCE_MM = 0.1
"""Depth of stock in mm, in radius and in Z, up to which a tool only touches the part.

It allows for feed marks and the braking distance of a stop.
"""

SECOND_START_OFFSET_MM = (
    7.3  # mm, offset of a second start position, chosen to differ from all programmed positions
)
_POSITION_TOLERANCE_MM = 1e-6  # mm
_NOSE = 0.4  # mm, assumed nose radius of the insert
_MAX_MOVES = 60  # largest number of moves that are checked
_JOG_DISTANCE_MM = 500.0  # mm, distance of a jog that moves a tool clear

IterStartBlocks = Callable[[tuple[float, ...]], Iterable[Block]]
"""Function that returns the blocks of a start from these axis positions, in machine mm."""


class CollisionBody(Enum):
    """The bodies that a tool can hit on its first move: the part, the chuck and the tailstock."""

    PART = "part"
    CHUCK = "into-chuck"
    TAILSTOCK = "into-tailstock"


@dataclass(frozen=True, slots=True)
class StartState:
    """The machine state at a start, with the axis positions and the active tool.

    ``axis_positions`` are in machine mm: X as a radius, then Z. ``interrupted_block`` is the number of the
    interrupted elementary block with its machine X and Z, or None if no block was interrupted.
    ``starts_at_first_line`` means that the program starts at its first line. Its moves before the first
    known position then only position the axes.
    """

    axis_positions: tuple[float, ...]
    active_tool_number: int
    interrupted_block: tuple[int, Point] | None = None
    starts_at_first_line: bool = True


@dataclass(frozen=True, slots=True)
class FirstMove:
    """The first move of a start, with the collision found on it, if any.

    - ``path`` is the move in machine X and Z in mm, with a flag for each rapid.
    - ``part_zero`` is the machine X and Z at which the displayed tip is at part zero. It belongs to the
      tool that hits a body, or otherwise to the tool at the end of the move.
    - ``hit_body`` is the body that ``tool_number`` hits at ``hit_z_mm`` (part's frame).
    - ``is_inside_at_start`` means that the tool is inside the body before it moves.
    - ``safe_jog_direction`` is the direction of a safe jog, such as ``Z+``, or an empty string if no
      direction is certain to be safe.
    """

    path: tuple[tuple[float, float, bool], ...]
    part_zero: Point = (0.0, 0.0)
    hit_body: CollisionBody | None = None
    tool_number: int = 0
    hit_z_mm: float = 0.0
    is_inside_at_start: bool = False
    safe_jog_direction: str = ""
    has_assumed_data: bool = False  # the part or the tool is assumed
    is_part_known: bool = True  # the part is known


def find_first_moves(iter_blocks: IterStartBlocks, axis_positions: tuple[float, ...]) -> list[TipMove]:
    """Return the moves up to the first position that does not depend on the axis positions."""
    aside = tuple(each + SECOND_START_OFFSET_MM for each in axis_positions)
    steps, found = StepConverter(), list[TipMove]()
    for block, other in zip(iter_blocks(axis_positions), iter_blocks(aside), strict=False):
        if block.travel is not None or block.plane is not None:
            break
        found += (step for step in steps.convert_blocks([block]) if isinstance(step, TipMove))
        if block.action is None and (_is_known(block, other) or len(found) >= _MAX_MOVES):
            break
    return found


def _is_known(one: Block, other: Block) -> bool:
    same = abs(one.x + one.offset_x - other.x - other.offset_x) < _POSITION_TOLERANCE_MM
    return same and abs(one.z + one.offset_z - other.z - other.offset_z) < _POSITION_TOLERANCE_MM


def make_unchecked_move(moves: Sequence[TipMove]) -> FirstMove:
    """Return a first move that consists of the given moves, without checking for collisions."""
    if not moves:
        return FirstMove(())
    legs = [(*_machine(moves[0].points[0], moves[0].part_zero), True)]
    for move in moves:
        legs += ((*_machine(point, move.part_zero), move.is_fast) for point in move.points[1:])
    return FirstMove(tuple(legs), moves[-1].part_zero)


def _tip_position(axis_position: Point, zero: Point) -> Point:
    """Return Z and r in mm of the tip in the part's frame, with the axes at this machine X and Z."""
    return axis_position[1] - zero[1], axis_position[0] - zero[0]


def _machine(point: Point, zero: Point) -> tuple[float, float]:
    return point[1] + zero[0], point[0] + zero[1]


@dataclass(slots=True)
class StartCheck:
    """A check of starts against the part of one program.

    ``tool_offsets`` are the tool offsets of the job, by T number.
    """

    part_history: PartHistory
    tool_offsets: dict[int, ToolOffset]
    is_stock_specified: bool
    silenced_checks: frozenset[str] = frozenset()
    _solids: dict[int, SolidTool] = field(default_factory=dict)

    def check_start(
        self,
        iter_blocks: IterStartBlocks,
        start_state: StartState,
        check_canceled: CheckCanceled | None = None,
    ) -> FirstMove:
        """Return the first move of a start, with the body that it hits, if any."""
        moves = find_first_moves(iter_blocks, start_state.axis_positions)
        making = self._making(start_state, check_canceled)
        known = making.milling is None and (making.part is not None or self.part_history.stock is None)
        found = replace(
            make_unchecked_move(moves), is_part_known=known or start_state.interrupted_block is None
        )
        for body, metal in self._metal(making):
            hit = self._find_hit(body, metal, moves, start_state)
            if hit is not None:
                tool, z, inside = hit
                return replace(
                    found,
                    part_zero=self._part_zero_for_tool(tool) or found.part_zero,
                    hit_body=body,
                    tool_number=tool,
                    hit_z_mm=z,
                    is_inside_at_start=inside,
                    safe_jog_direction=self._find_safe_jog(making, start_state),
                    has_assumed_data=self._is_assumed(body, tool, start_state),
                )
        return found

    def _making(self, now: StartState, watch: CheckCanceled | None) -> PartSimulation:
        if now.interrupted_block is None:
            return self.part_history.make_simulation_at(1, check_canceled=watch)
        block, where = now.interrupted_block
        zero = self._part_zero_for_tool(now.active_tool_number)
        return self.part_history.make_simulation_at(
            block, _tip_position(where, zero) if zero is not None else None, watch
        )

    def _is_assumed(self, body: CollisionBody, tool: int, start_state: StartState) -> bool:
        """Return whether a detected collision depends on assumptions about the stock or the tool.

        A tool that was stopped in a cut is certainly in the part. Without an active tool, the position of
        the tip is unknown, so the collision is only assumed.
        """
        if tool == 0:
            return True
        if (
            body is CollisionBody.PART
            and start_state.interrupted_block is None
            and not self.is_stock_specified
        ):
            return True
        return (
            start_state.interrupted_block is None
            and not self.part_history.program_tools.is_shape_specified(tool)
        )

    def _metal(self, making: PartSimulation) -> Iterator[tuple[CollisionBody, TurnedPart]]:
        if making.part is not None and making.milling is None and not making.is_collet_open:
            yield CollisionBody.PART, making.part
        for check, body in making.findings.clamping_bodies.items():
            if check not in self.silenced_checks:
                yield CollisionBody(check), body

    def _find_hit(
        self, body: CollisionBody, metal: TurnedPart, moves: Sequence[TipMove], start_state: StartState
    ) -> tuple[int, float, bool] | None:
        """Return the tool that hits the body, the Z of the hit, and whether the tool starts in the body.

        The result is None without a hit.
        """
        here = (start_state.axis_positions[0], start_state.axis_positions[1])
        if start_state.active_tool_number == 0 and start_state.interrupted_block is None:
            start_state = replace(
                start_state, starts_at_first_line=False
            )  # Without an active tool, the position of its tip is unknown.
        standing = self._met(metal, start_state.active_tool_number, here, here)
        if standing and start_state.starts_at_first_line:
            return start_state.active_tool_number, standing.front_z_mm, True
        for move in moves:
            for number in dict.fromkeys((start_state.active_tool_number, move.modal.tool)):
                for a, b in pairwise(move.points):
                    met = self._met(metal, number, _machine(a, move.part_zero), _machine(b, move.part_zero))
                    if (
                        met.area > standing.area + TOUCH_TOLERANCE_MM * TOUCH_TOLERANCE_MM
                        and not self._is_intended_cut(body, move, start_state)
                    ):
                        return number, met.front_z_mm, False
            self._cut(body, metal, move, start_state)
        if (
            body is CollisionBody.PART
            and start_state.starts_at_first_line
            and start_state.interrupted_block is not None
        ):
            return self._find_bore_hit(metal, start_state)
        return None

    def _find_bore_hit(self, metal: TurnedPart, start_state: StartState) -> tuple[int, float, bool] | None:
        """Return the hit of a tool that is inside a bore, or None if the tool is not in a bore.

        The hit contains the tool number, the Z of the tip in mm, and True. Even if the first move stays in
        the bore, a later move would take the tool through the wall.
        """
        zero = self._part_zero_for_tool(start_state.active_tool_number)
        if zero is None:
            return None
        z, r = _tip_position((start_state.axis_positions[0], start_state.axis_positions[1]), zero)
        around = metal.max_radii[
            abs(metal.columns.column_centers - z) <= max(2 * TOUCH_TOLERANCE_MM, metal.columns.step_mm)
        ]
        if len(around) and float(around.min()) > abs(r) + TOUCH_TOLERANCE_MM:
            return start_state.active_tool_number, z, True
        return None

    def _is_intended_cut(self, body: CollisionBody, move: TipMove, start_state: StartState) -> bool:
        """Return whether a move that hits the part is a feed with a turning spindle, so that it may cut.

        The result is always False for a program that starts at its first line.
        """
        return (
            body is CollisionBody.PART
            and not start_state.starts_at_first_line
            and not move.is_fast
            and move.rpm != 0.0
        )

    def _cut(self, body: CollisionBody, metal: TurnedPart, move: TipMove, now: StartState) -> None:
        cutter = (
            self.part_history.program_tools.make_cutter(move.modal.tool)
            if self._is_intended_cut(body, move, now)
            else None
        )
        if cutter is not None:
            for a, b in pairwise(move.points):
                cutter.cut_material(metal, a, b)

    def _find_safe_jog(self, simulation: PartSimulation, start_state: StartState) -> str:
        """Return the direction of a jog along one axis that retracts the active tool without a collision."""
        tool, (x, z) = start_state.active_tool_number, start_state.axis_positions[:2]
        zero = self._part_zero_for_tool(tool) or (0.0, 0.0)
        side = 1.0 if x >= zero[0] else -1.0
        across = (
            ("X+", (x + side * _JOG_DISTANCE_MM, z))
            if side > 0.0
            else ("X-", (x + side * _JOG_DISTANCE_MM, z))
        )
        for words, end in (("Z+", (x, z + _JOG_DISTANCE_MM)), across):
            paths = [(metal, self._met(metal, tool, (x, z), (x, z))) for _, metal in self._metal(simulation)]
            if all(
                self._met(m, tool, (x, z), end).area <= at.area + TOUCH_TOLERANCE_MM * TOUCH_TOLERANCE_MM
                for m, at in paths
            ):
                return words
        return ""

    # --- tool on the machine ------------------------------------------------------------------------------

    def _met(self, metal: TurnedPart, tool: int, start: Point, end: Point) -> Cut:
        zero = self._part_zero_for_tool(tool)
        if zero is None:
            return NO_CUT
        met = self._solid(tool).find_collision(metal, _tip_position(start, zero), _tip_position(end, zero))
        return met if met.depth_mm > TOUCH_TOLERANCE_MM and met.width_mm > TOUCH_TOLERANCE_MM else NO_CUT

    def _part_zero_for_tool(self, tool: int) -> Point | None:
        """Return the machine X and Z at which a tool is at part zero.

        The result is None if they are unknown, as for T0.
        """
        zero, offset = self.part_history.find_part_zero(tool), self.tool_offsets.get(tool)
        if zero is None and offset is not None:
            return offset.x, offset.z
        return zero

    def _solid(self, tool: int) -> SolidTool:
        if tool not in self._solids:
            self._solids[tool] = make_solid_tool(self._tool_outlines(tool))
        return self._solids[tool]

    def _tool_outlines(self, tool: int) -> tuple[FloatArray, ...]:
        """Return the edges and the body of a specified tool.

        For other tools, return only the parts that are certain: the nose, or the flutes of a drill.
        """
        tools = self.part_history.program_tools
        shape = tools.find_tool_shape(tool)
        if shape is None:
            return make_nose_circle(_NOSE, 0).cutting_outlines
        lines = make_tool_outline(shape)
        if tools.is_shape_specified(tool):
            return (*lines.cutting_outlines, *lines.body_outlines)
        if shape.is_rotating:
            return lines.cutting_outlines
        return make_nose_circle(max(shape.nose_radius, _NOSE), shape.tip).cutting_outlines
