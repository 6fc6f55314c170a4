"""The model of the SEARCHTO page: choose a line, rebuild its state, confirm, prove and start. No Qt."""

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
    """The stage of a restart, from choosing a line to ready for Cycle Start."""

    CHOOSE = auto()
    SEARCHING = auto()
    SHOWN = auto()  # A valid restart line with its plan.
    REFUSED = auto()  # A line that is not a valid restart line.
    PROVING = auto()
    READY = auto()


@dataclass(slots=True)
class SearchtoModel:
    """The model of the SEARCHTO page. ``say`` shows a message, and ``clear`` removes it."""

    session: ProgramLoader
    post: Callable[[Command], None]
    snapshot: Callable[[], Snapshot]
    say: Callable[[str], None]
    clear: Callable[[], None]
    rebuild: Callable[[Job, Watch], Search]  # Creates the search in a program; called on the worker.
    prove: Callable[[Job, Watch], Proved]  # Proves a restart and checks its first move; called on the worker.
    choices: Choices = field(default_factory=Choices)
    cursor: LineCursor = field(default_factory=LineCursor)
    stage: SearchtoStage = SearchtoStage.CHOOSE
    open: bool = False
    answer: NoRestart | None = None
    plan: Plan | None = None
    leaving: WayOut | None = None  # A retract without a restart.
    number: int = 0  # The wanted pass of the line; 0: the interrupted pass, or else the first.
    count: int = 0  # Number of passes of the line; 0: not known yet.
    proved: Proved | None = None
    started: bool = False  # The restart has started, so the Automatic page must be shown.
    finder: LineFinder = field(init=False)
    _job: Job | None = None
    _of: Job | None = None  # The job that was searched.
    _accepted: bool = False
    _cut: CutRecord | None = None
    _going_out: bool = False

    def __post_init__(self) -> None:
        self.finder = LineFinder(self.rebuild, self.prove, self._found, self._not_searched)

    # --- open and close ------------------------------------------------------------------------------

    @property
    def has_keyboard(self) -> bool:
        """Whether a line can be chosen, which is not possible while the tool retracts."""
        return self.snapshot().state not in CYCLE

    def opens(self) -> bool:
        """Return whether SEARCHTO can be opened now. If not, show the reason."""
        why = searchto_barred(self.snapshot(), self.session.now)
        if why:
            self.say(why)
        return not why

    def opened(self) -> None:
        """Prepare for the open page: Cycle Start runs a confirmed restart and nothing else."""
        loaded, snapshot = self.session.now, self.snapshot()
        self.clear()  # The operator has read the earlier message.
        self.open, self.started = True, False
        lines = loaded.source.lines if loaded.source is not None else ()
        before = self.cursor.line if self.cursor.lines is lines else 1
        self.cursor.show(lines, snapshot.interrupted_line or before)
        self.number = self.count = 0
        self._going_out = False
        self._forget()

    def leave(self) -> None:
        """Let Cycle Start run programs again."""
        if self.open:
            self.open = False
            self._withdraw()
            self.post(Prepare(Starts.PROGRAM))

    def close(self) -> None:
        """End the worker that searches."""
        self.finder.worker.close()

    def _forget(self) -> None:
        """Cancel the plan and the prepared restart."""
        self._withdraw()
        if self.open and self.has_keyboard:
            # The end of the retract must not discard an entry that begins at the same time.
            self._going_out = False
            self.post(Prepare(Starts.RESTART))

    def _withdraw(self) -> None:
        self.finder.worker.give_up()
        self.stage, self.answer, self.plan, self.proved = SearchtoStage.CHOOSE, None, None, None
        self.leaving, self._cut = None, None
        self._job, self._accepted = None, False

    # --- choose a line -------------------------------------------------------------------------------

    def move(self, lines: int) -> None:
        """Move the cursor by a number of lines."""
        self.cursor.go(self.cursor.line + lines)
        self.number = self.count = 0
        self._forget()

    def go(self, line: int, number: int = 0) -> None:
        """Select this line in this pass, and rebuild its state. Line 0 does nothing."""
        if line:
            self.cursor.go(line)
            self.cursor.text = ""
            self.number, self.count = number, 0
            self.search()

    def turn_pass(self, by: int) -> None:
        """Select a later or earlier pass of a line that runs more than once."""
        if self.count < 2:
            self.say(tr("NO REPETITIONS FOUND FOR THIS LINE. ENTER: REBUILD STATE"))
            return
        number = max(1, min(self.number + by, self.count))
        if number != self.number:
            self.number = number
            self.search()

    def takes(self, key: str) -> bool:
        """Return whether this character is text input, which is not so while the tool retracts."""
        return len(key) == 1 and self.has_keyboard

    def typed(self, key: str) -> bool:
        """Handle a character or an editing key. Return False if the key has no meaning here."""
        if not self.cursor.type(key):
            return False
        self.clear()
        return True

    def enter(self) -> None:
        """Handle Enter: go to a line number, find a text, or rebuild the state of the selected line."""
        number = self.cursor.number
        if number is not None:
            self.go(number, self.cursor.visit)
        elif self.cursor.text and not self.cursor.found:
            self.find(1)
        else:
            self.search()

    def barred_keys(self) -> frozenset[str]:
        """Return the function keys that are disabled now."""
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
        """Whether the machine is a mill, where every restart retracts the tool first."""
        job = self.session.now.job
        return job is not None and job.setup.kinematics is not None

    @property
    def _decided(self) -> bool:
        """Whether a retract path or a valid line is shown."""
        whole = self.session.now.job is not None
        return (
            self.stage is SearchtoStage.SHOWN and whole and (self._cut is not None or self.plan is not None)
        )

    def find(self, way: int) -> None:
        """Select the next (1) or previous (-1) line that contains the text."""
        self._forget()
        self.clear()
        if not self._has_text:
            self.say(tr('TYPE SEARCH TEXT FIRST. BEFORE A NUMBER, TYPE A " (QUOTE)'))
        elif not self.cursor.find(way):
            self.say(tr(Message("{text} NOT FOUND IN ANY LINE", text=self.cursor.wanted)))

    def search(self) -> None:
        """Rebuild the state of the selected line."""
        loaded = self.session.now
        self._forget()
        self.clear()
        job, line = loaded.job, self.cursor.line
        if job is None:
            return
        self.stage, self._of = SearchtoStage.SEARCHING, job
        self.finder.find(job, line, self.number, now_of(self.snapshot(), job).broken)

    def nearest(self, way: int) -> None:
        """Go to the valid line before or after a rejected line."""
        if self.answer is not None:
            self.go(self.answer.before if way < 0 else self.answer.after)

    # --- confirm -------------------------------------------------------------------------------------

    def way_out(self) -> None:
        """Plan a retract from the part without a restart."""
        self._forget()
        self.clear()
        if self._out_by_hand:
            self.say(tr("RESTARTING RETRACTS TOOL ALONG ITS AXIS FIRST; OR JOG IT OUT"))
        elif (job := self.session.now.job) is not None:
            self.stage, self._of = SearchtoStage.SEARCHING, job
            self.finder.cut(job)

    def turn_coolant(self) -> None:
        """Toggle whether the coolant starts, if it is on at the line."""
        self._choose(replace(self.choices, coolant=not self.choices.coolant))

    def confirm(self) -> None:
        """Confirm the restart or the retract. It is then proved and prepared for Cycle Start."""
        if self.stage in {SearchtoStage.PROVING, SearchtoStage.READY}:
            return  # It is already confirmed.
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
        """Go one step back. Return False if there was no step."""
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
        """Accept the results of the worker; called once a frame. A reloaded program needs a new search."""
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
        """Return the prompt. ``start`` is the instruction for starting a cycle."""
        shown = self.leaving or self.plan
        trouble = shown.trouble if shown is not None else ""
        return "" if snapshot.state in CYCLE else self._prompt(snapshot, trouble, start)

    def _prompt(self, snapshot: Snapshot, trouble: str, start: str) -> str:
        return searchto_prompt(self.stage, snapshot, trouble, start, out=self.leaving is not None)

    def barred(self) -> str:
        """Return why the start buttons have no effect now. Empty if they can start the restart."""
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
            self.started = snapshot.starts is Starts.PROGRAM  # A started restart counts once.
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
    """Return the prompt for a stage of the restart.

    ``start`` is the instruction for starting a cycle. ``trouble`` is why the plan cannot be started, or
    empty. ``out`` is True for a retract without a restart.
    """
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
