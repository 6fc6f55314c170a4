"""Depths of cut: what is proposed for a rough pass, and the most that an insert takes in one pass.

All depths are per side. A proposal is the smallest of three values, rounded down:

- by material: ``Material.depth``, what handbooks give for light roughing on small lathes;
- by insert: a quarter of the most that its cutting edge takes. Makers of inserts limit the depth to a share
  of the edge, which is smaller for a sharper corner: 1/2 from 75°, 1/3 from 55°, 1/5 below;
- by machine: the depth whose cutting force the spindle can turn at the diameter of the stock. Drives of
  these lathes have a constant torque. A machine file may state the power at the highest speed,
  ``[spindle] power_kw``; otherwise 1.5 kW is assumed, which is a small drive.

Boring bars get half of it, because they bend. Without an insert in the tool's sheet, that of a small holder
is assumed, CCMT 0602. Proposals are to be changed by who knows the job; only the most is enforced.
"""

from __future__ import annotations

import math

from core.extras.shapes.cutting_data import Work, feed, material_of
from core.extras.shapes.shape_fields import Setting
from core.part.insert_codes import Insert, InsertCodeError, decoded, insert_of

_OF_EDGE = ((75.0, 1 / 2), (55.0, 1 / 3), (0.0, 1 / 5))  # by corner angle, of the cutting edge
_OF_ROUND = 1 / 4  # of the diameter of a round insert
_PROPOSED = 1 / 4  # of the most
_SMALL = insert_of("C", 6.35, 0.4)
_BAR = 1 / 2
_STEP = {False: 0.005, True: 0.1}  # by metric: depths are rounded down to these
_LEAVE = {False: 0.01, True: 0.25}  # by metric: for finishing
_FACING = 0.75  # of the depth along a profile


def most_depth(setting: Setting, tool: float) -> float:
    """Return the deepest cut that the insert of a tool takes, in the unit of the program."""
    insert = _insert(setting, tool)
    if not insert.edges:
        return _OF_ROUND * insert.inscribed_circle / setting.mm
    share = next(each for angle, each in _OF_EDGE if insert.point_angle >= angle)
    return share * min(insert.edges) / setting.mm


def rough_depth(setting: Setting, tool: float, across: float, *, inside: bool = False) -> float:
    """Return the proposed depth of rough passes of a tool at a diameter, in the unit of the program."""
    by_material = material_of(setting).depth * 25.4 / setting.mm
    depth = min(by_material, _PROPOSED * most_depth(setting, tool), _turned(setting, tool, across))
    return _rounded(depth * (_BAR if inside else 1.0), setting)


def facing_depth(setting: Setting, tool: float, across: float) -> float:
    """Return the depth that is proposed for passes across the end of a bar."""
    return _rounded(_FACING * rough_depth(setting, tool, across), setting)


def finish_depth(setting: Setting, rough: float) -> float:
    """Return what roughing leaves along the contour, in X and Z alike: at most half a rough pass."""
    return min(_LEAVE[setting.metric], rough / 2.0)


def _turned(setting: Setting, tool: float, across: float) -> float:
    """Depth at which the cutting force has the torque of the spindle: force x depth x feed x radius."""
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
