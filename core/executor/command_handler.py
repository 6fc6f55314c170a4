"""Execution of posted commands, with one method for each command.

Every refusal is logged with its reason.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from core.executor import commands
from core.executor.control_status import modal_with_offsets
from core.executor.hand_motion.jogging import at_the_end
from core.executor.machine_context import MachineContext
from core.executor.machine_control import MachineControl
from core.executor.signals import StationWatch
from core.executor.snapshot import CYCLE, LINES, Starts, State
from core.message import Message

LAMP_TEST = 2.0  # s
_PRESSES = 64  # number of stop-key presses to remember
_SWITCHES = ("single_block", "optional_stop", "cycle_repeat", "no_count")
_AT_REST = frozenset({State.IDLE, State.DISABLED})
_UNDER_WAY = "a program is running; wait until it ends or press Reset before loading another program"


class CommandHandler:
    """Executes commands on the executor's thread and logs the reason for each refusal."""

    def __init__(self, context: MachineContext, control: MachineControl, station: StationWatch) -> None:
        self._context = context
        self._control = control
        self._station = station
        self._presses: deque[int] = deque(maxlen=_PRESSES)  # numbers of the stop-key presses that were obeyed
        self._methods: dict[type[commands.Command], Callable[[Any], None]] = {
            commands.CycleStart: self._start,
            commands.FeedHold: self._hold,
            commands.Reset: lambda _: control.reset(),
            commands.EnableDrives: self._enable,
            commands.SetSwitch: self._switch,
            commands.FeedOverride: self._override,
            commands.SpindleLimit: self._limit,
            commands.LoadJob: self._load,
            commands.GiveProof: self._prove,
            commands.GiveClearance: self._clear,
            commands.Renew: self._renew,
            commands.LeftInterrupted: self._left,
            commands.Prepare: self._prepare,
            commands.ConfirmStart: self._confirm,
            commands.PartsMade: self._count,
            commands.BarNextPart: self._bar,
            commands.Jog: self._jog,
            commands.JogStep: self._step,
            commands.DriveTest: self._test,
            commands.DriveTestOn: lambda command: control.drive_test.renew(command.lease),
            commands.Touch: self._touch,
            commands.JogStop: lambda _: control.let_go(),
            commands.Wheel: lambda command: control.wheel.select(command, control.state),
            commands.WheelOff: lambda _: control.wheel.off(control.state),
            commands.Home: self._home,
            commands.UseOffsets: self._offsets,
            commands.SpindleStop: self._stop_spindle,
            commands.ForceOutput: self._force,
        }

    def obey(self, command: commands.Command) -> None:
        """Execute a command, or log why it is refused. Raises DriverError if a driver fails."""
        self._methods[type(command)](command)

    def _refuse(self, why: str) -> None:
        self._context.log("refused", why)

    # --- start, drives, switches --------------------------------------------------------------------------

    def _start(self, _: commands.CycleStart) -> None:
        """Start a cycle without the palm buttons, unless the real machine requires two-hand start."""
        machine = self._context.machine
        if machine.interlocks.two_hand_start and machine.backend != "sim":
            self._control.refuse("press both palm buttons")
        elif self._station.may_start(self._context.now):
            self._control.start()

    def _hold(self, command: commands.FeedHold) -> None:
        """Hold the cycle, but ignore a key press that was already obeyed.

        The screen can deliver one press twice. The second delivery must not hold a cycle that was started in
        between.
        """
        if command.press not in self._presses:
            self._control.feed_hold("", command.by)
        if command.press:
            self._presses.append(command.press)

    def _enable(self, _: commands.EnableDrives) -> None:
        control = self._control
        if control.state is not State.DISABLED:
            self._refuse(Message("drives cannot be switched on in state {state}", state=control.state.value))
        elif control.status.alarms:
            self._refuse("an alarm is active; press Reset first")
        elif self._context.unknown:
            self._refuse(
                "the machine has not reported its state yet; wait a moment, then switch the drives on"
            )
        else:
            self._context.ports.axes.enable(True)
            self._context.sample = self._context.ports.axes.sample()
            control.enter(State.IDLE)

    def _switch(self, command: commands.SetSwitch) -> None:
        name, on = command.name, command.on
        if name not in _SWITCHES:
            self._refuse(Message("switch {name} does not exist", name=f"{name!r}"))
            return
        setattr(self._context.switches, name, on)
        self._context.log(
            "switch", Message("{name} {ending}", name=name.replace("_", " "), ending="on" if on else "off")
        )

    def _override(self, command: commands.FeedOverride) -> None:
        if not 0.0 <= command.fraction <= 1.5:
            self._refuse(
                Message("feed override {fraction} is not between 0 and 1.5", fraction=command.fraction)
            )
            return
        self._context.soft_override = command.fraction

    def _limit(self, command: commands.SpindleLimit) -> None:
        rpm, highest = command.rpm, self._context.machine.spindle.rpm_max
        if rpm is not None and not 0.0 < rpm <= highest:
            self._refuse(
                Message(
                    "spindle speed limit {rpm} is not between 0 and {highest} rpm",
                    rpm=f"{rpm:g}",
                    highest=f"{highest:g}",
                )
            )
            return
        spindle = self._context.spindle
        if spindle.command and (rpm or highest) > spindle.highest:
            self._refuse("the spindle speed limit can be raised only when the spindle is stopped")
            return
        spindle.limit = rpm
        self._context.log("override", Message("spindle speed limit {rpm} rpm", rpm=f"{rpm or highest:g}"))

    # --- selection of the next start ----------------------------------------------------------------------

    def _load(self, command: commands.LoadJob) -> None:
        """Load a job. A prepared restart is dropped, but the start mode (restart or MDI) remains."""
        if self._control.state in CYCLE:
            self._refuse(_UNDER_WAY)
            return
        status = self._control.status
        if status.job is None or status.job.source.name != command.job.source.name:
            status.modal = status.modal._replace(comment="")  # the comment belongs to the previous program
        self._control.program_run.interruption.loaded(command.job)
        status.job, status.proof, status.start_refused = command.job, command.proof, ""
        self._control.program_run.changed_offsets.forget()
        if status.starts is Starts.RESTART:
            self._prepare(commands.Prepare(Starts.RESTART))
        self._context.log("load", command.job.source.name)

    def _prove(self, command: commands.GiveProof) -> None:
        self._control.status.proof = command.proof

    def _clear(self, command: commands.GiveClearance) -> None:
        """Store new clearances and clear a start refusal that the earlier clearances caused."""
        status = self._control.status
        if status.start_code:
            status.start_refused = status.start_code = ""
        status.clearances = command.clearances

    def _renew(self, command: commands.Renew) -> None:
        """Accept changed offsets: at once between programs, or at the end of the part in progress."""
        changed_offsets, status = self._control.program_run.changed_offsets, self._control.status
        why = changed_offsets.ask(command, status.job)
        if why:
            self._refuse(why)
        elif self._control.state not in CYCLE:
            changed_offsets.take_up(status)

    def _prepare(self, command: commands.Prepare) -> None:
        if self._control.state in CYCLE:
            self._refuse(_UNDER_WAY)
            return
        status = self._control.status
        self._control.program_run.interruption.withdraw()
        status.starts, status.start_refused, status.start_code = command.starts, "", ""
        status.prepared, status.prepared_proof = command.job, command.proof
        status.prepared_clearance = command.clearance
        if command.job is not None and command.starts is Starts.RESTART:
            self._control.meant_at = self._context.now

    def _confirm(self, command: commands.ConfirmStart) -> None:
        why = self._control.program_run.interruption.answer(command.at)
        self._control.status.start_refused = ""
        if why:
            self._refuse(why)
        elif command.at:
            self._control.meant_at = self._context.now
            self._context.log("confirmed", "confirmed: the program starts at the first line")

    def _count(self, command: commands.PartsMade) -> None:
        self._control.counters.made = max(0, command.parts)

    def _left(self, command: commands.LeftInterrupted) -> None:
        self._control.program_run.interruption.found(command.left, logged=command.logged)

    def _bar(self, command: commands.BarNextPart) -> None:
        status = self._control.status
        if command.why != status.next_barred:
            status.next_barred, status.start_refused = command.why, ""
            self._context.log(
                "switch",
                Message("no more parts may be run: {why}", why=command.why)
                if command.why
                else ("parts may be run again"),
            )

    # --- jog, homing --------------------------------------------------------------------------------------

    def _jog(self, command: commands.Jog) -> None:
        control, jogger = self._control, self._control.jogger
        if self._may_not_jog():
            return
        if command.while_on and not self._context.button(command.while_on):
            control.stop_jog(
                "the jog button was released"
            )  # The screen has not yet seen that the button was released.
            return
        why = control.jog_ended or control.wheel.bars(control.state)
        why = why or jogger.refusal(command.axis, command.velocity, command.lease, command.along)
        if why:
            jogger.stop()
            self._refuse(Message("jog: {why}", why=why))
        elif jogger.move(command.axis, command.velocity, command.lease, command.along):
            jogger.while_on = command.while_on
            control.enter(State.JOG)
        elif control.state is State.IDLE:
            self._refuse(Message("jog: {why}", why=at_the_end(command.axis, command.velocity)))

    def _step(self, command: commands.JogStep) -> None:
        control, jogger = self._control, self._control.jogger
        if self._may_not_jog():
            return
        why = control.wheel.bars(control.state)
        why = why or jogger.step_refusal(command.axis, command.distance, command.speed, command.along)
        if not why:
            jogger.step(command.axis, command.distance, command.speed, command.along)
            control.enter(State.JOG)
            return
        if not jogger.stepping:
            jogger.stop()  # A continuous jog and a step at the same time are contradictory.
        self._refuse(Message("jog: {why}", why=why))

    def _test(self, command: commands.DriveTest) -> None:
        control, jogger = self._control, self._control.jogger
        if self._may_not_jog():
            return
        why = control.wheel.bars(control.state)
        why = why or control.drive_test.refusal(command.path, command.lease)
        if why:
            jogger.stop()  # A drive test and another motion at the same time are contradictory.
            self._refuse(Message("drive test: {why}", why=why))
            return
        if control.drive_test.begin(command.path, command.lease):
            control.enter(State.JOG)
        else:
            self._refuse("drive test: the watchdog time expired before any axis could move")

    def _may_not_jog(self) -> bool:
        control = self._control
        if control.state is State.IDLE:
            control.jogger.forget()  # An alarm or the E-stop may have ended an earlier jog.
        elif control.state is not State.JOG:
            self._refuse(Message("jogging is not available in state {state}", state=control.state.value))
            return True
        elif control.touch.phase is not None:
            control.stop_jog("another function was requested")
            return True
        return False

    def _touch(self, command: commands.Touch) -> None:
        control = self._control
        if control.touch.asked(command, control.state, control.wheel.axis):
            control.enter(State.JOG)

    def _home(self, command: commands.Home) -> None:
        control = self._control
        idle = control.state is State.IDLE
        why = (
            control.homing.begin(command.axis)
            if idle
            else (Message("not available in state {state}", state=control.state.value))
        )
        if why:
            self._refuse(Message("homing: {why}", why=why))
        else:
            control.enter(State.HOME)

    # --- manual functions between programs ----------------------------------------------------------------

    def _offsets(self, command: commands.UseOffsets) -> None:
        if self._control.state in CYCLE:
            self._refuse("the running program uses the offsets with which it was proved")
            return
        status = self._control.status
        status.modal = modal_with_offsets(status.modal, command.tools, command.secondary)
        self._context.log("offsets", "the offsets in the tables are in effect")

    def _stop_spindle(self, _: commands.SpindleStop) -> None:
        if self._control.state in CYCLE:
            if self._control.status.starts in LINES:  # The line started after the last update of the screen.
                self._control.reset()
            else:
                self._refuse("a program is running; press feed hold, then Reset to stop the spindle")
            return
        self._context.spindle.stop()
        self._context.log_stop("by-hand", "the spindle was stopped manually")

    def _force(self, command: commands.ForceOutput) -> None:
        why = self._output_refusal(command.name, command.on)
        if why:
            self._refuse(why)
            return
        if command.name in self._context.machine.lamps:
            self._context.lamp_test = self._context.now + LAMP_TEST
            self._context.log("force", "lamp test")
            return
        self._context.ports.io.write(command.name, command.on)
        self._context.log(
            "force",
            Message(
                "{output} switched on manually" if command.on else "{output} switched off manually",
                output=command.name,
            ),
        )

    def _output_refusal(self, name: str, on: bool) -> str:
        """Return why an output cannot be switched manually now, or an empty string if it can."""
        context, state = self._context, self._control.state
        if name not in context.machine.outputs:
            return Message("this machine has no output {name}", name=name)
        if state not in _AT_REST:
            return Message(
                "{name}: outputs can be switched manually only when the machine is at rest, not in "
                "state {state}",
                name=name,
                state=state.value,
            )
        if name == "collet" and not on and not (context.spindle.stopped and not context.spindle.asked):
            return "the collet cannot be opened manually while the spindle is turning"
        return ""
