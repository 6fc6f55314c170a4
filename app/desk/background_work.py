"""Slow and repeated work of TurnDesk on worker threads.

A new request for proving, drawing or searching replaces previous requests, because their results would be
outdated. Queued work, such as writing, is always completed. Results are delivered on the caller's thread
when the caller polls, once per frame.
"""

from __future__ import annotations

import logging
import queue
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TypeVar

_log = logging.getLogger(__name__)

CLOSE_TIMEOUT_S = 2.0  # Seconds that closing waits for the work in progress.
ResultT = TypeVar("ResultT")
ProgressCallback = Callable[[float], None]
"""Function that receives the progress of slow work.

It may raise WorkAbandonedError, which the caller must not catch.
"""
FailureCallback = Callable[[str], None]


class DaemonWorker:
    """Daemon thread that executes tasks in order. The thread starts with the first task.

    A ThreadPoolExecutor would join its threads when the interpreter exits, even if they hang. A task must
    not raise an exception.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._tasks: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()
        self._closed = False

    def submit_task(self, task: Callable[[], None]) -> None:
        """Add a task to the queue, or drop the task if the worker is closed."""
        with self._lock:
            if self._closed:
                return
            self._tasks.put(task)
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name=self._name, daemon=True)
                self._thread.start()

    def close(self, timeout_s: float) -> None:
        """Finish the queued tasks, but wait at most ``timeout_s`` seconds for them."""
        with self._lock:
            self._closed = True
            self._tasks.put(None)
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join(timeout_s)

    def _work(self) -> None:
        while (task := self._tasks.get()) is not None:
            task()


class WorkAbandonedError(Exception):
    """Exception that cancels the work in progress because a newer request replaced it."""


def describe_error(error: BaseException) -> str:
    """Return the text of a worker's error for display on the screen."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return str(error) or type(error).__name__


@dataclass(slots=True, eq=False)
class WorkRequest:
    """One request to a worker. The work calls this object as its ``ProgressCallback`` to report progress."""

    worker: LatestRequestWorker
    # Does the work and returns the function that delivers the result.
    run_work: Callable[[WorkRequest], Callable[[], None]]
    report_failure: FailureCallback
    is_queued: bool  # Runs to its end even if a newer request arrives.
    is_wanted: bool = True
    is_superseded: bool = False  # Replaced by a newer request, which waits for ``grace_time_s`` seconds.
    start_time_s: float = 0.0

    def __call__(self, reached: float = 0.0) -> None:
        """Report the progress of the work. Raises WorkAbandonedError if the work must stop."""
        self.worker.raise_if_canceled(self)
        self.worker.progress_count = int(reached)

    def publish_result(self, deliver: Callable[[], None]) -> None:
        """Call ``deliver`` with an intermediate result on the worker thread.

        Newer requests are blocked during the call. Raises WorkAbandonedError if the result is no longer
        needed.
        """
        with self.worker.lock:
            if not self.is_wanted:
                raise WorkAbandonedError
            deliver()


