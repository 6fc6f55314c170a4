"""The known accidents of hand moves, by key events on the real executor: the slide stops and stays so."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialog
from pytestqt.qtbot import QtBot

from app.screen import page_table
from core.executor.snapshot import MachineState
from tests.screen.hands import LIMIT
from tests.screen.jog.bench import INCH, SHIFT, JogBench, Key
from tests.screen.yes import twist_out
from tests.texts import shows, text

SLOW = 5 * INCH / 60  # mm/s: the speed that is chosen at first
AMAX = 120 * INCH
LEASE = 0.2
RUN_ON = LEASE * SLOW + SLOW * SLOW / (2 * AMAX) + 0.03 * SLOW + 0.002


def moving(jog: JogBench, key: Key = Key.Key_Left) -> float:
    """An arrow is held and the slide moves; where it is."""
    jog.down(key)
    jog.run(0.5)
    assert jog.shot.state is MachineState.JOG
    assert jog.shot.demand[1] < -0.3 * SLOW
    return jog.shot.demand[1]


def stands(jog: JogBench, at: float, run_on: float = RUN_ON) -> None:
    """It comes to rest within what a lease allows, and nothing moves it again."""
    jog.run(0.5)
    assert jog.shot.state is not MachineState.JOG
    rest = jog.shot.demand[1]
    assert at - rest <= run_on
    jog.run(1.0)
    assert jog.shot.demand[1] == rest
    assert jog.shot.alarms == ()


@pytest.mark.parametrize(
    ("key", "axis", "sign"),
    [
        (Key.Key_Left, 1, -1),
        (Key.Key_Right, 1, 1),
        (Key.Key_Down, 0, 1),
        (Key.Key_Up, 0, -1),
        (Key.Key_PageUp, 2, 1),
        (Key.Key_PageDown, 2, -1),
    ],
)
def test_each_arrow_moves_its_axis_while_it_is_held(jog: JogBench, key: Key, axis: int, sign: int) -> None:
    jog.down(key)
    jog.run(1.0)
    speed = 15.0 if axis == 2 else SLOW
    assert sign * jog.shot.demand[axis] == pytest.approx(speed * 0.97, rel=0.05)
    jog.up(key)
    jog.rests()
    assert [place for at, place in enumerate(jog.shot.demand) if at != axis] == [0.0, 0.0]


def test_the_release_ends_it_at_once(jog: JogBench) -> None:
    at = moving(jog)
    jog.up(Key.Key_Left)
    stands(jog, at, 0.06 * SLOW)


def test_the_pairs_of_a_repeating_key_neither_end_it_nor_begin_it_again(jog: JogBench) -> None:
    moving(jog)
    for _ in range(20):
        jog.repeats(Key.Key_Left)
        jog.run(0.03)
    assert jog.shot.state is MachineState.JOG
    at = jog.shot.demand[1]
    jog.up(Key.Key_Left)
    jog.repeats(Key.Key_Left)
    stands(jog, at)


def test_a_missed_release_ends_with_the_silence_of_the_key(jog: JogBench) -> None:
    moving(jog)
    jog.repeats(Key.Key_Left)
    jog.run(0.55)
    stands(jog, jog.shot.demand[1])
    assert shows(jog.prompt, "jog.key-silent")


def test_the_window_that_loses_the_keyboard(jog: JogBench, qtbot: QtBot) -> None:
    at = moving(jog)
    other = QDialog()
    with qtbot.waitActive(other, timeout=LIMIT):
        other.show()
        other.activateWindow()
    stands(jog, at)
    other.close()
    other.deleteLater()
    jog.window.activateWindow()
    qtbot.waitUntil(jog.window.isActiveWindow, timeout=LIMIT)
    jog.run(0.3)
    assert shows(jog.prompt, "jog.keyboard-left-jog")
    jog.up(Key.Key_Left)
    moving_again = jog.shot.demand[1]
    jog.down(Key.Key_Left)
    jog.run(0.5)
    assert jog.shot.demand[1] < moving_again - 0.3 * SLOW  # recovered: the next press moves
    jog.up(Key.Key_Left)


def test_a_dialog_of_the_window(jog: JogBench, qtbot: QtBot) -> None:
    at = moving(jog)
    dialog = QDialog(jog.window)
    dialog.setModal(True)
    with qtbot.waitExposed(dialog, timeout=LIMIT):
        dialog.show()
    stands(jog, at)
    dialog.close()
    dialog.deleteLater()


def test_the_page_changes(jog: JogBench) -> None:
    at = moving(jog)
    jog.key(Key.Key_F8)
    assert jog.frame.current_page.NAME == page_table.TOOLS
    stands(jog, at)


def test_the_increment_changes_while_held(jog: JogBench) -> None:
    at = moving(jog)
    jog.key(Key.Key_F2)
    stands(jog, at)
    assert jog.page.model.jog_speeds.step_index == 0


def test_the_speed_changes_while_held(jog: JogBench) -> None:
    at = moving(jog)
    jog.key(Key.Key_F3)
    stands(jog, at)


@pytest.mark.parametrize("key", [Key.Key_S, Key.Key_F7, Key.Key_T, Key.Key_Shift, Key.Key_Control])
def test_any_other_key(jog: JogBench, key: Key) -> None:
    at = moving(jog)
    jog.key(key)
    stands(jog, at)


@pytest.mark.parametrize("key", [Key.Key_H, Key.Key_Space, Key.Key_Escape, Key.Key_E])
def test_what_a_hand_hits_in_a_hurry(jog: JogBench, key: Key) -> None:
    at = moving(jog)
    jog.key(key)
    stands(jog, at)


def test_two_arrows_at_once(jog: JogBench) -> None:
    at = moving(jog)
    jog.down(Key.Key_Up)
    stands(jog, at)
    assert jog.shot.demand[0] == 0.0
    assert shows(jog.prompt, "jog.two-at-once")
    jog.up(Key.Key_Left)
    jog.up(Key.Key_Up)


def test_the_other_direction_while_moving(jog: JogBench) -> None:
    at = moving(jog)
    jog.down(Key.Key_Right)
    stands(jog, at)
    jog.up(Key.Key_Left)
    jog.run(0.3)
    stands(jog, jog.shot.demand[1])  # the one that is still down does not begin by itself
    jog.up(Key.Key_Right)


def test_a_screen_that_stands_still(jog: JogBench) -> None:
    at = moving(jog)
    jog.run(2.0, screen=False)
    assert jog.shot.state is MachineState.IDLE
    assert at - jog.shot.demand[1] <= RUN_ON
    stands(jog, at)
    assert jog.page.model.held_jog.active_jog is None


def test_a_rapid_whose_shift_comes_up_first(jog: JogBench) -> None:
    jog.down(Key.Key_Shift)
    jog.down(Key.Key_Left, SHIFT)
    jog.run(0.4)
    assert jog.shot.velocity == pytest.approx(100 * INCH / 60, rel=0.05)
    at = jog.shot.demand[1]
    jog.up(Key.Key_Shift)
    fast = 100 * INCH / 60
    stands(jog, at, 0.06 * fast + fast * fast / (2 * AMAX))
    jog.up(Key.Key_Left)


def test_arrows_in_an_entry_move_nothing(jog: JogBench) -> None:
    jog.type("t")
    jog.down(Key.Key_Left)
    jog.run(0.5)
    assert jog.shot.demand == (0.0, 0.0, 0.0)
    assert shows(jog.prompt, "jog.entry-open")
    jog.up(Key.Key_Left)
    jog.key(Key.Key_Escape)
    moving(jog)
    jog.up(Key.Key_Left)


def test_a_chord_moves_nothing(jog: JogBench) -> None:
    jog.down(Key.Key_Left, Qt.KeyboardModifier.ControlModifier)
    jog.run(0.5)
    assert jog.shot.demand == (0.0, 0.0, 0.0)
    jog.up(Key.Key_Left)


def test_the_soft_limit_ends_it_and_it_is_said(jog: JogBench) -> None:
    jog.down(Key.Key_Right, SHIFT)
    jog.run(5.0)
    assert jog.shot.state is MachineState.IDLE
    assert jog.shot.demand[1] == pytest.approx(6 * INCH - 0.01, abs=1e-6)
    jog.up(Key.Key_Right)
    jog.down(Key.Key_Right)
    jog.run(1.0)
    assert jog.prompt == text("screen.refused", why=f"jog: {text('jog.end-of-travel', axis='Z', side='+')}")
    jog.up(Key.Key_Right)


def test_with_the_drives_off_it_says_why(jog: JogBench) -> None:
    jog.key(Key.Key_E)
    jog.run(0.1)
    twist_out(jog.window)
    jog.run(0.1)
    jog.down(Key.Key_Left)
    jog.run(0.3)
    assert jog.prompt == text("screen.drives-off-for-hands")
    jog.up(Key.Key_Left)


# --- fingers and the mouse ---------------------------------------------------------------------------------


def target(jog: JogBench, number: int) -> QPoint:
    """The middle of one of the six targets, in the order in which they are drawn."""
    jog.window.grab()
    controls = jog.page.jog_cross.controls[-6:]
    return controls[number].box.center().toPoint()


def test_a_finger_moves_while_it_stays(jog: JogBench) -> None:
    left = target(jog, 1)
    QTest.mousePress(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=left)
    jog.run(0.5)
    assert jog.shot.demand[1] < -0.3 * SLOW
    at = jog.shot.demand[1]
    QTest.mouseRelease(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=left)
    stands(jog, at)


def test_a_finger_that_slides_off_the_target(jog: JogBench) -> None:
    QTest.mousePress(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=target(jog, 1))
    jog.run(0.5)
    at = jog.shot.demand[1]
    QTest.mouseMove(jog.page.jog_cross, pos=target(jog, 2))
    stands(jog, at)
    QTest.mouseRelease(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=target(jog, 2))


def test_a_finger_and_a_key_at_once(jog: JogBench) -> None:
    at = moving(jog)
    QTest.mousePress(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=target(jog, 1))
    stands(jog, at)
    QTest.mouseRelease(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=target(jog, 1))


def test_a_finger_that_asks_for_something_while_a_key_is_held(jog: JogBench) -> None:
    at = moving(jog)
    jog.window.grab()
    box, *_ = jog.page.tool_panel._places[0]  # the tool's number
    QTest.mouseClick(jog.page.tool_panel, Qt.MouseButton.LeftButton, pos=box.center().toPoint())
    assert jog.page.model.tool_setting.question_name
    stands(jog, at)


def test_a_finger_on_a_lamp_while_a_key_is_held(jog: JogBench) -> None:
    at = moving(jog)
    jog.window.grab()
    box, *_ = jog.frame.strip._places[0]  # single block
    QTest.mouseClick(jog.frame.strip, Qt.MouseButton.LeftButton, pos=box.center().toPoint())
    stands(jog, at)


@pytest.mark.parametrize("size", [(1024, 600), (1280, 1024), (1920, 1080)])
def test_every_target_fits_a_finger_and_none_lies_on_another(jog: JogBench, size: tuple[int, int]) -> None:
    jog.window.resize(*size)
    jog.run(0.02)
    jog.window.grab()
    boxes = [control.box for control in jog.page.jog_cross.controls]
    assert len(boxes) == 5 + 5 + 4 + 6
    for number, box in enumerate(boxes):
        assert min(box.width(), box.height()) >= 30
        assert jog.page.jog_cross.find_full_area().contains(box)
        assert not any(box.intersects(other) for other in boxes[number + 1 :])
    for box in boxes[-6:]:
        assert min(box.width(), box.height()) >= 60  # 12.5 mm of the smallest panel


def test_a_machine_without_c_has_no_targets_and_no_keys_for_it(no_c: JogBench) -> None:
    no_c.window.grab()
    assert len(no_c.page.jog_cross.controls) == 5 + 5 + 3 + 4
    no_c.down(Key.Key_PageUp)
    no_c.run(0.3)
    no_c.up(Key.Key_PageUp)
    assert no_c.shot.demand == (0.0, 0.0, 0.0)
    assert no_c.shot.state is MachineState.IDLE


def test_rapid_that_a_finger_selected_ends_with_a_jog_by_key(jog: JogBench) -> None:
    model = jog.page.model
    model.toggle_rapid()
    jog.down(Key.Key_Left)
    assert model.held_jog.active_jog is not None
    assert not model.held_jog.active_jog.is_rapid
    jog.up(Key.Key_Left)
    jog.run(0.5)
    assert not model.held_jog.is_rapid_armed
    model.press_direction("finger", "Z", -1)
    assert model.held_jog.active_jog is not None
    assert not model.held_jog.active_jog.is_rapid
    model.release_all()


def test_rapid_that_a_finger_selected_holds_for_its_next_jog_alone(jog: JogBench) -> None:
    model = jog.page.model
    model.toggle_rapid()
    model.press_direction("finger", "Z", -1)
    assert model.held_jog.active_jog is not None
    assert model.held_jog.active_jog.is_rapid
    assert not model.held_jog.is_rapid_armed
    model.release_all()
