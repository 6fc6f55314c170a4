"""SEARCHTO without Qt: a line is chosen, its state rebuilt, the restart confirmed, proved and started."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import Enum, auto
from typing import TYPE_CHECKING

from app.desk.background_work import Watch
from app.desk.pages.page_entry import searchto_barred
from app.desk.programs.program_loading import Loaded, ProgramLoader, Proved
from app.desk.translation import tr
from app.searchto.searchto_finder import Answer, LineCursor, LineFinder
from app.searchto.searchto_plan import Plan, WayOut, now_of, plan_of, way_out_of
from core.executor.commands import Command, Prepare
from core.executor.job import Job, make_job
from core.executor.snapshot import CYCLE, Snapshot, Starts, State
from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_approach import Choices
from core.interpreter.restart.restart_point import NoRestart, RestartPoint
from core.language.source import Source
from core.message import Message

if TYPE_CHECKING:
    from app.searchto.searchto_finder import Search

WAY_OUT = "(RETRACT FROM THE PART)"


class SearchtoStage(Enum):
    """From choosing a line to a restart that the palms begin."""

    CHOOSE = auto()
    SEARCHING = auto()
    SHOWN = auto()  # a good line, with its plan
    REFUSED = auto()  # a line that is not good
    PROVING = auto()
    READY = auto()


@dataclass(slots=True)
class SearchtoModel:
    """The model behind the SEARCHTO page. ``say`` answers on the prompt line, ``clear`` takes that back."""

    session: ProgramLoader
    post: Callable[[Command], None]
    snapshot: Callable[[], Snapshot]
    say: Callable[[str], None]
    clear: Callable[[], None]
    rebuild: Callable[[Job, Watch], Search]  # what goes through a program; called on the worker
    prove: Callable[[Job, Watch], Proved]  # what proves a restart and checks its first move; likewise
    choices: Choices = field(default_factory=Choices)
    cursor: LineCursor = field(default_factory=LineCursor)
    stage: SearchtoStage = SearchtoStage.CHOOSE
    open: bool = False
    answer: NoRestart | None = None
    plan: Plan | None = None
    leaving: WayOut | None = None  # the way out alone
    number: int = 0  # of the pass in which the line is meant; 0: the one that was interrupted, or the first
    count: int = 0  # how often the run comes to the line, once that is known
    proved: Proved | None = None
    started: bool = False  # the restart was started: what is to be seen now is the Automatic page
    finder: LineFinder = field(init=False)
    _job: Job | None = None
    _of: Job | None = None  # the program's job that was searched
    _accepted: bool = False
    _cut: CutRecord | None = None
    _going_out: bool = False

    def __post_init__(self) -> None:
        self.finder = LineFinder(self.rebuild, self.prove, self._found, self._not_searched)

    # --- opened and left -----------------------------------------------------------------------------

    @property
    def has_keyboard(self) -> bool:
        """Whether a line can be chosen: not while the way out is under way."""
        return self.snapshot().state not in CYCLE

    def opens(self) -> bool:
        """Whether it may be opened now; says why not."""
        why = searchto_barred(self.snapshot(), self.session.now)
        if why:
            self.say(why)
        return not why

    def opened(self) -> None:
        """From now on Cycle Start begins a confirmed restart and nothing else."""
        loaded, snapshot = self.session.now, self.snapshot()
        self.clear()  # why the palms began nothing before has been read
        self.open, self.started = True, False
        lines = loaded.source.lines if loaded.source is not None else ()
        before = self.cursor.line if self.cursor.lines is lines else 1
        self.cursor.show(lines, snapshot.interrupted_line or before)
        self.number = self.count = 0
        self._going_out = False
        self._forget()

    def leave(self) -> None:
        """Cycle Start begins programs again."""
        if self.open:
            self.open = False
            self._withdraw()
            self.post(Prepare(Starts.PROGRAM))

    def close(self) -> None:
        """End the thread that searches."""
        self.finder.worker.close()

    def _forget(self) -> None:
        """Nothing is shown and nothing is ready."""
        self._withdraw()
        if self.open and self.has_keyboard:
            self._going_out = False  # a key pressed as it ends is not undone by its end
            self.post(Prepare(Starts.RESTART))

    def _withdraw(self) -> None:
        self.finder.worker.give_up()
        self.stage, self.answer, self.plan, self.proved = SearchtoStage.CHOOSE, None, None, None
        self.leaving, self._cut = None, None
        self._job, self._accepted = None, False

    # --- choosing ------------------------------------------------------------------------------------

    def move(self, lines: int) -> None:
        """The cursor so many lines on."""
        self.cursor.go(self.cursor.line + lines)
        self.number = self.count = 0
        self._forget()

    def go(self, line: int, number: int = 0) -> None:
        """To this line, in this pass, and rebuild its state."""
        if line:
            self.cursor.go(line)
            self.cursor.text = ""
            self.number, self.count = number, 0
            self.search()

    def turn_pass(self, by: int) -> None:
        """To a later or an earlier pass of a line that is run more than once."""
        if self.count < 2:
            self.say(tr("NO REPETITIONS FOUND FOR THIS LINE. ENTER: REBUILD STATE"))
            return
        number = max(1, min(self.number + by, self.count))
        if number != self.number:
            self.number = number
            self.search()

    def takes(self, key: str) -> bool:
        """Whether a character is the question's: not while the tool is on its way out."""
        return len(key) == 1 and self.has_keyboard

    def typed(self, key: str) -> bool:
        """A character or an editing key of the question; False when it means nothing here."""
        if not self.cursor.type(key):
            return False
        self.clear()
        return True

    def enter(self) -> None:
        """A number: that line. A text: the next line that holds it. Found, or nothing: the cursor's line."""
        number = self.cursor.number
        if number is not None:
            self.go(number, self.cursor.visit)
        elif self.cursor.text and not self.cursor.found:
            self.find(1)
        else:
            self.search()

    def barred_keys(self) -> frozenset[str]:
        """Return the function keys that would be refused now."""
        found: set[str] = set()
        if not self._has_text:
            found |= {"F2", "F3"}
        if self._out_by_hand:
            found.add("F4")
        if not self._decided and self.stage not in {SearchtoStage.PROVING, SearchtoStage.READY}:
            found.add("F10")
        return frozenset(found)

    @property
    def _has_text(self) -> bool:
        return bool(self.cursor.text) and self.cursor.number is None

    @property
    def _out_by_hand(self) -> bool:
        """Whether the machine is a mill: there every restart draws the tool out."""
        job = self.session.now.job
        return job is not None and job.setup.kinematics is not None

    @property
    def _decided(self) -> bool:
        """Whether a way out, or a good line, is shown."""
        whole = self.session.now.job is not None
        return (
            self.stage is SearchtoStage.SHOWN and whole and (self._cut is not None or self.plan is not None)
        )

    def find(self, way: int) -> None:
        """The next or the previous line that holds the text."""
        self._forget()
        self.clear()
        if not self._has_text:
            self.say(tr('TYPE SEARCH TEXT FIRST. BEFORE A NUMBER, TYPE A " (QUOTE)'))
        elif not self.cursor.find(way):
            self.say(tr(Message("{text} NOT FOUND IN ANY LINE", text=self.cursor.wanted)))

    def search(self) -> None:
        """Rebuild the state of the cursor's line."""
        loaded = self.session.now
        self._forget()
        self.clear()
        job, line = loaded.job, self.cursor.line
        if job is None:
            return
        self.stage, self._of = SearchtoStage.SEARCHING, job
        self.finder.find(job, line, self.number, now_of(self.snapshot(), job).broken)

    def nearest(self, way: int) -> None:
        """To the good line before or after one that was refused."""
        if self.answer is not None:
            self.go(self.answer.before if way < 0 else self.answer.after)

    # --- deciding ------------------------------------------------------------------------------------

    def way_out(self) -> None:
        """Only the way out of the part, and no going on."""
        self._forget()
        self.clear()
        if self._out_by_hand:
            self.say(tr("RESTARTING RETRACTS TOOL ALONG ITS AXIS FIRST; OR JOG IT OUT"))
        elif (job := self.session.now.job) is not None:
            self.stage, self._of = SearchtoStage.SEARCHING, job
            self.finder.cut(job)

    def turn_coolant(self) -> None:
        """Whether coolant starts, where the line had it on."""
        self._choose(replace(self.choices, coolant=not self.choices.coolant))

    def confirm(self) -> None:
        """Yes to what will start and to the way, or to the way out: it is proved and ready for the palms."""
        if self.stage in {SearchtoStage.PROVING, SearchtoStage.READY}:
            return  # it is confirmed
        self.clear()
        snapshot, plan, whole = self.snapshot(), self.plan, self.session.now.job
        if self.stage is SearchtoStage.SHOWN and self._cut is not None and whole is not None:
            self._confirm_out(snapshot, self._cut, whole)
            return
        if self.stage is not SearchtoStage.SHOWN or plan is None or whole is None:
            self.say(tr("CHOOSE A VALID RESTART LINE FIRST"))
            return
        if snapshot.state is not State.IDLE:
            self.say(tr("SWITCH THE DRIVES ON FIRST (D)"))
            return
        plan = self.plan = plan_of(plan.found, snapshot, whole, self.choices)
        if plan.trouble:
            self.say(plan.trouble)
            return
        setup = replace(whole.setup, start=snapshot.demand, begin=plan.begin)
        self.stage = SearchtoStage.PROVING
        self.finder.check(make_job(whole.source, setup, whole))

    def _confirm_out(self, snapshot: Snapshot, cut: CutRecord, whole: Job) -> None:
        if snapshot.state is not State.IDLE:
            self.say(tr("SWITCH THE DRIVES ON FIRST (D)"))
            return
        out = self.leaving = way_out_of(cut, snapshot, whole, self.choices)
        if out.trouble:
            self.say(out.trouble)
            return
        setup = replace(whole.setup, start=snapshot.demand, begin=out.begin)
        self.stage = SearchtoStage.PROVING
        self.finder.check(make_job(Source("RETRACT", WAY_OUT), setup))

    def escape(self) -> bool:
        """One step back; False when there is none to go."""
        if self.cursor.text:
            self.cursor.text = ""
            return True
        if self.stage is SearchtoStage.CHOOSE:
            return False
        self._forget()
        return True

    def _choose(self, choices: Choices) -> None:
        self.choices = choices
        if self.plan is not None:
            found = self.plan.found
            self._forget()
            self._show(found)

    # --- every frame ---------------------------------------------------------------------------------

    def look(self, snapshot: Snapshot, loaded: Loaded) -> None:
        """Take up what the worker has found; a program that is read anew has to be searched anew."""
        if self._of is not None and loaded.job is not self._of:
            self._of = None
            self._forget()
        if self._going_out and snapshot.state not in CYCLE:
            self._going_out = False
            self._forget()
        if self.stage is SearchtoStage.READY:
            self._see_start(snapshot)
        self.finder.worker.poll()

    def prompt(self, snapshot: Snapshot, start: str) -> str:
        """What can be done now; ``start`` names what starts a cycle here."""
        shown = self.leaving or self.plan
        trouble = shown.trouble if shown is not None else ""
        return "" if snapshot.state in CYCLE else self._prompt(snapshot, trouble, start)

    def _prompt(self, snapshot: Snapshot, trouble: str, start: str) -> str:
        return searchto_prompt(self.stage, snapshot, trouble, start, out=self.leaving is not None)

    def barred(self) -> str:
        """Why the palms start nothing now; empty when they may."""
        if self.stage is SearchtoStage.READY or self.snapshot().state in CYCLE:
            return ""
        return tr("CANNOT START: SEARCH FOR A LINE AND CONFIRM IT FIRST (F10)")

    def _see_start(self, snapshot: Snapshot) -> None:
        waits = self._job is not None and snapshot.prepared == self._job.digest
        if self._accepted and not waits and self.leaving is not None:
            self._going_out = snapshot.state in CYCLE
            self._withdraw()
            return
        if self._accepted and not waits:
            self.started = snapshot.starts is Starts.PROGRAM  # a restart that is begun counts once
            self.open = not self.started
            self._withdraw()
        self._accepted = waits

    def _not_searched(self, why: str) -> None:
        self.stage = SearchtoStage.CHOOSE
        self.say(tr(Message("SEARCH FAILED: {why}", why=why)))

    def _found(self, answer: Answer) -> None:
        if isinstance(answer, RestartPoint):
            self.number, self.count = answer.visit.number, answer.visit.of
            self._show(answer)
        elif isinstance(answer, CutRecord):
            self._show_out(answer)
        elif isinstance(answer, NoRestart):
            self.stage, self.answer = SearchtoStage.REFUSED, answer
        else:
            self._made_ready(*answer)

    def _show(self, found: RestartPoint) -> None:
        if self._of is not None:
            self.stage = SearchtoStage.SHOWN
            self.plan = plan_of(found, self.snapshot(), self._of, self.choices)

    def _show_out(self, cut: CutRecord) -> None:
        if self._of is not None:
            self.stage, self._cut = SearchtoStage.SHOWN, cut
            self.leaving = way_out_of(cut, self.snapshot(), self._of, self.choices)

    def _made_ready(self, job: Job, proved: Proved) -> None:
        self.proved = proved
        if proved.proof.errors:
            self.stage = SearchtoStage.SHOWN
            self.say(tr(Message("WILL NOT START: {why}", why=proved.proof.errors[0])))
            return
        self.stage, self._job, self._accepted = SearchtoStage.READY, job, False
        starts = Starts.RESTART if self.leaving is None else Starts.WAY_OUT
        self.post(Prepare(starts, job, proved.proof, proved.clearance))


