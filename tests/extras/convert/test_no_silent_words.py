"""Every G code, M code and letter of a source program is either converted or reported by name.

A word is converted if the steps of the program change. A code that repeats the active mode changes the steps
at least after another mode.
"""

from __future__ import annotations

from dataclasses import astuple

import pytest

from core.extras.convert.source_options import ConversionOptions, SourceControl
from core.extras.convert.source_reader import read_source
from tests.extras.convert.sources import converted

BEGIN = {
    "fanuc-a": "G20G99\nT0202\nG97S500M03\nG00X2.Z.1\nG01F.01\n",
    "haas": "G20G99\nT0202\nG97S500M03\nG00X2.Z.1\nG01F.01\n",
    "fanuc-b": "G20G95G90\nT0202\nG97S500M03\nG00X2.Z.1\nG01F.01\n",
    "linuxcnc": "G20G7G95G90\nT2M6\nG97S500M3\nG0X2Z.1\nG1F.01\n",
    "mach": "G20G7G95G90\nT0202\nG97S500M3\nG0X2Z.1\nG1F.01\n",
}
END_OF_CODES = "X1.9Z.05\nX1.7Z0\nG1X1.65\n"
END_OF_LETTERS = "G0X1.9Z.05\nG1X1.7Z0\n"
HOLE = "G0X0Z.2\nG17\nG81Z-.3R.1\nX.5\n"
HOLE_OF_FANUC = HOLE.replace("R.1", "R-.1")  # a distance
HOLES = {"fanuc-b": HOLE_OF_FANUC, "linuxcnc": HOLE, "mach": HOLE}
OTHER_MODES = (
    "G0",
    "G1",
    "G21",
    "G98F1.",
    "G96S300",
    "G94F1.",
    "G91",
    "G8",
    "M5",
    "M4",
    "G42D2\nX1.95",
    "G99",
)
MODES = ("", *(f"{each}\n" for each in OTHER_MODES))
CONTROLS = sorted(BEGIN)
# All codes that Fanuc, Haas, LinuxCNC and Mach lathes define are in these ranges.
G_CODES = [*range(300), *(n + d / 10 for n in range(120) for d in range(1, 10))]
M_CODES = range(1000)

Steps = list[tuple[object, ...]]


def read(text: str, control: str) -> tuple[Steps, list[tuple[int, int, str]]]:
    """Return the steps without their line numbers, and line, column and text of each finding."""
    options = ConversionOptions(SourceControl(control), no_point=1, m_codes=frozenset({25, 26}))
    state, found = read_source(text.splitlines(), options)
    steps = [(each.kind, *astuple(each)[2:]) for each in state.steps]
    return steps, [(each.line, each.column, each.message) for each in found]


def is_handled(before: str, line: str, word: str, control: str, end: str) -> bool:
    """Return whether the word in a line is reported by name at its position, or changes the steps."""
    begin = BEGIN[control] + before
    steps, found = read(f"{begin}{line}\n{end}M30\n", control)
    row, column = begin.count("\n") + 1, line.rindex(word) + 1
    # P and Q of G64 are named in the finding of G64.
    if any(each[0] == row and (each[1] == column or "G64" in line) and word in each[2] for each in found):
        return True
    without, found_without = read(f"{begin}{line.replace(word, '')}\n{end}M30\n", control)
    return steps != without or len(found) > len(found_without)


@pytest.mark.parametrize("control", CONTROLS)
def test_each_g_code_is_converted_or_reported(control: str) -> None:
    end = END_OF_CODES + HOLES.get(control, "")
    silent = []
    for code in G_CODES:
        word = f"G{code:g}"
        if not any(is_handled(each, word, word, control, end) for each in MODES):
            silent.append(word)
    assert silent == []


@pytest.mark.parametrize("control", CONTROLS)
def test_each_m_code_is_converted_or_reported(control: str) -> None:
    silent = []
    for code in M_CODES:
        word = f"M{code}"
        if not any(is_handled(each, word, word, control, END_OF_CODES) for each in MODES):
            silent.append(word)
    assert silent == []


