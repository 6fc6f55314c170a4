"""A control that ends while its feeder is being started again: no thread dies of that, no feeder stays."""

from __future__ import annotations

import threading

import pytest

import resources
from app.compose.backends.feeder_process import FeederProcess
from app.compose.machine.machine_files import parse_machine
from drivers.waiting import RealClock


def test_closing_in_a_restart_leaves_no_broken_thread_and_no_feeder(monkeypatch: pytest.MonkeyPatch) -> None:
    text = resources.machine_file("gt75.toml").replace("[machine]\n", "[machine]\nfeeder = true\n", 1)
    died: list[object] = []
    monkeypatch.setattr(threading, "excepthook", died.append)
    feeder = FeederProcess(parse_machine(text, "gt75.toml"), RealClock())
    first = feeder.process
    feeder.line.fault = "gone"  # as after a feeder that has ended
    first.kill()
    feeder.line.restart()
    opening = [each for each in threading.enumerate() if each.name == "reopening"]
    while feeder.process is first and any(each.is_alive() for each in opening):
        opening[0].join(0.01)
    feeder.close()
    for each in opening:
        each.join()
    assert not died
    assert feeder.process is not first
    assert feeder.process.poll() is not None
