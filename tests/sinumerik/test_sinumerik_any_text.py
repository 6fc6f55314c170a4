"""Whatever stands in a program: findings with a place and a word, never a failure; blocks that move."""

from __future__ import annotations

import random

import numpy as np
import pytest

from core.language.sinumerik.sinumerik_colors import color_line
from core.machine.machine_model import Machine
from core.motion.axis_limits import MotionLimits
from tests.motion.paths import build_path
from tests.sinumerik.lathe import LINEAR, MODULO, run, setup

WORDS = (
    *(
        "G0",
        "G1",
        "G2",
        "G3",
        "G4",
        "G53",
        "G54",
        "G500",
        "G70",
        "G71",
        "G90",
        "G91",
        "G94",
        "G95",
        "G96",
        "G97",
    ),
    *(
        "G17",
        "G18",
        "G77",
        "M0",
        "M1",
        "M3",
        "M4",
        "M5",
        "M17",
        "M30",
        "M9",
        "DIAMON",
        "DIAMOF",
        "TRANS",
        "ATRANS",
    ),
    *(
        "X10",
        "X=R1",
        "X=IC(3)",
        "X=DC(4)",
        "Z-5",
        "Z=AC(7)",
        "Z=IC(-0.0000001)",
        "C90",
        "C=DC(350)",
        "C=ACN(5)",
    ),
    *("C=IC(-800)", "C400", "C=DC()", "I3", "K-2", "I=AC(4)", "CR=12", "CR=-12", "AR=90", "CHF=1", "CHR=2"),
    *(
        "RND=0.5",
        "F100",
        "F0",
        "F=R2",
        "S500",
        "S=R3",
        "LIMS=900",
        "R1=4",
        "R2=50",
        "N7",
        "/",
        "SUB",
        "L7",
        ";",
    ),
    *("MSG(1)", "T1", "?", "=", "(", "X", "G", "1", "IF", "LABEL:"),
)
ALONE = (
    "G0 X20 Z2",
    "G1 Z-5 F100",
    "G1 X30 C=IC(20)",
    "G3 X40 Z-10 CR=8",
    "C=IC(90)",
    "S400 M3",
    "G95 F0.1",
    "M5",
)


def text(dice: random.Random) -> str:
    """Lines of anything, and lines that make sense."""
    lines = []
    for _ in range(dice.randrange(1, 12)):
        if dice.random() < 0.85:
            lines.append(dice.choice(ALONE))
        else:
            lines.append(" ".join(dice.choice(WORDS) for _ in range(dice.randrange(1, 6))))
    return "\n".join(lines)


@pytest.mark.parametrize("machine", [MODULO, LINEAR], ids=["modulo", "linear"])
def test_any_text_gives_blocks_or_findings(machine: Machine) -> None:
    dice, ran = random.Random(5), 0
    limits = MotionLimits.from_axes(machine.axes, 0.001)
    for _ in range(1500):
        program = text(dice)
        passed = run(program, setup(machine, (0.0, 0.0, 0.0)))
        for found in passed.found:
            assert 1 <= found.line <= program.count("\n") + 1, program
            assert found.code, program
            assert found.message.count("channel 1 block") == 1, program
            assert "block N" in found.message or "block in line" in found.message or "LABEL" in found.message
        if passed.moves:
            ran += 1
            path = build_path(passed.moves, limits, rpm_max=machine.spindle.max_rpm)
            end = path.compute_positions(path.joint_distances[-1:])[0]
            assert end == pytest.approx(passed.moves[-1].machine_end, abs=1e-4), program
            assert np.isfinite(end).all()
        assert [block.n for block in passed.blocks] == list(range(1, len(passed.blocks) + 1))
    assert ran > 400


def test_any_characters_are_colored_or_left_plain() -> None:
    dice = random.Random(6)
    signs = "NGMXZCIKFSR0123456789.=+-(),;:/ \tßABLIMS%_?"
    for _ in range(3000):
        line = "".join(dice.choice(signs) for _ in range(dice.randrange(0, 40)))
        for start, length, _ink in color_line(line):
            assert 0 <= start < len(line)
            assert 0 < length <= len(line) - start
        run(line)
