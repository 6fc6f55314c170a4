"""Conversions of programs of other controls to SINUMERIK, calculated by hand."""

from __future__ import annotations

from typing import Any

import pytest

from core.extras.convert.conversion import Conversion
from core.extras.convert.path_steps import PathStep, SpindleState, StepKind
from core.extras.convert.proof.conversion_proof import prove
from core.extras.convert.source_options import ConversionOptions, SourceControl
from core.extras.convert.targets.target_conversion import convert_to_sinumerik
from core.interpreter.shared.job_setup import ControlLimits
from core.language.source import Dialect
from tests.extras.convert.sources import FANUC, LINUXCNC


def convert(text: str, control: str = "fanuc-a", **options: Any) -> Conversion:
    """Return the conversion of a complete program; ``omniturn`` is a control too."""
    is_omniturn = control == "omniturn"
    wanted = ConversionOptions(
        SourceControl.LINUXCNC if is_omniturn else SourceControl(control), writes_comments=False, **options
    )
    limits = ControlLimits()
    return convert_to_sinumerik(text.splitlines(), wanted, limits, "part.nc", is_omniturn=is_omniturn)


def lines_of(body: str, control: str = "fanuc-a", **options: Any) -> list[str]:
    """Return the converted lines of ``body`` after the usual beginning, without M30."""
    begin = LINUXCNC if control == "linuxcnc" else FANUC
    done = convert(f"{begin}{body}\nM30\n", control, **options)
    assert not done.errors, [each.message for each in done.errors]
    texts = [each.text for each in done.lines if each.source_line_number > begin.count("\n")]
    return texts[: texts.index("M30")]


def error_of(body: str, control: str = "fanuc-a", **options: Any) -> tuple[int, str]:
    """Return the line in ``body`` and the code of the only error."""
    begin = LINUXCNC if control == "linuxcnc" else FANUC
    (error,) = convert(f"{begin}{body}\nM30\n", control, **options).errors
    return error.line - begin.count("\n"), error.code


def test_fanuc_program_becomes_a_sinumerik_program() -> None:
    done = convert(
        "%\nO1000(PIN)\nG20G99\nG28U0W0\nT0101(ROUGH)\nG50S2500\nG96S400M03\nG00X2.1Z.1M08\nG01Z0F.01\n"
        "G02X2.6Z-.25R.25\nG97S800\nG98G01X2.8F5.\nG04P500\nG28U0W0\nT0202\nG00X1.Z.1\nM01(LOOK)\nM05\n"
        "M02\n%\n"
    )
    assert not done.errors
    assert [each.text for each in done.lines] == [
        "; part.nc", "G18 G700 G90 DIAMON G40 G54", "TRANS", "G64 G95", "; PIN", "D0", "G75 X0 Z0",
        "; ROUGH", "T1 D1",
        "G96 S400 LIMS=2500 M3", "M8", "G0 X2.1 Z0.1", "G1 Z0 F0.01", "G2 X2.6 Z-0.25 I0.25 K0",
        "G97 S800", "G1 G94 X2.8 F5", "G4 F0.5", "D0", "G75 X0 Z0", "T2 D1", "G97 S800 M3", "M8",
        "G0 X1 Z0.1", 'MSG("LOOK")', "M1", "MSG()", "M5", "M30",
    ]  # fmt: skip
    assert done.proof.compared_step_count == 14
    assert [each.line for each in done.findings if each.code == "home-fixed-point"] == [4]


