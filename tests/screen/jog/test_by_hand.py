"""Spindle, coolant and collet by hand on the Jog page: the palms alone switch on, and much switches off."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialog, QWidget
from pytestqt.qtbot import QtBot

from app.jog.manual_functions import CODES_BY_LANGUAGE
from app.screen import page_table
from core.executor.snapshot import MachineState
from tests.screen.hands import LIMIT
from tests.screen.jog.bench import SHIFT, JogBench, Key
from tests.screen.yes import twist_out
from tests.texts import shows, text


def palms(jog: JogBench) -> None:
    """Both down together, and up again."""
    jog.run(0.4)
    jog.down(Key.Key_F11)
    jog.down(Key.Key_F12)
    jog.run(0.1)
    jog.up(Key.Key_F11)
    jog.up(Key.Key_F12)
    jog.run(0.1)


def proved(jog: JogBench) -> None:
    """The worker has proved what was chosen, and the screen has seen it."""
    jog.page.model.manual_functions.prepared_line.worker.wait_for_results(60.0)
    jog.run(0.1)


def chosen(jog: JogBench, speed: str = "200") -> None:
    """FORWARD is ready."""
    jog.type("b1")
    jog.enter(speed)
    proved(jog)
    assert jog.page.model.manual_functions.prepared_line.ready_job is not None, jog.prompt


def turning(jog: JogBench) -> None:
    """The spindle turns at 200 rpm."""
    chosen(jog)
    palms(jog)
    jog.until(lambda: abs(jog.shot.rpm_actual - 200.0) < 10.0 and jog.shot.state is MachineState.IDLE)


def test_only_palm_buttons_start_spindle(jog: JogBench) -> None:
    chosen(jog)
    jog.run(0.5)
    assert (jog.shot.rpm_command, jog.shot.state) == (0.0, MachineState.IDLE)
    assert "G97M03S200" in jog.prompt
    assert text("screen.both-palms") in jog.prompt
    palms(jog)
    jog.run(1.5)
    assert jog.shot.rpm_actual == pytest.approx(200.0, abs=10.0)
    assert text("jog.spindle-turns") in jog.prompt


def test_single_palm_button_starts_nothing(jog: JogBench) -> None:
    chosen(jog)
    jog.down(Key.Key_F11)
    jog.run(0.5)
    jog.up(Key.Key_F11)
    jog.down(Key.Key_F12)
    jog.run(0.5)
    jog.up(Key.Key_F12)
    assert jog.shot.rpm_command == 0.0


def test_palm_buttons_without_selected_function_start_nothing(jog: JogBench) -> None:
    palms(jog)
    assert jog.shot.state is MachineState.IDLE
    jog.type("b")
    palms(jog)
    assert (jog.shot.state, jog.shot.rpm_command) == (MachineState.IDLE, 0.0)
    assert shows(jog.prompt, "jog.nothing-chosen")


def test_selected_function_runs_once(jog: JogBench) -> None:
    turning(jog)
    jog.type("0")
    jog.until(lambda: jog.shot.rpm_actual == 0.0)
    palms(jog)
    jog.run(0.5)
    assert jog.shot.rpm_command == 0.0


def test_jogging_cancels_selected_function(jog: JogBench) -> None:
    chosen(jog)
    jog.down(Key.Key_Left)
    jog.run(0.5)
    jog.up(Key.Key_Left)
    jog.rests()
    assert shows(jog.prompt, "jog.choose-again")
    palms(jog)
    assert jog.shot.rpm_command == 0.0


def test_esc_cancels_selected_function(jog: JogBench) -> None:
    chosen(jog)
    jog.key(Key.Key_Escape)
    palms(jog)
    assert jog.shot.rpm_command == 0.0
    assert jog.frame.current_page.NAME == page_table.JOG


def by_key(jog: JogBench) -> None:
    jog.type("0")


def by_finger(jog: JogBench) -> None:
    hand = jog.page.manual_panel
    hand.grab()
    stop = next(each for each in hand.controls if each.stops_machine)
    QTest.mouseClick(hand, Qt.MouseButton.LeftButton, pos=stop.box.center().toPoint())


def by_reset(jog: JogBench) -> None:
    jog.type("r")


def by_estop(jog: JogBench) -> None:
    jog.key(Key.Key_E)


def by_switch(jog: JogBench) -> None:
    jog.desk.station_controls.set_spindle_auto(False)  # on the station: A is a key of the Automatic page


@pytest.mark.parametrize(
    ("stop", "jogging"),
    [
        (by_reset, False),
        *((stop, on) for stop in (by_key, by_finger, by_estop, by_switch) for on in (False, True)),
    ],
)
def test_every_stop_action_stops_spindle(
    jog: JogBench, stop: Callable[[JogBench], None], jogging: bool
) -> None:
    turning(jog)
    if jogging:
        jog.down(Key.Key_Left)
        jog.run(0.5)
        assert jog.shot.state is MachineState.JOG
    stop(jog)
    jog.run(0.5)
    assert jog.shot.rpm_command == 0.0
    assert jog.shot.state is not MachineState.JOG
    stands = jog.shot.demand
    jog.run(0.5)
    assert (jog.shot.demand, jog.shot.rpm_command) == (stands, 0.0)


def test_stop_acts_while_spindle_accelerates(jog: JogBench) -> None:
    chosen(jog)
    jog.run(0.4)
    jog.down(Key.Key_F11)
    jog.down(Key.Key_F12)
    jog.run(0.02)
    jog.type("0")
    jog.run(0.3)
    jog.up(Key.Key_F11)
    jog.up(Key.Key_F12)
    jog.run(0.5)
    assert (jog.shot.rpm_command, jog.shot.state) == (0.0, MachineState.IDLE)


def test_estop_release_starts_nothing(jog: JogBench) -> None:
    turning(jog)
    by_estop(jog)
    jog.run(0.5)
    twist_out(jog.window)
    jog.key(Key.Key_D)
    palms(jog)
    jog.run(0.5)
    assert jog.shot.rpm_command == 0.0


def test_function_cannot_be_selected_with_drives_off(jog: JogBench) -> None:
    by_estop(jog)
    jog.run(0.2)
    twist_out(jog.window)
    jog.run(0.2)
    jog.type("b3")
    proved(jog)
    assert jog.page.model.manual_functions.prepared_line.ready_job is None
    assert shows(jog.prompt, "screen.drives-off-for-hands")


def test_alarm_stops_spindle_and_blocks_selection(jog: JogBench) -> None:
    turning(jog)
    jog.executor.handle_failure(RuntimeError("made by the test"))
    jog.run(0.3)
    assert (jog.shot.state, jog.shot.rpm_command) == (MachineState.FAULT, 0.0)
    jog.type("1")
    palms(jog)
    assert jog.shot.rpm_command == 0.0


def test_feed_hold_blocks_start(jog: JogBench) -> None:
    chosen(jog)
    assert jog.desk.desk_control.station_panel is not None
    jog.desk.desk_control.station_panel.press_hold()
    palms(jog)
    jog.run(0.5)
    assert (jog.shot.state, jog.shot.rpm_command) == (MachineState.IDLE, 0.0)
    assert text("jog.in-feed-hold") in jog.shot.start_refusal_reason
    jog.desk.desk_control.station_panel.release_hold()


@pytest.mark.parametrize("page", [Key.Key_F8, Key.Key_F1])
def test_leaving_page_cancels_ready_line_and_leaves_spindle_running(jog: JogBench, page: Key) -> None:
    turning(jog)
    jog.type("2")
    proved(jog)
    assert jog.page.model.manual_functions.prepared_line.ready_job is not None
    jog.key(page)
    jog.run(0.5)
    assert jog.shot.rpm_command == 200.0  # as MDI leaves it; every page shows it
    assert jog.shot.prepared_job_digest == ""


def test_key_down_through_page_change_does_not_jog(jog: JogBench) -> None:
    turning(jog)
    jog.down(Key.Key_Left)
    jog.run(0.5)
    jog.key(Key.Key_F8)
    jog.run(0.5)
    stands = jog.shot.demand
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F5)
    jog.repeats(Key.Key_Left)
    jog.run(0.5)
    assert jog.shot.demand == stands


def test_rapid_does_not_continue_slowly_after_shift_is_released(jog: JogBench) -> None:
    turning(jog)
    jog.down(Key.Key_Left, SHIFT)
    jog.run(0.3)
    jog.up(Key.Key_Shift, SHIFT)
    jog.run(0.5)
    stands = jog.shot.demand
    jog.run(0.5)
    assert (jog.shot.demand, jog.shot.state) == (stands, MachineState.IDLE)


def test_loss_of_keyboard_focus_ends_jog_without_resuming(jog: JogBench, qtbot: QtBot) -> None:
    turning(jog)
    jog.down(Key.Key_Left)
    jog.run(0.5)
    other = QDialog()
    with qtbot.waitActive(other, timeout=LIMIT):
        other.show()
        other.activateWindow()
    jog.run(0.5)
    stands = jog.shot.demand
    other.close()
    other.deleteLater()
    jog.window.activateWindow()
    qtbot.waitUntil(jog.window.isActiveWindow, timeout=LIMIT)
    jog.run(0.5)
    assert (jog.shot.demand, jog.shot.state) == (stands, MachineState.IDLE)


def test_c_axis_does_not_jog_while_spindle_turns(jog: JogBench) -> None:
    turning(jog)
    jog.down(Key.Key_PageUp)
    jog.run(0.5)
    assert jog.shot.state is MachineState.IDLE
    jog.up(Key.Key_PageUp)


def test_collet_does_not_open_while_spindle_turns(jog: JogBench) -> None:
    turning(jog)
    jog.type("6")
    proved(jog)
    assert shows(jog.prompt, "jog.collet-while-turning")
    palms(jog)
    assert "collet" in jog.shot.outputs


def test_coolant_starts_by_palm_buttons_and_stops_by_key(jog: JogBench) -> None:
    jog.type("b3")
    proved(jog)
    assert "coolant" not in jog.shot.outputs
    palms(jog)
    jog.run(0.5)
    assert "coolant" in jog.shot.outputs
    jog.type("4")
    jog.run(0.1)
    assert "coolant" not in jog.shot.outputs


def test_ready_collet_opening_is_canceled_when_spindle_waits(jog: JogBench) -> None:
    turning(jog)
    by_switch(jog)
    jog.until(lambda: jog.shot.rpm_actual == 0.0)
    jog.type("6")  # it stands, and the switch may start it
    proved(jog)
    assert jog.page.model.manual_functions.prepared_line.ready_job is None
    palms(jog)
    jog.run(0.5)
    assert "collet" in jog.shot.outputs


def test_palm_buttons_open_and_close_collet(jog: JogBench) -> None:
    jog.type("b6")
    proved(jog)
    palms(jog)
    jog.until(lambda: jog.shot.state is MachineState.IDLE)
    assert "collet" not in jog.shot.outputs
    jog.type("1")
    jog.enter("500")
    proved(jog)
    palms(jog)
    jog.run(0.5)
    assert jog.shot.rpm_command == 0.0  # with the collet open it is not started
    jog.type("5")
    proved(jog)
    palms(jog)
    jog.until(lambda: jog.shot.state is MachineState.IDLE)
    assert "collet" in jog.shot.outputs


@pytest.mark.parametrize(
    ("typed", "said"), [("4000", "ENTER MORE THAN 0"), ("-5", "ENTER MORE THAN 0"), ("", "REJECTED")]
)
def test_invalid_spindle_speed_is_rejected(jog: JogBench, typed: str, said: str) -> None:
    jog.type("b9")
    jog.enter(typed)
    assert said in jog.prompt
    jog.key(Key.Key_Left)
    assert jog.shot.state is MachineState.IDLE  # an entry is open
    jog.key(Key.Key_Escape)
    assert jog.page.model.manual_functions.entered_rpm == 0.0


def test_manual_function_targets_are_touch_sized(jog: JogBench) -> None:
    jog.type("b")
    jog.run(0.1)
    for panel, least in (
        (jog.page.manual_panel, 43.0),
        (jog.page.manual_strip, 43.0),
        (jog.page.jog_cross, 43.0),
    ):
        panel.grab()
        assert panel.controls
        for each in panel.controls:
            assert min(each.box.width(), each.box.height()) >= least - 1e-6, each.box


def test_function_is_selected_and_speed_entered_by_touch(jog: JogBench) -> None:
    def touch(panel: QWidget, at: QPointF) -> None:
        QTest.mouseClick(panel, Qt.MouseButton.LeftButton, pos=at.toPoint())

    strip, hand = jog.page.manual_strip, jog.page.manual_panel
    strip.grab()
    touch(strip, strip.controls[0].box.center())
    jog.run(0.1)
    assert hand.isVisible()
    hand.grab()
    touch(hand, hand.controls[2].box.center())  # FORWARD
    jog.run(0.1)
    assert jog.page.number_pad.isVisible()
    jog.enter("300")
    proved(jog)
    palms(jog)
    jog.run(0.5)
    assert jog.shot.rpm_command == 300.0


def test_every_language_has_codes_for_manual_functions() -> None:
    assert set(CODES_BY_LANGUAGE) == {"omniturn", "sinumerik", "klartext"}
