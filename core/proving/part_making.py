"""The part while a program makes it block by block, and the list of checks that lacked data."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

from core.interpreter.shared.actions import AskInput, Collet, Output, ProgramStop, ToolChange, WaitInput
from core.interpreter.shared.modal_state import Modal
from core.message import Message
from core.part.cutter import Cutter, Neighbours
from core.part.polar_field import NOTHING
from core.part.stock import Clamping, Point, Stock
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import Piece, TurnedPart
from core.proving.assumed_tools import ToolUse
from core.proving.checks.machine_checks import LIVE
from core.proving.checks.part_checks import HOLES, KIND, STOCK, TOOL
from core.proving.checks.part_findings import RAPID, PartFindings
from core.proving.checks.thread_checks import ThreadChecks
from core.proving.program_tools import PartSetting, ProgramTools
from core.proving.proof_report import PartReport
from core.proving.tip_moves import LiveStep, Step, TipMove
from core.tool_edges import edge_name

if TYPE_CHECKING:
    from core.proving.milling import Milling, MillMove


_DEEP = frozenset({ToolKind.DRILL, ToolKind.REAMER, ToolKind.TAP, ToolKind.END_MILL})
_TURN = frozenset(
    {
        ToolKind.DRILL,
        ToolKind.CENTRE_DRILL,
        ToolKind.REAMER,
        ToolKind.END_MILL,
        ToolKind.TURNING,
        ToolKind.PARTING,
    }
)


def unchecked(
    uses: Mapping[int, ToolUse],
    shapes: Mapping[int, ToolShape],
    clamping: Clamping | None,
    gang: Mapping[int, Point],
) -> tuple[str, ...]:
    """Return short phrases, one for each kind of missing data; ``uses`` are the tools of the program."""
    return tuple(_phrases([n for n in sorted(uses) if uses[n].moves or uses[n].live], shapes, clamping, gang))


def _phrases(
    used: Iterable[int],
    shapes: Mapping[int, ToolShape],
    clamping: Clamping | None,
    gang: Mapping[int, Point],
) -> Iterator[str]:
    used = list(used)
    if without := [n for n in used if n and n not in shapes]:
        yield Message(
            "{without}: tool holder, edge length and hand of the tool not defined", without=_names(without)
        )
    if short := [n for n in used if n in shapes and shapes[n].kind in _DEEP and not shapes[n].length]:
        yield Message("{short}: maximum tool depth (unknown: no flute length defined)", short=_names(short))
    if clamping is None or not clamping.diameter:
        yield (
            "collisions with the chuck and jaws, and stock whip (these checks require a "
            "diameter in [clamping] and a stick-out)"
        )
    if clamping is None or not clamping.max_rpm:
        yield "maximum chuck speed (unknown: no max_rpm in [clamping])"
    if gang and (beside := sorted(gang.keys() - shapes.keys())):
        yield (
            Message(
                "{tools}: collisions on the gang plate while a neighboring tool cuts (no tool shape defined)",
                tools=_names(beside),
            )
        )


def _names(numbers: Iterable[int]) -> str:
    return ", ".join(edge_name(n) for n in numbers)


class PartMaking:
    """The part while the program makes it."""

    def __init__(self, tools: ProgramTools, stock: Stock | None, setting: PartSetting | None = None) -> None:
        setting = setting or PartSetting()
        self._tools, self._stock, self._step = tools, stock, setting.step
        self._stock_said = setting.stock is not None
        self._cutters: dict[int, Cutter | None] = {}
        self._tool = 0
        self._begun = False
        self._is_open = False
        self._removed = 0.0
        self._pieces: list[Piece] = []
        self._last: Piece | None = None  # the last piece that a collet released or a parting tool cut off
        self._milled = False
        self.findings = PartFindings(
            tools.shape,
            stock,
            setting.clamping,
            Neighbours(setting.shapes, setting.gang) if setting.gang else None,
            ThreadChecks(setting.drives, tools.releases, self._stock_said),
            self._not_said,
            setting.silenced,
            tools.parted_at,
        )
        self._unchecked = unchecked(tools.uses, setting.shapes, setting.clamping, setting.gang)
        self.milling: Milling | None = None  # set at the first cut of a live tool
        self.milled_last = NOTHING  # material cut by the last block of a live tool
        self._live_codes = setting.live_codes
        self._turned = False  # the spindle has turned in the program
        self._in_cut = False  # a tool is in a cut with a stopped spindle
        self._standing: dict[int, int] = {}  # by T: the first line that cuts with the spindle stopped again
        self.part = TurnedPart(stock, self._step) if stock is not None and not tools.feeds_first else None

    @property
    def tool(self) -> int:
        """T of the active tool; 0 without a tool."""
        return self._tool

    @property
    def stock(self) -> Stock | None:
        """The stock in the chuck before the first cut, or None if it is unknown."""
        return self._stock

    @property
    def is_open(self) -> bool:
        """True if the collet is open."""
        return self._is_open

    @property
    def parted_off(self) -> int:
        """The number of pieces that have been parted off."""
        return len(self._pieces) + (len(self.part.pieces) if self.part is not None else 0)

    @property
    def nbytes(self) -> int:
        """The approximate memory of the material in bytes."""
        part, milling = self.part, self.milling
        turned = part.low.nbytes + part.high.nbytes if part is not None else 0
        return turned + (milling.nbytes if milling is not None else 0)

    def _not_said(self, rests_on: tuple[str, ...]) -> tuple[str, ...]:
        """Return the unspecified data on which a finding depends, for the active tool."""
        names = [STOCK] if STOCK in rests_on and not self._stock_said else []
        assumed = self._tools.assumed.get(self._tool)
        if assumed is not None and (TOOL in rests_on or (KIND in rests_on and not assumed.named)):
            names.append(edge_name(self._tool))
        if HOLES in rests_on:
            names += [edge_name(n) for n in self._tools.unsized_drills if n != self._tool]
        return tuple(names)

    def copy(self) -> PartMaking:
        """Return an independent copy that shares the constant data."""
        found = self.findings
        shared: tuple[object, ...] = (self._tools, self._stock, found.clamping, found.neighbours)
        shared += (*self._cutters.values(), *found.diagnostics)
        return copy.deepcopy(self, {id(each): each for each in shared})

    def see(self, step: Step) -> None:
        """Apply the next block."""
        if isinstance(step, TipMove):
            if not self._begun:  # the first move starts at an unknown position
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
        """Open or close the collet. After it has opened and closed, the bar has a new face."""
        self.findings.pause()
        if not closed:
            self._is_open = True
            return
        if self._is_open and self._stock is not None:
            self._finish()
            self.part = TurnedPart(self._stock, self._step)
        self._is_open = False

    def mill(self, step: LiveStep, first: float = 0.0, last: float = 1.0) -> None:
        """Apply a block of a live tool, or the piece of it between two shares."""
        move, shape = self.mill_move(step), self._tools.shape(self._tool)
        if move is None or shape is None or self.part is None or self._is_open:
            return
        from core.proving.milling import Milling, between

        if last - first < 1.0:
            move = move._replace(path=between(move.path, first, last))
        if self.milling is None:
            self.milling = Milling(self.part)
        self._milled = True
        milling = self.milling
        self.milled_last = milling.cut(move, shape)
        if self.milled_last.depth > RAPID and self._is_still(step.block.modal, shape):
            self.findings.standing(step.block.line, step.block.n, self._tool)
        modal, touches = step.block.modal, partial(milling.touches, move, shape)
        self.findings.milled(move, self.milled_last, shape, modal, self._tool, touches=touches)

    def mill_move(self, step: LiveStep) -> MillMove | None:
        """Return the path of a live tool in the part's frame, or None if no cutting shape is known."""
        shape = self._tools.shape(self._tool)
        if shape is None or not shape.diameter:
            return None
        from core.proving.milling import mill_move

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
        """Return whether a cut with a stopped spindle removes nothing, or follows such a cut.

        A spindle that never turns in the program is switched manually.
        """
        behind, self._in_cut = self._in_cut, False
        shape = self._tools.shape(self._tool)
        if not self._turned or move.rpm or shape is None:
            return False
        round_tool = shape.turns_itself
        if move.quick or (round_tool and shape.kind is ToolKind.TAP):
            return behind
        met = [cutter.meets(part, start, end) for start, end in pairwise(move.points)]
        if max(each.depth for each in met) > RAPID and self._is_still(move.modal, shape):
            self.findings.standing(move.line, move.n, self._tool)
        if round_tool:
            return False
        self._in_cut = any(met)
        if self._in_cut:
            self._standing.setdefault(self._tool, move.line)
        return self._in_cut

    def _is_still(self, modal: Modal, shape: ToolShape) -> bool:
        """Return whether a tool that must rotate, or needs a rotating part, has neither.

        Other tools may be broaches. On a machine without a code for the live tool, it is switched manually.
        """
        live = any(name.startswith(LIVE) for name in modal.outputs)
        return shape.kind in _TURN and self._live_codes and not live and not modal.spindle

    def _finish(self) -> None:
        part = self.part
        if part is None:
            return
        pieces = part.pieces
        if self.milling is None:
            self._removed += part.removed
        else:  # a turning tool removes nothing where a live tool has been before
            self._removed += part.whole - self.milling.left - sum(piece.volume for piece in pieces)
        self._pieces += pieces
        if part.removed or self.milling is not None or self._last is None:
            self._last = pieces[-1] if pieces else part.rest()
        self.part = self.milling = None

    def report(self) -> PartReport:
        """Return the result of the program for the stock."""
        left = self.part.volume if self.part is not None else 0.0
        if self.milling is not None:
            left = self.milling.left
        sides = self.milling.sides() if self.milling is not None and not self.parted_off else None
        self._finish()
        self.findings.finish()
        stock = self._stock
        assumed = [each.words for _, each in sorted(self._tools.assumed.items())]
        if stock is None and self._tools.uses:
            assumed.append(
                "no stock could be assumed: feed moves cut in front of Z0, so the stock face cannot be at Z0"
            )
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
            shapes={n: self._tools.shape(n) for n, use in self._tools.uses.items() if use.moves or use.live},
            sides=sides,
        )


def _cut_standing(lines: Mapping[int, int]) -> list[str]:
    return [
        Message(
            "cuts made by {tool} with the spindle stopped, from line {line} on",
            tool=edge_name(tool),
            line=line,
        )
        for tool, line in lines.items()
    ]
