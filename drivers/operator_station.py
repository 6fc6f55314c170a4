"""Operator stations: one without wires, and one whose buttons are inputs by the names of the machine file.

The one without wires has palms behind a two-hand relay, feed hold, E-stop, switch and pots.
"""

from __future__ import annotations

import dataclasses
import random
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import Protocol

from core.ports import Clock, Station, StationState


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

    def falls(self, now: float) -> bool:
        """Whether its output is going to fall by itself."""
        return now < self._on_until < float("inf")


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

    def settled(self, now: float) -> bool:
        """Whether it tells the same until somebody's hand is on it again."""
        pulse = now < self._hold_until or self.relay.falls(now)
        return self._silent is None and not self.noise and not pulse

    def silence(self, on: bool, now: float) -> None:
        """The station's cable is off, or on again."""
        self._silent = self.state(now) if on else None
        self._silent_since = now

    def state(self, now: float) -> StationState:
        """What the control reads; when silent, the last that came, with its age."""
        if self._silent is not None:
            estop = self._silent.estop or self.estop  # the E-stop has a wire of its own
            age = now - self._silent_since
            return dataclasses.replace(self._silent, estop=estop, start=False, age=age)
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


_WINDOW, _PULSE = 0.5, 0.1  # s, of the two-hand relay that the screen stands for


class StationHands:
    """What an operator does at a panel; every method may be called from any thread.

    ``lock`` is that of whoever reads the panel.
    """

    def __init__(self, panel: Panel, lock: AbstractContextManager[object], clock: Clock) -> None:
        self._panel, self._lock, self._clock = panel, lock, clock

    def press_left(self) -> None:
        """Left palm button down."""
        self._palm("left", down=True)

    def release_left(self) -> None:
        """Left palm button up."""
        self._palm("left", down=False)

    def press_right(self) -> None:
        """Right palm button down."""
        self._palm("right", down=True)

    def release_right(self) -> None:
        """Right palm button up."""
        self._palm("right", down=False)

    def press_start(self) -> None:
        """Both palms down together and up again."""
        self.press_left()
        self.press_right()
        self.release_left()
        self.release_right()

    def press_hold(self) -> None:
        """Feed hold button down."""
        with self._lock:
            self._panel.hold(True, self._clock.now())

    def release_hold(self) -> None:
        """Feed hold button up."""
        with self._lock:
            self._panel.hold(False, self._clock.now())

    def set_spindle_auto(self, auto: bool) -> None:
        """Spindle AUTO/OFF."""
        with self._lock:
            self._panel.spindle_auto = auto

    def set_spindle_pot(self, fraction: float) -> None:
        """Spindle override, 0…1."""
        with self._lock:
            self._panel.spindle_pot = min(max(fraction, 0.0), 1.0)

    def set_feed_pot(self, fraction: float) -> None:
        """Feed override, 0…1.5."""
        with self._lock:
            self._panel.feed_pot = min(max(fraction, 0.0), 1.5)

    def turn_handwheel(self, counts: int) -> None:
        """Turn the drawn handwheel on by so many counts, signed."""
        with self._lock:
            self._panel.handwheel += counts

    def _palm(self, which: str, *, down: bool) -> None:
        with self._lock:
            relay, now = self._panel.relay, self._clock.now()
            if down:
                relay.press(which, now)
            else:
                relay.release(which, now)


class PanelStation(StationHands):
    """Hands on one side, ``core.ports.Station`` on the other; any thread may call.

    ``inputs`` are those of the machine: its own E-stop, start and hold count as well, where it has any.
    ``wired`` is a station of which there is only a handwheel, which counts on, or the input of a load.
    """

    def __init__(
        self, clock: Clock, inputs: Callable[[], Mapping[str, bool]], wired: Station | None = None
    ) -> None:
        super().__init__(Panel(_WINDOW, _PULSE, seed=0), threading.Lock(), clock)
        self._inputs = inputs
        self._wired = wired

    def snapshot(self) -> StationState:
        """The station now."""
        with self._lock:
            state = self._panel.state(self._clock.now())
        inputs = self._inputs()
        wired = self._wired.snapshot() if self._wired is not None else StationState()
        return dataclasses.replace(
            state,
            estop=state.estop or inputs.get("estop", False),
            start=state.start or inputs.get("start", False),
            hold=state.hold or inputs.get("hold", False),
            handwheel=state.handwheel + wired.handwheel,
            spindle_load=wired.spindle_load,
            age=max(state.age, wired.age),
        )

    def press_estop(self) -> None:
        """The screen's E-stop: the control stops everything it can. It is no safety device."""
        with self._lock:
            self._panel.estop = True

    def release_estop(self) -> None:
        """Free again."""
        with self._lock:
            self._panel.estop = False


# --- A station whose buttons are inputs.


class Pot(Protocol):
    """A pot in the machine file: its values at both ends, and the input that says whether it counts."""

    @property
    def low(self) -> float: ...
    @property
    def high(self) -> float: ...
    @property
    def switch(self) -> str: ...


def station_of(
    inputs: Mapping[str, bool],
    pots: Mapping[str, Pot],
    read: Callable[[str], float],
    *,
    handwheel: int,
    age: float,
) -> StationState:
    """Return the state of the station. A button that the machine file does not have is never pressed.

    ``read`` returns the fraction of a pot's range by the name of the pot. Without an input ``spindle_auto``
    the switch of the spindle's pot says whether the spindle is on AUTO.
    """
    pot, load = pots.get("spindle_pot"), pots.get("spindle_load")
    auto = inputs.get(pot.switch, True) if pot is not None and pot.switch else True

    def override(name: str) -> float:
        return _scaled(pots[name], min(max(read(name), 0.0), 1.0)) if name in pots else 1.0

    return StationState(
        estop=inputs.get("estop", False),
        start=inputs.get("start", False),
        hold=inputs.get("hold", False),
        spindle_auto=inputs.get("spindle_auto", auto),
        spindle_pot=override("spindle_pot"),
        feed_pot=override("feed_pot"),
        handwheel=handwheel,
        age=age,
        # Per cent; what is below 0 is the noise of an idle motor.
        spindle_load=_scaled(load, max(read("spindle_load"), 0.0)) if load is not None else None,
    )


def _scaled(pot: Pot, fraction: float) -> float:
    return pot.low + (pot.high - pot.low) * fraction


# --- hands at a station in another process ----------------------------------------------------------------


def _hand(name: str) -> Callable[..., None]:
    """Return the method of this name, which is used at the station later: nobody waits."""

    def use(self: PostedHands, *values: object) -> None:
        self.post(name, *values)

    return use


class PostedHands(ABC):
    """Hands at a simulated station of another process; ``app.desk.station_hands.StationPanel`` explains them.

    A subclass has ``post``, which sends what a hand does to that process.
    """

    @abstractmethod
    def post(self, name: str, *values: object) -> None:
        """Have the method of this name used at the station. Never waits."""

    press_left, release_left = _hand("press_left"), _hand("release_left")
    press_right, release_right = _hand("press_right"), _hand("release_right")
    press_hold, release_hold = _hand("press_hold"), _hand("release_hold")
    press_estop, release_estop = _hand("press_estop"), _hand("release_estop")
    set_spindle_auto, set_spindle_pot = _hand("set_spindle_auto"), _hand("set_spindle_pot")
    set_feed_pot, turn_handwheel = _hand("set_feed_pot"), _hand("turn_handwheel")
