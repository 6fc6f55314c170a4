"""Handwheel, which moves the selected axis by one step per click.

The axis moves only while the sender renews the lease and no condition prevents motion. It follows the
handwheel with a delay of 0.1 s. The queue never exceeds the distance of this delay plus the braking
distance. Clicks that the axis is too slow to follow are ignored. If the control ends the motion, the
handwheel must be selected again.
"""

from __future__ import annotations

import math

from core.executor.commands import SelectHandwheel
from core.executor.hand_motion.jog_line import SOFT_LIMIT_MARGIN, Ramp
from core.executor.hand_motion.jog_ramps import plan_stop_at_distance
from core.executor.hand_motion.jogging import MAX_LEASE_S, Jogger, make_travel_end_message
from core.executor.machine_context import MachineContext
from core.executor.snapshot import MachineState
from core.machine.machine_model import Axis
from core.machine.station_rules import HANDWHEEL_ENABLE_INPUT, HANDWHEEL_INPUT, get_axis_selector_input
from core.message import Message

# --- encoder counts and clicks --------------------------------------------------------------------------


_MAX_CLICKS_PER_S = 1000.0  # clicks per second and
_EXTRA_CLICKS = 10  # additional clicks are the most that a hand can do; 300 per second is a fast spin
_AWAY = 0.1  # s between two readings; counts of a longer gap are too old
MAX_CLICK_MM = 0.254  # mm (.01 in)
MAX_CLICK_DEG = 0.5  # degrees
_FOLLOW_DELAY_S = 0.1  # s, delay of the axis after the wheel
_STILL_TIME_S = 0.1  # s for which the wheel must be still after it is selected
_RELEASE_PAUSE_S = 0.5  # s between a simultaneous use of key and wheel and the next jog
_ROUNDING = 1e-9


class ClickCounter:
    """Converter of encoder counts to handwheel clicks.

    ``per`` is the number of encoder counts per click; a negative number reverses the direction.
    """

    def __init__(self, per: int) -> None:
        self._per = per
        self._last: tuple[float, int] | None = None  # time and counts of the last reading
        self._base = 0  # counts that were converted to clicks
        self.still_time_s = 0.0  # s since the last motion of the wheel
        self.has_jumped = False  # the count has jumped in this tick, faster than a hand can turn

    def read_clicks(self, encoder_count: int, now: float) -> int:
        """Return the signed number of clicks since the last call.

        Half a click is ignored, so that a handwheel at rest causes no motion.
        """
        before, self._last = self._last, (now, encoder_count)
        if before is None:
            self._base = encoder_count
            return 0
        passed, moved = now - before[0], abs(encoder_count - before[1])
        self.has_jumped = moved > abs(self._per) * (_MAX_CLICKS_PER_S * passed + _EXTRA_CLICKS)
        if self.has_jumped or passed > _AWAY:
            self._base, self.still_time_s = encoder_count, 0.0
            return 0
        clicks = int((encoder_count - self._base) / self._per)  # rounded towards zero
        self._base += clicks * self._per
        self.still_time_s = 0.0 if clicks else self.still_time_s + passed
        return clicks


