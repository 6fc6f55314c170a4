"""Start of the control process.

A screen starts this process before anything else, so that the process loads while the window opens.
"""

from __future__ import annotations

import os
import pickle
import socket
import subprocess
import sys
import time
from contextlib import suppress
from multiprocessing.connection import Connection
from pathlib import Path
from typing import NamedTuple

from core.file_lock import is_written_elsewhere
from core.machine.machine_model import Machine
from core.process_environment import make_module_environment

_PATH_LENGTH = 100  # =
# names of the places of controls in a data folder; see control_slot.py
SLOT_NAMES = ("control", "control-2", "control-3", "control-4")
# s for the driver host of a killed control to end: 2 s for its queue, 8 s for the spindle, 15 s for HAL
DRIVERS_TIMEOUT_S = 25.0


class StartedControl(NamedTuple):
    """Connection to a control and its process. The process is None if a different screen started it."""

    connection: Connection
    process: subprocess.Popen[bytes] | None

    def kill_process(self) -> None:
        """Close the connection and kill the process. Call this method only before the machine has moved."""
        self.connection.close()
        if self.process is not None:
            self.process.kill()
            self.process.wait()


def list_socket_paths(folder: Path) -> list[Path]:
    """Return the paths of the sockets at which controls of this data folder listen.

    The usual path is the first. The list is empty if the paths are too long for a socket. Another screen
    cannot find such a control.
    """
    paths = [folder / f"{name}.sock" for name in SLOT_NAMES]
    return paths if all(len(os.fsencode(path)) < _PATH_LENGTH for path in paths) else []


def is_control_running(folder: Path) -> bool:
    """Return whether a control of this data folder is running, or the drivers of a killed control."""
    locks = (folder / f"{name}{ending}" for name in SLOT_NAMES for ending in (".lock", "-drivers.lock"))
    return any(path.exists() and is_written_elsewhere(path) for path in locks)


def start_control(machine: Machine, folder: Path, clock_zero_s: float | None = None) -> StartedControl:
    """Start the control process for this machine and data folder without waiting until it is ready.

    ``clock_zero_s`` is the time zero of the control's clock, in seconds of the computer's monotonic clock.
    If it is None, the clock starts at zero now.
    """
    ours, theirs = socket.socketpair()
    with theirs:
        command = [
            sys.executable,
            "-m",
            "app.compose.control.control_process",
            str(theirs.fileno()),
            repr(time.monotonic() if clock_zero_s is None else clock_zero_s),
            str(folder),
        ]
        # A separate session, so that Ctrl-C reaches only the screen, which then ends the control properly.
        process = subprocess.Popen(
            command,
            env=make_module_environment(),
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            pass_fds=(theirs.fileno(),),
            start_new_session=True,
        )
    assert process.stdin is not None
    # a process that has ended is reported by its connection
    with suppress(BrokenPipeError), process.stdin as pipe:
        pipe.write(pickle.dumps(machine))
    return StartedControl(Connection(ours.detach()), process)
