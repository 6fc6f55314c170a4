"""Handle of a process on this computer, including a process that another process started."""

from __future__ import annotations

import errno
import os
import select
import signal
from contextlib import suppress


class ProcessHandle:
    """Handle of one operating system process.

    The handle still refers to this process after the system has reused its process number.
    """

    def __init__(self, process_id: int) -> None:
        self._file: int | None = None
        self._has_ended = False
        try:
            self._file = os.pidfd_open(process_id)
        except OSError as error:
            self._has_ended = error.errno == errno.ESRCH

    def kill_process(self, timeout_s: float) -> bool:
        """Kill the process with SIGKILL, and return whether it ends within ``timeout_s``."""
        if self._file is None:
            return self._has_ended
        with suppress(OSError):
            signal.pidfd_send_signal(self._file, signal.SIGKILL)
        return self.wait_for_end(timeout_s)

    def wait_for_end(self, timeout_s: float) -> bool:
        """Wait at most ``timeout_s`` for the process to end, and return whether it has ended."""
        if self._file is None:
            return self._has_ended
        return bool(select.select([self._file], [], [], timeout_s)[0])

    def close(self) -> None:
        """Release the handle."""
        if self._file is not None:
            os.close(self._file)
            self._file = None
