"""The data folder (TURNDESK_HOME): where this installation keeps store, logs and settings."""

from __future__ import annotations

import os
from pathlib import Path

from core.message import CodedError, Message

HOME = "TURNDESK_HOME"
BACKUPS = "backups"  # the folder of backups, within it
RECORDS = "records"  # the folder of what the scope has recorded, within it


class DataFolderError(CodedError):
    """TURNDESK_HOME names no folder, or has to; ``str()`` is the sentence for whoever can set it."""


def check_data_folder() -> None:
    """Refuse a TURNDESK_HOME that is a file or lies below one; one that is not there yet will be made.

    Raises HomeError.
    """
    named = os.environ.get(HOME, "")
    if not named:
        return
    folder = data_folder()
    there = next((each for each in (folder, *folder.parents) if each.exists()), folder)
    if there.exists() and not there.is_dir():
        template = (
            "TURNDESK_HOME: {folder} is a file, not a folder; set TURNDESK_HOME to a folder or unset it"
            if there == folder
            else "TURNDESK_HOME: {folder} is inside {present}, which is a file, not a folder; set "
            "TURNDESK_HOME to a folder or unset it"
        )
        raise DataFolderError(Message(template, folder=folder, present=there), "not-a-folder")


def data_folder() -> Path:
    """The folder of store, logs and settings: ``TURNDESK_HOME``, else the platform's data folder.

    Raises DataFolderError for a user without a home, as in a container.
    """
    named = os.environ.get(HOME, "")
    try:
        if named:
            return Path(named).expanduser().absolute()
        from platformdirs import user_data_path  # noqa: PLC0415  asked only where nobody has named a folder

        return user_data_path("turndesk", appauthor=False)
    except RuntimeError as error:
        raise DataFolderError(
            "this user has no home folder; set TURNDESK_HOME to a folder", "no-home"
        ) from error
