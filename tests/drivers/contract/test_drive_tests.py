"""Drive tests on every driver that plays setpoints; a controller that plans by itself refuses them."""

from __future__ import annotations

import pytest

from core.executor.commands import RenewDriveTest, RunDriveTest
from core.executor.hand_motion.drive_test import NO_SETPOINTS_REASON, DriveTestMotion, Shape
from core.executor.snapshot import MachineState
from tests.drivers.contract.control import Control
from tests.drivers.contract.rig import STILL
from tests.texts import text

LEASE = 0.3
PATHS = (
    DriveTestMotion("X", Shape.STEP, 0.5),
    DriveTestMotion("Z", Shape.RAMP, -2.0, speed=10.0),
    DriveTestMotion("X", Shape.SINE, 0.4, frequencies_hz=(5.0,)),
)


def hold(control: Control, path: DriveTestMotion) -> list[float]:
    """Renewed until it is over: where the slide really was."""
    control.post(RunDriveTest(path, LEASE))
    index, seen = "XZ".index(path.axis), []
    while control.state is MachineState.JOG:
        control.post(RenewDriveTest(LEASE))
        seen.append(control.world.place()[index])
    return seen


@pytest.mark.parametrize("path", PATHS, ids=lambda path: path.shape.value)
def test_drive_test_returns_to_its_start_or_is_refused_with_a_reason(
    control: Control, path: DriveTestMotion
) -> None:
    control.ready()
    control.run(0.5)
    began = control.world.place()
    seen = hold(control, path)
    barred = control.shot.drive_test.barred
    assert barred == (NO_SETPOINTS_REASON if control.rig.blocks is not None else "")
    if barred:
        assert control.said("refused") == [text("executor.drive-test", why=NO_SETPOINTS_REASON)]
        assert seen == []
        assert control.world.place() == began
        return
    assert control.said("refused") == []
    assert control.shot.drive_test.completed_test_count == 1
    assert control.shot.alarms == ()
    far = max(seen, key=lambda place: abs(place - seen[0])) - seen[0]
    assert far * path.travel_mm > 0.0
    assert abs(far) == pytest.approx(abs(path.travel_mm), rel=0.15)
    control.run(0.5)
    assert control.world.place() == pytest.approx(began, abs=2.0 * STILL)


def test_drive_test_that_is_not_renewed_ends_with_its_lease(control: Control) -> None:
    control.ready()
    control.run(0.5)
    if control.shot.drive_test.barred:
        pytest.skip(control.shot.drive_test.barred)
    control.post(RunDriveTest(DriveTestMotion("Z", Shape.RAMP, 20.0, speed=10.0), LEASE))
    at = control.world.place()[1]
    control.run(LEASE + 0.2)
    control.rest(0.2)
    assert 0.5 < control.world.place()[1] - at <= 10.0 * (LEASE + 0.1)
    control.until(MachineState.IDLE, limit=0.5)
    assert control.said("refused") == [text("executor.test-cut-short", axis="Z")]
    assert control.shot.drive_test.completed_test_count == 0
