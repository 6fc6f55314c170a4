"""Monitor of the axes' following errors, which are calculated from HAL samples."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from drivers.hal.bridge.packets import BridgeConfig
from drivers.hal.bridge.row_streams import HalPins


class FollowingErrorMonitor:
    """Monitor of following errors, which detects an axis that exceeds its limit for too long."""

    def __init__(self, config: BridgeConfig, pins: HalPins) -> None:
        self._config, self._pins = config, pins
        self._over = [0.0] * len(config.axes)  # Seconds outside the window.

    def reset(self) -> None:
        """Reset the times for which the following errors have exceeded their limits."""
        self._over = [0.0] * len(self._config.axes)

    def find_faulty_axes(self, command: Sequence[float], actual: Sequence[float]) -> Iterator[str]:
        """Check the following errors of one sample, and yield the names of the faulty axes."""
        for index, axis in enumerate(self._config.axes):
            free = axis.is_spindle and not self._pins["spindle.position_mode"]
            if free or abs(command[index] - actual[index]) <= axis.window:
                self._over[index] = 0.0
                continue
            self._over[index] += self._config.period
            if self._over[index] > axis.time:
                yield axis.name
