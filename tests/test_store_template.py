"""A copied store is the one that the product makes."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from core.store.store_errors import StoreError
from tests import store_template


def contents(path: Path) -> list[str]:
    with closing(sqlite3.connect(path)) as connection:
        return [str(connection.execute("PRAGMA user_version").fetchone()), *connection.iterdump()]


def test_a_copy_holds_what_a_made_store_holds(tmp_path: Path) -> None:
    store_template.copy_template(tmp_path / "copied")
    store_template._create(tmp_path / "made")
    assert contents(tmp_path / "copied") == contents(tmp_path / "made")


def test_a_folder_that_cannot_be_written_is_the_products_error(tmp_path: Path) -> None:
    with pytest.raises(StoreError):
        store_template.copy_template(tmp_path / "gone" / "store")
