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
from pathlib import Path
from tempfile import TemporaryDirectory

from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication

from app.screen.screen_theme import set_language
from tests.extras.modules import of_extras
from tests.screen.pictures import lean

BROWSERS = ("chromium", "chromium-browser", "google-chrome")


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
    set_language(args.language)
    args.out.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder:
        os.environ["TURNDESK_HOME"] = folder
        for each in of_extras("browser_pages"):
            for name, address, size in getattr(each, "served", lambda: ())():
                _taken(browser, address, args.out / name, size)
            for name, (page, size) in getattr(each, "written", lambda _folder: {})(Path(folder)).items():
                _taken(browser, page.as_uri(), args.out / f"{name}.png", size)
    del app
    return 0


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
