"""The texts and values of one snapshot for the operator, and the detection of a silent control.

The module also describes for what a program waits (WAITING), and how the wait ends. It contains no Qt and no
machine logic.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from app.desk.screen_settings import Units
from app.desk.status import formats
from app.desk.status.readouts import (
    FeedFigures,
    Lamp,
    PositionFigures,
    Readout,
    SpindleFigures,
    feed_figures,
    lamps_of,
    modes_of,
    position_figures,
    spindle_figures,
)
from app.desk.translation import tr
from core.alarms import CATALOGUE, Reaction
from core.executor.snapshot import Alarm, Snapshot, State
from core.interpreter.shared.modal_state import Modal
from core.message import Message, join_messages
from core.tool_edges import edge_name, tool_of

_ENDS = {
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
GIVES_UP = "PAUSE (FEED HOLD), THEN R: CANCEL THE PROGRAM"


def waits_for(snapshot: Snapshot) -> str:
    """Return the text of the title for a wait: its cause, and for an input the expected state."""
    name = snapshot.waiting_for
    if not name or name in _ENDS:
        return name
    if _is_input(snapshot):
        state = tr("OFF") if name in snapshot.inputs else tr("ON")
        return tr(Message("INPUT {name} TO TURN {state}", name=name, state=state))
    return name


def how_it_ends(snapshot: Snapshot, simulated: bool = False) -> str:
    """Return the prompt for a wait, or an empty text if the wait is unknown.

    ``simulated`` is True if the inputs can be switched on the screen.
    """
    name = snapshot.waiting_for
    if not name:
        return ""
    if name in _ENDS:
        return join_messages("  ·  ", (tr(_ENDS[name]), tr(GIVES_UP)))
    if not _is_input(snapshot):
        return ""
    words = tr(Message("PROGRAM WAITING FOR {what}", what=waits_for(snapshot)))
    if simulated:
        words += "  ·  " + tr("F10, 3, ENTER, F4: SWITCH SIMULATED INPUTS")
    return join_messages("  ·  ", (words, tr(GIVES_UP)))


def _is_input(snapshot: Snapshot) -> bool:
    """Return whether the program waits for an input.

    A wait of M91 to M95 has the name of the input, which has no space. All other waits have names with a
    space.
    """
    return " " not in snapshot.waiting_for


class Tone(StrEnum):
    """The appearance of a state. A tone has its own color and shape, so that color is not the only sign."""

    OFF = "off"
    READY = "ready"
    RUN = "run"
    PAUSE = "pause"
    WAIT = "wait"
    ALARM = "alarm"


NOT_HOMED = "NOT HOMED"
TONES = {
    State.ESTOP: Tone.ALARM,
    State.DISABLED: Tone.OFF,
    State.IDLE: Tone.READY,
    State.RUN: Tone.RUN,
    State.HOLDING: Tone.PAUSE,
    State.HOLD: Tone.PAUSE,
    State.BLOCK_END: Tone.PAUSE,
    State.PROGRAM_STOP: Tone.PAUSE,
    State.WAIT: Tone.WAIT,
    State.JOG: Tone.RUN,
    State.HOME: Tone.RUN,
    State.FAULT: Tone.ALARM,
}


@dataclass(frozen=True, slots=True)
class MachineStatus:
    """All values on the page that come from the machine, as text."""

    program: str
    state: str
    tone: Tone
    position: PositionFigures
    tool: str
    secondary: str
    feed: FeedFigures
    spindle: SpindleFigures
    modes: tuple[Lamp, ...]
    lamps: tuple[Lamp, ...]
    cycle: str
    last_cycle: str
    line: int
    block_text: str
    next_text: str
    comment: str
    message: str
    alarms: tuple[Alarm, ...]  # Active alarms, oldest first, because later ones may follow from the first.
    stop: Alarm | None  # Cause of a stop without an alarm, unless the operator requested the stop.


def _in_work(modal: Modal) -> str:
    """Return the name of the tool in use, or the preset on a mill with presets."""
    preset = modal.settable and modal.edge is None
    return f"G{modal.settable}" if preset else edge_name(tool_of(modal.tool))


def _second(modal: Modal) -> str:
    """Return the text that follows T: the secondary offset, or the cutting edge and zero offset."""
    if modal.edge is not None:
        return f"D{modal.edge} G{modal.settable}" if modal.settable else f"D{modal.edge}"
    return "" if modal.settable else f"D{modal.secondary}"


def status_of(
    snapshot: Snapshot,
    readout: Readout,
    with_c: bool,
    units: Units = Units.PROGRAM,
    language: str = "omniturn",
    third_axis: str = "C",
    table: bool = True,
) -> MachineStatus:
    """Return the texts and values of a snapshot for the operator.

    ``with_c`` is True if the machine has a C axis. ``language`` is the machine's programming language.
    ``third_axis`` is the name of the C axis. ``table`` is True if a rotary table, and not only the head,
    turns on a mill. All values are in one unit, which follows from ``units`` and the snapshot.
    """
    modal = snapshot.modal
    metric = units.metric(modal.metric)
    stop = unasked(snapshot)
    state = _state(snapshot, stop)
    return MachineStatus(
        program=snapshot.program,
        state=state,
        tone=Tone.OFF if state == NOT_HOMED else TONES[snapshot.state],
        position=position_figures(snapshot, readout, with_c, metric, third_axis),
        tool=_in_work(modal),
        secondary="" if "Y" in snapshot.axes else _second(modal),
        feed=feed_figures(snapshot, metric),
        spindle=spindle_figures(snapshot, metric, language),
        modes=modes_of(snapshot),
        lamps=lamps_of(snapshot, table=table),
        cycle=formats.duration(snapshot.cycle_elapsed),
        last_cycle=formats.duration(snapshot.last_cycle) if snapshot.last_cycle else formats.NOTHING,
        line=snapshot.line,
        block_text=snapshot.block_text,
        next_text=snapshot.next_text,
        comment=snapshot.comment,
        message=_message(snapshot),
        alarms=snapshot.alarms,
        stop=stop,
    )


def unasked(snapshot: Snapshot) -> Alarm | None:
    """Return the cause of an E-stop or of a feed hold that the operator did not request, or None."""
    stop = snapshot.stop
    if stop is None or (stop.code != "estop" and CATALOGUE[stop.code].reaction is not Reaction.HOLD):
        return None
    return stop


def _state(snapshot: Snapshot, stop: Alarm | None) -> str:
    """Return the state as text. An alarm or a feed hold includes its number."""
    if snapshot.state is State.WAIT and snapshot.waiting_for:
        return tr(Message("WAITING: {what}", what=waits_for(snapshot)))
    if snapshot.state is State.RUN and snapshot.waiting_for:
        return waits_for(snapshot)
    if snapshot.state is State.FAULT and snapshot.alarms:
        return Message(
            "ALARM {number}: {alarms}", number=snapshot.alarms[0].number, alarms=snapshot.alarms[0].text
        )
    if snapshot.state is State.HOLD and stop is not None:
        return Message("FEED HOLD {number}: {stop}", number=stop.number, stop=stop.text)
    if snapshot.state is State.IDLE and not_homed(snapshot):
        return NOT_HOMED
    return snapshot.state.value


def not_homed(snapshot: Snapshot) -> bool:
    """Return whether an axis is not homed, so that no cycle can start."""
    return not all(snapshot.homed)


def _message(snapshot: Snapshot) -> str:
    if snapshot.state is not State.PROGRAM_STOP:
        return ""
    return snapshot.message or "PROGRAM STOP"


# --- whether the control is silent --------------------------------------------------------------------


SILENT_AFTER = 1.0  # Seconds without a new snapshot. The executor makes a snapshot every 10 ms.


@dataclass(slots=True)
class SilenceWatch:
    """Detects a silent control by comparing the time stamps of snapshots with the screen's clock."""

    is_silent: bool = False
    _stamp: float | None = None
    _since: float = 0.0

    def silent(self, stamp: float, now: float) -> bool:
        """Return whether the time stamp ``stamp`` has not changed for more than 1 s."""
        if stamp != self._stamp:
            self._stamp, self._since = stamp, now
        self.is_silent = now - self._since > SILENT_AFTER
        return self.is_silent
