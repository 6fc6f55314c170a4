"""The watch over the next start: its first move is checked against the part, refused or drawn.

A program that Cycle Start would begin is checked on a worker whenever the axes rest at another position. A
line of MDI and a restart are checked by the worker that proves them. The executor gets the verdict and
refuses a start without one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from app.desk.background_work import Latest, Watch
from app.desk.programs.prepared_line import ProveLine
from app.desk.programs.program_loading import FirstMoveSeen, Loaded, Proved
from app.desk.programs.start_verdict import KnownPart, StartJudge, StartQuestion, with_verdict
from app.desk.translation import tr
from app.path.path_aspects import DrawnLeg
from core.executor.commands import Clearance, Command, GiveClearance
from core.executor.job import Job
from core.executor.snapshot import CYCLE, LINES, Snapshot, Starts, State
from core.message import Message

_AT_REST = frozenset({State.IDLE, State.DISABLED})


@dataclass(slots=True)
class StartWatch:
    """``see`` is called once a frame; ``post`` hands commands to the executor."""

    post: Callable[[Command], None]
    worker: Latest = field(default_factory=lambda: Latest("start-check"))
    seen: FirstMoveSeen | None = None
    _judge: StartJudge = field(default_factory=StartJudge)
    _asked: tuple[object, ...] | None = None
    _part: KnownPart | None = None  # that was interrupted
    _loaded: KnownPart | None = None  # of the loaded program

    def see(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """Have the next start checked whenever job, position or part are no longer those of the verdict."""
        self.worker.poll()
        self._see_part(snapshot, loaded)
        question = self._question(snapshot, loaded)
        if question is None:
            self._asked = self.seen = None
        elif question.key != self._asked:
            self._asked, self.seen = question.key, None
            self.worker.ask(
                partial(self._judge.judge, question), self._found, partial(self._failed, question)
            )

    def close(self) -> None:
        """End the worker."""
        self.worker.close()

    def legs(self, snapshot: Snapshot) -> tuple[DrawnLeg, ...]:
        """The first move of the next start of the program; empty while a cycle runs."""
        return drawn(self.seen) if snapshot.state in _AT_REST else ()

    @property
    def refusal(self) -> str:
        """Why a start of the program is refused for its first move; empty when it is not."""
        return self.seen.clearance.why if self.seen is not None else ""

    @property
    def checking(self) -> bool:
        """Whether the verdict is still to come, so that the program does not start yet."""
        return self._asked is not None and self.seen is None

    # --- lines and restarts, on the worker that proves them ---------------------------------------------

    def with_lines(self, prove: ProveLine) -> ProveLine:
        """Return what proves a line of MDI, and checks its first move too."""

        def prove_line(text: str, snapshot: Snapshot, watch: Watch) -> tuple[Job, Proved]:
            job, proved = prove(text, snapshot, watch)
            return job, self.checked(job, proved, snapshot, watch)

        return prove_line

    def checked(self, job: Job, proved: Proved, snapshot: Snapshot, watch: Watch) -> Proved:
        """Return the proof of a line or of a restart with the verdict on its first move."""
        if proved.proof.errors:
            return proved
        return with_verdict(proved, self._judge.judge(self._of(job, Starts.LINE, snapshot), watch))

    # --- what is asked ------------------------------------------------------------------------------------

    def _see_part(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """An interrupted part stays in the chuck, whatever is loaded, until a program begins."""
        found, job, picture = snapshot.interrupted, loaded.job, loaded.picture
        self._loaded = KnownPart(job, picture) if job is not None and picture is not None else None
        if snapshot.state in CYCLE and snapshot.starts not in LINES:
            self._part = None
        elif found is not None and self._loaded is not None and found.text == self._loaded.job.text_digest:
            self._part = self._loaded._replace(broken=found)

    def _question(self, snapshot: Snapshot, loaded: Loaded) -> StartQuestion | None:
        if snapshot.state not in _AT_REST or not all(snapshot.homed):
            return None
        job = loaded.job
        if snapshot.starts is not Starts.PROGRAM or job is None or loaded.picture is None:
            return None
        return self._of(job, Starts.PROGRAM, snapshot) if job.digest == snapshot.job else None

    def _of(self, job: Job, starts: Starts, snapshot: Snapshot) -> StartQuestion:
        part, interrupted = self._part, snapshot.interrupted is not None
        if part is None and not interrupted:
            part = self._loaded
        broken = part.broken if part is not None else None
        return StartQuestion(
            job,
            starts,
            tuple(round(each, 3) for each in snapshot.demand),
            snapshot.begun,
            broken.tool if broken is not None else snapshot.modal.tool,
            part,
            unknown=interrupted and part is None,
        )

    # --- what was found -----------------------------------------------------------------------------------

    def _found(self, seen: FirstMoveSeen) -> None:
        self.seen = seen
        self.post(GiveClearance(seen.verdicts))

    def _failed(self, asked: StartQuestion, why: str) -> None:
        """A check that fails makes no start safe: that is announced."""
        warned = tr(Message("THE FIRST MOVE COULD NOT BE CHECKED: {why}", why=why))
        self._found(FirstMoveSeen((Clearance(asked.job.digest, asked.at, asked.begun, warned=warned),)))


def drawn(seen: FirstMoveSeen | None) -> tuple[DrawnLeg, ...]:
    """The first move as the path view draws it over the part; its end is labelled."""
    if seen is None:
        return ()
    (zero_x, zero_z), last = seen.zero, len(seen.legs) - 1
    return tuple(
        DrawnLeg(z - zero_z, x - zero_x, quick, tr("START") if number == last else "")
        for number, (x, z, quick) in enumerate(seen.legs)
    )
