"""A shift at the Automatic page, by keys alone."""

from __future__ import annotations

from dataclasses import replace

import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QApplication

from app.desk.programs.program_loading import LoadingPhase
from app.desk.status.prompt_line import CONFIRM_CANCEL, FILE_NOT_FOUND_TEXT, ONE_PALM_PRESSED
from core.executor.commands import CycleStart, FeedHold, Reset
from core.executor.snapshot import Alarm, MachineState
from tests.screen.hands import Hands, Key
from tests.screen.yes import twist_out, yes
from tests.texts import begins, shows, text


def test_cycle_start_hold_resume_single_block_estop_and_recovery(hands: Hands) -> None:
    hands.load("bushing")
    assert hands.frame.title_line.program_text == "bushing.nc"
    hands.both_palms()
    hands.sees_state(MachineState.RUN)
    hands.sees(lambda: hands.machine.now.line > 4)
    hands.key(Key.Key_H)
    hands.sees_state(MachineState.HOLD)
    assert begins(hands.prompt(), "screen.to-go-on")
    hands.both_palms()
    hands.sees_state(MachineState.RUN)
    hands.key(Key.Key_S)
    hands.sees_state(MachineState.SINGLE_BLOCK_STOP)
    block = hands.machine.at
    hands.both_palms()
    hands.sees(lambda: hands.machine.at > block and hands.machine.now.state is MachineState.SINGLE_BLOCK_STOP)
    hands.key(Key.Key_E)
    hands.sees_state(MachineState.ESTOP)
    hands.key(Key.Key_D)
    assert shows(hands.prompt(), "screen.e-stop-pressed")
    twist_out(hands.window)
    hands.sees_state(MachineState.DISABLED)
    hands.key(Key.Key_D)
    hands.sees_state(MachineState.IDLE)
    hands.key(Key.Key_S)
    hands.both_palms()
    hands.sees_state(MachineState.RUN)


def counted(hands: Hands) -> object:
    times = hands.frame.times_panel.value
    return times[0] if isinstance(times, tuple) else None


def test_complete_cycle_counts_a_part_and_returns_to_idle(hands: Hands) -> None:
    hands.machine.step = 0.5
    hands.load("grooves")
    hands.both_palms()
    hands.sees(lambda: hands.machine.now.parts == 1)
    hands.sees_state(MachineState.IDLE)
    hands.sees(lambda: counted(hands) == ("PARTS", "1"))


def test_optional_stop_shows_its_comment_in_large_text(hands: Hands) -> None:
    hands.machine.step = 1.0
    hands.load("bushing")
    hands.key(Key.Key_O)
    hands.both_palms()
    hands.sees_state(MachineState.PROGRAM_STOP)
    hands.sees(hands.frame.alarm_notice.isVisible)
    assert hands.frame.alarm_notice.message == "GAUGE THE OUTSIDE AND CORRECT D1"
    hands.both_palms()
    hands.sees(lambda: not hands.frame.alarm_notice.isVisible())


def test_file_not_found_is_cleared_by_any_key(hands: Hands) -> None:
    hands.key(Key.Key_F2)
    hands.type("nosuch")
    hands.key(Key.Key_Return)
    assert hands.page.file_prompt.message_text == FILE_NOT_FOUND_TEXT
    hands.key(Key.Key_X)
    assert hands.page.file_prompt.message_text == ""
    assert hands.page.file_prompt.name_edit.text() == "nosuch"
    hands.type("knob")  # what was wrong is marked and typed over
    hands.key(Key.Key_Return)
    hands.sees(lambda: hands.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    assert hands.desk.program_loader.loaded_program.name == "knob.nc"


def test_esc_leaves_loaded_program_unchanged(hands: Hands) -> None:
    hands.load("pin")
    hands.key(Key.Key_F2)
    hands.type("knob")
    hands.key(Key.Key_Escape)
    assert not hands.page.file_prompt.isVisible()
    assert hands.desk.program_loader.loaded_program.name == "pin.nc"
    hands.key(Key.Key_S)  # the keyboard is the page's again
    hands.sees(lambda: hands.machine.now.single_block)


def test_program_is_selected_from_list_by_arrows(hands: Hands) -> None:
    hands.key(Key.Key_F2)
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Down)
    hands.key(Key.Key_Up)
    hands.key(Key.Key_Return)
    hands.sees(lambda: hands.desk.program_loader.loaded_program.phase is LoadingPhase.READY)
    assert hands.desk.program_loader.loaded_program.name == "fitting.mpf"


@pytest.mark.parametrize("palm", [Key.Key_F11, Key.Key_F12])
def test_one_palm_button_does_not_start_cycle(hands: Hands, palm: Key) -> None:
    hands.load("pin")
    hands.down(palm)
    hands.up(palm)
    assert CycleStart() not in hands.machine.posted
    assert hands.prompt() == ONE_PALM_PRESSED


def test_auto_repeat_of_palm_keys_is_one_press(hands: Hands) -> None:
    hands.load("pin")
    hands.down(Key.Key_F11)
    for _ in range(5):
        again = QKeyEvent(
            QEvent.Type.KeyPress, Key.Key_F12, Qt.KeyboardModifier.NoModifier, autorep=True, count=1
        )
        QApplication.sendEvent(hands.window, again)
    assert CycleStart() not in hands.machine.posted
    hands.up(Key.Key_F11)


