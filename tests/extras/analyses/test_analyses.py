"""The analyses page: what is worked out of a record, told in figures and drawn."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from app.extras.analyses.analyses import AnalysesModel, analyze_record, find_last_program_run
from app.extras.analyses.analysis_result import AnalysisKind
from app.extras.analyses.drawing import scale_drawing
from tests.scope.played_record import record_of, seconds
from tests.texts import text


def turned_arc() -> object:
    """Line 4 is a whole circle of 10 mm in four seconds; X lags by a play of .02 mm."""
    times = seconds(0.0, 6.0)
    angle = 2.0 * np.pi * np.clip((times - 1.0) / 4.0, 0.0, 1.0)
    x, z = 30.0 + 10.0 * np.sin(angle), -50.0 + 10.0 * np.cos(angle)
    play = 0.01 * np.sign(np.gradient(x))
    line = np.where((times >= 1.0) & (times <= 5.0), 4.0, 0.0)
    return record_of(times, X_demand=x, X_actual=x - play, Z_demand=z, Z_actual=z, line=line)


def test_ball_bar_analysis_finds_the_arc_of_a_record() -> None:
    found = analyze_record(AnalysisKind.BALL_BAR, turned_arc(), 0, {})  # type: ignore[arg-type]
    assert found.ball_bar_result is not None
    assert found.selected_arc == (0, 1, 4)
    assert found.ball_bar_result.radius_mm == pytest.approx(10.0, abs=1e-3)
    assert found.ball_bar_result.backlash_mm == pytest.approx((0.0, 0.02), abs=3e-4)  # Z, X


def test_path_error_is_assigned_to_its_program_line() -> None:
    found = analyze_record(AnalysisKind.PATH, turned_arc(), 0, {})  # type: ignore[arg-type]
    assert [each.line_number for each in found.worst_deviations] == [4]
    assert abs(found.worst_deviations[0].distance_mm) == pytest.approx(
        0.01, abs=1e-4
    )  # the play where X goes radially


def test_path_error_table_shows_the_axis_positions() -> None:
    page = AnalysesModel(SimpleNamespace(metric=True))  # type: ignore[arg-type]
    page.result = analyze_record(AnalysisKind.PATH, turned_arc(), 0, {})  # type: ignore[arg-type]
    sheet = page.make_table()
    (line, _off, z, x), heads = sheet.rows[0].cells, sheet.column_heads
    assert (line, heads[2:]) == ("4", ("Z", "X"))
    assert float(z.replace("\u2212", "-")) == pytest.approx(
        -50.0, abs=0.3
    )  # X is radial there: at 40 or at 20
    assert abs(float(x) - 30.0) == pytest.approx(10.0, abs=0.1)
    page.close()


def milled_arc() -> object:
    """Of a mill: line 4 is a circle of 10 mm in X and Y at Z -8. Y has a play of .02 mm, Z is .004 low."""
    times = seconds(0.0, 6.0)
    angle = 2.0 * np.pi * np.clip((times - 1.0) / 4.0, 0.0, 1.0)
    x, y, z = 30.0 + 10.0 * np.cos(angle), 50.0 + 10.0 * np.sin(angle), np.full(len(times), -8.0)
    play = 0.01 * np.sign(np.gradient(y))
    line = np.where((times >= 1.0) & (times <= 5.0), 4.0, 0.0)
    return record_of(
        times,
        X_demand=x,
        X_actual=x,
        Y_demand=y,
        Y_actual=y - play,
        Z_demand=z,
        Z_actual=z - 0.004,
        line=line,
    )


def test_mill_arc_is_found_in_the_xy_plane() -> None:
    found = analyze_record(AnalysisKind.BALL_BAR, milled_arc(), 0, {})  # type: ignore[arg-type]
    assert found.ball_bar_result is not None
    assert (found.axis_names, found.selected_arc) == (("X", "Y"), (0, 1, 4))
    assert found.ball_bar_result.radius_mm == pytest.approx(10.0, abs=1e-3)
    assert found.ball_bar_result.backlash_mm == pytest.approx((0.0, 0.02), abs=3e-4)


def test_mill_path_error_is_spatial() -> None:
    """Where Y goes radially its play of .01 and the .004 of Z are at right angles: √(.01² + .004²)."""
    page = AnalysesModel(SimpleNamespace(metric=True))  # type: ignore[arg-type]
    page.result = found = analyze_record(AnalysisKind.PATH, milled_arc(), 0, {})  # type: ignore[arg-type]
    assert [each.line_number for each in found.worst_deviations] == [4]
    assert found.worst_deviations[0].distance_mm == pytest.approx(np.hypot(0.01, 0.004), abs=1e-4)
    sheet = page.make_table()
    assert sheet.column_heads[2:] == ("X", "Y", "Z")
    assert not any("radius" in note or "left" in note for note in sheet.notes)
    drawing = page.make_drawing()
    assert drawing.axis_labels == ("Y  {unit}", "", "X  {unit}")  # seen along Z, which stands
    assert not drawing.is_vertical_axis_inverted
    assert drawing.commanded_points.shape[1] == 2
    page.close()


def test_drawing_labels_its_axes_with_the_displayed_unit() -> None:
    page = AnalysesModel(SimpleNamespace(metric=True))  # type: ignore[arg-type]
    page.result = analyze_record(AnalysisKind.BALL_BAR, turned_arc(), 0, {})  # type: ignore[arg-type]
    drawing = page.make_drawing()
    assert scale_drawing(drawing, 1.0).axis_labels == ("X  mm", "", "Z  mm")
    assert scale_drawing(drawing, 1.0).is_vertical_axis_inverted
    assert scale_drawing(drawing, 1.0 / 25.4).axis_labels == ("X  in", "", "Z  in")
    page.close()


def test_missing_data_is_reported() -> None:
    record = record_of(seconds(0.0, 3.0))
    assert analyze_record(AnalysisKind.BALL_BAR, record, 0, {}).unavailable_reason == text("scope.no-arc")
    still = record_of(seconds(0.0, 3.0), spindle_turns=np.full(3001, 7.0))
    assert "does not turn" in analyze_record(AnalysisKind.THREAD, still, 0, {}).unavailable_reason
    assert (
        "a path needs two linear axes"
        in analyze_record(AnalysisKind.PATH, record_of(seconds(0.0, 3.0), {"line"}), 0, {}).unavailable_reason
    )
    nothing = np.full(3001, np.nan)
    deaf = record_of(seconds(0.0, 3.0), spindle_turns=nothing)
    assert "no spindle encoder count" in analyze_record(AnalysisKind.THREAD, deaf, 0, {}).unavailable_reason


def test_live_samples_are_reduced_to_the_last_run() -> None:
    times = seconds(0.0, 20.0)
    line = np.where((times > 2.0) & (times < 5.0), 3.0, 0.0) + np.where(
        (times > 9.0) & (times < 15.0), 4.0, 0.0
    )
    found = find_last_program_run(record_of(times, line=line))
    assert (found.times_s[0], found.times_s[-1]) == pytest.approx((9.001, 14.999))


def test_record_without_a_run_is_used_in_full() -> None:
    record = record_of(seconds(0.0, 2.0), line=np.zeros(2001))
    assert len(find_last_program_run(record).times_s) == 2001
    without = replace(record, values_by_channel={})
    assert find_last_program_run(without) is without
