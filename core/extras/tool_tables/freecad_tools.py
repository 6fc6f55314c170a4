"""Tool bits of FreeCAD: one tool in a ``.fctb`` file, or a ``.fctl`` library that names such files.

Both are JSON. Values are strings with a unit, such as ``"5.0000 mm"`` or ``"0.375 in"``. A number without a
unit is in mm. A library contains the tool numbers; a tool bit has no number.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

from core.extras.tool_tables.iso_code_recognition import ROUND_KINDS, recognize_shape_fields
from core.extras.tool_tables.json_fields import JsonFields, format_unused_keys, parse_object
from core.extras.tool_tables.tool_entry import TableReader
from core.input_file import BYTES_PER_MB, read_input_bytes
from core.message import Message
from core.store.store_rows import MM_PER_INCH, FieldValue

MAX_BIT_BYTES = BYTES_PER_MB
_MOST_TOOLS = 1000
_SHAPES: tuple[tuple[str, str], ...] = (
    *(("iso", "turning"), ("drill", "drill"), ("tapered", ""), ("taper", ""), ("tap", "tap")),
    *(("reamer", "reamer"), ("endmill", "end-mill"), ("ballend", "end-mill"), ("bullnose", "end-mill")),
    ("torus", "end-mill"),
)
"""Kind of tool by the beginning of the name of a FreeCAD shape; the first match applies."""
_LENGTHS: Mapping[str, str] = {
    **{"Diameter": "diameter", "CuttingEdgeLength": "length", "CuttingEdgeHeight": "length"},
    "Pitch": "pitch",
}
_RADII = ("TipRadius", "FlatRadius", "TorusRadius", "CornerRadius")
_QUANTITY = re.compile(r"\s*([-+]?[\d.,]+(?:[eE][-+]?\d+)?)\s*([^\s\d]*)\s*")
_UNITS_MM: Mapping[str, float] = {
    **{"": 1.0, "mm": 1.0, "cm": 10.0, "m": 1000.0, "um": 0.001, "µm": 0.001},
    **{"in": MM_PER_INCH, '"': MM_PER_INCH, "inch": MM_PER_INCH, "thou": MM_PER_INCH / 1000.0},
}
_ANGLE_UNITS = frozenset({"", "°", "deg"})


def read_tools(table: TableReader, text: str) -> None:
    """Add the tools of a library, or the only tool of a tool bit, to ``table``."""
    found = parse_object(table, "file", text)
    if found is None:
        return
    tools = found.values.get("tools")
    if isinstance(tools, list):
        _read_library(table, tools)
    elif "shape" in found.values or "shape-type" in found.values:
        _read_only_tool(table, found)
    else:
        text = 'the file has neither a list "tools" nor a shape; use a .fctl or .fctb file of FreeCAD'
        table.add_mistake("file", "no-tool-list", text)


def _read_library(table: TableReader, tools: list[object]) -> None:
    """Add the tools whose files a library names."""
    if len(tools) > _MOST_TOOLS:
        text = Message("the library has more than {most} tools; divide it", most=_MOST_TOOLS)
        table.add_mistake("file", "too-long", text)
        return
    for count, each in enumerate(tools, start=1):
        position = Message("tool {count}", count=count)
        if not isinstance(each, dict):
            table.add_mistake(
                position, "not-an-object", "the tool is not a JSON object; export the file again"
            )
            continue
        entry = JsonFields(table, position, each)
        mistakes, value = len(table.mistakes), entry.get_number("nr")
        number = table.check_tool_number(position, value if len(table.mistakes) == mistakes else None)
        if number is not None and (bit := _load_bit(table, entry)):
            _read_bit(table, number, bit)


def _load_bit(table: TableReader, entry: JsonFields) -> JsonFields | None:
    """Return the tool bit to which an entry of a library refers.

    If the file is neither in the folder of the library nor in the folder Bit next to it, a mistake of the
    library is reported and the result is None.
    """
    name = entry.get_text("path").replace("\\", "/")
    path = PurePosixPath(name)
    if path.suffix.lower() != ".fctb" or path.is_absolute() or ".." in path.parts:
        text = Message(
            "{text} is not the name of a .fctb file in the library's folder; correct it", text=repr(name[:80])
        )
        entry.add_mistake("path", "invalid-path", text)
        return None
    folders = (table.folder, table.folder.parent / "Bit")
    found = next((each / path for each in folders if (each / path).is_file()), folders[0] / path)
    try:
        data = read_input_bytes(Path(found), MAX_BIT_BYTES)
        return parse_object(table, str(path), data.decode("utf-8-sig"))
    except UnicodeDecodeError:
        entry.add_mistake("path", "not-utf8", Message("{name} is not UTF-8; save it with FreeCAD", name=path))
    except OSError as error:
        text = Message(
            "{name} cannot be read ({cause}); put it in the folder of the library or in the folder Bit "
            "next to it",
            name=path,
            cause=error.strerror or error,
        )
        entry.add_mistake("path", "missing-file", text)
    return None


def _read_only_tool(table: TableReader, bit: JsonFields) -> None:
    """Add the tool of a ``.fctb`` file, whose tool number is specified by the option --number."""
    if not table.options.default_tool_number:
        table.add_mistake("file", "no-number", "a tool bit has no tool number; add --number")
        return
    number = table.check_tool_number("file", float(table.options.default_tool_number))
    if number is not None:
        _read_bit(table, number, bit)


def _read_bit(table: TableReader, number: int, bit: JsonFields) -> None:
    """Add one tool bit to the table."""
    mistakes = len(table.mistakes)
    name = bit.get_text("name")
    shape = (bit.get_text("shape-type") or PurePosixPath(bit.get_text("shape")).stem).lower()
    kind = _find_kind(shape, bit.get_fields("attribute").get_text("subtype") or name)
    if not kind:
        text = Message("shape {name} is not supported; only the remark is imported", name=repr(shape[:40]))
        table.add_tool(number, bit.position_text, {"remark": name}, "", [text])
        return
    parameters = bit.get_fields("parameter")
    values = _read_parameters(parameters, kind)
    notes = format_unused_keys(parameters)
    found = recognize_shape_fields(name)
    if kind not in ROUND_KINDS:
        kind = found.get("kind", kind) if found.get("kind") not in ROUND_KINDS else kind
        values.update({key: value for key, value in found.items() if key != "kind"})
        if "insert" not in found:
            notes.append(
                Message("the name {name} contains no valid ISO code; enter the insert", name=repr(name[:40]))
            )
    if len(table.mistakes) == mistakes:
        table.add_tool(number, bit.position_text, {**values, "kind": kind, "remark": name}, "", notes)


def _find_kind(shape: str, subtype: str) -> str:
    """Return the kind of tool for a FreeCAD shape, or an empty string if the shape is not supported."""
    kind = next((kind for prefix, kind in _SHAPES if shape.startswith(prefix)), "")
    is_center = kind == "drill" and re.search(r"\bcent(?:er|re)\b", subtype.replace("_", " "), re.IGNORECASE)
    return "centre-drill" if is_center else kind


def _read_parameters(parameters: JsonFields, kind: str) -> dict[str, FieldValue]:
    """Return the shape fields that the parameters of a tool bit specify, in mm and degrees."""
    values: dict[str, FieldValue] = {}
    if kind in ROUND_KINDS:
        for key, name in _LENGTHS.items():
            values[name] = _read_quantity(parameters, key, _UNITS_MM) or values.get(name, 0.0)
        values["flutes"] = int(_read_quantity(parameters, "Flutes", {"": 1.0}))
        if kind in {"drill", "centre-drill"}:
            values["point"] = _read_quantity(parameters, "TipAngle", dict.fromkeys(_ANGLE_UNITS, 1.0))
        if threads := _read_quantity(parameters, "TPI", {"": 1.0}):
            values["pitch"] = values["pitch"] or MM_PER_INCH / threads
    if kind not in ROUND_KINDS or kind == "end-mill":
        radii = [_read_quantity(parameters, key, _UNITS_MM) for key in _RADII if key in parameters.values]
        values["nose_radius"] = next(filter(None, radii), 0.0)
    return values


def _read_quantity(parameters: JsonFields, key: str, units: Mapping[str, float]) -> float:
    """Return a quantity in mm or degrees, or a plain number; 0 if the value is missing or invalid."""
    value = parameters.values.get(key)
    if not isinstance(value, str):
        return parameters.get_number(key)
    parameters.get_text(key)
    match = _QUANTITY.fullmatch(value)
    if match is None or match[2].lower() not in units:
        text = Message("{text} is not a number with a known unit; correct it", text=repr(value[:40]))
        parameters.add_mistake(key, "not-a-number", text)
        return 0.0
    digits = match[1].replace(",", ".") if match[1].count(",") == 1 and "." not in match[1] else match[1]
    place = Message("{place}, {key}", place=parameters.position_text, key=key)
    return (parameters.table.parse_number(place, digits) or 0.0) * units[match[2].lower()]
