"""The executor: processes commands, queues setpoints and publishes one snapshot per tick.

Inputs are read and all decisions are made in every tick. After 1 s without a change, ticks come ten times per
second if the drivers can wake the executor, and at most twenty snapshots per second are made.
"""

from __future__ import annotations

import logging
import math
import queue
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

from core.executor.command_handler import CommandHandler
from core.executor.commands import (
    Command,
    CycleStart,
    DriveTest,
    EnableDrives,
    Home,
    Jog,
    JogStep,
    Reset,
    Touch,
    Wheel,
)
from core.executor.interruption_watch import Note
from core.executor.job import Job, ProgramPass, interpret
from core.executor.machine_context import MachineContext
from core.executor.machine_control import MachineControl
from core.executor.raised_alarm import AlarmError, Attempt, ReportedAttempt, log_alarm, log_line, make_alarm
from core.executor.signal_lamps import SignalLamps
from core.executor.signals import CommandedOutputs, StationWatch
from core.executor.snapshot import ACTIVE, CYCLE, Event, InterruptedJob, Snapshot, State, Tick
from core.executor.snapshot_publisher import Publisher
from core.executor.spindle_control import SpindleControl
from core.executor.start_conditions import guard_open
from core.faults import TrippedError
from core.interpreter.shared.job_setup import Setup
from core.machine.machine_model import Machine
from core.message import Message
from core.motion.axis_limits import MotionError
from core.ports import DriverError, MachinePorts, Unknown

_RESTING = frozenset({State.ESTOP, State.DISABLED, State.IDLE, State.FAULT})
_SETTLED = 100  # ticks without a change, after which the machine counts as settled
# s between two snapshots of a settled machine: five ticks, slightly less because their length varies
_SHOWN = 0.045
# s between two ticks at rest; a CANopen host sends its ten SYNC messages per second with these ticks
RESTS = 0.095
_log = logging.getLogger(__name__)
TICK = 0.01  # s from the end of one tick to the start of the next
_OFF_BY_ESTOP = frozenset({"power-lost", "spindle-off"})  # alarms that the E-stop chain causes
_STALL = 0.2  # s between two ticks that show a stalled computer
_STALE = 0.5  # s after which a key press must not start a motion
STARTS = (CycleStart, DriveTest, EnableDrives, Home, Jog, JogStep, Touch, Wheel)
"""Commands that begin a motion, or switch the drives on."""
_WAITED_FOR = (EnableDrives, Home, Reset)  # a driver returns from these only when its drives have obeyed
_WORTH_AN_ENTRY = 0.1  # smallest change of the feed override that is logged
_COMMANDS = 100  # commands handled in one tick at most
_POWERED = CYCLE | {State.IDLE, State.JOG, State.HOME}


class Rest:
    """Detects that nothing changes, so that the executor can tick less often. Used on its thread only."""

    def __init__(self, context: MachineContext, control: MachineControl) -> None:
        self._context, self._control = context, control
        self._wakeup = context.ports.wakeup
        self._seen: tuple[object, ...] = ()  # the values seen in the last tick, without the time
        self._same = 0  # ticks since any of these values changed
        self._shown_at = -1.0
        self._rested = False
        self.stirred = False  # a value changed in the last tick although the machine is at rest

    def over(self) -> None:
        """Return to the normal tick rate for at least 1 s because a command or a change arrived."""
        self._same = -1

    def look(self) -> bool:
        """Compare the machine with the last tick and return whether a new snapshot is needed.

        Making a snapshot is the largest part of the cost of a tick.
        """
        context, status = self._context, self._control.status
        seen: tuple[object, ...] = ()
        with Attempt() as look:  # The code that needs the missing value reports a driver that fails here.
            seen = (
                status.state,
                context.sample[1:],
                context.inputs,
                context.signals,
                context.ports.io.outputs(),
                context.spindle.measured,
                context.spindle.command,
                status.alarms,
                context.stop,
                status.job,
                context.unknown,
            )
        broken = look.error is not None
        changed = broken or self._same < 0 or status.state not in _RESTING or seen != self._seen
        resting = status.state in _RESTING
        self.stirred, self._rested = changed and (resting or self._rested), resting
        self._same = 0 if changed else self._same + 1
        self._seen = seen
        shown = self._same < _SETTLED or context.now - self._shown_at > _SHOWN
        self._shown_at = context.now if shown else self._shown_at
        return shown

    def wait(self) -> bool:
        """Wait until a driver wakes the executor, at most 0.095 s.

        Returns False at once if the machine is not at rest or its drivers cannot wake the executor.
        """
        wakeup = self._wakeup
        if wakeup is None or not self._lasts() or not wakeup.settled():
            return False
        if wakeup.wait(RESTS):
            self.over()
        return True

    @property
    def holds(self) -> bool:
        """True if nothing has changed for 1 s."""
        return self._same >= _SETTLED

    def _lasts(self) -> bool:
        """Return whether the spindle is stopped and every output is in its E-stop state."""
        if not self.holds or self._control.wheel.axis:
            return False
        context = self._context
        outputs, models = context.ports.io.outputs(), context.machine.outputs
        lamps = context.machine.lamps
        safe = all(name in lamps or model.safe in {None, outputs.get(name)} for name, model in models.items())
        return safe and not context.spindle.command and not context.spindle.measured


