"""Check of the first move of a start against the present part, up to the first known position.

The proof of a program starts at its first known position. The moves before it depend on the axis positions at
Cycle Start. For example, after an E-stop in a bore, the straight line to the first position passes through
the wall of the bore. The check runs on a worker thread.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from itertools import pairwise

from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ToolOffset
from core.part.cutter import SolidTool, solid_tool
from core.part.swept_edge import FloatArray, Point
from core.part.tool_outline import nose_circle, outline
from core.part.turned_part import NOTHING, Cut, TurnedPart
from core.proving.part_history import Go, PartHistory
from core.proving.part_making import PartMaking
from core.proving.tip_moves import Steps, TipMove

MET = 0.1
"""mm of metal, in r and in Z, up to which a tool only touches the part: feed marks, the braking of a stop."""

ASIDE = 7.3  # mm, offset of a second start position, chosen to differ from all programmed positions
_SAME = 1e-6  # mm
_NOSE = 0.4  # mm, assumed nose radius of the insert
_MOST = 60  # largest number of moves that are checked
_FAR = 500.0  # mm, distance of a jog that moves a tool clear

Passes = Callable[[tuple[float, ...]], Iterable[Block]]
"""The blocks of what is started, from these axis positions on, machine mm."""


class Body(Enum):
    """The objects that a tool may hit."""

    PART = "part"
    CHUCK = "into-chuck"
    TAILSTOCK = "into-tailstock"


@dataclass(frozen=True, slots=True)
class StartNow:
    """The machine at a start: axis positions (machine mm, X as a radius, then Z) and the active tool.

    ``broken`` is the interrupted elementary block with its machine X and Z, or None. ``strict`` means that a
    program starts at its first line, so that it only positions before its first known position.
    """

    at: tuple[float, ...]
    tool: int
    broken: tuple[int, Point] | None = None
    strict: bool = True


@dataclass(frozen=True, slots=True)
class FirstMove:
    """The finding about a first move.

    ``path`` is the move in machine X and Z in mm, with a flag for each rapid. ``zero`` is machine X and Z at
    which the displayed tip is at part zero. It belongs to the tool that hits something, or otherwise to the
    tool at the end of the move. ``met`` is the object that ``tool`` hits at Z ``z`` (mm, part's frame), even
    before it moves if ``inside`` is True. ``out`` is the direction of a safe jog, such as ``Z+``, or empty if
    no direction is certain.
    """

    path: tuple[tuple[float, float, bool], ...]
    zero: Point = (0.0, 0.0)
    met: Body | None = None
    tool: int = 0
    z: float = 0.0
    inside: bool = False
    out: str = ""
    assumed: bool = False  # the part or the tool is assumed
    known: bool = True  # the part is known


def first_moves(passes: Passes, at: tuple[float, ...]) -> list[TipMove]:
    """Return the moves up to the first position that does not depend on the axis positions."""
    aside = tuple(each + ASIDE for each in at)
    steps, found = Steps(), list[TipMove]()
    for block, other in zip(passes(at), passes(aside), strict=False):
        if block.travel is not None or block.plane is not None:
            break
        found += (step for step in steps.of([block]) if isinstance(step, TipMove))
        if block.action is None and (_is_known(block, other) or len(found) >= _MOST):
            break
    return found


def _is_known(one: Block, other: Block) -> bool:
    same = abs(one.x + one.offset_x - other.x - other.offset_x) < _SAME
    return same and abs(one.z + one.offset_z - other.z - other.offset_z) < _SAME


def unchecked(moves: Sequence[TipMove]) -> FirstMove:
    """Return the first move that consists of these moves, without a check for hits."""
    if not moves:
        return FirstMove(())
    legs = [(*_machine(moves[0].points[0], moves[0].zero), True)]
    for move in moves:
        legs += ((*_machine(point, move.zero), move.quick) for point in move.points[1:])
    return FirstMove(tuple(legs), moves[-1].zero)


def _tip(at: Point, zero: Point) -> Point:
    """Return Z and r of the tip in the part's frame in mm, with the axes at machine X and Z."""
    return at[1] - zero[1], at[0] - zero[0]


def _machine(point: Point, zero: Point) -> tuple[float, float]:
    return point[1] + zero[0], point[0] + zero[1]


@dataclass(slots=True)
class StartCheck:
    """Checks starts against the part of one program; ``offsets`` are those of its job, by T."""

    history: PartHistory
    offsets: dict[int, ToolOffset]
    stock_specified: bool
    silenced: frozenset[str] = frozenset()
    _solids: dict[int, SolidTool] = field(default_factory=dict)

    def find(self, passes: Passes, now: StartNow, watch: Go | None = None) -> FirstMove:
        """Return the first move of this start and the object that it hits, if any."""
        moves = first_moves(passes, now.at)
        making = self._making(now, watch)
        known = making.milling is None and (making.part is not None or self.history.stock is None)
        found = replace(unchecked(moves), known=known or now.broken is None)
        for body, metal in self._metal(making):
            hit = self._hit(body, metal, moves, now)
            if hit is not None:
                tool, z, inside = hit
                return replace(
                    found,
                    zero=self._zero(tool) or found.zero,
                    met=body,
                    tool=tool,
                    z=z,
                    inside=inside,
                    out=self._out(making, now),
                    assumed=self._is_assumed(body, tool, now),
                )
        return found

    def _making(self, now: StartNow, watch: Go | None) -> PartMaking:
        if now.broken is None:
            return self.history.making_at(1, watch=watch)
        block, where = now.broken
        zero = self._zero(now.tool)
        return self.history.making_at(block, _tip(where, zero) if zero is not None else None, watch)

    def _is_assumed(self, body: Body, tool: int, now: StartNow) -> bool:
        """Return whether the finding depends on an assumption.

        A tool that was stopped in a cut is certainly in the part. Without an active tool, the tip is unknown.
        """
        if tool == 0:
            return True
        if body is Body.PART and now.broken is None and not self.stock_specified:
            return True
        return now.broken is None and not self.history.tools.described(tool)

    def _metal(self, making: PartMaking) -> Iterator[tuple[Body, TurnedPart]]:
        if making.part is not None and making.milling is None and not making.is_open:
            yield Body.PART, making.part
        for check, body in making.findings.bodies.items():
            if check not in self.silenced:
                yield Body(check), body

    def _hit(
        self, body: Body, metal: TurnedPart, moves: Sequence[TipMove], now: StartNow
    ) -> tuple[int, float, bool] | None:
        """Return tool, Z, and whether the tool is inside before it moves; None without a hit."""
        here = (now.at[0], now.at[1])
        if now.tool == 0 and now.broken is None:
            now = replace(now, strict=False)  # Without an active tool, the position of its tip is unknown.
        standing = self._met(metal, now.tool, here, here)
        if standing and now.strict:
            return now.tool, standing.front, True
        for move in moves:
            for number in dict.fromkeys((now.tool, move.modal.tool)):
                for a, b in pairwise(move.points):
                    met = self._met(metal, number, _machine(a, move.zero), _machine(b, move.zero))
                    if met.area > standing.area + MET * MET and not self._cuts(body, move, now):
                        return number, met.front, False
            self._cut(body, metal, move, now)
        if body is Body.PART and now.strict and now.broken is not None:
            return self._enclosing(metal, now)
        return None

    def _enclosing(self, metal: TurnedPart, now: StartNow) -> tuple[int, float, bool] | None:
        """Return the hit of a tool that stopped in a bore, or None if no material is outside its tip.

        The first move may remain in the bore, but the next tools would then move this tool through the wall.
        """
        zero = self._zero(now.tool)
        if zero is None:
            return None
        z, r = _tip((now.at[0], now.at[1]), zero)
        around = metal.outermost[abs(metal.columns.middles - z) <= max(2 * MET, metal.columns.step)]
        if len(around) and float(around.min()) > abs(r) + MET:
            return now.tool, z, True
        return None

    def _cuts(self, body: Body, move: TipMove, now: StartNow) -> bool:
        """Return whether the move is meant to cut this material."""
        return body is Body.PART and not now.strict and not move.quick and move.rpm != 0.0

    def _cut(self, body: Body, metal: TurnedPart, move: TipMove, now: StartNow) -> None:
        cutter = self.history.tools.cutter(move.modal.tool) if self._cuts(body, move, now) else None
        if cutter is not None:
            for a, b in pairwise(move.points):
                cutter.cut(metal, a, b)

    def _out(self, making: PartMaking, now: StartNow) -> str:
        """Return the direction of a jog along one axis that moves the active tool out without a hit."""
        tool, (x, z) = now.tool, now.at[:2]
        zero = self._zero(tool) or (0.0, 0.0)
        side = 1.0 if x >= zero[0] else -1.0
        across = ("X+", (x + side * _FAR, z)) if side > 0.0 else ("X-", (x + side * _FAR, z))
        for words, end in (("Z+", (x, z + _FAR)), across):
            paths = [(metal, self._met(metal, tool, (x, z), (x, z))) for _, metal in self._metal(making)]
            if all(self._met(m, tool, (x, z), end).area <= at.area + MET * MET for m, at in paths):
                return words
        return ""

    # --- tool on the machine ------------------------------------------------------------------------------

    def _met(self, metal: TurnedPart, tool: int, start: Point, end: Point) -> Cut:
        zero = self._zero(tool)
        if zero is None:
            return NOTHING
        met = self._solid(tool).met(metal, _tip(start, zero), _tip(end, zero))
        return met if met.depth > MET and met.width > MET else NOTHING

    def _zero(self, tool: int) -> Point | None:
        """Return machine X and Z at which this tool is at part zero, or None if unknown, as for T0."""
        zero, offset = self.history.zero(tool), self.offsets.get(tool)
        if zero is None and offset is not None:
            return offset.x, offset.z
        return zero

    def _solid(self, tool: int) -> SolidTool:
        if tool not in self._solids:
            self._solids[tool] = solid_tool(self._outlines(tool))
        return self._solids[tool]

    def _outlines(self, tool: int) -> tuple[FloatArray, ...]:
        """Return edges and body of a specified tool, or else its certain parts: nose, or drill flutes."""
        tools = self.history.tools
        shape = tools.shape(tool)
        if shape is None:
            return nose_circle(_NOSE, 0).cutting
        lines = outline(shape)
        if tools.described(tool):
            return (*lines.cutting, *lines.body)
        if shape.turns_itself:
            return lines.cutting
        return nose_circle(max(shape.nose_radius, _NOSE), shape.tip).cutting
