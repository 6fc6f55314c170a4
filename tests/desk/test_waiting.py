"""WAITING: what is waited for and how it ends; NOT HOMED; a success and a refusal look different."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.desk.status.machine_status import GIVES_UP, NOT_HOMED, Tone, how_it_ends, status_of, waits_for
from app.desk.status.prompt_line import PromptAnswers, Sort
from app.desk.status.readouts import Readout
from core.executor.snapshot import Snapshot, State
from tests.texts import text

WAITS = replace(Snapshot(), state=State.WAIT, homed=(True, True, True))


def test_a_wait_for_an_input_names_the_state_it_waits_for() -> None:
    waits = replace(WAITS, waiting_for="TB2-5")
    assert waits_for(waits) == text("desk.input-to-come", name="TB2-5", state="ON")
    assert waits_for(replace(waits, inputs=frozenset({"TB2-5"}))) == text(
        "desk.input-to-come", name="TB2-5", state="OFF"
    )
    told = how_it_ends(waits)
    assert told.endswith(GIVES_UP)
    assert "F10, 3" not in told
    assert "F10, 3" in how_it_ends(waits, simulated=True)


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
def test_every_other_wait_says_how_it_ends(what: str, key: str) -> None:
    waits = replace(WAITS, waiting_for=what)
    assert waits_for(waits) == what
    assert key in how_it_ends(waits)


def test_a_wait_that_nobody_knows_is_not_made_up() -> None:
    assert how_it_ends(replace(WAITS, waiting_for="SOMETHING ELSE")) == ""
    assert how_it_ends(WAITS) == ""


def test_not_homed_is_a_state_of_its_own() -> None:
    lost = replace(Snapshot(), state=State.IDLE, homed=(True, False, True))
    view = status_of(lost, Readout.POSITION, with_c=True)
    assert (view.state, view.tone) == (NOT_HOMED, Tone.OFF)
    known = status_of(replace(lost, homed=(True,) * 3), Readout.POSITION, with_c=True)
    assert (known.state, known.tone) == (State.IDLE.value, Tone.READY)
    off = status_of(replace(lost, state=State.DISABLED), Readout.POSITION, with_c=True)
    assert off.state == State.DISABLED.value  # the drives come first


def test_success_question_and_refusal_are_told_apart() -> None:
    answers = PromptAnswers(Snapshot, str, lambda: 0.0)
    answers.say("T1 SAVED", done=True)
    assert answers.sort is Sort.DONE
    answers.ask("PRESS Y", lambda: None)
    assert answers.sort is Sort.ASKED
    answers.say("REFUSED: NO")
    assert answers.sort is Sort.ANSWER


def test_an_answer_outlives_every_state_and_ends_after_four_seconds() -> None:
    now, clock = [replace(Snapshot(), state=State.RUN)], [0.0]
    answers = PromptAnswers(lambda: now[0], str, lambda: clock[0])
    answers.say("TOUCH OFF WITH THE MACHINE AT REST AND READY")
    for clock[0], state in ((0.1, State.HOLDING), (0.4, State.HOLD), (3.9, State.ESTOP)):
        answers.expire(replace(Snapshot(), state=state))
        assert answers.answer
    clock[0] = 4.0
    answers.expire(replace(Snapshot(), state=State.ESTOP))
    assert answers.answer == ""


def test_a_question_belongs_to_its_state_and_an_answer_does_not_replace_it() -> None:
    done: list[str] = []
    now = [replace(Snapshot(), state=State.HOLD)]
    answers = PromptAnswers(lambda: now[0], str, lambda: 0.0)
    answers.ask("PRESS Y", lambda: done.append("yes"))
    answers.say("REFUSED: NO")
    assert (answers.question, answers.answer) == ("PRESS Y", "REFUSED: NO")
    answers.expire(now[0])
    assert answers.asked is not None
    answers.expire(replace(Snapshot(), state=State.ESTOP))
    answers.yes(9.0)
    assert not done


def test_a_lasting_answer_remains_for_its_four_seconds_whatever_is_pressed() -> None:
    clock = [0.0]
    answers = PromptAnswers(Snapshot, str, lambda: clock[0])
    answers.say("DROPPED", lasting=True)
    answers.next_key()
    answers.take_back()
    answers.say("THE DRIVES ARE ON")
    assert answers.answer == "DROPPED"
    clock[0] = 4.0
    answers.say("THE DRIVES ARE ON")
    answers.next_key()
    assert answers.answer == ""
