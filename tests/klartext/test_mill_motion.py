"""Setpoints of tilted programs: the feed is the programmed one, limits hold, a pivot keeps its place."""

from __future__ import annotations

import dataclasses

import numpy as np
import numpy.typing as npt
import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import Dialect, ProgramSource
from core.machine.machine_model import Machine
from core.proving.program_timeline import Timeline, iter_timed_blocks
from core.proving.prove_program import prove
from core.proving.setpoint_trace import iter_setpoints
from tests.klartext.chamfers import AXIAL, POINTS
from tests.klartext.running import TOOL, whole

pytestmark = pytest.mark.long

DT = 0.001
MILL = load_shipped_machine("ac-table-mill")
Array = npt.NDArray[np.float64]


def traced(text: str, machine: Machine = MILL) -> tuple[Array, Array]:
    """Axes (n, 5) and lines (n,) of a program's setpoints."""
    setup = create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    timeline = Timeline.from_program(ProgramSource("T.H", text, Dialect.KLARTEXT), setup, machine)
    chunks = list(iter_setpoints(timeline, DT))
    assert not timeline.has_errors, timeline.diagnostics
    return np.concatenate([chunk.positions for chunk in chunks]), np.concatenate(
        [chunk.line_numbers for chunk in chunks]
    )


def speeds(axes: Array) -> Array:
    return np.asarray(np.diff(axes, axis=0) / DT)


def test_feed_in_plane_is_programmed_feed() -> None:
    """L X+115 F600 of chamfer 2 runs along Y of the workpiece and X of the machine."""
    axes, lines = traced(AXIAL)
    cut = np.hypot.reduce(speeds(axes)[(lines[1:] == 25) & (lines[:-1] == 25), :3], axis=1)
    assert np.median(cut) == pytest.approx(600.0 / 60.0, rel=1e-6)
    assert cut.max() <= 600.0 / 60.0 * (1.0 + 1e-6)


def test_slanted_cut_runs_at_its_feed_for_any_axes() -> None:
    text = TOOL + "M3\nPLANE AXIAL A+45 C+30 TURN FMAX\nL X+0 Y+0 Z+50 FMAX\nL X+30 Y+20 Z+40 F3000"
    axes, lines = traced(whole(text))
    cut = np.hypot.reduce(speeds(axes[lines == 6])[:, :3], axis=1)
    assert np.median(cut) == pytest.approx(50.0, rel=1e-6)


def test_no_axis_exceeds_its_speed_and_acceleration() -> None:
    axes, _ = traced(POINTS)
    v = speeds(axes)
    top = np.array([axis.max_speed for axis in MILL.axes])
    hard = np.array([axis.max_acceleration for axis in MILL.axes])
    assert (np.abs(v).max(axis=0) <= top * (1.0 + 1e-6)).all()
    assert (np.abs(v).max(axis=0)[[2, 3, 4]] > top[[2, 3, 4]] * 0.99).all()  # and uses what there is
    # A sampled acceleration can hold one step of a corner besides.
    assert (np.abs(np.diff(v, axis=0)).max(axis=0) <= 2.0 * hard * DT * (1.0 + 1e-6)).all()


def slow(name: str, vmax: float) -> Machine:
    axes = tuple(dataclasses.replace(a, max_speed=vmax) if a.name == name else a for a in MILL.axes)
    return dataclasses.replace(MILL, axes=axes)


def test_slow_axis_reduces_feed_of_block() -> None:
    """A cut along Y' of the plane at A45 takes Y of the machine alone; F3000 is 50 mm/s, Y can 10."""
    text = TOOL + "M3\nPLANE AXIAL A+45 TURN FMAX\nL X+0 Y+0 Z+50 FMAX\nL X+30 Y+40 F3000"
    axes, lines = traced(whole(text), slow("Y", 10.0))
    v = np.abs(speeds(axes[lines == 6]))
    assert v[:, 1].max() == pytest.approx(10.0, rel=1e-6)
    assert v[:, 0].max() == pytest.approx(7.5, rel=1e-6)


def test_a_slow_table_slows_the_swivel() -> None:
    text = TOOL + "PLANE AXIAL A+45 C+90 TURN FMAX"
    axes, _ = traced(whole(text), slow("A", 5.0))
    v = np.abs(speeds(axes))
    assert v[:, 3].max() == pytest.approx(5.0, rel=1e-6)
    assert v[:, 4].max() == pytest.approx(10.0, rel=1e-6)  # in proportion


@pytest.mark.parametrize(("words", "depth"), [("MOVE FMAX", 0.0), ("MOVE DIST50 F3000", 50.0)])
def test_pivot_stays_in_place_while_all_five_axes_move(words: str, depth: float) -> None:
    text = TOOL + f"L X+5 Y+8 Z+50 R0 FMAX\nPLANE AXIAL A+45 C+90 {words}"
    axes, lines = traced(whole(text))
    moved = axes[lines == 4]
    assert np.ptp(moved[:, 3]) == pytest.approx(45.0, abs=0.1)  # the rows between its ends
    a, c = np.radians(moved[:, 3]), np.radians(moved[:, 4])
    x, y, z = moved[:, 0], moved[:, 1], moved[:, 2] - depth
    dy, dz = y - 250.0, z + 430.0
    y, z = 250.0 + np.cos(a) * dy - np.sin(a) * dz, -430.0 + np.sin(a) * dy + np.cos(a) * dz
    dx, dy = x - 300.0, y - 252.0
    x, y = 300.0 + np.cos(c) * dx - np.sin(c) * dy, 252.0 + np.sin(c) * dx + np.cos(c) * dy
    off = np.abs(np.array((x - 235.0, y - 218.0, z + 300.0 + depth)))
    assert off.max() < 2e-4
    v = np.abs(speeds(moved)).max(axis=0)
    assert (v <= np.array([axis.max_speed for axis in MILL.axes]) * (1.0 + 1e-6)).all()


def test_swivel_time_follows_its_feed() -> None:
    """50 degrees of path at 300 degrees a minute are 10 s, and a little to start and stop."""
    axes, _ = traced(whole(TOOL + "PLANE AXIAL A+30 C+40 TURN F300"))
    turning = (np.abs(speeds(axes)[:, 3]) > 1e-9).sum() * DT
    assert 10.0 <= turning <= 10.1


def test_move_that_exceeds_travel_between_its_ends_is_found() -> None:
    """The table swivels the tip down and back; between the ends Z goes lower than at either of them."""
    text = whole(TOOL + "L X+0 Y+0 Z-80 R0 FMAX\nPLANE AXIAL A-60 MOVE FMAX\nPLANE AXIAL A+60 MOVE FMAX")
    setup = create_power_up_setup(MILL, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    report = prove(ProgramSource("T.H", text, Dialect.KLARTEXT), setup, MILL)
    low = min(limits[0] for limits in _z_reach(text))
    assert low < -430.0
    assert not report.errors
    tight = tuple(dataclasses.replace(a, travel=(low + 1.0, 0.0)) if a.name == "Z" else a for a in MILL.axes)
    machine = dataclasses.replace(MILL, axes=tight)
    setup = create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    found = prove(ProgramSource("T.H", text, Dialect.KLARTEXT), setup, machine).errors
    assert {error.code for error in found} == {"soft-limit"}


def _z_reach(text: str) -> list[tuple[float, float]]:
    setup = create_power_up_setup(MILL, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    timeline = Timeline.from_program(ProgramSource("T.H", text, Dialect.KLARTEXT), setup, MILL)
    return [block.compute_machine_bounds()[2] for block, _, _ in iter_timed_blocks(timeline) if block.moves]
