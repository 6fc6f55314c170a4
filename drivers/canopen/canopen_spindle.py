"""The spindle on the bus: a drive in profile velocity mode, which makes its own ramps."""

from __future__ import annotations

from core.message import Message
from core.ports import DriverError, Fault
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import Bus
from drivers.canopen.canopen_config import SpindleConfig
from drivers.canopen.canopen_objects import HM, IP, MODE_BITS, PV, DriveState
from drivers.canopen.canopen_setup import stopping
from drivers.canopen.cia402_drives import SPEED, SPEED_TARGET, Drive402, DriveWork

_STANDS = 2.0  # rpm
_KEPT_TURNING = (od.ABORT_OPTION, od.WATCHED)  # without these it turns on when this computer falls silent
_POWER = 1.0  # s in which the drive must come on


class CanopenSpindle:
    """``core.ports.Spindle``. The drive is without power unless it turns or is asked to."""

    def __init__(self, config: SpindleConfig, bus: Bus) -> None:
        self._config = config
        self._bus = bus
        self._came_on = False
        self._last = self._counts = 0
        self._ordered = 0.0  # s, when power was last asked for
        self.lent = False  # to C: it does not turn as the spindle
        self.kept = False  # and shall stay so
        self.blind = False  # its counter leaps by homing: that is no turning
        self.drive = Drive402(bus, config.node, SPEED_TARGET, (SPEED,))

    def connect(self) -> None:
        """Configure it. Raises DriverError."""
        config = self._config
        queue = self.drive.profile.queue if config.is_c else None
        standing = (
            *self.drive.profile.units,
            *stopping(self._bus.config),
            (od.PROFILE_ACCEL, 0, round(config.accel)),
            (od.PROFILE_DECEL, 0, round(config.decel)),
            (od.QUICK_DECEL, 0, round(config.decel)),
        )
        if queue is not None:
            standing = (*standing, (od.IP_SUBMODE, 0, queue.submode))
        self.drive.connect(
            DriveWork(
                modes=MODE_BITS[PV] | (MODE_BITS[HM] | MODE_BITS[IP] if config.is_c else 0),
                standing=standing,
                own=config.node.sdo,
                needed=_KEPT_TURNING,
                records=queue.object if queue is not None else 0,
                axis=False,
            )
        )
        self.drive.mode, self.drive.target = PV, 0

    def tick(self) -> None:
        """Supervise; power goes when it stands and is to stand, and never comes back by itself."""
        drive = self.drive
        drive.look(3.0 * self._bus.config.heartbeat)
        lost = self._came_on and not drive.enabled
        self._came_on = drive.enabled and drive.goal is DriveState.ENABLED
        if drive.trouble:
            drive.goal, drive.target = DriveState.QUICK_STOP, 0
        elif self.lent:
            self._came_on = False
        elif drive.goal is DriveState.ENABLED:
            self._watch(lost)

    def _watch(self, lost: bool) -> None:
        """Power that E-stop took, or that does not come, is not waited for: its return would start it."""
        drive, now = self.drive, self._bus.clock.now()
        if lost:
            drive.goal, drive.target = DriveState.OFF, 0
        elif not drive.enabled and now - self._ordered > _POWER:
            drive.trouble = Fault(
                "spindle: the drive does not switch on; check that the E-stop is released and the "
                "drive has power",
                "spindle",
            )
        elif drive.target == 0 and abs(drive.speed) < _STANDS:
            drive.goal = DriveState.OFF

    def run(self, rpm: float) -> None:
        """Turn at ``rpm``, signed. Raises DriverError with a fault, unless asked to stop."""
        if rpm and (self._bus.trouble or self.drive.trouble):
            raise DriverError(
                Message("the spindle stays off: {problem}", problem=self._bus.trouble or self.drive.trouble),
                "spindle-off",
            )
        if rpm and self.kept:
            raise DriverError(
                "the spindle stays off because its drive is engaged as the C axis; release the "
                "drive with M05 first",
                "spindle-off",
                reason="held-as-c",
            )
        limit = self._config.rpm_max
        self.drive.target = round(min(max(rpm, -limit), limit))
        if rpm and self.lent:
            return  # it turns as soon as it is no longer C
        if rpm and self.drive.goal is not DriveState.ENABLED:
            self.drive.goal, self._ordered = DriveState.ENABLED, self._bus.clock.now()

    def coast(self) -> None:
        """No torque: it runs down by itself."""
        self.drive.target = 0
        if not self.lent:
            self.drive.goal = DriveState.OFF

    @property
    def counts_per_rev(self) -> int:
        """Of its encoder; 0: not known."""
        return self._config.node.counts_per_rev

    @property
    def commanded(self) -> bool:
        """Whether it is told to turn."""
        return self.drive.target != 0

    def resume(self) -> None:
        """It is no longer C: what it was told meanwhile is done."""
        if self.drive.target:
            self.drive.goal, self._ordered = DriveState.ENABLED, self._bus.clock.now()

    def clear_fault(self) -> None:
        """Forget and reset a fault, without power. Raises DriverError where it has to be configured anew."""
        if self.drive.rebooted or self.drive.missing:
            self.connect()
            self.drive.operational()
        self.drive.forget()
        self.drive.clear()

    def speed(self) -> float:
        """Measured rpm, signed; as C it does not turn as the spindle."""
        return 0.0 if self.lent else float(self.drive.speed)

    def angle(self) -> tuple[float, float] | None:
        """(time, turns) by the drive's encoder, of the last answer; None without counts a turn."""
        if not self.counts_per_rev:
            return None
        now = self.drive.position
        if self.blind:
            return self.drive.answered, self._counts / self.counts_per_rev
        self._counts += (now - self._last + 2**31) % 2**32 - 2**31  # its counter goes round every few hours
        self._last = now
        return self.drive.answered, self._counts / self.counts_per_rev

    def leapt(self) -> None:
        """Its counter stands elsewhere now: it goes on from there."""
        if self.blind:
            self._last, self.blind = self.drive.position, False

    def fault(self) -> str:
        """What is wrong with it; empty when well."""
        return self._bus.trouble or (self.drive.trouble and Fault(self.drive.trouble, "spindle"))
