"""The desk of the operator screen: machine, simulated lathe, executor thread, loading, folders."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.backends.backend_entry import NO_PRIORITY, Connected, has_inverter, played
from app.compose.backends.connection import connect
from app.compose.control.control_begin import begin_control
from app.compose.control.control_client import ControlClient
from app.compose.control.control_events import ControlEvents
from app.compose.control.control_start import StartedControl
from app.compose.desk_functions import furnish, give_production, give_scope, keep_status
from app.compose.extra import drawing_endings, extras
from app.compose.machine.accepted_machine import file_changes, guarded
from app.compose.machine.kinematics_chain import kinematics_of
from app.compose.machine.machine_setup import read_machine, remember_machine
from app.compose.runs.error_log import Log
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import Offsets, book_of, shapes_at_hand, stored_offsets
from app.compose.workshop import (
    drawer,
    give_mdi,
    give_part,
    give_searchto,
    part_comparer,
    samples,
    thumbnails,
    workshop,
)
from app.desk.command_errors import as_command_error
from app.desk.daily_backup import DailyBackup
from app.desk.data_folder import BACKUPS, RECORDS, data_folder
from app.desk.desk import Desk
from app.desk.kept_part import kept_part
from app.desk.persistence import Persistence
from app.desk.programs.program_folder import ProgramFile, ProgramFolders
from app.desk.programs.program_loading import LoadingSteps, ProgramLoader
from app.desk.programs.start_watch import StartWatch
from app.desk.station_hands import StationPanel
from app.desk.status.alarm_log import KEPT, KINDS
from app.desk.status.busy_notice import BusyNotice
from app.desk.status.prompt_line import UNDER_WAY
from app.desk.translation import tr
from app.offsets.mill_touch import MillTouch
from app.offsets.offset_effect import Effect
from core.access.access_table import Act
from core.closing import ClosingStep
from core.executor.commands import Command, LeftInterrupted
from core.executor.executor import Executor
from core.executor.recorder import Recorder, recorded_of
from core.executor.safety.watchdog import WATCHDOG, ExecutorThread, ThreadWatch, Watchdog
from core.executor.snapshot import Event, InterruptedJob, Snapshot
from core.interpreter.shared.modal_state import Modal
from core.language.source import Dialect, usual_ending
from core.machine.desk_tables import BackupTable
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import Clock, DriverError
from core.records.recordings import Recordings
from core.store.backup import problems as backup_problems
from core.store.store_errors import StoreError
from core.store.store_rows import EventRow
from drivers.waiting import RealClock

if TYPE_CHECKING:
    from app.compose.control.control_begin import Begun
    from app.editor.editor import Editor

# Threads beside the executor, and what an operator misses when they end.
SUPERVISED = {
    "store-writer": "STORAGE OF OFFSETS AND COUNTS",
    "daily-backup": "DAILY BACKUP",
    "status": "STATUS.JSON",
    "program-file": "PROGRAM FILE MONITOR",
    "inverter": "INVERTER CONNECTION",
    "recorder": "SCOPE RECORDER",
    WATCHDOG: "CONTROL WATCHDOG",
    "commands": "OPERATION OF THE CONTROL",
    **{name: what for extra in extras().values() for name, what in extra.threads.items()},
}
CONTROL_CLOSES = 30.0  # s: as the executor and its drivers, and then the process is killed
EXECUTOR_CLOSES = 12.0  # s: drives that come on are waited for, then the machine is halted
STORE_CLOSES = 15.0  # s: a slow disk takes what waits in memory
_OFTEN = (700, 10, 10)  # Python's usual: a collection stops every thread, so many short ones
GIVE_WAY = 0.001  # seconds after which a worker that proves or draws lets the screen and the executor go on


def build_desk(
    machine_file: str | None = None,
    offsets: Callable[[], Offsets] = stored_offsets,
    begun: Begun | None = None,
) -> Desk:
    """The desk on the machine that a file describes, its control running. Close it with ``Desk.close``.

    ``begun`` is what ``begin_control`` has returned for this file; None: it begins now. Raises CommandError
    for a bad machine file and for a machine that does not answer.
    """
    sys.setswitchinterval(GIVE_WAY)
    machine, control = begun or begin_control(machine_file)
    journal, log = Journal.at_home(goes_on=isinstance(control, ControlClient)), Log()
    try:
        remember_machine(machine_file, journal)
        if control is None:
            desk = _desk_on_thread(machine, offsets, journal)
        else:
            desk = _desk_on_process(machine, offsets, journal, control)
    except BaseException:
        if isinstance(control, StartedControl):
            control.abandon()
        journal.close()
        log.close()
        raise
    floor = _shop_floor(desk, journal)
    file = ProgramFile(lambda: desk.session.now)
    desk.closing.workers += [
        ClosingStep("program-file", file.close),
        *(ClosingStep(f"shop-floor-{number}", close) for number, close in enumerate(floor, 1)),
    ]
    desk.closing.ends += [
        ClosingStep("store", partial(_close_store, journal), STORE_CLOSES),
        ClosingStep("log", log.close),
    ]
    desk.differs, desk.saved_here = (lambda: file.differs), file.hurry
    desk.not_kept, desk.waiting = (lambda: journal.trouble or log.trouble), (lambda: journal.held)
    gc.freeze()  # modules and the like: collections need not look at them again
    gc.set_threshold(*_OFTEN)
    file.start()
    return desk


def _desk_on_thread(machine: Machine, offsets: Callable[[], Offsets], journal: Journal) -> Desk:
    """The desk with its control on a thread of this process."""
    clock = RealClock()
    desk, executor, recorder = _desk_and_parts(machine, offsets, clock, journal, data_folder() / RECORDS)
    thread = ExecutorThread(executor, clock)
    watchdog = Watchdog(thread, executor.halt, SUPERVISED, partial(_thread_ended, desk, journal))
    desk.closing.stops += [
        ClosingStep("watchdog", watchdog.end),  # what ends from now on ends in good order
        ClosingStep("executor", thread.close, EXECUTOR_CLOSES),
    ]
    desk.closing.workers += [
        ClosingStep("watchdog", watchdog.close),
        ClosingStep("recorder", recorder.close),
    ]
    executor.stirs = lambda: desk.stirs()  # noqa: PLW0108  the window gives it later
    thread.start()
    recorder.start()
    watchdog.start()
    return desk


def _desk_on_process(
    machine: Machine,
    offsets: Callable[[], Offsets],
    journal: Journal,
    control: ControlClient | StartedControl,
) -> Desk:
    """The desk with its control in a process of its own."""
    left = None
    if isinstance(control, ControlClient):
        client = control
        journal.note(client.hello.noted)
        journal.go_on(client.snapshot)
    else:
        with as_command_error(DriverError):
            client = ControlClient(control, data_folder())
        left = journal.left
        if left is not None:
            client.post(LeftInterrupted(left, logged=journal.left_is_logged))
    events = _Events(client.clock, journal)
    used = DeskControl(
        client.post,
        lambda: client.snapshot,
        client.hands,
        client.set_input if client.hello.inputs else None,
        client.hello.warnings,
        client.records,
    )
    desk = _desk_of(machine, used, events, offsets)
    for right in client.hello.rights:
        words = Message("control process: {name}: {granted}", name=right.name, granted=right.granted)
        events.say("rights", right.missing or words)
    threads = ThreadWatch(SUPERVISED, partial(_thread_ended, desk, journal))
    desk.closing.stops += [
        ClosingStep("threads", threads.end),  # what ends from now on ends in good order
        ClosingStep("control", client.close, CONTROL_CLOSES),
    ]
    desk.frame_watchers.append(client.see)
    desk.open_stop_line = client.open_stop_line
    client.begin(
        ControlEvents(
            events.hear,
            journal.note,
            partial(_thread_ended, desk, journal),
            lambda: desk.stirs(),  # noqa: PLW0108  the window gives it later
        )
    )
    if left is not None:
        client.wait_for(lambda snapshot: snapshot.interrupted is not None)  # it is loaded then
    threads.start()
    return desk


def _close_store(journal: Journal) -> None:
    """Write what waits, and report what is lost."""
    lost = journal.close()
    if lost:
        sys.stderr.write(f"turndesk: not kept, and lost by closing: {lost}; {journal.trouble}\n")


def _thread_ended(desk: Desk, journal: Journal, name: str) -> None:
    """On the watchdog's thread: the machine goes on, but what that thread did is not done any more."""
    text = tr(Message("{what} STOPPED. SAVE THE LOG, THEN RESTART TURNDESK", what=tr(SUPERVISED[name])))
    desk.say(text)
    journal.hear(Event(desk.snapshot().t, "warning", text))


