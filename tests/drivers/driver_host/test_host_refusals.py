"""What a driver host and its control refuse of each other, and what a driver that refuses makes of a stop."""

from __future__ import annotations

import ctypes
import dataclasses
import gc
import socket
from collections.abc import Callable

import pytest

from core.ports import DriverError
from drivers import process_messages
from drivers.driver_host import host_loop
from drivers.driver_host.host_connection import HostConnection, InProcessLink, SocketLink, clear_drive_faults
from drivers.driver_host.host_messages import NO_NUMBERS, Message, encode_message, parse_floats
from drivers.driver_host.host_ports import create_host_ports
from drivers.driver_host.host_server import DriverBundle, DriverHost
from drivers.simulated.simulated_machine import Simulation, build_simulation
from drivers.wakeups import ManualClock
from tests.coded import raises_code
from tests.drivers.contract.simulated import simulation_driven
from tests.drivers.machines import CONFIG
from tests.drivers.test_gear import cam


def simulation() -> tuple[Simulation, ManualClock]:
    clock = ManualClock()
    return build_simulation(CONFIG, clock), clock


def refuse(why: str) -> Callable[..., object]:
    def refused(*_given: object, **_words: object) -> object:
        raise DriverError(why)

    return refused


@pytest.mark.parametrize("told", ["1, 2", [1.0, "2"], None, {"x": 1.0}])
def test_position_that_is_not_numeric_is_rejected(told: object) -> None:
    with raises_code(DriverError, "feeder-silent") as refused:
        parse_floats(told)
    assert refused.value.reason == "no-numbers"


def test_missing_gear_port_is_reported_through_the_driver_host() -> None:
    sim, clock = simulation()
    plain = dataclasses.replace(sim.ports, gear=None)
    line = HostConnection(
        InProcessLink(DriverHost(DriverBundle(plain, plain.axes.sample, lambda: None))), clock
    )
    asked = HostConnection(InProcessLink(DriverHost(simulation_driven(sim.ports, sim.machine))), clock)
    ports = create_host_ports(asked)
    assert ports.gear is not None
    asked._link = line._link  # behind the other driver host there is none
    with raises_code(DriverError, "driver") as told:
        ports.gear.mesh(cam(sim, turns=3.0))
    assert told.value.reason == "no-gear"


def test_failing_spindle_stop_does_not_prevent_switching_outputs_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """A control that has ended: all is tried, and what did not work is told to the next one."""
    sim, clock = simulation()
    host = DriverHost(simulation_driven(sim.ports, sim.machine))
    ports = create_host_ports(HostConnection(InProcessLink(host), clock))
    ports.axes.enable(True)
    ports.io.write("coolant", True)
    monkeypatch.setattr(sim.ports.spindle, "set_speed", refuse("the inverter does not answer"))
    for _ in range(300):
        clock.advance(0.01)
        host.run_cycle()
    assert not sim.ports.io.get_outputs()["coolant"]
    assert [note for note in host._notes if "was stopping the machine: the inverter does not answer" in note]


def test_failing_outputs_do_not_prevent_stopping_the_spindle(monkeypatch: pytest.MonkeyPatch) -> None:
    sim, clock = simulation()
    host = DriverHost(simulation_driven(sim.ports, sim.machine))
    ports = create_host_ports(HostConnection(InProcessLink(host), clock))
    ports.spindle.set_speed(600.0)
    for _ in range(10):
        clock.advance(0.1)
        ports.axes.sample()
        host.run_cycle()
    assert sim.machine.get_spindle_rpm() > 500.0
    monkeypatch.setattr(sim.ports.io, "switch_to_safe_state", refuse("terminal 2 does not answer"))
    for _ in range(500):
        clock.advance(0.01)
        host.run_cycle()
    assert sim.machine.get_spindle_rpm() == 0.0
    assert [note for note in host._notes if "was stopping the machine: terminal 2 does not answer" in note]


def test_driver_that_fails_wakes_a_sleeping_control(monkeypatch: pytest.MonkeyPatch) -> None:
    """Asleep on a machine of which nothing is known it would sleep on."""
    sim, clock = simulation()
    rung: list[bool] = []
    driven = DriverBundle(sim.ports, sim.ports.axes.sample, lambda: None, sim.machine)
    host = DriverHost(driven, ring_bell=lambda: rung.append(True))
    InProcessLink(host).send_request(Message({"do": "look", "rests": True}, NO_NUMBERS))
    host.run_cycle()
    assert (host.is_asleep, rung) == (True, [])
    monkeypatch.setattr(sim.ports.axes, "sample", refuse("X does not answer"))
    clock.advance(0.005)
    host.run_cycle()
    assert rung == [True]


# --- the line ---------------------------------------------------------------------------------------------


def test_driver_host_that_cannot_be_restarted_reports_that_it_is_gone() -> None:
    sim, clock = simulation()
    line = HostConnection(InProcessLink(DriverHost(simulation_driven(sim.ports, sim.machine))), clock)
    line.fault = "the driver host has ended"
    with raises_code(DriverError, "feeder-gone"):
        line.restart_host()
    with raises_code(DriverError, "driver", line.fault):
        line.send_request(Message({"do": "hello"}, NO_NUMBERS))


def test_a_reset_that_the_drives_refuse_starts_no_driver_host(monkeypatch: pytest.MonkeyPatch) -> None:
    sim, _ = simulation()
    link = InProcessLink(DriverHost(simulation_driven(sim.ports, sim.machine)))
    assert clear_drive_faults(link) is link
    monkeypatch.setattr(sim.ports.axes, "clear_fault", refuse("Z: overcurrent"))
    with raises_code(DriverError, "driver", "Z: overcurrent"):
        clear_drive_faults(link)


def test_reply_received_in_pieces_is_reassembled(monkeypatch: pytest.MonkeyPatch) -> None:
    """A socket gives what has come: half a message is none yet, and no end of the driver host."""
    monkeypatch.setattr(process_messages, "_RECEIVE_SIZE", 5)  # bytes
    ours, theirs = socket.socketpair()
    theirs.sendall(encode_message(Message({"value": 7.0}, NO_NUMBERS)))
    link = SocketLink(ours)
    assert link.send_request(Message({"do": "hello"}, NO_NUMBERS)).header == {"value": 7.0}
    link.close()
    theirs.close()


# --- the process ------------------------------------------------------------------------------------------


def test_system_without_memory_locking_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(*_: object, **__: object) -> object:
        raise OSError("no C library")

    monkeypatch.setattr(gc, "freeze", lambda: None)
    monkeypatch.setattr(ctypes, "CDLL", missing)
    assert host_loop.lock_host_memory() == ["the driver host's memory is not locked (no C library)"]

    class Refusing:
        def mlockall(self, _how: int) -> int:
            ctypes.set_errno(12)
            return -1

    monkeypatch.setattr(ctypes, "CDLL", lambda *_a, **_k: Refusing())
    assert host_loop.lock_host_memory() == ["the driver host's memory is not locked (Cannot allocate memory)"]
