"""Which file a typed name means."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.desk.program_folder import ProgramFolders


@pytest.fixture
def shelf(tmp_path: Path) -> ProgramFolders:
    mine, samples = tmp_path / "mine", tmp_path / "samples"
    mine.mkdir()
    samples.mkdir()
    (mine / "PART1").write_text("G90")
    (mine / "part10.nc").write_text("G90")
    (samples / "part1").write_text("G90")
    (samples / "knob.nc").write_text("G90")
    (samples / "notes.md").write_text("no program")
    (samples / ".hidden").write_text("G90")
    return ProgramFolders((mine, samples, tmp_path / "not there"))


def test_the_operators_folder_hides_the_samples(shelf: ProgramFolders) -> None:
    assert [entry.name for entry in shelf.entries()] == ["knob.nc", "PART1", "part10.nc"]
    assert shelf.find("part1") == shelf.folders[0] / "PART1"


@pytest.mark.parametrize("typed", ["knob", "KNOB.NC", " knob.nc "])
def test_case_and_ending_do_not_matter(shelf: ProgramFolders, typed: str) -> None:
    assert shelf.find(typed) == shelf.folders[1] / "knob.nc"


def test_a_path_is_taken_as_it_is(shelf: ProgramFolders) -> None:
    there = shelf.folders[1] / "notes.md"
    assert shelf.find(str(there)) == there


@pytest.mark.parametrize("typed", ["", "  ", "nosuch", "par", "/nowhere/knob.nc", "notes"])
def test_unknown_names_find_nothing(shelf: ProgramFolders, typed: str) -> None:
    assert shelf.find(typed) is None


def test_typing_narrows_the_list(shelf: ProgramFolders) -> None:
    assert [entry.name for entry in shelf.matching("PART")] == ["PART1", "part10.nc"]
    assert shelf.matching("xyz") == ()
