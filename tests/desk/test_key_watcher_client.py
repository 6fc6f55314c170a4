"""The screen's end of the key watcher: a watcher that ends is restarted once, and both are reported."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, field

import pytest

from app.compose.control import key_watcher_process
from app.desk.stop_keys import key_watcher
from app.desk.stop_keys.key_watcher_client import KeyWatcherClient
from tests.killed.bench import until

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="starts processes with sockets")


@dataclass
class Bench:
    """A client, the ends of its stop channels, and what it has reported."""

    has_control: bool = True
    lines: list[socket.socket] = field(default_factory=list)
    reports: list[tuple[int, bool]] = field(default_factory=list)

    def open_line(self) -> socket.socket | None:
        if not self.has_control:
            return None
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.lines.append(theirs)
        return ours

    def start(self) -> KeyWatcherClient:
        line = self.open_line()
        assert line is not None
        return KeyWatcherClient(line, self.open_line, lambda *report: self.reports.append(report))

    def wait(self, client: KeyWatcherClient, count: int) -> None:
        def look() -> bool:
            client.check_process()
            return len(self.reports) >= count

        until(look, lambda: self.reports)


@pytest.fixture
def bench(monkeypatch: pytest.MonkeyPatch) -> Iterator[Bench]:
    monkeypatch.delenv("DISPLAY", raising=False)  # the watcher ends at once, as without libXi
    made = Bench()
    yield made
    for line in made.lines:
        line.close()


def test_watcher_that_cannot_start_is_restarted_once_and_then_reported(bench: Bench) -> None:
    with closing(bench.start()) as client:
        bench.wait(client, 2)
        assert bench.reports == [(1, True), (1, False)]
        client.check_process()
        assert len(bench.reports) == 2
        assert len(bench.lines) == 2


def test_watcher_is_not_restarted_without_a_control(bench: Bench) -> None:
    with closing(bench.start()) as client:
        bench.has_control = False
        bench.wait(client, 1)
        assert bench.reports == [(1, False)]


def test_watcher_that_the_system_does_not_restart_is_reported(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    with closing(bench.start()) as client:

        def refuse(*_arguments: object, **_options: object) -> None:
            raise OSError

        monkeypatch.setattr(subprocess, "Popen", refuse)
        bench.wait(client, 1)
        assert bench.reports == [(1, False)]


def test_watcher_that_ends_with_the_screen_is_not_reported(bench: Bench) -> None:
    client = bench.start()
    client.close()
    client.check_process()
    assert bench.reports == []
    assert len(bench.lines) == 1


@pytest.mark.parametrize("granted", [True, False])
def test_watcher_requests_real_time_priority_and_runs_without_it(
    monkeypatch: pytest.MonkeyPatch, granted: bool
) -> None:
    asked = list[object]()

    def schedule(_who: int, policy: int, param: os.sched_param) -> None:
        asked.append((policy, param.sched_priority))
        if not granted:
            raise PermissionError

    monkeypatch.setattr(os, "sched_setscheduler", schedule)

    def watch(arguments: list[str]) -> int:
        asked.append(arguments)
        return 7

    monkeypatch.setattr(key_watcher, "main", watch)
    assert key_watcher_process.main(["3", "4"]) == 7
    assert asked == [(os.SCHED_RR, 30), ["3", "4"]]
