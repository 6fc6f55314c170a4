"""Analyses of a record: path error, thread passes, ball-bar plot of an arc, response of axis and spindle.

They take what the scope shows frozen, or of live samples the last program that ran. A worker works them out;
what cannot be told is a sentence.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import Enum
from itertools import combinations
from operator import itemgetter

import numpy as np
import numpy.typing as npt

from app.desk.background_work import LatestRequestWorker
from app.desk.desk import Desk
from app.desk.pages.table_content import ROW_STEPS, TableContent, TableRow
from app.desk.status import formats
from app.desk.translation import tr
from app.extras.analyses.axis_response import AxisResponse, draw_response, find_last_move, make_response_table
from app.extras.analyses.drawing import AnalysisDrawing
from app.extras.analyses.drive_test_results import (
    DriveTestResults,
    calculate_results,
    describe_test_path,
    find_test_path,
    make_results_table,
)
from app.extras.analyses.spindle_response import (
    SpindleResponse,
    draw_spindle_response,
    find_last_run_up,
    make_spindle_table,
)
from app.scope.scope_model import ScopeModel
from core.extras.analyses.path_error import (
    BallBarResult,
    PathError,
    WorstDeviation,
    analyze_ball_bar,
    calculate_from_samples,
    find_arcs,
    find_worst_deviations,
)
from core.extras.analyses.thread_passes import ThreadAnalysis, analyze_thread, calculate_max_rpm
from core.machine.machine_model import Axis, SpindleModel
from core.message import Message
from core.records.record import AnalysisError, ScopeRecord

FloatArray = npt.NDArray[np.float64]
MAX_POINTS = 6000  # that are drawn of a path
MAGNIFICATIONS = (10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0)
_PAUSE = 2.0  # s without a line that end a run of the program
_WORST = 12


class AnalysisKind(Enum):
    """What is looked for."""

    PATH = "PATH ERROR"
    THREAD = "THREAD"
    BALL_BAR = "BALL BAR"
    AXIS_RESPONSE = "RESPONSE"
    SPINDLE_RESPONSE = "SPINDLE"


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What an analysis has found: one of the three, or ``missing_reason`` there is nothing."""

    kind: AnalysisKind
    missing_reason: str = ""
    path_error: PathError | None = None
    worst_deviations: tuple[WorstDeviation, ...] = ()
    thread: ThreadAnalysis | None = None
    pass_speeds_rpm: tuple[FloatArray, ...] = ()  # of the passes, rpm
    ball_bar: BallBarResult | None = None
    axis_response: AxisResponse | None = None
    spindle_response: SpindleResponse | None = None
    drive_test: DriveTestResults | None = None  # the record is one of a drive test
    arc_selection: tuple[int, int, int] = (0, 0, 0)  # its number, of how many, its line
    max_speed_mm_s: float = 0.0  # of the slide along a thread, mm/s
    axis_names: tuple[str, str] = ("Z", "X")  # that are drawn
    linear_axes: tuple[str, ...] = ("Z", "X")  # of a path: all that it goes in


