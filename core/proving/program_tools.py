"""The tools of a program: described by somebody, or assumed by what the program does with them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from core.interpreter.actions import AskInput, Collet, Output, ProgramStop, ToolChange, WaitInput
from core.interpreter.elementary_blocks import Kind
from core.interpreter.units import MM_PER_INCH
from core.message import Message
from core.part.cutter import Cutter, Side
from core.part.stock import Stock
from core.part.tool_outline import outline
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.assumed_stock import assumed_stock, zero_behind
from core.proving.assumed_tools import GROOVERS, OPENS, Assumed, ToolUse, assumed_tool, releases
from core.proving.part_setting import PartSetting
from core.proving.tip_moves import QUICK, LiveStep, Step, TipMove
from core.tool_edges import edge_name

_PLUNGE = 0.5  # mm
_FED_AWAY = 1.0  # mm


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
