"""Standard input, ``-`` where a file is named: what comes in there is one thing, for one argument."""

from __future__ import annotations

import sys

from app.desk.command_errors import CommandError
from core.message import Message

DASH = "-"
MOST_BYTES = 64 * 1024 * 1024  # a program has no more, and a pipe may have no end
_taken: dict[str, bytes] = {}


def nothing_taken() -> None:
    """A command begins."""
    _taken.clear()


def standard_input(what: str) -> bytes:
    """All that comes in, up to one byte more than anything may have; the same again for who asks again.

    Raises CommandError where it is closed, or was taken for something else.
    """
    if what in _taken:
        return _taken[what]
    for other in _taken:
        raise CommandError(
            Message(
                '"-" (stdin) is already used for the {other}; specify a file for the {what}',
                other=other,
                what=what,
            ),
            "stdin-taken",
        )
    if sys.stdin is None:
        raise CommandError(
            Message("stdin is closed, so the {what} cannot be read from it; specify a file", what=what),
            "stdin-closed",
        )
    _taken[what] = sys.stdin.buffer.read(MOST_BYTES + 1)
    return _taken[what]
