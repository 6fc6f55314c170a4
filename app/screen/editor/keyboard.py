"""What keys mean in the editor besides writing and the function keys."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent

from app.screen.editor.doings import Mode

if TYPE_CHECKING:
    from app.screen.editor.page import EditorPage

Key = Qt.Key
Actions = dict[int, Callable[[], None]]
ASKING = frozenset({Mode.FIND, Mode.GO_TO, Mode.NAME})


def action_of(page: EditorPage, event: QKeyEvent) -> Callable[[], None] | None:
    """What a key does; None when it means nothing here."""
    if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
        return {**_chords(page), **_panning(page)}.get(event.key())
    if page.mode in ASKING:
        back = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        return _asking(page, back=back and page.mode is Mode.FIND).get(event.key())
    return _history(page).get(event.key()) if page.mode is Mode.HISTORY else None


def _chords(page: EditorPage) -> Actions:
    if page.mode is Mode.HISTORY:
        return {}
    return {
        Key.Key_S: page.save,
        Key.Key_F: page.ask_text,
        Key.Key_H: page.ask_text,
        Key.Key_G: page.ask_line,
        Key.Key_M: page.looking.begin,
    }


def _panning(page: EditorPage) -> Actions:
    """Ctrl with arrows moves the picture, where they do not move the cursor by words."""
    if page.mode is not Mode.LOOK:
        return {}
    ways = {Key.Key_Left: (-1, 0), Key.Key_Right: (1, 0), Key.Key_Up: (0, -1), Key.Key_Down: (0, 1)}
    return {key: partial(page.path.pan, *way) for key, way in ways.items()}


def _asking(page: EditorPage, *, back: bool) -> Actions:
    enter = (lambda: page.finder.step(-1)) if back else page.asking.take
    tab = page.ask.other_field
    return {Key.Key_Return: enter, Key.Key_Enter: enter, Key.Key_Tab: tab, Key.Key_Backtab: tab}


def _history(page: EditorPage) -> Actions:
    history, versions = page.history, page.versions
    return {
        Key.Key_Up: lambda: history.mark(history.marked - 1),
        Key.Key_Down: lambda: history.mark(history.marked + 1),
        Key.Key_PageUp: lambda: versions.look_at(-versions.lines),
        Key.Key_PageDown: lambda: versions.look_at(versions.lines),
        Key.Key_Return: page.restore,
        Key.Key_Enter: page.restore,
    }
