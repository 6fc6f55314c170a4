"""Offsets of C, and of X and Z: TRANS, ATRANS, G54 to G59, G500 and G53."""

from __future__ import annotations

import pytest

from core.interpreter.omniturn.setup.inherited_state import compute_modal_after_end
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import ZeroOffset
from tests.sinumerik.lathe import good, refused, run, setup

ROWS = [  # MCS at the start, word, travel, MCS and WCS at the end; TRANS C30
    (0, "C10", -320, 40, 10),
    (0, "C=AC(10)", -320, 40, 10),
    (0, "C=DC(10)", +40, 40, 10),
    (0, "C=ACP(10)", +40, 40, 10),
    (0, "C=ACN(10)", -320, 40, 10),
    (30, "C0", 0, 30, 0),
    (350, "C0", -320, 30, 0),
    (350, "C=IC(20)", +20, 10, 340),
]


def travel(block: Block) -> float:
    return block.c - block.c0


@pytest.mark.parametrize(("start", "word", "way", "mcs", "wcs"), ROWS)
def test_trans_offsets_c(start: float, word: str, way: float, mcs: float, wcs: float) -> None:
    (block,) = good(f"TRANS C30\nG0 {word}", setup(start=(0.0, 0.0, start)))
    assert travel(block) == pytest.approx(way)
    assert block.mc % 360 == pytest.approx(mcs)
    assert block.c % 360 == pytest.approx(wcs)


def test_settable_and_programmed_offsets_are_added() -> None:
    """-15 + 30 + 10 = 25: the machine's 0 is 335 of the program."""
    around = setup(start=(0.0, 0.0, 0.0), zero={54: ZeroOffset(c=-15.0)})
    text = "G54\nTRANS C30\nATRANS C10\nG0 C=DC(0)"
    (block,) = good(text, around)
    assert block.c0 % 360 == pytest.approx(335)
    assert travel(block) == pytest.approx(25)
    assert block.mc == pytest.approx(25)


def test_offset_alone_causes_no_motion() -> None:
    assert run("G54\nTRANS C30 X1 Z-5\nATRANS C10\nTRANS\nG500").blocks == []


def test_trans_replaces_offset_and_empty_trans_clears_it() -> None:
    around = setup(start=(0.0, 0.0, 0.0))
    blocks = good("TRANS C30 Z5\nTRANS C10\nG0 Z0 C=DC(0)\nTRANS\nZ0 C=DC(0)", around)
    assert [b.mc for b in blocks] == pytest.approx([10, 0])
    assert [b.mz for b in blocks] == pytest.approx([0, 0])


def test_g53_suppresses_offsets_for_one_block() -> None:
    around = setup(start=(0.0, 0.0, 100.0), zero={55: ZeroOffset(5.0, 7.0, 40.0)})
    blocks = good("G55\nTRANS C30 Z1\nG0 G53 X10 Z2 C=DC(0)\nX10 Z2 C=DC(0)", around)
    assert [b.mc % 360 for b in blocks] == pytest.approx([0, 70])
    assert [b.mz for b in blocks] == pytest.approx([2, 10])
    assert [b.mx for b in blocks] == pytest.approx([5, 10])  # X is a diameter
    assert blocks[0].c == pytest.approx(0)
    assert blocks[1].c0 % 360 == pytest.approx(290)  # where the block before has ended, seen from the offsets


@pytest.mark.parametrize("code", range(54, 60))
def test_six_settable_offsets_are_available(code: int) -> None:
    zero = {n: ZeroOffset(float(n), 2.0 * n, 3.0 * n) for n in range(54, 60)}
    (block,) = good(f"G{code} G0 X0 Z0 C0", setup(start=(0.0, 0.0, 0.0), zero=zero))
    assert (block.mx, block.mz, block.mc % 360) == pytest.approx((code, 2 * code, 3 * code))
    assert block.modal.settable == code


