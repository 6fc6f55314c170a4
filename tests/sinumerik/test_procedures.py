"""PROC with parameters, VAR, defaults, local DEF, SAVE, EXTERN, MCALL, REPEAT, CASE, arrays, MSG with <<."""

from __future__ import annotations

from dataclasses import replace

import pytest

from core.interpreter.shared.job_setup import ToolOffset
from core.language.called_files import load_called_files
from core.language.source import Dialect, ProgramSource
from tests.sinumerik.lathe import good, refused, run, setup, source


def spf(name: str, text: str) -> ProgramSource:
    """A subprogram file."""
    return ProgramSource(f"{name}.spf", text, Dialect.SINUMERIK)


def stops(text: str | ProgramSource) -> list[float]:
    """Z of the ends of all moves."""
    return [block.z for block in good(text)]


def test_warning_in_a_subprogram_file_is_at_the_call() -> None:
    """Both parameters of one line are named, and a repeated call adds nothing to its line."""
    warn = spf("WARN", "G0 X30\nG0 X=R7 Z=R8\nG0 Z=R7\nRET\n")
    passed = run(source("G0 X20 Z5\nWARN\nWARN\nG0 Z=R9", warn))
    assert [(each.line, each.code) for each in passed.found] == [(2, "r-unset")] * 2 + [(4, "r-unset")]
    for name, found in zip(("R7", "R8"), passed.found, strict=False):
        assert found.message.startswith("WARN.spf line 2: ")
        assert f"{name} has no value" in found.message


def test_warning_of_a_corner_is_at_the_corner_when_the_next_move_is_in_a_subprogram() -> None:
    """``G1 Z-10 F100 RND=1``: RND starts at column 14."""
    passed = run(source("G0 X20 Z2\nM3 S500\nG1 Z-10 F100 RND=1\nNEXT", spf("NEXT", "G1 Z-20\nRET\n")))
    (found,) = passed.found
    assert (found.code, found.line, found.column) == ("corner-straight", 3, 14)
    assert not found.message.startswith("NEXT")


def test_warning_of_a_corner_in_a_subprogram_is_at_the_call_when_the_next_move_is_outside() -> None:
    passed = run(
        source("G0 X20 Z2\nM3 S500\nBEND\nG1 Z-20", spf("BEND", "G1 Z-5 F100\nG1 Z-10 RND=1\nRET\n"))
    )
    (found,) = passed.found
    assert (found.code, found.line) == ("corner-straight", 3)
    assert found.message.startswith("BEND.spf line 2: ")


def test_warning_of_radius_compensation_names_the_line_of_the_call_once() -> None:
    """The block of G42 is displayed at line 4, the line of the call."""
    without_radius = replace(setup(), tools={1: ToolOffset(quadrant=3)})
    turn = spf("FINISH", "G42 G1 X20 Z2 F100\nG1 Z-10\nG40 G0 X40\nRET\n")
    passed = run(source("T1 D1\nM3 S500\nG0 X60 Z10\nFINISH", turn), without_radius)
    (found,) = passed.found
    assert (found.code, found.line) == ("comp-no-radius", 4)
    assert found.message.startswith("channel 1 block in line 4: ")


STEP = spf("STEP", "PROC STEP(REAL DEPTH, INT TIMES=2, REAL MORE)\nG0 Z=DEPTH*TIMES+MORE\nRET\n")


@pytest.mark.parametrize(
    ("call", "z"),
    [
        ("STEP(-3,4,1)", -11),
        ("STEP(-3,,1)", -5),  # TIMES is 2
        ("STEP(-3)", -6),  # MORE is 0
        ("step (R1+1, 3)", -12),  # R1 = -5
        ("STEP(-1,2.6)", -3),  # an INT parameter is a whole number
    ],
)
def test_parameters_are_passed_to_procedure(call: str, z: float) -> None:
    assert stops(source(f"EXTERN STEP(REAL, INT, REAL)\nR1=-5\n{call}", STEP)) == [z]


@pytest.mark.parametrize(
    ("call", "code"),
    [
        ("STEP(1,2,3,4)", "12330"),
        ("STEP(1", "12080"),
        ("STEP(1 2)", "12080"),
        ("STEP(RESULT)", "12550"),
        ("STEP(1) X5", "12080"),
        ("G0 X5 STEP(1)", "12080"),
    ],
)
def test_calls_that_do_not_match_procedure_are_rejected(call: str, code: str) -> None:
    error = refused(source(f"G0 Z0\nN20 {call}", STEP))
    assert (error.code, error.line) == (code, 2)


