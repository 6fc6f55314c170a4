"""Holds the state of the machine and everything that changes it: start, hold, reset, end, alarm, E-stop."""

from __future__ import annotations

from collections.abc import Callable

from core.executor import gate
from core.executor.alarms import Reaction, TroubleError, alarm_of
from core.executor.bench import Bench
from core.executor.cycle import Cycle
from core.executor.feed import Pass
from core.executor.homing import Homing
from core.executor.inherited import as_it_is, at_power_up, given_up
from core.executor.interpret import circumstances
from core.executor.job import Job
from core.executor.jog import Jogger
from core.executor.player import Player
from core.executor.snapshot import Event, State
from core.executor.standing import Counters, Standing
from core.executor.states import ACTIVE, CYCLE, STOPPED, demand_allowed
from core.executor.supervisor import Supervisor
from core.interpreter.actions import ProgramEnd
from core.interpreter.modal import Modal
from core.interpreter.setup import Setup
from core.motion.limits import MotionLimits


class Conductor:
    """Everything about one machine that outlives a tick. Used by the executor's thread alone."""

    def __init__(self, bench: Bench, passes: Callable[[Job, Setup], Pass]) -> None:
        self._bench = bench
        self._passes = passes
        self.standing = Standing(modal=at_power_up(bench))
        self.counters = Counters()
        self.cycle: Cycle | None = None
        self.supervisor = Supervisor(bench)
        self.jogger = Jogger(bench)
        self.homing = Homing(bench)
        machine = bench.machine
        self._player = Player(
            bench.ports.axes, MotionLimits.of(machine.axes, machine.timing.setpoint), machine.timing.lookahead
        )
        self._giving_up = False

    @property
    def state(self) -> State:
        """The present state."""
        return self.standing.state

    @property
    def modal(self) -> Modal:
        """In force now: of the block being executed, or what stands between two programs."""
        return self.cycle.modal if self.cycle is not None else self.standing.modal

    def enter(self, state: State) -> None:
        """Change the state; raises TransitionError for a change that the table does not hold."""
        if state is self.state:
            return
        demand_allowed(self.state, state)
        self.standing.state = state
        self._bench.say("state", state.value)

    # --- what is asked ------------------------------------------------------------------------------------

    def start(self) -> None:
        """Cycle Start: begin, or go on. While a cycle runs it means nothing."""
        state, cycle = self.state, self.cycle
        if state in ACTIVE or self._giving_up:
            return
        if state in STOPPED and cycle is not None:
            if not self.refuse(gate.busy(self._bench) or cycle.why_not_on()):
                cycle.go_on()
        elif not self.refuse(gate.refusal(self._bench, state, self.standing.job, self.standing.proof)):
            self._begin()

    def refuse(self, why: str) -> bool:
        """Keep and log why a start is refused; False when there is no reason."""
        self.standing.start_refused = why
        if why:
            self._bench.say("refused", why)
        return bool(why)

    def feed_hold(self, reason: str) -> None:
        """Hold the cycle, end a jog, brake a homing."""
        if self.state is State.JOG:
            self.jogger.stop()
        elif self.state is State.HOME:
            self._stop_homing()
        elif self.cycle is not None and self.state in ACTIVE:
            self.cycle.hold(reason)

    def reset(self) -> None:
        """Give the program up, stop the spindle, acknowledge alarms."""
        self.standing.start_refused = ""
        self._bench.spindle.stop()
        self._bench.ports.io.safe()
        if self.standing.alarms:
            self._acknowledge()
        elif self.cycle is not None and self.state in CYCLE:
            self._giving_up = True
            self.cycle.abandon()
            self._leave()
        elif self.state is State.JOG:
            self.jogger.stop()
        elif self.state is State.HOME:
            self._stop_homing()

    def mirror_estop(self, pressed: bool) -> None:
        """The hardware has stopped everything; the control follows, and nothing starts on release."""
        if pressed and self.state is not State.ESTOP:
            self.supervisor.react(Reaction.OFF)
            self._giving_up = False
            self._forget_cycle()
            self.enter(State.ESTOP)
        elif not pressed and self.state is State.ESTOP:
            self.enter(State.DISABLED)

    # --- every tick ---------------------------------------------------------------------------------------

    def go_on(self) -> None:
        """Whatever is under way. Raises TroubleError, MotionError, DriverError."""
        if self.cycle is None:
            self.standing.modal = as_it_is(self.standing.modal, self._bench)
        if self.cycle is not None and self.state in CYCLE:
            if self._giving_up:
                self._leave()
                return
            if self.state in ACTIVE:
                self._mind_the_queue(self.cycle)
            self.cycle.step()
        elif (self.state is State.JOG and self.jogger.over()) or (
            self.state is State.HOME and self.homing.step()
        ):
            self.enter(State.IDLE)

    def _mind_the_queue(self, cycle: Cycle) -> None:
        """A host that comes back too late finds the slides braking on their path, or at rest: a hold."""
        left = self._player.starving - self._bench.now
        if self._player.active and left < self._bench.machine.timing.low_water:
            self.counters.underruns += 1
            self._bench.say("starved", "setpoints ran low; the slides stop on the path")
            cycle.starve()

    # --- the cycle ----------------------------------------------------------------------------------------

    def _begin(self) -> None:
        job = self.standing.job
        assert job is not None
        self.counters.cycle = 0.0
        self._open(job)
        self.enter(State.RUN)
        self._bench.say("start", job.source.name)

    def _open(self, job: Job) -> None:
        """A pass from the first line, from where the slides stand now; nothing is kept of an earlier one."""
        at, _ = self._bench.ports.axes.demand_at(self._bench.now)
        setup = circumstances(job.setup, tuple(at), self._bench.terminal)
        self._player.forget()
        source = self._passes(job, setup)
        begins = Modal(metric=setup.metric, rapid_rate=setup.last_rapid)
        self.cycle = Cycle(self._bench, self._player, source, begins, self.enter, self._ended)

    def _ended(self, end: ProgramEnd) -> None:
        """M30 and M02: one part more; M30 also ends what M functions have begun."""
        counters, job, bench = self.counters, self.standing.job, self._bench
        counters.parts += 1
        counters.last_cycle, counters.cycle = counters.cycle, 0.0
        bench.say("part", f"part {counters.parts}, {counters.last_cycle:.2f} s")
        if end.reset:
            bench.spindle.stop()
            for name, on in bench.ports.io.outputs().items():
                if on and name != "collet":
                    bench.ports.io.write(name, False)
        if end.reset and bench.switches.cycle_repeat and job is not None:
            self._open(job)
            return
        bench.say("end", "program end")
        left = self.cycle.modal if self.cycle is not None else self.standing.modal
        self._forget_cycle()
        self.standing.modal = left
        self.enter(State.IDLE)

    def _leave(self) -> None:
        """A cycle that was reset is over as soon as the slides rest."""
        if self.cycle is None or not self.cycle.at_rest:
            return
        self._giving_up = False
        self._forget_cycle()
        self.enter(State.IDLE)
        self._bench.say("end", "program given up by reset")

    def _forget_cycle(self) -> None:
        """What it leaves in force is what M30 would have left."""
        if self.cycle is not None:
            self.standing.modal = given_up(self.cycle.modal)
        self.cycle = None
        self._bench.line = 0
        self._player.forget()

    def _stop_homing(self) -> None:
        self.homing.stop()
        self.enter(State.IDLE)

    # --- alarms -------------------------------------------------------------------------------------------

    def alarm(self, trouble: TroubleError) -> None:
        """Stop the machine and say why. The same alarm twice is one."""
        bench = self._bench
        alarm, reaction = alarm_of(trouble, bench.line, bench.now)
        if any(old.code == alarm.code for old in self.standing.alarms):
            return
        self.standing.alarms = (*self.standing.alarms, alarm)
        self.supervisor.react(reaction)
        self.standing.power_off = self.standing.power_off or reaction is Reaction.OFF
        self._giving_up = False
        self._forget_cycle()
        if self.state not in {State.ESTOP, State.FAULT}:
            self.enter(State.FAULT)
        bench.on_event(Event(bench.now, "alarm", f"{alarm.text}: {alarm.cause}", alarm.line))

    def failed(self, error: Exception) -> None:
        """A mistake of the control itself, whatever the table of states says about it."""
        if self.state is not State.ESTOP:
            self.standing.state = State.FAULT
        self.alarm(TroubleError("internal", f"{type(error).__name__}: {error}"))

    def shut(self) -> None:
        """Nothing is left moving or switched on."""
        self.supervisor.react(Reaction.OFF)
        self._forget_cycle()
        if self.state is not State.ESTOP:
            self.standing.state = State.DISABLED

    def _acknowledge(self) -> None:
        """Reset with an alarm: only at rest, and drives that an alarm has switched off stay off."""
        bench, standing = self._bench, self.standing
        if bench.sample.moving:
            bench.say("refused", "reset: wait until the slides are at rest")
            return
        if standing.power_off:
            bench.ports.axes.enable(False)
        bench.ports.axes.clear_fault()
        standing.power_off, standing.alarms = False, ()
        bench.sample = bench.ports.axes.sample()
        if self.state is State.FAULT:
            self.enter(State.IDLE if bench.sample.enabled else State.DISABLED)
