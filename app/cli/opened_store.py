"""The store of this installation, opened for one command."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from app.cli.errors import CommandError
from app.desk.data_folder import data_folder
from core.store.store import Store, StoreError


@contextmanager
def told() -> Iterator[None]:
    """What the store refuses ends the command with its sentence."""
    try:
        yield
    except StoreError as error:
        raise CommandError(str(error)) from error


@contextmanager
def opened_store(*, read_only: bool = False) -> Iterator[Store]:
    """The store, closed at the end. Raises CommandError for whatever the store refuses."""
    with told(), Store.open(data_folder(), read_only=read_only) as store:
        yield store
