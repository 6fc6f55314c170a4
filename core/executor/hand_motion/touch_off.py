"""Homing of the axes in their homing order, and touch-off of a tool on a tool setter or probe.

As in a jog, the axis stops when the key is released. The touch-off reports the position of the second touch
with its uncertainty. This module does not change any offset.
"""

from __future__ import annotations

from core.executor.commands import TouchOffTool
from core.executor.hand_motion.jogging import MAX_LEASE_S, Jogger
from core.executor.machine_context import MachineContext
from core.executor.snapshot import MachineState, TouchPhase, TouchResult
from core.executor.start_conditions import is_guard_open
from core.key_declaration import MM_PER_INCH
from core.machine.setter_table import ToolSetterModel
from core.message import Message
from core.ports import PROBE_INPUT, StopMode, TouchLatch, UnknownPart

_SETTLED_S = 0.1  # s at rest before the input is evaluated
_RENEWAL_INTERVAL_S = 0.03  # s between two renewals of the motion
_TARGET_TOLERANCE = 0.003  # mm; within this distance, or two counts, the target is reached
_NONE = -1
_SETTLING_TIME_S = 1.0  # s that the axes may take to stop before the next axis is homed


class TouchOff:
    """Touch-off sequence of one tool on the tool setter.

    ``phase`` is the active phase, or None if no touch-off runs. ``last_result`` is the result of the last
    touch-off.
    """

    def __init__(self, context: MachineContext, jogger: Jogger) -> None:
        self._context = context
        self._jogger = jogger
        self._model = context.machine.hardware.find_driver_table(ToolSetterModel)
        self.phase: TouchPhase | None = None
        self.last_result: TouchResult | None = None
        self._ended = _NONE  # number of the key press whose touch-off has ended
        self._command = TouchOffTool("", 0, 0.0, _NONE)
        self._until = 0.0  # end of the lease
        self._start = self._first = 0.0  # positions at the start and at the first touch
        self._target = 0.0
        self._was_made = False  # state of the input in the previous tick
        self._braking = False  # the axis is braking after a touch
        self._renewed = self._rested = 0.0
        self._seen = (0.0, 0.0)  # time and position in the previous tick
        self._latch: TouchLatch | None = None
        self._failed = ""  # the failure to report when the axis is back

    def handle_request(self, command: TouchOffTool, state: MachineState, handwheel_axis: str) -> bool:
        """Start a touch-off or renew its lease; return whether it was started.

        Raises DriverError if a driver fails.
        """
        if command.press == self._ended:
            return False  # the key is still pressed, but its touch-off has ended
        if self.phase is None:
            return self._begin(command, state, handwheel_axis)
        if (command.axis, command.sign, command.press) != (
            self._command.axis,
            self._command.sign,
            self._command.press,
        ):
            self.cancel_touch_off("another touch-off direction was selected")
            self._ended = command.press
            return False
        self._until = self._context.now + min(command.lease, MAX_LEASE_S)
        return False

    def cancel_touch_off(self, reason: str) -> None:
        """Cancel the touch-off for the given reason and stop the axis.

        Raises DriverError if a driver fails.
        """
        if self.phase is None:
            return
        self._jogger.stop()
        self._over(reason)

    def check_state(self, state: MachineState) -> bool:
        """Check the machine state and the setter input; return True if a jog touches the tool setter.

        The function is called once per tick. A touch-off ends if the machine leaves the jog state. A jog
        that touches the setter must stop; a new jog can then move away from it.
        """
        before, self._was_made = self._was_made, self._made
        if self.phase is not None and state is not MachineState.JOG:
            self._over(Message("the machine is in state {state}", state=state.value))
        runs_in = self._was_made and not before and self._model is not None
        return runs_in and self.phase is None and state is MachineState.JOG

    def advance_one_tick(self) -> None:
        """Advance the touch-off by one tick. Raises DriverError if a driver fails."""
        assert self.phase is not None
        if why := self._find_abort_reason():
            self.cancel_touch_off(why)
            return
        here = self._here
        if self._braking:
            if self._jogger.finish_if_at_rest():
                self._braking = False
                self._at_rest(here)
        elif self._made and self.phase in {TouchPhase.SEARCH, TouchPhase.SLOW_TOUCH}:
            self._handle_touch(here)
        elif self._made and self.phase is TouchPhase.RETURN:
            self.cancel_touch_off("a touch was detected on the return move; check the tool setter")
        elif self._move_to_target(here):
            self._arrived()
        self._seen = (self._context.axis_sample.t, here)

    # --- conditions -----------------------------------------------------------------------------------------

    def _begin(self, command: TouchOffTool, state: MachineState, wheel: str) -> bool:
        if why := self._find_refusal(command, state, wheel):
            self._ended = command.press
            self._context.log_text("refused", Message("touch-off: {why}", why=why))
            return False
        self._command, self._failed, self._latch = command, "", None
        self._until = self._context.now + min(command.lease, MAX_LEASE_S)
        self._start = self._here
        self._seen = (self._context.axis_sample.t, self._start)
        self._jogger.clear_jog()
        assert self._model is not None
        if self._context.ports.touch is not None:
            self._context.ports.touch.arm_latch()
        self._go(TouchPhase.SEARCH, self._start + command.sign * self._model.search)
        return True

    def _find_refusal(self, command: TouchOffTool, state: MachineState, wheel: str) -> str:
        """Return why a touch-off may not start now, or an empty string if it may."""
        axis, inputs = command.axis, self._context.inputs
        if self._model is None or PROBE_INPUT not in self._context.machine.inputs:
            return "this machine has no tool setter; add [setter] and the input probe to the machine file"
        if axis not in {"X", "Z"} or command.sign not in {-1, 1}:
            return Message("a tool cannot be touched off along {axis}", axis=axis or "no axis")
        reasons = (
            (state is not MachineState.IDLE, Message("not available in state {state}", state=state.value)),
            (
                not self._context.axis_sample.homed[self._index(axis)],
                Message("{axis} is not homed, so its position is not valid", axis=axis),
            ),
            (
                inputs.get(PROBE_INPUT, False),
                (
                    "the probe input is already on; check whether the tool setter is touched or "
                    "its cable is damaged"
                ),
            ),
            (wheel != "", "the handwheel is selected; deselect it first"),
        )
        found = next((why for so, why in reasons if so), "")
        return found or self._find_abort_reason(command) or self._find_travel_refusal(command)

    def _find_abort_reason(self, command: TouchOffTool | None = None) -> str:
        """Return why the touch-off must be canceled, or an empty string if it can continue.

        ``command`` is a touch-off that has not started yet.
        """
        context = self._context
        button = (command or self._command).while_on
        reasons = (
            (command is None and context.now > self._until, "the key or button was released"),
            (
                bool(button) and not context.is_button_pressed(button),
                Message("button {button} was released", button=button),
            ),
            (context.station_signals.is_hold_requested, "feed hold is pressed"),
            (is_guard_open(context), "the guard is open: close it"),
            (
                context.spindle.is_requested or not context.spindle.is_stopped,
                ("the spindle is turning: stop it first"),
            ),
            (
                PROBE_INPUT not in context.inputs or UnknownPart.INPUTS in context.unknown_parts,
                "the probe input is not being read; check its terminal",
            ),
        )
        return next((why for so, why in reasons if so), "")

    def _find_travel_refusal(self, command: TouchOffTool) -> str:
        """Return why the search move would exceed the travel limits, or an empty string if it would not.

        The axis must be able to travel the full search distance.
        """
        assert self._model is not None
        axis = self._context.machine.find_axis(command.axis)
        low, high = axis.travel_with_margin
        here = self._context.axis_sample.actual[self._index(command.axis)]
        end = here + command.sign * (self._model.search + self._model.overtravel)
        if low <= end <= high:
            return ""
        far = self._format_length(abs(end - (high if command.sign > 0 else low)))
        return Message(
            "the search for the touch point would exceed the travel of {axis} by "
            "{distance}; jog the axis back first",
            axis=command.axis,
            distance=far,
        )

    def _format_length(self, mm: float) -> str:
        """Return a length as text in the units of the machine file."""
        return (
            Message("{mm} in", mm=f"{mm / MM_PER_INCH:.3f}")
            if self._context.machine.is_inch
            else Message("{unit} mm", unit=f"{mm:.2f}")
        )

    # --- phases of a touch-off ------------------------------------------------------------------------------

    @property
    def _made(self) -> bool:
        return self._context.inputs.get(PROBE_INPUT, False)

    @property
    def _here(self) -> float:
        return self._context.axis_sample.actual[self._index(self._command.axis)]

    def _index(self, axis: str) -> int:
        return self._context.ports.axes.axes.index(axis)

    def _go(self, phase: TouchPhase, target: float) -> None:
        self.phase, self._target, self._rested = phase, target, 0.0
        self._renewed = -1.0
        self._move_to_target(self._here)

    def _move_to_target(self, position: float) -> bool:
        """Continue the motion to the target; return whether the axis is at rest at the target."""
        context, model, command = self._context, self._model, self._command
        assert model is not None
        axis = context.machine.find_axis(command.axis)
        if (
            abs(position - self._target)
            <= max(_TARGET_TOLERANCE, 2 * axis.count_size, axis.in_position_tolerance)
            and self._jogger.finish_if_at_rest()
        ):
            self._rested = self._rested or context.now
            return context.now - self._rested >= _SETTLED_S
        if context.now - self._renewed >= _RENEWAL_INTERVAL_S:
            self._renewed = context.now
            speed = model.slow if self.phase is TouchPhase.SLOW_TOUCH else model.speed
            self._jogger.jog_to_target(command.axis, self._target, speed, self._until - context.now)
        return False

    def _handle_touch(self, position: float) -> None:
        """Stop the axis because the input has turned on, and store the position."""
        context, port = self._context, self._context.ports.touch
        if self.phase is TouchPhase.SLOW_TOUCH:
            kept = port.read_latch() if port is not None else None
            late = context.axis_sample.t - self._seen[0]
            self._latch = kept or TouchLatch(context.axis_sample.t, context.axis_sample.actual, late)
        else:
            self._first = position
        self._jogger.stop()
        self._braking = True

    def _at_rest(self, here: float) -> None:
        assert self._model is not None
        model, sign = self._model, self._command.sign
        place = (
            self._first
            if self._latch is None
            else self._latch.axis_positions[self._index(self._command.axis)]
        )
        over = (here - place) * sign
        if over > model.overtravel:
            far = self._format_length(over)
            self.cancel_touch_off(
                Message(
                    "the axis moved {distance} past the touch point, which is more than the "
                    "overtravel setting; check the tool setter",
                    distance=far,
                )
            )
        elif self.phase is TouchPhase.SEARCH:
            self._go(TouchPhase.BACK_OFF, self._first - sign * model.back_off)
        else:
            self._go(TouchPhase.RETREAT, place - sign * model.back_off)

    def _arrived(self) -> None:
        assert self._model is not None
        model, sign, port = self._model, self._command.sign, self._context.ports.touch
        if self.phase is TouchPhase.SEARCH:
            self._failed = Message(
                "no touch detected within {search}", search=self._format_length(model.search)
            )
            self._go(TouchPhase.RETURN, self._start)
        elif self.phase is TouchPhase.RETURN:
            self._over(self._failed)
        elif self.phase is TouchPhase.SLOW_TOUCH:
            self._failed = "no second touch detected; check whether the tool or the tool setter is loose"
            self._go(TouchPhase.RETURN, self._first - sign * model.back_off)
        elif self._made:
            far = self._format_length(model.back_off)
            self._over(
                Message(
                    "the probe input is still on after the tool has backed off {distance} from the touch "
                    "point; check the stylus and the cable",
                    distance=far,
                )
            )
        elif self.phase is TouchPhase.BACK_OFF:
            if port is not None:
                port.arm_latch()
            self._go(TouchPhase.SLOW_TOUCH, self._first + sign * model.overtravel)
        else:
            self._finish_measurement()

    def _finish_measurement(self) -> None:
        """Finish the touch-off with the measured position, corrected by half of the detection delay.

        The other half of the delay, plus half an encoder count, is the uncertainty.
        """
        assert self._latch is not None
        command, place = self._command, self._latch.axis_positions[self._index(self._command.axis)]
        assert self._model is not None
        half = self._model.slow * self._latch.max_delay_s / 2.0
        count = self._context.machine.find_axis(command.axis).count_size
        self._over("", place - command.sign * half, half + count / 2.0)

    def _over(self, why: str, place: float | None = None, error: float = 0.0) -> None:
        command, count = self._command, self.last_result.number if self.last_result is not None else 0
        self.phase, self._ended, self._braking = None, command.press, False
        self.last_result = TouchResult(count + 1, command.axis, command.sign, place, error, why)
        if why:
            self._context.log_text("refused", Message("touch-off: {why}", why=why))


