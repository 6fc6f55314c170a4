"""Values that were posted to the control but are not yet in its snapshot."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

ARRIVAL_TIMEOUT_S = 0.3  # Seconds within which the snapshot shows a posted value.


@dataclass(slots=True)
class PostedValues:
    """Newest posted value of each name, so that two quick key presses both take effect.

    ``clock`` returns monotonic time in seconds.
    """

    clock: Callable[[], float]
    _posted: dict[str, tuple[float, float]] = field(default_factory=dict)

    def toggle_value(self, name: str, displayed: bool) -> bool:
        """Return the opposite state of a switch, which the caller posts immediately.

        ``displayed`` is the state in the snapshot.
        """
        return bool(self.change_value(name, displayed, lambda now: not now))

    def change_value(self, name: str, displayed: float, change: Callable[[float], float]) -> float:
        """Return the value after ``change``, which the caller posts immediately.

        The change applies to the value that was posted last, or to ``displayed`` if no value was posted in
        the last 0.3 s.
        """
        now = self.clock()
        value, at = self._posted.get(name, (displayed, float("-inf")))
        value = change(value if now - at < ARRIVAL_TIMEOUT_S else displayed)
        self._posted[name] = value, now
        return value
