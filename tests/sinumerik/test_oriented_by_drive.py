"""SPOS, M19 and CYCLE86 where the spindle's drive brings it to an angle and C has a drive of its own."""

from __future__ import annotations

from dataclasses import replace

import pytest

from core.interpreter.shared.actions import SpindlePositioning
from core.machine.machine_model import Machine
from tests.sinumerik.lathe import LINEAR, MODULO, refused, run, setup

ORIENTED = replace(LINEAR, spindle=replace(LINEAR.spindle, oriented=True))
BORE = "G17 G90 G94 F100 S400 M3\nG0 X0 Z5\nCYCLE86(5,0,2,-12,,0,3,-1,0,1,{})\n"


def angles(text: str, machine: Machine) -> list[tuple[float, int]]:
    passed = run(text, setup(machine))
    assert passed.errors == []
    done = [block.action for block in passed.blocks]
    return [(action.angle, action.sense) for action in done if isinstance(action, SpindlePositioning)]


@pytest.mark.parametrize("machine", [MODULO, ORIENTED], ids=["modulo", "linear"])
def test_spindle_angle_is_modulo_360_regardless_of_c_axis_type(machine: Machine) -> None:
    text = "M19\nSPOS=350\nSPOS=DC(10)\nSPOS=ACP(5)\nSPOS=ACN(355)\nSPOSA=AC(20)\nWAITS\nSPOS=IC(-30)\n"
    made = angles(text, machine)
    # AC(20) from 355 does not cross 0, so it goes back; 20 - 30 is 350, backwards.
    assert made == [(0.0, 0), (350.0, 0), (10.0, 0), (5.0, 1), (355.0, -1), (20.0, -1), (350.0, -1)]


def test_c_axis_may_move_while_spindle_is_oriented() -> None:
    passed = run("SPOS=90\nG0 C=DC(45)\nG1 X30 F100\nM30\n", setup())
    assert passed.errors == []
    assert [block.c for block in passed.moves] == [45.0, 45.0]
    assert [block.modal.oriented for block in passed.moves] == [90.0, 90.0]


@pytest.mark.parametrize("ends", ["M5", "S300 M4"])
def test_stopping_or_starting_spindle_clears_its_oriented_angle(ends: str) -> None:
    passed = run(f"SPOS=90\n{ends}\nG1 X30 F100\n", setup())
    assert passed.moves[-1].modal.oriented is None
    assert refused(f"SPOS=90\n{ends}\nSPOS=IC(10)\n", setup()).code == "spindle-position"


def test_cycle86_orients_spindle_before_tool_lifts_off() -> None:
    assert angles(BORE.format(45), MODULO) == [(45.0, 0)]
    blocks = run(BORE.format(45), setup()).blocks
    held = next(n for n, block in enumerate(blocks) if isinstance(block.action, SpindlePositioning))
    lift = [(block.x, block.z, block.rpm) for block in blocks[held + 1 :] if block.moves]
    assert lift == [(-1.0, -11.0, 0.0), (-1.0, 5.0, 0.0), (0.0, 5.0, 0.0)]


@pytest.mark.parametrize("text", ["SPOS=90\n", "SPOSA=90\n", "M19\n", BORE.format(0)])
def test_rejected_orientation_names_the_machine_file_key(text: str) -> None:
    error = refused(text, setup(LINEAR))
    assert error.code == "spindle-position"
    assert "cannot be oriented" in error.message
    assert "oriented = true under [spindle]" in error.hint


@pytest.mark.parametrize("text", ["M70\n", "S100\nG331 Z-20 K1\n"])
def test_rigid_tapping_still_requires_c_axis(text: str) -> None:
    assert "not a C axis" in refused(text, setup()).message