@dataclass(slots=True)
class AnalysesModel:
    """``marked`` row of the table, ``magnified`` how many times an error is drawn larger."""

    scope: ScopeModel
    linear_axes: Mapping[str, Axis] = field(default_factory=dict)  # by letter
    spindle: SpindleModel | None = None
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("editing-analyses"))
    kind: AnalysisKind = AnalysisKind.PATH
    arc_index: int = 0
    magnification: float = 100.0
    selected_row: int = 0
    result: Found | None = None
    _of: object = None

    @property
    def desk(self) -> Desk:
        """Where answers are said."""
        return self.scope.desk

    # --- what is asked -------------------------------------------------------------------------------

    def opened(self) -> None:
        """The page comes up: look at what there is now."""
        self._of = None
        self.result = None

    def choose_analysis(self, kind: AnalysisKind) -> None:
        """Another analysis; the same again takes newer samples."""
        self.desk.clear_prompt_line()
        self.kind, self.arc_index, self.selected_row = kind, 0, 0
        self.opened()

    def select_next_arc(self) -> None:
        """The next arc of the record."""
        self.desk.clear_prompt_line()
        if self.kind is not AnalysisKind.BALL_BAR:
            self.choose_analysis(AnalysisKind.BALL_BAR)
            return
        self.arc_index += 1
        self.opened()

    def change_magnification(self, steps: int) -> None:
        """Draw the error larger or smaller."""
        at = min(range(len(MAGNIFICATIONS)), key=lambda i: abs(MAGNIFICATIONS[i] - self.magnification))
        self.magnification = MAGNIFICATIONS[max(0, min(len(MAGNIFICATIONS) - 1, at + steps))]

    def typed(self, key: str) -> bool:
        """Arrows mark a row."""
        count = len(self.make_table().rows)
        if key not in ROW_STEPS or not count:
            return False
        self.select_row(self.selected_row + ROW_STEPS[key])
        return True

    def select_row(self, row: int) -> None:
        """The drawing shows where it is."""
        self.selected_row = max(0, min(len(self.make_table().rows) - 1, row))

    def update(self) -> None:
        """Once a frame: what the worker has found; it is asked once."""
        self.worker.poll()
        if self._of is None and not self.worker.is_busy:
            kind, arc, drives, spindle = self.kind, self.arc_index, self.linear_axes, self.spindle
            self._of = (kind, arc)
            frozen, window, live = self.scope.frozen_curves, self.scope.time_window, self.scope.live_samples

            def work(_request: object) -> Found:
                if frozen is not None:
                    begin, end = frozen.zero_s + window.begin_s, frozen.zero_s + window.end_s
                    return analyze(kind, frozen.record.select_between(begin, end), arc, drives, spindle)
                if live is None or not math.isfinite(live.newest_time_s):
                    return Found(kind, tr("NO SCOPE DATA ON THIS MACHINE. F9: OPEN A SCOPE RECORD"))
                names = {each.name for each in live.channels if each.unit in {"mm", "deg"}}
                names |= {"line", "spindle turns", "spindle speed", "spindle command"}
                record = live.read_between(
                    live.newest_time_s - live.buffer_length_s, live.newest_time_s, names
                )
                cut = (
                    record
                    if kind in {AnalysisKind.AXIS_RESPONSE, AnalysisKind.SPINDLE_RESPONSE}
                    else find_last_run(record)
                )
                return analyze(kind, cut, arc, drives, spindle)

            self.worker.request(work, self._take, self.desk.say)

    def _take(self, found: Found) -> None:
        if found.kind is self.kind:
            self.result = found

    def close(self) -> None:
        """End the worker."""
        self.worker.close()

    # --- what is shown -------------------------------------------------------------------------------

    def make_drawing(self) -> AnalysisDrawing:
        """Lines of what was found."""
        found = self.result
        if found is None or found.missing_reason:
            return AnalysisDrawing()
        if found.path_error is not None:
            return _path_drawing(found, self.magnification, self.selected_row)
        if found.thread is not None:
            return _thread_drawing(found)
        if found.ball_bar is not None:
            return _ball_drawing(found, self.magnification)
        return _response_drawing(found)

    def make_table(self) -> TableContent:
        """Figures of what was found."""
        found, metric = self.result, self.scope.metric
        title = tr(self.kind.value)
        if found is None:
            return TableContent(title, ("",), (1.0,), (), notes=(tr("CALCULATING …"),))
        if found.path_error is not None:
            return _path_sheet(title, found, metric, self.selected_row)
        if found.thread is not None:
            return _thread_sheet(title, found.thread, found.max_speed_mm_s, metric, self.selected_row)
        if found.ball_bar is not None:
            return _ball_sheet(title, found.ball_bar, found, metric)
        return _response_sheet(title, found, metric)

    @property
    def description(self) -> str:
        """What is looked at, above the drawing."""
        found = self.result
        if found is None:
            return tr("CALCULATING …")
        if found.missing_reason:
            return found.missing_reason
        if found.thread is not None:
            return tr("thread passes overlaid by spindle angle: deviation from the thread, and spindle speed")
        if found.kind in {AnalysisKind.AXIS_RESPONSE, AnalysisKind.SPINDLE_RESPONSE}:
            return _response_words(found, self.scope.metric)
        return tr(
            Message("error magnified {times}x; press Z to change the scale", times=f"{self.magnification:g}")
        )


