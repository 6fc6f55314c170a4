"""3D-ROT: which way the keys move in a tilted plane, what limits hold, and what ends it."""

from __future__ import annotations

import dataclasses
from math import cos, radians, sin, sqrt

import numpy as np
import pytest

from app.compose.machine.kinematics_chain import build_kinematics
from app.compose.machine.machine_files import load_shipped_machine, parse_machine
from app.jog.tilted_jog import JogFrame, TiltedJog, make_jog_frame
from core.executor.commands import Jog, JogByStep, StopJog
from core.executor.hand_motion.jog_line import JogLine
from core.executor.snapshot import MachineState, Snapshot
from core.geometry.rotation_frames import IDENTITY, X_AXIS, make_rotation
from core.interpreter.shared.working_plane import PlaneCoordinateSystem, PlanePosition
from tests.executor.rig import Rig
from tests.machine.mill import MILL
from tests.texts import begins, shows, text

ALONG = (0.0, -sin(radians(30.0)), cos(radians(30.0)))  # Z of a plane that is tilted by 30 degrees about X
LEASE = 0.06


@pytest.fixture
def rig() -> Rig:
    rig = Rig(machine=parse_machine(MILL, "mill"))
    rig.ready()
    return rig


def held(rig: Rig, velocity: float, seconds: float, along: tuple[float, float, float] = ALONG) -> None:
    """Z of the plane is held so long."""
    for _ in range(round(seconds / 0.03)):
        rig.post(Jog("Z", velocity, LEASE, along=along))
        rig.run(0.03)
    rig.post(StopJog())
    rig.until(MachineState.IDLE)


# --- the machine ----------------------------------------------------------------------------------------


def test_axes_stay_on_line_of_tilted_plane(rig: Rig) -> None:
    shots: list[Snapshot] = []
    rig.watch.append(shots.append)
    held(rig, 25.0, 1.2)
    at = np.array([shot.demand[:3] for shot in shots])
    gone = at @ np.array(ALONG)
    assert gone[-1] > 20.0
    assert np.abs(at - np.outer(gone, ALONG)).max() < 1e-9
    assert rig.shot.demand[3:] == (0.0, 0.0)


def test_a_step_along_the_plane_is_exactly_its_length(rig: Rig) -> None:
    rig.post(JogByStep("Z", -1.0, 8.0, ALONG))
    rig.until(MachineState.IDLE)
    assert rig.shot.demand[:3] == pytest.approx([-share for share in ALONG], abs=1e-9)


def test_first_axis_at_its_limit_ends_travel(rig: Rig) -> None:
    """At 45 degrees: Z has .51 mm to its end, of which .01 is kept; .5 of it is .5 √2 of way."""
    rig.post(JogByStep("Z", 1.0, 20.0))
    rig.until(MachineState.IDLE)
    machine = rig.machine
    axes = [
        dataclasses.replace(axis, travel=(-500.0, 1.51)) if axis.name == "Z" else axis
        for axis in machine.axes
    ]
    slanted = (0.0, sqrt(0.5), sqrt(0.5))
    line = JogLine.from_direction(axes, slanted)
    assert line.get_distance_to_limit(rig.shot.demand, 1.0) == pytest.approx(0.5 * sqrt(2.0))
    assert line.get_distance_to_limit(rig.shot.demand, -1.0) == pytest.approx((499.99) * sqrt(2.0))
    assert line.max_acceleration == pytest.approx(machine.axes[1].max_acceleration * sqrt(2.0))


def test_no_axis_exceeds_its_travel(rig: Rig) -> None:
    for _ in range(40):
        held(rig, 1000.0, 0.9)
    y, z = rig.shot.demand[1:3]
    assert y == pytest.approx(-499.99 * 0.5 / cos(radians(30.0)), abs=0.05)
    assert z == pytest.approx(499.99, abs=0.02)
    rig.post(Jog("Z", 25.0, LEASE, along=ALONG))
    rig.run(0.1)
    assert text("jog.end-of-travel", axis="Z", side="+") in rig.said("refused")[-1]
    rig.post(JogByStep("Z", 1.0, 8.0, ALONG))
    rig.run(0.05)
    assert shows(rig.said("refused")[-1], "jog.end-of-travel")


@pytest.mark.parametrize("along", [(0.0, 0.0, 2.0), (float("nan"), 0.0, 1.0)])
def test_invalid_direction_moves_nothing(rig: Rig, along: tuple[float, float, float]) -> None:
    rig.post(Jog("Z", 25.0, LEASE, along=along))
    rig.run(0.1)
    assert text("jog.plane-needs-three") in rig.said("refused")[-1]
    assert rig.shot.demand == (0.0,) * 5


def test_jog_does_not_continue_along_another_line(rig: Rig) -> None:
    rig.post(Jog("Z", 25.0, LEASE, along=ALONG))
    rig.run(0.03)
    rig.post(Jog("Z", 25.0, LEASE))
    rig.until(MachineState.IDLE)
    assert text("jog.still-jogged", axis="Z") in rig.said("refused")[-1]
    at = np.array(rig.shot.demand[:3])
    assert np.abs(at - (at @ np.array(ALONG)) * np.array(ALONG)).max() < 1e-9


