"""Frames from points and angles, both ways to stand in them, and which is taken: the worked tables."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from core.geometry.rotary_axes import Kinematics
from core.geometry.rotation_frames import (
    IDENTITY,
    X_AXIS,
    Z_AXIS,
    InvalidFrameError,
    Matrix,
    Vector,
    make_frame_from_points,
    make_frame_from_spatial_angles,
    make_rotation,
    multiply_matrices,
)
from core.geometry.swivel_angles import PrimaryAxisSide, choose_solution, find_all_solutions
from tests.coded import raises_code
from tests.klartext.table import AC, CHAMFERS, DATUMS, limited

S = math.sqrt(0.5)
ZERO: Vector = (0.0, 0.0, 0.0)
FRAMES: dict[int, Matrix] = {
    1: ((1, 0, 0), (0, S, -S), (0, S, S)),
    2: ((0, -S, S), (1, 0, 0), (0, S, S)),
    3: ((-1, 0, 0), (0, -S, S), (0, S, S)),
    4: ((0, S, -S), (-1, 0, 0), (0, S, S)),
}
MIDDLE: Vector = (50.0, -7.0710678, 0.0)

# chamfer: SYM+ (A, C, g), machine of the middle, of the datum; the same for SYM-
STANDS = {
    1: (
        ((45, 0, 0), (280.0, 278.2843, -352.2183), (230.0, 285.3553, -352.2183)),
        ((-45, 180, 180), (320.0, 224.5442, -349.3898), (370.0, 217.4731, -349.3898)),
    ),
    2: (
        ((45, 90, 0), (308.0, 286.7696, -360.7035), (258.0, 293.8406, -360.7035)),
        ((-45, 270, 180), (292.0, 216.0589, -357.8751), (342.0, 208.9878, -357.8751)),
    ),
    3: (
        ((45, 180, 0), (320.0, 266.9706, -340.9045), (270.0, 274.0416, -340.9045)),
        ((-45, 0, 180), (280.0, 235.8579, -338.0761), (330.0, 228.7868, -338.0761)),
    ),
    4: (
        ((45, 270, 0), (292.0, 258.4853, -332.4193), (242.0, 265.5563, -332.4193)),
        ((-45, 90, 180), (308.0, 244.3431, -329.5908), (358.0, 237.2721, -329.5908)),
    ),
}


def stands(
    frame: Matrix,
    side: str = "",
    *,
    machine: Kinematics = AC,
    a: float = 0.0,
    c: float = 0.0,
    table_rot: bool = False,
) -> tuple[float, float, float] | None:
    """A, C and what is left to turn; None where there is no solution."""
    asked = PrimaryAxisSide(side) if side else None
    found = choose_solution(machine, frame, {"A": a, "C": c}, asked, rotates_table=table_rot)
    return (
        None if found is None else (found.axis_angles["A"], found.axis_angles["C"], found.tool_rotation_deg)
    )


def about(angles: tuple[float, float, float]) -> object:
    return pytest.approx(angles, abs=1e-6)


@pytest.mark.parametrize("chamfer", CHAMFERS)
def test_frame_of_chamfer_is_same_for_every_definition(chamfer: int) -> None:
    frame = make_frame_from_points(*CHAMFERS[chamfer])
    turn = 90.0 * (chamfer - 1)
    assert np.allclose(frame, FRAMES[chamfer], atol=1e-12)
    assert np.allclose(AC.compute_tool_frame({"A": 45.0, "C": turn}), FRAMES[chamfer], atol=1e-12)
    assert np.allclose(make_frame_from_spatial_angles(45.0, 0.0, turn), FRAMES[chamfer], atol=1e-12)


@pytest.mark.parametrize("chamfer", STANDS)
@pytest.mark.parametrize(("row", "side"), [(0, "SYM+"), (1, "SYM-"), (0, "SEQ+"), (1, "SEQ-")])
def test_both_solutions_of_chamfer_give_expected_positions(chamfer: int, row: int, side: str) -> None:
    frame = make_frame_from_points(*CHAMFERS[chamfer])
    angles, middle, origin = STANDS[chamfer][row]
    found = choose_solution(AC, frame, {}, PrimaryAxisSide(side))
    assert found is not None
    assert (found.axis_angles["A"], found.axis_angles["C"], found.tool_rotation_deg) == about(angles)
    place = AC.make_transform(found.axis_angles, frame, DATUMS[chamfer])
    assert place.convert_to_machine_position(MIDDLE) == pytest.approx(middle, abs=6e-5)
    assert place.convert_to_machine_position(ZERO) == pytest.approx(origin, abs=6e-5)
    assert place.convert_to_frame_point(place.convert_to_machine_position(MIDDLE)) == pytest.approx(
        MIDDLE, abs=1e-9
    )


def test_workpiece_datum_position_on_swiveled_table() -> None:
    for c, there in ((0.0, (230.0, 278.2843, -345.1472)), (90.0, (258.0, 357.4802, -424.3431))):
        assert AC.make_transform({"A": 45.0, "C": c}).convert_to_machine_position(ZERO) == pytest.approx(
            there, abs=6e-5
        )


def test_chamfers_without_sym_stay_on_positive_side() -> None:
    a = c = 0.0
    for chamfer, turn in ((1, 0.0), (2, 90.0), (3, 180.0), (4, 270.0)):
        found = stands(make_frame_from_points(*CHAMFERS[chamfer]), a=a, c=c)
        assert found == about((45.0, turn, 0.0))
        a, c = 45.0, turn


@pytest.mark.parametrize(
    ("points", "frame"),
    [
        (((10, 20, 5), (110, 20, 5), (10, 30, 15)), FRAMES[1]),
        ((ZERO, (1, 0, 0), (5, 1, 1)), FRAMES[1]),
        ((ZERO, (1, 0, 0), (0, 0, 1)), ((1, 0, 0), (0, 0, -1), (0, 1, 0))),
        ((ZERO, (1, 0, 0), (1000, 0.01, 0)), IDENTITY),
        ((ZERO, (1e9, 0, 0), (0, 1e9, 1e9)), FRAMES[1]),
    ],
)
def test_frame_depends_only_on_directions_of_points(
    points: tuple[Vector, Vector, Vector], frame: Matrix
) -> None:
    assert np.allclose(make_frame_from_points(*points), frame, atol=1e-9)


@pytest.mark.parametrize(
    ("points", "plus", "minus"),
    [
        ((ZERO, (1, 0, 0), (0, 0, 1)), (90, 0, 0), (-90, 180, 180)),
        ((ZERO, (1, 0, 0), (0, 0.866025404, 0.5)), (30, 0, 0), (-30, 180, 180)),
        ((ZERO, (1, 0, 0), (0, 1, -1)), (45, 180, 180), (-45, 0, 0)),
    ],
)
def test_solutions_of_other_planes(
    points: tuple[Vector, Vector, Vector],
    plus: tuple[float, float, float],
    minus: tuple[float, float, float],
) -> None:
    frame = make_frame_from_points(*points)
    assert stands(frame, "SYM+") == about(plus)
    assert stands(frame, "SYM-") == about(minus)


@pytest.mark.parametrize(
    "points",
    [
        (ZERO, (0, 1, -1), (1, 0, 0)),  # the second and the third swapped: Z' points down
        (ZERO, (1, 0, 0), (0, -1, 0)),  # on the right of the way: A would be 180
    ],
)
def test_a_plane_that_faces_down_is_out_of_range(points: tuple[Vector, Vector, Vector]) -> None:
    assert stands(make_frame_from_points(*points)) is None


@pytest.mark.parametrize(
    ("points", "code"),
    [
        ((ZERO, ZERO, (0, 1, 0)), "first-and-second-point-equal"),
        (((1, 1, 1), (2, 1, 1), (1, 1, 1)), "first-and-third-point-equal"),
        ((ZERO, ZERO, ZERO), "first-and-second-point-equal"),
        ((ZERO, (1, 0, 0), (5, 0, 0)), "points-on-one-line"),
        ((ZERO, (1, 0, 0), (-5, 0, 0)), "points-on-one-line"),
        ((ZERO, (1, 0, 0), (1000, 0.0001, 0)), "points-on-one-line"),
    ],
)
def test_points_that_define_no_plane_are_rejected(points: tuple[Vector, Vector, Vector], code: str) -> None:
    with raises_code(InvalidFrameError, code):
        make_frame_from_points(*points)


def test_solutions_match_table_of_older_manual() -> None:
    frame = make_frame_from_spatial_angles(0.0, 45.0, 0.0)
    plus, minus = (45.0, 90.0, 0.0), (-45.0, 270.0, 0.0)
    narrow = limited(-90.0, 10.0)
    rows = [
        (AC, 0.0, "", plus),
        (AC, 0.0, "SYM+", plus),
        (AC, 0.0, "SYM-", minus),
        (AC, -105.0, "", minus),
        (AC, -105.0, "SEQ+", plus),
        (AC, -105.0, "SEQ-", minus),
        (narrow, 0.0, "", minus),
    ]
    for machine, c, side, (a_expected, c_expected, _) in rows:
        found = stands(frame, side, machine=machine, c=c)
        assert found is not None
        assert found[:2] == pytest.approx((a_expected, c_expected), abs=1e-6)
    assert stands(frame, "SYM+", machine=narrow) is None


def test_shortest_rotation_is_selected_and_ties_are_resolved() -> None:
    frame = make_frame_from_points(*CHAMFERS[1])
    assert stands(frame, c=90.0) == about((45.0, 0.0, 0.0))  # a tie goes to the positive side
    assert stands(frame, c=91.0) == about((-45.0, 180.0, 180.0))
    assert stands(frame, a=-45.0) == about((45.0, 0.0, 0.0))
    assert stands(frame, a=45.0, c=95.0) == about((45.0, 0.0, 0.0))  # by the sum, not the longest


def test_solution_respects_axis_ranges() -> None:
    frame = make_frame_from_points(*CHAMFERS[1])
    up, down = limited(-10.0, 110.0), limited(-110.0, 10.0)
    assert stands(frame, "SYM+", machine=up) == about((45.0, 0.0, 0.0))
    assert stands(frame, "SYM-", machine=up) is None
    assert stands(frame, "SYM+", machine=down) is None
    assert stands(frame, "SYM-", machine=down) == about((-45.0, 180.0, 180.0))
    assert stands(frame, machine=down) == about((-45.0, 180.0, 180.0))
    assert stands(frame, "SYM+", machine=limited(0.0, 45.0)) == about((45.0, 0.0, 0.0))  # the end is inside


def test_rotation_about_tool_remains_in_solution() -> None:
    """Chamfer 2, then 20 degrees about its own Z."""
    frame = multiply_matrices(make_frame_from_points(*CHAMFERS[2]), make_rotation(Z_AXIS, 20.0))
    assert stands(frame, "SYM+") == about((45.0, 90.0, 20.0))
    assert stands(frame, "SYM-") == about((-45.0, 270.0, -160.0))


def test_free_axis_goes_to_zero_or_rotates_with_table_rot() -> None:
    frame = make_frame_from_spatial_angles(0.0, 0.0, 30.0)
    assert stands(frame) == about((0.0, 0.0, 30.0))
    assert stands(frame, table_rot=True) == about((0.0, 30.0, 0.0))
    assert stands(frame, "SYM-", table_rot=True) == about((0.0, 30.0, 0.0))
    tilted = make_frame_from_points(*CHAMFERS[2])  # C is not free at A45: nothing changes
    assert stands(tilted, "SYM+", table_rot=True) == stands(tilted, "SYM+")


def test_forward_of_inverse_kinematics_is_the_frame() -> None:
    """10 000 planes, some very near to the pole, against the closed formula of a right-angled A-C machine."""
    dice = random.Random(20)
    for count in range(10_000):
        tilt = dice.uniform(0.0, 179.0) if count % 5 else 10.0 ** dice.uniform(-12.0, -2.0)
        frame = multiply_matrices(
            make_rotation(Z_AXIS, dice.uniform(0.0, 360.0)),
            make_rotation(X_AXIS, tilt),
            make_rotation(Z_AXIS, dice.uniform(-180.0, 180.0)),
        )
        found = find_all_solutions(AC, frame)
        assert len(found) == (2 if tilt > 1e-9 else 1), tilt
        r = np.array(frame)
        a = math.degrees(math.atan2(math.hypot(r[0, 2], r[1, 2]), r[2, 2]))
        assert sorted(s.axis_angles["A"] for s in found) == pytest.approx([-a, a][-len(found) :], abs=1e-9)
        for solution in found:
            back = multiply_matrices(
                AC.compute_tool_frame(solution.axis_angles), make_rotation(Z_AXIS, solution.tool_rotation_deg)
            )
            assert np.abs(np.array(back) - r).max() < 1e-9