def _shop_floor(desk: Desk, journal: Journal) -> list[Callable[[], None]]:
    """Start the status file, the daily backup, and what reports to the shop floor or to other desks.

    What prevents it goes to the prompt line and to the log. A folder that another TurnDesk has, as its store
    tells, has that one's status. Returns what closes them.
    """

    def tell(why: str) -> None:
        desk.say(tr(Message("NO SHOP-FLOOR DATA: {why}", why=why)))
        journal.hear(Event(desk.snapshot().t, "warning", why))

    assert desk.lathe is not None
    open_ones = list[Callable[[], None]]()
    if not journal.trouble or journal.waiting:
        open_ones.append(keep_status(desk.lathe, desk.snapshot, data_folder()))
        open_ones.append(_daily_backup(desk, desk.lathe, journal))
    started = [extra.start(desk, journal, tell) for extra in extras().values()]
    open_ones += [close for close in started if close is not None]
    return open_ones


def _daily_backup(desk: Desk, machine: Machine, journal: Journal) -> Callable[[], None]:
    """Begin to look once in a while whether one is due; what is in the way is said and logged."""

    def tell(why: str) -> None:
        text = tr(Message("NO DAILY BACKUP: {why}", why=why))
        desk.say(text)
        journal.hear(Event(desk.snapshot().t, "warning", text))

    def still() -> bool:
        return desk.snapshot().state not in UNDER_WAY

    def same_disk() -> None:
        text = tr(
            "DAILY BACKUPS: {folder} IS ON THE SAME DISK AS THE DATA. CHECK THAT THE BACKUP DISK IS MOUNTED"
        )
        journal.hear(Event(desk.snapshot().t, "warning", tr(Message(text, folder=folder))))

    table = machine.hardware.table(BackupTable) or BackupTable()
    folder = Path(table.folder) if table.folder else data_folder() / BACKUPS
    daily = DailyBackup(folder, table.keep, journal.backup, backup_problems, still, tell)
    if table.folder:
        daily.apart, daily.hint = data_folder(), same_disk
    daily.start()
    return daily.close


