"""Check whether the first move of the next start would collide with the part.

A collision prevents the start.

A program is checked on a worker each time the axes stop at a new position. An MDI line or a restart is
checked by the worker that proves it. The executor receives the verdict, and rejects a start without a
verdict. The geometry is in ``core/proving/start_check.py``. Any worker may use ``FirstMoveChecker``,
because it does not read a clock or wait for the machine.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial
from threading import Lock
from typing import TYPE_CHECKING, NamedTuple

from app.desk.background_work import LatestRequestWorker, ProgressCallback
from app.desk.programs.prepared_line import ProveLine
from app.desk.programs.program_loading import FirstMoveResult, LoadedProgram, ProvedJob
from app.desk.status.interrupted_notice import can_restart_program
from app.desk.translation import tr
from app.path.path_aspects import ApproachLeg
from core.executor.commands import (
    FIRST_MOVE_CROSSES,
    TOOL_IN_PART,
    Command,
    ReplaceStartClearances,
    StartClearance,
)
from core.executor.job import Job, start_program_pass
from core.executor.snapshot import (
    CYCLE_STATES,
    MDI_ACTIONS,
    InterruptedJob,
    MachineState,
    Snapshot,
    StartAction,
)
from core.language.diagnostics import Diagnostic, Severity
from core.message import Message
from core.tool_edges import format_edge_name

if TYPE_CHECKING:
    from app.path.path_picture import ProgramPicture
    from core.interpreter.shared.elementary_blocks import Block
    from core.proving.part_history import PartHistory
    from core.proving.start_check import FirstMove, StartCheck, StartState


class PreviousPart(NamedTuple):
    """The program that made the part that is currently in the chuck.

    If the program was interrupted, this object also contains the interrupted job.
    """

    job: Job
    picture: ProgramPicture
    interrupted_job: InterruptedJob | None = None


class FirstMoveQuery(NamedTuple):
    """Data for one first-move check, such as the job, kind of start, axis positions and active tool."""

    job: Job
    start_kind: StartAction
    axis_positions: tuple[float, ...]
    started_cycle_count: int
    active_tool_number: int
    previous_part: (
        PreviousPart | None
    )  # None: no part is in the chuck, or the program of the part is unknown.
    is_part_unknown: bool = False  # The chuck holds a part that TurnDesk does not know.

    @property
    def key(self) -> tuple[object, ...]:
        """Return the values on which the verdict depends."""
        part = self.previous_part
        known = None if part is None else (id(part.picture), part.job.digest, part.interrupted_job)
        return (
            self.job.digest,
            self.start_kind,
            self.axis_positions,
            self.started_cycle_count,
            self.active_tool_number,
            known,
            self.is_part_unknown,
        )


def add_first_move_verdict(proved_job: ProvedJob, result: FirstMoveResult) -> ProvedJob:
    """Return the proof with the verdict of the first-move check added.

    A rejected first move is an error.
    """
    found = result.start_clearance
    if not found.code:
        return replace(proved_job, first_move_result=result)
    error = Diagnostic(1, 0, Severity.ERROR, found.code, found.why, "")
    proof = replace(proved_job.proof, errors=(*proved_job.proof.errors, found.why))
    return replace(
        proved_job, proof=proof, diagnostics=(*proved_job.diagnostics, error), first_move_result=result
    )


@dataclass(slots=True)
class FirstMoveChecker:
    """Checker of first moves, which caches the latest part history for the next check."""

    _lock: Lock = field(default_factory=Lock)
    _history: tuple[ProgramPicture, PartHistory] | None = None

    def check_first_move(self, query: FirstMoveQuery, report_progress: ProgressCallback) -> FirstMoveResult:
        """Return the verdict on the first move of this start.

        WorkAbandonedError of ``report_progress`` is passed on.
        """
        with self._lock:
            return self._judge(query, report_progress)

    def _judge(self, asked: FirstMoveQuery, watch: ProgressCallback) -> FirstMoveResult:
        from core.proving.start_check import find_first_moves, make_unchecked_move

        part, passes = asked.previous_part, _make_pass_finder(asked.job)
        plain = StartClearance(asked.job.digest, asked.axis_positions, asked.started_cycle_count)
        if part is None or part.picture.part is None:
            move = make_unchecked_move(find_first_moves(passes, asked.axis_positions))
            unknown = asked.is_part_unknown or (part is not None and part.interrupted_job is not None)
            warned = _not_known() if unknown and move.path else ""
            return FirstMoveResult((replace(plain, warned=warned),), move.path, move.part_zero)
        check, now, go = self._check(part), _now(asked, part), partial(watch, 0.0)
        found = check.check_start(passes, now, go)
        verdicts = [_make_verdict(plain, found, part)]
        end = check.part_history.end_position
        if asked.start_kind is StartAction.PROGRAM and end is not None:
            at = (*end, *asked.axis_positions[2:])
            again = check.check_start(
                passes,
                replace(now, axis_positions=at, interrupted_block=None, starts_at_first_line=False),
                go,
            )
            here = replace(plain, at=at, is_for_repeat=True)
            verdicts.append(_make_verdict(here, again, part._replace(interrupted_job=None)))
        return FirstMoveResult(tuple(verdicts), found.path, found.part_zero)

    def _check(self, part: PreviousPart) -> StartCheck:
        from core.proving.part_history import PartHistory
        from core.proving.start_check import StartCheck

        moves = part.picture.part
        assert moves is not None
        if self._history is None or self._history[0] is not part.picture:
            self._history = part.picture, PartHistory(moves)
        return StartCheck(
            self._history[1],
            dict(part.job.setup.tools),
            moves.part_settings.stock is not None,
            frozenset(moves.part_settings.silenced),
        )


def _make_pass_finder(job: Job) -> Callable[[tuple[float, ...]], Iterable[Block]]:
    """Return a function that interprets a job from a given axis position, with all inputs off."""

    def start_pass(at: tuple[float, ...]) -> Iterable[Block]:
        return start_program_pass(
            job, replace(job.setup, start=at, inputs=lambda _terminal: False)
        ).block_iterator

    return start_pass


def _now(asked: FirstMoveQuery, part: PreviousPart) -> StartState:
    from core.proving.start_check import StartState

    broken = part.interrupted_job
    where = (
        (broken.block, (broken.where[0], broken.where[1])) if broken is not None and broken.block else None
    )
    return StartState(
        asked.axis_positions,
        asked.active_tool_number,
        where,
        starts_at_first_line=asked.start_kind is StartAction.PROGRAM,
    )


# --- messages -----------------------------------------------------------------------------------------------


def _make_verdict(plain: StartClearance, found: FirstMove, part: PreviousPart) -> StartClearance:
    """Return the verdict of a first-move check with its text.

    A finding that depends on an assumption is a warning. Any other finding prevents the start.
    """
    if found.hit_body is None:
        warned = _not_known() if not found.is_part_known and found.path else ""
        return replace(plain, warned=warned)
    why = _words(found, part)
    if found.has_assumed_data:
        return replace(plain, warned=why)
    return replace(plain, code=TOOL_IN_PART if found.is_inside_at_start else FIRST_MOVE_CROSSES, why=why)


def _not_known() -> str:
    return tr("UNKNOWN PART IN CHUCK. CHECK THE FIRST MOVE BEFORE STARTING")


def _words(found: FirstMove, part: PreviousPart) -> str:
    from core.proving.start_check import CollisionBody

    what = {
        CollisionBody.PART: tr("THE PART"),
        CollisionBody.CHUCK: tr("THE CHUCK"),
        CollisionBody.TAILSTOCK: tr("THE TAILSTOCK"),
    }
    text = (
        tr("{tool} IS INSIDE {what}")
        if found.is_inside_at_start
        else tr("THE FIRST MOVE WOULD TAKE {tool} THROUGH {what}")
    )
    said = tr(
        Message(
            text,
            tool=format_edge_name(found.tool_number),
            what=what[found.hit_body] if found.hit_body else "",
        )
    )
    return Message("{text}: {value}", text=said, value=_way_out(found, part))


def _way_out(found: FirstMove, part: PreviousPart) -> str:
    jog = tr(Message("JOG {direction} UNTIL THE TOOL IS CLEAR", direction=found.safe_jog_direction))
    if not found.safe_jog_direction:
        jog = tr("JOG THE TOOL BACK OUT ALONG ITS ENTRY PATH")
    if part.interrupted_job is None or not can_restart_program(LoadedProgram(source=part.job.source)):
        return jog
    return tr(Message("F6, ENTER: RESUME   F6, F4: RETRACT   OR {jog}", jog=jog))


_REST_STATES = frozenset({MachineState.IDLE, MachineState.DISABLED})


@dataclass(slots=True)
class FirstMoveWatch:
    """Service that checks the first move of the next program start.

    ``post_command`` sends commands to the executor.
    """

    post_command: Callable[[Command], None]
    worker: LatestRequestWorker = field(default_factory=lambda: LatestRequestWorker("start-check"))
    first_move_result: FirstMoveResult | None = None
    _judge: FirstMoveChecker = field(default_factory=FirstMoveChecker)
    _asked: tuple[object, ...] | None = None
    _part: PreviousPart | None = None  # Part of the interrupted job.
    _loaded: PreviousPart | None = None  # Part of the loaded program.

    def update(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Request a new check if the job, the position or the part has changed.

        The screen calls this method once per frame.
        """
        self.worker.deliver_results()
        self._track_part(snapshot, loaded)
        question = self._question(snapshot, loaded)
        if question is None:
            self._asked = self.first_move_result = None
        elif question.key != self._asked:
            self._asked, self.first_move_result = question.key, None
            self.worker.request_work(
                partial(self._judge.check_first_move, question),
                self._found,
                partial(self._handle_failure, question),
            )

    def close(self) -> None:
        """End the worker that checks first moves."""
        self.worker.close()

    def make_start_legs(self, snapshot: Snapshot) -> tuple[ApproachLeg, ...]:
        """Return the first move of the next program start for drawing, or () while a cycle runs."""
        return make_drawn_legs(self.first_move_result) if snapshot.state in _REST_STATES else ()

    @property
    def start_refusal(self) -> str:
        """Return why the first move prevents a program start, or an empty string if it does not."""
        return self.first_move_result.start_clearance.why if self.first_move_result is not None else ""

    @property
    def is_checking(self) -> bool:
        """Return whether the first-move check is still pending. The program cannot start until it ends."""
        return self._asked is not None and self.first_move_result is None

    # =

    def wrap_line_proof(self, prove_text: ProveLine) -> ProveLine:
        """Return a function that proves an MDI line and also checks its first move."""

        def prove_line(text: str, snapshot: Snapshot, watch: ProgressCallback) -> tuple[Job, ProvedJob]:
            job, proved = prove_text(text, snapshot, watch)
            return job, self.add_first_move_check(job, proved, snapshot, watch)

        return prove_line

    def add_first_move_check(
        self, job: Job, proved_job: ProvedJob, snapshot: Snapshot, report_progress: ProgressCallback
    ) -> ProvedJob:
        """Return the proof of an MDI line or a restart, with the verdict on its first move."""
        if proved_job.proof.errors:
            return proved_job
        return add_first_move_verdict(
            proved_job,
            self._judge.check_first_move(self._of(job, StartAction.MDI_LINE, snapshot), report_progress),
        )

    # --- requests -----------------------------------------------------------------------------------------

    def _track_part(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Update the record of the part in the chuck.

        An interrupted part stays there until a program starts.
        """
        found, job, picture = snapshot.interrupted, loaded.job, loaded.picture
        self._loaded = PreviousPart(job, picture) if job is not None and picture is not None else None
        if snapshot.state in CYCLE_STATES and snapshot.starts not in MDI_ACTIONS:
            self._part = None
        elif found is not None and self._loaded is not None and found.text == self._loaded.job.text_digest:
            self._part = self._loaded._replace(interrupted_job=found)

    def _question(self, snapshot: Snapshot, loaded: LoadedProgram) -> FirstMoveQuery | None:
        if snapshot.state not in _REST_STATES or not all(snapshot.homed):
            return None
        job = loaded.job
        if snapshot.starts is not StartAction.PROGRAM or job is None or loaded.picture is None:
            return None
        return self._of(job, StartAction.PROGRAM, snapshot) if job.digest == snapshot.job else None

    def _of(self, job: Job, starts: StartAction, snapshot: Snapshot) -> FirstMoveQuery:
        part, interrupted = self._part, snapshot.interrupted is not None
        if part is None and not interrupted:
            part = self._loaded
        broken = part.interrupted_job if part is not None else None
        return FirstMoveQuery(
            job,
            starts,
            tuple(round(each, 3) for each in snapshot.demand),
            snapshot.begun,
            broken.tool if broken is not None else snapshot.modal.tool,
            part,
            is_part_unknown=interrupted and part is None,
        )

    # --- results ------------------------------------------------------------------------------------------

    def _found(self, seen: FirstMoveResult) -> None:
        self.first_move_result = seen
        self.post_command(ReplaceStartClearances(seen.clearances))

    def _handle_failure(self, asked: FirstMoveQuery, reason: str) -> None:
        """Report that the first move could not be checked."""
        warned = tr(Message("THE FIRST MOVE COULD NOT BE CHECKED: {why}", why=reason))
        self._found(
            FirstMoveResult(
                (
                    StartClearance(
                        asked.job.digest, asked.axis_positions, asked.started_cycle_count, warned=warned
                    ),
                )
            )
        )


def make_drawn_legs(result: FirstMoveResult | None) -> tuple[ApproachLeg, ...]:
    """Return the first move as path legs for the path view, with the label at the end of the move."""
    if result is None:
        return ()
    (zero_x, zero_z), last = result.part_zero_position, len(result.approach_legs) - 1
    return tuple(
        ApproachLeg(z - zero_z, x - zero_x, quick, tr("START") if number == last else "")
        for number, (x, z, quick) in enumerate(result.approach_legs)
    )