def find_last_run(record: ScopeRecord) -> ScopeRecord:
    """Of samples the last stretch in which lines of a program were executed; all of it where none were."""
    lines = record.values_by_channel.get("line")
    if lines is None or not (lines > 0).any():
        return record
    on = np.flatnonzero(lines > 0)
    times = record.times_s[on]
    gaps = np.flatnonzero(np.diff(times) > _PAUSE)
    first = on[gaps[-1] + 1] if len(gaps) else on[0]
    return record.select_between(float(record.times_s[first]), float(record.times_s[on[-1]]))


def analyze(
    kind: AnalysisKind,
    record: ScopeRecord,
    arc: int,
    linear_axes: Mapping[str, Axis],
    spindle: SpindleModel | None = None,
) -> Found:
    """Work it out; what cannot be is told by ``missing_reason``."""
    try:
        if kind is AnalysisKind.SPINDLE_RESPONSE:
            return Found(kind, spindle_response=find_last_run_up(record, spindle))
        return _analysed(kind, record, arc, linear_axes)
    except AnalysisError as error:
        return Found(kind, str(error))


def _analysed(kind: AnalysisKind, record: ScopeRecord, arc: int, drives: Mapping[str, Axis]) -> Found:
    if kind is AnalysisKind.AXIS_RESPONSE:
        played = find_test_path(record)
        if played is not None:
            return Found(kind, drive_test=calculate_results(record, played, drives))
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
        path = calculate_from_samples(demand, actual, lines, record.sampling_rate_hz)
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
        vmax = drives[axes[0]].vmax if axes[0] in drives else 0.0
        thread = analyze_thread(turns, actual[:, 0], actual[:, 1], speed)
        speeds = tuple(speed[each.first_sample : each.last_sample + 1] for each in thread.passes)
        return Found(kind, thread=thread, pass_speeds_rpm=speeds, max_speed_mm_s=vmax, axis_names=axes)
    return _analyze_ball_bar(slides, demand, actual, np.where(np.isfinite(lines), lines, 0.0), arc)


def _analyze_ball_bar(
    slides: tuple[str, ...], setpoints: FloatArray, actual: FloatArray, lines: FloatArray, arc: int
) -> Found:
    """The arc of this number, in whichever plane of two slides it lies."""
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
        AnalysisKind.BALL_BAR, ball_bar=ball, arc_selection=(number, len(arcs), line), axis_names=axes
    )


def _select_drawn_axes(slides: tuple[str, ...], setpoints: FloatArray) -> tuple[str, str]:
    """The two slides that went furthest: a path of three is drawn as it is seen along the third."""
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
        marks = ((float(place[0]), float(place[1]), tr(Message("line {line}", line=worst.line))),)
    soft, curve = (
        _thinned(path.nearest_path_points[:, seen]),
        _thinned(path.magnify_deviation(factor)[:, seen]),
    )
    return AnalysisDrawing(soft, (curve,), (), marks, axis_labels=_axis_names(found))


def _axis_names(found: Found) -> tuple[str, str, str]:
    across, up = (f"{letter}  {{unit}}" for letter in found.axis_names)
    return up, "", across


