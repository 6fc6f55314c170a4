"""The stock that the store remembers with a program, by the program's name; never written into its text."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING

from app.desk.command_errors import as_command_error
from app.desk.data_folder import data_folder
from app.desk.kept_part import NOTHING_KEPT, KeptPart, kept_part
from core.store.store_file import has_store

if TYPE_CHECKING:
    from core.store.store import Store


def kept_with(program: str) -> KeptPart:
    """What was said last; nothing where there is no store.

    Raises CommandError when the store cannot be trusted.
    """
    return kept_with_all([program]).get(program, NOTHING_KEPT)


def kept_with_all(programs: Iterable[str]) -> dict[str, KeptPart]:
    """Of those with which the store remembers something what is kept. Raises CommandError, as above."""
    folder = data_folder()
    if not has_store(folder):
        return {}
    from core.store.store import Store, StoreError

    with as_command_error(StoreError), Store.open(folder, read_only=True) as store:
        found = {program: kept_part(store.setting, program) for program in programs}
    return {program: kept for program, kept in found.items() if kept != NOTHING_KEPT}


def keep_stock(program: str, text: str, stick_out: float | None) -> None:
    """Remember it; ``stick_out`` mm, None: that of before. Raises CommandError when it cannot be kept."""
    from core.store.store import Store, StoreError

    with as_command_error(StoreError), Store.open(data_folder()) as store:
        kept = replace(kept_part(store.setting, program), stock=text)
        write(store, program, kept if stick_out is None else replace(kept, stick_out=stick_out))


def write(store: Store, program: str, kept: KeptPart) -> None:
    """Keep it, to the disk. Raises StoreError."""
    for key, value in kept.settings(program).items():
        store.set_setting(key, value).result()
