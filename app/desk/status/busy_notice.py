"""Tells the operator once that the computer is so busy that a feed hold reacts later."""

from __future__ import annotations

from collections.abc import Callable

from app.desk.translation import tr
from core.executor.snapshot import Snapshot
from core.message import Message


class BusyNotice:
    """Looks at every snapshot; ``say`` shows a text on the prompt line.

    It tells once for each busy time, and again if the delay has doubled.
    """

    def __init__(self, say: Callable[[str], None]) -> None:
        self._say = say
        self._told = 0.0  # s

    def see(self, snapshot: Snapshot) -> None:
        """Look at a snapshot; called once a frame."""
        later = snapshot.hold_later
        if later == 0.0:
            self._told = 0.0
        elif self._told == 0.0 or later >= 2.0 * self._told:
            self._told = later
            words = tr("COMPUTER BUSY: HOLD REACTS {seconds} S LATER")
            self._say(tr(Message(words, seconds=f"{later:.1f}")))
