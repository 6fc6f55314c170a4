"""Response of the spindle, against a lag of first order and a sine, whose figures are known."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from app.compose.machine.machine_files import load_machine
from app.extras.analyses.analyses import AnalysesModel, analyze_record
from app.extras.analyses.analysis_result import AnalysisKind
from app.extras.analyses.drawing import scale_drawing
from app.extras.analyses.spindle_response import SpindleResponse, find_last_speed_change
from core.records.record import AnalysisError, FloatArray, ScopeRecord
from tests.coded import raises_code
from tests.scope.played_record import record_of, seconds
from tests.texts import text

MODEL = load_machine(None).spindle  # at speed within 5 %
TAU = 0.2  # s


def turned(*changes: tuple[float, float], swing: float = 0.0) -> ScopeRecord:
    """Speeds asked for at instants; the spindle follows by a lag of first order, and swings at 10 Hz."""
    times = seconds(0.0, 12.0)
    asked, speed = np.zeros_like(times), np.zeros_like(times)
    for at, target in changes:
        on = times >= at
        here = float(speed[on][0])
        asked[on] = target
        speed[on] = target + (here - target) * np.exp(-(times[on] - at) / TAU)
    speed = speed + swing * np.sin(2.0 * np.pi * 10.0 * times) * (asked != 0.0)
    return record_of(times, spindle_command=asked, spindle_speed=speed)


def found(record: ScopeRecord) -> SpindleResponse:
    return find_last_speed_change(record, MODEL)


def test_first_order_lag_matches_the_formula() -> None:
    response = found(turned((1.0, 1000.0)))
    assert MODEL.at_speed_tolerance == pytest.approx(0.05)
    step = response.step_responses[0]
    assert step.step_size_mm == 1000.0
    assert step.rise_time_s == pytest.approx(TAU * math.log(9.0), abs=0.002)
    assert response.acceleration_rpm_s == pytest.approx(0.8 * 1000.0 / (TAU * math.log(9.0)), rel=0.01)
    assert step.overshoot_fraction == 0.0
    within = [TAU * math.log(1.0 / share) for share in (0.05, 0.02, 0.01)]
    assert [each.settling_time_s for each in response.step_responses] == pytest.approx(within, abs=0.002)


def test_speed_variation_is_measured() -> None:
    response = found(turned((1.0, 1000.0), swing=4.0))
    assert response.speed_variation_rpm == pytest.approx(8.0, abs=0.4)
    assert response.mean_speed_error_rpm == pytest.approx(0.0, abs=0.2)


def test_speed_swing_wider_than_the_band_never_settles() -> None:
    settling = [each.settling_time_s for each in found(turned((1.0, 1000.0), swing=15.0)).step_responses]
    assert math.isfinite(settling[1])  # 20 rpm
    assert math.isnan(settling[2])  # 10 rpm


def test_last_acceleration_of_several_is_used_and_stops_are_ignored() -> None:
    response = found(turned((1.0, 1000.0), (4.0, 2000.0), (8.0, 0.0)))
    assert (response.commanded_rpm[0], response.commanded_rpm[-1]) == (1000.0, 2000.0)
    assert response.step_responses[0].step_size_mm == 1000.0


def test_change_within_a_fixed_band_does_not_hide_the_run_up_before_it() -> None:
    """With a band of 1 %, 30 rpm exceed twice the band, 20.6 rpm, but not twice the band of 2 %, 41.2 rpm."""
    record = turned((1.0, 1000.0), (5.0, 1030.0))
    response = find_last_speed_change(record, replace(MODEL, at_speed_tolerance=0.01))
    assert [step.step_size_mm for step in response.step_responses] == [1000.0] * 3
    record = turned((1.0, 1000.0), (5.0, 1060.0))  # more than 4 %
    response = find_last_speed_change(record, replace(MODEL, at_speed_tolerance=0.01))
    assert [step.step_size_mm for step in response.step_responses] == [60.0] * 3


def test_reverse_speed_is_also_analyzed() -> None:
    response = found(turned((1.0, -500.0)))
    assert response.step_responses[0].step_size_mm == -500.0
    assert response.step_responses[0].rise_time_s == pytest.approx(TAU * math.log(9.0), abs=0.002)


@pytest.mark.parametrize(
    "record",
    [turned(), turned((0.0, 800.0)), turned((0.0, 800.0), (5.0, 0.0)), turned((0.0, 800.0), (5.0, 830.0))],
    ids=["stood", "even", "stopped", "within the window"],
)
def test_record_without_an_acceleration_raises_no_step(record: ScopeRecord) -> None:
    with raises_code(AnalysisError, "no-step"):
        found(record)


def test_missing_spindle_speed_is_reported() -> None:
    nothing: FloatArray = np.full(12001, np.nan)
    with raises_code(AnalysisError, "no-measured-speed"):
        found(record_of(seconds(0.0, 12.0), spindle_speed=nothing))
    assert (
        "no spindle"
        in analyze_record(AnalysisKind.SPINDLE_RESPONSE, turned((1.0, 500.0)), 0, {}).unavailable_reason
    )


def test_spindle_response_has_a_table_and_a_drawing() -> None:
    page = AnalysesModel(
        SimpleNamespace(metric=False),  # type: ignore[arg-type]
        spindle=MODEL,
        analysis_kind=AnalysisKind.SPINDLE_RESPONSE,
    )
    page.result = analyze_record(AnalysisKind.SPINDLE_RESPONSE, turned((1.0, 1000.0)), 0, {}, MODEL)
    rows = {row.cells[0]: row.cells[1] for row in page.make_table().rows}
    assert rows["SPEED"] == "0 → 1000 rpm"
    assert rows[text("scope.settled-after", share="5 %")] == "0.600 s"
    drawing = scale_drawing(page.make_drawing(), 1.0 / 25.4)
    assert drawing.upper_curves[0][:, 1].max() == pytest.approx(1000.0, abs=0.2)  # rpm in inch too
    page.close()
