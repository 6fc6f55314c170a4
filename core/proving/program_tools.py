"""The stock and tools of a program: described by somebody, or assumed by what it does with them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from core.interpreter.shared.actions import AskInput, Collet, Output, ProgramStop, ToolChange, WaitInput
from core.interpreter.shared.elementary_blocks import Kind
from core.interpreter.shared.units import MM_PER_INCH
from core.message import Message
from core.part.cutter import Cutter, Side
from core.part.stock import Clamping, Point, Stock
from core.part.stock_spec import StockSpec
from core.part.tool_outline import outline
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import STEP
from core.proving.assumed_tools import GROOVERS, OPENS, Assumed, ToolUse, assumed_tool, releases
from core.proving.checks.thread_checks import UNKNOWN, Drives
from core.proving.tip_moves import QUICK, LiveStep, Place, Step, TipMove
from core.tool_edges import edge_name

_PLUNGE = 0.5  # mm
_FED_AWAY = 1.0  # mm
_MORE = 0.25  # mm of radius that a bar is larger
_BEHIND = 10.0  # mm of bar behind the last cut
_SAME = 0.01
_NEAR_FACE, _CENTRE = 1.0, 1.0  # mm; a cut from outside to the axis here is the face
_BEYOND = 6.35  # mm; what is fed further out than the outside is no bore
_LEAST = 0.5  # mm of radius
_WALL = 2.0  # mm around a bore
_BEFORE = 5.0  # mm before Z0; a lost minus is nearer, or one move of many
_MOST = 0.5  # of what is fed


@dataclass(frozen=True, slots=True)
class PartSetting:
    """What has been said about stock, tools (by T) and clamping; nose radii, mm, come from the offsets."""

    stock: Stock | StockSpec | None = None
    shapes: Mapping[int, ToolShape] = field(default_factory=dict)
    nose_radii: Mapping[int, float] = field(default_factory=dict)
    clamping: Clamping | None = None
    gang: Mapping[int, Point] = field(default_factory=dict)  # Z and X of the tools that ride one plate
    tips: Mapping[int, Place] = field(default_factory=dict)  # as ``Steps`` has them
    drives: Drives = UNKNOWN
    live_codes: bool = False  # the machine has M codes that switch live tools
    step: float = STEP  # width of a column of the part, mm
    silenced: Mapping[str, str] = field(default_factory=dict)  # why, by check
    travel: tuple[Point, Point] | None = None  # of X and of Z, from home, mm

    @property
    def may_refuse(self) -> bool:
        """Whether enough is said for an error of the part to rest on nothing that is assumed."""
        return self.stock is not None or self.clamping is not None


class ProgramTools:
    """By T. What is assumed of one follows from all moves of the program, so these are gathered first."""

    def __init__(self, steps: Sequence[Step], setting: PartSetting) -> None:
        self.uses: dict[int, ToolUse] = {}
        self.fed_at: float | None = None  # Z, mm, where a stop has held the bar
        self.feeds_first = False  # the bar is fed before the first cut
        self._setting = setting
        self._gather(steps)
        self.assumed: dict[int, Assumed] = {
            n: assumed_tool(use, setting.shapes.get(n))
            for n, use in self.uses.items()
            if self._lacks_something(n) and (use.moves or use.live) and (n or len(self.uses) == 1)
        }  # T0 is none, but where the program names none at all
        self._give_sizes()

    def _gather(self, steps: Sequence[Step]) -> None:
        use, is_open, cut = self._use(0), False, False
        place, comment = (0.0, 0.0), ""
        for step in steps:
            if isinstance(step, TipMove):
                place = step.points[-1]
                use.moves.append(step)
                use.pushes_bar = use.pushes_bar or (is_open and not step.quick)
                cut = cut or not (step.quick or is_open or self._stop_to_come(use))
            elif isinstance(step, LiveStep):
                use.live.append(step)
                cut = True
            elif isinstance(step.action, ToolChange):
                use = self._use(step.action.tool)
                use.comments.append(step.modal.comment if step.modal.comment != comment else "")
            elif isinstance(step.action, ProgramStop | Output | WaitInput | AskInput):
                use.paused = True
            elif isinstance(step.action, Collet):
                use.paused = True
                is_open = not step.action.closed
                self.feeds_first = self.feeds_first or (is_open and not cut)
                if not is_open and use.pushes_bar and self.fed_at is None:
                    self.fed_at = place[0]
            comment = (step.block if isinstance(step, LiveStep) else step).modal.comment

    def _use(self, number: int) -> ToolUse:
        nose = self._setting.nose_radii.get(number, 0.0)
        return self.uses.setdefault(number, ToolUse(number, nose_radius=nose))

    @staticmethod
    def _stop_to_come(use: ToolUse) -> bool:
        return use.pushes_bar or any("STOP" in text.upper() for text in use.comments)

    def _lacks_something(self, number: int) -> bool:
        said = self._setting.shapes.get(number)
        return said is None or (said.kind in GROOVERS and not said.width)

    def _give_sizes(self) -> None:
        """Drills and grooves of unknown size leave as much as the tools behind them need to get in."""
        bore = [m for n, use in self.uses.items() if (s := self.shape(n)) and s.internal for m in use.moves]
        threads = [m for use in self.uses.values() for m in use.moves if m.kind is Kind.THREAD]
        for number, each in self.assumed.items():
            use = self.uses[number]
            self.assumed[number] = each.with_diameter(use, bore).with_width(use, threads)

    def shape(self, number: int) -> ToolShape | None:
        """The tool's shape; None for a bar stop, and where nothing is known that would cut."""
        if number in self.assumed:
            return self.assumed[number].shape
        return self._setting.shapes.get(number)

    @property
    def unsized_drills(self) -> list[int]:
        """The drills and reamers of the program whose diameter is assumed, by T."""
        return [
            n
            for n, each in sorted(self.assumed.items())
            if each.shape is not None and each.shape.kind in OPENS and each.sized
        ]

    def described(self, number: int) -> bool:
        """Whether somebody has said what it looks like."""
        return number in self._setting.shapes

    def releases(self, number: int) -> bool:
        """Whether a comment says that the holder of a tap turns it back, or lets it go, by itself."""
        return releases(self.uses[number]) if number in self.uses else False

    def cutter(self, number: int) -> Cutter | None:
        """The tool ready to cut; without a described holder only its edges count."""
        shape = self.shape(number)
        if shape is None or (shape.turns_itself and shape.direction[0] == 0):
            return None  # a live tool across the spindle turns nothing
        lines = outline(shape)
        body = lines.body if self.described(number) else ()
        return Cutter(lines.cutting, body, _side(shape), rear=shape.behind, drills=shape.turns_itself)

    @property
    def unit(self) -> float:
        """Millimetres in a unit of length of the program, by its first move."""
        metric = (use.metric for use in self.uses.values() if use.moves or use.live)
        return 1.0 if next(metric, False) else MM_PER_INCH

    @property
    def back(self) -> float:
        """Least Z that a tool cuts at, mm."""
        moves = (m for use in self.uses.values() for m in use.moves if not (m.quick or use.pushes_bar))
        return min((z for move in moves for z, _ in move.points), default=0.0)

    @property
    def parted_at(self) -> float | None:
        """The deepest Z to which a parting tool cuts that is fed towards the axis; None: there is none."""
        deepest: list[float] = []
        for number, use in self.uses.items():
            shape = self.shape(number)
            if shape is None or shape.kind is not ToolKind.PARTING:
                continue
            behind = (
                shape.width * (1 + shape.direction[0]) / 2.0
            )  # of the edge, beyond the corner that is set
            ways = [(*m.points[0], *m.points[-1]) for m in use.moves if not m.quick]
            deepest += [z1 - behind for _, r0, z1, r1 in ways if abs(r1) < abs(r0) - _PLUNGE]
        return min(deepest, default=None)

    def nothing_cut(self, stock: Stock | None) -> Iterator[tuple[int, int, str]]:
        """Line, block and sentence of what should have cut and has not: tools never fed, feeds all away."""
        cutting = [use for n, use in self.uses.items() if self.shape(n) is not None]
        for use in cutting:
            if (move := use.never_fed) is not None:
                yield (
                    move.line,
                    move.n,
                    (
                        Message(
                            "{number} makes no feed moves; all its moves are rapids.",
                            number=edge_name(use.number),
                        )
                    ),
                )
        if stock is not None:
            return
        if (lost := self.fed_away) is not None:
            yield (
                lost.line,
                lost.n,
                (
                    "This feed move goes away from the part, and no other feed move cuts past Z0 "
                    "toward the spindle."
                ),
            )
        for use in cutting:
            fed = [block for block in use.live_blocks if not block.rapid and block.feed < QUICK]
            if fed:
                yield (
                    fed[0].line,
                    fed[0].n,
                    (
                        Message(
                            "Live tool {number} feeds, but never past Z0 toward the spindle.",
                            number=edge_name(use.number),
                        )
                    ),
                )

    @property
    def fed_away(self) -> TipMove | None:
        """The longest feed away from the chuck, where all feeds together lead that way."""
        feeds = [m for n, use in self.uses.items() if self.shape(n) for m in use.moves if not m.quick]
        along = [move.points[-1][0] - move.points[0][0] for move in feeds]
        if sum(along) <= _FED_AWAY or zero_behind(feeds):
            return None
        return feeds[along.index(max(along))]

    def assumed_stock(self) -> Stock | None:
        """A bar for what the tools cut."""
        outside: list[TipMove] = []
        bore: list[TipMove] = []
        for number, use in self.uses.items():
            shape = self.shape(number)
            if shape is not None:
                (outside if _side(shape) is Side.OUTSIDE else bore).extend(use.moves)
        live = [step for use in self.uses.values() for step in use.live]
        drills = [s.diameter for s in map(self.shape, self.uses) if s is not None and s.turns_itself]
        return assumed_stock(outside, bore, self.fed_at, max(drills, default=0.0), live)


