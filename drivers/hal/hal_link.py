"""What the bridge has told last, and words to it; a bridge that is silent or gone is a fault."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import get_args

from core.ports import Clock, DriverError, Fault, FaultCode
from drivers.hal.bridge.packets import BridgeConfig, Head, number, pack, packets_of, text
from drivers.hal.hal_session import BridgeLink
from drivers.setpoint_pieces import Piece

_SILENT = 0.15  # s without a report
_AT_ONCE = 0.05  # s of silence that one look counts at most: who stood still himself blames nobody
_SETTLES = 0.5  # s after which debounced inputs tell the truth
_STARTS = 5.0  # s for the slaves of a bus to become operational after HAL was loaded
_DOWN = 4.0  # s in which HAL is taken down, what it goes on behind a bridge that has died among them
_LOOK = 0.002  # s between two looks while something is waited for


class HalLink:
    """One thread. ``open_link`` starts HAL and its bridge, and again after it was lost."""

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
        self._reports = 0  # of this bridge
        self._looked, self._silent = 0.0, 0.0  # when, and how long it had told nothing then, s
        self.told: Head = {}
        self.rows: list[Sequence[float]] = []  # samples that nobody has taken
        self.lost: Fault | str = ""  # why nothing can be said to it any more
        self.worst = 0.0  # s by which the bridge woke up too late, at most

    def connect(self) -> None:
        """Start it, and wait for its first report. Raises DriverError."""
        if self._link is not None and not self._goes_down(self._link):
            raise DriverError("HAL is still shutting down; press Reset again in a few seconds", "hal-bridge")
        self.close()
        self.lost, self.rows, self._reports = "", [], 0
        try:
            self._link = self._open()
        except DriverError as error:
            self.lost = error.fault  # the next Reset tries again
            raise
        self._looked, self._silent = self._clock.now(), 0.0
        if not self.wait(lambda: self._reports > 0, 3.0):
            raise DriverError("the HAL bridge does not send reports; restart TurnDesk", "hal-silent")
        self.wait(lambda: False, _SETTLES)
        self.wait(lambda: not self.is_stale, _STARTS)

    def _goes_down(self, link: BridgeLink) -> bool:
        """Whether HAL is down behind a bridge that has ended, or will be in a moment."""
        end = self._clock.now() + _DOWN
        while not link.down and self._clock.now() < end:
            if self._idle is not None:
                self._idle()
            self._clock.sleep_until(self._clock.now() + _LOOK)
        return link.down

    def give_up(self) -> None:
        """A bridge to a HAL that stands is of no use any more: it ends, and HAL with it."""
        if self._link is not None and not self.lost:
            self._link.hang_up()
            self.lost = Fault("HAL was shut down", "hal-thread")

    def pump(self) -> None:
        """Take in what has come. Raises nothing: a bridge that is gone is ``lost``."""
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
        """Why nothing is known of the machine now; empty while it is."""
        silent = self.age
        if self.lost or silent <= _SILENT:
            return self.lost
        return Fault(
            "the HAL bridge has not sent a report for {silent} s", "hal-silent", silent=f"{silent:.2f}"
        )

    @property
    def blind(self) -> bool:
        """Whether nothing is known of the machine: no word of the bridge, of HAL's thread or of the board."""
        return bool(self.trouble) or self.told.get("stands") is True or self.is_stale

    @property
    def is_stale(self) -> bool:
        """Return whether HAL's inputs are not current because the board is not reached."""
        return self.told.get("stale") is True

    @property
    def input_age(self) -> float:
        """Return the age of the inputs in seconds; inf while the board is not reached."""
        return float("inf") if self.is_stale else self.age

    @property
    def age(self) -> float:
        """For how long the bridge has told nothing while this side was listening, s."""
        return float("inf") if self.lost else self._silent + min(self._clock.now() - self._looked, _AT_ONCE)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is worth knowing of this session of HAL."""
        return self._link.warnings if self._link is not None else ()

    def beat(self) -> None:
        """This side lives. A bridge that is silent has enough to read when it comes back."""
        if not self.trouble:
            with suppress(DriverError):  # it is lost, and that is told
                self.say("beat")

    def say(self, what: str, **values: object) -> int:
        """One order; its number, which the bridge tells once it is carried out. Raises DriverError."""
        self._sent += 1
        self._send(pack({"do": what, "n": self._sent, **values}))
        return self._sent

    def say_pieces(self, what: str, pieces: Sequence[Piece], **values: object) -> None:
        """An order with setpoints. Raises DriverError."""
        self._sent += 1
        for data in packets_of({"do": what, "n": self._sent, **values}, pieces, self._axes):
            self._send(data)

    def done(self, order: int) -> bool:
        """Whether the bridge has carried this order out."""
        return number(self.told, "n") >= order

    def wait(self, ready: Callable[[], bool], longest: float) -> bool:
        """Look on until it is so; False when that takes too long, or the bridge is gone."""
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
        """A bit of the bridge's, by its pin; one that it has not is off."""
        told, at = self.told.get("bits"), self._bits.get(name)
        return isinstance(told, list) and at is not None and told[at] is True

    def figure(self, name: str) -> float:
        """A number of the bridge's, by its pin."""
        told, at = self.told.get("figures"), self._figures.get(name)
        return float(told[at]) if isinstance(told, list) and at is not None else 0.0

    def take_rows(self) -> Iterator[Sequence[float]]:
        """The samples since the last look, as they came."""
        rows, self.rows = self.rows, []
        yield from rows

    def close(self) -> None:
        """The bridge ends what is left, and HAL with it."""
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
    """What the bridge says is wrong."""
    words = text(told, "fault")
    code: FaultCode = next((each for each in get_args(FaultCode) if each == told.get("code")), "axis")
    return Fault(words, code) if words else ""
