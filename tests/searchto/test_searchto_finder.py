"""A line of a program by number or text; the worker that finds it."""

from __future__ import annotations

import threading

import pytest

from app.compose.workshop import rebuilt
from app.desk.programs.program_loading import Proved
from app.searchto.searchto_finder import LineCursor, LineFinder
from core.executor.job import Job, Proof, make_job
from core.interpreter.restart.restart_point import NoRestart, RestartPoint
from core.language.source import Source
from tests.interpreter.programs import setup

LINES = ("G90G94F300", "X1Z1(FACE)", "Z0", "X.5", "z.5(face again)", "M30")
LIMIT = 60.0


def typed(text: str, line: int = 1) -> LineCursor:
    cursor = LineCursor(LINES, line)
    for key in text:
        assert cursor.type(key)
    return cursor


def test_figures_are_a_number_and_with_a_quotation_mark_a_text() -> None:
    assert typed("12").number == 12
    assert typed('"12').number is None
    assert typed('"12').wanted == "12"
    assert typed("x1").number is None


def test_next_and_previous_go_round_the_end_and_know_no_case() -> None:
    cursor = typed("(face")
    assert cursor.find(1)
    assert cursor.line == 2
    assert cursor.find(1)
    assert cursor.line == 5
    assert cursor.find(1)
    assert cursor.line == 2
    assert cursor.find(-1)
    assert cursor.line == 5


def test_a_text_that_is_nowhere_leaves_the_cursor_where_it_is() -> None:
    cursor = typed("QQ", 3)
    assert not cursor.find(1)
    assert cursor.line == 3
    assert not typed("", 3).find(1)


@pytest.mark.parametrize(("line", "there"), [(-5, 1), (0, 1), (4, 4), (99, 6)])
def test_the_cursor_stays_in_the_program(line: int, there: int) -> None:
    cursor = LineCursor(LINES)
    cursor.go(line)
    assert cursor.line == there


def test_editing_keys() -> None:
    cursor = typed("X.55")
    cursor.type("Back")
    assert cursor.text == "X.5"
    cursor.type("Delete")
    assert cursor.text == ""
    assert not cursor.type("Tab")


def job(text: str) -> Job:
    return make_job(Source("PART", text), setup())


ANSWERS: list[object] = []


@pytest.fixture
def finder() -> LineFinder:
    ANSWERS.clear()
    return LineFinder(
        rebuilt, lambda job, _watch: Proved(Proof(job.digest, ())), ANSWERS.append, ANSWERS.append
    )


def answer(finder: LineFinder) -> object:
    finder.worker.settle(LIMIT)
    (found,) = ANSWERS
    ANSWERS.clear()
    return found


def test_lines_are_found_one_after_the_other(finder: LineFinder) -> None:
    part = job("\n".join(LINES) + "\n")
    finder.find(part, 4)
    assert isinstance(answer(finder), RestartPoint)
    finder.find(part, 2)
    assert isinstance(answer(finder), NoRestart)
    finder.find(part, 5)
    found = answer(finder)
    assert isinstance(found, RestartPoint)
    assert found.line == 5
    finder.worker.close()


def test_what_was_given_up_never_answers_and_the_next_line_is_found(finder: LineFinder) -> None:
    long = job("G90G94F300\nX1Z1\nLS90000\nX1\nX2\nLF\nX1\nM30\n")
    finder.find(long, 7)
    finder.worker.give_up()
    finder.find(long, 3)
    found = answer(finder)
    assert isinstance(found, RestartPoint)
    assert found.line == 3
    finder.worker.close()


def test_a_restart_is_proved_on_the_worker(finder: LineFinder) -> None:
    asked: list[str] = []

    def prove(job: Job, _watch: object) -> Proved:
        asked.append(threading.current_thread().name)
        return Proved(Proof(job.digest, ()))

    finder.prove = prove
    restart = job("G90\nM30\n")
    finder.check(restart)
    result = answer(finder)
    assert isinstance(result, tuple)
    assert result[1].proof.digest == restart.digest
    assert asked[0].startswith("loading-search")
    finder.worker.close()
