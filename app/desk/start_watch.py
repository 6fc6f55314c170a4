"""The watch over the next start: its first move is checked against the part, refused or drawn.

The geometry runs on a worker (``core/proving/start_check.py``); the executor gets the verdict and refuses a
start without one. A verdict counts for one job and one position of the axes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from app.desk.interrupted_notice import may_go_on
from app.desk.latest import Latest, Request
from app.desk.program_loading import Loaded
from app.desk.translation import tr
from app.path.path_aspects import DrawnLeg
from core.executor.commands import Command, GiveClearance, Prepare
from core.executor.interrupted_job import InterruptedJob
from core.executor.job import Job, interpret
from core.executor.snapshot import CYCLE, Snapshot, Starts, State
from core.executor.start_clearance import CROSSES, INSIDE, Clearance
from core.tool_edges import edge_name

if TYPE_CHECKING:
    from app.path.path_picture import Picture
    from core.interpreter.elementary_blocks import Block
    from core.proving.part_history import PartHistory
    from core.proving.start_check import FirstMove, StartCheck, StartNow

_AT_REST = frozenset({State.IDLE, State.DISABLED})


class KnownPart(NamedTuple):
    """The program that has the part in the chuck, and where it was interrupted; None: it was not."""

    job: Job
    picture: Picture
    broken: InterruptedJob | None = None


class StartQuestion(NamedTuple):
    """What is checked: what Cycle Start begins, from where, with which tool in work."""

    job: Job
    starts: Starts
    at: tuple[float, ...]
    begun: int
    tool: int
    part: KnownPart | None  # None: TurnDesk does not know what is in the chuck
    repeats: bool


class FirstMoveSeen(NamedTuple):
    """The answer to one question: the verdict, and the legs that the path view draws (machine X and Z)."""

    verdicts: tuple[Clearance, ...]
    legs: tuple[tuple[float, float, bool], ...] = ()
    starts: Starts = Starts.PROGRAM


@dataclass(slots=True)
class StartWatch:
    """``see`` is called once a frame; ``post`` hands commands to the executor and is listened to."""

    send: Callable[[Command], None]
    worker: Latest = field(default_factory=lambda: Latest("start-check"))
    seen: FirstMoveSeen | None = None
    _asked: tuple[object, ...] | None = None
    _prepared: Job | None = None
    _part: KnownPart | None = None
    _history: tuple[Picture, PartHistory] | None = None  # the worker's

    def post(self, command: Command) -> None:
        """Pass a command on; which line or restart is prepared is remembered."""
        if isinstance(command, Prepare):
            self._prepared = command.job
        self.send(command)

    def see(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """Have the next start checked whenever job, position or part are no longer those of the verdict."""
        self.worker.poll()
        self._see_part(snapshot, loaded)
        question = self._question(snapshot, loaded)
        if question is None:
            self.seen = None if snapshot.state is State.JOG else self.seen
            self._asked = None
            return
        key = (question.job.digest, question.starts, question.at, question.begun, _key(question.part))
        if key != self._asked:
            self._asked, self.seen = key, None
            self.worker.ask(partial(self._find, question), self._found, partial(self._failed, question))

    def close(self) -> None:
        """End the worker."""
        self.worker.close()

    def legs(self, snapshot: Snapshot) -> tuple[DrawnLeg, ...]:
        """The first move of the next start in the frame of the tool in work; empty while one runs."""
        seen = self.seen
        if seen is None or snapshot.state not in _AT_REST:
            return ()
        modal, label = snapshot.modal, tr("START")
        last = len(seen.legs) - 1
        return tuple(
            DrawnLeg(z - modal.base_z, x - modal.base_x, quick, label if number == last else "")
            for number, (x, z, quick) in enumerate(seen.legs)
        )

    @property
    def refusal(self) -> str:
        """Why the next start will be refused for its first move; empty when it will not."""
        seen = self.seen
        return seen.verdicts[0].why if seen is not None and seen.verdicts[0].code else ""

    # --- what is asked ------------------------------------------------------------------------------------

    def _see_part(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """An interrupted part stays in the chuck, whatever is loaded, until a program begins."""
        found, job, picture = snapshot.interrupted, loaded.job, loaded.picture
        if snapshot.state in CYCLE and snapshot.starts is not Starts.LINE:
            self._part = None
        elif found is not None and job is not None and picture is not None and found.text == job.text_digest:
            self._part = KnownPart(job, picture, found)

    def _question(self, snapshot: Snapshot, loaded: Loaded) -> StartQuestion | None:
        job, picture = loaded.job, loaded.picture
        if snapshot.state not in _AT_REST or not all(snapshot.homed):
            return None
        if snapshot.starts is not Starts.PROGRAM:
            job = self._prepared if self._prepared is not None else None
            if job is None or job.digest != snapshot.prepared:
                return None
        elif job is None or job.digest != snapshot.job or picture is None:
            return None
        part = self._part
        if part is None and snapshot.interrupted is None and loaded.job is not None and picture is not None:
            part = KnownPart(loaded.job, picture)
        at = tuple(round(each, 3) for each in snapshot.demand)
        tool = part.broken.tool if part is not None and part.broken is not None else snapshot.modal.tool
        unknown = snapshot.interrupted is not None and self._part is None
        return StartQuestion(
            job, snapshot.starts, at, snapshot.begun, tool, None if unknown else part,
            repeats=snapshot.starts is Starts.PROGRAM,
        )  # fmt: skip

    # --- on the worker ------------------------------------------------------------------------------------

    def _find(self, asked: StartQuestion, request: Request) -> FirstMoveSeen:
        from core.proving.start_check import first_moves, machine_path

        part, passes = asked.part, _passes(asked.job)
        plain = Clearance(asked.job.digest, asked.at, asked.begun)
        if part is None or part.picture.part is None:
            legs = machine_path(first_moves(passes, asked.at))
            interrupted = part is None or part.broken is not None
            warned = _not_known() if interrupted and legs else ""
            return FirstMoveSeen((replace(plain, warned=warned),), legs, asked.starts)
        check = self._check(part)
        now = _now(asked, part)
        found = check.find(passes, now, request)
        verdicts = [_verdict(plain, found, part)]
        end = check.history.end
        if asked.repeats and end is not None:
            again = check.find(
                passes, replace(now, at=(*end, *asked.at[2:]), broken=None, strict=False), request
            )
            here = replace(plain, at=(*end, *asked.at[2:]), repeats=True)
            verdicts.append(_verdict(here, again, part._replace(broken=None)))
        return FirstMoveSeen(tuple(verdicts), found.path, asked.starts)

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

    def _found(self, seen: FirstMoveSeen) -> None:
        self.seen = seen
        self.send(GiveClearance(seen.verdicts))

    def _failed(self, asked: StartQuestion, why: str) -> None:
        """A check that fails makes no start safe: that is announced."""
        warned = tr("THE FIRST MOVE COULD NOT BE CHECKED: {why}").format(why=why)
        self._found(FirstMoveSeen((Clearance(asked.job.digest, asked.at, asked.begun, warned=warned),)))


def _key(part: KnownPart | None) -> tuple[object, ...]:
    return () if part is None else (id(part.picture), part.job.digest, part.broken)


def _passes(job: Job) -> Callable[[tuple[float, ...]], Iterable[Block]]:
    """The blocks of a job from a position of the axes on; inputs are taken to be off."""

    def passes(at: tuple[float, ...]) -> Iterable[Block]:
        return interpret(job, replace(job.setup, start=at, inputs=lambda _terminal: False)).blocks

    return passes


def _now(asked: StartQuestion, part: KnownPart) -> StartNow:
    from core.proving.start_check import StartNow

    broken = part.broken
    where = (
        (broken.block, (broken.where[0], broken.where[1])) if broken is not None and broken.block else None
    )
    return StartNow(asked.at, asked.tool, where, strict=asked.starts is Starts.PROGRAM and where is not None)


def _verdict(plain: Clearance, found: FirstMove, part: KnownPart) -> Clearance:
    """In words: a refusal where the finding rests on nothing assumed, else an announcement."""
    if found.met is None:
        warned = _not_known() if not found.known and found.path else ""
        return replace(plain, warned=warned)
    why = _words(found, part)
    if found.assumed:
        return replace(plain, warned=why)
    return replace(plain, code=INSIDE if found.inside else CROSSES, why=why)


def _not_known() -> str:
    return tr("THE PART IN THE CHUCK IS NOT KNOWN: LOOK AT THE FIRST MOVE BEFORE YOU START")


def _words(found: FirstMove, part: KnownPart) -> str:
    from core.proving.start_check import Body

    what = {Body.PART: tr("THE PART"), Body.CHUCK: tr("THE CHUCK"), Body.TAILSTOCK: tr("THE TAILSTOCK")}
    text = tr("{tool} IS INSIDE {what}") if found.inside else tr("THE FIRST MOVE TAKES {tool} THROUGH {what}")
    said = text.format(tool=edge_name(found.tool), what=what[found.met] if found.met else "")
    return f"{said}: {_way_out(found, part)}"


def _way_out(found: FirstMove, part: KnownPart) -> str:
    jog = tr("JOG {direction} UNTIL IT IS CLEAR").format(direction=found.out)
    if not found.out:
        jog = tr("JOG IT OUT ALONG THE PATH BY WHICH IT CAME")
    if part.broken is None or not may_go_on(Loaded(source=part.job.source)):
        return jog
    return tr("F6, THEN F4 SHOWS THE WAY OUT, OR {jog}").format(jog=jog)
