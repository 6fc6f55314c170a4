"""Soft limits: a program that would leave the travel of a slide is refused before anything moves."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from core.interpreter.elementary_blocks import Block, Kind, Series
from core.language.diagnostics import Diagnostic, Severity
from core.language.source import Dialect
from core.machine.machine_model import Axis, Machine
from core.message import Message
from core.tool_edges import edge_name

MM_PER_INCH = 25.4


def travel_findings(
    blocks: Sequence[Block], machine: Machine, dialect: Dialect = Dialect.OMNITURN
) -> Iterator[Diagnostic]:
    """An error for each block whose machine positions leave the travel; curved ways all along."""
    limits = [(axis, *axis.reach) for axis in machine.axes]
    for block in _outside(blocks, limits):
        for (axis, least, most), (low, high) in zip(limits, block.machine_reach(), strict=True):
            if low < least or high > most:
                yield _beyond(machine, dialect, block, axis, low, high)


def _outside(blocks: Sequence[Block], limits: Sequence[tuple[Axis, float, float]]) -> Iterator[Block]:
    """Blocks that may leave the travel: straight moves of a lathe, which are most, are seen by their ends."""
    (_, x_least, x_most), (_, z_least, z_most) = limits[:2]
    endless = all(least == -math.inf for _, least, _ in limits[2:])
    if endless and isinstance(blocks, Series):
        x, z = blocks.x + blocks.pattern.offset_x, blocks.z + blocks.pattern.offset_z
        inside = (x_least <= x) & (x <= x_most) & (z_least <= z) & (z <= z_most)
        yield from (blocks[at] for at in (~inside).nonzero()[0].tolist())
        return
    for block in blocks:
        straight = block.kind is Kind.FEED or block.kind is Kind.RAPID
        if not (straight and endless and block.travel is None):
            yield block
            continue
        mx, mz = block.mx, block.mz
        if not (x_least <= mx <= x_most and z_least <= mz <= z_most):
            yield block


def _beyond(
    machine: Machine, dialect: Dialect, block: Block, axis: Axis, low: float, high: float
) -> Diagnostic:
    least, greatest = axis.reach
    at = low if low < least else high
    limit = least if low < least else greatest
    scale, unit, places = (1.0, "mm", 3) if block.modal.metric else (1 / MM_PER_INCH, "in", 4)
    if axis.rotary:
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
    if machine.kind != "lathe" or axis.rotary:
        return Message("check the {axis} word and all active shifts", axis=axis.name)
    where = Message(
        "check the {axis} word and the offset of {tool}", axis=axis.name, tool=edge_name(block.modal.tool)
    )
    if dialect is Dialect.OMNITURN:
        return Message("{place}; also check every G10 and G92", place=where)
    return Message("{place}; also check G54 to G59 and TRANS", place=where)


# --- C as the spindle -----------------------------------------------------------------------------------


def c_findings(blocks: Sequence[Block], machine: Machine) -> Iterator[Diagnostic]:
    """An error for each block that moves C while the spindle, which is this machine's C, turns."""
    if not machine.spindle_is_c or isinstance(blocks, Series):  # which moves X and Z alone
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
