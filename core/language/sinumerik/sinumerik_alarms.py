"""SINUMERIK alarms in the format of the control: number, channel, block, axis, message and remedy."""

from __future__ import annotations

from core.language.diagnostics import Diagnostic, refusal
from core.message import Message

SYNTAX = 12080
TWICE = 12010
ONE_GROUP = 12060
NESTING = 12640
NO_TARGET = 14080
NOT_DEFINED = 12550
UNKNOWN_G = 12470
FIRST_INDEX = 17020
OTHER_INDEX = 17030

CHANNEL = 1


def fault(
    line: int, column: int, code: int | str, block: str, text: str, hint: str, *, axis: str = ""
) -> Diagnostic:
    """Return an error with the control's alarm number as its code, or with a TurnDesk code in words."""
    where = Message("channel {channel} block {block}", channel=CHANNEL, block=block)
    where = Message("{place} axis {axis}", place=where, axis=axis) if axis else where
    if isinstance(code, int):
        return refusal(
            line,
            column,
            str(code),
            Message("Alarm {code}: {where}: {what}", code=code, where=where, what=text),
            hint,
        )
    return refusal(line, column, code, Message("{where}: {what}", where=where, what=text), hint)
