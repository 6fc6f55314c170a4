"""What is pictured of each page: the keys that lead to it, and whether the machine stands or runs."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from app.desk import pages

if TYPE_CHECKING:
    from PySide6.QtGui import QImage

    from app.desk.desk import Desk
    from app.screen.window import MainWindow

SETTLE = 0.5  # seconds for workers to read, prove and draw


@dataclass(frozen=True, slots=True)
class Scene:
    """``keys`` with a space between them; a word that begins with ``"`` is typed letter by letter."""

    name: str
    keys: str = ""
    running: bool = False
    language: str = "en"
    mill: bool = False  # the tilted sample on the mill with an A-C table
    line: int = 0  # where the editor's cursor is put


# One line for each picture.
SCENES = (
    Scene("menu", "F1"),
    Scene("file", "F2"),
    Scene("programs", "F1 F6"),
    Scene("export", "F1 F6 F9"),
    Scene("editor", "F3"),
    Scene("mdi", 'F1 F4 "G90G94F10X.9Z.1'),
    Scene("jog", "F1 F5"),
    Scene("searchto", 'F6 "20 Enter'),
    Scene("tools", "F8"),
    Scene("seccmp", 'F9 "1 Enter "-.002+.0005'),
    Scene("history", "F9 F5"),
    Scene("zero", "F1 G"),
    Scene("speed", 'F10 1 "1500'),
    Scene("parts", "F10 2"),
    Scene("outputs", "F10 3 Down"),
    Scene("inputs", "F10 3 F4"),
    Scene("drives", "F10 4"),
    Scene("log", "F10 5"),
    Scene("backup", "F10 6"),
    Scene("screen", "F10 7"),
    Scene("automatic", running=True),
    Scene("spanish", running=True, language="es"),
    Scene("mill-editor", "F3", mill=True, line=18),
    Scene("mill", running=True, mill=True),
)


def taken(
    desk: Desk,
    out: Path,
    running: bool,
    sizes: tuple[tuple[int, int], ...],
    themes: tuple[str, ...],
    *,
    mill: bool = False,
) -> Iterator[Path]:
    """The scenes of a machine that runs or stands, at every size and in every theme."""
    from app.screen.look import Look, dress, load_fonts
    from app.screen.theme import PALETTES
    from app.screen.window import MainWindow

    load_fonts()
    for theme in themes:
        dress(PALETTES[theme])
        for width, height in sizes:
            for scene in SCENES:
                if (scene.running, scene.mill) != (running, mill):
                    continue
                desk.settings.choose("theme", theme)
                desk.settings.choose("language", scene.language)
                window = MainWindow(Look(PALETTES[theme]))
                window.resize(width, height)
                window.open_desk(desk)
                path = out / f"{scene.name}-{theme}-{width}x{height}.png"
                press(window, scene.keys)
                _to_line(window, scene.line)
                _grab(window, path)
                _leave(window)
                yield path


def _leave(window: MainWindow) -> None:
    """As an operator leaves a page: nothing stays half done on the desk."""
    if window.frame is not None:
        window.frame.desk.clear()
        window.frame.go(pages.AUTOMATIC)
    window.put_away()


def press(window: MainWindow, keys: str) -> None:
    """Each key to the page as text first, then as what it does anywhere."""
    for word in keys.split():
        for key in word[1:] if word.startswith('"') else [word]:
            _settle(window, 0.2)
            frame = window.frame
            if frame is not None and not frame.page.typed(key):
                window.press(key)


def _to_line(window: MainWindow, line: int) -> None:
    from app.editor.editor_view import EditorPage

    page = window.frame.page if window.frame is not None else None
    if line and isinstance(page, EditorPage):
        _settle(window, SETTLE)
        page.go_to(line)


def _settle(window: MainWindow, seconds: float) -> None:
    from PySide6.QtWidgets import QApplication

    end = time.monotonic() + seconds
    while time.monotonic() < end:
        QApplication.processEvents()
        window.refresh()
        time.sleep(0.01)


def _grab(window: MainWindow, path: Path) -> None:
    window.show()
    _settle(window, SETTLE)
    if not _lean(window.grab().toImage()).save(str(path), "PNG", 1):  # type: ignore[call-overload]
        raise OSError(f"{path} cannot be written")


def _lean(image: QImage) -> QImage:
    """The same with its 256 most frequent colours: a third of the file, and no difference to be seen."""
    import numpy as np
    from PySide6.QtCore import Qt
    from PySide6.QtGui import QImage

    image = image.convertToFormat(QImage.Format.Format_RGB32)
    pixels = np.frombuffer(image.constBits(), dtype=np.uint32)
    colours, counts = np.unique(pixels, return_counts=True)
    table = [int(colour) for colour in colours[np.argsort(-counts)][:256]]
    flat = Qt.ImageConversionFlag.ThresholdDither | Qt.ImageConversionFlag.AvoidDither
    return image.convertToFormat(QImage.Format.Format_Indexed8, table, flat)