LINES = {
    "all": ("G0X1.8Z0", "G1X1.8Z0", "G3X1.7Z.05R.4", "G4P1.", "G28", "G53X0Z0", "M8", "G40"),
    "fanuc": (
        "G32Z-1.F.05", "G71U.1R.1", "G71P1Q2U0W0", "G70P1Q2", "G73U.1W.1R3", "G74R.1", "G76P010060Q0R0",
        "G76X1.8Z-1.P100Q100F.05", "G50S1000", "G22X-1.Z-9.I0K0", "G50.1X0Z0", "G83Z-1.R0Q1000",
        "G84Z-1.", "G85Z-1.",
    ),
    "fanuc-a": ("G75X1.8Z0P100Q100", "G90X1.8Z-1.", "G92X1.8Z-1.F.05", "G94X1.8Z0"),
    "haas": ("G90X1.8Z-1.", "G92X1.8Z-1.F.05", "G76X1.8Z-1.K.1D100F.05", "G74Z-1.K.1", "G75X1.8Z0I.1K.05"),
    "fanuc-b": ("G75X1.8Z0P100Q100", "G77X1.8Z-1.", "G78X1.8Z-1.F.05", "G79X1.8Z0", "G91G1X-.1"),
    "linuxcnc": (
        "G33Z-1K.05", "G76P.05Z-1I-.1J.01K.03", "G43", "G64", "G17G83Z-1R0Q.1", "G17G81Z-1R0", "G96D900S300",
        "G92X1",
    ),
    "mach": ("G33Z-1K.05", "G43", "G64", "G17G82Z-1R0P1", "G92X1"),
}  # fmt: skip


@pytest.mark.parametrize("control", CONTROLS)
def test_each_letter_of_each_line_is_used_or_reported(control: str) -> None:
    fanuc = LINES["fanuc"] if control in {"fanuc-a", "fanuc-b", "haas"} else ()
    contour = "N1G00X1.5\nN2G01Z-.2\n" if fanuc else ""
    silent = []
    for line in (*LINES["all"], *fanuc, *LINES[control]):
        for letter in sorted({*"ABCDEFHIJKLPQRSTUVWXYZ"} - set(line)):
            word = f"{letter}3."
            before = f"{contour}G0X2.Z.1\nG71U.1R.1\n" if "P1" in line and contour else ""
            if not is_handled(before, line + word, word, control, END_OF_LETTERS):
                silent.append(line + word)
    assert silent == []


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("T0211", ("tool-of-offset", 6, 1)),
        ("/G01Z0", ("block-delete-kept", 6, 1)),
        ("N10 /G01Z0", ("bad-word", 6, 5)),
        ("/IF[1EQ1]GOTO9\nN9", ("block-delete-kept", 6, 1)),
        ("G04P50", ("dwell-short", 6, 4)),
        ("G04P0", ("no-change", 6, 4)),
        ("G04P-5", ("dwell-negative", 6, 4)),
        ("G04X1.P500", ("word-twice", 6, 7)),
        ("M07", ("replaced", 6, 1)),
        ("M60", ("replaced", 6, 1)),
        ("M06", ("no-change", 6, 1)),
        ("G54", ("work-offset-used", 6, 1)),
        ("G54\nG55", ("work-offset", 7, 1)),
        ("G17\nG02X2.1Z0R.5", ("plane", 7, 1)),
        ("G01X1.X2.", ("word-twice", 6, 7)),
        ("G00G01X1.", ("word-twice", 6, 4)),
        ("G28U0G04P500", ("word-twice", 6, 6)),
        ("G28U0G37", ("code-unknown", 6, 6)),
        ("G30U0", ("home-position", 6, 1)),
        ("G01Z-.5C.05\nG28U0", ("corner", 6, 8)),
        ("G01Z-.5C.05", ("corner", 6, 8)),
        ("GOTO9\nG01Z0\nX1.\nN9", ("not-executed", 7, 1)),
        ("IF[1EQ1]GOTO9G01X1.\nN9", ("bad-word", 6, 14)),
    ],
)
def test_change_of_a_word_is_reported(body: str, found: tuple[str, int, int]) -> None:
    done = converted(f"{BEGIN['fanuc-a']}{body}\nM30\n")
    assert found in [(each.code, each.line, each.column) for each in done.findings]


