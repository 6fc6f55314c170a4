"""What may be at the other end when a screen connects to a control."""

from __future__ import annotations

import errno
import os
import socket
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from multiprocessing.connection import Connection, Listener, Pipe
from pathlib import Path
from unittest.mock import Mock

import pytest

from app.compose.control import control_client
from app.compose.control.control_client import ControlClient, find_running_control
from app.compose.control.control_messages import (
    PROTOCOL_VERSION,
    SCREEN_CONNECTED,
    CloseRequest,
    ControlFailedMessage,
    SnapshotMessage,
    is_same_user,
)
from app.compose.control.control_start import StartedControl, list_socket_paths, start_control
from core.executor.snapshot import MachineState, Snapshot
from core.ports import DriverError
from tests.control.bench import PATIENCE
from tests.control.test_client import MACHINE, Ear, Peer
from tests.interrupted import broken_off


class Listening:
    """Who listens at a socket path, and what he does with who connects."""

    def __init__(self, path: Path, serve: Callable[[Connection], object]) -> None:
        self._path = str(path)
        self._listener = Listener(self._path, "AF_UNIX")
        self._serve = serve
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _run(self) -> None:
        with suppress(OSError):  # nobody came
            self._serve(self._listener.accept())

    def close(self) -> None:
        """Listen no more."""
        with suppress(OSError), socket.socket(socket.AF_UNIX) as nobody:
            nobody.connect(self._path)
        self.thread.join(PATIENCE)
        self._listener.close()


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return list_socket_paths(tmp_path)[0]


def find(tmp_path: Path, path: Path, serve: Callable[[Connection], object]) -> ControlClient | None:
    """Look for the control there, whose end does ``serve``."""
    listening = Listening(path, serve)
    try:
        return find_running_control(MACHINE, tmp_path, path)
    finally:
        listening.close()


def test_stale_socket_is_not_a_running_control(tmp_path: Path, path: Path) -> None:
    assert find_running_control(MACHINE, tmp_path, path) is None
    path.write_text("no socket")
    assert find_running_control(MACHINE, tmp_path, path) is None
    path.unlink()
    with socket.socket(socket.AF_UNIX) as left:
        left.bind(str(path))  # of a control that was killed
    assert find_running_control(MACHINE, tmp_path, path) is None


def test_running_control_with_the_same_machine_file_is_joined(
    tmp_path: Path, path: Path, idle: Snapshot
) -> None:
    peers: list[Peer] = []

    def serve(connection: Connection) -> None:
        peers.append(Peer(connection, idle))
        peers[0].greet(broken_off())

    found = find(tmp_path, path, serve)
    assert found is not None
    assert found.is_attached
    assert found.hello_message.interrupted_job == broken_off()
    found.disconnect(end_control=False)


@pytest.mark.parametrize("state", [MachineState.RUN, MachineState.HOLD])
def test_active_control_with_another_machine_file_is_rejected(
    tmp_path: Path, path: Path, idle: Snapshot, state: MachineState
) -> None:
    other, running = replace(MACHINE, name="another"), replace(idle, state=state)
    with pytest.raises(DriverError):
        find(tmp_path, path, lambda end: Peer(end, running, other).greet())


def test_idle_control_with_another_machine_file_is_closed(tmp_path: Path, path: Path, idle: Snapshot) -> None:
    other = replace(MACHINE, name="another")
    got: list[object] = []

    def serve(end: Connection) -> None:
        Peer(end, idle, other).greet()
        got.append(end.recv())
        end.send(SnapshotMessage(idle, has_changed=False))
        end.close()  # without a word: its process has ended

    assert find(tmp_path, path, serve) is None
    assert got == [CloseRequest()]


