"""Search for the restart line of SEARCHTO, by number or text, and its proof on a worker."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.arithmetic import line_of
from app.desk.background_work import Latest, Watch
from app.desk.pages.sheet import edited
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
    """Finds and proves restart lines on a worker. A search for a later line continues from an earlier one.

    ``rebuild`` and ``prove`` are called on the worker. ``found`` and ``failed`` are called with the results
    when the worker is polled.
    """

    rebuild: Callable[[Job, Watch], Search]
    prove: Callable[[Job, Watch], Proved]
    found: Callable[[Answer], None]
    failed: Callable[[str], None]
    worker: Latest = field(default_factory=lambda: Latest("loading-search"))
    _rebuild: tuple[Job, Search] | None = None  # Used by the worker only.

    def find(self, job: Job, line: int, visit: int = 0, broken: Interruption | None = None) -> None:
        """Search for a line of this job's program.

        ``visit`` is the pass of the line, counted from 1. 0 means the interrupted pass, or else the first
        pass.
        """
        self._ask(job, lambda rebuild: rebuild.find(line, visit, broken))

    def cut(self, job: Job) -> None:
        """Calculate everything that this job's program cuts."""
        self._ask(job, lambda rebuild: rebuild.cut)

    def check(self, job: Job) -> None:
        """Prove the job of a restart."""
        self.worker.ask(lambda watch: (job, self.prove(job, watch)), self.found, self.failed)

    def _ask(self, job: Job, ask: Callable[[Search], Answer]) -> None:
        self.worker.ask(lambda watch: self._with(job, watch, ask), self.found, self.failed)

    def _with(self, job: Job, watch: Watch, ask: Callable[[Search], Answer]) -> Answer:
        """Run a query on the worker. A canceled search is discarded, because it stopped within a line."""
        kept, self._rebuild = self._rebuild, None
        if kept is not None and kept[0] is job:
            rebuild = kept[1]
            rebuild.watch = watch
        else:
            rebuild = self.rebuild(job, watch)
        answer = ask(rebuild)
        self._rebuild = (job, rebuild)
        return answer


_PASS = re.compile(r"\s*(\d+)\s*[Pp]\s*(\d+)\s*")
LONGEST = 60  # Maximum characters of the entry.
_QUOTE = '"'


@dataclass(slots=True)
class LineCursor:
    """The selected program line, counted from 1, and the text that is entered to find another line."""

    lines: Sequence[str] = ()
    line: int = 1
    text: str = ""
    found: bool = False  # The line was found by the present text.

    @property
    def number(self) -> int | None:
        """The line number that was entered, also as an expression. None if the entry is a search text."""
        passes = _PASS.fullmatch(self.text)
        return int(passes[1]) if passes else line_of(self.text)

    @property
    def visit(self) -> int:
        """The pass that was entered after the line, for example in ``8P4``. 0 without a pass."""
        passes = _PASS.fullmatch(self.text)
        return int(passes[2]) if passes else 0

    @property
    def wanted(self) -> str:
        """The search text. A leading quotation mark makes a number a text."""
        return self.text.removeprefix(_QUOTE).upper()

    def show(self, lines: Sequence[str], line: int) -> None:
        """Set the program lines and the selected line."""
        self.lines, self.text, self.found = lines, "", False
        self.go(line)

    def go(self, line: int) -> None:
        """Select this line, or the nearest line that exists."""
        self.line = max(1, min(line, len(self.lines)))

    def type(self, key: str) -> bool:
        """Handle a character or an editing key. Return False if the key has no meaning here."""
        taken = key in {"Back", "Delete"} or (len(key) == 1 and key.isprintable())
        if taken:
            self.text, self.found = edited(self.text, key, LONGEST), False
        return taken

    def find(self, way: int) -> bool:
        """Select the next (1) or previous (-1) line that contains the text, in a cycle.

        Return False if no line contains the text.
        """
        count, wanted = len(self.lines), self.wanted
        if not wanted:
            return False
        for step in range(1, count + 1):
            at = (self.line - 1 + way * step) % count
            if wanted in self.lines[at].upper():
                self.line, self.found = at + 1, True
                return True
        return False
