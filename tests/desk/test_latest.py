"""The worker of the desk: the newest request wins, what is queued is done, and a failure is a sentence."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator

import pytest

from app.desk.background_work import AbandonedError, Latest, Request, Watch

LIMIT = 60.0


@pytest.fixture
def worker() -> Iterator[Latest]:
    worker = Latest("tried")
    yield worker
    worker.close()
    assert not [t for t in threading.enumerate() if t.name.startswith("tried")]


class Heard:
    """What came of it, in the order in which it was told."""

    def __init__(self) -> None:
        self.answers: list[object] = []
        self.failures: list[str] = []

    def done(self, answer: object) -> None:
        self.answers.append(answer)

    def failed(self, why: str) -> None:
        self.failures.append(why)


class Slow:
    """Work that goes on until it is let go or given up."""

    def __init__(self) -> None:
        self.begun, self.go, self.given_up = threading.Event(), threading.Event(), threading.Event()

    def __call__(self, watch: Watch) -> str:
        self.begun.set()
        try:
            while not self.go.wait(0.001):
                watch(7)
        except AbandonedError:
            self.given_up.set()
            raise
        return "slow"


def test_an_answer_is_given_by_the_poll_of_whoever_asked(worker: Latest) -> None:
    heard, threads = Heard(), []

    def done(name: str) -> None:
        threads.extend([name, threading.current_thread().name])

    worker.ask(lambda _watch: threading.current_thread().name, done, heard.failed)
    assert worker.busy
    worker.settle(LIMIT)
    assert not worker.busy
    assert threads[0].startswith("tried")
    assert threads[1] == threading.current_thread().name
    worker.poll()
    assert len(threads) == 2


def test_the_newest_request_gives_up_the_one_in_hand(worker: Latest) -> None:
    heard, slow = Heard(), Slow()
    worker.ask(slow, heard.done, heard.failed)
    assert slow.begun.wait(LIMIT)
    worker.ask(lambda _watch: "new", heard.done, heard.failed)
    worker.settle(LIMIT)
    assert slow.given_up.is_set()
    assert (heard.answers, heard.failures) == (["new"], [])


def test_an_answer_that_nobody_took_up_goes_with_its_request(worker: Latest) -> None:
    heard, ready = Heard(), threading.Event()
    worker.ask(lambda _watch: ready.set(), heard.done, heard.failed)
    assert ready.wait(LIMIT)
    worker.ask(lambda _watch: "new", heard.done, heard.failed)
    worker.settle(LIMIT)
    assert heard.answers == ["new"]


def test_work_that_never_looks_up_is_not_answered_once_it_is_overtaken(worker: Latest) -> None:
    heard, begun, go = Heard(), threading.Event(), threading.Event()

    def deaf(_watch: Watch) -> str:
        begun.set()
        go.wait(LIMIT)
        return "old"

    worker.ask(deaf, heard.done, heard.failed)
    assert begun.wait(LIMIT)
    worker.give_up()
    assert not worker.busy
    go.set()
    worker.ask(lambda _watch: "new", heard.done, heard.failed)
    worker.settle(LIMIT)
    assert heard.answers == ["new"]


def test_what_is_queued_is_done_in_its_turn_and_never_given_up(worker: Latest) -> None:
    heard, slow = Heard(), Slow()
    worker.ask(slow, heard.done, heard.failed)
    worker.queue(lambda: 1, heard.done, heard.failed)
    worker.queue(lambda: 2, heard.done, heard.failed)
    worker.ask(lambda _watch: "new", heard.done, heard.failed)
    worker.settle(LIMIT)
    assert heard.answers == [1, 2, "new"]


@pytest.mark.parametrize(
    ("error", "told"),
    [
        (ValueError("no such path"), "no such path"),
        (OSError(2, "No such file or directory", "part.nc"), "No such file or directory"),
        (MemoryError(), "MemoryError"),
        (SystemExit(), "SystemExit"),
    ],
)
def test_a_failure_is_a_sentence_and_the_next_request_is_worked_at(
    worker: Latest, error: BaseException, told: str
) -> None:
    heard = Heard()

    def fail(_watch: Watch) -> None:
        raise error

    worker.ask(fail, heard.done, heard.failed)
    worker.settle(LIMIT)
    assert (heard.answers, heard.failures) == ([], [told])
    worker.ask(lambda _watch: "good", heard.done, heard.failed)
    worker.settle(LIMIT)
    assert heard.answers == ["good"]


@pytest.mark.parametrize(
    ("error", "logged"), [(KeyError("x"), 1), (ValueError("no number"), 0), (OSError(28, "full"), 0)]
)
def test_of_a_defect_the_traceback_is_logged(
    worker: Latest, caplog: pytest.LogCaptureFixture, error: Exception, logged: int
) -> None:
    heard = Heard()

    def fail(_watch: Watch) -> None:
        raise error

    worker.ask(fail, heard.done, heard.failed)
    worker.settle(LIMIT)
    assert [bool(each.exc_info) for each in caplog.records] == [True] * logged
    assert len(heard.failures) == 1


def test_an_answer_may_ask_again(worker: Latest) -> None:
    heard = Heard()

    def again(answer: int) -> None:
        heard.done(answer)
        if answer < 3:
            worker.ask(lambda _watch: answer + 1, again, heard.failed)

    worker.ask(lambda _watch: 1, again, heard.failed)
    worker.settle(LIMIT)
    assert heard.answers == [1, 2, 3]


def test_how_far_it_has_come_is_that_of_the_work_in_hand(worker: Latest) -> None:
    slow, heard = Slow(), Heard()
    worker.ask(slow, heard.done, heard.failed)
    assert slow.begun.wait(LIMIT)
    _until(lambda: worker.reached == 7)
    worker.give_up()
    assert worker.reached == 0


def test_what_is_published_on_the_way_is_that_of_the_newest_request_alone(worker: Latest) -> None:
    seen: list[str] = []
    heard, begun, go = Heard(), threading.Event(), threading.Event()

    def work(name: str) -> Callable[[Request], str]:
        def run(request: Request) -> str:
            begun.set()
            go.wait(LIMIT)
            request.publish(lambda: seen.append(name))
            return name

        return run

    worker.ask(work("old"), heard.done, heard.failed)
    assert begun.wait(LIMIT)
    worker.ask(work("new"), heard.done, heard.failed)
    go.set()
    worker.settle(LIMIT)
    assert (seen, heard.answers) == (["new"], ["new"])


def test_closing_gives_up_what_was_asked_and_finishes_what_was_queued() -> None:
    worker, slow, heard, written = Latest("tried"), Slow(), Heard(), []
    worker.ask(slow, heard.done, heard.failed)
    assert slow.begun.wait(LIMIT)
    worker.queue(lambda: written.append("whole"), heard.done, heard.failed)
    worker.close()
    assert slow.given_up.is_set()
    assert written == ["whole"]
    worker.ask(lambda _watch: written.append("late"), heard.done, heard.failed)
    worker.queue(lambda: written.append("late"), heard.done, heard.failed)
    assert written == ["whole"]
    assert not [t for t in threading.enumerate() if t.name.startswith("tried")]


def test_a_request_with_patience_behind_it_may_come_to_its_end() -> None:
    t = [0.0]
    worker, heard = Latest("typed", patience=1.0, clock=lambda: t[0]), Heard()
    slow, slower = Slow(), Slow()
    worker.ask(slow, heard.done, heard.failed)
    assert slow.begun.wait(LIMIT)
    worker.ask(slower, heard.done, heard.failed)
    slow.go.set()
    assert slower.begun.wait(LIMIT)
    worker.ask(lambda _watch: "new", heard.done, heard.failed)
    t[0] = 1.5
    worker.settle(LIMIT)
    assert slower.given_up.is_set()
    assert heard.answers == ["slow", "new"]
    worker.close()


def test_keys_are_waited_for_but_not_for_ever() -> None:
    heard = Heard()
    worker = Latest("typed", quiet=60.0, longest=0.02)
    for number in range(20):
        worker.ask(lambda _watch, number=number: number, heard.done, heard.failed)  # type: ignore[misc]
    worker.settle(LIMIT)
    assert heard.answers == [19]
    worker.close()


def test_two_workers_may_share_a_thread(worker: Latest) -> None:
    heard, slow = Heard(), Slow()
    other = Latest("other", beside=worker)
    worker.ask(slow, heard.done, heard.failed)
    assert slow.begun.wait(LIMIT)
    other.ask(lambda _watch: threading.current_thread().name, heard.done, heard.failed)
    assert not slow.given_up.is_set()
    slow.go.set()
    worker.settle(LIMIT)
    other.settle(LIMIT)
    other.close()
    assert heard.answers[0] == "slow"
    assert str(heard.answers[1]).startswith("tried")


def _until(done: Callable[[], bool]) -> None:
    waiting = threading.Event()
    for _ in range(12_000):
        if done():
            return
        waiting.wait(0.005)
    raise AssertionError("it never came")
