"""Input fields with a prompt and the entered text, and touch keyboards for them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

from PySide6.QtCore import QEvent, QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QKeyEvent
from PySide6.QtWidgets import QApplication, QLineEdit, QWidget

from app.desk.pages.table_content import RejectedText
from app.desk.translation import tr
from app.screen.panel import Panel, RedrawingAttribute
from app.screen.screen_theme import ScreenTheme, ThemedPainter

KeyRows = Sequence[Sequence[str]]
NAME_KEYS: KeyRows = ("1234567890", "qwertyuiop", "asdfghjkl-", "zxcvbnm._ ", ("Esc", "Back", "Enter"))
WIDE_NAME_KEYS: KeyRows = (
    (*"1234567890", "Back"),
    (*"qwertyuiop", "Enter"),
    (*"asdfghjkl-", "Esc"),
    "zxcvbnm._ ",
)  # For the full width. One row fewer leaves more room for a list.
PROGRAM_KEYS: KeyRows = (
    (*"1234567890-.", "Back"),
    (*"QWERTYUIOP()", "Enter"),
    (*"ASDFGHJKL+/}", "Up"),
    (*"ZXCVBNM=~ ", "Left", "Right", "Down"),
)
LINE_KEYS: KeyRows = (
    "1234567890-.",
    "QWERTYUIOP()",
    "ASDFGHJKL+/}",
    "ZXCVBNM=~ ",
    ("Back", "Left", "Right", "Up", "Down", "Enter"),
)  # For MDI. The rows are short enough to fit next to the modal state.
_KEY_CODES = {
    "Back": Qt.Key.Key_Backspace,
    "Enter": Qt.Key.Key_Return,
    "Up": Qt.Key.Key_Up,
    "Down": Qt.Key.Key_Down,
    "Left": Qt.Key.Key_Left,
    "Right": Qt.Key.Key_Right,
}
_ARROW_SIGNS = {"Up": "↑", "Down": "↓", "Left": "←", "Right": "→"}


class LetterPad(Panel):
    """Touch keyboard whose keys act like those of a hardware keyboard.

    The keyboard is hidden at first.
    """

    accessible_name = "KEYBOARD"

    def __init__(
        self, theme: ScreenTheme, press: Callable[[str], None], parent: QWidget, key_rows: KeyRows = NAME_KEYS
    ) -> None:
        super().__init__(theme, parent)
        self._press, self._rows = press, key_rows
        self.hide()

    @property
    def min_height_px(self) -> int:
        """Return the height in pixels at which every key is large enough for a fingertip."""
        return self.theme.find_key_rows_height(len(self._rows))

    def set_target_field(self, text_field: QWidget) -> None:
        """Set the standard text field that keeps the focus when a key of the touch keyboard is pressed.

        Otherwise Qt would give the focus to the window.
        """
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setFocusProxy(text_field)

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the keys of the touch keyboard, which fill the width of each row."""
        gap = 0.5 * self.theme.unit_px
        high = (self.height() + gap) / len(self._rows)
        for row, keys in enumerate(self._rows):
            wide = (self.width() + gap) / len(keys)
            for column, key in enumerate(keys):
                self.draw_pad_key(painter, QRectF(column * wide, row * high, wide - gap, high - gap), key)

    def draw_pad_key(self, painter: ThemedPainter, box: QRectF, key: str) -> None:
        """Draw one key."""
        words = {"Esc": "ESC", "Back": tr("DEL"), "Enter": tr("ENTER"), " ": tr("SPACE"), **_ARROW_SIGNS}
        shown = words.get(key, key)
        ink = "text" if key.isalnum() and len(key) == 1 else "accent"
        self.key(painter, box, shown, 2.8, partial(self._press, key), color=ink, is_raw=True, margin=0.4)


def send_key(key: str, widget: QWidget) -> None:
    """Send the press and release of a key of ``PROGRAM_KEYS`` to a widget, like a real key."""
    code = _KEY_CODES.get(key)
    text = "\r" if key == "Enter" else "" if code is not None else key
    number = code if code is not None else Qt.Key(ord(key))
    for kind in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
        QApplication.sendEvent(widget, QKeyEvent(kind, number, Qt.KeyboardModifier.NoModifier, text))


@dataclass(frozen=True, slots=True)
class EntryTexts:
    """Texts of an entry panel: subject, prompt, input, change (old → new), and a hint about keys."""

    subject_text: str = ""
    question_text: str = ""
    text: str = ""
    change_description: str = ""
    footer_text: str = ""
    is_rejected: bool = field(init=False)  # The next character replaces the text.

    def __post_init__(self) -> None:
        object.__setattr__(self, "is_rejected", isinstance(self.text, RejectedText))


