"""Messages between two processes: two lengths, a JSON head, and numbers in binary form.

This module uses only the standard library, because the HAL bridge runs under the system's Python.
"""

from __future__ import annotations

import errno
import json
import os
import select
import socket
import struct
from array import array
from collections.abc import Iterator, Mapping

_LENGTHS = struct.Struct("<II")  # Lengths of the head and of the numbers in bytes.
MAX_MESSAGE_BYTES = 64_000_000  # Maximum size of a message in bytes.
_RECEIVE_SIZE = 1 << 17  # Maximum size of a packet in bytes.

MessageHead = dict[str, object]
ReceivedMessage = tuple[MessageHead, "array[float]"]


def encode_message(head: Mapping[str, object], number_bytes: bytes = b"") -> bytes:
    """Return a message encoded as bytes. ``number_bytes`` are the numbers as doubles."""
    text = json.dumps(head, separators=(",", ":")).encode()
    return _LENGTHS.pack(len(text), len(number_bytes)) + text + number_bytes


def decode_message(data: bytes) -> ReceivedMessage:
    """Return the head and the numbers of exactly one message. Raises ValueError for invalid data."""
    if len(data) < _LENGTHS.size:
        raise ValueError("the message has no lengths")
    head_end, end = _find_ends(data)
    if len(data) != end:
        raise ValueError("the message has a wrong length")
    try:
        head = json.loads(data[_LENGTHS.size : head_end])
    except RecursionError as error:
        raise ValueError("the head is nested too deeply") from error
    if not isinstance(head, dict):
        raise ValueError("the head is not an object")  # noqa: TRY004 - callers catch one kind of error
    return head, array("d", data[head_end:])


def _find_ends(data: bytes | bytearray) -> tuple[int, int]:
    """Return the positions at which the head and the message end. Raises ValueError for invalid lengths."""
    head, numbers = _LENGTHS.unpack_from(data)
    end = _LENGTHS.size + head + numbers
    if end > MAX_MESSAGE_BYTES or numbers % 8:
        raise ValueError("the message has invalid lengths")
    return _LENGTHS.size + head, end


class MessageSocket:
    """A stream or packet socket that exchanges messages with another process."""

    def __init__(self, sock: socket.socket) -> None:
        self._socket, self._bytes = sock, bytearray()
        self._has_packets = sock.type == socket.SOCK_SEQPACKET
        sock.setblocking(False)

    def fileno(self) -> int:
        """Return the file descriptor, or -1 after the socket was closed."""
        return self._socket.fileno()

    def wait(self, timeout_s: float) -> bool:
        """Wait for received data or the end of the connection, and return whether it was in time.

        The method does not wait if a complete message is left from an earlier ``receive``. Raises OSError if
        the socket is closed.
        """
        if self.fileno() < 0:
            raise OSError(errno.EBADF, os.strerror(errno.EBADF))
        size = len(self._bytes) - _LENGTHS.size
        if size >= 0 and size >= sum(_LENGTHS.unpack_from(self._bytes)):
            return True
        return bool(select.select([self._socket], [], [], timeout_s)[0])

    def receive(self) -> Iterator[ReceivedMessage]:
        """Yield every message that has arrived.

        Raises EOFError if the other process has ended, OSError if the connection fails, and ValueError for
        invalid data.
        """
        while True:
            yield from self._take_complete_messages()
            try:
                data = self._socket.recv(_RECEIVE_SIZE)
            except BlockingIOError:
                return
            if not data:
                raise EOFError
            self._bytes += data

    def _take_complete_messages(self) -> Iterator[ReceivedMessage]:
        """Yield the complete messages that were received, which may be left from an earlier call."""
        while len(self._bytes) >= _LENGTHS.size:
            end = _find_ends(self._bytes)[1]
            if len(self._bytes) < end:
                break
            message = bytes(self._bytes[:end])
            del self._bytes[:end]
            yield decode_message(message)
        if self._bytes and self._has_packets:
            raise ValueError("the packet contains an incomplete message")

    def send(self, data: bytes, timeout_s: float = 0.0) -> None:
        """Send one encoded message, and wait at most ``timeout_s`` until the other process accepts it.

        Raises OSError if it does not accept the message in time or if the connection fails.
        """
        self._socket.settimeout(timeout_s)
        try:
            self._socket.sendall(data)
        finally:
            self._socket.setblocking(False)

    def disconnect(self) -> None:
        """Shut down both directions. Any thread may call this method. Raises OSError on failure."""
        self._socket.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Close the socket."""
        self._socket.close()


def text(head: Mapping[str, object], key: str) -> str:
    """Return a string from the head of a message, or an empty string if it is missing."""
    value = head.get(key)
    return value if isinstance(value, str) else ""
