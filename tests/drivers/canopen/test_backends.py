"""From a machine file to ports: who gets which station, and what is refused."""

from __future__ import annotations

import dataclasses

import resources
from app.compose.backends.canopen_backend import create_canopen_drivers
from app.compose.backends.connection import connect_machine
from app.compose.machine.machine_files import load_machine, parse_machine
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.operator_station import OnScreenStation
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.canopen.bench import can_machine


def without_station() -> Machine:
    """A machine whose file has no buttons, only the E-stop's contact."""
    return can_machine(
        ('start = { at = "401.6000.1.1" }', ""),
        ('hold  = { at = "401.6000.1.2", active = "low" }', ""),
        ("two_hand_start = true", "two_hand_start = false"),
    )


def test_machine_without_buttons_gets_an_on_screen_station() -> None:
    clock = ManualClock()
    owned = create_canopen_drivers(without_station(), clock)
    assert isinstance(owned.ports.station, OnScreenStation)
    owned.ports.station.press_hold()
    assert owned.ports.station.read_state().hold
    owned.close()


def test_hardware_estop_also_applies_to_an_on_screen_station() -> None:
    clock, pressed = ManualClock(), [False]
    station = OnScreenStation(clock, lambda: {"estop": pressed[0]})
    assert not station.read_state().estop
    pressed[0] = True
    station.release_estop()
    assert station.read_state().estop
    pressed[0] = False
    station.press_estop()
    assert station.read_state().estop


def test_both_on_screen_palm_buttons_give_one_start() -> None:
    clock = ManualClock()
    station = OnScreenStation(clock, dict)
    station.press_left()
    assert not station.read_state().start
    clock.advance(0.6)
    station.press_right()
    assert not station.read_state().start  # too late
    station.release_left()
    station.release_right()
    station.press_left()
    station.press_right()
    assert station.read_state().start


def test_machine_with_buttons_has_no_on_screen_station() -> None:
    clock = ManualClock()
    owned = create_canopen_drivers(can_machine(), clock)
    assert not isinstance(owned.ports.station, OnScreenStation)
    owned.close()


def test_the_simulated_machine_through_the_driver_host_has_all_ports() -> None:
    text = resources.read_machine_file("gt75.toml").replace(
        'backend = "sim"', 'backend = "sim"\nfeeder = true'
    )
    connected = connect_machine(parse_machine(text, "fed.toml"), ManualClock())
    assert connected.ports.gear is not None
    assert connected.on_screen_station is not None
    assert connected.set_input is not None
    connected.set_input("TB2-5", True)
    assert connected.ports.io.inputs()["TB2-5"]
    connected.close()


def test_a_backend_without_a_driver_is_refused() -> None:
    machine = dataclasses.replace(load_machine(None), backend="abacus")
    with raises_code(DriverError, "driver", "abacus"):
        connect_machine(machine, ManualClock())
