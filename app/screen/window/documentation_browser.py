"""Opening of the installed documentation site in the browser of the desktop."""

from __future__ import annotations

import shutil
import sys
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from PySide6.QtCore import QUrl
from PySide6.QtGui import QDesktopServices

from app.desk.desk import Desk
from app.desk.pages.page_entry import MANUAL_STATES
from app.desk.status.prompt_line import ACTIVE_STATES
from resources import get_documents_folder

DOCUMENTS_FOLDER_NAME = "documents"
_PROJECT_FOLDER = Path(__file__).parents[3]
_LINUX_BROWSERS = (
    "x-www-browser",
    "firefox",
    "firefox-esr",
    "chromium",
    "google-chrome",
    "epiphany",
    "falkon",
)


def find_documents_folder() -> Path | None:
    """Return the folder of the documentation site that a package has installed, or None without a site."""
    folder = get_documents_folder()
    return folder if (folder / "index.html").is_file() else None


def find_section_path(address: str) -> str:
    """Return the path that the help shows for the section at an address of the site.

    The path leads to the installed site or, in a clone, to the page in Markdown. It is empty if neither
    exists.
    """
    if find_documents_folder() is not None:
        return f"{DOCUMENTS_FOLDER_NAME}/{address}"
    file, _, anchor = address.partition("#")
    page = PurePosixPath(file).with_suffix(".md")
    return f"{page}#{anchor}" if (_PROJECT_FOLDER / page).is_file() else ""


def has_browser() -> bool:
    """Return whether the desktop has a browser. Windows and macOS always have one."""
    return not sys.platform.startswith("linux") or any(map(shutil.which, _LINUX_BROWSERS))


@dataclass(frozen=True, slots=True)
class DocumentationBrowser:
    """Browser of the desktop, which shows sections of the documentation site.

    A kiosk has no desktop, so nothing is opened there.
    """

    desk: Desk
    is_kiosk: bool

    def is_available(self) -> bool:
        """Return whether sections can be shown: not on a kiosk, with an installed site and a browser."""
        return not self.is_kiosk and find_documents_folder() is not None and has_browser()

    def open_section(self, address: str) -> bool:
        """Show the section at an address of the site, and return False after a message if it is not shown.

        The browser takes the keyboard. It is therefore not opened while the machine moves.
        """
        folder, snapshot = find_documents_folder(), self.desk.read_snapshot()
        file, _, anchor = address.partition("#")
        if snapshot.state in ACTIVE_STATES | MANUAL_STATES or snapshot.rpm_command:
            self.desk.say("STOP AXES AND SPINDLE BEFORE OPENING THE BROWSER")
            return False
        if not self.is_available() or folder is None or not (folder / file).is_file():
            self.desk.say("THE DOCUMENTATION IS NOT INSTALLED ON THIS COMPUTER")
            return False
        url = QUrl.fromLocalFile(str(folder / file))
        url.setFragment(anchor)
        if not QDesktopServices.openUrl(url):
            self.desk.say("THE BROWSER DOES NOT START. OPEN THE ADDRESS ON ANOTHER COMPUTER")
            return False
        return True
