"""Accessible interfaces of the custom-painted screen parts, for assistive technology and tests.

Qt gives every standard widget a name and a role. A ``Panel`` paints its own texts and touch targets. This
module therefore provides an interface for the panel, and a child for each target.
"""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QObject, QPoint, QRect
from PySide6.QtGui import (
    QAccessible,
    QAccessibleActionInterface,
    QAccessibleAnnouncementEvent,
    QAccessibleInterface,
)
from PySide6.QtWidgets import QAccessibleWidget, QWidget
from shiboken6 import VoidPtr, isValid

from app.desk.translation import tr
from app.screen.panel import Panel, TouchTarget, ignore_press
from app.screen.text_area.accessible_text import AccessibleTextArea
from app.screen.text_area.text_area import TextArea

Role, Text = QAccessible.Role, QAccessible.Text
MaybeInterface = Any  # Or None, which Qt accepts although its type stubs do not.
_ROLES = {"key": Role.Button, "row": Role.ListItem, "lamp": Role.CheckBox, "slider": Role.Slider}


def register_accessibility() -> None:
    """Register the factory that creates the accessible interfaces of panels and pages."""
    QAccessible.installFactory(_make_interface)


def _make_interface(kind: str, shown: QObject) -> QAccessibleInterface | None:
    """Return the accessible interface of a plain QWidget or a text area, or None for all other classes.

    Qt has its own interfaces for the other classes.
    """
    if kind == TextArea.__name__ and isinstance(shown, TextArea):
        return AccessibleTextArea(shown)
    if kind != "QWidget" or not isinstance(shown, QWidget):
        return None
    return AccessiblePanel(shown) if isinstance(shown, Panel) else AccessibleContainer(shown)


def announce_text(widget: QWidget, text: str) -> None:
    """Make a screen reader speak a text that has appeared.

    Without a screen reader, this does nothing.
    """
    if QAccessible.isActive() and text:
        QAccessible.updateAccessibility(QAccessibleAnnouncementEvent(widget, text))


class AccessibleContainer(QAccessibleWidget):
    """Accessible interface of a page or another widget that contains panels.

    A contained widget without an ``accessible_name`` uses the name of its parent widget.
    """

    def __init__(self, widget: QWidget, role: QAccessible.Role = Role.Grouping) -> None:
        super().__init__(widget, role)
        self._part = widget

    def text(self, kind: QAccessible.Text) -> str:
        """Return the accessible name in the operator's language."""
        part: QWidget | None = self._part if kind is Text.Name else None
        while part is not None:
            name: str = getattr(part, "accessible_name", "") or part.accessibleName() or part.windowTitle()
            if name:
                return tr(name)
            part = part.parentWidget()
        return super().text(kind)


class AccessiblePanel(AccessibleContainer):
    """Accessible interface of a panel, whose children are the touch targets.

    Its name is the title of the panel, and its description is the other texts.
    """

    def __init__(self, panel: Panel) -> None:
        super().__init__(panel, Role.List if panel.is_list else Role.Grouping)
        self._panel = panel
        self._spots: dict[int, AccessibleTarget] = {}

    def text(self, kind: QAccessible.Text) -> str:
        """Return the title as the name, or all texts outside the targets as the description."""
        if kind is Text.Name:
            return self._panel.find_accessible_name() or super().text(kind)
        return self._panel.describe_content() if kind is Text.Description else super().text(kind)

    def childCount(self) -> int:
        """Return the number of child widgets and targets."""
        return super().childCount() + len(self._panel.list_targets())

    def child(self, index: int) -> MaybeInterface:
        """Return the child with this index.

        The child widgets precede the targets.
        """
        number = index - super().childCount()
        if number < 0:
            return super().child(index)
        if number >= len(self._panel.list_targets()):
            return None
        if number not in self._spots:
            self._spots[number] = AccessibleTarget(self._panel, number)
            QAccessible.registerAccessibleInterface(self._spots[number])
        return self._spots[number]

    def indexOfChild(self, child: QAccessibleInterface) -> int:
        """Return the index of a child, or -1 if it is not a child of the panel."""
        if isinstance(child, AccessibleTarget):
            return super().childCount() + child.target_index
        return super().indexOfChild(child)

    def childAt(self, x: int, y: int) -> MaybeInterface:
        """Return the child at a position on the screen, or None if there is no child."""
        for index in range(self.childCount()):
            child = self.child(index)
            if child is not None and child.rect().contains(x, y):
                return child
        return None


