"""From a configuration to an inverter that is attended."""

from __future__ import annotations

from collections.abc import Callable

from core.ports import Clock
from drivers.inverter.attendant import Attendant
from drivers.inverter.config import InverterConfig
from drivers.inverter.delta import DeltaVfdB
from drivers.inverter.family import Family
from drivers.inverter.hitachi import HitachiWj200
from drivers.inverter.huanyang import HuanyangHy
from drivers.inverter.modbus import Modbus
from drivers.wire import Wire


def attendant(config: InverterConfig, open_wire: Callable[[], Wire], clock: Clock) -> Attendant:
    """Whoever attends this inverter; nothing is opened yet. ``open_wire`` raises WireError."""

    def opened() -> Family:
        return family(config, open_wire(), clock)

    return Attendant(opened, clock, config.comm_loss, config.rpm_max * config.hz_per_rpm)


def family(config: InverterConfig, wire: Wire, clock: Clock) -> Family:
    """The family that the machine file names, on an open line."""
    if config.family == "huanyang":
        return HuanyangHy(wire, clock, config.unit, config.character)
    line = Modbus(wire, clock, config.unit, config.character)
    return HitachiWj200(line, clock) if config.family == "hitachi-wj200" else DeltaVfdB(line)
