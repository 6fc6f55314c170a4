"""Soft limits: a program that would leave the travel of a slide is refused before anything moves."""

from __future__ import annotations

from collections.abc import Sequence

from core.interpreter.blocks import Block
from core.language.diagnostics import Diagnostic, Severity
from core.machine.model import Axis, Machine

MM_PER_INCH = 25.4

# The step of the control: a word on the limit itself must not fail by the noise of an inch in binary.
TOLERANCE = 1e-6


def travel_findings(blocks: Sequence[Block], machine: Machine) -> list[Diagnostic]:
    """An error for each block whose machine positions leave the travel; arcs are looked at all along."""
    x_axis, z_axis = machine.axes[0], machine.axes[1]
    (x_low, x_high), (z_low, z_high) = _reachable(x_axis), _reachable(z_axis)
    findings = []
    for block in blocks:
        low_x, high_x, low_z, high_z = block.reach()
        x, z = block.offset_x, block.offset_z
        if low_x + x < x_low or high_x + x > x_high:
            findings.append(_beyond(block, x_axis, low_x + x, high_x + x))
        if low_z + z < z_low or high_z + z > z_high:
            findings.append(_beyond(block, z_axis, low_z + z, high_z + z))
    return findings


def _reachable(axis: Axis) -> tuple[float, float]:
    if axis.travel is None:
        return float("-inf"), float("inf")
    return axis.travel[0] - TOLERANCE, axis.travel[1] + TOLERANCE


def _beyond(block: Block, axis: Axis, low: float, high: float) -> Diagnostic:
    least, greatest = _reachable(axis)
    at = low if low < least else high
    limit = least if low < least else greatest
    metric = block.modal.metric
    scale, unit, places = (1.0, "mm", 3) if metric else (1 / MM_PER_INCH, "in", 4)
    over = abs(at - limit) * scale
    return Diagnostic(
        line=block.line,
        column=1,
        severity=Severity.ERROR,
        code="soft-limit",
        message=(
            f"{axis.name} would go to {at * scale:.{places}f} {unit} from home (X as a radius), "
            f"{over:.{places}f} {unit} beyond the travel limit of {limit * scale:.{places}f}"
        ),
        hint=f"check the {axis.name} word, the offset of T{block.modal.tool} and any G10 or G92",
    )
