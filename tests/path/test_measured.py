"""What lies between two points: X as diameter and as radius, in the program's unit."""

from __future__ import annotations

from app.path.measuring import (
    SnapPoint,
    SnapPointKind,
    describe_snap_point_kind,
    make_face_distance_rows,
    make_face_position_rows,
    make_path_distance_rows,
    make_path_position_rows,
    make_side_distance_rows,
    make_side_position_rows,
)


def test_distance_of_3_4_5_triangle_in_inch() -> None:
    rows = dict(make_path_distance_rows(SnapPoint(0, 25.4), SnapPoint(-4 * 25.4, 4 * 25.4), is_metric=False))
    assert rows == {
        "ΔX Ø": "6.00000",
        "ΔX R": "3.00000",
        "ΔZ": "−4.00000",
        "DISTANCE": "5.00000",
        "ANGLE TO Z": "36.87°",
    }


def test_distance_in_metric_has_four_places() -> None:
    rows = dict(make_path_distance_rows(SnapPoint(0, 1), SnapPoint(-4, 4), is_metric=True))
    assert (rows["ΔX Ø"], rows["ΔZ"], rows["DISTANCE"]) == ("6.0000", "−4.0000", "5.0000")


def test_angle_to_z_is_same_in_every_direction() -> None:
    for end in (SnapPoint(1, 1), SnapPoint(-1, 1), SnapPoint(1, -1), SnapPoint(-1, -1)):
        assert dict(make_path_distance_rows(SnapPoint(0, 0), end, is_metric=True))["ANGLE TO Z"] == "45.00°"
    assert (
        dict(make_path_distance_rows(SnapPoint(0, 0), SnapPoint(0, 3), is_metric=True))["ANGLE TO Z"]
        == "90.00°"
    )


def test_distance_from_point_to_itself_is_zero() -> None:
    rows = dict(make_path_distance_rows(SnapPoint(2, 3), SnapPoint(2, 3), is_metric=True))
    assert set(rows.values()) == {"0.0000", "0.00°"}


def test_on_the_face_y_is_up() -> None:
    rows = dict(make_face_distance_rows(SnapPoint(1, 1), SnapPoint(4, -3), is_metric=True))
    assert (rows["ΔX"], rows["ΔY"], rows["DISTANCE"]) == ("3.0000", "4.0000", "5.0000")
    assert dict(make_face_position_rows(SnapPoint(3, -4), is_metric=True)) == {
        "X": "3.0000",
        "Y": "4.0000",
        "R": "5.0000",
    }


def test_measurement_on_side_shows_c_angle_with_its_sign() -> None:
    rows = dict(
        make_side_distance_rows(SnapPoint(0, 0), SnapPoint(-3, -4), is_metric=True, mm_per_degree=0.1)
    )
    assert (rows["ΔZ"], rows["ΔC"], rows["ARC LENGTH"]) == ("−3.0000", "40.00°", "4.0000")
    assert dict(make_side_position_rows(SnapPoint(-3, -4), is_metric=True, mm_per_degree=0.1)) == {
        "Z": "−3.0000",
        "C": "40.00°",
    }


def test_point_on_path_has_its_diameter() -> None:
    assert dict(make_path_position_rows(SnapPoint(-25.4, 12.7), is_metric=False)) == {
        "X Ø": "1.00000",
        "Z": "−1.00000",
    }


def test_every_point_kind_has_its_own_name() -> None:
    assert len({describe_snap_point_kind(kind) for kind in SnapPointKind}) == len(SnapPointKind)
