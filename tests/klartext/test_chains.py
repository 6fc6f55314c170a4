"""Machines of other kinds: one rotary axis, B-C tables, heads, a head over a table. One rule for all."""

from __future__ import annotations

import dataclasses
import math
import random

import numpy as np
import numpy.typing as npt
import pytest

from core.geometry.rotary_axes import Kinematics, PivotMove, RotaryAxis
from core.geometry.rotation_frames import (
    X_AXIS,
    Y_AXIS,
    Z_AXIS,
    Vector,
    make_frame_from_points,
    make_rotation,
    multiply_matrices,
)
from core.geometry.swivel_angles import PrimaryAxisSide, choose_solution, find_all_solutions
from tests.klartext.table import AC, CHAMFERS, ORIGIN, SLIDES, A, C

Array = npt.NDArray[np.float64]

A_HEAD = RotaryAxis("A", False, X_AXIS, (0.0, 0.0, 150.0), -120.0, 120.0)
B_HEAD = RotaryAxis("B", False, Y_AXIS, (0.0, 0.0, 150.0), -120.0, 120.0)
C_HEAD = RotaryAxis("C", False, Z_AXIS, (0.0, 30.0, 0.0), -360.0, 360.0)
B_TABLE = RotaryAxis("B", True, Y_AXIS, (310.0, 0.0, -430.0), -120.0, 120.0)


def machine(*chain: RotaryAxis) -> Kinematics:
    return Kinematics(SLIDES, chain, ORIGIN)


CHAINS = {
    "A-C table": machine(C, A),
    "B-C table": machine(C, B_TABLE),
    "A head over C table": machine(C, A_HEAD),
    "C fork head, A at the tool": machine(C_HEAD, A_HEAD),
    "C head, B at the tool": machine(C_HEAD, B_HEAD),
    "A table under B head": machine(A, B_HEAD),
}


def rotation(axis: Vector, degrees: float) -> Array:
    """Rodrigues by the exponential's series: independent of the product's own."""
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    t = math.radians(degrees)
    return np.asarray(np.eye(3) + math.sin(t) * k + (1 - math.cos(t)) * (k @ k))


@pytest.mark.parametrize("name", CHAINS)
def test_forward_of_inverse_kinematics_is_the_frame(name: str) -> None:
    chain, dice = CHAINS[name], random.Random(7)
    for _ in range(300):
        frame = multiply_matrices(
            make_rotation(Z_AXIS, dice.uniform(-180, 180)),
            make_rotation(X_AXIS, dice.uniform(0.0, 179.0)),
            make_rotation(Z_AXIS, dice.uniform(-180, 180)),
        )
        found = find_all_solutions(chain, frame)
        assert len(found) == 2
        for solution in found:
            back = multiply_matrices(
                chain.compute_tool_frame(solution.axis_angles),
                make_rotation(Z_AXIS, solution.tool_rotation_deg),
            )
            assert np.abs(np.array(back) - np.array(frame)).max() < 1e-9


@pytest.mark.parametrize("name", CHAINS)
def test_tool_axis_is_normal_to_plane_in_machine(name: str) -> None:
    """The tool axis as the machine sees it, and the plane's normal carried along by the tables, are one."""
    chain = CHAINS[name]
    frame = make_frame_from_points(*CHAMFERS[2])
    found = choose_solution(chain, frame, {})
    assert found is not None
    table = np.eye(3)
    tool = np.array(Z_AXIS)
    for axis in reversed(chain.rotary_axes):
        if axis.is_table:
            table = table @ rotation(axis.direction, -found.axis_angles[axis.name])
        else:
            tool = rotation(axis.direction, found.axis_angles[axis.name]) @ tool
    assert np.allclose(table @ np.array(frame)[:, 2], tool, atol=1e-12)
    assert np.allclose(chain.compute_tool_direction(found.axis_angles), tool, atol=1e-12)


