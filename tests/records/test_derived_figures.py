"""Velocity, acceleration and ripple against closed formulas."""

from __future__ import annotations

import numpy as np
import pytest

from core.records.record import calculate_acceleration, calculate_speed_ripple, calculate_velocity

T = np.arange(4000) / 1000.0


def test_velocity_of_parabola_is_exact() -> None:
    found = calculate_velocity(T, 3.0 + 2.0 * T + 0.5 * 40.0 * T**2)
    inner = slice(4, -4)
    assert found[inner] == pytest.approx(2.0 + 40.0 * T[inner])
    assert np.isnan(found[:4]).all()
    assert np.isnan(found[-4:]).all()


def test_velocity_of_sine_is_attenuated_by_documented_factor() -> None:
    omega, span = 2.0 * np.pi * 20.0, 0.008
    found = calculate_velocity(T, np.sin(omega * T), span)
    less = np.sin(omega * span / 2) / (omega * span / 2)
    assert found[4:-4] == pytest.approx(less * omega * np.cos(omega * T[4:-4]), abs=1e-6)


def test_acceleration_of_parabola_is_exact() -> None:
    found = calculate_acceleration(T, 1.0 - 7.0 * T + 0.5 * 250.0 * T**2)
    assert found[16:-16] == pytest.approx(250.0, rel=1e-6)


def test_acceleration_of_sine_is_attenuated_by_documented_factor() -> None:
    omega, h = 2.0 * np.pi * 10.0, 0.016
    found = calculate_acceleration(T, np.sin(omega * T))
    less = (np.sin(omega * h / 2) / (omega * h / 2)) ** 2
    assert found[16:-16] == pytest.approx(-less * omega**2 * np.sin(omega * T[16:-16]), abs=1e-3)


def test_ripple_is_speed_minus_mean_over_whole_waves() -> None:
    """10 Hz: five whole waves lie in half a second, so their mean is 1 in 501 samples of one of them."""
    speed = 1200.0 + 6.0 * np.sin(2.0 * np.pi * 10.0 * T)
    found = calculate_speed_ripple(T, speed)
    assert found[250:-250] == pytest.approx(speed[250:-250] - 1200.0, abs=6.0 / 501.0 + 1e-9)


def test_slow_speed_change_has_zero_ripple() -> None:
    assert calculate_speed_ripple(T, 1000.0 + 50.0 * T)[250:-250] == pytest.approx(0.0, abs=1e-6)


def test_derived_values_are_nan_with_too_few_samples() -> None:
    for derive in (calculate_velocity, calculate_acceleration, calculate_speed_ripple):
        assert np.isnan(derive(T[:3], T[:3])).sum() >= 2
        assert np.isnan(derive(T[:1], T[:1])).all()
        assert len(derive(T[:0], T[:0])) == 0


def test_ripple_is_nan_without_encoder_speed() -> None:
    speed = np.full(len(T), np.nan)
    assert np.isnan(calculate_speed_ripple(T, speed)).all()
