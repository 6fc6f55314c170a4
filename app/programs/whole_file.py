"""Atomic writing of program files: written next to the target, flushed to the disk, then renamed."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from core.file_lock import unfinished_folder
from core.file_placing import all_to_disk, folder_to_disk, make_folder, put_in_place
from core.input_file import input_bytes
from core.language.source import LARGEST_FILE, SourceError, load_source
from core.message import CodedError, Message, error_code


class FileError(CodedError):
    """Failed file operation that left the file unchanged. The message states the reason."""


def write_whole(path: Path, data: bytes) -> None:
    """Replace a file atomically with ``data``, which must be valid program text.

    The draft is read back as a program first and receives the permissions of the old file. Raises FileError.
    """
    target = path.resolve()  # the target of a link is replaced instead of the link
    with ExitStack() as stack:
        try:
            make_folder(target.parent)
            draft = stack.enter_context(_beside(target))
        except OSError as error:
            raise FileError(
                Message("{target} CANNOT BE WRITTEN: {cause}", target=target.parent, cause=error.strerror),
                "cannot-write",
            ) from error
        try:
            _fill(draft, data)
            if load_source(draft).text.encode("utf-8", "replace") != data:
                raise FileError(
                    "NOT SAVED: TEXT HAS CHARACTERS A PROGRAM FILE CANNOT STORE", "unstorable-text"
                )
            if target.exists():
                shutil.copymode(target, draft)
            put_in_place(draft, target)
        except OSError as error:
            raise FileError(
                Message("{target} CANNOT BE WRITTEN: {cause}", target=target.name, cause=error.strerror),
                "cannot-write",
            ) from error
        except SourceError as error:
            raise FileError(Message("NOT SAVED: {error}", error=error), error_code(error)) from error


def write_out(target: Path, data: bytes) -> None:
    """Copy a file to a removable medium atomically, and verify it. Raises FileError."""
    try:
        with _beside(target) as draft:
            _fill(draft, data)
            if draft.read_bytes() != data:
                raise FileError(
                    Message(
                        "VERIFICATION OF {target} FAILED. USE ANOTHER USB STICK",
                        target=target.name,
                    ),
                    "read-back-differs",
                )
            put_in_place(draft, target)
    except OSError as error:
        raise FileError(
            Message("{target} CANNOT BE WRITTEN: {cause}", target=target, cause=error.strerror),
            "cannot-write",
        ) from error


def write_new(target: Path, data: bytes) -> None:
    """Write a new file without ever replacing an existing one. Raises FileError if the name exists."""
    try:
        make_folder(target.parent)
    except OSError as error:
        raise FileError(
            Message("{target} CANNOT BE WRITTEN: {cause}", target=target.parent, cause=error.strerror),
            "cannot-write",
        ) from error
    try:
        with _beside(target) as draft:
            _fill(draft, data)
            target.hardlink_to(draft)  # fails if the name exists
            folder_to_disk(target.parent)
    except FileExistsError as error:
        raise FileError(
            Message("{other} ALREADY EXISTS. USE ANOTHER NAME", other=target.name), "name-in-use"
        ) from error
    except OSError as error:
        raise FileError(
            Message("{target} CANNOT BE WRITTEN: {cause}", target=target, cause=error.strerror),
            "cannot-write",
        ) from error


def settle(folder: Path) -> None:
    """Wait until all files of the folder are written to the medium. Raises FileError."""
    try:
        folder_to_disk(folder)
    except OSError as error:
        raise FileError(
            Message(
                "FILES IN {folder} CANNOT BE SAVED TO THE DISK: {cause}", folder=folder, cause=error.strerror
            ),
            "cannot-write",
        ) from error
    all_to_disk()


def present(path: Path) -> bytes | None:
    """Return the content of a file, or None if it does not exist.

    Raises FileError if it cannot be read.
    """
    try:
        return input_bytes(path, LARGEST_FILE)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise FileError(
            Message("{path} CANNOT BE READ: {cause}", path=path.name, cause=error.strerror),
            "unreadable",
        ) from error


@contextmanager
def _beside(target: Path) -> Iterator[Path]:
    """Provide a path with the same name in a hidden temporary folder next to the target."""
    with unfinished_folder(target) as folder:
        yield folder / target.name


def _fill(path: Path, data: bytes) -> None:
    with path.open("wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
