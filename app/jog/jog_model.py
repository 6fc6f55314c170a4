"""Model of the Jog page: its key functions and the conditions for manual motion."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.desk.desk import Desk
from app.desk.late_presses import BlockedLateAction
from app.desk.status import prompt_line
from app.desk.status.prompt_line import RELEASE_STOP_KEY
from app.desk.translation import tr
from app.jog.held_jog import CONTINUOUS_STEP_INDEX, JogDirection, JogSpeeds, make_jog_directions
from app.jog.jog_handwheel import JogHandwheel, MachineJogButtons
from app.jog.jog_homing import HomingQuestion
from app.jog.manual_functions import ManualFunctions
from app.jog.skim_cut_and_setter import HeldTouchOff, SkimCut, ToolSetterTouchOff
from app.jog.tilted_jog import TiltedJog
from app.jog.tool_setting import TOOL_QUESTION, ToolSetting
from app.jog.tool_touch_off import TOUCH_X, TOUCH_Z
from app.jog.touch_off_picture import TouchOffPictures
from app.offsets.mill_touch import MillTouchCalculator
from core.executor.commands import StopJog
from core.executor.snapshot import ACTIVE_STATES, MachineState, Snapshot
from core.machine.machine_model import Machine
from core.message import Message

MAX_LEASE_S = 0.25  # Maximum lease in seconds, also if the machine file specifies a longer one.

# Letters that ask for a value of the selected tool, while no question is open.
QUESTION_LETTERS = {
    "t": TOOL_QUESTION,
    "x": TOUCH_X,
    "z": TOUCH_Z,
    "n": "nose_radius",
    "q": "quadrant",
    "w": "wear_x",
    "k": "remark",
}


@dataclass(slots=True)
class JogModel:
    """Model of the Jog page, with jog, handwheel, homing, tool setting and manual functions."""

    desk: Desk
    machine: Machine
    jog_speeds: JogSpeeds = field(init=False)
    held_jog: HeldTouchOff = field(init=False)
    handwheel: JogHandwheel = field(init=False)
    homing_question: HomingQuestion = field(init=False)
    tool_setting: ToolSetting = field(init=False)
    touch_off_pictures: TouchOffPictures = field(init=False)
    skim_cut: SkimCut = field(init=False)
    manual_functions: ManualFunctions = field(init=False)
    tool_setter_touch_off: ToolSetterTouchOff = field(init=False)
    pendant_buttons: MachineJogButtons = field(init=False)
    tilted_jog: TiltedJog = field(init=False)
    directions: tuple[JogDirection, ...] = ()

    def __post_init__(self) -> None:
        desk = self.desk
        self.jog_speeds = JogSpeeds(self.machine)
        self.directions = make_jog_directions(self.machine)
        lease = min(self.machine.timing.motion_lease_s, MAX_LEASE_S)
        self.held_jog = HeldTouchOff(
            self.jog_speeds,
            lease,
            desk.post,
            desk.say,
            desk.clear_prompt_line,
            self._now,
            self.find_jog_refusal,
            refuses_late_press=desk.window_state.late_presses.refuse_late_press,
        )
        moved = {each.axis_name for each in self.directions}
        names = tuple(axis.name for axis in self.machine.axes if axis.name in moved)
        self.handwheel = JogHandwheel(self.machine, self.held_jog, names, self._find_wheel_refusal)
        self.homing_question = HomingQuestion(self.machine, desk)
        self.tool_setting = ToolSetting(desk, desk.offset_book)
        self.touch_off_pictures = TouchOffPictures(self.tool_setting)
        self.skim_cut = SkimCut(desk, self.tool_setting)
        hand = desk.page_registry.find_model(ManualFunctions)
        if hand is None:
            raise RuntimeError("the desk was put together without functions by hand")
        self.manual_functions = hand
        self.tool_setter_touch_off = ToolSetterTouchOff(
            desk, self.machine, self.tool_setting, lease, self.directions
        )
        self.held_jog.tool_setter_touch_off = self.tool_setter_touch_off
        self.pendant_buttons = MachineJogButtons(self.machine, self.held_jog, self.handwheel, names)
        self.tilted_jog = TiltedJog(
            MillTouchCalculator.get_for_desk(desk).kinematics, self._end_hold, desk.say
        )
        self.held_jog.find_direction = self.tilted_jog.find_direction

    @property
    def is_entry_open(self) -> bool:
        """Return whether the operator is entering a tool value or the spindle speed."""
        return bool(self.tool_setting.question_name) or self.manual_functions.is_asking_speed

    def _now(self) -> float:
        return self.desk.station_controls.clock()

    def find_jog_refusal(self) -> str:
        """Return the reason why axes cannot be jogged now, or an empty string if they can.

        This method cancels an open homing question.
        """
        state = self.desk.read_snapshot().state
        if self.desk.window_state.is_stop_key_held():
            return tr(RELEASE_STOP_KEY)
        if self.is_entry_open:
            return tr("ARROWS DO NOT JOG WHILE YOU TYPE A VALUE. PRESS ENTER OR ESC")
        if self.homing_question.cancel():
            return tr("HOMING CANCELED. PRESS THE ARROW AGAIN TO JOG")
        return find_jog_refusal(state)

    def _find_wheel_refusal(self) -> str:
        """Return the reason why the handwheel cannot move an axis now, or an empty string if it can.

        Unlike ``find_jog_refusal``, this method does not cancel an open question.
        """
        if self.tilted_jog.is_on:
            return tr("HANDWHEEL MOVES ONLY MACHINE AXES. F5: TURN 3D-ROT OFF FIRST")
        if self.is_entry_open:
            return tr("HANDWHEEL IS OFF WHILE YOU ENTER A VALUE")
        return find_jog_refusal(self.desk.read_snapshot().state)

    def update(self, snapshot: Snapshot) -> None:
        """Update all models of the page and renew the motion lease of the jog.

        This method is called once per frame.
        """
        self.tilted_jog.update(snapshot)
        self.held_jog.update(snapshot)
        self.pendant_buttons.update(snapshot)
        self.handwheel.update(snapshot)
        self.tool_setter_touch_off.update(snapshot)
        self.tool_setting.update(snapshot)
        self.skim_cut.update(snapshot)
        self.touch_off_pictures.update()
        self.manual_functions.update(snapshot)
        if self.tool_setting.question_name and (
            self.manual_functions.selected_function or self.manual_functions.is_asking_speed
        ):
            # The operator may be at the workpiece, so no line stays prepared during a question.
            self.manual_functions.cancel_selection()

    def prompt_text(self, snapshot: Snapshot) -> str:
        """Return the prompt of the Jog page for the current state."""
        if self.tool_setting.is_tool_setter_result:
            return tr("ENTER: SAVE MEASURED VALUE   ESC: DISCARD")
        if self.tool_setting.question_name:
            return tr("TYPE VALUE OR EXPRESSION (.5-.002), PRESS ENTER. ESC: CANCEL")
        return self._make_work_prompt(snapshot) or self._prompt_of_jog(snapshot)

    def _make_work_prompt(self, snapshot: Snapshot) -> str:
        """Return the prompt for an activity other than jogging, or an empty string if there is none."""
        hand = self.manual_functions
        if hand.is_asking_speed or hand.selected_function or hand.is_line_running(snapshot):
            return hand.prompt_text(snapshot)
        words = self.skim_cut.make_step_prompt(snapshot) or self.tool_setter_touch_off.prompt_text(snapshot)
        return (find_jog_refusal(snapshot.state) or words) if words else hand.prompt_text(snapshot)

    def _prompt_of_jog(self, snapshot: Snapshot) -> str:
        wheel = self.handwheel.wheel_choice[0] if self.handwheel.wheel_choice else ""
        why = make_jog_prompt(
            snapshot.state,
            self.homing_question.find_unhomed_axes(snapshot),
            wheel,
            self.jog_speeds.step_index,
        )
        if why:
            return why
        if not self.is_mill and not self.tool_setting.tool_number:
            return tr("HOLD AN ARROW TO JOG. SHIFT: RAPID   T: SELECT TOOL")
        if not self.is_mill:
            return tr("HOLD ARROW TO JOG. SHIFT: RAPID   T: TOOL   X, Z: TOUCH OFF")
        if self.tilted_jog.is_on:
            return tr("HOLD A KEY TO JOG IN TILTED X' Y' Z'. SHIFT: RAPID")
        return tr("HOLD KEY TO JOG. SHIFT: RAPID   TOUCH OFF: F8 TOOL, F9 PART")

    # --- step and speed: any change ends the jog -----------------------------------------------------

    def select_next_step(self) -> None:
        """Select the next jog step, and stop the jog (F2)."""
        self._another_step()
        self.jog_speeds.select_next_step()

    def select_step(self, step_index: int) -> None:
        """Stop the jog, and select the jog step with this index."""
        self._another_step()
        self.jog_speeds.step_index, self.held_jog.is_rapid_armed = step_index, False

    def select_next_speed(self) -> None:
        """Select the next jog speed, and stop the jog (F3)."""
        self._another_speed()
        self.jog_speeds.select_next_speed()

    def select_speed(self, speed_index: int) -> None:
        """Stop the jog, and select the jog speed with this index."""
        self._another_speed()
        self.jog_speeds.speed_index, self.held_jog.is_rapid_armed = speed_index, False

    def toggle_rapid(self) -> None:
        """Turn rapid speed on or off for the next jog by touch.

        A jog by key or button turns rapid speed off.
        """
        self._another_speed()
        self.held_jog.is_rapid_armed = not self.held_jog.is_rapid_armed

    def handle_direction_press(self, key_source: str, axis: str, direction_sign: int) -> None:
        """Handle a touch or mouse press on a jog direction."""
        self.held_jog.handle_direction_press(
            key_source, axis, direction_sign, is_rapid=self.held_jog.is_rapid_armed
        )

    def _another_step(self) -> None:
        self.held_jog.release_all_keys(tr("JOG STOPPED: STEP CHANGED"))

    def _another_speed(self) -> None:
        self.held_jog.release_all_keys(tr("JOG STOPPED: SPEED CHANGED"))

    # --- keys ----------------------------------------------------------------------------------------

    def ask_tool_value(self, quantity: str) -> None:
        """Ask for a value of the selected tool and stop the jog."""
        self.held_jog.stop_for_other_key()
        self.manual_functions.cancel_selection()
        self.skim_cut.cancel()
        self.tool_setting.open_question(quantity)

    @property
    def is_mill(self) -> bool:
        """Return whether the machine is a mill.

        A mill has separate pages for tools and presets.
        """
        return self.machine.kind == "mill"

    def toggle_tilted_jog(self) -> None:
        """Turn jogging in the tilted coordinate system (3D-ROT) on or off.

        The handwheel is always turned off.
        """
        self.handwheel.turn_off("")
        self.tilted_jog.toggle_tilted_frame(find_jog_refusal(self.desk.read_snapshot().state))

    def _end_hold(self, why: str) -> None:
        self.held_jog.release_all_keys(why)

    def select_manual_function(self, name: str) -> None:
        """Stop the jog, and select the manual function with this name."""
        self.held_jog.stop_for_other_key()
        self.manual_functions.select_function(name)

    def ask_for_spindle_speed(self) -> None:
        """Ask for the spindle speed and stop the jog."""
        self.held_jog.stop_for_other_key()
        self.manual_functions.ask_spindle_speed()

    def toggle_manual_functions(self) -> None:
        """Show or hide the manual functions and stop the jog."""
        self.held_jog.stop_for_other_key()
        self.manual_functions.toggle_panel()

    def ask_to_toggle_master(self) -> None:
        """Ask whether to make the selected tool the master tool, and stop the jog."""
        self.held_jog.stop_for_other_key()
        self.tool_setting.ask_to_toggle_master()

    def toggle_setter_touch_off(self) -> None:
        """Arm or cancel a touch-off at the tool setter, stop the jog, and turn the handwheel off."""
        self.held_jog.stop_for_other_key()
        self.handwheel.turn_off("")
        self.homing_question.cancel()
        self.tool_setter_touch_off.toggle_touch_off()

    @property
    def is_handwheel_shown(self) -> bool:
        """Return whether the on-screen handwheel is shown and an axis is selected for it.

        The handwheel is on the screen only if the operator station is simulated.
        """
        return self.handwheel.wheel_choice is not None and self.desk.station_controls.station is not None

    def turn_handwheel(self, clicks: int) -> None:
        """Turn the handwheel on the screen by a number of clicks."""
        station = self.desk.station_controls.station
        if (
            self.is_handwheel_shown
            and station is not None
            and not self.desk.window_state.late_presses.refuse_late_press(BlockedLateAction.HANDWHEEL)
        ):
            station.turn_handwheel(clicks * self.handwheel.counts_per_click)

    def handle_home_key(self) -> None:
        """Stop all manual motion, and ask which axes to home."""
        self.held_jog.release_all_keys()
        self.handwheel.turn_off("")
        self.homing_question.handle_home_key(self.desk.read_snapshot(), self._no_homing())

    def handle_home_touch(self, axis: str) -> None:
        """Stop all manual motion, and handle a touch on the homing key of one axis.

        The first touch asks for confirmation, and the second touch homes the axis.
        """
        self.held_jog.release_all_keys()
        self.handwheel.turn_off("")
        self.homing_question.handle_axis_touch(axis, self.desk.read_snapshot(), self._no_homing())

    def _no_homing(self) -> str:
        if self.is_entry_open:
            return tr("FINISH THE ENTRY FIRST: PRESS ENTER OR ESC")
        state = self.desk.read_snapshot().state
        return tr("AXES ARE STILL MOVING") if state is MachineState.JOG else find_jog_refusal(state)

    def on_open(self) -> None:
        """Prepare the model when the Jog page opens.

        From then on, earlier offset changes are ignored, and Cycle Start runs the lines of manual
        functions.
        """
        self.tool_setting.offset_history.on_open()
        self.manual_functions.on_open()

    def handle_key(self, key: str) -> bool:
        """Handle a key, and return False if the window must handle the key."""
        if self.is_entry_open:
            return (
                self.manual_functions.handle_key(key)
                if self.manual_functions.is_asking_speed
                else self.tool_setting.handle_key(key)
            )
        if self.homing_question.handle_axis_key(key, self.desk.read_snapshot()):
            return True
        if (not self.is_mill and self.skim_cut.handle_key(key)) or self.manual_functions.handle_key(key):
            return True
        if key in {"v", "V"}:
            self.handwheel.select_next_axis()
        elif self.is_mill:
            return False
        elif key in {"p", "P"}:
            self.toggle_setter_touch_off()
        elif key in {"m", "M"}:
            self.tool_setting.ask_to_toggle_master()
        elif key.lower() in QUESTION_LETTERS:
            self.ask_tool_value(QUESTION_LETTERS[key.lower()])
        else:
            return False
        return True

    def accepts_key(self, key: str) -> bool:
        """Return whether a character has a function on the Jog page."""
        own = {"v", "b"} if self.is_mill else {*QUESTION_LETTERS, "m", "v", "p", "b", "c"}
        if self.is_entry_open:
            return self.manual_functions.accepts_key(key) or self.tool_setting.accepts_key(key)
        return key.lower() in own

    def handle_escape(self) -> bool:
        """Stop the jog, or cancel a question or an entry. Return False if Esc currently has no function."""
        if self.held_jog.active_jog is not None:
            self.held_jog.release_all_keys()
            return True
        if self.tool_setter_touch_off.is_armed:
            self.tool_setter_touch_off.cancel()
            return True
        if self.handwheel.wheel_choice is not None:
            self.handwheel.turn_off(tr("HANDWHEEL IS OFF"))
            return True
        if self.homing_question.cancel() or self.manual_functions.handle_cancel_key():
            return True
        if self.tool_setting.is_touch_off_confirmation_open:
            return False  # Esc means N, and an axis of a new tool that is already known remains.
        return (
            self.skim_cut.handle_escape()
            or self.tool_setting.handle_escape()
            or self.manual_functions.hide_functions()
        )

    @property
    def is_active(self) -> bool:
        """Return whether a key is held down or the handwheel is selected."""
        return self.held_jog.active_jog is not None or self.handwheel.wheel_choice is not None

    def release_all_keys(self) -> None:
        """Stop the jog and turn the handwheel off, because the page will not receive key releases."""
        self.held_jog.release_all_keys(tr("JOG STOPPED: THIS PAGE NO LONGER HAS KEYBOARD FOCUS"))
        self.handwheel.turn_off(tr("HANDWHEEL IS OFF: THIS PAGE NO LONGER HAS KEYBOARD FOCUS"))
        self.held_jog.is_rapid_armed = False
        self._stop_step()

    def _stop_step(self) -> None:
        if self.desk.read_snapshot().state is MachineState.JOG:
            self.desk.post(StopJog())

    def try_leave(self) -> bool:
        """Return whether the page can close.

        Jog keys that are held down are treated as released in any case. If the page can close, all manual
        motion ends, and open questions and entries are canceled.
        """
        self.held_jog.release_all_keys()
        if not self.manual_functions.try_leave():
            return False
        self.handwheel.turn_off("")
        self._stop_step()
        self.homing_question.cancel()
        self.held_jog.is_rapid_armed = False
        self.tilted_jog.turn_off()
        self.tool_setter_touch_off.cancel()
        self.skim_cut.cancel()
        self.tool_setting.cancel_new_tool()
        self.desk.clear_prompt_line()
        return True


def find_jog_refusal(state: MachineState) -> str:
    """Return the reason why the machine state prevents manual motion, or else an empty string."""
    words = {
        MachineState.DISABLED: tr("DRIVES ARE OFF. PRESS D TO TURN THEM ON"),
        MachineState.ESTOP: tr("E-STOP IS PRESSED. NO AXIS CAN MOVE"),
        MachineState.FAULT: tr("ALARM ACTIVE. CORRECT ITS CAUSE, THEN PRESS R"),
        MachineState.HOMING: tr("HOMING. PRESS H TO STOP"),
    }
    if state in ACTIVE_STATES:
        return tr("PROGRAM RUNNING. TO JOG, LET IT END OR PRESS PAUSE, THEN R")
    if state in prompt_line.INTERRUPTED_STATES:
        return tr("PROGRAM NOT FINISHED. TO JOG, LET IT END OR CANCEL IT (R)")
    return words.get(state, "")


def make_jog_prompt(state: MachineState, unhomed_axes: list[str], wheel_axis: str, step_index: int) -> str:
    """Return the prompt for manual motion.

    ``unhomed_axes`` are the axes that are not homed. ``wheel_axis`` is the axis of the handwheel, or an
    empty string if the handwheel is off. ``step_index`` is the index of the selected jog step.
    """
    why = find_jog_refusal(state)
    if why:
        return why
    if unhomed_axes:
        return tr(
            Message(
                "{axes} NOT HOMED: SOFT LIMITS ARE OFF. JOG SLOWLY. PRESS HOME",
                axes=tr(" AND ").join(sorted(unhomed_axes)),
            )
        )
    if wheel_axis:
        return tr(Message("HANDWHEEL MOVES {axis}, ONE STEP PER CLICK. V: NEXT AXIS", axis=wheel_axis))
    if step_index != CONTINUOUS_STEP_INDEX:
        return tr("EACH ARROW PRESS JOGS ONE STEP. F2: STEP SIZE")
    return ""
