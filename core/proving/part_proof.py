"""The proof of the part: the blocks of a program take metal off the stock, and what goes wrong is found.

All moves are gathered first, because stock and tools that nobody has described follow from them.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

from core.interpreter.actions import (
    AskInput,
    Collet,
    Output,
    ProgramStop,
    ToolChange,
    WaitInput,
)
from core.interpreter.dialects import ReadProgram
from core.interpreter.elementary_blocks import Kind
from core.interpreter.job_setup import Setup
from core.language.diagnostics import Diagnostic
from core.language.source import Source
from core.machine.machine_model import Machine
from core.part.clamping import Clamping
from core.part.cutter import Cutter, Side
from core.part.neighbours import Neighbours
from core.part.polar_field import NOTHING
from core.part.stock import Point, Stock
from core.part.stock_spec import StockSpec
from core.part.tool_outline import outline
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import STEP, Piece, TurnedPart
from core.proving.assumed_stock import assumed_stock, zero_behind
from core.proving.assumed_tools import GROOVERS, Assumed, ToolUse, assumed_tool, releases
from core.proving.part_checks import STOCK, TOOL, Check
from core.proving.part_findings import PartFindings
from core.proving.program_timeline import MotionSpan, Part, RestSpan
from core.proving.proof_report import Report, in_order
from core.proving.prove_program import Progress, prove
from core.proving.thread_checks import UNKNOWN, Drives, ThreadChecks
from core.proving.tip_moves import QUICK, LiveStep, Place, Step, Steps, TipMove
from core.proving.unchecked_parts import unchecked
from core.tool_edges import edge_name

if TYPE_CHECKING:
    from core.proving.mill_moves import MillMove
    from core.proving.milling import Milling

MOST_MOVES = 50_000
"""Of a longer program the part is made when somebody has said its stock: a million take half a minute.

