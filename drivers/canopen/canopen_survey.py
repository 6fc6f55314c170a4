"""Survey of the bus that identifies each node of the machine file without changing anything."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

from core.message import Message
from core.ports import Clock, DriverError
from drivers.canopen import canopen_objects as od
from drivers.canopen.canopen_bus import Bus
from drivers.canopen.canopen_config import AxisConfig, CanopenConfig
from drivers.canopen.canopen_nodes import CanNode
from drivers.canopen.canopen_objects import MODE_BITS
from drivers.canopen.canopen_setup import Setup
from drivers.canopen.drive_profiles import DriveProfile
from drivers.canopen.driven_axes import MOTIONS, axis_work

_PATIENCE = 0.4  # Seconds for a response; nodes on a working bus need milliseconds.
_IDENTITY = (("vendor", 1), ("product", 2), ("revision", 3), ("serial", 4))
_SHORT = {1: "PP", 3: "PV", 6: "homing", 7: "IP", 8: "CSP"}


class Answer(NamedTuple):
    """Survey result of one node; its error text is empty if the node matches the machine file."""

    name: str
    node: int
    trouble: str
    detail: str


class _Quiet(Bus):
    """Bus without a heartbeat, which nodes would start to monitor and later miss."""

    def beat(self, *, at_once: bool = False) -> None:
        """Send nothing."""


def survey(config: CanopenConfig, clock: Clock, idle: Callable[[], None] | None = None) -> list[Answer]:
    """Identify every node of the machine file in its order; ``idle`` is as for the bus.

    Raises DriverError if the bus cannot be opened.
    """
    bus = _Quiet(config.bus, clock, idle)
    axes = {axis.name: axis for axis in config.axes}
    try:
        return [_asked(bus, wanted, axes.get(wanted.name), config.bus.mode) for wanted in _wanted(config)]
    finally:
        bus.close()


def _wanted(config: CanopenConfig) -> Iterator[CanNode]:
    yield from (axis.node for axis in config.axes if axis.node is not None)
    if config.spindle is not None:
        yield config.spindle.node
    if config.encoder is not None and config.encoder.node is not None:
        yield config.encoder.node
    yield from config.modules


def _asked(bus: Bus, config: CanNode, axis: AxisConfig | None, mode: str) -> Answer:
    name, number, profile = config.name, config.id, config.profile
    family: DriveProfile | None = None
    try:
        if profile == 402:
            objects, family = od.drive_dictionary(config)
        else:
            objects = od.encoder_objects() if profile == 406 else od.module_objects()
        setup = Setup(bus, name, number, objects)
        setup.node.sdo.RESPONSE_TIMEOUT = _PATIENCE
        setup.demand_profile(profile)
        said = [_shown(word, setup, sub) for word, sub in _IDENTITY]
        more = [] if family is None else [*_modes(setup, family), *_fits(setup, family, axis, mode, bus)]
    except DriverError as error:
        return Answer(name, number, str(error), "")
    title = family.title if family is not None else f"CiA {profile}"
    return Answer(name, number, "", ", ".join([title, *filter(None, said), *more]))


def _fits(setup: Setup, family: DriveProfile, axis: AxisConfig | None, mode: str, bus: Bus) -> Iterator[str]:
    """Yield the mode that the drive would run in, and its missing objects.

    Raises DriverError if the drive does not support the mode.
    """
    if axis is None:
        return
    work = axis_work(replace(axis, profile=family), bus.config, MOTIONS[mode])
    setup.demand_modes(work.modes, family.modes)
    setup.demand(MOTIONS[mode].target)
    yield f"runs {mode}"
    watched = ((od.SYNC_PERIOD, 0), (od.COMMANDED, 5)) if work.period else ()
    lacking = {index for index, sub, _ in work.standing if not setup.has(index, sub)}
    if watched and not any(setup.has(*each) for each in watched):
        lacking.add(od.COMMANDED)
    if lacking:
        yield Message(
            "missing objects: {index}", index=" ".join(f"{index:04X}h" for index in sorted(lacking))
        )


def _shown(word: str, setup: Setup, sub: int) -> str:
    value = _read(setup, od.IDENTITY, sub)
    return f"{word} {value:08X}h" if value else ""


def _modes(setup: Setup, family: DriveProfile) -> Iterator[str]:
    offered = _read(setup, od.SUPPORTED, 0) | family.modes
    if offered:
        yield "modes " + " ".join(_SHORT[mode] for mode, bit in MODE_BITS.items() if offered & bit)


def _read(setup: Setup, index: int, sub: int) -> int:
    """Return an object, or 0 if the node does not have it."""
    try:
        return setup.read(index, sub)
    except DriverError:
        return 0