class Handwheel:
    """Motion of the selected axis by the handwheel.

    ``axis`` is empty while no axis is selected. ``end_reason`` is the reason why the control disabled the
    handwheel.
    """

    def __init__(self, context: MachineContext, jogger: Jogger) -> None:
        model = context.machine.hardware.analog_inputs.get(HANDWHEEL_INPUT)
        self._context = context
        self._jogger = jogger
        self._there = model is not None and context.ports.blocks is None
        self._clicks = ClickCounter(model.counts_per_click if model else 1)
        self.axis = ""
        self.end_reason = ""
        self._step = 0.0
        self._until = 0.0
        self._ready = False  # the wheel was still after it was selected
        self._reported = ""  # the message already logged for this motion
        self._apart = -math.inf  # time until which jog keys are refused after simultaneous use

    def select_axis(self, command: SelectHandwheel, state: MachineState) -> None:
        """Select the axis and the step, or renew the lease. Raises DriverError if a driver fails."""
        if self.end_reason:
            return
        if why := self._refusal(command) or self._find_end_reason(state, command.axis):
            self.disable(why, state)
        elif (command.axis, command.step) != (self.axis, self._step):
            self._stop(state)
            self.axis, self._step, self._ready = command.axis, command.step, False
        self._until = self._context.now + min(command.lease, MAX_LEASE_S)

    def deselect_axis(self, state: MachineState) -> None:
        """Deselect the handwheel and stop its axis. Raises DriverError if a driver fails."""
        self._stop(state)
        self.axis = self.end_reason = ""

    def disable(self, reason: str, state: MachineState) -> None:
        """Disable the handwheel and log ``reason``. Raises DriverError if a driver fails."""
        self._stop(state)
        self.axis, self.end_reason = "", reason
        self._context.log_text("refused", Message("handwheel: {what}", what=reason))

    def follow_clicks(self, state: MachineState) -> bool:
        """Move the axis according to the clicks since the last tick; return whether the axis moves.

        Raises DriverError if a driver fails.
        """
        context, jogger = self._context, self._jogger
        clicks = self._clicks.read_clicks(context.station_signals.handwheel_count, context.now)
        if not self.axis:
            return False
        if why := self._find_end_reason(state, self.axis):
            self.disable(why, state)
            return False
        if state is MachineState.IDLE:
            jogger.clear_jog()
            self._reported = ""
        self._ready = self._ready or self._clicks.still_time_s >= _STILL_TIME_S
        if not clicks or not self._ready or jogger.is_stopping:
            return False
        if jogger.axis_name and jogger.target_position is None:
            self._together("the handwheel was turned while a key or the screen was pressed", state)
            return False
        return self._follow(clicks)

    def find_jog_refusal_reason(self, state: MachineState) -> str:
        """Return why a key cannot jog while the handwheel is active, or an empty string if it can."""
        if self._jogger.target_position is not None:
            self._together("a key or the screen was pressed while the handwheel was turning", state)
        if self._context.now >= self._apart:
            return ""
        self._apart = self._context.now + _RELEASE_PAUSE_S
        return "a key and the handwheel cannot be used at the same time"

    def _together(self, why: str, state: MachineState) -> None:
        self._jogger.stop()
        self._apart = self._context.now + _RELEASE_PAUSE_S
        self.disable(why, state)

    def _stop(self, state: MachineState) -> None:
        if state is MachineState.JOG and self._jogger.target_position is not None:
            self._jogger.stop()

    def _refusal(self, command: SelectHandwheel) -> str:
        context = self._context
        if not self._there:
            return "this machine has no handwheel"
        if why := self._jogger.find_axis_refusal_reason(command.axis):
            return why
        longest = MAX_CLICK_DEG if context.machine.find_axis(command.axis).is_rotary else MAX_CLICK_MM
        if not 0.0 < command.step <= longest + _ROUNDING:
            return Message(
                "a handwheel step must be above 0 and at most {longest}, not {step}",
                longest=f"{longest:g}",
                step=f"{command.step:g}",
            )
        if not 0.0 < command.lease < math.inf:
            return "the handwheel needs a watchdog time greater than 0"
        return ""

    def _find_end_reason(self, state: MachineState, axis: str) -> str:
        """Return why the handwheel must be disabled in this tick, or an empty string if it stays enabled."""
        context, signals, inputs = self._context, self._context.station_signals, self._context.inputs
        reasons = (
            (
                state not in {MachineState.IDLE, MachineState.JOG},
                Message("not available in state {state}", state=state.value),
            ),
            (signals.station_fault != "", signals.station_fault.lower()),
            (signals.handwheel_fault != "", signals.handwheel_fault),
            (signals.is_hold_requested, "feed hold"),
            (self._clicks.has_jumped, "the handwheel count jumps; check the handwheel cable"),
            (
                self.axis != "" and context.now > self._until,
                ("the page that uses the handwheel stopped responding"),
            ),
            (not inputs.get(HANDWHEEL_ENABLE_INPUT, True), "the handwheel's enabling switch is not pressed"),
            (
                not inputs.get(get_axis_selector_input(axis), True),
                Message("the axis selector switch is not set to {axis}", axis=axis),
            ),
        )
        found = next((why for so, why in reasons if so), "")
        return (
            found or self._jogger.find_spindle_turning_reason(axis) or self._jogger.request_c_axis_mode(axis)
        )

    def _follow(self, clicks: int) -> bool:
        context, jogger = self._context, self._jogger
        index = context.ports.axes.axes.index(self.axis)
        start = (
            context.axis_sample.demand[index] if jogger.target_position is None else jogger.target_position
        )
        wanted = self._limit_target(index, start + clicks * self._step)
        found = _TargetMove(context.machine.axes[index], self._top(index), self._step, wanted)
        jogger.follow_target(self.axis, found.make_ramps, wanted)
        if jogger.target_position is not None and found.goal != wanted:
            jogger.target_position = found.goal
            self._refuse_once(
                Message(
                    "the handwheel is being turned faster than {axis} can move, so clicks are lost",
                    axis=self.axis,
                )
            )
        return jogger.target_position is not None

    def _top(self, index: int) -> float:
        return self._jogger.get_max_jog_speed(
            self._context.machine.axes[index], self._context.axis_sample.homed[index]
        )

    def _limit_target(self, index: int, wanted: float) -> float:
        """Limit a target to the travel limits. Clicks past a travel limit are ignored."""
        axis = self._context.machine.axes[index]
        if axis.travel is None or not self._context.axis_sample.homed[index]:
            return wanted
        here = self._context.axis_sample.demand[index]
        low, high = axis.travel[0] + SOFT_LIMIT_MARGIN, axis.travel[1] - SOFT_LIMIT_MARGIN
        allowed = min(max(wanted, min(low, here)), max(high, here))
        if allowed != wanted:
            self._refuse_once(make_travel_end_message(axis.name, wanted - allowed))
        return allowed

    def _refuse_once(self, what: str) -> None:
        if what != self._reported:
            self._reported = what
            self._context.log_text("refused", Message("handwheel: {what}", what=what))


class _TargetMove:
    """A move toward ``wanted``, which ends at ``goal``.

    If the available time is too short to reach ``wanted``, ``goal`` is as far as the axis can move.
    """

    def __init__(self, axis: Axis, top: float, step: float, wanted: float) -> None:
        self._amax, self._top, self._step, self._wanted = axis.max_acceleration, top, step, wanted
        self.goal = wanted

    def make_ramps(self, _start: float, p: float, v: float) -> list[Ramp]:
        """Return the ramps for ``Jogger.follow_target``, at the speed that results in a 0.1 s delay."""
        distance = self._wanted - p
        longest = max(self._top * _FOLLOW_DELAY_S + v * v / (2.0 * self._amax), self._step)
        if abs(distance) > longest:
            distance = math.copysign(longest, distance)
            self.goal = p + distance
        least = max(abs(distance), v * v / (2.0 * self._amax))
        return plan_stop_at_distance(v, distance, min(self._top, least / _FOLLOW_DELAY_S), self._amax)
