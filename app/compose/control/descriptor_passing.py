"""Passing of file descriptors for shared memory and the stop-key socket through a connection."""

from __future__ import annotations

import mmap
import os
import threading
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection
from socket import AF_UNIX, SOCK_SEQPACKET, SOCK_STREAM, fromfd, recv_fds, send_fds, socket

from app.desk.stop_keys.stop_records import MAX_RECORD_BYTES, StopKeyPress

_MARK = b"f"  # a descriptor must be sent together with a byte


def send_descriptor(connection: Connection, descriptor: int) -> None:
    """Send a file descriptor to the process at the other end. Raises OSError if the connection ends."""
    with fromfd(connection.fileno(), AF_UNIX, SOCK_STREAM) as sock:
        send_fds(sock, [_MARK], [descriptor])


def receive_descriptor(connection: Connection) -> int:
    """Return the file descriptor that the other process sends.

    Raises OSError or EOFError if the connection ends.
    """
    with fromfd(connection.fileno(), AF_UNIX, SOCK_STREAM) as sock:
        _, files, _, _ = recv_fds(sock, len(_MARK), 1)
    if not files:
        raise EOFError
    return files[0]


class SharedMemory:
    """Anonymous shared memory, which exists until the last process closes it.

    ``memory_view`` is a view of its bytes.
    """

    def __init__(self, descriptor: int) -> None:
        self.descriptor = descriptor
        self.memory_view = memoryview(mmap.mmap(descriptor, 0))

    @classmethod
    def create(cls, size_bytes: int) -> SharedMemory:
        """Return new shared memory of ``size_bytes`` bytes, all set to zero.

        Raises OSError if the memory cannot be allocated.
        """
        file = os.memfd_create("turndesk-scope")
        os.ftruncate(file, size_bytes)
        return cls(file)


def handle_stop_keys(stop_socket: int, request_stop: Callable[[StopKeyPress], None]) -> None:
    """Call ``request_stop`` for each stop key received from ``stop_socket``, until the socket closes.

    A separate thread receives the keys and calls ``request_stop``, independently of the screen's state.
    """
    sock = socket(AF_UNIX, SOCK_SEQPACKET, fileno=stop_socket)
    threading.Thread(target=_obey, args=(sock, request_stop), name="stop-keys", daemon=True).start()


def _obey(line: socket, stop: Callable[[StopKeyPress], None]) -> None:
    with line, suppress(OSError):
        while record := line.recv(MAX_RECORD_BYTES):
            with suppress(ValueError):  # =
                stop(StopKeyPress.from_bytes(record))