def _thread_drawing(found: Found) -> AnalysisDrawing:
    assert found.thread is not None
    curves = tuple(
        _thinned(np.column_stack([each.spindle_revolutions, each.deviations_mm]))
        for each in found.thread.passes[:8]
    )
    below = tuple(
        _thinned(np.column_stack([each.spindle_revolutions, speed]))
        for each, speed in zip(found.thread.passes[:8], found.pass_speeds_rpm, strict=False)
        if np.isfinite(speed).all()
    )
    names = tr("THREAD DEVIATION") + "  {unit}", Message("{title}  rpm", title=tr("SPINDLE")), tr("turns")
    return AnalysisDrawing(curves=curves, lower_curves=below, has_equal_axes=False, axis_labels=names)


def _response_drawing(found: Found) -> AnalysisDrawing:
    if found.spindle_response is not None:
        return draw_spindle_response(found.spindle_response)
    move = found.drive_test.motion if found.drive_test is not None else found.axis_response
    return draw_response(move) if move is not None else AnalysisDrawing()


def _ball_drawing(found: Found, factor: float) -> AnalysisDrawing:
    ball = found.ball_bar
    assert ball is not None
    angles = np.radians(ball.angles_deg)
    out = np.column_stack([np.cos(angles), np.sin(angles)])
    seen = (ball.radius_mm + factor * ball.deviations_mm)[:, None] * out
    return AnalysisDrawing(_thinned(ball.radius_mm * out), (_thinned(seen),), axis_labels=_axis_names(found))


# --- figures --------------------------------------------------------------------------------------------


def _length(mm: float, metric: bool) -> str:
    return f"{formats.format_length(mm, metric)} {tr('mm') if metric else tr('in')}"


def _path_sheet(title: str, found: Found, metric: bool, marked: int) -> TableContent:
    path = found.path_error
    assert path is not None
    rows = tuple(
        TableRow(
            (
                str(each.line),
                *(formats.format_length(way, metric) for way in (each.distance_mm, *each.position)),
            )
        )
        for each in found.worst_deviations
    )
    lathe = len(found.linear_axes) == 2
    notes = (
        tr(Message("Largest error: {distance}", distance=_length(path.max_distance_mm, metric))),
        *((tr("Positive values are to the left of the direction of travel."),) if lathe else ()),
        tr("The table shows the worst point of each line."),
        tr("Axis positions are measured from home, X as a radius.")
        if lathe
        else tr("Axis positions are measured from home."),
    )
    heads = (tr("LINE"), tr("PATH DEVIATION"), *found.linear_axes)
    shares = (0.16, 0.3, 0.27, 0.27) if lathe else (0.11, 0.23, 0.22, 0.22, 0.22)
    figures = frozenset(range(1, len(heads)))
    return TableContent(
        title, heads, shares, rows, min(marked, len(rows) - 1), notes=notes, number_columns=figures
    )


def _thread_sheet(title: str, thread: ThreadAnalysis, vmax: float, metric: bool, marked: int) -> TableContent:
    rows = tuple(
        TableRow(
            (
                str(number),
                formats.format_length(abs(each.depth_mm - thread.passes[0].depth_mm), metric),
                f"{formats.format_fixed(each.entry_angle_deg, 2)}°",
                formats.format_length(each.lead_mm - thread.reference_lead_mm, metric),
                formats.format_fixed(each.speed_drop_rpm, 0),
            )
        )
        for number, each in enumerate(thread.passes, 1)
    )
    limit = calculate_max_rpm(thread.reference_lead_mm, vmax) if vmax else math.inf
    notes = (
        tr(Message("Lead: {lead} per revolution", lead=_length(abs(thread.reference_lead_mm), metric))),
        tr(
            Message(
                "The thread entry angles agree within {angle}°",
                angle=formats.format_fixed(thread.entry_spread_deg, 2),
            )
        ),
        tr("Flank infeed shifts the entry angle with the depth."),
        tr(Message("The axis is fast enough to cut this lead at up to {rpm} rpm", rpm=formats.rpm(limit))),
    )
    heads = (tr("PASS"), tr("ADDED DEPTH"), tr("ENTRY ANGLE"), tr("LEAD ERROR"), tr("RPM DROP"))
    shares = (0.12, 0.24, 0.2, 0.24, 0.2)
    figures = frozenset({1, 2, 3, 4})
    return TableContent(
        title, heads, shares, rows, min(marked, len(rows) - 1), notes=notes, number_columns=figures
    )


