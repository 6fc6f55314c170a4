"""Conversions of OmniTurn programs to LinuxCNC and Fanuc, calculated by hand."""

from __future__ import annotations

from typing import Any

import pytest

from core.extras.convert.conversion import Conversion
from core.extras.convert.omniturn_writer import WrittenLine
from core.extras.convert.source_options import ConversionOptions, SourceControl, TargetControl
from core.extras.convert.targets.omniturn_steps import interpret_source
from core.extras.convert.targets.read_back_proof import prove_by_reading
from core.extras.convert.targets.target_conversion import convert_from_omniturn
from core.interpreter.shared.job_setup import ControlLimits

BEGIN = "G90G94F300G70G72\nT1\nM03S1000\nX2.Z.1\nG95F.01\n"
"""The tool is at X2. Z.1 with the feed .01 in/rev, after five lines."""
LIMITS = ControlLimits(m_code_outputs={25: ("catcher", True), 26: ("catcher", False)})


def convert(text: str, target: str, title: str = "part.nc", **options: Any) -> Conversion:
    """Return the conversion of a complete OmniTurn program."""
    wanted = ConversionOptions(SourceControl.LINUXCNC, writes_comments=False, **options)
    return convert_from_omniturn(text.splitlines(), TargetControl(target), wanted, LIMITS, title)


def complete(body: str) -> str:
    """Return a program with the usual beginning, and with M30 unless ``body`` contains it."""
    return f"{BEGIN}{body}\n" if "M30" in body else f"{BEGIN}{body}\nM30\n"


def lines_of(body: str, target: str, **options: Any) -> list[str]:
    """Return the lines for ``body`` without those of the beginning and of M30."""
    done = convert(complete(body), target, **options)
    assert not done.errors, [each.message for each in done.errors]
    end = complete(body).splitlines().index("M30") + 1
    return [
        each.text for each in done.lines if each.source_line_number > 5 and each.source_line_number != end
    ]


def error_of(body: str, target: str = "linuxcnc", **options: Any) -> tuple[int, str]:
    """Return the line in ``body`` and the code of the only error."""
    (error,) = convert(complete(body), target, **options).errors
    return error.line - 5, error.code


def test_program_for_linuxcnc_states_its_modes_and_restarts_the_spindle() -> None:
    done = convert(
        "G90G94F300G70G72\nT0\nX0Z0\nT1(ROUGHER)\nG77S2500\nG96M03S400\nX1.1Z.1\nM08\n"
        "G95F.006G01Z-.5\nT0\nG00X0Z0\nT2\nX0Z.1\nG94F2Z-.2\nG04F.5\nM01(LOOK)\nM05\nM30\n",
        "linuxcnc",
    )
    assert [each.text for each in done.lines] == [
        "(part.nc)", "G20 G18 G7 G90 G40 G97 G54", "G80 G91.1 G92.1", "G64 P0.0005", "G30",
        "(ROUGHER)", "T1 M6 G43", "G96 D2500 S400 M3", "G0 X1.1 Z.1", "M8", "G1 G95 Z-.5 F.006",
        "G30", "T2 M6 G43", "G96 D2500 S400 M3", "M8", "G0 X0 Z.1", "G1 G94 Z-.2 F2", "G4 P.5",
        "(MSG, LOOK)", "M1", "M5", "M9", "M30",
    ]  # fmt: skip
    assert [each.source_line_number for each in done.lines][4:11] == [3, 4, 4, 6, 7, 8, 9]
    assert [(each.line, each.code) for each in done.findings] == [
        (3, "home-stored-point"), (7, "rapid-rate"), (12, "spindle-restarted"),
    ]  # fmt: skip


