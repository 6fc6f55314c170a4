"""Source programs that would make an endless, a motionless or a meaningless program."""

from __future__ import annotations

from unittest.mock import patch

import pytest

from core.extras.convert import source_state
from tests.extras.convert.sources import FANUC, LINUXCNC, converted, lines_after, refused

CONTOUR = "\nN10G00X1.\nG01Z-.5\nN20X2."
LINUXCNC_THREAD = "G76 P.05 Z-1 I-.1 J.01 K.03"


@pytest.mark.parametrize(
    ("body", "control", "found"),
    [
        (f"G71P10Q20U.02W.01D0F.01{CONTOUR}", "fanuc-a", (1, 18, "cycle-positive")),
        (f"G71P10Q20U.02W.01D0F.01{CONTOUR}", "haas", (1, 18, "cycle-positive")),
        (f"G71U.00001R.1\nG71P10Q20U0W0{CONTOUR}", "fanuc-a", (2, 1, "too-many-passes")),
        (f"G73U.1R5000\nG73P10Q20U0W0{CONTOUR}", "fanuc-a", (1, 7, "too-many-passes")),
        ("G75R.02\nG75X1.Z-1.P500Q.00001F.004", "fanuc-a", (2, 1, "too-many-passes")),
        ("G74R.02\nG74Z-1.Q.00001F.004", "fanuc-a", (2, 1, "too-many-passes")),
        ("G83Z-1.Q0F.01", "fanuc-a", (1, 8, "cycle-positive")),
        ("G83Z-1.Q.00001F.01", "fanuc-a", (1, 1, "too-many-passes")),
        ("G76P010060Q0R0\nG76X1.9Z-1.P500Q0F.05", "fanuc-a", (2, 16, "cycle-positive")),
        ("G76P010060Q0R0\nG76X1.9Z-1.P0Q300F.05", "fanuc-a", (2, 12, "cycle-positive")),
        ("G76P010060Q0R0\nG76X1.9Z-1.P5000Q100F.05", "fanuc-a", (2, 1, "too-many-passes")),
        (f"{LINUXCNC_THREAD} R0", "linuxcnc", (1, 29, "thread-degression")),
        (f"{LINUXCNC_THREAD} R-1", "linuxcnc", (1, 29, "thread-degression")),
        (LINUXCNC_THREAD.replace("J.01", "J0"), "linuxcnc", (1, 19, "cycle-positive")),
        (LINUXCNC_THREAD.replace("K.03", "K0"), "linuxcnc", (1, 24, "cycle-positive")),
        (LINUXCNC_THREAD.replace("J.01", "J.0001") + " R2", "linuxcnc", (1, 1, "too-many-passes")),
        (f"{LINUXCNC_THREAD} H99999", "linuxcnc", (1, 29, "too-many-passes")),
    ],
)
def test_cycle_without_an_end_is_rejected(body: str, control: str, found: tuple[int, int, str]) -> None:
    # G76 of Fanuc: depth .5 and first pass .01: pass n is .01·√n deep, so 2500 passes.
    # LinuxCNC: .0001/2·√n = .015 needs n = 90 000.
    assert refused(body, control) == found


def test_a_program_with_too_many_moves_is_rejected() -> None:
    with patch.object(source_state, "MAX_STEP_COUNT", 100):
        assert refused("N1M98P7L99\nM30\nO7\nG01W-.001\nG01W.001\nM99")[2] == "too-many-moves"


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("M05\nM03\nG98G01Z0F10.", None),  # the speed of the beginning is still active
        ("M05\nG97S0\nM03\nG98G01Z0F10.", (3, 1, "spindle-speed")),
        ("S0", (1, 1, "spindle-zero")),
        ("S-500", (1, 1, "spindle-negative")),
        ("G96\nG01Z0", (1, 1, "surface-speed")),
        ("G96\nS300\nG01Z0", None),
        ("G96S300\nG97\nG01Z0", None),  # G97 without S continues at the present speed
        ("G96S300\nG97\nM04\nG01Z0", (3, 1, "spindle-speed")),
        ("M05\nG97S0", None),
    ],
)
def test_spindle_without_a_speed_is_rejected(body: str, found: tuple[int, int, str] | None) -> None:
    if found is None:
        assert lines_after(body)
    else:
        assert refused(body) == found


@pytest.mark.parametrize("end", ["G98G1Z-5.F100.", "G04P500", ""])
def test_a_start_of_the_spindle_is_never_left_out(end: str) -> None:
    # The beginning of such a program is in feed per minute, so that the proof does not need the spindle.
    (error,) = converted(f"G21\nT0101\nG0X50.Z2.\nM3\n{end}\nM30\n").errors
    assert (error.line, error.column, error.code) == (4, 1, "spindle-speed")


