"""Data folder of this installation (``TURNDESK_HOME``) with its store, logs and settings."""

from __future__ import annotations

import os
from pathlib import Path

from core.message import CodedError, Message

HOME_VARIABLE = "TURNDESK_HOME"
BACKUPS_FOLDER_NAME = "backups"  # Subfolder for backups.
RECORDS_FOLDER_NAME = "records"  # Subfolder for recordings of the scope.


class DataFolderError(CodedError):
    """Error raised because TURNDESK_HOME must be set but is not, or is not the path of a folder.

    The text explains how to set the variable.
    """


def check_data_folder() -> None:
    """Raise DataFolderError if TURNDESK_HOME is a file or is inside a file.

    DataFolderError is also raised if TURNDESK_HOME begins with ~ and the home folder is unknown. A folder
    that does not exist is accepted.
    """
    named = os.environ.get(HOME_VARIABLE, "")
    if not named:
        return
    folder = find_data_folder()
    there = next((each for each in (folder, *folder.parents) if each.exists()), folder)
    if there.exists() and not there.is_dir():
        template = (
            "TURNDESK_HOME: {folder} is a file, not a folder; set TURNDESK_HOME to a folder or unset it"
            if there == folder
            else "TURNDESK_HOME: {folder} is inside {present}, which is a file, not a folder; set "
            "TURNDESK_HOME to a folder or unset it"
        )
        raise DataFolderError(Message(template, folder=folder, present=there), "not-a-folder")


def find_data_folder() -> Path:
    """Return the folder of the store, logs and settings.

    This is ``TURNDESK_HOME`` if it is set, and otherwise the platform's data folder. Raises DataFolderError
    if the user has no home folder, as in a container, and the variable is not set or begins with ~.
    """
    named = os.environ.get(HOME_VARIABLE, "")
    try:
        if named:
            return Path(named).expanduser().absolute()
        from platformdirs import user_data_path  # noqa: PLC0415  needed only if no folder is specified

        return user_data_path("turndesk", appauthor=False)
    except RuntimeError as error:
        raise DataFolderError(
            "this user has no home folder; set TURNDESK_HOME to a folder", "no-home"
        ) from error
