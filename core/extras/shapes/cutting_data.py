"""Proposed feeds, speeds and depths of cut by material, operation, tool and machine.

Surface speeds in ft/min and feeds in in/rev are conservative values from handbooks and insert makers. They
are for uncoated carbide and, for drills and taps, for high-speed steel on small lathes.

All depths are per side. The proposed depth is the smallest of three values, rounded down:

- by material: ``CuttingData.roughing_depth_in``, which handbooks give for light roughing on small
  lathes;
- by insert: a quarter of the largest depth for its cutting edge. Insert makers limit the depth to a
  fraction of the edge length, which is smaller for a sharper corner: 1/2 from 75°, 1/3 from 55°, 1/5
  below;
- by machine: the depth at which the cutting force needs the full torque of the spindle at the stock
  diameter. Drives of these lathes have constant torque. ``[spindle] power_kw`` of the machine file is
  the power at the highest speed; without it, a small drive of 1.5 kW is assumed.

For boring bars half of this depth is proposed, because they bend. If the tool data has no insert, the
insert of a small holder, CCMT 0602, is assumed. The operator can change every proposal; only the largest
depth is enforced.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from core.extras.shapes.shape_fields import ProgramSettings
from core.part.insert_codes import CuttingInsert, InsertCodeError, decode_insert_code, make_insert

M_PER_FOOT = 0.3048  # m
_INCHES = 12.0


class Operation(StrEnum):
    """Kind of machining operation."""

    TURN = "turn"
    FINISH = "finish"
    BORE = "bore"
    GROOVE = "groove"
    PART_OFF = "part"
    THREAD = "thread"
    DRILL = "drill"
    MILL = "mill"


@dataclass(frozen=True, slots=True)
class CuttingData:
    """Cutting data of a material.

    - ``turning_speed_ft_min``: for carbide; ``drilling_speed_ft_min``: for high-speed steel
    - ``feed_factor``: factor for the proposed feed
    - ``roughing_depth_in``: depth of a roughing pass in inches per side
    - ``specific_cutting_force``: kc1.1 in N/mm² at the proposed feeds, for a chip thickness of 0.1 mm
    """

    turning_speed_ft_min: float
    drilling_speed_ft_min: float
    feed_factor: float
    roughing_depth_in: float
    specific_cutting_force: float


CUTTING_DATA = {
    "STEEL": CuttingData(400, 80, 1.0, 0.04, 2600),
    "FREE STEEL": CuttingData(600, 120, 1.2, 0.05, 2000),
    "ALLOY STEEL": CuttingData(300, 55, 0.9, 0.03, 2900),
    "STAINLESS": CuttingData(250, 45, 0.9, 0.03, 3000),
    "TOOL STEEL": CuttingData(200, 40, 0.8, 0.025, 3200),
    "CAST IRON": CuttingData(300, 70, 1.0, 0.04, 1700),
    "BRASS": CuttingData(700, 200, 1.3, 0.06, 1100),
    "BRONZE": CuttingData(450, 120, 1.1, 0.05, 1400),
    "COPPER": CuttingData(500, 130, 1.0, 0.04, 1400),
    "ALUMINIUM": CuttingData(900, 250, 1.3, 0.06, 1000),
    "TITANIUM": CuttingData(150, 35, 0.8, 0.02, 2200),
    "PLASTIC": CuttingData(800, 200, 1.5, 0.06, 300),
}
"""Cutting data by material, in the order in which the materials are offered."""
CONSERVATIVE_DATA = CuttingData(250, 45, 0.8, 0.02, 3200)  # conservative values for an unspecified material

_SPEED = {
    Operation.TURN: 1.0,
    Operation.FINISH: 1.1,
    Operation.BORE: 0.8,
    Operation.GROOVE: 0.6,
    Operation.PART_OFF: 0.5,
    Operation.THREAD: 0.4,
    Operation.MILL: 0.3,
}
_FEED = {
    Operation.TURN: 0.005,
    Operation.FINISH: 0.003,
    Operation.BORE: 0.003,
    Operation.GROOVE: 0.002,
    Operation.PART_OFF: 0.0015,
    Operation.MILL: 0.001,  # per tooth
}
_MOST_OF_NOSE = 0.5  # fraction of the nose radius; a larger feed leaves a visible thread
_DRILLS = 0.016  # fraction of the drill diameter, in/rev
_LEAST = 0.0003
_SURE_RPM = 50.0  # rpm are rounded down to multiples of this value


def find_cutting_data(settings: ProgramSettings) -> CuttingData:
    """Return the cutting data of the material in the program head, or conservative data if unknown."""
    return CUTTING_DATA.get(settings.material, CONSERVATIVE_DATA)


def propose_surface_speed(operation: Operation, settings: ProgramSettings) -> float:
    """Return the proposed surface speed, rounded to a multiple of 5.

    The speed is in ft/min, or in m/min in a metric program.
    """
    material = find_cutting_data(settings)
    feet = (
        material.drilling_speed_ft_min
        if operation is Operation.DRILL
        else material.turning_speed_ft_min * _SPEED[operation]
    )
    value = feet * M_PER_FOOT if settings.metric else feet
    return max(5.0, 5.0 * round(value / 5.0))


def rpm(operation: Operation, diameter: float, settings: ProgramSettings) -> float:
    """Return the proposed rpm for a diameter, limited by the spindle.

    The diameter is in the unit of the program.
    """
    speed = propose_surface_speed(operation, settings)
    around = math.pi * max(diameter, 1e-6)
    turns = speed * (1000.0 if settings.metric else _INCHES) / around
    step = _SURE_RPM if turns >= 10 * _SURE_RPM else 10.0
    return max(step, step * math.floor(min(turns, settings.shop.max_rpm) / step))


def propose_feed(
    operation: Operation, settings: ProgramSettings, tool: float = 0.0, diameter: float = 0.0
) -> float:
    """Return the proposed feed per revolution in the unit of the program.

    The feed of a drill depends on its ``diameter``, and the feed of an insert on its nose radius.
    """
    factor = find_cutting_data(settings).feed_factor
    if operation is Operation.DRILL:
        inch = max(_LEAST, _DRILLS * diameter * settings.mm / 25.4 * min(1.0, factor))
        inch = min(inch, 0.012)
    else:
        inch = _FEED[operation] * factor
    shape = settings.tool(tool)
    if (
        shape is not None
        and shape.nose_radius
        and operation in {Operation.TURN, Operation.FINISH, Operation.BORE}
    ):
        inch = min(inch, _MOST_OF_NOSE * shape.nose_radius / 25.4)
    places = 4 if inch < 0.002 else 3
    inch = max(_LEAST, round(inch, places + (inch < 0.001)))
    return round(inch * 25.4, 3) if settings.metric else round(inch, 5)


_OF_EDGE = ((75.0, 1 / 2), (55.0, 1 / 3), (0.0, 1 / 5))  # fraction of the cutting edge, by corner angle
_OF_ROUND = 1 / 4  # fraction of the diameter of a round insert
_PROPOSED = 1 / 4  # fraction of the largest depth
_SMALL = make_insert("C", 6.35, 0.4)
_BAR = 1 / 2
_STEP = {False: 0.005, True: 0.1}  # by metric; depths are rounded down to multiples
_LEAVE = {False: 0.01, True: 0.25}  # by metric, finishing allowance
_FACING = 0.75  # fraction of the depth along a profile


def find_max_cutting_depth(settings: ProgramSettings, tool: float) -> float:
    """Return the largest permitted depth of cut for the insert of a tool, in the unit of the program."""
    insert = _insert(settings, tool)
    if not insert.edge_lengths:
        return _OF_ROUND * insert.inscribed_circle / settings.mm
    share = next(each for angle, each in _OF_EDGE if insert.point_angle >= angle)
    return share * min(insert.edge_lengths) / settings.mm


def propose_roughing_depth(
    settings: ProgramSettings, tool: float, diameter: float, *, is_inside: bool = False
) -> float:
    """Return the proposed depth of roughing passes at a diameter, in the unit of the program."""
    by_material = find_cutting_data(settings).roughing_depth_in * 25.4 / settings.mm
    depth = min(
        by_material,
        _PROPOSED * find_max_cutting_depth(settings, tool),
        _limit_depth_by_torque(settings, tool, diameter),
    )
    return _rounded(depth * (_BAR if is_inside else 1.0), settings)


def propose_facing_depth(settings: ProgramSettings, tool: float, diameter: float) -> float:
    """Return the proposed depth of facing passes across the end of a bar."""
    return _rounded(_FACING * propose_roughing_depth(settings, tool, diameter), settings)


def propose_finish_allowance(settings: ProgramSettings, rough_depth: float) -> float:
    """Return the proposed finishing allowance in X and Z, which is at most half a roughing pass."""
    return min(_LEAVE[settings.metric], rough_depth / 2.0)


def _limit_depth_by_torque(settings: ProgramSettings, tool: float, diameter: float) -> float:
    """Return the depth of cut at which the cutting force needs the full torque of the spindle.

    The torque is force · depth · feed · radius.
    """
    torque = settings.shop.spindle_power_w / (settings.shop.max_rpm * math.pi / 30.0)  # N m
    radius, mm = diameter * settings.mm / 2000.0, settings.mm
    if radius <= 0.0:
        return math.inf
    return (
        torque
        / (
            find_cutting_data(settings).specific_cutting_force
            * propose_feed(Operation.TURN, settings, tool)
            * mm
            * radius
        )
        / mm
    )


def _insert(setting: ProgramSettings, tool: float) -> CuttingInsert:
    shape = setting.tool(tool)
    try:
        return decode_insert_code(shape.insert) if shape is not None and shape.insert else _SMALL
    except InsertCodeError:
        return _SMALL


def _rounded(depth: float, setting: ProgramSettings) -> float:
    step = _STEP[setting.metric]
    return round(max(step, step * math.floor(depth / step + 1e-6)), 4)
