"""The offsets that the operator has entered, from the store to the interpreter."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from app.cli.errors import CommandError
from app.desk.home import home
from core.interpreter.setup import SecondaryOffset, ToolOffset

if TYPE_CHECKING:
    from core.store.store import Store

Offsets = tuple[dict[int, ToolOffset], dict[int, SecondaryOffset]]


def stored_offsets() -> Offsets:
    """Tool and secondary offsets of the store; none where there is no store yet.

    Raises CommandError when the store cannot be trusted.
    """
    folder = home()
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
    tools = {n: ToolOffset(row.x, row.z, row.nose_radius) for n, row in store.tools().items()}
    secondary = {n: SecondaryOffset(row.x, row.z, row.r) for n, row in store.secondary().items()}
    return tools, secondary


def chosen_offsets(path: str | None) -> Callable[[], Offsets]:
    """The offsets of a file, or None: the store's, looked up each time they are asked for."""
    if path is None:
        return stored_offsets
    from app.cli.offset_file import read_offsets

    return partial(read_offsets, Path(path))
