"""A bench for every test that asks for one."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.drivers.canopen.bench import CanBench


@pytest.fixture
def bench() -> Iterator[CanBench]:
    """Machine and peers, connected, drives off."""
    found = CanBench()
    yield found
    found.close()
