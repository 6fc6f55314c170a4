"""A bench that is put away afterwards."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.extras.mtconnect.bench import Bench


@pytest.fixture
def bench() -> Iterator[Bench]:
    """An open adapter, nobody there yet."""
    one = Bench()
    yield one
    one.close()
