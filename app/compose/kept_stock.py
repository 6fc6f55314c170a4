"""The stock that the store remembers with a program, by the program's name; never written into its text."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from app.desk.command_errors import CommandError
from app.desk.data_folder import data_folder

if TYPE_CHECKING:
    from core.part.stock_spec import StockSpec


def kept_stock(program: str) -> str:
    """What was said last, such as ``bar:1.0+.02``; empty where nothing was, or where there is no store.

    Raises CommandError when the store cannot be trusted.
    """
    folder = data_folder()
    if not folder.is_dir():
        return ""
    from core.store.store import Store, StoreError

    try:
        with Store.open(folder, read_only=True) as store:
            return store.stock_of(program)
    except StoreError as error:
        raise CommandError(str(error)) from error


def programs_with_stock(programs: Iterable[str]) -> frozenset[str]:
    """Those with which the store remembers a stock. Raises CommandError as ``kept_stock``."""
    folder = data_folder()
    if not folder.is_dir():
        return frozenset()
    from core.store.store import Store, StoreError

    try:
        with Store.open(folder, read_only=True) as store:
            return frozenset(program for program in programs if store.stock_of(program))
    except StoreError as error:
        raise CommandError(str(error)) from error


def keep_stock(program: str, text: str) -> None:
    """Remember it. Raises CommandError when the store cannot be written."""
    from core.store.store import Store, StoreError

    try:
        with Store.open(data_folder()) as store:
            store.keep_stock(program, text).result()
    except StoreError as error:
        raise CommandError(str(error)) from error


def round_stock_at_hand(program: str) -> StockSpec | None:
    """The bar or tube that is kept with a program, for a picture; None without one that can be read."""
    from core.part.stock_spec import StockError, stock_spec

    try:
        spec = stock_spec(kept_stock(program))
    except (CommandError, StockError):
        return None
    return spec if spec.diameter else None
