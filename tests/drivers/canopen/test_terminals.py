"""Terminals and operator station on the bus: levels, pots, handwheel, and what stays when nothing answers."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from core.ports import DriverError
from tests.coded import raises_code
from tests.drivers.canopen.bench import CanBench, can_machine


@pytest.fixture
def wheeled() -> Iterator[CanBench]:
    """A machine with a handwheel on the third analog word."""
    text = ("spindle_pot = {", 'handwheel = { at = "401.6401.3" }\nspindle_pot = {')
    found = CanBench(can_machine(text))
    yield found
    found.close()


def turn(bench: CanBench, to: int) -> int:
    """The counter of the module stands at ``to``; what the station has counted."""
    bench.machine.io.modules["io"].analog[2] = to
    return bench.machine.io.read_state().handwheel


def test_handwheel_continues_when_its_counter_wraps(wheeled: CanBench) -> None:
    assert turn(wheeled, 32000) == 0  # where it stands at the start is nothing
    assert turn(wheeled, 32700) == 700
    assert turn(wheeled, -32736) == 800  # 32767 and 32 further: 32768 is -32768
    assert turn(wheeled, 32700) == 700


def test_handwheel_is_zero_without_a_handwheel(bench: CanBench) -> None:
    assert bench.machine.io.read_state().handwheel == 0


def test_a_broken_estop_wire_is_a_pressed_estop(bench: CanBench) -> None:
    bench.run(0.05)
    assert not bench.machine.io.read_state().estop
    bench.machine.io.modules["io"].inputs[0] &= 0xFE  # low: no voltage on the wire
    assert bench.machine.io.read_state().estop


def test_pots_are_scaled_and_limited_at_both_ends(bench: CanBench) -> None:
    analog = bench.machine.io.modules["io"].analog
    for raw, feed, spindle in ((0, 0.0, 0.0), (32767, 1.5, 1.0), (-5, 0.0, 0.0)):
        analog[0] = analog[1] = raw
        station = bench.machine.io.read_state()
        assert (station.feed_pot, station.spindle_pot) == (feed, spindle)


def test_silent_module_makes_the_station_state_old(bench: CanBench) -> None:
    bench.run(0.05)
    bench.peers.nodes["io"].is_silent = True
    bench.run(0.3)
    assert bench.machine.io.read_state().age > 0.25


def test_outputs_of_a_silent_module_are_rejected_and_go_to_safe_states(bench: CanBench) -> None:
    io = bench.machine.io
    io.write("coolant", True)
    bench.run(0.1)
    bench.peers.nodes["io"].is_silent = True
    bench.run(0.5)
    with raises_code(DriverError, "output", "catcher", "io: "):
        io.write("catcher", True)
    io.switch_to_safe_state()
    assert not io.get_outputs()["coolant"]
    assert io.get_outputs()["collet"]


def test_spindle_load_input_is_reported_in_percent() -> None:
    """0…150 % over the word; the peer tells what its motor has."""
    text = ("spindle_pot = {", 'spindle_load = { at = "401.6401.3", range = [0, 150] }\nspindle_pot = {')
    bench = CanBench(can_machine(text))
    try:
        assert bench.machine.io.read_state().spindle_load == 0.0
        bench.peers.plant.spindle.command_speed(bench.clock.now(), 1750.0)
        for _ in range(300):
            bench.tick()
        load = bench.machine.io.read_state().spindle_load
        assert load is not None
        assert load == pytest.approx(bench.peers.plant.spindle.load_percent, abs=1.6)  # 1 % of the word
        assert load > 1.6
    finally:
        bench.close()


def test_no_spindle_load_is_reported_without_a_load_input() -> None:
    bench = CanBench(can_machine())
    try:
        assert bench.machine.io.read_state().spindle_load is None
    finally:
        bench.close()
