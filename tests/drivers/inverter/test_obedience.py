"""Whether an inverter does as it was told: what it says against what was asked, second by second."""

from __future__ import annotations

import pytest

from drivers.inverter.command_monitor import PRESS_ESTOP_TEXT, RESPONSE_TIME_S, InverterCommandMonitor
from drivers.inverter.inverter_family import InverterState
from tests.texts import text


def look(
    output: float,
    setpoint: float = 20.0,
    *,
    run: bool = True,
    reverse: bool = False,
    asked_reverse: bool = False,
) -> InverterState:
    return InverterState(output, setpoint, run, reverse, asked_reverse)


STOOD = look(0.0, 0.0, run=False)


def judged(
    asked: float, seen: InverterState, *, before: InverterState = STOOD, first: float = 0.0
) -> tuple[str, str]:
    """Just within the second that it has, and just behind it."""
    obedience = InverterCommandMonitor()
    if first:
        obedience.record_command(-9.0, first, STOOD)
        obedience.check_polled_state(-5.0, before)
    obedience.record_command(0.0, asked, before)
    return obedience.check_polled_state(RESPONSE_TIME_S - 0.01, seen), obedience.check_polled_state(
        RESPONSE_TIME_S + 0.01, seen
    )


@pytest.mark.parametrize(
    ("asked", "seen", "why"),
    [
        (20.0, look(0.0, 25.0), text("drivers.inverter-other-setpoint", asked="20.00", setpoint="25.00")),
        (20.0, look(0.0, run=False), text("drivers.inverter-does-not-run", asked="20.0")),
        (20.0, look(5.0, asked_reverse=True), ("the inverter reports a command for the opposite direction")),
        (-20.0, look(5.0), "the inverter reports a command for the opposite direction"),
        (20.0, look(5.0, reverse=True), "the inverter runs in the direction opposite to its command"),
        (20.0, look(35.0), text("drivers.inverter-other-output", asked="20.0", output="35.0")),
    ],
)
def test_disobeyed_command_is_reported_after_one_second(asked: float, seen: InverterState, why: str) -> None:
    assert judged(asked, seen) == ("", f"{why}: {PRESS_ESTOP_TEXT}")


@pytest.mark.parametrize("output", [0.0, 3.0, 20.0])
def test_ramping_up_is_not_a_fault(output: float) -> None:
    assert judged(20.0, look(output)) == ("", "")


def test_output_must_fall_and_stop_after_a_stop_command() -> None:
    turning = look(20.0)
    assert judged(0.0, turning, before=turning, first=20.0)[1] == (
        f"{text('drivers.inverter-still-outputs', output='20.0')}: {PRESS_ESTOP_TEXT}"
    )
    means_to = look(0.0)
    assert judged(0.0, means_to, before=turning, first=20.0)[1] == (
        f"{text('drivers.inverter-still-runs')}: {PRESS_ESTOP_TEXT}"
    )
    falling = InverterCommandMonitor()
    falling.record_command(0.0, 20.0, STOOD)
    falling.check_polled_state(1.0, turning)
    falling.record_command(2.0, 0.0, turning)
    for n in range(30):
        assert falling.check_polled_state(2.0 + 0.1 * n, look(20.0 - 0.6 * n, 0.0, run=False)) == ""


def test_repeated_command_does_not_restart_the_timeout() -> None:
    obedience = InverterCommandMonitor()
    obedience.record_command(0.0, 20.0, STOOD)
    obedience.record_command(0.9, 20.0, STOOD)
    why = text("drivers.inverter-does-not-run", asked="20.0")
    assert obedience.check_polled_state(1.1, look(0.0, run=False)).startswith(why)


def test_obeyed_command_restarts_the_timeout_of_the_next_fault() -> None:
    obedience = InverterCommandMonitor()
    obedience.record_command(0.0, 20.0, STOOD)
    assert obedience.check_polled_state(0.9, look(0.0, run=False)) == ""
    assert obedience.check_polled_state(0.95, look(1.0)) == ""
    assert obedience.check_polled_state(1.5, look(0.0, run=False)) == ""  # its second begins here
    assert obedience.check_polled_state(2.6, look(0.0, run=False)) != ""


def test_stop_during_acceleration_is_compared_with_the_next_poll() -> None:
    """On a slow line the look before the stop is old: 10 Hz there, 30 Hz when the stop came."""
    obedience = InverterCommandMonitor()
    obedience.record_command(-1.0, 50.0, STOOD)
    assert obedience.check_polled_state(-0.5, look(5.0, 50.0)) == ""
    obedience.record_command(0.0, 0.0, look(10.0, 50.0))
    for t, output in ((0.95, 30.0), (1.70, 25.0), (2.45, 15.0)):
        assert obedience.check_polled_state(t, look(output, run=False)) == "", t
    assert obedience.check_polled_state(3.2, look(15.0, run=False)) == ""
    assert obedience.check_polled_state(4.3, look(15.0, run=False)) != ""
