"""Result tables of the analyses, and the description above the drawing of a response."""

from __future__ import annotations

import math

from app.desk.pages.table_content import TableContent, TableRow
from app.desk.status import formats
from app.desk.translation import tr
from app.extras.analyses.analysis_result import Found
from app.extras.analyses.axis_response import make_response_table
from app.extras.analyses.drive_test_results import describe_test_path, make_results_table
from app.extras.analyses.spindle_response import make_spindle_table
from core.extras.analyses.path_error import BallBarResult
from core.extras.analyses.thread_passes import ThreadAnalysis, calculate_max_threading_rpm
from core.message import Message


def _length(mm: float, metric: bool) -> str:
    return f"{formats.format_length(mm, metric)} {tr('mm') if metric else tr('in')}"


def make_path_table(title: str, found: Found, metric: bool, marked: int) -> TableContent:
    """Return the table of the points with the largest path error."""
    path = found.path_error
    assert path is not None
    rows = tuple(
        TableRow(
            (
                str(each.line_number),
                *(formats.format_length(value, metric) for value in (each.distance_mm, *each.position)),
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
    number_columns = frozenset(range(1, len(heads)))
    return TableContent(
        title, heads, shares, rows, min(marked, len(rows) - 1), notes=notes, numeric_columns=number_columns
    )


def make_thread_table(
    title: str, thread: ThreadAnalysis, vmax: float, metric: bool, marked: int
) -> TableContent:
    """Return the table of the passes of a threading cycle."""
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
    limit = calculate_max_threading_rpm(thread.reference_lead_mm, vmax) if vmax else math.inf
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
    number_columns = frozenset({1, 2, 3, 4})
    return TableContent(
        title, heads, shares, rows, min(marked, len(rows) - 1), notes=notes, numeric_columns=number_columns
    )


def choose_response_table(title: str, found: Found, metric: bool) -> TableContent:
    """Return the table of the analyzed response: drive test, spindle or axis."""
    if found.drive_test_results is not None:
        return make_results_table(title, found.drive_test_results, metric)
    if found.spindle_response is not None:
        return make_spindle_table(title, found.spindle_response)
    if found.axis_response is not None:
        return make_response_table(title, found.axis_response, metric)
    return TableContent(title, ("",), (1.0,), ())


def describe_response(found: Found, metric: bool) -> str:
    """Return the description that is shown above the drawing of a response."""
    if found.drive_test_results is not None:
        return describe_test_path(found.drive_test_results.test_path, metric)
    if found.spindle_response is not None:
        return tr("last spindle speed change: commanded and actual speed over time in seconds")
    return tr("last move: commanded position, actual position and following error over time in seconds")


def make_ball_bar_table(title: str, ball: BallBarResult, found: Found, metric: bool) -> TableContent:
    """Return the table of a ball-bar plot."""
    u, v = found.axis_names

    def format_mm_per_meter(value: float) -> str:
        return (
            Message("{fixed} mm/m", fixed=formats.format_fixed(value, 3))
            if math.isfinite(value)
            else formats.NO_VALUE
        )

    def format_deviation(value: float) -> str:
        return _length(value, metric) if math.isfinite(value) else formats.NO_VALUE

    rows = (
        TableRow((tr("ROUNDNESS"), format_deviation(ball.circularity_mm))),
        TableRow((tr(Message("BACKLASH {axis}", axis=u)), format_deviation(ball.backlash_mm[0]))),
        TableRow((tr(Message("BACKLASH {axis}", axis=v)), format_deviation(ball.backlash_mm[1]))),
        TableRow((tr(Message("REVERSAL SPIKE {axis}", axis=u)), format_deviation(ball.reversal_spike_mm[0]))),
        TableRow((tr(Message("REVERSAL SPIKE {axis}", axis=v)), format_deviation(ball.reversal_spike_mm[1]))),
        TableRow((tr("SQUARENESS ERROR"), format_mm_per_meter(ball.squareness_error_mm_m))),
        TableRow(
            (
                tr(Message("SCALE OF {value} RELATIVE TO {v}", value=u, v=v)),
                format_mm_per_meter(ball.scale_error_mm_m),
            )
        ),
        TableRow((tr("RADIUS ERROR"), format_deviation(ball.size_error_mm))),
    )
    number, count, line = found.selected_arc
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
    return TableContent(title, ("", ""), (0.52, 0.48), rows, notes=notes, numeric_columns=frozenset({1}))
