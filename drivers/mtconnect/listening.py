"""The socket at which agents come in."""

from __future__ import annotations

import os
import socket

from core.ports import DriverError

_BACKLOG = 4
_SEND = 64 * 1024  # bytes that the system may keep for a slow agent: what it reads is never hours old
_UNANSWERED = 30_000  # ms without a word of the other computer after which it counts as gone


def listening(bind: str, port: int) -> socket.socket:
    """Bound and listening. Raises DriverError with what is in the way."""
    try:
        family, kind, proto, _, address = socket.getaddrinfo(
            bind, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE
        )[0]
        wire = socket.socket(family, kind, proto)
    except OSError as error:
        raise DriverError(f"[mtconnect] bind = {bind!r} is no address here: {error.strerror}") from error
    try:
        if os.name == "posix":  # elsewhere this would share a port that somebody else has
            wire.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        wire.bind(address)
        wire.listen(_BACKLOG)
    except OSError as error:
        wire.close()
        raise DriverError(
            f"[mtconnect] {bind} port {port} cannot be opened ({error.strerror}): "
            "choose another port, or end the program that has it"
        ) from error
    wire.setblocking(False)
    return wire


def accepted(door: socket.socket) -> socket.socket:
    """Who is at the door, not waiting for it. Raises OSError where nobody is there any more."""
    wire, _ = door.accept()
    try:
        _tune(wire)
    except OSError:
        wire.close()
        raise
    return wire


def _tune(wire: socket.socket) -> None:
    """The other end may vanish without a word, and lines go out at once."""
    wire.setblocking(False)
    wire.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    wire.setsockopt(socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1)
    wire.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND)
    if hasattr(socket, "TCP_USER_TIMEOUT"):
        wire.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, _UNANSWERED)
    if hasattr(socket, "TCP_KEEPIDLE"):
        for option, value in ((socket.TCP_KEEPIDLE, 10), (socket.TCP_KEEPINTVL, 5), (socket.TCP_KEEPCNT, 4)):
            wire.setsockopt(socket.IPPROTO_TCP, option, value)
