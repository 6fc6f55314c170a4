"""The screen's end of the connection, against a control of which a test has the other end."""

from __future__ import annotations

import errno
import os
import socket
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field, replace
from multiprocessing.connection import Connection, Listener, Pipe
from pathlib import Path
from unittest.mock import Mock

import pytest

from app.compose.control import control_client
from app.compose.control.control_client import (
    ControlClient,
    ControlEventHandlers,
    ControlStationControls,
    find_control,
)
from app.compose.control.control_messages import (
    PROTOCOL_VERSION,
    SCREEN_CONNECTED,
    CloseRequest,
    CommandMessage,
    ControlFailedMessage,
    EventMessage,
    EventStoredMessage,
    HelloMessage,
    InterruptedJobNote,
    MachineClosedMessage,
    ScreenAliveMessage,
    SnapshotMessage,
    StationAction,
    ThreadEndedMessage,
    is_own_user,
)
from app.compose.control.control_start import StartedControl, list_socket_paths, start_control
from app.compose.control.descriptor_passing import SharedMemory, send_descriptor
from app.compose.runs.receipt import Receipt
from core.executor.commands import LoadJob, SetSwitch, SupplyProof
from core.executor.job import Proof
from core.executor.snapshot import InterruptedJob, LogEvent, MachineState, Snapshot
from core.machine.machine_model import Machine
from core.ports import DriverError
from core.records.record_ring import RingLayout
from core.store.store_rows import EventOrigin
from tests.control.bench import PATIENCE, SHORT, job_of, one_button, until
from tests.executor.rig import Rig
from tests.interrupted import broken_off

RECORDED = RingLayout({"X": False, "Z": False}, duration_s=1.0)
MACHINE = one_button()


@pytest.fixture(scope="module")
def idle() -> Snapshot:
    rig = Rig()
    rig.ready()
    return rig.shot


@dataclass
class Peer:
    """The control's end: it says what a test wants."""

    end: Connection
    snapshot: Snapshot
    machine: Machine = MACHINE
    version: int = PROTOCOL_VERSION
    memory: SharedMemory = field(default_factory=lambda: SharedMemory.create(RECORDED.size_bytes))

    def greet(self, noted: InterruptedJob | None = None) -> None:
        """Hello, and the memory behind it."""
        self.say_hello(noted)
        send_descriptor(self.end, self.memory.descriptor)

    def say_hello(self, noted: InterruptedJob | None = None) -> None:
        hello = HelloMessage(
            self.version,
            0,  # no process that could be ended
            "a control",
            self.machine,
            0.0,
            (),
            (),
            RECORDED,
            "",
            True,
            False,
            self.snapshot,
            noted,
        )
        self.end.send(hello)

    def next(self, *kinds: type) -> object:
        """The next message of one of these kinds."""
        while self.end.poll(PATIENCE):
            message = self.end.recv()
            if isinstance(message, kinds):
                return message
        raise AssertionError(kinds)

    def sent(self) -> list[object]:
        """What the client posted before a mark."""
        found = list[object]()
        while not isinstance(
            message := self.next(CommandMessage, EventStoredMessage, StationAction), EventStoredMessage
        ):
            found.append(message.command if isinstance(message, CommandMessage) else message)
        return found


@dataclass
class Ear:
    """Everything that the client tells."""

    events: list[LogEvent] = field(default_factory=list)
    origins: list[EventOrigin] = field(default_factory=list)
    notes: list[InterruptedJob | None] = field(default_factory=list)
    ended: list[str] = field(default_factory=list)
    stirs: list[int] = field(default_factory=list)
    fails: bool = False

    def hear(self, event: LogEvent, receipt: Receipt | None) -> None:
        """An event, which cannot be kept while this fails."""
        if self.fails:
            raise ValueError
        self.events.append(event)
        if receipt is not None:
            self.origins.append(receipt.origin)
            receipt.confirm_storage()

    def note(self, job: InterruptedJob | None) -> None:
        """What is interrupted."""
        if self.fails:
            raise ValueError
        self.notes.append(job)

    def stir(self) -> None:
        """The window, which may be gone."""
        if self.fails:
            raise RuntimeError
        self.stirs.append(1)

    @property
    def all(self) -> ControlEventHandlers:
        """What the client calls."""
        return ControlEventHandlers(self.hear, self.note, self.ended.append, self.stir)


