"""Declarations of the keys in TurnDesk's JSON output, for the reference page and its tests."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from enum import Enum
from types import NoneType, UnionType
from typing import NamedTuple, get_args, get_origin, get_type_hints

_TYPES = {str: "string", int: "integer", float: "number", bool: "boolean", NoneType: "null"}


class JsonKey(NamedTuple):
    """A key of a JSON output.

    ``name`` is the path of the key: ``.`` leads into an object, ``[]`` leads into a list, and ``*`` matches
    any key. ``type`` is string, number, integer, boolean, object, list or null. Several types are joined by
    "or".
    """

    name: str
    type: str
    unit: str
    meaning: str


class JsonOutput(NamedTuple):
    """The output of one command with ``--json``."""

    command: str
    purpose: str
    keys: tuple[JsonKey, ...]


def declare_keys(text: str) -> tuple[JsonKey, ...]:
    """Return the keys declared by a text table with lines ``name | type | unit | meaning``.

    An indented line continues the line above.
    """
    return tuple(JsonKey(*_cells(line, 4)) for line in _lines(text))


def declare_row_keys(
    path: str, row_type: type[tuple[object, ...]] | type[object], text: str
) -> tuple[JsonKey, ...]:
    """Return the keys of a row type, as described by a text table, below the JSON path ``path``.

    The lines of ``text`` are ``name | unit | meaning``. Raises ValueError if ``text`` does not have exactly
    the fields of the type in the same order.
    """
    hints = get_type_hints(row_type)
    cells = {name: (unit, meaning) for name, unit, meaning in (_cells(line, 3) for line in _lines(text))}
    if list(cells) != list(hints):
        raise ValueError(f"{row_type.__name__} has the fields {', '.join(hints)}, not {', '.join(cells)}")
    return tuple(JsonKey(f"{path}{name}", find_json_type(hint), *cells[name]) for name, hint in hints.items())


def prefix_keys(path: str, keys: Collection[JsonKey]) -> tuple[JsonKey, ...]:
    """Return the keys with the prefix ``path`` added to their names."""
    return tuple(key._replace(name=f"{path}{key.name}") for key in keys)


def find_json_type(annotation: object) -> str:
    """Return the JSON type for a type annotation."""
    if get_origin(annotation) is UnionType:
        return " or ".join(find_json_type(each) for each in get_args(annotation))
    if annotation in _TYPES and isinstance(annotation, type):
        return _TYPES[annotation]
    if isinstance(annotation, type) and issubclass(annotation, Enum):
        return "string"
    if get_origin(annotation) in (tuple, list):
        return "list"
    return "object"


def find_keys(value: object, keys: Collection[JsonKey]) -> Iterator[tuple[str, object]]:
    """Yield the path and the value of every key in a JSON value, with each path in its declared form."""
    yield from _walk(value, "", _collect_paths(keys))


def find_parent_paths(keys: Collection[JsonKey]) -> frozenset[str]:
    """Return the paths of the objects that contain the declared keys."""
    return _collect_paths(keys) - {key.name for key in keys}


def has_declared_type(value: object, key: JsonKey) -> bool:
    """Return whether a JSON value has the declared type."""
    allowed = key.type.split(" or ")
    if isinstance(value, bool):
        return "boolean" in allowed
    if isinstance(value, int):
        return "integer" in allowed or "number" in allowed
    if isinstance(value, float):
        return "number" in allowed
    names = {str: "string", NoneType: "null", dict: "object", list: "list"}
    return names[type(value)] in allowed


def _walk(value: object, path: str, known: frozenset[str]) -> Iterator[tuple[str, object]]:
    if isinstance(value, list):
        for each in value:
            yield from _walk(each, f"{path}[]", known)
    elif isinstance(value, Mapping):
        for name, each in value.items():
            place = _joined(path, "*")
            place = place if place in known else _joined(path, name)
            yield place, each
            yield from _walk(each, place, known)


def _joined(path: str, name: str) -> str:
    return f"{path}.{name}" if path else name


def _collect_paths(declared: Collection[JsonKey]) -> frozenset[str]:
    """Return every declared path, and the paths of the objects that contain the declared keys."""
    known = set[str]()
    for key in declared:
        parts = key.name.split(".")
        known |= {".".join(parts[: n + 1]) for n in range(len(parts))}
    return frozenset(known | {path.removesuffix("[]") for path in known} - {""})


def _lines(text: str) -> list[str]:
    """Return the lines of a table; an indented line is joined to the line above."""
    lines: list[str] = []
    for line in filter(str.strip, text.splitlines()):
        if line.startswith(" "):
            lines[-1] += f" {line.strip()}"
        else:
            lines.append(line)
    return lines


def _cells(line: str, count: int) -> list[str]:
    cells = [cell.strip() for cell in line.split("|", count - 1)]
    if len(cells) != count or not cells[0] or not cells[-1]:
        raise ValueError(f"expected {count} cells: {line!r}")
    return cells
