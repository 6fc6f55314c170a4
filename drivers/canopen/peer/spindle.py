"""The brain of a CiA 402 drive on the simulated spindle: profile velocity."""

from __future__ import annotations

from collections.abc import Callable

from drivers.canopen import objects as od
from drivers.canopen.peer.power import PowerStates
from drivers.canopen.states import PV, REACHED, DriveState
from drivers.simulated.drive_spindle import SpindleMotor

EMCY_FAULT = 0x7120  # motor blocked


class SpindleDrive:
    """``step`` with the plant's time."""

    def __init__(self, motor: SpindleMotor, counts: int, emergency: Callable[[int], None]) -> None:
        self.motor = motor
        self.emergency = emergency
        self.power = PowerStates(lambda: None)
        self.mode = 0
        self.target = 0
        self._counts = counts
        self._ordered: int | None = None
        self.values: dict[tuple[int, int], int] = {}

    def read(self, index: int, _sub: int) -> int | None:
        """What lives in the drive."""
        live: dict[int, Callable[[], int]] = {
            od.DEVICE_TYPE: lambda: 0x00020192,
            od.SUPPORTED: lambda: 0x04,
            od.STATUS: lambda: self.power.word | self._reached(),
            od.MODE_SHOWN: lambda: self.mode,
            od.VELOCITY: lambda: round(self.motor.speed),
            od.POSITION: lambda: (round(self.motor.turns * self._counts) + 2**31) % 2**32 - 2**31,
        }
        return live[index]() if index in live else None

    def _reached(self) -> int:
        return REACHED if abs(self.motor.speed - self.target) < 10 else 0

    def write(self, index: int, sub: int, value: int) -> None:
        """What the host says."""
        self.values[index, sub] = value
        if index == od.CONTROL:
            self.power.control(value)
        elif index == od.MODE:
            self.mode = value
        elif index == od.TARGET_SPEED:
            self.target = value

    def host_lost(self) -> None:
        """Abort connection option."""
        if self.values.get((od.ABORT_OPTION, 0), 0) == 3:
            self.power.quick_stop()

    def reset(self) -> None:
        """No power, no target."""
        self.power.off()
        self.mode = self.target = 0
        self.values.clear()

    def step(self, now: float) -> None:
        """Obey; lose power when braked."""
        wanted = self.target if self.power.state is DriveState.ENABLED and self.mode == PV else 0
        if self.motor.faults.fault and self.power.state is not DriveState.FAULT:
            self.power.trip()
            self.emergency(EMCY_FAULT)
        if not self.power.powered:
            if self._ordered is not None:
                self.motor.cut(now)
                self._ordered = None
        elif wanted != self._ordered:
            self.motor.order(now, float(wanted))
            self._ordered = wanted
        if self.power.braking and abs(self.motor.speed) < 1.0:
            self.power.stopped()
