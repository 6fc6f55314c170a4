"""Assembly of the operator screen's model with all its pages, for a control in this or another process."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from app.compose.backends.backend_entry import NO_PRIORITY, Connected, has_inverter, played
from app.compose.backends.connection import connect
from app.compose.desk_pages import PAGES, PageSetup, own_folder, register_pages
from app.compose.extra import drawing_endings
from app.compose.machine.accepted_machine import file_changes, guarded
from app.compose.machine.machine_setup import read_machine, remember_machine
from app.compose.runs.journal import Journal
from app.compose.runs.receipt import Receipt
from app.compose.stored_offsets import Offsets, book_of, shapes_at_hand
from app.compose.workshop import samples, thumbnails, workshop
from app.desk.command_errors import as_command_error
from app.desk.desk import Desk
from app.desk.kept_part import kept_part
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import ProgramFolders
from app.desk.programs.program_loading import ProgramLoader
from app.desk.programs.start_watch import StartWatch
from app.desk.state.desk_control import DeskControl
from app.desk.state.desk_machine import DeskMachine
from app.desk.status.alarm_log import KEPT, KINDS
from app.desk.translation import tr
from core.executor.commands import LeftInterrupted
from core.executor.executor import Executor
from core.executor.recorder import Recorder, recorded_of
from core.executor.snapshot import Event, InterruptedJob
from core.interpreter.shared.modal_state import Modal
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import Clock, DriverError
from core.store.store_errors import StoreError
from core.store.store_rows import EventRow


def desk_and_executor(
    machine_file: str | None,
    offsets: Callable[[], Offsets],
    clock: Clock,
    journal: Journal | None = None,
    records: Path | None = None,
) -> tuple[Desk, Executor]:
    """Return the screen model and the executor, which nothing ticks yet; events go to ``journal``.

    Scope records go to the folder ``records``; None stores them only in memory.
    """
    machine = read_machine(machine_file)
    if journal is not None:
        remember_machine(machine_file, journal)
    return desk_and_parts(machine, offsets, clock, journal, records)[:2]


def desk_and_parts(
    machine: Machine,
    offsets: Callable[[], Offsets],
    clock: Clock,
    journal: Journal | None,
    records: Path | None,
) -> tuple[Desk, Executor, Recorder]:
    connected = _connected(machine, clock)
    recorder = Recorder(recorded_of(machine, connected.ports), records)
    events = DeskEvents(clock, journal, recorder.note)
    executor = Executor(
        machine,
        connected.ports,
        events.hear,
        note=journal.note if journal is not None else _kept_nowhere,
        left=journal.left if journal is not None else None,
        tell=recorder.tell,
        checks_starts=machine.kind == "lathe",
    )
    control = DeskControl(
        executor.post,
        lambda: executor.snapshot,
        connected.panel,
        connected.set_input,
        connected.ports.warnings,
        recorder,
    )
    desk = desk_of(machine, control, events, offsets)
    desk.closing.shut = connected.close
    return desk, executor, recorder


def desk_of(
    machine: Machine, control: DeskControl, events: DeskEvents, offsets: Callable[[], Offsets]
) -> Desk:
    """Return the screen model with all its pages, and report the warnings of the start."""
    journal = events.journal
    desk = _desk(machine, control, events, offsets)
    events.desk = desk
    if journal is not None:
        desk.log.recall(_stops(journal))
        journal.when_late(partial(_came_late, desk, journal))
    for warning in (
        *control.warnings,
        *(Message("machine file: {item}", item=each) for each in desk.changes.changes),
    ):
        events.say("warning", warning)
    if journal is not None:
        _tell_damage(desk, journal, partial(events.say, "warning"))
    recordings = control.recordings
    if recordings is not None and recordings.trouble:
        events.say("warning", recordings.trouble)
    if any(each.startswith(NO_PRIORITY) for each in control.warnings):
        desk.say(tr("NO REAL-TIME PRIORITY: AXES STOP IF THE COMPUTER IS 10 MS LATE"))
    if desk.changes.barred:
        desk.say(desk.changes.barred)
    return desk


def _came_late(desk: Desk, journal: Journal) -> None:
    """Report information that was unknown at the start because the store was unavailable.

    Called in another thread.
    """
    if journal.left is not None:
        desk.post(LeftInterrupted(journal.left))
    _tell_damage(desk, journal, lambda text: journal.hear(Event(desk.snapshot().t, "warning", text)))


def _tell_damage(desk: Desk, journal: Journal, log: Callable[[str], None]) -> None:
    """Report damaged data in the event log and on the prompt line."""
    for damage in journal.damage:
        log(damage)
        desk.say(tr(Message("CHECK: {what}", what=damage)))


class DeskEvents:
    """Distributor of events to the screen model and the journal, if they exist."""

    def __init__(
        self, clock: Clock, journal: Journal | None, record: Callable[[Event], Event] = lambda event: event
    ) -> None:
        self.journal, self._record = journal, record
        self.desk: Desk | None = None
        self._clock = clock

    def hear(self, event: Event, receipt: Receipt | None = None) -> None:
        """Pass on an event, unless an earlier screen has stored it; ``receipt`` is confirmed then."""
        if receipt is not None and (self.journal is None or self.journal.has_stored(receipt.origin)):
            receipt.confirm()
            if self.journal is not None:
                return
        event = self._record(event)
        if self.desk is not None:
            self.desk.hear(event)
        if self.journal is not None:
            self.journal.hear(event, receipt)

    def say(self, kind: str, text: str) -> None:
        """Report an event with the present time."""
        self.hear(Event(self._clock.now(), kind, text))


def _desk(
    machine: Machine,
    control: DeskControl,
    events: DeskEvents,
    offsets: Callable[[], Offsets],
) -> Desk:
    """Return the screen model with all its pages."""
    journal = events.journal
    keep = journal or Persistence()

    def left() -> Modal:
        return control.snapshot().modal

    kept = partial(kept_part, keep.read_setting)
    changed = file_changes(machine, keep, partial(events.say, "machine"))
    guarded_control = replace(control, post=guarded(control.post, changed, partial(events.say, "refused")))
    steps = workshop(machine, offsets, journal, left=left, shapes=shapes_at_hand, kept=kept)
    desk = Desk(
        guarded_control,
        ProgramLoader(steps, control.post),
        ProgramFolders((own_folder(), samples()), drawing_endings()),
        machine=_shown(machine),
        persistence=keep,
        book=book_of(offsets, journal),
        changes=changed,
        first_move=StartWatch(guarded_control.post) if machine.kind == "lathe" else None,
    )
    setup = PageSetup(
        desk=desk,
        machine=machine,
        persistence=keep,
        journal=journal,
        own=own_folder(),
        work=workshop(machine, offsets, left=left),
        proving=workshop(machine, offsets, left=left, pictures=False),
        offsets=offsets,
        kept=kept,
        thumbnail=thumbnails(machine, shapes_at_hand, kept),
    )
    register_pages(setup, PAGES)
    return desk


def _shown(machine: Machine) -> DeskMachine:
    """Return the machine as the screen presents it."""
    return DeskMachine(
        name=Message("{machine} · {machine2}", machine=machine.name, machine2=_drives(machine)),
        model=machine,
        two_hand=machine.interlocks.two_hand_start,
        with_c=machine.c_enabled,
        one_hand=played(machine) and not has_inverter(machine),
    )


def _stops(journal: Journal) -> Sequence[EventRow]:
    """Return the alarms and stops of earlier days; () without a store."""
    try:
        return journal.events("", KINDS, KEPT)
    except StoreError:
        return ()


def _kept_nowhere(_what: InterruptedJob | None) -> None:
    """Discard the note of an interrupted job, for a screen without a store."""


def _connected(machine: Machine, clock: Clock) -> Connected:
    with as_command_error(DriverError):
        return connect(machine, clock)


def _drives(machine: Machine) -> str:
    """Return which parts of the machine are real and which are simulated, for the operator."""
    if not played(machine):
        return machine.backend.upper()
    return "SIMULATED AXES · REAL SPINDLE" if has_inverter(machine) else "SIMULATED"
