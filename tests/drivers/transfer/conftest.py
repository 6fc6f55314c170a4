"""A pseudo terminal with somebody at its far end, and threads for who works at the near one."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest

from tests.drivers.transfer.far_end import FarEnd


@pytest.fixture
def far() -> Iterator[FarEnd]:
    end = FarEnd()
    yield end
    end.close()


@pytest.fixture
def pool(far: FarEnd) -> Iterator[ThreadPoolExecutor]:
    """Who still waits at the end of a test hears that the line has gone."""
    with ThreadPoolExecutor(2) as made:
        yield made
        far.close()
