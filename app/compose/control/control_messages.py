"""What the screen and the process of the control tell each other: pickled tuples over one socket.

Both ends belong to the same user. Times are seconds of one monotonic clock, whose zero the control states.
"""

from __future__ import annotations

import os
import struct
from contextlib import suppress
from multiprocessing.connection import Connection
from socket import AF_UNIX, SO_PEERCRED, SOCK_STREAM, SOL_SOCKET, fromfd
from typing import NamedTuple

from app.compose.control.rights import Right
from core.executor.commands import Command
from core.executor.snapshot import Event, InterruptedJob, Snapshot
from core.machine.machine_model import Machine
from core.records.record_ring import Recorded

VERSION = 2  # of these messages
BUSY = "busy"  # why a second screen is refused; it is not shown
STALE = 0.5  # s after which a press that moves something does not count any more
_CREDENTIALS = struct.Struct("3i")  # process, user, group


# --- from the screen --------------------------------------------------------------------------------------


class Post(NamedTuple):
    """Ask the executor for something. ``at`` is when it was asked for, s."""

    command: Command
    at: float


class Hand(NamedTuple):
    """Use the method of this name at the simulated operator station. ``at`` is when the hand did it, s."""

    name: str
    values: tuple[object, ...]
    at: float


class SetInput(NamedTuple):
    """Switch an input of a simulated machine."""

    name: str
    on: bool


class Alive(NamedTuple):
    """The screen has handled its keys and looked at the machine."""


class StopLine(NamedTuple):
    """After it comes the file descriptor of a socket with the records of stop keys."""


class Heard(NamedTuple):
    """The event of this number is kept: it need not be sent again."""

    number: int


class Close(NamedTuple):
    """Stop the machine, close the drivers and end the process."""


# --- from the control -------------------------------------------------------------------------------------


class Hello(NamedTuple):
    """The first message. After it comes the file descriptor of the shared memory of the scope."""

    version: int
    machine: Machine  # that the control runs
    zero: float  # of its clock: s of the monotonic clock of the computer
    warnings: tuple[str, ...]
    rights: tuple[Right, ...]  # that the system has granted and refused
    recorded: Recorded
    trouble: str  # why the scope does not write its file
    station: bool  # whether the station on the screen operates this machine
    inputs: bool  # whether its inputs can be switched from the screen
    snapshot: Snapshot
    noted: InterruptedJob | None  # what a power failure would leave interrupted now


class Failed(NamedTuple):
    """The control cannot be had, and why. It is the first and the last message."""

    why: str


class Shown(NamedTuple):
    """The newest snapshot. ``stirred``: something has changed on a machine at rest."""

    snapshot: Snapshot
    stirred: bool


class Happened(NamedTuple):
    """An event for the log, with its number."""

    number: int
    event: Event


class Noted(NamedTuple):
    """What a power failure would leave interrupted now; None: nothing."""

    job: InterruptedJob | None


class ThreadEnded(NamedTuple):
    """A thread of the control's process has ended by itself."""

    name: str


class Closed(NamedTuple):
    """The machine is stopped and its drivers are closed."""


def is_own_user(connection: Connection) -> bool:
    """Return whether the other end belongs to the user of this process."""
    with fromfd(connection.fileno(), AF_UNIX, SOCK_STREAM) as sock, suppress(OSError):
        _, user, _ = _CREDENTIALS.unpack(sock.getsockopt(SOL_SOCKET, SO_PEERCRED, _CREDENTIALS.size))
        return bool(user == os.geteuid())
    return False
