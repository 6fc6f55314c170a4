"""Connections of browsers to the status page: limited in number, each with a deadline for its request.

Imported only where waitress is installed.
"""

from __future__ import annotations

import socket
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, cast

from waitress.channel import HTTPChannel

if TYPE_CHECKING:
    from waitress.adjustments import Adjustments
    from waitress.server import BaseWSGIServer

DEADLINE = 10.0  # s for a whole request, and for reading the whole answer
MOST = 100  # connections in all
MOST_OF_ONE = 20  # connections of one address; a browser opens six
_NO_HTTP = b"?\r\n\r\n"  # what waitress refuses as a bad request


class Connection(HTTPChannel):
    """One browser; ``since`` is when it connected or was answered last.

    A new connection beyond a limit ends the oldest one that is not being answered. So whoever asks a whole
    question at once is answered, however many others hold theirs back.
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
        self._clock, self.since = clock, clock()
        super().__init__(server, sock, addr, adj, map)
        self._make_room()

    def received(self, data: bytes) -> bool:
        """Take bytes of a request; those that waitress cannot parse are a bad request."""
        try:
            return bool(super().received(data))
        except ValueError:
            self.request = None
            return bool(super().received(_NO_HTTP))

    def service(self) -> None:
        """Answer; the time for reading the answer and for the next request begins now."""
        super().service()
        self.since = self._clock()

    def end_if_late(self) -> None:
        """End a connection that has used up its time while nothing here kept it waiting."""
        if not self.requests and self._clock() - self.since > DEADLINE:
            self.will_close = True

    def _make_room(self) -> None:
        channels = cast("dict[int, Connection]", self.server.active_channels)
        others = [each for each in channels.values() if each is not self and not each.will_close]
        near = [each for each in others if each.addr[0] == self.addr[0]]
        for crowd, most in ((near, MOST_OF_ONE), (others, MOST)):
            if len(crowd) >= most:
                waiting = (each for each in crowd if not each.requests)
                min(waiting, key=lambda each: each.since, default=self).will_close = True
