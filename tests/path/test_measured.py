"""What lies between two points: X as diameter and as radius, in the program's unit."""

from __future__ import annotations

from app.path.measuring import (
    PointKind,
    SnapPoint,
    describe_point_kind,
    locate_on_face,
    locate_on_path,
    locate_on_side,
    measure_on_face,
    measure_on_path,
    measure_on_side,
)


def test_three_four_five_in_inch() -> None:
    rows = dict(measure_on_path(SnapPoint(0, 25.4), SnapPoint(-4 * 25.4, 4 * 25.4), is_metric=False))
    assert rows == {
        "ΔX Ø": "6.00000",
        "ΔX R": "3.00000",
        "ΔZ": "−4.00000",
        "DISTANCE": "5.00000",
        "ANGLE TO Z": "36.87°",
    }


def test_the_same_in_metric_has_four_places() -> None:
    rows = dict(measure_on_path(SnapPoint(0, 1), SnapPoint(-4, 4), is_metric=True))
    assert (rows["ΔX Ø"], rows["ΔZ"], rows["DISTANCE"]) == ("6.0000", "−4.0000", "5.0000")


def test_the_angle_is_that_to_the_axis_whichever_way() -> None:
    for end in (SnapPoint(1, 1), SnapPoint(-1, 1), SnapPoint(1, -1), SnapPoint(-1, -1)):
        assert dict(measure_on_path(SnapPoint(0, 0), end, is_metric=True))["ANGLE TO Z"] == "45.00°"
    assert dict(measure_on_path(SnapPoint(0, 0), SnapPoint(0, 3), is_metric=True))["ANGLE TO Z"] == "90.00°"


def test_nothing_between_one_point_and_itself() -> None:
    rows = dict(measure_on_path(SnapPoint(2, 3), SnapPoint(2, 3), is_metric=True))
    assert set(rows.values()) == {"0.0000", "0.00°"}


def test_on_the_face_y_is_up() -> None:
    rows = dict(measure_on_face(SnapPoint(1, 1), SnapPoint(4, -3), is_metric=True))
    assert (rows["ΔX"], rows["ΔY"], rows["DISTANCE"]) == ("3.0000", "4.0000", "5.0000")
    assert dict(locate_on_face(SnapPoint(3, -4), is_metric=True)) == {
        "X": "3.0000",
        "Y": "4.0000",
        "R": "5.0000",
    }


def test_on_the_side_degrees_are_told_with_the_way_round() -> None:
    rows = dict(measure_on_side(SnapPoint(0, 0), SnapPoint(-3, -4), is_metric=True, mm_per_degree=0.1))
    assert (rows["ΔZ"], rows["ΔC"], rows["ARC LENGTH"]) == ("−3.0000", "40.00°", "4.0000")
    assert dict(locate_on_side(SnapPoint(-3, -4), is_metric=True, mm_per_degree=0.1)) == {
        "Z": "−3.0000",
        "C": "40.00°",
    }


def test_a_place_on_the_path_tells_its_diameter() -> None:
    assert dict(locate_on_path(SnapPoint(-25.4, 12.7), is_metric=False)) == {
        "X Ø": "1.00000",
        "Z": "−1.00000",
    }


def test_every_kind_has_a_word() -> None:
    assert len({describe_point_kind(kind) for kind in PointKind}) == len(PointKind)
