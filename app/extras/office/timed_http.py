"""HTTP requests with a time limit for the whole exchange, and error texts for failed connections."""

from __future__ import annotations

import io
import logging
import socket
import ssl
import time
from collections.abc import Callable
from functools import partial
from http.client import (
    BadStatusLine,
    HTTPConnection,
    HTTPResponse,
    HTTPSConnection,
    InvalidURL,
    RemoteDisconnected,
)
from typing import Any
from urllib.error import URLError
from urllib.parse import urlsplit
from urllib.request import BaseHandler, HTTPHandler, HTTPSHandler, OpenerDirector, Request, build_opener

from core.message import Message

Clock = Callable[[], float]


class _TimedReader(io.RawIOBase):
    """Reader of a socket with a time limit.

    ``left`` is a function that returns the remaining seconds. Reading raises TimeoutError after the time
    limit.
    """

    def __init__(self, raw: io.RawIOBase, sock: socket.socket, left: Callable[[], float]) -> None:
        self._raw, self._socket, self._left = raw, sock, left

    def readable(self) -> bool:
        """Return True because this stream supports reading."""
        return True

    def readinto(self, buffer: Any, /) -> int | None:
        """Read some bytes into the buffer, and wait no longer than the remaining time."""
        if (left := self._left()) <= 0.0:
            raise TimeoutError("timed out")
        self._socket.settimeout(left)
        return self._raw.readinto(buffer)

    def close(self) -> None:
        """Close the reader and the socket."""
        self._raw.close()
        super().close()


class _TimedResponse(HTTPResponse):
    """HTTP response that must be received within a time limit.

    ``left`` is a function that returns the remaining seconds.
    """

    def __init__(self, sock: socket.socket, *args: Any, left: Callable[[], float], **more: Any) -> None:
        super().__init__(sock, *args, **more)
        raw = self.fp.detach()
        self.fp = io.BufferedReader(_TimedReader(raw, sock, left))


def _timed(kind: Callable[..., HTTPConnection], clock: Clock, host: str, **more: Any) -> HTTPConnection:
    """Return a connection with a time limit for the whole exchange. The time limit starts now."""
    connection, end = kind(host, **more), clock() + more["timeout"]
    connection.response_class = partial(_TimedResponse, left=lambda: end - clock())  # type: ignore[assignment]
    return connection


class _TimedHandler(HTTPHandler, HTTPSHandler):
    def __init__(self, clock: Clock) -> None:
        super().__init__()
        self._clock = clock

    def http_open(self, req: Request) -> HTTPResponse:
        """Open an HTTP connection without TLS."""
        return self.do_open(partial(_timed, HTTPConnection, self._clock), req)

    def https_open(self, req: Request) -> HTTPResponse:
        """Open an HTTPS connection and verify the certificate."""
        return self.do_open(partial(_timed, HTTPSConnection, self._clock), req)


def make_url_opener(
    *handlers: BaseHandler | type[BaseHandler], clock: Clock = time.monotonic
) -> OpenerDirector:
    """Return a urllib opener whose ``timeout`` also limits the whole exchange after connecting."""
    return build_opener(_TimedHandler(clock), *handlers)


MAX_CAUSE_LENGTH = 200  # characters of the other side's text in a message
NO_RESPONSE_TEXT = "no answer"
_NO_TLS = frozenset({"WRONG_VERSION_NUMBER", "RECORD_LAYER_FAILURE", "HTTP_REQUEST"})
_TLS_ALERT = "\x15\x03"
_CAUSES = 10  # reported causes of one problem, because a server can respond differently each time


def describe_connection_error(error: Exception) -> str:
    """Return the cause of a failed connection as text, without passwords and tokens.

    The operating system or the server provides the wording.
    """
    cause = error.reason if isinstance(error, URLError) else error  # URLError wraps the error of the system.
    match cause:
        case TimeoutError() if cause.errno is None:
            words = NO_RESPONSE_TEXT
        case ssl.SSLCertVerificationError():
            words = Message(
                "the server certificate cannot be verified: {verify_message}",
                verify_message=cause.verify_message,
            )
        case ssl.SSLError() if cause.reason in _NO_TLS:
            words = "the server does not support TLS; use an address that begins with http://"
        case RemoteDisconnected():
            words = "the server closed the connection without a response"
        case BadStatusLine() if str(cause).startswith(_TLS_ALERT):
            words = "the server accepts TLS only; use an address that begins with https://"
        case BadStatusLine():
            words = "the server's response is not HTTP"
        case InvalidURL():  # its message contains the address with the token
            words = "the address contains characters that are not allowed in an address"
        case _:
            words = str(getattr(cause, "strerror", None) or cause)
    return make_single_line(words)


def extract_origin(address: str) -> str:
    """Return the scheme, host and port of an address, without user name, password, path and token."""
    parts = urlsplit(address)
    return f"{parts.scheme}://{parts.netloc.rpartition('@')[2]}"


def make_single_line(text: str) -> str:
    """Return a received text as one line without control characters and with a limited length."""
    return "".join(sign for sign in text if sign.isprintable())[:MAX_CAUSE_LENGTH]


class DeliveryErrorLog:
    """Log of failed deliveries to another system.

    After a cause is logged, it is not logged again until a delivery succeeds.
    """

    def __init__(self, logger: logging.Logger, receiver_name: str) -> None:
        self._log, self._who = logger, receiver_name
        self._said = set[str]()

    def log_cause(self, cause: str) -> None:
        """Log the cause of a failed delivery.

        This method can be called from any thread.
        """
        if cause not in self._said and len(self._said) < _CAUSES:
            self._said.add(cause)
            self._log.warning("%s cannot be told: %s", self._who, cause)

    def clear_causes(self) -> None:
        """Clear the logged causes because a delivery has succeeded."""
        self._said.clear()
