"""What each function key does in the editor, by what is going on."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent

from app.editor import messages
from app.screen import page_table

if TYPE_CHECKING:
    from app.editor.editor_view import EditorPage


class Mode(StrEnum):
    """What the keys are for."""

    TEXT = "text"
    FIND = "find"
    GO_TO = "go to"
    NAME = "name"
    HISTORY = "history"
    OFFER = "offer"
    LOOK = "look"  # at the path: the keyboard measures in it


class Doing(NamedTuple):
    """A label of up to eight characters and what the key does."""

    label: str
    act: Callable[[], None]


PROMPTS = {Mode.FIND: messages.FINDING, Mode.GO_TO: messages.GOING, Mode.HISTORY: messages.CHOOSING}
"""What the prompt line says while nothing else is to be said."""


def doings(page: EditorPage, mode: Mode) -> dict[int, Doing]:
    """The function keys that mean something now."""
    if mode is Mode.FIND:
        return _finding(page)
    if mode is Mode.HISTORY:
        return _history(page)
    if mode is Mode.LOOK:
        return _looking(page)
    if mode is Mode.OFFER:
        return {1: Doing("CREATE", page.editor.create), 10: Doing("ABORT", page.editor.abort)}
    if mode is Mode.TEXT:
        return _text(page)
    return {2: Doing("SAVE" if mode is Mode.NAME else "GO", page.asking.take), 10: Doing("BACK", page.back)}


def _text(page: EditorPage) -> dict[int, Doing]:
    asked = Doing("YES", page.answer) if page.editor.asked else Doing("NEXT ERR", page.next_finding)
    return {
        1: Doing("MENU", partial(page.leave_to, page_table.MENU)),
        2: Doing("SAVE", page.save),
        3: Doing("LEAVE", partial(page.leave_to, page_table.AUTOMATIC)),
        4: Doing("FIND", page.ask_text),
        5: Doing("GO TO", page.ask_line),
        6: asked,
        7: Doing("HISTORY", page.show_history),
        8: Doing("UNDO", page.field.undo),
        9: Doing("REDO", page.field.redo),
        10: Doing("NO SAVE", page.abandon),
    }


def _finding(page: EditorPage) -> dict[int, Doing]:
    finder = page.finder
    return {
        1: Doing("MENU", partial(page.leave_to, page_table.MENU)),
        2: Doing("NEXT", partial(finder.step, 1)),
        3: Doing("BEFORE", partial(finder.step, -1)),
        4: Doing("REPLACE", finder.replace),
        5: Doing("ALL", finder.replace_all),
        6: Doing("PARTS" if finder.whole else "WHOLE", finder.other_width),
        8: Doing("UNDO", page.field.undo),
        9: Doing("REDO", page.field.redo),
        10: Doing("BACK", page.back),
    }


def _history(page: EditorPage) -> dict[int, Doing]:
    history, versions = page.history, page.versions
    return {
        1: Doing("MENU", partial(page.leave_to, page_table.MENU)),
        2: Doing("RESTORE", page.restore),
        4: Doing("NEWER", lambda: history.mark(history.marked - 1)),
        5: Doing("OLDER", lambda: history.mark(history.marked + 1)),
        6: Doing("UP", lambda: versions.look_at(-versions.lines)),
        7: Doing("DOWN", lambda: versions.look_at(versions.lines)),
        10: Doing("BACK", page.back),
    }


def _looking(page: EditorPage) -> dict[int, Doing]:
    path = page.path
    return {
        1: Doing("MENU", partial(page.leave_to, page_table.MENU)),
        2: Doing("HOLD", page.looking.hold),
        3: Doing("TO LINE", page.looking.to_line),
        4: Doing("VIEW", path.next_view),
        5: Doing("FIT", path.fit),
        6: Doing("NEARER", partial(path.zoom, 1)),
        7: Doing("FARTHER", partial(path.zoom, -1)),
        10: Doing("BACK", page.back),
    }


# --- What keys mean in the editor besides writing and the function keys.


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
    return _history_keyboard(page).get(event.key()) if page.mode is Mode.HISTORY else None


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


def _history_keyboard(page: EditorPage) -> Actions:
    history, versions = page.history, page.versions
    return {
        Key.Key_Up: lambda: history.mark(history.marked - 1),
        Key.Key_Down: lambda: history.mark(history.marked + 1),
        Key.Key_PageUp: lambda: versions.look_at(-versions.lines),
        Key.Key_PageDown: lambda: versions.look_at(versions.lines),
        Key.Key_Return: page.restore,
        Key.Key_Enter: page.restore,
    }