def _side(shape: ToolShape) -> Side:
    if shape.turns_itself or shape.internal:
        return Side.BORE
    if shape.direction == (-1, 0) and shape.kind is not ToolKind.TURNING:
        return Side.FACE
    across = shape.direction[1] * (-1 if shape.behind else 1)
    return Side.BORE if across > 0 else Side.OUTSIDE


def assumed_stock(
    outside: Sequence[TipMove],
    bore: Sequence[TipMove],
    face: float | None,
    drill: float,
    live: Sequence[LiveStep] = (),
) -> Stock | None:
    """The bar for the moves of outside tools; a tube where tools of a bore begin without a drill before them.

    ``face``: Z at which a bar stop has held it, mm; None: Z0. ``drill``: diameter of the largest, 0: none.
    None where nothing is cut behind the face, and where part zero is no face: then nothing says where one is.
    """
    cuts = [move for move in (*outside, *bore) if not move.quick]
    if face is None and zero_behind(cuts):
        return None
    front = _front((*outside, *bore)) if face is None else face
    milled = [step for step in live if not step.block.rapid and step.block.feed < QUICK]
    depths = [z for move in cuts for z, _ in move.points] + [b.reach()[2] + dz for b, (_, dz) in milled]
    back = min(depths, default=front)
    if back > front or not depths:
        return None
    reach = max((_live_reach(step) for step in milled), default=0.0)
    radius = max(_bar_radius(outside, bore, front) if cuts else reach, drill)
    hole = 0.0 if drill else min(_bore_radius(bore, front), radius - _SAME)
    ends = back - _BEHIND, front
    inner = tuple((z, hole) for z in ends) if hole > 0.0 else ()
    return Stock("", tuple((z, radius) for z in ends), inner)


