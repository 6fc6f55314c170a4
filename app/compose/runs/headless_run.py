"""A run without a screen: the executor, by default on the simulated lathe with the fastest possible clock.

Tool life is counted and reported as on the screen, and no part starts with a worn insert.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace

from app.compose.backends.backend_entry import Connected, played
from app.compose.backends.connection import connect, real_time
from app.compose.extra import extras
from app.compose.runs.journal import Journal
from app.compose.runs.run_log import EventLog
from app.desk.command_errors import CommandError, as_command_error
from app.desk.data_folder import RECORDS, data_folder
from app.desk.run_without_screen import HeadlessRun
from app.production.parts_book import PartsBook, production, tools_of
from app.production.tool_life_watch import ToolLifeWatch
from core.executor.commands import BarNextPart, Command
from core.executor.executor import Executor
from core.executor.interruption_watch import Note
from core.executor.job import Proof
from core.executor.recorder import Recorder, recorded_of
from core.executor.snapshot import Event, InterruptedJob, Snapshot
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError
from core.records.record_ring import LASTS
from core.records.ring_file import RUN
from core.store.store_errors import StoreError
from core.store.store_rows import Kind
from core.tool_edges import edge_name
from drivers.simulated.simulated_table import SimulatedTable
from drivers.waiting import RealClock, StepClock


class HeadlessLives:
    """Tool life during a run without a screen. ``see`` is called at every step of the run.

    Without a store nothing is counted, and a message is printed.
    """

    def __init__(
        self,
        journal: Journal,
        post: Callable[[Command], None],
        say: Callable[[str], None],
        tools: Kind = Kind.TOOL,
    ) -> None:
        self._book = journal.parts_book(tools)
        self._watch = ToolLifeWatch(self._book)
        self._post, self._say = post, say
        self._barred = ""
        try:
            self._read(self._book)
        except StoreError as error:
            say(Message("tool life is not counted: {error}", error=error))

    def _read(self, book: PartsBook) -> None:
        if book.store is None:
            raise StoreError(book.locked)
        book.now = production(book.store, "", book.tools, {})
        book.loads = 1

    def see(self, snapshot: Snapshot, proof: Proof) -> None:
        """Count the use of tools, report tools that are due, and lock the next part."""
        if not self._book.loads:
            return
        self._watch.see(snapshot, self._say)
        wanted = self._watch.bar(snapshot, proof.tools)
        if wanted != self._barred:
            self._post(BarNextPart(wanted))
        self._barred = wanted

    def close(self) -> None:
        """Save the use counted since the last save."""
        self._watch.keep_all()
        self._book.close()


@contextmanager
def headless(
    machine: Machine,
    *,
    inputs: Mapping[str, bool],
    realtime: bool,
    anew: bool = False,
    log: EventLog,
    say: Callable[[str], None],
    progress: Callable[[float], None],
    lasts: float = LASTS,
) -> Iterator[HeadlessRun]:
    """Yield a run without a screen on the machine, with these inputs and with automatic button presses.

    A machine that is not simulated runs in real time. A start after an interrupted job must be permitted
    explicitly. The scope's record is saved in the folder of records and has at least the last ``lasts`` s of
    samples. A run in real time counts for tool life, parts and cycles as on the screen; a faster run counts
    nothing. Raises CommandError if the machine does not respond, if inputs do not exist or are wired, or if a
    job was interrupted.
    """
    paced = _paced(machine, realtime)
    with (
        _remembered(machine, anew=anew, paced=paced, say=say) as (journal, note),
        _connected(machine, paced) as (clock, connected),
    ):
        _set_inputs(connected, inputs)
        recorder = Recorder(
            replace(recorded_of(machine, connected.ports), lasts=min(lasts, LASTS)),
            data_folder() / RECORDS,
            RUN,
        )
        if recorder.trouble:
            say(recorder.trouble)

        def hear(event: Event) -> None:
            noted = recorder.note(event)
            log.add(noted)
            if journal is not None:
                journal.hear(noted)

        executor = Executor(machine, connected.ports, hear, note=note, tell=recorder.tell)
        tools = tools_of(machine.kind)
        lives = HeadlessLives(journal, executor.post, say, tools) if journal is not None else None
        recorder.start()
        started = [
            extra.start_headless(machine, lambda: executor.snapshot, say, paced=paced)
            for extra in extras().values()
        ]
        try:
            palms, see = _palms(machine, connected, say), lives.see if lives is not None else None
            yield HeadlessRun(executor, clock, say, progress, palms, see)
        finally:
            executor.shut()  # also on Ctrl-C, so that the axes brake immediately
            if lives is not None:
                lives.close()
            recorder.close()
            for close in started:
                if close is not None:
                    close()


def _paced(machine: Machine, realtime: bool) -> bool:
    """Return whether the run takes as long as on the machine."""
    sim = machine.hardware.table(SimulatedTable)
    return realtime or (sim is not None and sim.realtime) or real_time(machine)


@contextmanager
def _connected(machine: Machine, paced: bool) -> Iterator[tuple[RealClock | StepClock, Connected]]:
    """Yield the connected machine and its clock."""
    clock = RealClock() if paced else StepClock()
    with as_command_error(DriverError):
        connected = connect(machine, clock)
    try:
        yield clock, connected
    finally:
        connected.close()


@contextmanager
def _remembered(
    machine: Machine, *, anew: bool, paced: bool, say: Callable[[str], None]
) -> Iterator[tuple[Journal | None, Note]]:
    """Yield the journal of the run, or None, and the function that notes the interrupted job.

    A simulated machine leaves no interrupted job.
    """
    if played(machine) and anew:
        raise CommandError(
            "--anew cannot be used here, because a simulated run does not save interrupted jobs",
            "nothing-interrupted",
        )
    if played(machine) and not paced:
        yield None, lambda _what: None
        return
    journal = Journal.at_home()
    try:
        if journal.trouble:
            say(Message("the data of this run cannot be saved: {problem}", problem=journal.trouble))
        if played(machine):
            yield journal, lambda _what: None
            return
        if journal.left is not None:
            _demand_anew(journal.left, anew=anew)
            journal.hear(
                Event(
                    0.0,
                    "cleared",
                    Message(
                        "{left}; the job was started again from the command line", left=journal.left.words
                    ),
                )
            )
        yield journal, journal.note
    finally:
        lost = journal.close()
        if lost:
            say(Message("this data was not saved and was lost when TurnDesk closed: {lost}", lost=lost))


def _demand_anew(left: InterruptedJob, *, anew: bool) -> None:
    if not anew:
        raise CommandError(
            Message(
                "a job was interrupted ({left}); {tool} may be in the part. Resume the job on the "
                "screen (SEARCHTO), or move the tool clear and use --anew to start at the first line",
                left=left.words,
                tool=edge_name(left.tool),
            ),
            "job-interrupted",
        )


def _palms(machine: Machine, connected: Connected, say: Callable[[str], None]) -> Callable[[], None] | None:
    """Return the function that starts a cycle if no command may start it, or None.

    It presses the palm buttons of the screen's station, or asks the user to press them.
    """
    panel = connected.panel
    if machine.backend == "sim" or not machine.interlocks.two_hand_start:
        return None
    if panel is None:
        return lambda: say("press both palm buttons")

    def press() -> None:
        panel.press_left()
        panel.press_right()
        panel.release_left()
        panel.release_right()

    return press


def _set_inputs(connected: Connected, inputs: Mapping[str, bool]) -> None:
    if inputs and connected.set_input is None:
        raise CommandError(
            "--inputs is only for simulated machines; this machine has wired inputs", "inputs-are-wires"
        )
    try:
        for name, on in inputs.items():
            assert connected.set_input is not None
            connected.set_input(name, on)
    except DriverError as error:
        raise CommandError(Message("--inputs: {error}", error=error), "unknown-input") from error
