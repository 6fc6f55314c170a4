"""An agent as the C++ one behaves on its side of the line, as far as an adapter can tell.

It knows the items from ``Devices.xml``, pings, takes the interval from the PONG, hangs up after two of them
in silence, reads nothing behind a condition, unquotes, and swallows ``--multiline--``.
"""

from __future__ import annotations

import select
import socket
from dataclasses import dataclass, field
from xml.etree import ElementTree

from app.extras.mtconnect.driver.mtconnect_adapter import SCHEMA_NAMESPACE
from core.ports import Clock

UNAVAILABLE = "UNAVAILABLE"


@dataclass
class FakeAgent:
    """``values`` and ``active`` are what it would show at /current."""

    model: str
    clock: Clock
    receive: int = 0  # bytes that its computer keeps for it; 0: as many as it likes
    values: dict[str, str] = field(default_factory=dict)
    active: dict[str, dict[str, tuple[str, str]] | None] = field(default_factory=dict)
    unknown: list[str] = field(default_factory=list)
    bad: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)
    interval: float | None = None
    _rest: bytes = field(default=b"", init=False)  # of a line that has not come whole

    def __post_init__(self) -> None:
        self.kinds = kinds_of(self.model)
        self.wire: socket.socket | None = None
        self._forget()

    def connect(self, address: tuple[str, int]) -> None:
        """Come in and ping."""
        self.wire = socket.socket()
        if self.receive:
            self.wire.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, self.receive)
        self.wire.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)  # as the C++ agent does
        self.wire.settimeout(60.0)
        self.wire.connect(address)
        self.send(b"* PING\n")
        self._heard = self._pinged = self.clock.now()

    def send(self, data: bytes) -> None:
        """Whatever an agent, or somebody else, says."""
        assert self.wire is not None
        self.wire.sendall(data)

    def read(self) -> None:
        """Take what is there; hang up when the adapter has, or is silent for too long."""
        if self.wire is None:
            return
        if select.select([self.wire], [], [], 0.0)[0]:
            come = self._received(self.wire)
            if not come:
                self.hang_up()
                return
            self._heard = self.clock.now()
            *lines, self._rest = (self._rest + come).split(b"\n")
            for line in lines:
                self.hear(line.decode("utf-8").rstrip())
        self._beat()

    def hang_up(self) -> None:
        """The connection is over: nothing is known any more."""
        if self.wire is not None:
            self.wire.close()
        self.wire = None
        self._forget()

    def _received(self, wire: socket.socket) -> bytes:
        try:
            return wire.recv(65536)
        except ConnectionError:
            return b""

    def _forget(self) -> None:
        self._rest, self._swallowing, self.interval = b"", "", None
        self._heard = self._pinged = 0.0
        self.values = {key: UNAVAILABLE for key, kind in self.kinds.items() if kind != "CONDITION"}
        self.active = {key: None for key, kind in self.kinds.items() if kind == "CONDITION"}

    def _beat(self) -> None:
        now = self.clock.now()
        if self.wire is None or self.interval is None:
            return
        if now - self._heard > 2.0 * self.interval:
            self.hang_up()
        elif now - self._pinged >= self.interval:
            self._pinged = now
            self.send(b"* PING\n")

    def hear(self, line: str) -> None:
        """One line."""
        self.lines.append(line)
        if self._swallowing:
            self._swallowing = "" if line == self._swallowing else self._swallowing
        elif "--multiline--" in line:
            self._swallowing = line[line.index("--multiline--") :]
        elif line.startswith("* PONG"):
            self._pong(line)
        elif line and not line.startswith("*"):
            self._observe(tokens(line))

    def _pong(self, line: str) -> None:
        """Only the first counts, and only with a time of less than half an hour."""
        ms = int(line[7:]) if line[6:7] == " " and line[7:].isdigit() else 0
        if self.interval is None and 0 < ms < 30 * 60 * 1000:
            self.interval = ms / 1000
        elif not 0 < ms < 30 * 60 * 1000:
            self.bad.append(line)

    def _observe(self, parts: list[str]) -> None:
        at = 1
        while at < len(parts):
            key, kind = parts[at], self.kinds.get(parts[at])
            if kind is None:
                self.unknown.append(key)
                at += 2
            elif kind == "CONDITION":
                self._condition(key, parts[at + 1 : at + 6])
                return  # more than two tokens: the rest of the line is dropped
            else:
                self._value(key, kind, parts[at + 1] if at + 1 < len(parts) else UNAVAILABLE)
                at += 2

    def _value(self, key: str, kind: str, text: str) -> None:
        if kind == "SAMPLE" and text != UNAVAILABLE and not _is_number(text):
            self.bad.append(f"{key}|{text}")
        self.values[key] = text

    def _condition(self, key: str, parts: list[str]) -> None:
        level, code, _severity, _qualifier, text = (parts + [""] * 5)[:5]
        if level == UNAVAILABLE:
            self.active[key] = None
        elif level == "NORMAL":
            left = dict(self.active[key] or {}) if code else {}
            left.pop(code, None)
            self.active[key] = left
        elif level in {"WARNING", "FAULT"}:
            self.active[key] = {**(self.active[key] or {}), code: (level, text)}
        else:
            self.bad.append(f"{key}|{level}")


def kinds_of(model: str) -> dict[str, str]:
    """Category by name, of all items of a device model."""
    items = ElementTree.fromstring(model).iter(f"{{{SCHEMA_NAMESPACE}}}DataItem")
    return {item.attrib["name"]: item.attrib["category"] for item in items}


def tokens(line: str) -> list[str]:
    """Fields without blanks around them; one in quotation marks ends at the second, whatever follows."""
    found: list[str] = []
    while True:
        line = line.lstrip()
        if line.startswith('"') and '"' in line[1:]:
            end = line.index('"', 1)
            found.append(line[1:end])
            line = line[end + 1 :].lstrip().removeprefix("|")
            if not line:
                return found
            continue
        field, bar, line = line.partition("|")
        found.append(field.rstrip())
        if not bar:
            return found


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
