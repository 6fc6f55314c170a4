"""Whether the executor still speaks: figures that stand still look exactly like a machine that does."""

from __future__ import annotations

from dataclasses import dataclass

SILENT_AFTER = 1.0  # seconds without another snapshot; the executor makes one every 10 ms


@dataclass(slots=True)
class Pulse:
    """Watches the time stamps of snapshots against the screen's own clock."""

    is_silent: bool = False
    _stamp: float | None = None
    _since: float = 0.0

    def silent(self, stamp: float, now: float) -> bool:
        """Whether no other snapshot than the one with this stamp has come for too long."""
        if stamp != self._stamp:
            self._stamp, self._since = stamp, now
        self.is_silent = now - self._since > SILENT_AFTER
        return self.is_silent
