"""Client of the control process, which sends commands to the process and receives its messages."""

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
    PROTOCOL_VERSION,
    SCREEN_CONNECTED,
    CloseRequest,
    CommandMessage,
    ControlFailedMessage,
    EventMessage,
    EventStoredMessage,
    HelloMessage,
    InputChange,
    InterruptedJobMessage,
    MachineClosedMessage,
    ScreenAliveMessage,
    SnapshotMessage,
    StationAction,
    StopSocketMessage,
    ThreadEndedMessage,
    is_same_user,
)
from app.compose.control.control_start import DRIVERS_TIMEOUT_S, StartedControl
from app.compose.control.descriptor_passing import SharedMemory, receive_descriptor, send_descriptor
from app.compose.control.process_handle import ProcessHandle
from app.compose.runs.receipt import EventReceipt
from app.desk.data_folder import RECORDS_FOLDER_NAME
from core.executor.commands import Command, LoadJob, SupplyJobProof
from core.executor.raised_alarm import ErrorCatcher, ErrorReporter, make_alarm
from core.executor.snapshot import CYCLE_STATES, InterruptedJob, LogEvent, MachineState, Snapshot
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError
from core.records.record_ring import ScopeRing
from core.records.recordings import ScopeRecordings
from core.store.store_rows import EventOrigin
from drivers.operator_station import PostedControls
from drivers.silence import SCREEN_ALIVE_INTERVAL_S
from drivers.wakeups import RealClock

_log = logging.getLogger(__name__)
# s until the first message: a new control waits for the drivers of an ended control, and may then have to
# configure drives
START_TIMEOUT_S = DRIVERS_TIMEOUT_S + 20.0
JOIN_TIMEOUT_S = 1.0  # =
REPLY_TIMEOUT_S = 2.0  # s until the first message of a control that is already running
# Exceptions that ``recv`` raises at the end of the connection, and for messages of another version.
_CONNECTION_ERRORS = (
    OSError,
    EOFError,
    pickle.UnpicklingError,
    AttributeError,
    ImportError,
    LookupError,
    TypeError,
    ValueError,
)
_ENDED_REASON = "ended"
_ENDED_TEXT = "the process of the control ended during start-up; see its message above"
_SILENT_TEXT = "the control that is running does not respond: restart the computer"
_SAVE_TIMEOUT_S = 5.0  # s to save the record of an alarm
CLOSE_TIMEOUT_S = 20.0  # s, for drives that are switching on; then the machine is halted


@dataclass(slots=True)
class ControlEventHandlers:
    """Callback functions for messages of the control, which are called in the client's thread."""

    on_event: Callable[[LogEvent, EventReceipt | None], None]
    on_interrupted_job: Callable[[InterruptedJob | None], None]
    on_thread_end: Callable[[str], None]
    on_rest_state_change: Callable[[], None] = lambda: None


