"""Formulas, jumps and control structures, by hand."""

from __future__ import annotations

import math
from collections import Counter

import pytest

from core.interpreter.shared.actions import CoolantSwitch
from core.interpreter.sinumerik.flow import control_structures
from core.language.sinumerik.sinumerik_lexer import lex_line
from core.language.sinumerik.sinumerik_words import LexedBlock
from tests.sinumerik.lathe import good, refused, run


def r(text: str, *behind: str) -> float:
    """What R1 holds behind a program: Z goes there."""
    ran = run("\n".join((text, "G0 Z=R1", "M30", *behind)))
    assert ran.found == []
    return ran.moves[-1].z


@pytest.mark.parametrize(
    ("formula", "value"),
    [
        ("2+3*4", 14.0),
        ("(2+3)*4", 20.0),
        ("-2.5", -2.5),
        ("7 DIV 2", 3.0),
        ("-7 MOD 3", -1.0),
        ("SIN(30)", 0.5),
        ("COS(90)", 0.0),
        ("ATAN2(1,-1)", 135.0),
        ("SQRT(2)", math.sqrt(2.0)),
        ("POT(3)", 9.0),
        ("TRUNC(2.9)", 2.0),
        ("ROUND(2.5)", 3.0),
        ("MINVAL(3,2)", 2.0),
        ("ABS(-3)", 3.0),
        ("1EX3", 1000.0),
        ("(2>1) AND (3<>4)", 1.0),
        ("NOT (1==1)", 0.0),
        ("TRUE OR FALSE", 1.0),
        ("R2*R2", 100.0),
    ],
)
def test_formula_is_evaluated(formula: str, value: float) -> None:
    assert r(f"R2=10\nR1={formula}") == pytest.approx(value, abs=1e-12)


def test_words_and_targets_accept_formulas() -> None:
    ran = run("R1=10 R2=4\nG0 X=R1+2*R2 Z=-R2\nX=IC(R1-4) C=DC(R1*9)\nM30")
    assert ran.found == []
    last = ran.moves[-1]
    assert (last.mx * 2.0, last.mz, last.mc) == pytest.approx((24.0, -4.0, 90.0))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("R1=1\nGOTOF ENDE\nR1=2\nENDE: R3=0", 1.0),
        ("R1=0\nAGAIN: R1=R1+1\nIF R1<5 GOTOB AGAIN", 5.0),
        ("R1=0\nN20 R1=R1+1\nIF R1<5 GOTO N20", 5.0),
        ("IF 2>1\nR1=1\nELSE\nR1=2\nENDIF", 1.0),
        ("IF 1>2\nR1=1\nELSE\nR1=2\nENDIF", 2.0),
        ("R1=7\nIF 1>2\nR1=1\nENDIF", 7.0),
        ("R1=0\nWHILE R1<4\nR1=R1+1\nENDWHILE", 4.0),
        ("R1=9\nWHILE R1<4\nR1=R1+1\nENDWHILE", 9.0),
        ("R1=0\nREPEAT\nR1=R1+1\nUNTIL R1>=3", 3.0),
        ("R1=0\nFOR R2=1 TO 4\nR1=R1+R2\nENDFOR", 10.0),
        ("R1=0\nFOR R2=4 TO 1\nR1=5\nENDFOR", 0.0),
        ("R1=0\nLOOP\nR1=R1+1\nIF R1==6 GOTOF OUT\nENDLOOP\nOUT: R3=0", 6.0),
        (
            "R1=0\nFOR R2=1 TO 3\nFOR R3=1 TO 2\nIF R3==2\nR1=R1+10\nELSE\nR1=R1+1\nENDIF\nENDFOR\nENDFOR",
            33.0,
        ),
        (
            "DEF REAL DEPTH=2.5, STEP\nDEF INT COUNT\nSTEP=DEPTH*2\nFOR COUNT=1 TO 2\nR1=COUNT+STEP\nENDFOR",
            7.0,
        ),
    ],
)
def test_control_structures_continue_at_the_right_block(text: str, value: float) -> None:
    assert r(text) == pytest.approx(value)


