"""Complete machine on one CANopen bus, driven by the one loop that owns the bus."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from core.message import Message
from core.ports import (
    ALL_UNKNOWN,
    PROBE,
    Clock,
    DriverError,
    FloatArray,
    MachinePorts,
    Spindle,
    Stop,
    Unknown,
)
from drivers.canopen.canopen_axes import CanopenAxes
from drivers.canopen.canopen_bus import Bus
from drivers.canopen.canopen_config import CanopenConfig
from drivers.canopen.canopen_encoder import CanEncoder, MeasuredSpindle
from drivers.canopen.canopen_objects import DriveState
from drivers.canopen.canopen_spindle import CanopenSpindle, SpindleC
from drivers.canopen.canopen_terminals import CanopenIO, CanopenProbe
from drivers.canopen.cia402_drives import Drive402
from drivers.canopen.position_modes import CyclicFollower
from drivers.port_parts import KEPT, SampleLog

_NAN = float("nan")
_UNTRACED = (
    'drive tests are not available, because with [canopen] mode = "pp" the drives plan their own moves'
)
# Seconds and fraction of a period before a SYNC at which the replies are read.
_BEFORE, _PART_BEFORE = 0.0004, 0.3
_EPSILON = 1e-9
_ANSWER = 0.01  # Seconds until the replies arrive.
_EARLY = 0.3  # Fraction of the SYNC period by which a SYNC may be early in this case.
_RESTING = 0.1  # Seconds between two replies of every node while the control sleeps.
_QUIET = 1.0  # Seconds between two warnings.
_FIRST = 0.5  # Seconds in which all nodes must reply to the first SYNC.


class CanopenSamples:
    """``core.ports.SampleSource`` with the replies of the drives to each SYNC."""

    def __init__(
        self, axes: CanopenAxes, spindle: Spindle, sync: float, spindle_drive: Drive402 | None
    ) -> None:
        self.rate = 1.0 / sync
        self._axes, self._spindle, self._spindle_drive = axes, spindle, spindle_drive
        self._drives = {axis.config.name: axis.drive for axis in axes.drives.axes}
        self._log = SampleLog(len(axes.axes))

    def note(self, now: float) -> None:
        """Store the replies to a SYNC that is newer than the last stored one."""
        if self._axes.drives.seen <= self._log.last:
            return
        sample, angle = self._axes.sample(), self._spindle.angle()
        turns = angle[1] if angle is not None else _NAN
        load = [self._drives[name].load if name in self._drives else _NAN for name in self._axes.axes]
        turning = self._spindle_drive.load if self._spindle_drive is not None else _NAN
        left = self._axes.queue.horizon(now) - now
        self._log.add(
            sample.t, *sample.demand, *sample.actual, *load, self._spindle.speed(), turns, turning, left
        )

    def take(self, most: int = KEPT) -> FloatArray:
        """Return at most ``most`` samples since the last call, oldest first."""
        return self._log.take(most)


class CanopenMachine:
    """Machine on the bus, connected by its constructor.

    The constructor raises DriverError that names the first node which does not match the machine file.
    """

    def __init__(self, config: CanopenConfig, clock: Clock, idle: Callable[[], None] | None = None) -> None:
        self.config = config
        self.clock = clock
        self.bus = Bus(config.bus, clock, idle)
        self._next = clock.now()
        # Replies to the last SYNC are read; setpoints are being calculated.
        self._looked = self._feeding = False
        self._sent = self._next  # Time of the last SYNC.
        self._early = _EPSILON
        self.asked = False  # The last cycle has sent a SYNC, and the next reads the replies.
        self._waits = False  # Waiting for replies to it.
        self._count = 0  # Number of SYNCs.
        self._told = -_QUIET
        try:
            self.axes = CanopenAxes(config, self.bus)
            self.spindle = CanopenSpindle(config.spindle, self.bus) if config.spindle else None
            drives = {axis.config.name: axis.drive for axis in self.axes.drives.axes}
            self.io = CanopenIO(config, self.bus, drives)
            self.axes.clearing = [self.io.clear_fault]
            if self.spindle is not None:
                self.axes.clearing.append(self.spindle.clear_fault)
            self.encoder = self._encoder(drives)
            self.c = self._spindle_c()
            self.touch = CanopenProbe(self.axes, self.io, config.bus.sync) if PROBE in config.inputs else None
            self.samples = CanopenSamples(
                self.axes,
                self._turning,
                config.bus.sync,
                self.spindle.drive if self.spindle is not None else None,
            )
            self.axes.reconnect = self._reconnect
            if self.axes.cyclic:
                self.axes.queue.give_way = self._give_way
            self._connect()
        except DriverError:
            self.bus.close()
            raise

    def _encoder(self, drives: Mapping[str, Drive402]) -> CanEncoder | None:
        config = self.config.encoder
        if config is None:
            return None
        encoder = CanEncoder(config, self.bus, None if config.node else drives[config.name])
        self.axes.clearing.append(encoder.clear_fault)
        return encoder

    def _spindle_c(self) -> SpindleC | None:
        if self.spindle is None or self.config.spindle is None or not self.config.spindle.is_c:
            return None
        found = SpindleC(self.axes, self.spindle, "C")
        self.axes.clearing.append(found.clear_fault)
        return found

    @property
    def _turning(self) -> Spindle:
        return self.spindle or MeasuredSpindle(self.encoder)

    @property
    def ports(self) -> MachinePorts:
        """The ports for the executor; the terminals are also the operator station."""
        return MachinePorts(
            clock=self.clock,
            axes=self.axes,
            spindle=self._turning,
            io=self.io,
            station=self.io,
            lock=self.c,
            samples=self.samples,
            touch=self.touch,
            unknown=self.unknown,
            untraced=_UNTRACED if self.config.bus.mode == "pp" else "",
            warnings=tuple(each for axis in self.axes.drives.axes for each in axis.drive.setup.warnings),
        )

    def unknown(self) -> frozenset[Unknown]:
        """Return the states that are unknown because their devices are silent or the bus has failed."""
        if self.bus.trouble:
            return ALL_UNKNOWN
        found: set[Unknown] = set()
        if any(axis.drive.silent for axis in self.axes.drives.axes):
            found.add(Unknown.SLIDES)
        if self.spindle is not None and self.spindle.drive.silent:
            found.add(Unknown.SPINDLE)
        if any(module.silent for module in self.io.modules.values()):
            found |= {Unknown.OUTPUTS, Unknown.INPUTS}
        return frozenset(found)

    def tick(self) -> None:
        """Run one cycle: receive, supervise, feed, command and SYNC.

        It must be called every few milliseconds, or at the time that ``wake`` returns.
        """
        if not self.axes.cyclic:
            self._look(exchange=True)
            return
        schedule = self.axes.schedule
        due = self.clock.now() >= schedule.due - _EPSILON
        # Received replies belong to the last SYNC and must be processed first.
        if not due or not self._looked:
            self._look(exchange=False)
            self._looked = True
        if due and not self.bus.trouble:
            self._cycle()

    def wake(self) -> float | None:
        """Return the time of the next cycle: shortly before a SYNC to read replies, or at the SYNC.

        None means every 5 ms.
        """
        if not self.axes.cyclic:
            return None
        schedule = self.axes.schedule
        before = max(_BEFORE, _PART_BEFORE * schedule.period)
        return schedule.due if self._looked else schedule.due - before

    def notes(self) -> Sequence[str]:
        """Return a warning about late setpoints, at most once per second."""
        follower, now = self.axes.follower, self.clock.now()
        if not isinstance(follower, CyclicFollower) or not follower.gaps or now < self._told + _QUIET:
            return ()
        schedule = follower.schedule
        told = Message(
            "setpoints were late {gaps} times, by up to {worst} ms",
            gaps=follower.gaps,
            worst=f"{1000 * schedule.worst:.1f}",
        )
        follower.gaps, schedule.worst, self._told = 0, 0.0, now
        return (
            Message(
                "{details}, and the axes waited for the setpoints; check that the driver host has "
                "real-time priority",
                details=told,
            ),
        )

    def _cycle(self) -> None:
        """Send SYNC at its time, then the commands for the next one."""
        now = self.clock.now()
        waited = self.axes.schedule.sent(now)
        try:
            self.bus.synchronise()
            self._looked = False
            self._count += 1
            counted = self._count % self.config.bus.seldom == 0
            self._sync_sent(now, counted=counted)
            if not self._feeding:  # Otherwise a homing is waiting for a node.
                self._feeding = True
                if waited and isinstance(self.axes.follower, CyclicFollower):
                    self.axes.follower.waited(waited)
                self.axes.go_on(now)
                self._feeding = False
            self.axes.drives.command()
            if counted:
                self._command_spindle()
        except DriverError as error:
            self.bus.lost(str(error))

    def _meanwhile(self) -> float:
        """Keep sending SYNC and setpoints while waiting for a node; return the seconds to the next SYNC."""
        left = self.axes.schedule.due - self.clock.now()
        if left <= 0.0 and not self.bus.trouble:
            self._cycle()
        return max(self.axes.schedule.due - self.clock.now(), 0.0)

    def _give_way(self) -> None:
        """Send SYNC at its time while a long path is queued, after reading the replies to the last one."""
        if self.clock.now() >= self.axes.schedule.due - _EPSILON and not self.bus.trouble:
            self.bus.pump()
            self._cycle()

    def _look(self, *, exchange: bool) -> None:
        """Receive and supervise; with ``exchange``, also feed, command and send SYNC when it is due."""
        before, self.asked = self.asked, False
        self.bus.pump()
        self._waits = self._waits and not self._answered()
        now = self.clock.now()
        self.axes.tick(now)
        self.samples.note(now)
        if self.touch is not None:
            self.touch.note()
        if self.bus.trouble:
            return
        try:
            self.axes.beside = self.io.tick(now) or (self.c.trouble if self.c is not None else "")
            if self.spindle is not None:
                self.spindle.tick()
            if self.c is not None:
                self.c.tick(now)
            if self.encoder is not None:
                self.encoder.look()
            early = _EPSILON if self._waits else self._early
            if exchange and (now >= self._next - early or self.axes.follower.urgent):
                self._next = max(self._next, now - self.config.bus.sync) + self.config.bus.sync
                self._sent = now
                self.axes.follower.urgent = False
                self._exchange()
                self._waits, self.asked = (
                    True,
                    not before,
                )  # If SYNCs follow immediately, every other one counts.
        except DriverError as error:
            self.bus.lost(str(error))

    def idle(self, asleep: bool) -> float:
        """Return the seconds until the next SYNC, heartbeat or reply is due while the control sleeps.

        The result is 0 if the control is not ``asleep``, while a drive moves, or after a bus failure. While
        the control sleeps, replies are needed only ten times per second.
        """
        bus = self.config.bus
        apart = max(bus.sync, _RESTING / bus.seldom if asleep else 0.0)
        self._next, self._early = self._sent + apart, _EARLY * apart if asleep else _EPSILON
        if not asleep or self.bus.trouble or self.axes.follower.urgent or self.axes.sample().moving:
            return 0.0
        next_ = min(self._next, self.bus.next_beat) - self.clock.now()
        return max(min(next_, _ANSWER) if self._waits else next_, 0.0)

    def close(self) -> None:
        """Switch the power off if the bus works, then close the bus."""
        if not self.bus.trouble:
            self.axes.stop(Stop.RAMP_OFF)
            self.io.safe()
            if self.spindle is not None:
                self.spindle.coast()
                if self.spindle.drive not in self.axes.drives.drives:
                    self.spindle.drive.goal = DriveState.OFF  # Also during the change to C.
                self._exchange()
        self.bus.close()

    def _connect(self) -> None:
        """Configure all nodes, then start them by NMT."""
        self.axes.connect()
        if self.spindle is not None:
            self.spindle.connect()
        if self.encoder is not None:
            self.encoder.connect()
        self.io.connect()
        self.axes.drives.operational()
        self.axes.schedule.due = self.clock.now()
        if self.axes.cyclic:
            self.bus.meanwhile = self._meanwhile
        if self.spindle is not None:
            self.spindle.drive.operational()
        if self.encoder is not None:
            self.encoder.operational()
        self.io.operational()
        self.bus.beat(at_once=True)
        self._exchange()
        self.bus.wait(self._answered, _FIRST)

    def _reconnect(self) -> None:
        """Reopen the bus and configure all nodes; axes with incremental encoders lose their home."""
        self.bus.reopen()
        try:
            self._connect()
        except DriverError as error:
            self.bus.lost(str(error))
            raise

    def _answered(self) -> bool:
        drives = [axis.drive for axis in self.axes.drives.axes]
        if self.spindle is not None:
            drives.append(self.spindle.drive)
        silent = [drive.missing for drive in drives] + [m.missing for m in self.io.modules.values()]
        if self.encoder is not None:
            silent.append(self.encoder.missing)
        return not any(silent)

    def _exchange(self) -> None:
        self.axes.drives.command()
        self._command_spindle()
        self._sync_sent(self.clock.now(), counted=True)
        self.bus.synchronise()

    def _command_spindle(self) -> None:
        if self.spindle is not None and self.spindle.drive not in self.axes.drives.drives:
            self.spindle.drive.command()

    def _sync_sent(self, now: float, *, counted: bool) -> None:
        """Record a SYNC at all devices.

        With ``counted``, slow devices must have replied once since the last counted SYNC.
        """
        self.axes.drives.sync_sent(now)
        if self.spindle is not None and self.spindle.drive not in self.axes.drives.drives:
            self.spindle.drive.sync_sent(now, counted=counted)
        if self.encoder is not None:
            self.encoder.sync_sent(now, counted=counted)
        if counted:
            for module in self.io.modules.values():
                module.sync_sent()
