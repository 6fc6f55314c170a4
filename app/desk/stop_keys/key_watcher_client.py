"""Client in the screen's process that starts the key watcher and communicates with it.

The client sends the X window IDs of TurnDesk to the watcher and receives stops from it.
"""

from __future__ import annotations

import socket
import subprocess
import sys
from collections import deque
from collections.abc import Callable
from contextlib import suppress

from app.desk.stop_keys.stop_records import MAX_RECORD_BYTES, NO_FOCUS, FocusRecord, StopKeyPress
from core.process_environment import make_module_environment

OpenStopChannel = Callable[[], socket.socket | None]
"""Function that opens a connection to the control for stops.

It returns None if the control does not provide one.
"""
ReportEnd = Callable[[int, bool], None]
"""Function that reports that the watcher has ended, with its exit status, and whether it was restarted."""
_MODULE = "app.compose.control.key_watcher_process"
_END_TIMEOUT_S = 2.0  # Seconds.
_MAX_SENT = 64  # Number of presses.


class KeyWatcherClient:
    """Connection of the screen to the key watcher. Only the method ``close`` may block.

    If the watcher ends, it is restarted once, with another stop channel from ``open_stop_channel``.
    """

    def __init__(
        self, stop_channel: socket.socket, open_stop_channel: OpenStopChannel, report_end: ReportEnd
    ) -> None:
        self._open_stop_channel, self._report_end = open_stop_channel, report_end
        self._sent: deque[StopKeyPress] = deque(maxlen=_MAX_SENT)
        self._news: list[StopKeyPress] = []
        self._can_restart, self._is_watched = True, True
        self._start_process(stop_channel)

    def _start_process(self, stop_channel: socket.socket) -> None:
        self._screen, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self._screen.setblocking(False)
        with stop_channel, theirs:
            files = (stop_channel.fileno(), theirs.fileno())
            self._process = subprocess.Popen(
                [sys.executable, "-m", _MODULE, *map(str, files)],
                env=make_module_environment(),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                pass_fds=files,
                start_new_session=True,  # Ctrl+C must reach the screen only.
            )
        self._shown = NO_FOCUS

    def check_process(self) -> None:
        """Restart the watcher if it has ended for the first time, and report that it has ended."""
        status = self._process.poll() if self._is_watched else None
        if status is None:
            return
        self._read()
        restarts, self._can_restart = self._can_restart, False
        self._is_watched = restarts and self._restart_process()
        self._report_end(status, self._is_watched)

    def _restart_process(self) -> bool:
        """Start another watcher, and return whether this was possible."""
        with suppress(OSError):  # The system may have no memory or file descriptor left.
            channel = self._open_stop_channel()
            if channel is not None:
                self._screen.close()
                self._start_process(channel)
                return True
        return False

    def send_focus(self, focus: FocusRecord) -> None:
        """Send the focus record to the watcher if it has changed.

        The record contains the window IDs, and whether Esc starts feed hold.
        """
        if focus != self._shown:
            with suppress(OSError):
                self._screen.send(focus.to_bytes())
                self._shown = focus

    def read_sent_stops(self) -> list[StopKeyPress]:
        """Return the stop key presses that the watcher has sent to the control since the last call."""
        self._read()
        found, self._news = self._news, []
        return found

    def was_press_sent(self, press: int) -> bool:
        """Return whether the watcher has sent this key press to the control."""
        self._read()
        return press != 0 and any(stop.press_number == press for stop in self._sent)

    def _read(self) -> None:
        with suppress(OSError):
            while record := self._screen.recv(MAX_RECORD_BYTES):
                stop = StopKeyPress.from_bytes(record)
                self._sent.append(stop)
                self._news.append(stop)

    def close(self) -> None:
        """End the watcher process, and kill it if it does not end within 2 s."""
        self._is_watched = False
        self._screen.close()
        try:
            self._process.wait(_END_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
