"""The machine state and all its transitions: start, feed hold, Reset, E-stop, alarms and shutdown."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from core.alarms import Code, Reaction
from core.alarms.bus_alarms import CUT_OFF
from core.executor import start_conditions
from core.executor.control_status import modal_at_power_up
from core.executor.hand_motion.drive_test import DriveTester
from core.executor.hand_motion.handwheel import Handwheel
from core.executor.hand_motion.jogging import jogger_of
from core.executor.hand_motion.touch_off import Homing, TouchOff
from core.executor.interruption_watch import Note
from core.executor.job import Job, ProgramPass
from core.executor.machine_context import MachineContext
from core.executor.program_motion.cycle import Cycle
from core.executor.program_run import ProgramRun
from core.executor.raised_alarm import AlarmError, Attempt, alarm_and_reaction, log_alarm, log_line
from core.executor.safety.safe_stop import SafeStop
from core.executor.safety.supervision import OutputsWatch, Supervisor
from core.executor.snapshot import (
    ACTIVE,
    BY_HAND,
    CLOSED,
    CYCLE,
    ESTOP,
    LINES,
    STOPPED,
    Event,
    InterruptedJob,
    State,
    demand_allowed,
)
from core.executor.start_conditions import SPINDLE, Announcement, Starting
from core.interpreter.shared.job_setup import Setup
from core.interpreter.shared.modal_state import Modal
from core.message import Message
from core.ports import Unknown

_GOES_ON = frozenset({State.RUN, State.WAIT, State.IDLE, State.DISABLED, State.JOG, State.HOME})
MEANT = 0.8  # s between a confirmation and a start: 0.5 s between the two palm buttons, plus time to read
_AT_REST = frozenset({State.IDLE, State.DISABLED})
_STOPPED = frozenset({State.ESTOP, State.FAULT, State.DISABLED})


class MachineControl:
    """The complete control of one machine. Used by the executor's thread only."""

    def __init__(
        self,
        context: MachineContext,
        passes: Callable[[Job, Setup], ProgramPass],
        note: Note,
        left: InterruptedJob | None,
    ) -> None:
        self._context = context
        self.program_run = ProgramRun(context, passes, self.enter, note, left)
        self.status = self.program_run.status
        self.status.modal = modal_at_power_up(context)
        self.counters = self.program_run.counters
        self.supervisor = Supervisor(context)
        self.safe = SafeStop(context)
        self.jogger = jogger_of(context)
        self.wheel = Handwheel(context, self.jogger)
        self.drive_test = DriveTester(context, self.jogger)
        self.touch = TouchOff(context, self.jogger)
        self.homing = Homing(context)
        self.announcement = Announcement()
        self.disturbance = OutputsWatch(context, self.program_run)
        self.announcement.sources += [self._spindle_starts, self.disturbance.starts, self._warned]
        self.announcement.sources.append(self._first_move_warned)
        self.meant_at = -MEANT  # time at which the operator last confirmed a start
        self.jog_ended = ""  # why the control ended a jog; it stays ended until the key is released
        self._turned = False  # in the previous tick the spindle turned as commanded
        self._giving_up = False
        self._hindered = ""  # the reason that prevented a start in the previous tick

    @property
    def state(self) -> State:
        """The present state of the machine."""
        return self.status.state

    @property
    def cycle(self) -> Cycle | None:
        """The running cycle, or None."""
        return self.program_run.cycle

    @property
    def modal(self) -> Modal:
        """The modal state of the block being executed, or the state in force between two programs."""
        return self.program_run.modal

    def enter(self, state: State) -> None:
        """Change the state and log the change. Raises TransitionError if the change is not permitted."""
        if state is self.state:
            return
        demand_allowed(self.state, state)
        self.status.state = state
        if state is State.BLOCK_END:
            self._context.show_stop("single-block")
        elif state in _GOES_ON:
            self._context.stop = None
        self._context.log("state", state.value)

    # --- requests -----------------------------------------------------------------------------------------

    def start(self) -> None:
        """Handle Cycle Start: start or resume a cycle. Has no effect while a cycle runs."""
        state, cycle = self.state, self.cycle
        if state in ACTIVE or self._giving_up:
            return
        if state in STOPPED and cycle is not None:
            if not self.refuse(
                start_conditions.station_stop(self._context) or cycle.why_not_on() or self._unannounced()
            ):
                waits = bool(self._context.spindle.waits)
                self.announcement.begin()
                cycle.go_on(starts_spindle=waits)
        elif not self.refuse(self.program_run.refusal(state) or self._unannounced() or self._just_meant()):
            self.announcement.begin()
            self.program_run.begin()

    def refuse(self, why: str) -> bool:
        """Store and log a start refusal. Return True if ``why`` contains a reason."""
        self.status.start_refused = why
        if why:
            self._context.log("refused", why)
        return bool(why)

    def _forget_refusal(self) -> None:
        """Clear a displayed start refusal when its cause in the machine has gone."""
        if self.status.start_refused:
            now = start_conditions.hindrance(self._context, self.state)
            if self._hindered == self.status.start_refused != now:
                self.status.start_refused = ""
            self._hindered = now

    def spindle_switch(self) -> None:
        """Handle the spindle switch turned from OFF to AUTO.

        Between programs the switch starts a waiting spindle. In a stopped cycle only Cycle Start does.
        """
        spindle = self._context.spindle
        if self.state not in BY_HAND or not spindle.waits:
            return
        why = start_conditions.unclamped(self._context) or self.announcement.refusal(
            self._context.now, SPINDLE
        )
        if why:
            self._context.log("refused", why)
        else:
            self.announcement.begin(SPINDLE)

    def _just_meant(self) -> str:
        """Return why a start within 0.8 s after a confirmation is refused, or an empty string.

        The operator cannot have read the prompt in that time.
        """
        if self._context.now - self.meant_at >= MEANT:
            return ""
        return (
            "the palm buttons were pressed too soon after the confirmation: release both "
            "buttons, read the prompt, then press both buttons again"
        )

    def _unannounced(self) -> str:
        waits = self._context.spindle.waits
        unclamped = start_conditions.unclamped_by_program(self._context) if waits else ""
        return unclamped or self.announcement.refusal(self._context.now)

    def _spindle_starts(self) -> Iterator[Starting]:
        """Yield the announcement of a waiting spindle that the next start turns on.

        In a cycle only Cycle Start turns it on. Between programs the spindle switch does too.
        """
        spindle = self._context.spindle
        rpm, by_hand = spindle.would_turn, self.state in BY_HAND
        if rpm and (by_hand or (self.state in STOPPED and not spindle.start_barred)):
            way = "FORWARD" if rpm > 0.0 else "REVERSE"
            text = Message("SPINDLE STARTS AT {rpm} RPM {direction}", rpm=f"{abs(rpm):.0f}", direction=way)
            yield Starting(
                SPINDLE,
                text if spindle.auto else Message("SET SPINDLE SWITCH TO AUTO: {start}", start=text),
                spindle.permit,
                rpm,
            )

    def _warned(self) -> Iterator[Starting]:
        """Yield the warnings of the proof, which the operator must read before the program starts."""
        status = self.status
        job, proof = status.job, status.proof
        if self.state not in _AT_REST or status.starts in LINES or job is None or proof is None:
            return
        # otherwise the start is refused anyway
        if proof.digest == job.digest and proof.warned and not proof.errors:
            first, more = proof.warned[0], len(proof.warned) - 1
            said = Message("{first_error} ({more} MORE)", first_error=first, more=more) if more else first
            yield Starting("warned" + job.digest, Message("WARNING: {warned}", warned=said), lambda: None)

    def _first_move_warned(self) -> Iterator[Starting]:
        """Yield the warning that the first move may hit a part that is unknown or only assumed."""
        if self.state not in _AT_REST or not self.status.checks_starts:
            return
        found = start_conditions.first_move_verdict(self._context, self.status, self.counters.begun)
        if found is not None and found.warned:
            yield Starting(
                "first-move" + found.job, Message("WARNING: {warned}", warned=found.warned), lambda: None
            )

    def feed_hold(self, reason: str, by: str = "", code: Code | None = None) -> None:
        """Hold the cycle, end a jog, stop homing and disable the handwheel.

        ``reason`` is a text of the alarm catalog, or a detail for ``code``. It is empty if a button was
        pressed; ``by`` then names the button.
        """
        if self.wheel.axis:
            self.wheel.end(reason.lower() or "feed hold", self.state)
        if self.state is State.JOG:
            self.stop_jog(reason.lower() or "feed hold")
        elif self.state is State.HOME:
            self._stop_homing()
        elif self.cycle is not None and self.state in ACTIVE:
            self._context.spindle.break_off()
            self.cycle.hold(reason, by, code)

    def reset(self) -> None:
        """Cancel the program, stop the spindle and acknowledge alarms."""
        self.status.start_refused = ""
        self.safe.functions_off()
        if self.status.alarms:
            self._acknowledge()
        elif self.cycle is not None and self.state in CYCLE:
            job = self.status.job
            self._context.log_stop(
                "reset", Message("{source} was canceled", source=job.source.name) if job is not None else ""
            )
            self._giving_up = True
            self.cycle.abandon()
            self._leave()
        elif self.state is State.JOG:
            self.feed_hold("reset")
        elif self.state is State.HOME:
            self._stop_homing()

    def stop_jog(self, why: str) -> None:
        """Stop manual motion and a touch-off for the reason ``why``. Raises DriverError."""
        self.touch.end(why)
        self.jogger.stop()

    def let_go(self) -> None:
        """Handle the release of a jog key or button, after which the next press counts again.

        A late or repeated release does not stop a motion that started after the jog. Raises DriverError if a
        driver fails.
        """
        self.jog_ended = ""
        if self.state is State.JOG:
            self.stop_jog("the key or button was released")

    def _end_jog(self, why: str) -> None:
        """End manual motion and refuse further renewals until the key is released."""
        self.jog_ended = "" if self.jogger.stepping or self.jogger.goal is not None else why
        self.stop_jog(why)

    def _mind_spindle(self) -> None:
        """End manual motion when the spindle stops, because the tool would crash into the stopped part."""
        spindle = self._context.spindle
        turned, self._turned = self._turned, spindle.asked and not spindle.fails
        if not turned or self._turned or self.state is not State.JOG:
            return
        why = Message(
            "the spindle has stopped: {why_slow}",
            why_slow=spindle.why_slow or "the spindle speed is below half of the commanded speed",
        ).lower()
        self._end_jog(why)
        if self.wheel.axis:
            self.wheel.end(why, self.state)
        else:
            self._context.log("refused", Message("jog: {why}", why=why))

    def _ran_into_setter(self) -> None:
        why = "the tool setter is triggered; jog the tool away from it"
        self.stop_jog(why)
        if self.wheel.axis:
            self.wheel.end(why, self.state)
        else:
            self._context.log("refused", Message("jog: {why}", why=why))

    def follow_wheel(self) -> None:
        """Move the selected axis as the handwheel turns. Raises DriverError if a driver fails."""
        if self.wheel.turn(self.state):
            self.enter(State.JOG)

    def mirror_estop(self, pressed: bool) -> None:
        """Follow the E-stop of the hardware, which has stopped the machine.

        Nothing starts when it is released.
        """
        if pressed and self.state is not State.ESTOP:
            self.safe.react(Reaction.OFF)
            self._context.show_stop("estop")
            self._give_up(ESTOP)
            self.enter(State.ESTOP)
        elif not pressed and self.state is State.ESTOP:
            self.enter(State.DISABLED)

    # --- actions in every tick ----------------------------------------------------------------------------

    def go_on(self) -> None:
        """Advance the active function by one tick. Raises AlarmError, MotionError or DriverError."""
        self._finish_stopping()
        self._forget_refusal()
        self.program_run.look()
        self._mind_spindle()
        if self.touch.mind(self.state):
            self._ran_into_setter()
        if self.cycle is not None and self.state in CYCLE:
            if self._giving_up:
                self._leave()
                return
            if self.state in ACTIVE:
                self._mind_the_queue(self.cycle)
            self.cycle.step()
        elif self.state is State.JOG:
            self._go_on_by_hand()
        elif self.state is State.HOME and self.homing.step():
            self.enter(State.IDLE)

    def _go_on_by_hand(self) -> None:
        """Advance a touch-off or a jog. The jog is over when the axis is at rest."""
        if self.touch.phase is not None:
            self.touch.step()
            return
        self.drive_test.look()
        self.jogger.mind_button()
        if self.jogger.over():
            self.enter(State.IDLE)

    def _mind_the_queue(self, cycle: Cycle) -> None:
        """Hold the cycle if the setpoint queue runs low, because the computer was too late to refill it."""
        motion = self.program_run.motion
        left = motion.starving - self._context.now
        if motion.active and left < self._context.machine.timing.low_water:
            self.counters.underruns += 1
            self._context.log("starved", "feed hold: computer busy; the axes stop on the path")
            cycle.starve()

    def _leave(self) -> None:
        if self.program_run.leave():
            self._giving_up = False

    def _stop_homing(self) -> None:
        self.homing.stop()
        self.enter(State.IDLE)

    # --- alarms -------------------------------------------------------------------------------------------

    def alarm(self, trouble: AlarmError) -> None:
        """Stop the machine and show the alarm. An alarm that is already active is ignored."""
        context = self._context
        alarm, reaction = alarm_and_reaction(trouble, context.line, context.now)
        if any(old.code == alarm.code for old in self.status.alarms):
            return
        log_alarm(alarm)
        if reaction is Reaction.HOLD and self._holds(trouble):
            return
        self.status.alarms = (*self.status.alarms, alarm)
        self.status.power_off = self.status.power_off or reaction is Reaction.OFF
        self.safe.react(reaction)
        self._give_up(Message("ALARM {number}: {alarms}", number=alarm.number, alarms=alarm.text))
        if self.state not in {State.ESTOP, State.FAULT}:
            self.enter(State.FAULT)
        context.log_event(Event(context.now, "alarm", log_line(alarm), alarm.line, alarm))

    def _holds(self, trouble: AlarmError) -> bool:
        """Handle an alarm whose reaction is feed hold; return False if nothing is moving."""
        if self.cycle is not None and self.state in ACTIVE:
            self.cycle.starve(trouble.code, trouble.detail)
        elif self.state in BY_HAND:
            self.jogger.stop()
            stop = self._context.log_stop(trouble.code, trouble.detail)
            self._context.log("refused", stop.text.lower())
        else:
            return False
        return True

    def failed(self, error: BaseException) -> None:
        """Enter the alarm state for an internal error, even if the transition table does not permit it."""
        if self.state is not State.ESTOP:
            self.status.state = State.FAULT
        self.alarm(AlarmError("internal", Message("{name}: {error}", name=type(error).__name__, error=error)))

    def _give_up(self, why: str) -> None:
        """Cancel the active function, even if its driver no longer responds."""
        self._giving_up = False
        self.jogger.forget()  # The stop has ended the jog, so a later release must not stop anything.
        with Attempt() as trial:
            self.program_run.forget(why)
        if trial.error is not None:
            self.program_run.drop()
            self._context.log(
                "alarm", Message("fault while canceling the program: {error}", error=trial.error)
            )

    def _finish_stopping(self) -> None:
        """Retry an incomplete safe stop and raise an alarm if a driver still does not carry it out."""
        if self.state in _STOPPED:
            self.safe.again()
            if self.safe.undone and not any(each.code in CUT_OFF for each in self.status.alarms):
                self.alarm(
                    AlarmError(
                        "not-safe",
                        Message(
                            "a driver does not carry out the stop command for {undone}",
                            undone=self.safe.undone,
                        ),
                    )
                )

    def shut(self) -> None:
        """Stop all motion and switch everything off."""
        self.safe.react(Reaction.OFF)
        self.safe.finish()
        self._give_up(CLOSED)
        if self.state is not State.ESTOP:
            self.status.state = State.DISABLED

    def _power_off(self) -> None:
        """Switch the drives off. A failure is ignored if the drives no longer communicate."""
        with Attempt() as off:
            self._context.ports.axes.enable(False)
        if off.error is not None and Unknown.SLIDES not in self._context.unknown:
            raise off.error

    def _acknowledge(self) -> None:
        """Acknowledge the alarms at rest. Drives that an alarm has switched off remain off."""
        context, status = self._context, self.status
        if context.sample.moving:
            context.log("refused", "reset: wait until the axes have stopped")
            return
        if status.power_off:
            self._power_off()
        context.ports.axes.clear_fault()
        status.power_off, status.alarms = False, ()
        self.safe.forget()
        self.supervisor.acknowledged()
        context.sample = context.ports.axes.sample()
        if self.state is State.FAULT:
            self.enter(State.IDLE if context.sample.enabled else State.DISABLED)
