"""Options that select tools and CSV columns, for the import and the export of tool tables."""

from __future__ import annotations

import re
from collections.abc import Iterable

from app.desk.command_errors import CommandError
from app.desk.toml_file import describe_unknown_key
from core.extras.tool_tables.csv_columns import FIELD_NAMES
from core.message import Message
from core.store.store_rows import OFFSET_NUMBERS

_ALIASES = {"t": "number", "tool": "number", "r": "nose_radius", "tip": "quadrant", "q": "quadrant"}


def parse_columns(entries: Iterable[str]) -> dict[str, str]:
    """Return the columns that the option ``--map`` specifies, by field.

    Raises CommandError if the option is invalid.
    """
    found: dict[str, str] = {}
    parts = [part for entry in entries for part in re.split(r",(?=\s*\w+\s*=)", entry)]
    for entry in parts:
        key, equals, column = entry.partition("=")
        name = key.strip().lower().replace("-", "_")
        field = _ALIASES.get(name, name)
        if not equals or not column.strip():
            text = Message("--map {entry} is incomplete; write FIELD=COLUMN, such as x=Dia", entry=entry)
            raise CommandError(text, "no-value")
        if field not in FIELD_NAMES:
            raise CommandError(
                Message("--map: {text}", text=describe_unknown_key(key.strip(), FIELD_NAMES)), "unknown-key"
            )
        if field in found:
            raise CommandError(Message("--map specifies {key} twice; remove one", key=field), "key-twice")
        found[field] = column.strip()
    return found


def parse_tool_numbers(text: str) -> frozenset[int]:
    """Return the tool numbers that the option ``--only`` specifies.

    Raises CommandError if the option is invalid.
    """
    found: set[int] = set()
    for part in filter(None, (each.strip() for each in text.split(","))):
        match = re.fullmatch(r"[Tt]?(\d{1,2})(?:\s*-\s*[Tt]?(\d{1,2}))?", part)
        first, last = (int(match[1]), int(match[2] or match[1])) if match else (0, 0)
        if first not in OFFSET_NUMBERS or last not in OFFSET_NUMBERS or first > last:
            message = Message(
                "--only {part} is not valid; use tool numbers 1 to 32, such as 1,3-6", part=part
            )
            raise CommandError(message, "unknown-number")
        found |= set(range(first, last + 1))
    return frozenset(found)
