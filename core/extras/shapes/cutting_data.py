"""Proposed feeds, speeds and depths of cut by material, operation, tool and machine.

Surface speeds in ft/min and feeds in in/rev are conservative values from handbooks and insert makers for
uncoated carbide and, for drills and taps, high-speed steel on small machines. They are only proposals.

All depths are per side. A proposal is the smallest of three values, rounded down:

- by material: ``Material.depth``, which handbooks give for light roughing on small lathes;
- by insert: a quarter of the largest depth for its cutting edge. Insert makers limit the depth to a
  fraction of the edge, which is smaller for a sharper corner: 1/2 from 75°, 1/3 from 55°, 1/5 below;
- by machine: the depth at which the cutting force equals the torque of the spindle at the stock diameter.
  Drives of these lathes have constant torque. A machine file may state the power at the highest speed,
  ``[spindle] power_kw``; otherwise a small drive of 1.5 kW is assumed.

Boring bars get half of the depth, because they bend. If the tool data has no insert, the insert of a small
holder, CCMT 0602, is assumed. The operator may change every proposal; only the largest depth is enforced.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from core.extras.shapes.shape_fields import Setting
from core.part.insert_codes import Insert, InsertCodeError, decoded, insert_of

FEET = 0.3048  # m
_INCHES = 12.0


class Work(StrEnum):
    """Kind of machining operation."""

    TURN = "turn"
    FINISH = "finish"
    BORE = "bore"
    GROOVE = "groove"
    PART = "part"
    THREAD = "thread"
    DRILL = "drill"
    MILL = "mill"


@dataclass(frozen=True, slots=True)
class Material:
    """Cutting data of a material.

    Surface speeds are in ft/min for turning with carbide and drilling with high-speed steel. ``feed`` is a
    factor. ``depth`` is the depth of a roughing pass in inches per side. ``force`` is the specific cutting
    force kc1.1 at the proposed feeds in N/mm², for a chip thickness of 0.1 mm.
    """

    turn: float
    drill: float
    feed: float
    depth: float
    force: float


MATERIALS = {
    "STEEL": Material(400, 80, 1.0, 0.04, 2600),
    "FREE STEEL": Material(600, 120, 1.2, 0.05, 2000),
    "ALLOY STEEL": Material(300, 55, 0.9, 0.03, 2900),
    "STAINLESS": Material(250, 45, 0.9, 0.03, 3000),
    "TOOL STEEL": Material(200, 40, 0.8, 0.025, 3200),
    "CAST IRON": Material(300, 70, 1.0, 0.04, 1700),
    "BRASS": Material(700, 200, 1.3, 0.06, 1100),
    "BRONZE": Material(450, 120, 1.1, 0.05, 1400),
    "COPPER": Material(500, 130, 1.0, 0.04, 1400),
    "ALUMINIUM": Material(900, 250, 1.3, 0.06, 1000),
    "TITANIUM": Material(150, 35, 0.8, 0.02, 2200),
    "PLASTIC": Material(800, 200, 1.5, 0.06, 300),
}
"""In the order in which they are offered."""
UNKNOWN = Material(250, 45, 0.8, 0.02, 3200)  # conservative values for an unspecified material

_SPEED = {
    Work.TURN: 1.0,
    Work.FINISH: 1.1,
    Work.BORE: 0.8,
    Work.GROOVE: 0.6,
    Work.PART: 0.5,
    Work.THREAD: 0.4,
    Work.MILL: 0.3,
}
_FEED = {
    Work.TURN: 0.005,
    Work.FINISH: 0.003,
    Work.BORE: 0.003,
    Work.GROOVE: 0.002,
    Work.PART: 0.0015,
    Work.MILL: 0.001,  # per tooth
}
_MOST_OF_NOSE = 0.5  # fraction of the nose radius; a larger feed leaves a visible thread
_DRILLS = 0.016  # fraction of the drill diameter, in/rev
_LEAST = 0.0003
_SURE_RPM = 50.0  # rpm are rounded down to multiples of this value


def material_of(setting: Setting) -> Material:
    """Return the material that the head of the program specifies, or conservative values."""
    return MATERIALS.get(setting.material, UNKNOWN)


def surface_speed(work: Work, setting: Setting) -> float:
    """Return the proposed surface speed in ft/min, or m/min in a metric program, rounded to 5."""
    material = material_of(setting)
    feet = material.drill if work is Work.DRILL else material.turn * _SPEED[work]
    value = feet * FEET if setting.metric else feet
    return max(5.0, 5.0 * round(value / 5.0))


def rpm(work: Work, diameter: float, setting: Setting) -> float:
    """Return the proposed rpm for a diameter in the program's unit, limited by the spindle."""
    speed = surface_speed(work, setting)
    around = math.pi * max(diameter, 1e-6)
    turns = speed * (1000.0 if setting.metric else _INCHES) / around
    step = _SURE_RPM if turns >= 10 * _SURE_RPM else 10.0
    return max(step, step * math.floor(min(turns, setting.shop.max_rpm) / step))


