"""Program run without a screen, by default on the simulated lathe with a clock that does not wait.

Tool life is counted and reported as on the screen. A part does not start with a worn insert.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace

from app.compose.backends.backend_entry import ConnectedMachine, is_simulated
from app.compose.backends.connection import connect_machine, needs_real_time
from app.compose.optional_features import extras
from app.compose.runs.journal import Journal
from app.compose.runs.run_log import EventLog
from app.desk.command_errors import CommandError, convert_to_command_error
from app.desk.data_folder import RECORDS_FOLDER_NAME, find_data_folder
from app.desk.headless_run import HeadlessRun
from app.production.parts_book import ProductionRecords, find_tool_table_kind, read_production_data
from app.production.tool_life_watch import ToolLifeMonitor
from core.executor.commands import Command, PreventNextPart
from core.executor.executor import Executor
from core.executor.interruption_watch import StoreFunction
from core.executor.job import Proof
from core.executor.scope_recorder import ScopeRecorder, list_recorded_signals
from core.executor.snapshot import InterruptedJob, LogEvent, Snapshot
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError
from core.records.record_ring import RING_DURATION_S
from core.records.ring_file import RUN_RING_NAME
from core.store.store_errors import StoreError
from core.store.store_rows import OffsetKind
from core.tool_edges import format_edge_name
from drivers.simulated.simulated_table import SimulatedTable
from drivers.wakeups import ManualClock, RealClock


class HeadlessToolLife:
    """Counter of tool life during a program run without a screen.

    ``update`` is called at every step of the run. If no store is open, tool life is not counted and a
    message is printed.
    """

    def __init__(
        self,
        journal: Journal,
        post_command: Callable[[Command], None],
        print_line: Callable[[str], None],
        tool_kind: OffsetKind = OffsetKind.TOOL,
    ) -> None:
        self._book = journal.create_parts_book(tool_kind)
        self._watch = ToolLifeMonitor(self._book)
        self._post, self._say = post_command, print_line
        self._barred = ""
        try:
            self._read(self._book)
        except StoreError as error:
            print_line(Message("tool life is not counted: {error}", error=error))

    def _read(self, book: ProductionRecords) -> None:
        if book.store is None:
            raise StoreError(book.lock_reason)
        book.current_data = read_production_data(book.store, "", book.tool_table_kind, {})
        book.load_count = 1

    def update(self, snapshot: Snapshot, proof: Proof) -> None:
        """Count the use of tools, and report tools that must be replaced.

        If a tool must be replaced, the method prevents the start of the next part.
        """
        if not self._book.load_count:
            return
        self._watch.process_snapshot(snapshot, self._say)
        wanted = self._watch.find_lock_reason(snapshot, proof.tool_numbers)
        if wanted != self._barred:
            self._post(PreventNextPart(wanted))
        self._barred = wanted

    def save_tool_use(self) -> None:
        """Save the tool use counted since the last save."""
        self._watch.save_all_tool_use()
        self._book.close()


@contextmanager
def run_headless(
    machine: Machine,
    *,
    input_states: Mapping[str, bool],
    is_real_time: bool,
    discard_interrupted: bool = False,
    event_log: EventLog,
    print_line: Callable[[str], None],
    report_progress: Callable[[float], None],
    duration_s: float = RING_DURATION_S,
) -> Iterator[HeadlessRun]:
    """Yield a program run without a screen, with these inputs and automatic button presses.

    A machine that is not simulated runs in real time. ``discard_interrupted`` permits a start after an
    interrupted job.

    The scope record is saved in the folder of records. It contains at least the last ``duration_s`` seconds
    of samples. A value above ``RING_DURATION_S`` is reduced to it. A run in real time counts tool life,
    parts and cycles as on the screen, but a faster run counts nothing.

    Raises CommandError if the machine does not respond, if an input does not exist or is wired, if a job
    was interrupted, or if ``discard_interrupted`` is used for a simulated machine.
    """
    paced = _is_real_time(machine, is_real_time)
    with (
        _open_journal(
            machine, discard_interrupted=discard_interrupted, real_time=paced, print_line=print_line
        ) as (journal, note),
        _connect(machine, paced) as (clock, connected),
    ):
        _set_inputs(connected, input_states)
        recorder = ScopeRecorder(
            replace(
                list_recorded_signals(machine, connected.ports), duration_s=min(duration_s, RING_DURATION_S)
            ),
            find_data_folder() / RECORDS_FOLDER_NAME,
            RUN_RING_NAME,
        )
        if recorder.storage_error:
            print_line(recorder.storage_error)

        def handle_event(event: LogEvent) -> None:
            noted = recorder.add_record_name(event)
            event_log.write_event(noted)
            if journal is not None:
                journal.hear(noted)

        executor = Executor(
            machine, connected.ports, handle_event, store_interruption=note, record_tick=recorder.queue_tick
        )
        tools = find_tool_table_kind(machine.kind)
        lives = HeadlessToolLife(journal, executor.post, print_line, tools) if journal is not None else None
        recorder.start()
        started = [
            extra.start_headless_services(machine, lambda: executor.snapshot, print_line, is_real_time=paced)
            for extra in extras().values()
        ]
        try:
            palms, see = (
                _start_function(machine, connected, print_line),
                lives.update if lives is not None else None,
            )
            yield HeadlessRun(executor, clock, print_line, report_progress, palms, see)
        finally:
            executor.shut_down()  # also on Ctrl-C, so that the axes brake immediately
            if lives is not None:
                lives.save_tool_use()
            recorder.close()
            for close in started:
                if close is not None:
                    close()


def _is_real_time(machine: Machine, realtime: bool) -> bool:
    """Return whether the run takes as long as on the real machine."""
    sim = machine.hardware.find_driver_table(SimulatedTable)
    return realtime or (sim is not None and sim.realtime) or needs_real_time(machine)


@contextmanager
def _connect(machine: Machine, real_time: bool) -> Iterator[tuple[RealClock | ManualClock, ConnectedMachine]]:
    """Yield the clock and the connected machine, and close the machine afterwards."""
    clock = RealClock() if real_time else ManualClock()
    with convert_to_command_error(DriverError):
        connected = connect_machine(machine, clock)
    try:
        yield clock, connected
    finally:
        connected.close()


@contextmanager
def _open_journal(
    machine: Machine, *, discard_interrupted: bool, real_time: bool, print_line: Callable[[str], None]
) -> Iterator[tuple[Journal | None, StoreFunction]]:
    """Yield the journal of the program run and the function that saves an interrupted job.

    The journal may be None. A simulated machine does not save an interrupted job.
    """
    if is_simulated(machine) and discard_interrupted:
        raise CommandError(
            "--anew cannot be used here, because a simulated run does not save interrupted jobs",
            "nothing-interrupted",
        )
    if is_simulated(machine) and not real_time:
        yield None, lambda _what: None
        return
    journal = Journal.open_default()
    try:
        if journal.write_error:
            print_line(
                Message("the data of this run cannot be saved: {problem}", problem=journal.write_error)
            )
        if is_simulated(machine):
            yield journal, lambda _what: None
            return
        if journal.left is not None:
            _demand_anew(journal.left, discard_interrupted=discard_interrupted)
            journal.hear(
                LogEvent(
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
            print_line(
                Message("this data was not saved and was lost when TurnDesk closed: {lost}", lost=lost)
            )


def _demand_anew(left: InterruptedJob, *, discard_interrupted: bool) -> None:
    if not discard_interrupted:
        raise CommandError(
            Message(
                "a job was interrupted ({left}); {tool} may be in the part. Resume the job on the "
                "screen (SEARCHTO), or move the tool clear and use --anew to start at the first line",
                left=left.words,
                tool=format_edge_name(left.tool),
            ),
            "job-interrupted",
        )


def _start_function(
    machine: Machine, connected: ConnectedMachine, print_line: Callable[[str], None]
) -> Callable[[], None] | None:
    """Return the function that starts a cycle, or None if a command can start the cycle.

    The function presses the palm buttons of the station on the screen, or asks the user to press the real
    buttons.
    """
    panel = connected.on_screen_station
    if machine.backend == "sim" or not machine.interlocks.two_hand_start:
        return None
    if panel is None:
        return lambda: print_line("press both palm buttons")

    def press_palm_buttons() -> None:
        panel.press_left()
        panel.press_right()
        panel.release_left()
        panel.release_right()

    return press_palm_buttons


def _set_inputs(connected: ConnectedMachine, inputs: Mapping[str, bool]) -> None:
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
