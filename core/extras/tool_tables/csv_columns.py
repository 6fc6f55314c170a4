"""Column names of CSV tool tables, and the field to which each name refers."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from core.extras.tool_tables.tool_entry import DIAMETER_FIELD, TABLE_FIELDS

NUMBER, X_DIAMETER, NOSE_DIAMETER = "number", "x_diameter", "nose_diameter"
FIELD_NAMES = (NUMBER, *TABLE_FIELDS, DIAMETER_FIELD, X_DIAMETER, NOSE_DIAMETER)
"""Fields that a column can have. ``x`` follows the option for X, and ``x_diameter`` is always a diameter."""

# Names without their unit, in lower case, without blanks and signs.
_NAMES: Mapping[str, Sequence[str]] = {
    NUMBER: ("t", "tool", "toolnumber", "toolno", "toolnr", "no", "nr", "number", "id"),
    "x": ("xoffset", "offsetx", "xgeometry", "geometryx", "xgeom", "geomx", "xradius", "radiusx"),
    X_DIAMETER: ("xdia", "diax", "diameterx", "xoffsetdia", "xoffsetdiameter"),
    "z": ("zoffset", "offsetz", "zgeometry", "geometryz", "zgeom", "geomz"),
    "nose_radius": ("r", "radius", "tipradius", "toolradius", "cornerradius", "toolnoseradius", "tnr"),
    NOSE_DIAMETER: ("tipdiameter",),
    DIAMETER_FIELD: ("dia",),
    "quadrant": ("q", "tip", "tipquadrant", "tipdirection", "direction", "tiptype", "imaginarytip", "tipno"),
    "remark": ("comment", "description", "desc", "name", "toolname", "note", "notes", "rem"),
    "kind": ("type", "tooltype", "kindoftool"),
    "insert": ("insertcode", "isocode", "iso", "insertiso"),
    "holder": ("toolholder", "holdercode", "shank"),
    "width": ("insertwidth", "groovewidth"),
    "diameter": ("tooldiameter", "drilldiameter"),
    "point": ("pointangle", "tipangle"),
    "length": ("cuttinglength", "flutelength"),
    "entry": ("enteringangle", "leadangle"),
}
_UNIT = re.compile(r"[(\[]\s*(mm|in|inch|inches|\"|millimeters?)\s*[)\]]", re.IGNORECASE)
_PLAIN = re.compile(r"[^a-z0-9]")
_BY_NAME = {
    _PLAIN.sub("", name): field
    for field, names in ((field, (field, *_NAMES.get(field, ()))) for field in FIELD_NAMES)
    for name in names
}
_SURE_RADIUS = frozenset({"xradius", "radiusx"})


class TableColumn(NamedTuple):
    """A column of a CSV file, with its index (from 0), heading and field.

    ``unit`` is the unit in the heading, or an empty string. ``is_radius`` is True if the heading of X
    states that X is a radius.
    """

    column_index: int
    heading: str
    field_name: str
    unit: str = ""
    is_radius: bool = False


def identify_column(index: int, heading: str, field: str = "") -> TableColumn | None:
    """Return the column with this heading, or None if the heading is unknown and ``field`` is empty.

    ``field`` is the field that the user assigned to the column.
    """
    unit = _UNIT.search(heading)
    plain = _PLAIN.sub("", _UNIT.sub("", heading).lower())
    meaning = _BY_NAME.get(plain, "")
    name = field or meaning
    if not name:
        return None
    if field == "x" and ("dia" in plain or "ø" in heading.lower()):
        name = X_DIAMETER
    letters = unit[1].lower() if unit else ""
    known = ("mm" if letters.startswith("m") else "in") if letters else ""
    return TableColumn(index, heading.strip(), name, known, plain in _SURE_RADIUS)
