"""The control as seen by the screen: commands sent to its process, and messages received from there."""

from __future__ import annotations

import logging
import pickle
import queue
import subprocess
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path
from socket import AF_UNIX, socket

from app.compose.control.control_messages import (
    BUSY,
    VERSION,
    Alive,
    Close,
    Closed,
    Failed,
    Hand,
    Happened,
    Heard,
    Hello,
    Noted,
    Post,
    SetInput,
    Shown,
    StopLine,
    ThreadEnded,
    is_own_user,
)
from app.compose.control.control_start import StartedControl
from app.compose.control.passed_files import SharedMemory, receive_file, send_file
from app.compose.control.process_handle import ProcessHandle
from app.compose.runs.receipt import Receipt
from app.desk.data_folder import RECORDS
from core.executor.commands import Command, GiveProof, LoadJob
from core.executor.raised_alarm import Attempt, ReportedAttempt, make_alarm
from core.executor.snapshot import CYCLE, Event, InterruptedJob, Snapshot, State
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError
from core.records.record_ring import Ring
from core.records.recordings import Recordings
from core.store.store_rows import EventOrigin
from drivers.operator_station import PostedHands
from drivers.waiting import RealClock

_log = logging.getLogger(__name__)
STARTS_IN = 20.0  # s until the first message, because drives may have to be configured
ALIVE_EVERY = 0.25  # s
ENDS = 1.0  # =
ANSWERS_IN = 2.0  # s until the first message of a control that is already running
# Exceptions that ``recv`` raises at the end of the connection, and for messages of another version.
_NO_MESSAGE = (
    OSError,
    EOFError,
    pickle.UnpicklingError,
    AttributeError,
    ImportError,
    LookupError,
    TypeError,
    ValueError,
)
_ENDED = "ended"
_SILENT = "the control that is running does not respond: restart the computer"
_SAVED_IN = 5.0  # s to save the record of an alarm
CLOSES_IN = 20.0  # s, for drives that are switching on; then the machine is halted


@dataclass(slots=True)
class ControlEvents:
    """Functions called in the client's thread for messages of the control."""

    event: Callable[[Event, Receipt | None], None]
    note: Callable[[InterruptedJob | None], None]
    thread_ended: Callable[[str], None]
    stirs: Callable[[], None] = lambda: None


