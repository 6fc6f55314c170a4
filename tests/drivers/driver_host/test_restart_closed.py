"""A control that ends while its driver host restarts: no thread dies, no driver host stays."""

from __future__ import annotations

import threading

import pytest

import resources
from app.compose.backends.driver_host_process import DriverHostProcess
from app.compose.machine.machine_files import parse_machine
from drivers.wakeups import RealClock


def test_closing_in_a_restart_leaves_no_broken_thread_and_no_driver_host(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    text = resources.read_machine_file("gt75.toml").replace("[machine]\n", "[machine]\nfeeder = true\n", 1)
    died: list[object] = []
    monkeypatch.setattr(threading, "excepthook", died.append)
    host = DriverHostProcess(parse_machine(text, "gt75.toml"), RealClock())
    first = host.process
    host.connection.fault = "gone"  # as after a driver host that has ended
    first.kill()
    host.connection.restart_host()
    opening = [each for each in threading.enumerate() if each.name == "reopening"]
    while host.process is first and any(each.is_alive() for each in opening):
        opening[0].join(0.01)
    host.close()
    for each in opening:
        each.join()
    assert not died
    assert host.process is not first
    assert host.process.poll() is not None
