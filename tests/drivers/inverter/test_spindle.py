"""Every family as a spindle: it turns, reverses, stops; wires that break and inverters that do not obey."""

from __future__ import annotations

import pytest

from core.faults import get_fault_code
from tests.drivers.inverter.benches import FAMILIES, OWN, Bench, bench


def test_constant_surface_speed_changes_the_setpoint_continuously(turning: Bench) -> None:
    for step in range(60):
        turning.spindle.set_speed(1200.0 + 30.0 * step if step < 40 else 2400.0 - 20.0 * (step - 40))
        turning.run(0.05)
        assert turning.spindle.read_fault() == ""
    turning.run(1.0)
    assert turning.rpm == pytest.approx(2400.0 - 20.0 * 19, abs=1.0)


def test_spindle_without_an_encoder_has_no_angle(turning: Bench) -> None:
    assert turning.spindle.read_angle() is None


def test_stop_is_sent_before_all_waiting_setpoints(turning: Bench) -> None:
    """At most the request under way comes before it, however many setpoints are waiting."""
    turning.spindle.set_speed(2000.0)
    turning.spindle.set_speed(0.0)
    before, stops = turning.clock.now(), turning.inverter.stops
    while turning.inverter.stops == stops:
        turning.attendant.run_exchange()
    assert turning.clock.now() - before < 0.2
    turning.run(1.5)
    assert turning.rpm == 0.0


def test_stop_waits_for_one_response_at_most(turning: Bench) -> None:
    """A line that has gone silent: the stop is sent although nothing comes back."""
    turning.wire.silent = True
    turning.attendant.run_exchange()
    turning.spindle.set_speed(0.0)
    sent = len(turning.wire.sent)
    turning.attendant.run_exchange()
    first = turning.wire.sent[sent]
    assert first[1] in (3, 5, 6, 16)
    assert first[-3] in (0x08, 0x01, 0x00)  # stop of each family


def test_stop_after_the_frequency_prevents_the_run_command(turning: Bench) -> None:
    send, back = turning.wire.send, set[bool]()

    def overtaken(data: bytes) -> None:
        turning.spindle.set_speed(0.0)
        send(data)
        back.add(turning.inverter.back)

    turning.spindle.set_speed(-900.0)
    turning.wire.send = overtaken  # type: ignore[method-assign]
    turning.run(2.0)
    assert turning.inverter.hz == pytest.approx(15.0)
    assert back == {False}
    assert turning.rpm == 0.0


def test_occasional_lost_response_has_no_effect(turning: Bench) -> None:
    for _ in range(5):
        turning.wire.loses = 1
        turning.run(1.0)
        assert turning.spindle.read_fault() == ""


def test_lost_responses_do_not_stop_a_spindle_at_changing_speed(turning: Bench) -> None:
    """Who has answered too seldom is given no start; a cut that turns already is not broken off for it."""
    for step in range(1, 41):
        turning.wire.loses = int(step % 10 == 0)
        turning.attendant.run_exchange()
        turning.spindle.set_speed(1200.0 + 10.0 * step)
    turning.run(1.5)
    assert turning.spindle.read_fault() == ""
    assert turning.rpm == pytest.approx(1600.0, abs=1.0)


def test_wrong_direction_is_reported(stand: Bench) -> None:
    """The inverter's own "at speed" would be true."""
    stand.inverter.backwards = True
    stand.spindle.set_speed(1200.0)
    assert stand.until_fault(4.0) <= 2.5
    assert get_fault_code(stand.spindle.read_fault(), "driver") == "ignores-stop"


def test_fault_cancels_the_commanded_speed(turning: Bench) -> None:
    turning.inverter.deaf = True
    turning.spindle.set_speed(600.0)
    turning.run(1.0)
    turning.spindle.set_speed(0.0)
    turning.until_fault(3.0)
    turning.inverter.deaf = False
    turning.run(3.0)
    assert turning.rpm == 0.0
    assert turning.attendant.commanded_hz == 0.0


@pytest.mark.parametrize("family", ["delta-vfdb", "hitachi-wj200", OWN])
def test_trip_is_reported_and_reset_once(family: str) -> None:
    one = bench(family)
    one.spindle.set_speed(1000.0)
    one.run(1.5)
    one.inverter.trip_with(1)
    assert one.until_fault(2.0) <= 0.6
    assert get_fault_code(one.spindle.read_fault(), "driver") == "spindle"
    one.run(5.0)
    assert one.inverter.resets == 0
    one.spindle.clear_fault()
    one.run(4.0)
    assert one.inverter.resets == 1
    assert one.spindle.read_fault() == ""
    assert one.rpm == 0.0
    one.spindle.set_speed(400.0)
    one.run(1.5)
    assert one.rpm == pytest.approx(400.0, abs=1.0)


def test_inverter_that_is_no_longer_polled_is_a_fault(turning: Bench) -> None:
    """Nobody calls the rounds: what is not looked at is not well."""
    turning.clock.advance(1.6)
    assert get_fault_code(turning.spindle.read_fault(), "driver") == "inverter-silent"


def test_closing_sends_a_stop(turning: Bench) -> None:
    turning.attendant.close()
    turning.clock.advance(2.0)
    assert turning.rpm == 0.0
    assert turning.wire.closed == 1


@pytest.mark.parametrize("family", FAMILIES)
def test_slow_line_is_not_mistaken_for_disobedience(family: str) -> None:
    """150 ms an answer: a look of the Delta, five registers, is 0.75 s old when it is whole."""
    one = bench(family)
    one.wire.delay = 0.15
    one.run(3.0)
    for rpm in (3000.0, 800.0, 2500.0, -1500.0, 0.0, 3400.0, 0.0):
        one.spindle.set_speed(rpm)
        one.run(0.7)
        assert one.spindle.read_fault() == "", rpm
    for step in range(40):
        one.spindle.set_speed(3000.0 - 60.0 * step)
        one.run(0.1)
        assert one.spindle.read_fault() == "", step
    one.spindle.set_speed(0.0)
    one.run(4.0)
    assert one.spindle.read_fault() == ""
    assert one.rpm == 0.0


def test_disobedience_on_a_slow_line_is_still_reported() -> None:
    one = bench("delta-vfdb")
    one.wire.delay = 0.15
    one.spindle.set_speed(2000.0)
    one.run(5.0)
    one.inverter.deaf = True
    one.spindle.set_speed(0.0)
    assert one.until_fault(6.0) <= 4.0
    assert get_fault_code(one.spindle.read_fault(), "driver") == "ignores-stop"
