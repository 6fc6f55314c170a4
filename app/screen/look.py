"""Themes, bundled fonts, unit of size and language, for everything that draws on the screen."""

from __future__ import annotations

import math
from dataclasses import dataclass
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
    QPaintDevice,
    QPainter,
    QPalette,
    QPen,
    QPolygonF,
)
from PySide6.QtWidgets import QApplication

from app.desk.status.machine_status import Tone
from app.desk.translation import ENGLISH, Translate, speak, tr
from app.screen.text_sizes import PanelSize, Role
from app.screen.window_layout import FINGER
from core.message import Message


@dataclass(frozen=True, slots=True)
class Palette:
    """Colors as ``#rrggbb``. ``on_…`` is the text color on a background of that color."""

    name: str
    ground: str
    panel: str
    frame: str
    text: str
    soft: str
    accent: str
    key: str
    ready: str
    run: str
    pause: str
    wait: str
    alarm: str
    off: str
    on_state: str
    mark: str
    on_mark: str
    lit: str
    on_lit: str
    here: str
    todo: str
    done: str
    rapid: str
    ghost: str
    centre: str
    tip: str
    estop: str = "#c81e1e"  # An E-stop is red on yellow in every theme (IEC 60204-1).
    estop_rim: str = "#7a0d0d"
    estop_plate: str = "#ffd400"
    estop_ground: str = "#14161a"
    estop_ink: str = "#ffffff"


DARK = Palette(
    name="dark",
    ground="#080c14",
    panel="#0f1623",
    frame="#5f7699",
    text="#f4f7fb",
    soft="#a9b9cf",
    accent="#74d4f7",
    key="#1d2a40",
    ready="#dde6f1",
    run="#35c4a2",
    pause="#f5b638",
    wait="#7fc8f6",
    alarm="#ff7f50",
    off="#8b9ab0",
    on_state="#05080d",
    mark="#f5b638",
    on_mark="#05080d",
    lit="#74d4f7",
    on_lit="#05080d",
    here="#203555",
    todo="#8093ad",
    done="#ffffff",
    rapid="#d98e1f",
    ghost="#3a4d6b",
    centre="#a8779a",
    tip="#ff7f50",
)
LIGHT = Palette(
    name="light",
    ground="#dfe5ec",
    panel="#ffffff",
    frame="#66788f",
    text="#0a101b",
    soft="#41506a",
    accent="#005580",
    key="#cdd7e3",
    ready="#2a3547",
    run="#006a52",
    pause="#8f4e00",
    wait="#005f99",
    alarm="#b32d00",
    off="#566478",
    on_state="#ffffff",
    mark="#8f4e00",
    on_mark="#ffffff",
    lit="#005f99",
    on_lit="#ffffff",
    here="#cfe3f3",
    todo="#7c8ca1",
    done="#0a101b",
    rapid="#a85c00",
    ghost="#c3ccd8",
    centre="#94497f",
    tip="#b32d00",
)
PALETTES = {palette.name: palette for palette in (DARK, LIGHT)}

# Colors of chart curves on the color ``panel``. Adjacent colors differ in lightness and in hue.
CURVES = {
    "dark": (
        *("#74d4f7", "#f5b638", "#35c4a2", "#ff7f50"),
        *("#d6a2e8", "#f4f7fb", "#b5d36a", "#8f9bff"),
    ),
    "light": (
        *("#005f99", "#8f4e00", "#006a52", "#b32d00"),
        *("#86347a", "#0a101b", "#5d6b00", "#3a3fb8"),
    ),
}


# B612 has digits of equal width, and an O that differs from a 0. In B612 Mono both look alike, and a gap
# follows the decimal point, so that X.69 looks like X. 69.
FAMILY = "B612"
LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
LEAST = 1.35  # Units: the smallest text.
LEAST_ROW = 20.0  # Pixels: a line of text.
_GROWN = 1.35  # Largest factor by which a text of a table is enlarged for the distance.
_ROW_SHARE = {Role.TABLE: 0.9, Role.PROMPT: 0.95}  # Largest em height as a ratio to the height of the row.
_ALONE = 1.1  # The same ratio for digits and capitals that have their row for themselves.
SQUEEZED = 0.6  # A translation may be drawn at this fraction of its text size.
CENTRE = Qt.AlignmentFlag.AlignCenter


@cache
def load_fonts() -> tuple[str, ...]:
    """Register the bundled fonts with Qt and return their families.

    Without them, a system without fonts shows boxes instead of characters.
    """
    families: list[str] = []
    for file in sorted(files("resources").joinpath("fonts").iterdir(), key=lambda f: f.name):
        if file.name.endswith(".otf"):
            number = QFontDatabase.addApplicationFontFromData(file.read_bytes())
            families += QFontDatabase.applicationFontFamilies(number)
    return tuple(families)


