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


def test_copied_store_equals_a_newly_created_store(tmp_path: Path) -> None:
    store_template.copy_template(tmp_path / "copied")
    store_template._create(tmp_path / "made")
    assert contents(tmp_path / "copied") == contents(tmp_path / "made")


def test_unwritable_folder_raises_store_error(tmp_path: Path) -> None:
    with pytest.raises(StoreError):
        store_template.copy_template(tmp_path / "gone" / "store")