def test_head_puts_tool_tip_at_programmed_point() -> None:
    """A fork head, a tool of 80 mm: the tip, carried from the nose about both lines, is where it should."""
    chain = CHAINS["C fork head, A at the tool"]
    frame = make_frame_from_points(*CHAMFERS[2])
    found = choose_solution(chain, frame, {})
    assert found is not None
    a, c = found.axis_angles["A"], found.axis_angles["C"]
    q = np.array((50.0, -7.0, 3.0))
    slides = np.array(
        chain.make_transform(found.axis_angles, frame, (90.0, 0.0, 0.0), 80.0).convert_to_machine_position(
            (50.0, -7.0, 3.0)
        )
    )
    pivot_a, pivot_c = np.array(A_HEAD.point_on_axis), np.array(C_HEAD.point_on_axis)
    tip = pivot_a + rotation(X_AXIS, a) @ (np.array((0, 0, -80.0)) - pivot_a)
    tip = pivot_c + rotation(Z_AXIS, c) @ (tip - pivot_c)
    wanted = np.array(ORIGIN) + np.array((90.0, 0.0, 0.0)) + np.array(frame) @ q
    assert slides + tip == pytest.approx(wanted, abs=1e-9)


def test_longer_tool_raises_linear_axes_of_table_machine() -> None:
    short, long = AC.make_transform({"A": 45.0}), AC.make_transform({"A": 45.0}, tool_length=80.0)
    low, high = (
        short.convert_to_machine_position((1.0, 2.0, 3.0)),
        long.convert_to_machine_position((1.0, 2.0, 3.0)),
    )
    assert np.subtract(high, low) == pytest.approx((0.0, 0.0, 80.0), abs=1e-12)


@pytest.mark.parametrize(("chamfer", "a", "spin"), [(1, 45.0, 0.0), (3, -45.0, 180.0)])
def test_single_rotary_axis_reaches_planes_across_it(chamfer: int, a: float, spin: float) -> None:
    found = choose_solution(machine(A), make_frame_from_points(*CHAMFERS[chamfer]), {})
    assert found is not None
    assert found.axis_angles["A"] == pytest.approx(a)
    assert abs(found.tool_rotation_deg) == pytest.approx(spin)


@pytest.mark.parametrize("chamfer", [2, 4])
def test_single_rotary_axis_does_not_reach_other_planes(chamfer: int) -> None:
    assert choose_solution(machine(A), make_frame_from_points(*CHAMFERS[chamfer]), {}) is None


def test_single_rotary_axis_has_one_solution_side() -> None:
    frame = make_frame_from_points(*CHAMFERS[1])
    assert choose_solution(machine(A), frame, {}, PrimaryAxisSide.SYM_PLUS) is not None
    assert choose_solution(machine(A), frame, {}, PrimaryAxisSide.SYM_MINUS) is None


def test_c_table_alone_rotates_but_cannot_tilt() -> None:
    flat = make_rotation(Z_AXIS, 30.0)
    standing, turning = (
        choose_solution(machine(C), flat, {}),
        choose_solution(machine(C), flat, {}, rotates_table=True),
    )
    assert standing is not None
    assert turning is not None
    assert (standing.axis_angles["C"], standing.tool_rotation_deg) == pytest.approx((0.0, 30.0))
    assert (turning.axis_angles["C"], turning.tool_rotation_deg) == pytest.approx((30.0, 0.0))
    assert choose_solution(machine(C), make_frame_from_points(*CHAMFERS[1]), {}) is None


def test_c_table_above_a_only_rotates_about_tool() -> None:
    """Workpiece, A, C: Rx(A) Rz(C)."""
    found = choose_solution(machine(A, C), make_frame_from_points(*CHAMFERS[1]), {})
    assert found is not None
    assert (found.axis_angles["A"], found.axis_angles["C"], found.tool_rotation_deg) == pytest.approx(
        (45.0, 0.0, 0.0)
    )
    assert choose_solution(machine(A, C), make_frame_from_points(*CHAMFERS[2]), {}) is None


