"""The scope page by keys, wheel and fingers: frozen, zoomed, measured, triggered, kept and opened again."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QColor, QImage, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.desk.desk import Desk
from app.scope.recording_store import RecordingFileError, RecordingStore
from app.scope.scope_model import ScopeModel, SidePanel
from app.scope.scope_view import ScopePage
from app.scope.time_window import TriggerEvent
from app.screen import page_table
from app.screen.color_palettes import CURVE_COLORS
from app.screen.window_layout import FINGERTIP_PX
from app.special.special_view import SpecialFunctionsPage
from core.executor.commands import FeedHold
from core.executor.raised_alarm import make_alarm
from core.executor.snapshot import LogEvent, MachineState
from core.records.record_file import open_record, save_record
from tests.scope.played_record import PlayedSamples, record_of, seconds
from tests.screen.desks import desk_on
from tests.screen.fake import FakeMachine
from tests.screen.hands import Hands, Key
from tests.screen.yes import yes
from tests.texts import begins, shows, text

SHIFT, CTRL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def played() -> PlayedSamples:
    return PlayedSamples()


@pytest.fixture
def desk(
    machine: FakeMachine, played: PlayedSamples, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Desk:
    """A desk that records."""
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    return desk_on(machine, live=played)


def opened(hands: Hands) -> ScopePage:
    """By the one key from any page, and until curves are seen."""
    hands.key(Key.Key_F10, SHIFT)
    page = hands.frame.current_page
    assert isinstance(page, ScopePage)
    hands.sees(lambda: page.curve_area.chart is not None and bool(page.curve_area.chart.picture.curves))
    return page


def frozen(hands: Hands) -> ScopePage:
    page = opened(hands)
    hands.key(Key.Key_F2)
    hands.sees(lambda: not page.scope_model.picture.is_live and page.scope_model.frozen_curves is not None)
    chart = page.curve_area.chart
    assert chart is not None
    hands.sees(lambda: not chart.picture.is_live and chart.curve_area.height() > 100.0)  # drawn, and laid out
    return page


def wheel(page: ScopePage, share: float, notches: int, held: Qt.KeyboardModifier = SHIFT) -> None:
    chart = page.curve_area.chart
    assert chart is not None
    room = chart.curve_area
    at = QPointF(room.x() + share * room.width(), room.center().y())
    spot = QPointF(page.curve_area.mapToGlobal(at.toPoint()))
    event = QWheelEvent(
        at,
        spot,
        QPoint(),
        QPoint(0, 120 * notches),
        Qt.MouseButton.NoButton,
        held,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(page.curve_area, event)


def test_shift_f10_opens_scope_and_returns(hands: Hands) -> None:
    hands.key(Key.Key_F1)
    hands.key(Key.Key_F5)
    hands.sees(lambda: hands.frame.current_page.NAME == page_table.JOG)
    opened(hands)
    hands.key(Key.Key_F10, SHIFT)
    assert hands.frame.current_page.NAME == page_table.JOG


def test_f10_list_contains_scope(hands: Hands) -> None:
    hands.key(Key.Key_F10)
    page = hands.frame.current_page
    assert isinstance(page, SpecialFunctionsPage)
    number = [each.name for each in page.model.functions].index("SCOPE")
    for _ in range(number):
        hands.key(Key.Key_Down)
    hands.key(Key.Key_Return)
    assert hands.frame.current_page.NAME == page_table.SCOPE


def test_curves_are_drawn_in_their_colors(hands: Hands) -> None:
    page = opened(hands)
    image = page.curve_area.grab().toImage()
    seen = {image.pixelColor(x, y).name() for x in range(60, image.width(), 3) for y in range(image.height())}
    assert {QColor(each).name() for each in CURVE_COLORS["dark"][:4]} <= seen


def test_frozen_curves_do_not_move(hands: Hands, played: PlayedSamples) -> None:
    page = frozen(hands)
    before = page.scope_model.picture.zero_time_s
    played.now += 5.0
    hands.qtbot.wait(50)
    assert page.scope_model.picture.zero_time_s == before
    hands.key(Key.Key_F2)
    hands.sees(
        lambda: page.scope_model.picture.is_live and page.scope_model.picture.zero_time_s > before + 4.9
    )


def test_level_curves_are_not_redrawn_while_scrolling(hands: Hands, played: PlayedSamples) -> None:
    page, scope = opened(hands), hands.desk.page_registry.find_model(ScopeModel)
    assert scope is not None
    assert page.is_animating()  # they swing
    scope.selected_signal_keys = ("spindle command", "C actual")
    hands.sees(lambda: not page.is_animating())
    chart = page.curve_area.chart
    assert chart is not None
    hands.sees(lambda: page._drawn is not None and chart.picture.constant_values == (0.0, 1000.0))
    seen = chart.picture
    played.now += 1.0
    hands.sees(lambda: scope.picture.zero_time_s > played.now - 0.1)
    assert chart.picture is seen
    played.now += 1.0
    hands.machine.now = replace(hands.machine.now, inputs=frozenset({"guard"}))  # something happens
    before = hands.desk.clock.read_seconds()
    hands.sees(lambda: scope.picture.zero_time_s > played.now - 0.1)
    hands.desk.clock.read_seconds = lambda: before  # no second passes any more
    scope.selected_signal_keys = ("spindle command", "C actual", "Z actual")

    def three() -> bool:
        hands.window.refresh()  # on a clock that stands nothing grows old
        return chart.picture is not seen and len(chart.picture.curves) == 3

    hands.sees(three)
    assert page.is_animating()


def test_the_wheel_zooms_about_the_pointer(hands: Hands) -> None:
    page = frozen(hands)
    before = page.scope_model.time_window.begin_s + 0.25 * page.scope_model.time_window.window_span_s
    wheel(page, 0.25, 1, Qt.KeyboardModifier.NoModifier)
    window = page.scope_model.time_window
    assert window.window_span_s == pytest.approx(5.0)
    assert window.begin_s + 0.25 * window.window_span_s == pytest.approx(before, abs=0.02)


def test_shift_and_wheel_scale_lane(hands: Hands) -> None:
    page = frozen(hands)
    before = dict(page.scope_model.picture.lane_ranges)
    wheel(page, 0.5, 1)
    hands.sees(lambda: page.scope_model.picture.lane_ranges != before)
    wider = {name: b[1] - b[0] for name, b in before.items()}
    narrower = [
        name
        for name, now in page.scope_model.picture.lane_ranges.items()
        if now[1] - now[0] < 0.9 * wider[name]
    ]
    assert len(narrower) == 1


def test_keys_zoom_pan_and_fit(hands: Hands) -> None:
    page = frozen(hands)
    hands.key(Key.Key_Z)
    assert page.scope_model.time_window.window_span_s == pytest.approx(5.0)
    end = page.scope_model.time_window.end_s
    hands.key(Key.Key_Left, CTRL)
    assert page.scope_model.time_window.end_s == pytest.approx(end - 0.5)
    hands.key(Key.Key_Z, SHIFT)
    assert page.scope_model.time_window.window_span_s == pytest.approx(10.0)
    hands.key(Key.Key_F6)
    assert page.scope_model.time_window.window_span_s == pytest.approx(60.0, abs=0.01)


def test_two_cursors_show_difference(hands: Hands) -> None:
    page = frozen(hands)
    hands.key(Key.Key_F5)
    scope = page.scope_model
    hands.sees(lambda: text("scope.following-error", axis="X") in scope.picture.cursor_values)
    first, second = scope.cursors.times_s
    hands.key(Key.Key_Right)
    assert scope.cursors.times_s[0] == pytest.approx(first + 10.0 / scope.chart_width_px)
    hands.key(Key.Key_Tab)
    hands.key(Key.Key_Left)
    assert scope.cursors.times_s[1] == pytest.approx(second - 10.0 / scope.chart_width_px)
    hands.key(Key.Key_Escape)
    assert not scope.cursors.shown
    assert hands.frame.current_page is page


def test_cursors_are_available_on_frozen_curves_only(hands: Hands) -> None:
    opened(hands)
    hands.key(Key.Key_F5)
    hands.sees(lambda: shows(hands.prompt(), "scope.freeze-first"))


def test_touch_drags_cursor(hands: Hands) -> None:
    page = frozen(hands)
    hands.key(Key.Key_F5)
    chart = page.curve_area.chart
    assert chart is not None
    hands.sees(lambda: chart.cursors.shown)
    x = round(chart.find_column(page.scope_model.cursors.times_s[0]))
    y = page.curve_area.height() // 2
    QTest.mousePress(page.curve_area, Qt.MouseButton.LeftButton, pos=QPoint(x + 5, y))
    QTest.mouseMove(page.curve_area, QPoint(x + 60, y))
    QTest.mouseRelease(page.curve_area, Qt.MouseButton.LeftButton, pos=QPoint(x + 60, y))
    assert page.scope_model.cursors.times_s[0] == pytest.approx(chart.find_time(QPointF(x + 60, y)), abs=1e-6)


def spread(page: ScopePage, *steps: tuple[QPoint, QPoint]) -> None:
    """Two fingers go down on the curves, move, and come up again."""
    device, last = QTest.createTouchDevice(), steps[-1]
    down = QTest.touchEvent(page.curve_area, device, False)
    down.press(0, steps[0][0], page.curve_area)
    down.press(1, steps[0][1], page.curve_area)
    down.commit()
    for one, other in steps[1:]:
        moved = QTest.touchEvent(page.curve_area, device, False)
        moved.move(0, one, page.curve_area)
        moved.move(1, other, page.curve_area)
        moved.commit()
    up = QTest.touchEvent(page.curve_area, device, False)
    up.release(0, last[0], page.curve_area)
    up.release(1, last[1], page.curve_area)
    up.commit()


def test_horizontal_two_finger_spread_zooms_time_about_its_center(hands: Hands) -> None:
    """From 100 to 200 pixels apart: the window is half as wide, and what was between them still is."""
    page = frozen(hands)
    hands.key(Key.Key_Z)
    chart, scope = page.curve_area.chart, page.scope_model
    assert chart is not None
    hands.sees(
        lambda: (
            (chart.picture.begin_s, chart.picture.end_s)
            == (scope.time_window.begin_s, scope.time_window.end_s)
        )
    )
    x, y = round(chart.curve_area.center().x()), round(chart.curve_area.center().y())
    span, middle = scope.time_window.window_span_s, chart.find_time(QPointF(x, y))
    spread(page, (QPoint(x - 50, y), QPoint(x + 50, y)), (QPoint(x - 100, y), QPoint(x + 100, y)))
    assert scope.time_window.window_span_s == pytest.approx(span / 2.0)
    assert (middle - scope.time_window.begin_s) / (span / 2.0) == pytest.approx(0.5, abs=0.02)


def test_vertical_two_finger_spread_scales_lane_between_touches(hands: Hands) -> None:
    page = frozen(hands)
    chart, scope = page.curve_area.chart, page.scope_model
    assert chart is not None
    x, y = (
        round(chart.curve_area.center().x()),
        round(chart.curve_area.y() + 0.15 * chart.curve_area.height()),
    )
    quantity = chart.find_quantity(QPointF(x, y))
    assert quantity is not None
    low, high = scope.picture.lane_ranges[quantity]
    span = scope.time_window.window_span_s
    spread(page, (QPoint(x, y - 20), QPoint(x, y + 20)), (QPoint(x, y - 40), QPoint(x, y + 40)))
    hands.sees(lambda: scope.picture.lane_ranges[quantity] != (low, high))
    near = scope.picture.lane_ranges[quantity]
    assert near[1] - near[0] == pytest.approx((high - low) / 2.0, rel=0.01)
    assert scope.time_window.window_span_s == span


def test_remaining_touch_after_spread_drags_nothing(hands: Hands) -> None:
    page = frozen(hands)
    chart, scope = page.curve_area.chart, page.scope_model
    assert chart is not None
    x, y = round(chart.curve_area.center().x()), round(chart.curve_area.center().y())
    before = scope.time_window.begin_s, scope.time_window.end_s
    spread(page, (QPoint(x - 50, y), QPoint(x + 50, y)), (QPoint(x - 50, y), QPoint(x + 50, y)))
    assert (scope.time_window.begin_s, scope.time_window.end_s) == pytest.approx(before)


def test_drag_scrolls_time(hands: Hands) -> None:
    page = frozen(hands)
    hands.key(Key.Key_Z)
    before = page.scope_model.time_window.end_s
    hands.sees(lambda: page.curve_area.chart is not None and page.curve_area.chart.picture.end_s == before)
    y = page.curve_area.height() // 2
    QTest.mousePress(page.curve_area, Qt.MouseButton.LeftButton, pos=QPoint(200, y))
    QTest.mouseMove(page.curve_area, QPoint(300, y))
    QTest.mouseRelease(page.curve_area, Qt.MouseButton.LeftButton, pos=QPoint(300, y))
    assert page.scope_model.time_window.end_s == pytest.approx(
        before - 100 * 5.0 / page.scope_model.chart_width_px, rel=0.01
    )


def test_curves_are_chosen_by_keys(hands: Hands) -> None:
    page = opened(hands)
    hands.key(Key.Key_F4)
    assert page.scope_model.side_panel is SidePanel.CURVES
    hands.key(Key.Key_Return)  # the first of the list: X commanded
    assert "X demand" in page.scope_model.selected_signal_keys
    hands.key(Key.Key_Return)
    assert "X demand" not in page.scope_model.selected_signal_keys
    hands.key(Key.Key_Escape)
    assert page.scope_model.side_panel is SidePanel.READINGS


def test_a_ninth_curve_is_refused(hands: Hands) -> None:
    page = opened(hands)
    hands.key(Key.Key_F4)
    for key in (Key.Key_Return, Key.Key_Down, Key.Key_Return, Key.Key_Down, Key.Key_Down, Key.Key_Return):
        hands.key(key)
    hands.sees(lambda: shows(hands.prompt(), "scope.too-many-curves", most=8))
    assert len(page.scope_model.shown) == 8


def test_trigger_uses_level_typed_while_waiting_for_edge(hands: Hands, played: PlayedSamples) -> None:
    page = opened(hands)
    hands.key(Key.Key_F3)
    played.lets.clear()
    hands.key(Key.Key_Return)  # rises through 0, by and by
    hands.sees(lambda: played.waits)
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Down)
    hands.type(".0003")
    hands.key(Key.Key_Return)
    played.now += 20.0  # more than the time to the next crossing and half a window
    played.lets.set()  # it looks at what came, still for a rise through 0
    hands.sees(lambda: page.scope_model.frozen_curves is not None)
    assert page.scope_model.frozen_curves is not None
    # .01·cos t = .00762 on the way up, 0 at 105.24: 2πn − arccos(.762)
    assert page.scope_model.frozen_curves.zero_time_s == pytest.approx(
        34.0 * np.pi - np.arccos(0.762), abs=0.002
    )


def test_a_trigger_freezes_once(hands: Hands, played: PlayedSamples) -> None:
    page = opened(hands)
    scope = page.scope_model
    hands.key(Key.Key_F3)
    hands.key(Key.Key_Return)
    assert scope.trigger.trigger_event is TriggerEvent.RISES_ABOVE
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Down)
    hands.type(".0003")  # in, of the following error of X, that swings by .01 mm
    hands.key(Key.Key_Return)
    assert scope.trigger.trigger_level == pytest.approx(0.0003 * 25.4)
    assert scope.is_armed

    def later() -> bool:
        """Samples come no faster than the worker looks at them, however busy the computer is."""
        if played.asked[-1][1] >= played.newest_time_s:
            played.now += 0.25
        return scope.frozen_curves is not None

    played.now += 8.0  # before the worker has looked at all: what came since it was armed counts
    hands.sees(later)
    # .01·cos t = .00762 on the way up: 2πn − arccos(.762)
    assert scope.frozen_curves is not None
    assert scope.frozen_curves.zero_time_s == pytest.approx(
        32.0 * np.pi + 2 * np.pi - np.arccos(0.762), abs=0.002
    )
    assert scope.time_window.begin_s == pytest.approx(-5.0)
    assert scope.time_window.end_s == pytest.approx(5.0)
    assert not scope.is_armed
    assert played.now < 112.0
    played.now = 117.0  # while the curves stand the level is crossed once more, at 112.4 s
    hands.key(Key.Key_F3)
    hands.key(Key.Key_F2)
    assert scope.is_armed
    hands.sees(later)
    assert scope.frozen_curves.zero_time_s == pytest.approx(
        32.0 * np.pi + 6 * np.pi - np.arccos(0.762), abs=0.002
    )


def test_invalid_trigger_level_is_rejected(hands: Hands) -> None:
    page = opened(hands)
    hands.key(Key.Key_F3)
    hands.key(Key.Key_Return)
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Down)
    hands.type("1/0")
    hands.key(Key.Key_Return)
    hands.sees(lambda: begins(hands.prompt(), "screen.refused"))
    assert page.scope_model.trigger.trigger_level == 0.0
    assert page.scope_model.frozen_curves is None


def test_frozen_curves_are_saved_and_opened_again(hands: Hands, tmp_path: Path) -> None:
    page = frozen(hands)
    scope = page.scope_model
    hands.key(Key.Key_F9)
    hands.key(Key.Key_F2)
    hands.sees(lambda: len(scope.recording_store.recording_files) == 1)
    kept = open_record(scope.recording_store.recording_files[0].path)
    whole = record_of(seconds(90.0, 100.0))
    assert (kept.times_s == whole.times_s).all()
    assert (kept.values_by_channel["X actual"] == whole.values_by_channel["X actual"]).all()
    hands.key(Key.Key_F3)
    hands.sees(lambda: scope.recording_name == scope.recording_store.recording_files[0].path.name)
    assert scope.time_window.window_span_s == pytest.approx(10.0)


def test_earlier_recording_is_overlaid(hands: Hands) -> None:
    page = frozen(hands)
    scope = page.scope_model
    hands.key(Key.Key_F9)
    hands.key(Key.Key_F2)
    hands.sees(lambda: len(scope.recording_store.recording_files) == 1)
    hands.key(Key.Key_F4)
    hands.sees(lambda: bool(scope.picture.overlay_curves))
    hands.key(Key.Key_F4)
    hands.sees(lambda: not scope.picture.overlay_curves)


def test_table_and_picture_are_exported(hands: Hands, tmp_path: Path) -> None:
    frozen(hands)
    hands.key(Key.Key_F9)
    hands.key(Key.Key_F5)
    hands.sees(lambda: begins(hands.prompt(), "screen.written") and ".csv" in hands.prompt())
    hands.key(Key.Key_F6)
    hands.sees(lambda: ".png" in hands.prompt())
    table = next((tmp_path / "records").glob("*.csv")).read_text().splitlines()
    assert table[0].startswith("t [s],X demand [mm]")
    assert len(table) == 1 + 10_001
    assert next((tmp_path / "records").glob("*.png")).read_bytes().startswith(b"\x89PNG")


def test_live_curves_cannot_be_saved(hands: Hands, tmp_path: Path) -> None:
    opened(hands)
    hands.key(Key.Key_F9)
    hands.key(Key.Key_F2)
    hands.sees(lambda: shows(hands.prompt(), "scope.freeze-first"))
    assert not list((tmp_path / "records").glob("*"))


def test_recording_is_deleted_after_confirmation(hands: Hands, tmp_path: Path) -> None:
    page = frozen(hands)
    hands.key(Key.Key_F9)
    hands.key(Key.Key_F2)
    hands.sees(lambda: len(page.scope_model.recording_store.recording_files) == 1)
    hands.key(Key.Key_F8)
    assert hands.desk.confirmation_key
    assert list((tmp_path / "records").glob("*.scope"))
    yes(hands.window)
    hands.sees(lambda: not page.scope_model.recording_store.recording_files)
    assert not list((tmp_path / "records").glob("*.scope"))


def test_invalid_recording_is_reported(hands: Hands, tmp_path: Path) -> None:
    (tmp_path / "records").mkdir()
    (tmp_path / "records" / "bad.scope").write_bytes(b"no record")
    page = opened(hands)
    hands.key(Key.Key_F9)
    hands.sees(lambda: len(page.scope_model.recording_store.recording_files) == 1)
    hands.key(Key.Key_Return)
    hands.sees(lambda: begins(hands.prompt(), "screen.refused") and "bad.scope" in hands.prompt())
    assert page.scope_model.is_live


def test_hold_and_esc_stop_machine_on_scope_page(hands: Hands) -> None:
    hands.load("bushing")
    hands.both_palms()
    hands.sees(lambda: hands.machine.now.state is MachineState.RUN)
    frozen(hands)
    hands.key(Key.Key_H)
    assert any(isinstance(each, FeedHold) for each in hands.machine.posted)
    hands.machine.posted.clear()
    hands.both_palms()
    assert not [each for each in hands.machine.posted if not isinstance(each, FeedHold)]


def test_rows_are_touch_sized(hands: Hands) -> None:
    page = opened(hands)
    assert page.readings.row_height_px >= FINGERTIP_PX
    places = page.readings._places
    assert len(places) == len(page.scope_model.shown)
    QTest.mouseClick(page.readings, Qt.MouseButton.LeftButton, pos=places[2][0].center().toPoint())
    assert page.scope_model.marked == 2


def test_theme_change_recolors_curves_at_once(hands: Hands) -> None:
    page = frozen(hands)
    hands.key(Key.Key_T)
    inks = {QColor(each).name() for each in CURVE_COLORS["light"][:4]}
    hands.sees(lambda: inks <= colours_of(page.curve_area.grab().toImage()))


def colours_of(image: QImage) -> set[str]:
    """Those of every third column, right of the figures."""
    across, down = range(60, image.width(), 3), range(image.height())
    return {image.pixelColor(x, y).name() for x in across for y in down}


def test_scope_without_recorder_shows_message(hands: Hands) -> None:
    scope = hands.desk.page_registry.find_model(ScopeModel)
    assert scope is not None
    scope.live_samples = scope._carried = None
    scope.signals = ()
    hands.key(Key.Key_F10, SHIFT)
    hands.key(Key.Key_F2)
    hands.sees(lambda: shows(hands.prompt(), "scope.nothing-recorded"))


def test_full_disk_is_reported(tmp_path: Path) -> None:
    def full(_record: object, _path: Path) -> None:
        raise OSError(28, "No space left on device")

    shelf = RecordingStore(tmp_path, full, open_record, lambda _record, _write: None)
    with pytest.raises(RecordingFileError, match=r"scope .*: No space left on device"):
        shelf.save_dated_record(record_of(seconds(0.0, 1.0)))
    assert not list(tmp_path.iterdir())


@pytest.mark.long
def test_screen_starts_without_pyqtgraph() -> None:
    code = (
        "import sys; import app.screen.screen_startup, app.compose.screen_desk;"
        "import app.scope.scope_view; sys.exit('pyqtgraph' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_f7_opens_recording_of_alarm(hands: Hands, tmp_path: Path) -> None:
    record = record_of(seconds(90.0, 101.0))
    told = {**record.about, "alarm time": "100.0"}
    save_record(replace(record, about=told), tmp_path / "records" / "one-alarm301.scope")
    alarm = make_alarm("following", "X is .2 mm off its setpoint", 7, 0.0)
    stop = make_alarm("estop", "", 0, 0.0)
    hands.desk.hear(LogEvent(100.0, "alarm", alarm.text, 7, alarm, "one-alarm301.scope"))
    hands.desk.hear(LogEvent(100.0, "stop", stop.text, 0, stop))
    hands.key(Key.Key_F7)
    hands.sees(lambda: len(hands.frame.alarm_list.logged_stops) == 2)
    hands.key(Key.Key_F10, SHIFT)  # the newest has none
    hands.sees(lambda: shows(hands.prompt(), "scope.nothing-before"))
    hands.key(Key.Key_Down, CTRL)
    hands.key(Key.Key_F10, SHIFT)
    scope = hands.desk.page_registry.find_model(ScopeModel)
    assert scope is not None
    hands.sees(lambda: scope.recording_name == "one-alarm301.scope")
    assert hands.frame.current_page.NAME == page_table.SCOPE
    assert not hands.frame.alarm_list.isVisible()
    assert scope.frozen_curves is not None
    assert scope.frozen_curves.zero_time_s == 100.0
    assert scope.time_window.begin_s == pytest.approx(-10.0)


def test_missing_recording_is_reported(hands: Hands) -> None:
    alarm = make_alarm("following", "X is .2 mm off its setpoint", 7, 0.0)
    hands.desk.hear(LogEvent(100.0, "alarm", alarm.text, 7, alarm, "gone-alarm301.scope"))
    hands.key(Key.Key_F7)
    hands.sees(lambda: len(hands.frame.alarm_list.logged_stops) == 1)
    hands.key(Key.Key_F10, SHIFT)
    hands.sees(lambda: begins(hands.prompt(), "screen.refused") and "gone-alarm301" in hands.prompt())