def _response_sheet(title: str, found: Found, metric: bool) -> TableContent:
    if found.drive_test is not None:
        return make_results_table(title, found.drive_test, metric)
    if found.spindle_response is not None:
        return make_spindle_table(title, found.spindle_response)
    if found.axis_response is not None:
        return make_response_table(title, found.axis_response, metric)
    return TableContent(title, ("",), (1.0,), ())


def _response_words(found: Found, metric: bool) -> str:
    if found.drive_test is not None:
        return describe_test_path(found.drive_test.test_path, metric)
    if found.spindle_response is not None:
        return tr("last spindle speed change: commanded and actual speed over time in seconds")
    return tr("last move: commanded position, actual position and following error over time in seconds")


def _ball_sheet(title: str, ball: BallBarResult, found: Found, metric: bool) -> TableContent:
    u, v = found.axis_names

    def lean(value: float) -> str:
        return (
            Message("{fixed} mm/m", fixed=formats.format_fixed(value, 3))
            if math.isfinite(value)
            else formats.NO_VALUE
        )

    def told(value: float) -> str:
        return _length(value, metric) if math.isfinite(value) else formats.NO_VALUE

    rows = (
        TableRow((tr("ROUNDNESS"), told(ball.circularity_mm))),
        TableRow((tr(Message("BACKLASH {axis}", axis=u)), told(ball.backlash_mm[0]))),
        TableRow((tr(Message("BACKLASH {axis}", axis=v)), told(ball.backlash_mm[1]))),
        TableRow((tr(Message("REVERSAL SPIKE {axis}", axis=u)), told(ball.reversal_spike_mm[0]))),
        TableRow((tr(Message("REVERSAL SPIKE {axis}", axis=v)), told(ball.reversal_spike_mm[1]))),
        TableRow((tr("SQUARENESS ERROR"), lean(ball.squareness_error_mm_m))),
        TableRow(
            (tr(Message("SCALE OF {value} RELATIVE TO {v}", value=u, v=v)), lean(ball.scale_error_mm_m))
        ),
        TableRow((tr("RADIUS ERROR"), told(ball.size_error_mm))),
    )
    number, count, line = found.arc_selection
    notes = (
        tr(
            Message(
                "Line {line}, arc {number} of {count}: radius {radius}, {angle}°",
                line=line,
                number=number + 1,
                count=count,
                radius=_length(ball.radius_mm, metric),
                angle=formats.format_fixed(ball.arc_angle_deg, 0),
            )
        ),
        tr("A dash means that the arc is too short to calculate the value."),
        tr("The encoder cannot measure backlash between the encoder and the tool."),
    )
    return TableContent(title, ("", ""), (0.52, 0.48), rows, notes=notes, number_columns=frozenset({1}))


def scale_drawing(drawing: AnalysisDrawing, factor: float) -> AnalysisDrawing:
    """In another unit of length, both ways of equal axes, else upwards."""
    by = np.array([factor if drawing.has_equal_axes else 1.0, factor if drawing.is_length else 1.0])
    marks = tuple((x * by[0], y * by[1], word) for x, y, word in drawing.labeled_points)
    curves = tuple(each * by for each in drawing.curves)
    below = (
        tuple(each * by for each in drawing.lower_curves) if drawing.is_lower_length else drawing.lower_curves
    )
    unit = "mm" if factor == 1.0 else tr("in")
    upper, lower, across = (each.replace("{unit}", unit) for each in drawing.axis_labels)
    soft, names = drawing.command_points * by, (upper, lower, across)
    return replace(
        drawing,
        command_points=soft,
        curves=curves,
        labeled_points=marks,
        lower_curves=below,
        axis_labels=names,
    )
