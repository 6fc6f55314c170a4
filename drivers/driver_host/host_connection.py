"""The connection to the driver host, by a socket or within one thread, with the last polled state.

If the driver host has ended, the connection reports a fault.
"""

from __future__ import annotations

import logging
import queue
import socket
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Protocol

from core.faults import TrippedError, get_fault_code
from core.message import Message as Text
from core.ports import ALL_UNKNOWN_PARTS, Clock, DriverError, Fault, FloatArray, UnknownPart
from drivers.driver_host.host_messages import (
    NO_NUMBERS,
    PROTOCOL_VERSION,
    Message,
    convert_messages,
    encode_message,
    parse_strings,
    read_fault,
)
from drivers.driver_host.host_server import DriverHost
from drivers.process_messages import MessageSocket, decode_message, text
from drivers.silence import CONTROL_HOST_TIMEOUT_S, MAX_STEP_S, SilenceTimer
from drivers.wakeups import ConnectionAttempt, ProcessWakeup

_log = logging.getLogger(__name__)
_POLL_VALIDITY_S = 0.002  # Seconds for which one poll serves all ports.
_SLEEP_POLL_VALIDITY_S = 0.02  # The same while the control sleeps: one tick, because changes cause a wake-up.
_MAX_BATCHES = 200  # Maximum number of sample batches waiting for the recorder.


class HostLink(Protocol):
    """A connection that transports requests and replies.

    ``disconnect_file_descriptors`` are file descriptors that become readable when the connection ends.
    """

    @property
    def disconnect_file_descriptors(self) -> Sequence[int]:
        """Return the file descriptors that become readable when the connection ends."""
        ...

    def send_request(self, message: Message) -> Message:
        """Send a request and return the reply.

        Raises DriverError if no reply is received.
        """
        ...

    def disconnect(self) -> None:
        """End the connection; any thread may call this method."""
        ...

    def close(self) -> None:
        """Close the connection and release its resources."""
        ...


def clear_drive_faults(link: HostLink) -> HostLink:
    """Clear the drive faults after a restart of the driver host, and return the connection to it.

    Raises DriverError if the faults cannot be cleared.
    """
    answer = link.send_request(Message({"do": "do", "what": "clear_fault"}, NO_NUMBERS))
    if why := read_fault(answer.header, "error", "driver"):
        raise DriverError(why)
    return link


class HostConnection:
    """A connection that sends requests to the driver host and caches the last polled state.

    ``restart_host`` starts a new driver host to replace a lost one. The driver host writes to
    ``wakeup_bell`` to wake the control while it sleeps.
    """

    def __init__(
        self,
        link: HostLink,
        clock: Clock,
        restart_host: Callable[[], ConnectionAttempt[HostLink]] | None = None,
        wakeup_bell: ProcessWakeup | None = None,
    ) -> None:
        self._link = link
        self._again = restart_host
        self._opening: ConnectionAttempt[HostLink] | None = None
        self.clock = clock
        self.wakeup_bell = wakeup_bell
        self._asleep = self._sleeps = False  # State known to the driver host, and state for the next poll.
        self.fault: Fault | str = ""  # Reason why the driver host is lost.
        self._state: Mapping[str, object] = {}
        self._at = -1.0
        self._posted: queue.SimpleQueue[Message] = queue.SimpleQueue()
        self.sample_batches: deque[FloatArray] = deque(maxlen=_MAX_BATCHES)  # Batches since the last reading.

    def send_request(self, message: Message) -> Message:
        """Send a request and return the reply.

        Raises DriverError if the drivers reject the request or the driver host is lost, and TrippedError
        after a trip.
        """
        if self.fault:
            raise DriverError(self.fault)
        if self._opening is not None:
            raise DriverError("the driver host is restarting", "feeder-gone")
        self._asleep = False
        try:
            answer = self._link.send_request(message)
        except DriverError as error:
            self.fault = error.fault
            raise
        if "tripped" in answer.header:
            raise TrippedError(text(answer.header, "tripped"))
        if why := read_fault(answer.header, "error", "driver"):
            raise DriverError(why, reason=text(answer.header, "reason"))
        return answer

    def send_command(self, command: str, **values: object) -> None:
        """Send a command that changes the machine, and invalidate the cached state."""
        self._at = -1.0
        self.send_request(Message({"do": "do", "what": command, **values}, NO_NUMBERS))

    def post_message(self, message: Message) -> None:
        """Queue a message, which is sent before the next poll.

        Any thread may call this method.
        """
        self._posted.put(message)
        if self.wakeup_bell is not None:
            self.wakeup_bell.send_wakeup()

    def enter_sleep(self) -> None:
        """Let the driver host send a wake-up for each change, until the control sends a request.

        Raises DriverError if this request fails.
        """
        if not self._asleep:
            self.send_request(Message({"do": "rest"}, NO_NUMBERS))
        self._asleep = self._sleeps = True

    def leave_sleep(self) -> None:
        """End the sleep, and invalidate the cached state."""
        self._sleeps, self._at = False, -1.0

    @property
    def disconnect_file_descriptors(self) -> Sequence[int]:
        """Return the file descriptors that become readable only when the connection ends."""
        return self._link.disconnect_file_descriptors

    def poll_state(self, *, is_forced: bool = False) -> Mapping[str, object]:
        """Poll the state, at most once per tick unless ``is_forced`` is True, and return it.

        After the loss of the driver host, the last state is returned.
        """
        if self._opening is not None:
            self._reopen(self._opening)
        now = self.clock.now()
        fresh = _SLEEP_POLL_VALIDITY_S if self._asleep else _POLL_VALIDITY_S
        if not self.is_host_unavailable and (is_forced or not 0.0 <= now - self._at < fresh):
            try:
                while not self._posted.empty():
                    self.send_request(self._posted.get())
                sleeps, self._sleeps = self._sleeps, False
                answer = self.send_request(Message({"do": "look", "rests": sleeps}, NO_NUMBERS))
                self._asleep = sleeps
                self._state = answer.header
                if len(answer.numbers):
                    self.sample_batches.append(answer.numbers)
            except DriverError as error:
                self.fault = self.fault or error.fault
            self._at = now
            for note in parse_strings(self._state.get("notes")):
                _log.warning("driver host: %s", note)
        return self._state

    @property
    def is_host_unavailable(self) -> bool:
        """Return whether no driver host is available."""
        return self.fault != "" or self._opening is not None

    def restart_host(self) -> None:
        """Start a new driver host.

        If the start fails later, the failure becomes the next fault. Raises DriverError if a restart is not
        possible.
        """
        if self._again is None:
            words = Text("{fault}; restart TurnDesk", fault=self.fault)
            raise DriverError(words, get_fault_code(self.fault, "feeder-gone"))
        self.fault, self._opening = "", self._again()

    def read_host_properties(self) -> Mapping[str, object]:
        """Return the properties of the driver host.

        Raises DriverError if the driver host is lost or does not reply, or uses another version of the
        protocol.
        """
        hello = self.send_request(Message({"do": "hello"}, NO_NUMBERS)).header
        if hello.get("version") != PROTOCOL_VERSION:
            raise DriverError(
                "the driver host uses version {version}, but TurnDesk uses version {expected}: exit "
                "TurnDesk, complete the installation, then start TurnDesk again",
                version=hello.get("version"),
                expected=PROTOCOL_VERSION,
            )
        return hello

    def _reopen(self, opening: ConnectionAttempt[HostLink]) -> None:
        try:
            link = opening.take_connection()
            if link is None:
                return
            self._link, self._opening, self._at = link, None, -1.0
            self._state = {}
            self.read_host_properties()
        except DriverError as error:
            self._opening, self.fault = None, error.fault

    def find_unknown_parts(self) -> frozenset[UnknownPart]:
        """Return the parts of the machine state that are unknown.

        All parts are unknown if the driver host is lost.
        """
        if self.is_host_unavailable:
            return ALL_UNKNOWN_PARTS
        return frozenset(map(UnknownPart, parse_strings(self.poll_state().get("unknown"))))

    def disconnect(self) -> None:
        """End the connection; any thread may call this method.

        The driver host detects the loss and stops the machine permanently.
        """
        self._link.disconnect()

    def close(self) -> None:
        """Close the connection, which also ends the driver host."""
        self._link.close()


