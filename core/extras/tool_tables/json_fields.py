"""JSON objects of tool libraries, with typed access to their values and a list of unused keys."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from core.extras.tool_tables.tool_entry import TableReader
from core.message import Message

_MAX_TEXT_LENGTH = 400
_MOST_KEYS_SHOWN = 12


@dataclass(slots=True)
class JsonFields:
    """An object of a JSON file. Its position in the file is used in messages about mistakes.

    ``used_keys`` contains the keys that were read.
    """

    table: TableReader
    position_text: str
    values: Mapping[str, object]
    used_keys: set[str] = field(default_factory=set)

    def get_fields(self, key: str) -> JsonFields:
        """Return the object with this key, or an empty object if the key is missing."""
        value = self._get(key)
        if value is not None and not isinstance(value, dict):
            self.add_mistake(key, "not-an-object", Message("{key} is not a JSON object; correct it", key=key))
        position = Message("{place}, {key}", place=self.position_text, key=key)
        return JsonFields(self.table, position, value if isinstance(value, dict) else {})

    def get_text(self, key: str) -> str:
        """Return the text with this key, or an empty string if the key is missing or is not a text."""
        value = self._get(key)
        return value[:_MAX_TEXT_LENGTH] if isinstance(value, str) else ""

    def get_flag(self, key: str, *, default: bool = False) -> bool:
        """Return the truth value with this key, or ``default`` if the key is missing or has another type."""
        value = self._get(key)
        return value if isinstance(value, bool) else default

    def get_number(self, key: str) -> float:
        """Return the number with this key, or 0 if the key is missing.

        If the value is not a finite number, a mistake of the file is reported and the result is 0.
        """
        value = self._get(key)
        if value is None or value == "":
            return 0.0
        if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e9:
            return float(value)
        if isinstance(value, str):
            return (
                self.table.parse_number(Message("{place}, {key}", place=self.position_text, key=key), value)
                or 0.0
            )
        shown = repr(value)[:40]
        self.add_mistake(key, "not-a-number", Message("{text} is not a number; correct it", text=shown))
        return 0.0

    def add_mistake(self, key: str, code: str, text: str) -> None:
        """Report a mistake in the value of a key."""
        self.table.add_mistake(Message("{place}, {key}", place=self.position_text, key=key), code, text)

    def list_unused_keys(self) -> Iterator[str]:
        """Yield the keys that were not read and that have a value other than 0, false or empty."""
        return (key[:40] for key, value in self.values.items() if value and key not in self.used_keys)

    def _get(self, key: str) -> object:
        self.used_keys.add(key)
        return self.values.get(key)


def format_unused_keys(*fields: JsonFields) -> list[str]:
    """Return a note that names the unused keys of the objects, or an empty list if all were used."""
    keys = [key for each in fields for key in each.list_unused_keys()]
    if not keys:
        return []
    more = len(keys) - _MOST_KEYS_SHOWN
    names = ", ".join(keys[:_MOST_KEYS_SHOWN]) + (f" (+{more})" if more > 0 else "")
    return [Message("not imported: {words}", words=names)]


def parse_object(table: TableReader, position: str, text: str) -> JsonFields | None:
    """Return the object that a JSON text contains.

    If the text is not a JSON object, a mistake of the file is reported and the result is None.
    """
    try:
        value: object = json.loads(text)
    except json.JSONDecodeError as error:
        where = Message("{place}, line {line}", place=position, line=error.lineno)
        table.add_mistake(
            where, "not-json", Message("not valid JSON ({error}); export the file again", error=error.msg)
        )
        return None
    except (ValueError, RecursionError):
        table.add_mistake(position, "not-json", "not valid JSON; export the file again")
        return None
    if isinstance(value, dict):
        return JsonFields(table, position, value)
    table.add_mistake(
        position, "not-an-object", "the file is not a JSON object; check the format with --from"
    )
    return None
