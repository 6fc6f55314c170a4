"""CANopen backend, which loads the optional libraries python-can and canopen."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from app.compose.backends.backend_entry import (
    Backend,
    get_axis_arguments,
    has_own_station,
    list_input_row_names,
)
from core.machine.hardware_model import HomingModel
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
from drivers.canopen.canopen_nodes import (
    FIRST_MODULE_ADDRESS,
    CanNode,
    CanTerminal,
    ObjectValues,
    parse_terminal,
)
from drivers.canopen.canopen_table import CanopenTable, EncoderTable
from drivers.canopen.drive_profiles import CIA402_PROFILE, PROFILES
from drivers.driver_host.host_server import DriverBundle
from drivers.operator_station import OnScreenStation

if TYPE_CHECKING:
    from drivers.canopen.canopen_machine import CanopenMachine
    from drivers.canopen.canopen_survey import SurveyResult
    from drivers.simulators.canopen_devices import CanopenDevices

_LIBRARY_NAMES = frozenset(("can", "canopen", "msgpack"))


def connect_canopen_machine(
    machine: Machine, clock: Clock, process_peers: Callable[[], None] | None = None
) -> CanopenMachine:
    """Connect to the bus that the machine file specifies.

    Raises DriverError if the connection fails. If a library is missing, the error names it.
    """
    try:
        from drivers.canopen.canopen_machine import CanopenMachine
    except ImportError as error:
        raise DriverError(describe_missing_library(error)) from error
    return CanopenMachine(create_canopen_config(machine), clock, process_peers)


def create_simulated_devices(machine: Machine, clock: Clock) -> CanopenDevices:
    """Return simulated drives and terminals for the bus of a machine file.

    Raises DriverError if a library or the bus configuration is missing, or if the bus cannot be opened.
    """
    from app.compose.backends.simulated_backend import create_sim_config

    try:
        from drivers.simulators.canopen_devices import CanopenDevices
    except ImportError as error:
        raise DriverError(describe_missing_library(error)) from error
    return CanopenDevices(create_canopen_config(machine), create_sim_config(machine), clock)


def survey_canopen_bus(machine: Machine, clock: Clock) -> list[SurveyResult]:
    """Ask each node of the bus for its identity. Raises DriverError if the bus cannot be used."""
    try:
        from drivers.canopen.canopen_survey import identify_nodes
    except ImportError as error:
        raise DriverError(describe_missing_library(error)) from error
    return identify_nodes(create_canopen_config(machine), clock)


def describe_missing_library(error: ImportError) -> str:
    """Return the error message for a missing library, with the command that installs it."""
    name = (error.name or "").partition(".")[0]
    library = {"can": "python-can"}.get(name, name) if name in _LIBRARY_NAMES else str(error)
    return Message(
        "backend canopen needs {library}; install it with: pip install 'turndesk[canopen]'", library=library
    )


def create_canopen_config(machine: Machine) -> CanopenConfig:
    """Return the configuration of the bus.

    Raises DriverError if the machine file does not specify a bus, or if a terminal is not a valid bus
    address.
    """
    can = machine.hardware.find_driver_table(CanopenTable)
    if can is None:
        raise DriverError("{source}: the [canopen] table is missing", source=machine.source)
    folder = Path(machine.source).parent  # folder of EDS files with relative paths
    found = [replace(node, eds=str(folder / node.eds) if node.eds else "") for node in can.nodes]
    nodes = {node.name: node for node in found}
    modules = tuple(node for node in found if node.profile == 401)
    first = modules[0].name if modules else ""
    return CanopenConfig(
        bus_settings=can,
        axes=tuple(_axis(axis, machine, nodes.get(axis.name)) for axis in machine.axes),
        spindle=_spindle(machine, nodes),
        encoder=_encoder_config(machine, nodes),
        io_modules=modules,
        outputs={
            name: OutputConfig(_terminal(output.terminal, first), output.safe_state)
            for name, output in machine.outputs.items()
        },
        inputs={
            name: replace(_terminal(wired.terminal, first), is_active_low=wired.is_active_low)
            for name, wired in machine.inputs.items()
        },
        pots={
            name: PotConfig(_terminal(pot.terminal, first), pot.low_value, pot.high_value, pot.switch)
            for name, pot in machine.hardware.analog_inputs.items()
        },
        commit_time_s=machine.timing.commit_time_s,
    )


def _axis(axis: Axis, machine: Machine, node: CanNode | None) -> AxisConfig:
    home = machine.hardware.homing_models.get(axis.name) or HomingModel()
    return AxisConfig(
        **get_axis_arguments(axis, machine),
        node=node,
        profile=PROFILES.get(node.drive, CIA402_PROFILE) if node is not None else CIA402_PROFILE,
        counts_per_rev=node.counts_per_rev if node is not None else 0,
        home_method=home.method,
        home_latch_speed=home.latch,
        home_offset=home.offset,
    )


def _spindle(machine: Machine, nodes: dict[str, CanNode]) -> SpindleConfig | None:
    node = nodes.get("spindle")
    if node is None or machine.hardware.spindle_driver != "cia402":
        return None
    model, is_c = machine.spindle, machine.is_c_enabled and machine.is_spindle_c_axis and "C" not in nodes
    return SpindleConfig(node, model.max_rpm, model.acceleration_rpm_s, model.deceleration_rpm_s, is_c)


def _encoder_config(machine: Machine, nodes: dict[str, CanNode]) -> EncoderConfig | None:
    """Return the configuration of the spindle encoder, or None if the machine does not have one.

    An encoder at a drive's second encoder input needs no node entry, because the drive maps its value.
    """
    model = machine.hardware.find_driver_table(EncoderTable)
    if model is None:
        return None
    own = nodes[model.node] if nodes[model.node].profile != 402 else None
    counts, rpm_max = model.counts_per_rev, machine.spindle.max_rpm
    return EncoderConfig(model.node, own, *model.object_address, counts, rpm_max)


def _terminal(text: str, first: str) -> CanTerminal:
    found = parse_terminal(text)
    if found is None:
        raise DriverError(Message("terminal {text} is not a valid bus address", text=f"{text!r}"))
    return replace(found, node_name=first) if found.node_name == FIRST_MODULE_ADDRESS else found


def _is_simulated(machine: Machine) -> bool:
    """Return whether the bus is virtual. The devices of a virtual bus are simulated in this process."""
    can = machine.hardware.find_driver_table(CanopenTable)
    return can is not None and not can.supports_separate_process


def create_canopen_drivers(machine: Machine, clock: Clock) -> DriverBundle:
    """Return the drivers of the machine on its bus for the driver host.

    Raises DriverError if connecting fails.
    """
    peers = create_simulated_devices(machine, clock) if _is_simulated(machine) else None
    try:
        # A stopped clock does not let the peers run, so they are served between the steps.
        owned = connect_canopen_machine(machine, clock, peers.process_frames if peers is not None else None)
    except DriverError:
        if peers is not None:
            peers.close()
        raise
    ports = owned.ports
    hands: object | None = peers.machine if peers is not None else None
    if not has_own_station(machine):
        wired = (
            ports.station if {"handwheel", "spindle_load"} & machine.hardware.analog_inputs.keys() else None
        )
        panel = OnScreenStation(clock, ports.io.inputs, wired)
        hands, ports = hands or panel, replace(ports, station=panel)
    if peers is None:
        return DriverBundle(
            ports,
            owned.run_cycle,
            owned.close,
            hands,
            get_next_tick_time=owned.get_next_cycle_time,
            collect_driver_messages=owned.collect_warnings,
            get_idle_time=owned.get_idle_time,
            has_sent_requests=lambda: owned.has_sent_sync,
        )

    def tick() -> None:
        peers.process_frames()
        owned.run_cycle()
        peers.process_frames()

    def close() -> None:
        owned.close()
        peers.close()

    return DriverBundle(ports, tick, close, hands, owned.get_next_cycle_time, owned.collect_warnings)


def _play(
    machine: Machine,
    going: Callable[[], bool],
    say: Callable[[str], None],
    typed: Callable[[], Iterable[str]],
) -> None:
    from app.compose.backends.simulated_devices import simulate_devices

    simulate_devices(machine, going, say, typed, create_simulated_devices)


def _survey(machine: Machine, clock: Clock) -> Iterator[tuple[str, str, str, str]]:
    for answer in survey_canopen_bus(machine, clock):
        yield (
            Message("node {answer}", answer=answer.name),
            str(answer.node_id),
            answer.error_text,
            answer.detail_text,
        )


def _measured_rows(machine: Machine) -> Iterator[str]:
    """Yield the names of the axes and spindle that have a node, and of all inputs of the I/O modules."""
    config = create_canopen_config(machine)
    yield from (axis.name for axis in config.axes if axis.node is not None)
    if config.spindle is not None or config.encoder is not None:
        yield "spindle"
    if config.spindle is not None and config.spindle.is_c_axis:
        yield "C"
    yield from list_input_row_names(machine)


BACKEND = Backend(
    "bus",
    create_drivers=create_canopen_drivers,
    is_simulated=_is_simulated,
    simulate_devices=_play,
    survey_nodes=_survey,
    list_measured_row_names=_measured_rows,
)


# --- Values that a control writes to the nodes at each start, to be compared with those of the last start.


def list_startup_objects(machine: Machine) -> dict[str, ObjectValues]:
    """Return the CANopen objects that are written to each node at startup, by node name.

    The accelerations of the spindle drive are omitted, because the text of the machine file contains them.
    Raises DriverError if a library is missing, if the configuration is invalid, or if the EDS file of a
    drive cannot be used.
    """
    try:
        from drivers.canopen.canopen_objects import load_drive_dictionary
        from drivers.canopen.canopen_setup import (
            build_axis_objects,
            build_monitoring_objects,
            build_stop_objects,
        )
    except ImportError as error:
        raise DriverError(describe_missing_library(error)) from error
    config = create_canopen_config(machine)
    objects_by_node: dict[str, ObjectValues] = {}
    for axis in config.axes:
        if axis.node is not None:
            family = replace(axis, profile=load_drive_dictionary(axis.node)[1])
            objects_by_node[axis.name] = (*build_axis_objects(family, config.bus_settings), *axis.node.sdo)
    if config.spindle is not None:
        objects_by_node["spindle"] = (*build_stop_objects(config.bus_settings), *config.spindle.node.sdo)
    monitoring = build_monitoring_objects(config.bus_settings)
    if config.encoder is not None and config.encoder.node is not None:
        objects_by_node[config.encoder.name] = (*monitoring, *config.encoder.node.sdo)
    return objects_by_node | {module.name: (*monitoring, *module.sdo) for module in config.io_modules}
