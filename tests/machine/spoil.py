"""Machine files with one thing wrong: written out again from their values, key by key."""

from __future__ import annotations

import copy
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

import resources
from app.compose.machine.driver_modules import load_all_drivers
from core.machine.driver_tables import list_driver_tables

SPEC = Path(__file__).parents[2].parent / "shared" / "spec" / "drivers.md"
Table = dict[str, object]
Place = tuple[str | int, ...]
_OF_FEATURES = {"mtconnect", "pendant", "status_page", "announce", "sharing"}


def spec_text() -> str:
    """The example of section 9, without the tables of optional features that are left out.

    Skips, saying so, where the specification is absent.
    """
    if not SPEC.exists():
        pytest.skip(f"the specification is not here: {SPEC}")
    section = SPEC.read_text(encoding="utf-8").partition("## 9. Machine file")[2]
    text = section.partition("```toml\n")[2].partition("```")[0]
    absent = "|".join(_OF_FEATURES - {table.path for table in list_driver_tables(load_all_drivers())})
    if not absent:
        return text
    return re.sub(rf"^\[({absent})\].*?(?=^\[|\Z)", "", text, flags=re.MULTILINE | re.DOTALL)


def sample(name: str) -> Table:
    """The values of a shipped file, or of the specification's example."""
    return tomllib.loads(spec_text() if name == "spec" else resources.read_machine_file(f"{name}.toml"))


def leaves(value: object, place: Place = ()) -> Iterator[tuple[Place, object]]:
    """Every value that is no table, with where it is; lists of numbers are values."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from leaves(inner, (*place, key))
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for number, inner in enumerate(value):
            yield from leaves(inner, (*place, number))
    else:
        yield place, value


def with_value(data: Table, place: Place, value: object) -> str:
    """The file's text with one value changed."""
    spoilt: Table = dict(data)
    inner: object = spoilt
    for step in place[:-1]:
        inner[step] = copy.copy(inner[step])  # type: ignore[index]
        inner = inner[step]  # type: ignore[index]
    inner[place[-1]] = value  # type: ignore[index]
    same, changed = _texts(data), place[0]
    return "".join(_line(key, part) if key == changed else same[key] for key, part in spoilt.items())


_WRITTEN: list[tuple[Table, dict[str, str]]] = []  # the file that was spoilt last, as it is


def _texts(data: Table) -> dict[str, str]:
    """Each table of a file as it is written; of the last file they are kept."""
    if not _WRITTEN or _WRITTEN[0][0] is not data:
        _WRITTEN[:] = [(data, {key: _line(key, part) for key, part in data.items()})]
    return _WRITTEN[0][1]


def _line(key: str, value: object) -> str:
    return f"{_key(key)} = {_toml(value)}\n"


def path_of(place: Place) -> str:
    """As a finding names it: list entries count from 1, addresses of objects stand in quotes."""
    steps = [str(step + 1) if isinstance(step, int) else step for step in place]
    quoted = steps[:2] == ["canopen", "sdo"] and len(steps) == 4
    return ".".join([*steps[:-1], f'"{steps[-1]}"' if quoted else steps[-1]])


def _key(key: str) -> str:
    return '"' + key + '"'


def _toml(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"').replace("\r", "\\r").replace("\n", "\\n")
        return f'"{escaped}"'
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_key(key)} = {_toml(part)}" for key, part in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_toml(part) for part in value) + "]"
    return str(value)
