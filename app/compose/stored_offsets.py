"""Tool, secondary and zero offsets from the store or from an offsets file, for interpreter and desk."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.command_errors import CommandError
from app.desk.data_folder import data_folder
from app.offsets.offset_book import OffsetBook, secondary_offsets, tool_offsets
from core.interpreter.job_setup import SecondaryOffset, ToolOffset, ZeroOffset
from core.store.store_rows import SecondaryRow, ToolRow, ZeroRow

if TYPE_CHECKING:
    from app.compose.journal import Journal
    from core.store.store import Store

OF_A_FILE = "THE OFFSETS COME FROM A FILE (--offsets) AND ARE READ ONLY: CHANGE THE FILE, OR START WITHOUT IT"
Zero = dict[int, ZeroOffset]
Offsets = tuple[dict[int, ToolOffset], dict[int, SecondaryOffset]]


def stored_offsets() -> Offsets:
    """Tool and secondary offsets of the store; none where there is no store yet.

    Raises CommandError when the store cannot be trusted.
    """
    folder = data_folder()
    if not folder.is_dir():
        return {}, {}
    from core.store.store import Store, StoreError

    try:
        with Store.open(folder, read_only=True) as store:
            return offsets_of(store)
    except StoreError as error:
        raise CommandError(str(error)) from error


def offsets_of(store: Store) -> Offsets:
    """What an open store holds, by value."""
    return tool_offsets(store.tools()), secondary_offsets(store.secondary())


def book_of(offsets: Callable[[], Offsets], zero: Callable[[], Zero], journal: Journal | None) -> OffsetBook:
    """For the screen: the offsets of the journal's store, or those of a file, which are not changed here.

    Raises CommandError when the file has mistakes.
    """
    if journal is not None and offsets is stored_offsets:
        return journal.book()
    tools, secondary = offsets()
    return OffsetBook(
        locked=OF_A_FILE,
        tools={n: ToolRow(row.x, row.z, row.nose_radius) for n, row in tools.items()},
        secondary={n: SecondaryRow(row.x, row.z, row.r) for n, row in secondary.items()},
        zero={n: ZeroRow(row.x, row.z, row.c) for n, row in zero().items()},
    )


def chosen_offsets(path: str | None) -> Callable[[], Offsets]:
    """The offsets of a file, or None: the store's, looked up each time they are asked for."""
    if path is None:
        return stored_offsets
    from app.cli.toml_files import read_offsets

    return partial(read_offsets, Path(path))


# --- G54 to G59 from the store, or from the offsets file, to the interpreter.


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
    from app.cli.toml_files import read_zero

    return partial(_of_file, read_zero, Path(path))


def _of_file(read: Callable[[Path], Mapping[int, ZeroRow]], path: Path) -> Zero:
    return _of_rows(read(path))


def _of_rows(rows: Mapping[int, ZeroRow]) -> Zero:
    return {code: ZeroOffset(*row) for code, row in rows.items()}