# --- Two links to the driver host: within one thread, and by a socket.


# Seconds for commands that wait for a drive; clearing a fault may configure a complete bus.
_LONG_TIMEOUTS_S = {"enable": 5.0, "home": 5.0, "clear_fault": 15.0}


class InProcessLink:
    """A link to a driver host in the same thread, for tests and headless runs.

    It exchanges the same bytes as a link to a separate process.
    """

    disconnect_file_descriptors = ()  # Its end is always detected.

    def __init__(self, host: DriverHost) -> None:
        self._host = host

    def send_request(self, message: Message) -> Message:
        """Run one cycle of the driver host, let it handle the message, and return its reply.

        The message and the reply are encoded and decoded.
        """
        self._host.run_cycle()
        (request,) = convert_messages([decode_message(encode_message(message))])
        (answer,) = convert_messages([decode_message(encode_message(self._host.handle_message(request)))])
        return answer

    def disconnect(self) -> None:
        """Mark the driver host as orphaned, as if the control had ended."""
        self._host.is_orphaned = True

    def close(self) -> None:
        """Mark the driver host as orphaned, as ``disconnect`` does."""
        self.disconnect()


class SocketLink:
    """A link to a driver host in its own process.

    It handles one request at a time, with a time limit for each request.
    """

    def __init__(self, sock: socket.socket) -> None:
        self._socket = MessageSocket(sock)

    @property
    def disconnect_file_descriptors(self) -> tuple[int, ...]:
        """Return the socket's file descriptor, which becomes readable when the driver host ends."""
        return (self._socket.fileno(),)

    def send_request(self, message: Message) -> Message:
        """Send a request and return the reply.

        Raises DriverError after a loss of the connection or a timeout.
        """
        limit = _LONG_TIMEOUTS_S.get(text(message.header, "what"), CONTROL_HOST_TIMEOUT_S)
        try:
            self._socket.send(encode_message(message), limit)
            return self.wait_for_message(limit)
        except TimeoutError as error:
            raise DriverError(
                "no response from the driver host for {seconds} s; the axes stop on their path",
                "feeder-silent",
                seconds=f"{limit:g}",
            ) from error
        except EOFError as error:
            raise DriverError("the driver host has ended", "feeder-gone") from error
        except OSError as error:
            raise DriverError(
                "the driver host has ended ({cause})", "feeder-gone", cause=error.strerror
            ) from error

    def wait_for_message(self, timeout_s: float) -> Message:
        """Return the next message.

        Raises TimeoutError if none arrives in time, EOFError if the driver host has ended, OSError if the
        connection fails, and DriverError for invalid data.
        """
        silence = SilenceTimer(timeout_s, time.monotonic(), MAX_STEP_S)
        while True:
            self._socket.wait(MAX_STEP_S)
            for message in convert_messages(self._socket.receive()):
                return message
            if silence.check(time.monotonic()):
                raise TimeoutError

    def disconnect(self) -> None:
        """Shut down both directions of the socket, even while another thread waits for a reply."""
        with suppress(OSError):
            self._socket.disconnect()

    def close(self) -> None:
        """Disconnect and close the socket, after which the driver host stops the machine."""
        self.disconnect()
        self._socket.close()
