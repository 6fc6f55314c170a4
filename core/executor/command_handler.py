"""What each command does, one method a command; nothing is refused in silence."""

from __future__ import annotations

from collections.abc import Callable

from core.executor.commands import (
    Command,
    ConfirmStart,
    CycleStart,
    EnableDrives,
    FeedHold,
    FeedOverride,
    ForceOutput,
    GiveProof,
    Home,
    Jog,
    JogStep,
    JogStop,
    LoadJob,
    PartsMade,
    Prepare,
    Renew,
    Reset,
    SetSwitch,
    SpindleLimit,
    SpindleStop,
    UseOffsets,
    Wheel,
    WheelOff,
)
from core.executor.control_status import modal_with_offsets
from core.executor.jogging import at_the_end
from core.executor.machine_context import MachineContext
from core.executor.machine_control import MachineControl
from core.executor.operator_station import StationWatch
from core.executor.snapshot import CYCLE, Starts, State

# --- between two programs -------------------------------------------------------------------------------


_AT_REST = frozenset({State.IDLE, State.DISABLED})


class ByHand:
    """Obeys these commands, on the executor's thread; what it refuses it says."""

    def __init__(self, context: MachineContext, control: MachineControl) -> None:
        self._context = context
        self._control = control

    def obey(self, command: UseOffsets | SpindleStop | ForceOutput) -> None:
        """Do it, or say why not. Raises DriverError."""
        why = self._refusal(command)
        if why:
            self._context.say("refused", why)
            return
        match command:
            case UseOffsets(tools=tools, secondary=secondary):
                status = self._control.status
                status.modal = modal_with_offsets(status.modal, tools, secondary)
                self._context.say("offsets", "the offsets of the tables are in force")
            case SpindleStop():
                self._context.spindle.stop()
                self._context.noted("by-hand", "the spindle was stopped by hand")
            case ForceOutput(name=name, on=on):
                self._context.ports.io.write(name, on)
                self._context.say("force", f"{name} {'on' if on else 'off'} by hand")

    def _refusal(self, command: UseOffsets | SpindleStop | ForceOutput) -> str:
        state = self._control.state
        if isinstance(command, ForceOutput):
            return self._output(command.name, command.on, state)
        if state not in CYCLE:
            return ""
        if isinstance(command, UseOffsets):
            return "a program is under way: it keeps the offsets that it was proved with"
        return "a program is under way: its spindle is stopped by feed hold and reset"

    def _output(self, name: str, on: bool, state: State) -> str:
        context = self._context
        if name not in context.machine.outputs:
            return f"this machine has no output {name}"
        if state not in _AT_REST:
            return f"{name}: outputs are switched by hand only at rest, not in state {state.value}"
        if name == "collet" and not on and not (context.spindle.stopped and not context.spindle.asked):
            return "the collet is not opened by hand while the spindle turns"
        return ""


# --- what Cycle Start will begin ------------------------------------------------------------------------


_UNDER_WAY = "a program is under way: it must end or be reset before another is loaded"


class Loading:
    """Obeys these commands, on the executor's thread; what it refuses it says."""

    def __init__(self, context: MachineContext, control: MachineControl) -> None:
        self._context = context
        self._control = control

    def obey(self, command: LoadJob | GiveProof | Renew | Prepare | ConfirmStart | PartsMade) -> None:
        """Do it, or say why not."""
        if isinstance(command, GiveProof):
            self._control.status.proof = command.proof
        elif isinstance(command, Renew):
            self._renew(command)
        elif isinstance(command, PartsMade):
            self._control.counters.made = max(0, command.parts)
        elif isinstance(command, ConfirmStart):
            self._confirm(command)
        elif self._control.state in CYCLE:
            self._context.say("refused", _UNDER_WAY)
        elif isinstance(command, LoadJob):
            self._load(command)
        else:
            self._prepare(command)

    def _load(self, command: LoadJob) -> None:
        """A restart belonged to the program before; an open SEARCHTO or MDI stays open."""
        status = self._control.status
        self._control.program_run.interruption.loaded(command.job)
        status.job, status.proof, status.start_refused = command.job, command.proof, ""
        self._control.program_run.changed_offsets.forget()
        if status.starts is Starts.RESTART:
            self._prepare(Prepare(Starts.RESTART))
        self._context.say("load", command.job.source.name)

    def _renew(self, command: Renew) -> None:
        """Under a running program it waits for the end of the part; else it counts at once."""
        program_run, status = self._control.program_run, self._control.status
        why = program_run.changed_offsets.ask(command, status.job)
        if why:
            self._context.say("refused", why)
        elif self._control.state not in CYCLE:
            program_run.changed_offsets.take_up(status)

    def _confirm(self, command: ConfirmStart) -> None:
        why = self._control.program_run.interruption.answer(command.at)
        self._control.status.start_refused = ""
        if why:
            self._context.say("refused", why)
        elif command.at:
            self._context.say("confirmed", "a start at the first line is meant")

    def _prepare(self, command: Prepare) -> None:
        status = self._control.status
        self._control.program_run.interruption.withdraw()
        status.starts, status.start_refused = command.starts, ""
        status.prepared, status.prepared_proof = command.job, command.proof


