"""Themes, bundled fonts, size unit and language for all parts that draw on the screen."""

from __future__ import annotations

import math
from functools import cache, lru_cache
from importlib.resources import files
from typing import ClassVar, Self

from PySide6.QtCore import QPointF, QRectF, Qt, QTranslator
from PySide6.QtGui import (
    QBrush,
    QColor,
    QFont,
    QFontDatabase,
    QFontMetricsF,
    QGuiApplication,
    QPaintDevice,
    QPainter,
    QPalette,
    QPen,
    QPolygonF,
)
from PySide6.QtWidgets import QApplication

from app.desk.screen_settings import SYSTEM_THEME
from app.desk.status.machine_status import StatusTone
from app.desk.translation import ENGLISH_CODE, Translate, set_translator, tr
from app.screen.color_palettes import DARK_PALETTE, LIGHT_PALETTE, PALETTES, ColorPalette
from app.screen.text_sizes import ScreenResolution, TextRole, find_narrow_size
from app.screen.window_layout import (
    FINGERTIP_PX,
    TABLE_ROW,
    find_title_height_px,
    find_unit_px,
    limit_resolution,
)
from core.message import Message

# B612 has digits of equal width, and an O that differs from a 0. In B612 Mono both look alike, and a gap
# follows the decimal point, so that X.69 looks like X. 69.
FONT_FAMILY = "B612"
ALIGN_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
ALIGN_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
MIN_TEXT_SIZE = 1.35  # Units: the smallest text.
MIN_ROW_PX = 20.0  # Pixels: a line of text.
# Largest em height as a ratio to the height of the row. Capitals and digits have no descenders.
_ROW_SHARE, _CAPITALS_ROW_SHARE = 1.0, 1.15
MIN_TEXT_SCALE = 0.6  # A translation may be drawn at this fraction of its text size.
ALIGN_CENTER = Qt.AlignmentFlag.AlignCenter


@cache
def load_fonts() -> tuple[str, ...]:
    """Register the bundled fonts with Qt, and return their families.

    Without these fonts, a system that has no fonts shows boxes instead of characters.
    """
    families: list[str] = []
    for file in sorted(files("resources").joinpath("fonts").iterdir(), key=lambda f: f.name):
        if file.name.endswith(".otf"):
            number = QFontDatabase.addApplicationFontFromData(file.read_bytes())
            families += QFontDatabase.applicationFontFamilies(number)
    return tuple(families)


