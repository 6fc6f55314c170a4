"""Messages that wait until the control process can send them to the screen."""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable
from multiprocessing.connection import Connection
from multiprocessing.reduction import ForkingPickler

from app.compose.control.control_messages import (
    EventMessage,
    InterruptedJobMessage,
    MachineClosedMessage,
    SnapshotMessage,
    ThreadEndedMessage,
)
from app.production.cycle_recorder import CycleRecorder
from core.executor.raised_alarm import ErrorReporter
from core.executor.snapshot import InterruptedJob, LogEvent, Snapshot

_log = logging.getLogger(__name__)
SNAPSHOT_INTERVAL_S = 0.015  # s between two snapshots for the screen
RECHECK_INTERVAL_S = 0.1  # s after which the snapshot is checked without notification
MAX_WAITING_EVENTS = 10_000  # events that can wait while no screen is connected
NOT_SAVED = object()


class ScreenOutbox:
    """Queue of messages for the screen.

    Any thread adds messages, and the screen's sender thread sends them. An event waits until the screen
    confirms that the event is stored. Otherwise the next screen receives the event again. The rows of
    cycles and stops wait with the event that has changed them, also while no screen is connected.
    """

    def __init__(self, read_snapshot: Callable[[], Snapshot]) -> None:
        self._snapshot = read_snapshot
        self._cycle_recorder = CycleRecorder()
        self._events: deque[EventMessage] = deque(maxlen=MAX_WAITING_EVENTS)
        self._ended: deque[ThreadEndedMessage] = deque()
        self._noted: InterruptedJobMessage | None = None
        self._ready = threading.Event()
        self._lock = threading.Lock()  # locked briefly while an event gets its number
        self._number = self._sent = 0  # numbers of the newest event and of the last event sent to this screen
        self._stirred = self._closed = False
        self._shown: Snapshot | None = None

    def request_snapshot(self) -> None:
        """Make the sender thread send the newest snapshot."""
        self._ready.set()

    def request_changed_snapshot(self) -> None:
        """Make the sender thread send the newest snapshot immediately, marked as changed."""
        self._stirred = True
        self._ready.set()

    def add_event(self, event: LogEvent) -> None:
        """Add an event to the queue."""
        with self._lock:
            self._number += 1
            self._events.append(EventMessage(self._number, event, self._cycle_recorder.hear(event)))
        self._ready.set()

    def confirm_events(self, number: int) -> None:
        """Discard the events up to this number, because the screen has stored them."""
        with self._lock:
            while self._events and self._events[0].event_number <= number:
                self._events.popleft()

    @property
    def unconfirmed_events(self) -> list[EventMessage]:
        """Return the events that no screen has confirmed."""
        with self._lock:
            return list(self._events)

    def set_interrupted_job(self, job: InterruptedJob | None) -> None:
        """Replace the waiting message about the job that a power failure would interrupt."""
        self._noted = InterruptedJobMessage(job)
        self._ready.set()

    def report_thread_end(self, name: str) -> None:
        """Add the message that a thread has ended unexpectedly."""
        self._ended.append(ThreadEndedMessage(name))
        self._ready.set()

    def report_machine_closed(self) -> None:
        """Make the sender thread report that the machine is closed."""
        self._closed = True
        self._ready.set()

    def send_messages(self, connection: Connection, screen_gone: threading.Event) -> None:
        """Send waiting messages to a screen until the screen disconnects or the control closes.

        ``screen_gone`` is set when the screen disconnects. The last message reports that the machine is
        closed. Raises OSError if the connection ends.
        """
        self._shown, self._sent = None, 0
        while not screen_gone.is_set():
            self._ready.wait(RECHECK_INTERVAL_S)
            self._ready.clear()
            if self._send_all(connection):
                return
            if not self._stirred:
                screen_gone.wait(SNAPSHOT_INTERVAL_S)

    def _send_all(self, connection: Connection) -> bool:
        """Send all waiting messages, and return whether the machine is closed."""
        with self._lock:
            events = [each for each in self._events if each.event_number > self._sent]
        for event in events:
            send_message(connection, event)
            self._sent = event.event_number
        while self._ended:
            send_message(connection, self._ended.popleft())
        noted, self._noted = self._noted, None
        if noted is not None:
            send_message(connection, noted)  # a later screen receives it in Hello
        closed = self._closed  # read first, so that the snapshot sent afterwards is the last
        stirred, self._stirred = self._stirred, False
        snapshot = self._snapshot()
        if stirred or snapshot is not self._shown:
            send_message(connection, SnapshotMessage(snapshot, stirred))
            self._shown = snapshot
        if closed:
            send_message(connection, MachineClosedMessage())
        return closed


def send_message(connection: Connection, message: object) -> None:
    """Send one message. If it cannot be pickled, log and omit it. Raises OSError if the connection ends."""
    with ErrorReporter(lambda _: _log.error("the screen does not get %s", type(message).__name__)) as trial:
        data = ForkingPickler.dumps(message)
    if trial.error is None:
        connection.send_bytes(data)
