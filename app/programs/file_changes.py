"""Copying, renaming and deleting programs. On a worker; nothing is ever overwritten."""

from __future__ import annotations

from pathlib import Path

from app.desk.persistence import Persistence
from app.desk.program_folder import ENDINGS
from app.programs.whole_file import SavingError, present, write_whole
from core.store.program_records import check_name
from core.store.store_errors import StoreError


class FileError(Exception):
    """It was not done; the sentence says why."""


def good_name(name: str, like: Path) -> str:
    """``name`` with the ending of ``like`` where it has none. Raises FileError for what names no program."""
    name = name.strip()
    if not name:
        raise FileError("NOTHING IS ENTERED; TYPE A NAME")
    if Path(name).suffix.lower() not in ENDINGS - {""}:
        name += like.suffix
    try:
        check_name(name)
    except StoreError as error:
        raise FileError(str(error)) from error
    if name.startswith("."):
        raise FileError(f"{name} WOULD BE HIDDEN; TAKE A NAME WITHOUT A POINT IN FRONT")
    return name


def taken(folder: Path, name: str) -> str:
    """The file of this name, in any case of letters; empty when there is none."""
    try:
        names = [path.name for path in folder.iterdir()]
    except OSError:
        return ""
    return next((other for other in names if other.lower() == name.lower()), "")


def copied(source: Path, folder: Path, name: str) -> str:
    """A copy in the operator's folder; its name. Raises FileError."""
    name = good_name(name, source)
    _free(folder, name)
    _write(folder / name, _read(source))
    return name


def renamed(source: Path, name: str, keep: Persistence) -> str:
    """Another name; versions, count and record go along. Raises FileError."""
    name = good_name(name, source)
    if name == source.name:
        raise FileError(f"{name} IS ITS NAME ALREADY")
    if name.lower() != source.name.lower():
        _free(source.parent, name)
    try:
        source.rename(source.with_name(name))
        keep.renamed(source.name, name)
    except OSError as error:
        raise FileError(f"{source.name} CANNOT BE RENAMED: {error.strerror}") from error
    except StoreError as error:
        raise FileError(f"RENAMED, BUT ITS VERSIONS STAY UNDER {source.name}: {error}") from error
    return name


def deleted(path: Path, keep: Persistence) -> str:
    """The file goes, its text stays as a version. Raises FileError, and then the file is still there."""
    try:
        keep.keep_text(path.name, _read(path), "deleted")
        path.unlink()
    except StoreError as error:
        raise FileError(f"NOT DELETED, BECAUSE ITS TEXT CANNOT BE KEPT: {error}") from error
    except OSError as error:
        raise FileError(f"{path.name} CANNOT BE DELETED: {error.strerror}") from error
    return path.name


def _free(folder: Path, name: str) -> None:
    if other := taken(folder, name):
        raise FileError(f"{other} IS THERE ALREADY; TAKE ANOTHER NAME")


def _read(path: Path) -> bytes:
    try:
        data = present(path)
    except SavingError as error:
        raise FileError(str(error)) from error
    if data is None:
        raise FileError(f"{path.name} IS NOT THERE ANY MORE")
    return data


def _write(path: Path, data: bytes) -> None:
    try:
        write_whole(path, data)
    except SavingError as error:
        raise FileError(str(error)) from error
