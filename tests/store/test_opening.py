"""Who may open what: locks, damaged, foreign and newer files. What is refused is not touched."""

from __future__ import annotations

import os
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from hashlib import sha256
from pathlib import Path

import pytest

from core import file_replacement
from core.store import backup, database, store_connection
from core.store.store import Store, StoreError
from core.store.store_connection import WriterLock, is_open_for_writing
from core.store.store_errors import StoreErrorCause
from core.store.store_file import STORE_FILE_NAME
from core.store.store_rows import ToolOffsetRow
from tests.coded import raises_code


def digest(path: Path) -> str:
    return sha256(path.read_bytes()).hexdigest()


@pytest.fixture
def closed(folder: Path) -> Path:
    """A closed store with something in it; the path of its file."""
    with Store.open(folder) as store:
        store.offsets.tool_offsets.change_row(1, "x", {"x": 1.0})
        store.programs.save_version("big", b"G90 X1.2345\n" * 20000, "x").result()
    return folder / STORE_FILE_NAME


def test_saved_values_exist_after_reopening(closed: Path) -> None:
    with Store.open(closed.parent) as store:
        assert store.offsets.tool_offsets.read_rows() == {1: ToolOffsetRow(1.0, 0.0, 0.0)}


def test_file_has_application_id_and_commits_are_synced(closed: Path) -> None:
    with Store.open(closed.parent) as store:
        pragmas = store.write(
            lambda c: [
                c.execute(f"PRAGMA {n}").fetchone()[0]
                for n in ("journal_mode", "synchronous", "foreign_keys")
            ]
        ).result()
    assert pragmas == ["wal", 2, 1]  # 2 is FULL
    header = closed.read_bytes()[:100]
    assert int.from_bytes(header[68:72], "big") == database.APPLICATION_ID


def test_second_writer_is_refused_and_a_reader_is_not(store: Store, folder: Path) -> None:
    store.offsets.tool_offsets.change_row(2, "x", {"x": 3.0}).result()
    with raises_code(StoreError, "in-use", f"process {os.getpid()}"):
        Store.open(folder)
    with Store.open(folder, read_only=True) as reader:
        assert reader.offsets.tool_offsets.read_rows() == {2: ToolOffsetRow(3.0, 0.0, 0.0)}
        with raises_code(StoreError, "read-only"):
            reader.offsets.tool_offsets.change_row(2, "x", {"x": 4.0})
    store.offsets.tool_offsets.change_row(2, "x", {"x": 5.0}).result()
    assert store.offsets.tool_offsets.read_rows()[2].x == 5.0


def test_writer_in_another_process_is_rejected(store: Store, folder: Path) -> None:
    code = (
        "import sys\nfrom pathlib import Path\nfrom core.store.store import Store, StoreError\n"
        "try:\n    Store.open(Path(sys.argv[1]))\nexcept StoreError as error:\n    sys.exit(error.code)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, str(folder)], capture_output=True, text=True, check=False, timeout=150
    )
    assert done.returncode == 1
    assert done.stderr == "in-use\n"


def test_reader_of_missing_store_sees_it_empty_and_creates_no_file(folder: Path) -> None:
    with Store.open(folder, read_only=True) as reader:
        assert reader.offsets.tool_offsets.read_rows() == {}
        assert reader.programs.list_programs() == ()
    assert not folder.exists()


def test_rejected_opening_releases_the_lock(closed: Path) -> None:
    good = closed.read_bytes()
    closed.write_bytes(b"rubbish" * 100)
    with raises_code(StoreError, "not-a-database"):
        Store.open(closed.parent)
    closed.write_bytes(good)
    with Store.open(closed.parent) as store:
        assert store.offsets.tool_offsets.read_rows()


def _not_a_database(path: Path) -> None:
    path.write_bytes(b"G90\r\nG01X1\r\n" * 50)


def _empty(path: Path) -> None:
    path.write_bytes(b"")


def _cut_short(path: Path) -> None:
    path.write_bytes(path.read_bytes()[: 4096 * 5 + 100])