def searchto_prompt(
    stage: SearchtoStage, snapshot: Snapshot, trouble: str, start: str, *, out: bool = False
) -> str:
    """``start`` names what starts a cycle here; ``trouble`` keeps the plan from being started; ``out``: it is
    the way out of the part alone."""
    if out and stage is SearchtoStage.SHOWN and not trouble:
        return tr("CHECK THE RETRACT PATH. F10: CONFIRM")
    if out and stage is SearchtoStage.READY:
        return tr(Message("RETRACT THE TOOL FROM THE PART: {start}. ESC: CANCEL", start=start))
    words = {
        SearchtoStage.SEARCHING: tr("SEARCHING THE PROGRAM. ESC: CANCEL"),
        SearchtoStage.PROVING: tr("PROVING THE RESTART. ESC: CANCEL"),
        SearchtoStage.SHOWN: trouble or tr("CHECK STATE, PATH AND WHAT WILL START. F10: CONFIRM"),
        SearchtoStage.REFUSED: tr("CANNOT START FROM THIS LINE. F8, F9: NEAREST VALID LINE"),
        SearchtoStage.READY: tr(Message("RESUME AT THIS LINE: {start}. ESC: CANCEL", start=start)),
    }
    return words.get(stage) or _choose(snapshot)


def _choose(snapshot: Snapshot) -> str:
    if not snapshot.interrupted_line:
        return tr("TYPE A NUMBER OR TEXT, OR USE ARROWS   ENTER: REBUILD STATE")
    words = tr("STOPPED IN LINE {line}. ENTER: REBUILD STATE   F4: RETRACT")
    return tr(Message(words, line=snapshot.interrupted_line))
