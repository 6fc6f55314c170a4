"""Main loop of the control: it processes commands, queues setpoints and publishes snapshots.

In each tick the executor reads the inputs, makes all decisions and publishes a snapshot (at most twenty per
second). After 1 s without a change, it runs only ten ticks per second, provided that the drivers can wake
it.
"""

from __future__ import annotations

import logging
import math
import queue
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

from core.executor.command_handler import CommandHandler
from core.executor.commands import BLOCKING_COMMANDS, MOTION_COMMAND_TYPES, Command
from core.executor.interruption_watch import StoreFunction
from core.executor.job import Job, ProgramPass, start_program_pass
from core.executor.machine_context import MachineContext
from core.executor.machine_control import MachineControl
from core.executor.raised_alarm import (
    AlarmError,
    ErrorCatcher,
    ErrorReporter,
    format_log_line,
    log_alarm,
    make_alarm,
)
from core.executor.signal_lamps import SignalLamps
from core.executor.snapshot import (
    ACTIVE_STATES,
    CYCLE_STATES,
    InterruptedJob,
    LogEvent,
    MachineState,
    Snapshot,
    TickData,
)
from core.executor.snapshot_publisher import SnapshotPublisher
from core.executor.spindle_control import SpindleControl
from core.executor.start_conditions import is_guard_open
from core.executor.station_signals import CommandedOutputs, StationSignalConverter
from core.faults import TrippedError
from core.interpreter.shared.job_setup import InterpreterSetup
from core.machine.machine_model import Machine
from core.message import Message
from core.motion.axis_limits import MotionError
from core.ports import DriverError, MachinePorts, UnknownPart

_REST_STATES = frozenset({MachineState.ESTOP, MachineState.DISABLED, MachineState.IDLE, MachineState.FAULT})
_SETTLED_TICKS = 100  # ticks without a change, after which the machine counts as settled
_SNAPSHOT_INTERVAL_S = 0.045  # s between snapshots of a settled machine: slightly less than five ticks
REST_TICK_S = 0.095  # s between ticks at rest, in which a CANopen host also sends its SYNC messages
_log = logging.getLogger(__name__)
TICK_PAUSE_S = 0.01  # s from the end of one tick to the start of the next
_ESTOP_ALARM_CODES = frozenset({"power-lost", "spindle-off"})  # alarms that the E-stop chain causes
_STALL_INTERVAL_S = 0.2  # s between two ticks that show a stalled computer
_STALE_PRESS_S = 0.5  # age in s from which a key press must not start motion or enable the drives
_LOGGED_OVERRIDE_CHANGE = 0.1  # smallest change of the feed override that is logged
_MAX_COMMANDS_PER_TICK = 100  # commands handled in one tick at most
_POWERED_STATES = CYCLE_STATES | {MachineState.IDLE, MachineState.JOG, MachineState.HOMING}


