"""Reports and setup sheets as PDF files, from the HTML of ``app/report``.

Drawings remain vector graphics. Qt lays out the text and tables (QTextDocument). Boxes that HTML places
side by side are placed below each other, because Qt does not support them. The module works without a
display. Once a Qt application exists, the module can be used on any thread.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from types import TracebackType
from typing import Self

from PySide6.QtCore import QByteArray, QFile, QLocale, QMarginsF, QObject, QRect, QRectF, QSizeF, Qt
from PySide6.QtGui import (
    QColor,
    QFont,
    QGuiApplication,
    QPageLayout,
    QPageSize,
    QPainter,
    QPdfWriter,
    QPen,
    QPyTextObject,
    QTextDocument,
    QTextFormat,
)
from PySide6.QtSvg import QSvgRenderer
from PySide6.QtWidgets import QApplication

from app.report.html_tables import DRAWING_STYLE, PAPER_COLORS
from app.report.pdf_file import PaperSize
from app.screen.screen_theme import FONT_FAMILY, load_fonts
from core.file_replacement import sync_file

_DPI = 96  # Resolution of the pixels in which drawings and text are measured.
_PDF_DPI = 1200  # Resolution of the PDF.
_MARGIN_MM = 14.0  # mm
_FOOTER_PX = 26.0  # pixels
_FRAME_COLOR = "#dde1e5"
# Tags that Qt does not support, with their replacements.
_TAG_REPLACEMENTS = {
    "<figure>": "<div>", "</figure>": "</div>", "<figcaption>": '<p class="hint">', "</figcaption>": "</p>",
}  # fmt: skip
_SVG = re.compile(r'<svg role="img" width="(\d+)" height="(\d+)".*?</svg>', re.DOTALL)


class PdfWriter:
    """Writer of a PDF file, page by page. It raises OSError if writing fails."""

    def __init__(self, path: Path, title: str, paper_size: PaperSize) -> None:
        _make_application()
        self._path, self._file, self._pages = path, QFile(str(path)), 0
        if not self._file.open(QFile.OpenModeFlag.WriteOnly):
            raise OSError(0, self._file.errorString(), str(path))
        self._writer = QPdfWriter(self._file)
        self._writer.setTitle(title)
        self._writer.setCreator("TurnDesk")
        self._writer.setResolution(_PDF_DPI)
        size = QPageSize.PageSizeId.Letter if paper_size is PaperSize.LETTER else QPageSize.PageSizeId.A4
        margins = QMarginsF(_MARGIN_MM, _MARGIN_MM, _MARGIN_MM, _MARGIN_MM)
        self._writer.setPageLayout(
            QPageLayout(
                QPageSize(size), QPageLayout.Orientation.Portrait, margins, QPageLayout.Unit.Millimeter
            )
        )
        self._painter = QPainter(self._writer)
        self._painter.scale(_PDF_DPI / _DPI, _PDF_DPI / _DPI)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, _error: BaseException | None, _trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.close()
        else:
            self.discard_file()

    def add_pages(self, html: str, footer: str) -> None:
        """Add ``html`` on new pages, with ``footer`` and a page number at the bottom of each page."""
        text = _PdfText(html, self._writer.width() * _DPI / _PDF_DPI)
        room = QSizeF(text.width, self._writer.height() * _DPI / _PDF_DPI - _FOOTER_PX)
        text.document.setPageSize(room)
        for page in range(text.document.pageCount()):
            if self._pages:
                self._writer.newPage()
            self._pages += 1
            self._page(text.document, page, room)
            self._number(room, footer)

    def _page(self, document: QTextDocument, page: int, room: QSizeF) -> None:
        painter = self._painter
        painter.save()
        painter.translate(0.0, -page * room.height())
        document.drawContents(painter, QRectF(0.0, page * room.height(), room.width(), room.height()))
        painter.restore()

    def _number(self, room: QSizeF, foot: str) -> None:
        painter, row = self._painter, QRectF(0.0, room.height(), room.width(), _FOOTER_PX)
        font = QFont(FONT_FAMILY)
        font.setPixelSize(10)
        painter.setFont(font)
        below = Qt.AlignmentFlag.AlignBottom
        painter.drawText(row, Qt.AlignmentFlag.AlignLeft | below, foot)
        painter.drawText(row, Qt.AlignmentFlag.AlignRight | below, str(self._pages))

    def close(self) -> None:
        """Finish the file, and write it to the disk.

        Raise OSError on failure.
        """
        whole = self._painter.end()
        whole = self._file.flush() and whole and self._file.error() == QFile.FileError.NoError
        why = self._file.errorString()
        self._file.close()
        if not whole:
            raise OSError(0, why, str(self._path))
        sync_file(self._path)

    def discard_file(self) -> None:
        """Close the incomplete file, which will not be used."""
        if self._painter.isActive():
            self._painter.end()
        self._file.close()


class _PdfText:
    """HTML text that is ready to be drawn on PDF pages.

    The SVG drawings of the text are stored separately and drawn as vector graphics.
    """

    def __init__(self, html: str, width: float) -> None:
        self.width = width
        self.document = QTextDocument()
        self.document.setUseDesignMetrics(True)
        self.document.setDocumentMargin(0.0)
        font = QFont(FONT_FAMILY)
        font.setPixelSize(12)
        self.document.setDefaultFont(font)
        self.document.setDefaultStyleSheet(PAPER_COLORS)
        self._drawings = _SvgObjects(width, self.document)
        image = QTextFormat.ObjectTypes.ImageObject.value
        self.document.documentLayout().registerHandler(image, self._drawings)
        for theirs, ours in _TAG_REPLACEMENTS.items():
            html = html.replace(theirs, ours)
        self.document.setHtml(_SVG.sub(self._drawings.add_svg, html))


class _SvgObjects(QPyTextObject):
    """Object handler that draws the SVG drawings in place of images in the text."""

    def __init__(self, width: float, parent: QObject) -> None:
        super().__init__(parent)
        self._width = width
        self._kept: list[tuple[QSizeF, str]] = []

    def add_svg(self, found: re.Match[str]) -> str:
        """Store an SVG drawing from the HTML, and return the image tag that replaces it."""
        wide, high = float(found[1]), float(found[2])
        share = min(1.0, self._width / wide)
        self._kept.append((QSizeF(wide * share, high * share), found[0]))
        return f'<img src="{len(self._kept) - 1}">'

    def intrinsicSize(self, _document: QTextDocument, _at: int, form: QTextFormat) -> QSizeF:
        """Return the size of a drawing in pixels, limited to the width of the page."""
        return self._kept[self._number(form)][0]

    def drawObject(
        self, painter: QPainter, rect: QRectF | QRect, _document: QTextDocument, _at: int, form: QTextFormat
    ) -> None:
        """Draw an SVG drawing as vector graphics."""
        rect = QRectF(rect)
        text = self._kept[self._number(form)][1]
        text = text.replace("<svg ", '<svg xmlns="http://www.w3.org/2000/svg" ', 1)
        text = text.replace("<title>", f"<style>{DRAWING_STYLE}</style><title>", 1)
        painter.save()
        painter.setClipRect(rect, Qt.ClipOperation.IntersectClip)
        QSvgRenderer(QByteArray(text.encode())).render(painter, rect)
        painter.restore()
        painter.setPen(QPen(QColor(_FRAME_COLOR), 0.5))
        painter.drawRect(rect.adjusted(0.5, 0.5, -0.5, -0.5))

    @staticmethod
    def _number(form: QTextFormat) -> int:
        return int(form.toImageFormat().name())


def find_default_paper_size() -> PaperSize:
    """Return Letter if the computer's locale uses inches, and otherwise A4."""
    system = QLocale.system().measurementSystem()
    return PaperSize.LETTER if system is QLocale.MeasurementSystem.ImperialUSSystem else PaperSize.A4


def _make_application() -> None:
    """Create an application without a display if no application exists.

    Fonts need an application.
    """
    if QGuiApplication.instance() is None:
        _application_ref.append(QApplication(["turndesk", "-platform", "offscreen"]))
    load_fonts()


_application_ref: list[QGuiApplication] = []  # References that keep the applications alive.


def main() -> int:
    """Run this module as a separate process.

    The command is ``python -m app.screen.pdf_pages FILE TITLE PAPER < HTML``.
    """
    path, title, paper = sys.argv[1:]
    try:
        with PdfWriter(Path(path), title, PaperSize(paper)) as pages:
            pages.add_pages(sys.stdin.buffer.read().decode(), title)
    except OSError as error:
        sys.stderr.write(f"{error.strerror}\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
