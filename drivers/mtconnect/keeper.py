"""The thread in which the adapter lives."""

from __future__ import annotations

import logging
import threading

from drivers.mtconnect.adapter import LOOK, Adapter

_BREATH = 0.005  # s between two turns: an agent that floods takes no more than that of this computer

_log = logging.getLogger(__name__)


class Keeper:
    """Turns the adapter until it is closed. Should it fail, agents are hung up on and so know it."""

    def __init__(self, adapter: Adapter) -> None:
        self._adapter = adapter
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._keep, name="mtconnect", daemon=True)

    @property
    def alive(self) -> bool:
        """Whether it still tells."""
        return self._thread.is_alive()

    def start(self) -> None:
        """Open the port, then begin. Raises DriverError where it cannot be opened; no thread is left then."""
        self._adapter.open()
        self._thread.start()

    def close(self) -> None:
        """Hang up, and end the thread; within a tenth of a second."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join()

    def _keep(self) -> None:
        try:
            while not self._closing.wait(_BREATH):
                self._adapter.turn(LOOK)
            self._adapter.look()  # how it ended is worth knowing too
        finally:
            if not self._closing.is_set():
                _log.error("there is no shop-floor data any more: a mistake of the control", exc_info=True)
            self._adapter.close()