@dataclass(slots=True)
class LatestRequestWorker:
    """Worker on which a new request replaces the previous request.

    ``enqueue_work`` adds work that is never canceled. Requests that follow typing are delayed: work begins
    after ``quiet_time_s`` seconds without another request, but no later than after ``max_delay_s`` seconds.
    A replaced request may continue for ``grace_time_s`` seconds. ``thread_owning_worker`` is another worker
    whose thread this worker shares.
    """

    name: str  # Name of the thread.
    quiet_time_s: float = 0.0
    max_delay_s: float = 0.0
    grace_time_s: float = 0.0
    thread_owning_worker: LatestRequestWorker | None = None
    read_time_s: Callable[[], float] = time.monotonic
    progress_count: int = 0  # Progress of the work in progress, in the unit of the work.
    lock: threading.Condition = field(default_factory=threading.Condition)
    _waiting: deque[WorkRequest] = field(default_factory=deque)
    _current: WorkRequest | None = None
    _answers: deque[tuple[WorkRequest, Callable[[], None]]] = field(default_factory=deque)
    _asked: float = 0.0
    _closing: bool = False
    _running: bool = False
    _pool: DaemonWorker = field(init=False)

    def __post_init__(self) -> None:
        self._pool = (
            DaemonWorker(self.name) if self.thread_owning_worker is None else self.thread_owning_worker._pool
        )

    # --- caller's side -------------------------------------------------------------------------------

    @property
    def is_busy(self) -> bool:
        """Return whether work is in progress or a result is waiting for ``deliver_results``."""
        with self.lock:
            at_work = self._current is not None and self._current.is_wanted
            return at_work or bool(self._waiting or self._answers)

    def request_work(
        self,
        work: Callable[[WorkRequest], ResultT],
        on_done: Callable[[ResultT], None],
        on_failed: FailureCallback,
    ) -> None:
        """Request ``work`` in place of the previous request.

        ``deliver_results`` later calls ``on_done`` with the result, or ``on_failed`` with an error text.
        ``work`` is called with the request as its progress callback.
        """
        with self.lock:
            if not self.grace_time_s:
                self.cancel_request()
            elif self._current is not None:
                self._current.is_superseded = True
            self._drop_waiting()
            self._begin(work, on_done, on_failed, queued=False)

    def enqueue_work(
        self, work: Callable[[], ResultT], on_done: Callable[[ResultT], None], on_failed: FailureCallback
    ) -> None:
        """Add ``work`` to the end of the queue. Queued work is never canceled.

        ``deliver_results`` delivers the result, as it does for ``request_work``.
        """
        with self.lock:
            self._begin(lambda _request: work(), on_done, on_failed, queued=True)

    def cancel_request(self) -> None:
        """Cancel the current request. Queued work continues, and its result is still delivered."""
        with self.lock:
            self._drop_waiting()
            if self._current is not None and not self._current.is_queued:
                self._current.is_wanted = False
            self._answers = deque(each for each in self._answers if each[0].is_queued)
            self.progress_count = 0

    def deliver_results(self) -> None:
        """Deliver the results of completed work in the order of completion.

        The screen calls this method once per frame.
        """
        while True:
            with self.lock:
                if not self._answers:
                    return
                _request, answer = self._answers.popleft()
            answer()

    def wait_for_results(self, timeout_s: float) -> None:
        """Wait for the results of all work and deliver them.

        Only scripts and tests use this method, because it blocks.
        """
        end = time.monotonic() + timeout_s
        while self.is_busy and time.monotonic() < end:
            with self.lock:
                self.lock.wait_for(lambda: self._answers or not self.is_busy, end - time.monotonic())
            self.deliver_results()

    def close(self) -> None:
        """End the thread after canceling requests and finishing queued work.

        The results of this work are not delivered. Work that takes longer than ``CLOSE_TIMEOUT_S`` seconds
        continues on the daemon thread.
        """
        with self.lock:
            self._closing = True
            self.cancel_request()
            self.lock.notify_all()
        if self.thread_owning_worker is None:
            self._pool.close(CLOSE_TIMEOUT_S)

    def _begin(
        self,
        work: Callable[[WorkRequest], ResultT],
        done: Callable[[ResultT], None],
        failed: FailureCallback,
        *,
        queued: bool,
    ) -> None:
        def run_request(request: WorkRequest) -> Callable[[], None]:
            result = work(request)
            return lambda: done(result)

        if self._closing:
            return
        self._waiting.append(WorkRequest(self, run_request, failed, queued))
        self._asked = self.read_time_s()
        self.lock.notify_all()
        if not self._running:
            self._running = True
            self._pool.submit_task(self._work_off)

    def _drop_waiting(self) -> None:
        self._waiting = deque(each for each in self._waiting if each.is_queued)

    # --- worker thread -------------------------------------------------------------------------------

    def raise_if_canceled(self, request: WorkRequest) -> None:
        """Raise WorkAbandonedError if the work on this request must stop."""
        late = request.is_superseded and self.read_time_s() - request.start_time_s > self.grace_time_s
        if late or not request.is_wanted:
            raise WorkAbandonedError

    def _work_off(self) -> None:
        while (request := self._wait_for_request()) is not None:
            answer = _run_request(request)
            with self.lock:
                self._current = None
                if answer is not None and request.is_wanted:
                    self._answers.append((request, answer))
                self.lock.notify_all()

    def _wait_for_request(self) -> WorkRequest | None:
        """Return the next request, or None if no request is waiting.

        While the operator types, wait until typing has paused for ``quiet_time_s`` seconds, or until
        ``max_delay_s`` seconds have passed.
        """
        with self.lock:
            end = self.read_time_s() + self.max_delay_s
            while self._waiting and not self._closing:
                left = min(self._asked + self.quiet_time_s, end) - self.read_time_s()
                if left <= 0.0:
                    break
                self.lock.wait(left)
            self._current = self._waiting.popleft() if self._waiting else None
            if self._current is None:
                self._running = False
            else:
                self._current.start_time_s = self.read_time_s()
            self.progress_count = 0
            return self._current


def _run_request(request: WorkRequest) -> Callable[[], None] | None:
    """Do the requested work, and return the function that delivers its result.

    If the work is canceled, return None.
    """
    try:
        return request.run_work(request)
    except WorkAbandonedError:
        return None
    except BaseException as error:  # noqa: BLE001 - any error is raised where the result is read
        if _is_defect(error):
            _log.error("on the worker %s", request.worker.name, exc_info=error)
        why = describe_error(error)
        return lambda: request.report_failure(why)


def _is_defect(error: BaseException) -> bool:
    """Return whether an error is a programming error, whose traceback must be logged."""
    return type(error).__module__ == "builtins" and not isinstance(error, OSError | ValueError)


class RepeatingThread:
    """Thread that calls the function ``read_status`` at regular intervals.

    The first call occurs after ``first_delay_s`` seconds, and each further call after ``interval_s``
    seconds. The watchdog identifies the thread by its name.
    """

    def __init__(
        self, name: str, read_status: Callable[[], object], interval_s: float, first_delay_s: float = 0.0
    ) -> None:
        self._look, self._every, self._first = read_status, interval_s, first_delay_s
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._repeat, name=name, daemon=True)

    @property
    def is_closing(self) -> bool:
        """Return whether ``close`` was called. A thread that ends without ``close`` has failed."""
        return self._closing.is_set()

    def start(self) -> None:
        """Start the thread. Call this method only once."""
        self._thread.start()

    def close(self) -> None:
        """End the thread, and wait at most ``CLOSE_TIMEOUT_S`` seconds for a call in progress.

        A call that hangs continues on the daemon thread.
        """
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join(CLOSE_TIMEOUT_S)

    def _repeat(self) -> None:
        wait = self._first
        while not self._closing.wait(wait):
            self._look()
            wait = self._every
