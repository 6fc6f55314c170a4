"""Browser connections of the status page, with limits on their number and on the request time.

This module is imported only if waitress is installed.
"""

from __future__ import annotations

import socket
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

from waitress.channel import HTTPChannel

if TYPE_CHECKING:
    from waitress.adjustments import Adjustments
    from waitress.server import BaseWSGIServer

REQUEST_DEADLINE_S = 10.0  # seconds for a whole request, and for reading the whole response
MAX_CONNECTIONS = 100  # total connections
MAX_CONNECTIONS_PER_HOST = 20  # connections of one address; a browser opens six
_NO_HTTP = b"?\r\n\r\n"  # data that waitress rejects as a bad request


class BrowserConnection(HTTPChannel):
    """Connection of a browser to the status page.

    If a new connection exceeds the maximum number, the oldest connection without a request in progress is
    closed. Incomplete requests therefore cannot block other browsers. ``last_activity_s`` is the time of
    the connection or of the last response.
    """

    def __init__(
        self,
        server: BaseWSGIServer,
        sock: socket.socket,
        addr: Any,
        adj: Adjustments,
        map: Any = None,
        *,
        clock: Callable[[], float],
    ) -> None:
        self._clock, self.last_activity_s = clock, clock()
        super().__init__(server, sock, addr, adj, map)
        self._make_room()

    def received(self, data: bytes) -> bool:
        """Process received bytes.

        Bytes that cannot be parsed are treated as a bad request.
        """
        try:
            return bool(super().received(data))
        except ValueError:
            self.request = None
            return bool(super().received(_NO_HTTP))

    def service(self) -> None:
        """Send the response and restart the time limit for the next request."""
        super().service()
        self.last_activity_s = self._clock()

    def end_if_late(self) -> None:
        """Close the connection if its time limit has expired and no request is in progress."""
        if not self.requests and self._clock() - self.last_activity_s > REQUEST_DEADLINE_S:
            self.will_close = True

    def _make_room(self) -> None:
        channels = cast("dict[int, BrowserConnection]", self.server.active_channels)
        others = [each for each in channels.values() if each is not self and not each.will_close]
        near = [each for each in others if each.addr[0] == self.addr[0]]
        for crowd, most in ((near, MAX_CONNECTIONS_PER_HOST), (others, MAX_CONNECTIONS)):
            if len(crowd) >= most:
                waiting = (each for each in crowd if not each.requests)
                min(waiting, key=lambda each: each.last_activity_s, default=self).will_close = True
