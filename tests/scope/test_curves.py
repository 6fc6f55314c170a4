"""Curves by pixel columns: nothing that was sampled is lost, nothing is drawn that was not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.scope.curve_points import CurveColumns, make_curve_points, make_round_range, update_range
from app.scope.scope_curves import LiveCurves, PictureRequest, RecordingCurves
from app.scope.signals import Quantity, find_default_signal_keys, list_signals
from app.scope.time_window import Trigger, TriggerEvent
from core.executor.snapshot import MachineState
from core.records.record import list_machine_channels
from tests.scope.played_record import CHANNELS, STATES, PlayedSamples, record_of, seconds
from tests.texts import text

SIGNALS = {each.key: each for each in list_signals(CHANNELS)}


def wanted(
    *keys: str, begin: float = -10.0, end: float = 0.0, pixels: int = 500, **more: object
) -> PictureRequest:
    settings: dict[str, object] = {"metric": True, **more}
    return PictureRequest(tuple(SIGNALS[key] for key in keys), begin, end, pixels, **settings)  # type: ignore[arg-type]


# --- columns --------------------------------------------------------------------------------------------


def test_single_outlier_sample_is_drawn() -> None:
    times, values = np.arange(100_000) / 1000.0, np.zeros(100_000)
    values[54_321] = 7.0
    found = make_curve_points(times, values, 0.1)
    assert found.has_line_pairs
    assert len(found.times_s) == 2 * 1000
    at = int(np.argmax(found.values))
    assert found.values[at] == 7.0
    assert found.times_s[at] == pytest.approx(54.35)  # the middle of its column
    assert (found.values == 7.0).sum() == 1  # nor in the next one: the way back is drawn there


def test_step_edge_between_two_columns_is_connected() -> None:
    times = np.arange(20) / 10.0
    found = make_curve_points(times, np.where(times < 0.95, 0.0, 1.0), 0.5)
    low, high = found.values[0::2], found.values[1::2]
    assert list(low) == [0.0, 0.0, 0.0, 1.0]
    assert list(high) == [0.0, 0.0, 1.0, 1.0]


def test_few_samples_are_drawn_unreduced() -> None:
    times = np.array([0.0, 1.0, 2.0])
    found = make_curve_points(times, times**2, 0.5)
    assert not found.has_line_pairs
    assert list(found.values) == [0.0, 1.0, 4.0]


def test_gap_of_unknown_values_is_not_joined() -> None:
    found = make_curve_points(np.arange(5.0), np.array([1.0, 2.0, np.nan, 4.0, 5.0]), 1.0)
    assert list(found.values) == [1.0, 2.0, 4.0, 5.0]
    assert found.is_joined_to_next is not None
    assert list(found.is_joined_to_next) == [True, False, True, False]


def test_a_gap_is_not_joined_in_columns() -> None:
    columns = CurveColumns.make_empty(1.0)
    columns.append_samples(np.arange(8) / 2.0, np.array([0.0, 0.0, 0.0, np.nan, np.nan, np.nan, 9.0, 9.0]))
    assert list(columns.column_numbers) == [0, 1, 3]
    assert list(columns.minima) == [0.0, 0.0, 9.0]
    assert len(columns.make_points().times_s) == 6  # no level line over the gap


def test_level_line_is_drawn_at_rest_without_new_samples() -> None:
    columns = CurveColumns.make_empty(1.0)
    columns.append_samples(np.array([0.5, 9.5]), np.array([3.0, 3.0]))
    points = columns.make_points()
    assert list(points.times_s[-2:]) == [0.5, 9.5]
    assert list(points.values[-2:]) == [3.0, 3.0]


def test_columns_added_in_pieces_equal_columns_added_at_once() -> None:
    rng = np.random.default_rng(3)
    times, values = np.sort(rng.uniform(0.0, 10.0, 5000)), rng.normal(size=5000)
    whole, pieces = CurveColumns.make_empty(0.02), CurveColumns.make_empty(0.02)
    whole.append_samples(times, values)
    for at in range(0, 5000, 37):
        pieces.append_samples(times[at : at + 37], values[at : at + 37])
    assert (whole.column_numbers == pieces.column_numbers).all()
    assert (whole.minima == pieces.minima).all()
    assert (whole.maxima == pieces.maxima).all()


def test_empty_input_gives_no_points() -> None:
    assert len(make_curve_points(np.empty(0), np.empty(0), 0.1).times_s) == 0
    assert len(make_curve_points(np.arange(3.0), np.full(3, np.nan), 0.1).times_s) == 0


def test_lane_range_is_unchanged_while_values_fit() -> None:
    first = make_round_range(-0.9, 0.95, 0.1)
    assert first[0] <= -0.9
    assert first[1] >= 0.95
    assert update_range(first, -0.5, 0.8, 0.1) == first
    assert update_range(first, -0.5, 1.7, 0.1)[1] >= 1.7
    assert update_range(first, 0.0, 0.01, 0.01) != first  # too small to be read in it
    assert update_range(first, -0.5, first[1], 0.1)[1] > first[1]  # on the edge it would not be seen


# --- of a record ----------------------------------------------------------------------------------------


def test_recorded_curve_is_drawn_exactly() -> None:
    record = record_of(seconds(100.0, 101.0))
    sight = RecordingCurves(record, 101.0).make_picture(wanted("X following error", begin=-1.0, pixels=4000))
    (curve,) = sight.curves
    assert (curve.points.values == record.values_by_channel["X following error"]).all()
    assert curve.points.times_s == pytest.approx(record.times_s - 101.0)


def test_inch_curve_is_metric_curve_converted() -> None:
    record = record_of(seconds(100.0, 101.0))
    metric = RecordingCurves(record, 101.0).make_picture(wanted("X demand", begin=-1.0, pixels=4000))
    inch = RecordingCurves(record, 101.0).make_picture(
        wanted("X demand", begin=-1.0, pixels=4000, metric=False)
    )
    assert inch.curves[0].points.values * 25.4 == pytest.approx(metric.curves[0].points.values)


def test_velocity_is_derived_from_record() -> None:
    record = record_of(seconds(0.0, 10.0))
    curves = RecordingCurves(record, 0.0)
    column = curves.read_signal_values(SIGNALS["X demand velocity"])
    assert column is not None
    assert column[10:-10] == pytest.approx(5.0 * np.cos(record.times_s[10:-10]), abs=1e-4)


def test_cursors_read_the_samples_and_not_the_pixels() -> None:
    record = record_of(seconds(100.0, 110.0))
    sight = RecordingCurves(record, 110.0).make_picture(wanted("X demand", pixels=50, cursors=(-8.0, -3.0)))
    a, b = sight.cursor_values["X demand"]
    assert a == pytest.approx(10.0 + 5.0 * np.sin(102.0))
    assert b == pytest.approx(10.0 + 5.0 * np.sin(107.0))


def test_cursor_outside_record_reads_nan() -> None:
    record = record_of(seconds(100.0, 110.0))
    sight = RecordingCurves(record, 110.0).make_picture(wanted("X demand", cursors=(-12.0, 5.0)))
    assert all(np.isnan(value) for value in sight.cursor_values["X demand"])


def test_channel_missing_from_record_is_not_drawn() -> None:
    record = record_of(seconds(0.0, 1.0), {"X actual"})
    assert (
        RecordingCurves(record, 0.0).make_picture(wanted("X demand", "X actual")).curves[0].signal.key
        == "X actual"
    )


# --- live -----------------------------------------------------------------------------------------------


def test_live_curves_match_recorded_curves() -> None:
    played = PlayedSamples()
    live = LiveCurves(played)
    asked = wanted("X velocity", "Z following error", "spindle ripple")
    for now in np.arange(100.0, 112.0, 0.017):
        played.now = float(now)
        sight = live.make_picture(asked)
    curves = {each.signal.key: each.points for each in sight.curves}
    whole = RecordingCurves(record_of(seconds(90.0, played.newest_time_s)), 0.0)
    for key, points in curves.items():
        column = whole.read_signal_values(SIGNALS[key])
        assert column is not None
        middle = slice(200, -200)  # columns at the edges are not whole yet
        for time, value in zip(
            points.times_s[middle] + sight.zero_time_s, points.values[middle], strict=True
        ):
            near = np.abs(whole.record.times_s - time) <= 0.5 * asked.width + 0.0011
            assert np.nanmin(column[near]) - 1e-9 <= value <= np.nanmax(column[near]) + 1e-9


@pytest.mark.parametrize(("armed", "released"), [(100.0, 34.0 * np.pi - np.arccos(0.762)), (107.0, None)])
def test_trigger_search_begins_at_arming_time(armed: float, released: float | None) -> None:
    """.01·cos t rises through .00762 at 106.1; the worker looks at 108 for the first time."""
    played = PlayedSamples(now=108.0)
    trigger = Trigger(TriggerEvent.RISES_ABOVE, "X following error", 0.00762)
    asked = replace(wanted("X following error"), trigger=trigger, armed=armed)
    found = LiveCurves(played).make_picture(asked).trigger_time_s
    assert found == (
        None if released is None else pytest.approx(32.0 * np.pi + 2 * np.pi - np.arccos(0.762), abs=0.002)
    )


def test_constant_values_are_reported_only_if_all_curves_are_level() -> None:
    played = PlayedSamples()
    live = LiveCurves(played)
    assert live.make_picture(wanted("spindle command", "C actual")).constant_values == (1000.0, 0.0)
    assert live.make_picture(wanted("spindle command", "X actual")).constant_values is None
    young = LiveCurves(PlayedSamples(now=5.0))  # it still grows across the window
    assert young.make_picture(wanted("spindle command")).constant_values is None


def test_constant_values_are_not_reported_with_earlier_record() -> None:
    earlier = RecordingCurves(record_of(seconds(90.0, 100.0)), 95.0)
    assert LiveCurves(PlayedSamples()).make_picture(wanted("C actual"), earlier).constant_values is None


def test_live_curves_read_only_new_samples() -> None:
    played = PlayedSamples()
    live = LiveCurves(played)
    live.make_picture(wanted("X actual"))
    played.asked.clear()
    played.now += 0.016
    live.make_picture(wanted("X actual"))
    assert max(end - begin for begin, end in played.asked) < 0.1


def test_latest_value_is_that_of_newest_sample() -> None:
    played = PlayedSamples()
    sight = LiveCurves(played).make_picture(wanted("X demand"))
    assert sight.curves[0].latest_value == pytest.approx(10.0 + 5.0 * np.sin(100.0))


def test_no_curve_is_drawn_before_first_sample() -> None:
    played = PlayedSamples(now=-np.inf)
    assert LiveCurves(played).make_picture(wanted("X demand")).curves == ()


# --- trigger --------------------------------------------------------------------------------------------

TIMES = np.arange(6.0)


@pytest.mark.parametrize(
    ("when", "values", "at"),
    [
        (TriggerEvent.RISES_ABOVE, [0, 0, 2, 2, 0, 2], 2.0),
        (TriggerEvent.FALLS_BELOW, [2, 2, 2, 0, 2, 0], 3.0),
        (TriggerEvent.EXCEEDS, [0, 0.5, -1.5, 0, 1.5, 0], 2.0),
        (TriggerEvent.RISES_ABOVE, [2, 2, 2, 2, 2, 2], None),  # it is above and never rose
        (TriggerEvent.FALLS_BELOW, [0, 0, 0, 0, 0, 0], None),
        (TriggerEvent.RISES_ABOVE, [0, np.nan, 2, 2, 2, 2], None),  # nobody saw it rise
        (TriggerEvent.LINE, [6, 6, 7, 7, 8, 7], 2.0),
        (TriggerEvent.OFF, [0, 2, 0, 2, 0, 2], None),
    ],
)
def test_trigger_releases_on_edge(when: TriggerEvent, values: list[float], at: float | None) -> None:
    trigger = Trigger(when, "X actual", 1.0, 7)
    assert trigger.find_trigger_time(TIMES, np.array(values, dtype=float), frozenset()) == at


def test_alarm_releases_trigger() -> None:
    run, fault = STATES.index(MachineState.RUN.value), STATES.index(MachineState.FAULT.value)
    states = np.array([run, run, fault, fault, run, fault], dtype=float)
    assert Trigger(TriggerEvent.ALARM).find_trigger_time(TIMES, states, frozenset({fault})) == 2.0


def test_a_live_trigger_finds_the_sample_between_two_pictures() -> None:
    played = PlayedSamples()
    live = LiveCurves(played)
    asked = wanted("X demand", trigger=Trigger(TriggerEvent.RISES_ABOVE, "X demand", 12.5))
    found = None
    while found is None and played.now < 110.0:
        found = live.make_picture(asked).trigger_time_s
        played.now += 0.016
    # 10 + 5 sin t = 12.5 where sin t = 1/2: the first t above 100 is 16·2π + π/6
    assert found == pytest.approx(32.0 * np.pi + np.pi / 6.0, abs=0.001)


def test_event_before_arming_does_not_release_trigger() -> None:
    played = PlayedSamples(now=101.4)
    live = LiveCurves(played)
    asked = wanted("X demand", trigger=Trigger(TriggerEvent.RISES_ABOVE, "X demand", 12.5))
    assert live.make_picture(asked).trigger_time_s is None
    played.now += 0.1
    assert live.make_picture(asked).trigger_time_s is None


# --- signals --------------------------------------------------------------------------------------------


def test_rotary_axis_velocity_is_a_rotation_speed() -> None:
    assert SIGNALS["C velocity"].quantity is Quantity.ROTATION_SPEED
    assert SIGNALS["X velocity"].quantity is Quantity.VELOCITY


def test_derived_signal_note_states_time_window() -> None:
    assert SIGNALS["X velocity"].note == text("scope.window", ms=8)
    assert SIGNALS["X actual"].note == ""


def test_channels_that_are_not_recorded_are_not_offered() -> None:
    there = {each.key for each in list_signals([each for each in CHANNELS if "load" not in each.name])}
    assert "X load" not in there
    assert find_default_signal_keys(list_signals(CHANNELS))[0] == "X following error"


def test_mill_offers_three_linear_axes_and_lathe_two() -> None:
    rotary = dict.fromkeys("XYZ", False) | dict.fromkeys("AC", True)
    shown = find_default_signal_keys(list_signals(list_machine_channels(rotary, (), ())))
    assert shown == (
        *(f"{letter} following error" for letter in "XYZ"),
        *(f"{letter} velocity" for letter in "XYZ"),
        "spindle speed",
    )
    lathe = find_default_signal_keys(list_signals(CHANNELS))
    assert "spindle command" in lathe
    assert not any(key.startswith("C ") for key in lathe)
