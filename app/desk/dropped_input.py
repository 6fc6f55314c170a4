"""The notice that input was dropped after the screen stood still: it stays long enough to be read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.desk.translation import tr

SHOWN = 4.0  # s, after the last press that was dropped


@dataclass(slots=True)
class DroppedInput:
    """The time of the last dropped press, and the length of the stall. ``clock`` is monotonic, in seconds."""

    clock: Callable[[], float]
    _until: float = float("-inf")
    _stalled: float = 0.0

    def note(self, stalled: float) -> None:
        """Note that a press was dropped after a stall of so many seconds."""
        self._until, self._stalled = self.clock() + SHOWN, stalled

    @property
    def words(self) -> str:
        """The notice; empty when none is due."""
        if self.clock() >= self._until:
            return ""
        text = tr("NOT RESPONDING FOR {seconds} S: KEYS WERE DROPPED. WAIT A SECOND, THEN PRESS AGAIN")
        return text.format(seconds=f"{self._stalled:.1f}")