def zero_behind(cuts: Sequence[TipMove]) -> bool:
    """Whether part zero lies behind the part, at the chuck: most is fed well before Z0."""
    before = sum(move.length for move in cuts if min(z for z, _ in move.points) > _BEFORE)
    return before > _MOST * sum(move.length for move in cuts)


def _front(moves: Sequence[TipMove]) -> float:
    """Z of the face: a little before where it is first cut, where no rapid meets it; Z0 where it is not."""
    faced = [m.points[-1][0] for m in moves if _cuts_face(m)]
    if not faced:
        return 0.0
    face = max(faced)
    free = min((z for m in moves if m.quick for z, _ in m.points if z > face + _SAME), default=face)
    return face + min(_MORE, (free - face) / 2.0)


def _cuts_face(move: TipMove) -> bool:
    """Whether it goes from outside to the axis near Z0; at a rapid, too: a G00 that was left on."""
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    across = abs(z1 - z0) <= _SAME and abs(r1) < _CENTRE < abs(r0) - _CENTRE
    return across and -_SAME <= z1 < _NEAR_FACE / 2.0


def _bar_radius(outside: Sequence[TipMove], bore: Sequence[TipMove], front: float) -> float:
    """The largest cylinder that is cut, and a little more, but not so much that a rapid meets it.

    Where grooves or faces alone are cut, the bar is a little smaller than where the largest of them begins.
    """
    feeds = [move for move in outside if not move.quick]
    behind = [move for move in feeds if min(z for z, _ in move.points) < front - _SAME]
    along = [_cylinder(m) for m in behind if _turns(m, front)]
    largest = max(along, default=math.inf) + _BEYOND
    widest = max((r for r in _radii(bore) if r < largest), default=0.0)
    sunk = [min(abs(r) for _, r in m.points) + _MORE for m in behind if along and _plunges(m)]
    begins = [max(abs(r) for _, r in move.points) - 2.0 * _MORE for move in behind or feeds]
    faced = _faced(feeds, front)
    cut = max([*along, *sunk, widest] if along or widest else begins, default=_LEAST)
    if faced < math.inf:
        cut = min(max(cut, faced - 3.0 * _MORE), faced)
    passed = [abs(r) for m in outside if m.quick for z, r in m.points if z < front - _SAME]
    beside = [r for r in passed if r >= cut - _SAME]
    return max(min([cut + _MORE, *beside]), widest + _WALL if widest else 0.0, _LEAST)


