"""The table of keys and their functions, used by the screen and its tests.

Arrow keys without modifiers have no function on the Automatic page, because they move axes on the Jog page.
"""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication, QInputEvent, QKeyEvent, QMouseEvent

from app.desk.stop_keys.key_codes import LETTERS_BY_CODE
from app.desk.stop_keys.stop_records import TOUCH_CODE, make_button_code

Key = Qt.Key
CTRL_MODIFIER = Qt.KeyboardModifier.ControlModifier
SHIFT_MODIFIER = Qt.KeyboardModifier.ShiftModifier
NO_MODIFIER = Qt.KeyboardModifier.NoModifier

_BUTTON_NUMBERS = {
    Qt.MouseButton.LeftButton: 1,
    Qt.MouseButton.MiddleButton: 2,
    Qt.MouseButton.RightButton: 3,
}

HELP_KEY = "?"  # The key that shows the help, by its character, because its place depends on the layout.
SEARCH_KEY = "Search"  # Ctrl+F, and the search key that a list draws.
RELOAD_KEY = "Shift+F2"  # Loads the changed file of the loaded program again on the Automatic page.
MODIFIER_KEYS = frozenset(
    {Key.Key_Shift, Key.Key_Control, Key.Key_Alt, Key.Key_AltGr, Key.Key_Meta, Key.Key_Super_L}
    | {Key.Key_Super_R, Key.Key_CapsLock, Key.Key_NumLock, Key.Key_Mode_switch, Key.Key_Hyper_L}
)
PC_PLATFORMS = frozenset({"xcb", "wayland"})  # Platforms on which the scan code is an X key code.
PALM_BUTTON_KEYS = {Key.Key_F11: "left", Key.Key_F12: "right"}

# Name of a key with these modifiers. Keypad and Shift are distinguished only where necessary.
KEY_NAMES: dict[tuple[int, Qt.KeyboardModifier], str] = {
    **{(Key(Key.Key_F1 + n), NO_MODIFIER): f"F{n + 1}" for n in range(10)},
    (Key.Key_S, NO_MODIFIER): "S",
    (Key.Key_O, NO_MODIFIER): "O",
    (Key.Key_Slash, NO_MODIFIER): "/",
    (Key.Key_C, NO_MODIFIER): "C",
    (Key.Key_P, NO_MODIFIER): "P",
    (Key.Key_G, NO_MODIFIER): "G",
    (Key.Key_B, NO_MODIFIER): "B",
    (Key.Key_U, NO_MODIFIER): "U",
    (Key.Key_R, NO_MODIFIER): "R",
    (Key.Key_D, NO_MODIFIER): "D",
    (Key.Key_A, NO_MODIFIER): "A",
    (Key.Key_Comma, NO_MODIFIER): ",",
    (Key.Key_Period, NO_MODIFIER): ".",
    (Key.Key_Plus, NO_MODIFIER): "+",
    (Key.Key_Minus, NO_MODIFIER): "-",
    (Key.Key_T, NO_MODIFIER): "T",
    (Key.Key_Y, NO_MODIFIER): "Y",
    (Key.Key_Escape, NO_MODIFIER): "Esc",
    (Key.Key_Z, NO_MODIFIER): "Zoom in",
    (Key.Key_Z, SHIFT_MODIFIER): "Zoom out",
    (Key.Key_M, NO_MODIFIER): "Measure",
    (Key.Key_V, NO_MODIFIER): "View",
    (Key.Key_J, NO_MODIFIER): "Step back",
    (Key.Key_K, NO_MODIFIER): "Play",
    (Key.Key_K, SHIFT_MODIFIER): "Play fast",
    (Key.Key_L, NO_MODIFIER): "Step forward",
    (Key.Key_N, NO_MODIFIER): "To line",
    (Key.Key_W, NO_MODIFIER): "W",
    (Key.Key_Left, CTRL_MODIFIER): "Pan left",
    (Key.Key_Right, CTRL_MODIFIER): "Pan right",
    (Key.Key_Up, CTRL_MODIFIER): "Pan up",
    (Key.Key_Down, CTRL_MODIFIER): "Pan down",
    (Key.Key_PageUp, NO_MODIFIER): "Page up",
    (Key.Key_PageDown, NO_MODIFIER): "Page down",
    (Key.Key_F, CTRL_MODIFIER): SEARCH_KEY,
    (Key.Key_Home, NO_MODIFIER): "Follow",
    (Key.Key_End, NO_MODIFIER): "End",
    (Key.Key_F10, SHIFT_MODIFIER): "Scope",
    (Key.Key_F1, SHIFT_MODIFIER): "Codes",
    (Key.Key_F2, SHIFT_MODIFIER): RELOAD_KEY,
    (Key.Key_F3, SHIFT_MODIFIER): "Shapes",
    (Key.Key_F4, SHIFT_MODIFIER): "Calculators",
    (Key.Key_F6, SHIFT_MODIFIER): "Shift+F6",
    (Key.Key_Q, NO_MODIFIER): "Q",
    (Key.Key_X, NO_MODIFIER): "X",
    (Key.Key_X, SHIFT_MODIFIER): "Shift+X",
    (Key.Key_W, SHIFT_MODIFIER): "Shift+W",
}
PAGE_FUNCTION_KEYS = frozenset(
    {"F2", "F3", "F4", "F5", "F6", "F8", "F9", "F10", "Codes", RELOAD_KEY, "Shapes", "Calculators"}
)
"""Function keys of the pages. They close the list of alarms first, so that they do not act unseen."""
SEARCH_CLOSING_KEYS = PAGE_FUNCTION_KEYS | {"F1", "F7", "Shift+F6", "Scope", HELP_KEY}
"""Keys that close the search first, because they show something else or act on the selected row."""
ROW_ACTION_KEYS = PAGE_FUNCTION_KEYS | {"Scope"}
"""Keys that can act on the selected row, and that are refused while a search does not show this row."""
MENU_KEYS = {"J": "Step back"}
"""Letters of the main menu whose key is named after its function in the part playback, by letter."""
REPEATING_KEYS = frozenset(
    {"+", "-", ",", ".", "Zoom in", "Zoom out", "Page up", "Page down"}
    | {"Pan left", "Pan right", "Pan up", "Pan down", "Step back", "Step forward"}
)
# Stop keys work with any modifier.
_STOP_KEYS = {Key.Key_H: "H", Key.Key_Space: "H", Key.Key_E: "E"}
STOP_LETTERS = frozenset(_STOP_KEYS.values())
NO_KEY = "No"  # N while a question is open, and its touch target. It only closes the question.
AUTOMATIC_KEYS = frozenset({"A", "C", "O", "P", "S", "/"})
"""Keys that change how a cycle runs. They work only on the Automatic page."""
YES_KEY = "Yes"  # The key that means yes, and its touch target on the prompt line.
# Signs that need Shift on some keyboards and not on others.
_SIGN_KEYS = {Key.Key_Slash, Key.Key_Plus, Key.Key_Minus, Key.Key_Comma, Key.Key_Period}


