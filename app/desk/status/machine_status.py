"""Texts and values of one snapshot for the operator, and detection of a silent control.

The module also describes the event for which a waiting program (WAITING) waits. It contains no Qt and no
machine logic.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from app.desk.screen_settings import DisplayUnits
from app.desk.status import formats
from app.desk.status.readouts import (
    FeedReadout,
    Lamp,
    PositionReadout,
    ReadoutKind,
    SpindleReadout,
    make_feed_readout,
    make_lamps,
    make_mode_lamps,
    make_position_readout,
    make_spindle_readout,
)
from app.desk.translation import tr
from core.alarms import CATALOG, AlarmReaction
from core.executor.snapshot import Alarm, MachineState, Snapshot
from core.interpreter.shared.modal_state import ModalState
from core.message import Message, join_messages
from core.tool_edges import format_edge_name, get_tool_number

_WAIT_PROMPTS = {
    "AT SPEED": "SPINDLE COMING TO SPEED: PROGRAM CONTINUES AUTOMATICALLY",
    "DWELL": "PROGRAM DWELL (G04): CONTINUES AUTOMATICALLY",
    "COLLET": "COLLET MOVING: PROGRAM CONTINUES AUTOMATICALLY",
    "SPINDLE STOP": "SPINDLE STOPPING: PROGRAM CONTINUES AUTOMATICALLY",
    "SPINDLE STOPPED": ("TURN SPINDLE SWITCH OFF, THEN TO AUTO (A). PRESS CYCLE START"),
    "SPINDLE SWITCH OFF": "SPINDLE SWITCH IS OFF. A: SWITCH TO AUTO",
    "SPINDLE OVERRIDE AT 0": "SPINDLE OVERRIDE IS AT 0. TO RAISE IT, PRESS THE DOT KEY (.)",
    "FEED OVERRIDE AT 0": "FEED OVERRIDE IS AT 0: TURN IT UP (+)",
    "FEED HOLD BEHIND THE TAP": "THE TAP BACKS OUT OF THE HOLE FIRST. E-STOP: STOP AT ONCE",
    "GUARD OPEN": "THE GUARD IS OPEN: CLOSE IT",
}
CANCEL_HINT = "PAUSE (FEED HOLD), THEN R: CANCEL THE PROGRAM"


def describe_wait(snapshot: Snapshot) -> str:
    """Return the title for a waiting program, which names the cause of the wait.

    For an input, the title also contains the expected state.
    """
    name = snapshot.waiting_for
    if not name or name in _WAIT_PROMPTS:
        return name
    if _is_input(snapshot):
        state = tr("OFF") if name in snapshot.inputs else tr("ON")
        return tr(Message("INPUT {name} TO TURN {state}", name=name, state=state))
    return name


def make_wait_prompt(snapshot: Snapshot, is_simulated: bool = False) -> str:
    """Return the prompt for a waiting program, or an empty string if the cause of the wait is unknown.

    ``is_simulated`` is True if the inputs can be switched on the screen.
    """
    name = snapshot.waiting_for
    if not name:
        return ""
    if name in _WAIT_PROMPTS:
        return join_messages("  ·  ", (tr(_WAIT_PROMPTS[name]), tr(CANCEL_HINT)))
    if not _is_input(snapshot):
        return ""
    words = tr(Message("PROGRAM WAITING FOR {what}", what=describe_wait(snapshot)))
    if is_simulated:
        words += "  ·  " + tr("F10, 3, ENTER, F4: SWITCH SIMULATED INPUTS")
    return join_messages("  ·  ", (words, tr(CANCEL_HINT)))


def _is_input(snapshot: Snapshot) -> bool:
    """Return whether the program waits for an input.

    A wait of M91 to M95 has the name of its input, which contains no space. The names of all other waits
    contain a space.
    """
    return " " not in snapshot.waiting_for


class StatusTone(StrEnum):
    """Appearance of a machine state.

    Each tone has its own color and shape, so that operators do not depend on color alone.
    """

    OFF = "off"
    READY = "ready"
    RUN = "run"
    PAUSE = "pause"
    WAIT = "wait"
    ALARM = "alarm"


NOT_HOMED_TITLE = "NOT HOMED"
STATE_TONES = {
    MachineState.ESTOP: StatusTone.ALARM,
    MachineState.DISABLED: StatusTone.OFF,
    MachineState.IDLE: StatusTone.READY,
    MachineState.RUN: StatusTone.RUN,
    MachineState.STOPPING: StatusTone.PAUSE,
    MachineState.HOLD: StatusTone.PAUSE,
    MachineState.SINGLE_BLOCK_STOP: StatusTone.PAUSE,
    MachineState.PROGRAM_STOP: StatusTone.PAUSE,
    MachineState.WAIT: StatusTone.WAIT,
    MachineState.JOG: StatusTone.RUN,
    MachineState.HOMING: StatusTone.RUN,
    MachineState.FAULT: StatusTone.ALARM,
}


@dataclass(frozen=True, slots=True)
class MachineStatus:
    """All values from the machine that a page displays, formatted as text."""

    program_name: str
    state_text: str
    state_tone: StatusTone
    position: PositionReadout
    tool_text: str
    secondary_offset_text: str
    feed: FeedReadout
    spindle: SpindleReadout
    mode_lamps: tuple[Lamp, ...]
    lamps: tuple[Lamp, ...]
    cycle_time_text: str
    last_cycle_time_text: str
    line_number: int
    block_text: str
    next_block_text: str
    comment: str
    message: str
    alarms: tuple[Alarm, ...]  # Active alarms, oldest first, because later ones may follow from the first.
    stop_cause: Alarm | None  # Cause of a stop without an alarm, unless the operator requested the stop.


def _find_tool_text(modal: ModalState) -> str:
    """Return the name of the active tool, or the active preset on a mill with presets."""
    preset = modal.settable and modal.edge is None
    return f"G{modal.settable}" if preset else format_edge_name(get_tool_number(modal.tool))


def _find_secondary_offset(modal: ModalState) -> str:
    """Return the offset text that is displayed after the tool number.

    The text is the secondary offset, or the cutting edge and the zero offset.
    """
    if modal.edge is not None:
        return f"D{modal.edge} G{modal.settable}" if modal.settable else f"D{modal.edge}"
    return "" if modal.settable else f"D{modal.secondary}"


def make_machine_status(
    snapshot: Snapshot,
    readout: ReadoutKind,
    has_c_axis: bool,
    units: DisplayUnits = DisplayUnits.PROGRAM,
    program_language: str = "omniturn",
    third_axis: str = "C",
    is_table_rotary: bool = True,
) -> MachineStatus:
    """Return the texts and values of a snapshot for the operator.

    - ``has_c_axis`` is True if the machine has a C axis, and ``third_axis`` is the name of that axis.
    - ``program_language`` is the machine's program language.
    - ``is_table_rotary`` is True if a rotary table of a mill turns, and not only the head.

    All values are in one unit system, which depends on ``units`` and the snapshot.
    """
    modal = snapshot.modal
    metric = units.metric(modal.metric)
    stop = find_unrequested_stop(snapshot)
    state = _find_state_text(snapshot, stop)
    return MachineStatus(
        program_name=snapshot.program,
        state_text=state,
        state_tone=StatusTone.OFF if state == NOT_HOMED_TITLE else STATE_TONES[snapshot.state],
        position=make_position_readout(snapshot, readout, has_c_axis, metric, third_axis),
        tool_text=_find_tool_text(modal),
        secondary_offset_text="" if "Y" in snapshot.axes else _find_secondary_offset(modal),
        feed=make_feed_readout(snapshot, metric),
        spindle=make_spindle_readout(snapshot, metric, program_language),
        mode_lamps=make_mode_lamps(snapshot),
        lamps=make_lamps(snapshot, is_table_rotary=is_table_rotary),
        cycle_time_text=formats.format_duration(snapshot.cycle_elapsed),
        last_cycle_time_text=formats.format_duration(snapshot.last_cycle)
        if snapshot.last_cycle
        else formats.NO_VALUE,
        line_number=snapshot.line,
        block_text=snapshot.block_text,
        next_block_text=snapshot.next_block_text,
        comment=snapshot.comment,
        message=_message(snapshot),
        alarms=snapshot.alarms,
        stop_cause=stop,
    )


def find_unrequested_stop(snapshot: Snapshot) -> Alarm | None:
    """Return the cause of an E-stop or an unrequested feed hold, or None if there is neither."""
    stop = snapshot.stop
    if stop is None or (stop.code != "estop" and CATALOG[stop.code].reaction is not AlarmReaction.HOLD):
        return None
    return stop


def _find_state_text(snapshot: Snapshot, stop: Alarm | None) -> str:
    """Return the machine state as text, with the number of an alarm or a feed hold."""
    if snapshot.state is MachineState.WAIT and snapshot.waiting_for:
        return tr(Message("WAITING: {what}", what=describe_wait(snapshot)))
    if snapshot.state is MachineState.RUN and snapshot.waiting_for:
        return describe_wait(snapshot)
    if snapshot.state is MachineState.FAULT and snapshot.alarms:
        return Message(
            "ALARM {number}: {alarms}", number=snapshot.alarms[0].number, alarms=snapshot.alarms[0].text
        )
    if snapshot.state is MachineState.HOLD and stop is not None:
        return Message("FEED HOLD {number}: {stop}", number=stop.number, stop=stop.text)
    if snapshot.state is MachineState.IDLE and needs_homing(snapshot):
        return NOT_HOMED_TITLE
    return snapshot.state.value


def needs_homing(snapshot: Snapshot) -> bool:
    """Return whether a cycle cannot start because an axis is not homed."""
    return not all(snapshot.homed)


def _message(snapshot: Snapshot) -> str:
    if snapshot.state is not MachineState.PROGRAM_STOP:
        return ""
    return snapshot.message or "PROGRAM STOP"


# --- whether the control is silent --------------------------------------------------------------------


SILENCE_TIMEOUT_S = 1.0  # Seconds without a new snapshot. The executor makes a snapshot every 10 ms.


@dataclass(slots=True)
class ControlSilenceDetector:
    """Detector of a control that no longer responds.

    It compares the time stamps of snapshots with the screen's clock.
    """

    is_silent: bool = False
    _stamp: float | None = None
    _since: float = 0.0

    def check_silence(self, time_stamp: float, time_s: float) -> bool:
        """Return whether ``time_stamp`` has not changed for more than 1 s.

        ``time_s`` is the time of the screen's clock in seconds.
        """
        if time_stamp != self._stamp:
            self._stamp, self._since = time_stamp, time_s
        self.is_silent = time_s - self._since > SILENCE_TIMEOUT_S
        return self.is_silent
