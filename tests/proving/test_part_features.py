"""Diameters and shoulders of a profile, and which of two parts belong together."""

from __future__ import annotations

import pytest

from core.part.turned_part import PartedPiece, ProfilePoints
from core.proving.offset_comparison import FeatureKind, Pair, PartFeature, find_features, match_features

STEPPED: ProfilePoints = [(0.0, 10.0), (-20.0, 10.0), (-20.0, 15.0), (-40.0, 15.0)]


def piece(outside: ProfilePoints, bore: ProfilePoints | None = None) -> PartedPiece:
    return PartedPiece(0.0, outside, bore, None)


def test_a_stepped_shaft_has_two_diameters_between_three_shoulders() -> None:
    assert find_features(piece(STEPPED)) == [
        PartFeature(FeatureKind.SHOULDER, 0.0, (0.0, 10.0)),
        PartFeature(FeatureKind.DIAMETER, 20.0, (0.0, -20.0)),
        PartFeature(FeatureKind.SHOULDER, -20.0, (10.0, 15.0)),
        PartFeature(FeatureKind.DIAMETER, 30.0, (-20.0, -40.0)),
        PartFeature(FeatureKind.SHOULDER, -40.0, (0.0, 15.0)),
    ]


def test_bore_and_its_bottom_are_features() -> None:
    found = find_features(
        piece([(0.0, 10.0), (-20.0, 10.0)], [(0.0, 4.0), (-8.0, 4.0), (-8.0, 0.0), (-20.0, 0.0)])
    )
    assert found[3:] == [
        PartFeature(FeatureKind.BORE, 8.0, (0.0, -8.0)),
        PartFeature(FeatureKind.BORE_SHOULDER, -8.0, (0.0, 4.0)),
    ]


def test_cones_chamfers_and_short_cylinders_are_not_features() -> None:
    cone: ProfilePoints = [(0.0, 5.0), (-0.2, 5.0), (-10.0, 9.0), (-10.2, 9.0)]
    assert [each.kind for each in find_features(piece(cone))] == [FeatureKind.SHOULDER] * 2


def test_corner_fillet_is_not_part_of_shoulder() -> None:
    """The last of a fillet lies within the tolerance of the profile: the other end is the shoulder's."""
    filleted: ProfilePoints = [
        (0.0, 10.0),
        (-19.6, 10.0),
        (-19.9, 10.1),
        (-19.997, 10.4),
        (-20.0, 15.0),
        (-40.0, 15.0),
    ]
    assert [each.at for each in find_features(piece(filleted)) if each.kind is FeatureKind.SHOULDER][
        1
    ] == -20.0


def test_empty_piece_has_no_features() -> None:
    assert find_features(piece([])) == []


def test_features_match_when_all_have_moved() -> None:
    here = find_features(piece(STEPPED))
    there = find_features(piece([(z - 0.5, r + 0.25) for z, r in STEPPED]))
    assert [pair.difference_mm for pair in match_features(here, there)] == [
        pytest.approx(-0.5), pytest.approx(0.5), pytest.approx(-0.5), pytest.approx(0.5), pytest.approx(-0.5),
    ]  # fmt: skip


def test_feature_of_only_one_part_has_no_match() -> None:
    """Face and first diameter are in both; a shoulder from r 10 to 15 is not the back from the axis to 10."""
    here, there = find_features(piece(STEPPED)), find_features(piece([(0.0, 10.0), (-20.0, 10.0)]))
    pairs = match_features(here, there)
    assert pairs[:2] == [Pair(here[0], there[0]), Pair(here[1], there[1])]
    assert pairs[2:] == [Pair(each, None) for each in here[2:]] + [Pair(None, there[2])]
    assert {pair.difference_mm for pair in pairs[2:]} == {None}


def test_diameter_does_not_match_bore_or_shoulder() -> None:
    ring = PartFeature(FeatureKind.DIAMETER, 20.0, (0.0, -5.0))
    for kind in (FeatureKind.BORE, FeatureKind.SHOULDER):
        assert match_features([ring], [ring._replace(kind=kind)]) == [
            Pair(ring, None),
            Pair(None, ring._replace(kind=kind)),
        ]


def test_distant_feature_does_not_match() -> None:
    ring = PartFeature(FeatureKind.DIAMETER, 20.0, (0.0, -5.0))
    assert len(match_features([ring], [ring._replace(at=33.0)])) == 2  # 6.5 mm of radius
    assert len(match_features([ring], [ring._replace(at=32.0)])) == 1
