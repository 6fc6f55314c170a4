"""Connections to MTConnect agents: SHDR lines, unsent data per agent, and the listening socket.

Lines have the form ``time|key|value|key|value``, as the reference agent in C++ expects them. Each condition
is on a separate line. SHDR has no escape characters.
"""

from __future__ import annotations

import re
import socket
import sys
from collections.abc import Iterator, Mapping
from datetime import datetime
from typing import NamedTuple

from app.extras.mtconnect.driver.mtconnect_items import DataItem, DataItemCategory
from core.message import Message
from core.ports import DriverError

UNAVAILABLE = "UNAVAILABLE"
NORMAL_LEVEL = "NORMAL"
PING_COMMAND = b"* PING"
MAX_VALUE_LENGTH = 256  # characters of a value; a program block can have any length
_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f\ufffe\uffff]+")
_LONGEST_BEAT = 30 * 60 * 1000 - 1  # ms; the agent requires less than half an hour

ItemValue = str | float | None  # None: not known


class ActiveCondition(NamedTuple):
    """Active MTConnect condition.

    ``condition_level`` is WARNING or FAULT, and ``native_code`` identifies the condition.
    """

    condition_level: str
    native_code: str
    condition_text: str


class MachineReport(NamedTuple):
    """Machine state at one point in time: values of samples and events, and active conditions.

    If a key is missing, its value is not known.
    """

    item_values: Mapping[str, ItemValue]
    active_conditions: Mapping[str, tuple[ActiveCondition, ...]]


def format_utc_time(time: datetime) -> str:
    """Return a UTC time in the format of the agent, with a resolution of milliseconds."""
    return time.isoformat(timespec="milliseconds").replace("+00:00", "Z")


def make_pong_reply(heartbeat_s: float) -> bytes:
    """Return the PONG line that replies to the PING of an agent. ``heartbeat_s`` is in seconds.

    The reply contains the heartbeat in milliseconds, limited to the range from 1 ms to just under half an
    hour.
    """
    return b"* PONG %d\n" % min(max(round(1000 * heartbeat_s), 1), _LONGEST_BEAT)


def format_value(item: DataItem, value: ItemValue) -> str:
    """Return the value of a data item as text for an SHDR line."""
    if value is None:
        return UNAVAILABLE
    if isinstance(value, str):
        return replace_separators(value)
    return f"{round(value, item.decimal_places) + 0.0:.{item.decimal_places}f}"


def replace_separators(text: str) -> str:
    """Return the text with separators and quotation marks replaced, so that an agent reads one value.

    Otherwise, after a leading quotation mark or ``--multiline--``, an agent would treat the data that
    follow as part of the value.
    """
    text = _CONTROL.sub(" ", text).replace("|", "/").replace("--multiline--", "- multiline -")
    text = text.encode("utf-8", "replace").decode("utf-8")[:MAX_VALUE_LENGTH].strip()
    return "'" + text[1:] if text.startswith('"') else text


def make_values_line(time_text: str, pairs: Mapping[str, str]) -> str:
    """Return the SHDR line with the values of samples and events at one point in time."""
    return "|".join((time_text, *(part for pair in pairs.items() for part in pair))) + "\n"


def make_active_condition_line(time_text: str, key: str, active_condition: ActiveCondition) -> str:
    """Return the SHDR line for a condition that becomes active or changes its text.

    The fields for severity and qualifier are empty.
    """
    return (
        f"{time_text}|{key}|{active_condition.condition_level}|{replace_separators(active_condition.native_code)}|||"
        f"{replace_separators(active_condition.condition_text)}\n"
    )


def make_cleared_condition_line(time_text: str, key: str, code: str = "") -> str:
    """Return the SHDR line that clears one native code of a condition.

    If ``code`` is empty, the line clears the whole condition.
    """
    return f"{time_text}|{key}|{NORMAL_LEVEL}|{replace_separators(code)}|||\n"


def make_unknown_condition_line(time_text: str, key: str) -> str:
    """Return the SHDR line for a condition whose state is not known."""
    return f"{time_text}|{key}|{UNAVAILABLE}||||\n"


# --- Sent values, so that only changes are sent. --------------------


ConditionsByItem = dict[str, tuple[ActiveCondition, ...] | None]  # None: not known