def test_an_endless_loop_is_an_error() -> None:
    ran = run("LOOP\nR1=1\nENDLOOP\nM30")
    assert [(each.code, each.line) for each in ran.found] == [("endless-loop", 3)]


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("AA: G0 Z=IC(-0.001)\nGOTOB AA\nM30", 2),  # wherever the axes stand
        ("G0 Z1\nGOTOS", 2),
        ("R1=1\nAA: R1=3-R1\nIF R1>0 GOTOB AA\nM30", 3),  # a round of two
        ("WHILE TRUE\nFOR R1=1 TO 3\nG0 Z=R1\nENDFOR\nENDWHILE\nM30", 4),  # the first jump that comes round
        ("REPEAT\nR1=1\nUNTIL R1==2\nM30", 3),
    ],
)
def test_jump_loop_without_change_is_reported(text: str, line: int) -> None:
    ran = run(text)
    assert [(each.code, each.line) for each in ran.found] == [("endless-loop", line)]
    assert len(ran.blocks) < 20


@pytest.mark.parametrize(
    "text",
    [
        "R1=0\nAA: R1=R1+1\nIF R1<400 GOTOB AA\nM30",
        "DEF REAL LIST[2]\nAA: LIST[1]=LIST[1]+1\nIF LIST[1]<40 GOTOB AA\nM30",
        "FOR R1=1 TO 9\nFOR R2=1 TO 9\nENDFOR\nENDFOR\nM30",
        "G0 Z50\nWHILE $AA_IW[Z]>10\nG0 Z=IC(-1)\nENDWHILE\nM30",  # goes by where it stands
    ],
)
def test_loop_that_ends_is_not_reported_as_endless(text: str) -> None:
    assert run(text).errors == []


@pytest.mark.parametrize(
    "text",
    [
        "GOTOF AA\nFOR R1=1 TO 3\nAA: G0 Z5\nENDFOR\nG0 Z9",
        "R1=2\nGOTOF AA\nFOR R1=1 TO 3\nAA: G0 Z=R1\nENDFOR",
        "FOR R1=1 TO 2\nGOTOF AA\nFOR R2=1 TO 2\nAA: R3=1\nENDFOR\nENDFOR",
    ],
)
def test_jump_into_a_for_loop_without_its_start_is_rejected(text: str) -> None:
    """The variable has no start value: with R1=2 of an earlier line, the loop ran 2 instead of 3 times."""
    found = run(f"{text}\nM30").errors[0]
    assert (found.code, found.line) == ("12640", text.split("\n").index("ENDFOR") + 1)


def test_jump_back_into_a_for_loop_that_has_started_continues_it() -> None:
    text = "FOR R1=1 TO 2\nGOTOF AA\nBB: G0 Z=R1\nENDFOR\nGOTOF CC\nAA: G0 Z9\nGOTOB BB\nCC: M30"
    assert [block.z for block in good(text)] == [9, 1, 9, 2]


def test_each_pass_of_a_subprogram_starts_its_loops_again() -> None:
    """The first pass executes FOR, and the second pass jumps past it."""
    sub = ("%_N_SUB_SPF", "R4=R4+1", "IF R4==2 GOTOF AA", "FOR R2=1 TO 3", "AA: R1=R1+1", "ENDFOR", "RET")
    ran = run("\n".join(("%_N_MAIN_MPF", "R1=0 R4=0", "SUB P2", "M30", *sub)))
    assert [each.code for each in ran.errors] == ["12640"]


def test_control_structures_and_ret_work_in_subprogram() -> None:
    sub = ("%_N_SUB_SPF", "FOR R2=1 TO 3", "R1=R1+1", "ENDFOR", "RET", "R1=99")
    assert r("%_N_MAIN_MPF\nR1=0\nSUB P2", *sub) == 6.0