class ScreenTheme:
    """Colors, fonts and sizes that all widgets of a window share.

    ``unit_px`` is the size unit in pixels, and ``text_resolution`` is the resolution that determines the text
    heights. Both follow the size of the window.
    """

    def __init__(self, palette: ColorPalette, unit_px: float = 12.0) -> None:
        self.palette = palette
        self.unit_px = unit_px
        self.is_caret_shown = (
            False  # An input field of the current page has the keyboard, so its caret is drawn.
        )
        self._window_size = (0, 0)
        self.screen = ScreenResolution()
        self._colours: dict[str, QColor] = {}
        self._fonts: dict[tuple[float, bool], QFont] = {}
        self._narrow_fonts: dict[tuple[int, bool, int], QFont] = {}  # By pixel size, weight and stretch.

    @property
    def screen(self) -> ScreenResolution:
        """The resolution of the screen."""
        return self._screen

    @screen.setter
    def screen(self, screen: ScreenResolution) -> None:
        self._screen = screen
        self.text_resolution = (
            limit_resolution(*self._window_size, screen) if any(self._window_size) else screen
        )

    def set_window_size(self, width_px: int, height_px: int) -> None:
        """Adapt the size unit and the text heights to the size of the window."""
        self._window_size = (width_px, height_px)
        self.screen = self._screen
        unit_px = find_unit_px(width_px, height_px)
        if unit_px != self.unit_px:
            self.unit_px = unit_px
            self._fonts.clear()
            self._narrow_fonts.clear()

    def find_row_height(
        self, height_units: float, max_height_mm: float, *, is_touchable: bool = False
    ) -> float:
        """Return the height of a list row in pixels.

        The height is ``height_units`` theme units, but at most ``max_height_mm``. A larger screen thus
        shows more rows. If ``is_touchable`` is True, the row is at least as high as a fingertip on the
        smallest screen.
        """
        high = min(height_units * self.unit_px, max_height_mm * self.text_resolution.pixels_per_mm)
        return (
            max(high, float(FINGERTIP_PX))
            if is_touchable
            else max(high, min(height_units * self.unit_px, MIN_ROW_PX))
        )

    def find_key_rows_height(self, row_count: int) -> int:
        """Return the total height in pixels of a number of rows of touch keys.

        Each row is as high as a fingertip.
        """
        return math.ceil(row_count * FINGERTIP_PX + (row_count - 1) * 0.6 * self.unit_px)

    def find_em_height(
        self, size: float, role: TextRole, row_height_px: float, *, has_descenders: bool = False
    ) -> float:
        """Return the em height, in units, of a text in a row that is ``row_height_px`` pixels high.

        The height is at least ``size``. It is larger if the role of the text requires this on a screen of
        this size and the row is high enough. Letters with descenders need a higher row.
        """
        least = self.text_resolution.find_min_em_px(role) / self.unit_px
        share = _ROW_SHARE if has_descenders else _CAPITALS_ROW_SHARE
        return max(size, min(least, row_height_px / self.unit_px * share))

    def find_table_size(self, size: float) -> float:
        """Return the em height, in units, of a value or label that is at least ``size`` units high."""
        return max(size, self.text_resolution.find_min_em_px(TextRole.TABLE) / self.unit_px)

    def find_line_height(self, height_units: float) -> float:
        """Return the height of a line of a table in pixels.

        The height is ``height_units``, or what the smallest permitted text needs on this screen.
        """
        return max(
            height_units * self.unit_px, TABLE_ROW * self.text_resolution.find_min_em_px(TextRole.TABLE)
        )

    @property
    def title_height(self) -> float:
        """Return the height of the title of a frame in units."""
        return find_title_height_px(self.unit_px, self.text_resolution) / self.unit_px

    def set_palette(self, palette: ColorPalette) -> None:
        """Use the colors of another palette from now on."""
        self.palette = palette
        self._colours.clear()

    def get_color(self, name: str) -> QColor:
        """Return a copy of a palette color.

        The caller may change the copy.
        """
        if name not in self._colours:
            self._colours[name] = QColor(getattr(self.palette, name))
        return QColor(self._colours[name])

    def make_font(self, size: float, *, is_bold: bool = False) -> QFont:
        """Return the bundled font with an em height of ``size`` theme units."""
        key = (size, is_bold)
        if key not in self._fonts:
            font = QFont(FONT_FAMILY)
            font.setPixelSize(max(8, round(size * self.unit_px)))
            font.setBold(is_bold)
            self._fonts[key] = font
        return self._fonts[key]

    def make_pen(self, color_name: str, width: float = 0.12) -> QPen:
        """Return a pen with a palette color.

        ``width`` is in theme units. The pen is at least one pixel wide.
        """
        return QPen(self.get_color(color_name), max(1.0, width * self.unit_px))

    def fit_font(self, text: str, size: float, width: float, *, is_bold: bool = False) -> QFont:
        """Return the font of this size, or a narrower font with which ``text`` fits in ``width`` pixels.

        Only if the narrowest letters are too wide, the font is also lower. It always remains large enough to
        read. A text that is still too long is elided when it is drawn.
        """
        font = self.make_font(size, is_bold=is_bold)
        wide = measure_text(tr(text), font)
        if wide <= width or wide <= 0:
            return font
        pixels, stretch = find_narrow_size(font.pixelSize(), width / wide)
        return self._make_narrow_font(
            max(round(MIN_TEXT_SIZE * self.unit_px), pixels), stretch, is_bold=is_bold
        )

    def _make_narrow_font(self, pixels: int, stretch: int, *, is_bold: bool) -> QFont:
        key = (pixels, is_bold, stretch)
        if key not in self._narrow_fonts:
            font = QFont(FONT_FAMILY)
            font.setPixelSize(pixels)
            font.setBold(is_bold)
            font.setStretch(stretch)
            self._narrow_fonts[key] = font
        return self._narrow_fonts[key]


