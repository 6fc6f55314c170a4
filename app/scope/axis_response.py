"""Response of an axis to its last move: rise, overshoot, settling, lag; what other windows would do.

A move from rest to rest is looked at, as a step of the Jog page makes it: nothing is moved from here, and
nothing is written to a drive.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.desk import formats
from app.desk.sheet import Row, Sheet
from app.desk.translation import tr
from app.scope.drawing import Drawing
from core.machine.machine_model import Axis
from core.records.analysis_errors import AnalysisError
from core.records.derived_figures import velocity
from core.records.record import Record
from core.records.step_response import StepResponse, at_other_speed, step_response, would_trip

FloatArray = npt.NDArray[np.float64]
_BEFORE, _BEHIND = 0.2, 1.0  # s of rest that belong to a move
_REST = 0.15  # s without a new setpoint that end a move
_STILL = 1e-7  # mm: setpoints nearer than that are one
FACTORS = (1.5, 2.0)  # of the speed
WINDOWS = (0.5, 0.25)  # of the window


@dataclass(frozen=True, slots=True, eq=False)
class AxisResponse:
    """One move. Times (n,) s from its beginning; ``speed`` the greatest asked for, mm/s."""

    letter: str
    times: FloatArray
    demand: FloatArray
    actual: FloatArray
    step: StepResponse
    speed: float
    lag: float  # s, by the part of the error that goes with the speed
    axis: Axis

    @property
    def error(self) -> FloatArray:
        """The following error (n,)."""
        return self.demand - self.actual

    def faster(self, factor: float) -> FloatArray:
        """The error at so many times the speed."""
        return at_other_speed(np.nan_to_num(velocity(self.times, self.demand)), self.error, factor)


def last_move(record: Record, drives: Mapping[str, Axis]) -> AxisResponse:
    """The last move from rest to rest of one axis. Raises AnalysisError."""
    found: tuple[int, int, str] | None = None
    for letter in drives:
        demand = record.columns.get(f"{letter} demand")
        if drives[letter].rotary or demand is None or not np.isfinite(demand).all():
            continue
        span = _last_stretch(record.times, demand)
        if span is not None and (found is None or span[1] > found[1]):
            found = (*span, letter)
    if found is None:
        raise AnalysisError(tr("no axis moved from rest to rest in this time: make a step on the Jog page"))
    first, last, letter = found
    times = record.times
    begin = int(np.searchsorted(times, times[first] - _BEFORE))
    end = int(np.searchsorted(times, times[last] + _BEHIND))
    return _response(letter, drives[letter], record, slice(begin, end), float(times[first]))


def _last_stretch(times: FloatArray, demand: FloatArray) -> tuple[int, int] | None:
    """First and last sample of the last move that has come to rest."""
    moving = np.flatnonzero(np.abs(np.diff(demand)) > _STILL)
    if not len(moving):
        return None
    breaks = np.flatnonzero(np.diff(times[moving]) > _REST)
    starts = np.concatenate([[0], breaks + 1])
    ends = np.concatenate([breaks, [len(moving) - 1]])
    if times[-1] - times[moving[-1]] < _REST:
        starts, ends = starts[:-1], ends[:-1]  # it still moves
    return (int(moving[starts[-1]]), int(moving[ends[-1]]) + 1) if len(starts) else None


def _response(letter: str, axis: Axis, record: Record, cut: slice, zero: float) -> AxisResponse:
    times = record.times[cut] - zero
    demand, actual = record.columns[f"{letter} demand"][cut], record.columns[f"{letter} actual"][cut]
    step = step_response(times, demand, actual, axis.in_position)
    speeds = np.nan_to_num(velocity(times, demand))
    speed = float(np.abs(speeds).max())
    square = float((speeds**2).sum())
    lag = float((speeds * (demand - actual)).sum()) / square if square > 0.0 else math.nan
    return AxisResponse(letter, times, demand, actual, step, speed, lag, axis)


def response_drawing(found: AxisResponse) -> Drawing:
    """Asked and done above, the following error below, over seconds."""
    asked = np.column_stack([found.times, found.demand])
    done = np.column_stack([found.times, found.actual])
    error = np.column_stack([found.times, found.error])
    return Drawing(asked, (done,), (error,), equal=False, lengths_below=True)


def response_sheet(title: str, found: AxisResponse, metric: bool) -> Sheet:
    """Its figures, and what other windows and speeds would do."""
    unit, scale = ("mm", 1.0) if metric else ("in", 1.0 / formats.MM_PER_INCH)

    def way(value: float) -> str:
        return f"{formats.length(value, metric)} {unit}"

    def ms(seconds: float) -> str:
        return f"{formats.fixed(1000.0 * seconds, 1)} ms" if math.isfinite(seconds) else formats.NOTHING

    def trips(error: FloatArray, window: float) -> str:
        at = would_trip(found.times, error, window, found.axis.following_time)
        return tr("holds") if at is None else tr("trips at {at}").format(at=ms(at))

    limit = found.axis.following_limit(found.speed)
    step, greatest = found.step, float(np.abs(found.error).max())
    rows = [
        Row((tr("WAY"), way(step.way))),
        Row((tr("GREATEST SPEED"), f"{formats.fixed(found.speed * scale, 3)} {unit}/s")),
        Row((tr("RISE, 10 TO 90 %"), ms(step.rise))),
        Row((tr("OVERSHOOT"), f"{formats.fixed(100.0 * step.overshoot, 2)} %")),
        Row((tr("IN POSITION AFTER"), ms(step.settling))),
        Row((tr("LAG BEHIND THE SPEED"), ms(found.lag))),
        Row((tr("GREATEST FOLLOWING ERROR"), way(greatest))),
        Row((tr("WINDOW AT THIS SPEED"), way(limit))),
    ]
    for share in WINDOWS:
        name = tr("WITH {share} OF THE WINDOW").format(share=formats.percent(share))
        rows.append(Row((name, trips(found.error, share * limit))))
    for factor in FACTORS:
        error = found.faster(factor)
        name = tr("AT {share} OF THE SPEED").format(share=formats.percent(factor))
        words = trips(error, found.axis.following_limit(factor * found.speed))
        rows.append(Row((name, f"{way(float(np.abs(error).max()))}, {words}")))
    notes = (
        tr("Of the last move of {axis}; worked out, nothing was changed.").format(axis=found.letter),
        tr("A step of the Jog page is a good one."),
    )
    return Sheet(title, ("", ""), (0.56, 0.44), tuple(rows), notes=notes, figures=frozenset({1}))
