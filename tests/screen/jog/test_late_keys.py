"""By hand, with presses that waited behind a stall of the screen: nothing moves before the next press."""

from __future__ import annotations

from app.desk.late_presses import BlockedLateAction, get_starting_action_name
from core.executor.snapshot import MachineState
from tests.screen.jog.bench import SHIFT, JogBench, Key
from tests.screen.yes import read
from tests.texts import shows


def late_down(jog: JogBench, *keys: Key) -> None:
    """Keys go down that waited behind a stall."""
    for key in keys:
        jog.window.set_event_late(is_late=True)
        jog.down(key)
    jog.window.set_event_late(is_late=False)


def told(jog: JogBench, starting: BlockedLateAction) -> bool:
    return shows(
        jog.desk.prompt_line.message, "screen.screen-stood-still", what=get_starting_action_name(starting)
    )


def moves(jog: JogBench, seconds: float = 1.0) -> bool:
    """Whether anything moves within this time."""
    before = jog.shot.demand
    jog.run(seconds)
    return jog.shot.demand != before or jog.shot.state in {MachineState.JOG, MachineState.HOMING}


def test_arrow_pressed_and_released_in_stall_does_not_jog(jog: JogBench) -> None:
    late_down(jog, Key.Key_Right)
    jog.window.set_event_late(is_late=True)
    jog.up(Key.Key_Right)
    assert not moves(jog)
    assert jog.page.model.held_jog.pressed_keys == set()
    assert told(jog, BlockedLateAction.JOG)


def test_arrow_down_through_stall_jogs_only_after_new_press(jog: JogBench) -> None:
    late_down(jog, Key.Key_Right)
    jog.repeats(Key.Key_Right)
    assert not moves(jog)
    jog.up(Key.Key_Right)
    jog.down(Key.Key_Right)
    assert moves(jog, 0.2)
    jog.up(Key.Key_Right)
    jog.rests()


def test_late_step_is_dropped_and_late_step_selection_counts(jog: JogBench) -> None:
    jog.window.set_event_late(is_late=True)
    jog.key(Key.Key_F2)
    assert jog.page.model.jog_speeds.step_index == 0
    late_down(jog, Key.Key_Right)
    assert not moves(jog)
    jog.up(Key.Key_Right)
    jog.key(Key.Key_Right)
    assert moves(jog)


def test_late_second_key_stops_active_jog(jog: JogBench) -> None:
    jog.down(Key.Key_Right)
    assert moves(jog, 0.2)
    late_down(jog, Key.Key_Up)
    jog.rests()
    assert not moves(jog)


def test_late_touch_does_not_jog(jog: JogBench) -> None:
    jog.window.set_event_late(is_late=True)
    jog.page.model.handle_direction_press("finger Z1", "Z", 1)
    jog.window.set_event_late(is_late=False)
    assert not moves(jog)


def test_late_rapid_does_not_start_after_shift_is_released(jog: JogBench) -> None:
    jog.window.set_event_late(is_late=True)
    jog.down(Key.Key_Right, SHIFT)
    jog.window.set_event_late(is_late=False)
    assert not moves(jog)


def test_late_home_key_asks_and_does_not_start_homing(lost: JogBench) -> None:
    lost.window.set_event_late(is_late=True)
    lost.key(Key.Key_Home)
    assert lost.desk.confirmation_key == "Enter"
    read(lost.desk)
    late_down(lost, Key.Key_Return)
    assert not moves(lost)
    assert told(lost, BlockedLateAction.YES)
    lost.up(Key.Key_Return)
    lost.key(Key.Key_Return)
    assert moves(lost, 0.2)


def test_late_axis_letter_does_not_start_homing(lost: JogBench) -> None:
    lost.key(Key.Key_Home)
    read(lost.desk)
    late_down(lost, Key.Key_X)
    assert not moves(lost)
    assert told(lost, BlockedLateAction.HOME)


def test_late_key_deselects_handwheel_but_does_not_select_it(wheeled: JogBench) -> None:
    late_down(wheeled, Key.Key_V)
    wheeled.run(0.3)
    assert wheeled.shot.wheel == ""
    assert told(wheeled, BlockedLateAction.HANDWHEEL)
    wheeled.up(Key.Key_V)
    wheeled.key(Key.Key_V)
    wheeled.run(0.3)
    assert wheeled.shot.wheel == "X"
    wheeled.window.set_event_late(is_late=True)
    wheeled.key(Key.Key_Escape)
    wheeled.run(0.3)
    assert wheeled.shot.wheel == ""


def test_late_letter_opens_value_entry(jog: JogBench) -> None:
    jog.window.set_event_late(is_late=True)
    jog.type("t")
    jog.window.set_event_late(is_late=False)
    assert jog.page.model.is_entry_open