def test_program_for_fanuc_has_decimal_points_and_a_program_number() -> None:
    done = convert("G90G94F3000G71G73\nT1\nG96M03S120\nX10Z2(ROUGH)\nG95F.2Z-8\nT0\nG00X0Z0\nM02\n", "fanuc")
    # G73: X is a radius of 10 mm, so the diameter is 20 mm; without G77, the limit of the lathe is 3500 rpm
    assert [each.text for each in done.lines] == [
        "%", "O0001 (PART.NC)", "G21", "G18 G40 G80 G97 G99 G54", "T0101", "G50 S3500",
        "G96 S120 M03", "(ROUGH)",
        "G00 X20. Z2.", "G01 G99 Z-8. F.2", "G28 U0 W0", "M02", "%",
    ]  # fmt: skip
    assert [(each.line, each.code) for each in done.findings] == [
        (3, "maximum-speed-added"), (4, "rapid-rate"), (4, "rapid-path"),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("body", "linuxcnc", "fanuc"),
    [
        ("Z0\nX1.8\nG00Z.1", ["G1 G95 Z0 F.01", "X1.8", "G0 Z.1"], ["G01 G99 Z0. F.01", "X1.8", "G00 Z.1"]),
        ("G94F10Z0", ["G1 G94 Z0 F10"], ["G01 G98 Z0. F10."]),
        # X+ points toward the operator in OmniTurn, so the direction of an arc is reversed
        ("G02X2.5Z-.15I0K-.25", ["G3 G95 X2.5 Z-.15 I0 K-.25 F.01"], ["G03 G99 X2.5 Z-.15 I0. K-.25 F.01"]),
        ("P4\nM30\n}4\nZ0\nM99", ["G1 G95 Z0 F.01"], ["G01 G99 Z0. F.01"]),
        ("LS2\nG91\nZ-.1\nG90\nLF", ["G1 G95 Z0 F.01", "Z-.1"], ["G01 G99 Z0. F.01", "Z-.1"]),
        # G92 gives X2. Z.1 the name Z.3, so Z0 is .2 lower
        ("G92Z.3\nZ0", ["G1 G95 Z-.2 F.01"], ["G01 G99 Z-.2 F.01"]),
        ("M09\nM00(TURN IT)", ["M9", "(MSG, TURN IT)", "M0"], ["M09", "M00 (TURN IT)"]),
        ("(NOTE)\nM04S800", ["(NOTE)", "G97 S800 M4"], ["(NOTE)", "G97 S800 M04"]),
    ],
)
def test_line_is_converted(body: str, linuxcnc: list[str], fanuc: list[str]) -> None:
    assert lines_of(body, "linuxcnc") == linuxcnc
    assert lines_of(body, "fanuc") == fanuc


def test_comment_has_only_the_characters_of_fanuc() -> None:
    """% ends a Fanuc file, ; and : begin a block or a program, and # and @ are macro words."""
    assert (
        lines_of("(25% off; #1 @ 3:1 A-B_C=D/E.,+*)\nZ0", "fanuc")[0] == "(25  OFF   1   3 1 A-B C=D/E.,+*)"
    )
    done = convert(complete("Z0"), "fanuc", title="my_part%1.nc")
    assert done.lines[1].text == "O0001 (MY PART 1.NC)"


@pytest.mark.parametrize(
    ("comment", "made"),
    [
        ("MSG, STOP", "(* MSG, STOP)"),
        ("debug,#1", "(* debug,#1)"),
        ("PROBEOPEN a.txt", "(* PROBEOPEN a.txt)"),
        ("PY,x=1", "(* PY,x=1)"),
        ("AXIS,hide", "(* AXIS,hide)"),
        ("PRINTED PART", "(PRINTED PART)"),
    ],
)
def test_comment_is_not_a_command_of_linuxcnc(comment: str, made: str) -> None:
    assert lines_of(f"({comment})\nZ0", "linuxcnc")[0] == made


def test_first_move_of_a_tool_is_written_where_the_tool_before_stood() -> None:
    """Both tools have their own tip, so T2 must move although its end point is that of T1."""
    assert lines_of("X.375Z0\nT2\nG00X.375Z0\nG01Z-.4", "fanuc") == [
        "G01 G99 X.375 Z0. F.01", "T0202", "G97 S1000 M03", "G00 X.375 Z0.", "G01 G99 Z-.4 F.01",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("target", "made"),
    [
        ("linuxcnc", ["T2 M6 G43", "G96 D2000 S300 M4", "G0 X2 Z.2", "G1 G94 Z0 F9"]),
        ("fanuc", ["T0202", "G50 S2000", "G96 S300 M04", "G00 X2. Z.2", "G01 G98 Z0. F9."]),
    ],
)
def test_every_mode_is_repeated_after_a_tool_change(target: str, made: list[str]) -> None:
    """A restart at the line of T does not run with another speed, move or feed mode."""
    body = "G77S2000\nG96S300M04\nG94F9.Z0\nG00X2.Z.2\nT2\nG00X2.Z.2\nG01Z0"
    assert lines_of(body, target)[-len(made) :] == made


