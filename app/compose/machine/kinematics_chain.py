"""Kinematic chain of a mill for the interpreter, from the machine file."""

from __future__ import annotations

import math

from core.geometry.rotary_axes import Kinematics, Rotary, Slide
from core.machine.machine_model import Axis, Machine
from core.machine.mill_kinematics import RotaryModel

_SLIDES = ("X", "Y", "Z")


def kinematics_of(machine: Machine) -> Kinematics | None:
    """Return the linear and rotary axes of a mill; None without Y or without [kinematics]."""
    names = tuple(axis.name for axis in machine.axes)
    if machine.kinematics is None or not set(_SLIDES) <= set(names):
        return None
    x, y, z = (_slide(machine.axis(name)) for name in _SLIDES)
    return Kinematics(
        slides=(x, y, z),
        rotaries=tuple(_rotary(each, machine.axis(each.name)) for each in machine.kinematics.chain),
        origin=machine.kinematics.origin,
        basic_rotation=machine.kinematics.basic_rotation,
        order=names,
    )


def _slide(axis: Axis) -> Slide:
    low, high = axis.travel or (-math.inf, math.inf)
    return Slide(axis.name, low, high, axis.vmax)


def _rotary(model: RotaryModel, axis: Axis) -> Rotary:
    low, high = axis.travel or (-math.inf, math.inf)
    return Rotary(
        name=axis.name,
        table=model.table,
        direction=model.unit_vector,
        point=model.point,
        low=low,
        high=high,
        modulo=model.modulo,
        vmax=axis.vmax,
    )
