"""A change of the history in words."""

from __future__ import annotations

from datetime import datetime

from app.desk.offsets.entry import shown_value, word
from app.desk.offsets.figures import Mode, in_words
from app.desk.words import tr
from core.store.rows import Change, Row, ToolRow


def told(change: Change, letter: str, mode: Mode) -> tuple[str, str, str, str]:
    """Of one change: when (local time), which offset, from → to, why and by whom."""
    at = datetime.fromisoformat(change.at).astimezone().strftime("%Y-%m-%d %H:%M:%S")
    who = "" if change.who == "operator" else f" ({change.who})"
    return at, f"{letter}{change.number}", from_to(change.old, change.new, mode), f"{change.why}{who}"


def from_to(old: Row | None, new: Row | None, mode: Mode) -> str:
    """An offset before and after; of a tool that was and stays set only the fields that changed."""
    if isinstance(old, ToolRow) and isinstance(new, ToolRow):
        pairs = [
            f"{word(name)} {_shown(name, old, mode)} → {_shown(name, new, mode)}"
            for name in ToolRow._fields
            if getattr(old, name) != getattr(new, name)
        ]
        return "   ".join(pairs)
    return f"{in_words(old, mode)}  →  {in_words(new, mode)}"


def _shown(name: str, row: ToolRow, mode: Mode) -> str:
    if name == "master":
        return tr("yes") if row.master else tr("no")
    return shown_value(name, getattr(row, name), mode) or tr("none")
