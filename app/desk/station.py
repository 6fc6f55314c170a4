"""The simulated operator station as the desk handles it, and its two palm buttons under two hands."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

TOGETHER = 0.5  # seconds within which the second palm button must follow the first


class StationPanel(Protocol):
    """What a hand can do to the simulated station. Whether both palms came together the station says."""

    def press_left(self) -> None: ...

    def release_left(self) -> None: ...

    def press_right(self) -> None: ...

    def release_right(self) -> None: ...

    def press_hold(self) -> None: ...

    def release_hold(self) -> None: ...

    def press_estop(self) -> None: ...

    def release_estop(self) -> None:
        """Twist the mushroom out again."""
        ...

    def set_spindle_auto(self, auto: bool) -> None: ...

    def set_spindle_pot(self, fraction: float) -> None:
        """0…1."""
        ...

    def set_feed_pot(self, fraction: float) -> None:
        """0…1.5."""
        ...

    def turn_handwheel(self, counts: int) -> None:
        """Signed; only where the machine has a handwheel."""
        ...


@dataclass(slots=True)
class Palms:
    """Which palm buttons are down and since when; tells a person what was wrong with a start.

    A pair that did not come within the time, or one let go while the other stays, is dead until both are up:
    a palm that is taped down starts nothing.
    """

    down: dict[str, float] = field(default_factory=dict)  # "left"/"right" → seconds, monotonic
    together: bool = False  # both have been down at once since the last time none was
    dead: bool = False

    def press(self, side: str, now: float) -> bool:
        """Note a press; True when this made both go down within the time."""
        if side in self.down:
            return False
        self.down[side] = now
        times = self.down.values()
        if len(self.down) < 2:
            return False
        self.dead = self.dead or max(times) - min(times) > TOGETHER
        self.together = self.together or not self.dead
        return not self.dead

    def release(self, side: str) -> bool:
        """Note a release; True when a button was let go that never had the other beside it in time."""
        if self.down.pop(side, None) is None:
            return False
        alone = not self.together
        self.dead = bool(self.down)
        if not self.down:
            self.together = False
        return alone


SLEW = 1.0  # of the whole range a second: faster than that a control takes it for a bad wiper, not for a hand


@dataclass(slots=True)
class Pot:
    """A pot on the screen: ``wanted`` jumps with the finger, ``value`` turns after it as a knob can."""

    most: float
    wanted: float = 1.0
    value: float = 1.0

    def set(self, fraction: float) -> None:
        """Where it shall stand."""
        self.wanted = max(0.0, min(self.most, fraction))

    def turn(self, seconds: float) -> bool:
        """Turn on for so long; True when it has moved."""
        if self.value == self.wanted:
            return False
        step = SLEW * seconds
        self.value += max(-step, min(step, self.wanted - self.value))
        return True
