"""Where the slides were when the input of a probe or tool setter came on, by the answers to each SYNC."""

from __future__ import annotations

from core.ports import PROBE, Latch
from drivers.canopen.canopen_axes import CanopenAxes
from drivers.canopen.canopen_terminals import CanopenIO

_LATE = 2  # SYNCs: a module answers one with what it had at the one before


class CanopenProbe:
    """``core.ports.TouchInput``. The drives' own latch (60B8) is not used: few have its input free."""

    def __init__(self, axes: CanopenAxes, io: CanopenIO, sync: float) -> None:
        self._axes, self._io, self._sync = axes, io, sync
        self._made = False
        self._kept: Latch | None = None

    def arm(self) -> None:
        """Forget what was kept."""
        self._kept = None

    def latched(self) -> Latch | None:
        """The first touch since."""
        return self._kept

    def note(self) -> None:
        """Once a round of the loop that owns the bus."""
        before, self._made = self._made, self._io.inputs()[PROBE]
        if self._made and not before and self._kept is None:
            sample = self._axes.sample()
            self._kept = Latch(sample.t, sample.actual, _LATE * self._sync)
