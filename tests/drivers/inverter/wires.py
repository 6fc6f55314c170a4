"""A line in process, on a clock that moves only while somebody waits: with every fault that cables have."""

from __future__ import annotations

from collections import deque
from typing import Protocol

from drivers.serial_line import SerialLineError
from drivers.wakeups import ManualClock


class UnexpectedError(Exception):
    """Nobody thought of it."""


class Slave(Protocol):
    """Whatever answers frames."""

    def answer(self, frame: bytes) -> bytes: ...


class BenchWire:
    """Each answer comes ``delay`` s after its request. ``loses`` so many answers, then it is well again."""

    def __init__(self, slave: Slave, clock: ManualClock) -> None:
        self.slave, self.clock = slave, clock
        self.delay = 0.02
        self.out = False
        self.silent = False
        self.loses = 0
        self.noise = b""  # before each answer
        self.spoils = False  # a bit of each answer falls over
        self.kills = False  # whoever talks over it ends
        self.sent: list[bytes] = []
        self.closed = 0
        self._coming: deque[tuple[float, bytes]] = deque()

    def opened(self) -> BenchWire:
        """As a port is opened. Raises WireError with the cable out."""
        if self.out:
            raise SerialLineError("/dev/bench cannot be opened: No such file or directory")
        return self

    def send(self, data: bytes) -> None:
        self._look()
        self.sent.append(data)
        if self.silent:
            return
        answer = self.slave.answer(data)
        if self.loses:
            self.loses -= 1
            return
        if self.spoils and answer:
            answer = answer[:3] + bytes((answer[3] ^ 4,)) + answer[4:]
        if answer or self.noise:
            self._coming.append((self.clock.now() + self.delay, self.noise + answer))

    def receive(self, timeout_s: float) -> bytes:
        self._look()
        until = self.clock.now() + timeout_s
        if self._coming and self._coming[0][0] <= until:
            at, data = self._coming.popleft()
            self.clock.sleep_until(at)
            return data
        self.clock.sleep_until(until)
        return b""

    @property
    def waits(self) -> bool:
        """Whether an answer is on its way."""
        return bool(self._coming)

    def discard_input(self) -> None:
        self._look()
        while self._coming and self._coming[0][0] <= self.clock.now():
            self._coming.popleft()

    def waiting(self) -> int:
        return 0

    def drop_output(self) -> None:
        """Nothing is kept here."""

    def close(self) -> None:
        self.closed += 1

    def _look(self) -> None:
        if self.kills:
            raise UnexpectedError
        if self.out:
            raise SerialLineError("/dev/bench has failed: Input/output error")
