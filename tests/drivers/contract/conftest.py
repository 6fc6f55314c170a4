"""Every test of this folder runs once for each driver, those of faults once for each driver and fault."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.drivers.contract.control import Control
from tests.drivers.contract.rig import Rig
from tests.drivers.contract.rigs import RIGS, make

Broken = tuple[Rig, str]
# The bus: its ports are tried by the loop that owns it, a machine under the executor by the driver host.
AT_PORTS = [name for name in RIGS if name != "fed canopen"]
SHIPPED = [name for name in RIGS if name != "canopen"]
_FAULTS = [(name, fault) for name, kind in RIGS.items() for fault in kind.faults]
_HARMLESS = [(name, what) for name, kind in RIGS.items() for what in kind.harmless]


@pytest.fixture(params=AT_PORTS)
def rig(request: pytest.FixtureRequest) -> Iterator[Rig]:
    """A machine behind one driver, drives off."""
    made = make(request.param)
    yield made
    made.close()


@pytest.fixture
def powered(rig: Rig) -> Rig:
    """The same with its drives on."""
    rig.ports.axes.enable(True)
    rig.run(0.2)
    return rig


@pytest.fixture
def moving(rig: Rig) -> Rig:
    """X goes at 120 mm/s, with 0.4 s of way before it."""
    rig.under_way()
    return rig


@pytest.fixture(params=list(RIGS))
def lost(request: pytest.FixtureRequest) -> Iterator[Rig]:
    """A machine whose Z has to be homed."""
    made = make(request.param, homing=True)
    yield made
    made.close()


@pytest.fixture(params=SHIPPED)
def shipped(request: pytest.FixtureRequest) -> Iterator[Rig]:
    """As an executor gets it: a bus always by the driver host."""
    made = make(request.param)
    yield made
    made.close()


@pytest.fixture
def control(shipped: Rig) -> Control:
    """The executor on it."""
    return Control(shipped)


@pytest.fixture(params=_FAULTS, ids="-".join)
def broken(request: pytest.FixtureRequest) -> Iterator[Broken]:
    """A driver, and a fault that its wires can have."""
    name, fault = request.param
    made = make(name)
    yield made, fault
    made.close()


@pytest.fixture(params=_HARMLESS, ids="-".join)
def disturbed(request: pytest.FixtureRequest) -> Iterator[Broken]:
    """A driver, and a disturbance that must not matter."""
    name, what = request.param
    made = make(name)
    yield made, what
    made.close()


def need(rig: Rig, what: str) -> None:
    """Skip where this driver cannot have it; its own words say why."""
    if what in rig.missing:
        pytest.skip(rig.missing[what])
