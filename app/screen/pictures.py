"""Pictures of the pages, made without a display: ``python -m app.screen.pictures OUT``.

A sample program runs on the simulated lathe, on a clock that this script moves, so that every call makes the
same pictures.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from app.desk.desk import Desk
    from app.screen.window import MainWindow
    from core.store.store import Store

SIZES = ((1024, 600), (1920, 1080), (3840, 2160))
PROGRAM = "bushing"
PAGES = {
    "automatic": "",
    "menu": "F1",
    "seccmp": "F9 1 Enter - . 0 0 2 + . 0 0 0 5",
    "history": "F9 F5",
    "tools": "F8",
}
AT_LINE = 26  # where the run is caught: finishing the outside
CORRECTIONS = (
    (1, -0.0005, 0.0, "X -.001"),
    (3, 0.001, -0.002, "X .002 Z -.002"),
    (1, -0.00125, 0.0, "X -.0015"),
)
AT_Z = -0.3 * 25.4
TICK = 0.01
LOADING = 60.0  # seconds after which loading has failed


class Stage:
    """One desk on the simulated lathe, moved by hand."""

    def __init__(self) -> None:
        from app.cli.offset_file import read_offsets
        from app.compose.screen import desk_and_executor, samples, step_clock
        from app.desk.offsets.book import OffsetBook

        self.clock = step_clock()
        self.desk, self._executor = desk_and_executor(
            None, lambda: read_offsets(samples() / "offsets.toml"), self.clock
        )
        self.store = self._kept()
        self.desk.book = OffsetBook(self.store)
        self.desk.hands.clock = self.clock.now
        self.desk.time_of_day = lambda: "09:41:07"

    def _kept(self) -> Store:
        """A store with the offsets of the samples and some corrections; its folder goes with this stage."""
        from app.cli.offset_file import read_offsets
        from app.compose.screen import samples
        from core.store.store import Store

        self._folder = TemporaryDirectory()
        store = Store.open(Path(self._folder.name))
        for number, tool in read_offsets(samples() / "offsets.toml")[0].items():
            store.set_tool(number, "touched off", x=tool.x, z=tool.z, nose_radius=tool.nose_radius)
        for number, x, z, why in CORRECTIONS:
            store.set_secondary(number, why, x=x * 25.4, z=z * 25.4).result()
        return store

    def close(self) -> None:
        """End the threads, forget the folder."""
        self.desk.close()
        self.store.close()
        self._folder.cleanup()

    def tick(self, until: Callable[[], bool], most: float = 120.0) -> None:
        """Let the machine go on until something is so."""
        end = self.clock.now() + most
        while not until():
            if self.clock.now() > end:
                raise TimeoutError(f"not so after {most:g} s: {self.desk.snapshot().state.value}")
            self._executor.tick()
            self.clock.sleep_until(self.clock.now() + TICK)

    def start(self) -> None:
        """Load, drives on, both palms."""
        from core.executor.snapshot import State

        desk = self.desk
        desk.choose(PROGRAM)
        loaded = desk.session.settled(LOADING)
        if loaded.errors:
            raise ValueError(f"{PROGRAM} does not prove: {loaded.errors[0].message}")
        self.tick(lambda: desk.snapshot().state is State.DISABLED)
        desk.enable()
        self.tick(lambda: desk.snapshot().state is State.IDLE)
        desk.hands.palm("left", down=True)
        desk.hands.palm("right", down=True)
        self.tick(lambda: desk.snapshot().state is not State.IDLE, 5.0)
        desk.hands.let_go()


def main(argv: list[str] | None = None) -> int:
    """Write the pictures; the exit status."""
    parser = argparse.ArgumentParser(prog="python -m app.screen.pictures", description=__doc__)
    parser.add_argument("out", metavar="OUT", type=Path, help="folder for the PNG files")
    out: Path = parser.parse_args(argv).out
    os.environ["QT_QPA_PLATFORM"] = "offscreen"
    out.mkdir(parents=True, exist_ok=True)
    stage = Stage()
    stage.start()
    stage.tick(lambda: stage.desk.snapshot().line >= AT_LINE)
    stage.tick(lambda: _z(stage.desk) <= AT_Z)
    for path in taken(stage.desk, out):
        sys.stdout.write(f"{path}\n")
    stage.close()
    return 0


def _z(desk: Desk) -> float:
    snapshot = desk.snapshot()
    return snapshot.actual[1] - snapshot.offset[1]


def taken(desk: Desk, out: Path) -> list[Path]:
    """The page as it is now, at every size, dark and light."""
    from PySide6.QtWidgets import QApplication

    from app.screen.look import Look, dress, load_fonts
    from app.screen.theme import PALETTES
    from app.screen.window import MainWindow

    app = QApplication.instance() or QApplication(sys.argv[:1])
    load_fonts()
    paths = []
    for name, palette in PALETTES.items():
        dress(palette)
        for width, height in SIZES:
            for page, keys in PAGES.items():
                window = MainWindow(Look(palette))
                window.resize(width, height)
                window.open_desk(desk)
                path = out / f"{page}-{name}-{width}x{height}.png"
                _press(window, keys)
                _grab(window, path, app.processEvents)
                paths.append(path)
    return paths


def _press(window: MainWindow, keys: str) -> None:
    """The keys that lead to a page, with a space between them; the last may be figures for its entry."""
    for key in keys.split():
        window.refresh()
        if key.startswith("F"):
            window.press(key)
        elif window.frame is not None:
            window.frame.page.typed(key)


def _grab(window: MainWindow, path: Path, process: Callable[[], None]) -> None:
    from PySide6.QtGui import QImage

    window.show()
    for _ in range(20):  # the path view draws in slices
        process()
        window.refresh()
    image = window.grab().toImage().convertToFormat(QImage.Format.Format_RGB32)
    if not image.save(str(path), "PNG", 1):  # type: ignore[call-overload]
        raise OSError(f"{path} cannot be written")
    window.put_away()


if __name__ == "__main__":
    sys.exit(main())
