"""Setup of the shapes panel with the data of the machine and its tools."""

from __future__ import annotations

import re
from collections.abc import Mapping

from app.compose.optional_features import extras
from app.compose.stored_offsets import try_read_shapes
from app.desk.desk import Desk
from app.extras.shapes.shapes_model import ShapesModel
from core.extras.shapes.shape_fields import ProgramSettings, ShopData
from core.machine.machine_model import Axis, Machine
from core.part.tool_shape import ToolShape

_LIVE = re.compile(r"live|mill|driven", re.IGNORECASE)
_USUAL = (15, 16)


def make_shapes_model(desk: Desk, machine: Machine) -> ShapesModel:
    """Return the model of the shapes panel.

    The tool data are read each time the panel opens.
    """
    found = ShapesModel(
        lambda: make_shop_data(machine, try_read_shapes()), ProgramSettings(metric=not machine.is_inch)
    )
    for extra in extras().values():
        extra.extend_model(found, desk, machine)
    return found


def make_shop_data(machine: Machine, tools: Mapping[int, ToolShape]) -> ShopData:
    """Return the machine and tool data that determine the proposed values and limits of a shape."""
    by_name = {axis.name: axis for axis in machine.axes}
    z, c = by_name.get("Z"), by_name.get("C")
    return ShopData(
        max_rpm=machine.spindle.max_rpm,
        spindle_power_w=machine.spindle.power_w or ShopData().spindle_power_w,
        max_acceleration_mm_s2=z.max_acceleration if z is not None else 0.0,
        max_c_axis_rpm=c.max_speed / 6.0 if c is not None and c.max_speed else ShopData().max_c_axis_rpm,
        live_tool_codes=_live(machine),
        has_live_output=bool(machine.live_tool_output),
        third_axis_name=machine.third_axis_name if machine.is_c_enabled else "",
        is_spindle_c_axis=machine.is_spindle_c_axis,
        chuck_codes=_chuck(machine),
        travel_mm=(_travel(by_name.get("X")), _travel(z)),
        tools=dict(tools),
    )


def _travel(axis: Axis | None) -> float:
    """Return the travel of an axis in mm, or 0 if there is no axis or it has no travel limits."""
    return axis.travel[1] - axis.travel[0] if axis is not None and axis.travel else 0.0


def _chuck(machine: Machine) -> tuple[int, int] | None:
    """Return the M codes that open and close the chuck.

    Returns None if the machine file does not define these codes.
    """
    codes = {on: code for code, (output, on) in sorted(machine.m_code_outputs.items()) if output == "collet"}
    return (codes[False], codes[True]) if len(codes) == 2 else None


def _live(machine: Machine) -> tuple[int, int]:
    """Return the M codes that turn the live tool on and off.

    The codes are found by the name of the output that they switch. If several codes match, the lowest are
    returned.
    """
    for code, (output, state) in sorted(machine.m_code_outputs.items()):
        if state and _LIVE.search(output):
            off = [other for other, (name, on) in machine.m_code_outputs.items() if name == output and not on]
            if off:
                return code, min(off)
    return _USUAL
