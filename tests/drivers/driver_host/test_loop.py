"""The loop of the driver host's process, in a thread: how it ends, and what the system grants it."""

from __future__ import annotations

import ctypes
import gc
import os
import resource
import select
import signal
import socket
import threading
from collections.abc import Iterator

import pytest

import resources
from app.compose.backends.backend_entry import NO_PRIORITY_TEXT
from app.compose.backends.driver_host_process import (
    DriverHostProcess,
    get_setpoint_interval_s,
    make_priority_warning,
)
from app.compose.machine.machine_files import parse_machine
from core.faults import get_fault_code
from core.ports import DriverError, MachinePorts
from drivers.driver_host import host_connection, host_loop
from drivers.driver_host.host_connection import HostConnection, SocketLink
from drivers.driver_host.host_loop import MessageListener, run_driver_host
from drivers.driver_host.host_messages import NO_NUMBERS, Message, encode_message
from drivers.driver_host.host_ports import create_host_ports
from drivers.driver_host.host_server import DriverBundle, DriverHost
from drivers.simulated.simulated_machine import Simulation, build_simulation
from drivers.wakeups import ManualClock, RealClock
from tests.coded import raises_code
from tests.drivers.contract.simulated import simulation_driven
from tests.drivers.machines import CONFIG


@pytest.fixture
def patient(monkeypatch: pytest.MonkeyPatch) -> pytest.MonkeyPatch:
    """A control that waits for an answer as long as a loaded computer may take: no test of lateness."""
    monkeypatch.setattr(host_connection, "CONTROL_HOST_TIMEOUT_S", 60.0)
    return monkeypatch


@pytest.fixture
def served(patient: pytest.MonkeyPatch) -> Iterator[tuple[socket.socket, Simulation, threading.Thread]]:
    """The loop of the driver host's process in a thread, and the control's end of its socket."""
    ours, theirs = socket.socketpair()
    clock = RealClock()
    sim = build_simulation(CONFIG, clock)
    thread = threading.Thread(
        target=run_driver_host, args=(theirs, simulation_driven(sim.ports, sim.machine), [])
    )
    thread.start()
    yield ours, sim, thread
    ours.close()
    thread.join(60.0)
    theirs.close()
    assert not thread.is_alive()


def assert_off(sim: Simulation) -> None:
    """The drives lose power with the next step of the model."""
    clock = sim.ports.clock
    end = clock.now() + 60.0
    while sim.ports.axes.sample().enabled:
        assert clock.now() < end


def test_loop_replies_and_ends_with_its_control(
    served: tuple[socket.socket, Simulation, threading.Thread],
) -> None:
    ours, sim, thread = served
    ports = create_host_ports(HostConnection(SocketLink(ours), RealClock()))
    ports.axes.enable(True)
    assert ports.axes.sample().enabled
    ours.close()
    thread.join(60.0)
    assert not thread.is_alive()
    assert_off(sim)


def test_invalid_data_from_the_control_is_treated_as_its_end(
    served: tuple[socket.socket, Simulation, threading.Thread],
) -> None:
    ours, sim, thread = served
    ports = create_host_ports(HostConnection(SocketLink(ours), RealClock()))
    ports.axes.enable(True)
    ours.sendall(b"\xff" * 64)
    thread.join(60.0)
    assert not thread.is_alive()
    assert_off(sim)
    assert get_fault_code(ports.axes.sample().fault, "driver") == "feeder-gone"


def test_a_mistake_in_the_loop_leaves_the_drives_without_power() -> None:
    sim = build_simulation(CONFIG, RealClock())
    sim.ports.axes.enable(True)
    ours, theirs = socket.socketpair()
    closed: list[bool] = []

    def broken() -> None:
        raise RuntimeError("a mistake")

    driven = DriverBundle(
        sim.ports, run_cycle=broken, close=lambda: closed.append(True), station_controls=sim.machine
    )
    with ours, theirs, pytest.raises(RuntimeError, match="a mistake"):
        run_driver_host(theirs, driven, [])
    assert closed == [True]


