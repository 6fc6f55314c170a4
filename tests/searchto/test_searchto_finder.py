"""A line of a program by number or text; the worker that finds it."""

from __future__ import annotations

import threading

import pytest

from app.compose.program_proving import create_restart_search
from app.desk.programs.program_loading import ProvedJob
from app.searchto.restart_finder import LineCursor, RestartFinder
from core.executor.job import Job, Proof, make_job
from core.interpreter.restart.restart_point import RestartPoint, RestartRejection
from core.language.source import ProgramSource
from tests.interpreter.programs import setup

LINES = ("G90G94F300", "X1Z1(FACE)", "Z0", "X.5", "z.5(face again)", "M30")
LIMIT = 60.0


def typed(text: str, line: int = 1) -> LineCursor:
    cursor = LineCursor(LINES, line)
    for key in text:
        assert cursor.handle_key(key)
    return cursor


def test_digits_are_a_line_number_and_quoted_digits_a_text() -> None:
    assert typed("12").entered_line_number == 12
    assert typed('"12').entered_line_number is None
    assert typed('"12').search_text == "12"
    assert typed("x1").entered_line_number is None


def test_search_wraps_around_and_ignores_case() -> None:
    cursor = typed("(face")
    assert cursor.find_text(1)
    assert cursor.selected_line == 2
    assert cursor.find_text(1)
    assert cursor.selected_line == 5
    assert cursor.find_text(1)
    assert cursor.selected_line == 2
    assert cursor.find_text(-1)
    assert cursor.selected_line == 5


def test_text_not_found_leaves_cursor_in_place() -> None:
    cursor = typed("QQ", 3)
    assert not cursor.find_text(1)
    assert cursor.selected_line == 3
    assert not typed("", 3).find_text(1)


@pytest.mark.parametrize(("line", "there"), [(-5, 1), (0, 1), (4, 4), (99, 6)])
def test_the_cursor_stays_in_the_program(line: int, there: int) -> None:
    cursor = LineCursor(LINES)
    cursor.select_line(line)
    assert cursor.selected_line == there


def test_entry_is_edited_by_keys() -> None:
    cursor = typed("X.55")
    cursor.handle_key("Back")
    assert cursor.entry_text == "X.5"
    cursor.handle_key("Delete")
    assert cursor.entry_text == ""
    assert not cursor.handle_key("Tab")


def job(text: str) -> Job:
    return make_job(ProgramSource("PART", text), setup())


ANSWERS: list[object] = []


@pytest.fixture
def finder() -> RestartFinder:
    ANSWERS.clear()
    return RestartFinder(
        create_restart_search,
        lambda job, _watch: ProvedJob(Proof(job.digest, ())),
        ANSWERS.append,
        ANSWERS.append,
    )


def answer(finder: RestartFinder) -> object:
    finder.worker.wait_for_results(LIMIT)
    (found,) = ANSWERS
    ANSWERS.clear()
    return found


def test_lines_are_found_one_after_the_other(finder: RestartFinder) -> None:
    part = job("\n".join(LINES) + "\n")
    finder.find_restart_line(part, 4)
    assert isinstance(answer(finder), RestartPoint)
    finder.find_restart_line(part, 2)
    assert isinstance(answer(finder), RestartRejection)
    finder.find_restart_line(part, 5)
    found = answer(finder)
    assert isinstance(found, RestartPoint)
    assert found.line_number == 5
    finder.worker.close()


def test_canceled_search_returns_nothing_and_next_line_is_found(finder: RestartFinder) -> None:
    long = job("G90G94F300\nX1Z1\nLS90000\nX1\nX2\nLF\nX1\nM30\n")
    finder.find_restart_line(long, 7)
    finder.worker.cancel_request()
    finder.find_restart_line(long, 3)
    found = answer(finder)
    assert isinstance(found, RestartPoint)
    assert found.line_number == 3
    finder.worker.close()


def test_a_restart_is_proved_on_the_worker(finder: RestartFinder) -> None:
    asked: list[str] = []

    def prove(job: Job, _watch: object) -> ProvedJob:
        asked.append(threading.current_thread().name)
        return ProvedJob(Proof(job.digest, ()))

    finder.prove_job = prove
    restart = job("G90\nM30\n")
    finder.prove_restart(restart)
    result = answer(finder)
    assert isinstance(result, tuple)
    assert result[1].proof.digest == restart.digest
    assert asked[0].startswith("loading-search")
    finder.worker.close()
