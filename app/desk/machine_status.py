"""One snapshot, put into the words and figures that the operator reads; and whether it is still of now.

No Qt and no machine logic.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from app.desk import formats
from app.desk.readouts import (
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
from app.desk.screen_settings import Units
from app.desk.translation import tr
from app.desk.waiting import waits_for
from core.alarms import CATALOGUE, Reaction
from core.executor.snapshot import Alarm, Snapshot, State
from core.interpreter.shared.modal_state import Modal
from core.message import Message
from core.tool_edges import edge_name, tool_of


class Tone(StrEnum):
    """How a state is drawn: colour and shape together, so that colour alone never says it."""

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
    """Everything on the page that comes from the machine."""

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
    alarms: tuple[Alarm, ...]  # that stand, the first one first: what came behind may only follow from it
    stop: Alarm | None  # why it stands where no alarm says it, unless somebody asked for it


def _in_work(modal: Modal) -> str:
    """The tool; of a mill its preset."""
    preset = modal.settable and modal.edge is None
    return f"G{modal.settable}" if preset else edge_name(tool_of(modal.tool))


def _second(modal: Modal) -> str:
    """What stands behind T: the secondary offset, or the cutting edge and the settable offset."""
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
    """What the page shows of ``snapshot``; ``with_c`` when the machine has a C axis, ``language`` is its own.
    ``third_axis`` is what it calls C, ``table``: whether a table turns on a mill, and not its head alone.

    Every figure is in the one unit that ``units`` and this very snapshot come to.
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
    """A hold that nobody pressed, or the E-stop: told with cause and remedy as an alarm is."""
    stop = snapshot.stop
    if stop is None or (stop.code != "estop" and CATALOGUE[stop.code].reaction is not Reaction.HOLD):
        return None
    return stop


def _state(snapshot: Snapshot, stop: Alarm | None) -> str:
    """In words, with the number of what is in the way."""
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
    """Whether an axis does not know where it is: no cycle starts then."""
    return not all(snapshot.homed)


def _message(snapshot: Snapshot) -> str:
    if snapshot.state is not State.PROGRAM_STOP:
        return ""
    return snapshot.message or "PROGRAM STOP"


# --- whether the control is silent --------------------------------------------------------------------


SILENT_AFTER = 1.0  # seconds without another snapshot; the executor makes one every 10 ms


@dataclass(slots=True)
class SilenceWatch:
    """Watches the time stamps of snapshots against the screen's own clock."""

    is_silent: bool = False
    _stamp: float | None = None
    _since: float = 0.0

    def silent(self, stamp: float, now: float) -> bool:
        """Whether no other snapshot than the one with this stamp has come for too long."""
        if stamp != self._stamp:
            self._stamp, self._since = stamp, now
        self.is_silent = now - self._since > SILENT_AFTER
        return self.is_silent
