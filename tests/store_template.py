"""Empty store that tests copy instead of creating their own.

Making a store runs every migration (16 ms of processor time); most tests only need the result. Tests of the
store itself, in ``tests/store``, make theirs as the product does.
"""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path

import pytest

from core.file_replacement import replace_atomically
from core.store import database

_create = database.create_store_file


@cache
def _template() -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "empty"
        _create(path)
        return path.read_bytes()


def copy_template(path: Path) -> None:
    """Make an empty store at ``path`` as ``database.create_store_file`` does. Raises StoreError."""
    unfinished = path.with_name(path.name + ".new")
    try:
        unfinished.write_bytes(_template())
        replace_atomically(unfinished, path)
    except OSError:
        _create(path)  # it raises what the product raises


def use_template(item: pytest.Item) -> None:
    """Let stores of this test begin as copies, unless its room is that of the store."""
    database.create_store_file = _create if item.nodeid.startswith("tests/store/") else copy_template
