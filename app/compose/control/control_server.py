"""Server in the control process, with executor, watchdog, recorder and connected screen.

The executor never waits for the screen. A new snapshot replaces a snapshot that was not sent yet. Events
and notes wait in order until a screen receives them.
"""

from __future__ import annotations

import gc
import logging
import os
import queue
import threading
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from multiprocessing.connection import Connection
from pathlib import Path
from socket import AF_UNIX, SHUT_RDWR, SOCK_STREAM, fromfd
from uuid import uuid4

from app.compose.backends.connection import connect_machine
from app.compose.control.control_messages import (
    KEY_EXPIRY_S,
    PROTOCOL_VERSION,
    SCREEN_CONNECTED,
    CloseRequest,
    CommandMessage,
    ControlFailedMessage,
    EventStoredMessage,
    HelloMessage,
    InputChange,
    ScreenAliveMessage,
    StationAction,
    StopSocketMessage,
)
from app.compose.control.descriptor_passing import (
    SharedMemory,
    handle_stop_keys,
    receive_descriptor,
    send_descriptor,
)
from app.compose.control.process_rights_check import READING_PRIORITY, ProcessRight
from app.compose.control.screen_outbox import NOT_SAVED, ScreenOutbox
from app.compose.control.unattended_notes import (
    UnconfirmedEvent,
    UnconfirmedEvents,
    delete_interruption_note,
    save_interruption_note,
    save_unconfirmed_events,
)
from app.compose.optional_features import extras
from app.desk.stop_keys.stop_records import StopKeyPress, StopKind
from core.closing_steps import ClosingStep, run_steps_in_order
from core.executor.commands import (
    MOTION_COMMAND_TYPES,
    ChangeOffsets,
    Command,
    DeselectHandwheel,
    FeedHold,
    LoadJob,
    PrepareCycleStart,
    PreventNextPart,
    Reset,
    StopJog,
    StopSpindle,
)
from core.executor.executor import Executor
from core.executor.raised_alarm import ErrorCatcher, ErrorReporter
from core.executor.safety.watchdog import WATCHDOG_THREAD_NAME, ExecutorThread, Watchdog
from core.executor.scope_recorder import ScopeRecorder, list_recorded_signals
from core.executor.snapshot import (
    ACTIVE_STATES,
    STOPPED_STATES,
    InterruptedJob,
    LogEvent,
    MachineState,
    TickData,
)
from core.interpreter.dialects import SharedProgram
from core.machine.machine_model import Machine
from core.message import Message
from core.ports import DriverError
from core.store.store_rows import EventOrigin, EventRow, format_utc
from drivers.process_rights import lower_thread_priority
from drivers.silence import CONTROL_SCREEN_TIMEOUT_S
from drivers.wakeups import RealClock

_log = logging.getLogger(__name__)
CHECK_INTERVAL_S = 0.1  # s between two checks of the screen
# checks without a message after which the screen is treated as hung
SILENT_CHECK_COUNT = round(CONTROL_SCREEN_TIMEOUT_S / CHECK_INTERVAL_S)
REST_CHECK_COUNT = 150  # checks without a screen after which a machine at rest is closed (15 s)
STOPPED_CHECK_COUNT = 600  # the same for a stopped program (60 s)
_STARTING_ACTIONS = frozenset({"press_left", "press_right"})
_MOVING_STATES = frozenset({MachineState.RUN, MachineState.WAIT, MachineState.JOG, MachineState.HOMING})
_STOPPING_ACTIONS = frozenset({"press_hold", "press_estop"})
JOIN_TIMEOUT_S = 1.0  # s that closing waits for the last messages to the screen
EXECUTOR_TIMEOUT_S = 12.0  # s, for drives that are switching on; then the machine is halted
_STOP_COMMANDS = (
    FeedHold | StopJog | Reset | StopSpindle | DeselectHandwheel
)  # stop commands, which overtake other commands
_NO_SCREEN_TEXT = Message("TurnDesk, because the screen did not respond")