def _discard(_what: InterruptedJob | None) -> None:
    """Ignore an interrupted job because nothing is stored after the executor ends."""


def _lay_out(ports: MachinePorts) -> Callable[[float], None]:
    """Return the function that receives the highest spindle speed before each speed command."""
    return ports.blocks.lay_out if ports.blocks is not None else lambda _: None


class Executor:
    """The main loop of the control.

    ``post`` and ``snapshot`` may be used from any thread, ``tick`` from one thread only. ``passes`` starts a
    pass through a job; tests supply their own. ``note`` receives the job that a power loss would leave
    interrupted, and ``left`` is the job that the previous process left interrupted. With ``checks_starts``, a
    cycle starts only after a worker has posted the clearance for its first move. ``tell`` receives the data
    that the scope records in each tick and must return at once.
    """

    def __init__(
        self,
        machine: Machine,
        ports: MachinePorts,
        on_event: Callable[[Event], None],
        passes: Callable[[Job, Setup], ProgramPass] = interpret,
        note: Note = _discard,
        left: InterruptedJob | None = None,
        tell: Callable[[Tick], None] | None = None,
        *,
        checks_starts: bool = False,
    ) -> None:
        self._commands: queue.SimpleQueue[tuple[float, Command]] = queue.SimpleQueue()
        self._ports = ports
        self._tell = tell
        self._due = ports.clock.now()  # when the next tick is expected
        self._missed = False  # a failure of the scope has been logged
        self._late = 0.0  # s, the longest delay since the scope last received data
        spindle = SpindleControl(
            ports.spindle, machine.spindle, ports.lock, _lay_out(ports), ports.orientation, ports.spindle_lag
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
        self._station = StationWatch()
        self._control = MachineControl(self._context, passes, note, left)
        self._control.status.checks_starts = checks_starts
        self._handler = CommandHandler(self._context, self._control, self._station)
        self._lamps = SignalLamps(self._context, ports.io)
        self._publisher = Publisher()
        self._rest = Rest(self._context, self._control)
        self.stirs: Callable[[], None] = lambda: (
            None
        )  # called on the executor's thread when a machine at rest has changed
        self._logged_override = 1.0
        self._lost = ""  # the fault of the station connection in the previous tick
        self._told_lost = ""
        self.ticks = 0  # number of finished ticks, which the watchdog checks
        self.patient = False  # the executor waits for drives, which may take seconds
        self._silent = ""  # why the watchdog has halted the machine
        self.snapshot: Snapshot = self._publish()

    @property
    def halt(self) -> Callable[[], None] | None:
        """The drivers' function that stops the machine from any thread, or None."""
        return self._ports.halt

    def post(self, command: Command, at: float | None = None) -> None:
        """Post a command for the next tick, without waiting.

        ``at`` is the time of the request in seconds of the machine's clock; None means now.
        """
        self._commands.put((self._ports.clock.now() if at is None else at, command))
        self.wake()

    def wake(self) -> None:
        """Start the next tick at once, from any thread.

        Has no effect if the drivers cannot wake the executor.
        """
        if self._ports.wakeup is not None:
            self._ports.wakeup.ring()

    def rest(self) -> bool:
        """Wait between two ticks while the machine is at rest, until a command or a change arrives.

        Returns False at once if the machine is not at rest. Must be called on the executor's thread.
        """
        with ReportedAttempt(self.failed):
            if self._commands.empty() and self._rest.wait():
                self._due = self._context.now + RESTS
                return True
        return False

    def tick(self) -> None:
        """Run one tick, every 10 to 20 ms: read, execute commands, supervise, advance and publish.

        Raises nothing; failures become alarms.
        """
        with ReportedAttempt(self.failed) as look:
            self._look()
        if look.error is not None:
            self._blind()
        for part in (self._mind_watchdog, self._obey, self._supervise, self._go_on, self._turn):
            self._guarded(part)
        status = self._control.status
        self._lamps.look(self._control.state, self._control.counters.ends, barred=bool(status.next_barred))
        self._note_late(self._context.now - self._due)
        self._due = self._context.now + TICK
        if self._rest.look():
            self._show()
            self._hand_over()
        if self._rest.stirred:
            with Attempt():
                self.stirs()
        self.patient = False
        self.ticks += 1

    def _note_late(self, late: float) -> None:
        """Record by how many seconds the tick was late.

        A busy computer makes the setpoint queue longer. The longer delay of a feed hold is logged once.
        """
        self._late = max(self._late, late)
        lateness = self._context.lateness
        if lateness.look(late, self._context.now):
            words = "the computer is busy: a feed hold reacts up to {seconds} s later"
            self._context.log("late", Message(words, seconds=f"{lateness.hold_later:.1f}"))

    def declare_silent(self, why: str) -> None:
        """Show an alarm because the watchdog has found the executor unresponsive and halted the machine.

        Called on the watchdog's thread. If the executor ticks again, its first action is to raise this alarm.
        """
        self._silent = why
        alarm = make_alarm("control-silent", why, self._context.line, self.snapshot.t)
        log_alarm(alarm)
        shown = replace(self.snapshot, state=State.FAULT, alarms=(*self.snapshot.alarms, alarm))
        self.snapshot = shown
        self._context.log_event(Event(shown.t, "alarm", log_line(alarm), alarm.line, alarm))

    def _mind_watchdog(self) -> None:
        if self._silent:
            why, self._silent = self._silent, ""
            raise AlarmError("control-silent", why)

    def failed(self, error: BaseException) -> None:
        """Raise an alarm for a driver error or for an internal error of the control."""
        if isinstance(error, DriverError):
            self._control.alarm(AlarmError(error.code, str(error)))
        else:
            self._control.failed(error)

    def shut(self) -> None:
        """Stop all motion and switch everything off when the executor ends. Raises nothing."""
        with ReportedAttempt(self.failed):
            self._control.shut()
        self._show()

    def _show(self) -> None:
        """Publish a snapshot, or only the state and the alarms if the machine cannot be read."""
        with ReportedAttempt(self.failed) as publishing:
            self.snapshot = self._publish()
        if publishing.error is not None:
            status = self._control.status
            self.snapshot = replace(
                self.snapshot, t=self._context.now, state=status.state, alarms=status.alarms
            )

    def _hand_over(self) -> None:
        """Pass the data of this tick to the scope. A failure is logged once and stops nothing."""
        if self._tell is None:
            return
        with Attempt() as trial:
            now, source = self._context.now, self._ports.samples
            late, self._late = self._late, 0.0
            samples = source.take() if source is not None else None
            self._context.note_load(samples)
            queued = math.nan if source is not None else max(self._ports.axes.horizon() - now, 0.0)
            turns, rests = self._context.spindle.angle.turns, self._rest.holds
            self._tell(Tick(self.snapshot, late, queued, turns, samples, rests))
        if trial.error is not None and not self._missed:
            self._missed = True  # Logged once, because the error may occur in every tick.
            _log.error("the scope misses what the machine does", exc_info=trial.error)

    def _blind(self) -> None:
        """Handle a failed read: ignore the last start signal, but obey the E-stop."""
        context = self._context
        context.signals = context.signals._replace(start=False)
        with Attempt():
            context.signals = context.signals._replace(estop=self._ports.station.snapshot().estop)

    def _look(self) -> None:
        context, before = self._context, self._context.now
        context.now = self._ports.clock.now()
        context.sample = self._ports.axes.sample()
        context.inputs = dict(self._ports.io.inputs())
        context.outputs.look(context.now)
        context.spindle.guard_open = guard_open(context)
        context.unknown = self._ports.unknown()
        context.spindle.known = Unknown.SPINDLE not in context.unknown
        context.spindle.look()
        context.signals = self._station.read(self._ports.station.snapshot(), context.now)
        context.spindle.override, context.spindle.auto = context.signals.spindle, context.signals.auto
        self._log_override()
        self._log_lost()
        if self._control.state in ACTIVE:
            self._control.counters.cycle += context.now - before
            self._control.program_run.cut(context.now - before)
            if context.now - before > _STALL:
                context.log(
                    "starved",
                    Message(
                        "the control software did not run for {now} s", now=f"{context.now - before:.2f}"
                    ),
                )
                if self._control.cycle is not None:  # before a key pressed during the stall stops the cycle
                    self._control.cycle.catch_up()

    def _log_lost(self) -> None:
        """Log when the pendant is disconnected and when it is connected again."""
        lost = self._context.signals.lost or self._context.signals.wheel_trouble
        if lost != self._told_lost:
            self._told_lost = lost
            self._context.log("disturbed", (lost or "the pendant is connected again").upper())

    def _log_override(self) -> None:
        """Log the feed override when it changes by 10 % or reaches or leaves zero."""
        fraction = self._context.feed_override
        if abs(fraction - self._logged_override) >= _WORTH_AN_ENTRY or (fraction == 0.0) != (
            self._logged_override == 0.0
        ):
            self._logged_override = fraction
            self._context.log(
                "override", Message("feed override {fraction} %", fraction=f"{100 * fraction:.0f}")
            )

    def _obey(self) -> None:
        """Handle the E-stop, then the posted commands, then the buttons of the operator station."""
        signals, control = self._context.signals, self._control
        control.mirror_estop(signals.estop)
        for command in self._posted():
            self.patient = self.patient or isinstance(command, _WAITED_FOR)
            self._guarded(partial(self._handler.obey, command))
        if signals.hold:
            control.feed_hold("", "the feed hold button on the operator station")
        elif signals.trouble:
            control.feed_hold(signals.trouble)
        elif signals.lost and (control.state in ACTIVE or signals.lost != self._lost):
            control.feed_hold(signals.lost, code="pendant")
        elif self._context.spindle.guard_open and control.state in ACTIVE:
            control.feed_hold("GUARD OPEN")  # The machine builder limits jogging with an open guard.
        if signals.start:
            control.start()
        elif signals.late_start:
            self._context.log("refused", "the CycleStart command arrived too late and was ignored")
        if signals.turned_on:
            control.spindle_switch()
        control.follow_wheel()
        self._lost = signals.lost

    def _posted(self) -> Iterator[Command]:
        for _ in range(_COMMANDS):
            try:
                posted, command = self._commands.get_nowait()
            except queue.Empty:
                return
            self._rest.over()  # show the effect of the command at once
            if isinstance(command, STARTS) and self._context.now - posted > _STALE:
                self._context.log(
                    "refused",
                    Message(
                        "the {name} command arrived too late and was ignored",
                        name=type(command).__name__,
                    ),
                )
            else:
                yield command

    def _supervise(self) -> None:
        self._control.disturbance.look()
        self._control.supervisor.look(self._control.state)
        if self._control.state in _POWERED and not self._context.sample.enabled:
            raise AlarmError("power-lost")

    def _go_on(self) -> None:
        self._control.go_on()

    def _turn(self) -> None:
        cycle = self._control.cycle
        block = cycle.current if cycle else None
        offset = block.offset_x if block else self._control.modal.offset_x
        self._context.spindle.update(self._context.now, self._context.sample.demand[0] - offset)

    def _guarded(self, part: Callable[[], None]) -> None:
        """Run one part of a tick and turn its errors into alarms, so that the other parts still run."""
        with ReportedAttempt(self.failed):
            try:
                part()
            except AlarmError as trouble:
                self._alarm(trouble)
            except MotionError as error:
                self._control.alarm(AlarmError("program", str(error)))
            except TrippedError:
                pass  # The driver host has switched something off; the next tick reports the details.
            except DriverError as error:
                self._alarm(AlarmError(error.code, str(error)))

    def _alarm(self, trouble: AlarmError) -> None:
        """Raise an alarm, or follow the E-stop if it has caused the loss of power."""
        if trouble.code in _OFF_BY_ESTOP and self._ports.station.snapshot().estop:
            self._control.mirror_estop(True)
        else:
            self._control.alarm(trouble)

    def _publish(self) -> Snapshot:
        return self._publisher.snapshot(self._context, self._control)
