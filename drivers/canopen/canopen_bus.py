"""CAN bus with one socket, read by the driver loop that owns the bus, without a separate thread."""

from __future__ import annotations

import contextlib
import logging
import struct
import time
from collections.abc import Callable
from typing import Any, NoReturn

import can
import canopen
from canopen.sdo.client import SdoClient
from canopen.sdo.constants import RESPONSE_ABORTED
from canopen.sdo.exceptions import SdoAbortedError, SdoCommunicationError

from core.message import Message
from core.ports import Clock, DriverError, Fault
from drivers.canopen.canopen_table import CanopenTable

_log = logging.getLogger(__name__)
for _library in ("can", "canopen"):  # Their errors are raised and reported by TurnDesk.
    logging.getLogger(_library).addHandler(logging.NullHandler())

_MAX_GARBLED_FRAMES = 3  # Number of invalid frames.
_BUS_OFF = 0x40  # Class of an error frame: the controller is bus-off.
_OPERATIONAL = 5
_MAX_STOPPED_CYCLES = 400  # Cycles with a stopped clock before a missing response is assumed.
_HEARTBEAT_EARLY_S = 0.005  # Seconds by which the heartbeat may be sent early.
_BEAT, _SYNC, _NMT = 0x700, 0x080, 0x000
_ECHOING_INTERFACES = ("udp_multicast",)  # Receives its own frames, so another master cannot be detected.


class CanBus(canopen.Network):
    """CAN bus on which only the loop that owns it sends and receives frames.

    In tests, the bus calls ``advance_time`` to advance the time while it waits.
    """

    def __init__(
        self, config: CanopenTable, clock: Clock, advance_time: Callable[[], None] | None = None
    ) -> None:
        super().__init__(open_can_interface(config))
        self.config = config
        self.clock = clock
        self.garbled_frame_count = 0
        self.failure: Fault | str = ""  # Reason for the bus failure until the bus is opened again.
        self._idle = advance_time
        # Called during every wait; returns seconds until the next call.
        self.wait_callback: Callable[[], float] | None = None
        self.next_heartbeat_s = clock.now()  # Time of TurnDesk's next heartbeat.
        if config.interface not in _ECHOING_INTERFACES:
            for cob in (_SYNC, _NMT, _BEAT + config.host_id):
                self.subscribe(cob, self._another_master)

    def close(self) -> None:
        """Close the CAN interface."""
        if self.bus is not None:
            self.bus.shutdown()
            self.bus = None

    def reopen(self) -> None:
        """Open the CAN interface again after a failure.

        Raises DriverError if the interface cannot be opened.
        """
        self.close()
        try:
            self.bus = open_can_interface(self.config)
        except DriverError as error:
            raise DriverError(f"{self.failure}; {error}", "bus") from error
        self.failure, self.garbled_frame_count = "", 0
        self.next_heartbeat_s = self.clock.now()

    def process_frames(self, timeout_s: float = 0.0) -> None:
        """Send the heartbeat when it is due, and process received frames.

        The method waits at most ``timeout_s`` seconds for the first frame. This loop deliberately sends the
        heartbeat itself: a kernel task would continue to send heartbeats even if the process hangs.
        """
        self.send_heartbeat()
        while self.bus is not None and not self.failure:
            try:
                message = self.bus.recv(timeout_s)
            except (can.CanError, OSError) as error:
                self.mark_failed(Message("the CAN interface has failed: {error}", error=error))
                return
            if message is None:
                return
            timeout_s = 0.0
            self._take(message)

    def send_heartbeat(self, *, force: bool = False) -> None:
        """Send the heartbeat when it is due, or at once with ``force``.

        A node starts to monitor the heartbeat when it receives the first one.
        """
        now = self.clock.now()
        if (force or now >= self.next_heartbeat_s - _HEARTBEAT_EARLY_S) and not self.failure:
            self.next_heartbeat_s = now + self.config.heartbeat
            with contextlib.suppress(DriverError):  # Stored as the fault of the bus.
                self.send_message(_BEAT + self.config.host_id, bytes([_OPERATIONAL]))

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        """Send one frame.

        Raises DriverError if the bus is closed or has failed, or if the interface rejects the frame.
        """
        if self.bus is None or self.failure:
            raise DriverError(
                "CAN {channel}: {problem}",
                "bus",
                channel=self.config.channel,
                problem=self.failure or "closed",
            )
        frame = can.Message(
            arbitration_id=can_id, data=bytes(data), is_extended_id=False, is_remote_frame=remote
        )
        try:
            self.bus.send(frame)
        except (can.CanError, OSError) as error:
            self.mark_failed(Message("the CAN interface cannot send: {error}", error=error))
            raise DriverError(
                "CAN {channel}: {problem}", "bus", channel=self.config.channel, problem=self.failure
            ) from error

    def send_sync(self) -> None:
        """Send one SYNC. The drives then apply the frames sent before the SYNC, and reply."""
        self.send_message(_SYNC, b"")

    def wait_until(self, is_ready: Callable[[], bool], timeout_s: float) -> bool:
        """Process frames until ``is_ready`` returns true, and return True.

        Return False after ``timeout_s`` seconds of real time, or at once if the bus has failed.
        """
        if self._idle is not None:
            return self._wait_in_steps(is_ready)
        end = time.monotonic() + timeout_s
        while not is_ready():
            left = end - time.monotonic()
            if left <= 0.0 or self.failure:
                return False
            due = self.wait_callback() if self.wait_callback is not None else 0.005
            self.process_frames(min(left, due, 0.005))
        return True

    @property
    def has_simulated_time(self) -> bool:
        """Return whether time advances only when the bus calls ``advance_time``, as in tests."""
        return self._idle is not None

    def mark_failed(self, reason: str) -> None:
        """Mark the bus as failed for ``reason``, or keep the earlier reason if it has already failed."""
        self.failure = self.failure or Fault(reason, "bus")

    def _wait_in_steps(self, ready: Callable[[], bool]) -> bool:
        assert self._idle is not None
        for _ in range(_MAX_STOPPED_CYCLES):
            self.process_frames()
            if ready():
                return True
            self._idle()
        return False

    def _take(self, message: can.Message) -> None:
        if message.is_error_frame:
            if message.arbitration_id & _BUS_OFF:
                self.mark_failed(
                    "bus-off: the CAN controller has disconnected itself from the bus; check cable and "
                    "termination"
                )
        elif not message.is_remote_frame and not message.is_extended_id:
            self._deliver(message)

    def _deliver(self, message: can.Message) -> None:
        """Pass a frame to its subscribers, and mark the bus as failed after several invalid frames."""
        try:
            self.notify(message.arbitration_id, bytearray(message.data), self.clock.now())
        except (struct.error, IndexError, ValueError) as error:
            self.garbled_frame_count += 1
            _log.warning("CAN frame %03X makes no sense: %s", message.arbitration_id, error)
            if self.garbled_frame_count >= _MAX_GARBLED_FRAMES:
                self.mark_failed(
                    Message(
                        "invalid CAN frames received, the last with ID {arbitration_id}; check the "
                        "node numbers",
                        arbitration_id=f"{message.arbitration_id:03X}",
                    )
                )

    def _another_master(self, can_id: int, _data: bytearray, _timestamp: float) -> None:
        what = {_SYNC: "SYNC", _NMT: "NMT commands"}.get(can_id, "our heartbeat")
        self.mark_failed(
            Message("another master is sending {what} on this bus; switch that master off", what=what)
        )


