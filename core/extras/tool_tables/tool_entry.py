"""Reader that collects the tools and the mistakes in a tool table of another program.

Lengths are in mm with X as a radius, and angles are in degrees. Values use the field names of the offset
tables. All mistakes of a file are reported together in one error.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import NamedTuple

from core.extras.tool_tables.iso_code_recognition import ROUND_KINDS, recognize_shape_fields
from core.message import CodedError, Message
from core.part.insert_codes import InsertCodeError, decode_insert_code
from core.store.store_rows import (
    FIELDS_BY_KIND,
    MAX_REMARK_LENGTH,
    MM_PER_INCH,
    OFFSET_NUMBERS,
    FieldType,
    FieldValue,
    OffsetKind,
    RowField,
)

OFFSET_FIELDS = ("x", "z", "nose_radius", "quadrant", "remark")
TABLE_FIELDS: Mapping[str, RowField] = {
    **{name: FIELDS_BY_KIND[OffsetKind.TOOL][name] for name in OFFSET_FIELDS},
    **FIELDS_BY_KIND[OffsetKind.SHAPE],
}
"""Fields that a tool table can set. Wear and the master mark are never imported."""
DIAMETER_FIELD = "d"
"""Name of the pseudo field D.

It holds the nose diameter of a turning tool or the diameter of a rotating tool, in mm.
"""

MM_PER_UNIT = {"in": MM_PER_INCH, "mm": 1.0}
_MOST_SHOWN = 10  # mistakes in one error text
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d{1,3})?")
_LONGEST_NUMBER = 40
_SAME_RADIUS = 0.05  # mm, more than the rounding of an inch radius to tenths of a mm


class ToolTableError(CodedError):
    """An error raised if a table cannot be read.

    The message lists all mistakes with their positions and remedies.
    """


class TableReadingOptions(NamedTuple):
    """Options for reading a table, for values that the file itself does not specify.

    ``unit`` is a key of ``MM_PER_UNIT``, and ``x_meaning`` is "radius" or "diameter". ``columns`` contains
    the column names of a CSV file by field. ``default_tool_number`` is the tool number for a file that
    contains one tool without a number. Only the tools in ``selected_tool_numbers`` are read, or all tools
    if ``selected_tool_numbers`` is empty.
    """

    unit: str = ""
    x_meaning: str = ""
    columns: Mapping[str, str] = {}
    default_tool_number: int = 0
    selected_tool_numbers: frozenset[int] = frozenset()


@dataclass(frozen=True, slots=True)
class ToolEntry:
    """One tool of a table, with its position in the file and notes about values that are not imported."""

    tool_number: int
    file_position_text: str
    offset_values: Mapping[str, FieldValue]
    shape_values: Mapping[str, FieldValue]
    notes: tuple[str, ...] = ()


class ToolTable(NamedTuple):
    """The tools of a file by number, and notes about the file."""

    tools: Mapping[int, ToolEntry]
    notes: Sequence[str] = ()


@dataclass(slots=True)
class TableReader:
    """Collector of the tools and mistakes in a file; mistakes are reported under ``file_name``.

    ``folder`` is the folder of the file. If the file is a library, the files to which it refers are there.
    """

    file_name: str
    options: TableReadingOptions
    folder: Path = Path()
    tools: dict[int, ToolEntry] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    mistakes: list[CodedError] = field(default_factory=list)

    def add_mistake(self, place: str, code: str, text: str) -> None:
        """Report a mistake at this position in the file."""
        self.mistakes.append(CodedError(Message("{place}: {text}", place=place, text=text), code))

    def parse_number(self, place: str, text: str) -> float | None:
        """Return the number in a text, or None if the text is not a finite number.

        In that case, a mistake at the position ``place`` in the file is also reported.
        """
        words = text.strip()
        if len(words) <= _LONGEST_NUMBER and _NUMBER.fullmatch(words) and isfinite(value := float(words)):
            return value
        shown = words if len(words) <= _LONGEST_NUMBER else f"{words[:_LONGEST_NUMBER]}…"
        self.add_mistake(
            place, "not-a-number", Message("{text} is not a number; correct it", text=repr(shown))
        )
        return None

    def check_tool_number(self, place: str, value: float | None) -> int | None:
        """Return a valid tool number, or None if this tool must be skipped.

        A tool is skipped if the options exclude it. It is also skipped if its number is invalid or already
        used; a mistake is then added.
        """
        if value is None:
            return None
        whole = int(value) if value.is_integer() else None
        if whole in self.options.selected_tool_numbers or not self.options.selected_tool_numbers:
            if whole not in OFFSET_NUMBERS:
                text = Message(
                    "T{number} does not exist here; tool numbers are 1 to 32. Change the number, or use "
                    "--only to import only some tools",
                    number=f"{value:g}",
                )
                self.add_mistake(place, "unknown-number", text)
                return None
            if whole in self.tools:
                text = Message(
                    "T{number} is already in {earlier}; remove one of them",
                    number=whole,
                    earlier=self.tools[whole].file_position_text,
                )
                self.add_mistake(place, "tool-twice", text)
                return None
            return whole
        return None

    def get_unit_mm(self, place: str) -> float:
        """Return the size of the file's length unit in mm.

        If the unit is not specified, a mistake of the file is reported and the result is 1.
        """
        if self.options.unit:
            return MM_PER_UNIT[self.options.unit]
        known = {mistake.code for mistake in self.mistakes}
        if "unit-missing" not in known:
            self.add_mistake(
                place, "unit-missing", "the file does not specify its unit; add --unit in or --unit mm"
            )
        return 1.0

    def add_tool(
        self,
        number: int,
        place: str,
        values: Mapping[str, FieldValue],
        words: str = "",
        notes: Sequence[str] = (),
    ) -> None:
        """Add a tool to the table.

        ``words`` is a text in which ISO codes and tool kinds are recognized. The values 0 and "" mean not
        specified. If X and Z are both 0, the tool is not measured.
        """
        found: dict[str, FieldValue] = {**recognize_shape_fields(words), **_stated(values)}
        all_notes = [*notes, *_cleaned(found), *_unmeasured(values, found), *_diameter(found)]
        for name, value in found.items():
            self._check(place, name, value)
        all_notes += _radius_notes(found)
        offset = {name: value for name, value in found.items() if name in OFFSET_FIELDS}
        shape = {name: value for name, value in found.items() if name not in offset}
        if shape and not shape.get("kind"):
            all_notes.append(Message("not imported without a kind of tool: {names}", names=", ".join(shape)))
            shape = {}
        self.tools[number] = ToolEntry(number, place, offset, shape, tuple(all_notes))

    def _check(self, place: str, name: str, value: FieldValue) -> None:
        known = TABLE_FIELDS[name]
        if known.is_valid_value(value):
            return
        shown: FieldValue = value
        if known.field_type is FieldType.LENGTH and not isinstance(value, str):
            shown = Message("{inches} in", inches=f"{value / MM_PER_INCH:g}")
        text = Message(
            "{word} {value} is out of range; use {range}, and check the unit of the file",
            word=known.label,
            value=shown,
            range=known.range_text,
        )
        self.add_mistake(place, "out-of-range", text)

    def make_table(self) -> ToolTable:
        """Return the collected tools.

        Raises ToolTableError with all mistakes if there are any, or if the file has no tools.
        """
        if self.mistakes:
            raise self._error()
        if not self.tools:
            text = Message("{name} has no tools to import; check the file and --only", name=self.file_name)
            raise ToolTableError(text, "no-tools")
        return ToolTable(dict(sorted(self.tools.items())), tuple(self.notes))

    def _error(self) -> ToolTableError:
        shown = "; ".join(str(each) for each in self.mistakes[:_MOST_SHOWN])
        if more := len(self.mistakes) - _MOST_SHOWN:
            shown += Message("; further mistakes: {count}", count=more) if more > 0 else ""
        codes = dict.fromkeys(each.code for each in self.mistakes)
        return ToolTableError(Message("{name}: {text}", name=self.file_name, text=shown), " ".join(codes))


def _stated(values: Mapping[str, FieldValue]) -> dict[str, FieldValue]:
    """Return the values that the file specifies: nonzero values, and X and Z even if 0."""
    return {name: value for name, value in values.items() if value or name in {"x", "z"}}


def _cleaned(found: dict[str, FieldValue]) -> list[str]:
    """Make the remark printable and limit its length; return a note if it is shortened."""
    text = found.get("remark")
    if not isinstance(text, str):
        return []
    plain = " ".join("".join(each if each.isprintable() else " " for each in text).split())
    found["remark"] = plain[:MAX_REMARK_LENGTH]
    if not plain:
        del found["remark"]
    return ["the remark is shortened to 40 characters"] if len(plain) > MAX_REMARK_LENGTH else []


def _unmeasured(values: Mapping[str, FieldValue], found: dict[str, FieldValue]) -> list[str]:
    """Remove X and Z if both are 0, because other programs write 0 for an unmeasured tool.

    Return a note if X and Z were specified.
    """
    if found.get("x", 0.0) or found.get("z", 0.0):
        return []
    found.pop("x", None)
    found.pop("z", None)
    return ["X and Z are 0, so the tool is not measured"] if {"x", "z"} <= values.keys() else []


def _diameter(found: dict[str, FieldValue]) -> list[str]:
    """Replace the pseudo field D with the diameter or nose radius that D means for this kind of tool.

    Return notes about the replacement.
    """
    if (value := found.pop(DIAMETER_FIELD, None)) is None or isinstance(value, str):
        return []
    if found.get("kind") in ROUND_KINDS:
        found.setdefault("diameter", value)
        return [Message("D is the diameter of the {kind}", kind=found["kind"])]
    found.setdefault("nose_radius", value / 2.0)
    return []


def _radius_notes(found: Mapping[str, FieldValue]) -> list[str]:
    """Return a note if the nose radius differs from the radius of the insert."""
    radius, code = found.get("nose_radius"), found.get("insert")
    if not isinstance(radius, float) or not isinstance(code, str):
        return []
    try:
        insert = decode_insert_code(code)
    except InsertCodeError:
        return []
    if not insert.corner_angles or abs(insert.nose_radius - radius) <= _SAME_RADIUS:
        return []
    return [
        Message(
            "check the nose radius: {radius} in the table, but {insert} in insert {code} (mm)",
            radius=f"{radius:.3f}",
            insert=f"{insert.nose_radius:.3f}",
            code=code,
        )
    ]
