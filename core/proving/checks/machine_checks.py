"""Checks against the machine: the travel limits, and the states that a cut requires.

A cut requires an active tool, a closed collet, and a running spindle or live tool. The inputs that the
program reads or waits for are also checked.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

from core.geometry.surface_speed import find_surface_rpm
from core.interpreter.shared.actions import (
    ColletSwitch,
    InputRead,
    InputWait,
    Preset,
    ProgramEnd,
    SpindleRun,
    ToolChange,
)
from core.interpreter.shared.elementary_blocks import Block, BlockKind, StraightMoveSeries
from core.interpreter.shared.modal_state import ModalState
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect
from core.machine.machine_model import Axis, Machine
from core.message import Message
from core.proving.tip_moves import is_rigid_tap
from core.tool_edges import format_edge_name

LIVE_TOOL_PREFIX = "live"
"""Prefix of the names of live tool outputs in the machine file."""

_QUICK = 100 * 25.4 / 60  # mm/s; a feed per minute at this speed or more is a positioning move
# mm/s of surface speed; higher speeds need tools that small lathes do not have
_FASTEST = 1000.0 * 1000.0 / 60.0
_MILLING = frozenset({BlockKind.PLANE_LINE, BlockKind.PLANE_ARC})
_METAL = _MILLING | {BlockKind.ARC, BlockKind.THREAD}
_PATH_KINDS = _METAL | {BlockKind.FEED}
_MAX_FINDINGS = 100  # findings
MM_PER_INCH = 25.4


def is_cutting_move(block: Block) -> bool:
    """Return whether a move is slow enough to cut material, that is, not a rapid or a fast feed."""
    return block.kind in _PATH_KINDS and (
        block.per_rev or block.feed < _QUICK or block.kind is BlockKind.THREAD
    )


@dataclass(slots=True)
class CuttingChecks:
    """Checks of the machine states that a cut requires, for blocks that are passed in program order.

    ``findings`` returns the results. A fault that persists gives one finding, at its first block. For
    languages other than OmniTurn, only the tool and the spindle are checked, because their frames and
    collets differ.
    """

    machine: Machine
    dialect: Dialect
    is_mdi_line: bool = False  # an MDI line, for which the operator sees the active tool
    is_position_known: bool = (
        False  # the axis positions are known from a move, or this is not the start of a program
    )
    _found: list[Diagnostic] = field(default_factory=list)
    _without_tool: list[Diagnostic] = field(default_factory=list)  # their severity is decided at the end
    _names_tool: bool = False
    _tool_off: int = 0  # =
    _preset: bool = False  # G92 has set the position since the last T
    _has_run: bool = False  # the program has turned the spindle
    _reported: frozenset[str] = frozenset()  # present faults that have been reported
    _cut_before_collet: int = 0  # line of the first cut before any M12 or M13
    _collet: bool = False  # M12 or M13 has been executed
    _asked: frozenset[str] = frozenset()
    _like: tuple[ModalState, BlockKind] | None = (
        None  # state of the previous move; a similar move needs no check
    )

    def copy_for_branch(self) -> CuttingChecks:
        """Return a copy in the same state, without the findings, for another path through the program."""
        return replace(self, _found=[], _without_tool=[])

    @property
    def findings(self) -> list[Diagnostic]:
        """Return the findings in the order of the blocks."""
        weight = Severity.ERROR if self._names_tool else Severity.WARNING
        return [*self._found, *(replace(each, severity=weight) for each in self._without_tool)]

    def check_blocks(self, blocks: Sequence[Block]) -> None:
        """Check the next blocks of the program."""
        if not blocks:
            return
        own = self.dialect is Dialect.OMNITURN
        alike: Iterable[Block] = (
            _iter_distinct_moves(blocks) if isinstance(blocks, StraightMoveSeries) else blocks
        )
        for block in alike:
            if block.action is not None:
                self._like = None
                self._act(block)
                continue
            if block.css is not None and is_cutting_move(block):
                self._check_surface_speed(block)
            if (block.modal, block.kind) != self._like:
                if own and not self.is_position_known:
                    self._check_first_move(block)
                self._like = (block.modal, block.kind) if block.modal.collet_closed else None
                if is_cutting_move(block):
                    (self._cut if own else self._check_other_dialect_cut)(block)

    def _check_first_move(self, block: Block) -> None:
        """Warn about an incremental first move, because its start position is unknown in the proof."""
        self.is_position_known = True
        if block.modal.absolute is False:
            text = (
                "The first move is incremental: it starts from the current axis position, but was "
                "proved from home."
            )
            hint = "Start with a move to X and Z under G90."
            self._add(_finding(block, Severity.WARNING, "start-place", text, hint))

    def _act(self, block: Block) -> None:
        match block.action:
            case ToolChange(tool=tool):
                self._names_tool = self._names_tool or tool > 0
                self._tool_off = 0 if tool else block.line
                self._preset = False
                self._clear("no-tool")
            case Preset():
                self._preset = True
            case SpindleRun():
                self._has_run = True
                self._clear("spindle-off")
            case ColletSwitch(closed=closed):
                self._collet = True
                if closed:
                    self._clear("collet-open")
            case InputRead(terminal=terminal) | InputWait(terminal=terminal):
                self._input(block, terminal)
            case ProgramEnd():
                self._end(block)
            case _:
                pass

    def _cut(self, block: Block) -> None:
        modal = block.modal
        if not self._collet:
            self._cut_before_collet = self._cut_before_collet or block.line
        if not (modal.tool or self.is_mdi_line or self._preset or modal.preset_x or modal.preset_z):
            self._no_tool(block)
        if not modal.collet_closed:
            self._check_collet(block)
        if any(name.startswith(LIVE_TOOL_PREFIX) for name in modal.outputs):
            self._clear("live-tool-off", "spindle-off")
        elif is_rigid_tap(block):
            return
        elif modal.c_locked or block.kind in _MILLING:
            self._live_tool_off(block)
        elif not modal.spindle and not block.per_rev and (self._has_run or modal.rpm):
            self._spindle_off(block)

    def _check_surface_speed(self, block: Block) -> None:
        """Check the spindle speeds that G96 requires at both ends of a cut against the active limits."""
        modal, most = block.modal, self.machine.spindle.max_rpm
        speed = block.css or 0.0
        radii = sorted((abs(block.x0), abs(block.x)))
        slowest, fastest = (find_surface_rpm(speed, r, 0.0, math.inf) for r in reversed(radii))
        if speed > _FASTEST and slowest > 2.0 * most:
            text = Message(
                "The surface speed requires {slowest} rpm in this move, but the spindle maximum is "
                "{maximum} rpm.",
                slowest=f"{slowest:.0f}",
                maximum=f"{most:.0f}",
            )
            self._report_once(
                block, Severity.ERROR, "surface-speed", text, "Correct S, or write G97 if S is in rpm."
            )
        limited = abs(block.x) <= abs(block.x0) and abs(block.rpm) < most  # as G26 limits it
        if modal.max_css_rpm is None and fastest > most and not limited:
            text = Message(
                "G96 has no speed limit, so the spindle reaches its maximum of {maximum} rpm in this move.",
                maximum=f"{most:.0f}",
            )
            hint = "Write G77Sn, where n is the maximum rpm for this chuck and bar."
            if self.dialect is Dialect.SINUMERIK:
                hint = "Write LIMS= with the maximum speed for this chuck and bar."
            self._report_once(block, Severity.WARNING, "no-speed-limit", text, hint)

    def _check_other_dialect_cut(self, block: Block) -> None:
        """Check a cut in Klartext or SINUMERIK. The Klartext interpreter checks the spindle itself."""
        modal = block.modal
        if not (modal.tool or self.is_mdi_line):
            self._no_tool(block)
        if self.dialect is Dialect.KLARTEXT:
            return
        if any(name.startswith(LIVE_TOOL_PREFIX) for name in modal.outputs):
            self._clear("spindle-off")
            return
        driven = is_rigid_tap(block) or modal.c_locked or modal.spindle or block.per_rev
        if not driven and (self._has_run or modal.rpm):
            self._spindle_off(block)

    def _no_tool(self, block: Block) -> None:
        text = "This move cuts with no tool active, so its coordinates are relative to machine home."
        hint = "Write T and the tool number before this move."
        if self.dialect is not Dialect.OMNITURN:
            text = "This move cuts with no tool active, so no tool length or radius applies."
            hint = "Write TOOL CALL before this move." if self.dialect is Dialect.KLARTEXT else hint
        elif self._tool_off:
            after = Message("the tool cancel (T0) on line {tool_off}", tool_off=self._tool_off)
            text = Message(
                "This cutting move follows {after}, so its coordinates are relative to machine home.",
                after=after,
            )
        if "no-tool" not in self._reported:
            self._without_tool.append(_finding(block, Severity.ERROR, "no-tool", text, hint))
        self._reported |= {"no-tool"}

    def _check_collet(self, block: Block) -> None:
        """Check that a move does not cut while the collet is open.

        A bar stop or a gripper may move while the collet is open.
        """
        if block.per_rev or block.kind in _METAL or block.modal.c_locked:
            text = "This move cuts with the collet open, so the part is not clamped."
            self._report_once(
                block, Severity.ERROR, "collet-open", text, "Close the collet with M12 before this move."
            )
        elif block.x != block.x0 or block.z < block.z0:
            text = (
                "This move feeds with the collet open, but not in a straight line away from the "
                "spindle, as a bar pull does."
            )
            self._report_once(
                block, Severity.WARNING, "collet-open", text, "Close the collet with M12 before this move."
            )

    def _live_tool_off(self, block: Block) -> None:
        codes = sorted(
            code
            for code, (name, on) in self.machine.m_code_outputs.items()
            if on and name.startswith(LIVE_TOOL_PREFIX)
        )
        if not codes:
            return  # this control does not switch the live tool
        hint = Message(
            "Turn on the live tool with {code} before this move.",
            code=" or ".join(f"M{code:02d}" for code in codes),
        )
        if block.kind in _MILLING:
            text = "This move mills with no live tool running."
            self._report_once(block, Severity.ERROR, "live-tool-off", text, hint)
        else:
            text = "This move cuts with the spindle locked as the C axis and no live tool running."
            self._report_once(block, Severity.WARNING, "live-tool-off", text, hint)

    def _spindle_off(self, block: Block) -> None:
        text = "This move cuts with the spindle stopped and no live tool running."
        if not self._has_run:
            text = "S sets a speed, but nothing starts the spindle before this cut."
        hint = "Start the spindle with M03 or M04 before this cut."
        if self.dialect is not Dialect.OMNITURN:
            hint = "Start the spindle with M3 or M4 before this cut."
        self._report_once(block, Severity.WARNING, "spindle-off", text, hint)

    def _input(self, block: Block, terminal: str) -> None:
        if terminal in self.machine.inputs or terminal in self._asked:
            return
        self._asked |= {terminal}
        text = Message("This machine has no input {terminal}.", terminal=terminal)
        hint = "Correct the number, or define the input under [io.in] in the machine file."
        if isinstance(block.action, InputWait):
            text = Message(
                "This machine has no input {terminal}, so the wait would never end.", terminal=terminal
            )
        self._add(_finding(block, Severity.ERROR, "no-input", text, hint))

    def _end(self, block: Block) -> None:
        if block.modal.collet_closed or not self._cut_before_collet:
            return
        line = self._cut_before_collet
        text = Message(
            "The program ends with the collet open, and the next cycle cuts on line {line} before any M12.",
            line=line,
        )
        self._add(
            _finding(
                block,
                Severity.WARNING,
                "collet-open",
                text,
                "Write M12 at the end or the start of the program.",
            )
        )

    def _report_once(self, block: Block, severity: Severity, check: str, text: str, hint: str) -> None:
        """Add a finding, unless it has already been added since the fault was last corrected.

        An error is added even after a warning.
        """
        key = f"{check} {severity}"
        if key not in self._reported:
            self._reported |= {key}
            self._add(_finding(block, severity, check, text, hint))

    def _clear(self, *checks: str) -> None:
        self._reported = frozenset(each for each in self._reported if each.split()[0] not in checks)

    def _add(self, found: Diagnostic) -> None:
        if len(self._found) < _MAX_FINDINGS:
            self._found.append(found)


def _iter_distinct_moves(series: StraightMoveSeries) -> Iterator[Block]:
    """Yield the moves of a series that the checks need: the first move, and the first move that cuts.

    If the first move already cuts, only this move is yielded.
    """
    yield series[0]
    if series.feed is not None and not is_cutting_move(series[0]):
        yield from (series[at] for at in (series.feed < _QUICK).nonzero()[0][:1].tolist())


def _finding(block: Block, severity: Severity, check: str, text: str, hint: str) -> Diagnostic:
    return Diagnostic(block.line, 0, severity, check, text, hint, check_name=check, block_number=block.n)


def check_travel(
    blocks: Sequence[Block], machine: Machine, dialect: Dialect = Dialect.OMNITURN
) -> Iterator[Diagnostic]:
    """Yield an error for each block whose move exceeds the travel limits in machine positions."""
    limits = [(axis, *axis.travel_with_margin) for axis in machine.axes]
    for block in _iter_outside_blocks(blocks, limits):
        for (axis, least, most), (low, high) in zip(limits, block.compute_machine_bounds(), strict=True):
            if low < least or high > most:
                yield _beyond(machine, dialect, block, axis, low, high)


def _iter_outside_blocks(
    blocks: Sequence[Block], limits: Sequence[tuple[Axis, float, float]]
) -> Iterator[Block]:
    """Yield the blocks that may exceed the travel limits.

    Straight moves of a lathe are checked only at their ends.
    """
    (_, x_least, x_most), (_, z_least, z_most) = limits[:2]
    endless = all(least == -math.inf for _, least, _ in limits[2:])
    if endless and isinstance(blocks, StraightMoveSeries):
        x, z = blocks.x + blocks.pattern.offset_x, blocks.z + blocks.pattern.offset_z
        inside = (x_least <= x) & (x <= x_most) & (z_least <= z) & (z <= z_most)
        yield from (blocks[at] for at in (~inside).nonzero()[0].tolist())
        return
    for block in blocks:
        straight = block.kind is BlockKind.FEED or block.kind is BlockKind.RAPID
        if not (straight and endless and block.travel is None):
            yield block
            continue
        mx, mz = block.mx, block.mz
        if not (x_least <= mx <= x_most and z_least <= mz <= z_most):
            yield block


def _beyond(
    machine: Machine, dialect: Dialect, block: Block, axis: Axis, low: float, high: float
) -> Diagnostic:
    least, greatest = axis.travel_with_margin
    at = low if low < least else high
    limit = least if low < least else greatest
    scale, unit, places = (1.0, "mm", 3) if block.modal.metric else (1 / MM_PER_INCH, "in", 4)
    if axis.is_rotary:
        scale, unit, places = 1.0, "degrees", 3
    template = (
        "{axis} would move to {position} {unit} from home (X as a radius), {excess} {unit} beyond the travel "
        "limit of {limit}"
        if machine.kind == "lathe"
        else "{axis} would move to {position} {unit} from home, {excess} {unit} beyond the travel limit of "
        "{limit}"
    )
    over = abs(at - limit) * scale
    return Diagnostic(
        line=block.line,
        column=1,
        severity=Severity.ERROR,
        code="soft-limit",
        message=Message(
            template,
            axis=axis.name,
            position=f"{at * scale:.{places}f}",
            unit=unit,
            excess=f"{over:.{places}f}",
            limit=f"{limit * scale:.{places}f}",
        ),
        hint=_hint(machine, dialect, block, axis),
    )


def _hint(machine: Machine, dialect: Dialect, block: Block, axis: Axis) -> str:
    if machine.kind != "lathe" or axis.is_rotary:
        return Message("check the {axis} word and all active shifts", axis=axis.name)
    where = Message(
        "check the {axis} word and the offset of {tool}",
        axis=axis.name,
        tool=format_edge_name(block.modal.tool),
    )
    if dialect is Dialect.OMNITURN:
        return Message("{place}; also check every G10 and G92", place=where)
    return Message("{place}; also check G54 to G59 and TRANS", place=where)


# --- C as the spindle -----------------------------------------------------------------------------------


def check_c_motion(blocks: Sequence[Block], machine: Machine) -> Iterator[Diagnostic]:
    """Yield an error for each block that moves C while the spindle turns.

    Blocks are checked only if the spindle is the C axis.
    """
    if not machine.is_spindle_c_axis or isinstance(blocks, StraightMoveSeries):  # a series moves only X and Z
        return
    for block in blocks:
        if block.c != block.c0 and block.modal.spindle:
            yield Diagnostic(
                line=block.line,
                column=1,
                severity=Severity.ERROR,
                code="c-is-spindle",
                message="C moves while the spindle turns, but on this machine C is the spindle itself",
                hint="stop the spindle with M5 first, or use a lathe with a separate C drive "
                "(sinumerik-modulo)",
            )
