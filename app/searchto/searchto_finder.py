"""The worker of SEARCHTO: finds lines and proves restarts, one at a time; what nobody wants is given up."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.background_work import Latest, Watch
from app.desk.programs.program_loading import Proved
from core.executor.job import Job
from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_point import Interruption, NoRestart, RestartPoint

if TYPE_CHECKING:
    from core.interpreter.restart.program_search import ProgramSearch
    from core.interpreter.restart.state_rebuild import StateRebuild

    Search = StateRebuild | ProgramSearch

Answer = RestartPoint | NoRestart | CutRecord | tuple[Job, Proved]


@dataclass(slots=True)
class LineFinder:
    """``rebuild`` and ``prove`` are called on the worker; a later line goes on from an earlier one.

    ``found`` and ``failed`` are called with what has come, when the worker is polled.
    """

    rebuild: Callable[[Job, Watch], Search]
    prove: Callable[[Job, Watch], Proved]
    found: Callable[[Answer], None]
    failed: Callable[[str], None]
    worker: Latest = field(default_factory=lambda: Latest("loading-search"))
    _rebuild: tuple[Job, Search] | None = None  # the worker's alone

    def find(self, job: Job, line: int, visit: int = 0, broken: Interruption | None = None) -> None:
        """Have a line of this job's program found; 0: in the pass that was interrupted, or in the first."""
        self._ask(job, lambda rebuild: rebuild.find(line, visit, broken))

    def cut(self, job: Job) -> None:
        """Have all that this job's program cuts gone through."""
        self._ask(job, lambda rebuild: rebuild.cut)

    def check(self, job: Job) -> None:
        """Have the job of a restart proved."""
        self.worker.ask(lambda watch: (job, self.prove(job, watch)), self.found, self.failed)

    def _ask(self, job: Job, ask: Callable[[Search], Answer]) -> None:
        self.worker.ask(lambda watch: self._with(job, watch, ask), self.found, self.failed)

    def _with(self, job: Job, watch: Watch, ask: Callable[[Search], Answer]) -> Answer:
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
