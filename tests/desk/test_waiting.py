"""WAITING: what is waited for and how it ends; NOT HOMED; a success and a refusal look different."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.desk.machine_status import NOT_HOMED, Tone, status_of
from app.desk.prompt_line import PromptAnswers, Sort
from app.desk.readouts import Readout
from app.desk.waiting import GIVES_UP, how_it_ends, waits_for
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


@pytest.mark.parametrize(
    ("said_in", "state", "over"),
    [
        (State.JOG, State.IDLE, False),  # the slide comes to rest: nobody has read it yet
        (State.HOLDING, State.HOLD, False),
        (State.JOG, State.ESTOP, True),
        (State.IDLE, State.JOG, True),
        (State.RUN, State.IDLE, True),
    ],
)
def test_an_answer_outlives_coming_to_rest_alone(said_in: State, state: State, over: bool) -> None:
    now = [replace(Snapshot(), state=said_in)]
    answers = PromptAnswers(lambda: now[0], str, lambda: 0.0)
    answers.say("TOUCH OFF WITH THE MACHINE AT REST AND READY")
    assert not answers.outlived(now[0])
    assert answers.outlived(replace(Snapshot(), state=state)) is over
    answers.ask("PRESS Y", lambda: None)  # a question is answered in its own state or never
    assert answers.outlived(replace(Snapshot(), state=state))