class Look:
    """Colors, fonts and sizes that all widgets of a window share. ``u`` changes with the window's size."""

    def __init__(self, palette: Palette, u: float = 12.0) -> None:
        self.palette = palette
        self.u = u
        self.caret = False  # An input field of the current page has the keyboard, so its caret is drawn.
        self.screen = PanelSize()
        self._colours: dict[str, QColor] = {}
        self._fonts: dict[tuple[float, bool], QFont] = {}

    def resize(self, u: float) -> None:
        """Set the unit of size in pixels."""
        if u != self.u:
            self.u = u
            self._fonts.clear()

    def row(self, units: float, mm: float, *, touch: bool = False) -> float:
        """Return the height of a list row in pixels.

        The height is ``units`` of the window, but at most ``mm`` on the screen. A larger screen thus shows
        more rows. A row for ``touch`` is never lower than a fingertip on the smallest screen.
        """
        high = min(units * self.u, mm * self.screen.pixels_per_mm)
        return max(high, float(FINGER)) if touch else max(high, min(units * self.u, LEAST_ROW))

    def keys_high(self, rows: int) -> int:
        """Return the height of a number of rows of touch keys in pixels, each as high as a fingertip."""
        return math.ceil(rows * FINGER + (rows - 1) * 0.6 * self.u)

    def em(self, size: float, role: Role, high: float) -> float:
        """Return the em height in units of a text in a row that is ``high`` pixels high.

        The height is at least ``size``. It is larger if the role of the text requires it at the size of this
        screen, and the row has room.
        """
        least = self.screen.least_em(role) / self.u
        room = high / self.u * _ROW_SHARE.get(role, _ALONE)
        most = min(room, size * _GROWN) if role is Role.TABLE else room
        return max(size, min(least, most))

    def repaint(self, palette: Palette) -> None:
        """Use the colors of another palette."""
        self.palette = palette
        self._colours.clear()

    def colour(self, name: str) -> QColor:
        """Return a copy of a palette color, which the caller may change."""
        if name not in self._colours:
            self._colours[name] = QColor(getattr(self.palette, name))
        return QColor(self._colours[name])

    def font(self, size: float, *, bold: bool = False) -> QFont:
        """Return the bundled font with an em height of ``size`` units."""
        key = (size, bold)
        if key not in self._fonts:
            font = QFont(FAMILY)
            font.setPixelSize(max(8, round(size * self.u)))
            font.setBold(bold)
            self._fonts[key] = font
        return self._fonts[key]

    def pen(self, name: str, width: float = 0.12) -> QPen:
        """Return a pen of a palette color. ``width`` is in units, at least one pixel."""
        return QPen(self.colour(name), max(1.0, width * self.u))

    def fit(self, text: str, size: float, width: float, *, bold: bool = False) -> QFont:
        """Return the font of this size, or a smaller one in which ``text`` is not wider than ``width``.

        The font stays large enough to read. A text that is still too long is elided when it is drawn.
        """
        font = self.font(size, bold=bold)
        wide = width_of(tr(text), font)
        if wide <= width or wide <= 0:
            return font
        smaller = QFont(font)
        smaller.setPixelSize(max(round(LEAST * self.u), int(font.pixelSize() * width / wide)))
        return smaller


def put(painter: QPainter, rect: QRectF, flags: Qt.AlignmentFlag, text: str) -> None:
    """Draw one line of TurnDesk's own text in the operator's language. See ``put_raw``.

    A translation that is too wide is drawn smaller, as far as it remains readable.
    """
    shown, font = tr(text), painter.font()
    wide = width_of(shown, font) if shown != text else 0.0
    if wide > rect.width() > 0:
        smaller = QFont(font)
        smaller.setPixelSize(int(font.pixelSize() * max(SQUEEZED, rect.width() / wide)))
        painter.setFont(smaller)
        put_raw(painter, rect, flags, shown)
        painter.setFont(font)
    else:
        put_raw(painter, rect, flags, shown)


def put_raw(painter: QPainter, rect: QRectF, flags: Qt.AlignmentFlag, text: str) -> None:
    """Draw one line of untranslated text, such as program lines, comments, names and input.

    Its capitals are centered vertically in ``rect``. A text that is too long is elided.
    """
    font = painter.font()
    if Painter.notes and isinstance(painter, Painter):
        painter.written.append((QRectF(rect), text))
    width = width_of(text, font)
    if width > rect.width() + 1:
        text = QFontMetricsF(font).elidedText(text, Qt.TextElideMode.ElideRight, rect.width())
        width = width_of(text, font)
    x = rect.left()
    if flags & Qt.AlignmentFlag.AlignRight:
        x = rect.right() - width
    elif flags & Qt.AlignmentFlag.AlignHCenter:
        x = rect.center().x() - width / 2
    painter.drawText(round(x), round(rect.center().y() + _capitals(*_face(font)) / 2), text)


def width_of(text: str, font: QFont) -> float:
    """Return the width of a line of text in pixels.

    The result is cached, because Qt shapes the text each time.
    """
    return _width(text, *_face(font))


