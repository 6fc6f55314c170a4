"""The executor: commands in, setpoints out, one snapshot a tick; it looks less often at rest.

Everything is looked at and decided in every tick. Once nothing has happened for a second a tick comes ten
times a second, where the drivers ring by themselves, and the snapshot is made anew twenty times at most.
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
_SETTLED = 100  # ticks in which nothing has happened
_SHOWN = 0.045  # s between two snapshots then: five ticks, whose length is never quite the same
RESTS = 0.095  # s between two ticks of a machine at rest: a host sends its SYNC, ten a second, with the look
_log = logging.getLogger(__name__)
TICK = 0.01  # s from the end of one to the beginning of the next
_OFF_BY_ESTOP = frozenset({"power-lost", "spindle-off"})  # of what its chain switches off by itself
_STALL = 0.2  # s between two ticks that tell of a stalled host
_STALE = 0.5  # s after which nobody expects a press to move the machine any more
STARTS = (CycleStart, DriveTest, EnableDrives, Home, Jog, JogStep, Touch, Wheel)
"""Commands that begin a motion, or switch the drives on."""
_WAITED_FOR = (EnableDrives, Home, Reset)  # a driver answers them when its drives have obeyed
_WORTH_AN_ENTRY = 0.1  # change of the feed override that is worth an entry in the log
_COMMANDS = 100  # looked at in one tick
_POWERED = CYCLE | {State.IDLE, State.JOG, State.HOME}


class Rest:
    """Of one executor, on its thread alone."""

    def __init__(self, context: MachineContext, control: MachineControl) -> None:
        self._context, self._control = context, control
        self._wakeup = context.ports.wakeup
        self._seen: tuple[object, ...] = ()  # what the last tick has seen, but for the time
        self._same = 0  # ticks since anything of that has changed
        self._shown_at = -1.0
        self._rested = False
        self.stirred = False  # with the last tick something has changed on a machine at rest

    def over(self) -> None:
        """Something was asked for: for a second every tick counts."""
        self._same = -1

    def look(self) -> bool:
        """At the end of a tick: whether it is worth showing; a snapshot is most of what a tick costs."""
        context, status = self._context, self._control.status
        seen: tuple[object, ...] = ()
        with Attempt() as look:  # a driver that breaks here is told of by whoever needs what it does not say
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
        """Between two ticks: until something is asked for or has changed. False, and at once, where the
        machine is not at rest or its drivers do not ring.
        """
        wakeup = self._wakeup
        if wakeup is None or not self._lasts() or not wakeup.settled():
            return False
        if wakeup.wait(RESTS):
            self.over()
        return True

    @property
    def holds(self) -> bool:
        """Whether nothing has happened for a second."""
        return self._same >= _SETTLED

    def _lasts(self) -> bool:
        """Nothing turns either, and nothing is on that an E-stop would switch off."""
        if not self.holds or self._control.wheel.axis:
            return False
        context = self._context
        outputs, models = context.ports.io.outputs(), context.machine.outputs
        lamps = context.machine.lamps
        safe = all(name in lamps or model.safe in {None, outputs.get(name)} for name, model in models.items())
        return safe and not context.spindle.command and not context.spindle.measured


def _discard(_what: InterruptedJob | None) -> None:
    """Where nothing outlives the executor, no interrupted job is kept."""


def _lay_out(ports: MachinePorts) -> Callable[[float], None]:
    """Who hears up to what speed the radius may take the spindle."""
    return ports.blocks.lay_out if ports.blocks is not None else lambda _: None


class Executor:
    """``post`` and ``snapshot`` may be used from any thread, ``tick`` from one only.

    ``passes`` makes a pass through a job with the circumstances of the start; tests give their own.
    ``note`` is told what job a power cut would leave interrupted now, ``left`` is what the last one left.
    With ``checks_starts`` no cycle starts before a worker has given its verdict on the first move.
    ``tell`` is handed what the scope records of each tick, and must only put it into a queue.
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
        self._missed = False  # the scope could not be told something
        self._late = 0.0  # s, the worst since the last that was handed over
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
        )  # called on its thread when what was at rest has changed
        self._logged_override = 1.0
        self._lost = ""  # what of the station was gone a tick ago
        self._told_lost = ""
        self.ticks = 0  # so many have ended: what the watchdog looks at
        self.patient = False  # it waits for drives, which may take seconds
        self._silent = ""  # why the watchdog has halted the machine
        self.snapshot: Snapshot = self._publish()

    @property
    def halt(self) -> Callable[[], None] | None:
        """The drivers' own way to stop everything, which any thread may use."""
        return self._ports.halt

    def post(self, command: Command, at: float | None = None) -> None:
        """Ask for something; it is looked at first thing in the next tick. Never waits.

        ``at`` is when it was asked for, s of the machine's clock; None: now.
        """
        self._commands.put((self._ports.clock.now() if at is None else at, command))
        self.wake()

    def wake(self) -> None:
        """Look at once, from any thread; where the drivers do not ring that is the next tick anyway."""
        if self._ports.wakeup is not None:
            self._ports.wakeup.ring()

    def rest(self) -> bool:
        """Between two ticks, on their thread: wait where the machine is at rest, until something is asked for
        or has changed. False, and at once, elsewhere.
        """
        with ReportedAttempt(self.failed):
            if self._commands.empty() and self._rest.wait():
                self._due = self._context.now + RESTS
                return True
        return False

    def tick(self) -> None:
        """Once every 10 to 20 ms: look, obey, supervise, go on, publish. Raises nothing."""
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
        """A busy computer deepens the setpoint queue; that a hold reacts later is logged once."""
        self._late = max(self._late, late)
        lateness = self._context.lateness
        if lateness.look(late, self._context.now):
            words = "the computer is busy: a feed hold reacts up to {seconds} s later"
            self._context.log("late", Message(words, seconds=f"{lateness.hold_later:.1f}"))

    def declare_silent(self, why: str) -> None:
        """From the watchdog's thread, which has halted the machine: an alarm on the screen, whose snapshot
        then stands still. Should this executor ever tick again, the alarm is what it begins with.
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
        """A driver that does not answer, or a mistake of the control itself: nothing may go on."""
        if isinstance(error, DriverError):
            self._control.alarm(AlarmError(error.code, str(error)))
        else:
            self._control.failed(error)

    def shut(self) -> None:
        """The end of the executor: nothing is left moving or switched on. Raises nothing."""
        with ReportedAttempt(self.failed):
            self._control.shut()
        self._show()

    def _show(self) -> None:
        """Where the machine cannot be read any more, its state and alarms at least."""
        with ReportedAttempt(self.failed) as publishing:
            self.snapshot = self._publish()
        if publishing.error is not None:
            status = self._control.status
            self.snapshot = replace(
                self.snapshot, t=self._context.now, state=status.state, alarms=status.alarms
            )

    def _hand_over(self) -> None:
        """What the scope records; that nothing can be recorded stops nothing."""
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
            self._missed = True  # once: it would come a hundred times a second
            _log.error("the scope misses what the machine does", exc_info=trial.error)

    def _blind(self) -> None:
        """Something cannot be read: what was seen before starts nothing, and E-stop is still obeyed."""
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
                if self._control.cycle is not None:  # before what was pressed meanwhile stops or ends it
                    self._control.cycle.catch_up()

    def _log_lost(self) -> None:
        """A pendant that is unplugged, and that is there again."""
        lost = self._context.signals.lost or self._context.signals.wheel_trouble
        if lost != self._told_lost:
            self._told_lost = lost
            self._context.log("disturbed", (lost or "the pendant is connected again").upper())

    def _log_override(self) -> None:
        """A turned pot goes to the log in steps worth reading."""
        fraction = self._context.feed_override
        if abs(fraction - self._logged_override) >= _WORTH_AN_ENTRY or (fraction == 0.0) != (
            self._logged_override == 0.0
        ):
            self._logged_override = fraction
            self._context.log(
                "override", Message("feed override {fraction} %", fraction=f"{100 * fraction:.0f}")
            )

    def _obey(self) -> None:
        """E-stop first, then what was posted, then the station's buttons."""
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
            control.feed_hold("GUARD OPEN")  # a jog in setting is the builder's to limit
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
            self._rest.over()  # whatever it does is shown at once
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
        """What a part of a tick has to tell becomes an alarm, and the other parts go on."""
        with ReportedAttempt(self.failed):
            try:
                part()
            except AlarmError as trouble:
                self._alarm(trouble)
            except MotionError as error:
                self._control.alarm(AlarmError("program", str(error)))
            except TrippedError:
                pass  # refused, since the driver host has stopped something: the next look tells what
            except DriverError as error:
                self._alarm(AlarmError(error.code, str(error)))

    def _alarm(self, trouble: AlarmError) -> None:
        """An E-stop that was pressed since the station was looked at is the cause of what has no power."""
        if trouble.code in _OFF_BY_ESTOP and self._ports.station.snapshot().estop:
            self._control.mirror_estop(True)
        else:
            self._control.alarm(trouble)

    def _publish(self) -> Snapshot:
        return self._publisher.snapshot(self._context, self._control)
