"""Writer of tool libraries for Fusion (JSON). ``fusion_library`` explains the geometry symbols."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from uuid import NAMESPACE_URL, uuid5

from core.extras.tool_tables.iso_code_recognition import ROUND_KINDS
from core.extras.tool_tables.tool_entry import MM_PER_UNIT, ToolEntry
from core.part.insert_codes import InsertCodeError, decode_insert_code, parse_holder

_TYPES: Mapping[str, str] = {
    **{"turning": "turning_general", "boring": "turning_boring", "grooving": "turning_grooving"},
    **{"parting": "turning_grooving", "threading": "turning_threading", "drill": "drill"},
    **{
        "centre-drill": "center_drill",
        "reamer": "reamer",
        "tap": "tap_right_hand",
        "end-mill": "flat_end_mill",
    },
}
EXPORTED_FIELDS = frozenset(
    {
        *("remark", "nose_radius", "kind", "hand", "insert", "holder"),
        *("width", "diameter", "point", "stick_out", "length", "pitch", "flutes"),
    }
)
_UNITS = {"in": "inches", "mm": "millimeters"}
_DIGITS = 6
_HEAD = re.compile(r"(?:[ACES]\d\d[A-Z]?-?)?([CDMPSWX])[CDEKMPRSTVWHO]([A-Y])[A-Z][RLN]")


def can_export(tool: ToolEntry) -> bool:
    """Return whether Fusion has a type for this kind of tool."""
    return str(tool.shape_values.get("kind", "")) in _TYPES


def format_library(tools: Iterable[ToolEntry], unit: str) -> str:
    """Return the tools as a Fusion library, except tools of a kind for which Fusion has no type.

    Lengths are in ``unit``.
    """
    data = [_format_tool(each, unit) for each in tools if can_export(each)]
    return json.dumps({"data": data, "version": 1}, indent=1) + "\n"


def _format_tool(tool: ToolEntry, unit: str) -> dict[str, object]:
    kind = str(tool.shape_values["kind"])
    is_left_tap = kind == "tap" and tool.shape_values.get("hand") == "left"
    kind_name = "tap_left_hand" if is_left_tap else _TYPES[kind]
    remark = str(tool.offset_values.get("remark", ""))
    if kind == "parting" and "part" not in remark.lower():
        remark = " ".join((remark, "parting")).strip()
    factor = MM_PER_UNIT[unit]
    content: dict[str, object] = {
        "type": kind_name.replace("_", " "),
        "unit": _UNITS[unit],
        "description": remark,
        "product-id": str(tool.shape_values.get("insert", "")),
        **{"BMC": "unspecified", "GRADE": "generic", "vendor": "", "product-link": ""},
        "geometry": _format_round(tool, factor) if kind in ROUND_KINDS else _format_insert(tool, factor),
        "post-process": _format_numbers(tool.tool_number),
        "start-values": {"presets": []},
    }
    if kind not in ROUND_KINDS:
        content["holder"] = _format_holder(tool, factor)
    content["guid"] = str(uuid5(NAMESPACE_URL, f"turndesk:{tool.tool_number}"))
    return content


def _format_numbers(number: int) -> dict[str, object]:
    offsets = {"diameter-offset": number, "length-offset": number}
    return {"number": number, "turret": 0, "live": False, "break-control": False, "comment": "", **offsets}


def _format_round(tool: ToolEntry, factor: float) -> dict[str, object]:
    """Return the geometry of a rotating tool."""
    shape = tool.shape_values
    lengths = {"DC": "diameter", "LCF": "length", "LB": "stick_out", "TP": "pitch"}
    geometry: dict[str, object] = {
        key: _scale(shape.get(name), factor) for key, name in lengths.items() if shape.get(name)
    }
    if flutes := shape.get("flutes"):
        geometry["NOF"] = flutes
    if point := shape.get("point"):
        geometry["SIG"] = point
    if radius := tool.offset_values.get("nose_radius"):
        geometry["RE"] = _scale(radius, factor)
    return {**geometry, "HAND": shape.get("hand") != "left", "CSP": False}


def _format_insert(tool: ToolEntry, factor: float) -> dict[str, object]:
    """Return the geometry of the insert of a turning tool."""
    shape = tool.shape_values
    geometry: dict[str, object] = {}
    nose = float(tool.offset_values.get("nose_radius", 0.0))
    if shape["kind"] == "threading":
        values = {"TP": shape.get("pitch"), "TPX": shape.get("pitch"), "thread-tip-radius": nose}
        geometry = {key: _scale(value, factor) for key, value in values.items() if value}
        if point := shape.get("point"):
            geometry["thread-profile-angle"] = point
        return {
            "SC": "thread_iso_double".replace("_", " "),
            **geometry,
            "tool_internalThread": bool(shape.get("diameter")),
        }
    if shape["kind"] in {"grooving", "parting"}:
        values = {"tool_grooveWidth": shape.get("width"), "LH": shape.get("length"), "RE": nose}
        geometry = {key: _scale(value, factor) for key, value in values.items() if value}
        return {"SC": "groove_square".replace("_", " "), **geometry}
    return {
        **_format_code(str(shape.get("insert", "")), factor),
        **({"RE": _scale(nose, factor)} if nose else {}),
    }


def _format_code(code: str, factor: float) -> dict[str, object]:
    """Return the geometry of an insert code, or an empty object if the code is empty or invalid."""
    try:
        insert = decode_insert_code(code)
    except InsertCodeError:
        return {}
    letters = re.match(r"[A-Z]*", re.sub(r"[\s_-]", "", code).upper())
    head = f"{letters[0] if letters else '':<4}"
    return {
        **{"SC": insert.shape, "TC": head[2].strip(), "SCTY": head[3].strip(), "RA": insert.clearance_angle},
        **{"INSD": _scale(insert.inscribed_circle, factor), "SIZE_SPECIFICATION_MODE": "IC"},
        **{"S": _scale(insert.thickness, factor), "RE": _scale(insert.nose_radius, factor)},
    }


def _format_holder(tool: ToolEntry, factor: float) -> dict[str, object]:
    """Return the holder of a turning tool."""
    name = str(tool.shape_values.get("holder", ""))
    hand = {"left": "L", "neutral": "N"}.get(str(tool.shape_values.get("hand", "")), "R")
    content: dict[str, object] = {"description": name, "HAND": hand}
    found = parse_holder(name)
    width = (found.shank_width_mm or found.bar_diameter_mm) if found else 0.0
    if width := width or float(tool.shape_values.get("diameter", 0.0)):
        content.update({"W": _scale(width, factor), "H": _scale(width, factor)})
    if letters := _HEAD.match(name.upper()):
        content.update({"MTP": letters[1], "THSC": letters[2]})
    return content


def _scale(value: object, factor: float) -> float:
    return round(float(str(value)) / factor, _DIGITS)