_SWITCHES = ("single_block", "optional_stop", "cycle_repeat", "no_count")


class Orders:
    """Obeys commands, on the executor's thread."""

    def __init__(self, context: MachineContext, control: MachineControl, station: StationWatch) -> None:
        self._context = context
        self._control = control
        self._station = station
        self._by_hand = ByHand(context, control)
        self._loading = Loading(context, control)
        self._simple: dict[type[Command], Callable[[], None]] = {
            CycleStart: self._start,
            Reset: control.reset,
            EnableDrives: self._enable,
            JogStop: control.jogger.stop,
            WheelOff: lambda: control.wheel.off(control.state),
        }

    def obey(self, command: Command) -> None:
        """Do it, or say why not. Raises DriverError."""
        simple = self._simple.get(type(command))
        if simple is not None:
            simple()
            return
        match command:
            case LoadJob() | GiveProof() | Renew() | Prepare() | ConfirmStart() | PartsMade():
                self._loading.obey(command)
            case FeedHold(by=by):
                self._control.feed_hold("", by)
            case SetSwitch(name=name, on=on):
                self._switch(name, on)
            case FeedOverride(fraction=fraction):
                self._override(fraction)
            case SpindleLimit(rpm=rpm):
                self._limit(rpm)
            case Jog() | JogStep() | Wheel():
                self._move(command)
            case Home(axis=axis):
                self._home(axis)
            case UseOffsets() | SpindleStop() | ForceOutput():
                self._by_hand.obey(command)

    def _start(self) -> None:
        """A start without the palms: where a real machine asks for two hands, this is not one."""
        machine = self._context.machine
        if machine.interlocks.two_hand_start and machine.backend != "sim":
            self._control.refuse("press both palm buttons")
        elif self._station.may_start(self._context.now):
            self._control.start()

    def _enable(self) -> None:
        control = self._control
        if control.state is not State.DISABLED:
            self._context.say("refused", f"drives cannot be switched on in state {control.state.value}")
        elif control.status.alarms:
            self._context.say("refused", "an alarm stands: press Reset first")
        else:
            self._context.ports.axes.enable(True)
            self._context.sample = self._context.ports.axes.sample()
            control.enter(State.IDLE)

    def _switch(self, name: str, on: bool) -> None:
        if name not in _SWITCHES:
            self._context.say("refused", f"there is no switch {name!r}")
            return
        setattr(self._context.switches, name, on)
        self._context.say("switch", f"{name.replace('_', ' ')} {'on' if on else 'off'}")

    def _override(self, fraction: float) -> None:
        if not 0.0 <= fraction <= 1.5:
            self._context.say("refused", f"feed override {fraction} is not between 0 and 1.5")
            return
        self._context.soft_override = fraction

    def _limit(self, rpm: float | None) -> None:
        highest = self._context.machine.spindle.rpm_max
        if rpm is not None and not 0.0 < rpm <= highest:
            self._context.say("refused", f"spindle limit {rpm:g} is not between 0 and {highest:g} rpm")
            return
        spindle = self._context.spindle
        if spindle.command and (rpm or highest) > spindle.highest:
            self._context.say("refused", "the spindle limit is raised only while the spindle stands")
            return
        spindle.limit = rpm
        self._context.say("override", f"spindle limit {rpm or highest:g} rpm")

    def _move(self, command: Jog | JogStep | Wheel) -> None:
        match command:
            case Jog():
                self._jog(command)
            case JogStep():
                self._step(command)
            case Wheel():
                self._control.wheel.select(command, self._control.state)

    def _jog(self, command: Jog) -> None:
        control, jogger = self._control, self._control.jogger
        if self._may_not_jog():
            return
        why = control.wheel.bars(control.state)
        why = why or jogger.refusal(command.axis, command.velocity, command.lease)
        if why:
            jogger.stop()
            self._context.say("refused", f"jog: {why}")
        elif jogger.move(command.axis, command.velocity, command.lease):
            control.enter(State.JOG)
        elif control.state is State.IDLE:
            self._context.say("refused", f"jog: {at_the_end(command.axis, command.velocity)}")

    def _step(self, command: JogStep) -> None:
        control, jogger = self._control, self._control.jogger
        if self._may_not_jog():
            return
        why = control.wheel.bars(control.state)
        why = why or jogger.step_refusal(command.axis, command.distance, command.speed)
        if not why:
            jogger.step(command.axis, command.distance, command.speed)
            control.enter(State.JOG)
            return
        if not jogger.stepping:
            jogger.stop()  # a held jog and a step at once: nobody can mean both
        self._context.say("refused", f"jog: {why}")

    def _may_not_jog(self) -> bool:
        control = self._control
        if control.state is State.IDLE:
            control.jogger.forget()  # an alarm or the E-stop may have ended the jog before
        elif control.state is not State.JOG:
            self._context.say("refused", f"no jog in state {control.state.value}")
            return True
        return False

    def _home(self, axis: str) -> None:
        control = self._control
        why = control.homing.begin(axis) if control.state is State.IDLE else f"state {control.state.value}"
        if why:
            self._context.say("refused", f"homing: {why}")
        else:
            control.enter(State.HOME)
