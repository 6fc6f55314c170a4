"""HAL bridge: writes setpoints, reports samples, and stops motion if the driver is silent.

``queue_packet`` queues a packet of the driver, ``run_cycle`` must be called every few milliseconds, and
``encode_report`` returns the state. If the driver is silent, the bridge executes the setpoint queue to the
end, where the axes are at rest. It then switches off the spindle and the outputs. If the driver has ended,
the bridge also switches off the drives.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence

from drivers.hal.bridge.following_monitor import FollowingErrorMonitor
from drivers.hal.bridge.output_pins import OutputPins, SafetyChainPins
from drivers.hal.bridge.packets import (
    BridgeConfig,
    PacketHead,
    flatten_pieces,
    number,
    pack_packet,
    parse_pieces,
)
from drivers.hal.bridge.row_streams import HalPins, RowStream, RowStreamPair, SampleStream
from drivers.hal.bridge.setpoint_player import SetpointPlayer, make_row_function
from drivers.hal.bridge.spindle_pins import SpindlePins
from drivers.process_messages import text
from drivers.setpoint_pieces import INFINITY, MotionPiece
from drivers.silence import (
    BRIDGE_DRIVER_TIMEOUT_S,
    BRIDGE_THREAD_TIMEOUT_S,
    MAX_STEP_S,
    SilenceStop,
    SilenceTimer,
    StopSteps,
)

_CHAIN_CLOSE_S = 0.1  # Seconds in which the chain must close.
_MAX_SLEW_IN_MOTION = 1e-3  # Maximum rate difference between rows and this computer's clock in motion.
_MAX_SLEW_AT_REST = 0.05
_CORRECTION_TIME_S = 0.5  # Seconds in which a difference is corrected.
_HISTORY_S = 0.5  # Age in s of setpoints that are still available.
_STANDSTILL_REV_PER_S = 0.1  # turns/s
_SAFE_TIME_FRACTION = 0.9  # Fraction of the time until the spindle reaches a position at its present speed.
_MAX_REPORT_SAMPLES = 300  # Samples in one report.
_STANDSTILL_MM_PER_S = 1e-3  # mm/s


class HalBridge:
    """Bridge between the driver and HAL; only one thread may use it."""

    def __init__(
        self,
        config: BridgeConfig,
        pins: HalPins,
        streams: tuple[RowStream, RowStream],
        sampler: SampleStream,
        now: Callable[[], float],
    ) -> None:
        self.config = config
        self.pins = pins
        self.setpoint_player = SetpointPlayer(len(config.axes))
        self.row_streams = RowStreamPair(streams, pins)
        self.spindle_pins = SpindlePins(config, pins)
        self._output_pins = OutputPins(config, pins)
        self._chain_pins = SafetyChainPins(pins)
        self._following_monitor = FollowingErrorMonitor(config, pins)
        self._sampler = sampler
        self._now = now
        self._orders: deque[tuple[PacketHead, Sequence[float]]] = deque()
        self._parts: list[MotionPiece] = []
        self._samples: list[float] = []
        self._place: tuple[float, ...] = (0.0,) * len(config.axes)  # Measured positions.
        self._off_by = 0.0  # Difference between rows and this computer's clock in s.
        self._sampled = False  # A sample has been read.
        self._thread_silence = SilenceTimer(BRIDGE_THREAD_TIMEOUT_S, now(), MAX_STEP_S)
        self._driver_silence = SilenceStop(
            BRIDGE_DRIVER_TIMEOUT_S,
            now(),
            StopSteps(
                lambda: self.setpoint_player.get_end_time(self._now()) <= self._now(),
                self._brake_waiting_cam,
                self._switch_off,
                self._power_off,
                self._is_spindle_stopped,
            ),
        )
        self.has_driver_ended = False  # The driver has ended.
        self.fault, self.fault_code = "", ""
        self._on = False  # Power is requested.
        self._grant_at = INFINITY  # Time when power is switched on.
        self._granted = -INFINITY
        self._off_at = INFINITY
        self._handled = 0.0
        self._braked: list[float] = []  # Pieces of a deceleration by the bridge.
        self._brakings = 0
        self._missed: list[float] = []  # Rows that were too late.
        self._least = INFINITY  # Fewest rows in HAL since the last report.
        self._latest = 0.0  # s
        self._dry = 0
        self._homing: set[str] = set()
        # The chain is closed in advance for later commands of the control.
        self._chain_pins.close_chain(self._now())
        self._acts: Mapping[str, Callable[[PacketHead, Sequence[float]], None]] = {
            "beat": lambda _head, _numbers: None,
            "splice": self._splice,
            "mesh": self._mesh,
            "brake": lambda _head, _numbers: self._halt(),
            "enable": self._enable,
            "off": lambda _head, _numbers: self._power_off(),
            "ramp-off": lambda _head, _numbers: self._ramp_off(),
            "clear": lambda _head, _numbers: self._clear(),
            "spindle": lambda head, _numbers: self.spindle_pins.set_speed(head),
            "out": lambda head, _numbers: self._output_pins.set_output(head),
            "safe": lambda _head, _numbers: self._output_pins.set_safe_states(),
            "homing": self._handle_home,
            "index": self._handle_index,
            "c": self._handle_hold_c,
            "orient": lambda head, _numbers: self.spindle_pins.orient_spindle(head, self._now()),
            "end": self._end,
        }

    # --- cycles -------------------------------------------------------------------------------------------

    def queue_packet(self, head: PacketHead, numbers: Sequence[float]) -> None:
        """Queue one packet, which is executed in the next cycle."""
        self._driver_silence.hear(self._now())
        self._orders.append((head, numbers))

    def run_cycle(self, delay_s: float = 0.0) -> None:
        """Run one cycle: read samples, monitor driver and HAL, execute commands, and write rows for HAL.

        ``delay_s`` is the delay of the cycle in seconds.
        """
        now = self._now()
        self._latest = max(self._latest, delay_s)
        self.pins["heartbeat"] = not self.pins["heartbeat"]
        self._thread_silence.check(now)
        self._take_samples(now)
        self._supervise(now)
        while self._orders and not self.row_streams.is_change_locked:
            head, numbers = self._orders.popleft()
            act = self._acts.get(text(head, "do"))
            if act is not None:
                act(head, numbers)
            self._handled = number(head, "n", self._handled)
        self._update_power(now)
        self._driver_silence.advance(now, has_ended=self.has_driver_ended)
        self._fill(now)
        self.setpoint_player.queue.discard_pieces_before(now - _HISTORY_S)

    def encode_report(self) -> bytes:
        """Return a packet with the complete state and the samples since the last report."""
        rows, self._samples = (
            self._samples[: _MAX_REPORT_SAMPLES * self._width],
            self._samples[_MAX_REPORT_SAMPLES * self._width :],
        )
        pins = self.pins
        head = {
            "n": self._handled,
            "t": self.row_streams.played_row_due_s,
            "at": self._place,
            "powered": bool(pins["powered"]),
            "ok": bool(pins["chain-ok"]),
            "fault": self.fault,
            "code": self.fault_code,
            "in": [bool(pins[f"in.{name}"]) for name in self.config.inputs],
            "is": [bool(pins[f"is.{name}"]) for name in self.config.outputs],
            "analog": [pins[f"analog.{name}"] for name in self.config.analog],
            "bits": [bool(pins[name]) for name in self.config.bits],
            "figures": [pins[name] for name in self.config.figures],
            "geared": not self.setpoint_player.is_cam_inactive,
            "left": self.setpoint_player.cam_end_time_s,
            "brakings": self._brakings,
            "braked": self._braked,
            "on": self._on,
            "late": self._latest,
            "least": None if self._least == INFINITY else self._least,
            "off_by": self._off_by,
            "dry": self._dry,
            "parted": self._driver_silence.has_switched_off,
            "stands": self._is_thread_stopped,
            "stale": self._is_stale,
            "orients": self.spindle_pins.is_orienting,
            "c_at": self.spindle_pins.held_c_position,
        }
        self._latest, self._least = 0.0, INFINITY
        return pack_packet(head, rows)

    # --- feedback -----------------------------------------------------------------------------------------

    @property
    def _width(self) -> int:
        config = self.config
        return 1 + 2 * len(config.axes) + config.turns + config.speed + config.marks

    def _take_samples(self, now: float) -> None:
        count, before = len(self.config.axes), self.row_streams.played_row_number
        axes = 1 + 2 * count
        while self._sampler.readable:
            sample = self._sampler.read()
            row = int(sample[0])
            if row == self.row_streams.played_row_number and row and self._on:
                self._dry += 1
            t = self.row_streams.record_played_row(row)
            command, actual = sample[1:axes:2], sample[2:axes:2]
            self._place = tuple(actual)
            if self.config.turns:
                self.setpoint_player.spindle_predictor.add_reading(t, sample[axes])
            if self._powered:
                for name in self._following_monitor.find_faulty_axes(command, actual):
                    self._trip(f"{name}: following error", "following")
            self._samples += (t, *command, *actual, *sample[axes : self._width])
            self._sampled = True
            self._thread_silence.hear(now)
        if self.row_streams.played_row_number != before:
            self._off_by += 0.05 * (self.row_streams.played_row_due_s - now - self._off_by)
        if len(self._samples) > 40 * _MAX_REPORT_SAMPLES * self._width:  # The samples are not read.
            del self._samples[: -_MAX_REPORT_SAMPLES * self._width]

    @property
    def _powered(self) -> bool:
        return self._granted > -INFINITY

    def _supervise(self, now: float) -> None:
        pins = self.pins
        if not self.row_streams.finish_stream_change(bool(pins["plays-b"])):
            self._trip(
                "setpoints reached HAL too late; HAL executed the setpoints that were already queued", "late"
            )
        if self._is_thread_stopped:
            self._trip(
                "the HAL servo thread has stopped; check that rtapi_app is still running", "hal-thread"
            )
        if self._is_stale:
            self._trip("the board does not respond; the inputs retain the values last read", "hal-board")
        for name in self.config.bits:
            axis, _, what = name.partition(".")
            if what == "fault" and pins[name] and self._on:
                who = "the spindle drive" if axis == "spindle" else f"the {axis} axis drive"
                self._trip(f"{who} reports a fault", "axis")
            elif what.startswith("limit") and pins[name] and self._on and axis not in self._homing:
                self._trip(f"{axis}: the axis is on its limit switch", "limit-switch")
        if self._dry and self._powered:
            self._handle_empty_queue()
        self._dry = 0
        if self._powered and not pins["powered"] and now > self._granted + _CHAIN_CLOSE_S:
            self._lost_power()
        if not pins["chain-ok"]:
            self._open_chain()

    def _handle_empty_queue(self) -> None:
        """Handle missing setpoint rows.

        At rest, missing rows are ignored. In motion, they cause a trip, because HAL's limit component has
        already braked the axes.
        """
        if any(
            abs(v) > _STANDSTILL_MM_PER_S
            for v in self.setpoint_player.get_motion_at(self.row_streams.played_row_due_s)[1]
        ):
            self.setpoint_player.reset_to_position(self._target())
            self._trip(
                f"HAL had no setpoints for {self._dry} periods because this computer was late", "queue-dry"
            )

    def _target(self) -> tuple[float, ...]:
        """Return the axis positions of the last setpoint row that was written to HAL."""
        return self.setpoint_player.get_motion_at(self.row_streams.last_row_due_s)[0]

    def _lost_power(self) -> None:
        if not self.pins["alive"]:
            self._trip("HAL removed drive power because this computer stopped sending signals", "hal-silent")
        self._power_off()

    @property
    def _is_thread_stopped(self) -> bool:
        """Return whether HAL's servo thread has stopped, which means that its pins are no longer updated."""
        return self._sampled and self._thread_silence.is_exceeded

    @property
    def _is_stale(self) -> bool:
        """Return whether hal.link_fault reports that the board's inputs are stale."""
        return "link-fault" in self.config.bits and bool(self.pins["link-fault"])

    def _open_chain(self) -> None:
        """Command the spindle and outputs off, so that they stay off when the E-stop chain closes."""
        self.spindle_pins.switch_spindle_off()
        self._output_pins.switch_outputs_off()

    def _trip(self, fault: str, code: str) -> None:
        """Set the fault, and brake all axes on their path before the power is switched off."""
        if not self.fault:
            self.fault, self.fault_code = fault, code
        if self._on and self._off_at == INFINITY:
            self._ramp_off()

    # --- rows ---------------------------------------------------------------------------------------------

    def _fill(self, now: float) -> None:
        rows, config = self.row_streams, self.config
        if not self._sampled:
            return
        if not self._on:
            self.setpoint_player.reset_to_position(self._place)
        elif self._powered:
            self._least = min(self._least, rows.pending_row_count)
        rest = self.setpoint_player.get_end_time(now) <= rows.last_row_due_s
        slew = _MAX_SLEW_AT_REST if rest else _MAX_SLEW_IN_MOTION
        step = config.period * (1.0 - min(max(self._off_by / _CORRECTION_TIME_S, -slew), slew))
        rows.last_row_due_s = max(rows.last_row_due_s, now)
        most = round(2.0 * config.ahead / config.period)
        while (t := rows.last_row_due_s + step) <= now + config.ahead and rows.pending_row_count < most:
            if not rows.write_row(t, self.setpoint_player.get_row_at(t)):
                return

    def _recall(self, t: float, same_until: float = -INFINITY) -> bool:
        return self.row_streams.recall_rows(t, self.setpoint_player.get_row_at, same_until)

    # --- commands -----------------------------------------------------------------------------------------

    def _splice(self, head: PacketHead, numbers: Sequence[float]) -> None:
        self._parts += parse_pieces(numbers, len(self.config.axes))
        if head.get("more"):
            return
        pieces, self._parts = self._parts, []
        if not self._on or not pieces or self._off_at < INFINITY:
            return
        t = pieces[0].start_time_s
        if self.row_streams.find_first_recallable_row(t) is None:
            if not self.row_streams.has_same_locked_rows(t, make_row_function(pieces)):
                self._trip("setpoints arrived too late to be executed", "late")
                return
            t = self.row_streams.find_earliest_recall_time()
        self.setpoint_player.splice_pieces(pieces)
        self._recall(t)

    def _mesh(self, head: PacketHead, numbers: Sequence[float]) -> None:
        self._parts += parse_pieces(numbers, len(self.config.axes))
        if head.get("more"):
            return
        pieces, self._parts = self._parts, []
        if not self._on or self._off_at < INFINITY:
            return
        zero, sign, t = (
            number(head, "zero"),
            number(head, "sign", 1.0),
            self.row_streams.find_earliest_recall_time(),
        )
        left = pieces[0].start_time_s - sign * (
            self.setpoint_player.spindle_predictor.predict_revolutions(t) - zero
        )  # turns
        if left < 0.0:
            if self.setpoint_player.is_cam_inactive:
                self._trip("the threading setpoints arrived too late to be executed", "late")
            return  # The earlier setpoints are a complete pass too.
        count = int(number(head, "way"))
        self.setpoint_player.engage_cam(zero, sign, pieces[:count], pieces[count:])
        # The path is unchanged until the spindle is there, so the change need not be immediate.
        until = t + _SAFE_TIME_FRACTION * left / max(
            sign * self.setpoint_player.spindle_predictor.speed_rev_per_s, _STANDSTILL_REV_PER_S
        )
        self._recall(0.5 * (t + until), until)

    def _brake_axes(self) -> float:
        """Replace the setpoints by a braking ramp, and return the end time of the ramp in seconds.

        The ramp starts at the first setpoint row that can still be recalled.
        """
        t = self.row_streams.find_earliest_recall_time()
        pieces = self.setpoint_player.brake_to_rest(t, [axis.amax for axis in self.config.axes])
        self._braked = list(
            flatten_pieces(
                pieces or [MotionPiece(t, 0.0, *self.setpoint_player.get_motion_at(t), self._still)]
            )
        )
        self._brakings += 1
        self._recall(t)
        return pieces[-1].start_time_s + pieces[-1].duration_s if pieces else t

    def _halt(self) -> None:
        if self._on and self._off_at == INFINITY:
            self._brake_axes()

    @property
    def _still(self) -> tuple[float, ...]:
        return (0.0,) * len(self.config.axes)

    def _enable(self, _head: PacketHead, _numbers: Sequence[float]) -> None:
        if self.fault or self._on:
            return
        self.setpoint_player.reset_to_position(self._place)
        self._recall(self.row_streams.find_earliest_recall_time())
        self._on, self._off_at = True, INFINITY
        self._following_monitor.reset()
        self._grant_at = self.row_streams.last_row_due_s
        self._chain_pins.close_chain(self._now())

    def _update_power(self, now: float) -> None:
        """End the reset pulse of the E-stop chain when it is due, and switch on the drives.

        The drives are switched on when HAL plays a setpoint row with the current axis positions.
        """
        self._chain_pins.update_pulses(now)
        if self._grant_at <= now:
            self._grant_at, self._granted = INFINITY, now
            self.pins["enable"] = 1
        self.spindle_pins.apply_due_actions(now)
        if self._off_at <= now:
            self._power_off()

    def _power_off(self) -> None:
        self.pins["enable"] = 0
        self._on = False
        self._grant_at = self._off_at = INFINITY
        self._granted = -INFINITY
        self._homing.clear()
        self.spindle_pins.release_c()
        self.setpoint_player.reset_to_position(self._place)

    def _ramp_off(self) -> None:
        if not self._on:
            return
        self._off_at = self._brake_axes() + self.config.period

    def _clear(self) -> None:
        self._power_off()
        self.fault = self.fault_code = ""
        self._chain_pins.close_chain(self._now())

    def _handle_hold_c(self, head: PacketHead, _numbers: Sequence[float]) -> None:
        """Engage the C axis at the current spindle position, or release it.

        To engage C, its setpoint is set to this position. The drive is switched to C when HAL plays this
        setpoint.
        """
        if head.get("on") is not True:
            self.spindle_pins.release_c()
        elif self._on:
            place = list(self._target())
            for index, axis in enumerate(self.config.axes):
                if axis.is_spindle:
                    place[index] = self.spindle_pins.c_position = self._place[index]
            self.setpoint_player.reset_to_position(place)
            self._recall(self.row_streams.find_earliest_recall_time())
            self.spindle_pins.request_position_mode(self.row_streams.last_row_due_s)

    def _handle_home(self, head: PacketHead, _numbers: Sequence[float]) -> None:
        """Record that an axis starts or ends homing; its limit switch is ignored while it is homing."""
        name = text(head, "axis")
        (self._homing.add if head.get("on") is True else self._homing.discard)(name)

    def _handle_index(self, head: PacketHead, _numbers: Sequence[float]) -> None:
        """Request the next index of an encoder, or cancel the request.

        The pin of the request turns off when the index passes.
        """
        self.pins[text(head, "pin")] = head.get("on") is True

    def _end(self, _head: PacketHead, _numbers: Sequence[float]) -> None:
        self.has_driver_ended = True

    # --- without a driver ---------------------------------------------------------------------------------

    @property
    def is_done(self) -> bool:
        """Return whether the driver has ended and the machine is at rest and switched off."""
        return self._driver_silence.is_done

    @property
    def _is_spindle_at_standstill(self) -> bool:
        return abs(self.setpoint_player.spindle_predictor.speed_rev_per_s) < _STANDSTILL_REV_PER_S

    def _brake_waiting_cam(self) -> None:
        """Brake axes that follow a stopped spindle, because their queue would otherwise never end."""
        if not self.setpoint_player.is_cam_inactive and self._is_spindle_at_standstill:
            self._brake_axes()

    def _switch_off(self) -> None:
        self.spindle_pins.switch_spindle_off()
        self._output_pins.set_safe_states()

    def _is_spindle_stopped(self) -> bool:
        """Return whether the spindle is stopped, or True if its position is not known."""
        return not self.config.turns or self._is_thread_stopped or self._is_spindle_at_standstill
