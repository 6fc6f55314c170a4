"""Moves of a virtual mill and with C locked, brought to the part: signs by hand, chords by their error."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from core.geometry.virtual_mill import FacePlane, PlaneMove, SidePlane
from core.part.milled_part import MilledPart
from core.part.polar_field import make_field_from_section
from core.part.ray_cuts import (
    MAX_CHORD_ERROR_MM,
    make_axial_path,
    make_c_axis_path,
    make_plane_path,
    make_radial_path,
)


def bar() -> MilledPart:
    low, high = np.zeros((1, 2000)), np.full((1, 2000), 10.0)
    return MilledPart(make_field_from_section(np.linspace(-20.0, 0.0, 2001), low, high))


@pytest.mark.parametrize(
    ("c", "x", "y"), [(0.0, 7.0, 0.0), (90.0, 0.0, -7.0), (-90.0, 0.0, 7.0), (180.0, -7.0, 0.0)]
)
def test_tool_at_x_minus_is_at_negative_c_angle_on_part(c: float, x: float, y: float) -> None:
    """C turns the part from X towards Y; what comes under a tool that stands still goes the other way."""
    assert make_axial_path(np.array([[-7.0, -1.0, c]]))[0] == pytest.approx([x, y, -1.0])
    r, z, angle = make_radial_path(np.array([[-7.0, -1.0, c]]))[0]
    assert (r, z) == (7.0, -1.0)
    assert (r * math.cos(math.radians(angle)), r * math.sin(math.radians(angle))) == pytest.approx((x, y))


def test_tool_at_x_plus_is_on_opposite_side() -> None:
    assert make_axial_path(np.array([[7.0, 0.0, 90.0]]))[0] == pytest.approx([0.0, 7.0, 0.0])
    assert make_radial_path(np.array([[7.0, 0.0, 90.0]]), is_far_side=True)[0] == pytest.approx(
        [7.0, 0.0, 90.0]
    )


def test_tool_above_center_is_toward_y() -> None:
    assert make_axial_path(np.array([[-4.0, 0.0, 0.0]]), height=3.0)[0] == pytest.approx([4.0, 3.0, 0.0])
    assert make_axial_path(np.array([[-4.0, 0.0, 90.0]]), height=3.0)[0] == pytest.approx([3.0, -4.0, 0.0])


def test_face_line_is_rotated_by_c_at_plane_entry() -> None:
    move = PlaneMove(FacePlane(90.0), (5.0, 0.0, -1.0), (5.0, 3.0, -1.0))
    way = make_plane_path(move, z_offset=0.5)
    assert way == pytest.approx(np.array([[0.0, -5.0, -0.5], [3.0, -5.0, -0.5]]))


@pytest.mark.parametrize("h", [0.0, 0.75, -2.0])
@pytest.mark.parametrize("c0", [0.0, 30.0])
def test_face_path_matches_machine_positions(c0: float, h: float) -> None:
    move = PlaneMove(
        FacePlane(c0, h), (8.0, -3.0, 0.0), (5.0, 6.0, -2.0), start_angle_rad=math.atan2(-3.0, 8.0)
    )
    share = np.linspace(0.0, 1.0, 2)
    assert make_plane_path(move) == pytest.approx(make_axial_path(move.compute_machine_positions(share), h))


def test_face_line_closer_to_axis_than_tool_height_goes_around_it() -> None:
    move = PlaneMove(
        FacePlane(0.0, 1.0), (8.0, 0.5, 0.0), (-8.0, 0.5, 0.0), start_angle_rad=math.atan2(0.5, 8.0)
    )
    way = make_plane_path(move)
    assert len(way) > 100
    assert np.hypot(way[:, 0], way[:, 1]).min() == pytest.approx(1.0)


@pytest.mark.parametrize("radius", [0.05, 1.0, 12.7, 200.0])
def test_arc_chords_are_within_chord_error(radius: float) -> None:
    move = PlaneMove(FacePlane(0.0), (radius, 0.0, 0.0), (-radius, 0.0, 0.0), center=(0.0, 0.0))
    way = make_plane_path(move)
    middle = 0.5 * (way[1:] + way[:-1])
    assert radius - np.hypot(middle[:, 0], middle[:, 1]).min() <= MAX_CHORD_ERROR_MM * 1.0001
    assert np.hypot(way[:, 0], way[:, 1]) == pytest.approx(np.full(len(way), radius))


def test_side_is_unrolled_at_its_diameter() -> None:
    """A quarter of the round, towards the spindle: Y grows with the polar angle, X towards the spindle."""
    quarter = math.pi * 20.0 / 4.0
    move = PlaneMove(SidePlane(10.0, -2.0, 20.0), (0.0, 0.0, 9.0), (5.0, quarter, 8.0))
    assert make_plane_path(move, z_offset=1.0) == pytest.approx(
        np.array([[9.0, -1.0, -10.0], [8.0, -6.0, 80.0]])
    )


def test_full_revolution_off_center_cuts_a_ring() -> None:
    part = bar()
    way = make_c_axis_path(np.array([-6.0, -2.0, 0.0]), np.array([-6.0, -2.0, 360.0]))
    told = part.mill_axial_path(make_axial_path(way), 1.0)
    assert told.volume_mm3 == pytest.approx(math.pi * (49.0 - 25.0) * 2.0, rel=1e-3)
    assert part.field.volume_mm3 == pytest.approx(math.pi * (2000.0 - 48.0), rel=1e-3)


def test_chords_of_move_with_c_are_within_chord_error() -> None:
    way = make_axial_path(make_c_axis_path(np.array([-10.0, 0.0, 0.0]), np.array([-10.0, 0.0, 200.0])))
    middle = 0.5 * (way[1:] + way[:-1])
    assert 10.0 - np.hypot(middle[:, 0], middle[:, 1]).min() <= MAX_CHORD_ERROR_MM
    assert len(make_c_axis_path(np.array([-10.0, 0.0, 5.0]), np.array([-3.0, 0.0, 5.0]))) == 2


def test_hexagon_in_face_plane_has_programmed_orientation() -> None:
    """Across flats 16 with a mill of 6: the first flat looks along the part's -Y, as C stood at 90."""
    part = bar()
    corner = 11.0 / math.cos(math.pi / 6.0)
    spots = [
        (corner * math.cos(a), corner * math.sin(a), -5.0) for a in np.radians(np.arange(30.0, 420.0, 60.0))
    ]
    for start, end in itertools.pairwise(spots):
        move = PlaneMove(FacePlane(90.0), start, end, start_angle_rad=math.atan2(start[1], start[0]))
        part.mill_axial_path(make_plane_path(move), 3.0)
    left = math.pi * 100.0 * 15.0 + 2.0 * math.sqrt(3.0) * 64.0 * 5.0
    assert part.field.volume_mm3 == pytest.approx(left, rel=1e-3)
    assert part.field.outer_radii[0, -1, 540] == pytest.approx(8.0)
    assert part.field.outer_radii[0, -1, 0] > 9.0
