"""Kinematic chain of a mill for the interpreter, built from the machine file."""

from __future__ import annotations

import math

from core.geometry.rotary_axes import Kinematics, LinearAxis, RotaryAxis
from core.machine.machine_model import Axis, Machine
from core.machine.mill_kinematics import RotaryModel

_LINEAR_AXES = ("X", "Y", "Z")


def build_kinematics(machine: Machine) -> Kinematics | None:
    """Return the kinematic chain of a mill, or None for a machine without a Y axis.

    The result is also None if the machine file has no [kinematics] table.
    """
    names = tuple(axis.name for axis in machine.axes)
    if machine.kinematics is None or not set(_LINEAR_AXES) <= set(names):
        return None
    x, y, z = (_slide(machine.find_axis(name)) for name in _LINEAR_AXES)
    return Kinematics(
        linear_axes=(x, y, z),
        rotary_axes=tuple(_rotary(each, machine.find_axis(each.name)) for each in machine.kinematics.chain),
        origin=machine.kinematics.origin,
        basic_rotation_deg=machine.kinematics.basic_rotation,
        axis_order=names,
    )


def _slide(axis: Axis) -> LinearAxis:
    low, high = axis.travel or (-math.inf, math.inf)
    return LinearAxis(axis.name, low, high, axis.max_speed)


def _rotary(model: RotaryModel, axis: Axis) -> RotaryAxis:
    low, high = axis.travel or (-math.inf, math.inf)
    return RotaryAxis(
        name=axis.name,
        is_table=model.is_table,
        direction=model.unit_vector,
        point_on_axis=model.point,
        travel_min=low,
        travel_max=high,
        is_modulo=model.modulo,
        vmax=axis.max_speed,
    )
