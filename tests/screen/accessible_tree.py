"""What assistive technology sees of a window, and its press on what has a name."""

from __future__ import annotations

from collections.abc import Iterator

from PySide6.QtGui import QAccessible, QAccessibleInterface
from PySide6.QtWidgets import QWidget

NAME, DESCRIPTION = QAccessible.Text.Name, QAccessible.Text.Description


def tree(widget: QWidget) -> Iterator[QAccessibleInterface]:
    """A widget and everything visible in it."""
    for part in (widget, *widget.findChildren(QWidget)):
        if isinstance(part, QWidget) and part.isVisible():
            part.grab()  # as it is painted now
    yield from _under(QAccessible.queryAccessibleInterface(widget))


def _under(node: QAccessibleInterface) -> Iterator[QAccessibleInterface]:
    if node.state().invisible:
        return
    yield node
    for index in range(node.childCount()):
        yield from _under(node.child(index))


def named(widget: QWidget, name: str) -> QAccessibleInterface:
    """The one node whose name begins so. Raises ValueError where there is none, or more than one."""
    found = [node for node in tree(widget) if node.text(NAME).startswith(name)]
    if len(found) != 1:
        raise ValueError(f"{len(found)} nodes are named {name}")
    return found[0]


def press(node: QAccessibleInterface) -> None:
    """As a screen reader presses it."""
    node.actionInterface().doAction("Press")
