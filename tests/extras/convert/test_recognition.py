"""Recognition of programs of other controls."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.compose.machine.machine_setup import read_machine
from app.extras.convert.extra import has_conversions
from core.extras.convert.recognition import recognize_language, recognize_other_control
from tests.extras.convert.sources import FANUC, LINUXCNC

ROOT = Path(__file__).parents[3]


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
        "G90G94F300G70G72\nT1\nG1X1Z.1\nG72G75I.05U.01F.01\nX.5\nRF\nM30\n",  # G1 is a typing error
    ],
)
def test_omniturn_program_is_not_recognized_as_another_control(text: str) -> None:
    assert recognize_other_control(text.splitlines()) is None


@pytest.mark.parametrize(
    "text",
    [
        "G90G94F300\nT1\nX1.Z.1\nM30\n",  # a move without a G code for moves
        "G90\nT1\nG00X1.Z.1\nG33X1.Z-.3I.05K.05\nM30\n",  # G33 of LinuxCNC has K, but not I
        "G90G94F300G72\nT1\nG00X1.Z.1\nG74X.5Z-.3I.05U.01\nM30\n",  # U of Fanuc is an increment
        "G90G94F300G71G72(G18 T0101)\nG00\nT1\nX1.Z.1\nM30\n",
        "G91\nG00\nLS5\nX-.1\nLF\nM30\n",
        "G90\nG00X1.Z1.\nP1\nM30\n}1\nM99\n",
        "G90\nG00X1.Z1.\nG96S300\nG77S2500\nM30\n",
        "G90\nG00X1.Z1.\nM19\n(~PLXC)\n(X1Y0)\n(END)\nM30\n",
        "%\nG90G94F300G72\nT1\nX1.Z.1\nM30\n%\n",  # a transfer adds %
    ],
)
def test_language_of_an_omniturn_program_is_recognized(text: str) -> None:
    assert recognize_language(text.splitlines()) == "omniturn"


@pytest.mark.parametrize(
    ("text", "control"),
    [
        (FANUC, "fanuc-a"),
        (LINUXCNC, "linuxcnc"),
        ("G90 G94 G18 G20\nG0 X1 Z1\nG1 Z0 F10\nM2\n", "linuxcnc"),  # begins with G90 too
        ("G90 G18 G21\nG00 X10 Z1\nG33 Z-5 K1\nM2\n", "linuxcnc"),
        ("G18\nG00X1Z1\nG33Z-1K.05\nM2\n", "linuxcnc"),
        ("O0001\nG90 G20 G99\nT0101\nG00 X1. Z1.\nG72 W.1 R.05\nG72 P1 Q2 U.01 W.01 F.01\nM30\n", "fanuc-a"),
        ("%\nO1\nG28\nT101\nG50S1000\nG0X2.Z.1\nM30\n", "haas"),
    ],
)
def test_language_of_another_control_is_recognized(text: str, control: str) -> None:
    assert recognize_language(text.splitlines()) == control


@pytest.mark.parametrize(
    "text",
    [
        "",
        "%\n(G90 ONLY)\n",
        "G90\nG00X1Z1\nG01Z0F10\nM30\n",  # valid in OmniTurn and in LinuxCNC
        "G90G94F300\nT0101\nN10G28U0\nX1.Z1.\nM30\n",  # words of both
        "X1.Z1.\nM30\n",  # OmniTurn begins with G90 or G91
        "G90\nG0X1.Z1.\nM30\n",  # G0 alone can be a typing error
    ],
)
def test_unclear_language_is_not_recognized(text: str) -> None:
    assert recognize_language(text.splitlines()) is None


def test_all_omniturn_programs_with_a_first_line_are_recognized() -> None:
    """Only programs with errors are unclear. None is recognized as a program of another control."""
    paths = [*(ROOT / "resources" / "programs").glob("*.nc"), *(ROOT / "tests" / "programs").glob("*.nc")]
    found = {each.name: recognize_language(each.read_text(errors="replace").splitlines()) for each in paths}
    unclear = {name for name, language in found.items() if language != "omniturn"}
    assert unclear <= {each for each in found if each.startswith("refuse_")}
    assert len(unclear) <= 0.02 * len(found)


@pytest.mark.parametrize(
    ("machine", "expected"),
    [(None, True), ("sinumerik-modulo", True), ("head-table-mill", False), ("fork-head-mill", False)],
)
def test_only_lathes_have_conversions(machine: str | None, expected: bool) -> None:
    assert has_conversions(read_machine(machine)) is expected
