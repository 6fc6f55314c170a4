"""How a command reports the error that ends it, or that ends it for one of its files."""

from __future__ import annotations

import sys

from app.desk.command_errors import EXIT_USAGE
from core.coded_error import CodedError


def refused(error: CodedError) -> int:
    """Print why the command cannot continue; return its exit status."""
    sys.stderr.write(f"turndesk: {error}\n")
    return EXIT_USAGE
