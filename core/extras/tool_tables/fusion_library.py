"""Tool libraries of Fusion (HSM): a JSON file, or a ``.tools`` archive that contains ``tools.json``.

Each tool states its own unit. Its ``geometry`` uses the symbols of ISO 13399: DC is the cutting diameter,
RE the corner radius, SIG the point angle, LCF the length of the flutes, NOF their number, TP the pitch, and
INSD the size of the insert. A library has no positions and no tip quadrants.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping
from functools import partial

from core.extras.tool_tables.iso_code_format import (
    HolderSizes,
    InsertSizes,
    find_clearance_letter,
    format_holder_code,
    format_insert_code,
)
from core.extras.tool_tables.iso_code_recognition import (
    ROUND_KINDS,
    get_tool_hand,
    recognize_shape_fields,
    recognize_tool_kind,
)
from core.extras.tool_tables.json_fields import JsonFields, format_unused_keys, parse_object
from core.extras.tool_tables.tool_entry import MM_PER_UNIT, TableReader, ToolTableError
from core.input_file import convert_exceptions
from core.message import Message
from core.part.insert_codes import CORNER_ANGLES, decode_insert_code
from core.store.store_rows import FieldValue

_KINDS: Mapping[str, str] = {
    **{"turning_general": "turning", "turning_boring": "boring", "turning_grooving": "grooving"},
    **{"turning_threading": "threading", "boring_bar": "boring", "reamer": "reamer"},
    **{"drill": "drill", "spot_drill": "drill", "center_drill": "centre-drill"},
    **{"tap_right_hand": "tap", "tap_left_hand": "tap"},
    **{"flat_end_mill": "end-mill", "ball_end_mill": "end-mill", "bull_nose_end_mill": "end-mill"},
}
"""Kind of tool by the type of a Fusion tool, with an underscore for each blank."""
_LENGTHS: Mapping[str, Mapping[str, str]] = {
    **{kind: {"DC": "diameter", "LCF": "length", "LB": "stick_out"} for kind in ROUND_KINDS},
    "tap": {"DC": "diameter", "LCF": "length", "LB": "stick_out", "TP": "pitch"},
    "end-mill": {"DC": "diameter", "LCF": "length", "LB": "stick_out", "RE": "nose_radius"},
    "turning": {"RE": "nose_radius"},
    "boring": {"RE": "nose_radius"},
    "grooving": {"RE": "nose_radius", "tool_grooveWidth": "width", "LH": "length"},
    "parting": {"RE": "nose_radius", "tool_grooveWidth": "width", "LH": "length"},
    "threading": {"thread-tip-radius": "nose_radius", "TPX": "pitch", "TP": "pitch"},
}
_UNITS = {"millimeters": "mm", "mm": "mm", "inches": "in", "in": "in"}
_MEMBER = "tools.json"
_MOST_TOOLS = 10_000
_SAME_SIZE_MM = 0.05  # more than the difference between 1/64 in and 0.4 mm


def unpack(name: str, data: bytes, max_bytes: int) -> bytes:
    """Return the JSON text of a library, which may be packed in a ``.tools`` archive.

    Raises ToolTableError if the archive is damaged, does not contain a library or is too large.
    """
    if not data.startswith(b"PK"):
        return data
    with (
        convert_exceptions(partial(_damaged, name)),
        zipfile.ZipFile(io.BytesIO(data)) as archive,
        archive.open(_MEMBER) as member,
    ):
        content = member.read(max_bytes + 1)
    if len(content) > max_bytes:
        text = Message(
            "{name} contains more than 16 MB, so it is not a tool table; check the name", name=name
        )
        raise ToolTableError(text, "too-large")
    return content


def _damaged(name: str, error: Exception) -> ToolTableError:
    text = Message(
        "{name} is not an archive that contains {member} ({error}); export the library again",
        name=name,
        member=_MEMBER,
        error=str(error)[:80],
    )
    return ToolTableError(text, "damaged-archive")


def read_tools(table: TableReader, text: str) -> None:
    """Add the tools of a library to ``table``."""
    library = parse_object(table, "file", text)
    if library is None:
        return
    tools = library.values.get("data")
    if not isinstance(tools, list) or len(tools) > _MOST_TOOLS:
        message = Message(
            'the file has no list "data" with up to {most} tools; export it from Fusion', most=_MOST_TOOLS
        )
        table.add_mistake("file", "no-tool-list", message)
        return
    for count, each in enumerate(tools, start=1):
        position = Message("tool {count}", count=count)
        if isinstance(each, dict):
            _read_tool(table, JsonFields(table, position, each))
        else:
            table.add_mistake(
                position, "not-an-object", "the tool is not a JSON object; export the file again"
            )


def _read_tool(table: TableReader, tool: JsonFields) -> None:
    """Add one tool to the table, or a note if it is a holder without a tool."""
    kind_name, remark = tool.get_text("type").strip().lower(), tool.get_text("description")
    if kind_name == "holder":
        table.notes.append(Message("not imported: holder {name}", name=remark[:40] or "?"))
        return
    mistakes = len(table.mistakes)
    number = _read_number(table, tool)
    if number is None or len(table.mistakes) > mistakes:
        return
    kind = _KINDS.get(kind_name.replace(" ", "_"), "")
    if not kind:
        text = Message("kind {name} is not supported; only the remark is imported", name=repr(kind_name[:40]))
        table.add_tool(number, tool.position_text, {"remark": remark}, "", [text])
        return
    if kind == "grooving" and recognize_tool_kind(remark) == "parting":
        kind = "parting"
    values, notes = _read_shape(tool, kind, _read_unit(table, tool))
    if len(table.mistakes) == mistakes:
        left = ["the tap is left-hand"] if kind_name.startswith("tap") and "left" in kind_name else []
        table.add_tool(number, tool.position_text, {**values, "remark": remark}, "", [*left, *notes])


def _read_number(table: TableReader, tool: JsonFields) -> int | None:
    """Return the tool number, or None if an option excludes the tool or its number is invalid."""
    settings = tool.get_fields("post-process")
    if settings.values.get("number") is None:
        tool.add_mistake("post-process", "no-number", "the tool has no number; add it in Fusion")
        return None
    mistakes = len(table.mistakes)
    number = settings.get_number("number")
    return table.check_tool_number(tool.position_text, number if len(table.mistakes) == mistakes else None)


def _read_unit(table: TableReader, tool: JsonFields) -> float:
    """Return the size of the tool's length unit in mm; a unit in the file overrides the option."""
    unit = tool.get_text("unit").strip().lower()
    if not unit:
        return table.get_unit_mm(tool.position_text)
    if unit not in _UNITS:
        text = Message("{text} is not a unit; use millimeters or inches", text=repr(unit[:40]))
        tool.add_mistake("unit", "unknown-unit", text)
    return MM_PER_UNIT[_UNITS.get(unit, "mm")]


