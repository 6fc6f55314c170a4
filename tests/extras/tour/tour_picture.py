"""Animation of the tour for the README: ``python -m tests.extras.tour.tour_picture FILE`` makes it.

The tour runs on the simulated lathe, on a clock that this script moves. The animation shows it at
twice its speed.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import BinaryIO

from PIL import Image
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication

from app.compose.desk_assembly import create_desk_and_executor
from app.compose.runs.journal import Journal
from app.compose.stored_offsets import read_stored_offsets
from app.desk.data_folder import HOME_VARIABLE
from app.extras.tour.tour_director import TourDirector
from app.extras.tour.tour_setup import use_tour_folder
from app.extras.tour.tour_view import WindowKeyboard
from app.offsets.offset_effect import OffsetEffectWorker
from app.screen.color_palettes import DARK_PALETTE
from app.screen.screen_theme import ScreenTheme, load_fonts, style_application
from app.screen.window.main_window import MainWindow
from core.executor.executor import Executor
from drivers.wakeups import ManualClock

WINDOW_PX, PICTURE_PX = (1200, 750), (800, 500)
QUALITY = 72
TICK_S, ADVANCE_TICKS = 0.01, 5
PICTURE_INTERVAL_S, PICTURE_MS = 0.4, 200
WORK_TIMEOUT_S = 60.0  # s for a worker that reads, proves or draws
MAX_TOUR_S = 180.0


class PlayedTour:
    """Tour in a window without a display."""

    def __init__(self) -> None:
        self.clock = ManualClock()
        self.is_over = False
        self._executor: Executor
        journal = Journal.open_default()
        self.desk, self._executor = create_desk_and_executor(None, read_stored_offsets, self.clock, journal)
        self.journal = journal
        self.desk.station_controls.clock = self.clock.now
        self.desk.clock.format_local_time = lambda: "09:41:07"
        self._executor.run_tick()
        self.window = MainWindow(ScreenTheme(DARK_PALETTE))
        self.window.resize(*WINDOW_PX)
        self.window.show_model(self.desk)
        self.window.show()
        self.director = TourDirector(self.desk, WindowKeyboard(self.window), self._end)
        self.desk.page_registry.set_guidance_card(self.director)

    def _end(self) -> None:
        self.is_over = True

    def run(self, seconds: float) -> None:
        """Let machine, screen and tour continue, and wait for each worker."""
        for number in range(round(seconds / TICK_S)):
            self.clock.advance(TICK_S)
            self._executor.run_tick()
            if number % ADVANCE_TICKS == 0:
                self.window.refresh()
                self.desk.program_loader.wait_until_loaded(WORK_TIMEOUT_S)
                if self.desk.start_watch is not None:
                    self.desk.start_watch.worker.wait_for_results(WORK_TIMEOUT_S)
                effect = self.desk.page_registry.find_model(OffsetEffectWorker)
                if effect is not None:
                    effect.worker.wait_for_results(WORK_TIMEOUT_S)
                self.director.advance()

    def draw(self) -> QImage:
        """Return the picture of the window with the part as it is now."""
        assert self.window.frame is not None
        self.window.refresh()
        player = self.window.frame.automatic_page.path_view.part_player
        if player is not None:
            player.wait_for_result(WORK_TIMEOUT_S)
        self.window.refresh()
        QApplication.processEvents()
        return (
            self.window.grab()
            .toImage()
            .scaled(
                *PICTURE_PX,
                Qt.AspectRatioMode.IgnoreAspectRatio,
                Qt.TransformationMode.SmoothTransformation,
            )
        )

    def close(self) -> None:
        """Close the window and the machine."""
        self.window.close_silently()
        self.desk.close()
        self.journal.close()


@contextmanager
def play_tour() -> Iterator[PlayedTour]:
    """Open a window with a tour that has not begun, with a data folder that is deleted afterwards."""
    with TemporaryDirectory() as folder:
        os.environ[HOME_VARIABLE] = folder
        with use_tour_folder(), closing(PlayedTour()) as tour:
            yield tour


def convert_picture(picture: QImage) -> Image.Image:
    """Return a picture of Qt as a picture of Pillow."""
    rows = picture.convertToFormat(QImage.Format.Format_RGB888)
    size, stride = (rows.width(), rows.height()), rows.bytesPerLine()
    return Image.frombytes("RGB", size, bytes(rows.constBits()), "raw", "RGB", stride)


def write_animation(pictures: Sequence[QImage], file: BinaryIO) -> None:
    """Write an animated WebP picture that repeats without end. Raises ValueError without pictures."""
    if not pictures:
        raise ValueError("the animation has no pictures")
    first, *others = map(convert_picture, pictures)
    first.save(
        file,
        "WEBP",
        save_all=True,
        append_images=others,
        duration=PICTURE_MS,
        loop=0,
        quality=QUALITY,
        kmax=0,  # Without key frames, the file has about half of the size.
    )


def play_pictures() -> Iterator[QImage]:
    """Yield the pictures of the whole tour. Raises TimeoutError if the tour does not end."""
    with play_tour() as tour:
        while not tour.is_over:
            if tour.clock.now() > MAX_TOUR_S:
                raise TimeoutError(f"the tour has not ended after {MAX_TOUR_S:g} s")
            tour.run(PICTURE_INTERVAL_S)
            if not tour.director.is_stopping:
                yield tour.draw()


def main() -> int:
    """Write the animation, and print its size."""
    parser = argparse.ArgumentParser(description="Write an animation of the tour.")
    parser.add_argument("file", type=Path, help="WebP file to write")
    path = parser.parse_args().file
    os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
    application = QApplication.instance() or QApplication(sys.argv[:1])
    assert isinstance(application, QApplication)
    load_fonts()
    style_application(DARK_PALETTE)
    pictures = list(play_pictures())
    with path.open("wb") as file:
        write_animation(pictures, file)
    sys.stdout.write(f"{path}: {path.stat().st_size / 1024:.0f} KB\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
