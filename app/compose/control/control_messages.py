"""Messages between the screen and the control process, sent as pickled tuples over one socket.

Both processes belong to the same user. Times are in seconds of one monotonic clock. The control sends the
zero of this clock.
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
from core.store.production.part_cycles import ProductionRow

PROTOCOL_VERSION = 4  # of these messages
SCREEN_CONNECTED = "busy"  # reason for rejecting a second screen, never shown to the user
KEY_EXPIRY_S = 0.5  # s after which a key press that starts motion expires
_CREDENTIALS = struct.Struct("3i")  # process, user, group


# --- Messages from the screen -----------------------------------------------------------------------------


class CommandMessage(NamedTuple):
    """Command for the executor. ``request_time_s`` is the time of the request in seconds."""

    command: Command
    request_time_s: float


class StationAction(NamedTuple):
    """Request to call a method of the simulated operator station.

    ``action_time_s`` is the time of the operator's action in seconds.
    """

    name: str
    arguments: tuple[object, ...]
    action_time_s: float


class InputChange(NamedTuple):
    """Request to switch an input of a simulated machine."""

    name: str
    is_on: bool


class ScreenAliveMessage(NamedTuple):
    """Report that the screen has processed its keys and drawn the state of the machine."""


class StopSocketMessage(NamedTuple):
    """Message that precedes the file descriptor of the socket for stop keys."""


class EventStoredMessage(NamedTuple):
    """Confirmation that the event with this number is stored and must not be sent again."""

    event_number: int


class CloseRequest(NamedTuple):
    """Request to stop the machine, close the drivers and end the process."""


# --- Messages from the control ----------------------------------------------------------------------------


class HelloMessage(NamedTuple):
    """First message of the control. The file descriptor of the scope's shared memory follows it."""

    protocol_version: int
    process_id: int  # number of its process
    control_identity: str  # differs from that of each other control; numbers of events belong to it
    machine: Machine  # machine of the control
    clock_zero_s: float  # zero of its clock, in s of the computer's monotonic clock
    warnings: tuple[str, ...]
    process_rights: tuple[ProcessRight, ...]  # rights that the system has granted or refused
    ring_layout: RingLayout
    disk_error: str  # reason why the scope does not write its file; empty if it does
    has_on_screen_station: bool  # whether the operator station on the screen operates this machine
    can_switch_inputs: bool  # whether the screen can switch the inputs of this machine
    snapshot: Snapshot
    interrupted_job: InterruptedJob | None  # job that a power failure would interrupt now


class ControlFailedMessage(NamedTuple):
    """Last message of a control that cannot run. The message contains the reason."""

    reason: str


class SnapshotMessage(NamedTuple):
    """Newest snapshot of the machine.

    ``has_changed`` means that the state of a machine at rest has changed.
    """

    snapshot: Snapshot
    has_changed: bool


class EventMessage(NamedTuple):
    """Event for the event log, with its number and the rows of cycles and stops that belong to it."""

    event_number: int
    event: LogEvent
    production_rows: tuple[ProductionRow, ...] = ()


class InterruptedJobMessage(NamedTuple):
    """Message with the job that a power failure would interrupt, or None if no job is running."""

    job: InterruptedJob | None


class ThreadEndedMessage(NamedTuple):
    """Report that a thread of the control process has ended unexpectedly."""

    name: str


class MachineClosedMessage(NamedTuple):
    """Report that the machine is stopped and its drivers are closed."""


def is_same_user(connection: Connection) -> bool:
    """Return whether the process at the other end of the connection belongs to the user of this process."""
    with fromfd(connection.fileno(), AF_UNIX, SOCK_STREAM) as sock, suppress(OSError):
        _, user, _ = _CREDENTIALS.unpack(sock.getsockopt(SOL_SOCKET, SO_PEERCRED, _CREDENTIALS.size))
        return bool(user == os.geteuid())
    return False