def test_speed_that_g97_retains_is_written() -> None:
    """At X2., 300 ft/min are 300·12/(2·π) = 572.958 rpm, which G97 without S retains."""
    body = "G77S2000\nG96S300\nG00X2.\nG97\nG00Z.3\nS800\nZ.2"
    assert lines_of(body, "linuxcnc")[-4:] == ["G97 S572.958", "Z.3", "G97 S800", "Z.2"]


@pytest.mark.parametrize(
    ("units", "speeds", "made"),
    [
        # 300 * .3048 = 91.44 m/min; 152.4 / .3048 = 500 ft/min
        (("G71", "G70"), (152.4, 300), ["S152.4", "S91.44"]),
        (("G70", "G71"), (300, 152.4), ["S300", "S500"]),
    ],
)
def test_surface_speed_is_converted_if_the_program_changes_its_unit(
    units: tuple[str, str], speeds: tuple[float, float], made: list[str]
) -> None:
    text = (
        f"G90G94F300{units[0]}G72\nT1\nG77S2500\nG96M03S{speeds[0]}\nX1.Z.1\nG95F.005Z-.2\nT0\nG00X0Z0\n"
        f"{units[1]}\nT2\nG96S{speeds[1]}\nX1.Z.1\nG95F.005Z-.2\nM30\n"
    )
    done = convert(text, "linuxcnc")
    assert not done.errors
    found = [each.text.split()[2] for each in done.lines if each.text.startswith("G96")]
    assert list(dict.fromkeys(found)) == made


@pytest.mark.parametrize(
    ("body", "target", "made"),
    [
        ("M08\nZ0", "fanuc", ["M09", "M05", "M30", "%"]),
        ("M08\nZ0", "linuxcnc", ["M9", "M5", "M30"]),
        ("M08\nM09\nZ0", "fanuc", ["M05", "M30", "%"]),
        ("Z0\nM05", "linuxcnc", ["M5", "M30"]),
    ],
)
def test_coolant_and_spindle_stop_before_the_end(body: str, target: str, made: list[str]) -> None:
    """M30 of another control may not stop them; a stop that the program contains is not repeated."""
    done = convert(complete(body), target)
    assert not done.errors
    texts = [each.text for each in done.lines]
    assert texts[-len(made) :] == made
    assert [each for each in texts if each in {"M5", "M05"}] == made[
        made.index("M30") - 1 : made.index("M30")
    ]


@pytest.mark.parametrize(
    "body",
    [
        "G77S2000\nG96S300\nG00X2.\nM05\nT2\nX1.Z.2\nM03\nZ0",
        "G77S2000\nG96S300\nG00X2.\nG97S500\nT2\nX1.Z.2\nG96S300\nZ0",
        "G77S2000\nG96S300\nG00X2.\nT2\nG97S500\nX1.Z.2\nG96S300\nZ0",
    ],
)
def test_maximum_speed_is_repeated_when_g96_starts_later_than_its_tool(body: str) -> None:
    """A restart at T2 then has the maximum speed of this program before its constant surface speed."""
    made = lines_of(body, "fanuc")
    assert "G50 S2000" in made[made.index("T0202") :]


@pytest.mark.parametrize(
    ("next_line", "made"),
    [
        ("G04F5", ["G97 S572.958", "G4 P5"]),
        ("M00(LOOK)", ["G97 S572.958", "(MSG, LOOK)", "M0"]),
        ("M08", ["G97 S572.958", "M8"]),
        ("T0\nX0Z0", ["G97 S572.958", "G30"]),
        ("T2(DRILL)\nX1.Z.2", ["G97 S572.958", "(DRILL)", "T2 M6 G43", "G97 S572.958 M3", "X1 Z.2"]),
        ("M25\nZ0", ["G97 S572.958", "Z0"]),
    ],
)
def test_speed_that_g97_retains_is_written_before_the_next_step(next_line: str, made: list[str]) -> None:
    """300 ft/min at the diameter 2. in is 3600 / (2 pi) = 572.958 rpm, as in the source during a dwell."""
    body = f"G77S2000\nG96S300\nG00Z.3\nG97\n{next_line}"
    written = lines_of(body, "linuxcnc", skipped_m_codes=frozenset({25}))
    begin = written.index("G97 S572.958")
    found = [each for each in written[begin:] if each not in {"M5", "M9", "M30"}]
    assert [each.removeprefix("G0 ") for each in found] == made


