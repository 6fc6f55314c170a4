"""Q parameters: formulas by hand, FN functions, jumps, figures of the control."""

from __future__ import annotations

import math
from typing import Any

import pytest

from core.interpreter.klartext.flow.word_values import MAX_Q_VALUE
from tests.klartext.running import Ran, run


def q(text: str, number: int = 1, **setup: Any) -> float:
    ran = run(text, **setup)
    assert ran.codes == []
    return ran.state.q_values[number]


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("2 ^ 3 ^ 2", 64.0),  # from left to right
        ("-2 ^ 2", -4.0),  # the power binds closer than the sign
        ("10 - 4 - 3", 3.0),
        ("12 / 3 / 2", 2.0),
        ("17 % 5", 2.0),
        ("SIN 30 * 2", 1.0),  # a function binds closest
        ("SIN(30 * 3)", 1.0),
        ("COS 90", 0.0),  # exact
        ("TAN 45", 1.0),
        ("ASIN 0.5", 30.0),
        ("ACOS 0", 90.0),
        ("ATAN 1", 45.0),
        ("SQRT 2", math.sqrt(2.0)),
        ("SQ 3", 9.0),
        ("LN EXP 2", 2.0),
        ("LOG 1000", 3.0),
        ("NEG 5", -5.0),
        ("INT -2.75", -2.0),
        ("FRAC 2.75", 0.75),
        ("ABS -3,5", 3.5),
        ("SGN -3", -1.0),
        ("PI", math.pi),
        ("1.5E2", 150.0),
        ("+5", 5.0),
    ],
)
def test_formula_gives_its_value(formula: str, value: float) -> None:
    assert q(f"Q1 = {formula}") == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize(
    ("block", "value"),
    [
        ("FN 0: Q1 = -3.5", -3.5),
        ("FN 1: Q1 = +4 + -1", 3.0),
        ("FN 2: Q1 = +4 - -1", 5.0),
        ("FN 3: Q1 = +4 * +2", 8.0),
        ("FN 4: Q1 = +4 DIV +8", 0.5),
        ("FN 5: Q1 = SQRT +9", 3.0),
        ("FN 6: Q1 = SIN +30", 0.5),
        ("FN 7: Q1 = COS +60", 0.5),
        ("FN 8: Q1 = +3 LEN +4", 5.0),
        ("FN 13: Q1 = +1 ANG -1", 135.0),
        ("FN 13: Q1 = -1 ANG +0", 270.0),
        ("FN3:Q1=Q2*-2", -20.0),
    ],
)
def test_fn_block_gives_its_value(block: str, value: float) -> None:
    assert q(f"Q2 = 10\n{block}") == pytest.approx(value, abs=1e-12)


@pytest.mark.parametrize(
    ("condition", "jumps"),
    [
        ("FN 9: IF +Q2 EQU +10", True),
        ("FN 9: IF +Q2 EQU +11", False),
        ("FN 10: IF +Q2 NE +11", True),
        ("FN 11: IF +Q2 GT +9.9", True),
        ("FN 11: IF +Q2 GT +10", False),
        ("FN 12: IF +Q2 LT +10.1", True),
        ("FN12: IF+Q2LT+10GOTO LBL 1", False),
    ],
)
def test_jump_follows_its_condition(condition: str, jumps: bool) -> None:
    goto = "" if "GOTO" in condition else " GOTO LBL 1"
    ran = run(f"Q2 = 10\nQ1 = 1\n{condition}{goto}\nQ1 = 2\nLBL 1")
    assert ran.codes == []
    assert ran.state.q_values[1] == (1.0 if jumps else 2.0)


def test_loop_with_counter_ends_by_jump() -> None:
    ran = run("L X+0 Y+0 FMAX\nQ1 = 0\nLBL 1\nL IX+5 FMAX\nQ1 = Q1 + 1\nFN 12: IF +Q1 LT +4 GOTO LBL 1")
    assert ran.codes == []
    assert ran.state.programmed_position[0] == pytest.approx(20.0)


