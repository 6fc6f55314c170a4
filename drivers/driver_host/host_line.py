"""Connection to the driver host, by a socket or within one thread, with the last polled state.

A driver host that has ended is a fault.
"""

from __future__ import annotations

import logging
import queue
import select
import socket
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Protocol

from core.faults import TrippedError, code_of
from core.message import Message as Text
from core.ports import ALL_UNKNOWN, Clock, DriverError, Fault, FloatArray, Unknown
from drivers.driver_host.host_messages import NOTHING, VERSION, Inbox, Message, fault_of, packed, text, texts
from drivers.driver_host.host_server import DriverHost
from drivers.waiting import Bell, Opening

_log = logging.getLogger(__name__)
_FRESH = 0.002  # Seconds for which one poll serves all ports.
_RESTS = 0.02  # The same while the control sleeps: one tick, because changes cause a wake-up.
_BATCHES = 200  # Maximum number of sample batches waiting for the recorder.


class Link(Protocol):
    """Connection that transports requests and replies; ``files`` become readable when it ends."""

    @property
    def files(self) -> Sequence[int]: ...

    def ask(self, message: Message) -> Message:
        """Send a request and return the reply. Raises DriverError without a reply."""
        ...

    def hang_up(self) -> None:
        """Disconnect, from any thread."""
        ...

    def close(self) -> None: ...


def cleared(link: Link) -> Link:
    """Clear the faults of the drives after a restart of the driver host. Raises DriverError."""
    answer = link.ask(Message({"do": "do", "what": "clear_fault"}, NOTHING))
    if why := fault_of(answer.head, "error", "driver"):
        raise DriverError(why)
    return link


class Line:
    """Connection that sends requests and caches the last polled state.

    ``again`` starts another driver host in place of a lost one. The driver host also uses ``bell`` while the
    control sleeps.
    """

    def __init__(
        self,
        link: Link,
        clock: Clock,
        again: Callable[[], Opening[Link]] | None = None,
        bell: Bell | None = None,
    ) -> None:
        self._link = link
        self._again = again
        self._opening: Opening[Link] | None = None
        self.clock = clock
        self.bell = bell
        self._asleep = self._sleeps = False  # State known to the driver host, and state for the next poll.
        self.fault: Fault | str = ""  # Reason why the driver host is lost.
        self._state: Mapping[str, object] = {}
        self._at = -1.0
        self._posted: queue.SimpleQueue[Message] = queue.SimpleQueue()
        self.sampled: deque[FloatArray] = deque(maxlen=_BATCHES)  # Batches since the last reading.

    def ask(self, message: Message) -> Message:
        """Send a request and return the reply.

        Raises DriverError if the drivers reject the request or the driver host is lost, and TrippedError
        after a trip.
        """
        if self.fault:
            raise DriverError(self.fault)
        if self._opening is not None:
            raise DriverError("the driver host is restarting", "feeder-gone")
        self._asleep = False
        try:
            answer = self._link.ask(message)
        except DriverError as error:
            self.fault = error.fault
            raise
        if "tripped" in answer.head:
            raise TrippedError(text(answer.head, "tripped"))
        if why := fault_of(answer.head, "error", "driver"):
            raise DriverError(why, reason=text(answer.head, "reason"))
        return answer

    def order(self, what: str, **values: object) -> None:
        """Send a command that changes the machine, and invalidate the polled state."""
        self._at = -1.0
        self.ask(Message({"do": "do", "what": what, **values}, NOTHING))

    def post(self, message: Message) -> None:
        """Queue a message from any thread, which is sent before the next poll."""
        self._posted.put(message)
        if self.bell is not None:
            self.bell.ring()

    def sleep(self) -> None:
        """Let the driver host send wake-ups for changes until the next other request. Raises DriverError."""
        if not self._asleep:
            self.ask(Message({"do": "rest"}, NOTHING))
        self._asleep = self._sleeps = True

    def awake(self) -> None:
        """End the sleep, and invalidate the polled state."""
        self._sleeps, self._at = False, -1.0

    @property
    def files(self) -> Sequence[int]:
        """The files of the connection, which become readable only when it ends."""
        return self._link.files

    def look(self, *, anew: bool = False) -> Mapping[str, object]:
        """Poll the state, at most once per tick unless forced; return the last state after a loss."""
        if self._opening is not None:
            self._reopen(self._opening)
        now = self.clock.now()
        fresh = _RESTS if self._asleep else _FRESH
        if not self.lost and (anew or not 0.0 <= now - self._at < fresh):
            try:
                while not self._posted.empty():
                    self.ask(self._posted.get())
                sleeps, self._sleeps = self._sleeps, False
                answer = self.ask(Message({"do": "look", "rests": sleeps}, NOTHING))
                self._asleep = sleeps
                self._state = answer.head
                if len(answer.numbers):
                    self.sampled.append(answer.numbers)
            except DriverError as error:
                self.fault = self.fault or error.fault
            self._at = now
            for note in texts(self._state.get("notes")):
                _log.warning("driver host: %s", note)
        return self._state

    @property
    def lost(self) -> bool:
        """Whether no driver host is available."""
        return self.fault != "" or self._opening is not None

    def restart(self) -> None:
        """Start another driver host; a later failure becomes the next fault.

        Raises DriverError if a restart is not possible.
        """
        if self._again is None:
            words = Text("{fault}; restart TurnDesk", fault=self.fault)
            raise DriverError(words, code_of(self.fault, "feeder-gone"))
        self.fault, self._opening = "", self._again()

    def greet(self) -> Mapping[str, object]:
        """Return the properties of the driver host. Raises DriverError for another version."""
        hello = self.ask(Message({"do": "hello"}, NOTHING)).head
        if hello.get("version") != VERSION:
            raise DriverError(
                "the driver host uses version {version}, but TurnDesk uses version {expected}: exit "
                "TurnDesk, complete the installation, then start TurnDesk again",
                version=hello.get("version"),
                expected=VERSION,
            )
        return hello

    def _reopen(self, opening: Opening[Link]) -> None:
        try:
            link = opening.take()
            if link is None:
                return
            self._link, self._opening, self._at = link, None, -1.0
            self._state = {}
            self.greet()
        except DriverError as error:
            self._opening, self.fault = None, error.fault

    def unknown(self) -> frozenset[Unknown]:
        """Return the unknown states; all of them if the driver host is lost."""
        if self.lost:
            return ALL_UNKNOWN
        return frozenset(map(Unknown, texts(self.look().get("unknown"))))

    def hang_up(self) -> None:
        """Disconnect from any thread; the driver host detects the loss and stops the machine for good."""
        self._link.hang_up()

    def close(self) -> None:
        """Close the connection, which ends the driver host."""
        self._link.close()


