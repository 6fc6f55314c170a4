"""Values that were posted to the control and are not in its snapshot yet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

ARRIVES = 0.3  # s within which the snapshot shows a value that was posted


@dataclass(slots=True)
class PostedValues:
    """The newest value by name, so that two presses in quick succession count twice.

    ``clock`` is monotonic, s.
    """

    clock: Callable[[], float]
    _posted: dict[str, tuple[float, float]] = field(default_factory=dict)

    def toggled(self, name: str, shown: bool) -> bool:
        """Return the other state of a switch that is shown like this, to be posted now."""
        return bool(self.changed(name, shown, lambda now: not now))

    def changed(self, name: str, shown: float, change: Callable[[float], float]) -> float:
        """Return the changed value, to be posted now; ``shown`` is changed where none was posted just now."""
        now = self.clock()
        value, at = self._posted.get(name, (shown, float("-inf")))
        value = change(value if now - at < ARRIVES else shown)
        self._posted[name] = value, now
        return value