def test_loss_of_keyboard_focus_releases_palm_button(hands: Hands) -> None:
    hands.load("pin")
    hands.down(Key.Key_F11)
    assert hands.machine.palms == {"left"}
    hands.window.release_all_inputs()
    assert hands.machine.palms == set()
    hands.down(Key.Key_F12)
    assert CycleStart() not in hands.machine.posted
    hands.up(Key.Key_F12)


def test_no_start_without_a_program(hands: Hands) -> None:
    hands.both_palms()
    hands.sees(lambda: hands.prompt() == text("screen.no-start", why="NO PROVED PROGRAM"))


def test_start_is_rejected_during_alarm(hands: Hands) -> None:
    hands.load("pin")
    hands.machine.fault(Alarm(102, "following", "FOLLOWING ERROR", "blocked", "free the slide", line=4))
    hands.sees_state(MachineState.FAULT)
    hands.both_palms()
    hands.sees(lambda: hands.prompt() == text("screen.no-start", why="AN ALARM STANDS"))
    assert hands.frame.alarm_notice.isVisible()
    hands.key(Key.Key_R)
    hands.sees_state(MachineState.DISABLED)
    assert not hands.frame.alarm_notice.isVisible()
    hands.key(Key.Key_F7)
    assert hands.frame.alarm_list.isVisible()
    assert [entry.alarm.code for entry in hands.frame.alarm_list.logged_stops] == ["following"]
    hands.key(Key.Key_Escape)
    assert not hands.frame.alarm_list.isVisible()


def test_a_program_with_errors_is_shown_and_refused(
    hands: Hands, tmp_path_factory: pytest.TempPathFactory
) -> None:
    bad = tmp_path_factory.mktemp("programs") / "bad.nc"
    bad.write_text("G90G94F300\nX1Z0\nG2X2Z1R5\nM30\n")
    hands.key(Key.Key_F2)
    hands.type(str(bad))
    hands.key(Key.Key_Return)
    hands.sees(lambda: hands.prompt().startswith(text("screen.will-not-run", why="LINE 3")))
    hands.both_palms()
    hands.sees(lambda: hands.prompt() == text("screen.no-start", why="THE PROGRAM HAS ERRORS"))


def test_reset_of_interrupted_program_asks_once(hands: Hands) -> None:
    hands.load("pin")
    hands.both_palms()
    hands.sees_state(MachineState.RUN)
    hands.key(Key.Key_R)
    assert shows(hands.prompt(), "screen.feed-hold-first")
    hands.key(Key.Key_Space)
    hands.sees_state(MachineState.HOLD)
    hands.key(Key.Key_R)
    assert hands.prompt() == CONFIRM_CANCEL
    hands.key(Key.Key_R)
    assert Reset() not in hands.machine.posted  # never the key that asked
    yes(hands.window)
    assert Reset() in hands.machine.posted
    hands.sees_state(MachineState.IDLE)


def test_program_change_and_exit_are_rejected_while_one_runs(hands: Hands) -> None:
    hands.load("pin")
    hands.both_palms()
    hands.sees_state(MachineState.RUN)
    hands.key(Key.Key_F2)
    assert not hands.page.file_prompt.isVisible()
    hands.window.close()
    assert hands.window.isVisible()
    assert shows(hands.prompt(), "screen.program-runs-no-leaving")


def test_cycle_started_at_station_closes_question(hands: Hands) -> None:
    hands.load("pin")
    hands.key(Key.Key_F2)
    hands.machine.post(CycleStart())
    hands.sees(lambda: not hands.page.file_prompt.isVisible())
    hands.key(Key.Key_H)
    assert FeedHold() in hands.machine.posted


def test_palm_keys_start_nothing_while_a_name_is_typed(hands: Hands) -> None:
    hands.load("pin")
    hands.key(Key.Key_F2)
    hands.both_palms()
    assert CycleStart() not in hands.machine.posted


def test_arrows_move_picture_only_with_ctrl(hands: Hands) -> None:
    hands.load("knob")
    hands.sees(lambda: hands.page.path_view.first_projection is not None)
    before = hands.page.path_view.first_projection
    hands.key(Key.Key_Left)
    assert hands.page.path_view.first_projection == before
    hands.key(Key.Key_Left, Qt.KeyboardModifier.ControlModifier)
    assert hands.page.path_view.first_projection != before
    hands.key(Key.Key_F5)
    assert hands.page.path_view.first_projection == before


def test_block_delete_proves_the_program_again(hands: Hands) -> None:
    hands.load("grooves")
    whole = hands.desk.program_loader.loaded_program.picture
    hands.key(Key.Key_Slash)
    hands.sees(
        lambda: (
            hands.machine.now.block_delete
            and hands.desk.program_loader.loaded_program.phase is LoadingPhase.READY
        )
    )
    shorter = hands.desk.program_loader.loaded_program.picture
    assert whole is not None
    assert shorter is not None
    assert shorter.blocks < whole.blocks


def test_prompt_with_drives_off_asks_for_drives(hands: Hands) -> None:
    hands.machine.now = replace(hands.machine.now, state=MachineState.DISABLED)
    hands.sees(lambda: hands.prompt() == text("screen.drives-off"))


def test_readout_and_theme_change_by_key(hands: Hands) -> None:
    hands.key(Key.Key_F4)
    hands.sees(lambda: hands.frame.position_panel.readout_kind == text("screen.distance-to-go"))
    hands.key(Key.Key_T)
    assert hands.window.theme.palette.name == "light"
    hands.key(Key.Key_T)
    assert hands.window.theme.palette.name == "contrast"
    hands.key(Key.Key_T)
    assert hands.window.theme.palette.name == "dark"
