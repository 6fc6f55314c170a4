"""Alarms in the shape of this control: number, channel and block, axis, what is wrong, and what to do."""

from __future__ import annotations

from core.language.diagnostics import Diagnostic, refusal

SYNTAX = 12080
TWICE = 12010
ONE_GROUP = 12060

CHANNEL = 1


def alarm(
    line: int, column: int, number: int, block: str, text: str, hint: str, *, axis: str = ""
) -> Diagnostic:
    """An alarm of the control by its number, which is the diagnostic's code as well."""
    return refusal(line, column, str(number), f"Alarm {number}: {_place(block, axis)}: {text}", hint)


def refused(
    line: int, column: int, code: str, block: str, text: str, hint: str, *, axis: str = ""
) -> Diagnostic:
    """An error that has no number on the control: ours, with a word for a code."""
    return refusal(line, column, code, f"{_place(block, axis)}: {text}", hint)


def _place(block: str, axis: str) -> str:
    where = f"channel {CHANNEL} block {block}"
    return f"{where} axis {axis}" if axis else where
