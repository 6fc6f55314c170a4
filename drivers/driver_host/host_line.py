"""The line to the driver host, by a socket to its process or within one thread: requests, answers, its last
look.

A driver host that is gone is a fault.
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
_FRESH = 0.002  # s for which one look serves all ports
_RESTS = 0.02  # s for which it does while the control sleeps: one tick, and what is new rings
_BATCHES = 200  # of samples that wait for whoever records them


class Link(Protocol):
    """Carries a request to the driver host and its answer back; ``files`` are what can be waited for."""

    @property
    def files(self) -> Sequence[int]: ...

    def ask(self, message: Message) -> Message:
        """Raises DriverError when there is no answer."""
        ...

    def hang_up(self) -> None:
        """From any thread: nothing is said or heard any more."""
        ...

    def close(self) -> None: ...


def cleared(link: Link) -> Link:
    """The Reset that has asked for another driver host is meant for its drives too. Raises DriverError."""
    answer = link.ask(Message({"do": "do", "what": "clear_fault"}, NOTHING))
    if why := fault_of(answer.head, "error", "driver"):
        raise DriverError(why)
    return link


class Line:
    """Requests in words, and the last look at everything.

    ``again`` begins to start another driver host in the place of one that is gone: there is no other way
    back. ``bell`` is rung by the driver host too, while the control sleeps.
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
        self._asleep = self._sleeps = False  # as the driver host has been told, and as the next look says
        self.fault: Fault | str = ""  # why the driver host cannot be asked any more
        self._state: Mapping[str, object] = {}
        self._at = -1.0
        self._posted: queue.SimpleQueue[Message] = queue.SimpleQueue()
        self.sampled: deque[FloatArray] = deque(maxlen=_BATCHES)  # since they were last taken

    def ask(self, message: Message) -> Message:
        """The answer. Raises DriverError with what the drivers refuse, or that the driver host is gone."""
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
        """Something that changes the machine; the next look is a new one."""
        self._at = -1.0
        self.ask(Message({"do": "do", "what": what, **values}, NOTHING))

    def post(self, message: Message) -> None:
        """From any thread: goes out before the next look, unanswered."""
        self._posted.put(message)
        if self.bell is not None:
            self.bell.ring()

    def sleep(self) -> None:
        """Have the driver host ring for news until anything but a look is asked. Raises DriverError."""
        if not self._asleep:
            self.ask(Message({"do": "rest"}, NOTHING))
        self._asleep = self._sleeps = True

    def awake(self) -> None:
        """Looks come as ever, and the next one is a new one."""
        self._sleeps, self._at = False, -1.0

    @property
    def files(self) -> Sequence[int]:
        """Of the link: nothing comes there that is not asked for, but its end."""
        return self._link.files

    def look(self, *, anew: bool = False) -> Mapping[str, object]:
        """Everything that can be seen, of this tick; the last known when the driver host is gone."""
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
        """Whether there is no driver host to ask."""
        return self.fault != "" or self._opening is not None

    def restart(self) -> None:
        """Begin to start another driver host; why that fails is the next fault. Raises DriverError where
        there is none to start.
        """
        if self._again is None:
            words = Text("{fault}; restart TurnDesk", fault=self.fault)
            raise DriverError(words, code_of(self.fault, "feeder-gone"))
        self.fault, self._opening = "", self._again()

    def greet(self) -> Mapping[str, object]:
        """What the driver host says of itself. Raises DriverError for one of another version."""
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
        """What the drivers do not hear of; of a driver host that is gone nothing is known."""
        if self.lost:
            return ALL_UNKNOWN
        return frozenset(map(Unknown, texts(self.look().get("unknown"))))

    def hang_up(self) -> None:
        """From any thread: the driver host sees that its control is gone, and stops the machine for good."""
        self._link.hang_up()

    def close(self) -> None:
        """End it."""
        self._link.close()


# --- Two links to the driver host: within one thread, and by a socket.


_QUICK = 0.5  # s for an answer; the driver host's loop takes milliseconds
_AT_ONCE = 0.05  # s that one look counts of it at most: who stood still himself blames nobody
# s for orders that wait for a drive; a fault that is cleared may mean to configure all of a bus
_SLOW = {"enable": 5.0, "home": 5.0, "clear_fault": 15.0}
_CHUNK = 1 << 16


class LoopLink:
    """Calls the driver host in the same thread, with the bytes of the socket: for tests and headless runs."""

    files = ()  # it cannot end unseen

    def __init__(self, host: DriverHost) -> None:
        self._host = host

    def ask(self, message: Message) -> Message:
        """There and back as bytes; the driver host's loop goes round before."""
        self._host.tick()
        (request,) = Inbox().feed(packed(message))
        (answer,) = Inbox().feed(packed(self._host.handle(request)))
        return answer

    def hang_up(self) -> None:
        """The control has gone."""
        self._host.orphaned = True

    def close(self) -> None:
        """The same."""
        self.hang_up()


class SocketLink:
    """A driver host in its own process. One request at a time, each answered within its time or never."""

    def __init__(self, sock: socket.socket) -> None:
        self._socket = sock
        self._socket.setblocking(True)
        self._inbox = Inbox()

    @property
    def files(self) -> tuple[int, ...]:
        """Readable when the driver host has ended."""
        return (self._socket.fileno(),)

    def ask(self, message: Message) -> Message:
        """Raises DriverError when the driver host has gone or does not answer in time."""
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
        """Both directions end, whoever waits on it."""
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """The driver host sees the end and stops what is left; who waits for its answer waits no longer."""
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