def desk_and_executor(
    machine_file: str | None,
    offsets: Callable[[], Offsets],
    clock: Clock,
    journal: Journal | None = None,
    records: Path | None = None,
) -> tuple[Desk, Executor]:
    """Both, with nobody ticking the executor yet; what happens goes to the journal, where there is one.

    The scope's record goes to the folder ``records``; None: it is kept in memory alone.
    """
    machine = read_machine(machine_file)
    if journal is not None:
        remember_machine(machine_file, journal)
    return _desk_and_parts(machine, offsets, clock, journal, records)[:2]


def _desk_and_parts(
    machine: Machine,
    offsets: Callable[[], Offsets],
    clock: Clock,
    journal: Journal | None,
    records: Path | None,
) -> tuple[Desk, Executor, Recorder]:
    connected = _connected(machine, clock)
    recorder = Recorder(recorded_of(machine, connected.ports), records)
    events = _Events(clock, journal, recorder.note)
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
    desk = _desk_of(machine, control, events, offsets)
    desk.closing.shut = connected.close
    return desk, executor, recorder


def _desk_of(machine: Machine, control: DeskControl, events: _Events, offsets: Callable[[], Offsets]) -> Desk:
    """The desk, and what it has to say at its start."""
    journal = events.journal
    desk = _desk(machine, control, events, offsets)
    events.desk, desk.recorder = desk, control.recordings
    desk.frame_watchers.append(BusyNotice(desk.say).see)
    give_scope(desk)
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
    if control.recordings.trouble:
        events.say("warning", control.recordings.trouble)
    if any(each.startswith(NO_PRIORITY) for each in control.warnings):
        desk.say(tr("NO REAL-TIME PRIORITY: AXES STOP IF THE COMPUTER IS 10 MS LATE"))
    if desk.changes.barred:
        desk.say(desk.changes.barred)
    return desk


def _came_late(desk: Desk, journal: Journal) -> None:
    """By another thread: what was not known at the start because the store was away."""
    if journal.left is not None:
        desk.post(LeftInterrupted(journal.left))
    _tell_damage(desk, journal, lambda text: journal.hear(Event(desk.snapshot().t, "warning", text)))


def _tell_damage(desk: Desk, journal: Journal, log: Callable[[str], None]) -> None:
    """What was not as it was saved goes to the log and to the prompt line."""
    for damage in journal.damage:
        log(damage)
        desk.say(tr(Message("CHECK: {what}", what=damage)))


