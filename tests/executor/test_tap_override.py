"""Overrides in a tap: the spindle's counts for Z, the feed's leaves it as it is."""

from __future__ import annotations

import numpy as np
import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.executor.program_motion.path_section import OverrideFactors, PathSection
from core.executor.snapshot_publisher import _feed_in_force
from core.interpreter.dialects import interpret_program
from core.interpreter.shared.job_setup import ToolOffset
from core.language.source import ProgramSource
from core.motion.axis_limits import MotionLimits

MILL = load_shipped_machine("ac-table-mill")
TAP = (
    "BEGIN PGM T MM\nTOOL CALL 1 Z S600 F500\nL X+0 Y+0 Z+50 R0 FMAX M3\n"
    "CYCL DEF 207 TAPPING Q200=+2 Q201=-10 Q239=+1.5 Q203=+0\nCYCL CALL\nL Z+40 F900\nEND PGM T MM\n"
)


def test_tap_follows_only_the_spindle_override() -> None:
    """1.5 mm at S600 are 15 mm/s; with the spindle at 80 % 12 mm/s, whatever the feed override is."""
    setup = create_power_up_setup(MILL, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    blocks = list(interpret_program(ProgramSource("T.H", TAP), setup).generate_blocks())
    tap = next(block for block in blocks if block.follows_spindle)
    assert _feed_in_force(tap, tap.modal) == pytest.approx(15.0)  # what the desk shows a minute
    cut = next(block for block in blocks if block.text.startswith("L Z+40"))
    for block, plain, changed in ((tap, 15.0, 12.0), (cut, 15.0, 7.5)):
        section = PathSection(
            MotionLimits.from_axes(MILL.axes, MILL.timing.setpoint_duration_s), rpm_max=MILL.spindle.max_rpm
        )
        section.append_blocks([block])
        assert section.scale_path(OverrideFactors(), None).pieces.rate.max() == pytest.approx(plain)
        rates = section.scale_path(
            OverrideFactors(feed_factor=0.5, rapid_factor=0.5, spindle_factor=0.8), None
        ).pieces.rate
        assert np.max(rates) == pytest.approx(changed)
