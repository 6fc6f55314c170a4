"""The fixtures of this folder."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.drivers.hal.halrun import folder_for_all, halrun

__all__ = ["halrun"]


@pytest.fixture
def tmp_path() -> Iterator[Path]:
    """As pytest's, for whoever runs HAL too."""
    with folder_for_all() as folder:
        yield folder
