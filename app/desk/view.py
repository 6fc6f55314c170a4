"""One snapshot, put into the words and figures that the operator reads. No Qt, no machine logic, no state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from app.desk import formats
from app.desk.lamps import LATHE, TURNING, Lamp, lamps_of, modes_of
from app.desk.settings import Units
from app.desk.swivel import position as of_mill
from core.executor.snapshot import Alarm, Snapshot, State


class Readout(StrEnum):
    """What the large figures show."""

    POSITION = "POSITION"
    TO_GO = "DISTANCE TO GO"
    HOME = "FROM HOME"

    @property
    def following(self) -> Readout:
        """The one that the key goes on to."""
        order = list(Readout)
        return order[(order.index(self) + 1) % len(order)]


class Tone(StrEnum):
    """How a state is drawn: colour and shape together, so that colour alone never says it."""

    OFF = "off"
    READY = "ready"
    RUN = "run"
    PAUSE = "pause"
    WAIT = "wait"
    ALARM = "alarm"


ROTARY = frozenset("ABC")  # axes that are read in degrees

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
class AxisView:
    """One row of the readout; ``mark`` says Ø or R on X, ``beside`` is the second figure."""

    name: str
    mark: str
    value: str
    beside: str
    homed: bool


@dataclass(frozen=True, slots=True)
class PositionView:
    """The readout: all of it in one unit, from one instant."""

    readout: Readout
    beside: Readout
    unit: str
    x_words: str
    axes: tuple[AxisView, ...]


@dataclass(frozen=True, slots=True)
class FeedView:
    """Programmed and actual feed in the unit of the program's mode."""

    value: str
    unit: str
    actual: str
    actual_unit: str
    override: float


@dataclass(frozen=True, slots=True)
class SpindleView:
    """Commanded and actual rpm, surface speed, override and the AUTO/OFF switch."""

    direction: str
    rpm: str
    actual: str
    surface: str
    surface_label: str
    override: float
    auto: bool


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
    alarm: Alarm | None


def view_of(snapshot: Snapshot, readout: Readout, with_c: bool, units: Units = Units.PROGRAM) -> View:
    """What the page shows of ``snapshot``; ``with_c`` when the machine has a C axis.

    Every figure is in the one unit that ``units`` and this very snapshot come to.
    """
    modal = snapshot.modal
    metric = units.metric(modal.metric)
    state = snapshot.state.value
    if snapshot.state is State.WAIT and snapshot.waiting_for:
        state = f"WAITING: {snapshot.waiting_for}"
    return View(
        program=snapshot.program,
        state=state,
        tone=TONES[snapshot.state],
        position=_position(snapshot, readout, with_c, metric),
        tool=f"G{modal.settable}" if modal.settable else f"T{modal.tool}",
        secondary="" if modal.settable else f"D{modal.secondary}",
        feed=_feed(snapshot, metric),
        spindle=_spindle(snapshot, metric),
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
        alarm=snapshot.alarms[-1] if snapshot.alarms else None,
    )


def coordinates(snapshot: Snapshot, readout: Readout) -> tuple[float, ...]:
    """The figures of a readout in the order of ``snapshot.axes``: mm with X a radius, and degrees."""
    actual, swivel = snapshot.actual, snapshot.swivel
    if swivel is not None:
        return _OF_MILL[readout](snapshot, swivel)
    if readout is Readout.HOME:
        return _wrapped(actual, snapshot)
    if readout is Readout.TO_GO:
        end = snapshot.block_end if snapshot.block else actual
        return tuple(there - here for there, here in zip(end, actual, strict=True))
    x, z, *rest = actual
    if snapshot.axes == LATHE:
        rest[0] -= snapshot.modal.offset_c
    return _wrapped((x - snapshot.offset[0], z - snapshot.offset[1], *rest), snapshot)


_OF_MILL = {
    Readout.POSITION: of_mill.plane_figures,
    Readout.TO_GO: of_mill.figures_to_go,
    Readout.HOME: of_mill.home_figures,
}


def _wrapped(at: tuple[float, ...], snapshot: Snapshot) -> tuple[float, ...]:
    """C from 0 to under 360 where the program counts it so; what would be shown as 360 is 0."""
    if not snapshot.modal.wraps_c:
        return at
    return (*at[:-1], round(at[-1], formats.ANGLE_PLACES) % 360.0)