def _read_shape(tool: JsonFields, kind: str, factor: float) -> tuple[dict[str, FieldValue], list[str]]:
    """Return the shape fields of a tool by name, and notes about values that are not imported."""
    geometry, holder = tool.get_fields("geometry"), tool.get_fields("holder")
    values: dict[str, FieldValue] = {"kind": kind}
    for key, name in _LENGTHS[kind].items():
        values[name] = values.get(name) or geometry.get_number(key) * factor
    notes: list[str] = []
    if kind in ROUND_KINDS:
        values["flutes"] = int(geometry.get_number("NOF"))
        if kind != "tap":
            values["point"] = geometry.get_number("SIG")
    elif geometry.get_text("SC") or holder.values:
        notes = _read_insert_and_holder(tool, geometry, holder, values, factor)
    if kind == "threading":
        values["point"] = geometry.get_number("thread-profile-angle")
    if kind in ROUND_KINDS:
        return values, [*notes, *format_unused_keys(geometry)]
    return values, [*notes, *format_unused_keys(geometry, holder)]


def _read_insert_and_holder(
    tool: JsonFields, geometry: JsonFields, holder: JsonFields, values: dict[str, FieldValue], factor: float
) -> list[str]:
    """Add the codes of the insert and the holder to ``values``, and return notes about them."""
    shape = geometry.get_text("SC").strip().upper()
    clearance = geometry.get_number("RA")
    code = _read_insert_code(geometry, shape, clearance, factor)
    words = " ".join(
        (tool.get_text("description"), tool.get_text("product-id"), holder.get_text("description"))
    )
    recognized = recognize_shape_fields(words)
    notes = []
    if values["kind"] in {"turning", "boring"}:
        notes = _choose_insert(shape, code, recognized.get("insert", ""), values)
    height, width = holder.get_number("H") * factor, holder.get_number("W") * factor
    hand = get_tool_hand(holder.get_text("HAND"))
    style, clamping = holder.get_text("THSC").strip().upper(), holder.get_text("MTP").strip().upper()
    is_bar = values["kind"] == "boring" or geometry.get_flag("tool_internalThread")
    sizes = HolderSizes(
        clamping if len(clamping) == 1 and clamping in "CDMPSW" else "X",
        shape if shape in CORNER_ANGLES else "",
        style.split()[-1] if style and len(style.split()[-1]) == 1 else "",
        find_clearance_letter(clearance),
        hand[:1].upper(),
        height,
        width,
        is_bar,
    )
    values["holder"] = recognized.get("holder", "") or format_holder_code(sizes, code)
    values["hand"] = hand or recognized.get("hand", "")
    if is_bar:
        values["diameter"] = width
    if style and style not in {"CUSTOM", "STRAIGHT"} and not values["holder"]:
        notes.append(Message("not imported: holder style {style}", style=style[:40]))
    return notes


