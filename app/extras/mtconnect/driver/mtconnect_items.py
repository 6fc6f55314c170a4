"""MTConnect data items of a machine, grouped into components."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum


class DataItemCategory(StrEnum):
    """Category of an MTConnect data item: sample, event or condition."""

    SAMPLE = "SAMPLE"
    EVENT = "EVENT"
    CONDITION = "CONDITION"


@dataclass(frozen=True, slots=True)
class DataItem:
    """MTConnect data item that the adapter reports.

    - ``key`` is the name of the item in SHDR lines, and ``units`` are the units of the sent values.
    - Values of samples are rounded to ``decimal_places`` decimals.
    - A change is sent only if it exceeds ``minimum_change`` plus ``min_relative_change`` times the value.
    """

    key: str
    category: DataItemCategory
    item_type: str
    sub_type: str = ""
    units: str = ""
    coordinate_system: str = ""  # coordinate system of a position
    decimal_places: int = 0
    minimum_change: float = 0.0
    min_relative_change: float = 0.0


@dataclass(frozen=True, slots=True)
class Component:
    """Component of the MTConnect device model, with its data items and sub-components."""

    component_type: str
    name: str
    items: tuple[DataItem, ...] = ()
    sub_components: tuple[Component, ...] = ()

    def iterate_items(self) -> Iterator[DataItem]:
        """Yield the data items of the component and of all its sub-components."""
        yield from self.items
        for part in self.sub_components:
            yield from part.iterate_items()


@dataclass(frozen=True, slots=True)
class MachineLayout:
    """Layout of the machine, which determines its data items.

    ``spindle_name`` is the name of the spindle component. ``is_spindle_positionable`` means that the
    spindle can also be used as a rotary axis.
    """

    linear_axes: tuple[str, ...]
    rotary_axes: tuple[str, ...]
    spindle_name: str
    is_spindle_positionable: bool
    has_chuck: bool


def make_machine_items(layout: MachineLayout, device_name: str) -> Component:
    """Return the MTConnect device with all its data items.

    Units are millimeters, degrees, mm/s, rpm and percent.
    """
    return Component(
        "Device",
        device_name,
        (_event("avail", "AVAILABILITY"),),
        (
            Component("Axes", "base", sub_components=(*_linear(layout), *_rotary(layout), _spindle(layout))),
            Component("Controller", "controller", _CONTROLLER, (Component("Path", "path", _PATH),)),
            Component("Door", "guard", (_event("door", "DOOR_STATE"),)),
            Component("Auxiliaries", "auxiliaries", sub_components=(_BAR_FEEDER,)),
        ),
    )


def _event(key: str, kind: str, sub_type: str = "", units: str = "") -> DataItem:
    return DataItem(key, DataItemCategory.EVENT, kind, sub_type, units)


def _percent(key: str, kind: str) -> DataItem:
    return DataItem(key, DataItemCategory.EVENT, kind, "PROGRAMMED", "PERCENT", decimal_places=1)


def _condition(key: str, kind: str) -> DataItem:
    return DataItem(key, DataItemCategory.CONDITION, kind)


def _rpm(key: str, sub_type: str) -> DataItem:
    units = "REVOLUTION/MINUTE"
    return DataItem(
        key,
        DataItemCategory.SAMPLE,
        "ROTARY_VELOCITY",
        sub_type,
        units,
        decimal_places=1,
        minimum_change=1.0,
        min_relative_change=0.005,
    )


def _angle(axis: str) -> DataItem:
    return DataItem(
        f"{axis}abs",
        DataItemCategory.SAMPLE,
        "ANGLE",
        "ACTUAL",
        "DEGREE",
        decimal_places=3,
        minimum_change=0.05,
    )


def _own_drive(axis: str) -> tuple[DataItem, ...]:
    return (_condition(f"{axis}travel", "POSITION"), _condition(f"{axis}servo", "ACTUATOR"))


def _linear(layout: MachineLayout) -> Iterator[Component]:
    """Yield the components of the linear axes.

    Changes of less than 3 µm are not reported, to suppress encoder noise at standstill.
    """
    for axis in layout.linear_axes:
        at = DataItem(
            f"{axis}abs",
            DataItemCategory.SAMPLE,
            "POSITION",
            "ACTUAL",
            "MILLIMETER",
            "MACHINE",
            decimal_places=4,
            minimum_change=0.003,
        )
        yield Component("Linear", axis, (at, *_own_drive(axis)))


def _rotary(layout: MachineLayout) -> Iterator[Component]:
    for axis in layout.rotary_axes:
        yield Component("Rotary", axis, (_angle(axis), *_own_drive(axis)))


def _spindle(layout: MachineLayout) -> Component:
    items = (
        *((_angle(layout.spindle_name),) if layout.is_spindle_positionable else ()),
        _rpm("Srpm", "ACTUAL"),
        _rpm("Scmd", "PROGRAMMED"),
        _percent("Sovr", "ROTARY_VELOCITY_OVERRIDE"),
        DataItem(
            "Sload",
            DataItemCategory.SAMPLE,
            "LOAD",
            "ACTUAL",
            "PERCENT",
            decimal_places=1,
            minimum_change=1.0,
        ),
        _event("rotmode", "ROTARY_MODE"),
        _condition("Sdrive", "ACTUATOR"),
    )
    return Component("Rotary", layout.spindle_name, items, (_CHUCK,) if layout.has_chuck else ())


_CHUCK = Component("Chuck", "collet", (_event("chuck", "CHUCK_STATE"), _event("chuckil", "CHUCK_INTERLOCK")))
_BAR_FEEDER = Component("BarFeeder", "bar", (_event("endbar", "END_OF_BAR"),))
_CONTROLLER = (
    _event("estop", "EMERGENCY_STOP"),
    _condition("comms", "COMMUNICATIONS"),
    _condition("logic", "LOGIC_PROGRAM"),
    _condition("system", "SYSTEM"),
)
_PATH = (
    _event("mode", "CONTROLLER_MODE"),
    _event("execution", "EXECUTION"),
    _event("program", "PROGRAM"),
    _event("line", "LINE_NUMBER", "ABSOLUTE"),
    _event("block", "BLOCK"),
    _event("toolnum", "TOOL_NUMBER"),
    _event("pcount", "PART_COUNT", "ALL"),
    _event("part", "PART_DETECT"),
    DataItem(
        "Fact",
        DataItemCategory.SAMPLE,
        "PATH_FEEDRATE",
        "ACTUAL",
        "MILLIMETER/SECOND",
        decimal_places=3,
        minimum_change=0.1,
        min_relative_change=0.02,
    ),
    _percent("Fovr", "PATH_FEEDRATE_OVERRIDE"),
    _condition("motion", "MOTION_PROGRAM"),
)