def draw_text(painter: QPainter, rect: QRectF, flags: Qt.AlignmentFlag, text: str) -> None:
    """Draw one line of a TurnDesk text, translated into the operator's language.

    A translation that is too wide is drawn narrower or smaller, but remains readable. See also
    ``draw_raw_text``.
    """
    shown, font = tr(text), painter.font()
    wide = measure_text(shown, font) if shown != text else 0.0
    if wide > rect.width() > 0:
        smaller = QFont(font)
        present = (font.stretch() or 100) / 100
        pixels, stretch = find_narrow_size(font.pixelSize(), present * rect.width() / wide)
        smaller.setPixelSize(max(pixels, int(font.pixelSize() * MIN_TEXT_SCALE)))
        smaller.setStretch(stretch)
        painter.setFont(smaller)
        draw_raw_text(painter, rect, flags, shown)
        painter.setFont(font)
    else:
        draw_raw_text(painter, rect, flags, shown)


def draw_raw_text(painter: QPainter, rect: QRectF, flags: Qt.AlignmentFlag, text: str) -> None:
    """Draw one line of untranslated text, such as program lines, comments, names and input.

    Capital letters are centered vertically in ``rect``. A text that is too long is elided.
    """
    font = painter.font()
    if ThemedPainter.records_texts and isinstance(painter, ThemedPainter):
        painter.drawn_texts.append((QRectF(rect), text))
    width = measure_text(text, font)
    if width > rect.width() + 1:
        text = QFontMetricsF(font).elidedText(text, Qt.TextElideMode.ElideRight, rect.width())
        width = measure_text(text, font)
    x = rect.left()
    if flags & Qt.AlignmentFlag.AlignRight:
        x = rect.right() - width
    elif flags & Qt.AlignmentFlag.AlignHCenter:
        x = rect.center().x() - width / 2
    painter.drawText(round(x), round(rect.center().y() + _capitals(*_face(font)) / 2), text)


def measure_text(text: str, font: QFont) -> float:
    """Return the width of a line of text in pixels.

    The result is cached, because Qt would otherwise lay out the text again in each call.
    """
    return _width(text, *_face(font))


def _face(font: QFont) -> tuple[str, int, bool, int]:
    return font.family(), font.pixelSize(), font.bold(), font.stretch()


@lru_cache(maxsize=4096)
def _width(text: str, family: str, pixels: int, bold: bool, stretch: int) -> float:
    return _metrics(family, pixels, bold, stretch).horizontalAdvance(text)


@cache
def _capitals(family: str, pixels: int, bold: bool, stretch: int) -> float:
    return _metrics(family, pixels, bold, stretch).capHeight()


def _metrics(family: str, pixels: int, bold: bool, stretch: int) -> QFontMetricsF:
    font = QFont(family)
    if pixels > 0:  # Otherwise the default font size applies.
        font.setPixelSize(pixels)
    font.setBold(bold)
    font.setStretch(stretch)
    return QFontMetricsF(font)


