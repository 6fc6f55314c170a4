"""Modes of the editor page and their prompts. The mode determines the meaning of the keys."""

from __future__ import annotations

from enum import StrEnum

from app.editor import editor_messages as messages


class EditorMode(StrEnum):
    """Mode of the editor page, which determines the meaning of the keys."""

    TEXT = "text"
    FIND = "find"
    LINE_NUMBER = "go to"
    NAME = "name"
    HISTORY = "history"
    NEW_FILE = "offer"
    CODES = "codes"  # the list of codes is open
    PATH = "look"  # the path has the keyboard, for measuring
    PANEL = "panel"  # a form of an optional feature writes the lines


ENTRY_MODES = frozenset({EditorMode.FIND, EditorMode.LINE_NUMBER, EditorMode.NAME})
MODE_PROMPTS = {
    EditorMode.FIND: messages.SEARCH_HINT,
    EditorMode.LINE_NUMBER: messages.LINE_NUMBER_HINT,
    EditorMode.HISTORY: messages.VERSION_LIST_HINT,
    EditorMode.CODES: messages.CODE_LIST_HINT,
}
"""Text of the prompt line in each editor mode when no other message is shown."""
