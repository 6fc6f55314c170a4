"""Machine state and its transitions: start, feed hold, Reset, E-stop, alarms and shutdown."""

from __future__ import annotations

from collections.abc import Callable

from core.alarms import AlarmCode, AlarmReaction
from core.alarms.bus_alarms import CONNECTION_LOSS_CODES
from core.executor import start_conditions
from core.executor.control_status import make_power_up_modal_state
from core.executor.hand_motion.drive_test import DriveTester
from core.executor.hand_motion.handwheel import Handwheel
from core.executor.hand_motion.jogging import create_jogger
from core.executor.hand_motion.touch_off import Homing, TouchOff
from core.executor.interruption_watch import StoreFunction
from core.executor.job import Job, ProgramPass
from core.executor.machine_context import MachineContext
from core.executor.program_motion.cycle import Cycle
from core.executor.program_run import ProgramRun
from core.executor.raised_alarm import (
    AlarmError,
    ErrorCatcher,
    format_log_line,
    log_alarm,
    make_alarm_and_reaction,
)
from core.executor.safety.safe_stop import SafeStop
from core.executor.safety.supervision import OutputMonitor, Supervisor
from core.executor.snapshot import (
    ACTIVE_STATES,
    CLOSED_REASON,
    CYCLE_STATES,
    ESTOP_REASON,
    MANUAL_STATES,
    STOPPED_STATES,
    InterruptedJob,
    LogEvent,
    MachineState,
    require_transition,
)
from core.executor.start_conditions import SPINDLE_FUNCTION, StartAnnouncement
from core.executor.start_warnings import StartWarnings
from core.interpreter.shared.job_setup import InterpreterSetup
from core.interpreter.shared.modal_state import ModalState
from core.message import Message
from core.ports import UnknownPart

_CONTINUED_STATES = frozenset(
    {
        MachineState.RUN,
        MachineState.WAIT,
        MachineState.IDLE,
        MachineState.DISABLED,
        MachineState.JOG,
        MachineState.HOMING,
    }
)
CONFIRMATION_DELAY_S = (
    0.8  # s between a confirmation and a start: 0.5 s between the two palm buttons, plus time to read
)
_STOP_STATES = frozenset({MachineState.ESTOP, MachineState.FAULT, MachineState.DISABLED})


