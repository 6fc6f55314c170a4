"""Desktop menu entry, icon, file types and autostart entry in the XDG folders."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from contextlib import suppress
from importlib.resources import files
from pathlib import Path

from app.desk.command_errors import CommandError, make_write_error
from core.message import Message

ENTRY_NAME = "turndesk"
_RESERVED = re.compile(r"""[\s"'\\><~|&;$*?#()`]""")
_ENTRY = """[Desktop Entry]
Type=Application
Name=TurnDesk
GenericName=CNC lathe control
Comment=Operator screen for OmniTurn-style lathes
Comment[es]=El puesto de mando para tornos tipo OmniTurn
Exec={command}
Icon=turndesk
MimeType=application/x-omniturn;application/x-sinumerik;application/x-klartext;
Categories=Engineering;Science;
StartupWMClass=turndesk
Terminal=false
"""


def _under(variable: str, otherwise: str) -> Path:
    named = os.environ.get(variable, "")
    try:
        return Path(named) if named else Path.home() / otherwise
    except RuntimeError as error:
        raise CommandError(
            Message(
                "this user has no home folder; set the environment variable {variable} to a folder",
                variable=variable,
            ),
            "no-home",
        ) from error


def _entry_paths() -> tuple[Path, Path, Path, Path]:
    """Return the paths of the menu entry, the icon, the file types and the autostart entry."""
    data, config = _under("XDG_DATA_HOME", ".local/share"), _under("XDG_CONFIG_HOME", ".config")
    return (
        data / "applications" / f"{ENTRY_NAME}.desktop",
        data / "icons" / "hicolor" / "scalable" / "apps" / f"{ENTRY_NAME}.svg",
        data / "mime" / "packages" / f"{ENTRY_NAME}.xml",
        config / "autostart" / f"{ENTRY_NAME}.desktop",
    )


def _command() -> str:
    """Return the shell command that starts this installation of TurnDesk."""
    entry_path = Path(sys.executable).with_name(ENTRY_NAME)
    if entry_path.exists():
        return _quote_word(str(entry_path))
    return Message("{executable} -m app.cli.main", executable=_quote_word(sys.executable))


def _quote_word(word: str) -> str:
    """Return a word quoted for the Exec line of a desktop entry. Each % is doubled."""
    if not _RESERVED.search(word):
        return word.replace("%", "%%")
    inside = re.sub(r'(["`$\\])', r"\\\1", word).replace("%", "%%")
    return '"' + inside.replace("\\", "\\\\") + '"'  # values of a desktop entry have another level of escapes


def install_desktop_entries(*, autostart: bool) -> list[Path]:
    """Write the desktop entries and return their paths.

    The autostart entry is written only if ``autostart`` is true. Raises CommandError if a file cannot be
    written, or if the user has no home folder and an XDG variable is not set.
    """
    entry, icon, types, start = _entry_paths()
    shipped = files("resources") / "desktop"
    try:
        for path in (entry, icon, types, *((start,) if autostart else ())):
            path.parent.mkdir(parents=True, exist_ok=True)
        entry.write_text(format_desktop_entry(f"{_command()} %f"), encoding="utf-8")
        shutil.copyfile(str(shipped / f"{ENTRY_NAME}.svg"), icon)
        shutil.copyfile(str(shipped / f"{ENTRY_NAME}.xml"), types)
        if autostart:
            start.write_text(format_desktop_entry(f"{_command()} --kiosk"), encoding="utf-8")
    except OSError as error:
        raise make_write_error(error.filename, error) from error
    _update_databases(entry.parent, types.parent.parent)
    return [entry, icon, types, *([start] if autostart else [])]


def format_desktop_entry(command: str) -> str:
    """Return the text of a desktop entry that runs ``command``."""
    return _ENTRY.format(command=command)


def _update_databases(applications: Path, mime: Path) -> None:
    """Update the desktop databases, so that file managers find the new entry immediately.

    A database is skipped if the tool that updates it is not installed, cannot run or hangs. The system
    updates the database later.
    """
    for tool, folder in (("update-desktop-database", applications), ("update-mime-database", mime)):
        if shutil.which(tool) and folder.is_dir():
            with suppress(OSError, subprocess.TimeoutExpired):
                subprocess.run([tool, str(folder)], check=False, capture_output=True, timeout=60)


def remove_desktop_entries() -> list[Path]:
    """Remove the existing desktop entries and return their paths.

    Raises CommandError if a file cannot be removed, or if the user has no home folder and an XDG variable
    is not set.
    """
    there = [path for path in _entry_paths() if path.exists()]
    for path in there:
        try:
            path.unlink()
        except OSError as error:
            raise CommandError(
                Message("{path} cannot be removed: {cause}", path=path, cause=error.strerror),
                "cannot-remove",
            ) from error
    _update_databases(_entry_paths()[0].parent, _entry_paths()[2].parent.parent)
    return there
