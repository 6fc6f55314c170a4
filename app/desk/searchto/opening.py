"""The SEARCHTO page opened and left: who starts what meanwhile, and what is forgotten."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.latest import Watch
from app.desk.searchto.cursor import Cursor
from app.desk.searchto.finder import Finder
from app.desk.searchto.leaving import Leaving
from app.desk.searchto.plan import Plan
from app.desk.searchto.stage import Stage
from app.desk.session import Loaded, Phase, Proved, Session
from app.desk.words import tr
from core.executor.commands import Command, Prepare
from core.executor.job import Job
from core.executor.snapshot import CYCLE, Snapshot, Starts
from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_approach import Choices
from core.interpreter.restart.restart_lines import NoRestart
from core.language.source import Dialect

if TYPE_CHECKING:
    from core.interpreter.restart.state_rebuild import StateRebuild


@dataclass(slots=True)
class SearchOpening:
    """What SEARCHTO holds. ``say`` answers on the prompt line, ``clear`` takes that back."""

    session: Session
    post: Callable[[Command], None]
    snapshot: Callable[[], Snapshot]
    say: Callable[[str], None]
    clear: Callable[[], None]
    rebuild: Callable[[Job, Watch], StateRebuild]  # what goes through a program; called on the worker
    choices: Choices = field(default_factory=Choices)
    cursor: Cursor = field(default_factory=Cursor)
    stage: Stage = Stage.CHOOSE
    open: bool = False
    answer: NoRestart | None = None
    plan: Plan | None = None
    leaving: Leaving | None = None  # the way out alone
    number: int = 0  # of the pass in which the line is meant; 0: the one that was interrupted, or the first
    count: int = 0  # how often the run comes to the line, once that is known
    proved: Proved | None = None
    started: bool = False  # the restart was started: what is to be seen now is the Automatic page
    finder: Finder = field(init=False)
    _job: Job | None = None
    _of: Job | None = None  # the program's job that was searched
    _accepted: bool = False
    _cut: CutRecord | None = None
    _going_out: bool = False

    def __post_init__(self) -> None:
        self.finder = Finder(self.rebuild, self.session.workshop.prove)

    @property
    def has_keyboard(self) -> bool:
        """Whether a line can be chosen: not while the way out is under way."""
        return self.snapshot().state not in CYCLE

    def opens(self) -> bool:
        """Whether it may be opened now; says why not."""
        why = self._why_closed(self.snapshot(), self.session.now)
        if why:
            self.say(why)
        return not why

    def opened(self) -> None:
        """From now on Cycle Start begins a confirmed restart and nothing else."""
        loaded, snapshot = self.session.now, self.snapshot()
        self.clear()  # why the palms began nothing before has been read
        self.open, self.started = True, False
        lines = loaded.source.lines if loaded.source is not None else ()
        before = self.cursor.line if self.cursor.lines is lines else 1
        self.cursor.show(lines, snapshot.interrupted_line or before)
        self.number = self.count = 0
        self._going_out = False
        self._forget()

    def leave(self) -> None:
        """Cycle Start begins programs again."""
        if self.open:
            self.open = False
            self._withdraw()
            self.post(Prepare(Starts.PROGRAM))

    def close(self) -> None:
        """End the worker."""
        self.finder.close()

    def _why_closed(self, snapshot: Snapshot, loaded: Loaded) -> str:
        if snapshot.state in CYCLE:
            return tr("A PROGRAM IS UNDER WAY: LET IT END, OR STOP IT AND PRESS R, BEFORE SEARCHTO")
        if loaded.source is None or loaded.job is None:
            return tr("CHOOSE A PROGRAM FIRST (F2)")
        if loaded.source.dialect is not Dialect.OMNITURN:
            return tr("SEARCHTO READS OMNITURN PROGRAMS ONLY; THIS ONE STARTS FROM ITS FIRST LINE")
        if loaded.phase is not Phase.READY:
            return tr("THE PROGRAM IS NOT PROVED WITHOUT ERRORS: SEARCHTO NEEDS THAT")
        return ""

    def _forget(self) -> None:
        """Nothing is shown and nothing is ready."""
        self._withdraw()
        if self.open and self.has_keyboard:
            self.post(Prepare(Starts.RESTART))

    def _withdraw(self) -> None:
        self.finder.give_up()
        self.stage, self.answer, self.plan, self.proved = Stage.CHOOSE, None, None, None
        self.leaving, self._cut = None, None
        self._job, self._accepted = None, False
