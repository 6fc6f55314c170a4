"""Exit statuses, and the one exception that ends a command with a sentence."""

from __future__ import annotations

import sys

from core.coded_error import CodedError

EXIT_OK, EXIT_ERRORS, EXIT_USAGE = 0, 1, 2
EXIT_INTERRUPTED = 130  # what a shell tells of Ctrl+C


class CommandError(CodedError):
    """The command cannot go on: usage, unreadable file, bad machine file. Ends with status 2."""


def report_refusal(error: CodedError) -> int:
    """Print why the command cannot continue; return its exit status."""
    sys.stderr.write(f"turndesk: {error}\n")
    return EXIT_USAGE
