"""Slow and repeated work of TurnDesk on worker threads.

For proving, drawing and searching, the newest request replaces older ones, because an outdated result is
useless. Queued work, such as writing, always runs to its end. Results are delivered on the caller's thread
when the caller polls, once a frame.
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

ENDS = 2.0  # Seconds that closing waits for the work in progress.
T = TypeVar("T")
Watch = Callable[[float], None]
"""Told how far slow work has come; it may raise AbandonedError, which has to be let through."""
Failed = Callable[[str], None]


class DaemonWorker:
    """One daemon thread that executes tasks in order. The thread starts with the first task.

    A ThreadPoolExecutor would join its threads when the interpreter exits, even if they hang. A task must not
    raise an exception.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._tasks: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()
        self._closed = False

    def submit(self, task: Callable[[], None]) -> None:
        """Queue a task. A closed worker drops the task."""
        with self._lock:
            if self._closed:
                return
            self._tasks.put(task)
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name=self._name, daemon=True)
                self._thread.start()

    def close(self, limit: float) -> None:
        """Finish the queued tasks, but wait for them for ``limit`` seconds at most."""
        with self._lock:
            self._closed = True
            self._tasks.put(None)
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join(limit)

    def _work(self) -> None:
        while (task := self._tasks.get()) is not None:
            task()


class AbandonedError(Exception):
    """The work in progress is canceled because a newer request replaced it."""


def sentence(error: BaseException) -> str:
    """Return the text of a worker's error for the screen."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return str(error) or type(error).__name__


@dataclass(slots=True, eq=False)
class Request:
    """One request to a worker. The work calls the request as its ``Watch`` to report progress."""

    worker: Latest
    # Does the work and returns the function that delivers the result.
    run: Callable[[Request], Callable[[], None]]
    failed: Failed
    queued: bool  # Runs to its end even if a newer request arrives.
    wanted: bool = True
    overtaken: bool = False  # Replaced by a newer request, which waits for ``patience`` seconds.
    began: float = 0.0

    def __call__(self, reached: float = 0.0) -> None:
        """Report the progress of the work. Raises AbandonedError if the work must stop."""
        self.worker.go_on(self)
        self.worker.reached = int(reached)

    def publish(self, put: Callable[[], None]) -> None:
        """Call ``put`` on the worker with an intermediate result, while no newer request can arrive.

        Raises AbandonedError if the result is no longer wanted.
        """
        with self.worker.lock:
            if not self.wanted:
                raise AbandonedError
            put()


@dataclass(slots=True)
class Latest:
    """A worker on which a new request replaces the previous one.

    ``ask`` replaces the previous request. ``queue`` adds work that is never canceled. For requests that
    follow typing, work begins after ``quiet`` seconds without another request, but at the latest after
    ``longest`` seconds. A replaced request may continue for ``patience`` seconds. ``beside`` is another
    worker whose thread this worker shares.
    """

    name: str  # Name of the thread.
    quiet: float = 0.0
    longest: float = 0.0
    patience: float = 0.0
    beside: Latest | None = None
    clock: Callable[[], float] = time.monotonic
    reached: int = 0  # Progress of the work in progress, in the unit of the work.
    lock: threading.Condition = field(default_factory=threading.Condition)
    _waiting: deque[Request] = field(default_factory=deque)
    _current: Request | None = None
    _answers: deque[tuple[Request, Callable[[], None]]] = field(default_factory=deque)
    _asked: float = 0.0
    _closing: bool = False
    _running: bool = False
    _pool: DaemonWorker = field(init=False)

    def __post_init__(self) -> None:
        self._pool = DaemonWorker(self.name) if self.beside is None else self.beside._pool

    # --- caller's side -------------------------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether work is in progress or a result is waiting for ``poll``."""
        with self.lock:
            at_work = self._current is not None and self._current.wanted
            return at_work or bool(self._waiting or self._answers)

    def ask(self, work: Callable[[Request], T], done: Callable[[T], None], failed: Failed) -> None:
        """Request ``work`` in place of the previous request.

        ``poll`` later calls ``done`` with the result, or ``failed`` with an error text. ``work`` gets the
        request as its watch.
        """
        with self.lock:
            if not self.patience:
                self.give_up()
            elif self._current is not None:
                self._current.overtaken = True
            self._drop_waiting()
            self._begin(work, done, failed, queued=False)

    def queue(self, work: Callable[[], T], done: Callable[[T], None], failed: Failed) -> None:
        """Add ``work`` that runs after all waiting work and is never canceled.

        ``poll`` delivers the result as for ``ask``.
        """
        with self.lock:
            self._begin(lambda _request: work(), done, failed, queued=True)

    def give_up(self) -> None:
        """Cancel the current request. Queued work continues, and its result is still delivered."""
        with self.lock:
            self._drop_waiting()
            if self._current is not None and not self._current.queued:
                self._current.wanted = False
            self._answers = deque(each for each in self._answers if each[0].queued)
            self.reached = 0

    def poll(self) -> None:
        """Deliver the finished results in the order of the work; called once a frame."""
        while True:
            with self.lock:
                if not self._answers:
                    return
                _request, answer = self._answers.popleft()
            answer()

    def settle(self, timeout: float) -> None:
        """Wait for the results and deliver them. For scripts and tests only, because this method blocks."""
        end = time.monotonic() + timeout
        while self.busy and time.monotonic() < end:
            with self.lock:
                self.lock.wait_for(lambda: self._answers or not self.busy, end - time.monotonic())
            self.poll()

    def close(self) -> None:
        """End the thread. Requests are canceled. Queued work is finished, but its result is not delivered.

        Work that takes longer than ``ENDS`` seconds remains on the daemon thread.
        """
        with self.lock:
            self._closing = True
            self.give_up()
            self.lock.notify_all()
        if self.beside is None:
            self._pool.close(ENDS)

    def _begin(
        self, work: Callable[[Request], T], done: Callable[[T], None], failed: Failed, *, queued: bool
    ) -> None:
        def run(request: Request) -> Callable[[], None]:
            result = work(request)
            return lambda: done(result)

        if self._closing:
            return
        self._waiting.append(Request(self, run, failed, queued))
        self._asked = self.clock()
        self.lock.notify_all()
        if not self._running:
            self._running = True
            self._pool.submit(self._work_off)

    def _drop_waiting(self) -> None:
        self._waiting = deque(each for each in self._waiting if each.queued)

    # --- worker thread -------------------------------------------------------------------------------

    def go_on(self, request: Request) -> None:
        """Check that the work on this request may continue. Raises AbandonedError if not."""
        late = request.overtaken and self.clock() - request.began > self.patience
        if late or not request.wanted:
            raise AbandonedError

    def _work_off(self) -> None:
        while (request := self._next()) is not None:
            answer = _answer_of(request)
            with self.lock:
                self._current = None
                if answer is not None and request.wanted:
                    self._answers.append((request, answer))
                self.lock.notify_all()

    def _next(self) -> Request | None:
        """Return the next request, or None if no request waits.

        Wait until typing has paused for ``quiet`` seconds, or until ``longest`` seconds have passed.
        """
        with self.lock:
            end = self.clock() + self.longest
            while self._waiting and not self._closing:
                left = min(self._asked + self.quiet, end) - self.clock()
                if left <= 0.0:
                    break
                self.lock.wait(left)
            self._current = self._waiting.popleft() if self._waiting else None
            if self._current is None:
                self._running = False
            else:
                self._current.began = self.clock()
            self.reached = 0
            return self._current