class MachineControl:
    """Complete control of one machine. Only the executor's thread uses it."""

    def __init__(
        self,
        context: MachineContext,
        start_pass: Callable[[Job, InterpreterSetup], ProgramPass],
        store_interruption: StoreFunction,
        interrupted_job: InterruptedJob | None,
    ) -> None:
        self._context = context
        self.program_run = ProgramRun(
            context, start_pass, self.change_state, store_interruption, interrupted_job
        )
        self.status = self.program_run.status
        self.status.modal_state = make_power_up_modal_state(context)
        self.counters = self.program_run.counters
        self.supervisor = Supervisor(context)
        self.safe_stop = SafeStop(context)
        self.jogger = create_jogger(context)
        self.handwheel = Handwheel(context, self.jogger)
        self.drive_tester = DriveTester(context, self.jogger)
        self.touch_off = TouchOff(context, self.jogger)
        self.homing = Homing(context)
        self.announcement = StartAnnouncement()
        self.outputs_watch = OutputMonitor(context, self.program_run)
        warnings = StartWarnings(context, self.status, self.counters)
        self.announcement.sources += [
            warnings.iter_spindle_starts,
            self.outputs_watch.iter_output_announcements,
            warnings.iter_proof_warnings,
            warnings.iter_first_move_warnings,
        ]
        self.confirmed_at = -CONFIRMATION_DELAY_S  # time at which the operator last confirmed a start
        self.jog_end_reason = ""  # why the control ended a jog; it stays ended until the key is released
        self._turned = False  # in the previous tick the spindle turned as commanded
        self._giving_up = False
        self._hindered = ""  # the reason that prevented a start in the previous tick

    @property
    def state(self) -> MachineState:
        """Return the current state of the machine."""
        return self.status.state

    @property
    def cycle(self) -> Cycle | None:
        """Return the running cycle, or None if no cycle runs."""
        return self.program_run.cycle

    @property
    def modal_state(self) -> ModalState:
        """Return the modal state of the executing block, or the stored state if no program runs."""
        return self.program_run.modal_state

    def change_state(self, state: MachineState) -> None:
        """Change the state and log the change. Raises TransitionError if the change is not permitted."""
        if state is self.state:
            return
        require_transition(self.state, state)
        self.status.state = state
        if state is MachineState.SINGLE_BLOCK_STOP:
            self._context.show_stop("single-block")
        elif state in _CONTINUED_STATES:
            self._context.stop = None
        self._context.log_text("state", state.value)

    # --- requests -----------------------------------------------------------------------------------------

    def handle_cycle_start(self) -> None:
        """Start or resume a cycle in response to Cycle Start.

        The call has no effect while a cycle runs.
        """
        state, cycle = self.state, self.cycle
        if state in ACTIVE_STATES or self._giving_up:
            return
        if state in STOPPED_STATES and cycle is not None:
            if not self.refuse_start(
                start_conditions.find_station_inhibit_reason(self._context)
                or cycle.find_resume_refusal_reason()
                or self._unannounced()
            ):
                waits = bool(self._context.spindle.waiting_reason)
                self.announcement.start_functions()
                cycle.resume(starts_spindle=waits)
        elif not self.refuse_start(
            self.program_run.find_start_refusal_reason(state)
            or self._unannounced()
            or self._find_confirmation_refusal()
        ):
            self.announcement.start_functions()
            self.program_run.start_run()

    def refuse_start(self, reason: str) -> bool:
        """Store a start refusal and return True, or clear it and return False if ``reason`` is empty.

        A refusal is also logged.
        """
        self.status.start_refusal_reason = reason
        if reason:
            self._context.log_text("refused", reason)
        return bool(reason)

    def _clear_start_refusal(self) -> None:
        """Clear a displayed start refusal when its cause no longer exists."""
        if self.status.start_refusal_reason:
            now = start_conditions.find_state_inhibit_reason(self._context, self.state)
            if self._hindered == self.status.start_refusal_reason != now:
                self.status.start_refusal_reason = ""
            self._hindered = now

    def handle_spindle_switch(self) -> None:
        """Handle a change of the spindle switch from OFF to AUTO.

        If no cycle is active, a spindle that waits for permission to start is started. In a stopped cycle,
        only Cycle Start turns it on.
        """
        spindle = self._context.spindle
        if self.state not in MANUAL_STATES or not spindle.waiting_reason:
            return
        why = start_conditions.find_collet_inhibit_reason(
            self._context
        ) or self.announcement.find_refusal_reason(self._context.now, SPINDLE_FUNCTION)
        if why:
            self._context.log_text("refused", why)
        else:
            self.announcement.start_functions(SPINDLE_FUNCTION)

    def _find_confirmation_refusal(self) -> str:
        """Return why a start too soon after a confirmation is refused, or an empty string.

        Within 0.8 s, the operator cannot have read the prompt.
        """
        if self._context.now - self.confirmed_at >= CONFIRMATION_DELAY_S:
            return ""
        return (
            "the palm buttons were pressed too soon after the confirmation: release both "
            "buttons, read the prompt, then press both buttons again"
        )

    def _unannounced(self) -> str:
        waits = self._context.spindle.waiting_reason
        unclamped = start_conditions.find_collet_resume_inhibit(self._context) if waits else ""
        return unclamped or self.announcement.find_refusal_reason(self._context.now)

    def start_feed_hold(self, reason: str, source: str = "", code: AlarmCode | None = None) -> None:
        """Hold the cycle, end a jog, stop homing and disable the handwheel.

        ``reason`` is a text of the alarm catalog, or a detail of the alarm ``code``. If a button was
        pressed, ``reason`` is empty and ``source`` names the button.
        """
        if self.handwheel.axis:
            self.handwheel.disable(reason.lower() or "feed hold", self.state)
        if self.state is MachineState.JOG:
            self.stop_jog(reason.lower() or "feed hold")
        elif self.state is MachineState.HOMING:
            self._stop_homing()
        elif self.cycle is not None and self.state in ACTIVE_STATES:
            self._context.spindle.cancel_orientation()
            self.cycle.start_feed_hold(reason, source, code)

    def reset_machine(self) -> None:
        """Cancel the program, stop the spindle and acknowledge alarms."""
        self.status.start_refusal_reason = ""
        self.safe_stop.switch_functions_off()
        if self.status.alarms:
            self._acknowledge()
        elif self.cycle is not None and self.state in CYCLE_STATES:
            job = self.status.job
            self._context.log_stop(
                "reset", Message("{source} was canceled", source=job.source.name) if job is not None else ""
            )
            self._giving_up = True
            self.cycle.stop_canceled_cycle()
            self._leave()
        elif self.state is MachineState.JOG:
            self.start_feed_hold("reset")
        elif self.state is MachineState.HOMING:
            self._stop_homing()

    def stop_jog(self, reason: str) -> None:
        """Stop manual motion and a touch-off for the given reason. Raises DriverError if a driver fails."""
        self.touch_off.cancel_touch_off(reason)
        self.jogger.stop()

    def release_jog_key(self) -> None:
        """Handle the release of a jog key or button, so that the next press can start a jog.

        A late or repeated release stops any manual motion, but has no effect on a program or homing that
        started after the jog. Raises DriverError if a driver fails.
        """
        self.jog_end_reason = ""
        if self.state is MachineState.JOG:
            self.stop_jog("the key or button was released")

    def _end_jog(self, reason: str) -> None:
        """End manual motion, and refuse to renew the jog until the key is released."""
        self.jog_end_reason = (
            "" if self.jogger.is_stepping or self.jogger.target_position is not None else reason
        )
        self.stop_jog(reason)

    def _check_spindle(self) -> None:
        """End manual motion when the spindle stops, to prevent a crash of the tool into the stopped part."""
        spindle = self._context.spindle
        turned, self._turned = self._turned, spindle.is_requested and not spindle.is_too_slow
        if not turned or self._turned or self.state is not MachineState.JOG:
            return
        why = Message(
            "the spindle has stopped: {why_slow}",
            why_slow=spindle.spindle_stopped_reason
            or "the spindle speed is below half of the commanded speed",
        ).lower()
        self._end_jog(why)
        if self.handwheel.axis:
            self.handwheel.disable(why, self.state)
        else:
            self._context.log_text("refused", Message("jog: {why}", why=why))

    def _ran_into_setter(self) -> None:
        why = "the tool setter is triggered; jog the tool away from it"
        self.stop_jog(why)
        if self.handwheel.axis:
            self.handwheel.disable(why, self.state)
        else:
            self._context.log_text("refused", Message("jog: {why}", why=why))

    def move_by_handwheel(self) -> None:
        """Move the selected axis as the handwheel turns. Raises DriverError if a driver fails."""
        if self.handwheel.follow_clicks(self.state):
            self.change_state(MachineState.JOG)

    def handle_estop(self, is_pressed: bool) -> None:
        """React to the hardware E-stop, which has already stopped the machine.

        Nothing starts when the E-stop is released.
        """
        if is_pressed and self.state is not MachineState.ESTOP:
            self.safe_stop.run_steps(AlarmReaction.DRIVES_OFF)
            self._context.show_stop("estop")
            self._cancel_active_function(ESTOP_REASON)
            self.change_state(MachineState.ESTOP)
        elif not is_pressed and self.state is MachineState.ESTOP:
            self.change_state(MachineState.DISABLED)

    # --- actions in every tick ----------------------------------------------------------------------------

    def advance_one_tick(self) -> None:
        """Advance the active function; raises AlarmError, MotionError or DriverError if it fails."""
        self._finish_stopping()
        self._clear_start_refusal()
        self.program_run.update_between_cycles()
        self._check_spindle()
        if self.touch_off.check_state(self.state):
            self._ran_into_setter()
        if self.cycle is not None and self.state in CYCLE_STATES:
            if self._giving_up:
                self._leave()
                return
            if self.state in ACTIVE_STATES:
                self._check_queue(self.cycle)
            self.cycle.advance_one_tick()
        elif self.state is MachineState.JOG:
            self._advance_manual_motion()
        elif self.state is MachineState.HOMING and self.homing.home_next_axis():
            self.change_state(MachineState.IDLE)

    def _advance_manual_motion(self) -> None:
        """Advance a touch-off or a jog. The jog ends when the axis is at rest."""
        if self.touch_off.phase is not None:
            self.touch_off.advance_one_tick()
            return
        self.drive_tester.stop_if_guard_open()
        self.jogger.stop_if_button_released()
        if self.jogger.finish_if_at_rest():
            self.change_state(MachineState.IDLE)

    def _check_queue(self, cycle: Cycle) -> None:
        """Hold the cycle if the setpoint queue is nearly empty because it was refilled too late."""
        motion = self.program_run.motion
        left = motion.starvation_time_s - self._context.now
        if motion.has_path_section and left < self._context.machine.timing.low_water_time_s:
            self.counters.underrun_count += 1
            self._context.log_text("starved", "feed hold: computer busy; the axes stop on the path")
            cycle.hold_for_underrun()

    def _leave(self) -> None:
        if self.program_run.finish_canceled_cycle():
            self._giving_up = False

    def _stop_homing(self) -> None:
        self.homing.stop()
        self.change_state(MachineState.IDLE)

    # --- alarms -------------------------------------------------------------------------------------------

    def raise_alarm(self, error: AlarmError) -> None:
        """Stop the machine and show the alarm. An alarm that is already active is ignored."""
        context = self._context
        alarm, reaction = make_alarm_and_reaction(error, context.line_number, context.now)
        if any(old.code == alarm.code for old in self.status.alarms):
            return
        log_alarm(alarm)
        if reaction is AlarmReaction.HOLD and self._handle_hold_alarm(error):
            return
        self.status.alarms = (*self.status.alarms, alarm)
        self.status.are_drives_switched_off = (
            self.status.are_drives_switched_off or reaction is AlarmReaction.DRIVES_OFF
        )
        self.safe_stop.run_steps(reaction)
        self._cancel_active_function(
            Message("ALARM {number}: {alarms}", number=alarm.number, alarms=alarm.text)
        )
        if self.state not in {MachineState.ESTOP, MachineState.FAULT}:
            self.change_state(MachineState.FAULT)
        context.log_event(LogEvent(context.now, "alarm", format_log_line(alarm), alarm.line, alarm))

    def _handle_hold_alarm(self, error: AlarmError) -> bool:
        """Handle an alarm whose reaction is feed hold; return False if no axis is moving."""
        if self.cycle is not None and self.state in ACTIVE_STATES:
            self.cycle.hold_for_underrun(error.code, error.detail)
        elif self.state in MANUAL_STATES:
            self.jogger.stop()
            stop = self._context.log_stop(error.code, error.detail)
            self._context.log_text("refused", stop.text.lower())
        else:
            return False
        return True

    def handle_internal_error(self, error: BaseException) -> None:
        """Change to the alarm state because of an internal error.

        The change is made even if the transition table does not permit it.
        """
        if self.state is not MachineState.ESTOP:
            self.status.state = MachineState.FAULT
        self.raise_alarm(
            AlarmError("internal", Message("{name}: {error}", name=type(error).__name__, error=error))
        )

    def _cancel_active_function(self, reason: str) -> None:
        """Cancel the active function, even if its driver no longer responds."""
        self._giving_up = False
        self.jogger.clear_jog()  # The stop has ended the jog, so a later release must not stop anything.
        with ErrorCatcher() as trial:
            self.program_run.cancel_run(reason)
        if trial.error is not None:
            self.program_run.discard_run()
            self._context.log_text(
                "alarm", Message("fault while canceling the program: {error}", error=trial.error)
            )

    def _finish_stopping(self) -> None:
        """Retry a safe stop that is incomplete, and raise an alarm if a driver still does not execute it."""
        if self.state in _STOP_STATES:
            self.safe_stop.retry_failed_steps()
            if self.safe_stop.failed_steps_text and not any(
                each.code in CONNECTION_LOSS_CODES for each in self.status.alarms
            ):
                self.raise_alarm(
                    AlarmError(
                        "not-safe",
                        Message(
                            "a driver does not carry out the stop command for {undone}",
                            undone=self.safe_stop.failed_steps_text,
                        ),
                    )
                )

    def shut_down(self) -> None:
        """Stop all motion and switch everything off."""
        self.safe_stop.run_steps(AlarmReaction.DRIVES_OFF)
        self.safe_stop.make_final_retry()
        self._cancel_active_function(CLOSED_REASON)
        if self.state is not MachineState.ESTOP:
            self.status.state = MachineState.DISABLED

    def _switch_drives_off(self) -> None:
        """Switch the drives off.

        A failure is ignored if the drives no longer communicate.
        """
        with ErrorCatcher() as off:
            self._context.ports.axes.enable(False)
        if off.error is not None and UnknownPart.AXES not in self._context.unknown_parts:
            raise off.error

    def _acknowledge(self) -> None:
        """Acknowledge the alarms when the axes are at rest.

        Drives that an alarm has switched off remain off.
        """
        context, status = self._context, self.status
        if context.axis_sample.moving:
            context.log_text("refused", "reset: wait until the axes have stopped")
            return
        if status.are_drives_switched_off:
            self._switch_drives_off()
        context.ports.axes.clear_fault()
        status.are_drives_switched_off, status.alarms = False, ()
        self.safe_stop.discard_failed_steps()
        self.supervisor.accept_current_positions()
        context.axis_sample = context.ports.axes.sample()
        if self.state is MachineState.FAULT:
            self.change_state(MachineState.IDLE if context.axis_sample.enabled else MachineState.DISABLED)