@pytest.mark.parametrize(
    ("source", "made"),
    [
        ("G01U-.5W-.1", ["G1 X1.5 Z0 F0.01"]),
        ("G98G01Z0F10.", ["G1 G94 Z0 F10"]),
        ("G28U0\nG00X2.2", ["D0", "G75 X0", "D1 G0 X2.2"]),
        ("M98P7L2\nM30\nO7\nG01W-.1\nM99", ["G1 Z0 F0.01", "Z-0.1"]),
        ("G01Z-1.,C.05\nX3.", ["G1 Z-0.95 F0.01", "X2.1 Z-1", "X3"]),
        # the pass is .05 deep in X, from Z.1 to Z-1.
        ("G92X1.9Z-1.F.05", ["X1.9", "G33 Z-1 K0.05", "G0 X2", "Z0.1"]),
        # X moves .5 per side and Z .4: the lead .05 is along X
        ("G00X1.2Z.4\nX.6\nG32X1.6Z0F.05\nG00X2.2", ["X1.2 Z0.4", "X0.6", "G33 X1.6 Z0 I0.05", "G0 X2.2"]),
        # G96 and G961 contain the feed mode, and G97 selects the feed per revolution
        (
            "G96S300\nG98G01Z0F9.\nG97S500\nZ-.1",
            ["G96 S300 LIMS=3500", "G1 G961 Z0 F9", "G97 S500", "G94 Z-0.1 F9"],
        ),
        ("G96S300\nG01Z0\nG97\nM05", ["G96 S300 LIMS=3500", "G1 Z0 F0.01", "G97", "M5"]),
        ("M05\nM03S900", ["M5", "S900 M3"]),
        # a restart at the line of T has the speed, the direction, the move and the feed
        (
            "G50S1000\nG96S300M04\nG01Z0\nT0202\nG01X2.Z.1",
            ["G96 S300 LIMS=1000 M4", "G1 Z0 F0.01", "T2 D1", "G96 S300 LIMS=1000 M4", "G1 X2 Z0.1 F0.01"],
        ),
        # LIMS also limits G97, and each later G96 needs the old limit again
        (
            "G50S1000\nG96S300\nG01Z0\nG97S3000\nM03S900\nG96S300",
            ["G96 S300 LIMS=1000", "G1 Z0 F0.01", "G97 S3000 LIMS=3000", "S900", "G96 S300 LIMS=1000"],
        ),
    ],
)
def test_fanuc_line_is_converted(source: str, made: list[str]) -> None:
    assert lines_of(source) == made


def test_linuxcnc_preset_is_contained_in_the_coordinates() -> None:
    """G92 gives Z.1 the name Z.3, so that Z0 is .2 lower; G92.1 cancels it."""
    assert lines_of("G92Z.3\nG1Z0\nG92.1\nZ0", "linuxcnc") == ["G1 Z-0.2 F0.01", "Z0"]


def test_nose_compensation_starts_and_ends_on_its_moves() -> None:
    body = "G00X1.2Z.2\nG42G01Z0\nX1.6\nZ-.5\nG40G00X2.\nZ.1"
    assert lines_of(body) == [
        "X1.2 Z0.2", "G42 G1 Z0 F0.01", "X1.6", "Z-0.5", "G40 G0 X2", "Z0.1",
    ]  # fmt: skip


def test_omniturn_program_becomes_a_sinumerik_program() -> None:
    done = convert("G90G94F3000G71G73\nT1\nM03S500\nX10Z2\nG95F.2G02X12Z0I12K2\nM30\n", "omniturn")
    # OmniTurn sees the arc from the other side
    assert [each.text for each in done.lines] == [
        "; part.nc", "G18 G710 G90 DIAMOF G40 G54", "TRANS", "G64 G95", "T1 D1", "G97 S500 M3", "G0 X10 Z2",
        "G3 X12 Z0 I2 K0 F0.2", "M5", "M30",
    ]  # fmt: skip
    assert not done.errors


@pytest.mark.parametrize(
    ("body", "control", "found"),
    [
        ("G12.1", "fanuc-a", (1, "c-axis")),
        ("G37Z0", "fanuc-a", (1, "code-unknown")),
        ("M77", "fanuc-a", (1, "m-code")),
        ("G54\nG55", "fanuc-a", (2, "work-offset")),
        ("G02X3.Z0R.1", "fanuc-a", (1, "arc-too-small")),
        ("T0202\nG50X5.Z5.", "fanuc-a", (2, "preset-target")),
        ("G01Z0\nT0111\nG00X2.Z.1", "fanuc-a", (2, "tool-and-offset")),
        ("T2M6G43H12\nM3G0X2Z.1", "linuxcnc", (1, "tool-and-offset")),
        ("G92Z.3\nT2M6", "linuxcnc", (2, "preset-target")),
        ("G04P4000000", "fanuc-a", (1, "target")),
        ("G00X1.\nG32X1.1Z-1.F.05\nG32X2.Z-1.F.05", "fanuc-a", (3, "target")),
    ],
)
def test_line_without_counterpart_is_rejected(body: str, control: str, found: tuple[int, str]) -> None:
    assert error_of(body, control) == found


def test_maximum_speed_is_repeated_when_g96_starts_later_than_its_tool() -> None:
    """The tool starts with G97, so that LIMS is in the line of G96."""
    body = "G50S2000\nG96S400\nG01Z0\nG28U0W0M05\nT0202\nG97S500M03\nG00X1.Z.1\nG96S400\nG01X-.03F.005"
    speeds = [each for each in lines_of(body) if "G96" in each]
    assert speeds == ["G96 S400 LIMS=2000", "G96 S400 LIMS=2000"]


