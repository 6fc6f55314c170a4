"""Recognize a program that was written for another control, by forms that OmniTurn programs do not have."""

from __future__ import annotations

import re
from collections.abc import Sequence

from core.language.diagnostics import Diagnostic, Severity
from core.message import Message

_COMMENT = re.compile(r"\([^)]*\)?")
_MOST_LINES = 400  # a program shows on its first lines for which control it was written

_ONLY = (
    ("LinuxCNC", re.compile(r"O<|O\d+(?:SUB|CALL|IF|WHILE|REPEAT)|#<|G64P|G[78](?![0-9])")),
    ("Mach", re.compile(r"G9[01]\.1|M1030")),
    ("Haas", re.compile(r"G154|G187|G103|M97P[0-9]{2,}|G53G0*X0")),
)
"""One of these forms is enough."""

_FANUC = (
    re.compile(r"^[O:][0-9]{1,8}$"),
    re.compile(r"^N[0-9]+"),
    re.compile(r"G50S"),
    re.compile(r"G28[UWXZ]"),
    re.compile(r"T[0-9]{4}(?![0-9])"),
    re.compile(r"G9[89](?![0-9])"),
    re.compile(r"G7[0-3].*[UWPQ]|G76P[0-9]{6}"),
    re.compile(r"#[0-9]+|\["),
    re.compile(r"G[0-3](?![0-9])"),
)
"""Forms of the Fanuc language; one alone may be a slip."""


def recognize(lines: Sequence[str]) -> Diagnostic | None:
    """Return one warning that names the control a program was written for; None for an OmniTurn program."""
    codes = [_COMMENT.sub("", line).replace(" ", "").upper() for line in lines[:_MOST_LINES]]
    control = next((name for name, form in _ONLY if any(map(form.search, codes))), "")
    if not control and sum(any(map(form.search, codes)) for form in _FANUC) > 1:
        control = "Fanuc"
    if not control:
        return None
    message = Message(
        "This program was written for a {control} control. TurnDesk runs OmniTurn programs.", control=control
    )
    hint = "Rewrite the program with the codes of this control; each message below names the code to use."
    return Diagnostic(1, 0, Severity.WARNING, "other-control-program", message, hint)
