"""The loop of the feeder's process, in a thread: how it ends, and what the system grants it."""

from __future__ import annotations

import resource
import socket
import threading
from collections.abc import Iterator

import pytest

from core.ports import DriverError
from drivers.clocks import RealClock
from drivers.feeder import feeder_loop
from drivers.feeder.feeder_client import Line, feeder_ports
from drivers.feeder.feeder_links import SocketLink
from drivers.feeder.feeder_loop import serve
from drivers.simulated.simulated_machine import Simulation, build_simulation
from tests.drivers.contract.simulated import SimDriven
from tests.drivers.machines import CONFIG


@pytest.fixture
def served() -> Iterator[tuple[socket.socket, Simulation, threading.Thread]]:
    """The loop of the feeder's process in a thread, and the control's end of its socket."""
    ours, theirs = socket.socketpair()
    clock = RealClock()
    sim = build_simulation(CONFIG, clock)
    thread = threading.Thread(target=serve, args=(theirs, SimDriven(sim.ports, sim.machine), []))
    thread.start()
    yield ours, sim, thread
    ours.close()
    thread.join(20.0)
    theirs.close()
    assert not thread.is_alive()


def assert_off(sim: Simulation) -> None:
    """The drives lose power with the next step of the model."""
    clock = sim.ports.clock
    end = clock.now() + 5.0
    while sim.ports.axes.sample().enabled:
        assert clock.now() < end


def test_the_loop_answers_and_ends_with_its_control(
    served: tuple[socket.socket, Simulation, threading.Thread],
) -> None:
    ours, sim, thread = served
    ports = feeder_ports(Line(SocketLink(ours), RealClock()))
    ports.axes.enable(True)
    assert ports.axes.sample().enabled
    ours.close()
    thread.join(20.0)
    assert not thread.is_alive()
    assert_off(sim)


def test_garbage_from_the_control_counts_as_its_end(
    served: tuple[socket.socket, Simulation, threading.Thread],
) -> None:
    ours, sim, thread = served
    ports = feeder_ports(Line(SocketLink(ours), RealClock()))
    ports.axes.enable(True)
    ours.sendall(b"\xff" * 64)
    thread.join(20.0)
    assert not thread.is_alive()
    assert_off(sim)
    assert "feeder process has ended" in ports.axes.sample().fault


def test_a_mistake_in_the_loop_leaves_the_drives_without_power() -> None:
    sim = build_simulation(CONFIG, RealClock())
    sim.ports.axes.enable(True)
    ours, theirs = socket.socketpair()
    closed: list[bool] = []

    class Broken(SimDriven):
        def tick(self) -> None:
            raise RuntimeError("a mistake")

        def close(self) -> None:
            closed.append(True)

    with ours, theirs, pytest.raises(RuntimeError, match="a mistake"):
        serve(theirs, Broken(sim.ports, sim.machine), [])
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
            ["the feeder's memory is locked as it is, later memory not (memlock limit 512 MB)"],
        ),
    ],
)
def test_memory_is_locked_as_far_as_it_cannot_run_out(
    monkeypatch: pytest.MonkeyPatch, user: int, limit: int, flags: int, told: list[str]
) -> None:
    asked: list[int] = []

    class Library:
        def mlockall(self, how: int) -> int:
            asked.append(how)
            return 0

    monkeypatch.setattr(feeder_loop.ctypes, "CDLL", lambda *_a, **_k: Library())
    monkeypatch.setattr(feeder_loop.os, "geteuid", lambda: user)
    monkeypatch.setattr(feeder_loop.resource, "getrlimit", lambda _which: (limit, limit))
    monkeypatch.setattr(feeder_loop.gc, "freeze", lambda: None)
    assert feeder_loop.keep_memory() == told
    assert asked == [flags]


def test_what_the_system_refuses_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(feeder_loop.os, "sched_setscheduler", refused)
    (told,) = feeder_loop.real_time()
    assert "without real-time priority (Operation not permitted)" in told


def test_a_feeder_that_does_not_answer_is_a_fault_and_no_hang() -> None:
    ours, theirs = socket.socketpair()
    line = Line(SocketLink(ours), RealClock())
    with ours, theirs, pytest.raises(DriverError, match="has not answered"):
        feeder_ports(line)
