"""Changes of the machine file since the operator accepted it, which prevent enabling the drives."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from app.desk.translation import tr
from core.machine.machine_file import KeyChange
from core.message import Message


@dataclass(slots=True)
class MachineFileChanges:
    """Changes of the machine file since it was last accepted. The list is empty if there are none.

    ``file_path`` is the path of the machine file. ``save_acceptance`` stores the current file as accepted.
    """

    file_path: str = ""
    changes: Sequence[KeyChange] = field(default_factory=tuple)
    save_acceptance: Callable[[], None] = field(default=lambda: None)

    @property
    def barred(self) -> str:
        """Return the reason why the drives cannot be enabled, or an empty string if they can be enabled."""
        if not self.changes:
            return ""
        text = tr("MACHINE FILE CHANGED ({count}). F10: REVIEW AND ACCEPT")
        return tr(Message(text, count=len(self.changes)))

    def accept_changes(self) -> None:
        """Accept the changes that the operator has reviewed."""
        self.save_acceptance()
        self.changes = ()