class RestDetector:
    """Detector of a machine at rest, so that the executor can reduce its tick rate."""

    def __init__(self, context: MachineContext, control: MachineControl) -> None:
        self._context, self._control = context, control
        self._wakeup = context.ports.wakeup
        self._seen: tuple[object, ...] = ()  # the values seen in the last tick, without the time
        self._same = 0  # ticks since any of these values changed
        self._shown_at = -1.0
        self._rested = False
        self.changed_at_rest = False  # a value changed in the last tick although the machine is at rest

    def restore_tick_rate(self) -> None:
        """Restore the normal tick rate for at least 1 s because a command or a change arrived."""
        self._same = -1

    def detect_machine_change(self) -> bool:
        """Compare the machine with the previous tick; return whether a new snapshot is needed.

        Making a snapshot takes most of the time of a tick, so skipping it saves time.
        """
        context, status = self._context, self._control.status
        seen: tuple[object, ...] = ()
        with (
            ErrorCatcher() as look
        ):  # The code that needs the missing value reports a driver that fails here.
            seen = (
                status.state,
                context.axis_sample[1:],
                context.inputs,
                context.station_signals,
                context.ports.io.get_outputs(),
                context.spindle.measured_rpm,
                context.spindle.commanded_rpm,
                status.alarms,
                context.stop,
                status.job,
                context.unknown_parts,
            )
        broken = look.error is not None
        changed = broken or self._same < 0 or status.state not in _REST_STATES or seen != self._seen
        resting = status.state in _REST_STATES
        self.changed_at_rest, self._rested = changed and (resting or self._rested), resting
        self._same = 0 if changed else self._same + 1
        self._seen = seen
        shown = self._same < _SETTLED_TICKS or context.now - self._shown_at > _SNAPSHOT_INTERVAL_S
        self._shown_at = context.now if shown else self._shown_at
        return shown

    def wait_for_wakeup(self) -> bool:
        """Wait until a driver wakes the executor, for at most 0.095 s; return whether it waited.

        If the machine is not at rest or its drivers cannot wake the executor, return False at once.
        """
        wakeup = self._wakeup
        if wakeup is None or not self._is_safe_at_rest() or not wakeup.can_rely_on_wakeups():
            return False
        if wakeup.wait_for_wakeup(REST_TICK_S):
            self.restore_tick_rate()
        return True

    @property
    def is_at_rest(self) -> bool:
        """Return whether no value has changed for 1 s."""
        return self._same >= _SETTLED_TICKS

    def _is_safe_at_rest(self) -> bool:
        """Return whether the spindle is stopped and every output is in its E-stop state."""
        if not self.is_at_rest or self._control.handwheel.axis:
            return False
        context = self._context
        outputs, models = context.ports.io.get_outputs(), context.machine.outputs
        lamps = context.machine.lamp_outputs
        safe = all(
            name in lamps or model.safe_state in {None, outputs.get(name)} for name, model in models.items()
        )
        return safe and not context.spindle.commanded_rpm and not context.spindle.measured_rpm


def _ignore_interruption(_what: InterruptedJob | None) -> None:
    """Do nothing. An executor without a store for the interrupted job uses this function."""


def _css_function(ports: MachinePorts) -> Callable[[float], None]:
    """Return the function that announces the highest CSS spindle speed before each speed command."""
    return ports.blocks.announce_css_max_rpm if ports.blocks is not None else lambda _: None


