"""Datum shift, mirroring, rotation, scaling and a tilted plane in every order, by matrices of its own."""

from __future__ import annotations

import itertools
import math
import random

import numpy as np
import numpy.typing as npt

from tests.klartext.running import run
from tests.klartext.table import ORIGIN, A, C

Array = npt.NDArray[np.float64]
STEPS = ("shift", "mirror", "turn", "scale", "plane")


def about(axis: str, degrees: float) -> Array:
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    rows = {"X": [[1, 0, 0], [0, c, -s], [0, s, c]], "Z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}
    return np.array(rows[axis])


def on_the_machine(spot: Array, a: float, c: float) -> Array:
    """Where tables at A and C bring a point of the workpiece: each turns it by minus its angle."""
    turned = C.point_on_axis + about("Z", -c) @ (np.array(ORIGIN) + spot - C.point_on_axis)
    moved: Array = A.point_on_axis + about("X", -a) @ (turned - A.point_on_axis)
    return moved


def told(step: str, value: object, old: bool) -> str:
    match step, value:
        case "shift", (x, y, z):
            return (
                f"CYCL DEF 7.0\nCYCL DEF 7.1 X{x:+g}\nCYCL DEF 7.2 Y{y:+g}\nCYCL DEF 7.3 Z{z:+g}\n"
                if old
                else f"TRANS DATUM AXIS X{x:+g} Y{y:+g} Z{z:+g}\n"
            )
        case "mirror", str():
            return f"CYCL DEF 8.0\nCYCL DEF 8.1 {value}\n" if old else f"TRANS MIRROR AXIS {value}\n"
        case "turn", float():
            return (
                f"CYCL DEF 10.0\nCYCL DEF 10.1 ROT{value:+g}\n" if old else f"TRANS ROTATION ROT{value:+g}\n"
            )
        case "scale", float():
            return f"CYCL DEF 11.0\nCYCL DEF 11.1 SCL {value:g}\n" if old else f"TRANS SCALE SCL{value:g}\n"
        case _, (a, c):
            return f"PLANE AXIAL A{a:+g} C{c:+g} TURN FMAX\n"
    raise AssertionError(step)


def test_plane_and_transformations_combine_in_every_order() -> None:
    """A shift counts in the system in force where it stands; a point is scaled, mirrored, turned about
    the datum, in whatever order that was told."""
    some = random.Random(11)
    for order in itertools.permutations(STEPS):
        shift = tuple(float(some.randint(-30, 30)) for _ in "XYZ")
        mirror, turn = some.choice(("X", "Y", "X Y", "Z")), float(some.randint(-170, 170))
        scale, tilt = some.randint(5, 18) / 10.0, (some.randint(5, 80), some.randint(0, 350))
        values = {"shift": shift, "mirror": mirror, "turn": turn, "scale": scale, "plane": tilt}
        q = np.array([some.randint(-50, 50) for _ in "XYZ"], dtype=float)
        text = "".join(told(step, values[step], some.random() < 0.5) for step in order)
        ran = run(f"{text}L X{q[0]:+g} Y{q[1]:+g} Z{q[2]:+g} FMAX")
        assert ran.codes == []
        frame = about("Z", tilt[1]) @ about("X", tilt[0])
        seen = about("Z", turn) @ (q * scale * [-1.0 if axis in mirror else 1.0 for axis in "XYZ"])
        within = order.index("shift") > order.index("plane")
        spot = frame @ (seen + shift) if within else shift + frame @ seen
        axes = ran.axes(ran.blocks[-2])
        assert np.allclose([axes[name] for name in "XYZ"], on_the_machine(spot, *tilt), atol=1e-9), order
