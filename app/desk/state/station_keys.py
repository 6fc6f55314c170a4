"""The keys and touch targets of the operator station."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from app.desk.posted_values import PostedValues
from app.desk.state.desk_control import DeskControl
from app.desk.station_hands import StationHands, override_of
from app.desk.status import prompt_line
from app.desk.status.prompt_line import PromptAnswers
from core.executor.commands import CycleStart, FeedOverride


@dataclass(frozen=True, slots=True)
class StationKeys:
    """E-stop, start button, spindle switch and feed override on the screen.

    If the machine has its own station, ``hold`` starts feed hold in place of an E-stop. ``barred`` returns
    why the start button has no effect. ``two_hand`` is True if the machine has palm buttons.
    """

    control: DeskControl
    hands: StationHands
    answers: PromptAnswers
    barred: Callable[[], str]
    hold: Callable[[int], None]
    two_hand: bool
    posted: PostedValues

    def press_estop(self, press: int = 0) -> None:
        """Press the E-stop of the simulated station.

        At a machine with a real station, start feed hold and show that the key is not an E-stop. ``press`` is
        the number of the key press.
        """
        if self.control.panel is None:
            self.hold(press)
            self.answers.say(prompt_line.NO_MUSHROOM)
        else:
            self.hands.estop(pressed=True)

    def release_estop(self) -> None:
        """Release the E-stop of the simulated station after the operator confirms."""
        if self.control.panel is None:
            self.answers.say(prompt_line.NO_MUSHROOM)
        elif not self.hands.estop_pressed:
            self.answers.say("THE E-STOP IS NOT PRESSED")
        else:
            self.answers.ask(prompt_line.TWIST_OUT, partial(self.hands.estop, pressed=False))

    def press_start(self) -> None:
        """Press Cycle Start of a machine with one start button."""
        if why := self.barred():
            self.answers.say(why)
        elif not self.two_hand:
            self.answers.take_back()
            self.control.post(CycleStart())

    def turn_spindle_switch(self) -> None:
        """Turn the spindle switch to its other position."""
        self.hands.set_spindle_auto(not self.control.snapshot().spindle_auto)

    def step_override(self, steps: int) -> None:
        """Change the feed override by a number of steps of ten percent.

        With a simulated station, this turns its pot, so that knob and value never differ.
        """
        if self.control.panel is not None:
            self.hands.turn_feed_pot(steps)
            return
        shown = self.control.snapshot().feed_override
        wanted = self.posted.changed("feed", shown, lambda now: override_of(now, steps))
        self.control.post(FeedOverride(wanted))