class Executor:
    """The main loop of the control.

    - ``post`` and ``snapshot`` can be used from any thread, but ``run_tick`` from only one thread.
    - ``start_pass`` starts a pass through a job; tests supply their own function.
    - ``store_interruption`` receives the job that a power loss would interrupt.
    - ``interrupted_job`` is the job that was interrupted when the previous process ended.
    - If ``checks_starts`` is True, a cycle needs a clearance of its first move from a worker.
    - ``record_tick`` receives the scope data of each tick and must return immediately.
    """

    def __init__(
        self,
        machine: Machine,
        ports: MachinePorts,
        on_event: Callable[[LogEvent], None],
        start_pass: Callable[[Job, InterpreterSetup], ProgramPass] = start_program_pass,
        store_interruption: StoreFunction = _ignore_interruption,
        interrupted_job: InterruptedJob | None = None,
        record_tick: Callable[[TickData], None] | None = None,
        *,
        checks_starts: bool = False,
    ) -> None:
        self._commands: queue.SimpleQueue[tuple[float, Command]] = queue.SimpleQueue()
        self._ports = ports
        self._tell = record_tick
        self._due = ports.clock.now()  # when the next tick is expected
        self._missed = False  # a failure of the scope has been logged
        self._late = 0.0  # s, the longest delay since the scope last received data
        spindle = SpindleControl(
            ports.spindle,
            machine.spindle,
            ports.lock,
            _css_function(ports),
            ports.orientation,
            ports.spindle_lag,
        )
        outputs = CommandedOutputs(ports.io, machine.outputs)
        self._context = MachineContext(
            machine,
            replace(ports, io=outputs),
            on_event,
            spindle,
            ports.clock.now(),
            ports.axes.sample(),
            dict(ports.io.inputs()),
            outputs,
        )
        self._station = StationSignalConverter()
        self._control = MachineControl(self._context, start_pass, store_interruption, interrupted_job)
        self._control.status.requires_start_clearance = checks_starts
        self._handler = CommandHandler(self._context, self._control, self._station)
        self._lamps = SignalLamps(self._context, ports.io)
        self._publisher = SnapshotPublisher()
        self._rest = RestDetector(self._context, self._control)
        self.on_change_at_rest: Callable[[], None] = lambda: (
            None
        )  # called on the executor's thread when a machine at rest has changed
        self._logged_override = 1.0
        self._lost = ""  # the fault of the station connection in the previous tick
        self._told_lost = ""
        self.tick_count = 0  # number of finished ticks, which the watchdog checks
        self.is_waiting_for_drive = False  # the executor waits for drives, which may take seconds
        self._silent = ""  # why the watchdog has halted the machine
        self.snapshot: Snapshot = self._publish()

    @property
    def halt_function(self) -> Callable[[], None] | None:
        """Return the drivers' function that stops the machine from any thread, or None if there is none."""
        return self._ports.halt_machine

    def post(self, command: Command, posted_at: float | None = None) -> None:
        """Post a command for the next tick, without waiting.

        ``posted_at`` is the time of the request on the machine's clock, in seconds, or None for the current
        time.
        """
        self._commands.put((self._ports.clock.now() if posted_at is None else posted_at, command))
        self.start_next_tick()

    def start_next_tick(self) -> None:
        """Start the next tick at once, without waiting for its time; any thread may call this.

        The call has no effect if the drivers cannot wake the executor.
        """
        if self._ports.wakeup is not None:
            self._ports.wakeup.request_poll()

    def wait_at_rest(self) -> bool:
        """Wait between two ticks while the machine is at rest, until a command or a change arrives.

        Return whether the executor waited; return False at once if the machine is not at rest. The function
        must be called on the executor's thread.
        """
        with ErrorReporter(self.handle_failure):
            if self._commands.empty() and self._rest.wait_for_wakeup():
                self._due = self._context.now + REST_TICK_S
                return True
        return False

    def run_tick(self) -> None:
        """Run one tick: read the inputs, execute commands, supervise, advance motion and publish.

        The function is called every 10 to 20 ms. It raises no exceptions; failures become alarms.
        """
        with ErrorReporter(self.handle_failure) as look:
            self._look()
        if look.error is not None:
            self._handle_failed_read()
        for part in (self._mind_watchdog, self._process_requests, self._supervise, self._go_on, self._turn):
            self._run_guarded(part)
        status = self._control.status
        self._lamps.update_lamps(
            self._control.state,
            self._control.counters.program_end_count,
            is_next_part_blocked=bool(status.next_part_inhibit_reason),
        )
        self._record_delay(self._context.now - self._due)
        self._due = self._context.now + TICK_PAUSE_S
        if self._rest.detect_machine_change():
            self._publish_snapshot()
            self._pass_to_recorder()
        if self._rest.changed_at_rest:
            with ErrorCatcher():
                self.on_change_at_rest()
        self.is_waiting_for_drive = False
        self.tick_count += 1

    def _record_delay(self, delay_s: float) -> None:
        """Record the delay of a tick in seconds.

        If the computer is busy, more setpoints are queued. Feed holds then take effect later, which is
        logged once.
        """
        self._late = max(self._late, delay_s)
        lateness = self._context.tick_lateness
        if lateness.record_tick(delay_s, self._context.now):
            words = "the computer is busy: a feed hold reacts up to {seconds} s later"
            self._context.log_text("late", Message(words, seconds=f"{lateness.hold_delay_s:.1f}"))

    def show_unresponsive_alarm(self, reason: str) -> None:
        """Show an alarm because the watchdog has halted the machine.

        The watchdog halts the machine if the executor does not respond, and calls this function on its own
        thread. If the executor ticks again, its first action is to raise this alarm.
        """
        self._silent = reason
        alarm = make_alarm("control-silent", reason, self._context.line_number, self.snapshot.t)
        log_alarm(alarm)
        shown = replace(self.snapshot, state=MachineState.FAULT, alarms=(*self.snapshot.alarms, alarm))
        self.snapshot = shown
        self._context.log_event(LogEvent(shown.t, "alarm", format_log_line(alarm), alarm.line, alarm))

    def _mind_watchdog(self) -> None:
        if self._silent:
            why, self._silent = self._silent, ""
            raise AlarmError("control-silent", why)

    def handle_failure(self, error: BaseException) -> None:
        """Raise an alarm for a driver error or for an internal error of the control."""
        if isinstance(error, DriverError):
            self._control.raise_alarm(AlarmError(error.code, str(error)))
        else:
            self._control.handle_internal_error(error)

    def shut_down(self) -> None:
        """Stop all motion and switch everything off when the executor ends.

        The function raises no exceptions.
        """
        with ErrorReporter(self.handle_failure):
            self._control.shut_down()
        self._publish_snapshot()

    def _publish_snapshot(self) -> None:
        """Publish a snapshot; if the machine cannot be read, update only the state and the alarms."""
        with ErrorReporter(self.handle_failure) as publishing:
            self.snapshot = self._publish()
        if publishing.error is not None:
            status = self._control.status
            self.snapshot = replace(
                self.snapshot, t=self._context.now, state=status.state, alarms=status.alarms
            )

    def _pass_to_recorder(self) -> None:
        """Pass the data of this tick to the scope.

        A failure is logged once and does not stop the tick.
        """
        if self._tell is None:
            return
        with ErrorCatcher() as trial:
            now, source = self._context.now, self._ports.samples
            late, self._late = self._late, 0.0
            samples = source.take_samples() if source is not None else None
            self._context.record_spindle_load(samples)
            queued = math.nan if source is not None else max(self._ports.axes.horizon() - now, 0.0)
            turns, rests = self._context.spindle.angle.latest_revolutions, self._rest.is_at_rest
            self._tell(TickData(self.snapshot, late, queued, turns, samples, rests))
        if trial.error is not None and not self._missed:
            self._missed = True  # Logged once, because the error may occur in every tick.
            _log.error("the scope misses what the machine does", exc_info=trial.error)

    def _handle_failed_read(self) -> None:
        """Discard the start signal after a failed read of the machine, but still react to the E-stop."""
        context = self._context
        context.station_signals = context.station_signals._replace(is_start_requested=False)
        with ErrorCatcher():
            context.station_signals = context.station_signals._replace(
                is_estop_pressed=self._ports.station.read_state().estop
            )

    def _look(self) -> None:
        context, before = self._context, self._context.now
        context.now = self._ports.clock.now()
        context.axis_sample = self._ports.axes.sample()
        context.inputs = dict(self._ports.io.inputs())
        context.commanded_outputs.set_write_time(context.now)
        context.spindle.is_guard_open = is_guard_open(context)
        context.unknown_parts = self._ports.unknown()
        context.spindle.is_speed_known = UnknownPart.SPINDLE not in context.unknown_parts
        context.spindle.read_encoder()
        context.station_signals = self._station.process_state(self._ports.station.read_state(), context.now)
        context.spindle.override, context.spindle.is_auto = (
            context.station_signals.spindle,
            context.station_signals.is_spindle_in_auto,
        )
        self._log_override()
        self._log_lost()
        if self._control.state in ACTIVE_STATES:
            self._control.counters.cycle_time_s += context.now - before
            self._control.program_run.add_cutting_time(context.now - before)
            if context.now - before > _STALL_INTERVAL_S:
                context.log_text(
                    "starved",
                    Message(
                        "the control software did not run for {now} s", now=f"{context.now - before:.2f}"
                    ),
                )
                if self._control.cycle is not None:  # before a key pressed during the stall stops the cycle
                    self._control.cycle.update_current_block()

    def _log_lost(self) -> None:
        """Log when the connection to the pendant is lost and when it is restored."""
        lost = (
            self._context.station_signals.connection_lost_reason
            or self._context.station_signals.handwheel_fault
        )
        if lost != self._told_lost:
            self._told_lost = lost
            self._context.log_text("disturbed", (lost or "the pendant is connected again").upper())

    def _log_override(self) -> None:
        """Log the feed override when it changes by 10 % or more, and when it reaches or leaves zero."""
        fraction = self._context.feed_override
        if abs(fraction - self._logged_override) >= _LOGGED_OVERRIDE_CHANGE or (fraction == 0.0) != (
            self._logged_override == 0.0
        ):
            self._logged_override = fraction
            self._context.log_text(
                "override", Message("feed override {fraction} %", fraction=f"{100 * fraction:.0f}")
            )

    def _process_requests(self) -> None:
        """Handle the E-stop, then the posted commands, then the buttons of the operator station."""
        signals, control = self._context.station_signals, self._control
        control.handle_estop(signals.is_estop_pressed)
        for command in self._posted():
            self.is_waiting_for_drive = self.is_waiting_for_drive or isinstance(command, BLOCKING_COMMANDS)
            self._run_guarded(partial(self._handler.execute_command, command))
        if signals.is_hold_requested:
            control.start_feed_hold("", "the feed hold button on the operator station")
        elif signals.station_fault:
            control.start_feed_hold(signals.station_fault)
        elif signals.connection_lost_reason and (
            control.state in ACTIVE_STATES or signals.connection_lost_reason != self._lost
        ):
            control.start_feed_hold(signals.connection_lost_reason, code="pendant")
        elif self._context.spindle.is_guard_open and control.state in ACTIVE_STATES:
            control.start_feed_hold("GUARD OPEN")  # The machine builder limits jogging with an open guard.
        if signals.is_start_requested:
            control.handle_cycle_start()
        elif signals.was_late_start_detected:
            self._context.log_text("refused", "the CycleStart command arrived too late and was ignored")
        if signals.was_spindle_switch_turned_on:
            control.handle_spindle_switch()
        control.move_by_handwheel()
        self._lost = signals.connection_lost_reason

    def _posted(self) -> Iterator[Command]:
        for _ in range(_MAX_COMMANDS_PER_TICK):
            try:
                posted, command = self._commands.get_nowait()
            except queue.Empty:
                return
            self._rest.restore_tick_rate()  # show the effect of the command at once
            if isinstance(command, MOTION_COMMAND_TYPES) and self._context.now - posted > _STALE_PRESS_S:
                self._context.log_text(
                    "refused",
                    Message(
                        "the {name} command arrived too late and was ignored",
                        name=type(command).__name__,
                    ),
                )
            else:
                yield command

    def _supervise(self) -> None:
        self._control.outputs_watch.check_outputs()
        self._control.supervisor.check_machine(self._control.state)
        if self._control.state in _POWERED_STATES and not self._context.axis_sample.enabled:
            raise AlarmError("power-lost")

    def _go_on(self) -> None:
        self._control.advance_one_tick()

    def _turn(self) -> None:
        cycle = self._control.cycle
        block = cycle.current_block if cycle else None
        offset = block.offset_x if block else self._control.modal_state.offset_x
        self._context.spindle.update(self._context.now, self._context.axis_sample.demand[0] - offset)

    def _run_guarded(self, part: Callable[[], None]) -> None:
        """Run one part of a tick and convert its errors to alarms, so that the other parts still run."""
        with ErrorReporter(self.handle_failure):
            try:
                part()
            except AlarmError as alarm_error:
                self._raise_alarm(alarm_error)
            except MotionError as error:
                self._control.raise_alarm(AlarmError("program", str(error)))
            except TrippedError:
                pass  # The driver host has switched something off; the next tick reports the details.
            except DriverError as error:
                self._raise_alarm(AlarmError(error.code, str(error)))

    def _raise_alarm(self, error: AlarmError) -> None:
        """Raise an alarm, or handle the E-stop if the E-stop has caused the alarm."""
        if error.code in _ESTOP_ALARM_CODES and self._ports.station.read_state().estop:
            self._control.handle_estop(True)
        else:
            self._control.raise_alarm(error)

    def _publish(self) -> Snapshot:
        return self._publisher.make_snapshot(self._context, self._control)
