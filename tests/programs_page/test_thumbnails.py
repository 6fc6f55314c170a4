"""Thumbnails of programs: made once, found by their contents, and none where there is no part."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import resources
from app.compose.machine.machine_files import load_machine, parse_machine
from app.compose.part_prover import PartProver
from app.compose.program_proving import create_loading_steps
from app.compose.stored_offsets import Offsets
from app.compose.thumbnails import HIGH, WIDE, ThumbnailCache
from app.desk.background_work import ProgressCallback
from app.desk.stored_part import EMPTY_STORED_PART, StoredPart
from app.programs.program_rows import ListedFile, ProgramPreview, Thumbnail
from core.executor.job import Job
from core.language.source import ProgramSource, load_source
from core.machine.machine_model import Machine
from core.proving import part_history
from core.store.store_rows import RunRow
from tests.desk.test_part_found import LIMIT, SHAFT, TOOLS


def job(text: str, machine: Machine | None = None, name: str = "part.nc") -> Job:
    steps = create_loading_steps(machine or load_machine(None), lambda: Offsets(TOOLS, {}, {}))
    return steps.make_job(ProgramSource(name, text), False)


def thumbnails(
    folder: Path, kept: StoredPart = EMPTY_STORED_PART, machine: Machine | None = None
) -> ThumbnailCache:
    machine = machine or load_machine(None)
    return ThumbnailCache(folder, machine, PartProver(machine, dict, lambda _name: kept, load_source))


def go_on(_count: float) -> None:
    """Somebody still wants it."""


def seen(picture: Thumbnail | None) -> int:
    """How many pixels are part."""
    assert picture is not None
    assert (picture.width_px, picture.height_px) == (WIDE, HIGH)
    return int((np.frombuffer(picture.pixels, np.uint32) >> 24 > 0).sum())


def test_thumbnail_is_drawn_once_and_then_read_from_cache(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    small = thumbnails(tmp_path)
    first = small.get_thumbnail(job(SHAFT), go_on)
    assert seen(first) > 0.1 * WIDE * HIGH
    monkeypatch.setattr(ThumbnailCache, "_made", None)  # nothing is made any more
    assert small.get_thumbnail(job(SHAFT), go_on) == first


def test_other_text_or_stock_gives_another_thumbnail(tmp_path: Path) -> None:
    first = thumbnails(tmp_path).get_thumbnail(job(SHAFT), go_on)
    assert thumbnails(tmp_path).get_thumbnail(job(SHAFT.replace("Z-.5", "Z-.3")), go_on) != first
    assert thumbnails(tmp_path, StoredPart("bar:2")).get_thumbnail(job(SHAFT), go_on) != first
    assert len(list(tmp_path.iterdir())) == 3


@pytest.mark.parametrize("damage", [b"", b"no picture", None])
def test_damaged_thumbnail_file_is_drawn_again(tmp_path: Path, damage: bytes | None) -> None:
    small = thumbnails(tmp_path)
    first = small.get_thumbnail(job(SHAFT), go_on)
    (path,) = tmp_path.iterdir()
    path.write_bytes(path.read_bytes()[:40] if damage is None else damage)
    assert small.get_thumbnail(job(SHAFT), go_on) == first


def test_unwritable_folder_does_not_prevent_thumbnail(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("no folder")
    assert seen(thumbnails(tmp_path / "file").get_thumbnail(job(SHAFT), go_on)) > 0


def test_program_without_part_has_no_thumbnail(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert thumbnails(tmp_path).get_thumbnail(job("G90G94F100\nM03S1500\nT1\nX2Z2\nM30\n"), go_on) is None
    mill = parse_machine(resources.read_machine_file("ac-table-mill.toml"), "mill")
    roof = job("BEGIN PGM A MM\nL X+1 Y+1 Z+1 F100\nEND PGM A MM\n", mill, "roof.h")
    assert thumbnails(tmp_path, machine=mill).get_thumbnail(roof, go_on) is None
    monkeypatch.setattr(part_history, "MAX_MOVES", 5)
    assert thumbnails(tmp_path).get_thumbnail(job(SHAFT), go_on) is None


# --- on the page --------------------------------------------------------------------------------------


@pytest.fixture
def preview(tmp_path: Path) -> Iterator[ProgramPreview]:
    steps = create_loading_steps(load_machine(None), lambda: Offsets(TOOLS, {}, {}))
    made = ProgramPreview(steps, thumbnails(tmp_path / "thumbnails").get_thumbnail)
    yield made
    made.close()


def program(folder: Path, text: str, name: str = "part.nc") -> ListedFile:
    path = folder / name
    path.write_text(text)
    return ListedFile(name, path, len(text), 1.0, False, RunRow(name))


def settled(preview: ProgramPreview, marked: ListedFile) -> Thumbnail | None:
    for _ in range(3):
        preview.find_picture(marked)
        preview.find_thumbnail(marked)
        preview._worker.wait_for_results(LIMIT)
        preview._drawing.wait_for_results(LIMIT)
    return preview.find_thumbnail(marked)


def test_preview_draws_part_after_path_of_marked_program(preview: ProgramPreview, tmp_path: Path) -> None:
    marked = program(tmp_path, SHAFT)
    assert preview.find_thumbnail(marked) is None  # the path first
    assert seen(settled(preview, marked)) > 0
    assert preview.find_thumbnail(None) is None


def test_failed_thumbnail_is_not_retried(preview: ProgramPreview, tmp_path: Path) -> None:
    tries: list[str] = []

    def broken(wanted: Job, _watch: ProgressCallback) -> Thumbnail | None:
        tries.append(wanted.source.name)
        raise ValueError("no such tool")

    preview.draw_thumbnail = broken
    assert settled(preview, program(tmp_path, SHAFT)) is None
    assert tries == ["part.nc"]