@pytest.mark.parametrize(
    ("text", "line", "most"),
    [
        ("LBL 1\nFN 9: IF +1 EQU +1 GOTO LBL 1", 4, 0),
        ("LBL 1\nL IX+5 FMAX\nQ1 = 3\nFN 12: IF +Q1 LT +4 GOTO LBL 1", 6, 4),  # no condition reads X
        ("LBL 1\nL IX+5 FMAX\nCALL LBL 2\nFN 9: IF +0 EQU +0 GOTO LBL 1\nM30\nLBL 2\nQ7 = 1\nLBL 0", 6, 4),
        ("Q1 = 0\nLBL 1\nQ1 = 1 - +Q1\nL X+Q1 FMAX\nFN 9: IF +0 EQU +0 GOTO LBL 1", 7, 6),  # two jumps
    ],
)
def test_loop_without_change_is_reported_at_its_jump(text: str, line: int, most: int) -> None:
    ran = run(text)
    assert ran.codes == ["endless-loop"]
    assert ran.errors[0].line == line
    assert len([block for block in ran.blocks if block.moves]) <= most


def test_long_loop_with_counter_is_accepted() -> None:
    text = "Q1 = 0\nLBL 1\nQ1 = Q1 + 0.001\nQ2 = INT( Q1 )\nFN 12: IF +Q2 LT +2 GOTO LBL 1\nL X+Q1 FMAX"
    ran = run(text)
    assert ran.codes == []
    assert ran.state.programmed_position[0] == pytest.approx(2.0, abs=2e-3)


def test_loop_inside_repeats_is_not_reported_as_endless() -> None:
    """The inner jump meets the same Q parameters again, but another repeat is left."""
    inner = "Q1 = 0\nLBL 2\nQ1 = Q1 + 1\nFN 12: IF +Q1 LT +3 GOTO LBL 2"
    assert run(f"LBL 1\n{inner}\nCALL LBL 1 REP 5").codes == []


def test_loop_that_reads_system_data_ends_at_block_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """FN 18 may read what no parameter shows, so only the count of blocks ends such a loop."""
    monkeypatch.setattr("core.interpreter.shared.interpretation.MAX_BLOCK_COUNT", 200)
    text = "LBL 1\nFN 18: SYSREAD Q5 = ID20 NR1\nL IX+1 FMAX\nFN 9: IF +0 EQU +0 GOTO LBL 1"
    assert run(text).codes == ["too-many-blocks"]


def test_q_ql_and_qr_parameters_are_separate() -> None:
    ran = run("Q1 = 1\nQL1 = 2\nQR1 = 3\nQ2 = Q1 + 10 * QL1 + 100 * QR1\nL X+QL1 Y-QR1 FMAX")
    assert ran.codes == []
    assert ran.state.q_values[2] == 321.0
    assert ran.state.programmed_position[:2] == pytest.approx((2.0, -3.0))


@pytest.mark.parametrize("block", ["Q1 = 10 ^ 300", "Q1 = EXP 1000", f"Q1 = {MAX_Q_VALUE:.0f} * 2"])
def test_result_out_of_range_is_rejected(block: str) -> None:
    assert run(block).codes


def test_control_updates_its_q_parameters() -> None:
    def told(text: str) -> Ran:
        return run(f"TOOL DEF 5 L+30 R+4\nTOOL CALL 5 Z S1200 DR+0.5\nM3\nL X+7 Y+0 Z+3 FMAX\n{text}")

    ran = told(
        "Q1 = Q108\nQ2 = Q114\nQ3 = Q110\nQ4 = Q109\n"
        "FN 18: SYSREAD Q5 = ID20 NR1\nFN 18: SYSREAD Q6 = ID270 NR1 IDX1"
    )
    assert ran.codes == []
    assert [ran.state.q_values[at] for at in range(1, 7)] == pytest.approx([4.5, 30.0, 0.0, 2.0, 5.0, 7.0])


def test_f_print_has_no_effect_and_is_reported() -> None:
    ran = run("FN 16: F-PRINT TNC:\\MASK.A / TNC:\\OUT.TXT\nL X+1 FMAX")
    assert ran.codes == []
    assert [each.code for each in ran.diagnostics] == ["unheeded"]
