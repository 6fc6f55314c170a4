"""Atomic writing of program files.

A file is written next to the target, flushed to the disk, and then renamed.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from core.file_lock import create_unfinished_folder
from core.file_replacement import create_synced_folder, replace_atomically, sync_all_files, sync_folder
from core.input_file import read_input_bytes
from core.language.source import MAX_FILE_BYTES, SourceError, load_source
from core.message import CodedError, Message, get_error_code


class FileOperationError(CodedError):
    """Failed file operation, with a message that states the reason.

    Each file is either unchanged or completely written. Of an operation with several steps, some may be
    complete. For example, a program may already have its new name, or some files may already be copied.
    """


def write_program_file(path: Path, data: bytes) -> None:
    """Replace a file atomically with ``data``, which must be valid program text.

    The temporary file is first read back as a program. It receives the permissions of the old file. Raise
    FileOperationError on failure.
    """
    target = path.resolve()  # the target of a link is replaced instead of the link
    with ExitStack() as stack:
        try:
            create_synced_folder(target.parent)
            draft = stack.enter_context(_make_temporary(target))
        except OSError as error:
            raise FileOperationError(
                Message("{target} CANNOT BE WRITTEN: {cause}", target=target.parent, cause=error.strerror),
                "cannot-write",
            ) from error
        try:
            _fill(draft, data)
            if load_source(draft).text.encode("utf-8", "replace") != data:
                raise FileOperationError(
                    "NOT SAVED: TEXT HAS CHARACTERS A PROGRAM FILE CANNOT STORE", "unstorable-text"
                )
            if target.exists():
                shutil.copymode(target, draft)
            replace_atomically(draft, target)
        except OSError as error:
            raise FileOperationError(
                Message("{target} CANNOT BE WRITTEN: {cause}", target=target.name, cause=error.strerror),
                "cannot-write",
            ) from error
        except SourceError as error:
            raise FileOperationError(
                Message("NOT SAVED: {error}", error=error), get_error_code(error)
            ) from error


def copy_to_medium(target: Path, data: bytes) -> None:
    """Copy a file to a removable medium atomically, and verify the copy.

    Raise FileOperationError on failure.
    """
    try:
        with _make_temporary(target) as draft:
            _fill(draft, data)
            if draft.read_bytes() != data:
                raise FileOperationError(
                    Message(
                        "VERIFICATION OF {target} FAILED. USE ANOTHER USB STICK",
                        target=target.name,
                    ),
                    "read-back-differs",
                )
            replace_atomically(draft, target)
    except OSError as error:
        raise FileOperationError(
            Message("{target} CANNOT BE WRITTEN: {cause}", target=target, cause=error.strerror),
            "cannot-write",
        ) from error


def write_new_file(target: Path, data: bytes) -> None:
    """Write a new file, and never replace an existing file.

    Raise FileOperationError if the name exists or the file cannot be written.
    """
    try:
        create_synced_folder(target.parent)
    except OSError as error:
        raise FileOperationError(
            Message("{target} CANNOT BE WRITTEN: {cause}", target=target.parent, cause=error.strerror),
            "cannot-write",
        ) from error
    try:
        with _make_temporary(target) as draft:
            _fill(draft, data)
            target.hardlink_to(draft)  # fails if the name exists
            sync_folder(target.parent)
    except FileExistsError as error:
        raise FileOperationError(
            Message("{other} ALREADY EXISTS. USE ANOTHER NAME", other=target.name), "name-in-use"
        ) from error
    except OSError as error:
        raise FileOperationError(
            Message("{target} CANNOT BE WRITTEN: {cause}", target=target, cause=error.strerror),
            "cannot-write",
        ) from error


def flush_folder(folder: Path) -> None:
    """Wait until all files of the folder are written to the medium.

    Raise FileOperationError on failure.
    """
    try:
        sync_folder(folder)
    except OSError as error:
        raise FileOperationError(
            Message(
                "FILES IN {folder} CANNOT BE SAVED TO THE DISK: {cause}", folder=folder, cause=error.strerror
            ),
            "cannot-write",
        ) from error
    sync_all_files()


def read_file_if_exists(path: Path) -> bytes | None:
    """Return the content of a file, or None if the file does not exist.

    Raise FileOperationError if the file cannot be read.
    """
    try:
        return read_input_bytes(path, MAX_FILE_BYTES)
    except FileNotFoundError:
        return None
    except OSError as error:
        raise FileOperationError(
            Message("{path} CANNOT BE READ: {cause}", path=path.name, cause=error.strerror),
            "unreadable",
        ) from error


@contextmanager
def _make_temporary(target: Path) -> Iterator[Path]:
    """Provide a path with the same name in a hidden temporary folder next to the target."""
    with create_unfinished_folder(target) as folder:
        yield folder / target.name


def _fill(path: Path, data: bytes) -> None:
    with path.open("wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
