"""The record of a run against what was promised: the trace, row by row, and the law of the slide."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.desk.command_errors import EXIT_OK
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.proving.program_timeline import Timeline
from core.proving.setpoint_trace import iter_setpoints
from core.records.record import ScopeRecord
from core.records.ring_file import read_ring_file
from tests.cli.conftest import Turndesk, home, offsets, turndesk

__all__ = ["home", "offsets", "turndesk"]
HEAD = "G90G94F300\nT1\n"
STRAIGHT = "X.5Z.1\nG01X.6Z.2F30\nX.7Z.15\nZ-.3F12\nX.9\nG00X1.Z.5\nM30\n"
ROUND = "X.7Z.15\nG02X.8Z.05I.8K.15F20\nG03X.9Z-.05I.8K-.05\nM30\n"


def recorded(turndesk: Turndesk, home: Path, offsets: Path, program: str) -> ScopeRecord:
    path = home.parent / "part.nc"
    path.write_text(HEAD + program)
    assert turndesk("run", path, "--headless", "--offsets", offsets).status == EXIT_OK
    return read_ring_file(home / "records" / "run.ring")


def traced(program: str) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """Machine X and Z, mm, each millisecond."""
    machine = load_machine()
    timeline = Timeline.from_program(
        ProgramSource("part.nc", HEAD + program),
        create_power_up_setup(machine, tool_offsets={1: ToolOffset()}, secondary_offsets={}),
        machine,
    )
    return np.concatenate([rows.positions[:, :2] for rows in iter_setpoints(timeline, 0.001)])


def first_move(path: np.ndarray[tuple[int, int], np.dtype[np.float64]]) -> int:
    """The last row before anything moves."""
    return int(np.flatnonzero(np.abs(np.diff(path, axis=0)).sum(axis=1) > 0.0)[0])


@pytest.mark.parametrize(
    ("program", "apart"),
    [(STRAIGHT, 1e-11), (ROUND, 2e-6)],  # mm; drives get an arc in pieces of constant acceleration
)
def test_recorded_demand_equals_planned_trace(
    turndesk: Turndesk, home: Path, offsets: Path, program: str, apart: float
) -> None:
    record, wanted = recorded(turndesk, home, offsets, program), traced(program)
    found = np.column_stack([record.values_by_channel["X demand"], record.values_by_channel["Z demand"]])
    here, there = first_move(found), first_move(wanted)
    count = min(len(found) - here, len(wanted) - there)
    assert count > 900
    times = record.times_s[here : here + count]
    moving = np.abs(np.diff(wanted[there : there + count], axis=0)).sum(axis=1) > 0.0
    assert moving.sum() > 0.9 * count
    assert times == pytest.approx(times[0] + 0.001 * np.arange(count), abs=1e-9)
    off = np.abs(found[here : here + count] - wanted[there : there + count])
    assert off.max() < apart


def test_following_error_in_feed_matches_control_law(turndesk: Turndesk, home: Path, offsets: Path) -> None:
    record = recorded(turndesk, home, offsets, "X.5Z.1\nG01Z-.9F60\nM30\n")
    feeding = (record.values_by_channel["line"] == 4) & (record.values_by_channel["Z demand"] < 0.0)
    feeding &= record.values_by_channel["Z demand"] > -0.8 * 25.4
    speed = -60 * 25.4 / 60
    wanted = 2.0 * (1.0 - 0.9) * speed / (2.0 * math.pi * 40.0)
    assert feeding.sum() == pytest.approx(800, abs=2)
    assert record.values_by_channel["Z following error"][feeding] == pytest.approx(wanted, abs=0.00127)
