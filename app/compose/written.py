"""What a control writes to the nodes of a bus at each start, to be compared with what it wrote before."""

from __future__ import annotations

from app.compose.canopen import canopen_config, lacking
from core.machine.model import Machine
from core.ports import DriverError
from drivers.canopen.config import Objects


def written_at_start(machine: Machine) -> dict[str, Objects]:
    """Every object that each node is told at a start, by the node's name. Raises DriverError."""
    try:
        from drivers.canopen.standing import standing, stopping, watching
    except ImportError as error:
        raise DriverError(lacking(error)) from error
    config = canopen_config(machine)
    told = {axis.name: (*standing(axis, config.bus), *axis.objects) for axis in config.axes if axis.node}
    if config.spindle is not None:
        told["spindle"] = (*stopping(config.bus), *config.spindle.objects)
    return told | {module.name: (*watching(config.bus), *module.objects) for module in config.modules}
