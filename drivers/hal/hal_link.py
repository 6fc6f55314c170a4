"""Connection to the bridge, with its last report; a silent or ended bridge is a fault."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import get_args

from core.ports import Clock, DriverError, Fault, FaultCode
from drivers.hal.bridge.packets import BridgeConfig, Head, number, pack, packets_of, text
from drivers.hal.hal_session import BridgeLink
from drivers.setpoint_pieces import Piece

_SILENT = 0.15  # Seconds without a report.
_AT_ONCE = 0.05  # Maximum silence in s that one check counts, so that a delay of this process is not counted.
_SETTLES = 0.5  # Seconds after which debounced inputs are valid.
_STARTS = 5.0  # Seconds for bus slaves to become operational after HAL was loaded.
_DOWN = 4.0  # Seconds for HAL to shut down, including its continuation after a crashed bridge.
_LOOK = 0.002  # Seconds between two checks during a wait.


class HalLink:
    """Connection to the bridge, used by one thread; ``open_link`` starts HAL and its bridge."""

    def __init__(
        self,
        open_link: Callable[[], BridgeLink],
        clock: Clock,
        bridge: BridgeConfig,
        idle: Callable[[], object] | None = None,
    ) -> None:
        self._open = open_link
        self._clock = clock
        self._axes = len(bridge.axes)
        self._bits = {name: n for n, name in enumerate(bridge.bits)}
        self._figures = {name: n for n, name in enumerate(bridge.figures)}
        self._idle = idle
        self._link: BridgeLink | None = None
        self._sent = 0
        self._reports = 0  # Number of reports of this bridge.
        self._looked, self._silent = 0.0, 0.0  # Time of the last check, and the silence at that time in s.
        self.told: Head = {}
        self.rows: list[Sequence[float]] = []  # Samples that have not been taken.
        self.lost: Fault | str = ""  # Reason why the connection is lost.
        self.worst = 0.0  # Maximum wake-up delay of the bridge in s.

    def connect(self) -> None:
        """Start HAL and wait for the first report. Raises DriverError."""
        if self._link is not None and not self._goes_down(self._link):
            raise DriverError("HAL is still shutting down; press Reset again in a few seconds", "hal-bridge")
        self.close()
        self.lost, self.rows, self._reports = "", [], 0
        try:
            self._link = self._open()
        except DriverError as error:
            self.lost = error.fault  # The next Reset tries again.
            raise
        self._looked, self._silent = self._clock.now(), 0.0
        if not self.wait(lambda: self._reports > 0, 3.0):
            raise DriverError("the HAL bridge does not send reports; restart TurnDesk", "hal-silent")
        self.wait(lambda: False, _SETTLES)
        self.wait(lambda: not self.is_stale, _STARTS)

    def _goes_down(self, link: BridgeLink) -> bool:
        """Return whether HAL has shut down after its bridge has ended, within 4 s."""
        end = self._clock.now() + _DOWN
        while not link.down and self._clock.now() < end:
            if self._idle is not None:
                self._idle()
            self._clock.sleep_until(self._clock.now() + _LOOK)
        return link.down

    def give_up(self) -> None:
        """End the bridge and HAL, for example after the servo thread has stopped."""
        if self._link is not None and not self.lost:
            self._link.hang_up()
            self.lost = Fault("HAL was shut down", "hal-thread")

    def pump(self) -> None:
        """Process received packets, without raising errors; a failure is stored in ``lost``."""
        if self._link is None or self.lost:
            return
        self._silent, self._looked = self.age, self._clock.now()
        try:
            for head, numbers in self._link.receive():
                self.told = head
                self._reports += 1
                self._silent = 0.0
                self.worst = max(self.worst, number(head, "late"))
                if len(numbers):
                    self.rows.append(numbers)
        except DriverError as error:
            self.lost = error.fault
        except (ValueError, struct.error):
            self.lost = Fault("the HAL bridge sent an invalid packet", "hal-silent")
            self._link.hang_up()

    @property
    def trouble(self) -> Fault | str:
        """The reason why the state of the machine is unknown, or an empty text."""
        silent = self.age
        if self.lost or silent <= _SILENT:
            return self.lost
        return Fault(
            "the HAL bridge has not sent a report for {silent} s", "hal-silent", silent=f"{silent:.2f}"
        )

    @property
    def blind(self) -> bool:
        """Whether the state of the machine is unknown because bridge, servo thread or board are silent."""
        return bool(self.trouble) or self.told.get("stands") is True or self.is_stale

    @property
    def is_stale(self) -> bool:
        """Whether HAL's inputs are old because the board is not reachable."""
        return self.told.get("stale") is True

    @property
    def input_age(self) -> float:
        """The age of the inputs in seconds, or inf while the board is not reachable."""
        return float("inf") if self.is_stale else self.age

    @property
    def age(self) -> float:
        """The seconds without a report while this side was listening, or inf after a loss."""
        return float("inf") if self.lost else self._silent + min(self._clock.now() - self._looked, _AT_ONCE)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The warnings of the present HAL session."""
        return self._link.warnings if self._link is not None else ()

    def beat(self) -> None:
        """Send a sign of life, unless the bridge is silent."""
        if not self.trouble:
            with suppress(DriverError):  # The loss is reported separately.
                self.say("beat")

    def say(self, what: str, **values: object) -> int:
        """Send a command and return its number, which the bridge later reports. Raises DriverError."""
        self._sent += 1
        self._send(pack({"do": what, "n": self._sent, **values}))
        return self._sent

    def say_pieces(self, what: str, pieces: Sequence[Piece], **values: object) -> None:
        """Send a command with setpoints. Raises DriverError."""
        self._sent += 1
        for data in packets_of({"do": what, "n": self._sent, **values}, pieces, self._axes):
            self._send(data)

    def done(self, order: int) -> bool:
        """Return whether the bridge has executed the command with this number."""
        return number(self.told, "n") >= order

    def wait(self, ready: Callable[[], bool], longest: float) -> bool:
        """Process packets until ``ready`` returns True; return False after ``longest`` seconds or a loss."""
        end = self._clock.now() + longest
        while not self.lost and self._clock.now() < end:
            self.pump()
            if ready():
                return True
            if self._idle is not None:
                self._idle()
            self._clock.sleep_until(self._clock.now() + _LOOK)
        return False

    def bit(self, name: str) -> bool:
        """Return a bit of the bridge by its pin; False for an unknown pin."""
        told, at = self.told.get("bits"), self._bits.get(name)
        return isinstance(told, list) and at is not None and told[at] is True

    def figure(self, name: str) -> float:
        """Return a number of the bridge by its pin; 0 for an unknown pin."""
        told, at = self.told.get("figures"), self._figures.get(name)
        return float(told[at]) if isinstance(told, list) and at is not None else 0.0

    def take_rows(self) -> Iterator[Sequence[float]]:
        """Remove and yield the received samples."""
        rows, self.rows = self.rows, []
        yield from rows

    def close(self) -> None:
        """Close the connection, upon which the bridge stops the machine and ends HAL."""
        if self._link is not None:
            self._link.close()
        self._link = None

    def _send(self, data: bytes) -> None:
        if self.lost or self._link is None:
            raise DriverError(
                self.lost or "the HAL bridge is not connected", reason="" if self.lost else "no-bridge"
            )
        try:
            self._link.send(data)
        except DriverError as error:
            if error.code != "hal-silent":
                self.lost = error.fault
            raise


def told_fault(told: Mapping[str, object]) -> Fault | str:
    """Return the fault that the bridge reports, or an empty text."""
    words = text(told, "fault")
    code: FaultCode = next((each for each in get_args(FaultCode) if each == told.get("code")), "axis")
    return Fault(words, code) if words else ""
