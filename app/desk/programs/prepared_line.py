"""An MDI line, typed or chosen on the Jog page, that is proved on a worker and prepared for Cycle Start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from app.desk.background_work import Latest, Watch
from app.desk.programs.program_loading import FirstMoveSeen, Proved
from core.executor.commands import Command, Prepare
from core.executor.job import Job
from core.executor.snapshot import CYCLE, Snapshot, Starts
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message

ProveLine = Callable[[str, Snapshot, Watch], tuple[Job, Proved]]
"""From a line and the machine as it stands to its job and its proof; called on the worker."""


def never_set(job: Job, proved: Proved) -> tuple[Diagnostic, ...]:
    """Return an error for each tool that the line calls and that has no measured offset."""
    missing = proved.proof.unset(job)
    text = "Tool {number} has not been set."
    return tuple(
        Diagnostic(
            1, 0, Severity.ERROR, "tool-never-set", Message(text, number=number), "Set the tool with F8."
        )
        for number in missing
    )


@dataclass(slots=True)
class PreparedLine:
    """One MDI line between the key that requests it and the start buttons that run it. A line runs once.

    Only Cycle Start starts the line. While no line is ready, Cycle Start has no effect.
    """

    prove: ProveLine
    post: Callable[[Command], None]
    found: tuple[Diagnostic, ...] = ()  # Diagnostics of the proof.
    ready: Job | None = None  # The job that is proved and prepared.
    worker: Latest = field(default_factory=lambda: Latest("loading-mdi"))
    # Called with the first error if the line cannot run.
    refused: Callable[[Diagnostic], None] = field(default=lambda _error: None)
    _proof: Proved | None = None  # Proof of the ready line.
    _begun: int = 0  # Number of lines that the executor had started at the last update.

    def ask(self, text: str, snapshot: Snapshot, failed: Callable[[str], None]) -> None:
        """Prove this line from the present machine state. A line that was ready is canceled.

        ``failed`` is called with an error text if the proof fails unexpectedly.
        """
        self.take_back()
        self.worker.ask(partial(self.prove, text, snapshot), self._proved, failed)

    def take_back(self) -> None:
        """Cancel the line, so that Cycle Start has no effect."""
        self.forget()
        self.post(Prepare(Starts.LINE))

    def leave(self) -> None:
        """Cancel the line, so that Cycle Start starts programs again."""
        self.forget()
        self.post(Prepare(Starts.PROGRAM))

    def forget(self) -> None:
        """Cancel the proof in progress, and discard the ready line and its diagnostics."""
        self.worker.give_up()
        self.ready, self.found = None, ()

    def keep(self, snapshot: Snapshot) -> None:
        """Make Cycle Start run lines only; called once a frame while the MDI page is open.

        The command is repeated until the snapshot shows it. The executor rejects it during a program, which
        may have started after the snapshot was made.
        """
        if snapshot.state in CYCLE or snapshot.starts is Starts.LINE:
            return
        self._prepare()

    def look(self, snapshot: Snapshot) -> bool:
        """Accept the results of the worker; called once a frame. Return True if the line has just started."""
        begun, self._begun = snapshot.lines > self._begun, snapshot.lines
        started = self.ready is not None and begun
        if started:
            self.ready, self.found = None, ()
        self.worker.poll()
        return started

    @property
    def busy(self) -> bool:
        """Whether a line is being proved."""
        return self.worker.busy

    @property
    def first_move(self) -> FirstMoveSeen | None:
        """The first move of the ready line. None if no line is ready or the move was not checked."""
        return self._proof.first_move if self.ready is not None and self._proof is not None else None

    @property
    def errors(self) -> tuple[Diagnostic, ...]:
        """The diagnostics that prevent the line from running."""
        return tuple(each for each in self.found if each.severity is Severity.ERROR)

    def close(self) -> None:
        """End the worker that proves lines."""
        self.worker.close()

    def _proved(self, answer: tuple[Job, Proved]) -> None:
        job, proved = answer
        self.found = (*proved.diagnostics, *never_set(job, proved))
        if self.errors:
            self.refused(self.errors[0])
        else:
            self.ready, self._proof = job, proved
            self._prepare()

    def _prepare(self) -> None:
        if self.ready is None or self._proof is None:
            self.post(Prepare(Starts.LINE))
        else:
            self.post(Prepare(Starts.LINE, self.ready, self._proof.proof, self._proof.clearance))