def test_var_parameter_is_written_back_and_value_parameter_is_not() -> None:
    twice = spf("TWICE", "PROC TWICE(VAR REAL AA, REAL BB)\nAA=AA*2\nBB=BB*2\nM17\n")
    text = "DEF REAL LENGTH=3, OTHER=5\nR7=10\nTWICE(LENGTH,OTHER)\nTWICE(R7,1)\nG0 Z=LENGTH+OTHER+R7"
    assert stops(source(text, twice)) == [31]  # 6 + 5 + 20
    assert refused(source("TWICE(3,1)", twice)).code == "12330"


def test_unreadable_proc_is_reported_at_its_own_line() -> None:
    error = refused(source("G0 Z1\nTWICE(3,1)", spf("TWICE", "PROC TWICE(REAL A)\nM17")))
    assert (error.code, error.line) == ("12080", 2)
    assert "TWICE.spf line 1" in error.message


def test_variables_are_local_to_their_program() -> None:
    inner = spf("INNER", "DEF REAL DEPTH=7\nG0 Z=DEPTH\nM17\n")
    assert stops(source("DEF REAL DEPTH=1\nINNER\nG0 Z=DEPTH", inner)) == [7, 1]
    blind = spf("BLIND", "G0 Z=DEPTH\nM17\n")
    assert refused(source("DEF REAL DEPTH=1\nBLIND", blind)).code == "12550"


def test_save_restores_g_functions_and_frame() -> None:
    text = "G90 G94 DIAMON F100\nTRANS Z5\nINNER\nG1 X20 Z1"
    loose = spf("INNER", "PROC INNER\nG91 DIAMOF\nTRANS\nM17\n")
    kept = spf("INNER", "PROC INNER SAVE DISPLOF\nG91 DIAMOF\nTRANS\nM17\n")
    assert [(b.mx, b.mz) for b in good(source(text, loose))] == [(30, 51)]  # by X20 Z1 from X10 Z50
    assert [(b.mx, b.mz) for b in good(source(text, kept))] == [(10, 6)]


def test_arrays_and_r_parameters_are_indexed() -> None:
    text = "DEF REAL DEPTHS[3]=2\nDEPTHS[1]=-4\nR2=1\nR[R2+1]=8\nG0 Z=DEPTHS[2]\nZ=R[2]\nZ=R2\nZ=DEPTHS[R2/8]"
    assert stops(text) == [2, 8, 8, -4]  # R2 is 8 from the fourth line on
    assert refused("DEF REAL DD[2]\nDD[2]=1").code == "17020"
    assert refused("DEF REAL DD[2]\nG0 Z=DD[2]").code == "17020"
    assert refused("R1=0.5\nG0 Z=R[R1]").code == "17020"


