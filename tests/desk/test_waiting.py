"""WAITING: what is waited for and how it ends; NOT HOMED; a success and a refusal look different."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.desk.status.machine_status import (
    CANCEL_HINT,
    NOT_HOMED_TITLE,
    StatusTone,
    describe_wait,
    make_machine_status,
    make_wait_prompt,
)
from app.desk.status.prompt_line import MessageKind, PromptLine
from app.desk.status.readouts import ReadoutKind
from core.executor.snapshot import MachineState, Snapshot
from tests.texts import text

WAITS = replace(Snapshot(), state=MachineState.WAIT, homed=(True, True, True))


def test_wait_for_an_input_names_the_expected_state() -> None:
    waits = replace(WAITS, waiting_for="TB2-5")
    assert describe_wait(waits) == text("desk.input-to-come", name="TB2-5", state="ON")
    assert describe_wait(replace(waits, inputs=frozenset({"TB2-5"}))) == text(
        "desk.input-to-come", name="TB2-5", state="OFF"
    )
    told = make_wait_prompt(waits)
    assert told.endswith(CANCEL_HINT)
    assert "F10, 3" not in told
    assert "F10, 3" in make_wait_prompt(waits, is_simulated=True)


@pytest.mark.parametrize(
    ("what", "key"),
    [
        ("SPINDLE SWITCH OFF", text("desk.spindle-switch-off")),
        ("FEED OVERRIDE AT 0", text("desk.feed-pot-at-0")),
        ("SPINDLE OVERRIDE AT 0", text("desk.spindle-pot-at-0")),
        ("GUARD OPEN", text("desk.guard-open")),
        ("DWELL", text("desk.dwell")),
    ],
)
def test_every_other_wait_shows_how_it_ends(what: str, key: str) -> None:
    waits = replace(WAITS, waiting_for=what)
    assert describe_wait(waits) == what
    assert key in make_wait_prompt(waits)


def test_unknown_wait_condition_gives_no_prompt() -> None:
    assert make_wait_prompt(replace(WAITS, waiting_for="SOMETHING ELSE")) == ""
    assert make_wait_prompt(WAITS) == ""


def test_not_homed_is_shown_as_its_own_state() -> None:
    lost = replace(Snapshot(), state=MachineState.IDLE, homed=(True, False, True))
    view = make_machine_status(lost, ReadoutKind.POSITION, has_c_axis=True)
    assert (view.state_text, view.state_tone) == (NOT_HOMED_TITLE, StatusTone.OFF)
    known = make_machine_status(replace(lost, homed=(True,) * 3), ReadoutKind.POSITION, has_c_axis=True)
    assert (known.state_text, known.state_tone) == (MachineState.IDLE.value, StatusTone.READY)
    off = make_machine_status(
        replace(lost, state=MachineState.DISABLED), ReadoutKind.POSITION, has_c_axis=True
    )
    assert off.state_text == MachineState.DISABLED.value  # the drives come first


def test_success_question_and_refusal_have_different_kinds() -> None:
    answers = PromptLine(Snapshot, str, lambda: 0.0)
    answers.say("T1 SAVED", is_success=True)
    assert answers.notice_kind is MessageKind.SUCCESS
    answers.ask_question("PRESS Y", lambda: None)
    assert answers.notice_kind is MessageKind.QUESTION
    answers.say("REFUSED: NO")
    assert answers.notice_kind is MessageKind.REFUSAL


def test_message_survives_state_changes_and_expires_after_four_seconds() -> None:
    now, clock = [replace(Snapshot(), state=MachineState.RUN)], [0.0]
    answers = PromptLine(lambda: now[0], str, lambda: clock[0])
    answers.say("TOUCH OFF WITH THE MACHINE AT REST AND READY")
    for clock[0], state in (
        (0.1, MachineState.STOPPING),
        (0.4, MachineState.HOLD),
        (3.9, MachineState.ESTOP),
    ):
        answers.remove_expired_texts(replace(Snapshot(), state=state))
        assert answers.message
    clock[0] = 4.0
    answers.remove_expired_texts(replace(Snapshot(), state=MachineState.ESTOP))
    assert answers.message == ""


def test_question_ends_with_its_state_and_a_message_does_not_replace_it() -> None:
    done: list[str] = []
    now = [replace(Snapshot(), state=MachineState.HOLD)]
    answers = PromptLine(lambda: now[0], str, lambda: 0.0)
    answers.ask_question("PRESS Y", lambda: done.append("yes"))
    answers.say("REFUSED: NO")
    assert (answers.question_text, answers.message) == ("PRESS Y", "REFUSED: NO")
    answers.remove_expired_texts(now[0])
    assert answers.on_confirmed is not None
    answers.remove_expired_texts(replace(Snapshot(), state=MachineState.ESTOP))
    answers.confirm_question(9.0)
    assert not done


def test_lasting_message_remains_four_seconds_despite_key_presses() -> None:
    clock = [0.0]
    answers = PromptLine(Snapshot, str, lambda: clock[0])
    answers.say("DROPPED", is_lasting=True)
    answers.clear_message()
    answers.withdraw_question()
    answers.say("THE DRIVES ARE ON")
    assert answers.message == "DROPPED"
    clock[0] = 4.0
    answers.say("THE DRIVES ARE ON")
    answers.clear_message()
    assert answers.message == ""
