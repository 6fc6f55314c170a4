"""Simulated operator station with palm buttons, feed hold, E-stop, spindle switch and pots."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from app.desk.late_presses import BlockedLateAction, LatePressFilter
from app.desk.status.prompt_line import ONE_PALM_PRESSED, RELEASE_BOTH_PALMS

# --- palm buttons and pots ----------------------------------------------------------------------------


TWO_HAND_WINDOW_S = 0.5  # Seconds within which the second palm button must follow the first.


class StationPanel(Protocol):
    """Interface of the simulated station. The station decides whether both palm buttons start a cycle."""

    def press_left(self) -> None:
        """Press the left palm button."""
        ...

    def release_left(self) -> None:
        """Release the left palm button."""
        ...

    def press_right(self) -> None:
        """Press the right palm button."""
        ...

    def release_right(self) -> None:
        """Release the right palm button."""
        ...

    def press_hold(self) -> None:
        """Press the feed hold button."""
        ...

    def release_hold(self) -> None:
        """Release the feed hold button."""
        ...

    def press_estop(self) -> None:
        """Press the on-screen E-stop button."""
        ...

    def release_estop(self) -> None:
        """Release the E-stop button by twisting it."""
        ...

    def set_spindle_auto(self, is_auto: bool) -> None:
        """Turn the spindle switch to AUTO if ``is_auto`` is true, and otherwise to OFF."""
        ...

    def set_spindle_pot(self, fraction: float) -> None:
        """Turn the spindle override pot to a fraction of its range, 0 to 1."""
        ...

    def set_feed_pot(self, fraction: float) -> None:
        """Turn the feed override pot to a fraction of the programmed feed, 0 to 1.5."""
        ...

    def turn_handwheel(self, count_change: int) -> None:
        """Turn the handwheel by a signed number of counts, if the machine has one."""
        ...


@dataclass(slots=True)
class PalmButtons:
    """Pressed palm buttons and their press times, used to find the reason why a start failed.

    A pair of presses is invalid if the second button was pressed too late, or if one button was released
    while the other remained pressed. An invalid pair has no effect until both buttons are released. A
    button that is taped down therefore cannot start a cycle.
    """

    # "left" or "right", with its monotonic time in seconds.
    press_times: dict[str, float] = field(default_factory=dict)
    are_both_pressed: bool = False  # Both were down together since the last time both were up.
    is_pair_invalid: bool = False

    def record_press(self, side: str, time_s: float) -> bool:
        """Record a press, and return whether both buttons are pressed and were pressed in time."""
        if side in self.press_times:
            return False
        self.press_times[side] = time_s
        times = self.press_times.values()
        if len(self.press_times) < 2:
            return False
        self.is_pair_invalid = self.is_pair_invalid or max(times) - min(times) > TWO_HAND_WINDOW_S
        self.are_both_pressed = self.are_both_pressed or not self.is_pair_invalid
        return not self.is_pair_invalid

    def record_release(self, side: str) -> bool:
        """Record a release, and return True if the other button was not pressed in time.

        The result is False if this button was not pressed.
        """
        if self.press_times.pop(side, None) is None:
            return False
        alone = not self.are_both_pressed
        self.is_pair_invalid = bool(self.press_times)
        if not self.press_times:
            self.are_both_pressed = False
        return alone


POT_SLEW_RATE = 1.0  # Fraction of the range per second. A control treats a faster change as a faulty pot.


@dataclass(slots=True)
class OverridePot:
    """Override pot on the screen.

    ``wanted`` is the target that the operator sets. ``current_fraction`` moves toward the target at a
    limited speed.
    """

    max_fraction: float
    wanted: float = 1.0
    current_fraction: float = 1.0
    starting_action: BlockedLateAction = BlockedLateAction.OVERRIDE
    late_presses: LatePressFilter | None = None

    def set(self, fraction: float) -> None:
        """Set the target of the pot, toward which the pot turns at a limited speed.

        A late press does not raise the target. While the screen is stalled, the operator sees no effect and
        may press too often.
        """
        if (
            self.late_presses is None
            or fraction <= self.wanted
            or not self.late_presses.refuse_late_press(self.starting_action)
        ):
            self._choose(fraction)

    def _choose(self, fraction: float) -> None:
        self.wanted = max(0.0, min(self.max_fraction, fraction))

    def turn_toward_target(self, elapsed_s: float) -> bool:
        """Turn the pot for this number of seconds, and return whether its position has changed."""
        if self.current_fraction == self.wanted:
            return False
        step = POT_SLEW_RATE * elapsed_s
        self.current_fraction += max(-step, min(step, self.wanted - self.current_fraction))
        return True


OVERRIDE_STEP = 0.1
MAX_OVERRIDE = 1.5
LATCH_TIME_S = 5.0  # Seconds for which a touched palm button waits for the other one.
# Maximum seconds of turning per frame, so that a pot does not jump after a stall of the screen.
MAX_TURN_STEP_S = 0.1


@dataclass(slots=True)
class StationControls:
    """Buttons and pots of the simulated station that the operator uses on the screen.

    Without a simulated station, the actions have no effect. ``say`` shows a message on the prompt line, and
    ``clear`` removes the message. ``starting`` is called when both palm buttons are pressed. ``barred``
    returns why a start is not possible.
    """

    station: StationPanel | None
    clock: Callable[[], float]
    say: Callable[[str], None]
    clear: Callable[[], None]
    starting: Callable[[], None]
    barred: Callable[[], str] = str
    find_press_age_s: Callable[[], float] = float  # Seconds since the press that is being handled.
    palms: PalmButtons = field(default_factory=PalmButtons)
    one_palm_message: str = ONE_PALM_PRESSED  # Message after a single palm button was pressed.
    is_estop_pressed: bool = False
    late: LatePressFilter | None = None
    spindle_pot: OverridePot = field(
        default_factory=lambda: OverridePot(1.0, starting_action=BlockedLateAction.SPINDLE)
    )
    feed_pot: OverridePot = field(default_factory=lambda: OverridePot(MAX_OVERRIDE))
    latched: str = ""  # The palm button that waits for the other one, "left" or "right".
    _latched_at: float = 0.0
    _looked: float | None = None

    def set_late_press_filter(self, late_presses: LatePressFilter) -> None:
        """Set the filter that drops late presses that would start an action at the station."""
        self.late = self.spindle_pot.late_presses = self.feed_pot.late_presses = late_presses

    def _refuses(self, starting: BlockedLateAction) -> bool:
        return self.late is not None and self.late.refuse_late_press(starting)

    def at(self) -> float:
        """Return the time of the press that is being processed, in seconds of this object's clock."""
        return self.clock() - self.find_press_age_s()

    def palm(self, side: str, is_down: bool) -> None:
        """Press or release a palm button. The station's relay decides whether two presses start a cycle.

        The relay receives a press when this method is called, which can be later than the key event. If the
        buttons were not pressed together, this method therefore forwards only one press.
        """
        station = self.station
        if station is None:
            return
        if is_down and self._refuses(BlockedLateAction.CYCLE):
            self.palms.is_pair_invalid = bool(self.palms.press_times)
        elif is_down and self.barred():
            self.palms.is_pair_invalid = bool(self.palms.press_times)
            self.say(self.barred())
        elif is_down and side not in self.palms.press_times:
            self._palm_down(station, side)
        elif not is_down and side in self.palms.press_times:
            (station.release_left if side == "left" else station.release_right)()
            if self.palms.record_release(side):
                self.say(self.one_palm_message)

    def latch(self, side: str) -> None:
        """Latch a palm button of a simulated machine with one touch or mouse click.

        The button remains latched until the other button is touched. Touching the other button presses both
        buttons together, and the end of the touch releases both.
        """
        first, self.latched = self.update_latched_side(), ""
        if self._refuses(BlockedLateAction.CYCLE):
            return
        if first in {"", side}:
            if why := self.barred():
                self.say(why)
            elif not first:
                self.clear()
                self.latched, self._latched_at = side, self.clock()
            return
        for each in (first, side):
            self.palm(each, is_down=True)

    def update_latched_side(self) -> str:
        """Return the palm button that is latched until the other button is touched.

        The button is no longer latched after a time limit.
        """
        if self.latched and self.clock() - self._latched_at > LATCH_TIME_S:
            self.latched = ""
        return self.latched

    def release_palm_buttons(self) -> None:
        """Release both palm buttons at the end of the touch that pressed them."""
        for side in tuple(self.palms.press_times):
            self.palm(side, is_down=False)

    def _palm_down(self, station: StationPanel, side: str) -> None:
        self.clear()
        if self.palms.record_press(side, self.at()):
            self.starting()
        if self.palms.is_pair_invalid:
            self.say(RELEASE_BOTH_PALMS)
        else:
            (station.press_left if side == "left" else station.press_right)()

    def release_all_buttons(self) -> None:
        """Release all buttons when the window has lost the keyboard focus.

        The window then receives no release events.
        """
        self.latched = ""
        for side in tuple(self.palms.press_times):
            self.palm(side, is_down=False)

    def hold(self, is_down: bool) -> None:
        """Press or release the station's feed hold button."""
        self.latched = ""
        if self.station:
            (self.station.press_hold if is_down else self.station.release_hold)()

    def estop(self, is_pressed: bool) -> None:
        """Press the E-stop button, or release it by twisting."""
        if not is_pressed and self._refuses(BlockedLateAction.RELEASE_ESTOP):
            return
        if self.station and is_pressed is not self.is_estop_pressed:
            self.is_estop_pressed = is_pressed
            self.clear()
            (self.station.press_estop if is_pressed else self.station.release_estop)()

    def set_spindle_auto(self, is_auto: bool) -> None:
        """Turn the spindle switch to AUTO or to OFF."""
        if self.station and not (is_auto and self._refuses(BlockedLateAction.SPINDLE)):
            self.station.set_spindle_auto(is_auto)

    def turn_spindle_pot(self, steps: int) -> None:
        """Turn the spindle override pot by a number of steps of ten percent."""
        self.spindle_pot.set(step_override_fraction(self.spindle_pot.wanted, steps))

    def turn_feed_pot(self, steps: int) -> None:
        """Turn the feed override pot by a number of steps of ten percent.

        The feed override always equals the position of the pot.
        """
        self.feed_pot.set(step_override_fraction(self.feed_pot.wanted, steps))

    def advance_pots(self) -> None:
        """Move the pots toward their targets. The screen calls this method once per frame."""
        now = self.clock()
        passed = min(MAX_TURN_STEP_S, now - self._looked) if self._looked is not None else 0.0
        self._looked = now
        if self.station is not None:
            if self.spindle_pot.turn_toward_target(passed):
                self.station.set_spindle_pot(self.spindle_pot.current_fraction)
            if self.feed_pot.turn_toward_target(passed):
                self.station.set_feed_pot(self.feed_pot.current_fraction)


def step_override_fraction(fraction: float, steps: int) -> float:
    """Return an override fraction changed by a number of steps of ten percent, without a range limit."""
    return round(fraction / OVERRIDE_STEP + steps) * OVERRIDE_STEP


def step_feed_override(fraction: float, steps: int) -> float:
    """Return a feed override changed by a number of steps of ten percent, limited to its range."""
    return max(0.0, min(MAX_OVERRIDE, step_override_fraction(fraction, steps)))
