"""The model of the SEARCHTO page without Qt.

The steps are to choose a line, rebuild its state, confirm, prove and start.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from enum import Enum, auto
from typing import TYPE_CHECKING

from app.desk.background_work import ProgressCallback
from app.desk.pages.page_entry import find_restart_refusal
from app.desk.programs.program_loading import LoadedProgram, ProgramLoader, ProvedJob
from app.desk.translation import tr
from app.searchto.restart_finder import LineCursor, RestartFinder, RestartSearchResult
from app.searchto.restart_plan import (
    RestartPlan,
    RetractPlan,
    make_restart_plan,
    plan_retract,
    read_machine_state,
)
from core.executor.commands import Command, PrepareCycleStart
from core.executor.job import Job, make_job
from core.executor.snapshot import CYCLE_STATES, MachineState, Snapshot, StartAction
from core.interpreter.restart.cut_record import CutRecord
from core.interpreter.restart.restart_approach import OperatorChoices
from core.interpreter.restart.restart_point import RestartPoint, RestartRejection
from core.language.source import ProgramSource
from core.message import Message

if TYPE_CHECKING:
    from app.searchto.restart_finder import RestartSearch

RETRACT_TEXT = "(RETRACT FROM THE PART)"


class RestartStage(Enum):
    """The stages of a restart, from choosing a line to being ready for Cycle Start."""

    CHOOSING = auto()
    SEARCHING = auto()
    PLAN_SHOWN = auto()  # A valid restart line with its plan.
    REFUSED = auto()  # A line that is not a valid restart line.
    PROVING = auto()
    READY = auto()


@dataclass(slots=True)
class RestartModel:
    """The model of the SEARCHTO page.

    ``show_message`` shows a message, and ``clear_message`` removes it.
    """

    program_loader: ProgramLoader
    post_command: Callable[[Command], None]
    read_snapshot: Callable[[], Snapshot]
    show_message: Callable[[str], None]
    clear_message: Callable[[], None]
    rebuild_state: Callable[
        [Job, ProgressCallback], RestartSearch
    ]  # Creates the search in a program; called on the worker.
    prove_job: Callable[
        [Job, ProgressCallback], ProvedJob
    ]  # Proves a restart and checks its first move; called on the worker.
    restart_choices: OperatorChoices = field(default_factory=OperatorChoices)
    line_cursor: LineCursor = field(default_factory=LineCursor)
    stage: RestartStage = RestartStage.CHOOSING
    is_open: bool = False
    restart_refusal: RestartRejection | None = None
    restart_plan: RestartPlan | None = None
    retract_plan: RetractPlan | None = None  # A retract without a restart.
    pass_number: int = 0  # The wanted pass of the line; 0: the interrupted pass, or else the first.
    pass_count: int = 0  # Number of passes of the line; 0: not known yet.
    proved_job: ProvedJob | None = None
    has_restart_started: bool = False  # The restart has started, so the Automatic page must be shown.
    restart_finder: RestartFinder = field(init=False)
    _job: Job | None = None
    _of: Job | None = None  # The job that was searched.
    _accepted: bool = False
    _cut: CutRecord | None = None
    _going_out: bool = False

    def __post_init__(self) -> None:
        self.restart_finder = RestartFinder(
            self.rebuild_state, self.prove_job, self._found, self._not_searched
        )

    # --- open and close ------------------------------------------------------------------------------

    @property
    def can_choose_line(self) -> bool:
        """Return whether a line can be chosen.

        This is not possible while the tool retracts.
        """
        return self.read_snapshot().state not in CYCLE_STATES

    def can_open(self) -> bool:
        """Return whether SEARCHTO can be opened now, and show the reason if not."""
        why = find_restart_refusal(self.read_snapshot(), self.program_loader.loaded_program)
        if why:
            self.show_message(why)
        return not why

    def on_open(self) -> None:
        """Restrict Cycle Start to a confirmed restart while the page is open."""
        loaded, snapshot = self.program_loader.loaded_program, self.read_snapshot()
        self.clear_message()  # The operator has read the earlier message.
        self.is_open, self.has_restart_started = True, False
        lines = loaded.source.lines if loaded.source is not None else ()
        before = self.line_cursor.selected_line if self.line_cursor.program_lines is lines else 1
        self.line_cursor.set_program(lines, snapshot.interrupted_line or before)
        self.pass_number = self.pass_count = 0
        self._going_out = False
        self._discard_results()

    def on_close(self) -> None:
        """Allow Cycle Start to run programs again."""
        if self.is_open:
            self.is_open = False
            self._withdraw()
            self.post_command(PrepareCycleStart(StartAction.PROGRAM))

    def close(self) -> None:
        """Stop the worker that searches for restart lines."""
        self.restart_finder.worker.close()

    def _discard_results(self) -> None:
        """Discard the plan of the restart, and cancel a restart that is prepared for Cycle Start."""
        self._withdraw()
        if self.is_open and self.can_choose_line:
            # The end of the retract must not discard an entry that begins at the same time.
            self._going_out = False
            self.post_command(PrepareCycleStart(StartAction.RESTART))

    def _withdraw(self) -> None:
        self.restart_finder.worker.cancel_request()
        self.stage, self.restart_refusal, self.restart_plan, self.proved_job = (
            RestartStage.CHOOSING,
            None,
            None,
            None,
        )
        self.retract_plan, self._cut = None, None
        self._job, self._accepted = None, False

    # --- choose a line -------------------------------------------------------------------------------

    def move_cursor(self, line_steps: int) -> None:
        """Move the cursor by a number of lines."""
        self.line_cursor.select_line(self.line_cursor.selected_line + line_steps)
        self.pass_number = self.pass_count = 0
        self._discard_results()

    def select_line(self, line_number: int, pass_number: int = 0) -> None:
        """Select a line in one of its passes (executions), and rebuild the machine state at this line.

        Line 0 has no effect.
        """
        if line_number:
            self.line_cursor.select_line(line_number)
            self.line_cursor.entry_text = ""
            self.pass_number, self.pass_count = pass_number, 0
            self.rebuild_selected_line()

    def change_pass_number(self, steps: int) -> None:
        """Select a later or earlier pass (execution) of the selected line."""
        if self.pass_count < 2:
            self.show_message(tr("NO REPETITIONS FOUND FOR THIS LINE. ENTER: REBUILD STATE"))
            return
        number = max(1, min(self.pass_number + steps, self.pass_count))
        if number != self.pass_number:
            self.pass_number = number
            self.rebuild_selected_line()

    def accepts_key(self, key: str) -> bool:
        """Return whether this character is text input.

        No character is text input while the tool retracts.
        """
        return len(key) == 1 and self.can_choose_line

    def handle_key(self, key: str) -> bool:
        """Handle a character or an editing key, and return False for any other key."""
        if not self.line_cursor.handle_key(key):
            return False
        self.clear_message()
        return True

    def handle_enter(self) -> None:
        """Handle Enter: go to a line number, find a text, or rebuild the machine state at the line."""
        number = self.line_cursor.entered_line_number
        if number is not None:
            self.select_line(number, self.line_cursor.entered_pass_number)
        elif self.line_cursor.entry_text and not self.line_cursor.is_text_found:
            self.find_text(1)
        else:
            self.rebuild_selected_line()

    def find_disabled_keys(self) -> frozenset[str]:
        """Return the function keys that are disabled now."""
        found: set[str] = set()
        if not self._has_text:
            found |= {"F2", "F3"}
        if self._needs_manual_retract:
            found.add("F4")
        if not self._is_decided and self.stage not in {RestartStage.PROVING, RestartStage.READY}:
            found.add("F10")
        return frozenset(found)

    @property
    def _has_text(self) -> bool:
        return bool(self.line_cursor.entry_text) and self.line_cursor.entered_line_number is None

    @property
    def _needs_manual_retract(self) -> bool:
        """Return whether every restart retracts the tool first, which is the case on a mill."""
        job = self.program_loader.loaded_program.job
        return job is not None and job.setup.kinematics is not None

    @property
    def _is_decided(self) -> bool:
        """Return whether the operator can confirm, because a retract path or a valid line is shown."""
        whole = self.program_loader.loaded_program.job is not None
        return (
            self.stage is RestartStage.PLAN_SHOWN
            and whole
            and (self._cut is not None or self.restart_plan is not None)
        )

    def find_text(self, direction: int) -> None:
        """Select the next (1) or previous (-1) line that contains the text."""
        self._discard_results()
        self.clear_message()
        if not self._has_text:
            self.show_message(tr('TYPE SEARCH TEXT FIRST. BEFORE A NUMBER, TYPE A " (QUOTE)'))
        elif not self.line_cursor.find_text(direction):
            self.show_message(tr(Message("{text} NOT FOUND IN ANY LINE", text=self.line_cursor.search_text)))

    def rebuild_selected_line(self) -> None:
        """Rebuild the machine state at the selected line."""
        loaded = self.program_loader.loaded_program
        self._discard_results()
        self.clear_message()
        job, line = loaded.job, self.line_cursor.selected_line
        if job is None:
            return
        self.stage, self._of = RestartStage.SEARCHING, job
        self.restart_finder.find_restart_line(
            job, line, self.pass_number, read_machine_state(self.read_snapshot(), job).interruption
        )

    def select_nearest_valid_line(self, direction: int) -> None:
        """Select the nearest valid line before or after a rejected line."""
        if self.restart_refusal is not None:
            self.select_line(
                self.restart_refusal.nearest_line_before
                if direction < 0
                else self.restart_refusal.nearest_line_after
            )

    # --- confirm -------------------------------------------------------------------------------------

    def plan_retract(self) -> None:
        """Plan a retract from the part without a restart."""
        self._discard_results()
        self.clear_message()
        if self._needs_manual_retract:
            self.show_message(tr("RESTARTING RETRACTS TOOL ALONG ITS AXIS FIRST; OR JOG IT OUT"))
        elif (job := self.program_loader.loaded_program.job) is not None:
            self.stage, self._of = RestartStage.SEARCHING, job
            self.restart_finder.calculate_cuts(job)

    def toggle_coolant(self) -> None:
        """Select whether the restart turns on the coolant, if coolant is on at the restart line."""
        self._choose(replace(self.restart_choices, uses_coolant=not self.restart_choices.uses_coolant))

    def confirm_plan(self) -> None:
        """Confirm the restart or the retract. It is then proved and prepared for Cycle Start."""
        if self.stage in {RestartStage.PROVING, RestartStage.READY}:
            return  # It is already confirmed.
        self.clear_message()
        snapshot, plan, whole = (
            self.read_snapshot(),
            self.restart_plan,
            self.program_loader.loaded_program.job,
        )
        if self.stage is RestartStage.PLAN_SHOWN and self._cut is not None and whole is not None:
            self._confirm_out(snapshot, self._cut, whole)
            return
        if self.stage is not RestartStage.PLAN_SHOWN or plan is None or whole is None:
            self.show_message(tr("CHOOSE A VALID RESTART LINE FIRST"))
            return
        if snapshot.state is not MachineState.IDLE:
            self.show_message(tr("SWITCH THE DRIVES ON FIRST (D)"))
            return
        plan = self.restart_plan = make_restart_plan(
            plan.restart_point, snapshot, whole, self.restart_choices
        )
        if plan.error_text:
            self.show_message(plan.error_text)
            return
        setup = replace(whole.setup, start=snapshot.demand, begin=plan.start_state)
        self.stage = RestartStage.PROVING
        self.restart_finder.prove_restart(make_job(whole.source, setup, whole))

    def _confirm_out(self, snapshot: Snapshot, cut: CutRecord, whole: Job) -> None:
        if snapshot.state is not MachineState.IDLE:
            self.show_message(tr("SWITCH THE DRIVES ON FIRST (D)"))
            return
        out = self.retract_plan = plan_retract(cut, snapshot, whole, self.restart_choices)
        if out.error_text:
            self.show_message(out.error_text)
            return
        setup = replace(whole.setup, start=snapshot.demand, begin=out.start_state)
        self.stage = RestartStage.PROVING
        self.restart_finder.prove_restart(make_job(ProgramSource("RETRACT", RETRACT_TEXT), setup))

    def handle_escape(self) -> bool:
        """Go back one step.

        Return False if there was no step to go back.
        """
        if self.line_cursor.entry_text:
            self.line_cursor.entry_text = ""
            return True
        if self.stage is RestartStage.CHOOSING:
            return False
        self._discard_results()
        return True

    def _choose(self, choices: OperatorChoices) -> None:
        self.restart_choices = choices
        if self.restart_plan is not None:
            found = self.restart_plan.restart_point
            self._discard_results()
            self._show(found)

    # --- every frame ---------------------------------------------------------------------------------

    def update(self, snapshot: Snapshot, loaded: LoadedProgram) -> None:
        """Accept the results of the worker.

        This is called once a frame. If the program has been reloaded, earlier results are not used.
        """
        if self._of is not None and loaded.job is not self._of:
            self._of = None
            self._discard_results()
        if self._going_out and snapshot.state not in CYCLE_STATES:
            self._going_out = False
            self._discard_results()
        if self.stage is RestartStage.READY:
            self._see_start(snapshot)
        self.restart_finder.worker.deliver_results()

    def prompt_text(self, snapshot: Snapshot, start_instruction: str) -> str:
        """Return the prompt.

        ``start_instruction`` is the instruction for starting a cycle.
        """
        shown = self.retract_plan or self.restart_plan
        error_text = shown.error_text if shown is not None else ""
        return "" if snapshot.state in CYCLE_STATES else self._prompt(snapshot, error_text, start_instruction)

    def _prompt(self, snapshot: Snapshot, error_text: str, start: str) -> str:
        return make_restart_prompt(
            self.stage, snapshot, error_text, start, is_retract=self.retract_plan is not None
        )

    def barred(self) -> str:
        """Return why the start buttons cannot start the restart now, or an empty string if they can."""
        if self.stage is RestartStage.READY or self.read_snapshot().state in CYCLE_STATES:
            return ""
        return tr("CANNOT START: SEARCH FOR A LINE AND CONFIRM IT FIRST (F10)")

    def _see_start(self, snapshot: Snapshot) -> None:
        waits = self._job is not None and snapshot.prepared_job_digest == self._job.digest
        if self._accepted and not waits and self.retract_plan is not None:
            self._going_out = snapshot.state in CYCLE_STATES
            self._withdraw()
            return
        if self._accepted and not waits:
            self.has_restart_started = (
                snapshot.starts is StartAction.PROGRAM
            )  # A started restart counts once.
            self.is_open = not self.has_restart_started
            self._withdraw()
        self._accepted = waits

    def _not_searched(self, why: str) -> None:
        self.stage = RestartStage.CHOOSING
        self.show_message(tr(Message("SEARCH FAILED: {why}", why=why)))

    def _found(self, answer: RestartSearchResult) -> None:
        if isinstance(answer, RestartPoint):
            self.pass_number, self.pass_count = answer.visit.visit_number, answer.visit.visit_count
            self._show(answer)
        elif isinstance(answer, CutRecord):
            self._show_out(answer)
        elif isinstance(answer, RestartRejection):
            self.stage, self.restart_refusal = RestartStage.REFUSED, answer
        else:
            self._made_ready(*answer)

    def _show(self, found: RestartPoint) -> None:
        if self._of is not None:
            self.stage = RestartStage.PLAN_SHOWN
            self.restart_plan = make_restart_plan(found, self.read_snapshot(), self._of, self.restart_choices)

    def _show_out(self, cut: CutRecord) -> None:
        if self._of is not None:
            self.stage, self._cut = RestartStage.PLAN_SHOWN, cut
            self.retract_plan = plan_retract(cut, self.read_snapshot(), self._of, self.restart_choices)

    def _made_ready(self, job: Job, proved: ProvedJob) -> None:
        self.proved_job = proved
        if proved.proof.errors:
            self.stage = RestartStage.PLAN_SHOWN
            self.show_message(tr(Message("WILL NOT START: {why}", why=proved.proof.errors[0])))
            return
        self.stage, self._job, self._accepted = RestartStage.READY, job, False
        starts = StartAction.RESTART if self.retract_plan is None else StartAction.RETRACT
        self.post_command(PrepareCycleStart(starts, job, proved.proof, proved.first_move_clearance))


def make_restart_prompt(
    stage: RestartStage,
    snapshot: Snapshot,
    error_text: str,
    start_instruction: str,
    *,
    is_retract: bool = False,
) -> str:
    """Return the prompt for a stage of the restart.

    ``start_instruction`` is the instruction for starting a cycle. ``error_text`` is the reason why the plan
    cannot be started, or an empty string. ``is_retract`` is True for a retract without a restart.
    """
    if is_retract and stage is RestartStage.PLAN_SHOWN and not error_text:
        return tr("CHECK THE RETRACT PATH. F10: CONFIRM")
    if is_retract and stage is RestartStage.READY:
        return tr(Message("RETRACT THE TOOL FROM THE PART: {start}. ESC: CANCEL", start=start_instruction))
    words = {
        RestartStage.SEARCHING: tr("SEARCHING THE PROGRAM. ESC: CANCEL"),
        RestartStage.PROVING: tr("PROVING THE RESTART. ESC: CANCEL"),
        RestartStage.PLAN_SHOWN: error_text or tr("CHECK STATE, PATH AND WHAT WILL START. F10: CONFIRM"),
        RestartStage.REFUSED: tr("CANNOT START FROM THIS LINE. F8, F9: NEAREST VALID LINE"),
        RestartStage.READY: tr(Message("RESUME AT THIS LINE: {start}. ESC: CANCEL", start=start_instruction)),
    }
    return words.get(stage) or _choose(snapshot)


def _choose(snapshot: Snapshot) -> str:
    if not snapshot.interrupted_line:
        return tr("TYPE A NUMBER OR TEXT, OR USE ARROWS   ENTER: REBUILD STATE")
    words = tr("STOPPED IN LINE {line}. ENTER: REBUILD STATE   F4: RETRACT")
    return tr(Message(words, line=snapshot.interrupted_line))
