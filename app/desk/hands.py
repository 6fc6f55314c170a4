"""The operator's hands on the simulated station: palms, E-stop, hold, spindle switch and the two pots."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from app.desk.prompts import BOTH_UP, ONE_PALM
from app.desk.station import Palms, Pot, StationPanel

OVERRIDE_STEP = 0.1
OVERRIDE_MOST = 1.5
LONGEST_TURN = 0.1  # seconds of turning at a time: a screen that was away does not catch up with a jump


def _free() -> str:
    return ""


def _just_now() -> float:
    return 0.0


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
    barred: Callable[[], str] = _free
    ago: Callable[[], float] = _just_now  # s since the press that is handled now really happened
    palms: Palms = field(default_factory=Palms)
    estop_pressed: bool = False
    spindle_knob: Pot = field(default_factory=lambda: Pot(1.0))
    feed_knob: Pot = field(default_factory=lambda: Pot(OVERRIDE_MOST))
    _looked: float | None = None

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
        if down and self.barred():
            self.palms.dead = bool(self.palms.down)
            self.say(self.barred())
        elif down and side not in self.palms.down:
            self._palm_down(station, side)
        elif not down and side in self.palms.down:
            (station.release_left if side == "left" else station.release_right)()
            if self.palms.release(side):
                self.say(ONE_PALM)

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
        for side in tuple(self.palms.down):
            self.palm(side, down=False)

    def hold(self, down: bool) -> None:
        """The station's feed hold button."""
        if self.station:
            (self.station.press_hold if down else self.station.release_hold)()

    def estop(self, pressed: bool) -> None:
        """Hit the mushroom, or twist it out."""
        if self.station and pressed is not self.estop_pressed:
            self.estop_pressed = pressed
            self.clear()
            (self.station.press_estop if pressed else self.station.release_estop)()

    def set_spindle_auto(self, auto: bool) -> None:
        """The spindle switch AUTO/OFF."""
        if self.station:
            self.station.set_spindle_auto(auto)

    @property
    def spindle_pot(self) -> float:
        """Where the spindle override pot shall stand, 0…1."""
        return self.spindle_knob.wanted

    def set_spindle_pot(self, fraction: float) -> None:
        """Put the spindle override pot there."""
        self.spindle_knob.set(fraction)

    def turn_spindle_pot(self, steps: int) -> None:
        """The spindle pot by so many steps of ten percent."""
        self.set_spindle_pot(stepped(self.spindle_pot, steps))

    @property
    def feed_pot(self) -> float:
        """Where the feed override pot shall stand, 0…1.5."""
        return self.feed_knob.wanted

    def set_feed_pot(self, fraction: float) -> None:
        """Put the feed override pot there."""
        self.feed_knob.set(fraction)

    def turn_knobs(self) -> None:
        """Once a frame: the pots turn on towards where they shall stand."""
        now = self.clock()
        passed = min(LONGEST_TURN, now - self._looked) if self._looked is not None else 0.0
        self._looked = now
        if self.station is not None:
            if self.spindle_knob.turn(passed):
                self.station.set_spindle_pot(self.spindle_knob.value)
            if self.feed_knob.turn(passed):
                self.station.set_feed_pot(self.feed_knob.value)


def stepped(fraction: float, steps: int) -> float:
    """An override so many steps further."""
    return round(fraction / OVERRIDE_STEP + steps) * OVERRIDE_STEP
