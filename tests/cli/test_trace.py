"""``turndesk trace``: setpoints dt apart, within the machine's limits, ending where the proof ends."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.cli.conftest import Turndesk

HEAD = "t,x,z,c,spindle_deg,line"


def table(path: Path) -> np.ndarray:
    assert path.read_text().splitlines()[0] == HEAD
    return np.loadtxt(path, delimiter=",", skiprows=1)


@pytest.fixture
def traced(turndesk: Turndesk, tmp_path: Path, offsets: Path) -> Callable[..., np.ndarray]:
    def trace(program: Path, *options: object) -> np.ndarray:
        out = tmp_path / "out.csv"
        told = turndesk("trace", program, "--offsets", offsets, "--out", out, *options)
        assert told.status == 0, told.err
        return table(out)

    return trace


@pytest.mark.parametrize("name", ["linear-diameter", "arc-r-diameter-barrel", "workshift-bar-loop"])
def test_rows_are_dt_apart_and_within_the_limits(
    traced: Callable[..., np.ndarray], example: Callable[[str], Path], name: str
) -> None:
    dt = 0.001
    rows = traced(example(name))
    assert np.allclose(np.diff(rows[:, 0]), dt)
    speed = np.diff(rows[:, 1:3], axis=0) / dt
    assert np.abs(speed).max() <= 5.0 + 1e-3  # 300 in/min
    # Within one setpoint interval the acceleration of 120 in/s², and at a corner once more as much.
    assert np.abs(np.diff(speed, axis=0)).max() / dt <= 2 * 120 + 1


def test_trace_ends_at_proved_position_and_time(
    traced: Callable[..., np.ndarray], turndesk: Turndesk, example: Callable[[str], Path], offsets: Path
) -> None:
    path = example("linear-diameter")
    rows = traced(path, "--dt", ".01")
    (proof,) = turndesk("prove", path, "--offsets", offsets, "--json").lines
    assert rows[-1, 1:3] == pytest.approx([proof["final"]["x"], proof["final"]["z"]])
    assert proof["cycle_time_s"] <= rows[-1, 0] + 1e-6
    assert rows[-1, 0] < proof["cycle_time_s"] + 0.011


def test_all_setpoints_of_an_arc_are_on_the_arc(
    traced: Callable[..., np.ndarray], example: Callable[[str], Path]
) -> None:
    rows = traced(example("arc-r-diameter-barrel"))
    arc = rows[rows[:, 5] == 10]
    radius = np.hypot(arc[:, 1] + 0.4170292, arc[:, 2] + 0.35)
    assert len(arc) > 1000
    assert np.abs(radius - 0.635).max() < 5e-6  # the CSV's own digits


def test_traced_spindle_angle_follows_the_drive_ramp(
    traced: Callable[..., np.ndarray], tmp_path: Path
) -> None:
    path = tmp_path / "spin.nc"
    path.write_text("G90G94F300\nM03S1500\nG04F4\nM30\n")
    rows = traced(path)
    # .08 s latency, 1 s to 1500 rpm at 1500 rpm/s, then 9000 degrees a second.
    assert rows[rows[:, 0] <= 0.08, 4].max() == pytest.approx(0.0, abs=1e-3)
    at_three = rows[np.searchsorted(rows[:, 0], 3.0), 4]
    assert at_three == pytest.approx(9000 * (1 / 2 + 1.92), rel=1e-3)


@pytest.mark.parametrize("dt", ["0", "-1", "x", "2", "nan"])
def test_invalid_time_step_is_rejected(turndesk: Turndesk, tmp_path: Path, dt: str) -> None:
    told = turndesk("trace", tmp_path / "part.nc", "--dt", dt)
    assert told.status == 2
    assert told.err.count("\n") == 1


def test_program_with_errors_writes_no_setpoints(turndesk: Turndesk, tmp_path: Path) -> None:
    program, out = tmp_path / "bad.nc", tmp_path / "out.csv"
    program.write_text("G90G94F300\nX1Z1\nX2Q5\nM30\n")
    told = turndesk("trace", program, "--out", out)
    assert told.status == 1
    assert sorted(p.name for p in tmp_path.iterdir() if "out" in p.name) == []


def test_missing_output_folder_is_reported_by_name(turndesk: Turndesk, tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text("G90G94F300\nX1Z1\nM30\n")
    told = turndesk("trace", program, "--out", tmp_path / "absent" / "out.csv")
    assert told.status == 2
    assert "absent" in told.err


def test_ctrl_c_leaves_no_output_file(
    turndesk: Turndesk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    (tmp_path / "part.nc").write_text("G90G94F300\nT1\nX.5Z.1\nM30\n")
    monkeypatch.setattr("app.cli.trace_command._write", interrupted)
    told = turndesk("trace", tmp_path / "part.nc", "--out", tmp_path / "out.csv")
    assert told.status == 130
    assert not list(tmp_path.glob("out.csv*"))
