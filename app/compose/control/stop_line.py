"""The line of the stop keys at the control, which obeys them whatever the screen does meanwhile."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from socket import AF_UNIX, SOCK_SEQPACKET, SOCK_STREAM, fromfd, recv_fds, send_fds, socket

from app.desk.stop_keys.stop_records import LONGEST, Stop

_MARK = b"s"


def send_line(connection: Connection, line: socket) -> None:
    """Give this end of a line to the control. Raises OSError."""
    with fromfd(connection.fileno(), AF_UNIX, SOCK_STREAM) as sock, line:
        send_fds(sock, [_MARK], [line.fileno()])


def obey_line(connection: Connection, stop: Callable[[Stop], None]) -> None:
    """Take a line from the screen, and call ``stop`` on a thread for each record until the line ends.

    Raises OSError and EOFError.
    """
    with fromfd(connection.fileno(), AF_UNIX, SOCK_STREAM) as sock:
        _, files, _, _ = recv_fds(sock, len(_MARK), 1)
    if not files:
        raise EOFError
    line = socket(AF_UNIX, SOCK_SEQPACKET, fileno=files[0])
    threading.Thread(target=_obey, args=(line, stop), name="stop-keys", daemon=True).start()


def _obey(line: socket, stop: Callable[[Stop], None]) -> None:
    with line, suppress(OSError):
        while record := line.recv(LONGEST):
            with suppress(ValueError):  # a record of another version
                stop(Stop.unpacked(record))