class ThemedPainter(QPainter):
    """A painter that uses the colors, fonts and unit of a theme."""

    # Whether all painters record the texts that they draw, for assistive technology.
    records_texts: ClassVar[bool] = False

    def __init__(self, device: QPaintDevice, theme: ScreenTheme) -> None:
        super().__init__(device)
        self.theme = theme
        self.drawn_texts: list[tuple[QRectF, str]] = []  # Recorded texts and their rectangles.

    def __enter__(self) -> Self:
        super().__enter__()
        return self

    def draw_text_line(
        self,
        rect: QRectF,
        text: str,
        size: float,
        ink: str,
        *,
        at: Qt.AlignmentFlag = ALIGN_LEFT,
        bold: bool = True,
        raw: bool = False,
        margin: float = 0.0,
        fit: bool = True,
        role: TextRole = TextRole.TABLE,
    ) -> None:
        """Draw one line of text in a palette color, ``size`` units high, and elide it if it is too long.

        If ``fit`` is True, the text is larger if its role requires this (see
        ``ScreenTheme.find_em_height``), and smaller if it does not fit in ``rect`` minus ``margin`` units.
        ``raw`` text is not translated (see ``draw_raw_text``). The painter retains the color and font.
        """
        look = self.theme
        room = rect.width() - margin * look.unit_px
        if fit:
            shown = text if raw else tr(text)
            size = look.find_em_height(size, role, rect.height(), has_descenders=shown != shown.upper())
        self.setPen(look.get_color(ink))
        self.setFont(
            look.fit_font(text, size, room, is_bold=bold) if fit else look.make_font(size, is_bold=bold)
        )
        (draw_raw_text if raw else draw_text)(self, rect, at, text)

    def draw_prepared_text(
        self,
        rect: QRectF,
        at: Qt.AlignmentFlag,
        text: str,
        role: TextRole,  # noqa: ARG002 - the role is for tests that measure the heights of texts.
    ) -> None:
        """Draw one line of untranslated text with the current pen and font.

        The caller has already found the font that the role of the text requires.
        """
        draw_raw_text(self, rect, at, text)

    def draw_wrapped_text(self, rect: QRectF, flags: int | Qt.AlignmentFlag | Qt.TextFlag, text: str) -> None:
        """Draw a text on several lines with the painter's current pen and font."""
        self.drawn_texts.append((QRectF(rect), text))
        self.drawText(rect, int(flags), text)

    def fill_rect(self, rect: QRectF, color: str) -> None:
        """Fill a rectangle with a palette color."""
        self.fillRect(rect, self.theme.get_color(color))

    def draw_box(self, rect: QRectF, line_color: str, width: float, fill_color: str) -> None:
        """Draw a filled rectangle with an edge that is ``width`` theme units wide.

        If ``fill_color`` is an empty string, the rectangle is not filled.
        """
        self.setPen(self.theme.make_pen(line_color, width))
        self.setBrush(self.theme.get_color(fill_color) if fill_color else Qt.BrushStyle.NoBrush)
        self.drawRect(rect)


def find_palette(theme_name: str) -> ColorPalette:
    """Return the palette of a theme.

    For ``SYSTEM_THEME``, this is the light palette if the operating system uses light colors, and otherwise
    the dark palette. Raise KeyError if there is no such theme.
    """
    if theme_name != SYSTEM_THEME:
        return PALETTES[theme_name]
    is_light = QGuiApplication.styleHints().colorScheme() is Qt.ColorScheme.Light
    return LIGHT_PALETTE if is_light else DARK_PALETTE


def style_application(palette: ColorPalette) -> None:
    """Apply the Fusion style with TurnDesk's palette to the standard widgets.

    Qt's setColorScheme has no effect on a plain X server.
    """
    QApplication.setStyle("Fusion")
    look = ScreenTheme(palette)
    colours = QPalette()
    for role, name in (
        (QPalette.ColorRole.Window, "ground"),
        (QPalette.ColorRole.Base, "panel"),
        (QPalette.ColorRole.AlternateBase, "panel"),
        (QPalette.ColorRole.Button, "key"),
        (QPalette.ColorRole.Text, "text"),
        (QPalette.ColorRole.WindowText, "text"),
        (QPalette.ColorRole.ButtonText, "text"),
        (QPalette.ColorRole.Highlight, "lit"),
        (QPalette.ColorRole.HighlightedText, "on_lit"),
        (QPalette.ColorRole.PlaceholderText, "soft"),
    ):
        colours.setColor(role, look.get_color(name))
    QApplication.setPalette(colours)


