"""The screen's end of the connection, against a control of which a test has the other end."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from multiprocessing.connection import Connection, Pipe
from pathlib import Path

import pytest

from app.compose.control.control_client import (
    ControlClient,
    ControlEventHandlers,
    RemoteStationControls,
)
from app.compose.control.control_messages import (
    PROTOCOL_VERSION,
    CloseRequest,
    CommandMessage,
    EventMessage,
    EventStoredMessage,
    HelloMessage,
    InterruptedJobMessage,
    MachineClosedMessage,
    ScreenAliveMessage,
    SnapshotMessage,
    StationAction,
    ThreadEndedMessage,
)
from app.compose.control.control_start import StartedControl
from app.compose.control.descriptor_passing import SharedMemory, send_descriptor
from app.compose.runs.receipt import EventReceipt
from core.executor.commands import LoadJob, SetSwitch, SupplyJobProof
from core.executor.job import Proof
from core.executor.snapshot import InterruptedJob, LogEvent, MachineState, Snapshot
from core.machine.machine_model import Machine
from core.records.record_ring import RingLayout
from core.store.store_rows import EventOrigin
from tests.control.bench import PATIENCE, SHORT, job_of, one_button, until
from tests.interrupted import broken_off

RECORDED = RingLayout({"X": False, "Z": False}, duration_s=1.0)
MACHINE = one_button()


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

    def hear(self, event: LogEvent, receipt: EventReceipt | None) -> None:
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
    pair.peer.end.send(InterruptedJobMessage(job))
    pair.peer.end.send(ThreadEndedMessage("recorder"))
    pair.mark()
    assert [event.kind for event in pair.ear.events] == ["part", "test"]
    assert pair.ear.notes == [job]
    assert pair.ear.ended == ["recorder"]


def test_unknown_message_and_failing_listener_do_not_end_the_connection(pair: Pair, idle: Snapshot) -> None:
    pair.peer.end.send("what is this?")
    pair.ear.fails = True
    later = replace(idle, t=77.0)
    pair.peer.end.send(InterruptedJobMessage(None))
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
    RemoteStationControls(pair.client.operate_station).press_left()
    hand = pair.peer.next(StationAction)
    assert isinstance(hand, StationAction)
    assert hand[:2] == ("press_left", ())
    assert hand.action_time_s == pytest.approx(pair.client.clock.now(), abs=PATIENCE)
    pair.client.report_screen_alive(idle)
    assert pair.peer.next(ScreenAliveMessage) == ScreenAliveMessage()
    pair.client.report_screen_alive(idle)  # at once: it was told a moment ago
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
    pair.client.post_command(SupplyJobProof(Proof(second.digest, ())))
    pair.client.post_command(SetSwitch("single_block", True))
    pair.client.report_screen_alive(running)
    assert pair.mark() == [SetSwitch("single_block", True)]
    pair.peer.end.send(SnapshotMessage(idle, has_changed=False))
    pair.mark()
    pair.client.post_command(
        SupplyJobProof(Proof(second.digest, (), block_count=3))
    )  # not before the job that is kept
    pair.client.report_screen_alive(idle)
    assert pair.mark() == [LoadJob(second), SupplyJobProof(Proof(second.digest, (), block_count=3))]
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
            pair.client.post_command(SupplyJobProof(Proof(job.digest, ())))

    worker = threading.Thread(target=load)
    worker.start()
    for _ in range(300):
        pair.client.snapshot = running
        pair.client.report_screen_alive(running)
        pair.client.snapshot = idle
        pair.client.report_screen_alive(idle)
    over.set()
    worker.join()
    pair.client.snapshot = running
    pair.client.post_command(LoadJob(job))
    pair.client.report_screen_alive(idle)
    assert pair.mark()[-1] == LoadJob(job)
    pair.peer.end.close()
    pair.client.stop_and_close()
