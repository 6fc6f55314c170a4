"""Simulation of the part while a program machines it, and the data that are missing for checks."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

from core.interpreter.shared.actions import (
    ColletSwitch,
    InputRead,
    InputWait,
    OutputSwitch,
    ProgramStop,
    ToolChange,
)
from core.interpreter.shared.modal_state import ModalState
from core.message import Message
from core.part.cutter import Cutter, NeighborTools
from core.part.polar_field import NO_MATERIAL
from core.part.stock import Clamping, Point, Stock
from core.part.tool_shape import ToolKind, ToolShape
from core.part.turned_part import PartedPiece, TurnedPart
from core.proving.assumed_tools import ToolUse
from core.proving.checks.machine_checks import LIVE_TOOL_PREFIX
from core.proving.checks.part_checks import EARLIER_HOLES, STOCK, TOOL, TOOL_KIND
from core.proving.checks.part_findings import RAPID_TOLERANCE_MM, PartFindings
from core.proving.checks.thread_checks import ThreadChecks
from core.proving.program_tools import PartSettings, ProgramTools
from core.proving.proof_report import PartReport
from core.proving.tip_moves import LiveToolStep, ProgramStep, TipMove
from core.tool_edges import format_edge_name

if TYPE_CHECKING:
    from core.proving.milling import MillingState, MillMove


_DEEP = frozenset({ToolKind.DRILL, ToolKind.REAMER, ToolKind.TAP, ToolKind.END_MILL})
_TURN = frozenset(
    {
        ToolKind.DRILL,
        ToolKind.CENTER_DRILL,
        ToolKind.REAMER,
        ToolKind.END_MILL,
        ToolKind.TURNING,
        ToolKind.PARTING,
    }
)


def describe_missing_data(
    tool_uses: Mapping[int, ToolUse],
    shapes: Mapping[int, ToolShape],
    clamping: Clamping | None,
    gang_positions: Mapping[int, Point],
) -> tuple[str, ...]:
    """Return one short phrase for each kind of missing data.

    ``tool_uses`` are the tools of the program.
    """
    return tuple(
        _phrases(
            [n for n in sorted(tool_uses) if tool_uses[n].moves or tool_uses[n].live_tool_steps],
            shapes,
            clamping,
            gang_positions,
        )
    )


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
    if clamping is None or not clamping.chuck_diameter:
        yield (
            "collisions with the chuck and jaws, and stock whip (these checks require a "
            "diameter in [clamping] and a stick-out)"
        )
    if clamping is None or not clamping.max_rpm:
        yield "maximum chuck speed (unknown: no max_rpm in [clamping])"
    if gang and (undefined_tools := sorted(gang.keys() - shapes.keys())):
        yield (
            Message(
                "{tools}: collisions on the gang plate while a neighboring tool cuts (no tool shape defined)",
                tools=_names(undefined_tools),
            )
        )


def _names(numbers: Iterable[int]) -> str:
    return ", ".join(format_edge_name(n) for n in numbers)


class PartSimulation:
    """Simulation of the part while a program is proved."""

    def __init__(
        self, tools: ProgramTools, stock: Stock | None, part_settings: PartSettings | None = None
    ) -> None:
        part_settings = part_settings or PartSettings()
        self._tools, self._stock, self._step = tools, stock, part_settings.step
        self._stock_said = part_settings.stock is not None
        self._cutters: dict[int, Cutter | None] = {}
        self._tool = 0
        self._begun = False
        self._is_open = False
        self._removed = 0.0
        self._pieces: list[PartedPiece] = []
        self._last: PartedPiece | None = (
            None  # the last piece that a collet released or a parting tool cut off
        )
        self._milled = False
        self.findings = PartFindings(
            tools.find_tool_shape,
            stock,
            part_settings.clamping,
            NeighborTools(part_settings.shapes, part_settings.gang) if part_settings.gang else None,
            ThreadChecks(part_settings.drives, tools.has_releasing_tap_holder, self._stock_said),
            self._find_unspecified_data,
            part_settings.silenced,
            tools.part_off_z_mm,
        )
        self._unchecked = describe_missing_data(
            tools.tool_uses, part_settings.shapes, part_settings.clamping, part_settings.gang
        )
        self.milling: MillingState | None = None  # set at the first cut of a live tool
        self.last_milled_material = NO_MATERIAL  # material cut by the last block of a live tool
        self._live_codes = part_settings.live_codes
        self._turned = False  # the spindle has turned in the program
        self._in_cut = False  # a tool is in a cut with a stopped spindle
        self._standing: dict[int, int] = {}  # by T: the first line that cuts with the spindle stopped again
        self.part = TurnedPart(stock, self._step) if stock is not None and not tools.feeds_bar_first else None

    @property
    def active_tool_number(self) -> int:
        """Return the T number of the active tool, or 0 without a tool."""
        return self._tool

    @property
    def initial_stock(self) -> Stock | None:
        """Return the stock in the chuck before the first cut, or None if it is unknown."""
        return self._stock

    @property
    def is_collet_open(self) -> bool:
        """Return whether the collet is open."""
        return self._is_open

    @property
    def parted_piece_count(self) -> int:
        """Return the number of pieces that have been parted off."""
        return len(self._pieces) + (len(self.part.parted_pieces) if self.part is not None else 0)

    @property
    def nbytes(self) -> int:
        """Return the approximate memory that the material uses, in bytes."""
        part, milling = self.part, self.milling
        turned = part.inner_radii.nbytes + part.outer_radii.nbytes if part is not None else 0
        return turned + (milling.nbytes if milling is not None else 0)

    def _find_unspecified_data(self, required_data: tuple[str, ...]) -> tuple[str, ...]:
        """Return the unspecified data of the active tool on which a finding depends."""
        names = [STOCK] if STOCK in required_data and not self._stock_said else []
        assumed = self._tools.assumed_tools.get(self._tool)
        if assumed is not None and (
            TOOL in required_data or (TOOL_KIND in required_data and not assumed.is_kind_named)
        ):
            names.append(format_edge_name(self._tool))
        if EARLIER_HOLES in required_data:
            names += [format_edge_name(n) for n in self._tools.unsized_drills if n != self._tool]
        return tuple(names)

    def copy(self) -> PartSimulation:
        """Return a copy of the simulation that shares only the constant data."""
        found = self.findings
        shared: tuple[object, ...] = (self._tools, self._stock, found.clamping, found.neighbors)
        shared += (*self._cutters.values(), *found.diagnostics)
        return copy.deepcopy(self, {id(each): each for each in shared})

    def apply_step(self, step: ProgramStep) -> None:
        """Apply the next step of the program to the part."""
        if isinstance(step, TipMove):
            if not self._begun:  # the first move starts at an unknown position
                step, self._begun = step._replace(points=step.points[-1:] * 2), True
            self._turned = self._turned or step.rpm != 0.0
            if self.part is not None and not self._is_open:
                self._move(step, self.part)
            return
        if isinstance(step, LiveToolStep):
            self.apply_milling_step(step)
            return
        match step.action:
            case ToolChange(tool=tool):
                self._tool = tool
            case ColletSwitch(closed=closed):
                self._move_collet(closed)
            case ProgramStop() | OutputSwitch() | InputWait() | InputRead():
                self.findings.record_pause()
            case _:
                pass

    def _move_collet(self, is_closed: bool) -> None:
        """Open or close the collet.

        After the collet has opened and closed, the bar has a new face.
        """
        self.findings.record_pause()
        if not is_closed:
            self._is_open = True
            return
        if self._is_open and self._stock is not None:
            self._finish()
            self.part = TurnedPart(self._stock, self._step)
        self._is_open = False

    def apply_milling_step(
        self, step: LiveToolStep, start_fraction: float = 0.0, end_fraction: float = 1.0
    ) -> None:
        """Apply a block of a live tool, or the part of the block between two fractions."""
        move, shape = self.make_mill_move(step), self._tools.find_tool_shape(self._tool)
        if move is None or shape is None or self.part is None or self._is_open:
            return
        from core.proving.milling import MillingState, trim_path_to_fractions

        if end_fraction - start_fraction < 1.0:
            move = move._replace(path=trim_path_to_fractions(move.path, start_fraction, end_fraction))
        if self.milling is None:
            self.milling = MillingState(self.part)
        self._milled = True
        milling = self.milling
        self.last_milled_material = milling.cut_material(move, shape)
        if self.last_milled_material.depth_mm > RAPID_TOLERANCE_MM and self._is_stationary(
            step.block.modal, shape
        ):
            self.findings.report_stationary_cut(step.block.line, step.block.n, self._tool)
        modal, touches = step.block.modal, partial(milling.follows_face, move, shape)
        self.findings.check_milled_move(
            move, self.last_milled_material, shape, modal, self._tool, touches_material=touches
        )

    def make_mill_move(self, step: LiveToolStep) -> MillMove | None:
        """Return the move of a live tool in the part's frame, or None if no cutting shape is known."""
        shape = self._tools.find_tool_shape(self._tool)
        if shape is None or not shape.diameter:
            return None
        from core.proving.milling import make_mill_move

        return make_mill_move(step.block, step.part_zero, shape)

    def _cutter(self) -> Cutter | None:
        if self._tool not in self._cutters:
            self._cutters[self._tool] = self._tools.make_cutter(self._tool)
        return self._cutters[self._tool]

    def _move(self, move: TipMove, part: TurnedPart) -> None:
        cutter = self._cutter()
        if cutter is None:
            return
        if self._detect_stationary_cut(move, cutter, part):
            return
        before = len(part.parted_pieces)
        self.findings.check_move(move, cutter, part, self._tool)
        if self.milling is not None:
            part.parted_pieces[before:] = [
                self.milling.subtract_milled_volume(piece) for piece in part.parted_pieces[before:]
            ]
        for piece in part.parted_pieces[before:]:
            self.findings.check_parted_piece(move, piece)

    def _detect_stationary_cut(self, move: TipMove, cutter: Cutter, part: TurnedPart) -> bool:
        """Return whether a move must not remove material because the spindle is stopped.

        A rapid after such a cut does not remove material either. A spindle that never turns in the program
        is assumed to be switched manually. A cut by a tool that must rotate is reported.
        """
        is_after_cut, self._in_cut = self._in_cut, False
        shape = self._tools.find_tool_shape(self._tool)
        if not self._turned or move.rpm or shape is None:
            return False
        round_tool = shape.is_rotating
        if move.is_fast or (round_tool and shape.kind is ToolKind.TAP):
            return is_after_cut
        met = [cutter.find_cut(part, start, end) for start, end in pairwise(move.points)]
        if max(each.depth_mm for each in met) > RAPID_TOLERANCE_MM and self._is_stationary(move.modal, shape):
            self.findings.report_stationary_cut(move.line, move.n, self._tool)
        if round_tool:
            return False
        self._in_cut = any(met)
        if self._in_cut:
            self._standing.setdefault(self._tool, move.line)
        return self._in_cut

    def _is_stationary(self, modal: ModalState, shape: ToolShape) -> bool:
        """Return whether neither the tool nor the part rotates, although the tool requires it.

        Tools of other kinds may be broaches. On a machine without a code for the live tool, the operator
        switches the live tool manually.
        """
        live = any(name.startswith(LIVE_TOOL_PREFIX) for name in modal.outputs)
        return shape.kind in _TURN and self._live_codes and not live and not modal.spindle

    def _finish(self) -> None:
        part = self.part
        if part is None:
            return
        pieces = part.parted_pieces
        if self.milling is None:
            self._removed += part.removed_volume_mm3
        else:  # a turning tool removes nothing where a live tool has been before
            self._removed += (
                part.stock_volume_mm3
                - self.milling.remaining_volume_mm3
                - sum(piece.volume_mm3 for piece in pieces)
            )
        self._pieces += pieces
        if part.removed_volume_mm3 or self.milling is not None or self._last is None:
            self._last = pieces[-1] if pieces else part.make_remaining_piece()
        self.part = self.milling = None

    def make_report(self) -> PartReport:
        """Return the report on the part after the program."""
        left = self.part.volume_mm3 if self.part is not None else 0.0
        if self.milling is not None:
            left = self.milling.remaining_volume_mm3
        sides = (
            self.milling.make_section_halves()
            if self.milling is not None and not self.parted_piece_count
            else None
        )
        self._finish()
        self.findings.add_final_findings()
        stock = self._stock
        assumed = [each.explanation for _, each in sorted(self._tools.assumed_tools.items())]
        if stock is None and self._tools.tool_uses:
            assumed.append(
                "no stock could be assumed: feed moves cut in front of Z0, so the stock face cannot be at Z0"
            )
        for line, n, text in self._tools.find_feeds_without_cut(stock):
            self.findings.report_missing_cut(line, n, text)
        volume = TurnedPart(stock).volume_mm3 if stock is not None else 0.0
        return PartReport(
            stock=stock,
            stock_volume_mm3=volume,
            removed_volume_mm3=self._removed,
            remaining_volume_mm3=left,
            last_piece=self._last,
            is_milled=self._milled,
            parted_pieces=tuple(self._pieces),
            assumptions=tuple(assumed),
            findings=self.findings.diagnostics,
            unchecked_data=(*self._unchecked, *_cut_standing(self._standing)),
            tool_shapes={
                n: self._tools.find_tool_shape(n)
                for n, use in self._tools.tool_uses.items()
                if use.moves or use.live_tool_steps
            },
            section_halves=sides,
        )


def _cut_standing(lines: Mapping[int, int]) -> list[str]:
    return [
        Message(
            "cuts made by {tool} with the spindle stopped, from line {line} on",
            tool=format_edge_name(tool),
            line=line,
        )
        for tool, line in lines.items()
    ]
