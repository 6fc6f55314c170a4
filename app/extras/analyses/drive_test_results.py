"""Results of a drive test: responses, bandwidth, and the effect of changed following-error limits.

The record of a test contains the commanded test path, so a stored record gives the same results.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np
import numpy.typing as npt

from app.desk.pages.table_content import TableContent, TableRow
from app.desk.status import formats
from app.desk.translation import tr
from app.extras.analyses.axis_response import (
    COLUMN_WIDTH_RATIOS,
    AxisMotion,
    UnitFormat,
    find_completed_moves,
    make_axis_motion,
    make_limit_rows,
    make_step_rows,
)
from core.executor.hand_motion.drive_test import PAUSE_BETWEEN_MOVES_S, DriveTestMotion, Shape
from core.extras.analyses.step_response import (
    RampResponse,
    SineResponse,
    StepResponse,
    analyze_ramp,
    analyze_sine,
    analyze_step,
    calculate_bandwidth,
)
from core.machine.machine_model import Axis
from core.message import Message
from core.records.record import AnalysisError, ScopeRecord

FloatArray = npt.NDArray[np.float64]
TEST_PATH_KEY = "drive test"  # key of the test path in a record
REST_BEFORE_TEST_S = 0.1  # seconds of rest before a test that are included
_REST_AFTER_MOVE_S = 0.9 * PAUSE_BETWEEN_MOVES_S  # seconds of rest after a move that are included
_SHAPE_NAMES = {Shape.STEP: "STEP", Shape.RAMP: "RAMP", Shape.SINE: "SINE"}


def format_test_path_json(path: DriveTestMotion) -> str:
    """Return the test path as a JSON text for the record."""
    path_fields = (path.axis, path.shape.value, path.travel_mm, path.speed, path.frequencies_hz)
    return json.dumps(path_fields)


def find_test_path(record: ScopeRecord) -> DriveTestMotion | None:
    """Return the test path of a record, or None if the record is not from a drive test."""
    try:
        axis, shape, size, speed, frequencies = json.loads(record.about.get(TEST_PATH_KEY, ""))
        return DriveTestMotion(
            str(axis), Shape(shape), float(size), float(speed), tuple(float(each) for each in frequencies)
        )
    except (ValueError, TypeError):
        return None


@dataclass(frozen=True, slots=True, eq=False)
class DriveTestResults:
    """Results of one drive test.

    A step or ramp has two responses: one for the outbound move and one for the return move. A sine has one
    response per frequency.
    """

    test_path: DriveTestMotion
    motion: AxisMotion
    step_responses: tuple[StepResponse, ...] = ()
    ramp_responses: tuple[RampResponse, ...] = ()
    sine_responses: tuple[SineResponse, ...] = ()


def calculate_test_results(
    record: ScopeRecord, path: DriveTestMotion, linear_axes: Mapping[str, Axis]
) -> DriveTestResults:
    """Calculate the results from the record of a complete test.

    Raises AnalysisError if the axis does not exist, if the test was not completed, or if its moves are too
    small or too short to be evaluated.
    """
    name, axis = Message("{item} demand", item=path.axis), linear_axes.get(path.axis)
    if axis is None or name not in record.values_by_channel:
        raise AnalysisError(tr(Message("this machine has no {axis} axis", axis=path.axis)), "no-axis")
    found = find_completed_moves(record.times_s, record.values_by_channel[name])
    ways = len(path.frequencies_hz) if path.shape is Shape.SINE else 2
    if len(found) < ways:
        raise AnalysisError(
            tr("the key was released before the test ended; hold the key until the axis has returned"),
            "test-broken-off",
        )
    found = found[-ways:]
    times, zero = record.times_s, float(record.times_s[found[0][0]])
    whole = _about(times, zero - REST_BEFORE_TEST_S, float(times[found[-1][1]]) + _REST_AFTER_MOVE_S)
    move = make_axis_motion(path.axis, axis, record, whole, zero)
    if path.shape is Shape.SINE:
        sines = tuple(
            _sine(record, path, first, last, frequency)
            for (first, last), frequency in zip(found, path.frequencies_hz, strict=True)
        )
        return DriveTestResults(path, move, sine_responses=sines)
    parts = [
        make_axis_motion(
            path.axis,
            axis,
            record,
            _about(times, times[first] - REST_BEFORE_TEST_S, times[last] + _REST_AFTER_MOVE_S),
            zero,
        )
        for first, last in found
    ]
    steps = tuple(
        analyze_step(each.times_s, each.setpoints, each.positions, axis.in_position_tolerance)
        for each in parts
    )
    if path.shape is Shape.STEP:
        return DriveTestResults(path, move, steps)
    ramps = tuple(analyze_ramp(each.times_s, each.setpoints, each.positions) for each in parts)
    return DriveTestResults(path, move, steps, ramps)


def _about(times: FloatArray, begin: float, end: float) -> slice:
    first, last = np.searchsorted(times, (begin, end))
    return slice(int(first), int(last))


def _sine(
    record: ScopeRecord, path: DriveTestMotion, first: int, last: int, frequency: float
) -> SineResponse:
    """Return the response to a sine motion.

    The first period is omitted, because the axis is still settling.
    """
    times = record.times_s
    cut = _about(times, float(times[first]) + 1.0 / frequency, float(times[last]))
    asked, done = (record.values_by_channel[f"{path.axis} {what}"][cut] for what in ("demand", "actual"))
    return analyze_sine(times[cut], asked, done, frequency)


# --- display --------------------------------------------------------------------------------------------


def describe_test_path(path: DriveTestMotion, metric: bool) -> str:
    """Return the test path as display text."""
    units = UnitFormat(metric)
    words = (
        f"{path.axis}{'+' if path.travel_mm > 0.0 else '−'}  {tr(_SHAPE_NAMES[path.shape])}  "
        f"{units.format_length(abs(path.travel_mm))}"
    )
    if path.shape is Shape.RAMP:
        return f"{words}, {units.format_speed(path.speed)}"
    if path.shape is Shape.SINE:
        return Message(
            "{words}, {item} Hz", words=words, item=", ".join(f"{each:g}" for each in path.frequencies_hz)
        )
    return words


class ResultsSection(Enum):
    """Section of the results that the page shows at one time, because a small screen cannot show all."""

    RESPONSE = "response"
    LIMITS = "window"
    ALL = "all"


def make_results_table(
    title: str, results: DriveTestResults, metric: bool, displayed_part: ResultsSection = ResultsSection.ALL
) -> TableContent:
    """Return the table of the responses, followed by the effect of changed following-error limits."""
    units = UnitFormat(metric)
    rows = (
        [TableRow(cells) for cells in _responses(results, units)]
        if displayed_part is not ResultsSection.LIMITS
        else []
    )
    rows += (
        map(TableRow, make_limit_rows(results.motion, units))
        if displayed_part is not ResultsSection.RESPONSE
        else ()
    )
    heads = (
        ("", tr("GAIN"), tr("PHASE LAG")) if results.sine_responses else ("", tr("OUTBOUND"), tr("RETURN"))
    )
    if displayed_part is ResultsSection.LIMITS:
        heads = ("", "", "")
    notes = (describe_test_path(results.test_path, metric), tr("Nothing was written to the drive."))
    return TableContent(
        title, heads, COLUMN_WIDTH_RATIOS, tuple(rows), notes=notes, numeric_columns=frozenset({1, 2})
    )


def _responses(found: DriveTestResults, units: UnitFormat) -> list[tuple[str, ...]]:
    if found.sine_responses:
        return _sine_rows(found)
    rows: list[tuple[str, ...]] = [*make_step_rows(found.step_responses, units)]
    if found.ramp_responses:
        rows += [
            (
                tr("LAG AT CONSTANT SPEED"),
                *(units.format_length(abs(each.lag_mm)) for each in found.ramp_responses),
            ),
            (tr("SPEED / LAG (GAIN)"), *(_gain(each) for each in found.ramp_responses)),
        ]
    return rows


def _gain(ramp: RampResponse) -> str:
    """Return the gain Kv = v/e of the position loop as text.

    The result is a dash if feedforward removes the lag.
    """
    return (
        f"{formats.format_fixed(1.0 / abs(ramp.lag_s), 0)} /s" if abs(ramp.lag_s) > 1e-5 else formats.NO_VALUE
    )


def _sine_rows(found: DriveTestResults) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = [
        (
            Message("{item} Hz", item=f"{each.frequency_hz:g}"),
            f"{formats.format_fixed(100.0 * each.gain, 1)} %",
            f"{formats.format_fixed(each.phase_lag_deg, 1)}°",
        )
        for each in found.sine_responses
    ]
    seen, most = calculate_bandwidth(found.sine_responses), found.sine_responses[-1].frequency_hz

    def format_frequency(hertz: float | None) -> str:
        return (
            Message("{item} Hz", item=formats.format_fixed(hertz, 1))
            if hertz is not None
            else tr(Message("−3 dB is not reached at frequencies up to {maximum} Hz", maximum=f"{most:g}"))
        )

    if len(found.sine_responses) > 1:
        rows += [
            (tr("BANDWIDTH, −3 dB"), "", format_frequency(seen.gain_bandwidth_hz)),
            (tr("90° PHASE LAG"), "", format_frequency(seen.phase_bandwidth_hz)),
        ]
    late = found.sine_responses[0].lag_s
    rows.append(
        (
            tr("DELAY"),
            "",
            Message("{seconds} ms", seconds=formats.format_fixed(1000.0 * late, 2))
            if math.isfinite(late)
            else "",
        )
    )
    return rows