@dataclass
class Pair:
    """Both ends."""

    peer: Peer
    client: ControlClient
    ear: Ear = field(default_factory=Ear)

    def begin(self) -> None:
        """Listen and send."""
        self.client.start_threads(self.ear.all)

    def mark(self) -> list[object]:
        """What the client has sent so far."""
        self.peer.end.send(EventMessage(999, LogEvent(0.0, "test", "mark")))
        return self.peer.sent()


@pytest.fixture
def pair(idle: Snapshot, tmp_path: Path) -> Iterator[Pair]:
    made = connected(idle, tmp_path)
    made.begin()
    yield made
    made.peer.end.close()
    made.client.stop_and_close()


def connected(snapshot: Snapshot, folder: Path) -> Pair:
    ours, theirs = Pipe()
    peer = Peer(theirs, snapshot)
    peer.greet()
    return Pair(peer, ControlClient(StartedControl(ours, None), folder))


def test_events_are_acknowledged_and_interruption_notes_forwarded(pair: Pair) -> None:
    job = broken_off()
    pair.peer.end.send(EventMessage(3, LogEvent(1.0, "part", "part 1")))
    assert pair.peer.next(EventStoredMessage) == EventStoredMessage(3)
    assert pair.ear.origins == [EventOrigin("a control", 3)]
    pair.peer.end.send(InterruptedJobNote(job))
    pair.peer.end.send(ThreadEndedMessage("recorder"))
    pair.mark()
    assert [event.kind for event in pair.ear.events] == ["part", "test"]
    assert pair.ear.notes == [job]
    assert pair.ear.ended == ["recorder"]


def test_unknown_message_and_failing_listener_do_not_end_the_connection(pair: Pair, idle: Snapshot) -> None:
    pair.peer.end.send("what is this?")
    pair.ear.fails = True
    later = replace(idle, t=77.0)
    pair.peer.end.send(InterruptedJobNote(None))
    pair.peer.end.send(SnapshotMessage(later, has_changed=True))
    pair.peer.end.send(ThreadEndedMessage("a mark"))
    until(lambda: bool(pair.ear.ended))
    assert pair.client.snapshot == later


def test_event_that_could_not_be_saved_is_not_acknowledged(pair: Pair) -> None:
    pair.ear.fails = True
    pair.peer.end.send(EventMessage(1, LogEvent(1.0, "part", "part 1")))
    pair.peer.end.send(ThreadEndedMessage("a mark"))
    until(lambda: bool(pair.ear.ended))
    pair.ear.fails = False
    pair.client.post_command(SetSwitch("single_block", True))
    assert pair.mark() == [SetSwitch("single_block", True)]


def test_command_that_cannot_be_pickled_does_not_block_later_commands(pair: Pair) -> None:
    pair.client.post_command(SetSwitch("single_block", threading.Lock()))  # type: ignore[arg-type]
    pair.client.post_command(SetSwitch("single_block", True))
    assert pair.mark() == [SetSwitch("single_block", True)]


def test_station_actions_and_life_signs_are_sent_with_their_time(pair: Pair, idle: Snapshot) -> None:
    ControlStationControls(pair.client.operate_station).press_left()
    hand = pair.peer.next(StationAction)
    assert isinstance(hand, StationAction)
    assert hand[:2] == ("press_left", ())
    assert hand.acted_at_s == pytest.approx(pair.client.clock.now(), abs=PATIENCE)
    pair.client.report_alive(idle)
    assert pair.peer.next(ScreenAliveMessage) == ScreenAliveMessage()
    pair.client.report_alive(idle)  # at once: it was told a moment ago
    assert pair.mark() == []


@pytest.mark.parametrize("data", [b"", b"\x80", b"no pickle", b"cno.such\nmodule\n.", b"\x80\x05K\x01K\x02"])
def test_damaged_bytes_are_reported_as_lost_control(pair: Pair, data: bytes) -> None:
    pair.peer.end.send_bytes(data)
    until(lambda: bool(pair.ear.events))
    assert pair.client.snapshot.state is MachineState.FAULT