class ControlClient:
    """Connection to the control process. ``snapshot`` is the newest snapshot, and ``post`` never blocks."""

    def __init__(self, started: StartedControl, folder: Path, records: ControlRecords | None = None) -> None:
        """Wait for the first message. ``records`` of an earlier control continue with the data of this one.

        Raises DriverError if the control reports an error, does not respond or has another version.
        """
        self._connection, self.process = connection, process = started
        hello = _hello(connection, STARTS_IN if process is not None else ANSWERS_IN)
        self.hello = hello
        self.attached = process is None  # connected to a control that another screen has started
        memory = SharedMemory(receive_file(connection))
        ring = Ring.of(hello.recorded, memory.view)
        self.records = records or ControlRecords(ring, folder / RECORDS, hello.trouble)
        self.records.ring, self.records.trouble = ring, hello.trouble
        self.handle = ProcessHandle(hello.process)
        self.clock = RealClock(hello.zero)
        self.snapshot: Snapshot = hello.snapshot
        self.heard_at = time.monotonic()  # s, time of the last message
        self.is_lost = False  # the connection has ended although the screen has not closed it
        self._outbox: queue.SimpleQueue[object] = queue.SimpleQueue()
        self._closed = threading.Event()
        self._closing = False  # closed by this screen
        self._came = threading.Event()  # a snapshot has arrived
        self._events: ControlEvents | None = None
        self._threads: list[threading.Thread] = []
        self._next_alive = 0.0  # s
        # commands to be sent when the running program has ended
        self._kept: dict[type[Command], Command] = {}
        self._keeping = threading.Lock()  # worker threads also send commands

    def begin(self, events: ControlEvents) -> None:
        """Start the threads that receive and send messages."""
        self._events = events
        for run, name in ((self._listen, "control-events"), (self._send, "control-posts")):
            self._threads.append(threading.Thread(target=run, name=name, daemon=True))
            self._threads[-1].start()

    def post(self, command: Command) -> None:
        """Send a command to the executor."""
        if self.attached and isinstance(command, LoadJob | GiveProof):
            with self._keeping:
                if self._kept or self.snapshot.state in CYCLE:
                    self._kept[type(command)] = command  # the running program already has its job
                    return
        self._outbox.put(Post(command, self.clock.now()))

    def wait_for(self, shown: Callable[[Snapshot], bool]) -> None:
        """Wait until ``shown`` returns True for a snapshot, or until the control does not respond in time."""
        until = time.monotonic() + ANSWERS_IN
        while not shown(self.snapshot) and not self._closed.is_set() and time.monotonic() < until:
            self._came.wait(ALIVE_EVERY)
            self._came.clear()

    def hand(self, name: str, *values: object) -> None:
        """Operate the simulated operator station."""
        self._outbox.put(Hand(name, values, self.clock.now()))

    def pass_line(self, line: socket) -> None:
        """Pass a socket to the control, which receives stop keys from it, and close it here."""
        self._outbox.put(line)

    @property
    def silent_for(self) -> float:
        """Seconds since the last message of the control."""
        return time.monotonic() - self.heard_at

    def set_input(self, name: str, on: bool) -> None:
        """Switch an input of a simulated machine."""
        self._outbox.put(SetInput(name, on))

    def see(self, snapshot: Snapshot) -> None:
        """Report to the control that the screen handles its keys; called once per frame."""
        now = self.clock.now()
        if now >= self._next_alive and not self.is_lost:
            self._next_alive = now + ALIVE_EVERY
            self._outbox.put(Alive())
        if self._kept and snapshot.state not in CYCLE:
            with self._keeping:
                for command in self._kept.values():
                    self._outbox.put(Post(command, now))
                self._kept.clear()

    def leave(self, *, close: bool) -> None:
        """Disconnect before ``begin`` was called. ``close`` also ends the control.

        The machine of a control that is ended must be at rest.
        """
        with self._connection, suppress(OSError, EOFError):
            if close:
                self._connection.send(Close())
                until = time.monotonic() + CLOSES_IN
                while self._connection.poll(max(until - time.monotonic(), 0.0)):
                    self._connection.recv()  # until its process ends and closes the socket

    def ask_to_end(self) -> None:
        """Ask the control to stop the machine and to end, without waiting for it."""
        self._outbox.put(Close())

    def close(self) -> None:
        """Stop the machine, close its drivers and wait for the end of the process."""
        self._closing = True
        self.ask_to_end()
        self._closed.wait(CLOSES_IN)
        if self.process is not None:
            try:
                self.process.wait(ENDS)
            except subprocess.TimeoutExpired:
                _log.error("the process of the control does not end; it is killed")
                self.process.kill()
                self.process.wait(ENDS)
        self.forget()

    def forget(self) -> None:
        """End the threads and the connection of a control whose process has ended."""
        self._closing = True
        self._outbox.put(None)
        for thread in self._threads:
            thread.join(ENDS)
        self._connection.close()
        self.handle.close()

    # --- threads ----------------------------------------------------------------------------------------

    def _send(self) -> None:
        with suppress(OSError):
            while (message := self._outbox.get()) is not None:
                try:
                    self._send_one(message)
                except (pickle.PicklingError, TypeError, AttributeError):
                    _log.exception("this message cannot be sent to the control: %r", message)

    def _send_one(self, message: object) -> None:
        if isinstance(message, socket):
            with message:
                self._connection.send(StopLine())
                send_file(self._connection, message.fileno())
        else:
            self._connection.send(message)

    def _listen(self) -> None:
        assert self._events is not None
        try:
            while True:
                message = self._connection.recv()
                self.heard_at = time.monotonic()
                with ReportedAttempt(_not_taken):
                    self._take(message, self._events)
        except _NO_MESSAGE:
            with ReportedAttempt(_not_taken):
                if not self._closing:
                    self._lose(self._events)
        self._closed.set()

    def _take(self, message: object, events: ControlEvents) -> None:
        match message:
            case Shown(snapshot, stirred):
                self.snapshot = snapshot
                self._came.set()
                if stirred:
                    with Attempt():  # the window may be closing
                        events.stirs()
            case Happened(number, event):
                self.records.hear(event)
                origin = EventOrigin(self.hello.identity, number)
                events.event(event, Receipt(origin, partial(self._outbox.put, Heard(number))))
            case Noted(job):
                events.note(job)
            case ThreadEnded(name):
                events.thread_ended(name)
            case Closed():
                self._closed.set()
            case _:
                _log.error("the screen does not know this message of the control: %r", message)

    def _lose(self, events: ControlEvents) -> None:
        """Show an alarm because the control process has ended; its drivers have stopped the machine."""
        why = Message("the process of the control has ended")
        last = self.snapshot
        alarm = make_alarm("control-silent", why, last.line, last.t)
        self.snapshot = replace(last, state=State.FAULT, alarms=(*last.alarms, alarm))
        self.is_lost = True
        events.event(Event(last.t, "alarm", alarm.text, alarm.line, alarm), None)
        events.stirs()