class _PressAction(QAccessibleActionInterface):
    """Accessible action that presses a target with the same effect as a touch."""

    def __init__(self, spot: AccessibleTarget) -> None:
        super().__init__()
        self._spot = spot

    def actionNames(self) -> list[str]:
        """Return the press action, or no action if the target can be dragged."""
        held = self._spot.isValid() and self._spot.target.on_press is ignore_press
        return [] if held else [QAccessibleActionInterface.pressAction()]

    def doAction(self, _name: str) -> None:
        """Press the target."""
        if self._spot.isValid():
            self._spot.target.on_press()

    def keyBindingsForAction(self, _name: str) -> list[str]:
        """Return no key bindings, because the label on the screen already contains the key."""
        return []


class AccessibleTarget(QAccessibleInterface):
    """Accessible interface of one touch target of a panel, identified by its index.

    The returned data always describes the target as it was last painted.
    """

    def __init__(self, panel: Panel, index: int) -> None:
        super().__init__()
        self._panel, self.target_index = panel, index
        self._press = _PressAction(self)

    @property
    def target(self) -> TouchTarget:
        """Return the target as it was last painted."""
        return self._panel.list_targets()[self.target_index]

    def isValid(self) -> bool:
        """Return whether the panel still shows a target with this index."""
        return isValid(self._panel) and self.target_index < len(self._panel.list_targets())

    def object(self) -> MaybeInterface:
        """Return None, because Qt expects a QObject here, and a touch target is not an object of Qt."""
        return None

    def parent(self) -> MaybeInterface:
        """Return the accessible interface of the panel."""
        return QAccessible.queryAccessibleInterface(self._panel) if isValid(self._panel) else None

    def child(self, _index: int) -> MaybeInterface:
        """Return None, because a target has no children."""
        return None

    def childAt(self, _x: int, _y: int) -> MaybeInterface:
        """Return None, because a target has no children."""
        return None

    def childCount(self) -> int:
        """Return 0, because a target has no children."""
        return 0

    def indexOfChild(self, _child: QAccessibleInterface) -> int:
        """Return -1, because a target has no children."""
        return -1

    def text(self, kind: QAccessible.Text) -> str:
        """Return the texts that are painted on the target."""
        return self._panel.describe_target(self.target) if kind is Text.Name and self.isValid() else ""

    def setText(self, _kind: QAccessible.Text, _text: str) -> None:
        """Do nothing, because the panel paints its own text."""

    def rect(self) -> QRect:
        """Return the rectangle of the target on the screen."""
        if not self.isValid():
            return QRect()
        return self.target.box.toRect().translated(self._panel.mapToGlobal(QPoint()))

    def role(self) -> QAccessible.Role:
        """Return the accessible role of the target."""
        return _ROLES[self.target.kind] if self.isValid() else Role.NoRole

    def state(self) -> QAccessible.State:
        """Return the state of the target: disabled, checked or selected."""
        state = QAccessible.State()
        if not self.isValid():
            state.invalid = True
            return state
        spot = self.target
        state.disabled, state.invisible = spot.is_disabled, not self._panel.isVisible()
        state.checkable = spot.kind == "lamp"
        state.checked = spot.is_on and spot.kind == "lamp"
        state.selectable = spot.kind == "row"
        state.selected = spot.is_on and spot.kind == "row"
        return state

    def actionInterface(self) -> QAccessibleActionInterface:
        """Return the action that presses the target."""
        return self._press

    def interface_cast(self, kind: QAccessible.InterfaceType) -> MaybeInterface:
        """Return the requested accessible interface, or a null pointer if it does not exist.

        Qt needs a null pointer, because it would treat None as the address of an interface.
        """
        return self._press if kind is QAccessible.InterfaceType.ActionInterface else VoidPtr(0)
