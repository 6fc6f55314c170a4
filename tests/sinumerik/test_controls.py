"""802D, 808D, 828D, 840D: what the control of the machine file has not is refused by its name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from app.compose.machine.machine_files import load_shipped_machine, parse_machine
from app.compose.machine.machine_setup import get_control_limits
from core.interpreter.dialects import get_code_book
from core.interpreter.shared.job_setup import InterpreterSetup
from core.language.sinumerik.control_differences import CONTROL_NAMES, MISSING_FUNCTIONS
from core.language.source import Dialect
from core.table_schema import MachineFileError
from tests.coded import raises_code
from tests.sinumerik.lathe import refused, run, setup

PAGE = Path(__file__).parents[2] / "docs" / "sinumerik-controls.md"


def of(control: str) -> InterpreterSetup:
    return replace(setup(), limits=replace(setup().limits, control_model=control))


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("R1=1\nWHILE R1<2\nR1=2\nENDWHILE", "WHILE"),
        ("R1=1\nIF R1==1\nG0 Z3\nENDIF", "IF without a jump"),
        ("DIAM90", "DIAM90"),
        ("G505 G0 X20", "G505"),
        ('T="ROUGHER"', 'T="NAME"'),
        ("CYCLE832()", "CYCLE832"),
        ("DYNFINISH", "DYNFINISH"),
    ],
)
@pytest.mark.parametrize("control", ["802d", "808d"])
def test_function_missing_from_small_control_is_rejected(text: str, named: str, control: str) -> None:
    error = run(text, of(control)).errors[0]
    assert error.code == "not-in-control"
    assert f"{named} is not a function of the SINUMERIK {control.upper()}" in error.message
    assert '"control" under [machine]' in error.hint


def test_cycle99_is_available_on_808d_and_not_on_802d() -> None:
    text = "S800 M3\nG0 X44 Z6\nCYCLE99(0,40,-20,40,4,2,0.92,0.05,30,,4,1,1.5,300103,1)"
    assert refused(text, of("802d")).code == "not-in-control"
    assert run(text, of("808d")).errors == []


@pytest.mark.parametrize("control", CONTROL_NAMES)
def test_common_functions_are_available_on_all_controls(control: str) -> None:
    text = 'G18 G90 G71 DIAMON\nR1=1\nAGAIN: R1=R1+1\nIF R1<3 GOTOB AGAIN\nG0 X20 Z5\nMSG("A")\nM30'
    assert run(text, of(control)).errors == []


@pytest.mark.parametrize("control", ["828d", "840d"])
def test_large_controls_lack_no_function(control: str) -> None:
    assert run("R1=1\nWHILE R1<2\nR1=2\nENDWHILE\nDIAM90\nG0 X20", of(control)).errors == []


def test_control_is_specified_in_machine_file() -> None:
    text = load_shipped_machine("sinumerik-modulo").text
    machine = parse_machine(text.replace("[machine]", '[machine]\ncontrol = "802d"'), "t")
    assert get_control_limits(machine).control_model == "802d"
    assert load_shipped_machine("sinumerik-modulo").control_model == "840d"
    with raises_code(MachineFileError, "wrong-value", "machine.control"):
        parse_machine(text.replace("[machine]", '[machine]\ncontrol = "810"'), "t")


def test_page_names_every_missing_function() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for control in CONTROL_NAMES:
        assert f"`{control}`" in page
        assert [name for name in MISSING_FUNCTIONS[control] if f"`{name}`" not in page] == []


def test_missing_functions_are_all_in_code_book() -> None:
    heads = {entry.head for entry in get_code_book(Dialect.SINUMERIK).entries}
    spoken = {name for lacks in MISSING_FUNCTIONS.values() for name in lacks} - {
        'T="NAME"',
        "IF without a jump",
    }
    assert spoken - heads == set()
