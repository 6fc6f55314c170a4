"""The response of an axis to a step of the Jog page, of a drive with a known lag."""

from __future__ import annotations

import numpy as np
import pytest

from app.compose.machine.machine_files import load_machine
from app.extras.analyses.analyses import analyze_record
from app.extras.analyses.analysis_result import AnalysisKind
from app.extras.analyses.axis_response import find_last_move, make_response_table
from core.records.record import AnalysisError
from tests.coded import raises_code
from tests.scope.played_record import record_of, seconds
from tests.texts import text

DRIVES = {axis.name: axis for axis in load_machine(None).axes}
TAU = 0.004


def moved(speed: float = 20.0, way: float = 2.0, tau: float = TAU) -> object:
    """Z goes ``way`` mm at ``speed`` mm/s from 2 s on, its drive behind by speed · τ · (1 − e^(−t/τ))."""
    times = seconds(0.0, 5.0)
    t = np.maximum(times - 2.0, 0.0)
    end = way / speed

    def lagged(since: np.ndarray) -> np.ndarray:
        s: np.ndarray = np.maximum(since, 0.0)
        return np.multiply(speed, s - tau * (1.0 - np.exp(-s / tau)))

    demand = speed * np.minimum(t, end)
    still = np.full(len(times), 3.0)
    actual = lagged(t) - lagged(t - end)
    return record_of(times, X_demand=still, X_actual=still, Z_demand=demand, Z_actual=actual)


def figures_of(record: object) -> dict[str, str]:
    sheet = make_response_table("", find_last_move(record, DRIVES), True)  # type: ignore[arg-type]
    return {row.cells[0]: row.cells[1] for row in sheet.rows}


def test_the_last_move_is_found_with_its_lag() -> None:
    found = find_last_move(moved(), DRIVES)  # type: ignore[arg-type]
    assert found.axis_letter == "Z"
    assert found.step_response.step_size_mm == pytest.approx(2.0)
    assert found.max_speed_mm_s == pytest.approx(20.0, rel=1e-3)
    assert found.following_lag_s == pytest.approx(
        TAU, rel=0.05
    )  # less the two ends, where it builds up and goes
    assert np.abs(found.following_error).max() == pytest.approx(20.0 * TAU, rel=1e-3)
    assert found.step_response.overshoot_fraction == pytest.approx(0.0, abs=1e-6)
    # it is within the window of in position after τ·ln(error / window)
    band = DRIVES["Z"].in_position_tolerance
    assert found.step_response.settling_time_s == pytest.approx(TAU * np.log(20.0 * TAU / band), abs=0.002)


def test_predicted_error_doubles_at_twice_the_speed() -> None:
    found = find_last_move(moved(), DRIVES)  # type: ignore[arg-type]
    assert np.abs(found.predict_following_error(2.0)).max() == pytest.approx(
        2.0 * np.abs(found.following_error).max(), rel=0.05
    )


def test_limit_that_would_trip_is_reported() -> None:
    """A lag of a tenth of a second: far outside a quarter of any window."""
    words, reduced = figures_of(moved(tau=0.1, way=8.0)), text("scope.limit-reduced", share="25 %")
    assert words[reduced].startswith("trips at")
    assert figures_of(moved(tau=1e-5))[reduced] == "no trip"


def test_record_without_a_move_raises_an_error() -> None:
    times = seconds(0.0, 3.0)
    still = np.full(len(times), 3.0)
    record = record_of(times, X_demand=still, Z_demand=still)
    with raises_code(AnalysisError, "no-step"):
        find_last_move(record, DRIVES)
    assert "Jog page" in analyze_record(AnalysisKind.AXIS_RESPONSE, record, 0, DRIVES).unavailable_reason


def test_unfinished_move_is_not_a_step_response() -> None:
    times = seconds(0.0, 3.0)
    record = record_of(times, X_demand=np.full(len(times), 3.0), Z_demand=5.0 * times)
    with raises_code(AnalysisError, "no-step"):
        find_last_move(record, DRIVES)