class ControlHands(PostedHands):
    """The simulated operator station of the control; methods can be called from any thread.

    ``hand`` sends the name of a method and its values to the station.
    """

    def __init__(self, hand: Callable[..., None]) -> None:
        self._hand = hand

    def post(self, name: str, *values: object) -> None:
        """Call the method with this name at the station."""
        self._hand(name, *values)


class ControlRecords(Recordings):
    """Scope data of the control. ``hear`` receives the events that name alarm records."""

    def __init__(self, ring: Ring, folder: Path, trouble: str) -> None:
        super().__init__(ring, folder, trouble)
        self._named: dict[str, float] = {}  # announced records by name, with the time in s

    def hear(self, event: Event) -> None:
        """Note the name of a record that is now being written."""
        if event.record:
            self._named.setdefault(event.record, time.monotonic())

    def is_saving(self, name: str) -> bool:
        """Return whether the record was announced and its file does not exist yet."""
        there = self.folder is not None and (self.folder / name).exists()
        return not there and time.monotonic() < self._named.get(name, -_SAVED_IN) + _SAVED_IN


def _not_taken(error: BaseException) -> None:
    _log.error("a message of the control was not taken: %s", error)


def _hello(connection: Connection, limit: float) -> Hello:
    """Return the first message of the control.

    Raises DriverError if the control reports an error, does not respond or has another version.
    """
    try:
        message = connection.recv() if connection.poll(limit) else None
    except (OSError, EOFError):
        words = "the process of the control ended during start-up; see its message above"
        raise DriverError(words, reason=_ENDED) from None
    except _NO_MESSAGE:
        message = b""  # a message of another version
    match message:
        case Hello() if message.version == VERSION:
            return message
        case Failed(why):
            raise DriverError(why, reason=why if why == BUSY else "")
        case None:
            raise DriverError(_SILENT if limit == ANSWERS_IN else "the process of the control does not start")
        case _:
            raise DriverError(
                "the control that runs belongs to another version of TurnDesk: wait until it has ended, then "
                "start TurnDesk again"
            )


def find_control(machine: Machine, folder: Path, path: Path) -> ControlClient | None:
    """Return a control that is still running because its screen was killed, or None.

    The control listens at the socket ``path``. The result is None if no control is running or another screen
    is connected to it. A control at rest that has another machine file is closed, and the result is None too.
    Raises DriverError if a control with another machine file is running a program, or if the control has
    another version or does not respond.
    """
    connection = _connected(path)
    if connection is None:
        return None
    try:
        found = ControlClient(StartedControl(connection, None), folder)
    except DriverError as error:
        connection.close()
        if error.reason in {BUSY, _ENDED}:
            return None
        raise
    if found.hello.machine == machine:
        return found
    under_way = found.snapshot.state in CYCLE
    found.leave(close=not under_way)
    if under_way:
        raise DriverError(
            "the control is running a program with another machine file: start TurnDesk with that "
            "machine file"
        )
    return None


def _connected(path: Path) -> Connection | None:
    """Return a connection to the control at a socket, or None.

    The control must belong to the same user, because its messages are unpickled.
    """
    with socket(AF_UNIX) as sock:
        sock.setblocking(False)
        try:
            sock.connect(str(path))
        except BlockingIOError:  # other connections are waiting
            raise DriverError(_SILENT) from None
        except OSError:
            return None
        sock.setblocking(True)
        connection = Connection(sock.detach())
    if is_own_user(connection):
        return connection
    connection.close()
    return None