class PollingSdoClient(SdoClient):
    """SDO client that reads the bus itself while it waits for a response."""

    RESPONSE_TIMEOUT = 1.0  # Seconds; some drives store values slowly.

    def __init__(self, rx_cobid: int, tx_cobid: int, dictionary: canopen.ObjectDictionary) -> None:
        SdoClient.__init__(self, rx_cobid, tx_cobid, dictionary)

    def on_response(self, can_id: int, data: bytearray, timestamp: float) -> None:
        """Handle a response; raise ValueError unless it has eight bytes."""
        if len(data) != 8:
            raise ValueError(f"an SDO answer of {len(data)} bytes")
        SdoClient.on_response(self, can_id, data, timestamp)

    def read_response(self) -> bytes:
        """Wait for the response and return it.

        Raises SdoCommunicationError if no response arrives, and SdoAbortedError if the node rejects the
        request.
        """
        bus = self.network
        assert isinstance(bus, CanBus)
        if not bus.wait_until(lambda: not self.responses.empty(), self.RESPONSE_TIMEOUT):
            raise SdoCommunicationError("no answer")
        answer: bytes = self.responses.get_nowait()
        if answer[0] == RESPONSE_ABORTED:
            raise SdoAbortedError(int.from_bytes(answer[4:8], "little"))
        return answer


class PollingNode(canopen.RemoteNode):
    """Remote node whose SDO client reads the bus itself, without a receiving thread."""

    def add_sdo(self, rx_cobid: int, tx_cobid: int) -> PollingSdoClient:
        """Add an SDO channel and return its client."""
        client = PollingSdoClient(rx_cobid, tx_cobid, self.object_dictionary)
        self.sdo_channels.append(client)
        if self.has_network():
            self.network.subscribe(client.tx_cobid, client.on_response)
        return client


# NotImplementedError is raised for an interface that python-can does not know.
_OPEN_ERRORS = (
    can.CanError,
    OSError,
    ValueError,
    TypeError,
    AttributeError,
    ImportError,
    NotImplementedError,
)


def open_can_interface(config: CanopenTable) -> can.BusABC:
    """Open the CAN interface.

    With the interface ``udp_multicast``, the channel may end in ``:port``. On one computer, multicast
    groups with the same port receive each other's frames. Raises DriverError if the interface cannot be
    opened.
    """
    on_udp = config.interface in _ECHOING_INTERFACES
    channel, _, port = config.channel.partition(":") if on_udp else (config.channel, "", "")
    more: dict[str, Any] = {"port": int(port)} if port.isdecimal() else {}
    try:
        return can.Bus(
            interface=config.interface, channel=channel, bitrate=config.bitrate, ignore_config=True, **more
        )
    except _OPEN_ERRORS as error:
        _refuse(config, error)


def _refuse(config: CanopenTable, error: Exception) -> NoReturn:
    hint = Message(
        "bring the interface up: ip link set {channel} up type can bitrate {bitrate}",
        channel=config.channel,
        bitrate=config.bitrate,
    )
    how = hint if config.interface == "socketcan" else "check the interface and channel in [canopen]"
    if "not installed" in str(error):  # msgpack, of udp_multicast
        how = "run: pip install 'turndesk[canopen]'"
    raise DriverError(
        "CAN interface {interface}, channel {channel}, cannot be opened: {error}; {method}",
        interface=config.interface,
        channel=config.channel,
        error=error,
        method=how,
    ) from error
