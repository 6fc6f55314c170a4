"""Load of a spindle behind an inverter: its output current against the motor's plate."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from app.compose.backends.inverter_backend import AxisOnlySamples
from core.ports import FloatArray
from drivers.inverter.inverter_family import InverterState
from drivers.inverter.inverter_spindle import InverterSpindle
from tests.drivers.inverter.benches import FAMILIES, Bench, bench, config


def rated(family: str, amps: float) -> tuple[Bench, InverterSpindle]:
    made = bench(family)
    spindle = InverterSpindle(
        dataclasses.replace(config(family), rated_current_a=amps), made.attendant, made.clock
    )
    return made, spindle


def draws(made: Bench, amps: float) -> None:
    """What the inverter says that it gives."""
    seen = made.attendant.last_poll
    assert seen is not None
    look: InverterState = dataclasses.replace(seen.inverter_state, current_a=amps)
    made.attendant.last_poll = dataclasses.replace(seen, inverter_state=look)


@pytest.mark.parametrize("family", FAMILIES)
def test_spindle_load_is_current_divided_by_rated_current(family: str) -> None:
    made, spindle = rated(family, 8.0)
    draws(made, 2.0)
    assert spindle.load_percent == 25.0
    draws(made, 10.0)
    assert spindle.load_percent == 125.0  # an overload is told as one


def test_no_load_is_reported_without_a_rated_current() -> None:
    made, spindle = rated("delta-vfdb", 0.0)
    draws(made, 2.0)
    assert math.isnan(spindle.load_percent)


def test_silent_inverter_reports_no_load() -> None:
    made, spindle = rated("delta-vfdb", 8.0)
    draws(made, 2.0)
    made.clock.advance(5.0)
    assert math.isnan(spindle.load_percent)


class Rows:
    """Slides of two axes that sample."""

    sample_rate_hz = 100.0

    def take_samples(self, max_rows: int = 8192) -> FloatArray:
        return np.arange(22.0).reshape(2, 11)[:max_rows]


def test_axis_samples_include_the_inverter_load() -> None:
    rows = AxisOnlySamples(Rows(), 2, lambda: 40.0).take_samples()
    assert np.isnan(rows[:, 7:9]).all()  # speed and turns
    assert list(rows[:, 9]) == [40.0, 40.0]
    assert list(rows[:, 10]) == [10.0, 21.0]  # the queue is the slides'
