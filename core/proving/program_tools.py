"""The stock and tools of a program, either specified or assumed from its moves."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from core.interpreter.shared.actions import (
    ColletSwitch,
    InputRead,
    InputWait,
    OutputSwitch,
    ProgramStop,
    ToolChange,
)
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.units import MM_PER_INCH
from core.message import Message
from core.part.cutter import CutSide, Cutter
from core.part.stock import Clamping, Point, Stock
from core.part.stock_spec import StockSpec
from core.part.tool_outline import make_tool_outline
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import DEFAULT_COLUMN_WIDTH_MM
from core.proving.assumed_tools import (
    GROOVING_TOOLS,
    HOLE_TOOLS,
    AssumedTool,
    ToolUse,
    assume_tool,
    has_releasing_tap_holder,
)
from core.proving.checks.thread_checks import UNKNOWN_LIMITS, DriveLimits
from core.proving.tip_moves import FAST_FEED_MM_S, LiveToolStep, MachineXZ, ProgramStep, TipMove
from core.tool_edges import format_edge_name

_PLUNGE = 0.5  # mm
_FED_AWAY_MM = 1.0  # mm
_EXTRA_RADIUS_MM = 0.25  # mm of radius added to a bar
_EXTRA_BAR_MM = 10.0  # mm of bar past the last cut
_SAME = 0.01
_NEAR_FACE, _CENTRE = 1.0, 1.0  # mm; a cut from outside to the axis within this range is the face
_BORE_MARGIN_MM = 6.35  # mm; feeds further outside do not belong to a bore
_MIN_RADIUS_MM = 0.5  # mm of radius
_WALL = 2.0  # mm of wall around a bore
_FACE_MARGIN_MM = 5.0  # mm before Z0; a missing minus sign gives smaller values or affects one move only
_MAX_FEED_FRACTION = 0.5  # fraction of all feeds


@dataclass(frozen=True, slots=True)
class PartSettings:
    """The specified stock, tools (by T number) and clamping.

    The nose radii in mm are those of the tool offsets.
    """

    stock: Stock | StockSpec | None = None
    shapes: Mapping[int, ToolShape] = field(default_factory=dict)
    nose_radii: Mapping[int, float] = field(default_factory=dict)
    clamping: Clamping | None = None
    gang: Mapping[int, Point] = field(default_factory=dict)  # Z and X of the tools on a gang plate
    tips: Mapping[int, MachineXZ] = field(default_factory=dict)  # as described in ``Steps``
    drives: DriveLimits = UNKNOWN_LIMITS
    live_codes: bool = False  # the machine has M codes that switch live tools
    step: float = DEFAULT_COLUMN_WIDTH_MM  # width of a column of the part, mm
    silenced: Mapping[str, str] = field(default_factory=dict)  # reason by check
    travel: tuple[Point, Point] | None = None  # travel of X and of Z from home, mm

    @property
    def can_refuse_start(self) -> bool:
        """Return whether an error about the part can prevent a start.

        This is possible only if the stock or the clamping is specified, not assumed.
        """
        return self.stock is not None or self.clamping is not None


class ProgramTools:
    """The tools of a program by T number.

    All moves are collected first, because assumptions depend on them.
    """

    def __init__(self, steps: Sequence[ProgramStep], part_settings: PartSettings) -> None:
        self.tool_uses: dict[int, ToolUse] = {}
        self.bar_stop_z: float | None = None  # Z of the bar stop in mm
        self.feeds_bar_first = False  # the bar is fed before the first cut
        self._setting = part_settings
        self._gather(steps)
        self.assumed_tools: dict[int, AssumedTool] = {
            n: assume_tool(use, part_settings.shapes.get(n))
            for n, use in self.tool_uses.items()
            if self._lacks_something(n)
            and (use.moves or use.live_tool_steps)
            and (n or len(self.tool_uses) == 1)
        }  # T0 counts as a tool only if the program names no other
        self._assume_sizes()

    def _gather(self, steps: Sequence[ProgramStep]) -> None:
        use, is_open, cut = self._use(0), False, False
        place, comment = (0.0, 0.0), ""
        for step in steps:
            if isinstance(step, TipMove):
                place = step.points[-1]
                use.moves.append(step)
                use.is_bar_stop = use.is_bar_stop or (is_open and not step.is_fast)
                cut = cut or not (step.is_fast or is_open or self._stop_to_come(use))
            elif isinstance(step, LiveToolStep):
                use.live_tool_steps.append(step)
                cut = True
            elif isinstance(step.action, ToolChange):
                use = self._use(step.action.tool)
                use.comments.append(step.modal.comment if step.modal.comment != comment else "")
            elif isinstance(step.action, ProgramStop | OutputSwitch | InputWait | InputRead):
                use.has_pause = True
            elif isinstance(step.action, ColletSwitch):
                use.has_pause = True
                is_open = not step.action.closed
                self.feeds_bar_first = self.feeds_bar_first or (is_open and not cut)
                if not is_open and use.is_bar_stop and self.bar_stop_z is None:
                    self.bar_stop_z = place[0]
            comment = (step.block if isinstance(step, LiveToolStep) else step).modal.comment

    def _use(self, number: int) -> ToolUse:
        nose = self._setting.nose_radii.get(number, 0.0)
        return self.tool_uses.setdefault(number, ToolUse(number, nose_radius=nose))

    @staticmethod
    def _stop_to_come(use: ToolUse) -> bool:
        return use.is_bar_stop or any("STOP" in text.upper() for text in use.comments)

    def _lacks_something(self, number: int) -> bool:
        said = self._setting.shapes.get(number)
        return said is None or (said.kind in GROOVING_TOOLS and not said.width)

    def _assume_sizes(self) -> None:
        """Set the unknown sizes of drills and grooving tools, derived from the cuts of later tools."""
        bore = [
            m
            for n, use in self.tool_uses.items()
            if (s := self.find_tool_shape(n)) and s.internal
            for m in use.moves
        ]
        threads = [
            m for use in self.tool_uses.values() for m in use.moves if m.block_kind is BlockKind.THREAD
        ]
        for number, each in self.assumed_tools.items():
            use = self.tool_uses[number]
            self.assumed_tools[number] = each.add_assumed_diameter(use, bore).add_assumed_width(use, threads)

    def find_tool_shape(self, number: int) -> ToolShape | None:
        """Return the shape of a tool, or None for a bar stop or an unknown cutting shape."""
        if number in self.assumed_tools:
            return self.assumed_tools[number].tool_shape
        return self._setting.shapes.get(number)

    @property
    def unsized_drills(self) -> list[int]:
        """Return the T numbers of the program's drills and reamers whose diameter is assumed."""
        return [
            n
            for n, each in sorted(self.assumed_tools.items())
            if each.tool_shape is not None and each.tool_shape.kind in HOLE_TOOLS and each.is_diameter_assumed
        ]

    def is_shape_specified(self, number: int) -> bool:
        """Return whether the shape of the tool is specified."""
        return number in self._setting.shapes

    def has_releasing_tap_holder(self, number: int) -> bool:
        """Return whether a comment names a tap holder that reverses or releases the tap automatically."""
        return has_releasing_tap_holder(self.tool_uses[number]) if number in self.tool_uses else False

    def make_cutter(self, number: int) -> Cutter | None:
        """Return a cutter for the tool, or None if it has no cutting shape or is a radial live tool.

        Without a specified holder, only the edges of the tool are used.
        """
        shape = self.find_tool_shape(number)
        if shape is None or (shape.is_rotating and shape.direction[0] == 0):
            return None  # a live tool across the spindle cannot turn
        lines = make_tool_outline(shape)
        body = lines.body_outlines if self.is_shape_specified(number) else ()
        return Cutter(
            lines.cutting_outlines, body, _side(shape), is_rear=shape.is_rear_tool, is_drill=shape.is_rotating
        )

    @property
    def unit_mm(self) -> float:
        """Return the length unit of the program in mm, from its first move."""
        metric = (use.is_metric for use in self.tool_uses.values() if use.moves or use.live_tool_steps)
        return 1.0 if next(metric, False) else MM_PER_INCH

    @property
    def back_z_mm(self) -> float:
        """Return the least Z of all cuts, in mm."""
        moves = (
            m for use in self.tool_uses.values() for m in use.moves if not (m.is_fast or use.is_bar_stop)
        )
        return min((z for move in moves for z, _ in move.points), default=0.0)

    @property
    def part_off_z_mm(self) -> float | None:
        """Return the deepest Z of a parting tool that feeds toward the axis, or None if none does."""
        deepest: list[float] = []
        for number, use in self.tool_uses.items():
            shape = self.find_tool_shape(number)
            if shape is None or shape.kind is not ToolKind.PARTING:
                continue
            edge_width_mm = (
                shape.width * (1 + shape.direction[0]) / 2.0
            )  # width of the edge beyond the corner that is set
            feed_moves = [(*m.points[0], *m.points[-1]) for m in use.moves if not m.is_fast]
            deepest += [z1 - edge_width_mm for _, r0, z1, r1 in feed_moves if abs(r1) < abs(r0) - _PLUNGE]
        return min(deepest, default=None)

    def find_feeds_without_cut(self, stock: Stock | None) -> Iterator[tuple[int, int, str]]:
        """Yield the line, block number and message for each cutting tool that makes only rapids.

        If ``stock`` is None, also yield them for ``longest_feed_from_chuck`` and for the first feed of each
        live tool, because these feeds cut nothing.
        """
        cutting = [use for n, use in self.tool_uses.items() if self.find_tool_shape(n) is not None]
        for use in cutting:
            if (move := use.first_rapid_position) is not None:
                yield (
                    move.line,
                    move.n,
                    (
                        Message(
                            "{number} makes no feed moves; all its moves are rapids.",
                            number=format_edge_name(use.tool_number),
                        )
                    ),
                )
        if stock is not None:
            return
        if (lost := self.longest_feed_from_chuck) is not None:
            yield (
                lost.line,
                lost.n,
                (
                    "This feed move goes away from the part, and no other feed move cuts past Z0 "
                    "toward the spindle."
                ),
            )
        for use in cutting:
            fed = [block for block in use.live_tool_blocks if not block.rapid and block.feed < FAST_FEED_MM_S]
            if fed:
                yield (
                    fed[0].line,
                    fed[0].n,
                    (
                        Message(
                            "Live tool {number} feeds, but never past Z0 toward the spindle.",
                            number=format_edge_name(use.tool_number),
                        )
                    ),
                )

    @property
    def longest_feed_from_chuck(self) -> TipMove | None:
        """Return the longest feed away from the chuck, if the feeds together lead away from the chuck.

        The result is None if they do not, or if part zero is at the chuck.
        """
        feeds = [
            m
            for n, use in self.tool_uses.items()
            if self.find_tool_shape(n)
            for m in use.moves
            if not m.is_fast
        ]
        along = [move.points[-1][0] - move.points[0][0] for move in feeds]
        if sum(along) <= _FED_AWAY_MM or has_zero_at_chuck(feeds):
            return None
        return feeds[along.index(max(along))]

    def assume_stock(self) -> Stock | None:
        """Return the stock that the cuts of the tools suggest, or None if it cannot be derived."""
        outside: list[TipMove] = []
        bore: list[TipMove] = []
        for number, use in self.tool_uses.items():
            shape = self.find_tool_shape(number)
            if shape is not None:
                (outside if _side(shape) is CutSide.OUTSIDE else bore).extend(use.moves)
        live = [step for use in self.tool_uses.values() for step in use.live_tool_steps]
        drills = [
            s.diameter for s in map(self.find_tool_shape, self.tool_uses) if s is not None and s.is_rotating
        ]
        return assume_stock(outside, bore, self.bar_stop_z, max(drills, default=0.0), live)


