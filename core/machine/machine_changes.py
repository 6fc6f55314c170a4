"""What differs between two texts of a machine file, key by key; comments and order do not count."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from core.message import Message
from core.table_schema import joined, written_openly
from core.toml_text import toml_tables

ABSENT = "—"


class Change(NamedTuple):
    """One key: as it was, as it is; ``ABSENT`` where the file did not have it, or has it no more."""

    path: str
    old: str
    new: str

    def __str__(self) -> str:
        return Message("{path}: {old} → {new}", path=self.path, old=self.old, new=self.new)


def changes(old: str, new: str) -> tuple[Change, ...]:
    """Every key whose value differs, in the order of the new file, then those that are gone.

    Raises ValueError for a text that is no TOML.
    """
    before, after = dict(_leaves(toml_tables(old))), dict(_leaves(toml_tables(new)))
    places = [*after, *(place for place in before if place not in after)]
    return tuple(
        Change(place, _shown(before, place), _shown(after, place))
        for place in places
        if place not in before or place not in after or _differ(before[place], after[place])
    )


def _differ(old: object, new: object) -> bool:
    """1 and 1.0 are one number; true is none."""
    return old != new or isinstance(old, bool) is not isinstance(new, bool)


def _shown(values: Mapping[str, object], place: str) -> str:
    return written_openly(place, values[place]) if place in values else ABSENT


def _leaves(table: Mapping[str, object], path: str = "") -> Iterator[tuple[str, object]]:
    for key, value in table.items():
        place = joined(path, key)
        if isinstance(value, dict) and value:
            yield from _leaves(value, place)
        else:
            yield place, value