On the desk, where it would be in the way of a machine, never: ``part_history``.
"""

_PLUNGE = 0.5  # mm
_FED_AWAY = 1.0  # mm
_WATCHED = 200  # moves between two looks at whether the part is still wanted


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
    step: float = STEP  # width of a column of the part, mm
    silenced: Mapping[str, str] = field(default_factory=dict)  # why, by check
    travel: tuple[Point, Point] | None = None  # of X and of Z, from home, mm

    @property
    def may_refuse(self) -> bool:
        """Whether enough is said for an error of the part to rest on nothing that is assumed."""
        return self.stock is not None or self.clamping is not None


@dataclass(frozen=True, slots=True)
class PartReport:
    """What became of the stock: mm and mm³. ``last`` is the last part that came off, or what the chuck holds.

    ``shapes`` are the tools by T, described or assumed, None where nothing is known that would cut.
    ``assumed`` are sentences, one for each thing that nobody has said, ``unchecked`` what could not be looked
    at for want of it.
    """

    stock: Stock | None
    volume: float
    removed: float
    left: float
    last: Piece | None
    milled: bool
    pieces: tuple[Piece, ...]
    assumed: tuple[str, ...]
    findings: tuple[Diagnostic, ...]
    unchecked: tuple[str, ...] = ()
    shapes: Mapping[int, ToolShape | None] = field(default_factory=dict)


def prove_with_part(
    program: Source | ReadProgram, setup: Setup, machine: Machine, setting: PartSetting,
    progress: Progress | None = None, *, ideal: bool = False,
    seen: Callable[[MotionSpan | RestSpan], None] | None = None,
    watch: Callable[[float], None] | None = None,
) -> tuple[Report, PartReport | None]:  # fmt: skip
    """The proof of a program with the findings of its part among the others; no part on a mill.

    ``seen`` is given each span, as ``prove`` gives it; ``watch`` may give up while the part is made.
    """
    if machine.kind != "lathe":
        return prove(program, setup, machine, progress, ideal=ideal, seen=seen), None
    gathered = PartProof(setting)

    def see(span: MotionSpan | RestSpan) -> None:
        gathered.see(span)
        if seen is not None:
            seen(span)

    report = prove(program, setup, machine, progress, ideal=ideal, seen=see)
    part = gathered.report(watch)
    known = {(each.line, each.code) for each in report.diagnostics}  # of reading, which knows no stock
    found = (each for each in part.findings if (each.line, each.code) not in known)
    return replace(report, diagnostics=in_order((*report.diagnostics, *found))), part


def _not_made(moves: int) -> PartReport:
    words = f"{moves} moves: a part of so many is made where its stock is said"
    return PartReport(None, 0.0, 0.0, 0.0, None, False, (), (words,), ())


class PartProof:
    """Gathers the blocks of a pass, and makes the part of them."""

    def __init__(self, setting: PartSetting, parts: Iterable[Part] = ()) -> None:
        self._setting = setting
        self._parts: list[Part] = list(parts)

    def see(self, span: MotionSpan | RestSpan) -> None:
        """The next span of the program."""
        if isinstance(span, MotionSpan):
            self._parts += span.parts
        elif span.block is not None:
            self._parts.append([span.block])

    def report(self, watch: Callable[[float], None] | None = None) -> PartReport:
        """The part, when the whole program has been seen; of a very long one only where a stock is said.

        ``watch`` is told how many moves are done, now and then, and may raise to give up.
        """
        moves = sum(len(part) for part in self._parts)
        if moves > MOST_MOVES and self._setting.stock is None:
            return _not_made(moves)
        making, steps = self._begun()
        for done, step in enumerate(steps):
            if watch is not None and done % _WATCHED == 0:
                watch(done)
            making.see(step)
        return making.report()

    def metal_at(self, blocks: Collection[int]) -> dict[int, Piece]:
        """What was held before each of these elementary blocks, by number; live tools are left out."""
        making, steps = self._begun()
        held: dict[int, Piece] = {}
        for step in steps:
            if isinstance(step, TipMove) and step.n in blocks and making.part is not None:
                held.setdefault(step.n, making.part.rest())
            making.see(step)
        return held

    def _begun(self) -> tuple[Making, list[Step]]:
        """The stock in the chuck, and the steps to come."""
        reading = Steps(self._setting.tips)
        steps = [step for part in self._parts for step in reading.of(part)]
        tools = Tools(steps, self._setting)
        stock = self._setting.stock or tools.assumed_stock()
        if isinstance(stock, StockSpec):
            stock = stock.stock(tools.back)
        return Making(tools, stock, self._setting), steps


class Tools:
    """The tools of a program: described, or assumed by what it does with them."""

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
    def back(self) -> float:
        """Least Z that a tool cuts at, mm."""
        moves = (m for use in self.uses.values() for m in use.moves if not (m.quick or use.pushes_bar))
        return min((z for move in moves for z, _ in move.points), default=0.0)

    @property
    def parted_at(self) -> float | None:
        """The deepest Z at which a parting tool is fed towards the axis; None: at none."""
        moves = (m for n, use in self.uses.items() for m in use.moves if self._parts(n) and not m.quick)
        ways = [(*move.points[0], *move.points[-1]) for move in moves]
        return min((z1 for _, r0, z1, r1 in ways if abs(r1) < abs(r0) - _PLUNGE), default=None)

    def _parts(self, number: int) -> bool:
        shape = self.shape(number)
        return shape is not None and shape.kind is ToolKind.PARTING

    def nothing_cut(self, stock: Stock | None) -> Iterator[tuple[int, int, str]]:
        """Line, block and sentence of what should have cut and has not: tools never fed, feeds all away."""
        cutting = [use for n, use in self.uses.items() if self.shape(n) is not None]
        for use in cutting:
            if (move := use.never_fed) is not None:
                yield move.line, move.n, f"{edge_name(use.number)} is never fed: all its moves are rapids."
        if stock is not None:
            return
        if (lost := self.fed_away) is not None:
            yield lost.line, lost.n, "This feed leads away from the part, and no other cuts behind Z0."
        for use in cutting:
            fed = [block for block in use.live_blocks if not block.rapid and block.feed < QUICK]
            if fed:
                yield (
                    fed[0].line,
                    fed[0].n,
                    f"The live tool {edge_name(use.number)} is fed, and never comes behind Z0.",
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


class Making:
    """The part while the program makes it."""

    def __init__(self, tools: Tools, stock: Stock | None, setting: PartSetting | None = None) -> None:
        setting = setting or PartSetting()
        self._tools, self._stock, self._step = tools, stock, setting.step
        self._stock_said = setting.stock is not None
        self._cutters: dict[int, Cutter | None] = {}
        self._tool = 0
        self._begun = False
        self._is_open = False
        self._removed = 0.0
        self._pieces: list[Piece] = []
        self._last: Piece | None = None  # the last piece that a collet let go or a parting tool cut off
        self._milled = False
        self.findings = PartFindings(
            tools.shape,
            stock,
            setting.clamping,
            Neighbours(setting.shapes, setting.gang) if setting.gang else None,
            ThreadChecks(setting.drives, tools.releases),
            self._not_said,
            setting.silenced,
            tools.parted_at,
        )
        self._unchecked = unchecked(tools.uses, setting.shapes, setting.clamping, setting.gang)
        self.milling: Milling | None = None  # from the first cut of a live tool on
        self.milled_last = NOTHING  # by the last block of a live tool
        self._turned = False  # the spindle has
        self._in_cut = False  # of a spindle that stands
        self._standing: dict[int, int] = {}  # by T: the first line that cuts while it stands again
        self.part = TurnedPart(stock, self._step) if stock is not None and not tools.feeds_first else None

    @property
    def tool(self) -> int:
        """T of the tool that is in work; 0: none."""
        return self._tool

    @property
    def is_open(self) -> bool:
        """Whether the collet is."""
        return self._is_open

    @property
    def parted_off(self) -> int:
        """How many pieces have been parted off."""
        return len(self._pieces) + (len(self.part.pieces) if self.part is not None else 0)

    @property
    def nbytes(self) -> int:
        """Memory of the metal, about."""
        part, milling = self.part, self.milling
        turned = part.low.nbytes + part.high.nbytes if part is not None else 0
        return turned + (milling.nbytes if milling is not None else 0)

    def _not_said(self, check: Check) -> tuple[str, ...]:
        """What a finding of this check rests on and nobody has described, at the tool in work."""
        stock = (STOCK,) if STOCK in check.rests_on and not self._stock_said else ()
        assumed = TOOL in check.rests_on and self._tool in self._tools.assumed
        return (*stock, edge_name(self._tool)) if assumed else stock

    def copy(self) -> Making:
        """The same once more, to be gone on with later; what never changes is shared."""
        found = self.findings
        shared: tuple[object, ...] = (self._tools, self._stock, found.clamping, found.neighbours)
        shared += (*self._cutters.values(), *found.diagnostics)
        return copy.deepcopy(self, {id(each): each for each in shared})

    def see(self, step: Step) -> None:
        """The next block."""
        if isinstance(step, TipMove):
            if not self._begun:  # from wherever the slides stand
                step, self._begun = step._replace(points=step.points[-1:] * 2), True
            self._turned = self._turned or step.rpm != 0.0
            if self.part is not None and not self._is_open:
                self._move(step, self.part)
            return
        if isinstance(step, LiveStep):
            self.mill(step)
            return
        match step.action:
            case ToolChange(tool=tool):
                self._tool = tool
            case Collet(closed=closed):
                self._clamp(closed)
            case ProgramStop() | Output() | WaitInput() | AskInput():
                self.findings.pause()
            case _:
                pass

    def _clamp(self, closed: bool) -> None:
        """A collet that opens lets the bar come: behind it stands a new face."""
        self.findings.pause()
        if not closed:
            self._is_open = True
            return
        if self._is_open and self._stock is not None:
            self._finish()
            self.part = TurnedPart(self._stock, self._step)
        self._is_open = False

    def mill(self, step: LiveStep, first: float = 0.0, last: float = 1.0) -> None:
        """A block of a live tool, or the piece of it from one share to another."""
        move, shape = self.mill_move(step), self._tools.shape(self._tool)
        if move is None or shape is None or self.part is None or self._is_open:
            return
        from core.proving.mill_moves import between
        from core.proving.milling import Milling

        if last - first < 1.0:
            move = move._replace(path=between(move.path, first, last))
        if self.milling is None:
            self.milling = Milling(self.part)
        self._milled = True
        milling = self.milling
        self.milled_last = milling.cut(move, shape)
        modal, touches = step.block.modal, partial(milling.touches, move, shape)
        self.findings.milled(move, self.milled_last, shape, modal, self._tool, touches=touches)

    def mill_move(self, step: LiveStep) -> MillMove | None:
        """The way of a live tool in the part's frame; None where nothing is known that would cut."""
        shape = self._tools.shape(self._tool)
        if shape is None or not shape.diameter:
            return None
        from core.proving.mill_moves import mill_move

        return mill_move(step.block, step.place, shape)

    def _cutter(self) -> Cutter | None:
        if self._tool not in self._cutters:
            self._cutters[self._tool] = self._tools.cutter(self._tool)
        return self._cutters[self._tool]

    def _move(self, move: TipMove, part: TurnedPart) -> None:
        cutter = self._cutter()
        if cutter is None:
            return
        if self._stands(move, cutter, part):
            return
        before = len(part.pieces)
        self.findings.look(move, cutter, part, self._tool)
        if self.milling is not None:
            part.pieces[before:] = [self.milling.less_milled(piece) for piece in part.pieces[before:]]
        for piece in part.pieces[before:]:
            self.findings.parted(move, piece)

    def _stands(self, move: TipMove, cutter: Cutter, part: TurnedPart) -> bool:
        """Whether metal is met while the spindle stands again, or left behind such a cut: that turns nothing.

        A spindle that never turns is one that is switched by hand.
        """
        behind, self._in_cut = self._in_cut, False
        shape = self._tools.shape(self._tool)
        if not self._turned or move.rpm or (shape is not None and shape.turns_itself):
            return False
        if move.quick:
            return behind
        self._in_cut = any(cutter.meets(part, start, end) for start, end in pairwise(move.points))
        if self._in_cut:
            self._standing.setdefault(self._tool, move.line)
        return self._in_cut

    def _finish(self) -> None:
        part = self.part
        if part is None:
            return
        pieces = part.pieces
        if self.milling is None:
            self._removed += part.removed
        else:  # a turning tool takes nothing where a live tool was before it
            self._removed += part.whole - self.milling.left - sum(piece.volume for piece in pieces)
        self._pieces += pieces
        if part.removed or self.milling is not None:
            self._last = pieces[-1] if pieces else part.rest()
        self.part = self.milling = None

    def report(self) -> PartReport:
        """What became of the stock."""
        left = self.part.volume if self.part is not None else 0.0
        if self.milling is not None:
            left = self.milling.left
        self._finish()
        self.findings.finish()
        stock = self._stock
        assumed = [each.words for _, each in sorted(self._tools.assumed.items())]
        if stock is None and self._tools.uses:
            assumed.append("no stock is assumed: the feeds cut before Z0, where no face of it can lie")
        for line, n, text in self._tools.nothing_cut(stock):
            self.findings.nothing_cut(line, n, text)
        volume = TurnedPart(stock).volume if stock is not None else 0.0
        return PartReport(
            stock=stock,
            volume=volume,
            removed=self._removed,
            left=left,
            last=self._last,
            milled=self._milled,
            pieces=tuple(self._pieces),
            assumed=tuple(assumed),
            findings=self.findings.diagnostics,
            unchecked=(*self._unchecked, *_cut_standing(self._standing)),
            shapes={n: self._tools.shape(n) for n, use in self._tools.uses.items() if use.moves},
        )


def _cut_standing(lines: Mapping[int, int]) -> list[str]:
    return [
        f"what {edge_name(tool)} cuts from line {line} on while the spindle stands"
        for tool, line in lines.items()
    ]
