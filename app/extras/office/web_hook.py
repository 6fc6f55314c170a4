"""Webhook client that posts each announcement until the server accepts or rejects it."""

from __future__ import annotations

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from http import HTTPStatus
from http.client import HTTPException
from urllib.error import HTTPError, URLError
from urllib.request import HTTPRedirectHandler, Request

from app.extras.office.announcements import MAX_QUEUED, Announcement
from app.extras.office.timed_http import (
    Clock,
    DeliveryErrorLog,
    describe_connection_error,
    extract_origin,
    make_single_line,
    make_url_opener,
)
from app.shopfloor.status_file import StatusDocument
from core.message import Message

_PATIENCE = 5.0  # seconds
_LATER = frozenset({HTTPStatus.REQUEST_TIMEOUT, HTTPStatus.TOO_MANY_REQUESTS})
_log = logging.getLogger(__name__)


class WebhookReceiver:
    """Receiver that posts each announcement as JSON to a webhook address.

    A separate thread posts the announcements in order. After a failed connection or a server error, the
    thread posts again after ``retry_time_s`` seconds. An announcement that is rejected (4xx) or redirected
    (3xx) is discarded.
    """

    def __init__(
        self, address: str, retry_time_s: float, post_data: Callable[[str, bytes], None] | None = None
    ) -> None:
        self._address, self._again, self._post = address, retry_time_s, post_data or post_json
        self._waiting: deque[Announcement] = deque(maxlen=MAX_QUEUED)
        self._there, self._closing = threading.Event(), threading.Event()
        self._trouble = DeliveryErrorLog(_log, extract_origin(address))
        self._thread = threading.Thread(target=self._work, name="web-hook", daemon=True)
        self._thread.start()

    def send_status(self, status: StatusDocument) -> None:
        """Do nothing because a webhook receives only announcements."""

    def send_announcement(self, announcement: Announcement) -> None:
        """Queue an announcement for the thread."""
        self._waiting.append(announcement)
        self._there.set()

    def close(self) -> None:
        """Tell the thread to stop after its current post, without waiting until it stops."""
        self._closing.set()
        self._there.set()

    def _work(self) -> None:
        while not self._closing.is_set():
            self._there.wait()
            self._there.clear()
            while self._waiting:
                self._until_taken(self._waiting.popleft())

    def _until_taken(self, announcement: Announcement) -> None:
        # otherwise newer announcements displace it
        while not self._settled(announcement) and len(self._waiting) < MAX_QUEUED:
            if self._closing.wait(self._again):
                self._waiting.clear()
                return

    def _settled(self, announcement: Announcement) -> bool:
        """Post an announcement, and return whether it was accepted or rejected and needs no retry."""
        try:
            self._post(self._address, announcement.make_json())
        except (URLError, HTTPException, OSError, ValueError) as error:
            self._trouble.log_cause(_why(error))
            return isinstance(error, HTTPError) and error.code < 500 and error.code not in _LATER
        self._trouble.clear_causes()
        return True


class _Stay(HTTPRedirectHandler):
    """Handler that does not follow HTTP redirects.

    To follow a redirect, urllib would send a GET request without the data.
    """

    def redirect_request(self, *_request: object, **_more: object) -> None:
        """Return None, so that a redirect counts as a rejection."""


def post_json(address: str, data: bytes, clock: Clock = time.monotonic) -> None:
    """Post JSON data to an address.

    Raises OSError, ValueError or HTTPException if the post fails or exceeds the time limit.
    """
    request = Request(address, data, {"Content-Type": "application/json"}, method="POST")
    try:
        with make_url_opener(_Stay, clock=clock).open(request, timeout=_PATIENCE):
            return
    except HTTPError as error:
        error.close()
        raise


def _why(error: Exception) -> str:
    if isinstance(error, HTTPError):
        to = error.headers.get("Location", "") if error.code < 400 else ""
        where = (
            Message(", redirected to {to}; set [announce] hook to that address", to=extract_origin(to))
            if to
            else ""
        )
        return make_single_line(
            Message("HTTP response {code} {reason}{place}", code=error.code, reason=error.reason, place=where)
        )
    return describe_connection_error(error)