@pytest.mark.parametrize("closed", [False, True])
def test_unexpected_end_of_the_control_raises_an_alarm(pair: Pair, closed: bool) -> None:
    if closed:  # as SIGTERM ends it
        pair.peer.end.send(MachineClosedMessage())
    pair.peer.end.close()
    until(lambda: pair.client.snapshot.state is MachineState.FAULT)
    until(lambda: bool(pair.ear.stirs))
    (event,) = pair.ear.events
    assert event.alarm is not None
    assert event.alarm.code == "control-silent"
    assert pair.client.snapshot.alarms == (event.alarm,)


def test_closing_the_control_from_the_screen_raises_no_alarm(idle: Snapshot, tmp_path: Path) -> None:
    pair = connected(idle, tmp_path)
    pair.begin()
    closing = threading.Thread(target=pair.client.stop_and_close)
    closing.start()
    assert pair.peer.next(CloseRequest) == CloseRequest()
    pair.peer.end.send(MachineClosedMessage())
    pair.peer.end.close()
    closing.join(PATIENCE)
    assert pair.ear.events == []
    assert pair.client.snapshot.state is MachineState.IDLE
    names = {thread.name for thread in threading.enumerate()}
    assert not names & {"control-events", "control-posts"}


# --- a program that was under way -------------------------------------------------------------------------


def test_program_loaded_during_a_cycle_is_sent_after_the_cycle(idle: Snapshot, tmp_path: Path) -> None:
    running = replace(idle, state=MachineState.RUN)
    pair = connected(running, tmp_path)
    pair.begin()
    first, second = job_of(SHORT, MACHINE), job_of(SHORT + "\n", MACHINE)
    for job in (first, second):
        pair.client.post_command(LoadJob(job))
    pair.client.post_command(SupplyProof(Proof(second.digest, ())))
    pair.client.post_command(SetSwitch("single_block", True))
    pair.client.report_alive(running)
    assert pair.mark() == [SetSwitch("single_block", True)]
    pair.peer.end.send(SnapshotMessage(idle, has_changed=False))
    pair.mark()
    pair.client.post_command(
        SupplyProof(Proof(second.digest, (), block_count=3))
    )  # not before the job that is kept
    pair.client.report_alive(idle)
    assert pair.mark() == [LoadJob(second), SupplyProof(Proof(second.digest, (), block_count=3))]
    pair.client.post_command(LoadJob(first))
    assert pair.mark() == [LoadJob(first)]
    pair.peer.end.close()
    pair.client.stop_and_close()


def test_program_loaded_while_the_cycle_ends_is_not_lost(idle: Snapshot, tmp_path: Path) -> None:
    running = replace(idle, state=MachineState.RUN)
    pair = connected(running, tmp_path)
    pair.begin()
    job = job_of(SHORT, MACHINE)
    over = threading.Event()

    def load() -> None:
        while not over.is_set():
            pair.client.post_command(LoadJob(job))
            pair.client.post_command(SupplyProof(Proof(job.digest, ())))

    worker = threading.Thread(target=load)
    worker.start()
    for _ in range(300):
        pair.client.snapshot = running
        pair.client.report_alive(running)
        pair.client.snapshot = idle
        pair.client.report_alive(idle)
    over.set()
    worker.join()
    pair.client.snapshot = running
    pair.client.post_command(LoadJob(job))
    pair.client.report_alive(idle)
    assert pair.mark()[-1] == LoadJob(job)
    pair.peer.end.close()
    pair.client.stop_and_close()


# --- what may be at the other end ---------------------------------------------------------------------------


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
        return find_control(MACHINE, tmp_path, path)
    finally:
        listening.close()


def test_stale_socket_is_not_a_running_control(tmp_path: Path, path: Path) -> None:
    assert find_control(MACHINE, tmp_path, path) is None
    path.write_text("no socket")
    assert find_control(MACHINE, tmp_path, path) is None
    path.unlink()
    with socket.socket(socket.AF_UNIX) as left:
        left.bind(str(path))  # of a control that was killed
    assert find_control(MACHINE, tmp_path, path) is None


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
                find_control(MACHINE, tmp_path, path)


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
    assert is_own_user(ours)
    user = os.geteuid()
    monkeypatch.setattr(os, "geteuid", lambda: user + 1)
    assert not is_own_user(ours)
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
