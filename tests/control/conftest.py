"""A machine at rest, for the tests of the connection between screen and control."""

from __future__ import annotations

import pytest

from core.executor.snapshot import Snapshot
from tests.executor.rig import Rig


@pytest.fixture(scope="module")
def idle() -> Snapshot:
    rig = Rig()
    rig.ready()
    return rig.shot
