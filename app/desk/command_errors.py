"""Exit statuses, and the one exception that ends a command with a sentence."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager

from core.message import CodedError, Message, error_code

EXIT_OK, EXIT_ERRORS, EXIT_USAGE = 0, 1, 2
EXIT_INTERRUPTED = 130  # what a shell tells of Ctrl+C


class CommandError(CodedError):
    """The command cannot go on: usage, unreadable file, bad machine file. Ends with status 2."""


@contextmanager
def as_command_error(*kinds: type[Exception]) -> Iterator[None]:
    """Let errors of these types end the command with their sentence."""
    try:
        yield
    except kinds as error:
        raise CommandError(str(error), error_code(error)) from error


def cannot_write(file: object, error: OSError) -> CommandError:
    """Return the error for a file that the system does not let us write."""
    return CommandError(
        Message("{file} cannot be written: {cause}", file=file, cause=error.strerror), "cannot-write"
    )


def report_refusal(error: CodedError) -> int:
    """Print why the command cannot continue; return its exit status."""
    sys.stderr.write(f"turndesk: {error}\n")
    return EXIT_USAGE
