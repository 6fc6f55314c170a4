"""Changes of the machine file since it was accepted: what differs, and that no drive goes on before."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from app.desk.translation import tr
from core.machine.machine_file import Change
from core.message import Message


@dataclass(slots=True)
class FileChanges:
    """``source`` is the file; ``keep`` remembers it as it is now. No changes: it is as it was accepted."""

    source: str = ""
    changes: Sequence[Change] = field(default_factory=tuple)
    keep: Callable[[], None] = field(default=lambda: None)

    @property
    def barred(self) -> str:
        """Why the drives stay off; empty when they need not."""
        if not self.changes:
            return ""
        text = tr("MACHINE FILE CHANGED ({count}). F10: REVIEW AND ACCEPT")
        return tr(Message(text, count=len(self.changes)))

    def accept(self) -> None:
        """Somebody has read the changes and takes them."""
        self.keep()
        self.changes = ()