class SentMachineState:
    """Machine state that all connected agents have received."""

    def __init__(self, items: tuple[DataItem, ...]) -> None:
        self._values = {item.key: item for item in items if item.category is not DataItemCategory.CONDITION}
        self._conditions: ConditionsByItem = {
            item.key: None for item in items if item.category is DataItemCategory.CONDITION
        }
        self._last: dict[str, ItemValue] = dict.fromkeys(self._values)
        self._shown = dict.fromkeys(self._values, UNAVAILABLE)

    def make_complete_state_lines(self, time: str) -> str:
        """Return the SHDR lines with the complete state for a newly connected agent."""
        lines = [make_values_line(time, self._shown)]
        for key, active in self._conditions.items():
            lines += _whole_condition(time, key, active)
        return "".join(lines)

    def make_change_lines(self, report: MachineReport, time: str) -> str:
        """Return SHDR lines with the changes in a report, and store the changed values as sent."""
        new = dict(self._new_values(report))
        lines = [make_values_line(time, new)] if new else []
        for key, before in self._conditions.items():
            now = report.active_conditions.get(key)
            if now != before:
                lines += _changed_condition(time, key, before, now)
                self._conditions[key] = now
        return "".join(lines)

    def _new_values(self, report: MachineReport) -> Iterator[tuple[str, str]]:
        for key, item in self._values.items():
            value = report.item_values.get(key)
            if not _differs(item, self._last[key], value):
                continue
            self._last[key] = value
            text = format_value(item, value)
            if text != self._shown[key]:
                self._shown[key] = text
                yield key, text


def _differs(item: DataItem, before: ItemValue, now: ItemValue) -> bool:
    """Return whether a value has changed enough to be sent.

    A sample must change by more than its minimum change, except for a change from or to 0.
    """
    if isinstance(before, str) or isinstance(now, str) or before is None or now is None:
        return before != now
    if now == 0.0 or before == 0.0:
        return now != before
    return abs(now - before) > item.minimum_change + item.min_relative_change * abs(before)


def _whole_condition(at: str, key: str, active: tuple[ActiveCondition, ...] | None) -> list[str]:
    if active is None:
        return [make_unknown_condition_line(at, key)]
    return [make_active_condition_line(at, key, each) for each in active] or [
        make_cleared_condition_line(at, key)
    ]


def _changed_condition(
    time: str, key: str, before: tuple[ActiveCondition, ...] | None, now: tuple[ActiveCondition, ...] | None
) -> list[str]:
    """Return the SHDR lines of a condition: new and changed codes first, then cleared codes."""
    if not now or before is None:
        return _whole_condition(time, key, now)
    codes = {each.native_code for each in now}
    lines = [make_active_condition_line(time, key, each) for each in now if each not in before]
    return lines + [
        make_cleared_condition_line(time, key, each.native_code)
        for each in before
        if each.native_code not in codes
    ]


MAX_UNSENT_BYTES = 64 * 1024  # bytes that may wait for a slow agent; about one minute at ten lines per second
READ_BYTES = 1024  # bytes per read; a faster sender waits in its own buffers
MAX_LINE_LENGTH = 1024
# --- Agent: data to be sent to it, and data received from it.


_GRACE = 1.0  # seconds in addition to two heartbeats
PING_TIMEOUT_S = 5.0  # seconds within which an additional agent must send PING


class AgentLostError(Exception):
    """Error raised if an agent has disconnected or does not respond.

    The message states the reason.
    """


class AgentDisconnectedError(AgentLostError):
    """Error raised if the connection to an agent is closed."""


