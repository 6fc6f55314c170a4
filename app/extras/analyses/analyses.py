"""Analyses of a scope record: path error, screw thread, ball-bar plot, axis or spindle response.

An analysis uses the frozen curves of the scope. If the scope is not frozen, it uses the last program run in
the live samples. A worker calculates the results. If an analysis has no result, the page shows the reason.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import combinations
from operator import itemgetter

import numpy as np
import numpy.typing as npt

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import ROW_STEPS, TableContent
from app.desk.translation import tr
from app.extras.analyses.analysis_result import AnalysisKind, Found
from app.extras.analyses.analysis_tables import (
    choose_response_table,
    describe_response,
    make_ball_bar_table,
    make_path_table,
    make_thread_table,
)
from app.extras.analyses.axis_response import draw_response, find_last_move
from app.extras.analyses.drawing import AnalysisDrawing
from app.extras.analyses.drive_test_results import calculate_test_results, find_test_path
from app.extras.analyses.spindle_response import draw_spindle_response, find_last_speed_change
from app.scope.scope_model import ScopeModel
from core.extras.analyses.path_error import (
    analyze_ball_bar,
    calculate_path_error_from_samples,
    find_arcs,
    find_worst_deviations,
)
from core.extras.analyses.thread_passes import analyze_thread
from core.machine.machine_model import Axis, SpindleModel
from core.message import Message
from core.records.record import AnalysisError, ScopeRecord

FloatArray = npt.NDArray[np.float64]
MAX_POINTS = 6000  # that are drawn of a path
MAGNIFICATIONS = (10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0)
_PAUSE = 2.0  # s without a line that end a run of the program
_WORST = 12


@dataclass(slots=True)
class AnalysesModel:
    """Model of the analyses page.

    ``selected_row`` is the index of the selected row in the result table. ``magnification`` is the factor
    by which the drawing enlarges path errors.
    """

    scope: ScopeModel
    linear_axes: Mapping[str, Axis] = field(default_factory=dict)  # by letter
    spindle: SpindleModel | None = None
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("editing-analyses"))
    analysis_kind: AnalysisKind = AnalysisKind.PATH
    arc_index: int = 0
    magnification: float = 100.0
    selected_row: int = 0
    result: Found | None = None
    _of: object = None

    @property
    def desk(self) -> Desk:
        """Return the TurnDesk model, which shows messages to the operator."""
        return self.scope.desk

    # --- what is asked -------------------------------------------------------------------------------

    def restart_analysis(self) -> None:
        """Discard the result, so that the current data are analyzed again."""
        self._of = None
        self.result = None

    def choose_analysis(self, kind: AnalysisKind) -> None:
        """Select an analysis. Selecting the current analysis again repeats it with newer samples."""
        self.desk.clear_prompt_line()
        self.analysis_kind, self.arc_index, self.selected_row = kind, 0, 0
        self.restart_analysis()

    def select_next_arc(self) -> None:
        """Select the next arc of the record.

        If another type of analysis is selected, this method selects the ball-bar analysis instead.
        """
        self.desk.clear_prompt_line()
        if self.analysis_kind is not AnalysisKind.BALL_BAR:
            self.choose_analysis(AnalysisKind.BALL_BAR)
            return
        self.arc_index += 1
        self.restart_analysis()

    def change_magnification(self, steps: int) -> None:
        """Increase or decrease the magnification of the path errors by a number of steps."""
        at = min(range(len(MAGNIFICATIONS)), key=lambda i: abs(MAGNIFICATIONS[i] - self.magnification))
        self.magnification = MAGNIFICATIONS[max(0, min(len(MAGNIFICATIONS) - 1, at + steps))]

    def handle_key(self, key: str) -> bool:
        """Select a table row with an arrow key, and return whether the key was used."""
        count = len(self.make_table().rows)
        if key not in ROW_STEPS or not count:
            return False
        self.select_row(self.selected_row + ROW_STEPS[key])
        return True

    def select_row(self, row: int) -> None:
        """Select a row of the table. The drawing then marks the position of that row."""
        self.selected_row = max(0, min(len(self.make_table().rows) - 1, row))

    def update(self) -> None:
        """Process the result of the worker, and start the selected analysis.

        This method is called once per frame. Each analysis is started only once.
        """
        self.worker.deliver_results()
        if self._of is None and not self.worker.is_busy:
            kind, arc, drives, spindle = self.analysis_kind, self.arc_index, self.linear_axes, self.spindle
            self._of = (kind, arc)
            frozen, window, live = self.scope.frozen_curves, self.scope.time_window, self.scope.live_samples

            def run_analysis(_request: object) -> Found:
                if frozen is not None:
                    begin, end = frozen.zero_time_s + window.begin_s, frozen.zero_time_s + window.end_s
                    return analyze_record(
                        kind, frozen.record.select_time_range(begin, end), arc, drives, spindle
                    )
                if live is None or not math.isfinite(live.newest_time_s):
                    return Found(kind, tr("NO SCOPE DATA ON THIS MACHINE. F9: OPEN A SCOPE RECORD"))
                names = {each.name for each in live.channels if each.unit in {"mm", "deg"}}
                names |= {"line", "spindle turns", "spindle speed", "spindle command"}
                record = live.read_samples_between(
                    live.newest_time_s - live.buffer_duration_s, live.newest_time_s, names
                )
                cut = (
                    record
                    if kind in {AnalysisKind.AXIS_RESPONSE, AnalysisKind.SPINDLE_RESPONSE}
                    else find_last_program_run(record)
                )
                return analyze_record(kind, cut, arc, drives, spindle)

            self.worker.request_work(run_analysis, self._take, self.desk.say)

    def _take(self, found: Found) -> None:
        if found.analysis_kind is self.analysis_kind:
            self.result = found

    def close(self) -> None:
        """Stop the worker."""
        self.worker.close()

    # --- what is shown -------------------------------------------------------------------------------

    def make_drawing(self) -> AnalysisDrawing:
        """Return the drawing of the result, or an empty drawing if there is no result."""
        found = self.result
        if found is None or found.unavailable_reason:
            return AnalysisDrawing()
        if found.path_error is not None:
            return _path_drawing(found, self.magnification, self.selected_row)
        if found.thread_analysis is not None:
            return _thread_drawing(found)
        if found.ball_bar_result is not None:
            return _ball_drawing(found, self.magnification)
        return _response_drawing(found)

    def make_table(self) -> TableContent:
        """Return the table of the result."""
        found, metric = self.result, self.scope.metric
        title = tr(self.analysis_kind.value)
        if found is None:
            return TableContent(title, ("",), (1.0,), (), notes=(tr("CALCULATING …"),))
        if found.path_error is not None:
            return make_path_table(title, found, metric, self.selected_row)
        if found.thread_analysis is not None:
            return make_thread_table(
                title, found.thread_analysis, found.max_speed_mm_s, metric, self.selected_row
            )
        if found.ball_bar_result is not None:
            return make_ball_bar_table(title, found.ball_bar_result, found, metric)
        return choose_response_table(title, found, metric)

    @property
    def description(self) -> str:
        """Return the text above the drawing, which describes the analyzed data."""
        found = self.result
        if found is None:
            return tr("CALCULATING …")
        if found.unavailable_reason:
            return found.unavailable_reason
        if found.thread_analysis is not None:
            return tr("thread passes overlaid by spindle angle: deviation from the thread, and spindle speed")
        if found.analysis_kind in {AnalysisKind.AXIS_RESPONSE, AnalysisKind.SPINDLE_RESPONSE}:
            return describe_response(found, self.scope.metric)
        return tr(
            Message("error magnified {times}x; press Z to change the scale", times=f"{self.magnification:g}")
        )


def find_last_program_run(record: ScopeRecord) -> ScopeRecord:
    """Return the part of a record that contains the last program run.

    If the record contains no program run, the whole record is returned.
    """
    lines = record.values_by_channel.get("line")
    if lines is None or not (lines > 0).any():
        return record
    on = np.flatnonzero(lines > 0)
    times = record.times_s[on]
    gaps = np.flatnonzero(np.diff(times) > _PAUSE)
    first = on[gaps[-1] + 1] if len(gaps) else on[0]
    return record.select_time_range(float(record.times_s[first]), float(record.times_s[on[-1]]))


def analyze_record(
    kind: AnalysisKind,
    record: ScopeRecord,
    arc_number: int,
    linear_axes: Mapping[str, Axis],
    spindle: SpindleModel | None = None,
) -> Found:
    """Return the result of an analysis.

    If the analysis is not possible, ``unavailable_reason`` of the result contains the reason.
    """
    try:
        if kind is AnalysisKind.SPINDLE_RESPONSE:
            return Found(kind, spindle_response=find_last_speed_change(record, spindle))
        return _analysed(kind, record, arc_number, linear_axes)
    except AnalysisError as error:
        return Found(kind, str(error))


def _analysed(kind: AnalysisKind, record: ScopeRecord, arc: int, drives: Mapping[str, Axis]) -> Found:
    if kind is AnalysisKind.AXIS_RESPONSE:
        played = find_test_path(record)
        if played is not None:
            return Found(kind, drive_test_results=calculate_test_results(record, played, drives))
        return Found(kind, axis_response=find_last_move(record, drives))
    columns = record.values_by_channel
    letters = [each.name[0] for each in record.channels if each.name[1:] == " demand" and each.unit == "mm"]
    if len(letters) < 2 or not len(record.times_s):
        raise AnalysisError(
            tr("a path needs two linear axes, but the record contains fewer than two"), "no-path"
        )
    slides = ("Z", "X") if set(letters) == {"X", "Z"} else tuple(sorted(letters))
    demand = np.column_stack([columns[Message("{item} demand", item=each)] for each in slides])
    actual = np.column_stack([columns[Message("{item} actual", item=each)] for each in slides])
    lines = columns.get("line", np.zeros(len(record.times_s)))
    axes = _select_drawn_axes(slides, demand)
    if kind is AnalysisKind.PATH:
        path = calculate_path_error_from_samples(demand, actual, lines, record.sampling_rate_hz)
        return Found(
            kind,
            path_error=path,
            worst_deviations=find_worst_deviations(path, _WORST),
            axis_names=axes,
            linear_axes=slides,
        )
    if kind is AnalysisKind.THREAD:
        speed = columns.get("spindle speed", np.full(len(lines), np.nan))
        turns = columns.get("spindle turns", np.full(len(lines), np.nan))
        vmax = drives[axes[0]].max_speed if axes[0] in drives else 0.0
        thread = analyze_thread(turns, actual[:, 0], actual[:, 1], speed)
        speeds = tuple(speed[each.first_sample : each.last_sample + 1] for each in thread.passes)
        return Found(
            kind, thread_analysis=thread, pass_speeds_rpm=speeds, max_speed_mm_s=vmax, axis_names=axes
        )
    return _analyze_ball_bar(slides, demand, actual, np.where(np.isfinite(lines), lines, 0.0), arc)


def _analyze_ball_bar(
    slides: tuple[str, ...], setpoints: FloatArray, actual: FloatArray, lines: FloatArray, arc: int
) -> Found:
    """Return the ball-bar result of an arc, which can be in the plane of any two axes.

    ``arc`` is the index of the arc, counted from 0. An index after the last arc selects the first arc
    again.
    """
    arcs = [
        (cut.start, line, cut, pair)
        for pair in combinations(range(len(slides)), 2)
        for line, cut in find_arcs(setpoints[:, pair], lines)
    ]
    if not arcs:
        raise AnalysisError(
            tr(
                "this time range does not contain an arc of 60 degrees or more; cut an arc of "
                "this size while recording"
            ),
            "no-arc",
        )
    arcs.sort(key=itemgetter(0))
    number = arc % len(arcs)
    _, line, cut, pair = arcs[number]
    part = setpoints[cut][:, pair]
    moved = np.append(True, (np.abs(np.diff(part, axis=0)) > 1e-9).any(axis=1))
    ball = analyze_ball_bar(part[moved], actual[cut][:, pair][moved])
    axes = slides[pair[0]], slides[pair[1]]
    return Found(
        AnalysisKind.BALL_BAR, ball_bar_result=ball, selected_arc=(number, len(arcs), line), axis_names=axes
    )


def _select_drawn_axes(slides: tuple[str, ...], setpoints: FloatArray) -> tuple[str, str]:
    """Return the two axes with the longest travel. A path in three axes is projected onto their plane."""
    least = int(np.argmin(np.ptp(setpoints, axis=0))) if len(slides) > 2 else -1
    first, second = (each for number, each in enumerate(slides) if number != least)
    return first, second


# --- drawings -------------------------------------------------------------------------------------------


def _thinned(points: FloatArray, most: int = MAX_POINTS) -> FloatArray:
    return points[:: max(1, math.ceil(len(points) / most))]


def _path_drawing(found: Found, factor: float, marked: int) -> AnalysisDrawing:
    path = found.path_error
    assert path is not None
    seen = [found.linear_axes.index(each) for each in found.axis_names]
    marks: tuple[tuple[float, float, str], ...] = ()
    if marked < len(found.worst_deviations):
        worst = found.worst_deviations[marked]
        place = path.magnify_deviation(factor)[worst.sample_index][seen]
        marks = ((float(place[0]), float(place[1]), tr(Message("line {line}", line=worst.line_number))),)
    soft, curve = (
        _thinned(path.nearest_path_points[:, seen]),
        _thinned(path.magnify_deviation(factor)[:, seen]),
    )
    return AnalysisDrawing(soft, (curve,), (), marks, axis_labels=_axis_names(found))


def _axis_names(found: Found) -> tuple[str, str, str]:
    across, up = (f"{letter}  {{unit}}" for letter in found.axis_names)
    return up, "", across


def _thread_drawing(found: Found) -> AnalysisDrawing:
    assert found.thread_analysis is not None
    curves = tuple(
        _thinned(np.column_stack([each.spindle_revolutions, each.deviations_mm]))
        for each in found.thread_analysis.passes[:8]
    )
    below = tuple(
        _thinned(np.column_stack([each.spindle_revolutions, speed]))
        for each, speed in zip(found.thread_analysis.passes[:8], found.pass_speeds_rpm, strict=False)
        if np.isfinite(speed).all()
    )
    names = tr("THREAD DEVIATION") + "  {unit}", Message("{title}  rpm", title=tr("SPINDLE")), tr("turns")
    return AnalysisDrawing(upper_curves=curves, lower_curves=below, has_equal_axes=False, axis_labels=names)


def _response_drawing(found: Found) -> AnalysisDrawing:
    if found.spindle_response is not None:
        return draw_spindle_response(found.spindle_response)
    move = found.drive_test_results.motion if found.drive_test_results is not None else found.axis_response
    return draw_response(move) if move is not None else AnalysisDrawing()


def _ball_drawing(found: Found, factor: float) -> AnalysisDrawing:
    ball = found.ball_bar_result
    assert ball is not None
    angles = np.radians(ball.angles_deg)
    out = np.column_stack([np.cos(angles), np.sin(angles)])
    seen = (ball.radius_mm + factor * ball.deviations_mm)[:, None] * out
    return AnalysisDrawing(_thinned(ball.radius_mm * out), (_thinned(seen),), axis_labels=_axis_names(found))
