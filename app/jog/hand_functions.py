"""Manual functions of the Jog page: spindle, coolant and collet.

Each function is an MDI line that the operator starts with the start buttons. The line is proved and checked
like a typed MDI line, with the same interlocks. Switching a function off needs no start buttons.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from app.desk.arithmetic import CHARACTERS, LONGEST, EntryError, value_of
from app.desk.desk import Desk
from app.desk.pages.sheet import edited, refused
from app.desk.programs.prepared_line import PreparedLine, ProveLine
from app.desk.status import prompt_line
from app.desk.status.readouts import TURNING
from app.desk.translation import tr
from core.executor.commands import ForceOutput, Reset, SpindleStop
from core.executor.snapshot import CYCLE, STOPPED, Snapshot, Starts, State
from core.language.diagnostics import Diagnostic
from core.machine.machine_model import Machine
from core.message import Message

FORWARD, REVERSE, STOP = "forward", "reverse", "stop"
COOLANT_ON, COOLANT_OFF = "coolant on", "coolant off"
CLOSE, OPEN = "close", "open"
KEYS = {
    "1": FORWARD,
    "2": REVERSE,
    "0": STOP,
    "3": COOLANT_ON,
    "4": COOLANT_OFF,
    "5": CLOSE,
    "6": OPEN,
}
NOT_OPENED = "CANNOT OPEN COLLET WHILE SPINDLE TURNS. 0: STOP SPINDLE"
SPEED = "9"  # The key that asks for the spindle speed.


class Words(NamedTuple):
    """The code of each function in a programming language.

    ``speed`` is a separate line for the speed, if S is not allowed in the line of M3.
    """

    forward: str
    reverse: str
    coolant: str
    collet: tuple[str, str] = ("", "")  # Codes for close and open.
    speed: str = ""


WORDS = {
    "omniturn": Words("G97M03S{rpm:g}", "G97M04S{rpm:g}", "M08", ("M12", "M13")),
    "sinumerik": Words("G97 S{rpm:g} M3", "G97 S{rpm:g} M4", "M8"),
    "klartext": Words("M3", "M4", "M8", speed="TOOL CALL S{rpm:g}"),
}


@dataclass(slots=True)
class HandFunctions:
    """The manual function that is selected, prepared or running.

    ``open`` is True while the Jog page is open. ``shown`` is True while the panel of the functions is
    visible.
    """

    desk: Desk
    machine: Machine
    prove: ProveLine
    line: PreparedLine = field(init=False)
    open: bool = False
    shown: bool = False
    chosen: str = ""
    rpm: float = 0.0  # The speed that was entered last; 0: none.
    asked: bool = False  # The speed is being entered.
    text: str = ""
    _wanted: str = ""  # The function to select after the speed is entered.
    _armed: bool = False  # Cycle Start runs lines only.
    _moved: bool = False  # The axes have moved since the selected function was proved.

    def __post_init__(self) -> None:
        self.line = PreparedLine(self.prove, self.desk.post, refused=self._refused)

    @property
    def words(self) -> Words:
        """The codes in the machine's programming language."""
        return WORDS[self.machine.language]

    @property
    def there(self) -> frozenset[str]:
        """The functions that this machine has."""
        found = {FORWARD, REVERSE, STOP}
        if "coolant" in self.machine.outputs:
            found |= {COOLANT_ON, COOLANT_OFF}
        if "collet" in self.machine.outputs and self.words.collet[0]:
            found |= {CLOSE, OPEN}
        return frozenset(found)

    # --- page ----------------------------------------------------------------------------------------

    def opened(self) -> None:
        """Prepare for the open Jog page: Cycle Start runs selected functions and no program."""
        self.open = True
        self._arm(self.desk.snapshot())

    def _arm(self, snapshot: Snapshot) -> None:
        if not self._armed and snapshot.state not in CYCLE:
            self._armed = True
            self.line.take_back()

    def leave(self) -> bool:
        """Return whether the page can close, which is not possible while a line runs.

        The spindle remains on.
        """
        if self.under_way(self.desk.snapshot()):
            self.desk.say(tr("A LINE IS RUNNING. LET IT END, OR STOP IT AND PRESS R"))
            return False
        if self._armed:
            self.line.leave()
        self.open = self.shown = self._armed = False
        self._forget()
        return True

    def close(self) -> None:
        """End the worker that proves lines."""
        self.line.close()

    def under_way(self, snapshot: Snapshot) -> bool:
        """Return whether a line that was selected here is running."""
        return self._armed and snapshot.state in CYCLE and snapshot.starts is Starts.LINE

    # --- keys and touches ----------------------------------------------------------------------------

    def toggle(self) -> None:
        """Show the manual functions, or tool setting again."""
        self.take_back()
        self.desk.clear()
        self.shown = not self.shown

    def press(self, name: str) -> None:
        """Select a function. A function that switches something off acts immediately."""
        if name == STOP:
            self.stop()
        elif name == COOLANT_OFF:
            self._coolant_off()
        elif name in {FORWARD, REVERSE} and not self.speed:
            self.ask_speed()
            self._wanted = name
        else:
            self._choose(name)

    @property
    def speed(self) -> float:
        """The speed in rpm that FORWARD and REVERSE start, or 0 if none is known.

        The speed is the active S, or the entered one if S is in the line of the function.
        """
        modal = self.desk.snapshot().modal
        typed = 0.0 if self.words.speed else self.rpm
        return typed or (0.0 if modal.css else modal.rpm)

    def _choose(self, name: str) -> None:
        snapshot = self.desk.snapshot()
        why = self._barred(snapshot)
        if not why and name == OPEN and self._gripping(snapshot):
            why = tr(NOT_OPENED)
        if why:
            self.desk.say(why)
            return
        self.desk.clear()
        self.chosen = name
        self.line.ask(self.text_of(name), snapshot, self._failed)

    def text_of(self, name: str) -> str:
        """Return the MDI line of a function."""
        words = self.words
        lines = {
            FORWARD: words.forward,
            REVERSE: words.reverse,
            COOLANT_ON: words.coolant,
            CLOSE: words.collet[0],
            OPEN: words.collet[1],
            SPEED: words.speed,
        }
        return tr(Message(lines[name], rpm=self.rpm if name == SPEED else self.speed))

    def _barred(self, snapshot: Snapshot) -> str:
        """Return why no function can be selected now.

        The executor makes the same checks, and more, at the start.
        """
        if snapshot.state is State.IDLE:
            return ""
        words = {
            State.DISABLED: tr("DRIVES ARE OFF. PRESS D TO TURN THEM ON"),
            State.ESTOP: tr("E-STOP IS PRESSED. NO AXIS CAN MOVE"),
            State.FAULT: tr("ALARM ACTIVE. CORRECT ITS CAUSE, THEN PRESS R"),
            State.JOG: tr("AXES ARE STILL MOVING"),
            State.HOME: tr("HOMING. PRESS H TO STOP"),
        }
        return words.get(snapshot.state) or tr("MACHINE IS BUSY. LET IT FINISH, OR PRESS R TO CANCEL")

    def stop(self) -> None:
        """Stop the spindle immediately, without the start buttons.

        A running line of this page is canceled.
        """
        snapshot = self.desk.snapshot()
        self.take_back()
        self.desk.clear()
        self.desk.post(Reset() if self.under_way(snapshot) else SpindleStop())

    def _coolant_off(self) -> None:
        self.take_back()
        if self.desk.snapshot().state is State.JOG:
            self.desk.say(tr("AXES ARE STILL MOVING"))
        else:
            self.desk.clear()
            self.desk.post(ForceOutput("coolant", on=False))

    # --- the speed -----------------------------------------------------------------------------------

    def ask_speed(self) -> None:
        """Ask for the spindle speed."""
        self.take_back()
        self.desk.clear()
        self.asked, self.text = True, ""

    def typed(self, key: str) -> bool:
        """Handle a key. Return False to leave the key to the page."""
        if self.asked:
            if key == "Enter":
                self._enter()
            elif key in {"Back", "Delete"} or self.takes(key):
                self.text = edited(self.text, key, LONGEST)
            else:
                return False
            return True
        name = KEYS.get(key, "")
        if name == STOP or (self.shown and name in self.there):
            self.press(name)
        elif self.shown and key == SPEED:
            self.ask_speed()
        elif key in {"b", "B"}:
            self.toggle()
        else:
            return False
        return True

    def takes(self, key: str) -> bool:
        """Return whether this character is text input for the speed."""
        return self.asked and key in CHARACTERS

    def _enter(self) -> None:
        try:
            rpm = value_of(self.text)
        except EntryError as error:
            self.text = refused(self.text)
            self.desk.say(tr(Message("REJECTED: {why}", why=error)))
            return
        highest = self.desk.snapshot().spindle_limit or self.machine.spindle.rpm_max
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
        self.rpm, self.asked, self.text = rpm, False, ""
        wanted, self._wanted = self._wanted, ""
        if self.words.speed:
            self._choose(SPEED)
        elif wanted:
            self._choose(wanted)

    # --- cancel --------------------------------------------------------------------------------------

    def take_back(self) -> bool:
        """Cancel the selected function or the question. Return False if there was neither."""
        was = bool(self.chosen or self.asked)
        if self._armed and self.chosen and not self.under_way(self.desk.snapshot()):
            self.line.take_back()
        self._forget()
        return was

    def _forget(self) -> None:
        self._moved = False
        self.chosen, self.asked, self.text, self._wanted = "", False, "", ""

    def take_back_by_key(self) -> bool:
        """Handle Esc: cancel the selected function or the question. Return False if nothing was canceled."""
        if self.under_way(self.desk.snapshot()) or not self.take_back():
            return False
        self.desk.clear()
        return True

    def hide(self) -> bool:
        """Handle Esc: show tool setting again. Return False if it is already shown or a line is running."""
        if self.under_way(self.desk.snapshot()):
            return False
        was, self.shown = self.shown, False
        return was

    def _refused(self, error: Diagnostic) -> None:
        self._forget()
        self.desk.say(tr(Message("REJECTED: {why}", why=f"{tr(error.message)} {tr(error.hint)}".strip())))

    def _failed(self, why: str) -> None:
        self._forget()
        self.desk.say(tr(Message("THE LINE CANNOT BE CHECKED: {why}", why=why)))

    # --- every frame ---------------------------------------------------------------------------------

    def look(self, snapshot: Snapshot) -> None:
        """Accept the proof of a line; called once a frame.

        A prepared line is canceled if the axes have moved.
        """
        self._arm(snapshot)
        if self._armed:
            self.line.keep(snapshot)
        if self.line.look(snapshot):
            self._forget()
        if self.chosen and snapshot.state not in {State.IDLE, *CYCLE}:
            self.take_back()
            self._moved = snapshot.state is State.JOG
        elif self.chosen == OPEN and self._gripping(snapshot):
            self.take_back()
            self.desk.say(tr(NOT_OPENED))

    @staticmethod
    def _gripping(snapshot: Snapshot) -> bool:
        """Return whether the collet clamps a part that turns or that a switch could start to turn."""
        return HandFunctions.turns(snapshot) or snapshot.spindle_asked != 0.0

    def barred(self) -> str:
        """Return why the start buttons have no effect now. Empty if they can start a line."""
        snapshot = self.desk.snapshot()
        if snapshot.state in CYCLE:
            return "" if self.under_way(snapshot) else prompt_line.NOT_HERE
        if snapshot.state is not State.IDLE or self.line.ready is not None:
            return ""
        if not self.shown:
            return prompt_line.NOT_HERE
        return tr("NOTHING SELECTED. PICK 1–6, THEN CYCLE START")

    def prompt(self, snapshot: Snapshot) -> str:
        """Return the prompt for manual functions. Empty if the prompt for jogging applies."""
        if self.asked:
            return tr("TYPE THE RPM AND PRESS ENTER. ESC: CANCEL")
        if self.under_way(snapshot):
            words = tr("{line} IS RUNNING. 0: STOP SPINDLE")
            if snapshot.state in STOPPED:
                words = tr("{line} STOPPED. CYCLE START: RESUME   0: STOP SPINDLE, CANCEL")
            return tr(Message(words, line=snapshot.block_text))
        if snapshot.state is not State.IDLE:
            return ""
        if self.line.busy:
            return tr("CHECKING THE LINE FOR ERRORS")
        return self._ready_words(snapshot)

    def _ready_words(self, snapshot: Snapshot) -> str:
        if self.line.ready is not None:
            words = tr("RUN {line}: {start}   ESC: CANCEL")
            line = self.line.ready.source.text
            if self.words.speed and self.chosen in {FORWARD, REVERSE}:
                line = f"{line} (S{self.speed:g})"  # The line itself does not contain the active S.
            return tr(Message(words, line=line, start=tr(self.desk.start_words)))
        if self._moved:
            return tr("AXES WERE MOVED. PICK THE FUNCTION AGAIN")
        if self.turns(snapshot):
            return tr("SPINDLE IS TURNING. KEEP CLEAR. 0: STOP   HOLD AN ARROW: JOG")
        if not self.shown:
            return ""
        return tr("PICK 1–6, THEN CYCLE START. 9: RPM. B: TOOL SETTING")

    @staticmethod
    def turns(snapshot: Snapshot) -> bool:
        """Return whether the spindle turns or is commanded to turn."""
        return abs(snapshot.rpm_actual) > TURNING or snapshot.rpm_command != 0.0
