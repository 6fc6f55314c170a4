"""Figures of drive tests on a drive of first order, whose responses have formulas."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from app.compose.machine.machine_files import load_machine
from app.extras.analyses.analyses import analyze_record
from app.extras.analyses.analysis_result import AnalysisKind
from app.extras.analyses.drive_test_results import (
    TEST_PATH_KEY,
    ResultsSection,
    calculate_test_results,
    describe_test_path,
    find_test_path,
    format_test_path_json,
    make_results_table,
)
from core.executor.hand_motion.drive_test import AxisTestLimits, DriveTestMotion, Shape
from core.extras.analyses.step_response import (
    analyze_sine,
    calculate_bandwidth,
    find_smallest_error_limit,
    find_speed_at_limit,
)
from core.records.record import AnalysisError, ScopeRecord
from tests.coded import raises_code
from tests.scope.played_record import RATE, record_of, seconds
from tests.texts import text

DRIVES = {axis.name: axis for axis in load_machine(None).axes if not axis.is_rotary}
LIMITS = AxisTestLimits(max_speed_mm_s=42.0, max_acceleration_mm_s2=3000.0, sample_rate_hz=RATE)
TAU = 0.004
_FINE = 10  # steps of the drive in one sample
STEP = DriveTestMotion("Z", Shape.STEP, 0.5)
RAMP = DriveTestMotion("Z", Shape.RAMP, -5.0, speed=20.0)
SINE = DriveTestMotion("Z", Shape.SINE, 0.5, frequencies_hz=(2.0, 10.0, 40.0, 80.0))


def played(path: DriveTestMotion, tau: float = TAU, lasts: float = 1.0) -> ScopeRecord:
    """A drive that is late by one time constant plays the path from 2 s on, ``lasts`` of it."""
    ramps = path.make_ramps(LIMITS)
    ends = np.cumsum([0.0] + [piece[0] for piece in ramps])
    count = len(seconds(0.0, 2.0 + lasts * ends[-1] + 0.5))
    times = np.arange(_FINE * count) / (_FINE * RATE)
    demand, place = np.zeros(len(times)), 0.0
    for begin, (dt, v, a) in zip(2.0 + ends[:-1], ramps, strict=True):
        t = np.clip(times - begin, 0.0, dt)
        inside = times >= begin
        demand[inside] = (place + (v + 0.5 * a * t) * t)[inside]
        place += (v + 0.5 * a * dt) * dt
    if lasts < 1.0:
        demand[times > 2.0 + lasts * ends[-1]] = demand[np.searchsorted(times, 2.0 + lasts * ends[-1])]
    actual = np.zeros(len(times))
    decay = math.exp(-1.0 / (_FINE * RATE) / tau)
    slope = tau * _FINE * RATE * (1.0 - decay)
    for i in range(1, len(times)):  # exact for a demand that is straight between two samples
        actual[i] = decay * actual[i - 1] + (slope - decay) * demand[i - 1] + (1.0 - slope) * demand[i]
    record = record_of(times[::_FINE], Z_demand=demand[::_FINE], Z_actual=actual[::_FINE])
    return dataclasses.replace(record, about={**record.about, TEST_PATH_KEY: format_test_path_json(path)})


def test_played_test_path_is_read_back_from_its_record() -> None:
    for path in (STEP, RAMP, SINE):
        assert find_test_path(played(path)) == path


@pytest.mark.parametrize(
    "told", ["", "no test", "[1]", '["Z", "jump", 1, 0, []]', '["Z", "step", null, 0, []]', "{}"]
)
def test_other_records_have_no_test_path(told: str) -> None:
    record = record_of(seconds(0.0, 1.0))
    assert find_test_path(dataclasses.replace(record, about={TEST_PATH_KEY: told})) is None


def test_first_order_drive_step_matches_the_formula() -> None:
    """Braking by a until T leaves an error e, which goes with exp(−t/τ): in position after τ·ln(e/band)."""
    found = calculate_test_results(played(STEP), STEP, DRIVES)
    assert [each.step_size_mm for each in found.step_responses] == pytest.approx([0.5, -0.5])
    # speeding up and braking: e' = v − e/τ; solved from rest over the two halves of h = √(s/a)
    h, a = math.sqrt(0.5 / LIMITS.max_acceleration_mm_s2), LIMITS.max_acceleration_mm_s2
    assert a * h < LIMITS.max_speed_mm_s
    half = a * TAU * (h - TAU * (1.0 - math.exp(-h / TAU)))
    t = np.linspace(0.0, h, 2001)
    gone = 1.0 - np.exp(-t / TAU)
    braked = half * (1.0 - gone) + a * h * TAU * gone - a * TAU * (t - TAU * gone)
    end = float(braked[-1])
    expected = TAU * math.log(end / DRIVES["Z"].in_position_tolerance)
    for each in found.step_responses:
        assert each.settling_time_s == pytest.approx(expected, abs=1.5 / RATE)
        assert each.overshoot_fraction == pytest.approx(0.0, abs=1e-6)
    assert np.abs(found.motion.following_error).max() == pytest.approx(float(braked.max()), rel=0.01)


def test_a_ramp_lags_by_its_speed_times_the_time_constant() -> None:
    found = calculate_test_results(played(RAMP), RAMP, DRIVES)
    assert [each.lag_mm for each in found.ramp_responses] == pytest.approx(
        [-20.0 * TAU, 20.0 * TAU], rel=1e-3
    )
    cells = [row.cells for row in make_results_table("", found, True).rows]
    assert ("LAG AT CONSTANT SPEED", "0.0800 mm", "0.0800 mm") in cells
    assert ("SPEED / LAG (GAIN)", "250 /s", "250 /s") in cells  # Kv = 1/τ


def test_sine_gain_phase_and_bandwidth_match_the_formula() -> None:
    """1/√(1+ω²τ²), arctan ωτ; 3 dB down at 1/2πτ = 39.8 Hz; never 90° late."""
    found = calculate_test_results(played(SINE), SINE, DRIVES)
    for each in found.sine_responses:
        omega = 2.0 * math.pi * each.frequency_hz * TAU
        assert each.gain == pytest.approx(1.0 / math.hypot(1.0, omega), rel=0.005)
        assert each.phase_lag_deg == pytest.approx(math.degrees(math.atan(omega)), abs=0.5)
    seen = calculate_bandwidth(found.sine_responses)
    assert seen.gain_bandwidth_hz == pytest.approx(1.0 / (2.0 * math.pi * TAU), rel=0.02)
    assert seen.phase_bandwidth_hz is None
    words = {row.cells[0]: row.cells[2] for row in make_results_table("", found, True).rows}
    assert words["90° PHASE LAG"] == text("scope.not-reached", most=80)


def test_analyses_page_recognizes_a_drive_test_record() -> None:
    found = analyze_record(AnalysisKind.AXIS_RESPONSE, played(RAMP), 0, DRIVES)
    assert found.drive_test_results is not None
    assert found.drive_test_results.test_path == RAMP
    assert describe_test_path(RAMP, True) == "Z−  RAMP  5.0000 mm, 20.000 mm/s"
    assert describe_test_path(SINE, True) == "Z+  SINE  0.5000 mm, 2, 10, 40, 80 Hz"


def test_response_and_limit_parts_make_up_the_whole_table() -> None:
    found = calculate_test_results(played(STEP), STEP, DRIVES)
    whole, *parts = (
        make_results_table("", found, True, part).rows
        for part in (ResultsSection.ALL, *ResultsSection)
        if part
    )
    assert list(whole) == [*parts[0], *parts[1]]


# --- refusals -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", [STEP, RAMP, SINE])
def test_released_drive_test_has_no_results(path: DriveTestMotion) -> None:
    with raises_code(AnalysisError, "test-broken-off"):
        calculate_test_results(played(path, lasts=0.3), path, DRIVES)


def test_record_of_another_machine_is_rejected() -> None:
    path = dataclasses.replace(STEP, axis="Y")
    with raises_code(AnalysisError, "no-axis", "Y"):
        calculate_test_results(played(STEP), path, DRIVES)


def test_step_within_the_in_position_band_is_rejected() -> None:
    path = dataclasses.replace(STEP, travel_mm=DRIVES["Z"].in_position_tolerance)
    with raises_code(AnalysisError, "step-too-small"):
        calculate_test_results(played(path), path, DRIVES)


def test_record_without_positions_is_rejected() -> None:
    record = played(STEP)
    none = np.full(len(record.times_s), np.nan)
    record = dataclasses.replace(record, values_by_channel={**record.values_by_channel, "Z actual": none})
    with raises_code(AnalysisError, "no-positions"):
        calculate_test_results(record, STEP, DRIVES)


# --- windows and speeds -------------------------------------------------------------------------------------


def test_narrowest_limit_is_exceeded_just_for_the_trip_time() -> None:
    """A triangle of 1 mm that rises and falls 10 ms each is above w for 20·(1−w) ms: 5 ms at w = .75."""
    times = seconds(0.0, 1.0)
    error = np.maximum(0.0, 1.0 - np.abs(times - 0.5) / 0.010)
    assert find_smallest_error_limit(times, error, 0.005) == pytest.approx(0.75, abs=0.06)
    assert find_smallest_error_limit(times, -error, 0.0) == pytest.approx(1.0, abs=0.11)
    assert find_smallest_error_limit(times, 0.0 * error, 0.005) == 0.0


def test_lag_meets_the_growing_limit_at_the_calculated_speed() -> None:
    """.2 + .01 v = .02 v gives 20 mm/s; a window that grows as fast as the lag is never met."""
    assert find_speed_at_limit(0.02, 0.2, 1.2, 100.0) == pytest.approx(20.0)
    assert find_speed_at_limit(0.01, 0.2, 1.2, 100.0) is None
    assert find_speed_at_limit(0.011, 0.2, 1.2, 100.0) is None  # at 200 mm/s, faster than the axis is


def test_unmeasured_bandwidth_is_not_reported() -> None:
    t = seconds(0.0, 2.0)
    wave = np.sin(2.0 * math.pi * 5.0 * t)
    seen = calculate_bandwidth([analyze_sine(t, wave, wave, 5.0)])
    assert (seen.gain_bandwidth_hz, seen.phase_bandwidth_hz) == (None, None)
