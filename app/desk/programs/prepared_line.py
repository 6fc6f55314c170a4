"""MDI line that is proved on a worker and prepared for Cycle Start.

The operator types the line or chooses it on the Jog page.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from app.desk.background_work import LatestRequestWorker, ProgressCallback
from app.desk.programs.program_loading import FirstMoveResult, ProvedJob
from core.executor.commands import Command, PrepareCycleStart
from core.executor.job import Job
from core.executor.snapshot import CYCLE_STATES, Snapshot, StartAction
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message

ProveLine = Callable[[str, Snapshot, ProgressCallback], tuple[Job, ProvedJob]]
"""Function that makes the job and its proof from a line and the current machine snapshot.

It is called on the worker thread.
"""


def find_unmeasured_tool_errors(job: Job, proved_job: ProvedJob) -> tuple[Diagnostic, ...]:
    """Return an error for each tool in the MDI line that does not have a measured offset."""
    missing = proved_job.proof.unset(job)
    text = "Tool {number} has not been set."
    return tuple(
        Diagnostic(
            1, 0, Severity.ERROR, "tool-never-set", Message(text, number=number), "Set the tool with F8."
        )
        for number in missing
    )


@dataclass(slots=True)
class PreparedMdiLine:
    """One MDI line, from the key press that requests it until it runs. A line runs only once.

    Only Cycle Start starts the line. While no line is ready, Cycle Start has no effect.
    """

    prove_text: ProveLine
    post_command: Callable[[Command], None]
    diagnostics: tuple[Diagnostic, ...] = ()  # Diagnostics of the proof.
    ready_job: Job | None = None  # The job that is proved and prepared.
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("loading-mdi"))
    # Called with the first error if the line cannot run.
    on_refused: Callable[[Diagnostic], None] = field(default=lambda _error: None)
    _proof: ProvedJob | None = None  # Proof of the ready line.
    _begun: int = 0  # Number of lines that the executor had started at the last update.

    def prove_line(self, text: str, snapshot: Snapshot, on_failed: Callable[[str], None]) -> None:
        """Prove this MDI line from the current machine state, and discard a previous line that is ready.

        ``on_failed`` is called with an error text if the proof fails unexpectedly.
        """
        self.cancel_line()
        self.worker.request_work(partial(self.prove_text, text, snapshot), self._proved, on_failed)

    def cancel_line(self) -> None:
        """Cancel the line. Cycle Start then has no effect until another line is ready."""
        self.discard_line()
        self.post_command(PrepareCycleStart(StartAction.MDI_LINE))

    def stop_line_mode(self) -> None:
        """Cancel the line and end MDI mode, so that Cycle Start starts programs again."""
        self.discard_line()
        self.post_command(PrepareCycleStart(StartAction.PROGRAM))

    def discard_line(self) -> None:
        """Cancel the proof in progress, and discard the ready line and its diagnostics."""
        self.worker.cancel_request()
        self.ready_job, self.diagnostics = None, ()

    def renew_line_mode(self, snapshot: Snapshot) -> None:
        """Make Cycle Start run MDI lines instead of the program.

        The MDI page calls this method once per frame while it is open. The command is repeated until the
        snapshot shows its effect. While a program runs, the executor rejects the command. A program may
        have started after the snapshot was made.
        """
        if snapshot.state in CYCLE_STATES or snapshot.starts is StartAction.MDI_LINE:
            return
        self._prepare()

    def update(self, snapshot: Snapshot) -> bool:
        """Process the results of the worker, and return whether the MDI line has just started.

        The page calls this method once per frame.
        """
        begun, self._begun = snapshot.lines > self._begun, snapshot.lines
        started = self.ready_job is not None and begun
        if started:
            self.ready_job, self.diagnostics = None, ()
        self.worker.deliver_results()
        return started

    @property
    def is_proving(self) -> bool:
        """Return whether a line is being proved."""
        return self.worker.is_busy

    @property
    def first_move_result(self) -> FirstMoveResult | None:
        """Return the result of the first-move check of the ready line.

        The result is None if no line is ready or the move was not checked.
        """
        return (
            self._proof.first_move_result if self.ready_job is not None and self._proof is not None else None
        )

    @property
    def blocking_errors(self) -> tuple[Diagnostic, ...]:
        """Return the diagnostics that prevent the line from running."""
        return tuple(each for each in self.diagnostics if each.severity is Severity.ERROR)

    def close(self) -> None:
        """End the worker that proves lines."""
        self.worker.close()

    def _proved(self, answer: tuple[Job, ProvedJob]) -> None:
        job, proved = answer
        self.diagnostics = (*proved.diagnostics, *find_unmeasured_tool_errors(job, proved))
        if self.blocking_errors:
            self.on_refused(self.blocking_errors[0])
        else:
            self.ready_job, self._proof = job, proved
            self._prepare()

    def _prepare(self) -> None:
        if self.ready_job is None or self._proof is None:
            self.post_command(PrepareCycleStart(StartAction.MDI_LINE))
        else:
            self.post_command(
                PrepareCycleStart(
                    StartAction.MDI_LINE, self.ready_job, self._proof.proof, self._proof.first_move_clearance
                )
            )
