"""Explanations of the fields of the offset tables, which the help shows for the selected field."""

from __future__ import annotations

from collections.abc import Mapping

from app.desk.pages.guide_text import BlockKind, GuideBlock
from app.desk.translation import tr
from core.store.store_rows import OffsetKind

_TOOL_FIELDS = {
    "x": "Distance from the machine reference to the tool tip in X. Touch off X to measure it.",
    "z": "Distance from the machine reference to the tool tip in Z. Touch off Z to measure it.",
    "nose_radius": "Radius of the rounded tool tip. Nose radius compensation (G41, G42) uses it.",
    "quadrant": "Direction from the nose center to the tip, 1 to 9. Nose radius compensation uses it.",
    "wear_x": "Wear correction in X as a diameter. It is added to X. You can change it while parts run.",
    "wear_z": "Wear correction in Z. It is added to Z. You can change it while parts run.",
    "master": "The tool to which X and Z of the other tools are relative when F3 MASTER is on.",
    "remark": "Your own note about the tool. It has no effect on the machine.",
}
_SECONDARY_FIELDS = {
    "x": "Correction of the diameter. Half of it is added to X, because X is stored as a radius.",
    "z": "Correction that is added to Z.",
    "r": "Nose radius for this offset. It replaces the previous value.",
}
_SHAPE_FIELDS = {
    "kind": "The type of tool. It determines which other fields the tool has.",
    "hand": "The side to which the tool cuts.",
    "insert": "ISO code of the insert. Size and angles follow from it.",
    "holder": "ISO code of the holder. The proof checks collisions with the holder.",
    "width": "Width of the cutting edge of a grooving or cutoff tool.",
    "diameter": "Diameter of the tool. For a boring bar, the diameter of the bar.",
    "point": "Angle at the point of a drill.",
    "stick_out": "Length of the tool outside its holder.",
    "length": "Length of the cutting edge.",
    "pitch": "Pitch of the thread that the tool cuts.",
    "flutes": "Number of cutting edges.",
    "entry": "Angle between the main cutting edge and the feed direction.",
    "rear": "Whether the tool works at negative X.",
    "profile": "Outline of a form tool, as points from the control point.",
}
_ZERO_FIELDS = {
    "x": "Position of the program zero in X, as a radius in mm from the machine zero.",
    "z": "Position of the program zero in Z, in mm from the machine zero.",
    "c": "Angle of the program zero of the C axis, in degrees.",
}
_MILL_TOOL_FIELDS = {
    "name": "Name of the tool. A program can call the tool by this name.",
    "length": "Length of the tool from the spindle nose to the tip. F2 touches it off.",
    "radius": "Radius of the tool. Radius compensation uses it.",
    "corner": "Corner radius of the tool, equal to R for a ball nose.",
    "dl": "Oversize that is added to the length.",
    "dr": "Oversize that is added to the radius.",
    "dr2": "Oversize that is added to the corner radius.",
    "teeth": "Number of teeth.",
    "point": "Point angle of a drill.",
    "life": "Tool life limit in minutes of cutting time. 0 means no limit.",
    "used": "Cutting time of the tool since it was new, in minutes.",
    "stops": "Whether no new part starts after TIME2 is reached. Enter turns it on or off.",
}
_PRESET_FIELDS = {
    "x": "Position of the workpiece zero in X, in machine coordinates.",
    "y": "Position of the workpiece zero in Y, in machine coordinates.",
    "z": "Position of the workpiece zero in Z, in machine coordinates.",
    "rotation": "Basic rotation: the angle of the workpiece around the tool axis.",
    "a": "Angle of the workpiece zero of the A axis.",
    "b": "Angle of the workpiece zero of the B axis.",
    "c": "Angle of the workpiece zero of the C axis.",
    "remark": "Your own note about the preset. It has no effect on the machine.",
}
FIELD_TEXTS: Mapping[OffsetKind, Mapping[str, str]] = {
    OffsetKind.TOOL: _TOOL_FIELDS,
    OffsetKind.SECONDARY: _SECONDARY_FIELDS,
    OffsetKind.SHAPE: {**_SHAPE_FIELDS, **{name: _TOOL_FIELDS[name] for name in ("quadrant", "nose_radius")}},
    OffsetKind.ZERO: _ZERO_FIELDS,
    OffsetKind.MILL_TOOL: _MILL_TOOL_FIELDS,
    OffsetKind.PRESET: _PRESET_FIELDS,
}


def make_field_help(kind: OffsetKind, field_name: str, question: str) -> tuple[GuideBlock, ...]:
    """Return the explanation of a field, or an empty tuple if the table does not have the field.

    ``question`` is the prompt of the field, which names the field with its unit.
    """
    text = FIELD_TEXTS[kind].get(field_name, "")
    if not text:
        return ()
    return GuideBlock(BlockKind.HEADING, question.rstrip("?")), GuideBlock(BlockKind.TEXT, tr(text))