def test_coolant_switches_on_before_motion_and_off_after_it() -> None:
    ran = run("G1 X10 F100 M8\nX20 M9\nM30")
    assert ran.errors == []
    told = [block.action if block.action is not None else "move" for block in ran.blocks[:4]]
    assert told == [CoolantSwitch(True), "move", "move", CoolantSwitch(False)]


def test_a_message_is_shown_and_its_semicolon_begins_no_comment() -> None:
    ran = run('MSG("ROUGH; THEN FINISH")\nG0 X10\nM30')
    assert ran.found == []
    assert ran.blocks[0].modal.comment == "ROUGH; THEN FINISH"


# --- how often a line is read


@pytest.mark.parametrize(
    "loop",
    [
        "AGAIN: R1=R1+1\nIF R1<500 GOTO AGAIN",
        "AGAIN: R1=R1+1\nIF R1>=500 GOTOF OUT\nGOTOB AGAIN",
        "FOR R1=1 TO 500\nR2=R1\nENDFOR",
        "WHILE R1<500\nR1=R1+1\nENDWHILE",
    ],
)
def test_loop_lines_are_not_read_again_at_each_pass(loop: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Once for its structure, once for a label, and twice when it runs first."""
    read: Counter[int] = Counter()

    def counted(number: int, text: str, third_axis: str) -> LexedBlock:
        read[number] += 1
        return lex_line(number, text, third_axis)

    monkeypatch.setattr(control_structures, "lex_line", counted)
    good(f"R1=0\n{loop}\nG0 X30\nOUT: G0 X40\nM30")
    assert max(read.values()) <= 4


@pytest.mark.parametrize("name", ["COUNT", "UNDEF"])
def test_a_loop_whose_variable_is_not_defined_is_one_error(name: str) -> None:
    assert refused(f"FOR {name}=1 TO 3\nG0 X30\nENDFOR\nM30").code == "12550"


def test_block_number_does_not_match_a_longer_one() -> None:
    assert [block.x for block in good("G0 X20\nGOTOF N3\nN33 G0 X30\nn3 G0 X40")] == [10.0, 20.0]
    assert refused("N20 GOTOF N3\nN33 G0 X30 ; N3").code == "14080"


@pytest.mark.parametrize(
    ("before", "axis", "value"),
    [
        ("G0 X40 Z2", "X", 40.0),
        ("DIAMOF\nG0 X40 Z2", "X", 40.0),
        ("TRANS X2 Z-10\nG0 X40 Z2", "Z", 2.0),
        ("TRANS Z-10\nG0 X40 Z2\nTRANS", "Z", -8.0),
        ("ROT RPL=90\nG0 X40 Z2\nROT", "Z", -20.0),  # +90 turns Z to X, and X to minus Z
        ("G0 C=ACN(330)", "C", 330.0),
    ],
)
def test_position_variables_are_in_program_coordinates(before: str, axis: str, value: float) -> None:
    for name in ("$AA_IW", "$P_EP"):
        assert r(f"{before}\nR1={name}[{axis}]") == pytest.approx(value)


@pytest.mark.parametrize("text", ["R1=$AA_IW[Y]", "R1=$AA_IM[X]", "G70\nR1=$AA_IW[X]"])
def test_unavailable_position_variables_are_rejected(text: str) -> None:
    assert refused(text).code == "system-variable"


def test_loop_with_undefined_condition_gives_one_error() -> None:
    """Its body is gone through for more mistakes, and no fault of the loop is told beside."""
    assert refused("WHILE $AA_IM[X]<100\nG0 Z=IC(1)\nENDWHILE\nM30").code == "system-variable"
    errors = run("WHILE NOBODY<100\nG0 Z=IC(0.001)\nG1 X\nENDWHILE\nM30").errors
    assert [each.line for each in errors] == [1, 3]
