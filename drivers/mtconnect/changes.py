"""What has been told, so that only what has changed is told again."""

from __future__ import annotations

from collections.abc import Iterator

from drivers.mtconnect.items import Category, DataItem
from drivers.mtconnect.lines import (
    UNAVAILABLE,
    Active,
    Report,
    Value,
    active_line,
    cleared_line,
    shown,
    unknown_line,
    values_line,
)

Conditions = dict[str, tuple[Active, ...] | None]  # None: not known


class Told:
    """The state of the machine as every agent that is connected has it."""

    def __init__(self, items: tuple[DataItem, ...]) -> None:
        self._values = {item.key: item for item in items if item.category is not Category.CONDITION}
        self._conditions: Conditions = {
            item.key: None for item in items if item.category is Category.CONDITION
        }
        self._last: dict[str, Value] = dict.fromkeys(self._values)
        self._shown = dict.fromkeys(self._values, UNAVAILABLE)

    def whole(self, at: str) -> str:
        """Everything, for an agent that has just come."""
        lines = [values_line(at, self._shown)]
        for key, active in self._conditions.items():
            lines += _whole_condition(at, key, active)
        return "".join(lines)

    def changes(self, report: Report, at: str) -> str:
        """What is new in a report; it counts as told from now on."""
        new = dict(self._new_values(report))
        lines = [values_line(at, new)] if new else []
        for key, before in self._conditions.items():
            now = report.conditions.get(key)
            if now != before:
                lines += _changed_condition(at, key, before, now)
                self._conditions[key] = now
        return "".join(lines)

    def _new_values(self, report: Report) -> Iterator[tuple[str, str]]:
        for key, item in self._values.items():
            value = report.values.get(key)
            if not _differs(item, self._last[key], value):
                continue
            self._last[key] = value
            text = shown(item, value)
            if text != self._shown[key]:
                self._shown[key] = text
                yield key, text


def _differs(item: DataItem, before: Value, now: Value) -> bool:
    """A sample by more than its band; standing still and everything else at once."""
    if isinstance(before, str) or isinstance(now, str) or before is None or now is None:
        return before != now
    if now == 0.0 or before == 0.0:
        return now != before
    return abs(now - before) > item.band + item.share * abs(before)


def _whole_condition(at: str, key: str, active: tuple[Active, ...] | None) -> list[str]:
    if active is None:
        return [unknown_line(at, key)]
    return [active_line(at, key, each) for each in active] or [cleared_line(at, key)]


def _changed_condition(
    at: str, key: str, before: tuple[Active, ...] | None, now: tuple[Active, ...] | None
) -> list[str]:
    """New and changed ones first, then those that are over."""
    if not now or before is None:
        return _whole_condition(at, key, now)
    codes = {each.code for each in now}
    lines = [active_line(at, key, each) for each in now if each not in before]
    return lines + [cleared_line(at, key, each.code) for each in before if each.code not in codes]
