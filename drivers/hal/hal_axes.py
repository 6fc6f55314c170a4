"""The axes on HAL, with the setpoint queue that the bridge and HAL play."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence

from core.ports import (
    AxisSample,
    Cam,
    DriverError,
    Fault,
    GearState,
    MotionSegments,
    StopMode,
    is_queue_finished,
)
from drivers.hal.bridge.packets import number
from drivers.hal.bridge.packets import parse_pieces as pieces_told
from drivers.hal.hal_config import HalConfig
from drivers.hal.hal_homing import HalHoming, HalTouchInput
from drivers.hal.hal_link import HalLink, parse_bridge_fault
from drivers.hal.hal_queue import HalQueue
from drivers.port_checks import (
    require_drive_power,
    require_existing_axis,
    require_no_fault,
    require_no_homing,
    require_standstill,
)
from drivers.setpoint_pieces import MotionPiece
from drivers.setpoint_queue import check_setpoint_limits, convert_segments
from drivers.spindle_gear import GearAxes, SpindlePhaseFilter

_HISTORY_S = 0.5  # Age in s of setpoints that are still available.
_POWER_ON_S = 1.5  # Seconds for the drives to switch on.
_STANDSTILL_TIME_S = 0.1  # Seconds without a count after which an axis is at standstill.
_SPEED_WINDOW_S = 0.05  # s
_NAN = float("nan")


class HalAxes:
    """Axes on HAL, with the ports ``core.ports.AxisSink`` and ``SpindleGear``.

    Only the thread that owns the bridge may use them.
    """

    def __init__(self, config: HalConfig, link: HalLink, now: Callable[[], float]) -> None:
        self.config = config
        self._link = link
        self._now = now
        self.axes = tuple(axis.name for axis in config.axes)
        self.commit = config.commit_time_s
        self._driven = [n for n, axis in enumerate(config.axes) if axis.pins is not None]
        self.queue = HalQueue(GearAxes.from_axes(config.axes, config.commit_time_s), (0.0,) * len(self.axes))
        self.home_positions = [0.0] * len(self.axes)  # Home positions in HAL's count.
        self._homed = [axis.absolute or axis.pins is None for axis in config.axes]
        self.active_homing: HalHoming | None = None
        self.fault: Fault | str = ""
        self.fault_clearers: list[Callable[[], None]] = []  # Functions that clear the faults of other parts.
        self.reconnect_handlers: list[Callable[[], None]] = []  # They are called after HAL was loaded again.
        self.spindle_sample: tuple[float, float] | None = None  # Time and revolutions of the newest sample.
        self.index_rev = 0.0  # Revolutions at the spindle's index in HAL's count.
        probe = config.probe_input
        self.touch_input: HalTouchInput | None = None
        if probe is not None:
            self.touch_input = HalTouchInput(config.hal_table.period, active_low=probe.is_active_low)
        # An axis that is used as the spindle and retains its count. None: C is engaged or does not exist.
        self._lent = next((n for n, axis in enumerate(config.axes) if axis.is_spindle_c_axis), None)
        self.is_c_turning = False  # C turns to its position relative to the index.
        self.spindle_rev_per_s = 0.0
        self._on = False
        self._order = 0  # Number of the command after which the bridge's power report is valid.
        self._t = 0.0
        self._command = self._actual = (0.0,) * len(self.axes)
        self._moved = -math.inf  # Time of the last motion.
        self._still = self._actual
        self._brakings = 0.0
        self._samples: Callable[..., None] = _discard_sample
        self._marks = [n for n, axis in enumerate(config.axes) if axis.switch_key]
        self._turned: deque[tuple[float, float]] = deque()

    # --- data from the bridge -----------------------------------------------------------------------------

    def handle_connection(self) -> None:
        """Handle a new connection to HAL, after which only absolute axes know their position."""
        self._homed = [axis.absolute or axis.pins is None for axis in self.config.axes]
        self._brakings = number(self._link.last_report, "brakings")
        self._on = False
        for forget in self.reconnect_handlers:
            forget()
        self.process_samples()
        self.queue.reset_to_position(self._actual)

    def set_sample_handler(self, handler: Callable[..., None]) -> None:
        """Set the function that receives each sample as a row of ``core.ports.SampleSource``."""
        self._samples = handler

    def process_samples(self) -> None:
        """Process the samples that have been received."""
        axes, config = len(self._driven), self.config
        turning, telling = bool(config.spindle.pins.position), bool(config.spindle.pins.velocity)
        width = 1 + 2 * axes + turning + telling + len(self._marks) + (self.touch_input is not None)
        for sample_numbers in self._link.pop_sample_rows():
            for at in range(0, len(sample_numbers) - width + 1, width):
                self._sample(sample_numbers[at : at + width], axes, turning=turning, telling=telling)

    def _sample(self, row: Sequence[float], axes: int, *, turning: bool, telling: bool) -> None:
        t = row[0]
        self._command = self._to_machine_position(row[1 : 1 + axes], t)
        self._actual = self._to_machine_position(row[1 + axes : 1 + 2 * axes], t)
        if turning:
            self.spindle_sample = t, row[1 + 2 * axes]
            self.queue.calculate_cam_setpoint(t, row[1 + 2 * axes] - self.index_rev)
        if telling:
            self.spindle_rev_per_s = row[1 + 2 * axes + turning]
        elif turning:
            self._estimate_speed(t, row[1 + 2 * axes])
        self._t = t
        bits = row[1 + 2 * axes + turning + telling :]
        if self.touch_input is not None:
            self.touch_input.add_sample(t, self._actual, bool(bits[-1]))
        for index, on in zip(self._marks, bits[: len(self._marks)], strict=True):
            if self.active_homing is not None and self._homes(index):
                self.active_homing.add_switch_sample(self.read_hal_position(index), bool(on))
        moved = zip(self._actual, self._still, self.config.axes, strict=True)
        if any(abs(a - b) > 1.5 * axis.count for a, b, axis in moved):
            self._moved, self._still = t, self._actual
        self._samples(
            t,
            *self._command,
            *self._actual,
            *(_NAN,) * len(self.axes),
            60.0 * self.spindle_rev_per_s,
            row[1 + 2 * axes] - self.index_rev if turning else _NAN,
            _NAN,
            self.queue.get_end_time(t) - t,
        )

    def _estimate_speed(self, t: float, turns: float) -> None:
        """Calculate the spindle speed in rev/s from position samples if HAL does not provide a speed."""
        turned = self._turned
        turned.append((t, turns))
        while turned[0][0] < t - _SPEED_WINDOW_S:
            turned.popleft()
        since = t - turned[0][0]
        self.spindle_rev_per_s = (turns - turned[0][1]) / since if since > 0.0 else self.spindle_rev_per_s

    def _to_machine_position(self, raw: Sequence[float], t: float) -> tuple[float, ...]:
        """Return HAL positions converted to positions of the control.

        An axis without pins is at its queued position.
        """
        place = list(self.queue.get_commanded_state(t)[0])
        for value, index in zip(raw, self._driven, strict=True):
            if index != self._lent:
                place[index] = value - self.home_positions[index]
        return tuple(place)

    def run_cycle(self) -> None:
        """Monitor the machine and continue the homing.

        The method raises no errors; errors become the fault.
        """
        self.process_samples()
        report = self._link.last_report
        fault_text = self._link.failure_reason or parse_bridge_fault(report)
        if fault_text and not self.fault:
            self.fault = fault_text
            self._forget()
        if self._on and self._link.is_command_executed(self._order) and report.get("on") is not True:
            self._handle_power_loss()
        self._process_bridge_state()
        self._home_on()
        self.queue.discard_pieces_before(self._now() - _HISTORY_S)

    def _process_bridge_state(self) -> None:
        """Update the setpoint queue after the bridge has ended a cam or has braked the axes."""
        report = self._link.last_report
        if self.queue.is_engaged and report.get("geared") is False and "left" in report:
            left = report["left"]
            if isinstance(left, float | int):
                self.queue.end_cam(float(left))
        count, numbers = number(report, "brakings"), report.get("braked")
        if count > self._brakings and isinstance(numbers, list) and numbers:
            self._brakings = count
            raw = pieces_told([float(each) for each in numbers], len(self._driven))
            pieces = [self._from_hal(piece) for piece in raw]
            self.queue.replace_with_braking(pieces[0].start_time_s, pieces)

    def _handle_power_loss(self) -> None:
        """Handle a loss of power after an E-stop or a drive fault.

        Axes without an absolute encoder lose their home position.
        """
        self._forget()
        for index in self._driven:
            self._homed[index] = self.config.axes[index].absolute

    def _forget(self) -> None:
        self._on, self.active_homing = False, None
        self.queue.reset_to_position(self._actual)

    # --- the port -----------------------------------------------------------------------------------------

    def now(self) -> float:
        """Return the time of the machine's clock in seconds."""
        return self._now()

    def horizon(self) -> float:
        """Return the end time of the setpoint queue in seconds, or the current time for an empty queue."""
        return self.queue.get_end_time(self._now())

    def demand_at(self, time_s: float) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return the queued positions and velocities at ``time_s``."""
        return self.queue.get_commanded_state(time_s)

    def splice(self, segments: MotionSegments) -> None:
        """Splice setpoints into the queue.

        Raises DriverError if a fault is active, the power is off or an axis is homing. Also raises
        DriverError if the setpoints are invalid or exceed axis limits, or if the bridge does not accept
        them.
        """
        self._need_power()
        require_no_homing(self.active_homing.name if self.active_homing is not None else "")
        self._check(segments)
        self.queue.splice_segments(segments, self._now())
        self._send("splice", convert_segments(segments, len(self.axes)))

    def mesh(self, cam: Cam) -> None:
        """Make the axes follow the spindle.

        Raises DriverError if a fault is active, the power is off, an axis is moving, or HAL has not
        reported the spindle position. Also raises DriverError if the cam is invalid or exceeds axis limits,
        if the spindle does not turn in the direction of the cam, or if the bridge does not accept it.
        """
        self._need_power()
        if self.spindle_sample is None:
            raise DriverError(
                "HAL does not report the spindle position, so no axis can follow the spindle",
                "thread-no-encoder",
            )
        t, turns = self.spindle_sample[0], self.spindle_sample[1] - self.index_rev
        self._check(
            cam.segments._replace(velocities=cam.segments.velocities * abs(self.spindle_rev_per_s) / 1.1)
        )
        phase = SpindlePhaseFilter(t, turns, self.spindle_rev_per_s)
        self.queue.engage_cam(cam, phase, self._now())
        path = convert_segments(cam.segments, len(self.axes))
        then = (
            convert_segments(cam.following_segments, len(self.axes))
            if cam.following_segments is not None
            else []
        )
        self._send(
            "mesh", [*path, *then], zero=cam.start_revolutions + self.index_rev, sign=cam.sign, way=len(path)
        )

    def geared(self) -> GearState | None:
        """Return the position of the axes on the cam, or None if they do not follow the spindle."""
        return self.queue.read_gear_state()

    def sample(self) -> AxisSample:
        """Return the state of the axes according to HAL's last sample."""
        t, actual, powered = self._t, self._actual, self._powered
        demand = self._command if powered and self.active_homing is None else actual
        velocity = self.queue.get_commanded_state(t)[1]
        return AxisSample(
            t=t,
            demand=demand,
            actual=actual,
            following_error=tuple([d - a for d, a in zip(demand, actual, strict=True)]),
            enabled=powered,
            homed=tuple([on and not self._homes(n) for n, on in enumerate(self._homed)]),
            moving=not self._link.is_state_unknown
            and (
                self.active_homing is not None or self.is_c_turning or any(velocity) or self._is_axis_rolling
            ),
            fault=self.fault,
        )

    def enable(self, is_on: bool) -> None:
        """Switch the power on and wait until the drives have power, or switch it off without waiting.

        When switching on, raises DriverError if a fault is active, if the bridge does not accept the
        command, or if the E-stop chain does not close within 1.5 s.
        """
        if not is_on:
            self._forget()
            if not self._link.failure:
                self._link.send_command("off")
            return
        require_no_fault(self.fault)
        if self._powered:
            return
        self._order = self._link.send_command("enable")
        link = self._link
        if not link.wait_until_ready(lambda: link.last_report.get("powered") is True, _POWER_ON_S):
            self._link.send_command("off")
            raise DriverError(
                "the drives stay off because HAL's E-stop chain does not close; check the E-stop "
                "button and look for faults",
                "no-power",
            )
        self.process_samples()
        self.queue.reset_to_position(self._actual)
        self._on = True

    def stop(self, mode: StopMode) -> None:
        """Brake on the path within a few milliseconds, or switch off immediately with ``StopMode.OFF``."""
        if self._link.failure:
            self._forget()
            return
        if mode is StopMode.RAMP_HOLD and self._powered:
            self.active_homing = None
            self._link.send_command("brake")
            self.queue.brake_to_rest(self._now() + self.commit, [axis.amax for axis in self.config.axes])
            return
        self._forget()
        self._link.send_command("off" if mode is StopMode.OFF else "ramp-off")

    def home(self, axis: str) -> None:
        """Start homing an axis.

        ``sample().homed`` becomes True when homing is done. Raises DriverError if homing cannot start.
        """
        require_existing_axis(axis, self.axes)
        index = self.axes.index(axis)
        axis_config = self.config.axes[index]
        if axis_config.absolute or axis_config.pins is None:
            return
        self._need_power()
        require_standstill(axis, self.sample().moving)
        self._homed[index] = False
        self.active_homing = HalHoming(axis_config, index, self)

    def clear_fault(self) -> None:
        """Clear the fault without switching on the drives.

        HAL is loaded again if the bridge has ended, the servo thread has stopped or the board is not
        reachable. hm2_eth reconnects to a card only when it is loaded. Raises DriverError if HAL cannot be
        loaded or the bridge does not accept the command. A fault that HAL still reports afterward is set
        again in the next cycle.
        """
        if self._link.last_report.get("stands") is True or self._link.are_inputs_stale:
            self._link.end_session()
        if self._link.failure:
            self._link.connect()
            self.handle_connection()
        self._forget()
        order = self._link.send_command("clear")
        self._link.wait_until_ready(lambda: self._link.is_command_executed(order), 0.5)
        for clear in self.fault_clearers:
            clear()
        self.fault = ""

    # --- for C on the spindle drive ------------------------------------------------------------------------

    def transfer_c_axis(
        self, axis_index: int | None, hal_position: float = 0.0, control_position: float = 0.0
    ) -> None:
        """Release the C axis ``axis_index`` to the spindle, or engage it if ``axis_index`` is None.

        The position count does not change when C is released. When C is engaged, ``hal_position`` is its
        position in HAL and ``control_position`` is its position in the control.
        """
        held, self._lent = self._lent, axis_index
        # HAL continues to play this setpoint, independent of the feedback.
        place = list(self.queue.get_commanded_state(self._now())[0])
        if held is not None and axis_index is None:
            self.home_positions[held] = hal_position - control_position
            place[held] = control_position
            self._actual, self._still, self._command = (
                tuple([control_position if n == held else p for n, p in enumerate(each)])
                for each in (self._actual, self._actual, self._command)
            )
        self.queue.reset_to_position(place)

    # --- for homing ---------------------------------------------------------------------------------------

    def read_bit_pin(self, name: str) -> bool:
        """Return the state of a bit pin of the bridge by the name of the pin, such as ``X.index``."""
        return self._link.read_bit_pin(name)

    def read_number_pin(self, name: str) -> float:
        """Return the value of a number pin of the bridge by the name of the pin, such as ``X.index-at``."""
        return self._link.read_number_pin(name)

    def request_encoder_index(self, pin: str, enabled: bool) -> None:
        """Request the index of an encoder, or cancel the request."""
        self._link.send_command("index", pin=pin, on=enabled)

    def set_limit_switch_ignored(self, axis: str, ignored: bool) -> None:
        """Select whether the limit switch of an axis is ignored.

        It must be ignored while the axis homes on this switch.
        """
        self._link.send_command("homing", axis=axis, on=ignored)

    def splice_homing_move(self, segments: MotionSegments) -> None:
        """Splice the setpoints of a homing move into the queue.

        Raises DriverError if they do not continue the queue, or if the bridge does not accept them.
        """
        self.queue.splice_segments(segments, self._now())
        self._send("splice", convert_segments(segments, len(self.axes)))

    def brake_axes(self) -> None:
        """Brake all axes to rest as soon as possible."""
        self._link.send_command("brake")

    def read_hal_position(self, index: int) -> float:
        """Return the position of an axis as HAL counts it."""
        return self._actual[index] + self.home_positions[index]

    def set_home_position(self, index: int, hal_position: float) -> None:
        """Set the home position of an axis to ``hal_position``, as HAL counts it."""
        leap = self.home_positions[index] - hal_position
        self.home_positions[index] = hal_position
        self._homed[index] = True
        self._actual, self._still, self._command = (
            tuple([p + leap if n == index else p for n, p in enumerate(each)])
            for each in (self._actual, self._still, self._command)
        )
        place = list(self.queue.get_commanded_state(self._now())[0])
        place[index] += leap
        self.queue.reset_to_position(place)

    # --- inside -------------------------------------------------------------------------------------------

    def _homes(self, index: int) -> bool:
        return self.active_homing is not None and self.active_homing.axis_index == index

    @property
    def _is_axis_rolling(self) -> bool:
        """Return whether an axis has moved recently, according to its feedback."""
        return self._t - self._moved < _STANDSTILL_TIME_S

    @property
    def _powered(self) -> bool:
        return self._on and self._link.last_report.get("powered") is True and not self.fault

    def _need_power(self) -> None:
        require_drive_power(self.fault, self._powered)

    def _check(self, segments: MotionSegments) -> None:
        check_setpoint_limits(segments, self.config.axes, self._homed, self._actual)

    def _send(self, what: str, pieces: Sequence[MotionPiece], **values: object) -> None:
        self._link.send_setpoint_pieces(what, [self._to_hal(piece) for piece in pieces], **values)

    def _to_hal(self, piece: MotionPiece) -> MotionPiece:
        p = tuple([piece.positions[n] + self.home_positions[n] for n in self._driven])
        return MotionPiece(
            piece.start_time_s,
            piece.duration_s,
            p,
            *(tuple([each[n] for n in self._driven]) for each in (piece.velocities, piece.accelerations)),
        )

    def _from_hal(self, piece: MotionPiece) -> MotionPiece:
        p, v, a = (
            list(self.queue.get_commanded_state(piece.start_time_s)[0]),
            [0.0] * len(self.axes),
            [0.0] * len(self.axes),
        )
        for k, n in enumerate(self._driven):
            p[n], v[n], a[n] = (
                piece.positions[k] - self.home_positions[n],
                piece.velocities[k],
                piece.accelerations[k],
            )
        return MotionPiece(piece.start_time_s, piece.duration_s, tuple(p), tuple(v), tuple(a))

    def _home_on(self) -> None:
        homing = self.active_homing
        if homing is None:
            return
        try:
            homing.continue_homing(self._now())
        except DriverError as error:
            self.fault = self.fault or error.fault
            self.stop(StopMode.RAMP_OFF)
            return
        if homing.is_done:
            self.active_homing = None

    @property
    def is_at_rest(self) -> bool:
        """Return whether the queue is empty and no axis moves."""
        return (
            is_queue_finished(self.queue.get_end_time(self._now()), self._now()) and not self._is_axis_rolling
        )


def _discard_sample(*_figures: float) -> None:
    """Do nothing with a sample; this is the default sample handler."""
