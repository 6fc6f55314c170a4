"""Assembly of the operator screen, whose control runs in a thread or in a separate process."""

from __future__ import annotations

import gc
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from app.compose.control.control_attachment import find_or_start_control
from app.compose.control.control_client import ControlClient, ControlEventHandlers
from app.compose.control.control_start import StartedControl
from app.compose.control.live_control import LiveControl
from app.compose.desk_assembly import EventDistributor, create_control_parts, create_desk
from app.compose.desk_services import SUPERVISED_THREAD_TEXTS, DeskServices, report_ended_thread
from app.compose.machine.machine_setup import save_machine_in_use
from app.compose.runs.error_log import ErrorLog
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import Offsets, read_stored_offsets
from app.desk.command_errors import convert_to_command_error
from app.desk.data_folder import RECORDS_FOLDER_NAME, find_data_folder
from app.desk.desk import Desk
from app.desk.pages.attached_parts import ClosingSequence, ControlClosing
from app.desk.state.desk_control import DeskControl
from core.closing_steps import ClosingStep
from core.executor.commands import ReportInterruptedJob
from core.executor.safety.watchdog import ExecutorThread, ThreadMonitor, Watchdog
from core.machine.machine_model import Machine
from core.ports import DriverError
from drivers.wakeups import RealClock

if TYPE_CHECKING:
    from app.compose.control.control_attachment import MachineAndControl

CONTROL_TIMEOUT_S = 30.0  # s for the executor and its drivers; then the process is killed
EXECUTOR_TIMEOUT_S = 12.0  # s, for drives that are switching on; then the machine is halted
STORE_TIMEOUT_S = 15.0  # s to write waiting entries to a slow disk
# Python's usual thresholds: a collection stops every thread, so many short collections are better
_GC_THRESHOLDS = (700, 10, 10)
SWITCH_INTERVAL_S = 0.001  # s after which a worker that proves or draws yields to the screen and the executor


def build_desk(
    machine_file: str | None = None,
    read_offsets: Callable[[], Offsets] = read_stored_offsets,
    begun_control: MachineAndControl | None = None,
) -> Desk:
    """Return the operator screen's model for a machine file, and start its control.

    Close the model with ``Desk.close``. ``begun_control`` is the result of ``find_or_start_control`` for
    this file. If it is None, the control is started now. Raises CommandError if the machine file or the
    offsets file is invalid, if the machine does not respond, or if a running control cannot be used.
    """
    sys.setswitchinterval(SWITCH_INTERVAL_S)
    machine, control = begun_control or find_or_start_control(machine_file)
    journal, log = Journal.open_default(control_running=isinstance(control, ControlClient)), ErrorLog()
    services = DeskServices(journal)
    closing = ClosingSequence(
        list_service_steps=services.list_closing_steps,
        storage_steps=(
            ClosingStep("store", partial(_close_store, journal), STORE_TIMEOUT_S),
            ClosingStep("log", log.close),
        ),
    )
    try:
        save_machine_in_use(machine_file, journal)
        if control is None:
            desk = _create_threaded_desk(machine, read_offsets, journal, closing)
        else:
            desk = _create_process_desk(machine, read_offsets, journal, closing, control)
    except BaseException:
        if isinstance(control, StartedControl):
            control.kill_process()
        journal.close()
        log.close()
        raise
    services.start(desk)
    desk.storage_state.set_store_readers(lambda: journal.write_error or log.error_text, lambda: journal.held)
    gc.freeze()  # modules and other permanent objects need not be scanned again
    gc.set_threshold(*_GC_THRESHOLDS)
    return desk


def _create_threaded_desk(
    machine: Machine, offsets: Callable[[], Offsets], journal: Journal, closing: ClosingSequence
) -> Desk:
    """Return the screen model, with its control running in a thread of this process."""
    clock = RealClock()
    control, events, executor, recorder, close_drivers = create_control_parts(
        machine, clock, journal, find_data_folder() / RECORDS_FOLDER_NAME
    )
    thread = ExecutorThread(executor, clock)
    watchdog = Watchdog(
        thread,
        executor.halt_function,
        SUPERVISED_THREAD_TEXTS,
        partial(report_ended_thread, events.report_warning),
    )
    control_closing = ControlClosing(
        (
            ClosingStep("watchdog", watchdog.stop_checks),  # threads that end from now on end as intended
            ClosingStep("executor", thread.close, EXECUTOR_TIMEOUT_S),
        ),
        close_drivers,
        (ClosingStep("watchdog", watchdog.close), ClosingStep("recorder", recorder.close)),
    )
    desk = create_desk(machine, control, events, offsets, replace(closing, control=control_closing))
    executor.on_change_at_rest = desk.window_state.wake_window
    thread.start()
    recorder.start()
    watchdog.start()
    return desk


def _create_process_desk(
    machine: Machine,
    offsets: Callable[[], Offsets],
    journal: Journal,
    closing: ClosingSequence,
    control: ControlClient | StartedControl,
) -> Desk:
    """Return the screen model, with its control running in a separate process."""
    left = None
    if isinstance(control, ControlClient):
        client = control
        journal.note(client.hello_message.interrupted_job)
        journal.resume_recording(client.snapshot)
    else:
        with convert_to_command_error(DriverError):
            client = ControlClient(control, find_data_folder())
        left = journal.left
        if left is not None:
            client.post_command(ReportInterruptedJob(left, logged=journal.is_interruption_logged))
    live = LiveControl(client, machine, find_data_folder())
    events = EventDistributor(client.clock, journal)
    used = DeskControl(
        live.post_command,
        lambda: live.snapshot,
        live.hands,
        live.set_input if client.hello_message.can_switch_inputs else None,
        client.hello_message.warnings,
        client.control_records,
        live.open_stop_socket,
        live.restart,
        lambda: live.client.hello_message.control_identity,
        events.report_event,
    )
    threads = ThreadMonitor(SUPERVISED_THREAD_TEXTS, partial(report_ended_thread, events.report_warning))
    control_closing = ControlClosing(
        (
            ClosingStep("threads", threads.stop_reporting),  # threads that end from now on end as intended
            ClosingStep("control", live.close, CONTROL_TIMEOUT_S),
        )
    )
    desk = create_desk(machine, used, events, offsets, replace(closing, control=control_closing))
    desk.page_registry.add_frame_watcher(live.report_screen_alive)
    live.start_threads(
        ControlEventHandlers(
            events.hear,
            journal.note,
            partial(report_ended_thread, events.report_warning),
            desk.window_state.wake_window,
        ),
        desk.show_warning,
    )
    if left is not None:
        # the interrupted job is loaded then
        client.wait_for_snapshot(lambda snapshot: snapshot.interrupted is not None)
    threads.start()
    return desk


def _close_store(journal: Journal) -> None:
    """Write the waiting entries to the store, close the store, and report lost entries."""
    lost = journal.close()
    if lost:
        sys.stderr.write(f"turndesk: not kept, and lost by closing: {lost}; {journal.write_error}\n")