def test_new_spindle_words_after_a_tool_change_are_complete() -> None:
    """Only the new speed is written, with the direction although it is the same as before."""
    assert lines_of("T2\nM03S800\nG00X2.Z.2", "fanuc") == ["T0202", "G97 S800 M03", "G00 X2. Z.2"]
    assert lines_of("M05\nT2\nG00X2.Z.2", "fanuc") == ["M05", "T0202", "G00 X2. Z.2"]


@pytest.mark.parametrize(
    ("body", "homes"),
    [
        # the axes are those of the line, also if an axis is at home already
        ("T0\nG00Z0\nX0", ["G91 G30 Z0", "G91 G30 X0"]),
        ("T0\nG00X0\nX0Z0", ["G91 G30 X0", "G30"]),
        # was machine home with an offset of .5 in
        ("G00X-1.Z3.\nT0\nG00X0Z0", ["G30"]),
    ],
)
def test_home_moves_the_axes_of_the_line(body: str, homes: list[str]) -> None:
    assert [each for each in lines_of(body, "linuxcnc") if "G30" in each] == homes


def test_home_before_the_first_tool_keeps_the_order_of_its_axes() -> None:
    done = convert("G90G94F300G70G72\nT0\nG00Z0\nX0\nT1\nM03S1000\nX1.Z.1\nM30\n", "linuxcnc")
    assert [each.text for each in done.lines if "G30" in each.text] == ["G91 G30 Z0", "G91 G30 X0"]


def test_thread_pass_has_the_lead_as_each_control_measures_it() -> None:
    """The pass moves .3 in X per side and .4 in Z, so the path is .5 and K .05·.5/.4."""
    body = "X2.2\nG33X2.Z-.3I.0001A-.6K.05O"
    assert [each for each in lines_of(body, "linuxcnc") if "G33" in each] == ["G33 X1.4 Z-.3 K.0625"]
    assert [each for each in lines_of(body, "fanuc") if "G32" in each] == ["G32 X1.4 Z-.3 F.05"]


def test_lead_of_fanuc_has_no_more_decimal_places_than_the_control() -> None:
    """1/13 in is .0769231; with six places it is 1e-7 less, which is 4e-7 after the 4 turns of .3 in."""
    made = lines_of("X2.2\nG33X1.95Z-.3I.05K.0769231O", "fanuc")
    assert [each for each in made if "G32" in each] == ["G32 Z-.3 F.076923"]


METRIC = "G90G94F3000G71G72\nT1\nM03S1000\nX20Z2\nG95F.1\n"


def test_displaced_end_of_a_fanuc_thread_is_rejected() -> None:
    """1.95384 becomes 1.9538: .00004·(z/1.95384) is .0005 at 22 mm, and .0013 mm at 62 mm of travel."""
    short = convert(f"{METRIC}G33X19.8Z-20I.2K1.95384O\nM30\n", "fanuc")
    assert not short.errors, short.errors
    assert any("F1.9538" in each.text for each in short.lines)
    long = convert(f"{METRIC}G33X19.8Z-60I.2K1.95384O\nM30\n", "fanuc")
    assert [(each.line, each.code) for each in long.errors] == [(6, "lead-resolution")]


def test_rounded_feed_of_fanuc_is_reported_or_rejected() -> None:
    done = convert(f"{METRIC}Z0F.12344\nM30\n", "fanuc")
    assert "G01 G99 Z0. F.1234" in [each.text for each in done.lines]
    assert (6, "feed-rounded") in [(each.line, each.code) for each in done.findings]
    done = convert(f"{METRIC}Z0F.00134\nM30\n", "fanuc")  # .0013 is 3% less
    assert [(each.line, each.code) for each in done.errors] == [(6, "feed-resolution")]
    assert not convert(f"{METRIC}Z0F.00134\nM30\n", "linuxcnc").errors


