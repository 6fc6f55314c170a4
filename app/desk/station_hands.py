"""The simulated operator station: palm buttons, feed hold, E-stop, spindle switch and pots."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from app.desk.late_presses import LatePresses, Starting
from app.desk.status.prompt_line import BOTH_UP, ONE_PALM

# --- palm buttons and pots ----------------------------------------------------------------------------


TOGETHER = 0.5  # Seconds within which the second palm button must follow the first.


class StationPanel(Protocol):
    """Interface of the simulated station. The station decides whether both palm buttons start a cycle."""

    def press_left(self) -> None: ...

    def release_left(self) -> None: ...

    def press_right(self) -> None: ...

    def release_right(self) -> None: ...

    def press_hold(self) -> None: ...

    def release_hold(self) -> None: ...

    def press_estop(self) -> None: ...

    def release_estop(self) -> None:
        """Twist the E-stop button out again."""
        ...

    def set_spindle_auto(self, auto: bool) -> None: ...

    def set_spindle_pot(self, fraction: float) -> None:
        """Turn the spindle override pot to a fraction of its range, 0…1."""
        ...

    def set_feed_pot(self, fraction: float) -> None:
        """Set the feed override pot to a fraction of the programmed feed, 0…1.5."""
        ...

    def turn_handwheel(self, counts: int) -> None:
        """Turn the handwheel by a signed number of counts, at a machine with a handwheel."""
        ...


@dataclass(slots=True)
class Palms:
    """The palm buttons that are pressed, with their times. It is used to explain a failed start.

    A pair is dead if the buttons were not pressed in time, or if one was released and the other was not. A
    dead pair starts nothing until both buttons are released, so that a button that is taped down starts
    nothing.
    """

    # "left" or "right", with its monotonic time in seconds.
    down: dict[str, float] = field(default_factory=dict)
    together: bool = False  # Both were down together since the last time both were up.
    dead: bool = False

    def press(self, side: str, now: float) -> bool:
        """Record a press. Return True if both buttons are now down and were pressed within the time limit."""
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
        """Record a release. Return True if the button was released without the other one pressed in time."""
        if self.down.pop(side, None) is None:
            return False
        alone = not self.together
        self.dead = bool(self.down)
        if not self.down:
            self.together = False
        return alone


SLEW = 1.0  # Fraction of the range per second. A control treats a faster change as a faulty pot.


@dataclass(slots=True)
class Pot:
    """A pot on the screen. ``wanted`` follows the touch, and ``value`` follows at a limited speed."""

    most: float
    wanted: float = 1.0
    value: float = 1.0
    starting: Starting = Starting.OVERRIDE
    late: LatePresses | None = None

    def set(self, fraction: float) -> None:
        """Set the target of the pot. The pot turns there at a limited speed.

        A late press does not raise the target, because an operator who sees no effect presses too often.
        """
        if self.late is None or fraction <= self.wanted or not self.late.refuses(self.starting):
            self._choose(fraction)

    def _choose(self, fraction: float) -> None:
        self.wanted = max(0.0, min(self.most, fraction))

    def turn(self, seconds: float) -> bool:
        """Turn the pot for this many seconds. Return True if the pot has moved."""
        if self.value == self.wanted:
            return False
        step = SLEW * seconds
        self.value += max(-step, min(step, self.wanted - self.value))
        return True


OVERRIDE_STEP = 0.1
OVERRIDE_MOST = 1.5
LATCHED = 5.0  # Seconds for which a touched palm button waits for the other one.
# Maximum seconds of turning per frame, so that a pot does not jump after a stall of the screen.
LONGEST_TURN = 0.1


@dataclass(slots=True)
class StationHands:
    """The buttons and pots of the simulated station that the operator uses on the screen.

    Without a simulated station, all actions have no effect. ``say`` shows a message on the prompt line, and
    ``clear`` removes it. ``starting`` is called when both palm buttons are pressed. ``barred`` returns why a
    start is not possible now.
    """

    station: StationPanel | None
    clock: Callable[[], float]
    say: Callable[[str], None]
    clear: Callable[[], None]
    starting: Callable[[], None]
    barred: Callable[[], str] = str
    ago: Callable[[], float] = float  # Seconds since the press that is being handled.
    palms: Palms = field(default_factory=Palms)
    one_palm: str = ONE_PALM  # Message after a single palm button was pressed.
    estop_pressed: bool = False
    late: LatePresses | None = None
    spindle_pot: Pot = field(default_factory=lambda: Pot(1.0, starting=Starting.SPINDLE))
    feed_pot: Pot = field(default_factory=lambda: Pot(OVERRIDE_MOST))
    latched: str = ""  # The palm button that waits for the other one, "left" or "right".
    _latched_at: float = 0.0
    _looked: float | None = None

    def refuse_late(self, late: LatePresses) -> None:
        """Drop late presses that would start something at the station."""
        self.late = self.spindle_pot.late = self.feed_pot.late = late

    def _refuses(self, starting: Starting) -> bool:
        return self.late is not None and self.late.refuses(starting)

    def at(self) -> float:
        """Return the time of the press that is being handled, by this clock."""
        return self.clock() - self.ago()

    def palm(self, side: str, down: bool) -> None:
        """Press or release a palm button, at the time of the key event.

        The relay of the station decides whether the pair starts a cycle. The relay gets presses when this
        method is called. Therefore this method passes on only one press of a pair that was not pressed
        together.
        """
        station = self.station
        if station is None:
            return
        if down and self._refuses(Starting.CYCLE):
            self.palms.dead = bool(self.palms.down)
        elif down and self.barred():
            self.palms.dead = bool(self.palms.down)
            self.say(self.barred())
        elif down and side not in self.palms.down:
            self._palm_down(station, side)
        elif not down and side in self.palms.down:
            (station.release_left if side == "left" else station.release_right)()
            if self.palms.release(side):
                self.say(self.one_palm)

    def latch(self, side: str) -> None:
        """Press a palm button of a simulated machine with one touch or the mouse.

        The button waits for the other one. A press of the other one presses both together, and the release of
        the touch releases both.
        """
        first, self.latched = self.latch_now(), ""
        if self._refuses(Starting.CYCLE):
            return
        if first in {"", side}:
            if why := self.barred():
                self.say(why)
            elif not first:
                self.clear()
                self.latched, self._latched_at = side, self.clock()
            return
        for each in (first, side):
            self.palm(each, down=True)

    def latch_now(self) -> str:
        """Return the palm button that waits for the other one.

        After a time limit, the button no longer waits.
        """
        if self.latched and self.clock() - self._latched_at > LATCHED:
            self.latched = ""
        return self.latched

    def latch_up(self) -> None:
        """Release both palm buttons at the end of the touch."""
        for side in tuple(self.palms.down):
            self.palm(side, down=False)

    def _palm_down(self, station: StationPanel, side: str) -> None:
        self.clear()
        if self.palms.press(side, self.at()):
            self.starting()
        if self.palms.dead:
            self.say(BOTH_UP)
        else:
            (station.press_left if side == "left" else station.press_right)()

    def let_go(self) -> None:
        """Release all buttons, because the window has lost the keyboard and gets no release events."""
        self.latched = ""
        for side in tuple(self.palms.down):
            self.palm(side, down=False)

    def hold(self, down: bool) -> None:
        """Press or release the station's feed hold button."""
        self.latched = ""
        if self.station:
            (self.station.press_hold if down else self.station.release_hold)()

    def estop(self, pressed: bool) -> None:
        """Press the E-stop button, or twist it out."""
        if not pressed and self._refuses(Starting.RELEASE):
            return
        if self.station and pressed is not self.estop_pressed:
            self.estop_pressed = pressed
            self.clear()
            (self.station.press_estop if pressed else self.station.release_estop)()

    def set_spindle_auto(self, auto: bool) -> None:
        """Turn the spindle switch to AUTO or to OFF."""
        if self.station and not (auto and self._refuses(Starting.SPINDLE)):
            self.station.set_spindle_auto(auto)

    def turn_spindle_pot(self, steps: int) -> None:
        """Turn the spindle pot by a number of steps of ten percent."""
        self.spindle_pot.set(stepped(self.spindle_pot.wanted, steps))

    def turn_feed_pot(self, steps: int) -> None:
        """Turn the feed pot by a number of steps of ten percent.

        The feed override always equals the position of the pot.
        """
        self.feed_pot.set(stepped(self.feed_pot.wanted, steps))

    def turn_knobs(self) -> None:
        """Move the pots toward their targets; called once a frame."""
        now = self.clock()
        passed = min(LONGEST_TURN, now - self._looked) if self._looked is not None else 0.0
        self._looked = now
        if self.station is not None:
            if self.spindle_pot.turn(passed):
                self.station.set_spindle_pot(self.spindle_pot.value)
            if self.feed_pot.turn(passed):
                self.station.set_feed_pot(self.feed_pot.value)


def stepped(fraction: float, steps: int) -> float:
    """Return an override fraction after a number of steps of ten percent, without a range limit."""
    return round(fraction / OVERRIDE_STEP + steps) * OVERRIDE_STEP


def override_of(fraction: float, steps: int) -> float:
    """Return a feed override after a number of steps of ten percent, within its range."""
    return max(0.0, min(OVERRIDE_MOST, stepped(fraction, steps)))