def test_surface_speed_is_converted_if_the_program_changes_its_unit() -> None:
    """300 ft/min is 300 * .3048 = 91.44 m/min; the written program is metric."""
    body = "G50S2000\nG96S300\nG01Z0\nG28U0W0\nG21\nT0202\nG96S100\nG00X25.Z2.\nG01Z-10.F.1"
    speeds = [each for each in lines_of(body) if "G96" in each]
    assert speeds == ["G96 S91.44 LIMS=2000", "G96 S100 LIMS=2000 M3"]


@pytest.mark.parametrize("body", ["G01Z0\nT0100", "G01Z0\nT0100\nG28U0W0\nT0200\nT0202\nG00X1.Z.2"])
def test_offset_that_is_cancelled_does_not_change_the_tool(body: str) -> None:
    """T0100 cancels the offset of T1, and T0200 indexes T2 without its offset."""
    tools = [each for each in lines_of(body) if each.startswith("T")]
    assert tools == ([] if "T0202" not in body else ["T2 D1"])


def test_nose_radius_is_entered_in_the_tool_table() -> None:
    body = "G00X1.2Z.2\nG42G01Z0\nX1.6\nZ-.5\nG40G00X2."
    codes = {each.code for each in convert(f"{FANUC}{body}\nM30\n").findings}
    assert "nose-table" in codes
    assert "nose-offset" not in codes


@pytest.mark.parametrize("word", ["G54", "G55"])
def test_work_offset_is_set_in_g54(word: str) -> None:
    """The program has only one work offset, and the converted program begins with G54."""
    done = convert(f"G20{word}\n{FANUC}G01Z0\nM30\n")
    assert not done.errors
    assert (1, "work-offset-g54") in [(each.line, each.code) for each in done.findings]


def test_text_of_a_stop_contains_only_the_comment_of_its_line() -> None:
    made = lines_of("G01Z0\n(PART OFF)\nM00(TURN IT)\nG01Z-.1")
    assert made == ["G1 Z0 F0.01", "; PART OFF", 'MSG("TURN IT")', "M0", "MSG()", "Z-0.1"]


def test_program_without_moves_is_rejected() -> None:
    assert [each.code for each in convert("G20G99\nT0101\nM30\n").errors] == ["file-empty"]


STEPS = [
    PathStep(StepKind.TOOL, 1, number=1),
    PathStep(StepKind.SPINDLE, 2, spindle=SpindleState(1, 100_000 / 60, True, 2000.0)),
    PathStep(StepKind.RAPID, 3, 10.0, 2.0),
    PathStep(StepKind.NOSE, 4, number=41),
    PathStep(StepKind.FEED, 4, 10.0, 0.0, feed=0.2, per_rev=True),
    PathStep(StepKind.FEED, 5, 12.0, 0.0, feed=0.2, per_rev=True),
    PathStep(StepKind.FEED, 6, 12.0, -5.0, feed=0.2, per_rev=True),
    PathStep(StepKind.RAPID, 7, 20.0, -5.0),
    PathStep(StepKind.NOSE, 7, number=40),
    PathStep(StepKind.HOME, 8, 0.0, 0.0),
    PathStep(StepKind.END, 9, number=30),
]
PROGRAM = (
    "T1 D1\nLIMS=2000 G710 DIAMON\nG96 S100 M3\nG0 X20 Z2\nG42 G1 Z0 F0.2\nX24\nZ-5\nG40 G0 X40\n"
    "D0\nG75 X0 Z0\nM30\n"
)


@pytest.mark.parametrize(
    ("line", "other"),
    [
        ("", ""),
        ("T1 D1", "T2 D1"),
        ("LIMS=2000", "LIMS=2100"),
        ("S100", "S110"),
        ("M3", "M4"),
        ("X24", "X24.01"),
        ("F0.2", "F0.3"),
        ("G42", "G41"),
        ("G40 G0 X40", "G0 X40\nG40 X41"),
        ("G75 X0 Z0", "G75 X0"),
        ("G75 X0 Z0", "G0 SUPA X0 Z0"),
        ("D0\n", ""),
        ("Z-5", "Z-5\nM8"),
        ("X24", "X24 Q1"),
    ],
)
def test_proof_detects_a_changed_program(line: str, other: str) -> None:
    """Only the unchanged program is equal to the steps."""
    text = PROGRAM.replace(line, other, 1) if line else PROGRAM
    numbers = [1] * len(text.splitlines())
    proof = prove(
        text, numbers, STEPS, ControlLimits(), is_metric=True, dialect=Dialect.SINUMERIK,
        resolution_mm=0.0001,
    )  # fmt: skip
    assert bool(proof.errors) == bool(line)
