"""The control process that the screen uses, which is replaced after it ends or hangs."""

from __future__ import annotations

import logging
import subprocess
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from socket import AF_UNIX, SOCK_SEQPACKET, socket, socketpair

from app.compose.backends.backend_entry import NO_PRIORITY_TEXT, is_simulated
from app.compose.control.control_client import (
    ControlClient,
    ControlEventHandlers,
    RemoteStationControls,
)
from app.compose.control.control_start import StartedControl, start_control
from app.compose.control.posted_state import PostedState
from app.compose.control.process_rights_check import has_real_time_priority, make_rights_events
from app.desk.translation import tr
from core.executor.commands import Command, Reset
from core.executor.raised_alarm import ErrorReporter
from core.executor.snapshot import InterruptedJob, LogEvent, Snapshot
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError
from drivers.silence import SCREEN_CONTROL_TIMEOUT_S

_log = logging.getLogger(__name__)
END_TIMEOUT_S = 3.0  # s for a control that can still close its drivers in order
KILL_TIMEOUT_S = 5.0  # s between SIGKILL and the end of the process
_LOOK = 0.1  # =
ShowText = Callable[[str], None]


class LiveControl:
    """The control process of the screen. ``restart`` replaces it after it ends or hangs.

    A machine never has two controls at the same time. A new control starts only after the old process has
    ended, and then waits for the end of the old driver host (``control_slot.py``). Methods can be called
    from any thread. Only ``close`` waits.
    """

    def __init__(self, client: ControlClient, machine: Machine, folder: Path) -> None:
        self._client, self._machine, self._folder = client, machine, folder
        self._state = PostedState(client.hello_message.interrupted_job)
        self.hands = (
            RemoteStationControls(self.operate_station)
            if client.hello_message.has_on_screen_station
            else None
        )
        self._line: socket | None = None  # end of the control of the stop keys' socket
        self._lock = threading.Lock()  # locked briefly while the client is replaced
        self._worker: threading.Thread | None = None
        self._started: StartedControl | None = None  # a new control that has not responded yet
        self._closing = threading.Event()
        self._events: ControlEventHandlers | None = None
        self._say: ShowText = _log.info

    @property
    def snapshot(self) -> Snapshot:
        """Return the newest snapshot of the machine."""
        return self._client.snapshot

    @property
    def client(self) -> ControlClient:
        """Return the connection to the current control."""
        return self._client

    def start_threads(self, handlers: ControlEventHandlers, show_text: ShowText) -> None:
        """Start the threads that receive and send messages of the control, and report its rights.

        ``show_text`` shows the operator the progress of a restart, and missing real-time priority.
        """
        self._events = replace(handlers, on_interrupted_job=self._note)
        self._noted, self._say = handlers.on_interrupted_job, show_text
        self._report_rights(self._events)
        self._client.start_threads(self._events)

    def post_command(self, command: Command) -> None:
        """Send a command to the control. Reset starts a new control if the current control has ended."""
        if isinstance(command, Reset) and self._client.is_lost:
            self.restart()
            return
        with self._lock:
            self._state.record_command(command)
            self._client.post_command(command)

    def operate_station(self, name: str, *values: object) -> None:
        """Call the method ``name`` of the simulated operator station with these values."""
        with self._lock:
            self._state.record_station_action(name, values)
            self._client.operate_station(name, *values)

    def set_input(self, name: str, is_on: bool) -> None:
        """Set an input of a simulated machine on or off."""
        self._client.set_input(name, is_on)

    def report_screen_alive(self, snapshot: Snapshot) -> None:
        """Report to the control that the screen is processing its keys.

        The screen calls this method once per frame.
        """
        self._client.report_screen_alive(snapshot)

    def open_stop_socket(self) -> socket | None:
        """Return a socket that sends stop keys directly to the current control, bypassing this process."""
        ours, theirs = socketpair(AF_UNIX, SOCK_SEQPACKET)
        with self._lock:
            if self._line is not None:
                self._line.close()
            self._line = theirs
            self._client.send_stop_socket(theirs.dup())
        return ours

    def close(self) -> None:
        """Stop the machine, close its drivers, and wait until the control process ends."""
        self._closing.set()
        worker = self._worker
        if worker is not None:
            worker.join(SCREEN_CONTROL_TIMEOUT_S + END_TIMEOUT_S + KILL_TIMEOUT_S)
            self._kill_started_control(worker)
        self._client.stop_and_close()
        if self._line is not None:
            self._line.close()

    def _kill_started_control(self, worker: threading.Thread) -> None:
        """Kill a new control that has not responded yet, so that its ``worker`` ends.

        The control has received no command, so it has not moved the machine.
        """
        with self._lock:
            process = self._started.process if self._started is not None else None
            if process is not None:
                process.kill()
        worker.join(KILL_TIMEOUT_S)

    # --- replacement --------------------------------------------------------------------------------------

    def restart(self) -> None:
        """Replace a control that has ended or is silent with a new control, in a separate thread.

        If a restart is already in progress, this call has no effect.
        """
        with self._lock:
            if not self._closing.is_set() and not self.is_restarting:
                self._worker = threading.Thread(target=self._restart, name="control-restart", daemon=True)
                self._worker.start()

    @property
    def is_restarting(self) -> bool:
        """Return whether a restart is in progress."""
        return self._worker is not None and self._worker.is_alive()

    def _restart(self) -> None:
        old = self._client
        with ErrorReporter(self._failed):
            if (old.is_lost or self._is_silent(old)) and self._has_ended(old):
                self._start(old)

    def _is_silent(self, client: ControlClient) -> bool:
        """Return whether the control remains silent and can no longer move the machine.

        The method waits for this state. It returns False if the control responds again, or if the screen
        closes.
        """
        self._say(tr("CONTROL HANGS: IT IS ENDED AFTER 5 S. PRESS E-STOP"))
        last_response_at = client.heard_at
        while client.silence_duration_s < SCREEN_CONTROL_TIMEOUT_S and not client.is_lost:
            if client.heard_at != last_response_at:
                self._say(tr("THE CONTROL RESPONDS AGAIN. IT WAS NOT RESTARTED"))
                return False
            if self._closing.wait(_LOOK):
                return False
        return True

    def _has_ended(self, client: ControlClient) -> bool:
        """Ask the control process to end, kill it if necessary, and return whether it has ended."""
        client.request_close()
        ended = client.handle.wait_for_end(END_TIMEOUT_S) or client.handle.kill_process(KILL_TIMEOUT_S)
        if ended and client.control_process is not None:
            with suppress(subprocess.TimeoutExpired):
                client.control_process.wait(KILL_TIMEOUT_S)
        if not ended:
            self._say(tr("THE CONTROL CANNOT BE ENDED. RESTART THE COMPUTER"))
        return ended

    def _start(self, old: ControlClient) -> None:
        assert self._events is not None
        if self._closing.is_set():
            return
        self._say(tr("THE CONTROL IS STARTING AGAIN"))
        started = start_control(self._machine, self._folder, old.clock.origin_s)
        with self._lock:
            self._started = started
        try:
            new = ControlClient(started, self._folder, old.control_records)
        except DriverError:
            with self._lock:
                self._started = None
            started.kill_process()
            if self._closing.is_set():
                return
            raise
        with self._lock:
            self._pass_state(new, old.snapshot)
            self._client, self._started = new, None
        old.close_connection()
        new.start_threads(self._events)
        self._events.on_event(
            LogEvent(new.clock.now(), "warning", Message("the control was started again")), None
        )
        self._report_rights(self._events)
        self._say(tr("THE CONTROL HAS STARTED AGAIN. CHECK TOOL, PART AND POSITION"))
        self._events.on_rest_state_change()

    def _report_rights(self, handlers: ControlEventHandlers) -> None:
        """Log the rights of the control, and show that real-time priority is missing on a real machine.

        The drivers may already have reported that the axes stop without this priority.
        """
        hello, simulated = self._client.hello_message, is_simulated(self._machine)
        for event in make_rights_events(
            hello.process_rights, self._client.clock.now(), is_simulated=simulated
        ):
            handlers.on_event(event, None)
        is_reported = any(each.startswith(NO_PRIORITY_TEXT) for each in hello.warnings)
        if not simulated and not is_reported and not has_real_time_priority(hello.process_rights):
            self._say(tr("NO REAL-TIME PRIORITY: A BUSY COMPUTER DELAYS THE CONTROL. SEE F7"))

    def _pass_state(self, new: ControlClient, last: Snapshot) -> None:
        """Send the loaded program and the operator's values, as shown on the screen, to a new control."""
        for name, values in self._state.list_restore_station_actions():
            new.operate_station(name, *values)
        for command in self._state.list_restore_commands(last):
            new.post_command(command)
        if self._line is not None:
            new.send_stop_socket(self._line.dup())

    def _note(self, job: InterruptedJob | None) -> None:
        self._state.interrupted_job = job
        self._noted(job)

    def _failed(self, error: BaseException) -> None:
        _log.error("the control was not started again", exc_info=error)
        why = error.fault if isinstance(error, DriverError) else str(error)
        self._say(tr(Message("CONTROL NOT STARTED: {why}. R: TRY AGAIN", why=why)))