def _side(shape: ToolShape) -> CutSide:
    if shape.is_rotating or shape.internal:
        return CutSide.BORE
    if shape.direction == (-1, 0) and shape.kind is not ToolKind.TURNING:
        return CutSide.FACE
    across = shape.direction[1] * (-1 if shape.is_rear_tool else 1)
    return CutSide.BORE if across > 0 else CutSide.OUTSIDE


def assume_stock(
    outside: Sequence[TipMove],
    bore: Sequence[TipMove],
    bar_stop_z: float | None,
    max_drill_diameter: float,
    live_steps: Sequence[LiveToolStep] = (),
) -> Stock | None:
    """Return a bar for the moves of outside tools, or a tube if boring starts without a drilled hole.

    ``bar_stop_z`` is the Z in mm of the bar stop; None means Z0. ``max_drill_diameter`` is the diameter of
    the largest drill, or 0 without a drill. Returns None if no move cuts past the face, or if part zero is
    not at the face.
    """
    cuts = [move for move in (*outside, *bore) if not move.is_fast]
    if bar_stop_z is None and has_zero_at_chuck(cuts):
        return None
    front = _find_face_z((*outside, *bore)) if bar_stop_z is None else bar_stop_z
    milled = [step for step in live_steps if not step.block.rapid and step.block.feed < FAST_FEED_MM_S]
    depths = [z for move in cuts for z, _ in move.points] + [b.reach()[2] + dz for b, (_, dz) in milled]
    back = min(depths, default=front)
    if back > front or not depths:
        return None
    reach = max((_live_tool_radius(step) for step in milled), default=0.0)
    radius = max(_bar_radius(outside, bore, front) if cuts else reach, max_drill_diameter)
    hole = 0.0 if max_drill_diameter else min(_bore_radius(bore, front), radius - _SAME)
    ends = back - _EXTRA_BAR_MM, front
    inner = tuple((z, hole) for z in ends) if hole > 0.0 else ()
    return Stock("", tuple((z, radius) for z in ends), inner)


