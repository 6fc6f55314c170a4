"""State, question and answer have separate places, and the prompt offers only what is accepted."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.desk.late_presses import BlockedLateAction
from app.desk.status.prompt_line import CHOOSE_FILE_TEXT, CONFIRM_CANCEL, MessageKind
from app.screen.page_table import list_menu_entries
from core.executor.commands import Reset
from core.executor.snapshot import MachineState
from tests.screen.hands import Hands, Key
from tests.screen.lathe import Operator


def test_prompt_line_shows_state_question_and_message_separately(hands: Hands) -> None:
    hands.load("pin")
    hands.sees_state(MachineState.IDLE)
    hands.desk.ask_operator(CONFIRM_CANCEL, lambda: None)
    hands.desk.say("AN ANSWER")
    hands.window.refresh()
    line = hands.frame.prompt_line
    assert (line.question_text, line.message_text, line.confirm_key) == (CONFIRM_CANCEL, "AN ANSWER", "Y")
    assert line.state_text not in {"", CONFIRM_CANCEL, "AN ANSWER"}
    assert line.message_kind is MessageKind.REFUSAL


def test_n_key_rejects_and_closes_question(hands: Hands) -> None:
    done: list[str] = []
    hands.desk.ask_operator(CONFIRM_CANCEL, lambda: done.append("yes"))
    hands.window.refresh()
    hands.key(Key.Key_N)
    assert (hands.desk.confirmation_key, done) == ("", [])
    assert not any(isinstance(each, Reset) for each in hands.machine.posted)


def test_dropped_input_is_reported_regardless_of_next_key(hands: Hands) -> None:
    hands.window.report_dropped_press(BlockedLateAction.CYCLE)
    hands.key(Key.Key_S)
    hands.key(Key.Key_O)
    assert hands.frame.prompt_line.message_text


def test_file_question_does_not_offer_start(hands: Hands) -> None:
    hands.key(Key.Key_F2)
    assert hands.page.file_prompt.isVisible()
    hands.window.refresh()
    assert hands.frame.prompt_line.state_text == CHOOSE_FILE_TEXT


def test_no_page_offers_a_start_that_is_refused(operator: Operator) -> None:
    desk, frame = operator.stage.desk, operator.window.frame
    assert frame is not None
    operator.stage.make_ready()
    operator.window.refresh()
    assert desk.start_instruction in frame.prompt_line.state_text
    for entry in list_menu_entries(desk.machine.program_language):
        if frame.open_page(entry.name):
            operator.window.refresh()
            assert desk.start_instruction not in frame.prompt_line.state_text or not desk.barred(), entry.name


@pytest.mark.parametrize(
    ("text", "starts"),
    [
        ("", False),
        ("G90G94F300\nT1\nX1Z.1\nM30\n", True),
        ("T29\nX1Z.1\nM30\n", False),
        ("G9O\n", False),
    ],
    ids=["no program", "a sound one", "a tool without an offset", "an error"],
)
def test_palm_buttons_are_lit_only_if_start_would_succeed(
    operator: Operator, tmp_path: Path, text: str, *, starts: bool
) -> None:
    operator.drives_on()
    if text:
        (tmp_path / "part.nc").write_text(text)
        operator.stage.desk.program_loader.start_loading(tmp_path / "part.nc")
        operator.stage.desk.program_loader.wait_until_loaded(30.0)
    operator.pause(0.2)
    operator.stage.checks_start()
    operator.window.refresh()
    assert operator.frame.station_dock is not None
    assert operator.frame.station_dock.is_start_disabled is not starts
    operator.palms()
    assert (operator.shot.state is MachineState.RUN) is starts
