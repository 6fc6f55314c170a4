"""The grblHAL controller as the machine file describes it."""

from __future__ import annotations

from collections.abc import Callable

from core.machine.model import Axis, Machine
from core.ports import Clock, DriverError
from drivers.grblhal.config import GrblAxis, GrblConfig, GrblInput, GrblOutput
from drivers.grblhal.machine import GrblMachine
from drivers.grblhal.peer.firmware import Firmware
from drivers.grblhal.peer.serve import PtyEnd, TcpEnd, serve
from drivers.simulated import RealClock

_TCP = "tcp://"
_WIRED = frozenset(("X", "Z"))


def grblhal_machine(machine: Machine, clock: Clock) -> GrblMachine:
    """Connect to the controller of a machine file. Raises DriverError."""
    return GrblMachine(grblhal_config(machine), clock)


def grblhal_config(machine: Machine) -> GrblConfig:
    """The controller's figures from the machine file's. Raises DriverError for what it cannot be."""
    model = machine.hardware.grblhal
    if model is None:
        raise DriverError(f"{machine.source}: there is no [grblhal] table")
    if model.x_mode != "G8":
        raise DriverError(f"{machine.source}: grblhal.x_mode: expected G8; a reset would change what X means")
    if machine.hardware.spindle_driver != "grblhal":
        raise DriverError(
            f"{machine.source}: backend grblhal drives its own spindle: spindle.driver = grblhal"
        )
    return GrblConfig(
        port=model.port,
        baud=model.baud,
        settings=model.settings,
        axes=tuple(_axis(axis) for axis in machine.axes),
        rpm_max=machine.spindle.rpm_max,
        outputs={name: GrblOutput(out.terminal, out.safe) for name, out in machine.outputs.items()},
        inputs={name: GrblInput(wired.terminal, wired.active_low) for name, wired in machine.inputs.items()},
    )


def play_grblhal(machine: Machine, going: Callable[[], bool], say: Callable[[str], None]) -> None:
    """A look-alike of the controller, on the TCP port of the machine file or on a new pseudo terminal."""
    port = grblhal_config(machine).port
    if port.startswith(_TCP):
        host, _, number = port.removeprefix(_TCP).rpartition(":")
        end: TcpEnd | PtyEnd = TcpEnd(host, int(number))
    else:
        end = PtyEnd()
    say(end.name)
    serve(end, Firmware(RealClock()), going)


def _axis(axis: Axis) -> GrblAxis:
    return GrblAxis(axis.name, axis.vmax, axis.amax, axis.absolute, axis.name in _WIRED)
