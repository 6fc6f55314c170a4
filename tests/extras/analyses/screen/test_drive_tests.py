"""The page of the drive tests, by key events on the real executor: asked first, then held, as a jog is."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialog
from pytestqt.qtbot import QtBot

from app.extras.analyses.drive_test_view import DriveTestPage
from app.screen import page_table
from core.executor.snapshot import MachineState
from tests.screen.hands import LIMIT
from tests.screen.jog.bench import INCH, SHIFT, JogBench, Key
from tests.screen.yes import twist_out
from tests.texts import shows, text

SIZE = 0.01 * INCH


@pytest.fixture
def page(jog: JogBench) -> DriveTestPage:
    return on_page(jog)


def on_page(jog: JogBench) -> DriveTestPage:
    assert jog.frame.open_page("DRIVE TEST")
    jog.run(0.1)
    page = jog.frame.current_page
    assert isinstance(page, DriveTestPage)
    return page


def asked_and_held(jog: JogBench, key: Key = Key.Key_Right) -> None:
    """The first press asks, the second one is kept down."""
    jog.key(key)
    jog.run(0.1)
    jog.down(key)
    jog.run(0.2)


def stands(jog: JogBench) -> None:
    """It comes to rest and nothing moves it again."""
    jog.run(0.4)
    assert jog.shot.state is not MachineState.JOG
    rest = jog.shot.demand
    jog.run(1.5)
    assert jog.shot.demand == rest
    assert jog.shot.drive_test.completed_test_count == 0


def ramp(jog: JogBench) -> None:
    jog.key(Key.Key_F2)
    jog.run(0.05)


def test_the_first_press_asks_and_moves_nothing(jog: JogBench, page: DriveTestPage) -> None:
    jog.down(Key.Key_Right)
    jog.run(1.0)
    assert jog.shot.state is MachineState.IDLE
    assert jog.shot.demand == (0.0, 0.0, 0.0)
    assert jog.prompt == text(
        "jog.play-test",
        travel=text("jog.test-travel", axis="Z", here="0.00000 in", there="0.01000 in", seconds="1.0"),
        key="→",
    )
    jog.up(Key.Key_Right)
    jog.key(Key.Key_Left)  # another arrow asks anew
    assert jog.shot.demand == (0.0, 0.0, 0.0)
    assert shows(jog.prompt, "jog.test-travel", there="−0.01000 in")
    jog.key(Key.Key_Escape)
    assert page.model.held_jog.requested_direction is None


def test_completed_drive_test_is_recorded_with_results(
    qtbot: QtBot, jog: JogBench, page: DriveTestPage
) -> None:
    asked_and_held(jog)
    assert jog.shot.state is MachineState.JOG
    assert jog.shot.drive_test.tested_axis == "Z"
    jog.run(1.5)
    assert jog.shot.state is MachineState.IDLE
    jog.up(Key.Key_Right)
    assert jog.shot.drive_test.completed_test_count == 1
    assert jog.shot.demand[1] == pytest.approx(0.0, abs=1e-9)
    assert jog.desk.desk_control.recordings is not None
    jog.desk.desk_control.recordings.store_queued_ticks()

    def worked_out() -> bool:
        jog.run(0.01)
        return page.model.results is not None

    qtbot.waitUntil(worked_out, timeout=60_000)  # on a worker, whose time is not the machine's
    found = page.model.results
    assert found is not None
    assert [each.step_size_mm for each in found.step_responses] == pytest.approx([SIZE, -SIZE])
    assert page.model.saved_record_name.startswith(text("jog.drive-test-of", axis="Z", kind="step"))
    assert (page.model.scope.recording_store.folder / page.model.saved_record_name).exists()
    kept = page.model.scope.recording_store.read_recording(
        page.model.scope.recording_store.folder / page.model.saved_record_name
    )
    assert text("jog.drive-test") in kept.about
    titles = [page.model.make_table().rows[0].cells[0]]
    for _ in range(3):
        jog.key(Key.Key_F5)
        titles.append(page.model.make_table().rows[0].cells[0])
    assert titles == ["RISE, 10 TO 90 %", "FOLLOWING LAG", "SHAPE", "RISE, 10 TO 90 %"]
    assert not page.model.make_drawing().has_equal_axes


def test_key_held_down_after_the_end_starts_no_second_test(jog: JogBench, page: DriveTestPage) -> None:
    asked_and_held(jog)
    jog.run(4.0)
    assert jog.shot.drive_test.number == 1
    jog.up(Key.Key_Right)
    jog.key(Key.Key_Right)  # asks again, and no more
    jog.run(0.5)
    assert jog.shot.drive_test.number == 1
    assert "HOLD" in page.find_pending_question()


def test_key_release_ends_the_drive_test(jog: JogBench, page: DriveTestPage) -> None:
    ramp(jog)
    asked_and_held(jog)
    assert jog.shot.state is MachineState.JOG
    jog.up(Key.Key_Right)
    stands(jog)
    assert page.model.results is None


def test_key_repeat_does_not_end_the_test_but_its_absence_does(jog: JogBench, page: DriveTestPage) -> None:
    jog.key(Key.Key_F2)
    jog.key(Key.Key_F2)
    asked_and_held(jog)  # the series of sines takes 12 s
    for _ in range(40):
        jog.repeats(Key.Key_Right)
        jog.run(0.03)
    assert jog.shot.state is MachineState.JOG
    jog.run(0.6)
    stands(jog)
    assert page.model.held_jog.active_jog is None


@pytest.mark.parametrize("key", [Key.Key_F2, Key.Key_F3, Key.Key_H, Key.Key_Escape, Key.Key_Up, Key.Key_R])
def test_any_other_key_ends_the_drive_test(jog: JogBench, page: DriveTestPage, key: Key) -> None:
    ramp(jog)
    asked_and_held(jog)
    jog.key(key)
    stands(jog)
    assert page.model.held_jog.active_jog is None


def test_losing_keyboard_focus_ends_the_drive_test(jog: JogBench, page: DriveTestPage, qtbot: QtBot) -> None:
    ramp(jog)
    asked_and_held(jog)
    other = QDialog()
    with qtbot.waitActive(other, timeout=LIMIT):
        other.show()
        other.activateWindow()
    stands(jog)
    other.close()
    other.deleteLater()
    assert page.model.held_jog.active_jog is None


def test_hung_screen_ends_the_drive_test(jog: JogBench, page: DriveTestPage) -> None:
    ramp(jog)
    asked_and_held(jog)
    jog.run(0.6, screen=False)
    assert jog.shot.state is MachineState.IDLE
    stands(jog)
    assert page.model.results is None


def test_changing_the_page_ends_the_drive_test(jog: JogBench, page: DriveTestPage) -> None:
    ramp(jog)
    asked_and_held(jog)
    jog.frame.open_page(page_table.SCOPE)
    stands(jog)
    assert page.model.held_jog.requested_direction is None


def test_touch_asks_first_and_then_runs_while_pressed(jog: JogBench, page: DriveTestPage) -> None:
    ramp(jog)
    jog.run(0.1)
    box = next(
        each.box for each in page.jog_cross.controls if each.box.center().x() > page.jog_cross.width() * 0.7
    )
    spot = QPoint(round(box.center().x()), round(box.center().y()))
    QTest.mouseClick(page.jog_cross, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, spot)
    jog.run(0.3)
    assert jog.shot.state is MachineState.IDLE
    QTest.mousePress(page.jog_cross, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, spot)
    jog.run(0.2)
    assert jog.shot.state is MachineState.JOG
    QTest.mouseRelease(page.jog_cross, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, spot)
    stands(jog)


# --- refusals -----------------------------------------------------------------------------------------------


def test_drive_test_has_no_rapid(jog: JogBench, page: DriveTestPage) -> None:
    jog.key(Key.Key_Right)
    jog.down(Key.Key_Right, SHIFT)
    jog.run(0.3)
    assert shows(jog.prompt, "jog.test-no-rapid")
    assert page.model.held_jog.active_jog is None
    assert jog.shot.demand == (0.0, 0.0, 0.0)


def test_drive_test_in_estop_is_rejected_with_a_message(jog: JogBench, page: DriveTestPage) -> None:
    jog.key(Key.Key_E)
    jog.run(0.3)
    jog.key(Key.Key_Right)
    jog.down(Key.Key_Right)
    jog.run(0.3)
    assert jog.shot.state is MachineState.ESTOP
    assert jog.shot.drive_test.number == 0
    assert "E-STOP" in page.prompt_text()
    jog.up(Key.Key_Right)
    twist_out(jog.window)


def test_an_axis_that_is_not_homed_is_not_tested(lost: JogBench) -> None:
    page = on_page(lost)
    lost.key(Key.Key_Right)
    assert shows(page.find_pending_question(), "jog.test-not-homed", axis="Z")
    lost.down(Key.Key_Right)
    lost.run(0.5)
    assert lost.shot.demand[1] == 0.0
    assert lost.shot.drive_test.number == 0


def test_insufficient_travel_is_reported_before_the_test(jog: JogBench, page: DriveTestPage) -> None:
    assert jog.desk.machine.machine is not None
    travel = jog.desk.machine.machine.find_axis("Z").travel
    assert travel is not None
    jog.frame.open_page(page_table.JOG)
    jog.down(Key.Key_Right, SHIFT)
    jog.run(0.1)
    jog.until(lambda: jog.shot.state is not MachineState.JOG or jog.shot.demand[1] > travel[1] - 0.05)
    jog.up(Key.Key_Right)
    jog.rests()
    on_page(jog)
    here = jog.shot.demand
    jog.key(Key.Key_Right)
    assert shows(jog.prompt, "jog.no-room", axis="Z")
    jog.down(Key.Key_Right)
    jog.run(0.5)
    assert jog.shot.demand == here
    assert jog.shot.drive_test.number == 0
    assert page.model.held_jog.active_jog is None
