"""Changes of the machine file since the operator accepted it. They prevent the drives from being enabled."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from app.desk.translation import tr
from core.machine.machine_file import KeyChange
from core.message import Message


@dataclass(slots=True)
class MachineFileChanges:
    """The changes of the machine file, empty if the file is as accepted.

    ``file_path`` is the file's path. ``save_acceptance`` stores the present file as accepted.
    """

    file_path: str = ""
    changes: Sequence[KeyChange] = field(default_factory=tuple)
    save_acceptance: Callable[[], None] = field(default=lambda: None)

    @property
    def barred(self) -> str:
        """The reason why the drives cannot be enabled. Empty if they can be."""
        if not self.changes:
            return ""
        text = tr("MACHINE FILE CHANGED ({count}). F10: REVIEW AND ACCEPT")
        return tr(Message(text, count=len(self.changes)))

    def accept_changes(self) -> None:
        """Accept the changes after the operator has read them."""
        self.save_acceptance()
        self.changes = ()