def test_limited_c_axis_uses_revolution_nearest_to_its_position() -> None:
    limited = dataclasses.replace(C, is_modulo=False, travel_min=-360.0, travel_max=360.0)
    chain, frame = machine(limited, A), make_frame_from_points(*CHAMFERS[2])
    for present, wanted in ((0.0, 90.0), (-200.0, -270.0), (359.0, 90.0)):
        found = choose_solution(chain, frame, {"A": 45.0, "C": present}, PrimaryAxisSide.SYM_PLUS)
        assert found is not None
        assert found.axis_angles["C"] == pytest.approx(wanted)


def test_reversed_axis_gives_opposite_angle() -> None:
    backwards = dataclasses.replace(A, direction=(-1.0, 0.0, 0.0))
    found = choose_solution(
        machine(C, backwards), make_frame_from_points(*CHAMFERS[1]), {}, PrimaryAxisSide.SYM_MINUS
    )
    assert found is not None
    assert (found.axis_angles["A"], found.axis_angles["C"] % 360.0) == pytest.approx((-45.0, 0.0))


def test_reversed_table_axis_does_not_swap_solution_sides() -> None:
    """SYM+ is the side of the greater A angle, whichever way C counts."""
    chain, frame = (
        machine(dataclasses.replace(C, direction=(0.0, 0.0, -1.0)), A),
        make_frame_from_points(*CHAMFERS[2]),
    )
    for side, wanted in (
        (PrimaryAxisSide.SYM_PLUS, (45.0, 270.0)),
        (PrimaryAxisSide.SYM_MINUS, (-45.0, 90.0)),
    ):
        found = choose_solution(chain, frame, {}, side)
        assert found is not None
        assert (found.axis_angles["A"], found.axis_angles["C"]) == pytest.approx(wanted)


def test_machine_without_rotary_axes_reaches_only_its_own_plane() -> None:
    assert choose_solution(machine(), make_rotation(Z_AXIS, 30.0), {}) is not None
    assert choose_solution(machine(), make_frame_from_points(*CHAMFERS[1]), {}) is None


def test_the_basic_rotation_turns_the_workpiece_about_its_zero() -> None:
    turned_part = dataclasses.replace(AC, basic_rotation_deg=90.0)
    place = turned_part.make_transform({}, turned_part.workpiece_rotation)
    assert place.convert_to_machine_position((10.0, 0.0, 0.0)) == pytest.approx((230.0, 220.0, -350.0))


def on_the_workpiece(chain: Kinematics, angles: dict[str, float], slides: Array, length: float) -> Array:
    """The tip in the machine-parallel system of the workpiece, by rotations about each line in turn."""
    tip = np.array((0.0, 0.0, -length))
    for axis in reversed(chain.rotary_axes):
        if not axis.is_table:
            point = np.array(axis.point_on_axis)
            tip = point + rotation(axis.direction, angles[axis.name]) @ (tip - point)
    spot = slides + tip
    for axis in reversed(chain.rotary_axes):
        if axis.is_table:
            point = np.array(axis.point_on_axis)
            spot = point + rotation(axis.direction, angles[axis.name]) @ (spot - point)
    return np.asarray(spot - np.array(ORIGIN))


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize("depth", [0.0, 35.0])
def test_move_option_preserves_pivot_for_any_chain(name: str, depth: float) -> None:
    chain, length = CHAINS[name], 80.0
    names = [axis.name for axis in chain.rotary_axes]
    start, end = dict.fromkeys(names, 5.0), dict(zip(names, (70.0, -40.0), strict=True))
    pivot = (12.0, -7.0, 25.0)
    way = PivotMove(chain, start, end, pivot, depth, length, 1.0)
    for row in way.compute_machine_positions(np.linspace(0.0, 1.0, 9)).tolist():
        at = dict(zip(chain.axis_names, row, strict=True))
        slides = np.array((at["X"], at["Y"], at["Z"]))
        # A tool as much longer as the pivot lies deeper has its tip on it.
        assert on_the_workpiece(chain, at, slides, length + depth) == pytest.approx(pivot, abs=1e-9)