@pytest.mark.parametrize(
    ("body", "made"),
    [
        ("S1200.4\nZ0", "G97 S1200"),
        ("S1200.4\nZ0\nS1200\nZ-.1", "G97 S1200"),
        ("G77S2000.3\nG96S300.4\nZ0", "G96 S300"),
        # 300 ft/min at the diameter 2. in: 3600 / (2 pi) = 572.958 rpm
        ("G77S2000\nG96S300\nG00Z.3\nG97\nZ0", "G97 S573"),
    ],
)
def test_rounded_speed_of_fanuc_is_reported_and_proved(body: str, made: str) -> None:
    done = convert(complete(body), "fanuc")
    assert not done.errors
    assert made in [each.text for each in done.lines]
    assert "speed-rounded" in [each.code for each in done.findings]


def test_changed_speed_of_fanuc_is_rejected_beyond_its_rounding() -> None:
    texts = complete("S1200.4\nZ0").splitlines()
    program = interpret_source(texts, ConversionOptions(SourceControl.LINUXCNC), LIMITS)
    lines = convert(complete("S1200.4\nZ0"), "fanuc").lines
    wrong = [WrittenLine(each.text.replace("S1200", "S1201"), each.source_line_number) for each in lines]
    for written, codes in ((lines, []), (wrong, ["proof-differs"])):
        proof = prove_by_reading(
            written, SourceControl.FANUC_A, program, resolution_mm=0.00254, speed_resolution=1.0
        )
        assert [each.code for each in proof.errors] == codes


def test_feed_is_repeated_after_a_fanuc_thread() -> None:
    body = "Z.2\nG33X1.95Z-.3I.05K.05O\nX1.99"
    assert lines_of(body, "fanuc")[-1] == "G01 X1.99 F.01"
    per_minute = lines_of(f"G94F9.Z.2\n{body}", "fanuc")
    assert [each for each in per_minute if "F" in each] == [
        "G01 G98 Z.2 F9.", "G32 G99 Z-.3 F.05", "G01 G98 X1.99 F9.",
    ]  # fmt: skip
    # LinuxCNC ends the feed per revolution after G33, and starts it again with F
    assert lines_of(body, "linuxcnc")[-1] == "G1 G95 X1.99 F.01"


def test_nose_compensation_starts_and_ends_on_its_moves() -> None:
    body = "G00X1.2Z.2\nG42\nG01Z0D1\nX1.6\nZ-.5\nG00X2.\nG40\nZ.1"
    assert lines_of(body, "linuxcnc") == [
        "X1.2 Z.2", "G41 G1 G95 Z0 F.01", "X1.6", "Z-.5", "G40 G0 X2", "Z.1",
    ]  # fmt: skip
    codes = [each.code for each in convert(complete(body), "linuxcnc").findings]
    assert "nose-table" in codes


def test_rounding_to_the_resolution_of_fanuc_is_counted() -> None:
    done = convert(f"{BEGIN}Z-.00005\nX1.9\nM30\n", "fanuc")
    assert (done.errors, done.proof.rounded_move_count) == ([], 2)  # the second move has the same Z
    assert done.proof.max_rounding_mm == pytest.approx(0.00005 * 25.4)


def test_each_rapid_rate_is_reported_once() -> None:
    done = convert(complete("G00Z.2\nX2.2\nX2.").replace("F300", "F200"), "fanuc")
    texts = [(each.line, str(each.message)) for each in done.findings if each.code == "rapid-rate"]
    assert texts == [(4, "Rapids move at the rate of the other lathe instead of 200 in/min.")]


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("M31\nZ0", (1, "left-out")),
        ("/Z0", (1, "block-delete")),
        ("Z0D2", (1, "secondary-offset")),
        ("T2\nG00X1.Z.1", (1, "tool-change-place")),
        ("G96S300\nG76S200\nG97S500", (1, "maximum-speed-added")),
        ("X-2.2\nT0\nG00X0Z0\nT2\nX-1.Z.1\nG01X-.8", (6, "far-side-tool")),
    ],
)
def test_difference_is_reported(body: str, found: tuple[int, str]) -> None:
    done = convert(complete(body), "linuxcnc")
    assert not done.errors
    assert found in [(each.line - 5, each.code) for each in done.findings]


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("M05\nM19S60", (2, "c-axis-target")),
        ("Z0\nM95\nM30\n}1\nM99", (2, "input-of-lathe")),
        ("M92", (1, "input-of-lathe")),
        ("M25", (1, "m-code-target")),
        ("M05\nM13", (2, "m-code-target")),
        ("T0\nG00X.1Z.1", (2, "machine-point")),
        ("T0\nG00X0Z0\nZ-.5", (3, "machine-point")),
        ("Z0\nX3.F9.", (2, "feed-range")),
        ("G01X2.Z", (1, "number-missing")),
        ("T2\nG92X4.Z3.\nG00X1.Z.1", (2, "preset-before-move")),
        ("T0\nG00X0Z0\nT1\nG92Z3.", (4, "preset-before-move")),
        ("T2\nG91\nG00X.1Z-.1", (3, "offset-dependent")),
        ("T0\nG92X4.\nG00X0", (2, "preset-before-move")),
    ],
)
def test_line_without_counterpart_is_rejected(body: str, found: tuple[int, str]) -> None:
    assert error_of(body) == found
    assert error_of(body, "fanuc") == found


