"""Exit statuses of commands, and the exception that ends a command with an error message."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from core.message import CodedError, Message, get_error_code

EXIT_OK, EXIT_ERRORS, EXIT_USAGE = 0, 1, 2
EXIT_INTERRUPTED = 130  # Status that a shell reports for Ctrl+C.


class CommandError(CodedError):
    """Error that ends a command.

    Examples of causes are wrong usage, an unreadable file and an invalid machine file. The command exits
    with status 2.
    """


@contextmanager
def convert_to_command_error(*kinds: type[Exception]) -> Iterator[None]:
    """Convert exceptions of these types inside the block to CommandError with the same text."""
    try:
        yield
    except kinds as error:
        raise CommandError(str(error), get_error_code(error)) from error


def make_write_error(file: object, error: OSError) -> CommandError:
    """Return the error for a file that cannot be written because of an error of the operating system."""
    return CommandError(
        Message("{file} cannot be written: {cause}", file=file, cause=error.strerror), "cannot-write"
    )


def report_command_error(error: CodedError) -> int:
    """Print the reason why the command cannot continue, and return its exit status."""
    sys.stderr.write(f"turndesk: {error}\n")
    return EXIT_USAGE
