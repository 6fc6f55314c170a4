"""Recognition of programs of other controls."""

from __future__ import annotations

import pytest

from app.compose.machine.machine_setup import read_machine
from app.extras.convert.extra import has_conversions
from core.extras.convert.recognition import recognize_other_control
from tests.extras.convert.sources import FANUC, LINUXCNC


@pytest.mark.parametrize(
    ("text", "control"),
    [
        (FANUC, "fanuc-a"),
        (LINUXCNC, "linuxcnc"),
        ("G90.1\nG0X1Z1\nM30\n", "mach"),
        ("%\nO1\nG28\nT101\nG50S1000\nG0X2.Z.1\nM30\n", "haas"),
        ("O12\nG98\nG0X2.\nM30\n", "fanuc-a"),  # a program number alone does not distinguish A from B
    ],
)
def test_program_of_another_control_is_recognized(text: str, control: str) -> None:
    assert recognize_other_control(text.splitlines()) == control


@pytest.mark.parametrize(
    "text",
    [
        "",
        "(T0101 G50S1000)\nG90\nM30\n",  # only a comment
        "G90G94F300G70G72\nT1\nG33X1Z-.3I.05K.05O\nM30\n",  # G33 of LinuxCNC has K too
        "G90G94F300G70G72\nT1\nG74X1Z-.3I.05U.01W.01\nM30\n",  # U and W of Fanuc are increments
        "T0101\n",  # one marker can be a typing error
    ],
)
def test_omniturn_program_is_not_recognized_as_another_control(text: str) -> None:
    assert recognize_other_control(text.splitlines()) is None


@pytest.mark.parametrize(
    ("machine", "expected"),
    [(None, True), ("sinumerik-modulo", True), ("head-table-mill", False), ("fork-head-mill", False)],
)
def test_only_lathes_have_conversions(machine: str | None, expected: bool) -> None:
    assert has_conversions(read_machine(machine)) is expected