class Homing:
    """Homing sequence that homes one axis after the other."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._left: list[str] = []
        self._now = ""
        self._found_at = 0.0  # time at which the last axis was homed, s

    def start_homing(self, name: str) -> str:
        """Home one axis, or all axes if ``name`` is empty.

        Returns the reason if homing is refused, otherwise an empty string.
        """
        axes = self._context.machine.axes
        if name and name not in {axis.name for axis in axes}:
            return Message("this machine has no axis {name} to home", name=name)
        lost = [
            axis
            for axis, homed in zip(axes, self._context.axis_sample.homed, strict=True)
            if not homed and name in {"", axis.name}
        ]
        if not lost:
            return "all axes homed"
        self._left = [axis.name for axis in sorted(lost, key=lambda axis: axis.home_order)]
        self._now = ""
        return ""

    def stop(self) -> None:
        """Cancel homing. The drives brake and hold position."""
        self._left, self._now = [], ""
        self._context.ports.axes.stop(StopMode.RAMP_HOLD)

    def home_next_axis(self) -> bool:
        """Start homing the next axis when the previous one is homed; return whether homing is complete.

        Homing is complete when all axes are homed and at rest. The function is called every tick. Raises
        DriverError if a drive rejects homing.
        """
        context = self._context
        homed = dict(zip(context.ports.axes.axes, context.axis_sample.homed, strict=True))
        if self._now and not homed[self._now]:
            self._found_at = context.now
            return False
        if self._left:
            if self._now and context.axis_sample.moving and context.now < self._found_at + _SETTLING_TIME_S:
                return False
            self._now = self._left.pop(0)
            context.ports.axes.home(self._now)
            return False
        self._now = ""
        return not context.axis_sample.moving
