"""Responses of systems with a formula: first and second order, pure delay."""

from __future__ import annotations

import math

import numpy as np
import pytest

from core.extras.analyses.step_response import (
    analyze_ramp,
    analyze_sine,
    analyze_step,
    find_trip_time,
    scale_error_to_speed,
)
from core.records.record import AnalysisError
from tests.coded import raises_code

T = np.arange(4001) / 1000.0 - 0.5
STEP = np.where(T >= 0.0, 0.1, 0.0)


def test_first_order_lag_matches_the_formula() -> None:
    """τ: 10 to 90 % take τ·ln 9, half is done after τ·ln 2, it is within .1 % after τ·ln 1000."""
    tau = 0.05
    response = np.where(T >= 0.0, 0.1 * (1.0 - np.exp(-np.maximum(T, 0.0) / tau)), 0.0)
    found = analyze_step(T, STEP, response, 0.0001)
    assert found.rise_time_s == pytest.approx(tau * math.log(9.0), abs=5e-4)
    assert found.delay_s == pytest.approx(tau * math.log(2.0), abs=1e-3)
    assert found.settling_time_s == pytest.approx(tau * math.log(1000.0), abs=2e-3)
    assert found.overshoot_fraction == pytest.approx(0.0, abs=1e-9)
    assert found.final_error_mm == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_second_order_overshoot_matches_the_formula(sign: float) -> None:
    """Damping d overshoots by exp(−πd/√(1−d²)): 25.4 % at d = .4."""
    d, w = 0.4, 60.0
    wd = w * math.sqrt(1.0 - d * d)
    t = np.maximum(T, 0.0)
    response = 1.0 - np.exp(-d * w * t) * (np.cos(wd * t) + d * w / wd * np.sin(wd * t))
    found = analyze_step(T, sign * STEP, sign * 0.1 * np.where(T >= 0.0, response, 0.0), 0.001)
    assert found.overshoot_fraction == pytest.approx(
        math.exp(-math.pi * d / math.sqrt(1.0 - d * d)), abs=1e-3
    )
    assert found.step_size_mm == pytest.approx(sign * 0.1)


def test_unsettled_response_has_no_settling_time() -> None:
    assert math.isnan(analyze_step(T, STEP, 0.9 * STEP, 0.001).settling_time_s)
    assert analyze_step(T, STEP, 0.9 * STEP, 0.001).final_error_mm == pytest.approx(-0.01)


@pytest.mark.parametrize("frequency", [1.0, 5.0, 20.0])
def test_sine_following_error_matches_the_formula(frequency: float) -> None:
    """First order: gain 1/√(1+ω²τ²), lag arctan ωτ, error ωτ/√(1+ω²τ²) of the amplitude."""
    tau, omega, a = 0.01, 2.0 * math.pi * frequency, 0.2
    gain, phase = 1.0 / math.hypot(1.0, omega * tau), math.atan(omega * tau)
    found = analyze_sine(T, a * np.sin(omega * T), a * gain * np.sin(omega * T - phase), frequency)
    assert found.gain == pytest.approx(gain)
    assert found.phase_lag_deg == pytest.approx(math.degrees(phase))
    assert found.max_error_mm == pytest.approx(a * omega * tau * gain)
    assert found.lag_s == pytest.approx(phase / omega)


def test_a_ramp_lags_by_its_speed_times_the_time_constant() -> None:
    tau, speed = 0.02, 10.0
    t = np.maximum(T, 0.0)
    request = speed * np.minimum(t, 2.0)
    response = speed * (t - tau * (1.0 - np.exp(-t / tau)))
    found = analyze_ramp(T[:2400], request[:2400], response[:2400])
    assert found.speed_mm_s == pytest.approx(speed)
    assert found.lag_mm == pytest.approx(speed * tau, rel=1e-3)
    assert found.lag_s == pytest.approx(tau, rel=1e-3)


@pytest.mark.parametrize(
    ("call", "code"),
    [
        (lambda: analyze_step(T[:5], STEP[:5], STEP[:5], 0.001), "too-few-samples"),
        (lambda: analyze_step(T, STEP, STEP, 0.1), "step-too-small"),
        (lambda: analyze_step(T, STEP, np.full(len(T), np.nan), 0.001), "no-positions"),
        (lambda: analyze_sine(T, STEP, STEP, 0.1), "too-short"),
        (lambda: analyze_sine(T, 0 * T, STEP, 5.0), "no-sine"),
        (lambda: analyze_ramp(T, 0 * T, 0 * T), "no-ramp"),
    ],
)
def test_invalid_response_is_rejected(call: object, code: str) -> None:
    with raises_code(AnalysisError, code):
        call()  # type: ignore[operator]


def test_limit_trips_only_if_the_error_lasts() -> None:
    error = np.where((T > 0.1) & (T < 0.2), 0.05, 0.0)
    assert find_trip_time(T, error, 0.04, 0.05) == pytest.approx(0.101 + 0.05)
    assert find_trip_time(T, -error, 0.04, 0.05) == pytest.approx(0.101 + 0.05)
    assert find_trip_time(T, error, 0.04, 0.15) is None
    assert find_trip_time(T, error, 0.06, 0.0) is None


def test_error_proportional_to_speed_scales_with_speed() -> None:
    velocity = np.sin(T)
    found = scale_error_to_speed(velocity, 0.002 * velocity, 3.0)
    assert found == pytest.approx(0.006 * velocity)
    cosine = np.cos(np.linspace(0, 2 * np.pi, 1001))[:-1]
    sine = np.sin(np.linspace(0, 2 * np.pi, 1001))[:-1]
    assert scale_error_to_speed(sine, 0.01 * cosine, 5.0) == pytest.approx(
        0.01 * cosine
    )  # none of it goes with it
