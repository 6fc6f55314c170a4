"""The thread that repeats the attendant's rounds. Its end is seen by whoever asks for the spindle's fault."""

from __future__ import annotations

import threading

from drivers.inverter.attendant import Attendant

_END = 3.0  # s: the longest exchange and its retries


class Keeper:
    """Rounds without a pause: the line itself keeps the pace of its requests."""

    def __init__(self, attendant: Attendant) -> None:
        self._attendant = attendant
        self._ended = threading.Event()
        self.thread = threading.Thread(target=self._keep, name="inverter", daemon=True)

    def start(self) -> None:
        """Once."""
        self.thread.start()

    @property
    def alive(self) -> bool:
        """Whether it still goes round."""
        return self.thread.is_alive()

    def close(self) -> None:
        """The last word on the line is a stop."""
        self._ended.set()
        if self.thread.is_alive():
            self.thread.join(_END)
        self._attendant.close()

    def _keep(self) -> None:
        while not self._ended.is_set():
            self._attendant.round()
