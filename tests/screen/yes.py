"""Answering a question of the desk: it is read first."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from app.desk.desk import Desk
from app.screen.window.main_window import MainWindow

NEVER = float("-inf")


def yes(window: MainWindow, key: Qt.Key = Qt.Key.Key_Y) -> None:
    """The question has stood long enough to be read, and its own key is pressed."""
    assert window.frame is not None
    read(window.frame.desk)
    QTest.keyClick(QApplication.focusWidget() or window, key)


def read(desk: Desk) -> None:
    """Time enough has passed for reading the question that stands."""
    assert desk.confirmation_key, f"nothing is asked: {desk.prompt_notice}"
    desk.prompt_line._since = NEVER


def twist_out(window: MainWindow) -> None:
    """The E-stop of the simulated station is freed by its own key, and its question answered."""
    QTest.keyClick(window, Qt.Key.Key_U)
    yes(window)
