"""Tool table of LinuxCNC: one tool per line, ``T3 P3 X1.5 Z-2 D.0315 I85 J25 Q2 ;CNMG431 rough``.

X is a radius. D is the nose diameter of a turning tool. The orientation Q is the position of the nose
center relative to the control point. X is reversed compared with the tip quadrant: Q2 is quadrant 3.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from core.extras.tool_tables.tool_entry import DIAMETER_FIELD, MM_PER_UNIT, TableReader, ToolEntry
from core.message import Message
from core.store.store_rows import FieldValue

QUADRANT_BY_ORIENTATION = {1: 4, 2: 3, 3: 2, 4: 1, 5: 5, 6: 8, 7: 7, 8: 6, 9: 9}
"""TurnDesk tip quadrant by the LinuxCNC tool orientation Q."""
ORIENTATION_BY_QUADRANT = {quadrant: orientation for orientation, quadrant in QUADRANT_BY_ORIENTATION.items()}

EXPORTED_FIELDS = frozenset(
    {"x", "z", "nose_radius", "quadrant", "remark", "diameter", "kind", "insert", "holder"}
)
"""Fields that a LinuxCNC table can contain; the kind, insert and holder are in the remark."""
_LENGTHS = {"X": "x", "Z": "z", "D": DIAMETER_FIELD}
_WORDS = frozenset("TPXYZABCUVWDIJQ")
_UNUSED = frozenset("YABCUVW")  # axes that the lathe does not have; P, I and J have no equivalent either
_WORD = re.compile(r"\S+")


def read_tools(table: TableReader, text: str) -> None:
    """Add the tools of a table to ``table``."""
    for count, line in enumerate(text.splitlines(), start=1):
        words, _, remark = line.partition(";")
        if words.strip():
            _read_line(table, count, words, remark.strip())


def _read_line(table: TableReader, count: int, line: str, remark: str) -> None:
    """Add the tool in one line to the table."""
    mistakes = len(table.mistakes)
    place = Message("line {line}", line=count)
    found = _words(table, count, line)
    if "T" not in found:
        if len(table.mistakes) == mistakes:
            table.add_mistake(place, "no-number", "the line has no tool number; add T1 to T32")
        return
    number = table.check_tool_number(place, found["T"])
    if number is None or len(table.mistakes) > mistakes:
        return
    factor = table.get_unit_mm(place) if any(found.get(letter) for letter in _LENGTHS) else 1.0
    values: dict[str, FieldValue] = {
        name: found[letter] * factor for letter, name in _LENGTHS.items() if letter in found
    }
    values[DIAMETER_FIELD] = abs(float(values.get(DIAMETER_FIELD, 0.0)))
    if (orientation := found.get("Q", 0.0)) not in {0.0, *QUADRANT_BY_ORIENTATION}:
        text = Message("Q{value} is not an orientation; use 0 to 9", value=f"{orientation:g}")
        table.add_mistake(place, "unknown-orientation", text)
        return
    values["quadrant"] = QUADRANT_BY_ORIENTATION.get(int(orientation), 0)
    values["remark"] = remark
    unused = sorted(letter for letter in _UNUSED & found.keys() if found[letter])
    notes = [Message("not imported: {words}", words=" ".join(unused))] if unused else []
    table.add_tool(number, place, values, remark, notes)


def _words(table: TableReader, count: int, line: str) -> dict[str, float]:
    """Return the numbers of a line by letter.

    Each invalid word is reported as a mistake with its line and column.
    """
    found: dict[str, float] = {}
    for match in _WORD.finditer(line):
        place = Message("line {line}, column {column}", line=count, column=match.start() + 1)
        letter = match[0][0].upper()
        if letter not in _WORDS:
            text = Message(
                "{word} is not a word of a LinuxCNC tool table; use T P X Z D I J Q, and start a remark "
                "with a semicolon",
                word=repr(match[0][:20]),
            )
            table.add_mistake(place, "unknown-word", text)
            continue
        if letter in found:
            text = Message("{letter} is on the line twice; remove one", letter=letter)
            table.add_mistake(place, "word-twice", text)
            continue
        value = table.parse_number(place, match[0][1:])
        if value is not None:
            found[letter] = value
    return found


def format_table(tools: Iterable[ToolEntry], unit: str) -> str:
    """Return the tools as a LinuxCNC table, with lengths in ``unit``."""
    return "".join(f"{line}\n" for line in _lines(tools, MM_PER_UNIT[unit]))


def _lines(tools: Iterable[ToolEntry], factor: float) -> Iterator[str]:
    for tool in tools:
        words = [f"T{tool.tool_number}", f"P{tool.tool_number}"]
        for letter, name in (("X", "x"), ("Z", "z")):
            if name in tool.offset_values:
                words.append(f"{letter}{float(tool.offset_values[name]) / factor:+.6f}")
        if diameter := get_tool_diameter_mm(tool):
            words.append(f"D{diameter / factor:.6f}")
        if quadrant := int(tool.offset_values.get("quadrant", 0)):
            words.append(f"Q{ORIENTATION_BY_QUADRANT[quadrant]}")
        if remark := make_tool_remark(tool):
            words.append(f";{remark}")
        yield " ".join(words)


def get_tool_diameter_mm(tool: ToolEntry) -> float:
    """Return the diameter of a rotating tool, or twice the nose radius of another tool, in mm.

    The result is 0 if the diameter is not specified.
    """
    from core.extras.tool_tables.iso_code_recognition import ROUND_KINDS  # noqa: PLC0415

    if tool.shape_values.get("kind") in ROUND_KINDS:
        return float(tool.shape_values.get("diameter", 0.0))
    return 2.0 * float(tool.offset_values.get("nose_radius", 0.0))


def make_tool_remark(tool: ToolEntry) -> str:
    """Return the remark of a tool, with its kind and ISO codes added if they are missing."""
    words = [str(tool.offset_values.get("remark", ""))]
    for name in ("insert", "holder", "kind"):
        value = str(tool.shape_values.get(name, ""))
        if value and value != "turning" and "," not in value and value.upper() not in " ".join(words).upper():
            words.append(value)
    return " ".join(word for word in words if word)