@pytest.mark.parametrize(
    ("text", "ends"),
    [
        ("DEF INT AA[2,3]=(1,2,3,4)\nG0 Z=AA[0,2]\nZ=AA[1,0]\nZ=AA[1,1]", [3, 4, 0]),  # what is left is 0
        ("DEF REAL AA[3]=SET(1,2,3)\nAA[1]=REP(7)\nG0 Z=AA[0]\nZ=AA[1]+AA[2]", [1, 14]),
        ("R[5]=SET(1,,3)\nR6=9\nG0 Z=R5+R6+R7", [13]),
        ("DEF REAL AA[2,2,2]\nAA[1,0,1]=4\nG0 Z=AA[1,0,1]+AA[1,1,0]", [4]),
        ("DEF REAL AA[4]=REP(2,2)\nG0 Z=AA[1]\nZ=AA[2]", [2, 0]),
        ("DEF REAL AA[2]=SET(3,4)\nAA[0]=REP(9,0)\nG0 Z=AA[0]", [3]),
        ("R298=1\nR[R298+298]=SET(7)\nG0 Z=R299", [7]),
        (
            "R1=0\nAA:\nDEF REAL BB[2]\nBB[1]=BB[1]+1\nR1=R1+1\nIF R1<3 GOTOB AA\nG0 Z=BB[1]",
            [1],
        ),  # DEF sets 0
    ],
)
def test_value_lists_fill_arrays(text: str, ends: list[float]) -> None:
    assert stops(text) == ends


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("DEF REAL AA[2,2]\nG0 Z=AA[2,0]", "17020"),
        ("DEF REAL AA[2,2]\nG0 Z=AA[0,2]", "17030"),
        ("DEF REAL AA[2,2]\nG0 Z=AA[0]", "17030"),
        ("DEF REAL AA[2]\nAA[1]=SET(1,2)", "array-values"),
        ("DEF REAL AA[2]\nBB[0]=SET(1)", "12550"),
        ("DEF REAL AA[2]\nAA[0]=SET(1", "12080"),
        ("DEF REAL AA[0]", "17020"),
        ("DEF REAL AA[101,100]", "17020"),
        ("DEF REAL AA[2,2,2,2]", "17020"),
        ("R[1,2]=3", "17030"),
        ("R[299]=SET(1,2)", "array-values"),
        ("R1=300\nR[R1]=SET(1,2)", "17020"),
        ("R1=300\nR[R1]=REP(0,2)", "17020"),
        ("R1=5000\nR[R1]=5", "17020"),
        ("R1=5000\nG0 Z=R[R1]", "17020"),
        ("IF R300==1 GOTOF AA\nAA: M0", "17020"),
        ("FOR R300=1 TO 2", "12080"),
        ("DEF REAL AA[2.5]", "17020"),
        ("DEF REAL AA[2]\nAA[0]=REP(1,1.5)", "array-values"),
        ("DEF REAL AA[2]\nAA[0]=REP(1,-1)", "array-values"),
        ("DEF REAL AA[2]\nAA[0]=REP(1,3)", "array-values"),
        ("DEF REAL AA[2]\nR1=1000000000\nAA[0]=REP(1,R1*R1*R1)", "array-values"),
        ("DEF REAL AA[3]\nDEF REAL AA[2]\nAA[2]=SET(1)", "17020"),
        ("DEF REAL AA[2]\nDEF REAL AA\nAA[0]=1", "12550"),
        ("DEF REAL AA\nDEF REAL AA[2]\nAA=1", "17020"),
        ("DEF REAL AA\nDEF STRING[5] AA\nAA=1", "12550"),
        ("AA: R1=1\nREPEAT AA P=2.5", "passes"),
        ("DEF REAL AA[2]=REP(1,2,3)", "12080"),
    ],
)
def test_invalid_arrays_are_rejected(text: str, code: str) -> None:
    assert refused(text).code == code


SWAP = spf("SWAP", "PROC SWAP(VAR REAL LIST[2], VAR REAL GRID[,2])\nDEF REAL HELD\n"
           "HELD=LIST[0]\nLIST[0]=GRID[1,0]\nGRID[1,0]=HELD\nM17\n")  # fmt: skip


def test_var_array_is_written_back() -> None:
    text = "DEF REAL ONE[2]=(3,4), TWO[3,2]=(0,0,8)\nSWAP(ONE,TWO)\nG0 Z=ONE[0]\nZ=TWO[1,0]\nZ=ONE[1]"
    assert stops(source(text, SWAP)) == [8, 3, 4]


@pytest.mark.parametrize(
    ("call", "code"),
    [
        ("SWAP(ONE,ONE)", "12360"),  # one dimension where two are asked for
        ("SWAP(TWO,TWO)", "12360"),
        ("SWAP(LONG,TWO)", "12360"),
        ("SWAP(ONE[0],TWO)", "12320"),
        ("SWAP(3,TWO)", "12320"),
        ("SWAP(ONE)", "12320"),
    ],
)
def test_mismatched_var_arrays_are_rejected(call: str, code: str) -> None:
    found = refused(source(f"DEF REAL ONE[2], TWO[3,2], LONG[3]\n{call}", SWAP))
    assert (found.code, found.line) == (code, 2)


def test_array_parameter_without_var_is_rejected() -> None:
    bare = spf("BARE", "PROC BARE(REAL LIST[2])\nM17\n")
    assert "needs VAR" in refused(source("DEF REAL ONE[2]\nBARE(ONE)", bare)).message


def test_mcall_acts_after_each_move_until_empty_mcall() -> None:
    hole = spf("HOLE", "PROC HOLE(REAL DEPTH)\nG0 Z=DEPTH\nZ2\nM17\n")
    assert stops(source("MCALL HOLE(-5)\nR1=0\nG0 X10 Z2\nX20\nMCALL\nX30", hole)) == [2, -5, 2, 2, -5, 2, 2]


