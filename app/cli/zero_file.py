"""Settable offsets in an offsets file: [zero.54] to [zero.59], x and z in mm (X a radius), c in degrees."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from pathlib import Path

from app.cli.toml_file import read_toml, refuse, unknown
from core.store.zero import CODES, FIELDS, ZeroRow, reach

TABLE = "zero"
_CODES = {str(code): code for code in CODES}


def read_zero(path: Path) -> dict[int, ZeroRow]:
    """Those that the file holds; a missing key is 0. Raises CommandError naming every mistake."""
    table, mistakes = read_toml(path).get(TABLE, {}), list[str]()
    found = dict(_rows(table, mistakes)) if isinstance(table, dict) else {}
    if not isinstance(table, dict):
        mistakes.append(f"{TABLE} must hold tables such as [{TABLE}.54]")
    refuse(path, mistakes)
    return found


def _rows(table: dict[str, object], mistakes: list[str]) -> Iterator[tuple[int, ZeroRow]]:
    for name, entry in table.items():
        if name not in _CODES:
            mistakes.append(f"[{TABLE}.{name}] does not exist; settable offsets are 54…59")
        elif not isinstance(entry, dict):
            mistakes.append(f"{TABLE}.{name} must be a table, [{TABLE}.{name}]")
        else:
            yield _CODES[name], ZeroRow(**_values(name, entry, mistakes))


def _values(name: str, entry: dict[str, object], mistakes: list[str]) -> dict[str, float]:
    values: dict[str, float] = {}
    for key, value in entry.items():
        where, unit = f"{TABLE}.{name}.{key}", "degrees" if key == "c" else "mm"
        if key not in FIELDS:
            mistakes.append(f"[{TABLE}.{name}] {unknown(key, FIELDS)}")
        elif isinstance(value, bool) or not isinstance(value, int | float):
            mistakes.append(f"{where} must be a number of {unit}")
        elif not (isfinite(value) and abs(value) <= reach(key)):
            mistakes.append(
                f"{where} = {value:g} is out of range; expected {-reach(key):g}…{reach(key):g} {unit}"
            )
        else:
            values[key] = float(value)
    return values