def _position(snapshot: Snapshot, readout: Readout, with_c: bool, metric: bool) -> PositionView:
    diameter = snapshot.modal.diameter
    beside = Readout.POSITION if readout is Readout.TO_GO else Readout.TO_GO
    large, small = (_figures(snapshot, r, metric, diameter) for r in (readout, beside))
    mark = "" if snapshot.axes != LATHE else "Ø" if diameter else "R"
    rows = [
        AxisView(name, mark if name == "X" else "", a, b, homed)
        for name, a, b, homed in zip(snapshot.axes, large, small, snapshot.homed, strict=True)
    ]
    return PositionView(
        readout=readout,
        beside=beside,
        unit=_unit(metric, snapshot.modal.metric),
        x_words=_words(snapshot, readout),
        axes=tuple(rows if with_c or snapshot.axes != LATHE else rows[:2]),
    )


def _words(snapshot: Snapshot, readout: Readout) -> str:
    """What X is on a lathe; on a mill the system that the figures count in."""
    if snapshot.axes != LATHE:
        return of_mill.system_words(None if readout is Readout.HOME else snapshot.swivel)
    return "X IS A DIAMETER" if snapshot.modal.diameter else "X IS A RADIUS"


def _unit(metric: bool, control: bool) -> str:
    """The unit of the figures; where the control is in the other one, that is said beside it."""
    names = ("INCH", "MM")
    return names[metric] if metric == control else f"{names[metric]}  ·  CONTROL IN {names[control]}"


def _figures(snapshot: Snapshot, readout: Readout, metric: bool, diameter: bool) -> list[str]:
    angle = formats.angle if snapshot.axes == LATHE else of_mill.angle
    return [
        angle(value) if name in ROTARY else formats.length(_doubled(name, value, diameter), metric)
        for name, value in zip(snapshot.axes, coordinates(snapshot, readout), strict=True)
    ]


def _doubled(name: str, value: float, diameter: bool) -> float:
    return 2 * value if name == "X" and diameter else value


def _feed(snapshot: Snapshot, metric: bool) -> FeedView:
    modal = snapshot.modal
    per_rev = modal.per_rev and not snapshot.rapid
    turns = abs(snapshot.rpm_actual) / 60
    if snapshot.turns:
        value = formats.fixed(snapshot.feed * (1 if per_rev else 60), 4 if per_rev else 1)
        return FeedView(value, formats.turn_unit(per_rev), formats.NOTHING, "", snapshot.feed_override)
    if per_rev:
        speed = snapshot.velocity / turns if turns > TURNING / 60 else math.nan
    else:
        speed = snapshot.velocity
    unit = formats.feed_unit(metric, per_rev)
    known = snapshot.rapid or snapshot.feed > 0
    value = "RAPID" if snapshot.rapid else formats.feed(snapshot.feed, metric, modal.per_rev)
    return FeedView(
        value=value if known else formats.NOTHING,
        unit="" if snapshot.rapid else unit,
        actual=formats.feed(speed, metric, per_rev) if math.isfinite(speed) else formats.NOTHING,
        actual_unit=unit,
        override=snapshot.feed_override,
    )


def _spindle(snapshot: Snapshot, metric: bool) -> SpindleView:
    modal = snapshot.modal
    radius = snapshot.actual[0] - snapshot.offset[0]
    lathe = snapshot.axes == LATHE  # on a mill it would be the tool's, whose radius nobody knows
    surface = 2 * math.pi * radius * snapshot.rpm_actual / 60 if lathe else math.nan
    command = snapshot.rpm_command
    direction = "M03 FWD" if command > 0 else "M04 REV" if command < 0 else "M05 OFF"
    return SpindleView(
        direction=f"{direction} · G96" if modal.css else direction,
        rpm=formats.rpm(command),
        actual=formats.rpm(snapshot.rpm_actual),
        surface=formats.surface_speed(surface, metric),
        surface_label="M/MIN" if metric else "SFM",
        override=snapshot.spindle_override,
        auto=snapshot.spindle_auto,
    )


def _message(snapshot: Snapshot) -> str:
    if snapshot.state is not State.PROGRAM_STOP:
        return ""
    return snapshot.message or "PROGRAM STOP"
