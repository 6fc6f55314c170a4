"""From a machine file to ports: who gets which station, and what is refused."""

from __future__ import annotations

import dataclasses

import resources
from app.compose.backends.canopen_backend import can_driven
from app.compose.backends.connection import connect
from app.compose.machine.machine_files import load_machine, parse_machine
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.operator_station import PanelStation
from drivers.waiting import StepClock
from tests.coded import raises_code
from tests.drivers.canopen.bench import can_machine


def without_station() -> Machine:
    """A machine whose file has no buttons, only the E-stop's contact."""
    return can_machine(
        ('start = { at = "401.6000.1.1" }', ""),
        ('hold  = { at = "401.6000.1.2", active = "low" }', ""),
        ("two_hand_start = true", "two_hand_start = false"),
    )


def test_a_machine_without_buttons_gets_those_on_the_screen() -> None:
    clock = StepClock()
    owned = can_driven(without_station(), clock)
    assert isinstance(owned.ports.station, PanelStation)
    owned.ports.station.press_hold()
    assert owned.ports.station.snapshot().hold
    owned.close()


def test_the_real_estop_counts_on_a_screen_station_too() -> None:
    clock, pressed = StepClock(), [False]
    station = PanelStation(clock, lambda: {"estop": pressed[0]})
    assert not station.snapshot().estop
    pressed[0] = True
    station.release_estop()
    assert station.snapshot().estop
    pressed[0] = False
    station.press_estop()
    assert station.snapshot().estop


def test_both_palms_on_the_screen_are_one_start() -> None:
    clock = StepClock()
    station = PanelStation(clock, dict)
    station.press_left()
    assert not station.snapshot().start
    clock.advance(0.6)
    station.press_right()
    assert not station.snapshot().start  # too late
    station.release_left()
    station.release_right()
    station.press_left()
    station.press_right()
    assert station.snapshot().start


def test_a_machine_with_buttons_has_none_on_the_screen() -> None:
    clock = StepClock()
    owned = can_driven(can_machine(), clock)
    assert not isinstance(owned.ports.station, PanelStation)
    owned.close()


def test_the_simulated_machine_through_the_driver_host_has_all_ports() -> None:
    text = resources.machine_file("gt75.toml").replace('backend = "sim"', 'backend = "sim"\nfeeder = true')
    connected = connect(parse_machine(text, "fed.toml"), StepClock())
    assert connected.ports.gear is not None
    assert connected.panel is not None
    assert connected.set_input is not None
    connected.set_input("TB2-5", True)
    assert connected.ports.io.inputs()["TB2-5"]
    connected.close()


def test_a_backend_without_a_driver_is_refused() -> None:
    machine = dataclasses.replace(load_machine(None), backend="abacus")
    with raises_code(DriverError, "driver", "abacus"):
        connect(machine, StepClock())
