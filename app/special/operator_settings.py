"""Operator settings: units, language, theme, spindle speed limit and R parameters."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

from app.desk.arithmetic import InvalidEntryError, evaluate_expression
from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import FunctionKey, TableContent, TableRow
from app.desk.persistence import Persistence
from app.desk.screen_settings import SYSTEM_THEME
from app.desk.status import formats
from app.desk.status.prompt_line import ACTIVE_STATES
from app.desk.status.readouts import UNKNOWN_VALUE
from app.desk.translation import tr
from app.offsets.active_offsets import R_PARAMETERS_SETTING, parse_r_parameters
from app.special.special_functions import NumericEntryFunction, SpecialFunction
from core.access.access_table import ProtectedChange
from core.executor.commands import SetSpindleLimit
from core.executor.snapshot import Snapshot
from core.language.sinumerik.block_reader import MAX_R_NUMBER
from core.language.sinumerik.sinumerik_words import VALUE_RANGES
from core.machine.machine_model import SpindleModel
from core.message import Message
from core.ports import UnknownPart
from core.store.store_errors import StoreError


class RParametersFunction(NumericEntryFunction):
    """Special function for R parameters.

    A typed value applies to the selected row. The loaded program is then proved again.
    """

    name = "R PARAMETERS"
    use = "R0 to R299 of SINUMERIK programs"

    def __init__(self, desk: Desk, persistence: Persistence, worker: LatestRequestWorker) -> None:
        super().__init__(desk)
        self._persistence, self._worker = persistence, worker
        self.parameter_values: dict[int, float] = {}  # parameters with a value
        self.on_open()

    def on_open(self) -> None:
        """Load the stored values when the function opens."""
        if self._worker.is_busy:
            return  # The pending values are already displayed.
        try:
            self.parameter_values = parse_r_parameters(self._persistence.read_setting(R_PARAMETERS_SETTING))
        except StoreError:
            self.parameter_values = {}  # TurnDesk itself reports that nothing is stored.

    @property
    def row_count(self) -> int:
        """Return the number of R parameters (R0 to R299)."""
        return MAX_R_NUMBER + 1

    def make_table(self, _snapshot: Snapshot) -> TableContent:
        """Return the table of all parameters.

        A dash means that the parameter is not set and counts as 0.
        """
        values = self.parameter_values
        rows = tuple(
            TableRow((f"R{number}", f"{values[number]:.9g}" if number in values else "–"), number in values)
            for number in range(self.row_count)
        )
        return TableContent(
            "R PARAMETERS",
            ("", ""),
            (0.4, 0.6),
            rows,
            self.marked,
            entry_prompt=f"R{self.marked}?",
            text=self.entry.text,
            notes=(
                (
                    "Every SINUMERIK program starts with these values. Values that the program assigns "
                    "apply until the program ends."
                ),
                "A parameter without a value is treated as 0, and a warning is shown.",
            ),
            numeric_columns=frozenset({1}),
        )

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function key F4, which clears the selected parameter."""
        return {"F4": FunctionKey("CLEAR", self.clear_selected_parameter)}

    def handle_key(self, key: str) -> bool:
        """Handle a key.

        Digits edit the entry, and arrow keys move the selection.
        """
        return super().handle_key(key) or self.move_selection(key)

    def clear_selected_parameter(self) -> None:
        """Clear the selected parameter."""
        self._save_value(self.marked, None)

    def accept_entry(self, text: str) -> bool:
        """Set the selected parameter to the typed value.

        Raise InvalidEntryError if the value is outside the permitted range.
        """
        value = evaluate_expression(text)
        low, high = VALUE_RANGES["R"]
        if not low <= value <= high:
            raise InvalidEntryError(
                tr(Message("R PARAMETERS RANGE FROM {low} TO {high}", low=f"{low:g}", high=f"{high:g}"))
            )
        return self._save_value(self.marked, value)

    def _save_value(self, number: int, value: float | None) -> bool:
        """Store and log an R parameter, then prove the loaded program again.

        Return False if a program is running.
        """
        if self.desk.is_refused(ProtectedChange.ZEROS):
            return False
        if self.desk.read_snapshot().state in ACTIVE_STATES:
            self.desk.say(tr("PROGRAM RUNNING. CHANGE R PARAMETERS BETWEEN CYCLES"))
            return False
        before = self.parameter_values.pop(number, None)
        if value is not None:
            self.parameter_values[number] = value
        kept = {str(each): self.parameter_values[each] for each in sorted(self.parameter_values)}
        change_text = f"R{number}: {_told(before)} → {_told(value)}"
        self._worker.enqueue_work(
            partial(self._persistence.save_settings, {R_PARAMETERS_SETTING: kept or None}),
            lambda _none: self._handle_saved(change_text),
            lambda why: self.desk.say(tr(Message("NOT SAVED: {why}", why=why))),
        )
        return True

    def _handle_saved(self, message: str) -> None:
        """Log the change of an R parameter, and prove the loaded program again."""
        self._persistence.log_change(message)
        now = self.desk.program_loader.loaded_program
        if now.path is None or now.job is None:
            return
        if self.desk.read_snapshot().state in ACTIVE_STATES:  # A cycle was started in the meantime.
            self.desk.renewal.is_requested = True
        else:
            self.desk.program_loader.start_loading(now.path, now.is_block_delete_on)


