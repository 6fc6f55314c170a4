"""Pictures of the pages that a browser shows: ``python -m tests.screen.browser_pictures OUT``.

The shift report of a morning that this script has made up, and pages of optional features, by Chromium.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from datetime import UTC, datetime, timedelta
from functools import partial
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication

from app.quality.shift_figures import shift_figures
from app.quality.shift_page import shift_html
from app.quality.shift_times import Shift
from app.screen.language import speak_in
from core.store.event_log import log
from core.store.production import measured_parts, part_cycles, tool_lives
from core.store.production.measured_parts import FeatureRow, ReadingRow
from core.store.production.part_cycles import CycleRow, StopRow
from core.store.production.tool_lives import LifeRow
from core.store.store import Store
from core.store.store_rows import EventRow, utc
from tests.screen.pictures import lean

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
BEGIN = datetime(2026, 3, 2, 6, tzinfo=UTC)


class Run(NamedTuple):
    """Parts one behind the other, and what stood behind them."""

    program: str
    parts: int
    seconds: float  # of the shortest; every third takes one more, every fifth another
    stop: str
    stood: float
    line: int = 0


MORNING = (
    Run("bushing.nc", 20, 151.0, "FEED HOLD", 95.0, 14),
    Run("bushing.nc", 36, 151.0, "E-STOP", 1260.0, 14),
    Run("bushing.nc", 23, 151.0, "BETWEEN CYCLES", 1500.0),
    Run("grooves.nc", 41, 92.0, "", 0.0),
)
ALARM = "102 FOLLOWING ERROR: X STANDS 0.31 mm OFF"
SIZES = (0, 1, 2, 4, 6, 11, 12, 13)  # ten thousandths of an inch off, of every tenth part


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
        page = Path(folder) / "shift.html"
        page.write_text(shift_report(Path(folder)), encoding="utf-8")
        _taken(browser, page.as_uri(), args.out / "shift.png", (740, 830))
        for pages in sorted((Path(__file__).parents[1] / "extras").glob("*/browser_pages.py")):
            served = import_module(f"tests.extras.{pages.parent.name}.browser_pages").served()
            for name, address, size in served:
                _taken(browser, address, args.out / name, size)
    del app
    return 0


def shift_report(folder: Path) -> str:
    """The HTML of a made-up morning, kept in a store in the folder."""
    with Store.open(folder) as store:
        _fill(store)
        shift = Shift(BEGIN.timestamp(), (BEGIN + timedelta(hours=8)).timestamp())
        found = shift_figures(store, shift, shift.end + 120.0)
        return shift_html(found, "GT-75", "2026-03-02 14:02", metric=False)


def _fill(store: Store) -> None:
    """Parts, stops, an alarm, readings that leave their tolerance, and two lives."""
    at, part = BEGIN + timedelta(minutes=4), 0
    for run in MORNING:
        for number in range(run.parts):
            part = part + 1 if part and run.program == "bushing.nc" else number + 1
            seconds = run.seconds + (number % 3 == 0) + (number % 5 == 0)
            end = at + timedelta(seconds=seconds)
            made = CycleRow(f"{at:%H%M%S}", run.program, part, utc(at), utc(end), seconds, "COMPLETE")
            store.write(partial(part_cycles.save_cycle, row=made)).result()
            at = end + timedelta(seconds=3)
        if run.stop:
            stop = StopRow(f"{at:%H%M%S}", "", run.program, utc(at), run.stood, run.stop, run.line)
            store.write(partial(part_cycles.save_stop, row=stop)).result()
        if run.stop == "E-STOP":
            alarm = EventRow(utc(at), "alarm", ALARM, run.line)
            store.write(partial(log, events=[alarm])).result()
        at += timedelta(seconds=run.stood)
    feature = FeatureRow(0, "bushing.nc", "OUTSIDE", "diameter", 22.225, -0.0254, 0.0254, "tool", 1, 1, 5, 1)
    kept = store.write(partial(measured_parts.save_feature, row=feature)).result()
    for number, off in enumerate(SIZES, start=1):
        read = utc(BEGIN + timedelta(minutes=26 * number))
        size = 22.225 + off * 0.00254
        row = ReadingRow(0, kept, 10 * number, size, "in", read, "gauge", "micrometer")
        store.write(partial(measured_parts.add_reading, row=row)).result()
    store.write(partial(tool_lives.set_limits, row=LifeRow(1, 200, 0.0, 0.9, True))).result()
    store.write(lambda c: tool_lives.set_use(c, 1, 184, 4020.0)).result()


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
