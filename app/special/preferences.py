"""Units, language, theme, readout and station of the screen: every one acts at once and is kept."""

from __future__ import annotations

from app.desk.pages.first_job import FirstJob
from app.desk.pages.sheet import Row, Sheet
from app.desk.translation import tr
from app.special.special_functions import SpecialFunction
from core.executor.snapshot import Snapshot

WORDS = {
    "units": "DISPLAY UNITS",
    "readout": "VALUE IN LARGE READOUT",
    "language": "LANGUAGE",
    "theme": "COLORS",
    "dock": "ON-SCREEN OPERATOR STATION",
    "latched": "ON-SCREEN PALM BUTTONS",
    "full_screen": "WINDOW",
    "first_job": "FIRST JOB CARD",
}
YES_NO = {
    "dock": ("SHOWN", "HIDDEN"),
    "latched": ("PRESS BUTTONS IN SEQUENCE", "PRESS BUTTONS TOGETHER"),
    "full_screen": ("FULL SCREEN", "WINDOW"),
    "first_job": ("SHOWN", "HIDDEN"),
}
VALUES = {"en": "ENGLISH", "es": "ESPAÑOL", "dark": "DARK", "light": "LIGHT"}


class ScreenPreferences(SpecialFunction):
    """Return, or a finger, goes on to the next choice."""

    name = "SCREEN"
    use = "units, language, operator station, window"

    @property
    def count(self) -> int:
        """How many settings there are."""
        return len(WORDS)

    def sheet(self, snapshot: Snapshot) -> Sheet:
        """One row for each setting: what is chosen now."""
        now = self.desk.settings.now
        rows = tuple(Row((words, _in_words(name, getattr(now, name)))) for name, words in WORDS.items())
        metric = snapshot.modal.metric
        return Sheet(
            "SCREEN",
            ("", ""),
            (0.6, 0.4),
            rows,
            self.marked,
            notes=(
                "The control is set to millimeters." if metric else ("The control is set to inches."),
                ("Display units change only the values shown; entries are always in the control's unit."),
            ),
        )

    def act(self) -> bool:
        """Return: the marked setting goes on to its next choice."""
        self._go_on()
        return True

    def choose(self, row: int) -> None:
        """A finger chooses at once."""
        self.marked = row
        self._go_on()

    def _go_on(self) -> None:
        name = tuple(WORDS)[self.marked]
        settings = self.desk.settings
        if name == "dock" and self.desk.station is None:
            self.desk.say("NOT AVAILABLE: THIS MACHINE HAS A REAL OPERATOR STATION")
            return
        if name == "dock" and settings.now.dock and self.desk.hands.estop_pressed:
            self.desk.say("RELEASE THE E-STOP (U) BEFORE HIDING THE OPERATOR STATION")
            return
        if name == "latched" and not self.desk.one_hand:
            self.desk.say(tr("SIMULATION ONLY: LATCHED PALM BUTTONS COULD START A REAL SPINDLE"))
            return
        if name == "first_job":
            self.desk.first_job = FirstJob()
        self.desk.hands.let_go()
        self.desk.clear()
        self.desk.choose_setting(name, settings.following(name))

    def prompt(self) -> str:
        """How to choose, for the prompt line."""
        return "ENTER OR TAP: NEXT CHOICE   ESC: BACK TO THE LIST"


def _in_words(name: str, value: object) -> str:
    if isinstance(value, bool):
        return YES_NO[name][not value]
    return VALUES.get(str(value), str(value))
