"""The table of keys and their functions, shared by the screen and its tests.

Bare arrow keys have no function on the Automatic page, because they move axes on the Jog page.
"""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeyEvent

Key = Qt.Key
CTRL = Qt.KeyboardModifier.ControlModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier
NONE = Qt.KeyboardModifier.NoModifier

PALMS = {Key.Key_F11: "left", Key.Key_F12: "right"}

# Name of a key with these modifiers. Keypad and Shift are distinguished only where necessary.
NAMES: dict[tuple[int, Qt.KeyboardModifier], str] = {
    **{(Key(Key.Key_F1 + n), NONE): f"F{n + 1}" for n in range(10)},
    (Key.Key_S, NONE): "S",
    (Key.Key_O, NONE): "O",
    (Key.Key_Slash, NONE): "/",
    (Key.Key_C, NONE): "C",
    (Key.Key_P, NONE): "P",
    (Key.Key_G, NONE): "G",
    (Key.Key_B, NONE): "B",
    (Key.Key_U, NONE): "U",
    (Key.Key_R, NONE): "R",
    (Key.Key_D, NONE): "D",
    (Key.Key_A, NONE): "A",
    (Key.Key_Comma, NONE): ",",
    (Key.Key_Period, NONE): ".",
    (Key.Key_Plus, NONE): "+",
    (Key.Key_Minus, NONE): "-",
    (Key.Key_T, NONE): "T",
    (Key.Key_Y, NONE): "Y",
    (Key.Key_Escape, NONE): "Esc",
    (Key.Key_Z, NONE): "Zoom in",
    (Key.Key_Z, SHIFT): "Zoom out",
    (Key.Key_M, NONE): "Measure",
    (Key.Key_V, NONE): "View",
    (Key.Key_J, NONE): "Step back",
    (Key.Key_K, NONE): "Play",
    (Key.Key_K, SHIFT): "Play fast",
    (Key.Key_L, NONE): "Step forward",
    (Key.Key_N, NONE): "To line",
    (Key.Key_W, NONE): "W",
    (Key.Key_Left, CTRL): "Pan left",
    (Key.Key_Right, CTRL): "Pan right",
    (Key.Key_Up, CTRL): "Pan up",
    (Key.Key_Down, CTRL): "Pan down",
    (Key.Key_PageUp, NONE): "Page up",
    (Key.Key_PageDown, NONE): "Page down",
    (Key.Key_Home, NONE): "Follow",
    (Key.Key_F10, SHIFT): "Scope",
    (Key.Key_F1, SHIFT): "Codes",
    (Key.Key_F3, SHIFT): "Shapes",
    (Key.Key_F4, SHIFT): "Calculators",
    (Key.Key_F6, SHIFT): "Shift+F6",
    (Key.Key_Q, NONE): "Q",
    (Key.Key_X, NONE): "X",
}
OF_MENU = {"J": "Step back"}
"""Letters of the main menu that are called otherwise, by what they do where a part is played."""
REPEATING = frozenset(
    {"+", "-", ",", ".", "Zoom in", "Zoom out", "Page up", "Page down"}
    | {"Pan left", "Pan right", "Pan up", "Pan down", "Step back", "Step forward"}
)
# Stop keys work with any modifier.
_STOPS = {Key.Key_H: "H", Key.Key_Space: "H", Key.Key_E: "E"}
STOP_LETTERS = frozenset(_STOPS.values())
NO = "No"  # N while a question is open, and its touch target. It only closes the question.
OF_AUTOMATIC = frozenset({"A", "C", "O", "P", "S", "/"})
"""Keys that change how a cycle runs: keys of the Automatic page alone."""
ANSWER = "Yes"  # The key that means yes, and its touch target on the prompt line.
# Signs that need Shift on some keyboards and not on others.
_SIGNS = {Key.Key_Slash, Key.Key_Plus, Key.Key_Minus, Key.Key_Comma, Key.Key_Period}


def name_of(key: int, modifiers: Qt.KeyboardModifier) -> str:
    """Return the name of a pressed key. Empty if the key has no function."""
    held = modifiers & (CTRL | SHIFT | Qt.KeyboardModifier.AltModifier | Qt.KeyboardModifier.MetaModifier)
    if key in _STOPS:
        return _STOPS[Key(key)]
    if key in _SIGNS:
        held &= ~SHIFT
    return NAMES.get((key, held), "")


_TYPED = {
    Key.Key_Return: "Enter",
    Key.Key_Enter: "Enter",
    Key.Key_Backspace: "Back",
    Key.Key_Delete: "Delete",
    Key.Key_Tab: "Tab",
    Key.Key_Up: "Up",
    Key.Key_Down: "Down",
    Key.Key_Left: "Left",
    Key.Key_Right: "Right",
    Key.Key_PageUp: "Page up",
    Key.Key_PageDown: "Page down",
}
# These keys may repeat while they are held down.
TYPED_AGAIN = frozenset({"Back", "Up", "Down", "Left", "Right", "Page up", "Page down"})


def typed_of(event: QKeyEvent) -> str:
    """Return a key as text input: one character, or the name of an editing key. Empty for any other key."""
    held = event.modifiers() & (CTRL | Qt.KeyboardModifier.AltModifier | Qt.KeyboardModifier.MetaModifier)
    if held:
        return ""
    name = _TYPED.get(Key(event.key()), "")
    text = event.text()
    return name or (text if len(text) == 1 and text.isprintable() else "")
