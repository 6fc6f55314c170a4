"""Keys and touch targets of the operator station on the screen."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from app.desk.posted_values import PostedValues
from app.desk.state.desk_control import DeskControl
from app.desk.station_controls import StationControls, step_feed_override
from app.desk.status import prompt_line
from app.desk.status.prompt_line import PromptLine
from core.executor.commands import CycleStart, SetFeedOverride


@dataclass(frozen=True, slots=True)
class StationKeys:
    """E-stop, start button, spindle switch and feed override on the screen.

    If the machine has its own station, the E-stop key calls ``start_feed_hold`` instead. ``barred`` returns
    why the start button is disabled. ``has_two_hand_start`` is True if the machine has palm buttons.
    """

    desk_control: DeskControl
    station_controls: StationControls
    prompt_line: PromptLine
    barred: Callable[[], str]
    start_feed_hold: Callable[[int], None]
    has_two_hand_start: bool
    posted_values: PostedValues

    def press_estop(self, press: int = 0) -> None:
        """Press the E-stop of the simulated station.

        For a machine with a real station, start feed hold and show that the key is not an E-stop. ``press``
        is the number of the key press.
        """
        if self.desk_control.station_panel is None:
            self.start_feed_hold(press)
            self.prompt_line.say(prompt_line.NO_ESTOP_BUTTON)
        else:
            self.station_controls.estop(is_pressed=True)

    def release_estop(self) -> None:
        """Release the E-stop of the simulated station after the operator confirms."""
        if self.desk_control.station_panel is None:
            self.prompt_line.say(prompt_line.NO_ESTOP_BUTTON)
        elif not self.station_controls.is_estop_pressed:
            self.prompt_line.say("THE E-STOP IS NOT PRESSED")
        else:
            self.prompt_line.ask_question(
                prompt_line.CONFIRM_ESTOP_RELEASE, partial(self.station_controls.estop, is_pressed=False)
            )

    def press_start(self) -> None:
        """Press Cycle Start of a machine with one start button."""
        if why := self.barred():
            self.prompt_line.say(why)
        elif not self.has_two_hand_start:
            self.prompt_line.withdraw_question()
            self.desk_control.post(CycleStart())

    def toggle_spindle_switch(self) -> None:
        """Toggle the spindle switch between AUTO and OFF."""
        self.station_controls.set_spindle_auto(not self.desk_control.read_snapshot().spindle_auto)

    def step_feed_override(self, steps: int) -> None:
        """Change the feed override by a number of steps of ten percent.

        On a simulated station, this method moves the feed override pot, so that the knob always shows the
        override value.
        """
        if self.desk_control.station_panel is not None:
            self.station_controls.turn_feed_pot(steps)
            return
        shown = self.desk_control.read_snapshot().feed_override
        wanted = self.posted_values.change_value("feed", shown, lambda now: step_feed_override(now, steps))
        self.desk_control.post(SetFeedOverride(wanted))
