"""Table of milling cycles 210 to 215 and 251 to 257; older cycles are executed as newer ones."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from core.interpreter.klartext.cycles.cycle_moves import CycleParameters, CycleTool
from core.interpreter.klartext.cycles.hole_cycles import read_cycle_heights
from core.interpreter.klartext.cycles.pocket_cycles import (
    mill_circular_pocket,
    mill_circular_slot,
    mill_circular_stud,
    mill_rectangular_pocket,
    mill_rectangular_stud,
    mill_slot,
)
from core.interpreter.shared.elementary_blocks import Block

MillingCycle = Callable[[CycleTool], Iterator[Block]]
_HEIGHTS: CycleParameters = {200: 200, 201: 201, 203: 203, 204: 204}
_SLOT: CycleParameters = {**_HEIGHTS, 202: 202, 206: 207, 207: 207, 215: 215, 219: 219, 338: 338, 366: 1.0}
_WALLS: CycleParameters = {**_HEIGHTS, 202: 202, 206: 206, 207: 207, 215: 2.0, 338: 202}


def _make_centered_cycle(milling: MillingCycle, parameters: CycleParameters) -> MillingCycle:
    """Return a cycle that executes another cycle at the center Q216, Q217 with these parameters."""

    def run_centered_cycle(tool: CycleTool) -> Iterator[Block]:
        surface, clear, _ = read_cycle_heights(tool)
        yield tool.move_to_z(max(clear, surface + tool.read_length_mm(204, 0.0), tool.z_position))
        yield tool.move_straight((tool.read_length_mm(216), tool.read_length_mm(217)))
        yield from milling(tool.copy_with_parameters(parameters))

    return run_centered_cycle


def _round_corners(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 212, a pocket whose corners are rounded with Q220.

    If Q220 is 0, the corner radius is the tool radius.
    """
    radius = tool.read_length_mm(220, 0.0) or tool.radius_mm
    yield from _make_centered_cycle(
        mill_rectangular_pocket, {**_WALLS, 218: 218, 219: 219, 220: radius / tool.mm_per_unit}
    )(tool)


def _older_stud(tool: CycleTool) -> Iterator[Block]:
    """Yield the blocks of cycle 213, a rectangular stud.

    The oversize of the blank is Q221, or the tool diameter if Q221 is missing.
    """
    more = 2.0 * (tool.read_parameter(221, 0.0) or tool.radius_mm / tool.mm_per_unit)
    sides = {424: tool.read_parameter(218) + more, 425: tool.read_parameter(219) + more}
    yield from _make_centered_cycle(mill_rectangular_stud, {**_WALLS, 218: 218, 219: 219, 220: 220, **sides})(
        tool
    )


MILLING_CYCLES: dict[int, MillingCycle] = {
    210: _make_centered_cycle(mill_slot, {**_SLOT, 218: 218, 374: 224}),
    211: _make_centered_cycle(
        mill_circular_slot, {**_SLOT, 216: 216, 217: 217, 375: 244, 376: 245, 248: 248}
    ),
    212: _round_corners,
    213: _older_stud,
    214: _make_centered_cycle(mill_circular_pocket, {**_WALLS, 223: 223}),
    215: _make_centered_cycle(mill_circular_stud, {**_WALLS, 222: 222, 223: 223}),
    251: mill_rectangular_pocket,
    252: mill_circular_pocket,
    253: mill_slot,
    254: mill_circular_slot,
    256: mill_rectangular_stud,
    257: mill_circular_stud,
}
"""Milling cycles by cycle number."""