def test_lathe_rejects_jog_in_plane() -> None:
    rig = Rig()
    rig.ready()
    rig.post(Jog("Z", 5.0, LEASE, along=ALONG))
    rig.run(0.1)
    assert shows(rig.said("refused")[-1], "jog.plane-needs-three")


# --- which way ------------------------------------------------------------------------------------------


PLANE = make_rotation(X_AXIS, 30.0)


def shot(machine: str, *at: float, tilted: bool = False) -> Snapshot:
    """The machine stands there; ``tilted``: in a plane of 30 degrees about X of the workpiece."""
    chain = build_kinematics(load_shipped_machine(machine))
    assert chain is not None
    place = chain.make_transform({"A": 30.0}, PLANE) if tilted else chain.make_transform({})
    frame, targets = (PLANE, (30.0, 0.0, 0.0)) if tilted else (IDENTITY, (0.0, 0.0, 0.0))
    system = PlaneCoordinateSystem(
        place, chain, frame, is_tilted=tilted, target_angles=targets, plane_block_line=7
    )
    zero = (0.0, 0.0, 0.0)
    rig = Rig()
    rig.ready()
    swivel = PlanePosition(zero, zero, zero, (0.0, None, 0.0), system)
    return dataclasses.replace(rig.shot, axes=chain.axis_names, actual=at, swivel=swivel)


def test_plane_z_is_machine_z_after_table_turned() -> None:
    machine = build_kinematics(load_shipped_machine("ac-table-mill"))
    frame = make_jog_frame(machine, shot("ac-table-mill", 0.0, 0.0, 0.0, 30.0, 0.0, tilted=True))
    assert isinstance(frame, JogFrame)
    assert frame.find_direction("Z") == pytest.approx((0.0, 0.0, 1.0))
    assert frame.find_direction("A") is None
    assert frame.frame_name == text("screen.tilted-plane", line=7)


def test_head_aligned_with_plane_tilts_jog_directions() -> None:
    machine = build_kinematics(load_shipped_machine("fork-head-mill"))
    assert machine is not None
    at = dict.fromkeys(machine.axis_names, 0.0) | {"A": 30.0}
    frame = make_jog_frame(
        machine, shot("fork-head-mill", *(at[name] for name in machine.axis_names), tilted=True)
    )
    assert isinstance(frame, JogFrame)
    assert frame.find_direction("Z") == pytest.approx(ALONG)
    assert frame.find_direction("X") == pytest.approx((1.0, 0.0, 0.0))


def test_table_not_aligned_with_plane_is_reported() -> None:
    machine = build_kinematics(load_shipped_machine("ac-table-mill"))
    told = make_jog_frame(machine, shot("ac-table-mill", 0.0, 0.0, 0.0, 29.9, 0.02, tilted=True))
    assert isinstance(told, str)
    assert begins(told, "jog.plane-asks-turn", axes="A AND C")


def test_tilted_head_without_plane_jogs_along_tool() -> None:
    """The fork head at A 40, C 0: the tool leans about X."""
    machine = build_kinematics(load_shipped_machine("fork-head-mill"))
    assert machine is not None
    at = dict.fromkeys(machine.axis_names, 0.0) | {"A": 40.0}
    frame = make_jog_frame(machine, shot("fork-head-mill", *(at[name] for name in machine.axis_names)))
    assert isinstance(frame, JogFrame)
    assert frame.find_direction("Z") == pytest.approx((0.0, -sin(radians(40.0)), cos(radians(40.0))))
    upright = make_jog_frame(machine, shot("fork-head-mill", *(0.0,) * 5))
    assert isinstance(upright, str)


def test_tilted_jog_ends_with_plane_and_needs_a_plane() -> None:
    told: list[str] = []
    ended: list[str] = []
    tilt = TiltedJog(build_kinematics(load_shipped_machine("ac-table-mill")), ended.append, told.append)
    flat = shot("ac-table-mill", *(0.0,) * 5)
    tilt.update(flat)
    tilt.toggle_tilted_frame()
    assert not tilt.is_on
    assert shows(told[-1], "screen.nothing-tilted")
    there = shot("ac-table-mill", 0.0, 0.0, 0.0, 30.0, 0.0, tilted=True)
    tilt.update(there)
    tilt.toggle_tilted_frame("A PROGRAM IS UNDER WAY")
    assert (tilt.is_on, told[-1]) == (False, "A PROGRAM IS UNDER WAY")
    tilt.toggle_tilted_frame()
    assert tilt.find_direction("Z") == pytest.approx((0.0, 0.0, 1.0))
    tilt.update(flat)  # PLANE RESET
    assert (tilt.is_on, tilt.find_direction("Z")) == (False, None)
    assert shows(ended[-1], "jog.plane-off")


def test_jog_frame_gives_directions_of_keys() -> None:
    frame = JogFrame(make_rotation(X_AXIS, 90.0), "")
    assert frame.find_direction("Y") == pytest.approx((0.0, 0.0, 1.0))
