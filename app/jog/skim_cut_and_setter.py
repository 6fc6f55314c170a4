"""Touch-off of a tool by a skim cut or at the tool setter.

A skim cut has these steps: cut, retract, stop the spindle, measure, and enter the size. The measured axis
is X for a diameter and Z for a face. It must not move between the cut and the entry, so the tool retracts
along the other axis. The offset is calculated from the position of the measured axis during the cut. If
this axis moves after the cut, the stored position is discarded, because it may no longer belong to this
cut.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum, auto

from app.desk.desk import Desk
from app.desk.status.formats import format_length
from app.desk.status.readouts import TURNING_RPM
from app.desk.translation import tr
from app.jog.held_jog import ActiveJog, HeldJog, JogDirection
from app.jog.tool_setting import ToolSetting
from app.jog.tool_touch_off import MOVE_TOLERANCE_MM, TOUCH_FIELDS, TOUCH_X, TOUCH_Z
from app.offsets.offset_changes import find_change_refusal
from app.offsets.offset_values import format_signed_length
from core.executor.commands import Command, TouchOffTool
from core.executor.snapshot import CYCLE_STATES, MachineState, Snapshot, TouchPhase, TouchResult
from core.machine.machine_model import Machine
from core.machine.setter_table import ToolSetterModel
from core.message import Message
from core.ports import PROBE_INPUT
from core.store.store_rows import ToolOffsetRow

# Minimum cut in mm along the other axis with the spindle turning. A shorter cut cannot be measured.
MIN_CUT_MM = 0.25


class SkimCutStep(Enum):
    """Step of a touch-off by skim cut."""

    OFF = auto()
    CHOOSE_AXIS = auto()  # Choose a diameter or a face.
    CUTTING = auto()
    RETRACT = auto()  # Retract along the other axis and stop the spindle.
    MEASURING = auto()  # The size is being entered.


@dataclass(slots=True)
class SkimCut:
    """Touch-off of a tool by a skim cut.

    Offsets change only when the size is entered. Esc cancels the skim cut.
    """

    desk: Desk
    tool_setting: ToolSetting
    cut_step: SkimCutStep = SkimCutStep.OFF
    measured_quantity: str = ""  # =
    cut_position_mm: float = 0.0  # Machine position of the axis during the cut in mm, by its encoder.
    # Commanded position during the cut in mm. The cutting force deflects the axis, which then springs back.
    commanded_position_mm: float = 0.0
    cut_length_mm: float = (
        0.0  # Distance in mm along the other axis with the spindle turning, since this axis moved.
    )
    failure_reason: str = ""  # Why the last cut is no longer valid.
    # Positions of both axes at the beginning of this distance.
    _stands: tuple[float, float] | None = field(default=None)

    @property
    def is_in_progress(self) -> bool:
        """Return whether a skim cut is in progress."""
        return self.cut_step is not SkimCutStep.OFF

    @property
    def measured_axis(self) -> str:
        """Return the axis that the skim cut measures, which must not move after the cut."""
        return TOUCH_FIELDS[self.measured_quantity].upper() if self.measured_quantity else ""

    @property
    def travel_axis(self) -> str:
        """Return the axis along which the tool cuts and retracts."""
        return "Z" if self.measured_axis == "X" else "X"

    # --- keys ----------------------------------------------------------------------------------------

    def begin_skim_cut(self) -> None:
        """Ask whether to cut a diameter or a face. If no tool can be set now, show the reason instead."""
        if self.is_in_progress:
            return
        why = self.tool_setting.find_refusal(TOUCH_X, self.desk.read_snapshot())
        if why:
            self.desk.say(why)
            return
        self.desk.clear_prompt_line()
        self.cut_step = SkimCutStep.CHOOSE_AXIS

    def select_cut_type(self, quantity: str) -> None:
        """Select the type of skim cut: a diameter or a face."""
        why = self.tool_setting.find_refusal(quantity, self.desk.read_snapshot())
        if why:
            self.desk.say(why)
            return
        self.desk.clear_prompt_line()
        self.measured_quantity, self.cut_step = quantity, SkimCutStep.CUTTING
        self._anew(self.desk.read_snapshot())

    def finish_cut(self) -> None:
        """End the cutting step, and store the position of the measured axis."""
        snapshot = self.desk.read_snapshot()
        why = self._find_cut_refusal(snapshot)
        if why:
            self.desk.say(why)
            return
        self.desk.clear_prompt_line()
        self.cut_position_mm = snapshot.tip["XZ".index(self.measured_axis)]
        self.commanded_position_mm, self.cut_step, self.failure_reason = (
            self._place(snapshot),
            SkimCutStep.RETRACT,
            "",
        )

    def _find_cut_refusal(self, snapshot: Snapshot) -> str:
        """Return the reason why the cutting step cannot end yet, or an empty string if it can end."""
        if snapshot.state is not MachineState.IDLE:
            return tr("AXES ARE STILL MOVING. WAIT UNTIL THEY STOP")
        if self.cut_length_mm >= MIN_CUT_MM:
            return ""
        if abs(snapshot.rpm_actual) <= TURNING_RPM:
            return tr("NO CUT YET, SPINDLE STOPPED. PRESS B TO START IT")
        return tr(
            Message(
                "NO CUT YET: {axis} MOVED LAST. FEED {other} WITHOUT MOVING {axis}",
                axis=self.measured_axis,
                other=self.travel_axis,
            )
        )

    def handle_key(self, key: str) -> bool:
        """Handle a key, and return False if the Jog page must handle the key."""
        if self.cut_step is SkimCutStep.CHOOSE_AXIS and key.lower() in {"x", "z"}:
            self.select_cut_type(TOUCH_X if key.lower() == "x" else TOUCH_Z)
        elif self.cut_step is SkimCutStep.CUTTING and key == "Enter":
            self.finish_cut()
        elif not self.is_in_progress and key in {"c", "C"}:
            self.begin_skim_cut()
        else:
            return False
        return True

    def handle_escape(self) -> bool:
        """Cancel the skim cut when Esc is pressed, and return whether a skim cut was in progress."""
        was = self.is_in_progress
        if was:
            self.cancel()
            self.desk.say(tr("SKIM CUT CANCELED, NOTHING CHANGED"))
        return was

    def cancel(self) -> None:
        """End the skim cut without changing offsets."""
        if self.cut_step is SkimCutStep.MEASURING:
            self.tool_setting.close_question()
        self.cut_step, self.measured_quantity, self.failure_reason = SkimCutStep.OFF, "", ""
        self.cut_length_mm, self._stands = 0.0, None

    # --- every frame ---------------------------------------------------------------------------------

    def update(self, snapshot: Snapshot) -> None:
        """Monitor the axes and the spindle, and advance the skim cut.

        This method is called once per frame.
        """
        if not self.is_in_progress or self.cut_step is SkimCutStep.CHOOSE_AXIS:
            return
        why = self._find_failure(snapshot)
        if why:
            self.cancel()
            self.desk.say(why)
        elif self.cut_step is SkimCutStep.CUTTING:
            self._follow_cut(snapshot)
        elif abs(self._place(snapshot) - self.commanded_position_mm) > MOVE_TOLERANCE_MM:
            self._handle_moved(snapshot)
        elif self.cut_step is SkimCutStep.RETRACT:
            self._measure_cut(snapshot)
        elif not self.tool_setting.question_name:  # The value was saved or canceled.
            self.cancel()
        elif self._turns(snapshot):
            self.tool_setting.close_question()
            self.cut_step = SkimCutStep.RETRACT

    def _find_failure(self, snapshot: Snapshot) -> str:
        """Return the reason why the skim cut cannot continue, or an empty string if it can continue."""
        if snapshot.state in {
            MachineState.ESTOP,
            MachineState.FAULT,
            MachineState.DISABLED,
            MachineState.HOMING,
        }:
            return tr("MACHINE STOPPED. SKIM CUT CANCELED. NOTHING CHANGED")
        if not snapshot.homed[snapshot.axes.index(self.measured_axis)]:
            return tr(
                Message("{axis} IS NOT HOMED. SKIM CUT CANCELED, NOTHING CHANGED", axis=self.measured_axis)
            )
        return ""

    def _follow_cut(self, snapshot: Snapshot) -> None:
        """Update the length of the cut, which is the travel along the other axis while the spindle turns.

        The travel is measured from the position at which the measured axis last moved.
        """
        if self._stands is None or abs(self._place(snapshot) - self._stands[0]) > MOVE_TOLERANCE_MM:
            self._anew(snapshot)
        elif self._turns(snapshot):
            self.cut_length_mm = max(self.cut_length_mm, abs(self._beside(snapshot) - self._stands[1]))
        elif not self.cut_length_mm:
            self._stands = (self._stands[0], self._beside(snapshot))

    def _anew(self, snapshot: Snapshot) -> None:
        self.cut_length_mm, self._stands = 0.0, (self._place(snapshot), self._beside(snapshot))

    def _handle_moved(self, snapshot: Snapshot) -> None:
        """Discard the stored position, because the measured axis has moved after the cut."""
        mode = self.tool_setting.offset_history.unit_mode
        away = self._place(snapshot) - self.commanded_position_mm
        shown = format_length(
            2 * away if self.measured_axis == "X" and mode.is_diameter else away, mode.is_metric
        )
        if self.cut_step is SkimCutStep.MEASURING:
            self.tool_setting.close_question()
        self.cut_step = SkimCutStep.CUTTING
        self._anew(snapshot)
        words = tr("{axis} MOVED {away} AFTER THE CUT. NOT SAVED. CUT AGAIN OR PRESS ESC")
        self.failure_reason = tr(Message(words, axis=self.measured_axis, away=shown))

    def _measure_cut(self, snapshot: Snapshot) -> None:
        """Ask for the measured size as soon as the spindle and the axes are stopped."""
        if snapshot.state is MachineState.IDLE and not self._turns(snapshot):
            self.cut_step = SkimCutStep.MEASURING
            self.tool_setting.ask_cut_size(self.measured_quantity, self.cut_position_mm)

    @staticmethod
    def _turns(snapshot: Snapshot) -> bool:
        return abs(snapshot.rpm_actual) > TURNING_RPM or snapshot.rpm_command != 0.0

    def _place(self, snapshot: Snapshot) -> float:
        return snapshot.demand[snapshot.axes.index(self.measured_axis)]

    def _beside(self, snapshot: Snapshot) -> float:
        return snapshot.demand[snapshot.axes.index(self.travel_axis)]

    # --- display -------------------------------------------------------------------------------------

    def make_step_prompt(self, snapshot: Snapshot) -> str:
        """Return the prompt that explains the current step, or an empty string if no prompt applies."""
        if self.cut_step is SkimCutStep.CHOOSE_AXIS:
            return tr("SKIM CUT. X: DIAMETER   Z: FACE   ESC: CANCEL")
        if self.cut_step is SkimCutStep.RETRACT:
            words = tr("RETRACT {other} ONLY. DO NOT MOVE {axis}. THEN 0: STOP SPINDLE")
            return tr(Message(words, axis=self.measured_axis, other=self.travel_axis))
        return self._words_of_cut(snapshot) if self.cut_step is SkimCutStep.CUTTING else ""

    def _words_of_cut(self, snapshot: Snapshot) -> str:
        if self.failure_reason and self.cut_length_mm < MIN_CUT_MM:
            return self.failure_reason
        if self.cut_length_mm >= MIN_CUT_MM and snapshot.state not in CYCLE_STATES:
            words = tr("CUT FAR ENOUGH IN {other} TO MEASURE, THEN PRESS ENTER")
            return tr(Message(words, other=self.travel_axis))
        if not self._turns(snapshot):
            return tr("START THE SPINDLE (B), THEN JOG INTO THE CUT. ESC: CANCEL")
        words = tr("JOG {axis} TO THE DEPTH OF CUT, THEN FEED IN {other}. ESC: CANCEL")
        return tr(Message(words, axis=self.measured_axis, other=self.travel_axis))


TouchDirection = tuple[str, int]  # Axis and sign.
ALL_DIRECTIONS: tuple[TouchDirection, ...] = (("X", -1), ("X", 1), ("Z", -1), ("Z", 1))
CENTER_TIP = 9  # The offset refers to the nose center.
_DIRECTIONS_BY_TIP: dict[int, tuple[TouchDirection, ...]] = {
    1: (("X", 1), ("Z", 1)),
    2: (("X", 1), ("Z", -1)),
    3: (("X", -1), ("Z", -1)),
    4: (("X", -1), ("Z", 1)),
    5: (("Z", 1),),
    6: (("X", 1),),
    7: (("Z", -1),),
    8: (("X", -1),),
    CENTER_TIP: ALL_DIRECTIONS,
}


def find_touch_off_directions(row: ToolOffsetRow | None) -> tuple[TouchDirection, ...]:
    """Return the directions in which a tool can be touched off.

    A tool that was never set can be touched off in all directions. A tool without a tip quadrant cannot be
    touched off.
    """
    return ALL_DIRECTIONS if row is None else _DIRECTIONS_BY_TIP.get(row.quadrant, ())


def find_zero_position(
    touch_position_mm: float,
    direction: TouchDirection,
    tool_setter: ToolSetterModel,
    tool_row: ToolOffsetRow | None,
) -> float:
    """Return the machine position in mm at which the tool tip would be at part zero.

    ``touch_position_mm`` is the machine position in mm at which the tip touched the tool setter.
    """
    axis, sign = direction
    before = sign * tool_row.nose_radius if tool_row is not None and tool_row.quadrant == CENTER_TIP else 0.0
    return touch_position_mm - (tool_setter.compute_touch_position(axis, sign) - before)


def format_direction(direction: TouchDirection) -> str:
    """Return a touch direction as text, for example X−."""
    return f"{direction[0]}{'+' if direction[1] > 0 else '−'}"


@dataclass(slots=True)
class ToolSetterTouchOff:
    """Touch-off of a tool at the tool setter.

    ``is_armed`` means that the next direction key starts a touch-off. ``directions`` contains the jog
    directions of the direction keys.
    """

    desk: Desk
    machine: Machine
    tool_setting: ToolSetting
    motion_lease_s: float
    directions: tuple[JogDirection, ...]
    is_armed: bool = False
    _presses: int = 0
    _seen: int | None = None  # Number of the last touch-off that was processed.

    @property
    def tool_setter(self) -> ToolSetterModel | None:
        """Return the tool setter of the machine, or None if no tool setter is connected to an input."""
        return (
            self.machine.hardware.find_driver_table(ToolSetterModel)
            if PROBE_INPUT in self.machine.inputs
            else None
        )

    def toggle_touch_off(self) -> None:
        """Arm the touch-off of the selected tool, or cancel the armed touch-off (P)."""
        if self.is_armed:
            self.cancel()
        elif why := self._barred():
            self.desk.say(why)
        else:
            self.is_armed = True
            self.desk.clear_prompt_line()

    def cancel(self) -> None:
        """Cancel the armed touch-off."""
        self.is_armed = False

    def _barred(self) -> str:
        tool, snapshot = self.tool_setting, self.desk.read_snapshot()
        if self.tool_setter is None:
            return tr("THIS MACHINE HAS NO TOOL SETTER")
        if why := tool.offset_book.lock_reason or find_change_refusal(snapshot, is_correction=False):
            return why
        if not tool.tool_number:
            return tr("NO TOOL SELECTED. PRESS T AND TYPE ITS NUMBER")
        if not find_touch_off_directions(tool.tool_row):
            return tr(
                Message("T{number}: TIP DIRECTION NOT SET. PRESS Q AND TYPE 1…9", number=tool.tool_number)
            )
        return ""

    def make_command(self, axis: str, direction_sign: int, button_name: str) -> Command | str:
        """Return the touch-off command for a direction.

        If the touch-off is not possible, return the reason as text.
        """
        ways = find_touch_off_directions(self.tool_setting.tool_row)
        if (axis, direction_sign) not in ways:
            text = tr("TOUCH OFF T{number} ONLY IN DIRECTION {ways}")
            words = tr(" OR ").join(format_direction(direction) for direction in ways)
            return tr(Message(text, number=self.tool_setting.tool_number, ways=words))
        self._presses += 1
        return TouchOffTool(axis, direction_sign, self.motion_lease_s, self._presses, button_name)

    def update(self, snapshot: Snapshot) -> None:
        """Ask whether to save the result of a touch-off when the axis has stopped.

        This method is called once per frame.
        """
        if self._seen is not None and snapshot.state is MachineState.JOG:
            return
        touched = snapshot.touched
        number = touched.number if touched is not None else 0
        if self._seen is None or touched is None or number == self._seen:
            self._seen = number
            return
        self._seen = number
        if not self.is_armed or self.tool_setter is None:
            return
        if touched.touch_position_mm is None:
            self.desk.say(tr(Message("TOUCH-OFF FAILED: {why}", why=touched.why.upper())))
        else:
            self.is_armed = False
            self._found(touched, touched.touch_position_mm, self.tool_setter)

    def _found(self, touched: TouchResult, place: float, model: ToolSetterModel) -> None:
        touch_direction = (touched.axis, touched.sign)
        value = find_zero_position(place, touch_direction, model, self.tool_setting.tool_row)
        metric = self.tool_setting.offset_history.unit_mode.is_metric
        about = format_signed_length(touched.uncertainty_mm, metric).removeprefix("+")
        cause = tr(
            Message(
                "measured at the tool setter, direction {direction}, ±{error}",
                direction=format_direction(touch_direction),
                error=about,
            )
        )
        self.tool_setting.ask_to_save_measurement(TOUCH_X if touched.axis == "X" else TOUCH_Z, value, cause)

    def prompt_text(self, snapshot: Snapshot) -> str:
        """Return the prompt for the touch-off, or an empty string if no touch-off is armed."""
        if not self.is_armed:
            return ""
        words = {
            TouchPhase.SEARCH: tr("SEARCHING FOR THE TOOL SETTER. RELEASE THE KEY TO STOP"),
            TouchPhase.BACK_OFF: tr("CONTACT MADE. BACKING OFF"),
            TouchPhase.SLOW_TOUCH: tr("MEASURING WITH A SLOW TOUCH"),
            TouchPhase.RETREAT: tr("CONTACT MADE. BACKING OFF"),
            TouchPhase.RETURN: tr("NO CONTACT. RETURNING"),
        }
        if snapshot.touch_phase is not None:
            return words[snapshot.touch_phase]
        ways = find_touch_off_directions(self.tool_setting.tool_row)
        keys = tr(" OR ").join(
            f"{each.label} ({format_direction((each.axis_name, each.direction_sign))})"
            for each in self.directions
            if (each.axis_name, each.direction_sign) in ways
        )
        text = tr("TOOL SETTER, T{number}: HOLD {keys} UNTIL THE AXIS RETRACTS. ESC: CANCEL")
        return tr(Message(text, number=self.tool_setting.tool_number, keys=keys))


@dataclass(slots=True)
class HeldTouchOff(HeldJog):
    """Jog in which a direction key starts a touch-off while ``tool_setter_touch_off`` is armed."""

    tool_setter_touch_off: ToolSetterTouchOff | None = None
    _asked: Command | None = field(default=None)

    def _start_jog(self, source: str, axis: str, sign: int, rapid: bool) -> None:
        self._asked = None
        if self.tool_setter_touch_off is None or not self.tool_setter_touch_off.is_armed:
            HeldJog._start_jog(self, source, axis, sign, rapid)
            return
        asked = self.tool_setter_touch_off.make_command(axis, sign, self.last_button_name)
        if isinstance(asked, str):
            self.show_message(asked)
        elif rapid:
            self.show_message(tr("NO RAPID DURING TOUCH-OFF. PRESS WITHOUT SHIFT"))
        else:
            self._asked = asked
            self._hold(source, axis, float(sign), False, asked)

    def _renewal(self, held: ActiveJog, /) -> Command:
        return self._asked or HeldJog._renewal(self, held)