def _read_insert_code(geometry: JsonFields, shape: str, clearance: float, factor: float) -> str:
    """Return the ISO code of the insert with these dimensions, or an empty string if it has no code."""
    is_circle = geometry.get_text("SIZE_SPECIFICATION_MODE").strip().upper() in {"IC", ""}
    sizes = InsertSizes(
        shape,
        clearance,
        geometry.get_text("TC").strip().upper(),
        geometry.get_text("SCTY").strip().upper(),
        geometry.get_number("INSD") * factor,
        not is_circle,
        geometry.get_number("S") * factor,
        geometry.get_number("RE") * factor,
    )
    return format_insert_code(sizes)


def _choose_insert(shape: str, code: str, recognized: str, values: dict[str, FieldValue]) -> list[str]:
    """Set the insert in ``values`` to the recognized code or to the code of the sizes; return notes.

    ``recognized`` is the code in the descriptions of the tool, and ``code`` is the code of the sizes. The
    code of the sizes is used if no code was recognized or if the two codes contradict each other.
    """
    values["insert"] = recognized or code
    if not code and not recognized and shape:
        return [Message("insert {shape}: its sizes have no ISO code; enter the insert", shape=shape[:20])]
    if code and recognized and not _is_same_insert(code, recognized):
        values["insert"] = code
        text = "check the insert: {code} by its sizes, but {recognized} in the description"
        return [Message(text, code=code, recognized=recognized)]
    return []


def _is_same_insert(one_code: str, other_code: str) -> bool:
    """Return whether two insert codes are equal, apart from the rounding of sizes in inches."""
    one, other = decode_insert_code(one_code), decode_insert_code(other_code)
    sizes = ((one.inscribed_circle, other.inscribed_circle), (one.nose_radius, other.nose_radius))
    letters = (one.shape, one.clearance_angle) == (other.shape, other.clearance_angle)
    return letters and all(abs(a - b) <= _SAME_SIZE_MM for a, b in sizes)
