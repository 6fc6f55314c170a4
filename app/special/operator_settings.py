"""Operator settings: units, language, theme, spindle speed limit and R parameters."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from app.desk.arithmetic import EntryError, value_of
from app.desk.background_work import Latest
from app.desk.desk import Desk
from app.desk.pages.sheet import Key, Row, Sheet
from app.desk.persistence import Persistence
from app.desk.status import formats
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.status.readouts import UNKNOWN
from app.desk.translation import tr
from app.offsets.offsets_in_force import R_PARAMETERS, r_parameters
from app.special.special_functions import FigureFunction, SpecialFunction
from core.access.access_table import Act
from core.executor.commands import SpindleLimit
from core.executor.snapshot import Snapshot
from core.language.sinumerik.sinumerik_words import MOST_R, REACH
from core.machine.machine_model import SpindleModel
from core.message import Message
from core.ports import Unknown
from core.store.store_errors import StoreError


class RParameters(FigureFunction):
    """Special function for R parameters.

    A typed value applies to the selected row. The loaded program is then proved again.
    """

    name = "R PARAMETERS"
    use = "R0 to R299 of SINUMERIK programs"

    def __init__(self, desk: Desk, persistence: Persistence, worker: Latest) -> None:
        super().__init__(desk)
        self._persistence, self._worker = persistence, worker
        self.values: dict[int, float] = {}  # parameters with a value
        self.opened()

    def opened(self) -> None:
        """Load the stored values when the function opens."""
        if self._worker.busy:
            return  # The pending values are already displayed.
        try:
            self.values = r_parameters(self._persistence.read_setting(R_PARAMETERS))
        except StoreError:
            self.values = {}  # TurnDesk itself reports that nothing is stored.

    @property
    def count(self) -> int:
        """Number of R parameters (R0 to R299)."""
        return MOST_R + 1

    def sheet(self, _snapshot: Snapshot) -> Sheet:
        """Return the table of all parameters. A dash means not set, which counts as 0."""
        values = self.values
        rows = tuple(
            Row((f"R{number}", f"{values[number]:.9g}" if number in values else "–"), number in values)
            for number in range(self.count)
        )
        return Sheet(
            "R PARAMETERS",
            ("", ""),
            (0.4, 0.6),
            rows,
            self.marked,
            question=f"R{self.marked}?",
            text=self.entry.text,
            notes=(
                (
                    "Every SINUMERIK program starts with these values. Values that the program assigns "
                    "apply until the program ends."
                ),
                "A parameter without a value is treated as 0, and a warning is shown.",
            ),
            figures=frozenset({1}),
        )

    def keys(self) -> Mapping[str, Key]:
        """Return F4, which clears the selected parameter."""
        return {"F4": Key("CLEAR", self.unset)}

    def typed(self, key: str) -> bool:
        """Handle a key: digits edit the entry, and arrows move the selection."""
        return super().typed(key) or self.moves(key)

    def unset(self) -> None:
        """Clear the selected parameter."""
        self._keep(self.marked, None)

    def take(self, text: str) -> bool:
        """Set the selected parameter to the typed value. Raises EntryError outside the permitted range."""
        value = value_of(text)
        low, high = REACH["R"]
        if not low <= value <= high:
            raise EntryError(
                tr(Message("R PARAMETERS RANGE FROM {low} TO {high}", low=f"{low:g}", high=f"{high:g}"))
            )
        return self._keep(self.marked, value)

    def _keep(self, number: int, value: float | None) -> bool:
        """Store and log a value, then prove the loaded program. Return False while a program runs."""
        if self.desk.refused(Act.ZEROS):
            return False
        if self.desk.snapshot().state in UNDER_WAY:
            self.desk.say(tr("PROGRAM RUNNING. CHANGE R PARAMETERS BETWEEN CYCLES"))
            return False
        before = self.values.pop(number, None)
        if value is not None:
            self.values[number] = value
        kept = {str(each): self.values[each] for each in sorted(self.values)}
        told = f"R{number}: {_told(before)} → {_told(value)}"
        self._worker.queue(
            partial(self._persistence.keep_settings, {R_PARAMETERS: kept or None}),
            lambda _none: self._is_kept(told),
            lambda why: self.desk.say(tr(Message("NOT SAVED: {why}", why=why))),
        )
        return True

    def _is_kept(self, told: str) -> None:
        """Log the change and prove the loaded program again."""
        self._persistence.note_change(told)
        now = self.desk.session.now
        if now.path is None or now.job is None:
            return
        if self.desk.snapshot().state in UNDER_WAY:  # A cycle was started in the meantime.
            self.desk.rebuilding.wanted = True
        else:
            self.desk.session.load(now.path, now.block_delete)


def _told(value: float | None) -> str:
    return "none" if value is None else f"{value:.9g}"


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
    """Special function for screen settings. Enter or a touch selects the next choice."""

    name = "SCREEN"
    use = "units, language, operator station, window"

    @property
    def count(self) -> int:
        """Number of settings."""
        return len(WORDS)

    def sheet(self, snapshot: Snapshot) -> Sheet:
        """Return the table with the present choice of each setting."""
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
        """Select the next choice of the selected setting."""
        self._go_on()
        return True

    def choose(self, row: int) -> None:
        """Select the next choice of the touched setting."""
        self.marked = row
        self._go_on()

    def _go_on(self) -> None:
        name = tuple(WORDS)[self.marked]
        settings = self.desk.settings
        if name == "dock" and self.desk.control.panel is None:
            self.desk.say("NOT AVAILABLE: THIS MACHINE HAS A REAL OPERATOR STATION")
            return
        if name == "dock" and settings.now.dock and self.desk.hands.estop_pressed:
            self.desk.say("RELEASE THE E-STOP (U) BEFORE HIDING THE OPERATOR STATION")
            return
        if name == "latched" and not self.desk.machine.one_hand:
            self.desk.say(tr("SIMULATION ONLY: LATCHED PALM BUTTONS COULD START A REAL SPINDLE"))
            return
        if name == "first_job":
            self.desk.runs.restart_first_job()
        self.desk.hands.let_go()
        self.desk.clear()
        self.desk.choose_setting(name, settings.following(name))

    def prompt(self) -> str:
        """Return the prompt about Enter."""
        return "ENTER OR TAP: NEXT CHOICE   ESC: BACK TO THE LIST"


def _in_words(name: str, value: object) -> str:
    if isinstance(value, bool):
        return YES_NO[name][not value]
    return VALUES.get(str(value), str(value))


LIFT = "PRESS Y TO REMOVE THE LIMIT, N TO KEEP IT"


class SpindleSpeedLimit(FigureFunction):
    """Special function for a spindle speed limit that applies until TurnDesk is restarted."""

    name = "MAXIMUM SPINDLE SPEED"
    use = "spindle speed limit until restart"

    def __init__(self, desk: Desk, spindle: SpindleModel) -> None:
        super().__init__(desk)
        self.spindle = spindle

    def sheet(self, snapshot: Snapshot) -> Sheet:
        """Return the table with the machine maximum, the limit and the present speeds."""
        limit = snapshot.spindle_limit
        rows = (
            Row(("MACHINE MAXIMUM", formats.rpm(self.spindle.rpm_max), "rpm")),
            Row(
                ("ACTIVE LIMIT", formats.rpm(limit) if limit else "NONE", "rpm" if limit else ""),
                bool(limit),
            ),
            Row(("COMMANDED SPEED", formats.rpm(snapshot.rpm_command), "rpm")),
            Row(("MEASURED SPEED", _measured(snapshot), "rpm")),
        )
        return Sheet(
            "MAXIMUM SPINDLE SPEED",
            ("", "", ""),
            (0.55, 0.3, 0.15),
            rows,
            question="MAXIMUM SPINDLE SPEED?",
            text=self.entry.text,
            notes=(
                "If a program commands a higher speed, the spindle runs at the limit.",
                "The limit takes effect at once, even while a program runs.",
            ),
            figures=frozenset({1}),
        )

    def keys(self) -> Mapping[str, Key]:
        """Return F4, which removes the limit."""
        return {"F4": Key("NO LIMIT", self.lift)}

    def lift(self) -> None:
        """Remove the limit after confirmation, because a workpiece can be in the chuck."""
        if not self.desk.snapshot().spindle_limit:
            self.desk.say("NO SPINDLE SPEED LIMIT IS ACTIVE")
        elif not self.desk.refused(Act.SPINDLE_LIMIT):
            self.desk.ask(LIFT, self._lifted)

    def _lifted(self) -> None:
        if not self.desk.refused(Act.SPINDLE_LIMIT):
            self._limit(None)

    def _limit(self, rpm: float | None) -> None:
        before = self.desk.snapshot().spindle_limit
        self.desk.post(SpindleLimit(rpm))
        told = " → ".join(
            Message("{speed} rpm", speed=f"{each:g}") if each else "none" for each in (before, rpm)
        )
        self.desk.access.persistence.note_change(Message("spindle speed limit: {details}", details=told))

    def take(self, text: str) -> bool:
        """Set the limit in rpm. Raises EntryError outside the range of the spindle."""
        rpm = value_of(text)
        low, high = self.spindle.rpm_min, self.spindle.rpm_max
        if not low <= rpm <= high:
            raise EntryError(
                Message(
                    "{rpm} rpm is outside the range of this spindle, {low} to {high} rpm",
                    rpm=f"{rpm:g}",
                    low=f"{low:g}",
                    high=f"{high:g}",
                )
            )
        limit = self.desk.snapshot().spindle_limit
        if limit and rpm > limit and self.desk.refused(Act.SPINDLE_LIMIT):
            return False
        self._limit(rpm)
        self.desk.done(tr(Message("SPINDLE LIMITED TO {rpm} RPM UNTIL RESTART", rpm=formats.rpm(rpm))))
        return True

    def prompt(self) -> str:
        """Return the prompt for the limit."""
        return "TYPE A SPEED OR EXPRESSION   ENTER: ACCEPT   ESC: BACK"


def _measured(snapshot: Snapshot) -> str:
    return UNKNOWN if Unknown.SPINDLE in snapshot.unknown else formats.rpm(snapshot.rpm_actual)
