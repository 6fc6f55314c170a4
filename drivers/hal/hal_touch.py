"""Where the slides were when the input of a probe or tool setter came on: HAL samples both in one period."""

from __future__ import annotations

from core.ports import Latch


class HalTouch:
    """``core.ports.TouchInput``."""

    def __init__(self, period: float, *, active_low: bool) -> None:
        self._period, self._low = period, active_low
        self._on = False
        self._kept: Latch | None = None

    def arm(self) -> None:
        """Forget what was kept."""
        self._kept = None

    def latched(self) -> Latch | None:
        """The first touch since."""
        return self._kept

    def see(self, t: float, place: tuple[float, ...], raw: bool) -> None:
        """One period of the servo thread: its input, and where the slides were."""
        before, self._on = self._on, raw is not self._low
        if self._on and not before and self._kept is None:
            self._kept = Latch(t, place, self._period)
