"""Two ways to the feeder: a socket to its process, or the same messages within one thread."""

from __future__ import annotations

import select
import socket
import time
from contextlib import suppress

from core.message import Message as Text
from core.ports import DriverError
from drivers.feeder.feeder_messages import Inbox, Message, packed, text
from drivers.feeder.feeder_server import Feeder

_QUICK = 0.5  # s for an answer; the feeder's loop takes milliseconds
_AT_ONCE = 0.05  # s that one look counts of it at most: who stood still himself blames nobody
# s for orders that wait for a drive; a fault that is cleared may mean to configure all of a bus
_SLOW = {"enable": 5.0, "home": 5.0, "clear_fault": 15.0}
_CHUNK = 1 << 16


class LoopLink:
    """The feeder in the same thread, by the same bytes as over the socket: for tests and headless runs."""

    files = ()  # it cannot end unseen

    def __init__(self, feeder: Feeder) -> None:
        self._feeder = feeder

    def ask(self, message: Message) -> Message:
        """There and back as bytes; the feeder's loop goes round before."""
        self._feeder.tick()
        (request,) = Inbox().feed(packed(message))
        (answer,) = Inbox().feed(packed(self._feeder.handle(request)))
        return answer

    def hang_up(self) -> None:
        """The control has gone."""
        self._feeder.orphaned = True

    def close(self) -> None:
        """The same."""
        self.hang_up()


class SocketLink:
    """A feeder in its own process. One request at a time, each answered within its time or never."""

    def __init__(self, sock: socket.socket) -> None:
        self._socket = sock
        self._socket.setblocking(True)
        self._inbox = Inbox()

    @property
    def files(self) -> tuple[int, ...]:
        """Readable when the feeder has ended."""
        return (self._socket.fileno(),)

    def ask(self, message: Message) -> Message:
        """Raises DriverError when the feeder has gone or does not answer in time."""
        limit = _SLOW.get(text(message.head, "what"), _QUICK)
        try:
            self._socket.settimeout(limit)
            self._socket.sendall(packed(message))
            return self._answer(limit)
        except TimeoutError as error:
            raise DriverError(
                Text(
                    "no response from the driver host for {seconds} s; the axes stop on their path",
                    seconds=f"{limit:g}",
                ),
                "feeder-silent",
            ) from error
        except OSError as error:
            raise DriverError(
                Text("the driver host has ended ({cause})", cause=error.strerror), "feeder-gone"
            ) from error

    def hang_up(self) -> None:
        """Both directions end, whoever waits on it."""
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """The feeder sees the end and stops what is left; who waits for its answer waits no longer."""
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