class ControlClient:
    """Connection to the control process.

    ``snapshot`` is the newest snapshot. ``post_command`` never blocks.
    """

    def __init__(
        self,
        started_control: StartedControl,
        folder: Path,
        recordings: ControlRecordings | None = None,
    ) -> None:
        """Wait for the first message of the control, at most 45 s if it was just started.

        If an earlier control has ended, its scope ``recordings`` continue with the data of this control.
        Raises DriverError if the control reports an error, ends, does not respond or has a different
        version.
        """
        self._connection, self.control_process = connection, process = started_control
        hello = _receive_hello(connection, START_TIMEOUT_S if process is not None else REPLY_TIMEOUT_S)
        self.hello_message = hello
        self.is_attached = process is None  # connected to a control that another screen has started
        memory = _receive_memory(connection)
        ring = ScopeRing.from_layout(hello.ring_layout, memory.memory_view)
        self.control_records = recordings or ControlRecordings(
            ring, folder / RECORDS_FOLDER_NAME, hello.disk_error
        )
        self.control_records.ring, self.control_records.storage_error = ring, hello.disk_error
        self.handle = ProcessHandle(hello.process_id)
        self.clock = RealClock(hello.clock_zero_s)
        self.snapshot: Snapshot = hello.snapshot
        self.heard_at = time.monotonic()  # s, time of the last message
        self.is_lost = False  # the connection has ended although the screen has not closed it
        self._outbox: queue.SimpleQueue[object] = queue.SimpleQueue()
        self._closed = threading.Event()
        self._closing = False  # closed by this screen
        self._came = threading.Event()  # a snapshot has arrived
        self._events: ControlEventHandlers | None = None
        self._threads: list[threading.Thread] = []
        self._next_alive = 0.0  # s
        # commands to be sent when the running program has ended
        self._kept: dict[type[Command], Command] = {}
        self._keeping = threading.Lock()  # worker threads also send commands

    def start_threads(self, handlers: ControlEventHandlers) -> None:
        """Start the threads that receive and send messages."""
        self._events = handlers
        for run, name in ((self._listen, "control-events"), (self._send, "control-posts")):
            self._threads.append(threading.Thread(target=run, name=name, daemon=True))
            self._threads[-1].start()

    def post_command(self, command: Command) -> None:
        """Send a command to the executor."""
        if self.is_attached and isinstance(command, LoadJob | SupplyJobProof):
            with self._keeping:
                if self._kept or self.snapshot.state in CYCLE_STATES:
                    self._kept[type(command)] = command  # the running program already has its job
                    return
        self._outbox.put(CommandMessage(command, self.clock.now()))

    def wait_for_snapshot(self, is_expected: Callable[[Snapshot], bool]) -> None:
        """Wait until ``is_expected`` returns True for a snapshot, or until the response times out."""
        until = time.monotonic() + REPLY_TIMEOUT_S
        while not is_expected(self.snapshot) and not self._closed.is_set() and time.monotonic() < until:
            self._came.wait(SCREEN_ALIVE_INTERVAL_S)
            self._came.clear()

    def operate_station(self, name: str, *values: object) -> None:
        """Call the method ``name`` of the simulated operator station with these values."""
        self._outbox.put(StationAction(name, values, self.clock.now()))

    def send_stop_socket(self, stop_socket: socket) -> None:
        """Pass a socket to the control and close it in this process.

        The control then receives stop keys from it.
        """
        self._outbox.put(stop_socket)

    @property
    def silence_duration_s(self) -> float:
        """Return the time since the last message of the control, in seconds."""
        return time.monotonic() - self.heard_at

    def set_input(self, name: str, is_on: bool) -> None:
        """Set an input of a simulated machine on or off."""
        self._outbox.put(InputChange(name, is_on))

    def report_screen_alive(self, snapshot: Snapshot) -> None:
        """Report to the control that the screen is processing its keys.

        The screen calls this method once per frame.
        """
        now = self.clock.now()
        if now >= self._next_alive and not self.is_lost:
            self._next_alive = now + SCREEN_ALIVE_INTERVAL_S
            self._outbox.put(ScreenAliveMessage())
        if self._kept and snapshot.state not in CYCLE_STATES:
            with self._keeping:
                for command in self._kept.values():
                    self._outbox.put(CommandMessage(command, now))
                self._kept.clear()

    def disconnect(self, *, end_control: bool) -> None:
        """Disconnect from the control. Call this method only before ``start_threads``.

        ``end_control`` also ends the control. Its machine must then be at rest.
        """
        with self._connection, suppress(OSError, EOFError):
            if end_control:
                self._connection.send(CloseRequest())
                until = time.monotonic() + CLOSE_TIMEOUT_S
                while self._connection.poll(max(until - time.monotonic(), 0.0)):
                    self._connection.recv()  # until its process ends and closes the socket

    def request_close(self) -> None:
        """Ask the control to stop the machine and end. The method does not wait for the end."""
        self._outbox.put(CloseRequest())

    def stop_and_close(self) -> None:
        """Stop the machine, close its drivers, and wait until the control process ends."""
        self._closing = True
        self.request_close()
        self._closed.wait(CLOSE_TIMEOUT_S)
        if self.control_process is not None:
            try:
                self.control_process.wait(JOIN_TIMEOUT_S)
            except subprocess.TimeoutExpired:
                _log.error("the process of the control does not end; it is killed")
                self.control_process.kill()
                self.control_process.wait(JOIN_TIMEOUT_S)
        self.close_connection()

    def close_connection(self) -> None:
        """End the threads and the connection to a control whose process has ended."""
        self._closing = True
        self._outbox.put(None)
        for thread in self._threads:
            thread.join(JOIN_TIMEOUT_S)
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
                self._connection.send(StopSocketMessage())
                send_descriptor(self._connection, message.fileno())
        else:
            self._connection.send(message)

    def _listen(self) -> None:
        assert self._events is not None
        try:
            while True:
                message = self._connection.recv()
                self.heard_at = time.monotonic()
                with ErrorReporter(_not_taken):
                    self._take(message, self._events)
        except _CONNECTION_ERRORS:
            with ErrorReporter(_not_taken):
                if not self._closing:
                    self._handle_loss(self._events)
        self._closed.set()

    def _take(self, message: object, events: ControlEventHandlers) -> None:
        match message:
            case SnapshotMessage(snapshot, stirred):
                self.snapshot = snapshot
                self._came.set()
                if stirred:
                    with ErrorCatcher():  # the window may be closing
                        events.on_rest_state_change()
            case EventMessage(number, event, rows):
                self.control_records.handle_event(event)
                origin = EventOrigin(self.hello_message.control_identity, number)
                confirm = partial(self._outbox.put, EventStoredMessage(number))
                events.on_event(event, EventReceipt(origin, confirm, rows))
            case InterruptedJobMessage(job):
                events.on_interrupted_job(job)
            case ThreadEndedMessage(name):
                events.on_thread_end(name)
            case MachineClosedMessage():
                self._closed.set()
            case _:
                _log.error("the screen does not know this message of the control: %r", message)

    def _handle_loss(self, events: ControlEventHandlers) -> None:
        """Raise an operator alarm because the control process has ended.

        The drivers of the control have stopped the machine.
        """
        why = Message("the process of the control has ended")
        last = self.snapshot
        alarm = make_alarm("control-silent", why, last.line, last.t)
        self.snapshot = replace(last, state=MachineState.FAULT, alarms=(*last.alarms, alarm))
        self.is_lost = True
        events.on_event(LogEvent(last.t, "alarm", alarm.text, alarm.line, alarm), None)
        events.on_rest_state_change()


