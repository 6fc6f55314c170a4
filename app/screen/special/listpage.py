"""A page that comes up with a list at its left: the model decides what its keys do."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from PySide6.QtWidgets import QWidget

from app.desk import pages
from app.desk.special.sheet import Key
from app.screen.pages import Host, Page


class ListModel(Protocol):
    """What such a page asks of its model; ``escape`` is False where it stands on the list itself."""

    def typed(self, key: str) -> bool: ...

    def takes(self, key: str) -> bool: ...

    def prompt(self) -> str: ...

    def opened(self) -> None: ...

    def leave(self) -> None: ...

    def escape(self) -> bool: ...


class ListPage(Page):
    """Hands keys on, and goes from the list back to the Automatic page."""

    model: ListModel

    def __init__(self, host: Host, model: ListModel, parent: QWidget) -> None:
        super().__init__(host, parent)
        self.model = model

    def labels_of(self, own: Mapping[str, str], keys: Mapping[str, Key]) -> tuple[str, ...]:
        """The ten labels: those that every such page has, the page's ``own``, and the model's ``keys``."""
        named = {"F1": "MENU", "F7": "ALARMS", **own}
        named.update((name, key.label) for name, key in keys.items())
        return tuple(named.get(f"F{number}", "") for number in range(1, 11))

    def typed(self, key: str) -> bool:
        """To the list, or to what is open."""
        return self.model.typed(key)

    def takes(self, key: str) -> bool:
        """As the model says."""
        return self.model.takes(key)

    def prompt(self) -> str:
        """From the model."""
        return self.model.prompt()

    def opened(self) -> None:
        """With the list."""
        self.model.opened()

    def leave(self) -> bool:
        """Nothing stays half entered or half asked."""
        self.desk.clear()
        self.model.leave()
        return True

    def escape(self) -> bool:
        """One step back, and from the list to the Automatic page."""
        if not self.model.escape():
            self.host.go(pages.AUTOMATIC)
        return True
