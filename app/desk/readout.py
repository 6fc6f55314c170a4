"""The large figures: what they show, in which unit, and how they come from one snapshot."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from app.desk import formats
from app.desk.lamps import LATHE
from app.desk.swivel import position as of_mill
from core.executor.snapshot import Snapshot

ROTARY = frozenset("ABC")  # axes that are read in degrees


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


def position_view(snapshot: Snapshot, readout: Readout, with_c: bool, metric: bool) -> PositionView:
    """Both figures of every axis; the second is the distance to go, or the position beside that.

    ``metric``: mm, else inches. C is a row of a lathe only ``with_c``.
    """
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
