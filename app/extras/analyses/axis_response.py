"""Response of an axis to its last move: step response, lag, and effect of changed error limits.

The analysis uses a recorded move from rest to rest, such as a jog step. It does not move an axis or write
to a drive.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.desk.pages.table_content import TableContent, TableRow
from app.desk.status import formats
from app.desk.translation import tr
from app.extras.analyses.drawing import AnalysisDrawing
from core.extras.analyses.step_response import (
    StepResponse,
    analyze_step,
    find_smallest_error_limit,
    find_speed_at_limit,
    find_trip_time,
    fit_lag,
    scale_error_to_speed,
)
from core.machine.machine_model import Axis
from core.message import Message
from core.records.record import AnalysisError, ScopeRecord, calculate_velocity

FloatArray = npt.NDArray[np.float64]
_BEFORE, _BEHIND = 0.2, 1.0  # seconds of rest before and after a move
_REST = 0.15  # seconds without a new setpoint that end a move
_STILL = 1e-7  # mm: smaller differences of setpoints are ignored
SPEED_FACTORS = (1.5, 2.0)  # ratios to the speed
LIMIT_FACTORS = (0.5, 0.25)  # ratios to the following-error limit


COLUMN_WIDTH_RATIOS = (0.5, 0.2, 0.3)  # ratios of the columns: name, verdict, value


@dataclass(frozen=True, slots=True, eq=False)
class AxisMotion:
    """Motion of one axis.

    The array ``times_s`` (n,) contains seconds from the start of the motion. ``max_speed_mm_s`` is the
    highest commanded speed in mm/s.
    """

    axis_letter: str
    times_s: FloatArray
    setpoints: FloatArray
    positions: FloatArray
    max_speed_mm_s: float
    following_lag_s: float  # seconds, from the part of the error that is proportional to the speed
    axis: Axis

    @property
    def following_error(self) -> FloatArray:
        """Return the following error in mm at each sample as an array (n,)."""
        return self.setpoints - self.positions

    def predict_following_error(self, factor: float) -> FloatArray:
        """Return the following error expected at ``factor`` times the recorded speed."""
        return scale_error_to_speed(
            np.nan_to_num(calculate_velocity(self.times_s, self.setpoints)), self.following_error, factor
        )


@dataclass(frozen=True, slots=True, eq=False)
class AxisResponse(AxisMotion):
    """Axis motion from rest to rest, with its step response."""

    step_response: StepResponse


def make_axis_motion(
    letter: str, axis: Axis, record: ScopeRecord, sample_range: slice, start_time_s: float
) -> AxisMotion:
    """Return the motion of an axis in one part of a record.

    The times of the motion are relative to ``start_time_s``, a time in seconds on the clock of the record.
    """
    times = record.times_s[sample_range] - start_time_s
    demand, actual = (
        record.values_by_channel[Message("{item} demand", item=letter)][sample_range],
        record.values_by_channel[Message("{item} actual", item=letter)][sample_range],
    )
    speeds = np.nan_to_num(calculate_velocity(times, demand))
    speed = float(np.abs(speeds).max(initial=0.0))
    return AxisMotion(letter, times, demand, actual, speed, fit_lag(speeds, demand - actual), axis)


def find_last_move(record: ScopeRecord, linear_axes: Mapping[str, Axis]) -> AxisResponse:
    """Return the last move of one axis from rest to rest.

    Rotary axes are ignored. Raises AnalysisError if the record contains no complete move, or if the move is
    too small for the in-position tolerance.
    """
    found: tuple[int, int, str] | None = None
    for letter in linear_axes:
        demand = record.values_by_channel.get(Message("{item} demand", item=letter))
        if linear_axes[letter].is_rotary or demand is None or not np.isfinite(demand).all():
            continue
        spans = find_completed_moves(record.times_s, demand)
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
    times = record.times_s
    begin = int(np.searchsorted(times, times[first] - _BEFORE))
    end = int(np.searchsorted(times, times[last] + _BEHIND))
    return _response(letter, linear_axes[letter], record, slice(begin, end), float(times[first]))


def find_completed_moves(times_s: FloatArray, setpoints: FloatArray) -> list[tuple[int, int]]:
    """Return the first and last sample index of every completed move, oldest move first."""
    moving = np.flatnonzero(np.abs(np.diff(setpoints)) > _STILL)
    if not len(moving):
        return []
    breaks = np.flatnonzero(np.diff(times_s[moving]) > _REST)
    starts = np.concatenate([[0], breaks + 1])
    ends = np.concatenate([breaks, [len(moving) - 1]])
    if times_s[-1] - times_s[moving[-1]] < _REST:
        starts, ends = starts[:-1], ends[:-1]  # the last move has not ended
    return [(int(moving[a]), int(moving[b]) + 1) for a, b in zip(starts, ends, strict=True)]


def _response(letter: str, axis: Axis, record: ScopeRecord, cut: slice, zero: float) -> AxisResponse:
    found = make_axis_motion(letter, axis, record, cut, zero)
    step = analyze_step(found.times_s, found.setpoints, found.positions, axis.in_position_tolerance)
    return AxisResponse(
        letter,
        found.times_s,
        found.setpoints,
        found.positions,
        found.max_speed_mm_s,
        found.following_lag_s,
        axis,
        step_response=step,
    )


def draw_response(response: AxisMotion) -> AnalysisDrawing:
    """Return the drawing of a motion over time in seconds.

    The upper plot shows the commanded and actual positions, and the lower plot shows the following error.
    """
    asked = np.column_stack([response.times_s, response.setpoints])
    done = np.column_stack([response.times_s, response.positions])
    error = np.column_stack([response.times_s, response.following_error])
    names = f"{response.axis_letter}  {{unit}}", tr("FOLLOWING ERROR") + "  {unit}", "s"
    return AnalysisDrawing(
        asked, (done,), (error,), has_equal_axes=False, has_lower_length_axis=True, axis_labels=names
    )


@dataclass(frozen=True, slots=True)
class UnitFormat:
    """Formatter of lengths and speeds in the selected unit of length, mm or inches."""

    metric: bool

    @property
    def length_unit(self) -> str:
        """Return the unit of a length, mm or in."""
        return "mm" if self.metric else "in"

    def format_length(self, mm: float) -> str:
        """Return a length in mm as text in the selected unit."""
        return f"{formats.format_length(mm, self.metric)} {self.length_unit}"

    def format_speed(self, speed_mm_s: float) -> str:
        """Return a speed in mm/s as text in the selected unit per second."""
        speed = speed_mm_s if self.metric else speed_mm_s / formats.MM_PER_INCH
        return f"{formats.format_fixed(speed, 3)} {self.length_unit}/s"

    def format_percentage(self, ratio: float) -> str:
        """Return a ratio as text in percent."""
        return f"{formats.format_fixed(100.0 * ratio, 2)} %"

    def format_milliseconds(self, seconds: float) -> str:
        """Return a time in seconds as text in milliseconds, or a dash if it is not finite."""
        return (
            Message("{seconds} ms", seconds=formats.format_fixed(1000.0 * seconds, 1))
            if math.isfinite(seconds)
            else formats.NO_VALUE
        )


def make_step_rows(steps: Sequence[StepResponse], units: UnitFormat) -> list[tuple[str, ...]]:
    """Return table rows for step responses, with one row per value and one cell per step."""
    return [
        (tr("RISE, 10 TO 90 %"), *(units.format_milliseconds(each.rise_time_s) for each in steps)),
        (tr("OVERSHOOT"), *(units.format_percentage(each.overshoot_fraction) for each in steps)),
        (tr("TIME UNTIL IN POSITION"), *(units.format_milliseconds(each.settling_time_s) for each in steps)),
    ]


def make_limit_rows(response: AxisMotion, units: UnitFormat) -> list[tuple[str, str, str]]:
    """Return table rows that show the effect of changed following-error limits and changed speeds.

    Each row contains a name, a verdict and a value.
    """
    axis, times, error = response.axis, response.times_s, response.following_error

    def describe_trip_time(error: FloatArray, window: float) -> str:
        at = find_trip_time(times, error, window, axis.following_error_time_s)
        return (
            tr("no trip")
            if at is None
            else tr(Message("trips at {position}", position=units.format_milliseconds(at)))
        )

    limit, greatest = axis.compute_max_following_error(response.max_speed_mm_s), float(np.abs(error).max())
    least = find_smallest_error_limit(times, error, axis.following_error_time_s)
    reached = find_speed_at_limit(
        abs(response.following_lag_s), axis.standstill_tolerance, axis.following_error_window, axis.max_speed
    )
    rows = [
        (tr("FOLLOWING LAG"), "", units.format_milliseconds(response.following_lag_s)),
        (tr("LARGEST ERROR"), "", units.format_length(greatest)),
        (tr("ERROR LIMIT AT THIS SPEED"), describe_trip_time(error, limit), units.format_length(limit)),
        (tr("SMALLEST LIMIT WITHOUT A TRIP"), "", units.format_length(least)),
    ]
    for share in LIMIT_FACTORS:
        name = tr(Message("LIMIT REDUCED TO {share}", share=formats.format_percent(share)))
        rows.append((name, describe_trip_time(error, share * limit), units.format_length(share * limit)))
    for factor in SPEED_FACTORS:
        faster = response.predict_following_error(factor)
        name = tr(Message("AT {share} SPEED", share=formats.format_percent(factor)))
        verdict = describe_trip_time(
            faster, axis.compute_max_following_error(factor * response.max_speed_mm_s)
        )
        rows.append((name, verdict, units.format_length(float(np.abs(faster).max()))))
    at = (
        units.format_speed(reached)
        if reached is not None
        else tr("the limit is not reached in the axis speed range")
    )
    rows.append((tr("SPEED AT WHICH LAG EQUALS LIMIT"), "", at))
    return rows


def make_response_table(title: str, response: AxisResponse, metric: bool) -> TableContent:
    """Return the table of a response, with rows for changed following-error limits and changed speeds."""
    units = UnitFormat(metric)
    rows = [
        TableRow((tr("TRAVEL"), "", units.format_length(response.step_response.step_size_mm))),
        TableRow((tr("MAXIMUM SPEED"), "", units.format_speed(response.max_speed_mm_s))),
        *(TableRow((name, "", figure)) for name, figure in make_step_rows([response.step_response], units)),
        *map(TableRow, make_limit_rows(response, units)),
    ]
    notes = (
        tr(
            Message(
                "Last move of {axis}. These values are for information only; no setting was changed.",
                axis=response.axis_letter,
            )
        ),
        tr(
            "For a good result, jog a single step on the Jog page, or press F9 on this page to "
            "open the drive tests."
        ),
    )
    return TableContent(
        title, ("", "", ""), COLUMN_WIDTH_RATIOS, tuple(rows), notes=notes, numeric_columns=frozenset({1, 2})
    )
