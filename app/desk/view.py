"""One snapshot, put into the words and figures that the operator reads. No Qt, no machine logic, no state."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from app.desk import formats
from app.desk.lamps import Lamp, lamps_of, modes_of
from app.desk.motion import FeedView, SpindleView, feed_view, spindle_view
from app.desk.readout import PositionView, Readout, position_view
from app.desk.settings import Units
from core.alarms import CATALOGUE, Reaction
from core.executor.snapshot import Alarm, Snapshot, State


class Tone(StrEnum):
    """How a state is drawn: colour and shape together, so that colour alone never says it."""

    OFF = "off"
    READY = "ready"
    RUN = "run"
    PAUSE = "pause"
    WAIT = "wait"
    ALARM = "alarm"


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
class View:
    """Everything on the page that comes from the machine."""

    program: str
    state: str
    tone: Tone
    position: PositionView
    tool: str
    secondary: str
    feed: FeedView
    spindle: SpindleView
    modes: tuple[Lamp, ...]
    lamps: tuple[Lamp, ...]
    parts: str
    cycle: str
    last_cycle: str
    line: int
    block: int
    block_text: str
    next_text: str
    comment: str
    message: str
    alarms: tuple[Alarm, ...]  # that stand, the first one first: what came behind may only follow from it
    stop: Alarm | None  # why it stands where no alarm says it, unless somebody asked for it


def view_of(snapshot: Snapshot, readout: Readout, with_c: bool, units: Units = Units.PROGRAM) -> View:
    """What the page shows of ``snapshot``; ``with_c`` when the machine has a C axis.

    Every figure is in the one unit that ``units`` and this very snapshot come to.
    """
    modal = snapshot.modal
    metric = units.metric(modal.metric)
    stop = unasked(snapshot)
    return View(
        program=snapshot.program,
        state=_state(snapshot, stop),
        tone=TONES[snapshot.state],
        position=position_view(snapshot, readout, with_c, metric),
        tool=f"G{modal.settable}" if modal.settable else f"T{modal.tool}",
        secondary="" if modal.settable else f"D{modal.secondary}",
        feed=feed_view(snapshot, metric),
        spindle=spindle_view(snapshot, metric),
        modes=modes_of(snapshot),
        lamps=lamps_of(snapshot),
        parts=str(snapshot.parts),
        cycle=formats.duration(snapshot.cycle_elapsed),
        last_cycle=formats.duration(snapshot.last_cycle) if snapshot.last_cycle else formats.NOTHING,
        line=snapshot.line,
        block=snapshot.block,
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
        return f"WAITING: {snapshot.waiting_for}"
    if snapshot.state is State.FAULT and snapshot.alarms:
        return f"ALARM {snapshot.alarms[0].number}: {snapshot.alarms[0].text}"
    if snapshot.state is State.HOLD and stop is not None:
        return f"FEED HOLD {stop.number}: {stop.text}"
    return snapshot.state.value


def _message(snapshot: Snapshot) -> str:
    if snapshot.state is not State.PROGRAM_STOP:
        return ""
    return snapshot.message or "PROGRAM STOP"
