"""Changes of the machine file since the operator accepted it. They prevent the drives from being enabled."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from app.desk.translation import tr
from core.machine.machine_file import Change
from core.message import Message


@dataclass(slots=True)
class FileChanges:
    """The changes of the machine file, empty if the file is as accepted.

    ``source`` is the file's path. ``keep`` stores the present file as accepted.
    """

    source: str = ""
    changes: Sequence[Change] = field(default_factory=tuple)
    keep: Callable[[], None] = field(default=lambda: None)

    @property
    def barred(self) -> str:
        """The reason why the drives cannot be enabled. Empty if they can be."""
        if not self.changes:
            return ""
        text = tr("MACHINE FILE CHANGED ({count}). F10: REVIEW AND ACCEPT")
        return tr(Message(text, count=len(self.changes)))

    def accept(self) -> None:
        """Accept the changes after the operator has read them."""
        self.keep()
        self.changes = ()
