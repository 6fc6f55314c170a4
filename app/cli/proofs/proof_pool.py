"""Pool of worker processes that proves programs on all CPU cores and recovers if a worker is killed."""

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

from app.cli.bug_report.crash_report import raise_dropped_interrupt

WorkUnit = TypeVar("WorkUnit")
UnitResult = TypeVar("UnitResult")

WORKER_KILLED_TEXT = "the worker process was killed twice while proving this program (out of memory?)"
# Modules imported once, in the process from which all workers are forked.
_PRELOADED_MODULES = (
    "app.cli.outputs.proof_output",
    "app.cli.proofs.proof_work",
    "core.interpreter.omniturn.omniturn_interpreter",
    "core.proving.part_proof",
)
_EXTRA_UNITS = 2  # units queued in addition to those that workers process


def count_cores() -> int:
    """Return the number of CPU cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class WorkerProvider(Protocol):
    """Source of worker processes for units of work.

    ``worker_killed_exception`` is the exception that a unit of work raises if its worker is killed.
    """

    worker_killed_exception: type[BaseException]

    @property
    def max_active_work_units(self) -> int:
        """Return the maximum number of units of work that may be in progress at the same time."""

    def start_workers(self, worker_count: int | None = None, /) -> Executor:
        """Start ``worker_count`` workers, or all workers if it is None, and return their executor."""

    def stop_workers(self, executor: Executor | None, /, *, is_done: bool) -> None:
        """Stop the workers. If ``is_done`` is false, also abort the units in progress."""


class LocalWorkers:
    """Worker processes on this computer.

    Units must be module-level functions, and their arguments must be picklable.
    """

    def __init__(self, worker_count: int) -> None:
        self.worker_count = worker_count
        self.worker_killed_exception: type[BaseException] = BrokenExecutor
        self.max_active_work_units = worker_count + _EXTRA_UNITS
        self._before = set(multiprocessing.active_children())
        method = "forkserver" if sys.platform == "linux" else "spawn"
        self._context = multiprocessing.get_context(method)
        if method == "forkserver":
            self._context.set_forkserver_preload(list(_PRELOADED_MODULES))

    def start_workers(self, worker_count: int | None = None) -> Executor:
        """Start ``worker_count`` workers, or all workers if it is None, and return their executor."""
        return ProcessPoolExecutor(
            worker_count or self.worker_count, mp_context=self._context, initializer=_initialize_worker
        )

    def stop_workers(self, executor: Executor | None, *, is_done: bool) -> None:
        """Stop the workers. If ``is_done`` is false, also abort the units in progress.

        The method waits for the pool's thread, because Python's shutdown would otherwise close pipes that
        this thread still uses.
        """
        if not is_done:
            self._terminate_workers()
        if executor is not None:
            executor.shutdown()

    def _terminate_workers(self) -> None:
        """Terminate the worker processes. Processes that have already left the pool are ignored."""
        with contextlib.suppress(OSError, ValueError):
            for each in set(multiprocessing.active_children()) - self._before:
                with contextlib.suppress(OSError, ValueError):
                    each.terminate()


def _initialize_worker() -> None:
    """Make a worker ignore Ctrl+C, because the parent process ends the worker."""
    gc.set_threshold(50_000)
    signal.signal(signal.SIGINT, signal.SIG_IGN)


class WorkDistributor(Generic[WorkUnit, UnitResult]):
    """Distributor of units of work to workers.

    The distributor returns results in the order in which the units finish. If a worker is killed, all
    workers of its pool end. The distributor then repeats their units one at a time, each in a separate
    worker. A repeated unit that kills its worker again is the cause of the failure.
    """

    def __init__(
        self, workers: WorkerProvider, submit_unit: Callable[[Executor, WorkUnit], Future[UnitResult]]
    ) -> None:
        self._workers, self._submit = workers, submit_unit
        self._running: dict[Future[UnitResult], WorkUnit] = {}
        self._again: deque[WorkUnit] = deque()

    def iterate_results(
        self, units: Iterator[WorkUnit]
    ) -> Generator[tuple[WorkUnit, UnitResult | BaseException], None, None]:
        """Yield each unit of work with its result or its exception.

        The exception BrokenExecutor means that the unit killed its worker.
        """
        executor: Executor | None = None
        done = False
        try:
            while True:
                raise_dropped_interrupt()
                for unit in units:
                    executor = executor or self._workers.start_workers()
                    self._give(executor, unit)
                    if len(self._running) >= self._workers.max_active_work_units or self._again:
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
            self._workers.stop_workers(executor, is_done=done)

    def _give(self, executor: Executor, unit: WorkUnit) -> None:
        try:
            self._running[self._submit(executor, unit)] = unit
        except BrokenExecutor:
            self._again.append(unit)

    def _settled(
        self, done: set[Future[UnitResult]]
    ) -> Iterator[tuple[WorkUnit, UnitResult | BaseException]]:
        for future in done:
            unit = self._running.pop(future)
            error = future.exception()
            if isinstance(error, BrokenExecutor):
                self._again.append(unit)
            else:
                yield unit, error or future.result()

    def _one_by_one(self) -> Iterator[tuple[WorkUnit, UnitResult | BaseException]]:
        while self._again:
            with self._workers.start_workers(1) as alone:
                while self._again:
                    unit = self._again.popleft()
                    future = self._submit(alone, unit)
                    error = future.exception()
                    yield unit, error or future.result()
                    if isinstance(error, BrokenExecutor):
                        break