@dataclass(frozen=True, slots=True)
class DeskControl:
    """The control as the desk uses it, whether it runs in this process or in one of its own.

    ``panel`` is the operator station on the screen, None where the machine has its own. ``set_input``
    switches an input of a simulated machine.
    """

    post: Callable[[Command], None]
    snapshot: Callable[[], Snapshot]
    panel: StationPanel | None
    set_input: Callable[[str, bool], None] | None
    warnings: Sequence[str]
    recordings: Recordings


class _Events:
    """What happens is heard by the desk, once there is one, and by the journal, where there is one."""

    def __init__(
        self, clock: Clock, journal: Journal | None, record: Callable[[Event], Event] = lambda event: event
    ) -> None:
        self.journal, self._record = journal, record
        self.desk: Desk | None = None
        self._clock = clock

    def hear(self, event: Event) -> None:
        event = self._record(event)
        if self.desk is not None:
            self.desk.hear(event)
        if self.journal is not None:
            self.journal.hear(event)

    def say(self, kind: str, text: str) -> None:
        """An event of this moment."""
        self.hear(Event(self._clock.now(), kind, text))


def _desk(
    machine: Machine,
    control: DeskControl,
    events: _Events,
    offsets: Callable[[], Offsets],
) -> Desk:
    """The desk with all its pages."""
    journal, say = events.journal, events.say
    keep = journal or Persistence()

    def left() -> Modal:
        return control.snapshot().modal

    kept = partial(kept_part, keep.read_setting)
    changed = file_changes(machine, keep, partial(say, "machine"))
    desk = Desk(
        post=guarded(control.post, changed, partial(say, "refused")),
        snapshot=control.snapshot,
        session=ProgramLoader(
            workshop(machine, offsets, journal, left=left, shapes=shapes_at_hand, kept=kept),
            control.post,
        ),
        program_folders=ProgramFolders((data_folder() / "programs", samples()), drawing_endings()),
        station=control.panel,
        two_hand=machine.interlocks.two_hand_start,
        with_c=machine.c_enabled,
        lathe=machine,
        set_input=control.set_input,
        one_hand=played(machine) and not has_inverter(machine),
        machine=Message("{machine} · {machine2}", machine=machine.name, machine2=_drives(machine)),
        changes=changed,
        book=book_of(offsets, journal),
    )
    if machine.kind == "lathe":
        desk.first_move = StartWatch(desk.post)
        desk.attach(desk.first_move)
    desk.attach(Effect(drawer(machine), part_comparer(machine, shapes_at_hand, kept)))
    beside = workshop(machine, offsets, left=left, shapes=shapes_at_hand, kept=kept)
    desk.attach_later("app.editor.editor.Editor", partial(_editor, desk, beside, journal, machine))
    small = thumbnails(machine, shapes_at_hand, kept)
    furnish(desk, machine, keep, workshop(machine, offsets, left=left), thumbnail=small)
    give_mdi(desk, machine, offsets, keep)
    if machine.kind == "mill":
        desk.attach(MillTouch(desk, kinematics_of(machine)))
    give_part(desk, machine, keep)
    give_searchto(desk, machine)
    give_production(desk, machine, journal)
    alone = workshop(machine, offsets, left=left, pictures=False)
    for extra in extras().values():
        extra.attach(desk, machine, journal, alone)
    return desk


def _stops(journal: Journal) -> Sequence[EventRow]:
    """Alarms and stops of the days before; without a store nobody knows of any."""
    try:
        return journal.events("", KINDS, KEPT)
    except StoreError:
        return ()


def _kept_nowhere(_what: InterruptedJob | None) -> None:
    """A desk without a store remembers nothing."""


def _connected(machine: Machine, clock: Clock) -> Connected:
    with as_command_error(DriverError):
        return connect(machine, clock)


def _drives(machine: Machine) -> str:
    """What an operator must never be in doubt about: what of it is real."""
    if not played(machine):
        return machine.backend.upper()
    return "SIMULATED AXES · REAL SPINDLE" if has_inverter(machine) else "SIMULATED"


def _editor(desk: Desk, work: LoadingSteps, journal: Journal | None, machine: Machine) -> Editor:
    """The editor proves what is being typed without keeping a version of every key."""
    from app.editor.editor import Editor
    from app.editor.versions import NoArchive

    ending = usual_ending(Dialect(machine.language))
    editor = Editor(work, journal or NoArchive(), data_folder() / "programs", samples(), usual_ending=ending)
    editor.may_save = lambda: desk.access.refusal(Act.PROGRAMS)
    return editor
