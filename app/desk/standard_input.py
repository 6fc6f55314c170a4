"""Reading of standard input for the argument ``-``, which is used in place of a file name.

Only one argument of a command can use standard input.
"""

from __future__ import annotations

import sys

from app.desk.command_errors import CommandError
from core.message import Message

STDIN_ARGUMENT = "-"
MAX_INPUT_BYTES = 64 * 1024 * 1024  # Limit in bytes, because a pipe may never end.
_read_inputs: dict[str, bytes] = {}


def reset_standard_input() -> None:
    """Discard the bytes that were read from standard input. Call this at the beginning of a command."""
    _read_inputs.clear()


def read_standard_input(description: str) -> bytes:
    """Return all bytes of standard input, up to one byte more than the limit.

    A second call with the same ``description`` returns the same bytes. Raises CommandError if standard
    input is closed or was already read with a different ``description``.
    """
    if description in _read_inputs:
        return _read_inputs[description]
    for other in _read_inputs:
        raise CommandError(
            Message(
                '"-" (stdin) is already used for the {other}; specify a file for the {what}',
                other=other,
                what=description,
            ),
            "stdin-taken",
        )
    if sys.stdin is None:
        raise CommandError(
            Message(
                "stdin is closed, so the {what} cannot be read from it; specify a file", what=description
            ),
            "stdin-closed",
        )
    _read_inputs[description] = sys.stdin.buffer.read(MAX_INPUT_BYTES + 1)
    return _read_inputs[description]