@pytest.mark.parametrize(
    ("user", "limit", "flags", "told"),
    [
        (0, 8 << 20, 3, []),
        (1000, resource.RLIM_INFINITY, 3, []),
        (
            1000,
            512 << 20,
            1,
            [
                "only the driver host's present memory is locked; memory allocated later is not locked "
                "(memlock limit 512 MB)"
            ],
        ),
    ],
)
def test_memory_is_locked_within_the_memlock_limit(
    monkeypatch: pytest.MonkeyPatch, user: int, limit: int, flags: int, told: list[str]
) -> None:
    asked: list[int] = []

    class Library:
        def mlockall(self, how: int) -> int:
            asked.append(how)
            return 0

    monkeypatch.setattr(ctypes, "CDLL", lambda *_a, **_k: Library())
    monkeypatch.setattr(os, "geteuid", lambda: user)
    monkeypatch.setattr(resource, "getrlimit", lambda _which: (limit, limit))
    monkeypatch.setattr(gc, "freeze", lambda: None)
    assert host_loop.lock_host_memory() == told
    assert asked == [flags]


def test_denied_real_time_priority_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "sched_setscheduler", refused)
    (told,) = host_loop.request_real_time_scheduling()
    assert "(Operation not permitted)" in told


def test_request_is_not_handled_shortly_before_a_sync_is_due() -> None:
    ours, theirs = socket.socketpair()
    clock = ManualClock()
    sim = build_simulation(CONFIG, clock)
    host = DriverHost(DriverBundle(sim.ports, sim.ports.axes.sample, lambda: None))
    ear = MessageListener(theirs, host, clock)
    ours.sendall(encode_message(Message({"do": "horizon"}, NO_NUMBERS)))
    ours.setblocking(False)
    due = clock.now() + 0.0002
    assert ear.handle_messages_until_due(due, is_punctual=True) == due
    with pytest.raises(BlockingIOError):
        ours.recv(1000)
    clock.advance(0.005)  # a control is not left alone for longer
    assert ear.handle_messages_until_due(clock.now(), is_punctual=True) == clock.now()
    assert ours.recv(1000)
    ours.close()
    theirs.close()


@pytest.mark.parametrize(
    ("shipped", "expected"),
    [("gt75-epos4.toml", 0.002), ("gt75-canopen.toml", 0.0), ("gt75.toml", 0.0)],
)
def test_setpoint_interval_applies_to_drives_with_a_setpoint_each_sync(shipped: str, expected: float) -> None:
    assert get_setpoint_interval_s(parse_machine(resources.read_machine_file(shipped), shipped)) == expected


@pytest.mark.parametrize(
    ("late", "expected"),
    [
        (0.0005, "the SYNC arrived in time in a 0.3 s test (at most 0.5 ms late)"),
        (0.0071, "0.3 s test, the SYNC did not arrive in time (up to 7.1 ms late)"),
    ],
)
def test_missing_priority_warning_gives_the_measured_wakeup_delay(late: float, expected: str) -> None:
    told = make_priority_warning(0.002, late)
    assert told.startswith(NO_PRIORITY_TEXT)  # the desk looks for that
    assert "2 ms" in told
    assert expected in told


def test_measured_wakeup_delay_detects_a_process_that_wakes_late(monkeypatch: pytest.MonkeyPatch) -> None:
    class Stalled(ManualClock):
        def sleep_until(self, time_s: float) -> None:
            super().sleep_until(time_s + (0.02 if 0.1 < time_s < 0.103 else 0.0001))

    monkeypatch.setattr(host_loop, "RealClock", Stalled)
    assert host_loop.measure_wakeup_delay(0.002) == pytest.approx(0.02)


def test_driver_host_that_does_not_reply_is_a_fault_and_does_not_block() -> None:
    ours, theirs = socket.socketpair()
    line = HostConnection(SocketLink(ours), RealClock())
    with ours, theirs, raises_code(DriverError, "feeder-silent"):
        create_host_ports(line)


# --- a control that sleeps, and the process of its driver host