def feed(work: Work, setting: Setting, tool: float = 0.0, diameter: float = 0.0) -> float:
    """Return the proposed feed per revolution in the unit of the program.

    The feed of a drill depends on its ``diameter``, and the feed of an insert on its nose radius.
    """
    factor = material_of(setting).feed
    if work is Work.DRILL:
        inch = max(_LEAST, _DRILLS * diameter * setting.mm / 25.4 * min(1.0, factor))
        inch = min(inch, 0.012)
    else:
        inch = _FEED[work] * factor
    shape = setting.tool(tool)
    if shape is not None and shape.nose_radius and work in {Work.TURN, Work.FINISH, Work.BORE}:
        inch = min(inch, _MOST_OF_NOSE * shape.nose_radius / 25.4)
    places = 4 if inch < 0.002 else 3
    inch = max(_LEAST, round(inch, places + (inch < 0.001)))
    return round(inch * 25.4, 3) if setting.metric else round(inch, 5)


_OF_EDGE = ((75.0, 1 / 2), (55.0, 1 / 3), (0.0, 1 / 5))  # fraction of the cutting edge, by corner angle
_OF_ROUND = 1 / 4  # fraction of the diameter of a round insert
_PROPOSED = 1 / 4  # fraction of the largest depth
_SMALL = insert_of("C", 6.35, 0.4)
_BAR = 1 / 2
_STEP = {False: 0.005, True: 0.1}  # by metric; depths are rounded down to multiples
_LEAVE = {False: 0.01, True: 0.25}  # by metric, finishing allowance
_FACING = 0.75  # fraction of the depth along a profile


def most_depth(setting: Setting, tool: float) -> float:
    """Return the largest depth of cut for the insert of a tool, in the unit of the program."""
    insert = _insert(setting, tool)
    if not insert.edges:
        return _OF_ROUND * insert.inscribed_circle / setting.mm
    share = next(each for angle, each in _OF_EDGE if insert.point_angle >= angle)
    return share * min(insert.edges) / setting.mm


def rough_depth(setting: Setting, tool: float, across: float, *, inside: bool = False) -> float:
    """Return the proposed depth of roughing passes at a diameter, in the unit of the program."""
    by_material = material_of(setting).depth * 25.4 / setting.mm
    depth = min(by_material, _PROPOSED * most_depth(setting, tool), _turned(setting, tool, across))
    return _rounded(depth * (_BAR if inside else 1.0), setting)


def facing_depth(setting: Setting, tool: float, across: float) -> float:
    """Return the proposed depth of passes across the end of a bar."""
    return _rounded(_FACING * rough_depth(setting, tool, across), setting)


def finish_depth(setting: Setting, rough: float) -> float:
    """Return the finishing allowance in X and Z, at most half a roughing pass."""
    return min(_LEAVE[setting.metric], rough / 2.0)


def _turned(setting: Setting, tool: float, across: float) -> float:
    """Return the depth at which the cutting force needs the full torque of the spindle.

    The torque is force · depth · feed · radius.
    """
    torque = setting.shop.power / (setting.shop.max_rpm * math.pi / 30.0)  # N m
    radius, mm = across * setting.mm / 2000.0, setting.mm
    if radius <= 0.0:
        return math.inf
    return torque / (material_of(setting).force * feed(Work.TURN, setting, tool) * mm * radius) / mm


def _insert(setting: Setting, tool: float) -> Insert:
    shape = setting.tool(tool)
    try:
        return decoded(shape.insert) if shape is not None and shape.insert else _SMALL
    except InsertCodeError:
        return _SMALL


def _rounded(depth: float, setting: Setting) -> float:
    step = _STEP[setting.metric]
    return round(max(step, step * math.floor(depth / step + 1e-6)), 4)
