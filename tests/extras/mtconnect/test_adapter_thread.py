"""The adapter's own thread: it begins, it ends, and what goes wrong in it is seen by the agents."""

from __future__ import annotations

import socket
import threading

import pytest

from app.extras.mtconnect.driver.agent_links import MachineReport
from app.extras.mtconnect.driver.mtconnect_adapter import AdapterThread, MtconnectAdapter
from app.extras.mtconnect.driver.mtconnect_table import MtconnectTable
from core.ports import DriverError
from drivers.wakeups import RealClock
from tests.coded import raises_code
from tests.extras.mtconnect.bench import lathe

HERE = "127.0.0.1"


class Machine:
    """Its state, and whether asking for it fails."""

    def __init__(self) -> None:
        self.state, self.broken = "READY", threading.Event()

    def report(self) -> MachineReport:
        if self.broken.is_set():
            raise RuntimeError("a mistake of our own")
        return MachineReport({"execution": self.state}, {})


def adapter(machine: Machine, port: int = 0) -> MtconnectAdapter:
    return MtconnectAdapter(
        MtconnectTable(bind=HERE, port=port), tuple(lathe().iterate_items()), machine.report, RealClock()
    )


def threads() -> list[str]:
    return [thread.name for thread in threading.enumerate() if thread.name == "mtconnect"]


def all_of(wire: socket.socket) -> str:
    """What comes until the other side hangs up."""
    told = b""
    while more := wire.recv(65536):
        told += more
    return told.decode("utf-8")


def test_thread_serves_until_closed_and_leaves_nothing_open() -> None:
    machine = Machine()
    one = adapter(machine)
    thread = AdapterThread(one)
    thread.start()
    address = one.address
    with socket.create_connection(address, 60.0) as wire:
        assert b"execution|READY" in wire.recv(65536)
        machine.state = "STOPPED"  # the last word, whether a look comes before the end or not
        thread.close()
        assert "execution|STOPPED" in all_of(wire)
    assert not thread.is_alive
    assert threads() == []
    with pytest.raises(ConnectionError):
        socket.create_connection(address, 60.0)


def test_second_close_has_no_effect() -> None:
    thread = AdapterThread(adapter(Machine()))
    thread.start()
    thread.close()
    thread.close()


def test_port_in_use_leaves_no_thread() -> None:
    with socket.create_server((HERE, 0)) as other:
        thread = AdapterThread(adapter(Machine(), other.getsockname()[1]))
        with raises_code(DriverError, "driver", other.getsockname()[1]):
            thread.start()
        thread.close()
    assert threads() == []


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_thread_failure_disconnects_the_agents(caplog: pytest.LogCaptureFixture) -> None:
    """Then they say UNAVAILABLE by themselves instead of showing what was true once."""
    machine = Machine()
    one = adapter(machine)
    thread = AdapterThread(one)
    thread.start()
    with socket.create_connection(one.address, 60.0) as wire:
        wire.recv(65536)
        machine.broken.set()
        all_of(wire)
    thread.close()
    assert not thread.is_alive
    assert "RuntimeError: a mistake of our own" in caplog.text
