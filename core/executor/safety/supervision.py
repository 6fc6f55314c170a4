"""Supervision in each tick: following error, standstill, drives, collet, outputs and driver host.

A driver host that receives no data stops the spindle and switches off the outputs; a terminal, a module or
a controller may do the same. If an output changes without a command, the cycle enters feed hold, and the
part is not counted. No axis feeds while an output differs from its command. If a start will turn an output
on again, this is announced first.

The drives also supervise the following error, with one window for all speeds. The window in this module is
narrower and also applies at rest. ``spindle_control`` supervises the spindle.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial

from core.alarms import AlarmCode
from core.executor.machine_context import MachineContext
from core.executor.program_run import ProgramRun
from core.executor.raised_alarm import AlarmError
from core.executor.snapshot import ACTIVE_STATES, CYCLE_STATES, STOPPED_STATES, MachineState
from core.executor.start_conditions import AnnouncedFunction
from core.faults import DriverHostTrip, get_fault_code
from core.machine.machine_model import Axis
from core.message import Message, join_messages
from core.ports import AxisSample, UnknownPart

_HOST_DELAY_S = (
    0.03  # s in addition to the drive's own time, so that the fault of the drive is reported first
)
_RECENT_TIME_S = 0.1  # s for which an axis may still lag after its speed has dropped
_ENCODER_TIMEOUT_S = 0.05  # s within which the encoder must count while its axis is commanded to move
_ARRIVAL_TIMEOUT_S = 1.0  # s that an axis may take to get in position, as in the wait of the cycle
_FROZEN, _CLOSE = 3.0, 2.5  # s and counts; a drive that pushes moves its encoder by one or two counts
_WINDOW_FRACTION = 0.125  # fraction of the standstill window; a free axis moves at this error
_MIN_COUNTS = 20.0  # counts that the axis must be commanded to move if the encoder is coarse
_NOTHING = 1e-9
_POWERED = CYCLE_STATES | {MachineState.IDLE, MachineState.JOG, MachineState.HOMING}
_NO_DATA_TIMEOUT_S = 0.25  # s without axis data before a driver must report a fault


class FollowingErrorMonitor:
    """Supervision of the position of all axes, at rest and in motion, with drives on or off.

    ``check_sample`` is called once per tick.
    """

    def __init__(self, axes: Sequence[Axis]) -> None:
        self._axes = [_AxisWatch(axis) for axis in axes]
        self._enabled = False

    def check_sample(self, sample: AxisSample, *, is_unpowered: bool) -> None:
        """Check a sample and raise AlarmError for the first axis that is out of position.

        If ``is_unpowered`` is True, the drives are off without a fault, and no axis should move.
        """
        if sample.enabled is not self._enabled:
            self._enabled = sample.enabled
            self.reset_supervision()
        each = zip(self._axes, sample.demand, sample.actual, sample.homed, strict=True)
        for one, demand, actual, homed in each:
            if sample.moving:
                one.clear_rest_position()  # even if its axis data has not arrived yet
            if not one.store_sample_time(sample.t):
                continue
            if sample.enabled:
                one.check_powered_sample(demand, actual)
                one.check_unrequested_motion(actual, at_rest=not sample.moving and demand == actual)
            else:
                one.check_unrequested_motion(actual, at_rest=not sample.moving and is_unpowered and homed)

    def reset_supervision(self) -> None:
        """Reset the supervision after a change of drive power or the acknowledgment of an alarm."""
        for one in self._axes:
            one.clear_samples()


class _AxisWatch:
    """Supervision of the position of one axis.

    It uses the times of the samples, so that a late tick has no effect.
    """

    def __init__(self, axis: Axis) -> None:
        self._axis = axis
        self._t = 0.0
        self.clear_samples()

    def clear_samples(self) -> None:
        self._dt = 0.0
        self._demand: float | None = None
        self._speed = self._speed_at = 0.0
        self._sent_at = self._t
        self._since: dict[str, float] = {}
        # start time and setpoint of the move, and the last position that counted
        self._counted = (self._t, 0.0, 0.0)
        self._counted_at = self._t
        self._stood: float | None = None  # position at which the axis came to rest

    def store_sample_time(self, t: float) -> bool:
        """Store the time of a sample; return whether the sample is newer than the one before it."""
        self._dt, self._t = t - self._t, t
        return self._dt > 0.0

    def check_powered_sample(self, demand: float, actual: float) -> None:
        """Check a sample of the axis with its drive on. Raises AlarmError if the axis is out of position."""
        axis, error = self._axis, abs(demand - actual)
        if self._demand is None:
            self._demand, self._sent_at, self._counted = demand, self._t, (self._t, demand, actual)
        self._note_speed(abs(demand - self._demand) / self._dt)
        self._demand = demand
        self._encoder(demand, actual)
        rest = self._t - self._sent_at
        limit = axis.compute_max_following_error(self._speed)
        if self._lasts("off", error > limit) > axis.following_error_time_s + _HOST_DELAY_S:
            code: AlarmCode = "standstill" if rest > axis.standstill_time_s else "following"
            raise AlarmError(
                code, Message("{axis} is {error} off its setpoint", axis=axis.name, error=self._words(error))
            )
        if rest > axis.standstill_time_s:
            self._at_standstill(error, rest)

    def _at_standstill(self, error: float, rest: float) -> None:
        """Raise AlarmError if an axis at standstill does not settle at its target position.

        A small error is permitted for a longer time than a large error.
        """
        axis, unmoved = self._axis, self._t - self._counted_at
        pushed = max(_WINDOW_FRACTION * axis.standstill_tolerance, 4.0 * axis.in_position_tolerance)
        if (
            self._lasts("pushed", error > pushed) > axis.standstill_time_s
            and unmoved > axis.standstill_time_s
        ):
            raise AlarmError(
                "standstill",
                Message("{axis} remains {error} off its setpoint", axis=axis.name, error=self._words(error)),
            )
        is_off_target = (
            self._lasts("beside", error > axis.in_position_tolerance) > _ARRIVAL_TIMEOUT_S
            and rest > _ARRIVAL_TIMEOUT_S
        )
        frozen = self._lasts("frozen", error > _CLOSE * axis.count_size) > _FROZEN and unmoved > _FROZEN
        if is_off_target or frozen:
            raise AlarmError(
                "standstill",
                Message("{axis} remains {error} off its setpoint", axis=axis.name, error=self._words(error)),
            )

    def clear_rest_position(self) -> None:
        """Clear the stored rest position because the driver reports motion."""
        self._stood = None
        self._since.pop("rest", None)

    def check_unrequested_motion(self, actual: float, *, at_rest: bool) -> None:
        """Raise AlarmError if an axis that should be at rest moves without a setpoint."""
        axis = self._axis
        if not at_rest:
            self.clear_rest_position()
            return
        if self._lasts("rest", True) < axis.standstill_time_s:
            return
        self._stood = actual if self._stood is None else self._stood
        off = abs(actual - self._stood)
        if self._lasts("moved", off > axis.standstill_tolerance) > axis.standstill_time_s:
            raise AlarmError(
                "moved-unasked",
                Message("{axis} has moved by {off} without a command", axis=axis.name, off=self._words(off)),
            )

    def _note_speed(self, speed: float) -> None:
        if speed * self._dt > _NOTHING:
            self._sent_at = self._t
        if speed >= self._speed or self._t - self._speed_at > _RECENT_TIME_S:
            self._speed, self._speed_at = speed, self._t

    def _encoder(self, demand: float, actual: float) -> None:
        """Raise AlarmError if the axis is commanded to move but its encoder does not count.

        Either the axis is jammed, or its encoder has failed and its position is unknown.
        """
        axis, (since, sent_from, read) = self._axis, self._counted
        if abs(actual - read) > 1.5 * axis.count_size:
            self._counted, self._counted_at = (self._t, demand, actual), self._t
            return
        least = max(0.25 * axis.standstill_tolerance, _MIN_COUNTS * axis.count_size)
        sent = abs(demand - sent_from)
        if sent <= axis.count_size:
            self._counted = (self._t, sent_from, read)
        elif self._t - since > _ENCODER_TIMEOUT_S and sent > least and abs(demand - actual) > least:
            raise AlarmError(
                "encoder-still",
                Message(
                    "{axis} was commanded to move {sent}, but its encoder does not count",
                    axis=axis.name,
                    sent=self._words(sent),
                ),
            )

    def _lasts(self, what: str, holds: bool) -> float:
        """Return for how many seconds the condition named ``what`` has been true without interruption."""
        if not holds:
            self._since.pop(what, None)
            return 0.0
        return self._t - self._since.setdefault(what, self._t)

    def _words(self, deviation: float) -> str:
        return (
            Message("{angle} degrees", angle=f"{deviation:.2f}")
            if self._axis.is_rotary
            else Message("{unit} mm", unit=f"{deviation:.3f}")
        )


class Supervisor:
    """Supervision of drives, axes and collet."""

    def __init__(self, context: MachineContext) -> None:
        self._context = context
        self._axes = FollowingErrorMonitor(context.machine.axes)
        self.max_following_error = 0.0

    def accept_current_positions(self) -> None:
        """Accept the current positions of the axes because the operator has acknowledged an alarm."""
        self._axes.reset_supervision()

    def check_machine(self, state: MachineState) -> None:
        """Raise AlarmError for the first condition that must stop the machine."""
        sample, context = self._context.axis_sample, self._context
        if sample.fault:
            raise AlarmError(get_fault_code(sample.fault, "axis"), sample.fault)
        if UnknownPart.AXES in context.unknown_parts:
            self._axes.reset_supervision()  # the axes may be at other positions when data arrives again
            self._check_data(is_powered=state in _POWERED)
            return
        self._unheard_since = None
        self._check_numbers(sample)
        self.max_following_error = max(self.max_following_error, *map(abs, sample.following_error[:2]))
        self._axes.check_sample(sample, is_unpowered=state is MachineState.DISABLED)
        turning = not context.spindle.is_stopped and context.spindle.is_requested
        gripped = context.inputs.get("collet_closed", True) or not context.ports.io.get_outputs().get(
            "collet", True
        )
        if turning and not gripped and not context.machine.interlocks.spindle_with_collet_open:
            self._check_collet()
        else:
            self._open_since = None

    def _check_data(self, *, is_powered: bool) -> None:
        """Raise AlarmError if the axes send no data for more than 0.25 s although no fault is reported.

        The alarm is raised only in a machine state with powered drives.
        """
        now = self._context.now
        since = self._unheard_since = now if self._unheard_since is None else self._unheard_since
        if is_powered and now - since > _NO_DATA_TIMEOUT_S:
            raise AlarmError("drive-silent", "no data from the axes")

    def _check_numbers(self, sample: AxisSample) -> None:
        """Raise AlarmError if a setpoint, a position or a following error is NaN or infinite.

        This check is necessary because every comparison with NaN is false, so that no other check would
        react.
        """
        each = zip(
            self._context.machine.axes, sample.demand, sample.actual, sample.following_error, strict=True
        )
        for axis, *axis_values in each:
            if not all(map(math.isfinite, axis_values)):
                raise AlarmError(
                    "axis",
                    Message("{axis}: the drive reports a position that is not a number", axis=axis.name),
                )

    def _check_collet(self) -> None:
        """Raise AlarmError if the collet switch is off for too long to be contact bounce."""
        now = self._context.now
        self._open_since = now if self._open_since is None else self._open_since
        if now - self._open_since > 2.0 * self._context.machine.collet.close_time_s:
            raise AlarmError("collet-lost")

    _open_since: float | None = None
    _unheard_since: float | None = None


# --- outputs and the driver host ----------------------------------------------------------------------


class OutputMonitor:
    """Supervision of the outputs and the driver host in every tick.

    It is used on the executor's thread only.
    """

    def __init__(self, context: MachineContext, program_run: ProgramRun) -> None:
        self._context = context
        self._program_run = program_run
        self._known_off: frozenset[str] = frozenset()  # outputs known to differ from their commanded states

    def check_outputs(self) -> None:
        """Start a feed hold if an output has changed without a command.

        Raises DriverError or AlarmError on failure.
        """
        trips = self._context.ports.trip_monitor
        trip = trips.get_active_trip() if trips is not None else None
        if trips is not None and trip is not None:
            trips.acknowledge_trip(trip)  # acknowledged first, because the hold also needs setpoints
            self._handle_trip(trip)
        if UnknownPart.OUTPUTS in self._context.unknown_parts or self._context.axis_sample.fault:
            return  # The fault that switched outputs off is reported in this tick.
        if self._program_run.status.state not in CYCLE_STATES:
            known_off, self._known_off = self._known_off, frozenset()
            for each in self._context.commanded_outputs.accept_actual_states():
                if (
                    each.output_name not in known_off
                ):  # already reported by the device that switched the output off
                    self._context.log_text(
                        "disturbed", Message("{item} MOVED WITHOUT A COMMAND", item=each.description)
                    )
            return
        differing = self._context.commanded_outputs.find_mismatches()
        new = [each for each in differing if each.output_name not in self._known_off]
        self._known_off = frozenset(each.output_name for each in differing)
        if new:
            self._disturbed("switched-off", " AND ".join(each.description for each in new))

    def iter_output_announcements(self) -> Iterator[AnnouncedFunction]:
        """Yield an announcement for each output that a resume would switch back to its commanded state."""
        if self._program_run.status.state in STOPPED_STATES:
            for name, wanted in self._context.commanded_outputs.find_mismatches():
                words = Message("{output} TURNS ON" if wanted else "{output} TURNS OFF", output=name.upper())
                begin = partial(self._context.commanded_outputs.write, name, wanted)
                yield AnnouncedFunction(Message("output {name}", name=name), words, begin)

    def _handle_trip(self, trip: DriverHostTrip) -> None:
        """Start a feed hold if the driver host has switched off outputs or the spindle.

        Lamps are ignored, because they are not outputs of the program and are turned on again.
        """
        context = self._context
        outputs = tuple(name for name in trip.active_outputs if name not in context.machine.lamp_outputs)
        off = [*(["SPINDLE"] if trip.spindle else []), *(name.upper() for name in outputs)]
        if not off:
            return
        if trip.spindle:
            context.spindle.record_external_stop("DRIVER HOST STOPPED SPINDLE/OUTPUTS")
        context.commanded_outputs.mark_outputs_switched_off(outputs)
        self._known_off |= set(outputs)
        template = (
            "NO SIGNAL FROM MACHINE FOR {away} S, OUTPUTS FOUND ON AND SWITCHED OFF: {off}"
            if trip.was_connection_lost
            else "NO SIGNAL FROM CONTROL FOR {away} S, SWITCHED OFF: {off}"
        )
        self._disturbed(
            "feeder-tripped",
            Message(
                template,
                away=f"{trip.silence_s:.1f}",
                off=join_messages(", ", off),
            ),
        )

    def _disturbed(self, code: AlarmCode, words: str) -> None:
        program_run, state = self._program_run, self._program_run.status.state
        self._context.log_text("disturbed", words)
        if program_run.cycle is None or state not in CYCLE_STATES:
            return
        program_run.exclude_part_from_count(words.lower())
        if state in ACTIVE_STATES:
            self._context.spindle.cancel_orientation()
        else:
            self._context.show_stop(code, words.lower())
        program_run.cycle.start_feed_hold(words, code=code)
