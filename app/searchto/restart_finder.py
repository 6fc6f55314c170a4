"""Search for the restart line of SEARCHTO by number or text, and proof of the restart on a worker."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from app.desk.arithmetic import evaluate_line_number
from app.desk.background_work import LatestRequestWorker, ProgressCallback
from app.desk.pages.table_content import apply_edit_key
from app.desk.programs.program_loading import ProvedJob
from core.executor.job import Job
from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_point import Interruption, RestartPoint, RestartRejection

if TYPE_CHECKING:
    from core.interpreter.restart.program_search import RestartLineSearch
    from core.interpreter.restart.state_rebuild import OmniturnRestartSearch

    RestartSearch = OmniturnRestartSearch | RestartLineSearch


RestartSearchResult = RestartPoint | RestartRejection | CutRecord | tuple[Job, ProvedJob]


@dataclass(slots=True)
class RestartFinder:
    """Finder that calculates the machine state at a restart line and proves the restart, on a worker.

    A search for a later line continues from an earlier search. ``rebuild_state`` and ``prove_job`` are
    called on the worker. ``on_found`` and ``on_failed`` get the results when the worker is polled.
    """

    rebuild_state: Callable[[Job, ProgressCallback], RestartSearch]
    prove_job: Callable[[Job, ProgressCallback], ProvedJob]
    on_found: Callable[[RestartSearchResult], None]
    on_failed: Callable[[str], None]
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("loading-search"))
    _rebuild: tuple[Job, RestartSearch] | None = None  # Used by the worker only.

    def find_restart_line(
        self, job: Job, line_number: int, pass_number: int = 0, interruption: Interruption | None = None
    ) -> None:
        """Request the machine state at a line of this job's program.

        ``pass_number`` is the execution of the line, counted from 1. If it is 0, the interrupted execution
        is used, or the first execution if none was interrupted.
        """
        self._ask(job, lambda rebuild: rebuild.find_restart_point(line_number, pass_number, interruption))

    def calculate_cuts(self, job: Job) -> None:
        """Calculate all cuts of the program of this job."""
        self._ask(job, lambda rebuild: rebuild.cut_record)

    def prove_restart(self, job: Job) -> None:
        """Prove the job that a restart would run, on the worker."""
        self.worker.request_work(
            lambda watch: (job, self.prove_job(job, watch)), self.on_found, self.on_failed
        )

    def _ask(self, job: Job, ask: Callable[[RestartSearch], RestartSearchResult]) -> None:
        self.worker.request_work(lambda watch: self._with(job, watch, ask), self.on_found, self.on_failed)

    def _with(
        self, job: Job, watch: ProgressCallback, ask: Callable[[RestartSearch], RestartSearchResult]
    ) -> RestartSearchResult:
        """Run a query on the worker, with the search that already exists for this job.

        A canceled search is discarded, because it stopped in the middle of a line.
        """
        kept, self._rebuild = self._rebuild, None
        if kept is not None and kept[0] is job:
            rebuild = kept[1]
            rebuild.report_progress = watch
        else:
            rebuild = self.rebuild_state(job, watch)
        answer = ask(rebuild)
        self._rebuild = (job, rebuild)
        return answer


_PASS_PATTERN = re.compile(r"\s*(\d+)\s*[Pp]\s*(\d+)\s*")
MAX_ENTRY_LENGTH = 60  # Maximum characters of the entry.
_QUOTE = '"'


@dataclass(slots=True)
class LineCursor:
    """The selected program line, counted from 1, and the text entered to find another line."""

    program_lines: Sequence[str] = ()
    selected_line: int = 1
    entry_text: str = ""
    is_text_found: bool = False  # The line was found by the present text.

    @property
    def entered_line_number(self) -> int | None:
        """Return the entered line number, or None if the entry is a search text.

        The number may be entered as an expression.
        """
        passes = _PASS_PATTERN.fullmatch(self.entry_text)
        return int(passes[1]) if passes else evaluate_line_number(self.entry_text)

    @property
    def entered_pass_number(self) -> int:
        """Return the pass (execution) of the line that was entered, for example 4 in ``8P4``.

        Return 0 if no pass was entered.
        """
        passes = _PASS_PATTERN.fullmatch(self.entry_text)
        return int(passes[2]) if passes else 0

    @property
    def search_text(self) -> str:
        """Return the search text.

        If a number follows a quotation mark, the number is the search text.
        """
        return self.entry_text.removeprefix(_QUOTE).upper()

    def set_program(self, lines: Sequence[str], line_number: int) -> None:
        """Set the program lines and the selected line."""
        self.program_lines, self.entry_text, self.is_text_found = lines, "", False
        self.select_line(line_number)

    def select_line(self, line_number: int) -> None:
        """Select this line, or the nearest line that exists."""
        self.selected_line = max(1, min(line_number, len(self.program_lines)))

    def handle_key(self, key: str) -> bool:
        """Handle a character or an editing key, and return False for any other key."""
        taken = key in {"Back", "Delete"} or (len(key) == 1 and key.isprintable())
        if taken:
            self.entry_text, self.is_text_found = (
                apply_edit_key(self.entry_text, key, MAX_ENTRY_LENGTH),
                False,
            )
        return taken

    def find_text(self, direction: int) -> bool:
        """Select the next (1) or previous (-1) line that contains the text, and wrap around at the end.

        Return False if no line contains the text.
        """
        count, wanted = len(self.program_lines), self.search_text
        if not wanted:
            return False
        for step in range(1, count + 1):
            at = (self.selected_line - 1 + direction * step) % count
            if wanted in self.program_lines[at].upper():
                self.selected_line, self.is_text_found = at + 1, True
                return True
        return False