def has_zero_at_chuck(cuts: Sequence[TipMove]) -> bool:
    """Return whether part zero is at the chuck end of the part.

    This is assumed if most feeds are in front of Z0.
    """
    before = sum(move.length_mm for move in cuts if min(z for z, _ in move.points) > _FACE_MARGIN_MM)
    return before > _MAX_FEED_FRACTION * sum(move.length_mm for move in cuts)


def _find_face_z(moves: Sequence[TipMove]) -> float:
    """Return the Z of the face of the stock, or 0 if the face is not cut.

    The assumed face is slightly in front of the first face cut, and clear of rapids.
    """
    faced = [m.points[-1][0] for m in moves if _cuts_face(m)]
    if not faced:
        return 0.0
    face = max(faced)
    free = min((z for m in moves if m.is_fast for z, _ in m.points if z > face + _SAME), default=face)
    return face + min(_EXTRA_RADIUS_MM, (free - face) / 2.0)


def _cuts_face(move: TipMove) -> bool:
    """Return whether a move goes from outside to the axis near Z0, as a face cut does.

    The move may also be a rapid, in case G00 was left active by mistake.
    """
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    across = abs(z1 - z0) <= _SAME and abs(r1) < _CENTRE < abs(r0) - _CENTRE
    return across and -_SAME <= z1 < _NEAR_FACE / 2.0