def _told(value: float | None) -> str:
    return "none" if value is None else f"{value:.9g}"


SETTING_NAMES = {
    "units": "DISPLAY UNITS",
    "readout": "VALUE IN LARGE READOUT",
    "language": "LANGUAGE",
    "theme": "COLORS",
    "dock": "ON-SCREEN OPERATOR STATION",
    "latched": "ON-SCREEN PALM BUTTONS",
    "full_screen": "WINDOW",
    "first_job": "FIRST JOB CARD",
}
YES_NO_NAMES = {
    "dock": ("SHOWN", "HIDDEN"),
    "latched": ("PRESS BUTTONS IN SEQUENCE", "PRESS BUTTONS TOGETHER"),
    "full_screen": ("FULL SCREEN", "WINDOW"),
    "first_job": ("SHOWN", "HIDDEN"),
}
VALUE_NAMES = {
    "en": "ENGLISH",
    "es": "ESPAÑOL",
    SYSTEM_THEME: "AS THE SYSTEM",
    "dark": "DARK",
    "light": "LIGHT",
    "contrast": "HIGH CONTRAST",
}


class ScreenSettingsFunction(SpecialFunction):
    """Special function for screen settings.

    Enter or a tap selects the next value of a setting.
    """

    name = "SCREEN"
    use = "units, language, operator station, window"

    @property
    def row_count(self) -> int:
        """Return the number of settings."""
        return len(SETTING_NAMES)

    def make_table(self, snapshot: Snapshot) -> TableContent:
        """Return the table of screen settings with their current values."""
        now = self.desk.settings_store.current_settings
        rows = tuple(
            TableRow((words, _in_words(name, getattr(now, name)))) for name, words in SETTING_NAMES.items()
        )
        metric = snapshot.modal.metric
        return TableContent(
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

    def activate_selected_row(self) -> bool:
        """Change the selected setting to its next value."""
        self._go_on()
        return True

    def choose(self, row: int) -> None:
        """Change the touched setting to its next value."""
        self.marked = row
        self._go_on()

    def _go_on(self) -> None:
        name = tuple(SETTING_NAMES)[self.marked]
        settings = self.desk.settings_store
        if name == "dock" and self.desk.desk_control.station_panel is None:
            self.desk.say("NOT AVAILABLE: THIS MACHINE HAS A REAL OPERATOR STATION")
            return
        if name == "dock" and settings.current_settings.dock and self.desk.station_controls.is_estop_pressed:
            self.desk.say("RELEASE THE E-STOP (U) BEFORE HIDING THE OPERATOR STATION")
            return
        if name == "latched" and not self.desk.machine.allows_one_hand_start:
            self.desk.say(tr("SIMULATION ONLY: LATCHED PALM BUTTONS COULD START A REAL SPINDLE"))
            return
        if name == "first_job":
            self.desk.program_runs.restart_first_job()
        self.desk.station_controls.release_all_buttons()
        self.desk.clear_prompt_line()
        self.desk.apply_setting(name, settings.find_next_choice(name))

    def prompt_text(self) -> str:
        """Return the prompt, which explains the Enter and Esc keys."""
        return "ENTER OR TAP: NEXT CHOICE   ESC: BACK TO THE LIST"


def _in_words(name: str, value: object) -> str:
    if isinstance(value, bool):
        return YES_NO_NAMES[name][not value]
    return VALUE_NAMES.get(str(value), str(value))


CONFIRM_REMOVE_LIMIT = "PRESS Y TO REMOVE THE LIMIT, N TO KEEP IT"


class SpindleLimitFunction(NumericEntryFunction):
    """Special function for a spindle speed limit that applies until TurnDesk is restarted."""

    name = "MAXIMUM SPINDLE SPEED"
    use = "spindle speed limit until restart"

    def __init__(self, desk: Desk, spindle: SpindleModel) -> None:
        super().__init__(desk)
        self.spindle = spindle

    def make_table(self, snapshot: Snapshot) -> TableContent:
        """Return the table with the machine maximum, the active limit and the current spindle speeds."""
        limit = snapshot.spindle_limit_rpm
        rows = (
            TableRow(("MACHINE MAXIMUM", formats.rpm(self.spindle.max_rpm), "rpm")),
            TableRow(
                ("ACTIVE LIMIT", formats.rpm(limit) if limit else "NONE", "rpm" if limit else ""),
                bool(limit),
            ),
            TableRow(("COMMANDED SPEED", formats.rpm(snapshot.rpm_command), "rpm")),
            TableRow(("MEASURED SPEED", _measured(snapshot), "rpm")),
        )
        return TableContent(
            "MAXIMUM SPINDLE SPEED",
            ("", "", ""),
            (0.55, 0.3, 0.15),
            rows,
            entry_prompt="MAXIMUM SPINDLE SPEED?",
            text=self.entry.text,
            notes=(
                "If a program commands a higher speed, the spindle runs at the limit.",
                "The limit takes effect at once, even while a program runs.",
            ),
            numeric_columns=frozenset({1}),
        )

    def make_function_keys(self) -> Mapping[str, FunctionKey]:
        """Return the function key F4, which removes the limit."""
        return {"F4": FunctionKey("NO LIMIT", self.confirm_limit_removal)}

    def confirm_limit_removal(self) -> None:
        """Remove the spindle speed limit after the operator confirms."""
        if not self.desk.read_snapshot().spindle_limit_rpm:
            self.desk.say("NO SPINDLE SPEED LIMIT IS ACTIVE")
        elif not self.desk.is_refused(ProtectedChange.SPINDLE_LIMIT):
            self.desk.ask_operator(CONFIRM_REMOVE_LIMIT, self._lifted)

    def _lifted(self) -> None:
        if not self.desk.is_refused(ProtectedChange.SPINDLE_LIMIT):
            self._limit(None)

    def _limit(self, rpm: float | None) -> None:
        before = self.desk.read_snapshot().spindle_limit_rpm
        self.desk.post(SetSpindleLimit(rpm))
        change = " → ".join(
            Message("{speed} rpm", speed=f"{each:g}") if each else "none" for each in (before, rpm)
        )
        self.desk.user_access.persistence.log_change(
            Message("spindle speed limit: {details}", details=change)
        )

    def accept_entry(self, text: str) -> bool:
        """Set the spindle speed limit in rpm.

        Raise InvalidEntryError if the limit is outside the range of the spindle.
        """
        rpm = evaluate_expression(text)
        low, high = self.spindle.min_rpm, self.spindle.max_rpm
        if not low <= rpm <= high:
            raise InvalidEntryError(
                Message(
                    "{rpm} rpm is outside the range of this spindle, {low} to {high} rpm",
                    rpm=f"{rpm:g}",
                    low=f"{low:g}",
                    high=f"{high:g}",
                )
            )
        limit = self.desk.read_snapshot().spindle_limit_rpm
        if limit and rpm > limit and self.desk.is_refused(ProtectedChange.SPINDLE_LIMIT):
            return False
        self._limit(rpm)
        self.desk.show_success(
            tr(Message("SPINDLE LIMITED TO {rpm} RPM UNTIL RESTART", rpm=formats.rpm(rpm)))
        )
        return True

    def prompt_text(self) -> str:
        """Return the prompt for entering a spindle speed limit."""
        return "TYPE A SPEED OR EXPRESSION   ENTER: ACCEPT   ESC: BACK"


def _measured(snapshot: Snapshot) -> str:
    return UNKNOWN_VALUE if UnknownPart.SPINDLE in snapshot.unknown else formats.rpm(snapshot.rpm_actual)