# --- state symbols ------------------------------------------------------------------------------------


def draw_state_symbol(painter: QPainter, box: QRectF, tone: StatusTone, color: QColor) -> None:
    """Draw the symbol of a machine state.

    Running is a triangle, paused is two bars, waiting is dots, an alarm is a triangle with a bar, and ready
    is a square.
    """
    side = min(box.width(), box.height())
    square = QRectF(box.center().x() - side / 2, box.center().y() - side / 2, side, side)
    painter.save()
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QBrush(color))
    _STATE_SYMBOLS[tone](painter, square, color)
    painter.restore()


def _run(painter: QPainter, box: QRectF, _colour: QColor) -> None:
    painter.drawPolygon(QPolygonF([box.topLeft(), QPointF(box.right(), box.center().y()), box.bottomLeft()]))


def _pause(painter: QPainter, box: QRectF, _colour: QColor) -> None:
    bar = box.width() * 0.36
    painter.drawRect(QRectF(box.left(), box.top(), bar, box.height()))
    painter.drawRect(QRectF(box.right() - bar, box.top(), bar, box.height()))


def _wait(painter: QPainter, box: QRectF, _colour: QColor) -> None:
    size = box.width() * 0.24
    for k in range(3):
        x = box.left() + k * (box.width() - size) / 2
        painter.drawEllipse(QRectF(x, box.center().y() - size / 2, size, size))


def _alarm(painter: QPainter, box: QRectF, colour: QColor) -> None:
    painter.setBrush(Qt.BrushStyle.NoBrush)
    pen = QPen(colour, box.width() * 0.12)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    painter.setPen(pen)
    inner = box.adjusted(box.width() * 0.06, box.width() * 0.06, -box.width() * 0.06, -box.width() * 0.06)
    painter.drawPolygon(
        QPolygonF([QPointF(inner.center().x(), inner.top()), inner.bottomRight(), inner.bottomLeft()])
    )
    x = box.center().x()
    painter.drawLine(QPointF(x, box.top() + box.height() * 0.40), QPointF(x, box.top() + box.height() * 0.62))
    painter.drawPoint(QPointF(x, box.top() + box.height() * 0.79))


def _ready(painter: QPainter, box: QRectF, _colour: QColor) -> None:
    inset = box.width() * 0.12
    painter.drawRect(box.adjusted(inset, inset, -inset, -inset))


def _off(painter: QPainter, box: QRectF, colour: QColor) -> None:
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.setPen(QPen(colour, box.width() * 0.14))
    inset = box.width() * 0.12
    painter.drawEllipse(box.adjusted(inset, inset, -inset, -inset))


_STATE_SYMBOLS = {
    StatusTone.RUN: _run,
    StatusTone.PAUSE: _pause,
    StatusTone.WAIT: _wait,
    StatusTone.ALARM: _alarm,
    StatusTone.READY: _ready,
    StatusTone.OFF: _off,
}


TRANSLATION_CONTEXT = "turndesk"


def set_language(language: str) -> None:
    """Show all texts in the given language from now on.

    Raise FileNotFoundError if the language has no catalog.
    """
    set_translator(None if language == ENGLISH_CODE else load_translator(language), language)


@cache
def load_translator(language: str) -> Translate:
    """Return the translation function of a language.

    The catalog is read only once. The function returns an empty string if a text has no translation. Raise
    FileNotFoundError if there is no catalog.
    """
    folder = files("resources") / "translations"
    translator = QTranslator()
    if not translator.load(str(folder / f"turndesk_{language}.qm")):
        raise FileNotFoundError(
            Message("catalog turndesk_{language}.qm not found in {folder}", language=language, folder=folder)
        )
    return lambda text: translator.translate(TRANSLATION_CONTEXT, text) or ""
