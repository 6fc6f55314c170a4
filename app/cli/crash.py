"""What happens when TurnDesk itself is at fault: one line for the person, the traceback into a file."""

from __future__ import annotations

import sys
import tempfile
import traceback
from pathlib import Path
from types import TracebackType


def report_crash(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """An excepthook: nobody at a machine can act on a traceback, but whoever mends it needs it."""
    where = _keep("".join(traceback.format_exception(kind, error, trace)))
    what = str(error).splitlines()[0] if str(error) else kind.__name__
    sys.stderr.write(f"turndesk: a fault in TurnDesk itself ({what}); please report it with {where}\n")


def _keep(text: str) -> str:
    path = Path(tempfile.gettempdir()) / "turndesk-crash.txt"
    try:
        path.write_text(text, encoding="utf-8")
    except OSError:
        return "what you were doing"
    return str(path)
