"""G54 to G59 from the store, or from the offsets file, to the interpreter."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.errors import CommandError
from app.compose.offsets import OF_A_FILE
from app.desk.data_folder import data_folder
from app.offsets.offset_book import ZeroBook
from core.interpreter.job_setup import ZeroOffset
from core.store.zero import ZeroRow

if TYPE_CHECKING:
    from app.compose.journal import Journal

Zero = dict[int, ZeroOffset]


def stored_zero() -> Zero:
    """The settable offsets of the store; none where there is no store yet.

    Raises CommandError when the store cannot be trusted.
    """
    folder = data_folder()
    if not folder.is_dir():
        return {}
    from core.store.store import Store, StoreError

    try:
        with Store.open(folder, read_only=True) as store:
            return _of_rows(store.zero_offsets())
    except StoreError as error:
        raise CommandError(str(error)) from error


def chosen_zero(path: str | None) -> Callable[[], Zero]:
    """Those of an offsets file, or None: the store's, looked up each time they are asked for."""
    if path is None:
        return stored_zero
    from app.cli.zero_file import read_zero

    return partial(_of_file, read_zero, Path(path))


def zero_book(zero: Callable[[], Zero], journal: Journal | None) -> ZeroBook:
    """For the screen: those of the journal's store, or those of a file, which are not changed here."""
    if journal is not None and zero is stored_zero:
        return journal.zero_book()
    return ZeroBook(locked=OF_A_FILE, rows={n: ZeroRow(row.x, row.z, row.c) for n, row in zero().items()})


def _of_file(read: Callable[[Path], Mapping[int, ZeroRow]], path: Path) -> Zero:
    return _of_rows(read(path))


def _of_rows(rows: Mapping[int, ZeroRow]) -> Zero:
    return {code: ZeroOffset(*row) for code, row in rows.items()}
