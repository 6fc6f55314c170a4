"""The operator station: two palm buttons behind a two-hand relay, hold, latching E-stop, switch and pots."""

from __future__ import annotations

import random

from core.ports import StationState


class TwoHandRelay:
    """Both palms within ``window`` seconds, and both let go before it works again (anti-tie-down).

    On a real machine this is a safety relay; the control sees its one output and never the palms.
    """

    def __init__(self, window: float, pulse: float) -> None:
        self._window = window
        self._pulse = pulse
        self._down: dict[str, float | None] = {"left": None, "right": None}
        self._armed = True
        self._on_from = -1.0
        self._on_until = -1.0

    def press(self, palm: str, now: float) -> None:
        """A palm goes down."""
        if self._down[palm] is not None:
            return
        self._down[palm] = now
        left, right = self._down["left"], self._down["right"]
        if left is None or right is None:
            return
        if self._armed and abs(left - right) <= self._window:
            self._on_from, self._on_until = now, float("inf")
        self._armed = False

    def release(self, palm: str, now: float) -> None:
        """A palm comes up: the output falls, but not before a pulse that a scan can see."""
        self._down[palm] = None
        if self._on_until > now:
            self._on_until = max(now, self._on_from + self._pulse)
        if all(since is None for since in self._down.values()):
            self._armed = True

    def output(self, now: float) -> bool:
        """The relay's contact."""
        return self._on_from <= now < self._on_until


class Panel:
    """Everything on the station, as the operator's hands leave it."""

    def __init__(self, window: float, pulse: float, seed: int) -> None:
        self.relay = TwoHandRelay(window, pulse)
        self.estop = False
        self.spindle_auto = True
        self.spindle_pot = 1.0
        self.feed_pot = 1.0
        self.handwheel = 0  # counts
        self.noise = 0.0  # half width of what a bad wiper adds to the pots
        self._pulse = pulse
        self._hold_down = False
        self._hold_until = -1.0
        self._silent: StationState | None = None
        self._silent_since = 0.0
        self._random = random.Random(seed)

    def hold(self, down: bool, now: float) -> None:
        """Feed hold button; seen for one pulse at least."""
        self._hold_down = down
        if down:
            self._hold_until = now + self._pulse

    def silence(self, on: bool, now: float) -> None:
        """The station's cable is off, or on again."""
        self._silent = self.state(now) if on else None
        self._silent_since = now

    def state(self, now: float) -> StationState:
        """What the control reads; when silent, the last that came, with its age."""
        if self._silent is not None:
            return StationState(
                estop=self._silent.estop or self.estop,  # the E-stop has a wire of its own
                hold=self._silent.hold,
                spindle_auto=self._silent.spindle_auto,
                spindle_pot=self._silent.spindle_pot,
                feed_pot=self._silent.feed_pot,
                handwheel=self._silent.handwheel,
                age=now - self._silent_since,
            )
        return StationState(
            estop=self.estop,
            start=self.relay.output(now),
            hold=self._hold_down or now < self._hold_until,
            spindle_auto=self.spindle_auto,
            spindle_pot=self._noisy(self.spindle_pot, 1.0),
            feed_pot=self._noisy(self.feed_pot, 1.5),
            handwheel=self.handwheel,
        )

    def _noisy(self, value: float, top: float) -> float:
        if not self.noise:
            return value
        return min(max(value + self._random.uniform(-self.noise, self.noise), 0.0), top)
