"""Handler that executes posted commands, with one method for each command.

Every refusal is logged with its reason.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from core.executor import commands
from core.executor.control_status import apply_offsets_to_modal_state
from core.executor.hand_motion.jogging import make_travel_end_message
from core.executor.machine_context import MachineContext
from core.executor.machine_control import MachineControl
from core.executor.snapshot import CYCLE_STATES, MDI_ACTIONS, MachineState, StartAction
from core.executor.station_signals import StationSignalConverter
from core.message import Message

LAMP_TEST_S = 2.0  # s
_MAX_PRESSES = 64  # number of stop-key presses to remember
_SWITCH_NAMES = ("single_block", "optional_stop", "cycle_repeat", "no_count")
_REST_STATES = frozenset({MachineState.IDLE, MachineState.DISABLED})
_PROGRAM_RUNNING_REASON = (
    "a program is running; wait until it ends or press Reset before loading another program"
)


class CommandHandler:
    """A handler that executes commands on the executor's thread and logs the reason for each refusal."""

    def __init__(
        self, context: MachineContext, control: MachineControl, station: StationSignalConverter
    ) -> None:
        self._context = context
        self._control = control
        self._station = station
        self._presses: deque[int] = deque(
            maxlen=_MAX_PRESSES
        )  # numbers of the stop-key presses that were obeyed
        self._methods: dict[type[commands.Command], Callable[[Any], None]] = {
            commands.CycleStart: self._start_cycle,
            commands.FeedHold: self._hold_cycle,
            commands.Reset: lambda _: control.reset_machine(),
            commands.EnableDrives: self._enable,
            commands.SetSwitch: self._switch,
            commands.SetFeedOverride: self._override,
            commands.SetSpindleLimit: self._limit,
            commands.LoadJob: self._load_job,
            commands.SupplyJobProof: self._prove,
            commands.ReplaceStartClearances: self._store_clearances,
            commands.ChangeOffsets: self._change_offsets,
            commands.ReportInterruptedJob: self._left,
            commands.PrepareCycleStart: self._prepare,
            commands.ConfirmStart: self._confirm,
            commands.SetPartCount: self._count,
            commands.PreventNextPart: self._bar,
            commands.Jog: self._jog,
            commands.JogByStep: self._step,
            commands.RunDriveTest: self._test,
            commands.RenewDriveTest: lambda command: control.drive_tester.renew_lease(command.lease),
            commands.TouchOffTool: self._touch,
            commands.StopJog: lambda _: control.release_jog_key(),
            commands.SelectHandwheel: lambda command: control.handwheel.select_axis(command, control.state),
            commands.DeselectHandwheel: lambda _: control.handwheel.deselect_axis(control.state),
            commands.HomeAxes: self._home,
            commands.UseOffsetTables: self._offsets,
            commands.StopSpindle: self._stop_spindle,
            commands.ForceOutput: self._force,
        }

    def execute_command(self, command: commands.Command) -> None:
        """Execute a command, or log why the command is refused. Raises DriverError if a driver fails."""
        self._methods[type(command)](command)

    def _refuse(self, why: str) -> None:
        self._context.log_text("refused", why)

    # --- start, drives, switches --------------------------------------------------------------------------

    def _start_cycle(self, _: commands.CycleStart) -> None:
        """Start a cycle without the palm buttons, unless the real machine requires two-hand start."""
        machine = self._context.machine
        if machine.interlocks.two_hand_start and machine.backend != "sim":
            self._control.refuse_start("press both palm buttons")
        elif self._station.accept_start_press(self._context.now):
            self._control.handle_cycle_start()

    def _hold_cycle(self, command: commands.FeedHold) -> None:
        """Start a feed hold, unless the same key press has already caused one.

        The screen can deliver one key press twice. The second delivery must not stop a cycle that was
        started in between.
        """
        if command.press not in self._presses:
            self._control.start_feed_hold("", command.by)
        if command.press:
            self._presses.append(command.press)

    def _enable(self, _: commands.EnableDrives) -> None:
        control = self._control
        if control.state is not MachineState.DISABLED:
            self._refuse(Message("drives cannot be switched on in state {state}", state=control.state.value))
        elif control.status.alarms:
            self._refuse("an alarm is active; press Reset first")
        elif self._context.unknown_parts:
            self._refuse(
                "the machine has not reported its state yet; wait a moment, then switch the drives on"
            )
        else:
            self._context.ports.axes.enable(True)
            self._context.axis_sample = self._context.ports.axes.sample()
            control.change_state(MachineState.IDLE)

    def _switch(self, command: commands.SetSwitch) -> None:
        name, on = command.name, command.on
        if name not in _SWITCH_NAMES:
            self._refuse(Message("switch {name} does not exist", name=f"{name!r}"))
            return
        setattr(self._context.switches, name, on)
        self._context.log_text(
            "switch", Message("{name} {ending}", name=name.replace("_", " "), ending="on" if on else "off")
        )

    def _override(self, command: commands.SetFeedOverride) -> None:
        if not 0.0 <= command.fraction <= 1.5:
            self._refuse(
                Message("feed override {fraction} is not between 0 and 1.5", fraction=command.fraction)
            )
            return
        self._context.screen_feed_override = command.fraction

    def _limit(self, command: commands.SetSpindleLimit) -> None:
        rpm, highest = command.rpm, self._context.machine.spindle.max_rpm
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
        if spindle.commanded_rpm and (rpm or highest) > spindle.max_rpm:
            self._refuse("the spindle speed limit can be raised only when the spindle is stopped")
            return
        spindle.operator_limit_rpm = rpm
        self._context.log_text(
            "override", Message("spindle speed limit {rpm} rpm", rpm=f"{rpm or highest:g}")
        )

    # --- selection of the next start ----------------------------------------------------------------------

    def _load_job(self, command: commands.LoadJob) -> None:
        """Load a job and discard a prepared restart.

        The start mode that is selected (restart or MDI) does not change.
        """
        if self._control.state in CYCLE_STATES:
            self._refuse(_PROGRAM_RUNNING_REASON)
            return
        status = self._control.status
        if status.job is None or status.job.source.name != command.job.source.name:
            status.modal_state = status.modal_state._replace(
                comment=""
            )  # the comment belongs to the previous program
        self._control.program_run.interruption_watch.handle_loaded_job(command.job)
        status.job, status.proof, status.start_refusal_reason = command.job, command.proof, ""
        self._control.program_run.changed_offsets.discard_request()
        if status.start_action is StartAction.RESTART:
            self._prepare(commands.PrepareCycleStart(StartAction.RESTART))
        self._context.log_text("load", command.job.source.name)

    def _prove(self, command: commands.SupplyJobProof) -> None:
        self._control.status.proof = command.proof

    def _store_clearances(self, command: commands.ReplaceStartClearances) -> None:
        """Store new clearances for the first move, and clear a start refusal that the old ones caused."""
        status = self._control.status
        if status.start_refusal_code:
            status.start_refusal_reason = status.start_refusal_code = ""
        status.start_clearances = command.clearances

    def _change_offsets(self, command: commands.ChangeOffsets) -> None:
        """Accept changed offsets immediately between programs, otherwise at the end of the current part."""
        changed_offsets, status = self._control.program_run.changed_offsets, self._control.status
        why = changed_offsets.store_request(command, status.job)
        if why:
            self._refuse(why)
        elif self._control.state not in CYCLE_STATES:
            changed_offsets.apply_changes(status)

    def _prepare(self, command: commands.PrepareCycleStart) -> None:
        if self._control.state in CYCLE_STATES:
            self._refuse(_PROGRAM_RUNNING_REASON)
            return
        status = self._control.status
        self._control.program_run.interruption_watch.withdraw_confirmation()
        status.start_action, status.start_refusal_reason, status.start_refusal_code = command.starts, "", ""
        status.prepared_job, status.prepared_proof = command.job, command.proof
        status.prepared_start_clearance = command.clearance
        if command.job is not None and command.starts is StartAction.RESTART:
            self._control.confirmed_at = self._context.now

    def _confirm(self, command: commands.ConfirmStart) -> None:
        why = self._control.program_run.interruption_watch.confirm_start(command.at)
        self._control.status.start_refusal_reason = ""
        if why:
            self._refuse(why)
        elif command.at:
            self._control.confirmed_at = self._context.now
            self._context.log_text("confirmed", "confirmed: the program starts at the first line")

    def _count(self, command: commands.SetPartCount) -> None:
        self._control.counters.program_part_count = max(0, command.parts)

    def _left(self, command: commands.ReportInterruptedJob) -> None:
        self._control.program_run.interruption_watch.set_previous_interruption(
            command.left, is_logged=command.logged
        )

    def _bar(self, command: commands.PreventNextPart) -> None:
        status = self._control.status
        if command.why != status.next_part_inhibit_reason:
            status.next_part_inhibit_reason, status.start_refusal_reason = command.why, ""
            self._context.log_text(
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
        if command.while_on and not self._context.is_button_pressed(command.while_on):
            control.stop_jog(
                "the jog button was released"
            )  # The screen has not yet seen that the button was released.
            return
        why = control.jog_end_reason or control.handwheel.find_jog_refusal_reason(control.state)
        why = why or jogger.find_jog_refusal_reason(
            command.axis, command.velocity, command.lease, command.along
        )
        if why:
            jogger.stop()
            self._refuse(Message("jog: {why}", why=why))
        elif jogger.start_or_renew_jog(command.axis, command.velocity, command.lease, command.along):
            jogger.button_input = command.while_on
            control.change_state(MachineState.JOG)
        elif control.state is MachineState.IDLE:
            self._refuse(Message("jog: {why}", why=make_travel_end_message(command.axis, command.velocity)))

    def _step(self, command: commands.JogByStep) -> None:
        control, jogger = self._control, self._control.jogger
        if self._may_not_jog():
            return
        why = control.handwheel.find_jog_refusal_reason(control.state)
        why = why or jogger.find_step_refusal_reason(
            command.axis, command.distance, command.speed, command.along
        )
        if not why:
            jogger.start_step(command.axis, command.distance, command.speed, command.along)
            control.change_state(MachineState.JOG)
            return
        if not jogger.is_stepping:
            jogger.stop()  # A continuous jog and a step at the same time are contradictory.
        self._refuse(Message("jog: {why}", why=why))

    def _test(self, command: commands.RunDriveTest) -> None:
        control, jogger = self._control, self._control.jogger
        if self._may_not_jog():
            return
        why = control.handwheel.find_jog_refusal_reason(control.state)
        why = why or control.drive_tester.find_refusal_reason(command.path, command.lease)
        if why:
            jogger.stop()  # A drive test and another motion at the same time are contradictory.
            self._refuse(Message("drive test: {why}", why=why))
            return
        if control.drive_tester.start_test(command.path, command.lease):
            control.change_state(MachineState.JOG)
        else:
            self._refuse("drive test: the watchdog time expired before any axis could move")

    def _may_not_jog(self) -> bool:
        control = self._control
        if control.state is MachineState.IDLE:
            control.jogger.clear_jog()  # An alarm or the E-stop may have ended an earlier jog.
        elif control.state is not MachineState.JOG:
            self._refuse(Message("jogging is not available in state {state}", state=control.state.value))
            return True
        elif control.touch_off.phase is not None:
            control.stop_jog("another function was requested")
            return True
        return False

    def _touch(self, command: commands.TouchOffTool) -> None:
        control = self._control
        if control.touch_off.handle_request(command, control.state, control.handwheel.axis):
            control.change_state(MachineState.JOG)

    def _home(self, command: commands.HomeAxes) -> None:
        control = self._control
        idle = control.state is MachineState.IDLE
        why = (
            control.homing.start_homing(command.axis)
            if idle
            else (Message("not available in state {state}", state=control.state.value))
        )
        if why:
            self._refuse(Message("homing: {why}", why=why))
        else:
            control.change_state(MachineState.HOMING)

    # --- manual functions between programs ----------------------------------------------------------------

    def _offsets(self, command: commands.UseOffsetTables) -> None:
        if self._control.state in CYCLE_STATES:
            self._refuse("the running program uses the offsets with which it was proved")
            return
        status = self._control.status
        status.modal_state = apply_offsets_to_modal_state(
            status.modal_state, command.tools, command.secondary
        )
        self._context.log_text("offsets", "the offsets in the tables are in effect")

    def _stop_spindle(self, _: commands.StopSpindle) -> None:
        if self._control.state in CYCLE_STATES:
            if (
                self._control.status.start_action in MDI_ACTIONS
            ):  # The line started after the last update of the screen.
                self._control.reset_machine()
            else:
                self._refuse("a program is running; press feed hold, then Reset to stop the spindle")
            return
        self._context.spindle.stop()
        self._context.log_stop("by-hand", "the spindle was stopped manually")

    def _force(self, command: commands.ForceOutput) -> None:
        why = self._find_output_refusal(command.name, command.on)
        if why:
            self._refuse(why)
            return
        if command.name in self._context.machine.lamp_outputs:
            self._context.lamp_test_end_s = self._context.now + LAMP_TEST_S
            self._context.log_text("force", "lamp test")
            return
        self._context.ports.io.write(command.name, command.on)
        self._context.log_text(
            "force",
            Message(
                "{output} switched on manually" if command.on else "{output} switched off manually",
                output=command.name,
            ),
        )

    def _find_output_refusal(self, name: str, on: bool) -> str:
        """Return why an output cannot be switched manually now, or an empty string if it can."""
        context, state = self._context, self._control.state
        if name not in context.machine.outputs:
            return Message("this machine has no output {name}", name=name)
        if state not in _REST_STATES:
            return Message(
                "{name}: outputs can be switched manually only when the machine is at rest, not in "
                "state {state}",
                name=name,
                state=state.value,
            )
        if (
            name == "collet"
            and not on
            and not (context.spindle.is_stopped and not context.spindle.is_requested)
        ):
            return "the collet cannot be opened manually while the spindle is turning"
        return ""
