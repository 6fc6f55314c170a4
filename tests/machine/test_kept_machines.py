"""Shipped machine files are read once: what is kept counts while text, readers and bytes are the same."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

import resources
from app.compose import kept_machines
from app.compose.machine_files import parse_machine
from core.machine.machine_model import Machine

NAMES = ("gt75-canopen.toml", "gt75-vfd.toml", "gt75-mesa-7i76e.toml", "ac-table-mill.toml")


@pytest.fixture(autouse=True)
def compiled(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where Python keeps what it has compiled, for this test alone."""
    monkeypatch.setattr(sys, "pycache_prefix", str(tmp_path / "compiled"))
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    return tmp_path / "compiled"


def kept(name: str) -> tuple[Path, str, Machine]:
    """A shipped file, its text and its machine, which is kept now."""
    file, text = resources.machine_path(name), resources.machine_file(name)
    machine = parse_machine(text, name)
    kept_machines.keep(file, text, machine)
    return file, text, machine


def the_file(compiled: Path) -> Path:
    (found,) = compiled.rglob("*.machine")
    return found


@pytest.mark.parametrize("name", NAMES)
def test_it_comes_back_as_it_was_read(name: str) -> None:
    file, text, machine = kept(name)
    assert kept_machines.find(file, text) == machine


def test_nothing_is_found_where_nothing_was_kept() -> None:
    name = "gt75.toml"
    assert kept_machines.find(resources.machine_path(name), resources.machine_file(name)) is None


def test_another_text_is_read_again() -> None:
    file, text, _ = kept("gt75.toml")
    assert kept_machines.find(file, text.replace("3500", "3400", 1)) is None


@pytest.mark.parametrize("at", [0, 40, -1])
def test_a_damaged_one_is_read_again(compiled: Path, at: int) -> None:
    file, text, _ = kept("gt75.toml")
    data = bytearray(the_file(compiled).read_bytes())
    data[at] ^= 1
    the_file(compiled).write_bytes(data)
    assert kept_machines.find(file, text) is None


def test_half_of_one_is_read_again(compiled: Path) -> None:
    file, text, _ = kept("gt75.toml")
    data = the_file(compiled).read_bytes()
    the_file(compiled).write_bytes(data[: len(data) // 2])
    assert kept_machines.find(file, text) is None


def test_it_counts_no_more_once_a_reader_is_changed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_machines, "_ROOT", tmp_path)
    reader = tmp_path / "core" / "table_schema.py"
    reader.parent.mkdir()
    reader.write_text("old")
    os.utime(reader, ns=(1, 1))
    monkeypatch.setattr(kept_machines, "_readers", lambda: [reader])
    monkeypatch.setattr(kept_machines, "_BEGUN", reader.stat().st_ctime_ns)
    file, text, machine = kept("gt75.toml")
    assert kept_machines.find(file, text) == machine
    reader.write_text("new")
    os.utime(reader, ns=(2, 2))
    assert kept_machines.find(file, text) is None
    reader.unlink()
    assert kept_machines.find(file, text) is None


def test_a_process_that_was_updated_under_way_keeps_nothing(
    tmp_path: Path, compiled: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It has read with the modules of before, and the stamps would be those of the new ones."""
    monkeypatch.setattr(kept_machines, "_ROOT", tmp_path)
    reader = tmp_path / "table_schema.py"
    reader.write_text("new")
    os.utime(reader, ns=(1, 1))  # as an archive has it: its time of change may be years ago
    monkeypatch.setattr(kept_machines, "_readers", lambda: [reader])
    monkeypatch.setattr(kept_machines, "_BEGUN", reader.stat().st_ctime_ns - 1)
    kept("gt75.toml")
    assert not [each for each in compiled.rglob("*") if each.is_file()]


def test_the_readers_are_those_of_the_file_and_none_else() -> None:
    kept("gt75.toml")
    names = {path.name for path in kept_machines._readers()}
    assert {"machine_file.py", "table_schema.py", "machine_drivers.py", "canopen_table.py"} <= names
    assert "lines_and_arcs.py" not in names


def test_who_wants_nothing_compiled_gets_nothing_kept(
    compiled: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    kept("gt75.toml")
    assert not compiled.exists()


def test_a_folder_that_takes_nothing_does_no_harm(compiled: Path) -> None:
    compiled.write_text("a file where the folder should be")
    file, text, _ = kept("gt75.toml")
    assert kept_machines.find(file, text) is None


def test_nothing_is_left_aside(compiled: Path) -> None:
    kept("gt75.toml")
    kept("gt75.toml")
    assert len([each for each in compiled.rglob("*") if each.is_file()]) == 1
