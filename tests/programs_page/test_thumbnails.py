"""Thumbnails of programs: made once, found by their contents, and none where there is no part."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import resources
from app.compose.desk_part import PartDesk
from app.compose.machine.machine_files import load_machine, parse_machine
from app.compose.stored_offsets import Offsets
from app.compose.thumbnails import HIGH, WIDE, Thumbnails
from app.compose.workshop import workshop
from app.desk.background_work import Watch
from app.desk.kept_part import NOTHING_KEPT, KeptPart
from app.programs.program_rows import Preview, Program, Thumbnail
from core.executor.job import Job
from core.language.source import Source, load_source
from core.machine.machine_model import Machine
from core.proving import part_history
from core.store.store_rows import RunRow
from tests.desk.test_part_found import LIMIT, SHAFT, TOOLS


def job(text: str, machine: Machine | None = None, name: str = "part.nc") -> Job:
    steps = workshop(machine or load_machine(None), lambda: Offsets(TOOLS, {}, {}))
    return steps.make_job(Source(name, text), False)


def thumbnails(folder: Path, kept: KeptPart = NOTHING_KEPT, machine: Machine | None = None) -> Thumbnails:
    machine = machine or load_machine(None)
    return Thumbnails(folder, machine, PartDesk(machine, dict, lambda _name: kept, load_source))


def go_on(_count: float) -> None:
    """Somebody still wants it."""


def seen(picture: Thumbnail | None) -> int:
    """How many pixels are part."""
    assert picture is not None
    assert (picture.width, picture.height) == (WIDE, HIGH)
    return int((np.frombuffer(picture.pixels, np.uint32) >> 24 > 0).sum())


def test_the_part_is_drawn_and_found_again_without_being_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    small = thumbnails(tmp_path)
    first = small.of(job(SHAFT), go_on)
    assert seen(first) > 0.1 * WIDE * HIGH
    monkeypatch.setattr(Thumbnails, "_made", None)  # nothing is made any more
    assert small.of(job(SHAFT), go_on) == first


def test_another_text_or_another_stock_is_another_picture(tmp_path: Path) -> None:
    first = thumbnails(tmp_path).of(job(SHAFT), go_on)
    assert thumbnails(tmp_path).of(job(SHAFT.replace("Z-.5", "Z-.3")), go_on) != first
    assert thumbnails(tmp_path, KeptPart("bar:2")).of(job(SHAFT), go_on) != first
    assert len(list(tmp_path.iterdir())) == 3


@pytest.mark.parametrize("damage", [b"", b"no picture", None])
def test_a_damaged_file_is_made_anew(tmp_path: Path, damage: bytes | None) -> None:
    small = thumbnails(tmp_path)
    first = small.of(job(SHAFT), go_on)
    (path,) = tmp_path.iterdir()
    path.write_bytes(path.read_bytes()[:40] if damage is None else damage)
    assert small.of(job(SHAFT), go_on) == first


def test_a_folder_that_cannot_be_written_costs_no_picture(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    assert seen(thumbnails(tmp_path / "file").of(job(SHAFT), go_on)) > 0


def test_without_a_part_there_is_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert thumbnails(tmp_path).of(job("G90G94F100\nM03S1500\nT1\nX2Z2\nM30\n"), go_on) is None
    mill = parse_machine(resources.machine_file("ac-table-mill.toml"), "mill")
    roof = job("BEGIN PGM A MM\nL X+1 Y+1 Z+1 F100\nEND PGM A MM\n", mill, "roof.h")
    assert thumbnails(tmp_path, machine=mill).of(roof, go_on) is None
    monkeypatch.setattr(part_history, "MOST_MOVES", 5)
    assert thumbnails(tmp_path).of(job(SHAFT), go_on) is None


# --- on the page --------------------------------------------------------------------------------------


@pytest.fixture
def preview(tmp_path: Path) -> Iterator[Preview]:
    steps = workshop(load_machine(None), lambda: Offsets(TOOLS, {}, {}))
    made = Preview(steps, thumbnails(tmp_path / "thumbnails").of)
    yield made
    made.close()


def program(folder: Path, text: str, name: str = "part.nc") -> Program:
    path = folder / name
    path.write_text(text)
    return Program(name, path, len(text), 1.0, False, RunRow(name))


def settled(preview: Preview, marked: Program) -> Thumbnail | None:
    for _ in range(3):
        preview.of(marked)
        preview.part_of(marked)
        preview._worker.settle(LIMIT)
        preview._drawing.settle(LIMIT)
    return preview.part_of(marked)


def test_the_part_of_the_marked_program_comes_behind_its_path(preview: Preview, tmp_path: Path) -> None:
    marked = program(tmp_path, SHAFT)
    assert preview.part_of(marked) is None  # the path first
    assert seen(settled(preview, marked)) > 0
    assert preview.part_of(None) is None


def test_a_part_that_cannot_be_drawn_is_not_tried_for_ever(preview: Preview, tmp_path: Path) -> None:
    tries: list[str] = []

    def broken(wanted: Job, _watch: Watch) -> Thumbnail | None:
        tries.append(wanted.source.name)
        raise ValueError("no such tool")

    preview.thumbnail = broken
    assert settled(preview, program(tmp_path, SHAFT)) is None
    assert tries == ["part.nc"]
