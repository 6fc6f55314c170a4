"""The worker of SEARCHTO: finds lines and proves restarts, one at a time; what nobody wants is given up."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.latest import AbandonedError, Watch
from app.desk.program_loading import Proved
from core.executor.job import Job
from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_lines import Interruption, NoRestart, RestartPoint

if TYPE_CHECKING:
    from core.interpreter.restart.state_rebuild import StateRebuild

Answer = RestartPoint | NoRestart | CutRecord | tuple[Job, Proved]


@dataclass(slots=True)
class Finder:
    """``rebuild`` and ``prove`` are called on the worker; a later line goes on from an earlier one."""

    rebuild: Callable[[Job, Watch], StateRebuild]
    prove: Callable[[Job, Watch], Proved]
    reached: int = 0  # blocks that the work has come to
    _rebuild: tuple[Job, StateRebuild] | None = None  # the worker's alone
    _future: Future[Answer] | None = None
    _ticket: int = 0
    _pool: ThreadPoolExecutor = field(
        default_factory=lambda: ThreadPoolExecutor(1, thread_name_prefix="loading-search")
    )

    def find(self, job: Job, line: int, visit: int = 0, broken: Interruption | None = None) -> None:
        """Have a line of this job's program found; 0: in the pass that was interrupted, or in the first."""
        watch = self._watch()
        self._future = self._pool.submit(self._with, job, watch, lambda one: one.find(line, visit, broken))

    def cut(self, job: Job) -> None:
        """Have all that this job's program cuts gone through."""
        watch = self._watch()
        self._future = self._pool.submit(self._with, job, watch, lambda one: one.cut)

    def check(self, job: Job) -> None:
        """Have a restart proved."""
        watch = self._watch()
        self._future = self._pool.submit(lambda: (job, self.prove(job, watch)))

    def poll(self) -> Future[Answer] | None:
        """What has come, once; None while it is still to come."""
        future = self._future
        if future is None or not future.done():
            return None
        self._future = None
        return None if isinstance(future.exception(), AbandonedError) else future

    def give_up(self) -> None:
        """Nobody wants the answer any more."""
        self._ticket += 1
        self._future = None

    def settle(self, timeout: float) -> None:
        """Wait for the worker; for scripts and tests, never for the screen."""
        if self._future is not None:
            wait([self._future], timeout)

    def close(self) -> None:
        """End the worker."""
        self.give_up()
        self._pool.shutdown(wait=True, cancel_futures=True)

    def _with(self, job: Job, watch: Watch, ask: Callable[[StateRebuild], Answer]) -> Answer:
        """Work that is given up leaves nothing behind: a pass stopped within a line is worth nothing."""
        kept, self._rebuild = self._rebuild, None
        if kept is not None and kept[0] is job:
            rebuild = kept[1]
            rebuild.watch = watch
        else:
            rebuild = self.rebuild(job, watch)
        answer = ask(rebuild)
        self._rebuild = (job, rebuild)
        return answer

    def _watch(self) -> Watch:
        self._ticket += 1
        ticket = self._ticket
        self.reached = 0

        def watch(count: float) -> None:
            if ticket != self._ticket:
                raise AbandonedError
            self.reached = int(count)

        return watch
