"""State, question and answer have separate places, and the prompt offers only what is accepted."""

from __future__ import annotations

from app.desk.prompt_line import CHOOSE_FILE, GIVE_UP, Sort
from app.screen.page_table import IN_MENU
from core.executor.commands import Reset
from core.executor.snapshot import State
from tests.screen.hands import Hands, Key


def test_three_places_one_subject_each(hands: Hands) -> None:
    hands.load("rough.nc")
    hands.sees_state(State.IDLE)
    hands.desk.ask(GIVE_UP, lambda: None)
    hands.desk.say("AN ANSWER")
    hands.window.refresh()
    line = hands.frame.prompt
    assert (line.question, line.answer, line.asked) == (GIVE_UP, "AN ANSWER", "Y")
    assert line.state not in {"", GIVE_UP, "AN ANSWER"}
    assert line.sort is Sort.ANSWER


def test_n_is_no_and_the_question_is_gone(hands: Hands) -> None:
    done: list[str] = []
    hands.desk.ask(GIVE_UP, lambda: done.append("yes"))
    hands.window.refresh()
    hands.key(Key.Key_N)
    assert (hands.desk.asked, done) == ("", [])
    assert not any(isinstance(each, Reset) for each in hands.machine.posted)


def test_dropped_input_is_reported_whatever_is_pressed_next(hands: Hands) -> None:
    hands.window.forgotten(0.6)
    hands.key(Key.Key_S)
    hands.key(Key.Key_O)
    assert hands.frame.prompt.answer


def test_the_question_for_a_file_offers_no_start(hands: Hands) -> None:
    hands.key(Key.Key_F2)
    assert hands.page.files.isVisible()
    hands.window.refresh()
    assert hands.frame.prompt.state == CHOOSE_FILE


def test_a_start_is_offered_where_the_page_starts_cycles_alone(hands: Hands) -> None:
    hands.load("rough.nc")
    hands.sees_state(State.IDLE)
    for entry in IN_MENU:
        if not hands.frame.go(entry.name):
            continue
        hands.window.refresh()
        offered = hands.desk.start_words in hands.frame.prompt.state
        assert not (offered and hands.desk.barred()), entry.name