def _bar_radius(outside: Sequence[TipMove], bore: Sequence[TipMove], front: float) -> float:
    """Return the assumed bar radius: slightly above the largest cut, but clear of all rapids.

    If only grooves or faces are cut, the bar is slightly smaller than the start of the largest of these
    cuts.
    """
    feeds = [move for move in outside if not move.is_fast]
    cuts = [move for move in feeds if min(z for z, _ in move.points) < front - _SAME]
    along = [_bar_radius_for_move(m) for m in cuts if _is_turning_move(m, front)]
    largest = max(along, default=math.inf) + _BORE_MARGIN_MM
    widest = max((r for r in _radii(bore) if r < largest), default=0.0)
    sunk = [min(abs(r) for _, r in m.points) + _EXTRA_RADIUS_MM for m in cuts if along and _is_plunge(m)]
    begins = [max(abs(r) for _, r in move.points) - 2.0 * _EXTRA_RADIUS_MM for move in cuts or feeds]
    faced = _facing_start_radius(feeds, front)
    cut = max([*along, *sunk, widest] if along or widest else begins, default=_MIN_RADIUS_MM)
    if faced < math.inf:
        cut = min(max(cut, faced - 3.0 * _EXTRA_RADIUS_MM), faced)
    passed = [abs(r) for m in outside if m.is_fast for z, r in m.points if z < front - _SAME]
    rapid_radii = [r for r in passed if r >= cut - _SAME]
    return max(min([cut + _EXTRA_RADIUS_MM, *rapid_radii]), widest + _WALL if widest else 0.0, _MIN_RADIUS_MM)


