"""SINUMERIK alarms in the format of the control, with number, channel, block, axis, message and remedy."""

from __future__ import annotations

from core.language.diagnostics import Diagnostic, make_error_diagnostic
from core.message import Message

SYNTAX_ERROR = 12080
WORD_REPEATED = 12010
GROUP_CONFLICT = 12060
WRONG_NESTING = 12640
JUMP_TARGET_MISSING = 14080
NAME_NOT_DEFINED = 12550
UNKNOWN_G_FUNCTION = 12470
WRONG_FIRST_INDEX = 17020
WRONG_OTHER_INDEX = 17030

CHANNEL_NUMBER = 1


def make_alarm_diagnostic(
    line: int, column: int, code: int | str, block: str, text: str, hint: str, *, axis: str = ""
) -> Diagnostic:
    """Return an error whose code is the control's alarm number or a TurnDesk code in words."""
    where = Message("channel {channel} block {block}", channel=CHANNEL_NUMBER, block=block)
    where = Message("{place} axis {axis}", place=where, axis=axis) if axis else where
    if isinstance(code, int):
        return make_error_diagnostic(
            line,
            column,
            str(code),
            Message("Alarm {code}: {where}: {what}", code=code, where=where, what=text),
            hint,
        )
    return make_error_diagnostic(line, column, code, Message("{where}: {what}", where=where, what=text), hint)
