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


def test_the_palms_start_the_spindle_and_nothing_else_does(jog: JogBench) -> None:
    chosen(jog)
    jog.run(0.5)
    assert (jog.shot.rpm_command, jog.shot.state) == (0.0, MachineState.IDLE)
    assert "G97M03S200" in jog.prompt
    assert text("screen.both-palms") in jog.prompt
    palms(jog)
    jog.run(1.5)
    assert jog.shot.rpm_actual == pytest.approx(200.0, abs=10.0)
    assert text("jog.spindle-turns") in jog.prompt


def test_one_palm_starts_nothing(jog: JogBench) -> None:
    chosen(jog)
    jog.down(Key.Key_F11)
    jog.run(0.5)
    jog.up(Key.Key_F11)
    jog.down(Key.Key_F12)
    jog.run(0.5)
    jog.up(Key.Key_F12)
    assert jog.shot.rpm_command == 0.0


def test_palms_without_a_choice_start_neither_spindle_nor_program(jog: JogBench) -> None:
    palms(jog)
    assert jog.shot.state is MachineState.IDLE
    jog.type("b")
    palms(jog)
    assert (jog.shot.state, jog.shot.rpm_command) == (MachineState.IDLE, 0.0)
    assert shows(jog.prompt, "jog.nothing-chosen")


def test_it_runs_once(jog: JogBench) -> None:
    turning(jog)
    jog.type("0")
    jog.until(lambda: jog.shot.rpm_actual == 0.0)
    palms(jog)
    jog.run(0.5)
    assert jog.shot.rpm_command == 0.0


def test_what_is_jogged_away_has_to_be_chosen_again(jog: JogBench) -> None:
    chosen(jog)
    jog.down(Key.Key_Left)
    jog.run(0.5)
    jog.up(Key.Key_Left)
    jog.rests()
    assert shows(jog.prompt, "jog.choose-again")
    palms(jog)
    assert jog.shot.rpm_command == 0.0


def test_esc_takes_it_back(jog: JogBench) -> None:
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
def test_what_stops_it(jog: JogBench, stop: Callable[[JogBench], None], jogging: bool) -> None:
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


def test_stop_counts_while_the_spindle_speeds_up_in_its_line(jog: JogBench) -> None:
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


def test_estop_released_starts_nothing(jog: JogBench) -> None:
    turning(jog)
    by_estop(jog)
    jog.run(0.5)
    twist_out(jog.window)
    jog.key(Key.Key_D)
    palms(jog)
    jog.run(0.5)
    assert jog.shot.rpm_command == 0.0


def test_with_the_drives_off_nothing_is_chosen(jog: JogBench) -> None:
    by_estop(jog)
    jog.run(0.2)
    twist_out(jog.window)
    jog.run(0.2)
    jog.type("b3")
    proved(jog)
    assert jog.page.model.manual_functions.prepared_line.ready_job is None
    assert shows(jog.prompt, "screen.drives-off-for-hands")


def test_an_alarm_stops_it_and_lets_nothing_be_chosen(jog: JogBench) -> None:
    turning(jog)
    jog.executor.handle_failure(RuntimeError("made by the test"))
    jog.run(0.3)
    assert (jog.shot.state, jog.shot.rpm_command) == (MachineState.FAULT, 0.0)
    jog.type("1")
    palms(jog)
    assert jog.shot.rpm_command == 0.0


def test_a_held_feed_hold_lets_nothing_start(jog: JogBench) -> None:
    chosen(jog)
    assert jog.desk.desk_control.station_panel is not None
    jog.desk.desk_control.station_panel.press_hold()
    palms(jog)
    jog.run(0.5)
    assert (jog.shot.state, jog.shot.rpm_command) == (MachineState.IDLE, 0.0)
    assert text("jog.in-feed-hold") in jog.shot.start_refusal
    jog.desk.desk_control.station_panel.release_hold()


@pytest.mark.parametrize("page", [Key.Key_F8, Key.Key_F1])
def test_leaving_takes_back_what_was_ready_and_leaves_what_turns(jog: JogBench, page: Key) -> None:
    turning(jog)
    jog.type("2")
    proved(jog)
    assert jog.page.model.manual_functions.prepared_line.ready_job is not None
    jog.key(page)
    jog.run(0.5)
    assert jog.shot.rpm_command == 200.0  # as MDI leaves it; every page shows it
    assert jog.shot.prepared_digest == ""


def test_a_key_held_while_the_page_changes(jog: JogBench) -> None:
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


def test_a_rapid_whose_shift_is_let_go_does_not_go_on_slowly(jog: JogBench) -> None:
    turning(jog)
    jog.down(Key.Key_Left, SHIFT)
    jog.run(0.3)
    jog.up(Key.Key_Shift, SHIFT)
    jog.run(0.5)
    stands = jog.shot.demand
    jog.run(0.5)
    assert (jog.shot.demand, jog.shot.state) == (stands, MachineState.IDLE)


def test_a_window_that_loses_the_keyboard_ends_the_jog_and_takes_nothing_up(
    jog: JogBench, qtbot: QtBot
) -> None:
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


def test_c_is_not_jogged_while_it_turns(jog: JogBench) -> None:
    turning(jog)
    jog.down(Key.Key_PageUp)
    jog.run(0.5)
    assert jog.shot.state is MachineState.IDLE
    jog.up(Key.Key_PageUp)


def test_the_collet_is_not_opened_while_it_turns(jog: JogBench) -> None:
    turning(jog)
    jog.type("6")
    proved(jog)
    assert shows(jog.prompt, "jog.collet-while-turning")
    palms(jog)
    assert "collet" in jog.shot.outputs


def test_coolant_comes_on_by_the_palms_and_goes_off_by_a_key(jog: JogBench) -> None:
    jog.type("b3")
    proved(jog)
    assert "coolant" not in jog.shot.outputs
    palms(jog)
    jog.run(0.5)
    assert "coolant" in jog.shot.outputs
    jog.type("4")
    jog.run(0.1)
    assert "coolant" not in jog.shot.outputs


def test_a_collet_that_is_ready_to_open_is_so_no_more_when_the_spindle_waits(jog: JogBench) -> None:
    turning(jog)
    by_switch(jog)
    jog.until(lambda: jog.shot.rpm_actual == 0.0)
    jog.type("6")  # it stands, and the switch may start it
    proved(jog)
    assert jog.page.model.manual_functions.prepared_line.ready_job is None
    palms(jog)
    jog.run(0.5)
    assert "collet" in jog.shot.outputs


def test_the_collet_opens_and_closes_by_the_palms(jog: JogBench) -> None:
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
def test_a_speed_that_is_none(jog: JogBench, typed: str, said: str) -> None:
    jog.type("b9")
    jog.enter(typed)
    assert said in jog.prompt
    jog.key(Key.Key_Left)
    assert jog.shot.state is MachineState.IDLE  # an entry is open
    jog.key(Key.Key_Escape)
    assert jog.page.model.manual_functions.entered_rpm == 0.0


def test_every_target_is_a_fingertip(jog: JogBench) -> None:
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


def test_a_finger_chooses_and_the_pad_takes_the_speed(jog: JogBench) -> None:
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


def test_every_language_says_it() -> None:
    assert set(CODES_BY_LANGUAGE) == {"omniturn", "sinumerik", "klartext"}