@pytest.mark.parametrize(
    ("body", "control", "found"),
    [
        ("#1=[[0-8]**0.5]", "linuxcnc", (1, 4, "division")),
        ("O1 IF [[[0-8]**0.5] GT 1]\nO1 ENDIF", "linuxcnc", (1, 8, "division")),
        ("G1X1F[[0-8]**0.5]", "linuxcnc", (1, 6, "division")),
        (f"T{'9' * 400}", "linuxcnc", (1, 2, "expression")),
        (f"M98P{'9' * 400}", "linuxcnc", (1, 5, "expression")),
        (f"#{'9' * 400}=1", "linuxcnc", (1, 2, "expression")),
        (f"#1=[1{'0' * 300}*1{'0' * 300}]", "linuxcnc", (1, 4, "expression")),
        (f"#1={'[' * 3000}1{']' * 3000}", "linuxcnc", (1, 54, "expression")),
        (f"#1={'#' * 3000}1", "linuxcnc", (1, 54, "expression")),
        ("#1=[6 AND 3]", "fanuc-a", (1, 4, "division")),
        ("X#1", "fanuc-a", (1, 2, "variable")),
        ("IF[#1GT2]GOTO9", "fanuc-a", (1, 3, "division")),
        ("X#0", "fanuc-a", (1, 2, "variable")),
        ("X#500", "fanuc-a", (1, 2, "variable")),
    ],
)
def test_an_expression_without_a_value_is_rejected(
    body: str, control: str, found: tuple[int, int, str]
) -> None:
    assert refused(body, control) == found


@pytest.mark.parametrize(
    ("value", "control", "made"),
    [
        ("[FIX[0-2.5]+3.5]", "fanuc-a", 1.5),  # toward zero: -2
        ("[FIX[0-2.5]+4]", "linuxcnc", 1.0),  # down: -3
        ("[FUP[0-2.5]+4]", "fanuc-a", 1.0),  # away from zero: -3
        ("[FUP[0-2.5]+3.5]", "linuxcnc", 1.5),  # up: -2
        ("[[0-5]MOD3+3]", "fanuc-a", 1.0),  # -2
        ("[[0-5]MOD3+3]", "linuxcnc", 4.0),  # 1
        ("[ATAN[0-1]/[0-1]/100]", "fanuc-a", 2.25),  # 225 degrees
        ("[3+ATAN[0-1]/[0-1]/100]", "linuxcnc", 1.65),  # -135 degrees
        ("[--1.5]", "linuxcnc", 1.5),
    ],
)
def test_functions_follow_the_source_control(value: str, control: str, made: float) -> None:
    assert lines_after(f"#100={value}\nG1X#100", control) == [f"G95F.01X{made:g}"]


def test_fanuc_variable_without_a_value_equals_only_variable_zero() -> None:
    body = "IF[#1EQ#0]THEN#1=1.5\nIF[#1EQ#0]THEN#1=1.\nIF[#1NE#0]GOTO5\nM99\nN5G01X#1"
    assert lines_after(body) == ["G95F.01X1.5"]


def test_the_variables_of_a_macro_call_are_local_to_it() -> None:
    body = "#1=1.5\nG65P7\nG01X#1\nG65P8X1.2\nIF[#24EQ#0]THENG01Z0\nM30\n"
    body += "O7\nIF[#1EQ#0]THENG01X1.8\nM99\nO8\nG01X#24\nM99"
    assert lines_after(body) == ["G95F.01X1.8", "X1.5", "X1.2", "Z0"]


def test_hazards_of_the_beginning_do_not_occur_in_a_correct_program() -> None:
    assert not converted(f"{FANUC}G71P10Q20U.02W.01D.1F.01{CONTOUR}\nM30\n").errors


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("T2M6\nG0X1.Z.1\nG1Z0", (3, "spindle-start")),
        ("T2M6\nS800\nG0X1.Z.1\nG1Z0", (4, "spindle-start")),
        ("T2M6\nG0X1.Z.1M3\nG1Z0", None),
        ("M5\nT2M6\nG0X1.Z.1\nG94G1Z0F10.", None),  # the program itself has stopped the spindle
    ],
)
def test_cut_after_m6_of_linuxcnc_needs_a_start_of_the_spindle(
    body: str, found: tuple[int, str] | None
) -> None:
    """M6 of LinuxCNC stops the spindle, as rs274 shows with STOP_SPINDLE_TURNING."""
    done = converted(f"{LINUXCNC}{body}\nM30\n", "linuxcnc")
    wanted = [] if found is None else [(LINUXCNC.count("\n") + 1, found[1])]
    assert [(each.line, each.code) for each in done.errors] == wanted
