"""The id of a desk after a power cut."""

from __future__ import annotations

from pathlib import Path

from app.extras.sharing.sharing_setup import read_machine_id, store_machine_id
from tests.power_cut import cut_everywhere, mains

__all__ = ["mains"]


def test_machine_id_file_is_replaced_atomically(tmp_path: Path) -> None:
    """An empty file would be another desk, whose programs nobody may go on with."""
    store_machine_id(tmp_path, "0" * 32)
    seen = set(
        cut_everywhere(lambda: store_machine_id(tmp_path, "f" * 32), lambda: read_machine_id(tmp_path))
    )
    assert seen == {"0" * 32, "f" * 32}