# --- Two links to the driver host: within one thread, and by a socket.


_QUICK = 0.5  # Seconds for a reply; the driver host needs milliseconds.
_AT_ONCE = 0.05  # Maximum in s that one wait counts, so that a delay of this process is not counted.
# Seconds for commands that wait for a drive; clearing a fault may configure a complete bus.
_SLOW = {"enable": 5.0, "home": 5.0, "clear_fault": 15.0}
_CHUNK = 1 << 16


class LoopLink:
    """Link to a driver host in the same thread that uses the same bytes, for tests and headless runs."""

    files = ()  # Its end is always detected.

    def __init__(self, host: DriverHost) -> None:
        self._host = host

    def ask(self, message: Message) -> Message:
        """Run one cycle of the driver host, then encode, handle and decode the message."""
        self._host.tick()
        (request,) = Inbox().feed(packed(message))
        (answer,) = Inbox().feed(packed(self._host.handle(request)))
        return answer

    def hang_up(self) -> None:
        """Mark the driver host as orphaned."""
        self._host.orphaned = True

    def close(self) -> None:
        """Mark the driver host as orphaned."""
        self.hang_up()


class SocketLink:
    """Link to a driver host in its own process, with one request at a time and a time limit for each."""

    def __init__(self, sock: socket.socket) -> None:
        self._socket = sock
        self._socket.setblocking(True)
        self._inbox = Inbox()

    @property
    def files(self) -> tuple[int, ...]:
        """The file of the socket, which becomes readable when the driver host ends."""
        return (self._socket.fileno(),)

    def ask(self, message: Message) -> Message:
        """Send a request and return the reply. Raises DriverError after a loss or a timeout."""
        limit = _SLOW.get(text(message.head, "what"), _QUICK)
        try:
            self._socket.settimeout(limit)
            self._socket.sendall(packed(message))
            return self._answer(limit)
        except TimeoutError as error:
            raise DriverError(
                "no response from the driver host for {seconds} s; the axes stop on their path",
                "feeder-silent",
                seconds=f"{limit:g}",
            ) from error
        except OSError as error:
            raise DriverError(
                "the driver host has ended ({cause})", "feeder-gone", cause=error.strerror
            ) from error

    def hang_up(self) -> None:
        """Shut down both directions, even while another thread waits for a reply."""
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Disconnect and close the socket; the driver host then stops the machine."""
        self.hang_up()
        self._socket.close()

    def _answer(self, left: float) -> Message:
        while left > 0.0:
            began = time.monotonic()
            ready, _, _ = select.select([self._socket], [], [], min(left, _AT_ONCE))
            left -= min(time.monotonic() - began, _AT_ONCE)
            if not ready:
                continue
            data = self._socket.recv(_CHUNK)
            if not data:
                raise DriverError("the driver host has ended", "feeder-gone")
            for message in self._inbox.feed(data):
                return message
        raise TimeoutError
