"""What the prompt line says on the SEARCHTO page."""

from __future__ import annotations

from app.desk.searchto.stage import Stage
from app.desk.words import tr
from core.executor.snapshot import Snapshot


def prompt(stage: Stage, snapshot: Snapshot, trouble: str, start: str, *, out: bool = False) -> str:
    """``start`` names what starts a cycle here; ``trouble`` keeps the plan from being started; ``out``: it is
    the way out of the part alone."""
    if out and stage is Stage.SHOWN and not trouble:
        return tr("LOOK AT THE WAY OUT OF THE PART; F10 CONFIRMS IT")
    if out and stage is Stage.READY:
        return tr("TO TAKE THE TOOL OUT OF THE PART {start}; ESC TAKES IT BACK").format(start=start)
    words = {
        Stage.SEARCHING: tr("GOING THROUGH THE PROGRAM; ESC GIVES UP"),
        Stage.PROVING: tr("PROVING THE RESTART; ESC GIVES UP"),
        Stage.SHOWN: trouble or tr("COMPARE; LOOK AT THE WAY AND AT WHAT WILL START; F10 CONFIRMS"),
        Stage.REFUSED: tr("NO START FROM THIS LINE: F8 OR F9 GOES TO THE NEAREST GOOD ONE"),
        Stage.READY: tr("TO START THE RESTART {start}; ESC TAKES IT BACK").format(start=start),
    }
    return words.get(stage) or _choose(snapshot)


def _choose(snapshot: Snapshot) -> str:
    if not snapshot.interrupted_line:
        return tr("TYPE A LINE NUMBER OR A TEXT, OR CHOOSE BY THE ARROWS; ENTER REBUILDS THE STATE")
    words = tr(
        "LINE {line} WAS RUNNING WHEN THE PROGRAM BROKE OFF; ENTER REBUILDS ITS STATE, F4 ONLY LEADS OUT"
    )
    return words.format(line=snapshot.interrupted_line)