class RemoteStationControls(PostedControls):
    """Simulated operator station of the control, whose methods can be called from any thread.

    ``operate_station`` sends the name of a method and its values to the station.
    """

    def __init__(self, operate_station: Callable[..., None]) -> None:
        self._hand = operate_station

    def post_action(self, name: str, *values: object) -> None:
        """Call the method with this name at the simulated station of the control."""
        self._hand(name, *values)


class ControlRecordings(ScopeRecordings):
    """Scope recordings of the control. ``handle_event`` receives the events that announce them."""

    def __init__(self, ring: ScopeRing, folder: Path, storage_error: str) -> None:
        super().__init__(ring, folder, storage_error)
        self._named: dict[str, float] = {}  # announced records by name, with the time in s

    def handle_event(self, event: LogEvent) -> None:
        """Store the name of a scope record that the control is writing. The event contains the name."""
        if event.record_name:
            self._named.setdefault(event.record_name, time.monotonic())

    def is_saving_record(self, name: str) -> bool:
        """Return whether the control has announced the record but its file does not exist yet."""
        there = self.folder is not None and (self.folder / name).exists()
        return not there and time.monotonic() < self._named.get(name, -_SAVE_TIMEOUT_S) + _SAVE_TIMEOUT_S


def _not_taken(error: BaseException) -> None:
    _log.error("a message of the control was not taken: %s", error)


def _receive_hello(connection: Connection, timeout_s: float) -> HelloMessage:
    """Return the first message of the control.

    Raises DriverError if the control reports an error, ends, does not respond within ``timeout_s`` seconds
    or has a different version.
    """
    try:
        message = connection.recv() if connection.poll(timeout_s) else None
    except (OSError, EOFError):
        raise DriverError(_ENDED_TEXT, reason=_ENDED_REASON) from None
    except _CONNECTION_ERRORS:
        message = b""  # a message of another version
    match message:
        case HelloMessage() if message.protocol_version == PROTOCOL_VERSION:
            return message
        case ControlFailedMessage(why):
            raise DriverError(why, reason=why if why == SCREEN_CONNECTED else "")
        case None:
            raise DriverError(
                _SILENT_TEXT if timeout_s == REPLY_TIMEOUT_S else "the process of the control does not start"
            )
        case _:
            raise DriverError(
                "the control that runs belongs to another version of TurnDesk: wait until it has ended, then "
                "start TurnDesk again"
            )


def _receive_memory(connection: Connection) -> SharedMemory:
    """Return the memory of the scope, which follows the first message.

    Raises DriverError if the control has ended in between, with the reason ``_ENDED_REASON``. If the control
    runs but its memory cannot be used, the DriverError has no reason.
    """
    try:
        return SharedMemory(receive_descriptor(connection))
    except (ConnectionResetError, BrokenPipeError, EOFError):
        raise DriverError(_ENDED_TEXT, reason=_ENDED_REASON) from None
    except (OSError, ValueError) as error:
        raise DriverError(
            "the memory of the control cannot be opened ({cause}): close other programs, then start TurnDesk "
            "again",
            cause=error.strerror if isinstance(error, OSError) else str(error),
        ) from error


def find_running_control(machine: Machine, folder: Path, path: Path) -> ControlClient | None:
    """Return the client of a control that is still running after its screen was killed, or None.

    The control listens at the socket ``path``. The result is None if no control is running, or if a
    different screen is connected to the control. If a control at rest has a different machine file, it is
    closed and the result is None. Raises DriverError if a control with a different machine file is running
    a program, or if the control has a different version or does not respond.
    """
    connection = _connect(path)
    if connection is None:
        return None
    try:
        found = ControlClient(StartedControl(connection, None), folder)
    except DriverError as error:
        connection.close()
        if error.reason in {SCREEN_CONNECTED, _ENDED_REASON}:
            return None
        raise
    if found.hello_message.machine == machine:
        return found
    under_way = found.snapshot.state in CYCLE_STATES
    found.disconnect(end_control=not under_way)
    if under_way:
        raise DriverError(
            "the control is running a program with another machine file: start TurnDesk with that "
            "machine file"
        )
    return None


def _connect(path: Path) -> Connection | None:
    """Return a connection to the control at a socket, or None if no control of the same user listens there.

    The control must belong to the same user, because its messages are unpickled.
    """
    with socket(AF_UNIX) as sock:
        sock.setblocking(False)
        try:
            sock.connect(str(path))
        except BlockingIOError:  # other connections are waiting
            raise DriverError(_SILENT_TEXT) from None
        except OSError:
            return None
        sock.setblocking(True)
        connection = Connection(sock.detach())
    if is_same_user(connection):
        return connection
    connection.close()
    return None
