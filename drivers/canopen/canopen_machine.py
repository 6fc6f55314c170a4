"""Complete machine on one CANopen bus, controlled by the loop that owns the bus."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from core.message import Message
from core.ports import (
    ALL_UNKNOWN_PARTS,
    PROBE_INPUT,
    Clock,
    DriverError,
    FloatArray,
    MachinePorts,
    Spindle,
    StopMode,
    UnknownPart,
)
from drivers.canopen.canopen_axes import CanopenAxes
from drivers.canopen.canopen_bus import CanBus
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_encoder import CanEncoder, MeasuredSpindle
from drivers.canopen.canopen_objects import DriveState
from drivers.canopen.canopen_spindle import CanopenCAxis, CanopenSpindle
from drivers.canopen.canopen_terminals import CanopenIO, CanopenProbe
from drivers.canopen.cia402_drives import Cia402Drive
from drivers.canopen.position_modes import CyclicSetpointFollower
from drivers.port_checks import LOG_ROWS, SampleRingBuffer

_NAN = float("nan")
_UNTRACED_REASON = (
    'drive tests are not available, because with [canopen] mode = "pp" the drives plan their own moves'
)
# Seconds and fraction of a period before a SYNC at which the replies are read.
_BEFORE, _PART_BEFORE = 0.0004, 0.3
_EPSILON = 1e-9
_REPLY_TIME_S = 0.01  # Seconds until the replies arrive.
_MAX_EARLY_FRACTION = 0.3  # Fraction of the SYNC period by which a SYNC may be early in this case.
_IDLE_REPLY_PERIOD_S = 0.1  # Seconds between two replies of every node while the control sleeps.
_WARNING_PERIOD_S = 1.0  # Seconds between two warnings.
_FIRST_REPLY_S = 0.5  # Seconds in which all nodes must reply to the first SYNC.


class CanopenSamples:
    """``core.ports.SampleSource`` that stores the replies of the drives to each SYNC."""

    def __init__(
        self, axes: CanopenAxes, spindle: Spindle, sync_period_s: float, spindle_drive: Cia402Drive | None
    ) -> None:
        self.sample_rate_hz = 1.0 / sync_period_s
        self._axes, self._spindle, self._spindle_drive = axes, spindle, spindle_drive
        self._drives = {axis.config.name: axis.drive for axis in axes.drives.axes}
        self._log = SampleRingBuffer(len(axes.axes))

    def record_replies(self, now: float) -> None:
        """Store the replies to the last SYNC, unless they are already stored."""
        if self._axes.drives.last_reply_s <= self._log.newest_time_s:
            return
        sample, angle = self._axes.sample(), self._spindle.read_angle()
        turns = angle[1] if angle is not None else _NAN
        load = [
            self._drives[name].torque_percent if name in self._drives else _NAN for name in self._axes.axes
        ]
        turning = self._spindle_drive.torque_percent if self._spindle_drive is not None else _NAN
        left = self._axes.queue.get_end_time(now) - now
        self._log.append_row(
            sample.t, *sample.demand, *sample.actual, *load, self._spindle.speed(), turns, turning, left
        )

    def take_samples(self, max_rows: int = LOG_ROWS) -> FloatArray:
        """Return at most ``max_rows`` samples that were stored since the last call, oldest first."""
        return self._log.pop_rows(max_rows)


class CanopenMachine:
    """Complete machine on the CAN bus; the constructor connects all nodes.

    The constructor raises DriverError with the name of the first node that does not match the machine file.
    """

    def __init__(self, config: CanopenConfig, clock: Clock, idle: Callable[[], None] | None = None) -> None:
        self.config = config
        self.clock = clock
        self.bus = CanBus(config.bus_settings, clock, idle)
        self._next = clock.now()
        # Replies to the last SYNC are read; setpoints are being calculated.
        self._looked = self._feeding = False
        self._sent = self._next  # Time of the last SYNC.
        self._early = _EPSILON
        self.has_sent_sync = False  # The last cycle has sent a SYNC, and the next reads the replies.
        self._waits = False  # Waiting for replies to it.
        self._count = 0  # Number of SYNCs.
        self._told = -_WARNING_PERIOD_S
        try:
            self.axes = CanopenAxes(config, self.bus)
            self.spindle = CanopenSpindle(config.spindle, self.bus) if config.spindle else None
            drives = {axis.config.name: axis.drive for axis in self.axes.drives.axes}
            self.io = CanopenIO(config, self.bus, drives)
            self.axes.fault_clearers = [self.io.clear_fault]
            if self.spindle is not None:
                self.axes.fault_clearers.append(self.spindle.clear_fault)
            self.encoder = self._encoder(drives)
            self.spindle_c = self._spindle_c()
            self.touch_input = (
                CanopenProbe(self.axes, self.io, config.bus_settings.sync)
                if PROBE_INPUT in config.inputs
                else None
            )
            self.samples = CanopenSamples(
                self.axes,
                self._turning,
                config.bus_settings.sync,
                self.spindle.drive if self.spindle is not None else None,
            )
            self.axes.reconnect_bus = self._reconnect
            if self.axes.is_cyclic:
                self.axes.queue.yield_cpu = self._yield_cpu
            self._connect()
        except DriverError:
            self.bus.close()
            raise

    def _encoder(self, drives: Mapping[str, Cia402Drive]) -> CanEncoder | None:
        config = self.config.encoder
        if config is None:
            return None
        encoder = CanEncoder(config, self.bus, None if config.node else drives[config.name])
        self.axes.fault_clearers.append(encoder.clear_fault)
        return encoder

    def _spindle_c(self) -> CanopenCAxis | None:
        if self.spindle is None or self.config.spindle is None or not self.config.spindle.is_c_axis:
            return None
        found = CanopenCAxis(self.axes, self.spindle, "C")
        self.axes.fault_clearers.append(found.clear_fault)
        return found

    @property
    def _turning(self) -> Spindle:
        return self.spindle or MeasuredSpindle(self.encoder)

    @property
    def ports(self) -> MachinePorts:
        """Return the ports for the executor; the terminals also serve as the operator station."""
        return MachinePorts(
            clock=self.clock,
            axes=self.axes,
            spindle=self._turning,
            io=self.io,
            station=self.io,
            lock=self.spindle_c,
            samples=self.samples,
            touch=self.touch_input,
            unknown=self.find_unknown_items,
            untraced=_UNTRACED_REASON if self.config.bus_settings.mode == "pp" else "",
            warnings=tuple(each for axis in self.axes.drives.axes for each in axis.drive.setup.warnings),
        )

    def find_unknown_items(self) -> frozenset[UnknownPart]:
        """Return the parts of the machine whose state is unknown.

        The state of a part is unknown if its device does not respond or the bus has failed.
        """
        if self.bus.failure:
            return ALL_UNKNOWN_PARTS
        found: set[UnknownPart] = set()
        if any(axis.drive.is_silent for axis in self.axes.drives.axes):
            found.add(UnknownPart.AXES)
        if self.spindle is not None and self.spindle.drive.is_silent:
            found.add(UnknownPart.SPINDLE)
        if any(module.is_silent for module in self.io.modules.values()):
            found |= {UnknownPart.OUTPUTS, UnknownPart.INPUTS}
        return frozenset(found)

    def run_cycle(self) -> None:
        """Run one cycle: receive frames, supervise devices, feed setpoints, and send commands and SYNC.

        This method must be called every few milliseconds, or at the times that ``get_next_cycle_time``
        returns.
        """
        if not self.axes.is_cyclic:
            self._supervise(exchange=True)
            return
        schedule = self.axes.sync_schedule
        due = self.clock.now() >= schedule.due_time_s - _EPSILON
        # Received replies belong to the last SYNC and must be processed first.
        if not due or not self._looked:
            self._supervise(exchange=False)
            self._looked = True
        if due and not self.bus.failure:
            self._cycle()

    def get_next_cycle_time(self) -> float | None:
        """Return the time of the next cycle, or None if cycles run every 5 ms in this motion mode.

        If replies must be read first, the time is shortly before the next SYNC, otherwise at that SYNC.
        """
        if not self.axes.is_cyclic:
            return None
        schedule = self.axes.sync_schedule
        before = max(_BEFORE, _PART_BEFORE * schedule.period_s)
        return schedule.due_time_s if self._looked else schedule.due_time_s - before

    def collect_warnings(self) -> Sequence[str]:
        """Return a warning if setpoints were late since the last warning, at most once per second."""
        follower, now = self.axes.follower, self.clock.now()
        if (
            not isinstance(follower, CyclicSetpointFollower)
            or not follower.gap_count
            or now < self._told + _WARNING_PERIOD_S
        ):
            return ()
        schedule = follower.schedule
        delay_text = Message(
            "setpoints were late {gaps} times, by up to {worst} ms",
            gaps=follower.gap_count,
            worst=f"{1000 * schedule.max_delay_s:.1f}",
        )
        follower.gap_count, schedule.max_delay_s, self._told = 0, 0.0, now
        return (
            Message(
                "{details}, and the axes waited for the setpoints; check that the driver host has "
                "real-time priority",
                details=delay_text,
            ),
        )

    def _cycle(self) -> None:
        """Send SYNC when it is due, and then the commands for the next SYNC."""
        now = self.clock.now()
        waited = self.axes.sync_schedule.record_sync(now)
        try:
            self.bus.send_sync()
            self._looked = False
            self._count += 1
            counted = self._count % self.config.bus_settings.slow_reply_divisor == 0
            self._record_sync(now, reply_expected=counted)
            if not self._feeding:  # Otherwise a homing is waiting for a node.
                self._feeding = True
                if waited and isinstance(self.axes.follower, CyclicSetpointFollower):
                    self.axes.follower.delay_path(waited)
                self.axes.advance_motion(now)
                self._feeding = False
            self.axes.drives.send_commands()
            if counted:
                self._command_spindle()
        except DriverError as error:
            self.bus.mark_failed(str(error))

    def _wait_callback(self) -> float:
        """Send SYNC and setpoints when they are due, while the caller waits for a node to reply.

        Returns the time until the next SYNC in seconds.
        """
        left = self.axes.sync_schedule.due_time_s - self.clock.now()
        if left <= 0.0 and not self.bus.failure:
            self._cycle()
        return max(self.axes.sync_schedule.due_time_s - self.clock.now(), 0.0)

    def _yield_cpu(self) -> None:
        """Send SYNC when it is due while a long path is being queued.

        The replies to the previous SYNC are read first.
        """
        if self.clock.now() >= self.axes.sync_schedule.due_time_s - _EPSILON and not self.bus.failure:
            self.bus.process_frames()
            self._cycle()

    def _supervise(self, *, exchange: bool) -> None:
        """Receive frames and supervise the devices.

        With ``exchange``, also feed setpoints, and send commands and SYNC when they are due.
        """
        before, self.has_sent_sync = self.has_sent_sync, False
        self.bus.process_frames()
        self._waits = self._waits and not self._answered()
        now = self.clock.now()
        self.axes.run_cycle(now)
        self.samples.record_replies(now)
        if self.touch_input is not None:
            self.touch_input.record_touch()
        if self.bus.failure:
            return
        try:
            self.axes.other_device_fault = self.io.run_cycle(now) or (
                self.spindle_c.failure if self.spindle_c is not None else ""
            )
            if self.spindle is not None:
                self.spindle.supervise_drive()
            if self.spindle_c is not None:
                self.spindle_c.advance_mode_change(now)
            if self.encoder is not None:
                self.encoder.supervise_encoder()
            early = _EPSILON if self._waits else self._early
            if exchange and (now >= self._next - early or self.axes.follower.must_send_now):
                self._next = (
                    max(self._next, now - self.config.bus_settings.sync) + self.config.bus_settings.sync
                )
                self._sent = now
                self.axes.follower.must_send_now = False
                self._exchange()
                self._waits, self.has_sent_sync = (
                    True,
                    not before,
                )  # If SYNCs follow immediately, every other one counts.
        except DriverError as error:
            self.bus.mark_failed(str(error))

    def get_idle_time(self, is_asleep: bool) -> float:
        """Return how many seconds the loop may wait until the next SYNC, heartbeat or reply is due.

        The result is 0 if ``is_asleep`` is false, while a drive moves, or after a bus failure. While the
        control is asleep, the drives must reply only ten times per second.
        """
        bus = self.config.bus_settings
        apart = max(bus.sync, _IDLE_REPLY_PERIOD_S / bus.slow_reply_divisor if is_asleep else 0.0)
        self._next, self._early = self._sent + apart, _MAX_EARLY_FRACTION * apart if is_asleep else _EPSILON
        if not is_asleep or self.bus.failure or self.axes.follower.must_send_now or self.axes.sample().moving:
            return 0.0
        next_ = min(self._next, self.bus.next_heartbeat_s) - self.clock.now()
        return max(min(next_, _REPLY_TIME_S) if self._waits else next_, 0.0)

    def close(self) -> None:
        """Switch the power off, unless the bus has failed, and then close the bus."""
        if not self.bus.failure:
            self.axes.stop(StopMode.RAMP_OFF)
            self.io.switch_to_safe_state()
            if self.spindle is not None:
                self.spindle.start_coasting()
                if self.spindle.drive not in self.axes.drives.drives:
                    self.spindle.drive.goal_state = (
                        DriveState.SWITCH_ON_DISABLED
                    )  # Also during the change to C.
                self._exchange()
        self.bus.close()

    def _connect(self) -> None:
        """Configure all nodes and then start them by NMT."""
        self.axes.connect()
        if self.spindle is not None:
            self.spindle.connect()
        if self.encoder is not None:
            self.encoder.connect()
        self.io.connect()
        self.axes.drives.start_nodes()
        self.axes.sync_schedule.due_time_s = self.clock.now()
        if self.axes.is_cyclic:
            self.bus.wait_callback = self._wait_callback
        if self.spindle is not None:
            self.spindle.drive.start_node()
        if self.encoder is not None:
            self.encoder.start_node()
        self.io.start_nodes()
        self.bus.send_heartbeat(force=True)
        self._exchange()
        self.bus.wait_until(self._answered, _FIRST_REPLY_S)

    def _reconnect(self) -> None:
        """Reopen the bus and configure all nodes.

        Axes with incremental encoders must then be homed again.
        """
        self.bus.reopen()
        try:
            self._connect()
        except DriverError as error:
            self.bus.mark_failed(str(error))
            raise

    def _answered(self) -> bool:
        drives = [axis.drive for axis in self.axes.drives.axes]
        if self.spindle is not None:
            drives.append(self.spindle.drive)
        silent = [drive.missing_reply_count for drive in drives] + [
            m.missing_reply_count for m in self.io.modules.values()
        ]
        if self.encoder is not None:
            silent.append(self.encoder.missing_reply_count)
        return not any(silent)

    def _exchange(self) -> None:
        self.axes.drives.send_commands()
        self._command_spindle()
        self._record_sync(self.clock.now(), reply_expected=True)
        self.bus.send_sync()

    def _command_spindle(self) -> None:
        if self.spindle is not None and self.spindle.drive not in self.axes.drives.drives:
            self.spindle.drive.send_command()

    def _record_sync(self, now: float, *, reply_expected: bool) -> None:
        """Record a SYNC for all devices.

        With ``reply_expected``, slow devices must have replied once since the last such SYNC.
        """
        self.axes.drives.record_sync(now)
        if self.spindle is not None and self.spindle.drive not in self.axes.drives.drives:
            self.spindle.drive.record_sync(now, reply_expected=reply_expected)
        if self.encoder is not None:
            self.encoder.record_sync(now, reply_expected=reply_expected)
        if reply_expected:
            for module in self.io.modules.values():
                module.record_sync()
