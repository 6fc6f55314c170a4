"""Corrections by hand: sign, diameter and radius, dead band, half steps; and what is no wear."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from core.extras.quality.control_charts import QualityError
from core.extras.quality.measured_feature import (
    CorrectingOffset,
    CorrectionRule,
    FeatureKind,
    MeasuredFeature,
    check_feature,
    propose_correction,
)
from tests.coded import raises_code

IN = 25.4
TENTH = 0.0001 * IN
SPIGOT = MeasuredFeature(
    "SPIGOT", FeatureKind.DIAMETER, 0.5 * IN, -0.001 * IN, 0.001 * IN, CorrectingOffset.TOOL, 3
)
FULL = CorrectionRule(step_fraction=1.0)


def inches(*sizes: float) -> list[float]:
    return [IN * size for size in sizes]


def test_oversize_diameter_reduces_the_offset() -> None:
    """Ø .5012 → Ø .5000 is −.0012 of the diameter, −.0006 at the offset, whose X is a radius."""
    found = propose_correction(SPIGOT, inches(0.5012), TENTH, FULL)
    assert found.change_mm == pytest.approx(-0.0012 * IN)
    assert found.offset_change_mm == pytest.approx(-0.0006 * IN)
    assert found.expected_size_mm == pytest.approx(0.5 * IN)


def test_half_gain_applies_half_of_the_correction() -> None:
    found = propose_correction(SPIGOT, inches(0.5012), TENTH)
    assert found.change_mm == pytest.approx(-0.0006 * IN)
    assert found.expected_size_mm == pytest.approx(0.5006 * IN)


def test_undersize_bore_increases_the_offset() -> None:
    """The same sign inside as outside: the edge has to go outward."""
    assert propose_correction(SPIGOT, inches(0.4992), TENTH, FULL).change_mm == pytest.approx(0.0008 * IN)


def test_tool_at_negative_x_inverts_the_correction() -> None:
    found = propose_correction(replace(SPIGOT, grows=-1), inches(0.5012), TENTH, FULL)
    assert found.change_mm == pytest.approx(0.0012 * IN)
    assert found.expected_size_mm == pytest.approx(0.5 * IN)


def test_length_correction_is_not_halved() -> None:
    """A shoulder whose length shrinks as its tool goes to Z+: .020 too long wants +.020 of Z."""
    length = MeasuredFeature(
        "L", FeatureKind.LENGTH, 30.0, -0.05, 0.05, CorrectingOffset.SECONDARY, 2, grows=-1
    )
    found = propose_correction(length, [30.02], 0.001, FULL)
    assert [found.change_mm, found.offset_change_mm] == pytest.approx([0.02, 0.02])
    assert found.expected_size_mm == pytest.approx(30.0)


def test_correction_aims_at_the_middle_of_the_tolerance() -> None:
    """20 −.04/0: the middle is 19.98, so 20.00 is .02 too large."""
    shaft = MeasuredFeature("H", FeatureKind.DIAMETER, 20.0, -0.04, 0.0, CorrectingOffset.TOOL, 1)
    assert propose_correction(shaft, [20.0], 0.001, FULL).change_mm == pytest.approx(-0.02)


def test_only_the_newest_readings_are_averaged() -> None:
    """Of seven the last five: mean .5004."""
    sizes = inches(0.52 - 0.018, 0.502, 0.5002, 0.5003, 0.5004, 0.5005, 0.5006)
    found = propose_correction(SPIGOT, sizes, TENTH, FULL)
    assert found.reading_count == 5
    assert found.mean_size_mm == pytest.approx(0.5004 * IN)


def test_deviation_within_the_dead_band_is_not_corrected() -> None:
    """A tenth of .002 is .0002."""
    assert propose_correction(SPIGOT, inches(0.5002), TENTH, FULL).change_mm == 0.0
    assert "dead band" in propose_correction(SPIGOT, inches(0.5002), TENTH, FULL).reason
    assert propose_correction(SPIGOT, inches(0.5003), TENTH, FULL).change_mm == pytest.approx(-0.0003 * IN)


def test_correction_is_rounded_down_to_whole_offset_steps() -> None:
    """Half of .0005 is two and a half tenths: two."""
    assert propose_correction(SPIGOT, inches(0.5005), TENTH).change_mm == pytest.approx(-0.0002 * IN)
    coarse = propose_correction(SPIGOT, inches(0.5005), 0.01 * IN)
    assert coarse.change_mm == 0.0
    assert "smallest offset step" in coarse.reason


@pytest.mark.parametrize(
    ("readings", "code"),
    [
        ([], "no-readings"),
        ([math.nan], "not-a-number"),
        (inches(0.5061), "reading-too-far"),  # 6.1 thousandths off, three tolerances are 6
        (inches(0.5002, 0.4), "reading-too-far"),
    ],
)
def test_invalid_readings_give_no_proposal(readings: list[float], code: str) -> None:
    with raises_code(QualityError, code):
        propose_correction(SPIGOT, readings, TENTH)


def test_correction_beyond_the_wear_limit_is_rejected() -> None:
    wide = replace(SPIGOT, low=-0.2 * IN, high=0.2 * IN)
    with raises_code(QualityError, "correction-too-large"):
        propose_correction(wide, inches(0.75), TENTH, FULL)


@pytest.mark.parametrize(
    ("changes", "code"),
    [
        ({"name": " "}, "invalid-name"),
        ({"name": "X" * 25}, "invalid-name"),
        ({"nominal": 0.0}, "nominal"),
        ({"nominal": math.inf}, "not-a-number"),
        ({"low": 0.1, "high": 0.1}, "limits-reversed"),
        ({"low": -13.0}, "lower-limit"),
        ({"number": 33}, "offset-number"),
        ({"grows": 0}, "direction"),
        ({"every": -1}, "interval"),
        ({"sample": 11}, "sample-size"),
    ],
)
def test_invalid_feature_is_rejected(changes: dict[str, object], code: str) -> None:
    check_feature(SPIGOT)
    with raises_code(QualityError, code):
        check_feature(replace(SPIGOT, **changes))  # type: ignore[arg-type]


def test_size_on_the_limit_is_good() -> None:
    assert SPIGOT.good(0.501 * IN)
    assert not SPIGOT.good(0.5011 * IN)
    assert SPIGOT.corrected_by == "T3 X"
