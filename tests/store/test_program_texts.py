"""Proof, counts and times belong to a text, whatever it is called."""

from __future__ import annotations

from itertools import count
from pathlib import Path

import pytest

from app.compose.runs.journal import Journal
from app.desk.programs.program_folder import ProgramFolders
from app.programs.program_rows import ListedFile, list_programs
from core.language.source import load_source
from core.store import program_records
from core.store.production import job_queue, run_records
from core.store.store import Store

GOOD, BAD = "G90G94\nX.5F10\nM30\n", "G90G94\nX1.5F10\nQ\nM30\n"


def load(journal: Journal, path: Path) -> None:
    """Load a file as a program to be run."""
    journal.keep(load_source(path))


def made(journal: Journal, path: Path, parts: int, seconds: float) -> None:
    """Load, prove and run it."""
    load(journal, path)
    journal.runs.record_proof(path.name, "PROVED", seconds, load_source(path).text)
    store = journal.require_store()
    for _ in range(parts):
        store.runs.add_parts(path.name)
        store.runs.record_cycle(path.name, seconds).result(60)


def listed(journal: Journal, folder: Path) -> dict[str, ListedFile]:
    found = list_programs(ProgramFolders((folder,)), folder, journal)
    return {program.name: program for program in found}


@pytest.fixture
def own(tmp_path: Path) -> Path:
    folder = tmp_path / "programs"
    folder.mkdir()
    return folder


def test_different_text_with_same_name_has_no_proof_count_or_time(own: Path, tmp_path: Path) -> None:
    journal, path = Journal(tmp_path / "store"), own / "pin.nc"
    path.write_text(GOOD)
    made(journal, path, 3, 12.5)
    run = listed(journal, own)["pin.nc"].run_row
    assert (run.proof, run.parts, run.best) == ("PROVED", 3, 12.5)
    path.write_text(BAD)
    run = listed(journal, own)["pin.nc"].run_row
    assert (run.proof, run.parts, run.best, run.started) == ("", 0, None, None)
    assert journal.runs.read_part_count("pin.nc") == 3  # of the text that is still loaded
    load(journal, path)
    assert journal.runs.read_part_count("pin.nc") == 0
    path.write_text(GOOD)  # the first text again
    load(journal, path)
    assert journal.runs.read_part_count("pin.nc") == 3
    journal.close()


def test_copied_and_renamed_programs_retain_proof_count_and_time(own: Path, tmp_path: Path) -> None:
    journal, path = Journal(tmp_path / "store"), own / "pin.nc"
    path.write_text(GOOD)
    made(journal, path, 2, 9.0)
    (own / "copy.nc").write_text(GOOD)
    path.rename(own / "bolt.nc")
    journal.rename_program("pin.nc", "bolt.nc")
    for program in listed(journal, own).values():
        assert (program.run_row.proof, program.run_row.parts, program.run_row.best) == ("PROVED", 2, 9.0)
    assert journal.runs.read_part_count("bolt.nc") == 2
    load(journal, own / "copy.nc")
    assert journal.runs.read_part_count("copy.nc") == 2
    journal.close()


def test_proof_of_another_text_is_not_used_for_loaded_text(own: Path, tmp_path: Path) -> None:
    journal, path = Journal(tmp_path / "store"), own / "pin.nc"
    path.write_text(GOOD)
    made(journal, path, 1, 9.0)
    journal.runs.record_proof("pin.nc", "1 ERRORS: Q", None, BAD)
    journal.require_store().settings.save_setting("done", 1).result(60)
    assert listed(journal, own)["pin.nc"].run_row.proof == "PROVED"
    path.write_text(BAD)
    assert listed(journal, own)["pin.nc"].run_row.proof == "1 ERRORS: Q"
    journal.close()


def test_a_job_retains_its_parts_when_the_text_is_edited(tmp_path: Path) -> None:
    with Store.open(tmp_path) as store:
        store.programs.save_loaded_version("pin.nc", GOOD.encode(), "loaded to run").result(60)
        job = store.write(lambda c: job_queue.add_job(c, "pin.nc", 10)).result(60)
        store.write(lambda c: job_queue.activate_job(c, job)).result(60)
        store.runs.add_parts("pin.nc", 4).result(60)
        store.programs.save_loaded_version("pin.nc", BAD.encode(), "loaded to run").result(60)
        assert store.runs.read_part_count("pin.nc") == 0
        store.runs.add_parts("pin.nc").result(60)
        (row,) = store.jobs.read_jobs()
        assert (row.parts_made, row.target_part_count) == (5, 6)


def test_records_stored_by_name_are_assigned_to_the_proved_text(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A store of an older version, in which the name was the key."""
    ticks = count(1)  # each reading of the clock a minute later: nothing is saved and proved at one moment

    def later() -> str:
        return f"2026-01-01T00:{next(ticks):02d}:00.000Z"

    for module in (program_records, run_records):
        monkeypatch.setattr(module, "get_utc_now_text", later)
    with Store.open(tmp_path) as store:
        store.programs.save_version("pin.nc", GOOD.encode(), "loaded to run").result(60)
        store.runs.add_parts("pin.nc")
        store.runs.record_proof("pin.nc", "PROVED", 9.0).result(60)
        assert [row.program for row in store.runs.read_run_records()] == ["pin.nc"]
        store.programs.save_version("pin.nc", BAD.encode(), "saved in the editor").result(60)
        store.programs.save_loaded_version("pin.nc", BAD.encode(), "loaded to run").result(60)
        assert store.runs.read_part_count("pin.nc") == 0
        store.programs.save_loaded_version("pin.nc", GOOD.encode(), "loaded to run").result(60)
        (row,) = store.runs.read_run_records()
        assert (row.program, row.parts, row.proof) == ("pin.nc", 1, "PROVED")
