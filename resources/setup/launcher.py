"""Package ``turndesk`` of a wheel; its folder contains the packages of the source code.

The build copies this file to ``turndesk/__init__.py``. Only the processes of TurnDesk can import the inner
packages, so that an installed TurnDesk does not occupy the names ``app``, ``core``, ``drivers`` and
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
