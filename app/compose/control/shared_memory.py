"""Memory that the control shares with its screen: it needs no file and ends with the last of both."""

from __future__ import annotations

import mmap
import os
from multiprocessing.connection import Connection
from socket import AF_UNIX, SOCK_STREAM, fromfd, recv_fds, send_fds

_MARK = b"m"


class SharedMemory:
    """Memory behind a file descriptor; ``view`` is its bytes."""

    def __init__(self, file: int) -> None:
        self._file = file
        self.view = memoryview(mmap.mmap(file, 0))

    @classmethod
    def of_size(cls, size: int) -> SharedMemory:
        """Return new memory of so many bytes, all of them zero. Raises OSError."""
        file = os.memfd_create("turndesk-scope")
        os.ftruncate(file, size)
        return cls(file)

    def send_to(self, connection: Connection) -> None:
        """Share the memory with the process at the other end. Raises OSError."""
        with fromfd(connection.fileno(), AF_UNIX, SOCK_STREAM) as sock:
            send_fds(sock, [_MARK], [self._file])

    @classmethod
    def received_from(cls, connection: Connection) -> SharedMemory:
        """Return the memory that the process at the other end shares. Raises OSError and EOFError."""
        with fromfd(connection.fileno(), AF_UNIX, SOCK_STREAM) as sock:
            _, files, _, _ = recv_fds(sock, len(_MARK), 1)
        if not files:
            raise EOFError
        return cls(files[0])