def test_m_code_can_be_left_out_with_a_warning() -> None:
    done = convert(f"{BEGIN}M25\nZ0\nM30\n", "fanuc", skipped_m_codes=frozenset({25}))
    assert not done.errors
    assert [(each.line, each.code) for each in done.findings] == [
        (4, "rapid-rate"), (4, "rapid-path"), (6, "left-out"),
    ]  # fmt: skip


def test_arc_below_the_resolution_is_left_out_because_it_would_be_a_circle() -> None:
    text = "G90G94F3000G71G72\nT1\nM03S1000\nX20Z0\nG95F.1\nG02X20Z-.0004R.01\nX22\nM30\n"
    done = convert(text, "fanuc")
    assert not done.errors
    assert [each.text for each in done.lines][-5:-3] == ["G00 X20. Z0.", "G01 G99 X22. F.1"]


def test_program_without_moves_is_rejected() -> None:
    assert [each.code for each in convert("G90G94F300G70G72\nM30\n", "fanuc").errors] == ["file-empty"]


@pytest.mark.parametrize(
    ("line", "other", "code"),
    [
        ("G01 G99 Z-.5", "G01 G99 Z-.5002", "proof-differs"),
        ("X1.9", "X1.9\nX1.8", "proof-differs"),
        ("G50 S2000", "G50 S2100", "proof-differs"),
        ("G96 S300", "G96 S310", "proof-differs"),
        ("T0202", "T0303", "proof-differs"),
        ("G00 X1. Z.1", "G00 X1. Z.1 M08", "proof-differs"),
        ("M30", "Z.2\nM30", "proof-differs"),
        ("G41 G01 G99 Z0.", "G42 G01 G99 Z0.", "proof-differs"),
        ("G00 X1. Z.1", "G00 X1.\nZ.1", "proof-differs"),
        ("G28 U0 W0", "G28 U0", "proof-differs"),
        ("G28 U0 W0", "G28 U0\nG28 W0", "proof-differs"),
        ("G28 U0 W0", "", "proof-differs"),
        ("X1.9", "X1.9 C30.", "target"),
        ("X1.9", "X1.9 M77", "target"),
        ("G96 S300", "(NO END", "target"),
    ],
)
def test_proof_detects_a_changed_line(line: str, other: str, code: str) -> None:
    """The proof must not depend on the writer: any changed line is an error at its source line."""
    body = (
        "Z-.5F.01\nX1.9\nT0\nG00X0Z0\nT1\nX2.Z.1\nG01X1.95\nG77S2000\nG96S300\nG97S500\n"
        "T2\nG00X1.Z.1\nG42\nG01Z0D1\nX1.5\nZ-.2\nG00X2.\nG40\nM30\n"
    )
    texts = f"{BEGIN}{body}".splitlines()
    options = ConversionOptions(SourceControl.LINUXCNC, writes_comments=False)
    program = interpret_source(texts, options, LIMITS)
    lines = list(convert_from_omniturn(texts, TargetControl.FANUC, options, LIMITS, "").lines)
    index = next(i for i, each in enumerate(lines) if each.text.startswith(line))
    number = lines[index].source_line_number
    changed = [
        WrittenLine(lines[index].text.replace(line, text) if not i else text, number)
        for i, text in enumerate(other.split("\n"))
    ]
    for made, wanted in ((lines, ()), ([*lines[:index], *changed, *lines[index + 1 :]], (code,))):
        proof = prove_by_reading(made, SourceControl.FANUC_A, program, resolution_mm=0.00254)
        assert tuple(each.code for each in proof.errors) == wanted
