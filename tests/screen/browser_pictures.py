"""Pictures of the pages that a browser shows: ``python -m tests.screen.browser_pictures OUT``.

The shift report and the page for the office, of a morning that this script has made up, by Chromium.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory

from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication

from app.compose.machine_files import load_machine
from app.compose.page_server import PageServer, listening_at
from app.compose.stored_offsets import read_offsets, setup_with
from app.compose.workshop import office_pictures, samples
from app.desk.kept_part import kept_part
from app.screen.language import speak_in
from app.shopfloor.png_file import png_of
from app.shopfloor.status_file import Status
from app.shopfloor.status_page import OtherDesk, StatusPage
from core.executor.job import make_job
from core.language.source import load_source
from tests.screen.pictures import lean

BROWSERS = ("chromium", "chromium-browser", "google-chrome")


STATUS: Status = {
    "updated": "2026-03-02T09:41:07+00:00", "machine": "GT-75", "available": True, "program": "bushing.nc",
    "state": "RUNNING", "waiting_for": "", "line": 26, "made": 57, "time_left": 31.0, "last_cycle": 49.4,
    "spindle_load": 35, "stop": "", "alarms": [],
    "stops": [
        {"at": "2026-03-02T08:57:31+00:00", "reason": "BETWEEN CYCLES", "seconds": 1500},
        {"at": "2026-03-02T08:24:02+00:00", "reason": "FEED HOLD", "seconds": 95},
    ],
}  # fmt: skip
OTHERS = (
    OtherDesk(
        "lathe2:8317", {"machine": "LATHE 2", "state": "FEED HOLD", "program": "grooves.nc", "made": 41}
    ),
    OtherDesk("LATHE 3 (lathe3:8317)", trouble="Connection refused"),
)


def main(argv: list[str] | None = None) -> int:
    """Write the pictures; the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tests.screen.browser_pictures", description=__doc__)
    parser.add_argument("out", metavar="OUT", type=Path, help="folder for the PNG files")
    parser.add_argument("--language", default="en", choices=("en", "es"), help="default en")
    args = parser.parse_args(argv)
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        parser.error(f"none of {', '.join(BROWSERS)} is installed; these pictures are what a browser shows")
    os.environ["QT_QPA_PLATFORM"], os.environ["TZ"] = "offscreen", "UTC"
    time.tzset()
    app = QApplication.instance() or QApplication(sys.argv[:1])
    speak_in(args.language)
    args.out.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder:
        os.environ["TURNDESK_HOME"] = folder
        for each in sorted((Path(__file__).parents[1] / "extras").glob("*/browser_pages.py")):
            module = import_module(f"tests.extras.{each.parent.name}.browser_pages")
            for name, (page, size) in module.written(Path(folder)).items():
                _taken(browser, page.as_uri(), args.out / f"{name}.png", size)
        for address in _office():
            _taken(browser, address, args.out / "office.png", (740, 1060))
    del app
    return 0


def _office() -> Iterator[str]:
    """The address of the page, while it is served."""
    machine = load_machine(None)
    setup = setup_with(machine, read_offsets(samples() / "offsets.toml"))
    job = make_job(load_source(samples() / "bushing.nc"), setup)
    drawn = office_pictures(machine, dict, partial(kept_part, lambda _key: None))(job, lambda _done: None)
    part = png_of(drawn.pixels, drawn.width, drawn.height) if drawn is not None else b""
    page = StatusPage("GT-75", "", lambda: STATUS, lambda: OTHERS, lambda: part, lambda: b"")
    listening = listening_at("127.0.0.1", 0)
    server = PageServer(page, listening, lambda: None)
    server.start()
    yield f"http://127.0.0.1:{listening.getsockname()[1]}/"
    server.close()


def _taken(browser: str, address: str, path: Path, size: tuple[int, int]) -> None:
    """What the browser shows of an address, in a window of this size."""
    options = ["--headless", "--no-sandbox", "--hide-scrollbars", f"--window-size={size[0]},{size[1]}"]
    with TemporaryDirectory() as profile:
        command = [browser, *options, f"--user-data-dir={profile}", f"--screenshot={path}", address]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    if not lean(QImage(str(path))).save(str(path), "PNG", 1):  # type: ignore[call-overload]
        raise OSError(f"{path} cannot be written")
    sys.stdout.write(f"{path}\n")


if __name__ == "__main__":
    sys.exit(main())
