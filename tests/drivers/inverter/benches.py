"""An inverter of each family on the bench, attended round by round."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from drivers.inverter.inverter_control import InverterControl
from drivers.inverter.inverter_spindle import InverterSpindle, create_inverter_control
from drivers.inverter.inverter_table import InverterTable
from drivers.wakeups import ManualClock
from tests.drivers.inverter.inverter_simulators import (
    HZ_PER_RPM,
    DeltaMemory,
    HitachiMemory,
    HuanyangSlave,
    Inverter,
    Memory,
    MyDriveMemory,
    MyDriveSlave,
    RtuSlave,
)
from tests.drivers.inverter.wires import BenchWire, Slave

FOLDER = Path(__file__).parent  # has the file of an inverter that the product does not know
OWN = "my-drive.toml"
FAMILIES = ("delta-vfdb", "hitachi-wj200", "huanyang", OWN)


@dataclass
class Bench:
    """``memory`` of a Modbus inverter, or the Huanyang itself."""

    clock: ManualClock
    inverter: Inverter
    memory: Memory | HuanyangSlave
    wire: BenchWire
    attendant: InverterControl
    spindle: InverterSpindle

    def run(self, seconds: float) -> None:
        """Let the line be attended for so long."""
        end = self.clock.now() + seconds
        while self.clock.now() < end:
            before = self.clock.now()
            self.attendant.run_exchange()
            if self.clock.now() == before:
                self.clock.advance(0.01)

    def until_fault(self, limit: float) -> float:
        """Run until a fault is told; after how long."""
        began = self.clock.now()
        while not self.spindle.read_fault():
            assert self.clock.now() - began < limit, f"no fault within {limit} s"
            self.run(0.01)
        return self.clock.now() - began

    @property
    def rpm(self) -> float:
        """What the motor really does."""
        return self.inverter.rpm


def config(family: str) -> InverterTable:
    """As a machine file would give it."""
    return InverterTable(family=family, port="", hz_per_rpm=HZ_PER_RPM, rpm_max=3500.0)


def bench(family: str, *, connect: bool = True) -> Bench:
    """Connected, standing."""
    clock = ManualClock()
    inverter = Inverter(clock)
    memory, slave = far_end(family, inverter)
    wire = BenchWire(slave, clock)
    one = create_inverter_control(config(family), wire.opened, clock, FOLDER)
    made = Bench(clock, inverter, memory, wire, one, InverterSpindle(config(family), one, clock))
    if connect:
        one.open_and_check_line()
    return made


def far_end(family: str, inverter: Inverter) -> tuple[Memory | HuanyangSlave, Slave]:
    """What an inverter of this family knows, and what answers for it on the line."""
    if family == "huanyang":
        huanyang = HuanyangSlave(inverter)
        return huanyang, huanyang
    memory = memory_of(family, inverter)
    return memory, (MyDriveSlave if family == OWN else RtuSlave)(memory)


def memory_of(family: str, inverter: Inverter) -> Memory:
    """Registers of a family on Modbus."""
    if family == "hitachi-wj200":
        return HitachiMemory(inverter)
    return MyDriveMemory(inverter) if family == OWN else DeltaMemory(inverter)
