"""Lines of SHDR as the reference agent reads them: ``time|key|value|key|value``; a condition stands alone.

Source of the rules: the C++ agent's tokenizer, token mapper and adapter. There is no escaping in them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from datetime import datetime
from typing import NamedTuple

from drivers.mtconnect.items import DataItem

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


def shown(item: DataItem, value: Value) -> str:
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
