"""Every test of this folder runs once for each driver."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.drivers.contract.moves import start
from tests.drivers.contract.rigs import FAULTS, RIGS, Rig


@pytest.fixture(params=list(RIGS))
def rig(request: pytest.FixtureRequest) -> Iterator[Rig]:
    """A machine behind one backend, drives off."""
    made: Rig = RIGS[request.param]()
    yield made
    made.close()


@pytest.fixture
def powered(rig: Rig) -> Rig:
    """The same with its drives on."""
    rig.ports.axes.enable(True)
    return rig


@pytest.fixture
def moving(powered: Rig) -> Rig:
    """X goes at 120 mm/s, with 0.4 s of way before it."""
    return _moving(powered)


@pytest.fixture(params=FAULTS, ids="-".join)
def broken(request: pytest.FixtureRequest) -> Iterator[tuple[Rig, str]]:
    """A backend whose X moves, and a fault that its wires can have."""
    name, fault = request.param
    made: Rig = RIGS[name]()
    made.ports.axes.enable(True)
    yield _moving(made), fault
    made.close()


def _moving(rig: Rig) -> Rig:
    rig.ports.axes.splice(start(rig, 120.0, 0.7))
    rig.run(0.4)
    assert rig.ports.axes.sample().moving
    return rig
