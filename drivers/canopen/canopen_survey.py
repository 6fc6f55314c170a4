"""Survey of the bus that identifies each node of the machine file without changing its settings."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

from core.message import Message
from core.ports import Clock, DriverError
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import CanBus
from drivers.canopen.canopen_config import AxisConfig, CanopenConfig
from drivers.canopen.canopen_nodes import CanNode
from drivers.canopen.canopen_objects import MODE_BITS
from drivers.canopen.canopen_setup import NodeSetup
from drivers.canopen.drive_profiles import DriveProfile
from drivers.canopen.drive_set import MOTION_MODES, build_drive_setup

_RESPONSE_TIMEOUT_S = 0.4  # Seconds for a response; nodes on a working bus need milliseconds.
_IDENTITY = (("vendor", 1), ("product", 2), ("revision", 3), ("serial", 4))
_SHORT_MODE_NAMES = {1: "PP", 3: "PV", 6: "homing", 7: "IP", 8: "CSP"}


class SurveyResult(NamedTuple):
    """Survey result of one node.

    ``error_text`` is empty if the node matches the machine file.
    """

    name: str
    node_id: int
    error_text: str
    detail_text: str


class _SilentBus(CanBus):
    """CAN bus that sends no heartbeat.

    Otherwise nodes would start to monitor the heartbeat, and report a fault when the survey ends.
    """

    def send_heartbeat(self, *, force: bool = False) -> None:
        """Do nothing, because the survey must not send heartbeats."""


def identify_nodes(
    config: CanopenConfig, clock: Clock, advance_time: Callable[[], None] | None = None
) -> list[SurveyResult]:
    """Identify every node of the machine file, in the order of the file.

    In tests, the bus calls ``advance_time`` to advance the time. Raises DriverError if the bus cannot be
    opened.
    """
    bus = _SilentBus(config.bus_settings, clock, advance_time)
    axes = {axis.name: axis for axis in config.axes}
    try:
        return [
            _asked(bus, wanted, axes.get(wanted.name), config.bus_settings.mode) for wanted in _wanted(config)
        ]
    finally:
        bus.close()


def _wanted(config: CanopenConfig) -> Iterator[CanNode]:
    yield from (axis.node for axis in config.axes if axis.node is not None)
    if config.spindle is not None:
        yield config.spindle.node
    if config.encoder is not None and config.encoder.node is not None:
        yield config.encoder.node
    yield from config.io_modules


def _asked(bus: CanBus, config: CanNode, axis: AxisConfig | None, mode: str) -> SurveyResult:
    name, number, profile = config.name, config.id, config.profile
    family: DriveProfile | None = None
    try:
        if profile == 402:
            objects, family = od.load_drive_dictionary(config)
        else:
            objects = od.build_encoder_dictionary() if profile == 406 else od.build_module_dictionary()
        setup = NodeSetup(bus, name, number, objects)
        setup.node.sdo.RESPONSE_TIMEOUT = _RESPONSE_TIMEOUT_S
        setup.require_profile(profile)
        said = [_shown(word, setup, sub) for word, sub in _IDENTITY]
        more = (
            []
            if family is None
            else [*_modes(setup, family), *_list_mismatches(setup, family, axis, mode, bus)]
        )
    except DriverError as error:
        return SurveyResult(name, number, str(error), "")
    title = family.display_name if family is not None else f"CiA {profile}"
    return SurveyResult(name, number, "", ", ".join([title, *filter(None, said), *more]))


def _list_mismatches(
    setup: NodeSetup, family: DriveProfile, axis: AxisConfig | None, mode: str, bus: CanBus
) -> Iterator[str]:
    """Yield texts about an axis drive: its motion mode, and any objects that are missing.

    The first text contains the motion mode. The second text exists only if objects are missing. Raises
    DriverError if the drive does not support the mode, or lacks the object that receives the setpoints in
    this mode.
    """
    if axis is None:
        return
    work = build_drive_setup(replace(axis, profile=family), bus.config, MOTION_MODES[mode])
    setup.require_modes(work.mode_bits, family.supported_mode_bits)
    setup.require_objects(MOTION_MODES[mode].target_entry)
    yield f"runs {mode}"
    watched = ((od.SYNC_PERIOD, 0), (od.COMMANDED, 5)) if work.setpoint_period_s else ()
    lacking = {index for index, sub, _ in work.default_objects if not setup.has_object(index, sub)}
    if watched and not any(setup.has_object(*each) for each in watched):
        lacking.add(od.COMMANDED)
    if lacking:
        yield Message(
            "missing objects: {index}", index=" ".join(f"{index:04X}h" for index in sorted(lacking))
        )


def _shown(word: str, setup: NodeSetup, sub: int) -> str:
    value = _read_object(setup, od.IDENTITY, sub)
    return f"{word} {value:08X}h" if value else ""


def _modes(setup: NodeSetup, family: DriveProfile) -> Iterator[str]:
    offered = _read_object(setup, od.SUPPORTED, 0) | family.supported_mode_bits
    if offered:
        yield "modes " + " ".join(_SHORT_MODE_NAMES[mode] for mode, bit in MODE_BITS.items() if offered & bit)


def _read_object(setup: NodeSetup, index: int, sub: int) -> int:
    """Return the value of an object, or 0 if the node does not have the object."""
    try:
        return setup.read(index, sub)
    except DriverError:
        return 0
