"""Mills on a part: what is left, against closed formulas within .1 %, and what is not met."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from core.part.milled_part import MilledPart
from core.part.polar_field import make_field_from_section
from core.part.ray_cuts import FloatArray
from core.part.tool_polygons import PartError
from tests.coded import raises_code

R, LENGTH = 10.0, 20.0
BAR = math.pi * R * R * LENGTH
THOUSANDTH = 1e-3
PER_CENT = 1e-2


def bar(radius: float = R, bore: float = 0.0, length: float = LENGTH) -> MilledPart:
    """A bar or tube from Z -``length`` to its face at Z0."""
    count = round(length / 0.01)
    low, high = np.full((1, count), bore), np.full((1, count), radius)
    return MilledPart(make_field_from_section(np.linspace(-length, 0.0, count + 1), low, high))


def path(*points: tuple[float, float, float]) -> FloatArray:
    return np.array(points)


def segment(radius: float, distance: float) -> float:
    """Area of a circle beyond a chord at ``distance`` from its centre."""
    return radius**2 * math.acos(distance / radius) - distance * math.sqrt(radius**2 - distance**2)


def integral(function: Callable[[FloatArray], FloatArray], least: float, most: float) -> float:
    """Gauss-Legendre by 400 points; the substitution takes roots at both ends out."""
    x, w = np.polynomial.legendre.leggauss(400)
    at = 0.5 * (least + most) + 0.5 * (most - least) * np.sin(0.5 * math.pi * x)
    slope = 0.25 * math.pi * (most - least) * np.cos(0.5 * math.pi * x)
    return float(np.sum(w * function(at) * slope))


def past(angle: float, apothem: float, tool: float, z: float) -> FloatArray:
    """An end mill past one side of a prism: its axis runs by ``tool`` beyond the side."""
    cos, sin = math.cos(math.radians(angle)), math.sin(math.radians(angle))
    off, far = apothem + tool, 15.0
    return path(
        (off * cos - far * sin, off * sin + far * cos, z), (off * cos + far * sin, off * sin - far * cos, z)
    )


def check(part: MilledPart, removed: float, told: float, *, share: float = PER_CENT) -> None:
    """What is left within .1 %, and what was removed within ``share`` of itself; the two belong together."""
    whole = part.field.volume_mm3 + told
    assert part.field.volume_mm3 == pytest.approx(whole - removed, rel=THOUSANDTH)
    assert told == pytest.approx(removed, rel=share)


# --- prisms and flats


@pytest.mark.parametrize(
    ("sides", "apothem", "area"),
    [(6, 8.0, 2.0 * math.sqrt(3.0) * 64.0), (4, 7.0, 196.0), (8, 9.0, 8.0 * 81.0 * math.tan(math.pi / 8.0))],
)
def test_prism_is_milled_at_end_of_bar(sides: int, apothem: float, area: float) -> None:
    part = bar()
    told = sum(
        part.mill_axial_path(past(360.0 / sides * k, apothem, 3.0, -6.0), 3.0).volume_mm3
        for k in range(sides)
    )
    check(part, (math.pi * R * R - area) * 6.0, told, share=THOUSANDTH)


def test_flat_is_milled_along_side_with_end_of_mill() -> None:
    part = bar()
    told = part.mill_radial_path(path((8.0, 10.0, 90.0), (8.0, -30.0, 90.0)), 6.5)
    check(part, segment(R, 8.0) * LENGTH, told.volume_mm3, share=THOUSANDTH)
    assert told.depth_mm == pytest.approx(2.0)
    assert part.field.outer_radii[0, 0, 180] == pytest.approx(8.0)  # ray 180 of 720 looks along the part's Y
    assert part.field.outer_radii[0, 0, 540] == pytest.approx(10.0)


def test_two_flats_are_milled_with_c_rotation_between() -> None:
    part = bar()
    told = sum(
        part.mill_radial_path(path((8.5, 10.0, c), (8.5, -5.0, c)), 7.0).volume_mm3 for c in (0.0, 180.0)
    )
    # The mill's round stands in the bar where it stops: its half circle at Z -5.
    half = math.sqrt(R * R - 8.5**2)
    ends = integral(lambda u: np.sqrt(49.0 - u * u) * (np.sqrt(R * R - u * u) - 8.5), -half, half)
    check(part, 2.0 * (segment(R, 8.5) * 5.0 + ends), told)


# --- holes


def test_cross_hole_through_bar_has_expected_volume() -> None:
    part = bar()
    told = part.mill_radial_path(path((12.0, -10.0, 37.0), (-12.0, -10.0, 37.0)), 3.0)
    hole = 8.0 * integral(lambda x: np.sqrt((R * R - x * x) * (9.0 - x * x)), 0.0, 3.0)
    check(part, hole, told.volume_mm3)


def test_cross_hole_through_tube_has_expected_volume() -> None:
    part = bar(bore=6.0)
    told = part.mill_radial_path(path((12.0, -10.0, 0.0), (-12.0, -10.0, 0.0)), 2.0)
    walls = 8.0 * integral(
        lambda x: (np.sqrt(R * R - x * x) - np.sqrt(36.0 - x * x)) * np.sqrt(4.0 - x * x), 0.0, 2.0
    )
    check(part, walls, told.volume_mm3)


def test_off_center_cross_hole_leaves_other_side_uncut() -> None:
    part = bar()
    told = part.mill_radial_path(path((12.0, -10.0, 0.0), (-12.0, -10.0, 0.0)), 2.0, axis_offset=5.0)
    hole = 4.0 * integral(lambda v: np.sqrt(R * R - (5.0 + v) ** 2) * np.sqrt(4.0 - v * v), -2.0, 2.0)
    check(part, hole, told.volume_mm3)
    assert part.field.outer_radii[0, :, 60].min() < 8.0  # towards growing angles: at 30°
    assert part.field.outer_radii[0, :, 660].min() == pytest.approx(R)


def test_blind_hole_on_side_has_drill_point() -> None:
    part = bar()
    told = part.mill_radial_path(path((12.0, -10.0, 200.0), (4.0, -10.0, 200.0)), 2.0, cone_height=1.2)
    above = integral(lambda u: 2.0 * np.sqrt(4.0 - u * u) * (np.sqrt(R * R - u * u) - 4.0), -2.0, 2.0)
    check(part, above - math.pi * 4.0 * 1.2 * 2.0 / 3.0, told.volume_mm3)


@pytest.mark.parametrize("point", [0.0, 1.2])
def test_off_center_face_hole_has_expected_volume(point: float) -> None:
    part = bar()
    told = part.mill_axial_path(path((5.0, -1.0, 2.0), (5.0, -1.0, -12.0)), 2.0, cone_height=point)
    check(part, math.pi * 4.0 * (12.0 - point * 2.0 / 3.0), told.volume_mm3, share=0.003)


def test_face_hole_on_axis_has_expected_volume() -> None:
    part = bar()
    told = part.mill_axial_path(path((0.5, 0.0, 2.0), (0.5, 0.0, -12.0)), 2.0)
    check(part, math.pi * 4.0 * 12.0, told.volume_mm3, share=THOUSANDTH)
    assert len(part.field.inner_radii) == 1  # what is left is a wall all round


# --- slots and pockets


def test_key_slot_has_round_ends() -> None:
    part = bar()
    told = part.mill_radial_path(path((12.0, -14.0, 45.0), (7.0, -14.0, 45.0), (7.0, -6.0, 45.0)), 2.0)
    slot = integral(lambda u: (np.sqrt(R * R - u * u) - 7.0) * (8.0 + 2.0 * np.sqrt(4.0 - u * u)), -2.0, 2.0)
    check(part, slot, told.volume_mm3)


def test_full_revolution_slot_is_a_groove() -> None:
    part = bar()
    told = part.mill_radial_path(path((8.0, -10.0, 0.0), (8.0, -10.0, 360.0)), 1.5)
    check(part, math.pi * (R * R - 64.0) * 3.0, told.volume_mm3)


def test_slot_over_sector_by_c_rotation_has_expected_volume() -> None:
    part = bar(radius=20.0)
    told = part.mill_radial_path(path((17.0, -10.0, 10.0), (17.0, -10.0, 100.0)), 1.0)
    # Unrolled at each r it is as wide as the mill, with round ends; (1/17)² is left out.
    r = 0.5 * (400.0 - 289.0)
    check(part, 2.0 * math.radians(90.0) * r + math.pi * 3.0, told.volume_mm3)


def test_helical_slot_has_expected_volume() -> None:
    part = bar(radius=20.0)
    told = part.mill_radial_path(path((17.0, -16.0, 0.0), (17.0, -4.0, 120.0)), 1.0)
    turn = math.radians(120.0)
    check(part, integral(lambda r: 2.0 * np.hypot(r * turn, 12.0) + math.pi, 17.0, 20.0), told.volume_mm3)


def test_slot_across_face_has_expected_volume() -> None:
    part = bar()
    told = part.mill_axial_path(path((0.0, -15.0, -4.0), (0.0, 15.0, -4.0)), 2.5)
    check(
        part, 4.0 * integral(lambda u: 2.0 * np.sqrt(R * R - u * u), -2.5, 2.5), told.volume_mm3, share=0.002
    )


def test_off_center_round_pocket_in_face_has_expected_volume() -> None:
    part = bar()
    turn = np.linspace(0.0, 2.0 * math.pi, 361)
    circle = np.column_stack([4.0 + 1.5 * np.cos(turn), 1.0 + 1.5 * np.sin(turn), np.full(361, -3.0)])
    told = part.mill_axial_path(np.vstack([path((5.5, 1.0, 1.0)), circle]), 2.0)
    check(part, math.pi * 3.5**2 * 3.0, told.volume_mm3, share=0.003)
    assert told.back_z_mm == pytest.approx(-3.0)


def test_ramped_slot_is_as_deep_as_end_of_mill() -> None:
    part = bar()
    told = part.mill_axial_path(path((-4.0, 3.0, 0.0), (4.0, 3.0, -4.0)), 2.0)
    # Each spot is as deep as the mill's rear edge leaves it: half a millimetre a millimetre along X.
    x, u = np.meshgrid(np.linspace(-6.0, 6.0, 2401), np.linspace(-2.0, 2.0, 801))
    last = np.minimum(x + np.sqrt(4.0 - u * u), 4.0)
    covered = (np.hypot(np.maximum(np.abs(x) - 4.0, 0.0), u) < 2.0) & (last > -4.0)
    depth = np.where(covered, 0.5 * (last + 4.0), 0.0)
    check(part, float(depth.sum()) * 0.005 * 0.005, told.volume_mm3)


def test_end_mill_cuts_only_along_its_flute_length() -> None:
    part = bar()
    told = part.mill_axial_path(path((15.0, 0.0, -6.0), (9.0, 0.0, -6.0)), 2.0, cutting_length=3.0)
    other = bar()
    deep = other.mill_axial_path(path((15.0, 0.0, -6.0), (9.0, 0.0, -6.0)), 2.0)
    assert deep.volume_mm3 == pytest.approx(2.0 * told.volume_mm3, rel=1e-6)
    assert (told.back_z_mm, told.front_z_mm) == pytest.approx((-6.0, -3.0))


# --- one after the other


def test_hexagon_is_turned_after_milling() -> None:
    part = bar()
    for k in range(6):
        part.mill_axial_path(past(60.0 * k, 8.0, 3.0, -30.0), 3.0)
    count = len(part.field.column_centers)
    part.remove_turned_material(0, np.full(count, 8.5), np.full(count, math.inf))
    area = math.pi * 8.5**2 - 6.0 * segment(8.5, 8.0)
    assert part.field.volume_mm3 == pytest.approx(area * LENGTH, rel=THOUSANDTH)


def test_bore_is_turned_through_cross_hole() -> None:
    part = bar()
    part.mill_radial_path(path((12.0, -10.0, 0.0), (-12.0, -10.0, 0.0)), 2.0)
    count = len(part.field.column_centers)
    part.remove_turned_material(0, np.zeros(count), np.full(count, 6.0))
    walls = 8.0 * integral(
        lambda x: (np.sqrt(R * R - x * x) - np.sqrt(36.0 - x * x)) * np.sqrt(4.0 - x * x), 0.0, 2.0
    )
    left = math.pi * (R * R - 36.0) * LENGTH - walls
    assert part.field.volume_mm3 == pytest.approx(left, rel=THOUSANDTH)


def test_two_holes_across_one_ray_leave_three_layers() -> None:
    part = bar()
    for x in (3.0, 7.0):
        part.mill_axial_path(path((x, 0.0, -5.0)), 1.0)
    field = part.field
    assert field.inner_radii[:, -1, 0] == pytest.approx([0.0, 4.0, 8.0])
    assert field.outer_radii[:, -1, 0] == pytest.approx([2.0, 6.0, 10.0])
    part.mill_axial_path(path((5.0, 0.0, -5.0)), 1.5)
    there = field.outer_radii[:, -1, 0] > field.inner_radii[:, -1, 0]
    assert field.inner_radii[there, -1, 0] == pytest.approx([0.0, 8.0])
    assert field.outer_radii[there, -1, 0] == pytest.approx([2.0, 10.0])


def test_repeated_cut_removes_nothing() -> None:
    part = bar()
    way = path((7.0, -14.0, 45.0), (7.0, -6.0, 45.0))
    assert part.mill_radial_path(way, 2.0)
    assert not part.mill_radial_path(way, 2.0)
    assert not part.has_radial_collision(way, 2.0)


# --- what is met and what is not


@pytest.mark.parametrize(
    ("x", "z", "met"),
    [(14.0, -5.0, False), (11.999, -5.0, False), (11.99, -5.0, True), (5.0, 0.0, False), (5.0, -0.01, True)],
)
def test_rapid_of_axial_mill_collides_with_bar(x: float, z: float, met: bool) -> None:
    part = bar()
    assert part.has_axial_collision(path((14.0, 0.0, z), (x, 0.0, z)) if z else path((x, 0.0, z)), 2.0) is met
    assert part.field.volume_mm3 == pytest.approx(BAR, rel=1e-4)


@pytest.mark.parametrize(
    ("r", "z", "met"),
    [(10.0, -5.0, False), (9.99, -5.0, True), (5.0, 2.001, False), (5.0, 1.99, True), (5.0, -22.0, False)],
)
def test_rapid_of_radial_mill_collides_with_bar(r: float, z: float, met: bool) -> None:
    part = bar()
    assert part.has_radial_collision(path((r, z, 10.0), (r, z, 70.0)), 2.0) is met
    assert part.field.volume_mm3 == pytest.approx(BAR, rel=1e-4)


def test_mill_clear_of_bar_removes_nothing() -> None:
    part = bar()
    assert not part.mill_axial_path(path((0.0, 0.0, 1.0), (5.0, 0.0, 0.0)), 3.0)
    assert not part.mill_radial_path(path((11.0, -5.0, 0.0), (10.0, -5.0, 300.0)), 3.0)
    assert part.field.change_count == 0


@pytest.mark.parametrize("wrong", [np.zeros((3, 2)), np.zeros(3), np.zeros((0, 3))])
def test_path_without_three_coordinates_is_rejected(wrong: FloatArray) -> None:
    with raises_code(PartError, "points-not-xyz"):
        bar().mill_axial_path(wrong, 1.0)
    with raises_code(PartError, "points-not-xyz"):
        bar().mill_radial_path(wrong, 1.0)
