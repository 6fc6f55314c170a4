"""The spindle's ramp, by hand: 1500 rpm/s up, 2500 down, 5 % band for .3 s, .08 s latency."""

import pytest

from app.compose.machine.machine_files import load_machine
from core.proving.spindle_forecast import SpindleForecast


@pytest.fixture
def spindle() -> SpindleForecast:
    return SpindleForecast(load_machine(None))


def test_spindle_start_ramps_after_drive_delay(spindle: SpindleForecast) -> None:
    spindle.command_speed(1.0, 3000.0)
    assert spindle.calculate_speed_at(1.08) == 0.0
    assert spindle.calculate_speed_at(2.08) == pytest.approx(1500.0)
    assert spindle.calculate_speed_at(9.0) == 3000.0


def test_spindle_is_at_speed_after_dwell_in_tolerance_band(spindle: SpindleForecast) -> None:
    spindle.command_speed(0.0, 2000.0)
    # 1900 rpm reached after 1900/1500 s, then .3 s.
    assert spindle.calculate_at_speed_time_s() == pytest.approx(0.08 + 1900 / 1500 + 0.3)


def test_spindle_reversal_brakes_to_standstill_first(spindle: SpindleForecast) -> None:
    spindle.command_speed(0.0, 1000.0)
    spindle.command_speed(10.0, -1000.0)
    assert spindle.calculate_speed_at(10.08 + 0.4) == pytest.approx(0.0, abs=1e-9)
    assert spindle.calculate_speed_at(10.08 + 0.4 + 1.0 / 3.0) == pytest.approx(-500.0)
    assert spindle.calculate_at_speed_time_s() == pytest.approx(10.08 + 1000 / 2500 + 950 / 1500 + 0.3)


def test_repeated_speed_command_changes_nothing(spindle: SpindleForecast) -> None:
    spindle.command_speed(0.0, 1500.0)
    ready = spindle.calculate_at_speed_time_s()
    spindle.command_speed(5.0, 1500.0)
    assert spindle.calculate_at_speed_time_s() == ready
