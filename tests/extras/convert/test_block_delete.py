"""Block delete and program numbers of other controls.

Lines with / keep their / if both settings of block delete can be proved.
"""

from __future__ import annotations

import pytest

from core.extras.convert.conversion import convert_program, find_deletable_lines
from core.extras.convert.source_options import ConversionOptions, SourceControl
from core.interpreter.shared.job_setup import ControlLimits
from tests.extras.convert.sources import FANUC, converted


def findings_after(body: str) -> tuple[list[str], set[str]]:
    """Return the converted lines of ``body`` and the codes of the findings with block delete."""
    done = converted(f"{FANUC}{body}\nM30\n")
    assert not done.errors
    codes = {each.code for each in done.findings if each.code.startswith("block-delete")}
    return [each.text for each in done.lines][4:-1], codes


@pytest.mark.parametrize(
    ("body", "lines"),
    [
        ("/M08\nG01Z-.5\nX2.2", ["/M08", "G95F.01X2Z-.5", "X2.2"]),
        ("G01Z-.5\n/M01\nX2.2", ["G95F.01Z-.5", "/M01", "G95F.01X2.2Z-.5"]),
        # The move after the lines names only Z, so X must stay as it is: 2.1, or 2 without these lines.
        ("/G01Z-.5\n/X2.1\nG00Z.1\nX3.", ["/G95F.01Z-.5", "/X2.1", "G00Z.1", "X3"]),
        # The move after the line names the same X, so X must not be left out.
        ("/G01X2.1\nG01X2.1Z-.5", ["/G95F.01X2.1Z.1", "G95F.01X2.1Z-.5"]),
        ("/S800\nG01Z-.5", ["/G97S800", "G95F.01X2Z-.5"]),
        ("G01Z-.5\n/2X2.1F.002\n/2X2.\nX2.2F.01", None),
    ],
)
def test_line_keeps_its_block_delete(body: str, lines: list[str] | None) -> None:
    written, codes = findings_after(body)
    assert codes == {"block-delete-kept"}
    if lines is not None:
        assert written == lines


@pytest.mark.parametrize(
    ("body", "lines"),
    [
        # Without the first line, the center of the arc would be elsewhere.
        ("/G03X2.2Z0R.1\nG02X2.4Z-.1R.1", ["G95F.01G02X2.2Z0I0K-.1", "G03X2.4Z-.1I.1K0"]),
        # Two switches on the other control, but one here.
        ("/2M08\n/3M09\nG01Z0", ["M08", "M09", "G95F.01Z0"]),
    ],
)
def test_line_that_cannot_be_proved_both_ways_is_executed_with_a_warning(body: str, lines: list[str]) -> None:
    assert findings_after(body) == (lines, {"block-delete"})


def test_unit_in_a_deletable_line_is_executed_with_a_warning() -> None:
    done = converted(f"/{FANUC}G01Z-.5\nM30\n", metric=True)
    assert {each.code for each in done.findings} >= {"block-delete"}


def test_lines_with_one_switch_are_deletable() -> None:
    options = ConversionOptions(SourceControl("fanuc-a"))
    assert find_deletable_lines(["/X1", "X2", "/N30X3"], options) == {1, 3}
    assert find_deletable_lines(["/1X1", "/2X2"], options) == set()
    assert find_deletable_lines(["X1"], options) == set()


@pytest.mark.parametrize(
    ("begin", "comment"),
    [
        ("%\nO1000(PIN)\n", "(L4 O1000)"),
        ("O0042\n", "(L3 O0042)"),
        ("(PIN)\n:77\n", "(L4 O77)"),
        ("N5G40\nO9\n", "(L4)"),  # not at the start of the program
        ("", "(L2)"),
    ],
)
def test_first_line_names_the_program_number(begin: str, comment: str) -> None:
    """L is the line of T0101, the second line of ``FANUC``, because it is the first with an effect."""
    options = ConversionOptions(SourceControl("fanuc-a"))
    text = f"{begin}{FANUC}G01Z0\nM30\n"
    done = convert_program(text.splitlines(), options, ControlLimits())
    first = done.lines[0].text
    assert first[first.index("(") :] == comment
    assert "O" not in converted(text).lines[0].text
