"""Assembly of the operator screen, with its control in a thread or in a separate process."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from app.compose.control.control_begin import begin_control
from app.compose.control.control_client import ControlClient, ControlEvents
from app.compose.control.control_start import StartedControl
from app.compose.control.live_control import LiveControl
from app.compose.desk_assembly import DeskEvents, desk_and_parts, desk_of
from app.compose.desk_services import SUPERVISED, report_ended_thread, start_services
from app.compose.machine.machine_setup import remember_machine
from app.compose.runs.error_log import Log
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import Offsets, stored_offsets
from app.desk.command_errors import as_command_error
from app.desk.data_folder import RECORDS, data_folder
from app.desk.desk import Desk
from app.desk.programs.program_folder import ProgramFile
from app.desk.state.desk_control import DeskControl
from core.closing import ClosingStep
from core.executor.commands import LeftInterrupted
from core.executor.safety.watchdog import ExecutorThread, ThreadWatch, Watchdog
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError
from drivers.waiting import RealClock

if TYPE_CHECKING:
    from app.compose.control.control_begin import Begun

CONTROL_CLOSES = 30.0  # s for the executor and its drivers; then the process is killed
EXECUTOR_CLOSES = 12.0  # s, for drives that are switching on; then the machine is halted
STORE_CLOSES = 15.0  # s to write waiting entries to a slow disk
# Python's usual thresholds: a collection stops every thread, so many short collections are better
_OFTEN = (700, 10, 10)
GIVE_WAY = 0.001  # s after which a worker that proves or draws yields to the screen and the executor


def build_desk(
    machine_file: str | None = None,
    offsets: Callable[[], Offsets] = stored_offsets,
    begun: Begun | None = None,
) -> Desk:
    """Return the operator screen's model for a machine file, with its control running.

    Close it with ``Desk.close``. ``begun`` is the result of ``begin_control`` for this file; None starts the
    control now. Raises CommandError for an invalid machine file, and if the machine does not respond.
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
    floor = start_services(desk, journal)
    file = ProgramFile(lambda: desk.session.now)
    desk.closing.workers += [
        ClosingStep("program-file", file.close),
        *(ClosingStep(f"shop-floor-{number}", close) for number, close in enumerate(floor, 1)),
    ]
    desk.closing.ends += [
        ClosingStep("store", partial(_close_store, journal), STORE_CLOSES),
        ClosingStep("log", log.close),
    ]
    desk.storage.follow_program(lambda: file.differs, file.hurry)
    desk.storage.follow_store(lambda: journal.trouble or log.trouble, lambda: journal.held)
    gc.freeze()  # modules and other permanent objects need not be scanned again
    gc.set_threshold(*_OFTEN)
    file.start()
    return desk


def _desk_on_thread(machine: Machine, offsets: Callable[[], Offsets], journal: Journal) -> Desk:
    """Return the screen model with its control in a thread of this process."""
    clock = RealClock()
    desk, executor, recorder = desk_and_parts(machine, offsets, clock, journal, data_folder() / RECORDS)
    thread = ExecutorThread(executor, clock)
    watchdog = Watchdog(thread, executor.halt, SUPERVISED, partial(report_ended_thread, desk, journal))
    desk.closing.stops += [
        ClosingStep("watchdog", watchdog.end),  # threads that end from now on end as intended
        ClosingStep("executor", thread.close, EXECUTOR_CLOSES),
    ]
    desk.closing.workers += [
        ClosingStep("watchdog", watchdog.close),
        ClosingStep("recorder", recorder.close),
    ]
    executor.stirs = desk.window.wake
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
    """Return the screen model with its control in a separate process."""
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
    live = LiveControl(client, machine, data_folder())
    events = DeskEvents(client.clock, journal)
    used = DeskControl(
        live.post,
        lambda: live.snapshot,
        live.hands,
        live.set_input if client.hello.inputs else None,
        client.hello.warnings,
        client.records,
        live.open_stop_line,
        live.restart,
        lambda: live.client.hello.identity,
    )
    desk = desk_of(machine, used, events, offsets)
    for right in client.hello.rights:
        words = Message("control process: {name}: {granted}", name=right.name, granted=right.granted)
        events.say("rights", right.missing or words)
    threads = ThreadWatch(SUPERVISED, partial(report_ended_thread, desk, journal))
    desk.closing.stops += [
        ClosingStep("threads", threads.end),  # threads that end from now on end as intended
        ClosingStep("control", live.close, CONTROL_CLOSES),
    ]
    desk.pages.add_frame_watcher(live.see)
    live.begin(
        ControlEvents(
            events.hear,
            journal.note,
            partial(report_ended_thread, desk, journal),
            desk.window.wake,
        ),
        desk.warn,
    )
    if left is not None:
        # the interrupted job is loaded then
        client.wait_for(lambda snapshot: snapshot.interrupted is not None)
    threads.start()
    return desk


def _close_store(journal: Journal) -> None:
    """Write waiting entries to the store, and report lost entries."""
    lost = journal.close()
    if lost:
        sys.stderr.write(f"turndesk: not kept, and lost by closing: {lost}; {journal.trouble}\n")
