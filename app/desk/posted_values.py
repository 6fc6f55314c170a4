"""Values that were posted to the control but are not yet in its snapshot."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

ARRIVAL_TIMEOUT_S = 0.3  # Seconds within which the snapshot shows a posted value.


@dataclass(slots=True)
class PostedValues:
    """Latest value posted to the control for each name, so that two quick key presses both take effect.

    ``read_time_s`` returns monotonic time in seconds.
    """

    read_time_s: Callable[[], float]
    _posted: dict[str, tuple[float, float]] = field(default_factory=dict)

    def toggle_value(self, name: str, displayed_state: bool) -> bool:
        """Return the opposite state of a switch. The caller must post this state immediately.

        ``displayed_state`` is the state in the snapshot.
        """
        return bool(self.change_value(name, displayed_state, lambda now: not now))

    def change_value(self, name: str, displayed_value: float, change: Callable[[float], float]) -> float:
        """Return the new value that ``change`` calculates. The caller must post this value immediately.

        ``change`` is applied to the value that was posted last, or to ``displayed_value`` if no value was
        posted in the last 0.3 s.
        """
        now = self.read_time_s()
        value, at = self._posted.get(name, (displayed_value, float("-inf")))
        value = change(value if now - at < ARRIVAL_TIMEOUT_S else displayed_value)
        self._posted[name] = value, now
        return value
