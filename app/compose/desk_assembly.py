"""Assembly of the operator screen's model with all its pages.

The machine control runs in this process or in another process.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

from app.compose.backends.backend_entry import NO_PRIORITY_TEXT, ConnectedMachine, has_inverter, is_simulated
from app.compose.backends.connection import connect_machine
from app.compose.desk_pages import PAGES, PageSetup, get_program_folder, register_pages
from app.compose.machine.accepted_machine import make_guarded_post, prepare_change_review
from app.compose.machine.machine_setup import read_machine, save_machine_in_use
from app.compose.optional_features import list_drawing_suffixes
from app.compose.program_proving import create_loading_steps, create_thumbnail_drawer, get_samples_folder
from app.compose.runs.journal import Journal
from app.compose.runs.receipt import EventReceipt
from app.compose.stored_offsets import Offsets, create_offset_book, try_read_shapes
from app.desk.command_errors import convert_to_command_error
from app.desk.desk import Desk
from app.desk.pages.attached_parts import ClosingSequence, ControlClosing
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import ProgramLoader
from app.desk.programs.start_watch import FirstMoveWatch
from app.desk.state.desk_control import DeskControl
from app.desk.state.desk_machine import DeskMachine
from app.desk.status.alarm_log import LOGGED_KINDS, MAX_ENTRIES
from app.desk.stored_part import load_stored_part
from app.desk.translation import tr
from core.executor.commands import ReportInterruptedJob
from core.executor.executor import Executor
from core.executor.scope_recorder import ScopeRecorder, list_recorded_signals
from core.executor.snapshot import InterruptedJob, LogEvent
from core.interpreter.shared.modal_state import ModalState
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import Clock, DriverError
from core.store.store_errors import StoreError
from core.store.store_rows import EventRow


def create_desk_and_executor(
    machine_file: str | None,
    read_offsets: Callable[[], Offsets],
    clock: Clock,
    journal: Journal | None = None,
    records_folder: Path | None = None,
) -> tuple[Desk, Executor]:
    """Return the screen model, and the executor before its first tick.

    ``journal`` receives events. Scope records are saved in the folder ``records_folder``. If it is None,
    they are only in memory.
    """
    machine = read_machine(machine_file)
    if journal is not None:
        save_machine_in_use(machine_file, journal)
    parts = create_control_parts(machine, clock, journal, records_folder)
    closing = ClosingSequence(ControlClosing(close_drivers=parts.close_drivers))
    return create_desk(machine, parts.control, parts.events, read_offsets, closing), parts.executor


class ControlParts(NamedTuple):
    """The control of a machine in the process of the screen, before the screen's model is created."""

    control: DeskControl
    events: EventDistributor
    executor: Executor
    recorder: ScopeRecorder
    close_drivers: Callable[[], None]


def create_control_parts(
    machine: Machine, clock: Clock, journal: Journal | None, records_folder: Path | None
) -> ControlParts:
    """Create the executor and the recorder of a machine in this process.

    ``records_folder`` is the folder of the scope records, or None if no records are written to files.
    Without a ``journal``, interruptions are not saved. Raises CommandError if the machine cannot be
    connected.
    """
    connected = _connected(machine, clock)
    recorder = ScopeRecorder(list_recorded_signals(machine, connected.ports), records_folder)
    events = EventDistributor(clock, journal, recorder.add_record_name)
    executor = Executor(
        machine,
        connected.ports,
        events.hear,
        store_interruption=journal.note if journal is not None else _discard,
        interrupted_job=journal.left if journal is not None else None,
        record_tick=recorder.queue_tick,
        checks_starts=machine.kind == "lathe",
    )
    control = DeskControl(
        executor.post,
        lambda: executor.snapshot,
        connected.on_screen_station,
        connected.set_input,
        connected.ports.warnings,
        recorder,
    )
    return ControlParts(control, events, executor, recorder, connected.close)


def create_desk(
    machine: Machine,
    control: DeskControl,
    event_distributor: EventDistributor,
    read_offsets: Callable[[], Offsets],
    closing_sequence: ClosingSequence,
) -> Desk:
    """Return the screen model with all its pages, and report the warnings from startup.

    Raises CommandError if ``read_offsets`` reads an offsets file that has errors.
    """
    journal = event_distributor.journal
    desk = _create_desk_model(machine, control, event_distributor, read_offsets, closing_sequence)
    event_distributor.desk = desk
    if journal is not None:
        desk.alarm_log.add_stored_entries(_list_stops(journal))
        journal.set_late_open_callback(partial(_handle_late_store, desk, journal))
    for warning in (
        *control.warnings,
        *(Message("machine file: {item}", item=each) for each in desk.changes.changes),
    ):
        event_distributor.report_event("warning", warning)
    if journal is not None:
        _report_damage(desk, journal, partial(event_distributor.report_event, "warning"))
    recordings = control.recordings
    if recordings is not None and recordings.storage_error:
        event_distributor.report_event("warning", recordings.storage_error)
    if any(each.startswith(NO_PRIORITY_TEXT) for each in control.warnings):
        desk.say(tr("NO REAL-TIME PRIORITY: AXES STOP IF THE COMPUTER IS 10 MS LATE"))
    if desk.changes.barred:
        desk.say(desk.changes.barred)
    return desk


