"""Lines of SHDR as the reference agent reads them: ``time|key|value|key|value``; a condition stands alone.

Source of the rules: the C++ agent's tokenizer, token mapper and adapter. There is no escaping in them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from datetime import datetime
from typing import NamedTuple

from app.extras.mtconnect.driver.mtconnect_items import Category, DataItem

UNAVAILABLE = "UNAVAILABLE"
NORMAL = "NORMAL"
PING = b"* PING"
LONGEST = 256  # characters of a value; a block of a program may be any length
_CONTROL = re.compile(r"[\x00-\x1f\x7f-\x9f\ufffe\uffff]+")
_LONGEST_BEAT = 30 * 60 * 1000 - 1  # ms; the agent wants less than half an hour

Value = str | float | None  # None: not known


class Active(NamedTuple):
    """A condition that is not normal: ``level`` is WARNING or FAULT, ``code`` tells it from its like."""

    level: str
    code: str
    text: str


class Report(NamedTuple):
    """The machine at one instant: value of each sample and event, and what is active of each condition.

    A key that is missing is not known.
    """

    values: Mapping[str, Value]
    conditions: Mapping[str, tuple[Active, ...]]


def stamp(at: datetime) -> str:
    """UTC as the agent reads it, in milliseconds."""
    return at.isoformat(timespec="milliseconds").replace("+00:00", "Z")


def pong(heartbeat: float) -> bytes:
    """The answer to a PING; ``heartbeat`` in s. The agent takes whole ms from 1 to under half an hour."""
    return b"* PONG %d\n" % min(max(round(1000 * heartbeat), 1), _LONGEST_BEAT)


def text_of(item: DataItem, value: Value) -> str:
    """A value as text."""
    if value is None:
        return UNAVAILABLE
    if isinstance(value, str):
        return clean(value)
    return f"{round(value, item.digits) + 0.0:.{item.digits}f}"


def clean(text: str) -> str:
    """Text that stays one value: what the agent would take for a separator or a quotation is replaced.

    A quotation mark at the beginning and ``--multiline--`` anywhere would swallow what follows.
    """
    text = _CONTROL.sub(" ", text).replace("|", "/").replace("--multiline--", "- multiline -")
    text = text.encode("utf-8", "replace").decode("utf-8")[:LONGEST].strip()
    return "'" + text[1:] if text.startswith('"') else text


def values_line(at: str, pairs: Mapping[str, str]) -> str:
    """Samples and events of one instant."""
    return "|".join((at, *(part for pair in pairs.items() for part in pair))) + "\n"


def active_line(at: str, key: str, active: Active) -> str:
    """A condition becomes active, or its text changes; severity and qualifier are left empty."""
    return f"{at}|{key}|{active.level}|{clean(active.code)}|||{clean(active.text)}\n"


def cleared_line(at: str, key: str, code: str = "") -> str:
    """One code of a condition is over; without one the condition is normal."""
    return f"{at}|{key}|{NORMAL}|{clean(code)}|||\n"


def unknown_line(at: str, key: str) -> str:
    """Nobody knows how it stands with a condition."""
    return f"{at}|{key}|{UNAVAILABLE}||||\n"


# --- What has been told, so that only what has changed is told again.


Conditions = dict[str, tuple[Active, ...] | None]  # None: not known


class AgentsState:
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
            text = text_of(item, value)
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
