"""Results of a drive test: step, ramp and sine responses, bandwidth, and the effect of other limits.

The record of a test contains the commanded test path, so that a stored record gives the same results.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np
import numpy.typing as npt

from app.desk.pages.sheet import Row, Sheet
from app.desk.status import formats
from app.desk.translation import tr
from app.extras.analyses.axis_response import SHARES, Moved, Units, moved, step_rows, stretches, window_rows
from core.executor.hand_motion.drive_test import PAUSE, DriveTestPath, Shape
from core.extras.analyses.step_response import (
    RampResponse,
    SineResponse,
    StepResponse,
    bandwidth,
    ramp_response,
    sine_response,
    step_response,
)
from core.machine.machine_model import Axis
from core.message import Message
from core.records.record import AnalysisError, Record

FloatArray = npt.NDArray[np.float64]
TESTED = "drive test"  # key of the test path in a record
BEFORE = 0.1  # seconds of rest before a test that are included
_SETTLES = 0.9 * PAUSE  # seconds of rest after a move that are included
_NAMES = {Shape.STEP: "STEP", Shape.RAMP: "RAMP", Shape.SINE: "SINE"}


def words_of(path: DriveTestPath) -> str:
    """Return the test path in the form for the record."""
    told = (path.axis, path.shape.value, path.size, path.speed, path.frequencies)
    return json.dumps(told)


def path_in(record: Record) -> DriveTestPath | None:
    """Return the test path of a record, or None if the record is not from a drive test."""
    try:
        axis, shape, size, speed, frequencies = json.loads(record.about.get(TESTED, ""))
        return DriveTestPath(
            str(axis), Shape(shape), float(size), float(speed), tuple(float(each) for each in frequencies)
        )
    except (ValueError, TypeError):
        return None


@dataclass(frozen=True, slots=True, eq=False)
class DriveTestFigures:
    """Results of one test: the response of the outbound and the return move, or of each frequency."""

    path: DriveTestPath
    move: Moved
    steps: tuple[StepResponse, ...] = ()
    ramps: tuple[RampResponse, ...] = ()
    sines: tuple[SineResponse, ...] = ()


def drive_test_figures(record: Record, path: DriveTestPath, drives: Mapping[str, Axis]) -> DriveTestFigures:
    """Calculate the results from the record of a complete test. Raises AnalysisError."""
    name, axis = Message("{item} demand", item=path.axis), drives.get(path.axis)
    if axis is None or name not in record.columns:
        raise AnalysisError(tr(Message("this machine has no {axis} axis", axis=path.axis)), "no-axis")
    found = stretches(record.times, record.columns[name])
    ways = len(path.frequencies) if path.shape is Shape.SINE else 2
    if len(found) < ways:
        raise AnalysisError(
            tr("the key was released before the test ended; hold the key until the axis has returned"),
            "test-broken-off",
        )
    found = found[-ways:]
    times, zero = record.times, float(record.times[found[0][0]])
    whole = _about(times, zero - BEFORE, float(times[found[-1][1]]) + _SETTLES)
    move = moved(path.axis, axis, record, whole, zero)
    if path.shape is Shape.SINE:
        sines = tuple(
            _sine(record, path, first, last, frequency)
            for (first, last), frequency in zip(found, path.frequencies, strict=True)
        )
        return DriveTestFigures(path, move, sines=sines)
    parts = [
        moved(path.axis, axis, record, _about(times, times[first] - BEFORE, times[last] + _SETTLES), zero)
        for first, last in found
    ]
    steps = tuple(step_response(each.times, each.demand, each.actual, axis.in_position) for each in parts)
    if path.shape is Shape.STEP:
        return DriveTestFigures(path, move, steps)
    ramps = tuple(ramp_response(each.times, each.demand, each.actual) for each in parts)
    return DriveTestFigures(path, move, steps, ramps)


def _about(times: FloatArray, begin: float, end: float) -> slice:
    first, last = np.searchsorted(times, (begin, end))
    return slice(int(first), int(last))


def _sine(record: Record, path: DriveTestPath, first: int, last: int, frequency: float) -> SineResponse:
    """Return the sine response without the first period, in which the axis settles."""
    times = record.times
    cut = _about(times, float(times[first]) + 1.0 / frequency, float(times[last]))
    asked, done = (record.columns[f"{path.axis} {what}"][cut] for what in ("demand", "actual"))
    return sine_response(times[cut], asked, done, frequency)


# --- display --------------------------------------------------------------------------------------------


def shown_words(path: DriveTestPath, metric: bool) -> str:
    """Return the test path as display text."""
    units = Units(metric)
    words = (
        f"{path.axis}{'+' if path.size > 0.0 else '−'}  {tr(_NAMES[path.shape])}  {units.way(abs(path.size))}"
    )
    if path.shape is Shape.RAMP:
        return f"{words}, {units.speed(path.speed)}"
    if path.shape is Shape.SINE:
        return Message(
            "{words}, {item} Hz", words=words, item=", ".join(f"{each:g}" for each in path.frequencies)
        )
    return words


class Part(Enum):
    """Displayed part of the results, because a small screen cannot show all."""

    RESPONSE = "response"
    WINDOW = "window"
    ALL = "all"


def figures_sheet(title: str, found: DriveTestFigures, metric: bool, part: Part = Part.ALL) -> Sheet:
    """Return the table of responses, followed by the effect of the limits."""
    units = Units(metric)
    rows = [Row(cells) for cells in _responses(found, units)] if part is not Part.WINDOW else []
    rows += map(Row, window_rows(found.move, units)) if part is not Part.RESPONSE else ()
    heads = ("", tr("GAIN"), tr("PHASE LAG")) if found.sines else ("", tr("OUTBOUND"), tr("RETURN"))
    if part is Part.WINDOW:
        heads = ("", "", "")
    notes = (shown_words(found.path, metric), tr("Nothing was written to the drive."))
    return Sheet(title, heads, SHARES, tuple(rows), notes=notes, figures=frozenset({1, 2}))


def _responses(found: DriveTestFigures, units: Units) -> list[tuple[str, ...]]:
    if found.sines:
        return _sine_rows(found)
    rows: list[tuple[str, ...]] = [*step_rows(found.steps, units)]
    if found.ramps:
        rows += [
            (tr("LAG AT CONSTANT SPEED"), *(units.way(abs(each.error)) for each in found.ramps)),
            (tr("SPEED / LAG (GAIN)"), *(_gain(each) for each in found.ramps)),
        ]
    return rows


def _gain(ramp: RampResponse) -> str:
    """Return the gain of the position loop, Kv = v/e, or a dash if feedforward removes the lag."""
    return f"{formats.fixed(1.0 / abs(ramp.lag), 0)} /s" if abs(ramp.lag) > 1e-5 else formats.NOTHING


def _sine_rows(found: DriveTestFigures) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = [
        (
            Message("{item} Hz", item=f"{each.frequency:g}"),
            f"{formats.fixed(100.0 * each.gain, 1)} %",
            f"{formats.fixed(each.lag, 1)}°",
        )
        for each in found.sines
    ]
    seen, most = bandwidth(found.sines), found.sines[-1].frequency

    def at(hertz: float | None) -> str:
        return (
            Message("{item} Hz", item=formats.fixed(hertz, 1))
            if hertz is not None
            else tr(Message("−3 dB is not reached at frequencies up to {maximum} Hz", maximum=f"{most:g}"))
        )

    if len(found.sines) > 1:
        rows += [(tr("BANDWIDTH, −3 dB"), "", at(seen.down)), (tr("90° PHASE LAG"), "", at(seen.quarter))]
    late = found.sines[0].late
    rows.append(
        (
            tr("DELAY"),
            "",
            Message("{seconds} ms", seconds=formats.fixed(1000.0 * late, 2)) if math.isfinite(late) else "",
        )
    )
    return rows
