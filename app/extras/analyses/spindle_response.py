"""Response of the spindle to its last speed change: rise, overshoot, settling time and variation.

The analysis uses a recorded speed change. It does not command the spindle, which only programs and MDI do.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from app.desk.pages.table_content import TableContent, TableRow
from app.desk.status import formats
from app.desk.translation import tr
from app.extras.analyses.drawing import AnalysisDrawing
from core.extras.analyses.step_response import StepResponse, analyze_step
from core.machine.machine_model import SpindleModel
from core.message import Message
from core.records.record import AnalysisError, ScopeRecord

FloatArray = npt.NDArray[np.float64]
_CHANGE = 1.0  # rpm: minimum change of the command
_ONE = 0.15  # seconds between two changes of one run-up, as by a pot or constant surface speed
_BEFORE, _BEHIND, _MOST = 0.2, 2.0, 15.0  # seconds before the change, after reaching the speed, and at most
TOLERANCE_RATIOS = (0.02, 0.01)  # ratios to the speed
_SHARES = (0.62, 0.38)


@dataclass(frozen=True, slots=True, eq=False)
class SpindleResponse:
    """Response of the spindle to one change of speed. All speeds are in rpm.

    - ``times_s`` (n,) are seconds from the change.
    - ``commanded_rpm`` (n,) and ``measured_rpm`` (n,) are the speeds at these times.
    - ``step_responses`` are for the at-speed tolerance of the machine file and for each of
      ``TOLERANCE_RATIOS``.
    - ``speed_variation_rpm`` is the peak-to-peak variation over the last second.
    - ``mean_speed_error_rpm`` is the mean error over the last second.
    """

    times_s: FloatArray
    commanded_rpm: FloatArray
    measured_rpm: FloatArray
    step_responses: tuple[StepResponse, ...]
    speed_variation_rpm: float
    mean_speed_error_rpm: float
    spindle_model: SpindleModel

    @property
    def acceleration_rpm_s(self) -> float:
        """Return the acceleration between 10 and 90 % of the speed change, in rpm/s.

        The result is inf if both levels are reached within one sample.
        """
        step = self.step_responses[0]
        return 0.8 * abs(step.step_size_mm) / step.rise_time_s if step.rise_time_s > 0.0 else np.inf


def find_last_speed_change(record: ScopeRecord, model: SpindleModel | None) -> SpindleResponse:
    """Return the response to the last change to a speed other than 0.

    A change counts only if it exceeds twice the widest tolerance band of the new speed. The bands are the
    at-speed tolerance and ``TOLERANCE_RATIOS``. Raises AnalysisError if the machine has no spindle, or if
    the record has no such change or no measured spindle speed.
    """
    if model is None:
        raise AnalysisError(tr("this machine has no spindle"), "no-spindle")
    nothing = np.full(len(record.times_s), np.nan)
    asked, turned = (
        record.values_by_channel.get(Message("spindle {name}", name=name), nothing)
        for name in ("command", "speed")
    )
    if not np.isfinite(turned).any():
        raise AnalysisError(
            tr("no device on this machine reports the measured spindle speed"), "no-measured-speed"
        )
    known = np.isfinite(asked) & np.isfinite(turned)
    times, asked, turned = record.times_s[known], asked[known], turned[known]
    changes = np.flatnonzero(np.abs(np.diff(asked)) > _CHANGE)
    groups = np.split(changes, np.flatnonzero(np.diff(times[changes]) > _ONE) + 1) if len(changes) else []
    for number in reversed(range(len(groups))):
        first, last = int(groups[number][0]), int(groups[number][-1]) + 1
        # Each tolerance band is analyzed, so the change must exceed the widest one.
        speed_change_rpm, band = abs(asked[last] - asked[first]), max(_shares(model)) * abs(asked[last])
        if abs(asked[last]) <= _CHANGE or speed_change_rpm <= 2.0 * band:
            continue
        end = float(times[groups[number + 1][0]]) if number + 1 < len(groups) else np.inf
        return _response(times, asked, turned, first, last, min(end, times[last] + _MOST), model)
    raise AnalysisError(
        tr("the spindle speed did not change in this time range; start the spindle from a program or in MDI"),
        "no-step",
    )


def _response(
    times: FloatArray,
    asked: FloatArray,
    turned: FloatArray,
    first: int,
    last: int,
    end: float,
    model: SpindleModel,
) -> SpindleResponse:
    target = asked[last]
    there = np.flatnonzero(
        (np.abs(turned - target) <= model.at_speed_tolerance * abs(target)) & (times >= times[last])
    )
    if len(there):
        end = min(end, float(times[there[0]]) + _BEHIND)
    cut = slice(
        int(np.searchsorted(times, times[first] - _BEFORE)), int(np.searchsorted(times, end, "right"))
    )
    t, a, b = times[cut] - times[last], asked[cut], turned[cut]
    steps = tuple(_stayed(analyze_step(t, a, b, share * abs(target)), t, model) for share in _shares(model))
    steady = b[t >= t[-1] - 1.0]
    return SpindleResponse(t, a, b, steps, float(np.ptp(steady)), float(steady.mean() - target), model)


def _shares(model: SpindleModel) -> tuple[float, ...]:
    return model.at_speed_tolerance, *TOLERANCE_RATIOS


def _stayed(step: StepResponse, times: FloatArray, model: SpindleModel) -> StepResponse:
    """Return the response with a settling time of nan if the speed did not stay within the tolerance."""
    if times[-1] - step.settling_time_s >= model.at_speed_time_s:
        return step
    return replace(step, settling_time_s=math.nan)


def draw_spindle_response(response: SpindleResponse) -> AnalysisDrawing:
    """Return the drawing of the commanded and the measured speed over time in seconds."""
    asked, turned = (
        np.column_stack([response.times_s, each]) for each in (response.commanded_rpm, response.measured_rpm)
    )
    names = Message("{title}  rpm", title=tr("SPINDLE")), "", "s"
    return AnalysisDrawing(
        asked, (turned,), has_equal_axes=False, has_upper_length_axis=False, axis_labels=names
    )


def make_spindle_table(title: str, response: SpindleResponse) -> TableContent:
    """Return the table of the response, with settling times for narrower tolerances."""
    step, model = response.step_responses[0], response.spindle_model
    target = float(response.commanded_rpm[-1])
    rows = (
        (
            tr("SPEED"),
            Message(
                "{target} → {target2} rpm",
                target=formats.format_fixed(target - step.step_size_mm, 0),
                target2=formats.format_fixed(target, 0),
            ),
        ),
        (tr("RISE, 10 TO 90 %"), _seconds(step.rise_time_s)),
        (
            tr("ACCELERATION"),
            Message(
                "{acceleration} rpm/s", acceleration=formats.format_fixed(response.acceleration_rpm_s, 0)
            ),
        ),
        (tr("OVERSHOOT"), f"{formats.format_fixed(100.0 * step.overshoot_fraction, 2)} %"),
        *(
            (
                tr(Message("TIME TO SETTLE WITHIN {share}", share=formats.format_percent(share))),
                _seconds(each.settling_time_s),
            )
            for share, each in zip(_shares(model), response.step_responses, strict=True)
        ),
        (
            tr("MEAN SPEED ERROR"),
            Message("{speed} rpm", speed=formats.format_fixed(response.mean_speed_error_rpm, 1)),
        ),
        (
            tr("SPEED VARIATION"),
            Message("{speed} rpm", speed=formats.format_fixed(response.speed_variation_rpm, 1)),
        ),
    )
    notes = (
        tr(
            Message(
                "The acceleration in the machine file is {accel} rpm/s; a speed within {share} "
                "of the target counts as reached.",
                accel=formats.format_fixed(model.acceleration_rpm_s, 0),
                share=formats.format_percent(model.at_speed_tolerance),
            )
        ),
        tr(
            "Mean error and variation are calculated from the last second. A dash means "
            "that the speed did not stay within the tolerance band."
        ),
        tr("Last change of spindle speed. These values are for information only; no setting was changed."),
    )
    return TableContent(
        title, ("", ""), _SHARES, tuple(map(TableRow, rows)), notes=notes, numeric_columns=frozenset({1})
    )


def _seconds(value: float) -> str:
    return f"{formats.format_fixed(value, 3)} s" if np.isfinite(value) else formats.NO_VALUE