def _turns(move: TipMove, front: float) -> bool:
    """Whether it goes along Z in the part; what comes from behind and ends before the face is a retract."""
    z0, z1 = move.points[0][0], move.points[-1][0]
    return abs(z1 - z0) > _SAME and not z1 > max(z0, front + _NEAR_FACE)


def _plunges(move: TipMove) -> bool:
    """Whether it goes square towards the axis, to some place before it."""
    (z0, r0), (z1, r1) = move.points[0], move.points[-1]
    return abs(z1 - z0) <= _SAME and abs(r0) > abs(r1) > _CENTRE


def _radii(moves: Iterable[TipMove]) -> Iterator[float]:
    return (abs(r) for move in moves if not move.quick for _, r in move.points)


def _live_reach(step: LiveStep) -> float:
    """A little less than where a live tool's cut begins or ends, the further out."""
    low, high, _, _ = step.block.reach()
    return (
        max(abs(low + step.place[0]), abs(high + step.place[0]), abs(step.block.x0 + step.place[0])) - _MORE
    )


def _faced(feeds: Iterable[TipMove], front: float) -> float:
    """Where the first cut begins if it is that of the face: no bar is larger. Infinite if it is another."""
    for move in feeds:
        (z0, r0), (z1, r1) = move.points[0], move.points[-1]
        if abs(abs(r1) - abs(r0)) > _CENTRE:
            faces = abs(z1 - z0) <= _SAME and z1 > front - _NEAR_FACE and abs(r1) < _CENTRE < abs(r0)
            return abs(r0) if faces else math.inf
        if z1 < front - _NEAR_FACE:
            return math.inf
    return math.inf


def _cylinder(move: TipMove) -> float:
    """The radius of the bar that a move along Z needs: an arc bulges, a line outwards leaves the part."""
    radii = [abs(r) for _, r in move.points]
    return max(radii) if move.kind is Kind.ARC else min(radii)


def _bore_radius(bore: Iterable[TipMove], front: float) -> float:
    """Just under the smallest cylinder that is cut in the bore, 0 where none is."""
    behind = [m for m in bore if not m.quick and min(z for z, _ in m.points) < front - _SAME]
    return max(min((max(abs(r) for _, r in m.points) for m in behind), default=0.0) - _MORE, 0.0)
