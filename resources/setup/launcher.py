"""TurnDesk, as a wheel installs it: one package whose folder contains the packages of the source code.

The build copies this file to ``turndesk/__init__.py``. The packages are found only by the processes of
TurnDesk, so that an installed TurnDesk does not claim the names ``app``, ``core``, ``drivers`` and
``resources`` in its environment.
"""

from __future__ import annotations

import os
import sys


def console() -> int:
    """Run the installed ``turndesk`` command."""
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    from app.cli.main import run_console as run  # noqa: PLC0415  found only since the line above

    return run()