def _handle_late_store(desk: Desk, journal: Journal) -> None:
    """Report data from a store that could not be opened until after startup.

    The function is called in a different thread.
    """
    if journal.left is not None:
        desk.post(ReportInterruptedJob(journal.left))
    _report_damage(
        desk, journal, lambda text: journal.hear(LogEvent(desk.read_snapshot().t, "warning", text))
    )


def _report_damage(desk: Desk, journal: Journal, log: Callable[[str], None]) -> None:
    """Report damaged data in the event log and on the prompt line."""
    for damage in journal.damage:
        log(damage)
        desk.say(tr(Message("CHECK: {what}", what=damage)))


class EventDistributor:
    """Distributor of events to the screen model and to the journal. Either of them may be None."""

    def __init__(
        self,
        clock: Clock,
        journal: Journal | None,
        record_event: Callable[[LogEvent], LogEvent] = lambda event: event,
    ) -> None:
        self.journal, self._record = journal, record_event
        self.desk: Desk | None = None
        self._clock = clock

    def hear(self, event: LogEvent, receipt: EventReceipt | None = None) -> None:
        """Pass an event to the screen model and the journal.

        If a previous screen process has already stored the event, only confirm its ``receipt``.
        """
        if receipt is not None and (self.journal is None or self.journal.has_stored_event(receipt.origin)):
            receipt.confirm_storage()
            if self.journal is not None:
                return
        event = self._record(event)
        if self.desk is not None:
            self.desk.hear(event)
        if self.journal is not None:
            self.journal.hear(event, receipt)

    def report_warning(self, text: str) -> None:
        """Show a warning on the prompt line, and report it with the current time."""
        if self.desk is not None:
            self.desk.say(text)
        self.report_event("warning", text)

    def report_event(self, kind: str, text: str) -> None:
        """Distribute a new event with the current time as its time stamp."""
        self.hear(LogEvent(self._clock.now(), kind, text))


def _create_desk_model(
    machine: Machine,
    control: DeskControl,
    events: EventDistributor,
    offsets: Callable[[], Offsets],
    closing_sequence: ClosingSequence,
) -> Desk:
    """Create the screen model, register all its pages, and return the model."""
    journal = events.journal
    keep = journal or Persistence()

    def read_modal_state() -> ModalState:
        return control.read_snapshot().modal

    kept = partial(load_stored_part, keep.read_setting)
    changed = prepare_change_review(machine, keep, partial(events.report_event, "machine"))
    guarded_control = replace(
        control, post=make_guarded_post(control.post, changed, partial(events.report_event, "refused"))
    )
    steps = create_loading_steps(
        machine,
        offsets,
        journal,
        read_modal_state=read_modal_state,
        read_shapes=try_read_shapes,
        read_stored_part=kept,
    )
    desk = Desk(
        guarded_control,
        ProgramLoader(steps, control.post),
        ProgramFolders((get_program_folder(), get_samples_folder()), list_drawing_suffixes()),
        machine=_displayed_machine(machine),
        persistence=keep,
        offset_book=create_offset_book(offsets, journal),
        file_changes=changed,
        start_watch=FirstMoveWatch(guarded_control.post) if machine.kind == "lathe" else None,
        closing_sequence=closing_sequence,
    )
    setup = PageSetup(
        desk=desk,
        machine=machine,
        persistence=keep,
        journal=journal,
        program_folder=get_program_folder(),
        loading_steps=create_loading_steps(machine, offsets, read_modal_state=read_modal_state),
        proof_steps=create_loading_steps(
            machine, offsets, read_modal_state=read_modal_state, draw_pictures=False
        ),
        read_offsets=offsets,
        read_stored_part=kept,
        draw_thumbnail=create_thumbnail_drawer(machine, try_read_shapes, kept),
    )
    register_pages(setup, PAGES)
    return desk


def _displayed_machine(machine: Machine) -> DeskMachine:
    """Return the machine data that the operator screen shows."""
    return DeskMachine(
        name=Message("{machine} · {machine2}", machine=machine.name, machine2=_describe_drives(machine)),
        machine=machine,
        has_two_hand_start=machine.interlocks.two_hand_start,
        has_c_axis=machine.is_c_enabled,
        allows_one_hand_start=is_simulated(machine) and not has_inverter(machine),
    )


def _list_stops(journal: Journal) -> Sequence[EventRow]:
    """Return the alarms and stops of previous days, or () if the store cannot be read."""
    try:
        return journal.events("", LOGGED_KINDS, MAX_ENTRIES)
    except StoreError:
        return ()


def _discard(_value: InterruptedJob | None) -> None:
    """Discard the interrupted job. This function is for a screen that has no store."""


def _connected(machine: Machine, clock: Clock) -> ConnectedMachine:
    with convert_to_command_error(DriverError):
        return connect_machine(machine, clock)


def _describe_drives(machine: Machine) -> str:
    """Return the message that tells the operator which parts of the machine are simulated."""
    if not is_simulated(machine):
        return machine.backend.upper()
    return "SIMULATED AXES · REAL SPINDLE" if has_inverter(machine) else "SIMULATED"
