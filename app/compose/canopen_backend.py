"""The CAN bus as the machine file describes it. Loads python-can and canopen, which not everybody has."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.backend_entry import Backend, has_station
from core.machine.machine_model import Axis, Machine
from core.ports import Clock, DriverError
from drivers.canopen.canopen_config import (
    AxisConfig,
    CanopenConfig,
    EncoderConfig,
    ModuleConfig,
    Objects,
    OutputConfig,
    PotConfig,
    SpindleConfig,
    Terminal,
)
from drivers.canopen.canopen_table import PLAIN_MODULE, CanNode, CanopenTable, EncoderTable, can_terminal
from drivers.feeder.feeder_server import Driven
from drivers.operator_station import PanelStation

if TYPE_CHECKING:
    from drivers.canopen.canopen_machine import CanopenMachine
    from drivers.canopen.canopen_survey import Answer
    from drivers.lookalikes.canopen_devices import CanopenDevices

_LIBRARIES = frozenset(("can", "canopen", "msgpack"))


def canopen_machine(machine: Machine, clock: Clock, idle: Callable[[], None] | None = None) -> CanopenMachine:
    """Connect to the bus of a machine file. Raises DriverError; one that names a library that is missing."""
    try:
        from drivers.canopen.canopen_machine import CanopenMachine
    except ImportError as error:
        raise DriverError(lacking(error)) from error
    return CanopenMachine(canopen_config(machine), clock, idle)


def canopen_peers(machine: Machine, clock: Clock) -> CanopenDevices:
    """Simulated drives and terminals for the other end of that bus. Raises DriverError."""
    from app.compose.simulated_backend import sim_config

    try:
        from drivers.lookalikes.canopen_devices import CanopenDevices
    except ImportError as error:
        raise DriverError(lacking(error)) from error
    return CanopenDevices(canopen_config(machine), sim_config(machine), clock)


def canopen_survey(machine: Machine, clock: Clock) -> list[Answer]:
    """Each node of that bus asked what it is. Raises DriverError."""
    try:
        from drivers.canopen.canopen_survey import survey
    except ImportError as error:
        raise DriverError(lacking(error)) from error
    return survey(canopen_config(machine), clock)


def lacking(error: ImportError) -> str:
    """One sentence for a library that is not there."""
    name = (error.name or "").partition(".")[0]
    library = {"can": "python-can"}.get(name, name) if name in _LIBRARIES else str(error)
    return f"backend canopen needs {library}: pip install 'turndesk[canopen]'"


def canopen_config(machine: Machine) -> CanopenConfig:
    """The bus's figures from the machine file's. Raises DriverError for a machine without a bus."""
    can = machine.hardware.table(CanopenTable)
    if can is None:
        raise DriverError(f"{machine.source}: there is no [canopen] table")
    nodes = {node.name: node for node in can.nodes}
    modules = [node for node in can.nodes if node.profile == 401]
    first = modules[0].name if modules else ""
    return CanopenConfig(
        bus=can.bus,
        axes=tuple(_axis(axis, machine, nodes) for axis in machine.axes),
        spindle=_spindle(machine, nodes),
        encoder=_encoder(machine, nodes),
        modules=tuple(
            ModuleConfig(node.name, node.id, _eds(node, machine), _objects(node)) for node in modules
        ),
        outputs={
            name: OutputConfig(_terminal(output.terminal, first), output.safe)
            for name, output in machine.outputs.items()
        },
        inputs={
            name: _terminal(wired.terminal, first, active_low=wired.active_low)
            for name, wired in machine.inputs.items()
        },
        pots={
            name: PotConfig(_terminal(pot.terminal, first), pot.low, pot.high, pot.switch)
            for name, pot in machine.hardware.analog.items()
        },
        mode=can.mode,
        commit=machine.timing.commit,
        record=can.record,
    )


def _axis(axis: Axis, machine: Machine, nodes: dict[str, CanNode]) -> AxisConfig:
    node = nodes.get(axis.name)
    home = machine.hardware.homes.get(axis.name)
    return AxisConfig(
        name=axis.name,
        node=node.id if node else 0,
        count=axis.count,
        vmax=axis.vmax,
        amax=axis.amax,
        following_window=axis.following_window,
        following_time=axis.following_time,
        corner=axis.amax * machine.timing.setpoint,
        travel=axis.travel,
        absolute=axis.absolute,
        home_method=home.method if home else 0,
        home_speed=axis.home_speed,
        home_latch=home.latch if home else 0.0,
        home_offset=home.offset if home else 0.0,
        counts_per_rev=node.counts_per_rev if node else 0,
        eds=_eds(node, machine) if node else "",
        objects=_objects(node) if node else (),
    )


def _spindle(machine: Machine, nodes: dict[str, CanNode]) -> SpindleConfig | None:
    node = nodes.get("spindle")
    if node is None or machine.hardware.spindle_driver != "cia402":
        return None
    model = machine.spindle
    return SpindleConfig(
        node=node.id,
        rpm_max=model.rpm_max,
        accel=model.accel,
        decel=model.decel,
        counts_per_rev=node.counts_per_rev,
        eds=_eds(node, machine),
        objects=_objects(node),
        is_c=machine.c_enabled and machine.spindle_is_c and "C" not in nodes,
    )


def _encoder(machine: Machine, nodes: dict[str, CanNode]) -> EncoderConfig | None:
    """A drive's node is its own: its second input is mapped there."""
    model = machine.hardware.table(EncoderTable)
    if model is None:
        return None
    node = nodes[model.node]
    own = node.profile != 402
    return EncoderConfig(
        name=node.name,
        node=node.id if own else 0,
        index=model.index,
        sub=model.sub,
        counts_per_rev=model.counts_per_rev,
        rpm_max=machine.spindle.rpm_max,
        eds=_eds(node, machine) if own else "",
        objects=_objects(node) if own else (),
    )


