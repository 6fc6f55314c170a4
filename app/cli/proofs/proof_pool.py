"""Proving on all cores: worker processes that are started once, and what happens when one is killed."""

from __future__ import annotations

import contextlib
import gc
import multiprocessing
import os
import signal
import sys
from collections import deque
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, ProcessPoolExecutor, wait
from typing import Generic, Protocol, TypeVar

from app.cli.crash_report import raise_interrupt

Unit = TypeVar("Unit")
Made = TypeVar("Made")

KILLED = "the worker process was killed twice while proving this program (out of memory?)"
# Imported once, in the process that all workers are forked from.
_PRELOAD = (
    "app.cli.figures.proof_json",
    "app.cli.proofs.proof_work",
    "core.interpreter.omniturn.omniturn_interpreter",
    "core.proving.part_proof",
)
_AHEAD = 2  # units that wait in front of the workers


def cores() -> int:
    """How many of them this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class WorkerSource(Protocol):
    """Where workers come from; ``killed`` is the exception that a unit ends with which kills its worker."""

    killed: type[BaseException]

    @property
    def ahead(self) -> int:
        """How many units may be under way."""

    def open(self, jobs: int | None = None, /) -> Executor:
        """Workers, as many as there are or so many."""

    def stop(self, executor: Executor | None, /, *, done: bool) -> None:
        """Let the workers go; of what is not ``done`` end what is under way."""


class Workers:
    """Processes of this computer. ``work`` is a function of a module, and its arguments can be sent."""

    def __init__(self, jobs: int) -> None:
        self.jobs = jobs
        self.killed: type[BaseException] = BrokenExecutor
        self.ahead = jobs + _AHEAD
        self._before = set(multiprocessing.active_children())
        method = "forkserver" if sys.platform == "linux" else "spawn"
        self._context = multiprocessing.get_context(method)
        if method == "forkserver":
            self._context.set_forkserver_preload(list(_PRELOAD))

    def open(self, jobs: int | None = None) -> Executor:
        """So many workers, or all."""
        return ProcessPoolExecutor(jobs or self.jobs, mp_context=self._context, initializer=_begin)

    def stop(self, executor: Executor | None, *, done: bool) -> None:
        """Let the workers go; of what is not ``done`` at once, with what they are at.

        The pool's own thread is waited for: where Python ended beside it, one closed what the other wrote to.
        """
        if not done:
            self._terminate()
        if executor is not None:
            executor.shutdown()

    def _terminate(self) -> None:
        """The pool's own thread takes them away meanwhile: one that is gone already is no error."""
        with contextlib.suppress(OSError, ValueError):
            for each in set(multiprocessing.active_children()) - self._before:
                with contextlib.suppress(OSError, ValueError):
                    each.terminate()


def _begin() -> None:
    """Ctrl-C is for the process that has started the workers; it ends them."""
    gc.set_threshold(50_000)
    signal.signal(signal.SIGINT, signal.SIG_IGN)


class Proving(Generic[Unit, Made]):
    """Gives units of work to workers and hands out what they have made, in the order in which it comes.

    A worker that is killed takes all others of its pool with it. What they were at is done again, one unit
    at a time in a worker of its own: what kills that one too is the cause.
    """

    def __init__(self, workers: WorkerSource, submit: Callable[[Executor, Unit], Future[Made]]) -> None:
        self._workers, self._submit = workers, submit
        self._running: dict[Future[Made], Unit] = {}
        self._again: deque[Unit] = deque()

    def results(self, units: Iterator[Unit]) -> Generator[tuple[Unit, Made | BaseException], None, None]:
        """Each unit with its result, or with what has kept it from one: a BrokenExecutor if it kills."""
        executor: Executor | None = None
        done = False
        try:
            while True:
                raise_interrupt()
                for unit in units:
                    executor = executor or self._workers.open()
                    self._give(executor, unit)
                    if len(self._running) >= self._workers.ahead or self._again:
                        break
                if not self._running and not self._again:
                    break
                yield from self._settled(wait(self._running, return_when=FIRST_COMPLETED).done)
                if self._again:
                    yield from self._settled(wait(self._running).done)
                    assert executor is not None
                    executor.shutdown()
                    executor = None
                    yield from self._one_by_one()
            done = True
        finally:
            for future in self._running:
                future.cancel()
            self._workers.stop(executor, done=done)

    def _give(self, executor: Executor, unit: Unit) -> None:
        try:
            self._running[self._submit(executor, unit)] = unit
        except BrokenExecutor:
            self._again.append(unit)

    def _settled(self, done: set[Future[Made]]) -> Iterator[tuple[Unit, Made | BaseException]]:
        for future in done:
            unit = self._running.pop(future)
            error = future.exception()
            if isinstance(error, BrokenExecutor):
                self._again.append(unit)
            else:
                yield unit, error or future.result()

    def _one_by_one(self) -> Iterator[tuple[Unit, Made | BaseException]]:
        while self._again:
            with self._workers.open(1) as alone:
                while self._again:
                    unit = self._again.popleft()
                    future = self._submit(alone, unit)
                    error = future.exception()
                    yield unit, error or future.result()
                    if isinstance(error, BrokenExecutor):
                        break
