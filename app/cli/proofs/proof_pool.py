"""Proving on all cores: a pool of worker processes, with recovery if a worker is killed."""

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

from app.cli.bug_report.crash_report import raise_interrupt

Unit = TypeVar("Unit")
Made = TypeVar("Made")

KILLED = "the worker process was killed twice while proving this program (out of memory?)"
# Modules imported once, in the process from which all workers are forked.
_PRELOAD = (
    "app.cli.figures.proof_json",
    "app.cli.proofs.proof_work",
    "core.interpreter.omniturn.omniturn_interpreter",
    "core.proving.part_proof",
)
_AHEAD = 2  # units queued in addition to those that workers process


def cores() -> int:
    """Return the number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class WorkerSource(Protocol):
    """Source of workers; ``killed`` is the exception of a unit that kills its worker."""

    killed: type[BaseException]

    @property
    def ahead(self) -> int:
        """Largest number of units in progress."""

    def open(self, jobs: int | None = None, /) -> Executor:
        """Start workers, ``jobs`` or all, and return their executor."""

    def stop(self, executor: Executor | None, /, *, done: bool) -> None:
        """Stop the workers; unless ``done`` is true, also abort the units in progress."""


class Workers:
    """Worker processes on this computer.

    Units must be functions of modules with arguments that can be pickled.
    """

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
        """Start ``jobs`` workers, or all, and return their executor."""
        return ProcessPoolExecutor(jobs or self.jobs, mp_context=self._context, initializer=_begin)

    def stop(self, executor: Executor | None, *, done: bool) -> None:
        """Stop the workers; unless ``done`` is true, also abort the units in progress.

        The method waits for the thread of the pool, because Python's shutdown would otherwise close pipes
        that this thread still uses.
        """
        if not done:
            self._terminate()
        if executor is not None:
            executor.shutdown()

    def _terminate(self) -> None:
        """Terminate the worker processes. Processes that the pool has already removed are ignored."""
        with contextlib.suppress(OSError, ValueError):
            for each in set(multiprocessing.active_children()) - self._before:
                with contextlib.suppress(OSError, ValueError):
                    each.terminate()


def _begin() -> None:
    """Initialize a worker, which ignores Ctrl-C because the parent process ends it."""
    gc.set_threshold(50_000)
    signal.signal(signal.SIGINT, signal.SIG_IGN)


class Proving(Generic[Unit, Made]):
    """Distribution of units of work to workers; results are returned in the order in which they finish.

    If a worker is killed, all workers of its pool end. Their units are then repeated one at a time, each in
    its own worker. A unit that kills its worker again is the cause.
    """

    def __init__(self, workers: WorkerSource, submit: Callable[[Executor, Unit], Future[Made]]) -> None:
        self._workers, self._submit = workers, submit
        self._running: dict[Future[Made], Unit] = {}
        self._again: deque[Unit] = deque()

    def results(self, units: Iterator[Unit]) -> Generator[tuple[Unit, Made | BaseException], None, None]:
        """Yield each unit with its result or its exception.

        A BrokenExecutor means that the unit kills its worker.
        """
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
