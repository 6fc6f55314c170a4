"""Help panel: the guide's text and pictures about the current page, with the marked word or field."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFont, QKeyEvent, QMouseEvent, QPixmap, QResizeEvent
from PySide6.QtWidgets import QWidget

from app.desk.pages.guide_text import BlockKind, GuideBlock
from app.desk.translation import tr
from app.screen.panel import FocusHolder, RedrawingAttribute
from app.screen.screen_theme import ScreenTheme, ThemedPainter, measure_text
from app.screen.table_panel import RowPanel
from app.screen.text_sizes import TextRole
from app.screen.window.alarm_panels import AlarmNotice
from app.screen.window.documentation_browser import DocumentationBrowser, find_section_path
from app.screen.window.key_table import HELP_KEY, MODIFIER_KEYS
from app.screen.window.part_placement import find_area_left_of
from app.screen.window_layout import Rect, divide_work_area
from core.message import Message

TEXT_SIZE, MAX_TEXT_SIZE = 2.1, 3.0  # Units.
ROW_RATIO = 1.6  # Height of a row as a ratio to the em height of its text.
KEY_SHARE = 0.3  # Largest width of the key column as a ratio to the width of the panel.
_MAX_PICTURE_SHARE = 0.9  # Largest height of a picture as a ratio to the height of the visible rows.
_SPACED_KINDS = frozenset({BlockKind.HEADING, BlockKind.PICTURE})  # A blank row precedes these blocks.
_KIND_COLORS = {
    BlockKind.HEADING: "accent",
    BlockKind.TEXT: "text",
    BlockKind.KEY: "text",
    BlockKind.ADDRESS: "soft",
}
_BROWSER_KEY = Qt.Key.Key_B


@dataclass(frozen=True, slots=True)
class HelpRow:
    """One row of the panel: a line of text with the key on its left, or one slice of a picture.

    ``slice_number`` is the number of the slice, from the top of the picture.
    """

    kind: BlockKind
    text: str = ""
    key: str = ""
    slice_number: int = 0


class HelpPanel(RowPanel):
    """Help about a page, which covers the page until a key closes it.

    While the panel is open, it has the keyboard: the arrow and page keys scroll, the help key shows the
    next screenful, and any other key only closes the panel. Keys that stop the machine never arrive here.
    """

    title = "HELP  ·  ?: NEXT  ·  ARROWS: SCROLL  ·  ANY OTHER KEY: CLOSE"
    _rows: RedrawingAttribute[tuple[HelpRow, ...]] = RedrawingAttribute(())

    def __init__(self, theme: ScreenTheme, parent: QWidget) -> None:
        super().__init__(theme, parent)
        self._blocks: tuple[GuideBlock, ...] = ()
        self.browser: DocumentationBrowser | None = None
        self._focus = FocusHolder(self)
        self._pictures: dict[str, QPixmap] = {}
        self.hide()

    @property
    def shown_text(self) -> str:
        """Return the whole text of the help, including rows that are not visible."""
        return "\n".join(f"{block.key} {block.text}".strip() for block in self._blocks)

    @property
    def addresses(self) -> tuple[str, ...]:
        """Return the addresses of the shown sections in the documentation site."""
        return tuple(block.text for block in self._blocks if block.kind is BlockKind.ADDRESS)

    def open_help(self, blocks: Sequence[GuideBlock]) -> None:
        """Show the given blocks of help, and take the keyboard focus from an input field."""
        self._blocks, self.first_row = tuple(blocks), 0
        self._focus.hold_focus()
        self._wrap_blocks()
        self.show()
        self.raise_()
        self.update()

    def close_help(self) -> None:
        """Hide the panel, and return the keyboard focus to the input field that had it."""
        if self.isHidden():
            return
        self.hide()
        self._focus.return_focus()

    def place_with_notice(self, area: Rect, notice: AlarmNotice) -> None:
        """Place the notice and the help over the page, next to each other if both are open.

        The notice of an alarm covers the page, and the notice of a program stop covers the path view.
        """
        if notice.isHidden() and self.isHidden():
            return
        path = divide_work_area(area, self.theme.unit_px)[2]
        notice.setGeometry(*(area if notice.has_alarm and self.isHidden() else path))
        if not self.isHidden():
            self.setGeometry(*area if notice.isHidden() else find_area_left_of(area, path))

    def show_next_screenful(self) -> None:
        """Scroll down by one screenful, or close the panel if its last row is already visible."""
        if self.first_row + self.rows >= len(self._rows):
            self.close_help()
        else:
            self.scroll_by(self.rows)

    def handle_key(self, event: QKeyEvent) -> None:
        """Scroll with the arrow, page, Home and End keys. Any other key closes the panel."""
        steps = {
            Qt.Key.Key_Up: -1,
            Qt.Key.Key_Left: -1,
            Qt.Key.Key_Down: 1,
            Qt.Key.Key_Right: 1,
            Qt.Key.Key_PageUp: -self.rows,
            Qt.Key.Key_PageDown: self.rows,
            Qt.Key.Key_Home: -len(self._rows),
            Qt.Key.Key_End: len(self._rows),
        }
        key = Qt.Key(event.key())
        if key in steps:
            self.scroll_by(steps[key])
        elif event.isAutoRepeat() or key in MODIFIER_KEYS:
            return
        elif event.text() == HELP_KEY:
            self.show_next_screenful()
        elif key == _BROWSER_KEY:
            self._press_browser_key()
        else:
            self.close_help()

    def _press_browser_key(self) -> None:
        """Close the help, and show its first section in the browser if the desktop has one."""
        self.close_help()
        if self.addresses and self.browser is not None and self.browser.is_available():
            self.browser.open_section(self.addresses[0])

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Press a scroll key. A touch anywhere else closes the panel."""
        if not self.press_target_at(event.position()):
            self.close_help()

    def resizeEvent(self, _event: QResizeEvent) -> None:
        """Wrap the texts to the new width."""
        self._wrap_blocks()

    # --- rows ----------------------------------------------------------------------------------------

    @property
    def _text_size(self) -> float:
        """Return the em height in units. On a small screen, the reading distance determines it."""
        needed = self.theme.text_resolution.find_min_em_px(TextRole.TABLE) / self.theme.unit_px
        return max(TEXT_SIZE, min(needed, MAX_TEXT_SIZE))

    @property
    def _row_height_px(self) -> float:
        return ROW_RATIO * self._text_size * self.theme.unit_px

    def _make_font(self, *, is_bold: bool) -> QFont:
        return self.theme.make_font(self._text_size, is_bold=is_bold)

    @property
    def _text_width(self) -> float:
        """Return the width that the scroll keys leave for the texts."""
        return self.inside().width() - self.scroll_key_size[0] - 2.4 * self.theme.unit_px

    def _wrap_blocks(self) -> None:
        """Divide the blocks of help into rows, with texts wrapped to the width of the panel."""
        wide, rows = self._text_width, list[HelpRow]()
        if wide <= 0 or not self._blocks:
            return
        previous = BlockKind.HEADING
        linked = self.addresses[:1] if self.browser is not None and self.browser.is_available() else ()
        for block in self._blocks:
            if rows and (block.kind in _SPACED_KINDS or block.kind is not previous is not BlockKind.HEADING):
                rows.append(HelpRow(BlockKind.TEXT))
            previous = block.kind
            if block.kind is BlockKind.PICTURE:
                rows += self._slice_picture(block.text)
            elif block.kind is BlockKind.ADDRESS:
                rows += self._wrap_address(block.text, wide, has_browser=block.text in linked)
            else:
                rows += self._wrap_block(block, wide)
        self._rows = tuple(rows)

    def _wrap_block(self, block: GuideBlock, wide: float) -> list[HelpRow]:
        key_font, font = self._make_font(is_bold=True), self._make_font(is_bold=False)
        if block.kind is not BlockKind.KEY:
            is_heading = block.kind is BlockKind.HEADING
            lines = wrap_words(tr(block.text), key_font if is_heading else font, wide)
            return [HelpRow(block.kind, line) for line in lines]
        keys = wrap_words(block.key, key_font, KEY_SHARE * wide)
        lines = wrap_words(tr(block.text), font, (1 - KEY_SHARE) * wide - self.theme.unit_px)
        count = max(len(keys), len(lines))
        keys += [""] * (count - len(keys))
        lines += [""] * (count - len(lines))
        return [HelpRow(BlockKind.KEY, line, key) for key, line in zip(keys, lines, strict=True)]

    def _wrap_address(self, address: str, wide: float, *, has_browser: bool) -> list[HelpRow]:
        """Return the rows of an address, or no rows if this computer does not contain the section.

        The key of the rows opens the address if the desktop has a browser.
        """
        if not (path := find_section_path(address)):
            return []
        pattern = (
            "IN THE DOCUMENTATION: {path} · B: OPEN IN THE BROWSER"
            if has_browser
            else "IN THE DOCUMENTATION: {path}"
        )
        lines = wrap_words(tr(Message(pattern, path=path)), self._make_font(is_bold=False), wide)
        return [HelpRow(BlockKind.ADDRESS, line, "B" if has_browser else "") for line in lines]

    def _slice_picture(self, path: str) -> list[HelpRow]:
        """Return a row for each slice of a picture, or no rows if the picture cannot be read."""
        height = self._find_picture_size(path)[1]
        count = -(-height // max(1, int(self._row_height_px)))
        return [HelpRow(BlockKind.PICTURE, path, slice_number=number) for number in range(count)]

    def _load_picture(self, path: str) -> QPixmap:
        if path not in self._pictures:
            self._pictures[path] = QPixmap(path)
        return self._pictures[path]

    def _find_picture_size(self, path: str) -> tuple[int, int]:
        """Return the size in pixels at which a picture is drawn, which fits in the panel."""
        picture = self._load_picture(path)
        if picture.isNull():
            return 0, 0
        most = _MAX_PICTURE_SHARE * self.inside().height()
        scale = min(1.0, self._text_width / picture.width(), most / picture.height())
        return int(scale * picture.width()), int(scale * picture.height())

    # --- drawing -------------------------------------------------------------------------------------

    def draw(self, painter: ThemedPainter) -> None:
        """Draw the visible rows and the scroll keys."""
        room, high = self.inside(), self._row_height_px
        fits = max(1, int(room.height() / high))
        room = self.draw_scroll_keys(painter, room, fits, len(self._rows))
        for number, box in self.find_row_boxes(room, high):
            row = self._rows[number]
            self._draw_row(painter, box, row)
            if row.kind is BlockKind.ADDRESS and row.key:
                self.add_target(box, self._press_browser_key, "OPEN IN THE BROWSER")
        self.add_target(self.find_full_area(), self.close_help, "CLOSE HELP")

    def _draw_row(self, painter: ThemedPainter, box: QRectF, row: HelpRow) -> None:
        if row.kind is BlockKind.PICTURE:
            self._draw_slice(painter, box, row)
            return
        wide = self._text_width
        if row.kind is BlockKind.KEY:
            key = QRectF(box.x(), box.y(), KEY_SHARE * wide, box.height())
            painter.draw_text_line(key, row.key, self._text_size, "accent", raw=True, fit=False)
            box = box.adjusted(KEY_SHARE * wide + self.theme.unit_px, 0, 0, 0)
        is_bold = row.kind is BlockKind.HEADING
        painter.draw_text_line(
            box, row.text, self._text_size, _KIND_COLORS[row.kind], bold=is_bold, raw=True, fit=False
        )

    def _draw_slice(self, painter: ThemedPainter, box: QRectF, row: HelpRow) -> None:
        """Draw the slice of a picture that this row shows."""
        picture, high = self._load_picture(row.text), int(self._row_height_px)
        wide, whole = self._find_picture_size(row.text)
        top = row.slice_number * high
        part = min(high, whole - top)
        scale = picture.height() / max(1, whole)
        target = QRectF(round(box.x()), round(box.y()), wide, part + 1)
        source = QRectF(0, top * scale, picture.width(), (part + 1) * scale)
        painter.drawPixmap(target, picture, source)


def wrap_words(text: str, font: QFont, width_px: float) -> list[str]:
    """Return the text in lines that are no wider than ``width_px``, with at least one word each."""
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and measure_text(longer, font) <= width_px:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines or [""]
