"""A name may be that of a pipe, a device, a folder or 3 GB; every reader has its own error for each."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import NamedTuple

import canopen
import pytest

from app.cli.program_options import read_inputs_file
from app.compose.machine.setup_file import check_setup
from app.desk.command_errors import CommandError
from app.offsets.offsets_file import read_offset_rows, read_tool_shapes
from app.programs.atomic_files import FileOperationError, read_file_if_exists
from core.input_file import (
    NotAFileError,
    TooLargeError,
    convert_exceptions,
    open_input_file,
    read_input_bytes,
)
from core.language.source import SourceError, load_source
from core.machine.machine_file import read_machine_text
from core.message import CodedError
from core.ports import DriverError
from core.records.record import RecordError
from core.records.record_file import open_record
from core.store import backup
from core.store.store_errors import StoreError
from core.table_schema import MachineFileError
from drivers.canopen.canopen_objects import load_object_dictionary
from tests.coded import raises_code
from tests.extras.modules import of_extras

_HUGE = 3_000_000_000


class Door(NamedTuple):
    """A reader, and the codes of its errors for what is no file and for what is too large."""

    name: str
    read: Callable[[Path], object]
    error: type[Exception]
    no_file: str
    too_large: str


def _dictionary(path: Path) -> object:
    return load_object_dictionary("X", str(path), canopen.ObjectDictionary)


DOORS = (
    Door("part.nc", load_source, SourceError, "file-unreadable", "file-too-large"),
    Door("part.h", load_source, SourceError, "file-unreadable", "file-too-large"),
    Door("part.mpf", load_source, SourceError, "file-unreadable", "file-too-large"),
    Door("old.nc", read_file_if_exists, FileOperationError, "unreadable", "unreadable"),
    Door("lathe.toml", read_machine_text, MachineFileError, "unreadable", "too-large"),
    Door("offsets.toml", read_offset_rows, CommandError, "unreadable", "too-large"),
    Door("tools.toml", read_tool_shapes, CommandError, "unreadable", "too-large"),
    Door("inputs.toml", read_inputs_file, CommandError, "unreadable", "too-large"),
    Door("alarm.scope", open_record, RecordError, "unusable", "too-large"),
    Door("now.ring", open_record, RecordError, "unusable", "too-large"),
    Door("lathe.setup", check_setup, CommandError, "unreadable", "too-large"),
    Door(
        "backup.db", backup.find_store_problems, StoreError, "not-a-file", "not-a-database"
    ),  # it is read by pages
    Door(
        "x.eds",
        lambda path: load_object_dictionary("X", str(path), canopen.ObjectDictionary),
        DriverError,
        "driver",
        "driver",
    ),
    *(Door(*door) for each in of_extras("doors") for door in each.DOORS),
)
each_door = pytest.mark.parametrize("door", DOORS, ids=lambda door: door.name)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
@each_door
def test_pipe_without_a_writer_does_not_hang(door: Door, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / door.name)
    with raises_code(door.error, door.no_file, door.name):
        door.read(tmp_path / door.name)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no device here that never ends")
@each_door
def test_device_is_rejected(door: Door, tmp_path: Path) -> None:
    (tmp_path / door.name).symlink_to("/dev/zero")
    with raises_code(door.error, door.no_file, door.name):
        door.read(tmp_path / door.name)


@each_door
def test_folder_is_rejected(door: Door, tmp_path: Path) -> None:
    (tmp_path / door.name).mkdir()
    with pytest.raises(door.error) as raised:
        door.read(tmp_path / door.name)
    assert door.name in str(raised.value)


@each_door
def test_three_gigabyte_file_is_not_read(door: Door, tmp_path: Path) -> None:
    path = tmp_path / door.name
    with path.open("wb") as file:
        file.write(b"TurnDesk ring\n" if door.name.endswith(".ring") else b"PK")
        file.truncate(_HUGE)
    with raises_code(door.error, door.too_large, door.name):
        door.read(path)


@each_door
def test_impossible_file_name_is_rejected(door: Door, tmp_path: Path) -> None:
    with pytest.raises(door.error):
        door.read(tmp_path / f"a\0{door.name}")


# --- the door itself


def test_file_size_is_limited(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(bytes(100))
    assert read_input_bytes(path, 100) == bytes(100)
    with pytest.raises(TooLargeError):
        read_input_bytes(path, 99)


@pytest.mark.parametrize(
    ("limit", "shown"),
    [
        (99, "99 bytes"),
        (64 * 1024, "64 KB"),
        (1536, "1.5 KB"),
        (16 * 1024**2, "16 MB"),
        (1_600_000, "1.526 MB"),
    ],
)
def test_file_size_limit_is_reported_with_its_unit(tmp_path: Path, limit: int, shown: str) -> None:
    path = tmp_path / "a"
    with path.open("wb") as file:
        file.truncate(limit + 1)
    with pytest.raises(TooLargeError) as told:
        read_input_bytes(path, limit)
    assert told.value.strerror == f"the file is larger than {shown}"


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="no files here whose size is not known")
def test_file_that_reports_zero_size_is_also_limited() -> None:
    with pytest.raises(TooLargeError):
        read_input_bytes(Path("/proc/self/status"), 10)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_rejected_pipe_is_closed_again(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(NotAFileError):
        open_input_file(tmp_path / "pipe")
    with pytest.raises(OSError, match="No such device"):  # nobody has it open for reading
        os.open(tmp_path / "pipe", os.O_WRONLY | os.O_NONBLOCK)


@pytest.mark.parametrize(
    "error", [ValueError(), KeyError("x"), MemoryError(), RecursionError(), OSError(5, "x")]
)
def test_parser_exception_is_converted_to_the_reader_error(error: Exception) -> None:
    with pytest.raises(CodedError) as raised, convert_exceptions(lambda _: CodedError("damaged", "damaged")):
        raise error
    assert raised.value.__cause__ is error


def test_coded_error_is_passed_unchanged() -> None:
    own = partial(CodedError, "own", "own")
    with raises_code(CodedError, "own"), convert_exceptions(lambda _: CodedError("other", "other")):
        raise own()
