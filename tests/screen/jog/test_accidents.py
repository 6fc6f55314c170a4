"""The known accidents of hand moves, by key events on the real executor: the slide stops and stays so."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialog
from pytestqt.qtbot import QtBot

from app.screen import page_table
from app.screen.window_layout import LOW_WINDOW_HEIGHT_PX
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
def test_each_arrow_jogs_its_axis_while_key_is_down(jog: JogBench, key: Key, axis: int, sign: int) -> None:
    jog.down(key)
    jog.run(1.0)
    speed = 15.0 if axis == 2 else SLOW
    assert sign * jog.shot.demand[axis] == pytest.approx(speed * 0.97, rel=0.05)
    jog.up(key)
    jog.rests()
    assert [place for at, place in enumerate(jog.shot.demand) if at != axis] == [0.0, 0.0]


def test_key_release_stops_jog_at_once(jog: JogBench) -> None:
    at = moving(jog)
    jog.up(Key.Key_Left)
    stands(jog, at, 0.06 * SLOW)


def test_auto_repeat_neither_stops_nor_restarts_jog(jog: JogBench) -> None:
    moving(jog)
    for _ in range(20):
        jog.repeats(Key.Key_Left)
        jog.run(0.03)
    assert jog.shot.state is MachineState.JOG
    at = jog.shot.demand[1]
    jog.up(Key.Key_Left)
    jog.repeats(Key.Key_Left)
    stands(jog, at)


def test_jog_with_missed_key_release_stops_on_key_timeout(jog: JogBench) -> None:
    moving(jog)
    jog.repeats(Key.Key_Left)
    jog.run(0.55)
    stands(jog, jog.shot.demand[1])
    assert shows(jog.prompt, "jog.key-silent")


def test_jog_stops_when_window_loses_keyboard_focus(jog: JogBench, qtbot: QtBot) -> None:
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


def test_jog_stops_when_dialog_opens(jog: JogBench, qtbot: QtBot) -> None:
    at = moving(jog)
    dialog = QDialog(jog.window)
    dialog.setModal(True)
    with qtbot.waitExposed(dialog, timeout=LIMIT):
        dialog.show()
    stands(jog, at)
    dialog.close()
    dialog.deleteLater()


def test_jog_stops_when_page_changes(jog: JogBench) -> None:
    at = moving(jog)
    jog.key(Key.Key_F8)
    assert jog.frame.current_page.NAME == page_table.TOOLS
    stands(jog, at)


def test_jog_stops_when_increment_changes(jog: JogBench) -> None:
    at = moving(jog)
    jog.key(Key.Key_F2)
    stands(jog, at)
    assert jog.page.model.jog_speeds.step_index == 0


def test_jog_stops_when_speed_changes(jog: JogBench) -> None:
    at = moving(jog)
    jog.key(Key.Key_F3)
    stands(jog, at)


@pytest.mark.parametrize("key", [Key.Key_S, Key.Key_F7, Key.Key_T, Key.Key_Shift, Key.Key_Control])
def test_jog_stops_on_any_other_key(jog: JogBench, key: Key) -> None:
    at = moving(jog)
    jog.key(key)
    stands(jog, at)


@pytest.mark.parametrize("key", [Key.Key_H, Key.Key_Space, Key.Key_Escape, Key.Key_E])
def test_jog_stops_on_hold_space_esc_and_estop_keys(jog: JogBench, key: Key) -> None:
    at = moving(jog)
    jog.key(key)
    stands(jog, at)


def test_jog_stops_when_two_arrows_are_down(jog: JogBench) -> None:
    at = moving(jog)
    jog.down(Key.Key_Up)
    stands(jog, at)
    assert jog.shot.demand[0] == 0.0
    assert shows(jog.prompt, "jog.two-at-once")
    jog.up(Key.Key_Left)
    jog.up(Key.Key_Up)


def test_jog_stops_on_opposite_arrow(jog: JogBench) -> None:
    at = moving(jog)
    jog.down(Key.Key_Right)
    stands(jog, at)
    jog.up(Key.Key_Left)
    jog.run(0.3)
    stands(jog, jog.shot.demand[1])  # the one that is still down does not begin by itself
    jog.up(Key.Key_Right)


def test_jog_stops_when_screen_freezes(jog: JogBench) -> None:
    at = moving(jog)
    jog.run(2.0, screen=False)
    assert jog.shot.state is MachineState.IDLE
    assert at - jog.shot.demand[1] <= RUN_ON
    stands(jog, at)
    assert jog.page.model.held_jog.active_jog is None


def test_rapid_jog_stops_when_shift_is_released_first(jog: JogBench) -> None:
    jog.down(Key.Key_Shift)
    jog.down(Key.Key_Left, SHIFT)
    jog.run(0.4)
    assert jog.shot.velocity == pytest.approx(100 * INCH / 60, rel=0.05)
    at = jog.shot.demand[1]
    jog.up(Key.Key_Shift)
    fast = 100 * INCH / 60
    stands(jog, at, 0.06 * fast + fast * fast / (2 * AMAX))
    jog.up(Key.Key_Left)


def test_arrows_in_entry_field_do_not_jog(jog: JogBench) -> None:
    jog.type("t")
    jog.down(Key.Key_Left)
    jog.run(0.5)
    assert jog.shot.demand == (0.0, 0.0, 0.0)
    assert shows(jog.prompt, "jog.entry-open")
    jog.up(Key.Key_Left)
    jog.key(Key.Key_Escape)
    moving(jog)
    jog.up(Key.Key_Left)


def test_arrow_with_modifier_does_not_jog(jog: JogBench) -> None:
    jog.down(Key.Key_Left, Qt.KeyboardModifier.ControlModifier)
    jog.run(0.5)
    assert jog.shot.demand == (0.0, 0.0, 0.0)
    jog.up(Key.Key_Left)


def test_jog_stops_at_soft_limit_with_message(jog: JogBench) -> None:
    jog.down(Key.Key_Right, SHIFT)
    jog.run(5.0)
    assert jog.shot.state is MachineState.IDLE
    assert jog.shot.demand[1] == pytest.approx(6 * INCH - 0.01, abs=1e-6)
    jog.up(Key.Key_Right)
    jog.down(Key.Key_Right)
    jog.run(1.0)
    assert jog.prompt == text("screen.refused", why=f"jog: {text('jog.end-of-travel', axis='Z', side='+')}")
    jog.up(Key.Key_Right)


def test_jog_with_drives_off_shows_reason(jog: JogBench) -> None:
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


def test_touch_jogs_while_target_is_pressed(jog: JogBench) -> None:
    left = target(jog, 1)
    QTest.mousePress(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=left)
    jog.run(0.5)
    assert jog.shot.demand[1] < -0.3 * SLOW
    at = jog.shot.demand[1]
    QTest.mouseRelease(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=left)
    stands(jog, at)


def test_jog_stops_when_touch_leaves_target(jog: JogBench) -> None:
    QTest.mousePress(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=target(jog, 1))
    jog.run(0.5)
    at = jog.shot.demand[1]
    QTest.mouseMove(jog.page.jog_cross, pos=target(jog, 2))
    stands(jog, at)
    QTest.mouseRelease(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=target(jog, 2))


def test_jog_stops_when_touch_and_key_are_down_together(jog: JogBench) -> None:
    at = moving(jog)
    QTest.mousePress(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=target(jog, 1))
    stands(jog, at)
    QTest.mouseRelease(jog.page.jog_cross, Qt.MouseButton.LeftButton, pos=target(jog, 1))


def test_jog_by_key_stops_when_touch_opens_question(jog: JogBench) -> None:
    at = moving(jog)
    jog.window.grab()
    box, *_ = jog.page.tool_panel._places[0]  # the tool's number
    QTest.mouseClick(jog.page.tool_panel, Qt.MouseButton.LeftButton, pos=box.center().toPoint())
    assert jog.page.model.tool_setting.question_name
    stands(jog, at)


def test_jog_by_key_stops_when_lamp_is_touched(jog: JogBench) -> None:
    at = moving(jog)
    jog.window.grab()
    box, *_ = jog.frame.strip._places[0]  # single block
    QTest.mouseClick(jog.frame.strip, Qt.MouseButton.LeftButton, pos=box.center().toPoint())
    stands(jog, at)


@pytest.mark.parametrize("size", [(1024, 600), (1280, 1024), (1920, 1080)])
def test_jog_targets_are_touch_sized_and_do_not_overlap(jog: JogBench, size: tuple[int, int]) -> None:
    jog.window.resize(*size)
    jog.run(0.02)
    jog.window.grab()
    boxes = [control.box for control in jog.page.jog_cross.controls]
    low = size[1] < LOW_WINDOW_HEIGHT_PX  # Step, speed and RAPID are then in the corners.
    assert len(boxes) == (3 if low else 5 + 5) + 4 + 6
    for number, box in enumerate(boxes):
        assert min(box.width(), box.height()) >= 30
        assert jog.page.jog_cross.find_full_area().contains(box)
        assert not any(box.intersects(other) for other in boxes[number + 1 :])
    for box in boxes[-6:]:
        assert min(box.width(), box.height()) >= 60  # 12.5 mm of the smallest panel


def test_machine_without_c_axis_has_no_c_targets_or_keys(no_c: JogBench) -> None:
    no_c.window.grab()
    assert len(no_c.page.jog_cross.controls) == 3 + 3 + 4
    no_c.down(Key.Key_PageUp)
    no_c.run(0.3)
    no_c.up(Key.Key_PageUp)
    assert no_c.shot.demand == (0.0, 0.0, 0.0)
    assert no_c.shot.state is MachineState.IDLE


def test_rapid_selected_by_touch_ends_with_jog_by_key(jog: JogBench) -> None:
    model = jog.page.model
    model.toggle_rapid()
    jog.down(Key.Key_Left)
    assert model.held_jog.active_jog is not None
    assert not model.held_jog.active_jog.is_rapid
    jog.up(Key.Key_Left)
    jog.run(0.5)
    assert not model.held_jog.is_rapid_armed
    model.handle_direction_press("finger", "Z", -1)
    assert model.held_jog.active_jog is not None
    assert not model.held_jog.active_jog.is_rapid
    model.release_all_keys()


def test_rapid_selected_by_touch_applies_to_next_jog_only(jog: JogBench) -> None:
    model = jog.page.model
    model.toggle_rapid()
    model.handle_direction_press("finger", "Z", -1)
    assert model.held_jog.active_jog is not None
    assert model.held_jog.active_jog.is_rapid
    assert not model.held_jog.is_rapid_armed
    model.release_all_keys()
