"""Every family as a spindle: it turns, reverses, stops; wires that break and inverters that do not obey."""

from __future__ import annotations

import pytest

from core.ports import DriverError
from drivers.inverter.attendant import LOST
from tests.drivers.inverter.benches import Bench, bench

BOUND = LOST + 1.1  # s: two answers of half a second that do not come, each waited for once more


def test_turns_both_ways_and_stops(stand: Bench) -> None:
    spindle = stand.spindle
    for rpm in (1200.0, 600.0, -900.0, 1500.0):
        spindle.run(rpm)
        stand.run(3.0)
        assert spindle.fault() == ""
        assert stand.rpm == pytest.approx(rpm, abs=1.0)
        assert spindle.speed() == pytest.approx(rpm, abs=1.0)  # hundredths of a hertz are .6 rpm
    spindle.run(0.0)
    stand.run(2.0)
    assert spindle.fault() == ""
    assert stand.rpm == spindle.speed() == 0.0


def test_a_surface_speed_changes_the_setpoint_all_the_time(turning: Bench) -> None:
    for step in range(60):
        turning.spindle.run(1200.0 + 30.0 * step if step < 40 else 2400.0 - 20.0 * (step - 40))
        turning.run(0.05)
        assert turning.spindle.fault() == ""
    turning.run(1.0)
    assert turning.rpm == pytest.approx(2400.0 - 20.0 * 19, abs=1.0)


def test_without_an_encoder_there_is_no_angle(turning: Bench) -> None:
    assert turning.spindle.angle() is None


def test_more_than_the_machine_allows_is_not_sent(stand: Bench) -> None:
    stand.spindle.run(9000.0)
    stand.run(1.0)
    assert stand.inverter.hz == pytest.approx(3500.0 / 60.0, abs=0.01)


def test_a_stop_goes_before_everything(turning: Bench) -> None:
    """At most the request under way comes before it, however many setpoints are waiting."""
    turning.spindle.run(2000.0)
    turning.spindle.run(0.0)
    before, stops = turning.clock.now(), turning.inverter.stops
    while turning.inverter.stops == stops:
        turning.attendant.round()
    assert turning.clock.now() - before < 0.2
    turning.run(1.5)
    assert turning.rpm == 0.0


def test_a_stop_waits_for_one_answer_at_most(turning: Bench) -> None:
    """A line that has gone silent: the stop is sent although nothing comes back."""
    turning.wire.silent = True
    turning.attendant.round()
    turning.spindle.run(0.0)
    sent = len(turning.wire.sent)
    turning.attendant.round()
    first = turning.wire.sent[sent]
    assert first[1] in (3, 5, 6)
    assert first[-3] in (0x08, 0x01, 0x00)  # stop of each family


@pytest.mark.parametrize("fault", ["silent", "spoils", "out"])
def test_a_broken_line_is_told_and_stays(turning: Bench, fault: str) -> None:
    setattr(turning.wire, fault, True)
    assert turning.until_fault(5.0) <= BOUND
    told = turning.spindle.fault()
    assert "PRESS E-STOP" in told
    with pytest.raises(DriverError, match="the spindle stays off"):
        turning.spindle.run(500.0)
    setattr(turning.wire, fault, False)
    turning.run(3.0)
    assert turning.spindle.fault() == told
    assert turning.rpm == 0.0  # once it hears again, the first it hears is a stop


@pytest.mark.parametrize("fault", ["silent", "spoils", "out"])
def test_mended_and_cleared_it_turns_again_only_when_told(turning: Bench, fault: str) -> None:
    setattr(turning.wire, fault, True)
    turning.until_fault(5.0)
    turning.spindle.clear_fault()
    turning.until_fault(5.0)  # still broken: clearing helps nothing
    setattr(turning.wire, fault, False)
    turning.run(3.0)
    turning.spindle.clear_fault()
    turning.run(5.0)
    assert turning.spindle.fault() == ""
    assert turning.rpm == 0.0
    turning.spindle.run(700.0)
    turning.run(1.5)
    assert turning.rpm == pytest.approx(700.0, abs=1.0)


def test_answers_that_come_too_late_are_no_answers(turning: Bench) -> None:
    turning.wire.delay = 0.7
    assert turning.until_fault(6.0) <= 2 * BOUND


def test_noise_before_the_answers_does_no_harm(turning: Bench) -> None:
    turning.wire.noise = b"\x00\xff\x01"
    turning.run(3.0)
    assert turning.spindle.fault() == ""


def test_an_answer_lost_now_and_then_does_no_harm(turning: Bench) -> None:
    for _ in range(5):
        turning.wire.loses = 1
        turning.run(1.0)
        assert turning.spindle.fault() == ""


def test_ignoring_a_stop_is_told_within_a_second_with_the_word_for_the_operator(turning: Bench) -> None:
    turning.inverter.deaf = True
    turning.spindle.run(0.0)
    assert 1.0 <= turning.until_fault(3.0) <= 1.6
    assert "told to stop" in turning.spindle.fault()
    assert "PRESS E-STOP" in turning.spindle.fault()


def test_the_wrong_direction_is_told(stand: Bench) -> None:
    """The inverter's own "at speed" would be true."""
    stand.inverter.backwards = True
    stand.spindle.run(1200.0)
    assert stand.until_fault(4.0) <= 2.5
    assert "other direction" in stand.spindle.fault()


def test_a_command_that_was_not_understood_is_told(stand: Bench) -> None:
    """Somebody turns the knob at the keypad."""
    stand.spindle.run(1200.0)
    stand.run(1.5)
    stand.inverter.hz = 45.0
    assert stand.until_fault(3.0) <= 1.6
    assert "understood 45.00 Hz" in stand.spindle.fault()


def test_trouble_wants_nothing_any_more(turning: Bench) -> None:
    turning.inverter.deaf = True
    turning.spindle.run(600.0)
    turning.run(1.0)
    turning.spindle.run(0.0)
    turning.until_fault(3.0)
    turning.inverter.deaf = False
    turning.run(3.0)
    assert turning.rpm == 0.0
    assert turning.attendant.want == 0.0


@pytest.mark.parametrize("family", ["delta-vfdb", "hitachi-wj200"])
def test_a_trip_is_told_and_reset_once(family: str) -> None:
    one = bench(family)
    one.spindle.run(1000.0)
    one.run(1.5)
    one.inverter.trip_with(1)
    assert one.until_fault(2.0) <= 0.6
    assert "tripped" in one.spindle.fault()
    one.run(5.0)
    assert one.inverter.resets == 0
    one.spindle.clear_fault()
    one.run(4.0)
    assert one.inverter.resets == 1
    assert one.spindle.fault() == ""
    assert one.rpm == 0.0
    one.spindle.run(400.0)
    one.run(1.5)
    assert one.rpm == pytest.approx(400.0, abs=1.0)


def test_the_end_of_whoever_attends_is_a_fault(turning: Bench) -> None:
    """Nobody calls the rounds: what is not looked at is not well."""
    turning.clock.advance(1.6)
    assert "nothing has been heard" in turning.spindle.fault()


def test_closing_says_stop(turning: Bench) -> None:
    turning.attendant.close()
    turning.clock.advance(2.0)
    assert turning.rpm == 0.0
    assert turning.wire.closed == 1
