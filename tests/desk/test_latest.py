"""The worker of the desk: the newest request wins, what is queued is done, and a failure is a sentence."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator

import pytest

from app.desk.background_work import LatestRequestWorker, ProgressCallback, WorkAbandonedError, WorkRequest

LIMIT = 60.0


@pytest.fixture
def worker() -> Iterator[LatestRequestWorker]:
    worker = LatestRequestWorker("tried")
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

    def __call__(self, watch: ProgressCallback) -> str:
        self.begun.set()
        try:
            while not self.go.wait(0.001):
                watch(7)
        except WorkAbandonedError:
            self.given_up.set()
            raise
        return "slow"


def test_result_is_delivered_by_the_poll_of_the_requester(worker: LatestRequestWorker) -> None:
    heard, threads = Heard(), []

    def done(name: str) -> None:
        threads.extend([name, threading.current_thread().name])

    worker.request_work(lambda _watch: threading.current_thread().name, done, heard.failed)
    assert worker.is_busy
    worker.wait_for_results(LIMIT)
    assert not worker.is_busy
    assert threads[0].startswith("tried")
    assert threads[1] == threading.current_thread().name
    worker.deliver_results()
    assert len(threads) == 2


def test_newer_request_cancels_the_running_one(worker: LatestRequestWorker) -> None:
    heard, slow = Heard(), Slow()
    worker.request_work(slow, heard.done, heard.failed)
    assert slow.begun.wait(LIMIT)
    worker.request_work(lambda _watch: "new", heard.done, heard.failed)
    worker.wait_for_results(LIMIT)
    assert slow.given_up.is_set()
    assert (heard.answers, heard.failures) == (["new"], [])


def test_undelivered_result_is_dropped_by_a_newer_request(worker: LatestRequestWorker) -> None:
    heard, ready = Heard(), threading.Event()
    worker.request_work(lambda _watch: ready.set(), heard.done, heard.failed)
    assert ready.wait(LIMIT)
    worker.request_work(lambda _watch: "new", heard.done, heard.failed)
    worker.wait_for_results(LIMIT)
    assert heard.answers == ["new"]


def test_canceled_work_that_ignores_cancellation_delivers_no_result(worker: LatestRequestWorker) -> None:
    heard, begun, go = Heard(), threading.Event(), threading.Event()

    def deaf(_watch: ProgressCallback) -> str:
        begun.set()
        go.wait(LIMIT)
        return "old"

    worker.request_work(deaf, heard.done, heard.failed)
    assert begun.wait(LIMIT)
    worker.cancel_request()
    assert not worker.is_busy
    go.set()
    worker.request_work(lambda _watch: "new", heard.done, heard.failed)
    worker.wait_for_results(LIMIT)
    assert heard.answers == ["new"]


def test_queued_work_runs_in_order_and_is_never_canceled(worker: LatestRequestWorker) -> None:
    heard, slow = Heard(), Slow()
    worker.request_work(slow, heard.done, heard.failed)
    worker.enqueue_work(lambda: 1, heard.done, heard.failed)
    worker.enqueue_work(lambda: 2, heard.done, heard.failed)
    worker.request_work(lambda _watch: "new", heard.done, heard.failed)
    worker.wait_for_results(LIMIT)
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
def test_failed_request_reports_an_error_and_the_next_one_runs(
    worker: LatestRequestWorker, error: BaseException, told: str
) -> None:
    heard = Heard()

    def fail(_watch: ProgressCallback) -> None:
        raise error

    worker.request_work(fail, heard.done, heard.failed)
    worker.wait_for_results(LIMIT)
    assert (heard.answers, heard.failures) == ([], [told])
    worker.request_work(lambda _watch: "good", heard.done, heard.failed)
    worker.wait_for_results(LIMIT)
    assert heard.answers == ["good"]


@pytest.mark.parametrize(
    ("error", "logged"), [(KeyError("x"), 1), (ValueError("no number"), 0), (OSError(28, "full"), 0)]
)
def test_unexpected_exception_is_logged_with_its_traceback(
    worker: LatestRequestWorker, caplog: pytest.LogCaptureFixture, error: Exception, logged: int
) -> None:
    heard = Heard()

    def fail(_watch: ProgressCallback) -> None:
        raise error

    worker.request_work(fail, heard.done, heard.failed)
    worker.wait_for_results(LIMIT)
    assert [bool(each.exc_info) for each in caplog.records] == [True] * logged
    assert len(heard.failures) == 1


def test_result_callback_may_make_a_new_request(worker: LatestRequestWorker) -> None:
    heard = Heard()

    def again(answer: int) -> None:
        heard.done(answer)
        if answer < 3:
            worker.request_work(lambda _watch: answer + 1, again, heard.failed)

    worker.request_work(lambda _watch: 1, again, heard.failed)
    worker.wait_for_results(LIMIT)
    assert heard.answers == [1, 2, 3]


def test_progress_is_that_of_the_running_request(worker: LatestRequestWorker) -> None:
    slow, heard = Slow(), Heard()
    worker.request_work(slow, heard.done, heard.failed)
    assert slow.begun.wait(LIMIT)
    _until(lambda: worker.progress_count == 7)
    worker.cancel_request()
    assert worker.progress_count == 0


def test_intermediate_results_come_only_from_the_newest_request(
    worker: LatestRequestWorker,
) -> None:
    seen: list[str] = []
    heard, begun, go = Heard(), threading.Event(), threading.Event()

    def work(name: str) -> Callable[[WorkRequest], str]:
        def run(request: WorkRequest) -> str:
            begun.set()
            go.wait(LIMIT)
            request.publish_result(lambda: seen.append(name))
            return name

        return run

    worker.request_work(work("old"), heard.done, heard.failed)
    assert begun.wait(LIMIT)
    worker.request_work(work("new"), heard.done, heard.failed)
    go.set()
    worker.wait_for_results(LIMIT)
    assert (seen, heard.answers) == (["new"], ["new"])


def test_closing_cancels_requests_and_finishes_queued_work() -> None:
    worker, slow, heard, written = LatestRequestWorker("tried"), Slow(), Heard(), []
    worker.request_work(slow, heard.done, heard.failed)
    assert slow.begun.wait(LIMIT)
    worker.enqueue_work(lambda: written.append("whole"), heard.done, heard.failed)
    worker.close()
    assert slow.given_up.is_set()
    assert written == ["whole"]
    worker.request_work(lambda _watch: written.append("late"), heard.done, heard.failed)
    worker.enqueue_work(lambda: written.append("late"), heard.done, heard.failed)
    assert written == ["whole"]
    assert not [t for t in threading.enumerate() if t.name.startswith("tried")]


def test_request_within_its_grace_time_may_finish() -> None:
    t = [0.0]
    worker, heard = LatestRequestWorker("typed", grace_time_s=1.0, read_time_s=lambda: t[0]), Heard()
    slow, slower = Slow(), Slow()
    worker.request_work(slow, heard.done, heard.failed)
    assert slow.begun.wait(LIMIT)
    worker.request_work(slower, heard.done, heard.failed)
    slow.go.set()
    assert slower.begun.wait(LIMIT)
    worker.request_work(lambda _watch: "new", heard.done, heard.failed)
    t[0] = 1.5
    worker.wait_for_results(LIMIT)
    assert slower.given_up.is_set()
    assert heard.answers == ["slow", "new"]
    worker.close()


def test_worker_waits_for_a_pause_in_requests_up_to_a_limit() -> None:
    heard = Heard()
    worker = LatestRequestWorker("typed", quiet_time_s=60.0, max_delay_s=0.02)
    for number in range(20):
        worker.request_work(lambda _watch, number=number: number, heard.done, heard.failed)  # type: ignore[misc]
    worker.wait_for_results(LIMIT)
    assert heard.answers == [19]
    worker.close()


def test_two_workers_may_share_a_thread(worker: LatestRequestWorker) -> None:
    heard, slow = Heard(), Slow()
    other = LatestRequestWorker("other", thread_owning_worker=worker)
    worker.request_work(slow, heard.done, heard.failed)
    assert slow.begun.wait(LIMIT)
    other.request_work(lambda _watch: threading.current_thread().name, heard.done, heard.failed)
    assert not slow.given_up.is_set()
    slow.go.set()
    worker.wait_for_results(LIMIT)
    other.wait_for_results(LIMIT)
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