def _is_turning_move(move: TipMove, front: float) -> bool:
    """Return whether a move goes along Z inside the part.

    A move that ends in front of the face is a retract.
    """
    z0, z1 = move.points[0][0], move.points[-1][0]
    return abs(z1 - z0) > _SAME and not z1 > max(z0, front + _NEAR_FACE)


def _is_plunge(move: TipMove) -> bool:
    """Return whether a move goes perpendicularly toward the axis and ends before it reaches the axis."""
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    return abs(z1 - z0) <= _SAME and abs(r0) > abs(r1) > _CENTRE


def _radii(moves: Iterable[TipMove]) -> Iterator[float]:
    return (abs(r) for move in moves if not move.is_fast for _, r in move.points)


def _live_tool_radius(step: LiveToolStep) -> float:
    """Return a radius slightly less than the outer end of a live tool's cut."""
    low, high, _, _ = step.block.reach()
    return (
        max(
            abs(low + step.part_zero[0]),
            abs(high + step.part_zero[0]),
            abs(step.block.x0 + step.part_zero[0]),
        )
        - _EXTRA_RADIUS_MM
    )


def _facing_start_radius(feeds: Iterable[TipMove], front: float) -> float:
    """Return the start radius of the first cut if it faces the part, otherwise inf.

    The bar is never larger than this radius.
    """
    for move in feeds:
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        if abs(abs(r1) - abs(r0)) > _CENTRE:
            faces = abs(z1 - z0) <= _SAME and z1 > front - _NEAR_FACE and abs(r1) < _CENTRE < abs(r0)
            return abs(r0) if faces else math.inf
        if z1 < front - _NEAR_FACE:
            return math.inf
    return math.inf


def _bar_radius_for_move(move: TipMove) -> float:
    """Return the bar radius that a move along Z requires.

    An arc may bulge outward, and an outward line may leave the part.
    """
    radii = [abs(r) for _, r in move.points]
    return max(radii) if move.block_kind is BlockKind.ARC else min(radii)


def _bore_radius(bore: Iterable[TipMove], front: float) -> float:
    """Return a radius slightly less than the smallest radius cut in the bore, or 0 without a cut."""
    cuts = [m for m in bore if not m.is_fast and min(z for z, _ in m.points) < front - _SAME]
    return max(min((max(abs(r) for _, r in m.points) for m in cuts), default=0.0) - _EXTRA_RADIUS_MM, 0.0)