def test_idle_control_that_does_not_close_is_given_up_after_timeout(
    tmp_path: Path, path: Path, idle: Snapshot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(control_client, "CLOSE_TIMEOUT_S", 0.1)
    ends: list[Connection] = []

    def serve(end: Connection) -> None:
        ends.append(end)
        Peer(end, idle, replace(MACHINE, name="another")).greet()

    assert find(tmp_path, path, serve) is None


@pytest.mark.parametrize("version", [PROTOCOL_VERSION + 1, 0, "x"])
def test_control_of_another_version_is_rejected(
    tmp_path: Path, path: Path, idle: Snapshot, version: int
) -> None:
    with pytest.raises(DriverError):
        find(tmp_path, path, lambda end: Peer(end, idle, version=version).greet())


@pytest.mark.parametrize("data", [b"no pickle", b"cno.such\nmodule\n.", b"capp.desk.desk\nNothing\n."])
def test_unreadable_hello_is_rejected_as_another_version(tmp_path: Path, path: Path, data: bytes) -> None:
    with pytest.raises(DriverError):
        find(tmp_path, path, lambda end: end.send_bytes(data))


def test_silent_control_is_rejected_after_timeout(
    tmp_path: Path, path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(control_client, "REPLY_TIMEOUT_S", 0.1)
    ends: list[Connection] = []
    with pytest.raises(DriverError):
        find(tmp_path, path, ends.append)


def test_control_with_a_full_queue_is_rejected_after_timeout(
    tmp_path: Path, path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(control_client, "REPLY_TIMEOUT_S", 0.1)
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(str(path))
        listener.listen(0)
        with socket.socket(socket.AF_UNIX) as first:
            first.connect(str(path))
            with pytest.raises(DriverError):
                find_running_control(MACHINE, tmp_path, path)


@pytest.mark.parametrize("why", [SCREEN_CONNECTED])
def test_control_that_has_a_screen_is_not_joined(tmp_path: Path, path: Path, why: str) -> None:
    assert find(tmp_path, path, lambda end: end.send(ControlFailedMessage(why))) is None


def test_control_that_ends_during_connection_is_not_found(tmp_path: Path, path: Path) -> None:
    assert find(tmp_path, path, lambda end: end.close()) is None


def test_control_that_ends_between_hello_and_its_memory_is_not_found(
    tmp_path: Path, path: Path, idle: Snapshot
) -> None:
    def serve(end: Connection) -> None:
        Peer(end, idle).say_hello()
        end.close()

    assert find(tmp_path, path, serve) is None


@pytest.mark.parametrize(
    "error",
    [ConnectionResetError(errno.ECONNRESET, "reset"), BrokenPipeError(errno.EPIPE, "pipe"), EOFError()],
)
def test_control_whose_connection_breaks_before_its_memory_is_not_found(
    tmp_path: Path, path: Path, idle: Snapshot, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    monkeypatch.setattr(control_client, "receive_descriptor", Mock(side_effect=error))
    assert find(tmp_path, path, lambda end: Peer(end, idle).greet()) is None


@pytest.mark.parametrize(
    "error",
    [OSError(errno.EMFILE, "Too many open files"), OSError(errno.ENOMEM, "No memory"), ValueError("empty")],
)
def test_running_control_whose_memory_cannot_be_opened_is_not_taken_as_ended(
    tmp_path: Path, path: Path, idle: Snapshot, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    """A second control would otherwise be started beside the one that runs."""
    monkeypatch.setattr(control_client, "SharedMemory", Mock(side_effect=error))
    with pytest.raises(DriverError) as raised:
        find(tmp_path, path, lambda end: Peer(end, idle).greet())
    assert raised.value.reason == ""
    assert raised.value.__cause__ is error


@pytest.mark.parametrize("data", [b"", b"f"])
def test_control_that_sends_no_memory_raises_an_error(idle: Snapshot, tmp_path: Path, data: bytes) -> None:
    ours, theirs = Pipe()
    Peer(theirs, idle).say_hello()
    os.write(theirs.fileno(), data)
    theirs.close()
    with pytest.raises(DriverError):
        ControlClient(StartedControl(ours, None), tmp_path)
    ours.close()


def test_peer_of_another_user_is_not_trusted(
    tmp_path: Path, path: Path, idle: Snapshot, monkeypatch: pytest.MonkeyPatch
) -> None:
    ours, theirs = Pipe()
    assert is_same_user(ours)
    user = os.geteuid()
    monkeypatch.setattr(os, "geteuid", lambda: user + 1)
    assert not is_same_user(ours)
    assert find(tmp_path, path, lambda end: Peer(end, idle).greet()) is None
    ours.close()
    theirs.close()


def test_control_process_that_does_not_start_raises_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "executable", "/bin/false")
    started = start_control(MACHINE, tmp_path)
    with pytest.raises(DriverError):
        ControlClient(started, tmp_path)
    started.kill_process()
    assert started.process is not None
    assert started.process.returncode is not None


@pytest.mark.parametrize(("is_new", "seconds"), [(True, 45.0), (False, 2.0)])
def test_first_start_also_waits_for_the_drivers_of_an_ended_control(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_new: bool, seconds: float
) -> None:
    """A new control waits 25 s for the old drivers and has 20 s to start; a running one responds in 2 s."""
    ours, theirs = Pipe()
    timeouts: list[float] = []
    monkeypatch.setattr(ours, "poll", timeouts.append)  # None: nothing arrives
    process = subprocess.Popen([sys.executable, "-c", ""]) if is_new else None
    with pytest.raises(DriverError):
        ControlClient(StartedControl(ours, process), tmp_path)
    assert timeouts == [seconds]
    StartedControl(ours, process).kill_process()
    theirs.close()


def test_a_process_that_does_not_end_is_killed(
    idle: Snapshot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(control_client, "CLOSE_TIMEOUT_S", 0.1)
    monkeypatch.setattr(control_client, "JOIN_TIMEOUT_S", 0.1)
    ours, theirs = Pipe()
    peer = Peer(theirs, idle)
    peer.greet()
    process = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    client = ControlClient(StartedControl(ours, process), tmp_path)
    client.start_threads(Ear().all)
    client.stop_and_close()
    assert process.returncode is not None
    assert process.returncode < 0
    assert process.stdin is not None
    process.stdin.close()
