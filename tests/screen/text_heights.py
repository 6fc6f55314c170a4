"""Heights of the painted texts of a window, from what its panels draw on the screen."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

import pytest
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFontMetricsF, QPainter

from app.desk.translation import tr
from app.screen import screen_theme
from app.screen.text_sizes import TextRole
from app.screen.window.window_bars import TitleLine


class Text(NamedTuple):
    """One drawn text: ``capitals`` is the height of its capitals in pixels."""

    text: str
    role: TextRole
    capitals: float
    panel: str


@contextmanager
def recorded(patch: pytest.MonkeyPatch) -> Iterator[list[Text]]:
    """Everything that is drawn inside, with the role of each text."""
    texts: list[Text] = []
    roles = [TextRole.TABLE]
    write, put_raw = screen_theme.ThemedPainter.draw_text_line, screen_theme.draw_raw_text
    prepared = screen_theme.ThemedPainter.draw_prepared_text

    def prepared_noted(
        painter: screen_theme.ThemedPainter, rect: QRectF, at: Qt.AlignmentFlag, text: str, role: TextRole
    ) -> None:
        roles.append(role)
        prepared(painter, rect, at, text, role)
        roles.pop()

    def noted(painter: screen_theme.ThemedPainter, *args: Any, **more: Any) -> None:
        roles.append(more.get("role", TextRole.TABLE))
        write(painter, *args, **more)
        roles.pop()

    def put(painter: QPainter, rect: QRectF, flags: Qt.AlignmentFlag, text: str) -> None:
        panel = painter.device()
        role = roles[-1]
        if isinstance(panel, TitleLine) and text == tr(panel.state_text):
            role = TextRole.STATE
        if text.strip():
            capitals = QFontMetricsF(painter.font()).capHeight()
            texts.append(Text(text, role, capitals, type(panel).__name__))
        put_raw(painter, rect, flags, text)

    patch.setattr(screen_theme.ThemedPainter, "draw_text_line", noted)
    patch.setattr(screen_theme.ThemedPainter, "draw_prepared_text", prepared_noted)
    patch.setattr(screen_theme, "draw_raw_text", put)
    yield texts
    patch.undo()
