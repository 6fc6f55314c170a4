"""Messages between the screen and the control process: pickled tuples over one socket.

Both ends belong to the same user. Times are seconds of one monotonic clock, whose zero the control sends.
"""

from __future__ import annotations

import os
import struct
from contextlib import suppress
from multiprocessing.connection import Connection
from socket import AF_UNIX, SO_PEERCRED, SOCK_STREAM, SOL_SOCKET, fromfd
from typing import NamedTuple

from app.compose.control.process_rights_check import ProcessRight
from core.executor.commands import Command
from core.executor.snapshot import InterruptedJob, LogEvent, Snapshot
from core.machine.machine_model import Machine
from core.records.record_ring import RingLayout

PROTOCOL_VERSION = 3  # of these messages
SCREEN_CONNECTED = "busy"  # reason for rejecting a second screen, never shown to the user
KEY_EXPIRY_S = 0.5  # s after which a key press that starts motion expires
_CREDENTIALS = struct.Struct("3i")  # process, user, group


# --- Messages from the screen -----------------------------------------------------------------------------


class CommandMessage(NamedTuple):
    """Send a command to the executor. ``at`` is the time of the request in s."""

    command: Command
    requested_at_s: float


class StationAction(NamedTuple):
    """Call a method of the simulated operator station. ``at`` is the time of the action in s."""

    name: str
    values: tuple[object, ...]
    acted_at_s: float


class InputChange(NamedTuple):
    """Switch an input of a simulated machine."""

    name: str
    is_on: bool


class ScreenAlive(NamedTuple):
    """The screen has handled its keys and drawn the state of the machine."""


class StopSocketMessage(NamedTuple):
    """The file descriptor of a socket for stop keys follows this message."""


class EventStored(NamedTuple):
    """The event with this number is stored and need not be sent again."""

    number: int


class CloseRequest(NamedTuple):
    """Stop the machine, close the drivers and end the process."""


# --- Messages from the control ----------------------------------------------------------------------------


class HelloMessage(NamedTuple):
    """First message of the control. The file descriptor of the scope's shared memory follows it."""

    version: int
    process: int  # number of its process
    identity: str  # differs from that of each other control; numbers of events belong to it
    machine: Machine  # machine of the control
    clock_zero_s: float  # zero of its clock, in s of the computer's monotonic clock
    warnings: tuple[str, ...]
    rights: tuple[ProcessRight, ...]  # rights that the system has granted or refused
    recorded: RingLayout
    disk_error: str  # reason why the scope does not write its file; empty if it does
    has_on_screen_station: bool  # whether the operator station on the screen operates this machine
    can_switch_inputs: bool  # whether the screen can switch the inputs of this machine
    snapshot: Snapshot
    interrupted_job: InterruptedJob | None  # job that a power failure would interrupt now


class ControlFailed(NamedTuple):
    """The control cannot be used, with the reason. No other message follows."""

    reason: str


class SnapshotMessage(NamedTuple):
    """The newest snapshot. ``has_changed`` means that something has changed on a machine at rest."""

    snapshot: Snapshot
    has_changed: bool


class EventMessage(NamedTuple):
    """A numbered event for the event log."""

    number: int
    event: LogEvent


class InterruptedJobNote(NamedTuple):
    """The job that a power failure would interrupt now, or None."""

    job: InterruptedJob | None


class ThreadEnded(NamedTuple):
    """A thread of the control process has ended unexpectedly."""

    name: str


class MachineClosed(NamedTuple):
    """The machine is stopped and its drivers are closed."""


def is_own_user(connection: Connection) -> bool:
    """Return whether the other end belongs to the user of this process."""
    with fromfd(connection.fileno(), AF_UNIX, SOCK_STREAM) as sock, suppress(OSError):
        _, user, _ = _CREDENTIALS.unpack(sock.getsockopt(SOL_SOCKET, SO_PEERCRED, _CREDENTIALS.size))
        return bool(user == os.geteuid())
    return False