class AgentLink:
    """Connection to an agent on a non-blocking socket.

    ``heartbeat_s`` is the requested PING interval in seconds. ``waiting_since`` is None if the agent
    receives data. Otherwise it is the time in seconds since which the agent has waited for a free
    connection.
    """

    def __init__(
        self, agent_socket: socket.socket, heartbeat_s: float, waiting_since: float | None = None
    ) -> None:
        self.agent_socket = agent_socket
        self.waiting_since = waiting_since
        self.ignored_line_count = 0  # received lines other than PING
        self._heartbeat = heartbeat_s
        self._heard: float | None = None  # time of the last PING; None if the agent has never sent one
        self._in = b""
        self._out = bytearray()

    @property
    def has_pinged(self) -> bool:
        """Return whether the agent has sent a PING."""
        return self._heard is not None

    def queue_data(self, data: bytes) -> None:
        """Queue data for the agent.

        Raises AgentLostError if too much unsent data is already queued.
        """
        if len(self._out) + len(data) > MAX_UNSENT_BYTES:
            raise AgentLostError(
                Message(
                    "the agent does not read its data: {out_count} bytes are waiting",
                    out_count=len(self._out),
                )
            )
        self._out += data

    def flush(self) -> None:
        """Send as much queued data as the socket accepts.

        Raises AgentLostError if the connection fails.
        """
        try:
            sent = self.agent_socket.send(self._out)
        except BlockingIOError:
            return
        except OSError as error:
            raise AgentDisconnectedError(
                Message("the agent cannot be reached: {cause}", cause=error.strerror or error)
            ) from error
        del self._out[:sent]

    def read_data(self, now_s: float) -> None:
        """Read received data, reply to each PING, and count all other lines as ignored.

        Raises AgentLostError if the connection ends, if a line is longer than ``MAX_LINE_LENGTH`` bytes, or
        if too much unsent data is queued to add the reply.
        """
        try:
            come = self.agent_socket.recv(READ_BYTES)
        except BlockingIOError:
            return
        except OSError as error:
            raise AgentDisconnectedError(
                Message("the connection failed: {cause}", cause=error.strerror or error)
            ) from error
        if not come:
            raise AgentDisconnectedError("the agent closed the connection")
        *lines, self._in = (self._in + come).split(b"\n")
        for line in lines:
            self._obey(line.strip(), now_s)
        if len(self._in) > MAX_LINE_LENGTH:
            raise AgentLostError("the agent sent data that is not a valid line")

    def _obey(self, line: bytes, now: float) -> None:
        if line == PING_COMMAND:
            self._heard = now
            self.queue_data(make_pong_reply(self._heartbeat))
        elif line:
            self.ignored_line_count += 1

    def check_timeout(self, now_s: float) -> None:
        """Raise AgentLostError if the next PING of the agent is overdue.

        A PING is overdue if the agent has stopped sending PING, or if the agent waits for a free connection
        and has never sent one.
        """
        if self.waiting_since is not None and now_s - self.waiting_since > PING_TIMEOUT_S:
            raise AgentDisconnectedError("all connections are in use, and this agent does not send PING")
        if self._heard is not None and now_s - self._heard > 2.0 * self._heartbeat + _GRACE:
            raise AgentLostError(
                Message("no PING from the agent for {now} s", now=f"{now_s - self._heard:.0f}")
            )


# --- Listening socket. -----------------


_BACKLOG = 4
_SEND = 64 * 1024  # bytes that the system buffers for a slow agent, so that its data is not outdated
_UNANSWERED = 30_000  # ms without a response after which the other computer counts as gone


def open_listening_socket(bind_address: str, port: int) -> socket.socket:
    """Return a bound, listening socket.

    Raises DriverError if the socket cannot be opened.
    """
    try:
        family, kind, proto, _, address = socket.getaddrinfo(
            bind_address, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        wire = socket.socket(family, kind, proto)
    except OSError as error:
        raise DriverError(
            "[mtconnect] bind = {bind} is not an address of this computer: {cause}",
            bind=f"{bind_address!r}",
            cause=error.strerror,
        ) from error
    try:
        if sys.platform != "win32":  # On Windows, this option would share a port with another program.
            wire.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        wire.bind(address)
        wire.listen(_BACKLOG)
    except OSError as error:
        wire.close()
        raise DriverError(
            "[mtconnect] port {port} of {bind} cannot be opened ({cause}): choose another "
            "port, or end the program that uses this port",
            bind=bind_address,
            port=port,
            cause=error.strerror,
        ) from error
    wire.setblocking(False)
    return wire


def accept_connection(listener: socket.socket) -> socket.socket:
    """Accept a connection without waiting, and return its socket.

    Raises BlockingIOError if no connection is waiting, or another OSError if the peer has disconnected.
    """
    wire, _ = listener.accept()
    try:
        _tune(wire)
    except OSError:
        wire.close()
        raise
    return wire


def _tune(wire: socket.socket) -> None:
    """Configure a socket to detect a lost peer and to send lines without delay."""
    wire.setblocking(False)
    wire.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    wire.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    wire.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND)
    if hasattr(socket, "TCP_USER_TIMEOUT"):
        wire.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, _UNANSWERED)
    if hasattr(socket, "TCP_KEEPIDLE"):
        for option, value in ((socket.TCP_KEEPIDLE, 10), (socket.TCP_KEEPINTVL, 5), (socket.TCP_KEEPCNT, 4)):
            wire.setsockopt(socket.IPPROTO_TCP, option, value)
