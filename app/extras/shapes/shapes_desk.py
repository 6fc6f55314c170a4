"""Data of the machine and its tools for shapes."""

from __future__ import annotations

import re
from collections.abc import Mapping

from app.compose.extra import extras
from app.compose.stored_offsets import shapes_at_hand
from app.desk.desk import Desk
from app.extras.shapes.shapes_model import Shapes
from core.extras.shapes.shape_fields import Setting, Shop
from core.machine.machine_model import Axis, Machine
from core.part.tool_shape import ToolShape

_LIVE = re.compile(r"live|mill|driven", re.IGNORECASE)
_USUAL = (15, 16)


def shapes_of(desk: Desk, machine: Machine) -> Shapes:
    """Return the shapes model. The tools are read again each time a form opens."""
    found = Shapes(lambda: shop_of(machine, shapes_at_hand()), Setting(metric=not machine.inch))
    for extra in extras().values():
        extra.extend(found, desk, machine)
    return found


def shop_of(machine: Machine, tools: Mapping[int, ToolShape]) -> Shop:
    """Return the machine and tool data on which proposals and limits of a shape depend."""
    by_name = {axis.name: axis for axis in machine.axes}
    z, c = by_name.get("Z"), by_name.get("C")
    return Shop(
        max_rpm=machine.spindle.rpm_max,
        power=machine.spindle.power or Shop().power,
        slide_accel=z.amax if z is not None else 0.0,
        c_rpm=c.vmax / 6.0 if c is not None and c.vmax else Shop().c_rpm,
        live=_live(machine),
        live_output=bool(machine.live_output),
        third_axis=machine.third_axis if machine.c_enabled else "",
        spindle_is_c=machine.spindle_is_c,
        chuck=_chuck(machine),
        travel=(_travel(by_name.get("X")), _travel(z)),
        tools=dict(tools),
    )


def _travel(axis: Axis | None) -> float:
    """Return the length of an axis's travel in mm, 0 if the machine file does not limit it."""
    return axis.travel[1] - axis.travel[0] if axis is not None and axis.travel else 0.0


def _chuck(machine: Machine) -> tuple[int, int] | None:
    """Return the M codes that open and close the chuck, or None if the machine file does not define them."""
    codes = {on: code for code, (output, on) in sorted(machine.m_codes.items()) if output == "collet"}
    return (codes[False], codes[True]) if len(codes) == 2 else None


def _live(machine: Machine) -> tuple[int, int]:
    """Return the first M codes that switch the live tool on and off, found by the name of the output."""
    for code, (output, state) in sorted(machine.m_codes.items()):
        if state and _LIVE.search(output):
            off = [other for other, (name, on) in machine.m_codes.items() if name == output and not on]
            if off:
                return code, min(off)
    return _USUAL
