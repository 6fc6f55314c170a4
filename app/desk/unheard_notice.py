"""The row that says of what nothing is heard any more: its wire is lost, the machine may go on without it."""

from __future__ import annotations

from app.desk.interrupted_notice import NoticeRow
from app.desk.translation import tr
from core.executor.snapshot import Snapshot
from core.message import Message
from core.ports import Unknown


def unheard_notice(snapshot: Snapshot) -> NoticeRow | None:
    """Of what the snapshot does not know; None when it knows all."""
    unknown = snapshot.unknown
    if not unknown:
        return None
    named = {
        Unknown.SLIDES: tr("POSITIONS"),
        Unknown.SPINDLE: tr("SPINDLE"),
        Unknown.OUTPUTS: tr("OUTPUTS"),
        Unknown.INPUTS: tr("INPUTS"),
    }
    what = ", ".join(words for which, words in named.items() if which in unknown)
    head = tr(Message("{what} UNKNOWN: NO RESPONSE FROM THE MACHINE", what=what))
    if Unknown.SPINDLE in unknown:
        head = tr("SPINDLE UNKNOWN – SPINDLE MAY BE TURNING: PRESS E-STOP")
    below = tr(Message("UNKNOWN: {what} · LAST KNOWN VALUES ARE SHOWN", what=what))
    return NoticeRow(head, below, tone="alarm")