@pytest.mark.parametrize(
    ("text", "ends"),
    [
        ("AA:G0 Z=IC(1)\nZ=IC(1)\nREPEAT AA P=2\nZ99", [51, 52, 53, 54, 55, 56, 99]),
        ("AA:G0 Z1\nBB:Z2\nZ3\nREPEAT AA BB\nZ4", [1, 2, 3, 1, 2, 4]),
        ("AA:G0 Z1\nZ2\nENDLABEL:Z3\nZ4\nREPEAT AA", [1, 2, 3, 4, 1, 2, 3]),
        ("AA:G0 Z1\nZ2\nREPEATB AA P=2\nZ3", [1, 2, 1, 1, 3]),
        ("R1=0\nREPEAT\nR1=R1+1\nG0 Z=R1\nUNTIL R1==2", [1, 2]),
    ],
)
def test_repeat_runs_blocks_again(text: str, ends: list[float]) -> None:
    assert stops(text) == ends


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("G0 Z1\nREPEAT NOWHERE", "14080"),
        ("AA:G0 Z1\nREPEAT AA P=0", "passes"),
        ("G0 Z1\nAA: REPEAT AA", "12640"),
    ],
)
def test_invalid_repeat_is_rejected(text: str, code: str) -> None:
    assert refused(text).code == code


@pytest.mark.parametrize(("value", "z"), [(1, 10), (2, 20), (3, 30)])
def test_case_and_two_ifs_in_one_block_jump_to_their_labels(value: int, z: float) -> None:
    ends = "AA:G0 Z10\nGOTOF QQ\nBB:G0 Z20\nGOTOF QQ\nCC:G0 Z30\nQQ:"
    assert stops(f"R1={value}\nCASE R1 OF 1 GOTOF AA 2 GOTOF BB DEFAULT GOTOF CC\n{ends}") == [z]
    assert stops(f"R1={value}\nIF R1==1 GOTOF AA IF R1==2 GOTOF BB\nGOTOF CC\n{ends}") == [z]


def test_case_without_matching_value_continues() -> None:
    assert stops("R1=9\nCASE R1 OF 1 GOTOF AA\nG0 Z1\nAA:Z2") == [1, 2]
    assert refused("CASE R1 1 GOTOF AA").code == "12080"


def test_msg_joins_texts_and_numbers() -> None:
    text = 'DEF STRING[20] PART="RING"\nR1=2.5\nMSG("Ø "<<R1*2<<" OF "<<PART)\nG0 Z1\nMSG()\nG0 Z2'
    assert [block.modal.comment for block in good(text)] == ["Ø 5 OF RING", ""]


def test_program_alarms_are_raised_and_ineffective_lines_are_ignored() -> None:
    assert refused("G0 Z1\nIF 1==1\nSETAL(65000)\nENDIF").code == "program-alarm"
    assert stops('STOPRE\nSBLOF\nSBLON\nDISPLOF\nGROUP_BEGIN(0,"ROUGH",0,0)\nG0 Z1\nGROUP_END(0,0)') == [1]


@pytest.mark.parametrize(
    ("text", "code", "word"),
    [
        ("CYCLE800(1)", "not-in-subset", "CYCLE800"),
        ("POCKET3(5,0,1,-5,20,10)", "not-in-subset", "POCKET3"),
        ("R1=$AA_IM[X]", "system-variable", "$AA_IM[X]"),
        ("$TC_DP3[1,1]=5", "not-in-subset", "$TC_DP3"),
        ("DEF FRAME SHIFT", "12080", "FRAME"),
        ("CALL", "12080", "CALL"),
    ],
)
def test_unsupported_words_are_rejected_by_name(text: str, code: str, word: str) -> None:
    error = refused(f"G0 Z1\n{text}")
    assert (error.code, error.line) == (code, 2)
    assert word in error.message
    assert error.hint


def test_contour_named_in_cycle_is_loaded_with_program(tmp_path) -> None:  # type: ignore[no-untyped-def]
    (tmp_path / "kontur.spf").write_text("G1 X10 Z0\nM17\n")
    found = load_called_files(source('CYCLE95("KONTUR",1)'), [tmp_path])
    assert [each.name.lower() for each in found.subprograms] == ["kontur.spf"]
