"""The wire: one socket, read by the loop that owns it. There is no reading thread that could die unseen."""

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
for _library in ("can", "canopen"):  # what goes wrong there is raised, and told by us in one sentence
    logging.getLogger(_library).addHandler(logging.NullHandler())

_GARBLED = 3  # frames of a wrong shape
_BUS_OFF = 0x40  # class of an error frame: the controller has switched itself off
_OPERATIONAL = 5
_ROUNDS = 400  # looks at a bus whose clock stands, before nobody answers
_EARLY = 0.005  # s by which our heartbeat may go out with something else
_BEAT, _SYNC, _NMT = 0x700, 0x080, 0x000
_ECHOING = ("udp_multicast",)  # hears itself: no other master can be told apart


class Bus(canopen.Network):
    """One CAN bus. ``idle`` is what a wait does in between where time does not pass by itself (tests)."""

    def __init__(self, config: CanopenTable, clock: Clock, idle: Callable[[], None] | None = None) -> None:
        super().__init__(opened(config))
        self.config = config
        self.clock = clock
        self.garbled = 0
        self.trouble: Fault | str = ""  # why the bus cannot be trusted; stays until it is opened anew
        self._idle = idle
        self.meanwhile: Callable[[], float] | None = None  # goes on in every wait; s until it has to again
        self.next_beat = clock.now()  # when ours is due
        if config.interface not in _ECHOING:
            for cob in (_SYNC, _NMT, _BEAT + config.host_id):
                self.subscribe(cob, self._another_master)

    def close(self) -> None:
        """Let the interface go."""
        if self.bus is not None:
            self.bus.shutdown()
            self.bus = None

    def reopen(self) -> None:
        """The interface anew, behind whatever ended the trust in it. Raises DriverError."""
        self.close()
        try:
            self.bus = opened(self.config)
        except DriverError as error:
            raise DriverError(f"{self.trouble}; {error}", "bus") from error
        self.trouble, self.garbled = "", 0
        self.next_beat = self.clock.now()

    def pump(self, wait: float = 0.0) -> None:
        """Take in what has come, waiting at most ``wait`` for the first; our heartbeat goes out from here.

        The heartbeat lives in the loop on purpose: a kernel job would go on telling the drives that all is
        well when this process hangs.
        """
        self.beat()
        while self.bus is not None and not self.trouble:
            try:
                message = self.bus.recv(wait)
            except (can.CanError, OSError) as error:
                self.lost(Message("the CAN interface has failed: {error}", error=error))
                return
            if message is None:
                return
            wait = 0.0
            self._take(message)

    def beat(self, *, at_once: bool = False) -> None:
        """Our heartbeat, when it is due. A node begins to watch it with the first that it hears."""
        now = self.clock.now()
        if (at_once or now >= self.next_beat - _EARLY) and not self.trouble:
            self.next_beat = now + self.config.heartbeat
            with contextlib.suppress(DriverError):  # kept as the bus's trouble
                self.send_message(_BEAT + self.config.host_id, bytes([_OPERATIONAL]))

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        """Send one frame. Raises DriverError when the interface does not take it."""
        if self.bus is None or self.trouble:
            raise DriverError(
                "CAN {channel}: {problem}",
                "bus",
                channel=self.config.channel,
                problem=self.trouble or "closed",
            )
        frame = can.Message(
            arbitration_id=can_id, data=bytes(data), is_extended_id=False, is_remote_frame=remote
        )
        try:
            self.bus.send(frame)
        except (can.CanError, OSError) as error:
            self.lost(Message("the CAN interface cannot send: {error}", error=error))
            raise DriverError(
                "CAN {channel}: {problem}", "bus", channel=self.config.channel, problem=self.trouble
            ) from error

    def synchronise(self) -> None:
        """One SYNC: drives apply what was sent before it, and answer."""
        self.send_message(_SYNC, b"")

    def wait(self, ready: Callable[[], bool], timeout: float) -> bool:
        """Take messages in until ``ready``; False after ``timeout`` seconds of real time."""
        if self._idle is not None:
            return self._wait_in_steps(ready)
        end = time.monotonic() + timeout
        while not ready():
            left = end - time.monotonic()
            if left <= 0.0 or self.trouble:
                return False
            due = self.meanwhile() if self.meanwhile is not None else 0.005
            self.pump(min(left, due, 0.005))
        return True

    @property
    def stepped(self) -> bool:
        """Time does not pass by itself (tests)."""
        return self._idle is not None

    def lost(self, why: str) -> None:
        """Nothing on this bus can be believed any more; the first reason is kept."""
        self.trouble = self.trouble or Fault(why, "bus")

    def _wait_in_steps(self, ready: Callable[[], bool]) -> bool:
        assert self._idle is not None
        for _ in range(_ROUNDS):
            self.pump()
            if ready():
                return True
            self._idle()
        return False

    def _take(self, message: can.Message) -> None:
        if message.is_error_frame:
            if message.arbitration_id & _BUS_OFF:
                self.lost(
                    "bus-off: the CAN controller has disconnected itself from the bus; check cable and "
                    "termination"
                )
        elif not message.is_remote_frame and not message.is_extended_id:
            self._deliver(message)

    def _deliver(self, message: can.Message) -> None:
        """To whoever listens; a few frames of a wrong shape are dropped, more of them end the trust."""
        try:
            self.notify(message.arbitration_id, bytearray(message.data), self.clock.now())
        except (struct.error, IndexError, ValueError) as error:
            self.garbled += 1
            _log.warning("CAN frame %03X makes no sense: %s", message.arbitration_id, error)
            if self.garbled >= _GARBLED:
                self.lost(
                    Message(
                        "invalid CAN frames received, the last with ID {arbitration_id}; check the "
                        "node numbers",
                        arbitration_id=f"{message.arbitration_id:03X}",
                    )
                )

    def _another_master(self, can_id: int, _data: bytearray, _timestamp: float) -> None:
        what = {_SYNC: "SYNC", _NMT: "NMT commands"}.get(can_id, "our heartbeat")
        self.lost(Message("another master is sending {what} on this bus; switch that master off", what=what))


