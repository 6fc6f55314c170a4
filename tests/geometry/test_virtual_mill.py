"""The virtual mill on face and side: figures by hand, and the way back from the lathe's axes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.virtual_mill import FacePlane, PlaneMove, SidePlane

ENDS = np.array([0.0, 1.0])
MANY = np.linspace(0.0, 1.0, 2001)

size = st.floats(-50.0, 50.0, allow_nan=False)
angle = st.floats(-720.0, 720.0)


def at(move: PlaneMove, share: float) -> list[float]:
    """Lathe X, Z, C at a fraction of the way."""
    row: list[float] = move.compute_machine_positions(np.array([share]))[0].tolist()
    return row


def test_face_point_above_center_is_reached_by_negative_c_rotation() -> None:
    """Seen by the tool C+ is counter-clockwise; what is up has to turn clockwise to come to the right."""
    move = PlaneMove(FacePlane(c_start_deg=10.0), (3.0, 0.0, -1.0), (0.0, 4.0, -2.0))
    assert at(move, 0.0) == pytest.approx([-3.0, -1.0, 10.0])
    assert at(move, 1.0) == pytest.approx([-4.0, -2.0, 10.0 - 90.0])


def test_tool_above_the_axis_retains_its_entry_height() -> None:
    """H 3 and X 4: rho 5, machine x -4, and C where it was; (0, 5) is 53.13 degrees further round."""
    theta = math.atan2(3.0, 4.0)
    move = PlaneMove(FacePlane(c_start_deg=0.0, tool_height_mm=3.0), (4.0, 3.0, 0.0), (0.0, 5.0, 0.0), theta)
    assert at(move, 0.0) == pytest.approx([-4.0, 0.0, 0.0])
    assert at(move, 1.0) == pytest.approx([-4.0, 0.0, -math.degrees(math.pi / 2 - theta)])


def test_side_plane_is_unrolled_at_its_diameter() -> None:
    """Half the circumference up is 180 degrees back; right is towards the spindle; Z counts outwards."""
    move = PlaneMove(
        SidePlane(c_start_deg=5.0, z_start_mm=-2.0, diameter_mm=20.0),
        (0.0, 0.0, 12.0),
        (7.0, math.pi * 10.0, 9.0),
    )
    assert at(move, 0.0) == pytest.approx([-12.0, -2.0, 5.0])
    assert at(move, 1.0) == pytest.approx([-9.0, -9.0, 5.0 - 180.0])


def test_clockwise_arc_is_clockwise_with_y_up() -> None:
    quarter = PlaneMove(FacePlane(0.0), (-2.0, 0.0, 0.0), (0.0, 2.0, 0.0), center=(0.0, 0.0), clockwise=True)
    assert quarter.compute_mill_points(np.array([0.5]))[0].tolist() == pytest.approx(
        [-math.sqrt(2), math.sqrt(2), 0.0]
    )
    assert quarter.length == pytest.approx(math.pi)
    other = PlaneMove(FacePlane(0.0), (-2.0, 0.0, 0.0), (0.0, 2.0, 0.0), center=(0.0, 0.0))
    assert other.length == pytest.approx(3.0 * math.pi)


def test_arc_that_ends_at_its_start_is_a_full_circle() -> None:
    move = PlaneMove(FacePlane(0.0), (5.0, 0.0, 0.0), (5.0, 0.0, 0.0), center=(2.0, 0.0))
    assert move.length == pytest.approx(6.0 * math.pi)
    # round the axis C turns once; beside it C comes back
    assert at(move, 1.0)[2] == pytest.approx(-360.0)
    beside = PlaneMove(FacePlane(0.0), (5.0, 0.0, 0.0), (5.0, 0.0, 0.0), center=(8.0, 0.0))
    assert at(beside, 1.0)[2] == pytest.approx(0.0, abs=1e-9)


def test_rounded_center_is_adjusted_so_the_arc_meets_its_end() -> None:
    move = PlaneMove(SidePlane(0.0, 0.0, 20.0), (0.0, 0.0, 1.0), (3.0, 3.0, 1.0), center=(3.0, 0.01))
    assert move.compute_mill_points(ENDS)[1].tolist() == pytest.approx([3.0, 3.0, 1.0])


def test_minimum_distance_from_the_axis_is_found() -> None:
    line = PlaneMove(FacePlane(0.0), (8.0, -6.0, 0.0), (8.0, 2.0, 0.0))
    assert line.get_fastest_rotation_fraction() == pytest.approx(0.75)
    assert line.compute_distance_from_axis(line.get_fastest_rotation_fraction()) == pytest.approx(8.0)
    behind = PlaneMove(FacePlane(0.0), (8.0, 1.0, 0.0), (8.0, 2.0, 0.0))
    assert behind.get_fastest_rotation_fraction() == 0.0
    arc = PlaneMove(FacePlane(0.0), (5.0, -3.0, 0.0), (5.0, 3.0, 0.0), center=(5.0, 0.0), clockwise=True)
    assert arc.compute_distance_from_axis(arc.get_fastest_rotation_fraction()) == pytest.approx(2.0)
    away = PlaneMove(FacePlane(0.0), (5.0, -3.0, 0.0), (5.0, 3.0, 0.0), center=(5.0, 0.0))
    assert away.compute_distance_from_axis(away.get_fastest_rotation_fraction()) == pytest.approx(
        math.hypot(5.0, 3.0)
    )


def test_travel_range_of_a_chord_includes_its_nearest_point() -> None:
    low, high = PlaneMove(FacePlane(0.0), (8.0, -6.0, 1.0), (8.0, 6.0, -1.0)).find_travel_range()
    assert low.tolist() == pytest.approx([-10.0, -1.0, -2 * math.degrees(math.atan2(6.0, 8.0))])
    assert high.tolist() == pytest.approx([-8.0, 1.0, 0.0])


@settings(max_examples=150, deadline=None)
@given(size, size, size, angle, st.floats(-3.0, 3.0))
def test_face_plane_conversion_is_reversible(x: float, y: float, z: float, c0: float, h: float) -> None:
    face, rho = FacePlane(c0, h), math.hypot(x, y)
    if rho < abs(h) + 0.01:
        return
    point = np.array([[x, y, z]])
    back = face.convert_to_mill(face.convert_to_lathe(point, np.array([math.atan2(y, x)])))
    assert back[0].tolist() == pytest.approx([x, y, z], abs=1e-9)


@settings(max_examples=100, deadline=None)
@given(size, size, size, angle, st.floats(0.5, 100.0))
def test_side_plane_conversion_is_reversible(
    x: float, y: float, z: float, c0: float, diameter: float
) -> None:
    side = SidePlane(c0, 3.0, diameter)
    back = side.convert_to_mill(side.convert_to_lathe(np.array([[x, y, z]])))
    assert back[0].tolist() == pytest.approx([x, y, z], abs=1e-9)


@settings(max_examples=150, deadline=None)
@given(size, size, size, size, st.booleans(), st.booleans())
def test_c_is_continuous_along_a_move(
    x: float, y: float, i: float, j: float, round_: bool, clockwise: bool
) -> None:
    """No two of 2001 points lie further apart in C than their distance and their nearness to the axis say."""
    start = (x, y, 0.0)
    move = PlaneMove(FacePlane(0.0), start, (i, j, 0.0), math.atan2(y, x))
    if round_:
        move = PlaneMove(FacePlane(0.0), start, start, math.atan2(y, x), (i, j), clockwise)
    if move.length < 1.0 or move.compute_distance_from_axis(move.get_fastest_rotation_fraction()) < 0.05:
        return
    points, machine = move.compute_mill_points(MANY), move.compute_machine_positions(MANY)
    step = move.length / (len(MANY) - 1)
    nearest = np.minimum(np.hypot(points[:-1, 0], points[:-1, 1]), np.hypot(points[1:, 0], points[1:, 1]))
    most = 2.0 * np.degrees(np.arcsin(np.minimum(step / np.maximum(nearest, step), 1.0)))
    assert (np.abs(np.diff(machine[:, 2])) <= most + 1e-6).all()
    assert move.frame.convert_to_mill(machine) == pytest.approx(points, abs=1e-8)