class ControlServer:
    """Server for the control of one machine, with the connection to its screen.

    ``folder`` is the data folder, in which the scope writes its records. ``lock_descriptor`` is the
    descriptor of a file that a driver host does not close before it ends. Raises DriverError if the machine
    cannot be connected.
    """

    def __init__(
        self,
        machine: Machine,
        clock: RealClock,
        folder: Path,
        rights: tuple[ProcessRight, ...],
        lock_descriptor: int | None = None,
    ) -> None:
        self._machine, self._clock, self._folder, self._rights = machine, clock, folder, rights
        self._identity = uuid4().hex  # of this control, for the numbers of its events
        self._connected = connect_machine(machine, clock, lock_descriptor)
        recorded = list_recorded_signals(machine, self._connected.ports)
        self._memory = SharedMemory.create(recorded.size_bytes)
        self.recorder = ScopeRecorder(recorded, folder / "records", memory=self._memory.memory_view)
        self.outbox = ScreenOutbox(lambda: self.executor.snapshot)
        self.executor = Executor(
            machine,
            self._connected.ports,
            self._hear,
            store_interruption=self._note,
            record_tick=self._tell,
            checks_starts=machine.kind == "lathe",
        )
        self.executor.on_change_at_rest = self.outbox.request_changed_snapshot
        self._thread = ExecutorThread(self.executor, clock)
        self._watchdog = Watchdog(
            self._thread,
            self.executor.halt_function,
            list_watched_thread_names(),
            self.outbox.report_thread_end,
        )
        self._noted: InterruptedJob | None = None
        self._reading: SharedProgram | None = None
        self._screen: Connection | None = None
        self._served = threading.Lock()  # locked while a screen is connected
        self._sender: threading.Thread | None = None
        # numbers of checks since the last message of the screen and since its disconnection
        self._quiet = self._away = 0
        self._met = False  # whether this screen has sent Alive; before that it is opening its window
        self._alone = False  # the screen has disconnected or hangs
        self._barred = ""  # reason why the next part was locked before the screen was lost
        self._saved: object = NOT_SAVED  # the note stored in the data folder
        self._posts: queue.SimpleQueue[CommandMessage] = queue.SimpleQueue()
        self._stopped_at = -1.0  # s, time of the last stop request
        self.closing_event = threading.Event()

    def start(self) -> None:
        """Start the executor, the recorder and the watchdog."""
        self._thread.start()
        threading.Thread(target=self._post_commands, name="commands", daemon=True).start()
        self.recorder.start()
        self._watchdog.start()

    def close(self) -> None:
        """Stop the machine as an emergency stop does, and close its drivers."""
        run_steps_in_order(
            (
                ClosingStep("watchdog", self._watchdog.stop_checks),
                ClosingStep("executor", self._thread.close, EXECUTOR_TIMEOUT_S),
                ClosingStep("drivers", self._connected.close),
                ClosingStep("watchdog", self._watchdog.close),
                ClosingStep("recorder", self.recorder.close),
            )
        )
        self.outbox.report_machine_closed()
        if self._sender is not None:
            self._sender.join(JOIN_TIMEOUT_S)
        run_steps_in_order([ClosingStep("events", self._save_events)])

    def _save_events(self) -> None:
        """Save the events that no screen has stored, so that the next start can read them."""
        left = self.outbox.unconfirmed_events if self._screen is None else []
        if left:
            began = datetime.now(UTC) - timedelta(seconds=self._clock.now())
            events = tuple(
                UnconfirmedEvent(
                    _row(each.event, began),
                    EventOrigin(self._identity, each.event_number),
                    each.production_rows,
                )
                for each in left
            )
            save_unconfirmed_events(self._folder, UnconfirmedEvents(self.executor.snapshot.program, events))

    # --- Executor thread ------------------------------------------------------------------------------

    def _hear(self, event: LogEvent) -> None:
        self.outbox.add_event(self.recorder.add_record_name(event))

    def _note(self, job: InterruptedJob | None) -> None:
        self._noted = job
        self.outbox.set_interrupted_job(job)

    def _tell(self, tick: TickData) -> None:
        self.recorder.queue_tick(tick)
        self.outbox.request_snapshot()

    # --- Screen ---------------------------------------------------------------------------------------

    def serve_screen(self, connection: Connection) -> None:
        """Serve one screen until its connection ends, and then close the connection.

        A second screen is rejected.
        """
        with connection:
            if not self._served.acquire(
                timeout=JOIN_TIMEOUT_S
            ):  # a screen that was just killed may still be connected
                with suppress(OSError):
                    connection.send(ControlFailedMessage(SCREEN_CONNECTED))
                return
            try:
                if not self.closing_event.is_set():
                    self._talk(connection)
            finally:
                self._served.release()

    def _talk(self, connection: Connection) -> None:
        gone = threading.Event()
        sender = threading.Thread(
            target=self._send, args=(connection, gone), name="control-sender", daemon=True
        )
        with ErrorCatcher() as talk:
            connection.send(self._hello())
            send_descriptor(connection, self._memory.descriptor)
            self._quiet, self._met, self._screen = 0, False, connection
            delete_interruption_note(self._folder)
            self._saved = NOT_SAVED  # if the screen disconnects before it has stored the note
            sender.start()
            self._sender = sender
            while True:
                message = connection.recv()
                with ErrorReporter(_not_obeyed):
                    self._obey(message)
        # otherwise ``check_screen_response`` reacts as the machine file specifies
        if not isinstance(talk.error, OSError | EOFError):
            _log.error("the screen has sent what is no message; it is disconnected", exc_info=talk.error)
        self._screen = None
        gone.set()
        if sender.is_alive():
            with fromfd(connection.fileno(), AF_UNIX, SOCK_STREAM) as sock, suppress(OSError):
                sock.shutdown(SHUT_RDWR)  # the sender may be blocked by a screen that does not read
            sender.join()
        self._release_station()

    def _send(self, connection: Connection, gone: threading.Event) -> None:
        with suppress(OSError):
            self.outbox.send_messages(connection, gone)

    def _hello(self) -> HelloMessage:
        connected, recorder = self._connected, self.recorder
        return HelloMessage(
            PROTOCOL_VERSION,
            os.getpid(),
            self._identity,
            self._machine,
            self._clock.origin_s,
            tuple(connected.ports.warnings),
            self._rights,
            recorder.ring.layout,
            recorder.storage_error,
            connected.on_screen_station is not None,
            connected.set_input is not None,
            self.executor.snapshot,
            self._noted,
        )

    def _obey(self, message: object) -> None:
        match message:
            case CommandMessage(command, at) if isinstance(command, _STOP_COMMANDS):
                self._stopped_at = max(self._stopped_at, at)
                self.executor.post(command, at)
            case CommandMessage(command):
                if isinstance(command, PreventNextPart):
                    self._barred = command.why
                self._posts.put(message)
            case StationAction():
                self._use_hand(message)
            case InputChange(name, on):
                self._set_input(name, on)
            case StopSocketMessage() if self._screen is not None:
                handle_stop_keys(receive_descriptor(self._screen), self._stop)
            case EventStoredMessage(number):
                self.outbox.confirm_events(number)
            case ScreenAliveMessage():
                # only this message counts, because the screen's other threads run even while it hangs
                self._quiet, self._met = 0, True
            case CloseRequest():
                self.closing_event.set()
            case _:
                _log.error("the control does not know this message of the screen: %r", message)

    def _stop(self, stop: StopKeyPress) -> None:
        """Execute a stop key. The method is called in the thread of the key's socket."""
        self._stopped_at = max(self._stopped_at, self._clock.now())
        panel = self._connected.on_screen_station
        if stop.stop_kind is StopKind.ESTOP and panel is not None:
            panel.press_estop()
        else:
            self.executor.post(FeedHold(stop.stop_kind.source_text, stop.press_number))

    def _post_commands(self) -> None:
        """Send commands to the executor in order.

        This method runs in a separate thread, because reading a program takes time. A stop takes precedence
        over waiting commands. Commands that start a motion and were sent earlier than the stop are dropped.
        With a real-time policy, the thread has the lowest priority, so that reading never delays a tick by
        a time slice.
        """
        lower_thread_priority(READING_PRIORITY)
        while not self.closing_event.is_set():
            command, at = self._posts.get()
            if not (isinstance(command, MOTION_COMMAND_TYPES) and at <= self._stopped_at):
                with ErrorReporter(self.executor.handle_failure):
                    self.executor.post(self._attach_reading(command), at)

    def _use_hand(self, hand: StationAction) -> None:
        if hand.name in _STOPPING_ACTIONS:
            self._stopped_at = max(self._stopped_at, hand.action_time_s)
        late = self._clock.now() - hand.action_time_s > KEY_EXPIRY_S
        if self._connected.on_screen_station is None or (late and hand.name in _STARTING_ACTIONS):
            return
        getattr(self._connected.on_screen_station, hand.name)(*hand.arguments)

    def _release_station(self) -> None:
        """Release the buttons that the screen has pressed. An emergency stop remains pressed."""
        if self._connected.on_screen_station is not None:
            for release in ("release_left", "release_right", "release_hold"):
                getattr(self._connected.on_screen_station, release)()

    def _set_input(self, name: str, on: bool) -> None:
        if self._connected.set_input is not None:
            with suppress(DriverError):
                self._connected.set_input(name, on)

    def _attach_reading(self, command: Command) -> Command:
        """Return the command with the result of reading its program.

        The executor's thread does not have enough time to read a program.
        """
        if not isinstance(command, LoadJob | ChangeOffsets | PrepareCycleStart) or command.job is None:
            return command
        job = command.job
        if job.setup.begin is not None and job.setup.begin.is_mdi_line:
            return command
        if self._reading is None or not self._reading.has_same_source(job.shared_program):
            job.shared_program.parse_text()
            self._reading = job.shared_program
            gc.collect(1)
            gc.freeze()  # scanning a long program for reference cycles would delay the executor's thread
        return replace(command, job=replace(job, shared_program=self._reading))

    # --- Screen that is silent or disconnected --------------------------------------------------------

    def check_screen_response(self) -> None:
        """Check whether the screen responds.

        The watchdog calls this method every ``CHECK_INTERVAL_S`` seconds.

        Without a screen, a cut continues or stops as the machine file specifies.
        """
        self._quiet += 1
        self._away = 0 if self._screen is not None else self._away + 1
        silent = self._quiet >= SILENT_CHECK_COUNT if self._met else self._alone
        alone = self._away > 0 or silent
        if alone is not self._alone:
            self._alone = alone
            self._run_without_screen() if alone else self._go_together()
        if self._away and self._noted is not self._saved:
            self._save_note()
        state = self.executor.snapshot.state
        if alone and state in _MOVING_STATES and not self._machine.hardware.continues_without_screen:
            self.executor.post(
                FeedHold(_NO_SCREEN_TEXT)
            )  # also if the machine's own buttons have started the motion
        longest = STOPPED_CHECK_COUNT if state in STOPPED_STATES else REST_CHECK_COUNT
        if self._away >= longest and state not in ACTIVE_STATES:
            self.closing_event.set()

    def _run_without_screen(self) -> None:
        """Block the start of the next part if the machine continues without a screen.

        The lost screen no longer counts parts or sends stop keys.
        """
        self._saved = NOT_SAVED
        if self._machine.hardware.continues_without_screen:
            self.executor.post(PreventNextPart(_NO_SCREEN_TEXT))

    def _go_together(self) -> None:
        if self._machine.hardware.continues_without_screen:
            self.executor.post(PreventNextPart(self._barred))

    def _save_note(self) -> None:
        self._saved = noted = self._noted
        save_interruption_note(self._folder, noted)
        if self._screen is not None:  # a screen has connected since and has the note
            delete_interruption_note(self._folder)


def _row(event: LogEvent, began: datetime) -> EventRow:
    """Return the event as a row of the event log."""
    at = format_utc(began + timedelta(seconds=event.time_s))
    return EventRow(at, event.kind, event.text, event.line_number, event.record_name)


def list_watched_thread_names() -> tuple[str, ...]:
    """Return the names of the threads in this process whose unexpected end is reported to the operator."""
    return (
        "commands",
        "recorder",
        "inverter",
        WATCHDOG_THREAD_NAME,
        *(n for e in extras().values() for n in e.supervised_threads),
    )


def _not_obeyed(error: BaseException) -> None:
    _log.error("a message of the screen was not obeyed: %s", error)
