"""Manual functions of the Jog page: spindle, coolant and collet.

Each function is an MDI line that the operator runs with the start buttons. The line is proved and checked
like a typed MDI line, and has the same interlocks. Functions can be turned off without the start buttons.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from app.desk.arithmetic import EXPRESSION_CHARACTERS, MAX_LENGTH, InvalidEntryError, evaluate_expression
from app.desk.desk import Desk
from app.desk.pages.table_content import apply_edit_key, refused
from app.desk.programs.prepared_line import PreparedMdiLine, ProveLine
from app.desk.status import prompt_line
from app.desk.status.readouts import TURNING_RPM
from app.desk.translation import tr
from core.executor.commands import ForceOutput, Reset, StopSpindle
from core.executor.snapshot import CYCLE_STATES, STOPPED_STATES, MachineState, Snapshot, StartAction
from core.language.diagnostics import Diagnostic
from core.machine.machine_model import Machine
from core.message import Message

FORWARD, REVERSE, STOP = "forward", "reverse", "stop"
COOLANT_ON, COOLANT_OFF = "coolant on", "coolant off"
CLOSE, OPEN = "close", "open"
MANUAL_KEYS = {
    "1": FORWARD,
    "2": REVERSE,
    "0": STOP,
    "3": COOLANT_ON,
    "4": COOLANT_OFF,
    "5": CLOSE,
    "6": OPEN,
}
COLLET_REFUSAL = "CANNOT OPEN COLLET WHILE SPINDLE TURNS. 0: STOP SPINDLE"
SPEED_KEY = "9"  # The key that asks for the spindle speed.


class Words(NamedTuple):
    """Program words of the manual functions in one program language.

    ``speed_line`` sets the spindle speed in a separate line, for languages that do not permit S with M3.
    """

    forward_line: str
    reverse_line: str
    coolant_line: str
    collet_lines: tuple[str, str] = ("", "")  # Codes for close and open.
    speed_line: str = ""


CODES_BY_LANGUAGE = {
    "omniturn": Words("G97M03S{rpm:g}", "G97M04S{rpm:g}", "M08", ("M12", "M13")),
    "sinumerik": Words("G97 S{rpm:g} M3", "G97 S{rpm:g} M4", "M8"),
    "klartext": Words("M3", "M4", "M8", speed_line="TOOL CALL S{rpm:g}"),
}


@dataclass(slots=True)
class ManualFunctions:
    """Manual functions, of which at most one is selected, prepared or running.

    ``is_open`` is True while the Jog page is open. ``is_panel_shown`` is True while the panel of the
    functions is visible.
    """

    desk: Desk
    machine: Machine
    prove_line: ProveLine
    prepared_line: PreparedMdiLine = field(init=False)
    is_open: bool = False
    is_panel_shown: bool = False
    selected_function: str = ""
    entered_rpm: float = 0.0  # The speed that was entered last; 0: none.
    is_asking_speed: bool = False  # The speed is being entered.
    text: str = ""
    _wanted: str = ""  # The function to select after the speed is entered.
    _armed: bool = False  # Cycle Start runs lines only.
    _moved: bool = False  # The axes have moved since the selected function was proved.

    def __post_init__(self) -> None:
        self.prepared_line = PreparedMdiLine(self.prove_line, self.desk.post, on_refused=self._refused)

    @property
    def function_codes(self) -> Words:
        """Return the program words of the functions in the program language of the machine."""
        return CODES_BY_LANGUAGE[self.machine.mdi_language]

    @property
    def available_functions(self) -> frozenset[str]:
        """Return the functions that this machine has."""
        found = {FORWARD, REVERSE, STOP}
        if "coolant" in self.machine.outputs:
            found |= {COOLANT_ON, COOLANT_OFF}
        if "collet" in self.machine.outputs and self.function_codes.collet_lines[0]:
            found |= {CLOSE, OPEN}
        return frozenset(found)

    # --- page ----------------------------------------------------------------------------------------

    def on_open(self) -> None:
        """Prepare the functions when the Jog page opens.

        Cycle Start then runs a selected function instead of a program.
        """
        self.is_open = True
        self._arm(self.desk.read_snapshot())

    def _arm(self, snapshot: Snapshot) -> None:
        if not self._armed and snapshot.state not in CYCLE_STATES:
            self._armed = True
            self.prepared_line.cancel_line()

    def try_leave(self) -> bool:
        """Return whether the page can close.

        The page cannot close while the MDI line of a function is running. The spindle remains on when the
        page closes.
        """
        if self.is_line_running(self.desk.read_snapshot()):
            self.desk.say(tr("A LINE IS RUNNING. LET IT END, OR STOP IT AND PRESS R"))
            return False
        if self._armed:
            self.prepared_line.stop_line_mode()
        self.is_open = self.is_panel_shown = self._armed = False
        self._forget()
        return True

    def close(self) -> None:
        """Stop the worker that proves MDI lines."""
        self.prepared_line.close()

    def is_line_running(self, snapshot: Snapshot) -> bool:
        """Return whether the MDI line of a manual function is running."""
        return self._armed and snapshot.state in CYCLE_STATES and snapshot.starts is StartAction.MDI_LINE

    # --- keys and touches ----------------------------------------------------------------------------

    def toggle_panel(self) -> None:
        """Show the manual functions instead of tool setting, or show tool setting again."""
        self.cancel_selection()
        self.desk.clear_prompt_line()
        self.is_panel_shown = not self.is_panel_shown

    def select_function(self, function: str) -> None:
        """Select a manual function.

        A function that turns something off takes effect immediately.
        """
        if function == STOP:
            self.stop_spindle()
        elif function == COOLANT_OFF:
            self._coolant_off()
        elif function in {FORWARD, REVERSE} and not self.start_speed_rpm:
            self.ask_spindle_speed()
            self._wanted = function
        else:
            self._choose(function)

    @property
    def start_speed_rpm(self) -> float:
        """Return the speed in rpm for FORWARD and REVERSE, or 0 if no speed is known.

        This is the active programmed speed S. If the line of the function contains S, an entered speed has
        priority.
        """
        modal = self.desk.read_snapshot().modal
        typed = 0.0 if self.function_codes.speed_line else self.entered_rpm
        return typed or (0.0 if modal.css else modal.rpm)

    def _choose(self, name: str) -> None:
        snapshot = self.desk.read_snapshot()
        why = self._find_refusal(snapshot)
        if not why and name == OPEN and self._is_gripping(snapshot):
            why = tr(COLLET_REFUSAL)
        if why:
            self.desk.say(why)
            return
        self.desk.clear_prompt_line()
        self.selected_function = name
        self.prepared_line.prove_line(self.make_mdi_line(name), snapshot, self._failed)

    def make_mdi_line(self, function: str) -> str:
        """Return the MDI line of a function."""
        words = self.function_codes
        lines = {
            FORWARD: words.forward_line,
            REVERSE: words.reverse_line,
            COOLANT_ON: words.coolant_line,
            CLOSE: words.collet_lines[0],
            OPEN: words.collet_lines[1],
            SPEED_KEY: words.speed_line,
        }
        return tr(
            Message(lines[function], rpm=self.entered_rpm if function == SPEED_KEY else self.start_speed_rpm)
        )

    def _find_refusal(self, snapshot: Snapshot) -> str:
        """Return the reason why no manual function can be selected now, or else an empty string.

        When the line starts, the executor repeats these checks and makes further checks.
        """
        if snapshot.state is MachineState.IDLE:
            return ""
        words = {
            MachineState.DISABLED: tr("DRIVES ARE OFF. PRESS D TO TURN THEM ON"),
            MachineState.ESTOP: tr("E-STOP IS PRESSED. NO AXIS CAN MOVE"),
            MachineState.FAULT: tr("ALARM ACTIVE. CORRECT ITS CAUSE, THEN PRESS R"),
            MachineState.JOG: tr("AXES ARE STILL MOVING"),
            MachineState.HOMING: tr("HOMING. PRESS H TO STOP"),
        }
        return words.get(snapshot.state) or tr("MACHINE IS BUSY. LET IT FINISH, OR PRESS R TO CANCEL")

    def stop_spindle(self) -> None:
        """Stop the spindle immediately, without the start buttons.

        If a line of a manual function is running, it is canceled.
        """
        snapshot = self.desk.read_snapshot()
        self.cancel_selection()
        self.desk.clear_prompt_line()
        self.desk.post(Reset() if self.is_line_running(snapshot) else StopSpindle())

    def _coolant_off(self) -> None:
        self.cancel_selection()
        if self.desk.read_snapshot().state is MachineState.JOG:
            self.desk.say(tr("AXES ARE STILL MOVING"))
        else:
            self.desk.clear_prompt_line()
            self.desk.post(ForceOutput("coolant", on=False))

    # --- the speed -----------------------------------------------------------------------------------

    def ask_spindle_speed(self) -> None:
        """Ask for the spindle speed."""
        self.cancel_selection()
        self.desk.clear_prompt_line()
        self.is_asking_speed, self.text = True, ""

    def handle_key(self, key: str) -> bool:
        """Handle a key, and return False if the Jog page must handle the key."""
        if self.is_asking_speed:
            if key == "Enter":
                self._enter()
            elif key in {"Back", "Delete"} or self.accepts_key(key):
                self.text = apply_edit_key(self.text, key, MAX_LENGTH)
            else:
                return False
            return True
        name = MANUAL_KEYS.get(key, "")
        if name == STOP or (self.is_panel_shown and name in self.available_functions):
            self.select_function(name)
        elif self.is_panel_shown and key == SPEED_KEY:
            self.ask_spindle_speed()
        elif key in {"b", "B"}:
            self.toggle_panel()
        else:
            return False
        return True

    def accepts_key(self, key: str) -> bool:
        """Return whether a character can be entered as part of the speed."""
        return self.is_asking_speed and key in EXPRESSION_CHARACTERS

    def _enter(self) -> None:
        try:
            rpm = evaluate_expression(self.text)
        except InvalidEntryError as error:
            self.text = refused(self.text)
            self.desk.say(tr(Message("REJECTED: {why}", why=error)))
            return
        highest = self.desk.read_snapshot().spindle_limit_rpm or self.machine.spindle.max_rpm
        if not 0.0 < rpm <= highest:
            self.text = refused(self.text)
            self.desk.say(
                tr(
                    Message(
                        "{rpm:g} RPM REJECTED. ENTER MORE THAN 0, UP TO {highest:g} RPM",
                        rpm=rpm,
                        highest=highest,
                    )
                )
            )
            return
        self.entered_rpm, self.is_asking_speed, self.text = rpm, False, ""
        wanted, self._wanted = self._wanted, ""
        if self.function_codes.speed_line:
            self._choose(SPEED_KEY)
        elif wanted:
            self._choose(wanted)

    # --- cancel --------------------------------------------------------------------------------------

    def cancel_selection(self) -> bool:
        """Cancel the selected function or the speed question. Return False if there was nothing to cancel."""
        was = bool(self.selected_function or self.is_asking_speed)
        if self._armed and self.selected_function and not self.is_line_running(self.desk.read_snapshot()):
            self.prepared_line.cancel_line()
        self._forget()
        return was

    def _forget(self) -> None:
        self._moved = False
        self.selected_function, self.is_asking_speed, self.text, self._wanted = "", False, "", ""

    def handle_cancel_key(self) -> bool:
        """Cancel the selected function or the speed question when Esc is pressed.

        Returns False if there was nothing to cancel.
        """
        if self.is_line_running(self.desk.read_snapshot()) or not self.cancel_selection():
            return False
        self.desk.clear_prompt_line()
        return True

    def hide_functions(self) -> bool:
        """Show tool setting again when Esc is pressed.

        Returns False if tool setting is already shown or a line is running.
        """
        if self.is_line_running(self.desk.read_snapshot()):
            return False
        was, self.is_panel_shown = self.is_panel_shown, False
        return was

    def _refused(self, error: Diagnostic) -> None:
        self._forget()
        self.desk.say(tr(Message("REJECTED: {why}", why=f"{tr(error.message)} {tr(error.hint)}".strip())))

    def _failed(self, why: str) -> None:
        self._forget()
        self.desk.say(tr(Message("THE LINE CANNOT BE CHECKED: {why}", why=why)))

    # --- every frame ---------------------------------------------------------------------------------

    def update(self, snapshot: Snapshot) -> None:
        """Process the result of proving a line, and cancel a prepared line if the axes have moved.

        This method is called once per frame.
        """
        self._arm(snapshot)
        if self._armed:
            self.prepared_line.renew_line_mode(snapshot)
        if self.prepared_line.update(snapshot):
            self._forget()
        if self.selected_function and snapshot.state not in {MachineState.IDLE, *CYCLE_STATES}:
            self.cancel_selection()
            self._moved = snapshot.state is MachineState.JOG
        elif self.selected_function == OPEN and self._is_gripping(snapshot):
            self.cancel_selection()
            self.desk.say(tr(COLLET_REFUSAL))

    @staticmethod
    def _is_gripping(snapshot: Snapshot) -> bool:
        """Return whether the collet must stay clamped.

        It must stay clamped while the spindle is turning or a spindle speed is requested.
        """
        return ManualFunctions.is_spindle_turning(snapshot) or snapshot.requested_rpm != 0.0

    def barred(self) -> str:
        """Return the reason why the start buttons cannot start a line now, or an empty string if they can."""
        snapshot = self.desk.read_snapshot()
        if snapshot.state in CYCLE_STATES:
            return "" if self.is_line_running(snapshot) else prompt_line.START_ON_AUTOMATIC
        if snapshot.state is not MachineState.IDLE or self.prepared_line.ready_job is not None:
            return ""
        if not self.is_panel_shown:
            return prompt_line.START_ON_AUTOMATIC
        return tr("NOTHING SELECTED. PICK 1–6, THEN CYCLE START")

    def prompt_text(self, snapshot: Snapshot) -> str:
        """Return the prompt for manual functions, or an empty string if another prompt applies."""
        if self.is_asking_speed:
            return tr("TYPE THE RPM AND PRESS ENTER. ESC: CANCEL")
        if self.is_line_running(snapshot):
            words = tr("{line} IS RUNNING. 0: STOP SPINDLE")
            if snapshot.state in STOPPED_STATES:
                words = tr("{line} STOPPED. CYCLE START: RESUME   0: STOP SPINDLE, CANCEL")
            return tr(Message(words, line=snapshot.block_text))
        if snapshot.state is not MachineState.IDLE:
            return ""
        if self.prepared_line.is_proving:
            return tr("CHECKING THE LINE FOR ERRORS")
        return self._ready_words(snapshot)

    def _ready_words(self, snapshot: Snapshot) -> str:
        if self.prepared_line.ready_job is not None:
            words = tr("RUN {line}: {start}   ESC: CANCEL")
            line = self.prepared_line.ready_job.source.text
            if self.function_codes.speed_line and self.selected_function in {FORWARD, REVERSE}:
                line = f"{line} (S{self.start_speed_rpm:g})"  # The line itself does not contain the active S.
            return tr(Message(words, line=line, start=tr(self.desk.start_instruction)))
        if self._moved:
            return tr("AXES WERE MOVED. PICK THE FUNCTION AGAIN")
        if self.is_spindle_turning(snapshot):
            return tr("SPINDLE IS TURNING. KEEP CLEAR. 0: STOP   HOLD AN ARROW: JOG")
        if not self.is_panel_shown:
            return ""
        return tr("PICK 1–6, THEN CYCLE START. 9: RPM. B: TOOL SETTING")

    @staticmethod
    def is_spindle_turning(snapshot: Snapshot) -> bool:
        """Return whether the spindle is turning or is commanded to turn."""
        return abs(snapshot.rpm_actual) > TURNING_RPM or snapshot.rpm_command != 0.0
