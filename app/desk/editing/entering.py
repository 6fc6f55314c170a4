"""Whether the editor may be entered now.

The control cancels the spindle-on command when its editor is entered, so that nobody writes beside a turning
chuck. No command of the executor does just that (Reset gives the program up as well), so entering is refused
until the spindle stands.
"""

from __future__ import annotations

from app.desk import prompts
from app.desk.editing import words
from app.desk.lamps import TURNING
from core.executor.snapshot import Snapshot

UNDER_WAY = prompts.MOVING | prompts.INTERRUPTED


def refusal(snapshot: Snapshot) -> str:
    """Why not, in the words of the prompt line; empty when the editor may be entered."""
    if snapshot.state in UNDER_WAY:
        return words.UNDER_WAY
    if snapshot.rpm_command:
        return words.SPINDLE_ON
    return words.COASTING if abs(snapshot.rpm_actual) > TURNING else ""
