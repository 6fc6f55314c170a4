"""The executor built for the lathe moves five axes as well: slides and a swivelling table together."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.compose.machine.machine_files import parse_machine
from core.executor.commands import FeedHold
from core.executor.snapshot import MachineState, Snapshot
from core.geometry.rotary_axes import Kinematics, LinearAxis, PivotMove, RotaryAxis
from core.geometry.working_plane import AxisMove
from core.interpreter.shared.actions import ProgramEnd
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.modal_state import ModalState
from tests.executor.rig import Rig
from tests.machine.mill import MILL
from tests.texts import text

AXES = ("X", "Y", "Z", "A", "C")
HOME = (0.0,) * 5


def block(n: int, kind: BlockKind, feed: float, travel: AxisMove | None, end: bool = False) -> Block:
    """A block of a machine with five axes; mm/s, or degrees/s where only rotary axes turn."""
    action = ProgramEnd(reset=True) if end else None
    return Block(
        n=n,
        line=n,
        kind=kind,
        text="",
        modal=ModalState(metric=True),
        feed=feed,
        travel=travel,
        action=action,
        x0=0.0,
        z0=0.0,
        c0=0.0,
        x=0.0,
        z=0.0,
        c=0.0,
        offset_x=0.0,
        offset_z=0.0,
    )


def line(n: int, start: tuple[float, ...], end: tuple[float, ...], feed: float) -> Block:
    """All axes in proportion; the feed counts the slides' way, or else the degrees of the rotary axes."""
    way = math.dist(start[:3], end[:3])
    length = way or math.dist(start[3:], end[3:])
    return block(n, BlockKind.FEED, feed, AxisMove(start, end, length, slides=way > 0.0))


def rig_with(*moves: Block) -> Rig:
    rig = Rig(
        machine=parse_machine(MILL, "mill"),
        made=[*moves, block(len(moves) + 1, BlockKind.ACTION, 0.0, None, end=True)],
    )
    rig.start("anything")
    return rig


def seen(rig: Rig) -> list[Snapshot]:
    shots: list[Snapshot] = []
    rig.watch.append(shots.append)
    return shots


def test_all_five_axes_arrive_together() -> None:
    there = (30.0, -40.0, 20.0, 45.0, -90.0)
    rig = rig_with(line(1, HOME, there, 25.0))
    shots = seen(rig)
    rig.until(MachineState.IDLE)
    assert rig.shot.axes == AXES
    assert rig.shot.actual == pytest.approx(there, abs=2e-3)
    middle = np.array([shot.demand for shot in shots if 0.0 < shot.demand[0] < 30.0])
    assert len(middle) > 50
    share = middle / np.array(there)
    assert np.abs(share - share[:, :1]).max() < 1e-9  # every setpoint on the one line


def test_a_slow_rotary_axis_slows_the_block_down() -> None:
    """10 mm and 90 degrees at 100 mm/s: C can do 60 degrees/s, so it takes 1.5 s and the ramps."""
    rig = rig_with(line(1, HOME, (10.0, 0.0, 0.0, 0.0, 90.0), 100.0))
    took = rig.until(MachineState.IDLE)
    assert 1.5 < took < 1.5 + 60.0 / 720.0 + 0.3


def test_rotary_only_move_uses_the_feed_in_degrees() -> None:
    """A 30 and C 40 together are 50 degrees of way; at 25 degrees/s that is 2 s."""
    rig = rig_with(line(1, HOME, (0.0, 0.0, 0.0, 30.0, 40.0), 25.0))
    took = rig.until(MachineState.IDLE)
    assert 2.0 < took < 2.0 + 0.4


def test_hold_stays_on_the_programmed_line() -> None:
    there = (100.0, 50.0, 0.0, 30.0, 0.0)
    rig = rig_with(line(1, HOME, there, 40.0))
    rig.run(0.8)
    rig.post(FeedHold())
    rig.until(MachineState.HOLD)
    at = np.array(rig.shot.demand)
    assert 1.0 < at[0] < 99.0
    assert at[[1, 3]] == pytest.approx(at[0] * np.array([0.5, 0.3]), abs=1e-9)


TRUNNION = RotaryAxis("A", True, (1.0, 0.0, 0.0), (0.0, 0.0, 50.0))  # its line lies 50 mm above the spot
SLIDES = (
    LinearAxis("X", -500.0, 500.0, 250.0),
    LinearAxis("Y", -500.0, 500.0, 250.0),
    LinearAxis("Z", -500.0, 500.0, 250.0),
)


def test_pivot_move_leaves_the_tool_tip_on_the_same_spot() -> None:
    """The tip stays on its spot of the workpiece while A swings it: a quarter circle of Y and Z."""
    spot = (0.0, 0.0, 0.0)
    table = Kinematics(
        SLIDES, (RotaryAxis("C", True, (0.0, 0.0, 1.0), spot), TRUNNION), spot, axis_order=AXES
    )
    swing = PivotMove(table, {"A": 0.0, "C": 0.0}, {"A": 90.0, "C": 0.0}, spot, 0.0, 0.0, length=90.0)
    rig = rig_with(block(1, BlockKind.FEED, 30.0, AxisMove(HOME, (0.0, -50.0, 50.0, 90.0, 0.0), 90.0, swing)))
    shots = seen(rig)
    took = rig.until(MachineState.IDLE)
    assert 3.0 < took < 3.5  # 90 degrees at 30 degrees/s
    _, y, z, a, _ = np.array([shot.demand for shot in shots]).T
    off = np.hypot(y + 50.0 * np.sin(np.radians(a)), z - 50.0 + 50.0 * np.cos(np.radians(a)))
    assert a.max() == pytest.approx(90.0)
    assert off.max() < 2e-4


def test_move_beyond_the_swivel_range_is_rejected_before_it_starts() -> None:
    rig = rig_with(line(1, HOME, (0.0, 0.0, 0.0, 121.0, 0.0), 25.0))
    rig.until(MachineState.FAULT)
    assert rig.shot.alarms[0].cause == text(
        "executor.line-moves", line=1, axis="A", place="121.000", unit="degrees"
    )
    assert rig.shot.actual == HOME
