"""Size and position of the window on the screen."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QScreen
from PySide6.QtWidgets import QWidget

from app.screen.window_layout import MIN_WINDOW_PX

START_SIZE_PX = (1280, 720)
TITLE_BAR_PX = 60  # Pixels that the title bar of a window manager uses.


def show_full_screen(window: QWidget, *, is_frameless: bool = False) -> None:
    """Show a window on the whole screen.

    The geometry is also set, because there may be no window manager.
    """
    if is_frameless:
        window.setWindowFlag(Qt.WindowType.FramelessWindowHint)
    screen = window.screen()
    if screen is not None:
        window.setGeometry(screen.geometry())
    window.showFullScreen()


def show_in_suitable_size(window: QWidget, screen: QScreen, *, is_kiosk: bool) -> None:
    """Show the window in a size that suits the screen.

    The window fills a small screen completely. The title bar of a window manager could otherwise push the
    function keys off a screen with 600 lines.
    """
    room = screen.availableGeometry()
    window.setMinimumSize(min(MIN_WINDOW_PX[0], room.width()), min(MIN_WINDOW_PX[1], room.height()))
    if is_kiosk or room.height() < MIN_WINDOW_PX[1] + TITLE_BAR_PX or room.width() <= MIN_WINDOW_PX[0]:
        show_full_screen(window, is_frameless=is_kiosk)
    elif room.width() < 2 * START_SIZE_PX[0]:
        window.setGeometry(room)  # Without a window manager, nothing else sets the geometry.
        window.showMaximized()
    else:  # On a large screen, use a quarter of it.
        window.resize(max(START_SIZE_PX[0], room.width() // 2), max(START_SIZE_PX[1], room.height() // 2))
        window.show()