class WaitingSdo(SdoClient):
    """An SDO client that reads the bus itself while it waits."""

    RESPONSE_TIMEOUT = 1.0  # s; some drives take their time over what they store

    def __init__(self, rx_cobid: int, tx_cobid: int, dictionary: canopen.ObjectDictionary) -> None:
        SdoClient.__init__(self, rx_cobid, tx_cobid, dictionary)

    def on_response(self, can_id: int, data: bytearray, timestamp: float) -> None:
        """An answer has eight bytes; anything else is none. Raises ValueError."""
        if len(data) != 8:
            raise ValueError(f"an SDO answer of {len(data)} bytes")
        SdoClient.on_response(self, can_id, data, timestamp)

    def read_response(self) -> bytes:
        """The answer. Raises SdoCommunicationError without one, SdoAbortedError when the node refuses."""
        bus = self.network
        assert isinstance(bus, Bus)
        if not bus.wait(lambda: not self.responses.empty(), self.RESPONSE_TIMEOUT):
            raise SdoCommunicationError("no answer")
        answer: bytes = self.responses.get_nowait()
        if answer[0] == RESPONSE_ABORTED:
            raise SdoAbortedError(int.from_bytes(answer[4:8], "little"))
        return answer


class Node(canopen.RemoteNode):
    """A node of the bus whose SDO client needs no reading thread."""

    def add_sdo(self, rx_cobid: int, tx_cobid: int) -> WaitingSdo:
        """One more SDO channel."""
        client = WaitingSdo(rx_cobid, tx_cobid, self.object_dictionary)
        self.sdo_channels.append(client)
        if self.has_network():
            self.network.subscribe(client.tx_cobid, client.on_response)
        return client


# NotImplementedError: an interface that python-can does not know.
_NOT_OPENED = (can.CanError, OSError, ValueError, TypeError, AttributeError, ImportError, NotImplementedError)


def opened(config: CanopenTable) -> can.BusABC:
    """The interface; raises DriverError. On udp_multicast a channel may end in ``:port``.

    Two groups on one port hear each other within one computer.
    """
    on_udp = config.interface in _ECHOING
    channel, _, port = config.channel.partition(":") if on_udp else (config.channel, "", "")
    more: dict[str, Any] = {"port": int(port)} if port.isdecimal() else {}
    try:
        return can.Bus(
            interface=config.interface, channel=channel, bitrate=config.bitrate, ignore_config=True, **more
        )
    except _NOT_OPENED as error:
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
