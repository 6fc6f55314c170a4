"""Values that were posted to the control and are not in its snapshot yet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

ARRIVES = 0.3  # Seconds within which the snapshot shows a posted value.


@dataclass(slots=True)
class PostedValues:
    """The newest posted value of each name, so that two quick key presses count twice.

    ``clock`` returns monotonic time in seconds.
    """

    clock: Callable[[], float]
    _posted: dict[str, tuple[float, float]] = field(default_factory=dict)

    def toggled(self, name: str, shown: bool) -> bool:
        """Return the opposite state of a switch, to be posted now. ``shown`` is the state in the snapshot."""
        return bool(self.changed(name, shown, lambda now: not now))

    def changed(self, name: str, shown: float, change: Callable[[float], float]) -> float:
        """Return the value after ``change``, to be posted now.

        The change applies to the value that was posted last, or to ``shown`` if no value was posted in the
        last 0.3 s.
        """
        now = self.clock()
        value, at = self._posted.get(name, (shown, float("-inf")))
        value = change(value if now - at < ARRIVES else shown)
        self._posted[name] = value, now
        return value