def _overwritten_page(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[4096 : 4096 * 3] = b"\xa5" * 4096 * 2
    path.write_bytes(content)


def _foreign(path: Path) -> None:
    path.unlink()
    with sqlite3.connect(path) as connection:
        connection.execute("CREATE TABLE t (a)")
    connection.close()


def _newer(path: Path) -> None:
    connection = sqlite3.connect(path)
    connection.execute("PRAGMA user_version = 99")
    connection.close()


@pytest.mark.parametrize(
    ("spoil", "code"),
    [
        (_not_a_database, "not-a-database"),
        (_empty, "not-a-database"),
        (_cut_short, "damaged"),
        (_overwritten_page, "damaged"),
        (_foreign, "foreign-database"),
        (_newer, "newer-version"),
    ],
)
def test_damaged_file_is_reported_and_left_unchanged(
    closed: Path, spoil: Callable[[Path], None], code: str
) -> None:
    spoil(closed)
    before = digest(closed)
    with raises_code(StoreError, code, closed) as caught:
        Store.open(closed.parent)
    assert "\n" not in str(caught.value)
    assert digest(closed) == before


@pytest.mark.parametrize(("spoil", "code"), [(_not_a_database, "not-a-database"), (_newer, "newer-version")])
def test_reader_also_rejects_damaged_file(closed: Path, spoil: Callable[[Path], None], code: str) -> None:
    spoil(closed)
    with raises_code(StoreError, code):
        Store.open(closed.parent, read_only=True)


def test_log_without_database_is_not_applied_to_a_new_one(closed: Path) -> None:
    log, _ = store_connection.get_log_and_index_paths(closed)
    closed.unlink()
    log.write_bytes(b"something")
    with raises_code(StoreError, "database-gone"):
        Store.open(closed.parent)
    assert not closed.exists()


def test_interrupted_creation_is_restarted(folder: Path) -> None:
    folder.mkdir()
    (folder / "turndesk.db.new").write_bytes(b"half of a store")
    with Store.open(folder) as store:
        assert store.offsets.tool_offsets.read_rows() == {}
    assert not (folder / "turndesk.db.new").exists()


def test_full_disk_is_reported_and_store_is_unchanged(store: Store) -> None:
    store.offsets.tool_offsets.change_row(1, "x", {"x": 1.0}).result()
    store.write(lambda c: c.execute("PRAGMA max_page_count = 1").close()).result()  # as large as it is now
    with raises_code(StoreError, "disk-full"):
        store.programs.save_version("big", b"G90\n" * 100000, "x").result()
    assert store.write_error == str(StoreErrorCause.FULL.make_error(store.path, ""))
    assert store.programs.list_programs() == ()
    store.write(lambda c: c.execute("PRAGMA max_page_count = 1000000").close()).result()
    assert store.programs.save_version("big", b"G90\n" * 100000, "x").result() == 1


def test_closed_store_rejects_reads(store: Store) -> None:
    store.close()
    with raises_code(StoreError, "closed"):
        store.offsets.tool_offsets.read_rows()


def test_new_folder_is_synced_with_its_parents(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A power cut took the folder, and the store in it, that had been acknowledged."""
    brought = list[Path]()
    monkeypatch.setattr(file_replacement, "sync_folder", brought.append)
    Store.open(tmp_path / "shop" / "home").close()
    assert {tmp_path, tmp_path / "shop", tmp_path / "shop" / "home"} <= set(brought)


def test_folder_that_cannot_be_created_is_reported(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with raises_code(StoreError, "cannot-make-folder"):
        Store.open(tmp_path / "file" / "home")


def test_migration_is_complete_or_rolled_back() -> None:
    first, *_ = scripts = (*database.load_migrations(), "CREATE TABLE extra (a); SELECT nonsense;")
    connection = store_connection.configure_connection(sqlite3.connect(":memory:", isolation_level=None))
    with raises_code(StoreError, "migration-failed", f"version {len(scripts)}"):
        database.upgrade_tables(connection, scripts)
    assert first
    assert store_connection.read_store_version(connection) == len(scripts) - 1
    tables = {row[0] for row in connection.execute("SELECT name FROM sqlite_master")}
    assert "programs" in tables
    assert "extra" not in tables
    connection.close()


def test_older_store_is_migrated_and_a_copy_is_saved(closed: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    newer = (*database.load_migrations(), "CREATE TABLE extra (a);")
    monkeypatch.setattr(database, "load_migrations", lambda: newer)
    with raises_code(StoreError, "older-version"):
        Store.open(closed.parent, read_only=True)
    with Store.open(closed.parent) as store:
        assert store.offsets.tool_offsets.read_rows() == {1: ToolOffsetRow(1.0, 0.0, 0.0)}
    assert database.check_store_file(closed, is_thorough=True) == len(newer)
    kept = closed.with_name(f"turndesk-version-{len(newer) - 1}.db")
    assert database.check_store_file(kept, is_thorough=True) == len(newer) - 1


@contextmanager
def as_nobody() -> Iterator[None]:
    """A user without rights here; only root can become one."""
    if os.geteuid() != 0:
        pytest.skip("only root can be somebody else for a while")
    os.seteuid(65534)
    try:
        yield
    finally:
        os.seteuid(0)


def test_folder_without_read_permission_is_reported(closed: Path) -> None:
    """Not a traceback, and not that there is no store."""
    folder = closed.parent
    folder.chmod(0o700)
    backup.find_all_store_problems(closed)  # whatever is imported late is there
    tried: list[tuple[Callable[[], object], str]] = [
        (lambda: Store.open(folder, read_only=True), "forbidden"),
        (lambda: Store.open(folder), "cannot-make-folder"),
        (lambda: backup.find_all_store_problems(closed), "forbidden"),
        (lambda: backup.back_up_store(folder, folder / "b.db"), "cannot-write"),
        (lambda: backup.restore_store(folder, folder / "b.db"), "forbidden"),
    ]
    with as_nobody():
        for attempt, code in tried:
            with raises_code(StoreError, code, folder):
                attempt()


# Asks as another program would, for the locks by which SQLite knows that the store is open: one byte of its
# index, the shared bytes of the file. 1: somebody holds them.
_ASK = """
import fcntl, sys
taken = 0
for path, at, count in ((sys.argv[1], 0x40000002, 510), (sys.argv[1] + "-shm", 128, 1)):
    with open(path, "r+b") as file:
        try:
            fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB, count, at)
        except OSError:
            taken += 1
sys.exit(taken)
"""


def locks_held(path: Path) -> int:
    return subprocess.run([sys.executable, "-c", _ASK, str(path)], check=False).returncode


@pytest.mark.skipif(os.name != "posix", reason="locks that a process loses are those of POSIX")
@pytest.mark.parametrize("look", ["backup", "verify", "read", "in use"])
def test_open_store_retains_its_sqlite_locks(folder: Path, tmp_path: Path, look: str) -> None:
    """Without them the next other program that opens the store takes its log, and all that is saved later."""
    path = folder / STORE_FILE_NAME
    with Store.open(folder) as store:
        store.settings.save_setting("language", "es").result()
        assert locks_held(path) == 2
        if look == "backup":
            backup.back_up_store(folder, tmp_path / "b.db")
        elif look == "verify":
            assert backup.find_store_problems(path) == ()
        elif look == "read":
            Store.open(folder, read_only=True).close()
        else:
            assert is_open_for_writing(folder)
        assert locks_held(path) == 2


@pytest.mark.skipif(os.name != "posix", reason="locks that a process loses are those of POSIX")
def test_reader_in_another_program_does_not_remove_the_log(folder: Path, tmp_path: Path) -> None:
    """What is saved behind that would be gone with a desk that is killed."""
    look = "import sqlite3, sys; c = sqlite3.connect(sys.argv[1]); c.execute('SELECT * FROM runs'); c.close()"
    with Store.open(folder) as store:
        store.settings.save_setting("language", "es").result()
        backup.back_up_store(folder, tmp_path / "b.db")
        log = (folder / f"{STORE_FILE_NAME}-wal").stat().st_ino
        subprocess.run([sys.executable, "-c", look, str(folder / STORE_FILE_NAME)], check=True)
        assert (folder / f"{STORE_FILE_NAME}-wal").stat().st_ino == log


def test_owner_query_does_not_block_a_writer(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """At the instant at which another process asks, the lock can be taken."""
    WriterLock(tmp_path).close()
    took: list[bool] = []
    close = os.close

    def closing_(file: int) -> None:
        if not took:
            took.append(False)
            WriterLock(tmp_path).close()
            took[0] = True
        close(file)

    monkeypatch.setattr(os, "close", closing_)
    assert not is_open_for_writing(tmp_path)
    assert took == [True]


def test_store_is_in_use_only_while_it_has_a_writer(tmp_path: Path) -> None:
    assert not is_open_for_writing(tmp_path)
    lock = WriterLock(tmp_path)
    assert is_open_for_writing(tmp_path)
    lock.close()
    assert not is_open_for_writing(tmp_path)


def test_writer_retries_a_lock_that_is_briefly_in_use(tmp_path: Path) -> None:
    first, pauses = WriterLock(tmp_path), list[float]()

    def pause(seconds: float) -> None:
        pauses.append(seconds)
        if len(pauses) == 3:
            first.close()

    WriterLock(tmp_path, pause).close()
    assert len(pauses) == 3


def test_a_writer_is_refused_after_a_tenth_of_a_second(tmp_path: Path) -> None:
    first, pauses = WriterLock(tmp_path), list[float]()
    with raises_code(StoreError, "in-use"):
        WriterLock(tmp_path, pauses.append)
    first.close()
    assert sum(pauses) == pytest.approx(0.1)
