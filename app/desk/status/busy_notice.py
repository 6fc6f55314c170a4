"""Message to the operator when a busy computer delays feed hold."""

from __future__ import annotations

from collections.abc import Callable

from app.desk.translation import tr
from core.executor.snapshot import Snapshot
from core.message import Message


class BusyNotice:
    """Notice to the operator that feed hold reacts late because the computer is busy.

    The notice appears once in each busy period, and again if the delay has doubled. ``show_message`` shows
    a text on the prompt line.
    """

    def __init__(self, show_message: Callable[[str], None]) -> None:
        self._say = show_message
        self._told = 0.0  # s

    def check_snapshot(self, snapshot: Snapshot) -> None:
        """Check the feed hold delay in a snapshot, and show the notice if necessary.

        The screen calls this method once per frame.
        """
        later = snapshot.hold_delay_s
        if later == 0.0:
            self._told = 0.0
        elif self._told == 0.0 or later >= 2.0 * self._told:
            self._told = later
            words = tr("COMPUTER BUSY: HOLD REACTS {seconds} S LATER")
            self._say(tr(Message(words, seconds=f"{later:.1f}")))
