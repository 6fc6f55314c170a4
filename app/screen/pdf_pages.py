"""Reports and setup sheets as PDF: HTML of ``app/report`` on numbered pages, its drawings as lines.

Qt sets text and tables (QTextDocument); what its HTML does not know, boxes side by side, stands one below the
other. Works without a display, and on any thread once there is an application.
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

from app.report.html_tables import DRAWINGS, PAPER
from app.report.pdf_file import Paper
from app.screen.look import FAMILY, load_fonts
from core.file_placing import bytes_to_disk

_DPI = 96  # of the pixels that drawings and letters are measured in
_FINE = 1200  # of the PDF
_MARGIN = 14.0  # mm
_FOOT = 26.0  # pixels
_FRAME = "#dde1e5"
# What the HTML of Qt does not know, and what of it stands for that.
_INSTEAD = {
    "<figure>": "<div>", "</figure>": "</div>", "<figcaption>": '<p class="hint">', "</figcaption>": "</p>",
}  # fmt: skip
_SVG = re.compile(r'<svg role="img" width="(\d+)" height="(\d+)".*?</svg>', re.DOTALL)


class PdfPages:
    """A PDF file, written page after page. Raises OSError when the disk refuses, ``close`` at the latest."""

    def __init__(self, path: Path, title: str, paper: Paper) -> None:
        _application()
        self._path, self._file, self._pages = path, QFile(str(path)), 0
        if not self._file.open(QFile.OpenModeFlag.WriteOnly):
            raise OSError(0, self._file.errorString(), str(path))
        self._writer = QPdfWriter(self._file)
        self._writer.setTitle(title)
        self._writer.setCreator("TurnDesk")
        self._writer.setResolution(_FINE)
        size = QPageSize.PageSizeId.Letter if paper is Paper.LETTER else QPageSize.PageSizeId.A4
        margins = QMarginsF(_MARGIN, _MARGIN, _MARGIN, _MARGIN)
        self._writer.setPageLayout(
            QPageLayout(
                QPageSize(size), QPageLayout.Orientation.Portrait, margins, QPageLayout.Unit.Millimeter
            )
        )
        self._painter = QPainter(self._writer)
        self._painter.scale(_FINE / _DPI, _FINE / _DPI)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, _error: BaseException | None, _trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.close()
        else:
            self.give_up()

    def add(self, html: str, foot: str) -> None:
        """Set ``html`` on pages of its own, ``foot`` and a number under each."""
        text = _Text(html, self._writer.width() * _DPI / _FINE)
        room = QSizeF(text.width, self._writer.height() * _DPI / _FINE - _FOOT)
        text.document.setPageSize(room)
        for page in range(text.document.pageCount()):
            if self._pages:
                self._writer.newPage()
            self._pages += 1
            self._page(text.document, page, room)
            self._number(room, foot)

    def _page(self, document: QTextDocument, page: int, room: QSizeF) -> None:
        painter = self._painter
        painter.save()
        painter.translate(0.0, -page * room.height())
        document.drawContents(painter, QRectF(0.0, page * room.height(), room.width(), room.height()))
        painter.restore()

    def _number(self, room: QSizeF, foot: str) -> None:
        painter, row = self._painter, QRectF(0.0, room.height(), room.width(), _FOOT)
        font = QFont(FAMILY)
        font.setPixelSize(10)
        painter.setFont(font)
        below = Qt.AlignmentFlag.AlignBottom
        painter.drawText(row, Qt.AlignmentFlag.AlignLeft | below, foot)
        painter.drawText(row, Qt.AlignmentFlag.AlignRight | below, str(self._pages))

    def close(self) -> None:
        """All of it is on the disk. Raises OSError."""
        whole = self._painter.end()
        whole = self._file.flush() and whole and self._file.error() == QFile.FileError.NoError
        why = self._file.errorString()
        self._file.close()
        if not whole:
            raise OSError(0, why, str(self._path))
        bytes_to_disk(self._path)

    def give_up(self) -> None:
        """Leave it as it is: nobody will read it."""
        if self._painter.isActive():
            self._painter.end()
        self._file.close()


class _Text:
    """HTML ready to be drawn; its drawings are kept as they are and drawn as lines."""

    def __init__(self, html: str, width: float) -> None:
        self.width = width
        self.document = QTextDocument()
        self.document.setUseDesignMetrics(True)
        self.document.setDocumentMargin(0.0)
        font = QFont(FAMILY)
        font.setPixelSize(12)
        self.document.setDefaultFont(font)
        self.document.setDefaultStyleSheet(PAPER)
        self._drawings = _Drawings(width, self.document)
        image = QTextFormat.ObjectTypes.ImageObject.value
        self.document.documentLayout().registerHandler(image, self._drawings)
        for theirs, ours in _INSTEAD.items():
            html = html.replace(theirs, ours)
        self.document.setHtml(_SVG.sub(self._drawings.keep, html))


class _Drawings(QPyTextObject):
    """Draws what stands as an image in the text."""

    def __init__(self, width: float, parent: QObject) -> None:
        super().__init__(parent)
        self._width = width
        self._kept: list[tuple[QSizeF, str]] = []

    def keep(self, found: re.Match[str]) -> str:
        """A drawing of the HTML; what stands in its place."""
        wide, high = float(found[1]), float(found[2])
        share = min(1.0, self._width / wide)
        self._kept.append((QSizeF(wide * share, high * share), found[0]))
        return f'<img src="{len(self._kept) - 1}">'

    def intrinsicSize(self, _document: QTextDocument, _at: int, form: QTextFormat) -> QSizeF:
        """Pixels, no wider than the page."""
        return self._kept[self._number(form)][0]

    def drawObject(
        self, painter: QPainter, rect: QRectF | QRect, _document: QTextDocument, _at: int, form: QTextFormat
    ) -> None:
        """Draw it as lines."""
        rect = QRectF(rect)
        text = self._kept[self._number(form)][1]
        text = text.replace("<svg ", '<svg xmlns="http://www.w3.org/2000/svg" ', 1)
        text = text.replace("<title>", f"<style>{DRAWINGS}</style><title>", 1)
        painter.save()
        painter.setClipRect(rect, Qt.ClipOperation.IntersectClip)
        QSvgRenderer(QByteArray(text.encode())).render(painter, rect)
        painter.restore()
        painter.setPen(QPen(QColor(_FRAME), 0.5))
        painter.drawRect(rect.adjusted(0.5, 0.5, -0.5, -0.5))

    @staticmethod
    def _number(form: QTextFormat) -> int:
        return int(form.toImageFormat().name())


def usual_paper() -> Paper:
    """Letter where inches are at home, as the computer's own settings say; else A4."""
    system = QLocale.system().measurementSystem()
    return Paper.LETTER if system is QLocale.MeasurementSystem.ImperialUSSystem else Paper.A4


def _application() -> None:
    """Fonts need one; where there is none yet there is no display either."""
    if QGuiApplication.instance() is None:
        _kept.append(QApplication(["turndesk", "-platform", "offscreen"]))
    load_fonts()


_kept: list[QGuiApplication] = []  # an application that nobody holds is gone


def main() -> int:
    """``python -m app.screen.pdf_pages FILE TITLE PAPER < HTML``: a process that nothing else waits for."""
    path, title, paper = sys.argv[1:]
    try:
        with PdfPages(Path(path), title, Paper(paper)) as pages:
            pages.add(sys.stdin.buffer.read().decode(), title)
    except OSError as error:
        sys.stderr.write(f"{error.strerror}\n")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