def find_key_name(key: int, modifiers: Qt.KeyboardModifier) -> str:
    """Return the name of a pressed key, or an empty string if the key has no function."""
    held = modifiers & (
        CTRL_MODIFIER | SHIFT_MODIFIER | Qt.KeyboardModifier.AltModifier | Qt.KeyboardModifier.MetaModifier
    )
    if key in _STOP_KEYS:
        return _STOP_KEYS[Key(key)]
    if key in _SIGN_KEYS:
        held &= ~SHIFT_MODIFIER
    return KEY_NAMES.get((key, held), "")


_EDITING_KEYS = {
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
    Key.Key_Home: "Home",
    Key.Key_End: "End",
}
# These keys may repeat while they are held down.
REPEATED_WHEN_TYPED = frozenset({"Back", "Up", "Down", "Left", "Right", "Page up", "Page down"})


def find_typed_text(event: QKeyEvent) -> str:
    """Return the text input of a key event.

    This is one character, the name of an editing key, or an empty string for any other key.
    """
    held = event.modifiers() & (
        CTRL_MODIFIER | Qt.KeyboardModifier.AltModifier | Qt.KeyboardModifier.MetaModifier
    )
    if held:
        return ""
    name = _EDITING_KEYS.get(Key(event.key()), "")
    text = event.text()
    return name or (text if len(text) == 1 and text.isprintable() else "")


def find_letter(event: QKeyEvent) -> str:
    """Return the letter of a key in the current keyboard layout.

    If the layout has no Latin letters, return the letter at the same position of a PC keyboard.
    """
    key = event.key()
    if Key.Key_A <= key <= Key.Key_Z:
        return chr(key)
    foreign = key > 0x7F and not Key.Key_Escape <= key <= Key.Key_unknown
    code = event.nativeScanCode() if QGuiApplication.platformName() in PC_PLATFORMS else 0
    return LETTERS_BY_CODE.get(code, "") if foreign or key == 0 else ""


def find_key_code(event: QKeyEvent) -> int:
    """Return Qt's code of a key.

    In a layout without Latin letters, this is the code of the Latin letter at the same position.
    """
    letter = find_letter(event)
    return ord(letter) if letter else event.key()


def find_scan_code(event: QKeyEvent) -> int:
    """Return the scan code of a key, which does not depend on modifiers."""
    return event.nativeScanCode() or event.key()


def find_press_code(event: QInputEvent) -> int:
    """Return the code of a mouse press or touch for press numbers.

    Buttons other than the three of every mouse have the code of button 0.
    """
    if isinstance(event, QMouseEvent):
        return make_button_code(_BUTTON_NUMBERS.get(event.button(), 0))
    return TOUCH_CODE
