"""Slow and repeated work of the desk, on threads of its own.

Of slow work the newest request wins, and answers are taken up once a frame. What is proved, drawn or looked
for is only worth something as long as nobody wants something newer; what is written is written to its end.
Whoever asks is answered on his own thread, when he polls.
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

ENDS = 2.0  # s that closing waits for work in hand
T = TypeVar("T")
Watch = Callable[[float], None]
"""Told how far slow work has come; it may raise AbandonedError, which has to be let through."""
Failed = Callable[[str], None]


class DaemonWorker:
    """Carries tasks out, one after the other, on one daemon thread; the thread starts with the first task.

    A ThreadPoolExecutor would join its threads when the interpreter ends, however long they hang. A task may
    raise nothing.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._tasks: queue.SimpleQueue[Callable[[], None] | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()
        self._closed = False

    def submit(self, task: Callable[[], None]) -> None:
        """Queue a task; a closed worker drops it."""
        with self._lock:
            if self._closed:
                return
            self._tasks.put(task)
            if self._thread is None:
                self._thread = threading.Thread(target=self._work, name=self._name, daemon=True)
                self._thread.start()

    def close(self, limit: float) -> None:
        """Finish the queued tasks; wait ``limit`` seconds for them at most."""
        with self._lock:
            self._closed = True
            self._tasks.put(None)
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join(limit)

    def _work(self) -> None:
        while (task := self._tasks.get()) is not None:
            task()


class AbandonedError(Exception):
    """Something newer is wanted: the work in hand is given up."""


def sentence(error: BaseException) -> str:
    """What a failure on a worker is called on the screen."""
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return str(error) or type(error).__name__


@dataclass(slots=True, eq=False)
class Request:
    """One request, handed to the work that it is for; called by that work, it is its ``Watch``."""

    worker: Latest
    run: Callable[[Request], Callable[[], None]]  # does the work; what it returns gives the answer
    failed: Failed
    queued: bool  # worked to its end, whatever is asked for meanwhile
    wanted: bool = True
    overtaken: bool = False  # by a newer one, which waits as long as the worker has patience
    began: float = 0.0

    def __call__(self, reached: float = 0.0) -> None:
        """The work has come so far. Raises AbandonedError when it is to be given up."""
        self.worker.go_on(self)
        self.worker.reached = int(reached)

    def publish(self, put: Callable[[], None]) -> None:
        """Call ``put`` from the worker, with what is known so far; nothing newer can be asked for meanwhile.

        Raises AbandonedError when nobody wants it any more.
        """
        with self.worker.lock:
            if not self.wanted:
                raise AbandonedError
            put()


@dataclass(slots=True)
class Latest:
    """``ask`` takes the place of what was asked before; ``queue`` waits for its turn and is never given up.

    For what is typed: ``quiet`` seconds without another request before work begins, put off no longer than
    ``longest``; and ``patience`` seconds for which an overtaken request may still come to its end. ``beside``
    is another worker whose thread this one shares.
    """

    name: str  # of the thread
    quiet: float = 0.0
    longest: float = 0.0
    patience: float = 0.0
    beside: Latest | None = None
    clock: Callable[[], float] = time.monotonic
    reached: int = 0  # how far the work in hand has come
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

    # --- the side that asks --------------------------------------------------------------------------

    @property
    def busy(self) -> bool:
        """Whether an answer is still to come, or to be taken up."""
        with self.lock:
            at_work = self._current is not None and self._current.wanted
            return at_work or bool(self._waiting or self._answers)

    def ask(self, work: Callable[[Request], T], done: Callable[[T], None], failed: Failed) -> None:
        """Have ``work`` done instead of what was asked for before.

        ``poll`` then calls ``done`` with its answer, or ``failed`` with a sentence. ``work`` gets the request
        as its watch.
        """
        with self.lock:
            if not self.patience:
                self.give_up()
            elif self._current is not None:
                self._current.overtaken = True
            self._drop_waiting()
            self._begin(work, done, failed, queued=False)

    def queue(self, work: Callable[[], T], done: Callable[[T], None], failed: Failed) -> None:
        """Have ``work`` done after all that waits; nothing takes its place. Answered as ``ask`` is."""
        with self.lock:
            self._begin(lambda _request: work(), done, failed, queued=True)

    def give_up(self) -> None:
        """Nobody wants the answer any more; what was queued is done and answered all the same."""
        with self.lock:
            self._drop_waiting()
            if self._current is not None and not self._current.queued:
                self._current.wanted = False
            self._answers = deque(each for each in self._answers if each[0].queued)
            self.reached = 0

    def poll(self) -> None:
        """Once a frame: give the answers that have come, in the order of the work."""
        while True:
            with self.lock:
                if not self._answers:
                    return
                _request, answer = self._answers.popleft()
            answer()

    def settle(self, timeout: float) -> None:
        """Wait for the answers and give them; for scripts and tests, never for the screen."""
        end = time.monotonic() + timeout
        while self.busy and time.monotonic() < end:
            with self.lock:
                self.lock.wait_for(lambda: self._answers or not self.busy, end - time.monotonic())
            self.poll()

    def close(self) -> None:
        """End the thread: what was asked for is given up, what was queued is done to its end, unanswered.

        Work that takes longer than ``ENDS`` seconds is left to the daemon thread.
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

    # --- the thread ----------------------------------------------------------------------------------

    def go_on(self, request: Request) -> None:
        """Raises AbandonedError when the work at this request is to be given up."""
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
        """What to do now, once the keys rest or have been waited for long enough; None: nothing."""
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
    """Do the work; None when it was given up."""
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
    """Whether it is no sentence of ours or of the system: whoever mends it needs its traceback."""
    return type(error).__module__ == "builtins" and not isinstance(error, OSError | ValueError)


class RepeatingThread:
    """Calls ``look`` after ``first`` s, then every ``every`` s; its name is what the watchdog knows."""

    def __init__(self, name: str, look: Callable[[], object], every: float, first: float = 0.0) -> None:
        self._look, self._every, self._first = look, every, first
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._repeat, name=name, daemon=True)

    @property
    def closing(self) -> bool:
        """Whether it was told to end; else its end is a mistake."""
        return self._closing.is_set()

    def start(self) -> None:
        """Once."""
        self._thread.start()

    def close(self) -> None:
        """Wait ``ENDS`` seconds at most for a look that is under way; one that hangs is left running."""
        self._closing.set()
        if self._thread.is_alive():
            self._thread.join(ENDS)

    def _repeat(self) -> None:
        wait = self._first
        while not self._closing.wait(wait):
            self._look()
            wait = self._every
