"""The other side of a program's line, scripted on a clock that moves only while somebody waits."""

from __future__ import annotations

from collections.abc import Callable

from drivers.serial_line import SerialLineError
from drivers.wakeups import ManualClock


class OtherSide:
    """``script``: (s, bytes) that come in. It takes bytes as fast as 9600 baud, but not within ``holds``."""

    def __init__(
        self,
        clock: ManualClock,
        script: list[tuple[float, bytes]] | None = None,
        holds: tuple[float, float] = (-1.0, -1.0),
        cut_at: float = float("inf"),
    ) -> None:
        self.clock, self.script, self.holds, self.cut_at = clock, list(script or ()), holds, cut_at
        self.taken = bytearray()
        self.damaged_character_count = 0
        self.closed = self.obeys = False
        self.largest = 0  # chunk
        self.before_listening: Callable[[], object] = lambda: None
        self._out = 0.0  # when the last byte will have gone out

    def send_available_bytes(self, data: bytes) -> int:
        self._look()
        if self._held:
            return 0
        self.largest = max(self.largest, len(data))
        self.taken += data
        self._out = self.clock.now() + len(data) / 960.0
        return len(data)

    def send(self, data: bytes) -> None:
        self.send_available_bytes(data)

    def receive(self, timeout_s: float) -> bytes:
        self.before_listening()
        self._look()
        until = self.clock.now() + timeout_s
        if self.script and self.script[0][0] <= until:
            at, data = self.script.pop(0)
            self.clock.sleep_until(at)
            return data
        self.clock.sleep_until(until)
        return b""

    def count_unsent_bytes(self) -> int:
        self._look()
        return max(0, round((self._out - self.clock.now()) * 960.0))

    def discard_output(self) -> None:
        self.taken = self.taken[: len(self.taken) - self.count_unsent_bytes()]
        self._out = self.clock.now()

    def enable_xon_xoff(self) -> None:
        self.obeys = True

    def discard_input(self) -> None:
        """Nothing is kept here."""

    def close(self) -> None:
        self.closed = True

    @property
    def _held(self) -> bool:
        return self.holds[0] <= self.clock.now() < self.holds[1]

    def _look(self) -> None:
        if self.clock.now() >= self.cut_at:
            raise SerialLineError("/dev/bench has failed: Input/output error")
