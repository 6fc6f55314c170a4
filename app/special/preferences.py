"""Units, language, theme, readout and station of the screen: every one acts at once and is kept."""

from __future__ import annotations

from app.desk.first_job import FirstJob
from app.desk.sheet import Row, Sheet
from app.desk.translation import tr
from app.special.special_functions import SpecialFunction
from core.executor.snapshot import Snapshot

WORDS = {
    "units": "UNITS OF THE FIGURES",
    "readout": "LARGE FIGURES SHOW",
    "language": "LANGUAGE",
    "theme": "COLOURS",
    "dock": "OPERATOR STATION ON THE SCREEN",
    "latched": "PALM BUTTONS ON THE SCREEN",
    "full_screen": "WINDOW",
    "first_job": "CARD OF THE FIRST JOB",
}
YES_NO = {
    "dock": ("SHOWN", "HIDDEN"),
    "latched": ("ONE AFTER THE OTHER", "BOTH HELD"),
    "full_screen": ("FULL SCREEN", "WINDOW"),
    "first_job": ("SHOWN", "HIDDEN"),
}
VALUES = {"en": "ENGLISH", "es": "ESPAÑOL", "dark": "DARK", "light": "LIGHT"}


class ScreenPreferences(SpecialFunction):
    """Return, or a finger, goes on to the next choice."""

    name = "SCREEN"
    use = "units, language, station, window"

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
                "The control counts in millimetres now." if metric else "The control counts in inches now.",
                "Units change the figures that are shown; what is typed is always in the control's unit.",
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
            self.desk.say("THIS MACHINE HAS AN OPERATOR STATION OF ITS OWN: NONE IS SHOWN")
            return
        if name == "dock" and settings.now.dock and self.desk.hands.estop_pressed:
            self.desk.say("RELEASE THE E-STOP OF THE STATION BEFORE HIDING IT (U)")
            return
        if name == "latched" and not self.desk.one_hand:
            self.desk.say(
                tr("PALMS LATCH WHERE EVERYTHING IS SIMULATED ALONE: HERE SOMETHING REAL WOULD TURN")
            )
            return
        if name == "first_job":
            self.desk.first_job = FirstJob()
        self.desk.hands.let_go()
        self.desk.clear()
        self.desk.choose_setting(name, settings.following(name))

    def prompt(self) -> str:
        """How to choose, for the prompt line."""
        return "RETURN OR A TOUCH GOES ON TO THE NEXT CHOICE; ESC GOES BACK TO THE LIST"


def _in_words(name: str, value: object) -> str:
    if isinstance(value, bool):
        return YES_NO[name][not value]
    return VALUES.get(str(value), str(value))
