"""The operator station: the two-hand relay, buttons, pots."""

from __future__ import annotations

import pytest

from tests.drivers.machines import simulation


def test_both_palm_buttons_together_give_a_start() -> None:
    sim, clock = simulation()
    sim.machine.press_left()
    clock.advance(0.49)
    assert not sim.ports.station.read_state().start
    sim.machine.press_right()
    assert sim.ports.station.read_state().start
    clock.advance(3.0)
    assert sim.ports.station.read_state().start
    sim.machine.release_right()
    assert not sim.ports.station.read_state().start


def test_short_press_lasts_one_pulse() -> None:
    sim, clock = simulation()
    sim.machine.press_start()
    clock.advance(0.09)
    assert sim.ports.station.read_state().start
    clock.advance(0.02)
    assert not sim.ports.station.read_state().start


@pytest.mark.parametrize("apart", [0.51, 5.0])
def test_palm_presses_too_far_apart_do_not_start(apart: float) -> None:
    sim, clock = simulation()
    sim.machine.press_left()
    clock.advance(apart)
    sim.machine.press_right()
    assert not sim.ports.station.read_state().start


def test_tied_down_palm_button_allows_no_second_start() -> None:
    sim, clock = simulation()
    sim.machine.press_left()
    sim.machine.press_right()
    for _ in range(3):
        sim.machine.release_right()
        clock.advance(0.2)
        sim.machine.press_right()
        assert not sim.ports.station.read_state().start
    sim.machine.release_left()
    clock.advance(0.2)
    sim.machine.press_left()
    assert not sim.ports.station.read_state().start
    sim.machine.release_left()
    sim.machine.release_right()
    sim.machine.press_start()
    assert sim.ports.station.read_state().start


def test_hold_and_estop_are_read_from_the_station() -> None:
    sim, clock = simulation()
    sim.machine.press_hold()
    sim.machine.release_hold()
    clock.advance(0.05)
    assert sim.ports.station.read_state().hold
    clock.advance(0.1)
    assert not sim.ports.station.read_state().hold
    sim.machine.press_estop()
    clock.advance(60.0)
    assert sim.ports.station.read_state().estop
    sim.machine.release_estop()
    assert not sim.ports.station.read_state().estop


def test_silent_station_state_ages_but_estop_is_still_read() -> None:
    sim, clock = simulation()
    sim.machine.set_feed_pot(0.8)
    sim.machine.station_silent()
    sim.machine.set_feed_pot(0.1)
    sim.machine.press_start()
    clock.advance(0.4)
    state = sim.ports.station.read_state()
    assert state.age == pytest.approx(0.4)
    assert state.feed_pot == 0.8
    assert not state.start
    sim.machine.press_estop()
    assert sim.ports.station.read_state().estop
    sim.machine.station_silent(False)
    assert sim.ports.station.read_state().age == 0.0


def test_pots_are_limited_and_their_noise_is_seeded() -> None:
    first, _ = simulation()
    second, _ = simulation()
    first.machine.set_feed_pot(7.0)
    assert first.ports.station.read_state().feed_pot == 1.5
    first.machine.set_feed_pot(1.0)
    for sim in (first, second):
        sim.machine.pot_noise(0.4)
    a = [first.ports.station.read_state().feed_pot for _ in range(20)]
    b = [second.ports.station.read_state().feed_pot for _ in range(20)]
    assert a == b
    assert max(a) - min(a) > 0.4
    assert all(0.6 <= pot <= 1.4 for pot in a)
