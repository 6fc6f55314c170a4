"""Agents of MTConnect: the socket at which they come in, what waits to be sent to each, and what it sends."""

from __future__ import annotations

import socket
import sys

from app.extras.mtconnect.driver.shdr_lines import PING, pong
from core.message import Message
from core.ports import DriverError

BEHIND = 64 * 1024  # bytes that may wait for a slow agent; at ten lines a second about a minute
READ = 1024  # bytes taken at a time: whoever sends more waits in its own buffers
LONGEST_LINE = 1024
_GRACE = 1.0  # s on top of two heartbeats
DOOR = 5.0  # s in which a newcomer to a full house has to ping


class LostError(Exception):
    """The agent is gone, or is given up; the sentence says why."""


class GoneError(LostError):
    """It went by itself, as agents do."""


class AgentLink:
    """On a wire that does not wait. ``heartbeat`` (s) is what the agent is told to ping at.

    ``waits_since`` (s): it came when all places were taken, and is told nothing; None: it is served.
    """

    def __init__(self, wire: socket.socket, heartbeat: float, waits_since: float | None = None) -> None:
        self.wire = wire
        self.waits_since = waits_since
        self.ignored = 0  # lines that were no PING
        self._heartbeat = heartbeat
        self._heard: float | None = None  # when it last pinged; None: it never did and need not
        self._in = b""
        self._out = bytearray()

    @property
    def pings(self) -> bool:
        """Whether it is an agent by its own word."""
        return self._heard is not None

    def put(self, data: bytes) -> None:
        """Queue it. Raises LostError for an agent that has not taken what was sent before."""
        if len(self._out) + len(data) > BEHIND:
            raise LostError(
                Message(
                    "the agent does not read its data: {out_count} bytes are waiting",
                    out_count=len(self._out),
                )
            )
        self._out += data

    def flush(self) -> None:
        """Send what the wire takes now; the rest waits for the next look. Raises LostError."""
        try:
            sent = self.wire.send(self._out)
        except BlockingIOError:
            return
        except OSError as error:
            raise GoneError(
                Message("the agent cannot be reached: {cause}", cause=error.strerror or error)
            ) from error
        del self._out[:sent]

    def read(self, now: float) -> None:
        """Take what has come; a PING is answered, everything else is only counted. Raises LostError."""
        try:
            come = self.wire.recv(READ)
        except BlockingIOError:
            return
        except OSError as error:
            raise GoneError(
                Message("the connection failed: {cause}", cause=error.strerror or error)
            ) from error
        if not come:
            raise GoneError("the agent closed the connection")
        *lines, self._in = (self._in + come).split(b"\n")
        for line in lines:
            self._obey(line.strip(), now)
        if len(self._in) > LONGEST_LINE:
            raise LostError("the agent sent data that is not a valid line")

    def _obey(self, line: bytes, now: float) -> None:
        if line == PING:
            self._heard = now
            self.put(pong(self._heartbeat))
        elif line:
            self.ignored += 1

    def mind(self, now: float) -> None:
        """Raises LostError for an agent that pinged and has stopped: its end of the line may be long gone.

        And for one that waits for a place and is none.
        """
        if self.waits_since is not None and now - self.waits_since > DOOR:
            raise GoneError("all connections are in use, and this agent does not send PING")
        if self._heard is not None and now - self._heard > 2.0 * self._heartbeat + _GRACE:
            raise LostError(Message("no PING from the agent for {now} s", now=f"{now - self._heard:.0f}"))


# --- The socket at which agents come in.


_BACKLOG = 4
_SEND = 64 * 1024  # bytes that the system may keep for a slow agent: what it reads is never hours old
_UNANSWERED = 30_000  # ms without a word of the other computer after which it counts as gone


def listening(bind: str, port: int) -> socket.socket:
    """Bound and listening. Raises DriverError with what is in the way."""
    try:
        family, kind, proto, _, address = socket.getaddrinfo(
            bind, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        wire = socket.socket(family, kind, proto)
    except OSError as error:
        raise DriverError(
            Message(
                "[mtconnect] bind = {bind} is not an address of this computer: {cause}",
                bind=f"{bind!r}",
                cause=error.strerror,
            )
        ) from error
    try:
        if sys.platform != "win32":  # elsewhere this would share a port that somebody else has
            wire.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        wire.bind(address)
        wire.listen(_BACKLOG)
    except OSError as error:
        wire.close()
        raise DriverError(
            Message(
                "[mtconnect] port {port} of {bind} cannot be opened ({cause}): choose another "
                "port, or end the program that uses this port",
                bind=bind,
                port=port,
                cause=error.strerror,
            )
        ) from error
    wire.setblocking(False)
    return wire


def accepted(door: socket.socket) -> socket.socket:
    """Who is at the door, not waiting for it. Raises OSError where nobody is there any more."""
    wire, _ = door.accept()
    try:
        _tune(wire)
    except OSError:
        wire.close()
        raise
    return wire


def _tune(wire: socket.socket) -> None:
    """The other end may vanish without a word, and lines go out at once."""
    wire.setblocking(False)
    wire.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    wire.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    wire.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND)
    if hasattr(socket, "TCP_USER_TIMEOUT"):
        wire.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, _UNANSWERED)
    if hasattr(socket, "TCP_KEEPIDLE"):
        for option, value in ((socket.TCP_KEEPIDLE, 10), (socket.TCP_KEEPINTVL, 5), (socket.TCP_KEEPCNT, 4)):
            wire.setsockopt(socket.IPPROTO_TCP, option, value)
