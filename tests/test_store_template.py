"""A copied store is the one that the product makes."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from core.store import database
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


def test_store_is_copied_in_all_rooms_but_that_of_the_store(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert database.create_store_file is store_template.copy_template
    monkeypatch.setattr(database, "create_store_file", database.create_store_file)  # as it was, at the end
    item: Any = SimpleNamespace(nodeid="tests/store/test_opening.py::test_any")
    store_template.use_template(item)
    assert database.create_store_file is store_template._create
    store_template.use_template(request.node)
    assert database.create_store_file is store_template.copy_template