def _objects(node: CanNode) -> tuple[tuple[int, int, int], ...]:
    return tuple((entry.index, entry.sub, entry.value) for entry in node.sdo)


def _eds(node: CanNode, machine: Machine) -> str:
    """An EDS file lies beside the machine file unless its path says otherwise."""
    return str(Path(machine.source).parent / node.eds) if node.eds else ""


def _terminal(text: str, first: str, *, active_low: bool = False) -> Terminal:
    found = can_terminal(text)
    if found is None:
        raise DriverError(f"terminal {text!r} is no address on the bus")
    node = first if found.node == PLAIN_MODULE else found.node
    return Terminal(node, found.index, found.sub, found.bit, active_low)


def _played(machine: Machine) -> bool:
    """On a virtual bus the other end is here too: there is none elsewhere."""
    can = machine.hardware.table(CanopenTable)
    return can is not None and not can.bus.own_process


def can_driven(machine: Machine, clock: Clock) -> Driven:
    """The machine on its bus, for the feeder. Raises DriverError."""
    peers = canopen_peers(machine, clock) if _played(machine) else None
    try:
        # A clock that stands waits for nobody: the peers are looked after in between.
        owned = canopen_machine(machine, clock, peers.pump if peers is not None else None)
    except DriverError:
        if peers is not None:
            peers.close()
        raise
    ports = owned.ports
    hands: object | None = peers.machine if peers is not None else None
    if not has_station(machine):
        wired = ports.station if "handwheel" in machine.hardware.analog else None
        panel = PanelStation(clock, ports.io.inputs, wired)
        hands, ports = hands or panel, dataclasses.replace(ports, station=panel)
    if peers is None:
        return Driven(ports, owned.tick, owned.close, hands)

    def tick() -> None:
        peers.pump()
        owned.tick()
        peers.pump()

    def close() -> None:
        owned.close()
        peers.close()

    return Driven(ports, tick, close, hands)


def _play(
    machine: Machine,
    going: Callable[[], bool],
    say: Callable[[str], None],
    typed: Callable[[], Iterable[str]],
) -> None:
    from app.compose.played_machine import play_peers

    play_peers(machine, going, say, typed, canopen_peers)


BACKEND = Backend("bus", driven=can_driven, played=_played, play=_play, survey=canopen_survey)


# --- What a control writes to the nodes of a bus at each start, to be compared with what it wrote before.


def written_at_start(machine: Machine) -> dict[str, Objects]:
    """Every object that each node is told at a start, by the node's name. Raises DriverError."""
    try:
        from drivers.canopen.canopen_setup import standing, stopping, watching
    except ImportError as error:
        raise DriverError(lacking(error)) from error
    config = canopen_config(machine)
    told = {axis.name: (*standing(axis, config.bus), *axis.objects) for axis in config.axes if axis.node}
    if config.spindle is not None:
        told["spindle"] = (*stopping(config.bus), *config.spindle.objects)
    return told | {module.name: (*watching(config.bus), *module.objects) for module in config.modules}