@pytest.fixture
def asleep(patient: pytest.MonkeyPatch) -> Iterator[tuple[DriverHostProcess, MachinePorts]]:
    """The simulated lathe in a driver host of its own, whose control is about to sleep."""
    text = resources.read_machine_file("gt75.toml").replace("[machine]\n", "[machine]\nfeeder = true\n", 1)
    process = DriverHostProcess(parse_machine(text, "gt75.toml"), RealClock())
    ports = create_host_ports(process.connection)
    ports.axes.sample()
    assert ports.wakeup is not None
    assert ports.wakeup.can_rely_on_wakeups()
    yield process, ports
    if process.process.poll() is None:
        process.process.send_signal(signal.SIGCONT)
    process.close()


def test_killed_driver_host_wakes_its_control_and_its_successor_does_too(
    asleep: tuple[DriverHostProcess, MachinePorts],
) -> None:
    process, ports = asleep
    assert ports.wakeup is not None
    process.process.kill()
    assert ports.wakeup.wait_for_wakeup(60.0)
    assert get_fault_code(ports.axes.sample().fault, "driver") == "feeder-gone"
    assert not ports.wakeup.can_rely_on_wakeups()
    ports.axes.clear_fault()
    while process.connection.is_host_unavailable and not process.connection.fault:
        ports.axes.sample()
        ports.clock.sleep_until(ports.clock.now() + 0.01)
    assert ports.axes.sample().fault == ""
    while ports.wakeup.wait_for_wakeup(0.0):
        ports.axes.sample()
    process.connection.send_request(Message({"do": "hand", "name": "press_estop", "values": []}, NO_NUMBERS))
    at_once = ports.wakeup.wait_for_wakeup(0.0)  # tells it that nobody looks
    assert at_once or ports.wakeup.wait_for_wakeup(60.0)
    assert ports.station.read_state().estop


def test_driver_host_suspended_during_control_sleep_is_found_at_next_poll(
    asleep: tuple[DriverHostProcess, MachinePorts], patient: pytest.MonkeyPatch
) -> None:
    process, ports = asleep
    assert ports.wakeup is not None
    ports.wakeup.wait_for_wakeup(0.0)
    process.process.send_signal(signal.SIGSTOP)
    assert not ports.wakeup.wait_for_wakeup(0.1)
    patient.setattr(host_connection, "CONTROL_HOST_TIMEOUT_S", 0.5)
    sample = ports.axes.sample()
    assert get_fault_code(sample.fault, "driver") == "feeder-silent"
    assert not sample.enabled
    assert not ports.wakeup.can_rely_on_wakeups()


class Asleep:
    """Stands for a driver host whose control sleeps, or not."""

    def __init__(self, asleep: bool) -> None:
        self.is_asleep, self.is_orphaned = asleep, False

    def handle_message(self, _message: Message) -> Message:
        """As a look is answered."""
        return Message({}, NO_NUMBERS)


@pytest.mark.parametrize(
    ("asleep", "punctual", "left", "early"),
    [
        (True, False, 0.02, True),
        (True, False, 0.06, False),  # it is not due for long
        (False, False, 0.02, False),
        (True, True, 0.02, False),  # setpoints at their time
    ],
)
def test_cycle_due_soon_runs_early_with_the_poll_of_a_sleeping_control(
    asleep: bool, punctual: bool, left: float, early: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    ours, theirs = socket.socketpair()
    with ours, theirs:
        clock = ManualClock()
        ear = MessageListener(theirs, Asleep(asleep), clock)  # type: ignore[arg-type]  # all that it asks of it

        def waited(_files: list[socket.socket], _w: object, _x: object, seconds: float) -> tuple[object, ...]:
            """What has been sent is there at once; else the time goes by."""
            if not said:
                clock.advance(seconds + 1e-6)
                return ([], [], [])
            said.pop()
            return ([theirs], [], [])

        said = [True]
        monkeypatch.setattr(select, "select", waited)
        ours.sendall(encode_message(Message({"do": "look"}, NO_NUMBERS)))
        due = ear.handle_messages_until_due(left, is_punctual=punctual)
        assert due == pytest.approx(0.0 if early else left, abs=1e-5)
