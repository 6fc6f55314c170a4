"""Connects to a machine and asks everything in it how it is."""

from __future__ import annotations

from typing import NamedTuple

from app.compose.backends import connect, real_time
from core.machine.model import Machine
from core.ports import Clock, MachinePorts, Spindle
from drivers.inverter.spindle import InverterSpindle
from drivers.simulated import RealClock, StepClock

Row = tuple[str, str, str]  # name, state, detail


class Answers(NamedTuple):
    """What answered, and what the operator should know although nothing is broken."""

    rows: list[Row]
    warnings: list[str]


def check_ports(machine: Machine) -> Answers:
    """(name, state, detail) of each drive, the spindle, the station and each input. Raises DriverError.

    Nothing is switched on and nothing moves.
    """
    clock: Clock = RealClock() if real_time(machine) else StepClock()
    connected = connect(machine, clock)
    try:
        return Answers(_rows(connected.ports), list(connected.ports.warnings))
    finally:
        connected.close()


def _turning(spindle: Spindle) -> str:
    told = f"{spindle.speed():.0f} rpm"
    return f"{told}, {spindle.status()}" if isinstance(spindle, InverterSpindle) else told


def _rows(ports: MachinePorts) -> list[Row]:
    sample = ports.axes.sample()
    rows = [
        (name, "fault" if sample.fault else "ok", f"homed {homed}, at {at:.4f}")
        for name, homed, at in zip(ports.axes.axes, sample.homed, sample.actual, strict=True)
    ]
    fault = ports.spindle.fault()
    rows.append(("spindle", "fault" if fault else "ok", fault or _turning(ports.spindle)))
    station = ports.station.snapshot()
    rows.append(("station", "E-stop" if station.estop else "ok", f"feed pot {station.feed_pot:.0%}"))
    rows += [(f"input {name}", "on" if on else "off", "") for name, on in ports.io.inputs().items()]
    return rows
