"""The clock of the stories: a busy computer is never late for the machine."""

from __future__ import annotations

import threading
from collections.abc import Callable

import pytest

from tests.stories import patient_clock
from tests.stories.patient_clock import GRACE, PatientClock


class _Real:
    """The monotonic clock, moved by the test."""

    t = 100.0

    def monotonic(self) -> float:
        return self.t


@pytest.fixture
def real(monkeypatch: pytest.MonkeyPatch) -> _Real:
    made = _Real()
    monkeypatch.setattr(patient_clock, "time", made)
    return made


def on_the_control(call: Callable[[], float]) -> float:
    found: list[float] = []
    thread = threading.Thread(target=lambda: found.append(call()), name="executor")
    thread.start()
    thread.join()
    return found[0]


def test_clock_runs_with_real_time_while_both_processes_keep_up(real: _Real) -> None:
    clock = PatientClock()
    for _ in range(100):
        on_the_control(clock.now)
        clock.beat_of_screen()
        real.t += 0.05
    assert clock.now() == pytest.approx(105.0)


@pytest.mark.parametrize("late", ["control", "screen"])
def test_late_process_stops_the_clock(real: _Real, late: str) -> None:
    clock = PatientClock()
    on_the_control(clock.now)
    clock.beat_of_screen()
    real.t += 10.0
    if late == "screen":
        on_the_control(clock.now)
    else:
        clock.beat_of_screen()
    assert clock.now() == pytest.approx(100.0 + GRACE)
    on_the_control(clock.now)
    clock.beat_of_screen()
    real.t += 0.01
    assert clock.now() == pytest.approx(100.0 + GRACE + 0.01)


def test_lateness_counts_in_real_time_and_lost_time_is_not_recovered(real: _Real) -> None:
    clock = PatientClock()
    on_the_control(clock.now)
    real.t += 10.0
    clock.run_in_real_time()
    real.t += 3.0
    assert clock.now() == pytest.approx(100.0 + GRACE + 3.0)


def test_fast_mode_begins_and_ends_without_a_time_jump(real: _Real) -> None:
    clock = PatientClock()
    real.t += 1.0
    clock.run_at(5.0)
    assert clock.now() == pytest.approx(101.0)
    real.t += 2.0
    clock.run_at(1.0)
    assert clock.now() == pytest.approx(111.0)
    real.t += 1.0
    assert clock.now() == pytest.approx(112.0)