def _face(font: QFont) -> tuple[str, int, bool]:
    return font.family(), font.pixelSize(), font.bold()


@lru_cache(maxsize=4096)
def _width(text: str, family: str, pixels: int, bold: bool) -> float:
    return _metrics(family, pixels, bold).horizontalAdvance(text)


@cache
def _capitals(family: str, pixels: int, bold: bool) -> float:
    return _metrics(family, pixels, bold).capHeight()


def _metrics(family: str, pixels: int, bold: bool) -> QFontMetricsF:
    font = QFont(family)
    if pixels > 0:  # Otherwise the default font size applies.
        font.setPixelSize(pixels)
    font.setBold(bold)
    return QFontMetricsF(font)


class Painter(QPainter):
    """A painter that uses the colors, fonts and unit of a look."""

    # Whether all painters record the texts that they draw, for assistive technology.
    notes: ClassVar[bool] = False

    def __init__(self, device: QPaintDevice, look: Look) -> None:
        super().__init__(device)
        self.look = look
        self.written: list[tuple[QRectF, str]] = []  # Recorded texts and their rectangles.

    def __enter__(self) -> Self:
        super().__enter__()
        return self

    def write(
        self,
        rect: QRectF,
        text: str,
        size: float,
        ink: str,
        *,
        at: Qt.AlignmentFlag = LEFT,
        bold: bool = True,
        raw: bool = False,
        margin: float = 0.0,
        fit: bool = True,
        role: Role = Role.TABLE,
    ) -> None:
        """Draw one line of text in a palette color, ``size`` units high, or smaller if necessary.

        It is larger if its role requires that, see ``Look.em``.

        The text is fitted into ``rect`` minus ``margin`` units, or elided. ``raw`` text is not translated,
        see ``put_raw``. Color and font remain set.
        """
        look = self.look
        room = rect.width() - margin * look.u
        size = look.em(size, role, rect.height()) if fit else size
        self.setPen(look.colour(ink))
        self.setFont(look.fit(text, size, room, bold=bold) if fit else look.font(size, bold=bold))
        (put_raw if raw else put)(self, rect, at, text)

    def wrap(self, rect: QRectF, flags: int | Qt.AlignmentFlag | Qt.TextFlag, text: str) -> None:
        """Draw a text with several lines in the present pen and font."""
        self.written.append((QRectF(rect), text))
        self.drawText(rect, int(flags), text)

    def fill(self, rect: QRectF, ground: str) -> None:
        """Fill a rectangle with a palette color."""
        self.fillRect(rect, self.look.colour(ground))

    def box(self, rect: QRectF, line: str, width: float, ground: str) -> None:
        """Draw a filled rectangle with an edge ``width`` units wide. An empty ``ground`` leaves it hollow."""
        self.setPen(self.look.pen(line, width))
        self.setBrush(self.look.colour(ground) if ground else Qt.BrushStyle.NoBrush)
        self.drawRect(rect)


def dress(palette: Palette) -> None:
    """Use the Fusion style with TurnDesk's palette for the standard widgets.

    Qt's setColorScheme has no effect on a plain X server.
    """
    QApplication.setStyle("Fusion")
    look = Look(palette)
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
        colours.setColor(role, look.colour(name))
    QApplication.setPalette(colours)


# --- state symbols ------------------------------------------------------------------------------------


def draw_sign(painter: QPainter, box: QRectF, tone: Tone, colour: QColor) -> None:
    """Draw the symbol of a state.

    Running is a triangle, paused is two bars, waiting is dots, an alarm is a triangle with a bar, ready is a
    square.
    """
    side = min(box.width(), box.height())
    square = QRectF(box.center().x() - side / 2, box.center().y() - side / 2, side, side)
    painter.save()
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(QBrush(colour))
    _SIGNS[tone](painter, square, colour)
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


_SIGNS = {
    Tone.RUN: _run,
    Tone.PAUSE: _pause,
    Tone.WAIT: _wait,
    Tone.ALARM: _alarm,
    Tone.READY: _ready,
    Tone.OFF: _off,
}


CONTEXT = "turndesk"


def speak_in(language: str) -> None:
    """Show texts in this language from now on. Raises FileNotFoundError if it has no catalog."""
    speak(None if language == ENGLISH else catalogue(language), language)


@cache
def catalogue(language: str) -> Translate:
    """Return the translation function of a language. The catalog is read once.

    The function returns an empty text for a text without a translation. Raises FileNotFoundError without a
    catalog.
    """
    folder = files("resources") / "translations"
    translator = QTranslator()
    if not translator.load(str(folder / f"turndesk_{language}.qm")):
        raise FileNotFoundError(
            Message("catalog turndesk_{language}.qm not found in {folder}", language=language, folder=folder)
        )
    return lambda text: translator.translate(CONTEXT, text) or ""
