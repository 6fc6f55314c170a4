"""What the states of an operator station become, one look at a time."""

from __future__ import annotations

import math

import pytest

from core.executor.station_signals import StationSignalConverter
from core.ports import StationState
from tests.texts import text


@pytest.mark.parametrize("state", [StationState(age=1e3), StationState(feed_pot=math.nan)])
def test_station_never_heard_is_silent_with_unknown_switch(state: StationState) -> None:
    told = StationSignalConverter().process_state(state, 0.0)
    assert (told.station_fault, told.is_spindle_in_auto) == (text("executor.station-silent"), True)
    assert (told.is_start_requested, told.was_spindle_switch_turned_on) == (False, False)


def test_start_signal_on_at_the_first_poll_is_not_a_press() -> None:
    watch = StationSignalConverter()
    assert not watch.process_state(StationState(start=True), 0.0).is_start_requested
    assert not watch.process_state(StationState(start=True), 0.01).is_start_requested
    assert not watch.process_state(StationState(), 0.02).is_start_requested


def test_turning_the_spindle_switch_on_is_reported_once() -> None:
    watch = StationSignalConverter()
    found = [
        watch.process_state(StationState(spindle_auto=auto), 0.01 * n).was_spindle_switch_turned_on
        for n, auto in enumerate((True, False, True, True))
    ]
    assert found == [False, False, True, False]
