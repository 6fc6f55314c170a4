"""The corner tolerance of the machine file: used where words are coarse, never exceeded."""

from __future__ import annotations

import math

import numpy as np
import pytest

import resources
from app.cli.outputs.proof_output import make_report_json
from app.compose.machine.machine_files import parse_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.machine.machine_model import Machine
from core.motion.axis_limits import MotionLimits
from core.motion.motion_plan import plan_motion
from core.proving.prove_program import prove
from core.table_schema import MachineFileError
from tests.motion.moves import A, chords, rounded_chords
from tests.motion.paths import build_path

IDEAL = 2000 * 0.02 / 100.0 + 100.0 / A  # s of 2000 chords at 100 mm/s, with one ramp up and one down


def machine(tolerance: str = "") -> Machine:
    """The shipped lathe, of which a count is .00005 in."""
    text = resources.read_machine_file("gt75.toml")
    said = f"[limits]\ncorner_tolerance = {tolerance}\n" if tolerance else "[limits]\n"
    return parse_machine(text.replace("[limits]\n", said, 1), "lathe.toml")


def limits(tolerance: float) -> MotionLimits:
    lathe = machine()
    return MotionLimits.from_axes(lathe.axes, lathe.timing.setpoint_duration_s, tolerance)


def moved(blocks: list[Block], tolerance: float) -> float:
    """The farthest that a joint lies from its words, mm, on both slides together."""
    eased, written = build_path(blocks, limits(tolerance)), build_path(blocks, MotionLimits())
    off = eased.pieces.start[:, :2] - written.pieces.start[:, :2]
    return float(np.hypot(off[:, 0], off[:, 1]).max())


def test_corner_tolerance_lets_coarse_words_run_at_full_feed() -> None:
    blocks = rounded_chords(2000, 100.0, 0.005)
    assert plan_motion(build_path(blocks, limits(0.005))).duration_s < 1.01 * IDEAL
    assert plan_motion(build_path(blocks, limits(0.0))).duration_s > 3.0 * IDEAL


@pytest.mark.parametrize("grid", [0.001, 0.00254, 0.005, 0.01])
@pytest.mark.parametrize("tolerance", [0.002, 0.0036, 0.005])
def test_no_joint_moves_by_more_than_corner_tolerance(grid: float, tolerance: float) -> None:
    assert moved(rounded_chords(2000, 100.0, grid), tolerance) <= tolerance + 1e-12


def test_corner_tolerance_is_used_for_coarse_words() -> None:
    assert moved(rounded_chords(2000, 100.0, 0.01), 0.005) > 0.004


def test_corner_tolerance_does_not_move_exact_chords() -> None:
    blocks = chords(50.0, 0.8, 2000, 100.0)
    off = build_path(blocks, limits(0.005)).pieces.start - build_path(blocks, MotionLimits()).pieces.start
    assert np.abs(off[100:-100]).max() < 1e-5


def test_corner_tolerance_is_read_in_unit_of_file() -> None:
    lathe = machine("0.0002")
    assert lathe.limits.corner_tolerance == pytest.approx(0.00508)
    grain = MotionLimits.from_axes(
        lathe.axes, lathe.timing.setpoint_duration_s, lathe.limits.corner_tolerance
    ).grain
    assert grain == pytest.approx(0.00508 / math.sqrt(2.0))


def test_grain_is_axis_count_without_corner_tolerance() -> None:
    assert machine().limits.corner_tolerance == 0.0
    assert limits(0.0).grain == pytest.approx(0.00127)


def test_proof_report_shows_corner_tolerance() -> None:
    lathe = machine("0.0002")
    setup = create_power_up_setup(lathe, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    report = prove(ProgramSource("A", "G90G94F300\nT1\nX.5Z.1\nM30\n"), setup, lathe)
    assert make_report_json("A", report)["corner_tolerance"] == pytest.approx(0.0002)


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ("0.00006", "7.07107e-05 in"),  # √2 × .00005, which a count on each slide takes anyway
        ("-0.001", "0…0.00393701 in"),
        ("0.005", "0…0.00393701 in"),  # .1 mm
        ('"fine"', "a number"),
    ],
)
def test_invalid_corner_tolerance_is_rejected(said: str, expected: str) -> None:
    with pytest.raises(MachineFileError) as refused:
        machine(said)
    assert any(
        f.path == "limits.corner_tolerance" and expected in f.expected_value for f in refused.value.findings
    )
