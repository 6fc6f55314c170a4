"""Agents of MTConnect: the lines of SHDR that they read, what waits for each, and the socket they come in by.

The lines are as the reference agent reads them: ``time|key|value|key|value``; a condition stands alone.
Source of the rules: the C++ agent's tokenizer, token mapper and adapter. There is no escaping in them.
"""

from __future__ import annotations

import re
import socket
import sys
from collections.abc import Iterator, Mapping
from datetime import datetime
from typing import NamedTuple

from app.extras.mtconnect.driver.mtconnect_items import Category, DataItem
from core.message import Message
from core.ports import DriverError

UNAVAILABLE = "UNAVAILABLE"
NORMAL = "NORMAL"
PING = b"* PING"
LONGEST = 256  # characters of a value; a block of a program may be any length
_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f\ufffe\uffff]+")
_LONGEST_BEAT = 30 * 60 * 1000 - 1  # ms; the agent wants less than half an hour

Value = str | float | None  # None: not known


class Active(NamedTuple):
    """A condition that is not normal: ``level`` is WARNING or FAULT, ``code`` tells it from its like."""

    level: str
    code: str
    text: str


class Report(NamedTuple):
    """The machine at one instant: value of each sample and event, and what is active of each condition.

    A key that is missing is not known.
    """

    values: Mapping[str, Value]
    conditions: Mapping[str, tuple[Active, ...]]


def stamp(at: datetime) -> str:
    """UTC as the agent reads it, in milliseconds."""
    return at.isoformat(timespec="milliseconds").replace("+00:00", "Z")


def pong(heartbeat: float) -> bytes:
    """The answer to a PING; ``heartbeat`` in s. The agent takes whole ms from 1 to under half an hour."""
    return b"* PONG %d\n" % min(max(round(1000 * heartbeat), 1), _LONGEST_BEAT)


def text_of(item: DataItem, value: Value) -> str:
    """A value as text."""
    if value is None:
        return UNAVAILABLE
    if isinstance(value, str):
        return clean(value)
    return f"{round(value, item.digits) + 0.0:.{item.digits}f}"


def clean(text: str) -> str:
    """Text that stays one value: what the agent would take for a separator or a quotation is replaced.

    A quotation mark at the beginning and ``--multiline--`` anywhere would swallow what follows.
    """
    text = _CONTROL.sub(" ", text).replace("|", "/").replace("--multiline--", "- multiline -")
    text = text.encode("utf-8", "replace").decode("utf-8")[:LONGEST].strip()
    return "'" + text[1:] if text.startswith('"') else text


def values_line(at: str, pairs: Mapping[str, str]) -> str:
    """Samples and events of one instant."""
    return "|".join((at, *(part for pair in pairs.items() for part in pair))) + "\n"


def active_line(at: str, key: str, active: Active) -> str:
    """A condition becomes active, or its text changes; severity and qualifier are left empty."""
    return f"{at}|{key}|{active.level}|{clean(active.code)}|||{clean(active.text)}\n"


def cleared_line(at: str, key: str, code: str = "") -> str:
    """One code of a condition is over; without one the condition is normal."""
    return f"{at}|{key}|{NORMAL}|{clean(code)}|||\n"


def unknown_line(at: str, key: str) -> str:
    """Nobody knows how it stands with a condition."""
    return f"{at}|{key}|{UNAVAILABLE}||||\n"


# --- What has been told, so that only what has changed is told again.


Conditions = dict[str, tuple[Active, ...] | None]  # None: not known


class AgentsState:
    """The state of the machine as every agent that is connected has it."""

    def __init__(self, items: tuple[DataItem, ...]) -> None:
        self._values = {item.key: item for item in items if item.category is not Category.CONDITION}
        self._conditions: Conditions = {
            item.key: None for item in items if item.category is Category.CONDITION
        }
        self._last: dict[str, Value] = dict.fromkeys(self._values)
        self._shown = dict.fromkeys(self._values, UNAVAILABLE)

    def whole(self, at: str) -> str:
        """Everything, for an agent that has just come."""
        lines = [values_line(at, self._shown)]
        for key, active in self._conditions.items():
            lines += _whole_condition(at, key, active)
        return "".join(lines)

    def changes(self, report: Report, at: str) -> str:
        """What is new in a report; it counts as told from now on."""
        new = dict(self._new_values(report))
        lines = [values_line(at, new)] if new else []
        for key, before in self._conditions.items():
            now = report.conditions.get(key)
            if now != before:
                lines += _changed_condition(at, key, before, now)
                self._conditions[key] = now
        return "".join(lines)

    def _new_values(self, report: Report) -> Iterator[tuple[str, str]]:
        for key, item in self._values.items():
            value = report.values.get(key)
            if not _differs(item, self._last[key], value):
                continue
            self._last[key] = value
            text = text_of(item, value)
            if text != self._shown[key]:
                self._shown[key] = text
                yield key, text


def _differs(item: DataItem, before: Value, now: Value) -> bool:
    """A sample by more than its band; standing still and everything else at once."""
    if isinstance(before, str) or isinstance(now, str) or before is None or now is None:
        return before != now
    if now == 0.0 or before == 0.0:
        return now != before
    return abs(now - before) > item.band + item.share * abs(before)


def _whole_condition(at: str, key: str, active: tuple[Active, ...] | None) -> list[str]:
    if active is None:
        return [unknown_line(at, key)]
    return [active_line(at, key, each) for each in active] or [cleared_line(at, key)]


def _changed_condition(
    at: str, key: str, before: tuple[Active, ...] | None, now: tuple[Active, ...] | None
) -> list[str]:
    """New and changed ones first, then those that are over."""
    if not now or before is None:
        return _whole_condition(at, key, now)
    codes = {each.code for each in now}
    lines = [active_line(at, key, each) for each in now if each not in before]
    return lines + [cleared_line(at, key, each.code) for each in before if each.code not in codes]


BEHIND = 64 * 1024  # bytes that may wait for a slow agent; at ten lines a second about a minute
READ = 1024  # bytes taken at a time: whoever sends more waits in its own buffers
LONGEST_LINE = 1024
# --- An agent: what waits to be sent to it, and what it sends.


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
            "[mtconnect] bind = {bind} is not an address of this computer: {cause}",
            bind=f"{bind!r}",
            cause=error.strerror,
        ) from error
    try:
        if sys.platform != "win32":  # elsewhere this would share a port that somebody else has
            wire.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        wire.bind(address)
        wire.listen(_BACKLOG)
    except OSError as error:
        wire.close()
        raise DriverError(
            "[mtconnect] port {port} of {bind} cannot be opened ({cause}): choose another "
            "port, or end the program that uses this port",
            bind=bind,
            port=port,
            cause=error.strerror,
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
