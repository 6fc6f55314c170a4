"""Check of the first move of the next start against the part. A collision refuses the start.

A program is checked on a worker whenever the axes rest at another position. An MDI line and a restart are
checked by the worker that proves them. The executor gets the verdict and refuses a start without one. The
geometry is in ``core/proving/start_check.py``. Any worker may use ``StartJudge``, because it reads no clock
and does not wait for the machine.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial
from threading import Lock
from typing import TYPE_CHECKING, NamedTuple

from app.desk.background_work import Latest, Watch
from app.desk.programs.prepared_line import ProveLine
from app.desk.programs.program_loading import FirstMoveSeen, Loaded, Proved
from app.desk.status.interrupted_notice import may_go_on
from app.desk.translation import tr
from app.path.path_aspects import DrawnLeg
from core.executor.commands import CROSSES, INSIDE, Clearance, Command, GiveClearance
from core.executor.job import Job, interpret
from core.executor.snapshot import CYCLE, LINES, InterruptedJob, Snapshot, Starts, State
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message
from core.tool_edges import edge_name

if TYPE_CHECKING:
    from app.path.path_picture import Picture
    from core.interpreter.shared.elementary_blocks import Block
    from core.proving.part_history import PartHistory
    from core.proving.start_check import FirstMove, StartCheck, StartNow


class KnownPart(NamedTuple):
    """The program that made the part in the chuck, and the interrupted job if it was interrupted."""

    job: Job
    picture: Picture
    broken: InterruptedJob | None = None


class StartQuestion(NamedTuple):
    """The data of one first-move check: job, kind of start, axis position and tool in use."""

    job: Job
    starts: Starts
    at: tuple[float, ...]
    begun: int
    tool: int
    part: KnownPart | None  # None: no part is in the chuck, or the program of the part is unknown.
    unknown: bool = False  # The chuck holds a part that TurnDesk does not know.

    @property
    def key(self) -> tuple[object, ...]:
        """The values on which the verdict depends."""
        part = self.part
        known = None if part is None else (id(part.picture), part.job.digest, part.broken)
        return self.job.digest, self.starts, self.at, self.begun, self.tool, known, self.unknown


def with_verdict(proved: Proved, seen: FirstMoveSeen) -> Proved:
    """Return the proof of a line or a restart with this verdict added. A refused first move is an error."""
    found = seen.clearance
    if not found.code:
        return replace(proved, first_move=seen)
    error = Diagnostic(1, 0, Severity.ERROR, found.code, found.why, "")
    proof = replace(proved.proof, errors=(*proved.proof.errors, found.why))
    return replace(proved, proof=proof, diagnostics=(*proved.diagnostics, error), first_move=seen)


@dataclass(slots=True)
class StartJudge:
    """Checks first moves. The last part history is cached for the next check."""

    _lock: Lock = field(default_factory=Lock)
    _history: tuple[Picture, PartHistory] | None = None

    def judge(self, asked: StartQuestion, watch: Watch) -> FirstMoveSeen:
        """Return the verdict on this start. Raises AbandonedError if ``watch`` does."""
        with self._lock:
            return self._judge(asked, watch)

    def _judge(self, asked: StartQuestion, watch: Watch) -> FirstMoveSeen:
        from core.proving.start_check import first_moves, unchecked

        part, passes = asked.part, _passes(asked.job)
        plain = Clearance(asked.job.digest, asked.at, asked.begun)
        if part is None or part.picture.part is None:
            move = unchecked(first_moves(passes, asked.at))
            unknown = asked.unknown or (part is not None and part.broken is not None)
            warned = _not_known() if unknown and move.path else ""
            return FirstMoveSeen((replace(plain, warned=warned),), move.path, move.zero)
        check, now, go = self._check(part), _now(asked, part), partial(watch, 0.0)
        found = check.find(passes, now, go)
        verdicts = [_verdict(plain, found, part)]
        end = check.history.end
        if asked.starts is Starts.PROGRAM and end is not None:
            at = (*end, *asked.at[2:])
            again = check.find(passes, replace(now, at=at, broken=None, strict=False), go)
            here = replace(plain, at=at, repeats=True)
            verdicts.append(_verdict(here, again, part._replace(broken=None)))
        return FirstMoveSeen(tuple(verdicts), found.path, found.zero)

    def _check(self, part: KnownPart) -> StartCheck:
        from core.proving.part_history import PartHistory
        from core.proving.start_check import StartCheck

        moves = part.picture.part
        assert moves is not None
        if self._history is None or self._history[0] is not part.picture:
            self._history = part.picture, PartHistory(moves)
        return StartCheck(
            self._history[1],
            dict(part.job.setup.tools),
            moves.setting.stock is not None,
            frozenset(moves.setting.silenced),
        )


def _passes(job: Job) -> Callable[[tuple[float, ...]], Iterable[Block]]:
    """Return a function that interprets a job from a given axis position. All inputs count as off."""

    def passes(at: tuple[float, ...]) -> Iterable[Block]:
        return interpret(job, replace(job.setup, start=at, inputs=lambda _terminal: False)).blocks

    return passes


def _now(asked: StartQuestion, part: KnownPart) -> StartNow:
    from core.proving.start_check import StartNow

    broken = part.broken
    where = (
        (broken.block, (broken.where[0], broken.where[1])) if broken is not None and broken.block else None
    )
    return StartNow(asked.at, asked.tool, where, strict=asked.starts is Starts.PROGRAM)


# --- messages -----------------------------------------------------------------------------------------------


def _verdict(plain: Clearance, found: FirstMove, part: KnownPart) -> Clearance:
    """Return the verdict with its text.

    A finding that rests on an assumption is a warning. Any other finding refuses the start.
    """
    if found.met is None:
        warned = _not_known() if not found.known and found.path else ""
        return replace(plain, warned=warned)
    why = _words(found, part)
    if found.assumed:
        return replace(plain, warned=why)
    return replace(plain, code=INSIDE if found.inside else CROSSES, why=why)


def _not_known() -> str:
    return tr("UNKNOWN PART IN CHUCK. CHECK THE FIRST MOVE BEFORE STARTING")


def _words(found: FirstMove, part: KnownPart) -> str:
    from core.proving.start_check import Body

    what = {Body.PART: tr("THE PART"), Body.CHUCK: tr("THE CHUCK"), Body.TAILSTOCK: tr("THE TAILSTOCK")}
    text = (
        tr("{tool} IS INSIDE {what}")
        if found.inside
        else tr("THE FIRST MOVE WOULD TAKE {tool} THROUGH {what}")
    )
    said = tr(Message(text, tool=edge_name(found.tool), what=what[found.met] if found.met else ""))
    return Message("{text}: {value}", text=said, value=_way_out(found, part))


def _way_out(found: FirstMove, part: KnownPart) -> str:
    jog = tr(Message("JOG {direction} UNTIL THE TOOL IS CLEAR", direction=found.out))
    if not found.out:
        jog = tr("JOG THE TOOL BACK OUT ALONG ITS ENTRY PATH")
    if part.broken is None or not may_go_on(Loaded(source=part.job.source)):
        return jog
    return tr(Message("F6, ENTER: RESUME   F6, F4: RETRACT   OR {jog}", jog=jog))


_AT_REST = frozenset({State.IDLE, State.DISABLED})


@dataclass(slots=True)
class StartWatch:
    """Checks the first move of the next program start. ``post`` sends commands to the executor."""

    post: Callable[[Command], None]
    worker: Latest = field(default_factory=lambda: Latest("start-check"))
    seen: FirstMoveSeen | None = None
    _judge: StartJudge = field(default_factory=StartJudge)
    _asked: tuple[object, ...] | None = None
    _part: KnownPart | None = None  # Part of the interrupted job.
    _loaded: KnownPart | None = None  # Part of the loaded program.

    def see(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """Request a new check when the job, position or part has changed; called once a frame."""
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
        """Return the first move of the next program start for drawing. Empty while a cycle runs."""
        return drawn(self.seen) if snapshot.state in _AT_REST else ()

    @property
    def refusal(self) -> str:
        """The reason why the first move prevents a start of the program. Empty if it does not."""
        return self.seen.clearance.why if self.seen is not None else ""

    @property
    def checking(self) -> bool:
        """Whether the verdict is pending, so that the program cannot start yet."""
        return self._asked is not None and self.seen is None

    # =

    def with_lines(self, prove: ProveLine) -> ProveLine:
        """Return a function that proves an MDI line and also checks its first move."""

        def prove_line(text: str, snapshot: Snapshot, watch: Watch) -> tuple[Job, Proved]:
            job, proved = prove(text, snapshot, watch)
            return job, self.checked(job, proved, snapshot, watch)

        return prove_line

    def checked(self, job: Job, proved: Proved, snapshot: Snapshot, watch: Watch) -> Proved:
        """Return the proof of a line or a restart with the verdict on its first move added."""
        if proved.proof.errors:
            return proved
        return with_verdict(proved, self._judge.judge(self._of(job, Starts.LINE, snapshot), watch))

    # --- requests -----------------------------------------------------------------------------------------

    def _see_part(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """Update the known part. An interrupted part remains in the chuck until a program starts."""
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

    # --- results ------------------------------------------------------------------------------------------

    def _found(self, seen: FirstMoveSeen) -> None:
        self.seen = seen
        self.post(GiveClearance(seen.verdicts))

    def _failed(self, asked: StartQuestion, why: str) -> None:
        """Announce that the first move could not be checked."""
        warned = tr(Message("THE FIRST MOVE COULD NOT BE CHECKED: {why}", why=why))
        self._found(FirstMoveSeen((Clearance(asked.job.digest, asked.at, asked.begun, warned=warned),)))


def drawn(seen: FirstMoveSeen | None) -> tuple[DrawnLeg, ...]:
    """Return the first move as drawn legs for the path view. The end of the move has a label."""
    if seen is None:
        return ()
    (zero_x, zero_z), last = seen.zero, len(seen.legs) - 1
    return tuple(
        DrawnLeg(z - zero_z, x - zero_x, quick, tr("START") if number == last else "")
        for number, (x, z, quick) in enumerate(seen.legs)
    )
