"""Words of the language and of the ISO mode that are refused by their name, with what stands for them."""

from __future__ import annotations

import pytest

from core.language.diagnostics import Diagnostic
from tests.sinumerik.lathe import good, refused, run

HEAD = "S1000 M3 G95\nG0 X30 Z2\nG1 Z-10 F0.2\n"


def told(line: str) -> Diagnostic:
    """The one error of a program with this line as its fourth."""
    error = refused(f"{HEAD}{line}\nG0 Z20")
    assert error.line == 4
    return error


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("SETINT(1) PRIO=1 ABHEB", "SETINT"),
        ("SETINT(3) LIFT_Z LIFTFAST", "SETINT"),
        ("CLRINT(1)", "CLRINT"),
        ("DISABLE(1)", "DISABLE"),
        ("FL[X]=1000", "FL"),
        ("ACC[X]=50", "ACC"),
        ("G1 X40 ACC[X]=50", "ACC"),
        ("FXS[Z]=1 FXST[Z]=20", "FXS"),
        ("FOC[X]=1", "FOC"),
        ("FGREF[C]=10", "FGREF"),
        ("JERKLIM[X]=75", "JERKLIM"),
        ("OFTEN[Z]=3", "OFTEN"),
        ("PRESETON(X,10)", "PRESETON"),
        ("LIFTFAST", "LIFTFAST"),
        ("DELDTG", "DELDTG"),
        ('WRITE(R1,"F","T")', "WRITE"),
    ],
)
def test_unsupported_word_is_rejected_by_name(line: str, name: str) -> None:
    error = told(line)
    assert error.code == "not-in-subset"
    assert f" {name}: " in error.message


def test_rejected_acceleration_word_is_not_described_as_feed() -> None:
    """What ACC and FL are not must not be told of them: F, FB and OVR say the feed of the path alone."""
    assert "OVR" not in told("ACC[X]=50").message
    assert "OVR" not in told("FL[X]=1000").message
    assert "OVR" in told("FA[X]=100").message


@pytest.mark.parametrize(
    ("line", "column", "written"),
    [
        ("G2 X34 Z-12 R2", 14, "CR=2"),
        ("G02X34.Z-12.R2.", 14, "CR=2"),
        ("G3 X34 Z-12 R-2.5", 14, "CR=-2.5"),
        ("G1 X34 R1", 8, "RND=1"),
        ("G1 X34 ,R1.5", 8, "RND=1.5"),
        ("G1 X34 ,C1", 8, "CHR=1"),
        ("G4 X1", 1, "F1"),
        ("G04 U1.5", 5, "F1.5"),
        ("G4 P500", 4, "F0.5"),
        ("G1 U2 F0.1", 4, "X=IC(2)"),
        ("G1 W-3", 4, "Z=IC(-3)"),
        ("G28 U0 W0", 1, "G74"),
        ("G50 S2000", 1, "LIMS=2000"),
        ("G92 S2000", 1, "LIMS=2000"),
        ("G92 X100 Z50", 1, "TRANS"),
        ("G71 U2 R1", 1, "CYCLE95"),
        ("G76 P010060 Q100 R0.1", 1, "CYCLE97"),
        ("G32 Z-20 F2", 1, "G33"),
        ("M98 P1000", 1, "L1000"),
        ("G98", 1, "G94"),
        ("G21", 1, "G71"),
        ("#100=5", 1, "R100"),
        ("GOTO 100", 6, "N100"),
        ("O1234", 1, "O1234"),
        ("(ROUGH)", 1, ";"),
    ],
)
def test_iso_mode_word_is_rejected_with_its_replacement(line: str, column: int, written: str) -> None:
    error = told(line)
    assert (error.code, error.column) == ("other-control", column)
    assert written in error.message + error.hint


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("G4 F1 X3", "own-block"),
        ("G4 S30 X10", "own-block"),
        ("G999 X3", "12470"),
        ("X34 R2", "not-in-subset"),
    ],
)
def test_other_unsupported_words_retain_their_own_code(line: str, code: str) -> None:
    assert told(line).code == code


def test_suggested_replacement_words_run() -> None:
    good("G94 F200\nG1 X30 Z0\nG2 X34 Z-2 CR=2\nG1 X40 CHR=1\nZ-9\nG4 F1\nG1 X=IC(2)")


@pytest.mark.parametrize(
    ("call", "name"),
    [
        ("CYCLE97(2,,0,-30,30,30,5,2,1.226,0.1,30,0,5,0.5,3,1)", "NID"),
        ("CYCLE97(2,,0,-30,30,30,5,2,1.226,0.1,30,0,5.5,1,3,1)", "NRC"),
        ("CYCLE97(2,,0,-30,30,30,5,2,1.226,0.1,30,0,5,1,3.5,1)", "VARI"),
        ("CYCLE97(2,,0,-30,30,30,5,2,1.226,0.1,30,0,5,1,3,1.5)", "NUMT"),
        ("G17\nCYCLE83(10,0,1,-30,,-5,,2,0,0,1,0.5)", "VARI"),
    ],
)
def test_count_must_be_a_whole_number(call: str, name: str) -> None:
    error = refused(f"{HEAD}{call}")
    assert f"{name} is" in error.message
    assert "whole number" in error.message + error.hint


@pytest.mark.parametrize(("word", "written"), [("T0101", "T1 D1"), ("T1212", "T12 D2"), ("T0300", "T3 D1")])
def test_t_word_with_offset_digits_is_reported_with_correct_form(word: str, written: str) -> None:
    (found,) = run(word).found
    assert (found.code, written in found.hint) == ("tool-offset-missing", True)