class EntryPanel(Panel):
    """Panel with one input field. It is redrawn when one of its texts changes."""

    background_color = "panel"
    entry_texts = RedrawingAttribute(EntryTexts())

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the subject, the change text, the input field and the footer."""
        u, asked = self.theme.unit_px, self.entry_texts
        room = self.find_full_area().adjusted(1.4 * u, 0.4 * u, -1.4 * u, -0.3 * u)
        painter.draw_text_line(
            QRectF(room.x(), room.y(), 27 * u, 3.2 * u), asked.subject_text, 1.9, "text", bold=False
        )
        left = 28 * u if asked.subject_text else 0.0
        change = QRectF(room.x() + left, room.y(), room.width() - left, 3.2 * u)
        painter.draw_text_line(change, asked.change_description, 2.0, "accent")
        self._ask(painter, QRectF(room.x(), room.y() + 3.5 * u, room.width(), 4.8 * u))
        room.setTop(room.bottom() - 3.0 * u)
        painter.draw_text_line(room, asked.footer_text, 1.8, "soft", bold=False)

    def _ask(self, painter: ThemedPainter, row: QRectF) -> None:
        u, asked = self.theme.unit_px, self.entry_texts
        painter.draw_text_line(
            QRectF(row.x(), row.y(), 36 * u, row.height()), asked.question_text, 2.4, "text"
        )
        if not asked.question_text:
            return
        box = row.adjusted(37 * u, 0.2 * u, 0, -0.2 * u)
        draw_entry_box(painter, box, asked.text)


def draw_entry_text(
    painter: ThemedPainter, area: QRectF, text: str, *, height_units: float = 2.8, has_cursor: bool = True
) -> None:
    """Draw an input text, ``height_units`` theme units high, with a caret.

    The caret is drawn if ``has_cursor`` is True and an input field of the page has the keyboard focus.
    While the field has the focus, a rejected text is drawn as selected, because the next character replaces
    it.
    """
    u, selected = painter.theme.unit_px, painter.theme.is_caret_shown and isinstance(text, RejectedText)
    painter.setFont(painter.theme.fit_font(text, height_units, area.width() - u, is_bold=True))
    wide = min(QFontMetricsF(painter.font()).horizontalAdvance(text), area.width() - u)
    high = (height_units + 0.2) * u
    if selected:
        painter.fill_rect(QRectF(area.x(), area.center().y() - high / 2, wide, high), "lit")
    painter.draw_text_line(area, text, height_units, "on_lit" if selected else "text", raw=True, margin=1.0)
    if has_cursor and painter.theme.is_caret_shown:
        _draw_caret(painter, area, wide, high)


def draw_text_with_caret(painter: ThemedPainter, area: QRectF, text: str, height_units: float) -> None:
    """Draw the text of an input field that always has the keyboard focus while it is visible."""
    u = painter.theme.unit_px
    painter.setFont(painter.theme.fit_font(text, height_units, area.width() - u, is_bold=True))
    wide = min(QFontMetricsF(painter.font()).horizontalAdvance(text), area.width() - u)
    painter.draw_text_line(area, text, height_units, "text", raw=True, margin=1.0)
    _draw_caret(painter, area, wide, (height_units + 0.2) * u)


def _draw_caret(painter: ThemedPainter, area: QRectF, left_px: float, height_px: float) -> None:
    u = painter.theme.unit_px
    at = area.x() + left_px + 0.3 * u
    painter.fill_rect(QRectF(at, area.center().y() - height_px / 2, 0.3 * u, height_px), "accent")


def draw_entry_box(painter: ThemedPainter, box: QRectF, text: str, size: float = 2.8) -> None:
    """Draw an input field with its frame and text."""
    painter.draw_box(box, "accent", 0.2, "ground")
    draw_entry_text(
        painter, box.adjusted(painter.theme.unit_px, 0, -painter.theme.unit_px, 0), text, height_units=size
    )


def style_line_edit(edit: QLineEdit, theme: ScreenTheme, size: float, left_padding: float) -> None:
    """Apply the current font and colors to a line edit.

    ``left_padding`` is the padding to the left of the text, in theme units.
    """
    u, colours = theme.unit_px, theme.palette
    edit.setFont(theme.make_font(size, is_bold=True))
    edit.setStyleSheet(
        f"QLineEdit {{ background: {colours.ground}; color: {colours.text};"
        f" border: {max(1, round(0.2 * u))}px solid {colours.accent}; padding-left: "
        f"{round(left_padding * u)}px;"
        f" selection-background-color: {colours.lit}; selection-color: {colours.on_lit}; }}"
    )


# --- number pad --------------------------------------------------------------------------------------------


_PAGE_KEY = "C"  # The key to which a page gives its own meaning.
_NUMBER_KEYS: KeyRows = ("789/", "456*", "123-", "0.(+", (_PAGE_KEY, "Esc", ")", "Back"), ("Enter",))
_KEY_LABELS = {"-": "−", "*": "×", "/": "÷", "Back": "DEL", "Enter": "ENTER"}


class NumberPad(LetterPad):
    """A touch keyboard for numbers and arithmetic operators."""

    accessible_name = "NUMBER PAD"
    selected_page_key: RedrawingAttribute[tuple[str, str] | None] = RedrawingAttribute(
        None
    )  # Key name and label of the page's own key.

    def __init__(
        self,
        theme: ScreenTheme,
        press: Callable[[str], None],
        *,
        page_key: tuple[str, str] | None,
        parent: QWidget,
    ) -> None:
        """Create the number pad.

        ``page_key`` is the name and label of a key that the page adds, or None for no such key.
        """
        super().__init__(theme, press, parent, _NUMBER_KEYS)
        self.selected_page_key = page_key
        self.show()

    def draw_pad_key(self, painter: ThemedPainter, box: QRectF, key: str) -> None:
        """Draw one key of the number pad.

        The position of the key that the page adds remains empty if the page adds no key.
        """
        key, shown = (
            (self.selected_page_key or ("", ""))
            if key == _PAGE_KEY
            else (key, _KEY_LABELS.get(key, key.upper()))
        )
        if key:
            ink = "text" if key.isdigit() or key == "." else "accent"
            self.key(painter, box, shown, 3.0, partial(self._press, key), color=ink, margin=1.0)
