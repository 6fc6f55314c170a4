"""The offsets file: [tool.1] x z nose_radius, [secondary.1] x z r, in inches; also part of an export."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from app.cli.toml_file import read_toml, refuse, unknown
from core.interpreter.setup import SecondaryOffset, ToolOffset
from core.store.rows import MM_PER_INCH, OFFSETS, RADIUS_MAX, SECONDARY_REACH, TOOL_REACH

# Keys with their ranges in mm.
KEYS = {
    "tool": {
        "x": (-TOOL_REACH, TOOL_REACH),
        "z": (-TOOL_REACH, TOOL_REACH),
        "nose_radius": (0.0, RADIUS_MAX),
    },
    "secondary": {
        "x": (-SECONDARY_REACH, SECONDARY_REACH),
        "z": (-SECONDARY_REACH, SECONDARY_REACH),
        "r": (0.0, RADIUS_MAX),
    },
}
_NUMBERS = {str(number): number for number in OFFSETS}


def read_offsets(path: Path) -> tuple[dict[int, ToolOffset], dict[int, SecondaryOffset]]:
    """Tool and secondary offsets in mm by number; a missing key is 0.

    Raises CommandError naming every mistake.
    """
    data = read_toml(path)
    mistakes = [unknown(key, KEYS) for key in data if key not in KEYS]
    tools = {n: ToolOffset(**values) for n, values in _table(data, "tool", mistakes)}
    secondary = {n: SecondaryOffset(**values) for n, values in _table(data, "secondary", mistakes)}
    refuse(path, mistakes)
    return tools, secondary


def _table(data: dict[str, object], kind: str, mistakes: list[str]) -> Iterator[tuple[int, dict[str, float]]]:
    table = data.get(kind, {})
    if not isinstance(table, dict):
        mistakes.append(f"{kind} must hold tables such as [{kind}.1]")
        return
    for name, entry in table.items():
        if name not in _NUMBERS:
            mistakes.append(f"[{kind}.{name}] does not exist; offsets are 1…32")
        elif not isinstance(entry, dict):
            mistakes.append(f"{kind}.{name} must be a table, [{kind}.{name}]")
        else:
            yield _NUMBERS[name], _values(entry, kind, name, mistakes)


def _values(entry: dict[str, object], kind: str, name: str, mistakes: list[str]) -> dict[str, float]:
    known, values = KEYS[kind], {}
    for key, value in entry.items():
        where = f"{kind}.{name}.{key}"
        if key not in known:
            mistakes.append(f"[{kind}.{name}] {unknown(key, known)}")
        elif isinstance(value, bool) or not isinstance(value, int | float):
            mistakes.append(f"{where} must be a number of inches")
        elif mistake := out_of_range(kind, key, value):
            mistakes.append(f"{where} = {value:g} {mistake}")
        else:
            values[key] = value * MM_PER_INCH
    return values


def out_of_range(kind: str, key: str, value: float) -> str:
    """What is wrong with an offset of ``value`` inches, or nothing; NaN is out of every range."""
    low, high = (limit / MM_PER_INCH for limit in KEYS[kind][key])
    return "" if low - 1e-9 <= value <= high + 1e-9 else f"is out of range; expected {low:g}…{high:g} in"
