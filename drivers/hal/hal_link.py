"""Connection to the HAL bridge, with the last report of the bridge.

A bridge that is silent or has ended is a fault.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import get_args

from core.ports import Clock, DriverError, Fault, FaultCode
from drivers.hal.bridge.packets import BridgeConfig, PacketHead, build_piece_packets, number, pack_packet
from drivers.hal.hal_session import INVALID_PACKET, BridgeLink
from drivers.process_messages import text
from drivers.setpoint_pieces import MotionPiece
from drivers.silence import DRIVER_BRIDGE_TIMEOUT_S, MAX_STEP_S, SilenceTimer

_SETTLING_TIME_S = 0.5  # Seconds after which debounced inputs are valid.
_START_TIMEOUT_S = 5.0  # Seconds for bus slaves to become operational after HAL was loaded.
_SHUTDOWN_TIMEOUT_S = 4.0  # Seconds for HAL to shut down, including its continuation after a crashed bridge.
_POLL_INTERVAL_S = 0.002  # Seconds between two checks during a wait.


class HalLink:
    """The connection to the bridge, used by one thread.

    ``open_link`` starts HAL and its bridge.
    """

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
        self._silence = SilenceTimer(DRIVER_BRIDGE_TIMEOUT_S, max_step_s=MAX_STEP_S)
        self.last_report: PacketHead = {}
        self.sample_rows: list[Sequence[float]] = []  # Samples that have not been taken.
        self.failure: Fault | str = ""  # Reason why the connection is lost.
        self.max_bridge_delay_s = 0.0  # Maximum wake-up delay of the bridge in s.

    def connect(self) -> None:
        """Start HAL, and wait for the first report of the bridge.

        Raises DriverError if the previous HAL session is still shutting down, if HAL does not start, or if
        the bridge sends no report within 3 s.
        """
        if self._link is not None and not self._wait_for_shutdown(self._link):
            raise DriverError("HAL is still shutting down; press Reset again in a few seconds", "hal-bridge")
        self.close()
        self.failure, self.sample_rows, self._reports = "", [], 0
        try:
            self._link = self._open()
        except DriverError as error:
            self.failure = error.fault  # The next Reset tries again.
            raise
        self._silence.hear(self._clock.now())
        if not self.wait_until_ready(lambda: self._reports > 0, 3.0):
            raise DriverError("the HAL bridge does not send reports; restart TurnDesk", "hal-silent")
        self.wait_until_ready(lambda: False, _SETTLING_TIME_S)
        self.wait_until_ready(lambda: not self.are_inputs_stale, _START_TIMEOUT_S)

    def _wait_for_shutdown(self, link: BridgeLink) -> bool:
        """Wait up to 4 s until HAL has shut down after the end of its bridge, and return whether it has."""
        end = self._clock.now() + _SHUTDOWN_TIMEOUT_S
        while not link.has_shut_down and self._clock.now() < end:
            if self._idle is not None:
                self._idle()
            self._clock.sleep_until(self._clock.now() + _POLL_INTERVAL_S)
        return link.has_shut_down

    def end_session(self) -> None:
        """End the bridge and HAL, for example because the servo thread has stopped."""
        if self._link is not None and not self.failure:
            self._link.stop_bridge()
            self.failure = Fault("HAL was shut down", "hal-thread")

    def process_packets(self) -> None:
        """Process the received packets.

        The method raises no errors; a failure is stored in ``failure``.
        """
        if self._link is None or self.failure:
            return
        now = self._clock.now()
        self._silence.check(now)
        try:
            for head, numbers in self._link.receive_packets():
                self.last_report = head
                self._reports += 1
                self._silence.hear(now)
                self.max_bridge_delay_s = max(self.max_bridge_delay_s, number(head, "late"))
                if len(numbers):
                    self.sample_rows.append(numbers)
        except DriverError as error:
            self.failure = error.fault
        except ValueError:
            self.failure = Fault(INVALID_PACKET, "hal-silent")
            self._link.stop_bridge()

    @property
    def failure_reason(self) -> Fault | str:
        """Return the reason why the state of the machine is unknown, or an empty string."""
        silent = self.report_age_s
        if self.failure or silent <= DRIVER_BRIDGE_TIMEOUT_S:
            return self.failure
        return Fault(
            "the HAL bridge has not sent a report for {silent} s", "hal-silent", silent=f"{silent:.2f}"
        )

    @property
    def is_state_unknown(self) -> bool:
        """Return whether the state of the machine is unknown.

        It is unknown while the bridge, the servo thread or the board is silent.
        """
        return bool(self.failure_reason) or self.last_report.get("stands") is True or self.are_inputs_stale

    @property
    def are_inputs_stale(self) -> bool:
        """Return whether HAL's inputs are stale because the board is not reachable."""
        return self.last_report.get("stale") is True

    @property
    def input_age_s(self) -> float:
        """Return the age of the board's inputs in seconds, or inf while the board is not reachable."""
        return float("inf") if self.are_inputs_stale else self.report_age_s

    @property
    def report_age_s(self) -> float:
        """Return the seconds since the last report of the bridge, or inf if the connection is lost.

        Only the time during which this process was receiving is counted.
        """
        return float("inf") if self.failure else self._silence.measure(self._clock.now())

    @property
    def warnings(self) -> tuple[str, ...]:
        """Return the warnings of the current HAL session."""
        return self._link.warnings if self._link is not None else ()

    def send_heartbeat(self) -> None:
        """Send a heartbeat, unless the bridge is silent."""
        if not self.failure_reason:
            with suppress(DriverError):  # The loss is reported separately.
                self.send_command("beat")

    def send_command(self, command: str, **values: object) -> int:
        """Send a command and return its number, which the bridge reports after execution.

        Raises DriverError if the bridge does not accept the command.
        """
        self._sent += 1
        self._send(pack_packet({"do": command, "n": self._sent, **values}))
        return self._sent

    def send_setpoint_pieces(self, what: str, pieces: Sequence[MotionPiece], **values: object) -> None:
        """Send a command with the motion pieces of a path to the bridge.

        Raises DriverError if the bridge does not accept the command.
        """
        self._sent += 1
        for data in build_piece_packets({"do": what, "n": self._sent, **values}, pieces, self._axes):
            self._send(data)

    def is_command_executed(self, command_number: int) -> bool:
        """Return whether the bridge has executed the command with this number."""
        return number(self.last_report, "n") >= command_number

    def wait_until_ready(self, is_ready: Callable[[], bool], timeout_s: float) -> bool:
        """Process packets until ``is_ready`` returns True, and return whether it did.

        The result is False after ``timeout_s`` seconds or a loss of the connection.
        """
        end = self._clock.now() + timeout_s
        while not self.failure and self._clock.now() < end:
            self.process_packets()
            if is_ready():
                return True
            if self._idle is not None:
                self._idle()
            self._clock.sleep_until(self._clock.now() + _POLL_INTERVAL_S)
        return False

    def read_bit_pin(self, name: str) -> bool:
        """Return a bit of the bridge by the name of its pin, or False for an unknown pin."""
        bits, at = self.last_report.get("bits"), self._bits.get(name)
        return isinstance(bits, list) and at is not None and bits[at] is True

    def read_number_pin(self, name: str) -> float:
        """Return a number of the bridge by the name of its pin, or 0 for an unknown pin."""
        numbers, at = self.last_report.get("figures"), self._figures.get(name)
        return float(numbers[at]) if isinstance(numbers, list) and at is not None else 0.0

    def pop_sample_rows(self) -> Iterator[Sequence[float]]:
        """Remove and yield the received samples."""
        rows, self.sample_rows = self.sample_rows, []
        yield from rows

    def close(self) -> None:
        """Close the connection, after which the bridge stops the machine and ends HAL."""
        if self._link is not None:
            self._link.close()
        self._link = None

    def _send(self, data: bytes) -> None:
        if self.failure or self._link is None:
            raise DriverError(
                self.failure or "the HAL bridge is not connected", reason="" if self.failure else "no-bridge"
            )
        try:
            self._link.send_packet(data)
        except DriverError as error:
            if error.code != "hal-silent":
                self.failure = error.fault
            raise


def parse_bridge_fault(report: Mapping[str, object]) -> Fault | str:
    """Return the fault that the bridge reports, or an empty string."""
    words = text(report, "fault")
    code: FaultCode = next((each for each in get_args(FaultCode) if each == report.get("code")), "axis")
    return Fault(words, code) if words else ""