@pytest.mark.parametrize("contour", ["N1G00X1.\nG01Z-.2\nN2X2.\n", "N1G00X1.\nG01Z-.2\nG70P1Q2\nN2X2.\n"])
def test_a_contour_before_its_cycle_does_not_repeat_the_program(contour: str) -> None:
    done = converted(f"{BEGIN['fanuc-a']}{contour}G00X2.Z.1\nG71U.1R.1\nG71P1Q2U0W0\nG01X3.\nM30\n")
    codes = [each.code for each in done.errors]
    assert codes == (["cycle-nested"] if "G70" in contour else [])


def test_lines_after_the_end_are_reported() -> None:
    done = converted(f"{BEGIN['fanuc-a']}G01Z0\nM30\nG00X5.\nG01Z-1.\n%\n")
    found = [(each.code, each.line) for each in done.findings if each.code == "not-executed"]
    assert found == [("not-executed", 8)]


def test_actions_inside_a_roughing_contour_are_reported() -> None:
    done = converted(f"{BEGIN['fanuc-a']}G71U.1R.1\nG71P1Q2U0W0\nN1G00X1.\nM08\nG01Z-.2\nN2X2.\nM30\n")
    assert ("contour-action", 9) in [(each.code, each.line) for each in done.findings]


@pytest.mark.parametrize(
    ("body", "code"),
    [
        ("G43H33", "tool-number"),
        ("T4M6\nG92X1Z1\nG92.1\nG0X3", "preset-cancelled"),
        ("G17G81Z-1R0\nG80\nX1", "motion-missing"),
        ("G17G81Z-1R0L3", "code-unknown"),
        ("T101M6", "tool-number"),
        ("O1 IF [1 EQ 1] G1X1\nO1 ENDIF", "bad-word"),
        ("O1 SUB\nO1 ENDSUB [5]\nO1 CALL", "bad-word"),
    ],
)
def test_linuxcnc_word_without_an_equal_is_rejected(body: str, code: str) -> None:
    errors = converted(f"{BEGIN['linuxcnc']}{body}\nM30\n", "linuxcnc").errors
    assert [each.code for each in errors] == [code]


def test_t_of_linuxcnc_prepares_the_tool_until_m6() -> None:
    done = converted(f"{BEGIN['linuxcnc']}T3\nG1Z0\nM6\nG0X2Z.1\nM30\n", "linuxcnc")
    texts = [each.text for each in done.lines]
    assert texts.index("T3") > texts.index("G95F.01Z0")


def test_g43_selects_the_tool_of_the_offset() -> None:
    done = converted(f"{BEGIN['linuxcnc']}G43H3\nG0X2Z.2\nG92X1\nG92.1\nM30\n", "linuxcnc")
    assert [each.text for each in done.lines][4:6] == ["T3", "X2Z.2"]
    assert "tool-of-offset" in [each.code for each in done.findings]


def test_g0_on_a_line_with_g28_stays_active() -> None:
    done = converted(f"{BEGIN['fanuc-a']}G01Z0\nG00G28U0\nX1.5\nM30\n")
    assert done.lines[-2].text == "X1.5Z0"  # a rapid; G01 would be written as G95F.01


def test_g80_of_fanuc_returns_to_the_move_before_the_cycle() -> None:
    done = converted(f"{BEGIN['fanuc-a']}G01Z0\nG83Z-1.R0\nG80\nX1.5\nM30\n")
    assert done.lines[-2].text == "G95F.01X1.5"
