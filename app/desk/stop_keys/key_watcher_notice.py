"""Messages to the operator about a key watcher that has ended."""

from __future__ import annotations

from app.desk.desk import Desk
from app.desk.translation import tr
from core.message import Message


def report_watcher_end(desk: Desk, exit_status: int, is_restarted: bool) -> None:
    """Log that the key watcher has ended, and warn the operator if it was not restarted.

    The exit status is 1 without libXi, and negative after a signal.
    """
    if is_restarted:
        words = "the key watcher ended (exit status {status}) and was restarted"
    else:
        words = (
            "the key watcher ended (exit status {status}): while the screen is blocked, stop keys act late. "
            "Install the package libxi6 if it is missing, then restart TurnDesk"
        )
        desk.show_warning(tr("STOP KEYS MAY ACT LATE: KEY WATCHER ENDED. RESTART TURNDESK"))
    desk.desk_control.report_event("warning", Message(words, status=exit_status))
