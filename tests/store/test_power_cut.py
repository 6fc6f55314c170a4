"""What is kept beside the store is the old or the new one after a power cut, at every step and every byte."""

from __future__ import annotations

import resource
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
import pytest

from app.desk.background_work import LatestRequestWorker
from app.editor.edited_document import Document, DraftStore
from app.editor.version_history import NullVersionArchive
from app.programs.atomic_files import FileOperationError, copy_to_medium, write_new_file, write_program_file
from app.shopfloor.status_file import StatusFileWriter
from core.file_replacement import write_atomically
from core.records.record import Channel, ScopeRecord
from core.records.record_file import open_record, save_csv, save_record
from core.store import store_export
from core.store.store import Store
from tests.power_cut import cut_everywhere, mains

OLD, NEW = b"G90\nG01 X.5 F6\n", b"G90\nG01 X.25 F6\nM30\n"
Write = Callable[[Path, bytes], object]


class _Busy(LatestRequestWorker):
    """A worker that never comes round: what is left is written at the end."""

    @property
    def is_busy(self) -> bool:
        return True


def _draft(path: Path, data: bytes) -> None:
    drafts = DraftStore(path.parent, NullVersionArchive(), worker=_Busy("editing-drafts"))
    drafts.set_text(Document(path.parent / path.stem, ""), data.decode())
    drafts.close()


def _status(path: Path, data: bytes) -> None:
    StatusFileWriter(path, lambda: "12:00").write_status({"execution": data.decode()})


WRITERS: dict[str, Write] = {
    "any": write_atomically,
    "draft": _draft,
    "status": _status,
    "saved program": write_program_file,
    "setup sheet": copy_to_medium,
}


@contextmanager
def no_longer_than(size: int) -> Iterator[None]:
    """A disk that takes so many bytes of a file."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.mark.parametrize("writer", WRITERS)
def test_power_cut_at_any_step_leaves_old_or_new_content(tmp_path: Path, writer: str) -> None:
    path, write = tmp_path / "part.nc.draft", WRITERS[writer]
    write(path, NEW)
    after = path.read_bytes()
    write(path, OLD)
    before = path.read_bytes()

    def again() -> None:
        path.write_bytes(before)
        write(path, NEW)

    told = cut_everywhere(again, path.read_bytes)
    assert set(told) == {before, after}
    assert told[-1] == after


@pytest.mark.parametrize("writer", WRITERS)
def test_full_disk_at_any_byte_leaves_old_content(tmp_path: Path, writer: str) -> None:
    path, write = tmp_path / "part.nc.draft", WRITERS[writer]
    write(path, OLD)
    before = path.read_bytes()
    for size in range(len(NEW)):
        with (
            no_longer_than(size),
            suppress(OSError, FileOperationError),
        ):  # a draft, the status tell it elsewhere
            write(path, NEW)
        assert path.read_bytes() == before
        assert [each.name for each in tmp_path.iterdir()] == [path.name]


def test_remains_of_earlier_power_cut_are_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "status.json"
    path.with_name(".status.json.new").write_bytes(b"{half")
    write_atomically(path, NEW)
    assert {each.name: each.read_bytes() for each in tmp_path.iterdir()} == {"status.json": NEW}


def test_folder_created_for_a_file_is_synced_too(tmp_path: Path) -> None:
    with mains() as at:
        write_atomically(tmp_path / "home" / "drafts" / "a.draft", NEW)
    assert at.lost == []
    assert at.steps == ["fsync", "fsync", "fsync", "rename", "fsync"]  # two folders, the bytes, the name


def test_new_program_is_complete_or_absent_after_power_cut(tmp_path: Path) -> None:
    path = tmp_path / "new.nc"

    def again() -> None:
        path.unlink(missing_ok=True)
        write_new_file(path, NEW)

    told = cut_everywhere(again, lambda: path.read_bytes() if path.exists() else None)
    assert set(told) == {None, NEW}
    assert told[-1] == NEW


def test_scope_recording_is_complete_after_power_cut(tmp_path: Path) -> None:
    def record(at: float) -> ScopeRecord:
        return ScopeRecord((Channel("X", "mm"),), np.arange(3.0), {"X": np.full(3, at)}, at, 1000.0)

    for path, save in ((tmp_path / "a.scope", save_record), (tmp_path / "a.csv", save_csv)):
        save(record(2.0), path)
        new = path.read_bytes()
        save(record(1.0), path)
        old = path.read_bytes()

        def again(path: Path = path, old: bytes = old, save: Callable[..., None] = save) -> None:
            path.write_bytes(old)
            save(record(2.0), path)

        assert set(cut_everywhere(again, path.read_bytes)) == {old, new}
    assert open_record(tmp_path / "a.scope").start_time_utc_s == 2.0


def test_export_is_a_complete_folder_or_absent(tmp_path: Path, store: Store) -> None:
    store.programs.save_version("pin.nc", NEW, "saved").result()
    folder, number = tmp_path / "export", iter(range(99))

    def again() -> None:
        folder.exists() and folder.rename(tmp_path / f"before {next(number)}")
        store_export.export_store(store, folder)

    def seen() -> object:
        return sorted(each.name for each in folder.rglob("*")) if folder.exists() else None

    told = cut_everywhere(again, seen)
    assert told[0] is None
    assert all(each in (None, told[-1]) for each in told)
    assert (folder / "programs" / "pin.nc").read_bytes() == NEW
    assert (folder / "runs.csv").read_text().startswith("program,parts,started,")


def test_writer_without_sync_is_detected(tmp_path: Path) -> None:
    beside = tmp_path / "beside"

    def careless() -> None:
        beside.write_bytes(NEW)
        beside.replace(tmp_path / "place")

    with mains() as at:
        careless()
    assert at.lost == [
        "beside got its name before its bytes were on the disk",
        "the name of place is not on the disk",
    ]
