"""Every test that takes a bench runs once for each family."""

from __future__ import annotations

import pytest

from tests.drivers.inverter.benches import FAMILIES, Bench, bench


@pytest.fixture(params=FAMILIES)
def stand(request: pytest.FixtureRequest) -> Bench:
    """An inverter that answers and stands."""
    return bench(request.param)


@pytest.fixture
def turning(stand: Bench) -> Bench:
    """It turns at 1200 rpm."""
    stand.spindle.set_speed(1200.0)
    stand.run(1.5)
    assert stand.spindle.read_fault() == ""
    assert abs(stand.rpm - 1200.0) < 1.0
    return stand
