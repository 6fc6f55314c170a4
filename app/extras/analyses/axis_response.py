"""Response of an axis to its last move: rise, overshoot, settling and lag, and the effect of other limits.

The analysis uses a move from rest to rest, such as a jog step. The analysis moves no axis and writes nothing
to a drive.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.desk.pages.sheet import Row, Sheet
from app.desk.status import formats
from app.desk.translation import tr
from app.extras.analyses.drawing import Drawing
from core.extras.analyses.step_response import (
    StepResponse,
    at_other_speed,
    lag_of,
    narrowest_window,
    speed_of_window,
    step_response,
    would_trip,
)
from core.machine.machine_model import Axis
from core.message import Message
from core.records.record import AnalysisError, Record, velocity

FloatArray = npt.NDArray[np.float64]
_BEFORE, _BEHIND = 0.2, 1.0  # seconds of rest before and after a move
_REST = 0.15  # seconds without a new setpoint that end a move
_STILL = 1e-7  # mm: smaller differences of setpoints are ignored
FACTORS = (1.5, 2.0)  # ratios to the speed
WINDOWS = (0.5, 0.25)  # ratios to the following-error limit


SHARES = (0.5, 0.2, 0.3)  # ratios of the columns: name, verdict, value


@dataclass(frozen=True, slots=True, eq=False)
class Moved:
    """Motion of one axis.

    ``times`` (n,) are seconds from its start. ``speed`` is the highest commanded speed in mm/s.
    """

    letter: str
    times: FloatArray
    demand: FloatArray
    actual: FloatArray
    speed: float
    lag: float  # seconds, from the part of the error that is proportional to the speed
    axis: Axis

    @property
    def error(self) -> FloatArray:
        """Following error (n,)."""
        return self.demand - self.actual

    def faster(self, factor: float) -> FloatArray:
        """Return the expected following error at ``factor`` times the speed."""
        return at_other_speed(np.nan_to_num(velocity(self.times, self.demand)), self.error, factor)


@dataclass(frozen=True, slots=True, eq=False)
class AxisResponse(Moved):
    """Motion from rest to rest with its step response."""

    step: StepResponse


def moved(letter: str, axis: Axis, record: Record, cut: slice, zero: float) -> Moved:
    """Return the motion of an axis in a part of a record, with times relative to ``zero`` of its clock."""
    times = record.times[cut] - zero
    demand, actual = (
        record.columns[Message("{item} demand", item=letter)][cut],
        record.columns[Message("{item} actual", item=letter)][cut],
    )
    speeds = np.nan_to_num(velocity(times, demand))
    speed = float(np.abs(speeds).max(initial=0.0))
    return Moved(letter, times, demand, actual, speed, lag_of(speeds, demand - actual), axis)


def last_move(record: Record, drives: Mapping[str, Axis]) -> AxisResponse:
    """Return the last move of one axis from rest to rest. Raises AnalysisError."""
    found: tuple[int, int, str] | None = None
    for letter in drives:
        demand = record.columns.get(Message("{item} demand", item=letter))
        if drives[letter].rotary or demand is None or not np.isfinite(demand).all():
            continue
        spans = stretches(record.times, demand)
        if spans and (found is None or spans[-1][1] > found[1]):
            found = (*spans[-1], letter)
    if found is None:
        raise AnalysisError(
            tr(
                "this time range contains no complete move of an axis from rest to rest; jog one "
                "step on the Jog page"
            ),
            "no-step",
        )
    first, last, letter = found
    times = record.times
    begin = int(np.searchsorted(times, times[first] - _BEFORE))
    end = int(np.searchsorted(times, times[last] + _BEHIND))
    return _response(letter, drives[letter], record, slice(begin, end), float(times[first]))


def stretches(times: FloatArray, demand: FloatArray) -> list[tuple[int, int]]:
    """Return the first and last sample of every completed move, oldest first."""
    moving = np.flatnonzero(np.abs(np.diff(demand)) > _STILL)
    if not len(moving):
        return []
    breaks = np.flatnonzero(np.diff(times[moving]) > _REST)
    starts = np.concatenate([[0], breaks + 1])
    ends = np.concatenate([breaks, [len(moving) - 1]])
    if times[-1] - times[moving[-1]] < _REST:
        starts, ends = starts[:-1], ends[:-1]  # the last move has not ended
    return [(int(moving[a]), int(moving[b]) + 1) for a, b in zip(starts, ends, strict=True)]


def _response(letter: str, axis: Axis, record: Record, cut: slice, zero: float) -> AxisResponse:
    found = moved(letter, axis, record, cut, zero)
    step = step_response(found.times, found.demand, found.actual, axis.in_position)
    return AxisResponse(
        letter, found.times, found.demand, found.actual, found.speed, found.lag, axis, step=step
    )


def response_drawing(found: Moved) -> Drawing:
    """Return the drawing of command and actual position above, and following error below, over seconds."""
    asked = np.column_stack([found.times, found.demand])
    done = np.column_stack([found.times, found.actual])
    error = np.column_stack([found.times, found.error])
    names = f"{found.letter}  {{unit}}", tr("FOLLOWING ERROR") + "  {unit}", "s"
    return Drawing(asked, (done,), (error,), equal=False, lengths_below=True, names=names)


@dataclass(frozen=True, slots=True)
class Units:
    """Text format of lengths and speeds."""

    metric: bool

    @property
    def name(self) -> str:
        """Unit of a length."""
        return "mm" if self.metric else "in"

    def way(self, mm: float) -> str:
        """Return a length as text."""
        return f"{formats.length(mm, self.metric)} {self.name}"

    def speed(self, mm: float) -> str:
        """Return a speed per second as text."""
        return f"{formats.fixed(mm if self.metric else mm / formats.MM_PER_INCH, 3)} {self.name}/s"

    def share(self, part: float) -> str:
        """Return a ratio as a percentage."""
        return f"{formats.fixed(100.0 * part, 2)} %"

    def ms(self, seconds: float) -> str:
        """Return a short time in milliseconds as text."""
        return (
            Message("{seconds} ms", seconds=formats.fixed(1000.0 * seconds, 1))
            if math.isfinite(seconds)
            else formats.NOTHING
        )


def step_rows(steps: Sequence[StepResponse], units: Units) -> list[tuple[str, ...]]:
    """Return one row per value, with one cell per step."""
    return [
        (tr("RISE, 10 TO 90 %"), *(units.ms(each.rise) for each in steps)),
        (tr("OVERSHOOT"), *(units.share(each.overshoot) for each in steps)),
        (tr("TIME UNTIL IN POSITION"), *(units.ms(each.settling) for each in steps)),
    ]


def window_rows(found: Moved, units: Units) -> list[tuple[str, str, str]]:
    """Return rows of name, verdict and value for the following-error limit, other limits and other speeds."""
    axis, times, error = found.axis, found.times, found.error

    def trips(error: FloatArray, window: float) -> str:
        at = would_trip(times, error, window, axis.following_time)
        return tr("no trip") if at is None else tr(Message("trips at {position}", position=units.ms(at)))

    limit, greatest = axis.following_limit(found.speed), float(np.abs(error).max())
    least = narrowest_window(times, error, axis.following_time)
    reached = speed_of_window(abs(found.lag), axis.still_window, axis.following_window, axis.vmax)
    rows = [
        (tr("FOLLOWING LAG"), "", units.ms(found.lag)),
        (tr("LARGEST ERROR"), "", units.way(greatest)),
        (tr("ERROR LIMIT AT THIS SPEED"), trips(error, limit), units.way(limit)),
        (tr("SMALLEST LIMIT WITHOUT A TRIP"), "", units.way(least)),
    ]
    for share in WINDOWS:
        name = tr(Message("LIMIT REDUCED TO {share}", share=formats.percent(share)))
        rows.append((name, trips(error, share * limit), units.way(share * limit)))
    for factor in FACTORS:
        faster = found.faster(factor)
        name = tr(Message("AT {share} SPEED", share=formats.percent(factor)))
        verdict = trips(faster, axis.following_limit(factor * found.speed))
        rows.append((name, verdict, units.way(float(np.abs(faster).max()))))
    at = (
        units.speed(reached)
        if reached is not None
        else tr("the limit is not reached in the axis speed range")
    )
    rows.append((tr("SPEED AT WHICH LAG EQUALS LIMIT"), "", at))
    return rows


def response_sheet(title: str, found: AxisResponse, metric: bool) -> Sheet:
    """Return the table of the response, and the effect of other limits and speeds."""
    units = Units(metric)
    rows = [
        Row((tr("TRAVEL"), "", units.way(found.step.way))),
        Row((tr("MAXIMUM SPEED"), "", units.speed(found.speed))),
        *(Row((name, "", figure)) for name, figure in step_rows([found.step], units)),
        *map(Row, window_rows(found, units)),
    ]
    notes = (
        tr(
            Message(
                "Last move of {axis}. These values are for information only; no setting was changed.",
                axis=found.letter,
            )
        ),
        tr(
            "For a good result, jog a single step on the Jog page, or press F9 on this page to "
            "open the drive tests."
        ),
    )
    return Sheet(title, ("", "", ""), SHARES, tuple(rows), notes=notes, figures=frozenset({1, 2}))
