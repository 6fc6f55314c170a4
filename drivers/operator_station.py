"""Operator stations of simulated and real machines.

A simulated or on-screen station has palm buttons with a two-hand relay, feed hold, E-stop, a spindle switch
and pots. The buttons and pots of a wired station are inputs of the machine file.
"""

from __future__ import annotations

import dataclasses
import random
import threading
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import Protocol

from core.ports import Clock, OperatorStation, StationState


class TwoHandRelay:
    """Two-hand relay that turns on only if both palm buttons are pressed within ``window_s`` seconds.

    Both buttons must be released before the next start (anti-tie-down). On a real machine, this is a safety
    relay, and the control reads only its output.
    """

    def __init__(self, window_s: float, pulse_s: float) -> None:
        self._window = window_s
        self._pulse = pulse_s
        self._down: dict[str, float | None] = {"left": None, "right": None}
        self._armed = True
        self._on_from = -1.0
        self._on_until = -1.0

    def press_palm_button(self, palm: str, now_s: float) -> None:
        """Press the palm button ``palm``, "left" or "right", at time ``now_s`` in seconds."""
        if self._down[palm] is not None:
            return
        self._down[palm] = now_s
        left, right = self._down["left"], self._down["right"]
        if left is None or right is None:
            return
        if self._armed and abs(left - right) <= self._window:
            self._on_from, self._on_until = now_s, float("inf")
        self._armed = False

    def release_palm_button(self, palm: str, now_s: float) -> None:
        """Release a palm button and turn the relay output off.

        If the minimum pulse has not ended yet, the output turns off at the end of this pulse.
        """
        self._down[palm] = None
        if self._on_until > now_s:
            self._on_until = max(now_s, self._on_from + self._pulse)
        if all(since is None for since in self._down.values()):
            self._armed = True

    def is_output_on(self, now: float) -> bool:
        """Return whether the relay output is on at time ``now``."""
        return self._on_from <= now < self._on_until

    def will_output_turn_off(self, now: float) -> bool:
        """Return whether the output is on and will turn off when its minimum pulse ends."""
        return now < self._on_until < float("inf")


class PanelState:
    """State of all controls of a simulated operator station."""

    def __init__(self, window_s: float, pulse_s: float, seed: int) -> None:
        self.relay = TwoHandRelay(window_s, pulse_s)
        self.estop = False
        self.spindle_auto = True
        self.spindle_pot = 1.0
        self.feed_pot = 1.0
        self.handwheel = 0  # counts
        self.noise_amplitude = 0.0  # Half width of the noise of the pots.
        self._pulse = pulse_s
        self._hold_down = False
        self._hold_until = -1.0
        self._silent: StationState | None = None
        self._silent_since = 0.0
        self._random = random.Random(seed)

    def set_feed_hold_button(self, pressed: bool, now: float) -> None:
        """Press or release the feed hold button.

        The station reports the button as pressed for at least one minimum pulse.
        """
        self._hold_down = pressed
        if pressed:
            self._hold_until = now + self._pulse

    def is_state_constant(self, now: float) -> bool:
        """Return whether the reported state will not change before the next action of the operator."""
        pulse = now < self._hold_until or self.relay.will_output_turn_off(now)
        return self._silent is None and not self.noise_amplitude and not pulse

    def set_cable_disconnected(self, disconnected: bool, now: float) -> None:
        """Disconnect the cable of the station if ``disconnected`` is true, otherwise reconnect it."""
        self._silent = self.state(now) if disconnected else None
        self._silent_since = now

    def state(self, now: float) -> StationState:
        """Return the station state that the control reads.

        A disconnected station returns its last state and the age of that state.
        """
        if self._silent is not None:
            estop = self._silent.estop or self.estop  # The E-stop has a separate wire.
            age = now - self._silent_since
            return dataclasses.replace(self._silent, estop=estop, start=False, age=age)
        return StationState(
            estop=self.estop,
            start=self.relay.is_output_on(now),
            hold=self._hold_down or now < self._hold_until,
            spindle_auto=self.spindle_auto,
            spindle_pot=self._noisy(self.spindle_pot, 1.0),
            feed_pot=self._noisy(self.feed_pot, 1.5),
            handwheel=self.handwheel,
        )

    def _noisy(self, value: float, top: float) -> float:
        if not self.noise_amplitude:
            return value
        return min(max(value + self._random.uniform(-self.noise_amplitude, self.noise_amplitude), 0.0), top)


_WINDOW, _PULSE = 0.5, 0.1  # Seconds; two-hand relay that the screen replaces.


