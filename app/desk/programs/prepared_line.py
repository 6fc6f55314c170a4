"""A line of MDI, typed or chosen on the Jog page: proved on a worker and made ready for Cycle Start."""

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
    """An error for each tool that the line calls and nobody has set."""
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
    """One line between the key that asks for it and the palms that run it; it runs once.

    Nothing starts but by Cycle Start, and as long as no line is ready that begins nothing at all.
    """

    prove: ProveLine
    post: Callable[[Command], None]
    found: tuple[Diagnostic, ...] = ()  # what proving had to say of it
    ready: Job | None = None  # proved and prepared
    worker: Latest = field(default_factory=lambda: Latest("loading-mdi"))
    refused: Callable[[Diagnostic], None] = field(default=lambda _error: None)  # it does not run
    _proof: Proved | None = None  # of what is ready
    _begun: int = 0  # lines that the executor has begun, as far as they were seen

    def ask(self, text: str, snapshot: Snapshot, failed: Callable[[str], None]) -> None:
        """Have this line proved from the state and the place of now; what was ready before is so no more."""
        self.take_back()
        self.worker.ask(partial(self.prove, text, snapshot), self._proved, failed)

    def take_back(self) -> None:
        """No line is ready, and Cycle Start begins nothing."""
        self.forget()
        self.post(Prepare(Starts.LINE))

    def leave(self) -> None:
        """No line is ready, and Cycle Start begins programs again."""
        self.forget()
        self.post(Prepare(Starts.PROGRAM))

    def forget(self) -> None:
        """What is being proved, or was found, counts no more."""
        self.worker.give_up()
        self.ready, self.found = None, ()

    def keep(self, snapshot: Snapshot) -> None:
        """Once a frame while Cycle Start is to begin lines alone: told again where that was not heard.

        It is refused under a program, which may have begun behind the snapshot that was looked at.
        """
        if snapshot.state in CYCLE or snapshot.starts is Starts.LINE:
            return
        self._prepare()

    def look(self, snapshot: Snapshot) -> bool:
        """Once a frame: take up what the worker has found. True when the line has just been started."""
        begun, self._begun = snapshot.lines > self._begun, snapshot.lines
        started = self.ready is not None and begun
        if started:
            self.ready, self.found = None, ()
        self.worker.poll()
        return started

    @property
    def busy(self) -> bool:
        """Whether the proof of a line is still to come."""
        return self.worker.busy

    @property
    def first_move(self) -> FirstMoveSeen | None:
        """The first move of the line that is ready; None: none is, or it was not checked."""
        return self._proof.first_move if self.ready is not None and self._proof is not None else None

    @property
    def errors(self) -> tuple[Diagnostic, ...]:
        """What keeps the line from running."""
        return tuple(each for each in self.found if each.severity is Severity.ERROR)

    def close(self) -> None:
        """End the thread that proves."""
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