def test_g500_cancels_settable_offset_and_retains_trans() -> None:
    around = setup(start=(0.0, 0.0, 0.0), zero={54: ZeroOffset(z=20.0)})
    (block,) = good("G54\nTRANS Z3\nG500 G0 Z1", around)
    assert block.mz == pytest.approx(4)
    assert block.modal.settable == 0


def test_offset_not_entered_is_zero() -> None:
    (block,) = good("G59 G0 Z1")
    assert block.mz == pytest.approx(1)


def test_trans_of_x_is_a_radius_regardless_of_diamon() -> None:
    for key in ("DIAMON", "DIAMOF"):
        (block,) = good(f"{key}\nTRANS X3\nG0 X0")
        assert block.mx == pytest.approx(3)


def test_trans_is_in_inches_under_g70() -> None:
    (block,) = good("G70\nTRANS X1 C10\nG0 X0 C0", setup(start=(0.0, 0.0, 0.0)))
    assert block.mx == pytest.approx(25.4)
    assert block.mc % 360 == pytest.approx(10)


@pytest.mark.parametrize(
    "text",
    [
        "TRANS C30 X10 G1",
        "TRANS C30 F100",
        "TRANS C30 M3",
        "ATRANS X1 S100",
        "N5 G0 TRANS",
    ],
)
def test_trans_requires_a_separate_block(text: str) -> None:
    error = refused(text)
    assert error.code == "own-block"
    assert "separate block" in error.message


def test_target_form_is_rejected_in_offset() -> None:
    assert refused("TRANS C=DC(10)").code == "offset-form"


def test_g53_without_move_is_rejected() -> None:
    assert refused("G53").code == "word-unused"


@pytest.mark.parametrize("end", ["M30", "M2", "M17"])
def test_program_end_clears_offsets(end: str) -> None:
    """MDI and the next program, in whatever language, count from the machine's own zero."""
    around = setup(zero={54: ZeroOffset(5.0, -20.0, 15.0)})
    last = run(f"G54 G0 X10\nTRANS C20 Z3\nS100 M3\n{end}", around).blocks[-1]
    modal = last.modal
    assert (modal.settable, modal.offset_x, modal.offset_z, modal.offset_c, modal.spindle) == (0, 0, 0, 0, 0)
    assert (last.mx, last.mz) == pytest.approx((10, 50))


def test_canceled_program_clears_offsets() -> None:
    modal = run("TRANS X4 Z3 C20\nG0 X1").blocks[-1].modal
    left = compute_modal_after_end(modal, 0.0, resets_m_functions=True)
    assert (modal.offset_c, left.offset_x, left.offset_z, left.offset_c) == (20, 0, 0, 0)


def test_picture_is_drawn_from_program_zero() -> None:
    """G54 moves the part in the machine and nothing in the picture; TRANS moves what it is meant to move."""
    text = "G54 G0 X20 Z5\nG1 Z-10 F100\nTRANS Z-30\nZ0\nG53 G0 X100 Z80\nM30\n"
    here = setup(start=(0.0, 0.0, 0.0))
    there = setup(start=(0.0, 0.0, 0.0), zero={54: ZeroOffset(50.0, -200.0, 0.0)})
    ends = [
        [(b.mx - b.modal.drawing_zero_x, b.mz - b.modal.drawing_zero_z) for b in good(text, around)]
        for around in (here, there)
    ]
    assert ends[0][:3] == [(10.0, 5.0), (10.0, -10.0), (10.0, -30.0)]
    assert ends[1][:3] == ends[0][:3]
    assert ends[1][3] == pytest.approx((0.0, 280.0))  # the machine's own X100 Z80, seen from G54


def test_program_end_restores_diameter_and_mm() -> None:
    """As a line of MDI behind it counts, and a program that is given up."""
    modal = run("G70 DIAMOF\nG0 X1\nM30").blocks[-1].modal
    assert (modal.metric, modal.diameter) == (True, True)
    assert not run("DIAMOF\nG0 X1").blocks[-1].modal.diameter  # what has no end leaves nothing
