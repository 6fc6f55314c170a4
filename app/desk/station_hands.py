"""The operator station of the simulated machine: palm buttons, feed hold, E-stop, spindle switch and pots."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

from app.desk.late_presses import LatePresses, Starting
from app.desk.status.prompt_line import BOTH_UP, ONE_PALM

# --- palm buttons and pots ----------------------------------------------------------------------------


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
        """Turn the spindle override pot to this share of its range, 0…1."""
        ...

    def set_feed_pot(self, fraction: float) -> None:
        """Turn the feed override pot to this share of the programmed feed, 0…1.5."""
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
    starting: Starting = Starting.OVERRIDE
    late: LatePresses | None = None

    def set(self, fraction: float) -> None:
        """Choose where the pot shall stand; it turns there as fast as a knob can.

        A late press does not raise it: hands that saw no effect press too often.
        """
        if self.late is None or fraction <= self.wanted or not self.late.refuses(self.starting):
            self._choose(fraction)

    def _choose(self, fraction: float) -> None:
        self.wanted = max(0.0, min(self.most, fraction))

    def turn(self, seconds: float) -> bool:
        """Turn on for so long; True when it has moved."""
        if self.value == self.wanted:
            return False
        step = SLEW * seconds
        self.value += max(-step, min(step, self.wanted - self.value))
        return True


OVERRIDE_STEP = 0.1
OVERRIDE_MOST = 1.5
LATCHED = 5.0  # s for which a palm that was touched waits for the other one
LONGEST_TURN = 0.1  # seconds of turning at a time: a screen that was away does not catch up with a jump


@dataclass(slots=True)
class StationHands:
    """What is held and where the knobs stand. Without a station (a real machine has its own) nothing happens.

    ``say`` answers on the prompt line, ``clear`` takes an answer back, ``starting`` hears of both palms;
    ``barred`` tells why they start nothing now.
    """

    station: StationPanel | None
    clock: Callable[[], float]
    say: Callable[[str], None]
    clear: Callable[[], None]
    starting: Callable[[], None]
    barred: Callable[[], str] = str
    ago: Callable[[], float] = float  # s since the press that is handled now really happened
    palms: Palms = field(default_factory=Palms)
    one_palm: str = ONE_PALM  # what is said when one was pressed alone
    estop_pressed: bool = False
    late: LatePresses | None = None
    spindle_pot: Pot = field(default_factory=lambda: Pot(1.0, starting=Starting.SPINDLE))
    feed_pot: Pot = field(default_factory=lambda: Pot(OVERRIDE_MOST))
    latched: str = ""  # the palm that waits for the other one, "left" or "right"
    _latched_at: float = 0.0
    _looked: float | None = None

    def refuse_late(self, late: LatePresses) -> None:
        """Have late presses start nothing at the station."""
        self.late = self.spindle_pot.late = self.feed_pot.late = late

    def _refuses(self, starting: Starting) -> bool:
        return self.late is not None and self.late.refuses(starting)

    def at(self) -> float:
        """When the press that is handled now happened, by this clock."""
        return self.clock() - self.ago()

    def palm(self, side: str, down: bool) -> None:
        """A palm button goes down or up, at the time of its event.

        The station's relay decides whether that is a start; it sees presses when they come here, so of a pair
        that was not pressed together it sees one only.
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
        """A palm where everything is simulated, by one finger or the mouse: it waits for the other one.

        With that both go down at once, as two hands press them; the finger that comes up lets both go.
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
        """The palm that waits for the other one; after a while it waits no more."""
        if self.latched and self.clock() - self._latched_at > LATCHED:
            self.latched = ""
        return self.latched

    def latch_up(self) -> None:
        """The finger has come up."""
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
        """Hands off: the window has lost the keyboard, so no release would ever arrive."""
        self.latched = ""
        for side in tuple(self.palms.down):
            self.palm(side, down=False)

    def hold(self, down: bool) -> None:
        """The station's feed hold button."""
        self.latched = ""
        if self.station:
            (self.station.press_hold if down else self.station.release_hold)()

    def estop(self, pressed: bool) -> None:
        """Hit the mushroom, or twist it out."""
        if not pressed and self._refuses(Starting.RELEASE):
            return
        if self.station and pressed is not self.estop_pressed:
            self.estop_pressed = pressed
            self.clear()
            (self.station.press_estop if pressed else self.station.release_estop)()

    def set_spindle_auto(self, auto: bool) -> None:
        """Turn the spindle switch to AUTO, or to OFF."""
        if self.station and not (auto and self._refuses(Starting.SPINDLE)):
            self.station.set_spindle_auto(auto)

    def turn_spindle_pot(self, steps: int) -> None:
        """The spindle pot by so many steps of ten percent."""
        self.spindle_pot.set(stepped(self.spindle_pot.wanted, steps))

    def turn_feed_pot(self, steps: int) -> None:
        """The feed pot by so many steps of ten percent, so that knob and override never differ."""
        self.feed_pot.set(stepped(self.feed_pot.wanted, steps))

    def turn_knobs(self) -> None:
        """Once a frame: the pots turn on towards where they shall stand."""
        now = self.clock()
        passed = min(LONGEST_TURN, now - self._looked) if self._looked is not None else 0.0
        self._looked = now
        if self.station is not None:
            if self.spindle_pot.turn(passed):
                self.station.set_spindle_pot(self.spindle_pot.value)
            if self.feed_pot.turn(passed):
                self.station.set_feed_pot(self.feed_pot.value)


def stepped(fraction: float, steps: int) -> float:
    """An override so many steps further."""
    return round(fraction / OVERRIDE_STEP + steps) * OVERRIDE_STEP


def override_of(fraction: float, steps: int) -> float:
    """Return a feed override so many steps further, within its range."""
    return max(0.0, min(OVERRIDE_MOST, stepped(fraction, steps)))
