"""A received program becomes a new file or none."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.programs.atomic_files import FileOperationError
from app.transfer.line_transfer import ReceivedProgram, find_unused_name, store_received_program
from tests.texts import pattern


def received(name: str = "O77.nc") -> ReceivedProgram:
    return ReceivedProgram(b"M30\n", name, 1, "", False, 0, (), 0.0)


def test_received_program_is_saved_with_its_extension(tmp_path: Path) -> None:
    path = store_received_program(received(), tmp_path / "programs", "O77")
    assert path == tmp_path / "programs" / "O77.nc"
    assert path.read_bytes() == b"M30\n"
    assert [each.name for each in path.parent.iterdir()] == ["O77.nc"]


def test_renamed_klartext_program_retains_its_extension(tmp_path: Path) -> None:
    assert store_received_program(received("PLATE.h"), tmp_path, "ROOF").name == "ROOF.h"


@pytest.mark.parametrize("name", ["O77", "O77.nc", "o77.NC"])
def test_existing_file_is_not_overwritten(tmp_path: Path, name: str) -> None:
    (tmp_path / "O77.nc").write_bytes(b"OLD\n")
    with pytest.raises(FileOperationError, match=pattern("files.name-taken", file="O77.nc")):
        store_received_program(received(), tmp_path, name)
    assert (tmp_path / "O77.nc").read_bytes() == b"OLD\n"
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("name", ["", "  ", "../O77", "a/b", ".hidden"])
def test_invalid_names_are_rejected(tmp_path: Path, name: str) -> None:
    with pytest.raises(FileOperationError):
        store_received_program(received(), tmp_path, name)
    assert list(tmp_path.iterdir()) == []


def test_write_error_is_reported_in_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(FileOperationError, match=pattern("files.not-written", path=tmp_path / "file")):
        store_received_program(received(), tmp_path / "file", "O77")


def test_a_name_that_is_free_is_offered(tmp_path: Path) -> None:
    assert find_unused_name(tmp_path, "O77.nc") == "O77.nc"
    assert find_unused_name(tmp_path, "RING.mpf") == "RING.mpf"
    (tmp_path / "o77.NC").write_bytes(b"")
    (tmp_path / "O77-2.nc").write_bytes(b"")
    assert find_unused_name(tmp_path, "O77.nc") == "O77-3.nc"
