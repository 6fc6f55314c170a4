"""Starts the process of the control. A screen does this first: the process loads while the window opens."""

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

from core.machine.machine_model import Machine

_PATH_LENGTH = 100  # bytes of the path of a socket; Linux allows 107


class StartedControl(NamedTuple):
    """The connection to a control, and its process; None for a control that another screen has started."""

    connection: Connection
    process: subprocess.Popen[bytes] | None

    def abandon(self) -> None:
        """Kill a process whose machine has not begun to move."""
        self.connection.close()
        if self.process is not None:
            self.process.kill()
            self.process.wait()


def socket_path(folder: Path) -> Path | None:
    """Return where the control of this data folder listens for a screen.

    Returns None if the path is too long for a socket. Nobody can find such a control again.
    """
    path = folder / "control.sock"
    return path if len(os.fsencode(path)) < _PATH_LENGTH else None


def start_control(machine: Machine, folder: Path) -> StartedControl:
    """Start the process for this machine and this data folder, without waiting for it."""
    ours, theirs = socket.socketpair()
    with theirs:
        command = [
            sys.executable,
            "-m",
            "app.compose.control.control_process",
            str(theirs.fileno()),
            repr(time.monotonic()),
            str(folder),
        ]
        # A session of its own: Ctrl-C is for the screen, which then ends the control in good order.
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            pass_fds=(theirs.fileno(),),
            start_new_session=True,
        )
    assert process.stdin is not None
    with suppress(BrokenPipeError), process.stdin as pipe:  # one that has ended is told of by its connection
        pipe.write(pickle.dumps(machine))
    return StartedControl(Connection(ours.detach()), process)