class StationControls:
    """Actions of the operator at a simulated or on-screen station.

    Any thread may call the methods, because they acquire ``lock``, as the reader of the station does.
    """

    def __init__(self, panel: PanelState, lock: AbstractContextManager[object], clock: Clock) -> None:
        self._panel, self._lock, self._clock = panel, lock, clock

    def press_left(self) -> None:
        """Press the left palm button."""
        self._palm("left", down=True)

    def release_left(self) -> None:
        """Release the left palm button."""
        self._palm("left", down=False)

    def press_right(self) -> None:
        """Press the right palm button."""
        self._palm("right", down=True)

    def release_right(self) -> None:
        """Release the right palm button."""
        self._palm("right", down=False)

    def press_start(self) -> None:
        """Press both palm buttons at the same time and release both."""
        self.press_left()
        self.press_right()
        self.release_left()
        self.release_right()

    def press_hold(self) -> None:
        """Press the feed hold button."""
        with self._lock:
            self._panel.set_feed_hold_button(True, self._clock.now())

    def release_hold(self) -> None:
        """Release the feed hold button."""
        with self._lock:
            self._panel.set_feed_hold_button(False, self._clock.now())

    def set_spindle_auto(self, is_auto: bool) -> None:
        """Set the spindle switch to AUTO if ``is_auto`` is true, otherwise to OFF."""
        with self._lock:
            self._panel.spindle_auto = is_auto

    def set_spindle_pot(self, fraction: float) -> None:
        """Set the spindle override pot, limited to the range 0…1."""
        with self._lock:
            self._panel.spindle_pot = min(max(fraction, 0.0), 1.0)

    def set_feed_pot(self, fraction: float) -> None:
        """Set the feed override pot, limited to the range 0…1.5."""
        with self._lock:
            self._panel.feed_pot = min(max(fraction, 0.0), 1.5)

    def turn_handwheel(self, count_change: int) -> None:
        """Turn the on-screen handwheel by ``count_change``, which may be negative."""
        with self._lock:
            self._panel.handwheel += count_change

    def _palm(self, which: str, *, down: bool) -> None:
        with self._lock:
            relay, now = self._panel.relay, self._clock.now()
            if down:
                relay.press_palm_button(which, now)
            else:
                relay.release_palm_button(which, now)


class OnScreenStation(StationControls):
    """``core.ports.OperatorStation`` that combines an on-screen panel with wired inputs.

    Any thread may call the methods. ``inputs`` returns the states of the wired inputs. A wired E-stop,
    start or hold input has the same effect as the on-screen button. ``wired`` is an optional station that
    provides only a handwheel or the spindle load.
    """

    def __init__(
        self, clock: Clock, inputs: Callable[[], Mapping[str, bool]], wired: OperatorStation | None = None
    ) -> None:
        super().__init__(PanelState(_WINDOW, _PULSE, seed=0), threading.Lock(), clock)
        self._inputs = inputs
        self._wired = wired

    def read_state(self) -> StationState:
        """Return the current state of the station."""
        with self._lock:
            state = self._panel.state(self._clock.now())
        inputs = self._inputs()
        wired = self._wired.read_state() if self._wired is not None else StationState()
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
        """Press the on-screen E-stop, after which the control stops the machine as far as it can.

        The on-screen E-stop is not a safety device.
        """
        with self._lock:
            self._panel.estop = True

    def release_estop(self) -> None:
        """Release the on-screen E-stop."""
        with self._lock:
            self._panel.estop = False


# --- Operator station whose buttons are inputs.


class PotSettings(Protocol):
    """Settings of a potentiometer: the values at both ends, and the input that enables it."""

    @property
    def low_value(self) -> float:
        """Return the value at the low end of the pot."""
        ...

    @property
    def high_value(self) -> float:
        """Return the value at the high end of the pot."""
        ...

    @property
    def switch_input(self) -> str:
        """Return the name of the input that enables the pot."""
        ...


def build_station_state(
    inputs: Mapping[str, bool],
    pots: Mapping[str, PotSettings],
    read_pot: Callable[[str], float],
    *,
    handwheel: int,
    age_s: float,
) -> StationState:
    """Build the state of the station from inputs and pots.

    A button that is not in the machine file counts as released. ``read_pot`` takes the name of a pot and
    returns its position as a fraction. Without an input ``spindle_auto``, the switch input of the spindle
    pot selects AUTO. If the pot has no switch input either, AUTO is always selected.
    """
    pot, load = pots.get("spindle_pot"), pots.get("spindle_load")
    auto = inputs.get(pot.switch_input, True) if pot is not None and pot.switch_input else True

    def calculate_override(name: str) -> float:
        return _scaled(pots[name], min(max(read_pot(name), 0.0), 1.0)) if name in pots else 1.0

    return StationState(
        estop=inputs.get("estop", False),
        start=inputs.get("start", False),
        hold=inputs.get("hold", False),
        spindle_auto=inputs.get("spindle_auto", auto),
        spindle_pot=calculate_override("spindle_pot"),
        feed_pot=calculate_override("feed_pot"),
        handwheel=handwheel,
        age=age_s,
        # Percent; negative values are noise of an idle motor.
        spindle_load=_scaled(load, max(read_pot("spindle_load"), 0.0)) if load is not None else None,
    )


def _scaled(pot: PotSettings, fraction: float) -> float:
    return pot.low_value + (pot.high_value - pot.low_value) * fraction


# --- Operator actions at a station in another process -----------------------------------------------------


def _posted_action(name: str) -> Callable[..., None]:
    """Return a method that sends its own name and arguments to another process without waiting."""

    def post_values(self: PostedControls, *values: object) -> None:
        self.post_action(name, *values)

    return post_values


class PostedControls(ABC):
    """Operator actions at a simulated station that runs in another process.

    ``app.desk.station_controls.StationPanel`` explains the actions. A subclass implements ``post_action``,
    which sends an action to that process.
    """

    @abstractmethod
    def post_action(self, name: str, *values: object) -> None:
        """Send the name of a station method and its arguments to the other process, without waiting."""

    press_left, release_left = _posted_action("press_left"), _posted_action("release_left")
    press_right, release_right = _posted_action("press_right"), _posted_action("release_right")
    press_hold, release_hold = _posted_action("press_hold"), _posted_action("release_hold")
    press_estop, release_estop = _posted_action("press_estop"), _posted_action("release_estop")
    set_spindle_auto, set_spindle_pot = _posted_action("set_spindle_auto"), _posted_action("set_spindle_pot")
    set_feed_pot, turn_handwheel = _posted_action("set_feed_pot"), _posted_action("turn_handwheel")
