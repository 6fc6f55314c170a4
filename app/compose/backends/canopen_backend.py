"""CANopen backend. Loads python-can and canopen, which are optional."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.backends.backend_entry import Backend, axis_figures, has_station, wired_inputs
from core.machine.hardware_model import HomeModel
from core.machine.machine_model import Axis, Machine
from core.message import Message
from core.ports import Clock, DriverError
from drivers.canopen.canopen_config import (
    AxisConfig,
    CanopenConfig,
    EncoderConfig,
    OutputConfig,
    PotConfig,
    SpindleConfig,
)
from drivers.canopen.canopen_nodes import PLAIN_MODULE, CanNode, CanTerminal, Objects, can_terminal
from drivers.canopen.canopen_table import CanopenTable, EncoderTable
from drivers.canopen.drive_profiles import CIA402, PROFILES
from drivers.driver_host.host_server import Driven
from drivers.operator_station import PanelStation

if TYPE_CHECKING:
    from drivers.canopen.canopen_machine import CanopenMachine
    from drivers.canopen.canopen_survey import Answer
    from drivers.simulators.canopen_devices import CanopenDevices

_LIBRARIES = frozenset(("can", "canopen", "msgpack"))


def canopen_machine(machine: Machine, clock: Clock, idle: Callable[[], None] | None = None) -> CanopenMachine:
    """Connect to the bus of a machine file.

    Raises DriverError, which names a missing library.
    """
    try:
        from drivers.canopen.canopen_machine import CanopenMachine
    except ImportError as error:
        raise DriverError(lacking(error)) from error
    return CanopenMachine(canopen_config(machine), clock, idle)


def canopen_peers(machine: Machine, clock: Clock) -> CanopenDevices:
    """Return simulated drives and terminals for the bus of a machine file. Raises DriverError."""
    from app.compose.backends.simulated_backend import sim_config

    try:
        from drivers.simulators.canopen_devices import CanopenDevices
    except ImportError as error:
        raise DriverError(lacking(error)) from error
    return CanopenDevices(canopen_config(machine), sim_config(machine), clock)


def canopen_survey(machine: Machine, clock: Clock) -> list[Answer]:
    """Ask each node of the bus for its identity. Raises DriverError."""
    try:
        from drivers.canopen.canopen_survey import survey
    except ImportError as error:
        raise DriverError(lacking(error)) from error
    return survey(canopen_config(machine), clock)


def lacking(error: ImportError) -> str:
    """Return the message for a missing library."""
    name = (error.name or "").partition(".")[0]
    library = {"can": "python-can"}.get(name, name) if name in _LIBRARIES else str(error)
    return Message(
        "backend canopen needs {library}; install it with: pip install 'turndesk[canopen]'", library=library
    )


def canopen_config(machine: Machine) -> CanopenConfig:
    """Return the configuration of the bus. Raises DriverError if the machine file has no bus."""
    can = machine.hardware.table(CanopenTable)
    if can is None:
        raise DriverError("{source}: the [canopen] table is missing", source=machine.source)
    folder = Path(machine.source).parent  # folder of EDS files with relative paths
    found = [replace(node, eds=str(folder / node.eds) if node.eds else "") for node in can.nodes]
    nodes = {node.name: node for node in found}
    modules = tuple(node for node in found if node.profile == 401)
    first = modules[0].name if modules else ""
    return CanopenConfig(
        bus=can,
        axes=tuple(_axis(axis, machine, nodes.get(axis.name)) for axis in machine.axes),
        spindle=_spindle(machine, nodes),
        encoder=_encoder(machine, nodes),
        modules=modules,
        outputs={
            name: OutputConfig(_terminal(output.terminal, first), output.safe)
            for name, output in machine.outputs.items()
        },
        inputs={
            name: replace(_terminal(wired.terminal, first), active_low=wired.active_low)
            for name, wired in machine.inputs.items()
        },
        pots={
            name: PotConfig(_terminal(pot.terminal, first), pot.low, pot.high, pot.switch)
            for name, pot in machine.hardware.analog.items()
        },
        commit=machine.timing.commit,
    )


def _axis(axis: Axis, machine: Machine, node: CanNode | None) -> AxisConfig:
    home = machine.hardware.homes.get(axis.name) or HomeModel()
    return AxisConfig(
        **axis_figures(axis, machine),
        node=node,
        profile=PROFILES.get(node.drive, CIA402) if node is not None else CIA402,
        counts_per_rev=node.counts_per_rev if node is not None else 0,
        home_method=home.method,
        home_latch=home.latch,
        home_offset=home.offset,
    )


def _spindle(machine: Machine, nodes: dict[str, CanNode]) -> SpindleConfig | None:
    node = nodes.get("spindle")
    if node is None or machine.hardware.spindle_driver != "cia402":
        return None
    model, is_c = machine.spindle, machine.c_enabled and machine.spindle_is_c and "C" not in nodes
    return SpindleConfig(node, model.rpm_max, model.accel, model.decel, is_c)


def _encoder(machine: Machine, nodes: dict[str, CanNode]) -> EncoderConfig | None:
    """Return the configuration of the encoder, or None.

    The encoder of a drive has no node entry, because the drive's node maps its second input.
    """
    model = machine.hardware.table(EncoderTable)
    if model is None:
        return None
    own = nodes[model.node] if nodes[model.node].profile != 402 else None
    counts, rpm_max = model.counts_per_rev, machine.spindle.rpm_max
    return EncoderConfig(model.node, own, *model.address, counts, rpm_max)


def _terminal(text: str, first: str) -> CanTerminal:
    found = can_terminal(text)
    if found is None:
        raise DriverError(Message("terminal {text} is not a valid bus address", text=f"{text!r}"))
    return replace(found, node=first) if found.node == PLAIN_MODULE else found


def _played(machine: Machine) -> bool:
    """Return whether the bus is virtual, so that its devices are simulated in this process."""
    can = machine.hardware.table(CanopenTable)
    return can is not None and not can.own_process


def can_driven(machine: Machine, clock: Clock) -> Driven:
    """Return the machine on its bus for the driver host. Raises DriverError."""
    peers = canopen_peers(machine, clock) if _played(machine) else None
    try:
        # A stopped clock does not let the peers run, so they are served between the steps.
        owned = canopen_machine(machine, clock, peers.pump if peers is not None else None)
    except DriverError:
        if peers is not None:
            peers.close()
        raise
    ports = owned.ports
    hands: object | None = peers.machine if peers is not None else None
    if not has_station(machine):
        wired = ports.station if {"handwheel", "spindle_load"} & machine.hardware.analog.keys() else None
        panel = PanelStation(clock, ports.io.inputs, wired)
        hands, ports = hands or panel, replace(ports, station=panel)
    if peers is None:
        return Driven(
            ports,
            owned.tick,
            owned.close,
            hands,
            wake=owned.wake,
            notes=owned.notes,
            idle=owned.idle,
            asked=lambda: owned.asked,
        )

    def tick() -> None:
        peers.pump()
        owned.tick()
        peers.pump()

    def close() -> None:
        owned.close()
        peers.close()

    return Driven(ports, tick, close, hands, owned.wake, owned.notes)


def _play(
    machine: Machine,
    going: Callable[[], bool],
    say: Callable[[str], None],
    typed: Callable[[], Iterable[str]],
) -> None:
    from app.compose.backends.played_machine import play_peers

    play_peers(machine, going, say, typed, canopen_peers)


def _survey(machine: Machine, clock: Clock) -> Iterator[tuple[str, str, str, str]]:
    for answer in canopen_survey(machine, clock):
        yield Message("node {answer}", answer=answer.name), str(answer.node), answer.trouble, answer.detail


def _measured(machine: Machine) -> Iterator[str]:
    """Yield the axes and the spindle with a node, and all inputs of the modules."""
    config = canopen_config(machine)
    yield from (axis.name for axis in config.axes if axis.node is not None)
    if config.spindle is not None or config.encoder is not None:
        yield "spindle"
    if config.spindle is not None and config.spindle.is_c:
        yield "C"
    yield from wired_inputs(machine)


BACKEND = Backend("bus", driven=can_driven, played=_played, play=_play, survey=_survey, measured=_measured)


# --- Values that a control writes to the nodes at each start, to be compared with those of the last start.


def written_at_start(machine: Machine) -> dict[str, Objects]:
    """Return every object written to each node at a start, by node name. Raises DriverError."""
    try:
        from drivers.canopen.canopen_objects import drive_dictionary
        from drivers.canopen.canopen_setup import axis_objects, stopping, watching
    except ImportError as error:
        raise DriverError(lacking(error)) from error
    config = canopen_config(machine)
    told: dict[str, Objects] = {}
    for axis in config.axes:
        if axis.node is not None:
            family = replace(axis, profile=drive_dictionary(axis.node)[1])
            told[axis.name] = (*axis_objects(family, config.bus), *axis.node.sdo)
    if config.spindle is not None:
        told["spindle"] = (*stopping(config.bus), *config.spindle.node.sdo)
    return told | {module.name: (*watching(config.bus), *module.sdo) for module in config.modules}