def _answer_of(request: Request) -> Callable[[], None] | None:
    """Do the work and return the function that delivers its result; None if the work was canceled."""
    try:
        return request.run(request)
    except AbandonedError:
        return None
    except BaseException as error:  # noqa: BLE001 - whatever it is, it is told where it was asked for
        if _is_a_defect(error):
            _log.error("on the worker %s", request.worker.name, exc_info=error)
        why = sentence(error)
        return lambda: request.failed(why)


def _is_a_defect(error: BaseException) -> bool:
    """Return whether an error is a programming error, so that its traceback must be logged."""
    return type(error).__module__ == "builtins" and not isinstance(error, OSError | ValueError)


class RepeatingThread:
    """A thread that calls ``look`` after ``first`` seconds and then every ``every`` seconds.

    The watchdog identifies the thread by its name.
    """

    def __init__(self, name: str, look: Callable[[], object], every: float, first: float = 0.0) -> None:
        self._look, self._every, self._first = look, every, first
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._repeat, name=name, daemon=True)

    @property
    def closing(self) -> bool:
        """Whether ``close`` was called. If the thread ends without ``close``, its end is an error."""
        return self._closing.is_set()

    def start(self) -> None:
        """Start the thread. Call this once."""
        self._thread.start()

    def close(self) -> None:
        """End the thread. Wait for a call in progress for ``ENDS`` seconds at most.

        A call that hangs remains on the daemon thread.
        """
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join(ENDS)

    def _repeat(self) -> None:
        wait = self._first
        while not self._closing.wait(wait):
            self._look()
            wait = self._every
