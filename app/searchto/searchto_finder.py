"""The line that SEARCHTO looks for: by number or text, found and proved on a worker, one at a time."""

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


_PASS = re.compile(r"\s*(\d+)\s*[Pp]\s*(\d+)\s*")
LONGEST = 60  # characters of what is typed
_QUOTE = '"'


@dataclass(slots=True)
class LineCursor:
    """A line of the program, counted from 1, and what is being typed to find another."""

    lines: Sequence[str] = ()
    line: int = 1
    text: str = ""
    found: bool = False  # the line was found by the text as it stands

    @property
    def number(self) -> int | None:
        """The number of a line that was typed, a sum too; None when it is a text to look for."""
        passes = _PASS.fullmatch(self.text)
        return int(passes[1]) if passes else line_of(self.text)

    @property
    def visit(self) -> int:
        """The pass that was typed behind the line, such as ``8P4``; 0: none was."""
        passes = _PASS.fullmatch(self.text)
        return int(passes[2]) if passes else 0

    @property
    def wanted(self) -> str:
        """The text to look for; a quotation mark in front makes figures a text."""
        return self.text.removeprefix(_QUOTE).upper()

    def show(self, lines: Sequence[str], line: int) -> None:
        """Another program, or another line to begin with."""
        self.lines, self.text, self.found = lines, "", False
        self.go(line)

    def go(self, line: int) -> None:
        """To this line, or the nearest there is."""
        self.line = max(1, min(line, len(self.lines)))

    def type(self, key: str) -> bool:
        """A character or an editing key; False when it means nothing here."""
        taken = key in {"Back", "Delete"} or (len(key) == 1 and key.isprintable())
        if taken:
            self.text, self.found = edited(self.text, key, LONGEST), False
        return taken

    def find(self, way: int) -> bool:
        """To the next (1) or the previous (-1) line that holds the text, round the end; False: in none."""
        count, wanted = len(self.lines), self.wanted
        if not wanted:
            return False
        for step in range(1, count + 1):
            at = (self.line - 1 + way * step) % count
            if wanted in self.lines[at].upper():
                self.line, self.found = at + 1, True
                return True
        return False
