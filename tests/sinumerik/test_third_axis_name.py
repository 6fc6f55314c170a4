"""The third axis by the name of the machine file: Q1, B or Y in the place of C."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_shipped_machine, parse_machine
from app.compose.machine.machine_setup import get_control_limits
from app.desk.status.readouts import ReadoutKind, make_position_readout
from app.jog.held_jog import make_jog_directions
from core.executor.snapshot import Snapshot
from core.interpreter.shared.checkpoint import Checkpoint, PassStart
from core.interpreter.shared.job_setup import InterpreterSetup, ZeroOffset
from core.language.sinumerik import lex_line
from core.machine.machine_model import Machine
from core.table_schema import MachineFileError
from tests.coded import raises_code
from tests.sinumerik.lathe import good, refused, run, setup

TEXT = load_shipped_machine("sinumerik-modulo").text


def of(name: str) -> Machine:
    return parse_machine(TEXT.replace("[axis.C]", f'[axis.C]\nname = "{name}"'), "t")


def around(name: str) -> InterpreterSetup:
    return setup(of(name))


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("Q1", "G0 Q1=90 X30"), ("Q1", "G0 X30 Q1 = DC(90)"), ("Q1", "G0 X30Q1=AC(90)"),
        ("B", "G0 X30 B90"), ("B", "G0 X30B90."), ("B", "G0 B=90 X30"), ("b1", "G0 X30 B1=90"),
        ("Y", "G0 X30 Y90"), ("A", "G0 A=ACP(90) X30"),
    ],
)  # fmt: skip
def test_words_with_axis_name_move_the_third_axis(name: str, words: str) -> None:
    (block,) = good(words, around(name.upper()))
    assert (block.c, block.mx) == (90.0, 15.0)
    assert block.text == words


def test_offsets_and_distances_use_the_axis_name() -> None:
    """G54 turns it by 15, TRANS by 30: position 10 of the program is 55; then 20 on."""
    zero = replace(around("B"), zero={54: ZeroOffset(c=15.0)})
    first, second = good("G54\nTRANS B30\nG0 B=DC(10)\nG91 B20", zero)
    assert (first.machine_end[2], second.machine_end[2]) == pytest.approx((55.0, 75.0))


@pytest.mark.parametrize(
    ("name", "text", "code", "said"),
    [
        ("Q1", "G0 C90", "not-in-subset", "no C axis; its third axis is Q1"),
        ("Q1", "G0 X10 C=DC(90)", "not-in-subset", "no C axis; its third axis is Q1"),
        ("Q1", "G0 B90", "not-in-subset", "no B axis"),
        ("Q1", "G0 Q1=360", "16830", "axis Q1"),
        ("B", "G0 B=DC(360)", "16830", "axis B"),
        ("B", "G0 B10 B20", "12010", ""),
        ("B", "G0 B=QC(1)", "12080", ""),
        ("C", "G0 B90", "not-in-subset", "no B axis"),
        ("Y", "M5\nTRANSMIT", "14401", "third axis of this machine is Y"),
    ],
)
def test_words_with_wrong_axis_name_are_rejected(name: str, text: str, code: str, said: str) -> None:
    error = refused(text, around(name))
    assert error.code == code
    assert said in error.message


def test_texts_and_variables_with_axis_name_are_unchanged() -> None:
    passed = run('DEF REAL CB1=3\nMSG("C90 B90")\nG0 Z=CB1\nLABEL_B:\nR1=2', around("B"))
    assert passed.errors == []
    line = lex_line(1, 'N10 MSG("B90 C90")', "B")
    assert line.errors == ()


def test_mdi_line_uses_the_axis_name() -> None:
    begin = PassStart(Checkpoint(run("G0 X20", around("Q1")).blocks[-1].modal), is_mdi_line=True)
    blocks = run("G0 Q1=45", replace(around("Q1"), begin=begin)).moves
    assert [block.c for block in blocks] == [45.0]


def test_axis_name_is_specified_in_machine_file() -> None:
    assert get_control_limits(of("Q1")).third_axis_name == "Q1"
    assert load_shipped_machine("sinumerik-modulo").third_axis_name == "C"
    for wrong in ("X", "Z", "Q", "SPINDLE", "Q10", ""):
        with raises_code(MachineFileError, "wrong-value", "axis.C.name"):
            of(wrong)


def test_readout_shows_the_axis_name() -> None:
    machine = of("Q1")
    assert [way.displayed_axis_name for way in make_jog_directions(machine) if way.axis_name == "C"] == [
        "Q1",
        "Q1",
    ]
    shown = make_position_readout(Snapshot(), ReadoutKind.POSITION, True, True, machine.third_axis_name)
    assert [axis.name for axis in shown.axes] == ["X", "Z", "Q1"]
