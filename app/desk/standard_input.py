"""Reading of standard input in place of a file, by the argument ``-``. Only one argument can use it."""

from __future__ import annotations

import sys

from app.desk.command_errors import CommandError
from core.message import Message

DASH = "-"
MOST_BYTES = 64 * 1024 * 1024  # Limit in bytes, because a pipe may never end.
_taken: dict[str, bytes] = {}


def nothing_taken() -> None:
    """Forget the input that was read. Call this at the beginning of a command."""
    _taken.clear()


def standard_input(what: str) -> bytes:
    """Return all bytes of standard input, up to one byte more than the limit.

    A second call with the same ``what`` returns the same bytes. Raises CommandError if standard input is
    closed or was read for another purpose.
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
