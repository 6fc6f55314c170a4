"""The machine of the worked tables: an A-C table whose lines do not meet, and a workpiece off its centre."""

from __future__ import annotations

import dataclasses

from core.geometry.rotary_axes import Kinematics, LinearAxis, RotaryAxis

A = RotaryAxis("A", True, (1.0, 0.0, 0.0), (0.0, 250.0, -430.0), -120.0, 120.0, vmax=60.0)
C = RotaryAxis("C", True, (0.0, 0.0, 1.0), (300.0, 252.0, 0.0), is_modulo=True, vmax=120.0)
SLIDES = (
    LinearAxis("X", -100.0, 700.0, 400.0),
    LinearAxis("Y", -100.0, 600.0, 400.0),
    LinearAxis("Z", -600.0, 0.0, 400.0),
)
ORIGIN = (230.0, 210.0, -350.0)
AC = Kinematics(SLIDES, (C, A), ORIGIN, axis_order=("X", "Y", "Z", "A", "C"))

CHAMFERS = {
    1: ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 1.0)),
    2: ((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 1.0)),
    3: ((0.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 1.0)),
    4: ((0.0, 0.0, 0.0), (0.0, -1.0, 0.0), (1.0, 0.0, 1.0)),
}
DATUMS = {1: (0.0, 10.0, 0.0), 2: (90.0, 0.0, 0.0), 3: (100.0, 90.0, 0.0), 4: (10.0, 100.0, 0.0)}


def limited(low: float, high: float) -> Kinematics:
    """The same machine with another range of A."""
    return dataclasses.replace(AC, rotary_axes=(C, dataclasses.replace(A, travel_min=low, travel_max=high)))
