"""Differences between lathes that the proof of a converted program cannot detect, calculated by hand."""

from __future__ import annotations

import pytest

from tests.extras.convert.sources import FANUC, converted
from tests.extras.convert.test_from_omniturn import BEGIN, complete, convert, error_of, lines_of
from tests.extras.convert.test_to_sinumerik import convert as convert_to_sinumerik


def texts_of(text: str, target: str) -> list[str]:
    """Return the lines of the conversion of a complete OmniTurn program."""
    done = convert_to_sinumerik(text, "omniturn") if target == "sinumerik" else convert(text, target)
    assert not done.errors, [each.message for each in done.errors]
    return [each.text for each in done.lines]


@pytest.mark.parametrize(
    ("target", "made"),
    [
        ("linuxcnc", ["G1 G94 X1 Z.1 F5", "Z-.5", "G0 X1.2", "G1 Z-.6"]),
        ("fanuc", ["G01 G98 X1. Z.1 F5.", "Z-.5", "G00 X1.2", "G01 Z-.6"]),
        ("sinumerik", ["G1 G94 X1 Z0.1 F5", "Z-0.5", "G0 X1.2", "G1 Z-0.6"]),
    ],
)
def test_cut_at_the_feed_of_the_first_line_does_not_become_a_rapid(target: str, made: list[str]) -> None:
    """F5 of the first line is the rapid rate of OmniTurn, but Z-.5 at 5 in/min is a cut."""
    text = "G90G94F5G70G72\nT1\nM03S1000\nX1.Z.1\nZ-.5\nG00X1.2\nG94F5Z-.6\nM30\n"
    assert texts_of(text, target)[-len(made) - 2 - (target == "fanuc") :][: len(made)] == made


@pytest.mark.parametrize(
    ("first_line", "made"),
    [
        ("G90G94F99.9G70G72", ["G1 G94 X1 Z.1 F99.9", "Z-.5"]),
        ("G90G94F100G70G72", ["G0 X1 Z.1", "Z-.5"]),
        ("G90G94F2539G71G72", ["G1 G94 X1 Z.1 F2539", "Z-.5"]),  # 99.96 in/min
        ("G90G94F2540G71G72", ["G0 X1 Z.1", "Z-.5"]),
    ],
)
def test_move_without_g00_is_a_rapid_from_100_in_per_minute(first_line: str, made: list[str]) -> None:
    done = convert(f"{first_line}\nT1\nM03S1000\nX1.Z.1\nZ-.5\nM30\n", "linuxcnc")
    assert [each.text for each in done.lines][-4:-2] == made
    assert ("slow-rapid" in {each.code for each in done.findings}) is made[0].startswith("G1")


def test_slow_move_to_machine_home_remains_a_move_to_home() -> None:
    text = "G90G94F20G70G72\nT1\nM03S1000\nX1.Z.1\nT0\nX0Z0\nM30\n"
    assert texts_of(text, "linuxcnc")[-3:] == ["G30", "M5", "M30"]


def test_move_to_machine_home_at_a_cutting_feed_is_rejected() -> None:
    """The other control moves home in rapid."""
    assert error_of("Z0\nT0\nX0Z0") == (3, "home-feed")
    assert error_of("Z0\nT0\nX0Z0", "fanuc") == (3, "home-feed")
    assert lines_of("Z0\nT0\nG00X0Z0", "fanuc")[-1] == "G28 U0 W0"


@pytest.mark.parametrize(
    ("body", "made"),
    [
        # the lines from (PART OFF) to M30 are not executed before M00
        (
            "M98P1(GROOVE)\n(PART OFF)\nZ0(FACE)\nM30\n}1(SUB)\nM00(TURN IT)\nM99",
            ["(GROOVE)", "(SUB)", "(MSG, TURN IT)", "M0", "(PART OFF)", "(FACE)", "G1 G95 Z0 F.01"],
        ),
        # subroutine 1 is never executed
        (
            "P2\nM30\n}1(NEVER)\n(NEVER)\nM99\n}2\nM00(LOOK)\nM99",
            ["(MSG, LOOK)", "M0"],
        ),
        # the text of a stop is shown at each stop
        ("LS2\nM00(LOOK)\nLF", ["(MSG, LOOK)", "M0", "(MSG, LOOK)", "M0"]),
    ],
)
def test_text_of_a_stop_contains_no_comment_of_other_lines(body: str, made: list[str]) -> None:
    assert lines_of(body, "linuxcnc")[: len(made)] == made


LONG = "TURN THE PART AND TIGHTEN THE CHUCK TO 40 NM; DO NOT CONTINUE WHILE THE DOOR IS OPEN"
"""Text of 84 characters; the first 60 end within CONTINUE."""


def test_long_text_for_the_operator_is_not_cut() -> None:
    first, second = "TURN THE PART AND TIGHTEN THE CHUCK TO 40 NM; DO NOT", "CONTINUE WHILE THE DOOR IS OPEN"
    assert lines_of(f"M00({LONG})", "linuxcnc")[:3] == [f"(MSG, {first})", f"(MSG, {second})", "M0"]
    fanuc = lines_of(f"M00({LONG})", "fanuc")
    assert fanuc[:3] == [f"({first.replace(';', ' ')})", f"({second})", "M00"]
    made = texts_of(complete(f"M00({LONG})"), "sinumerik")
    assert f'MSG("{LONG}")' in made
    assert f'MSG("{LONG} {LONG[:29]}...")' in texts_of(complete(f"M00({LONG} {LONG})"), "sinumerik")


def test_accents_become_plain_letters() -> None:
    assert lines_of("(OPERACIÓN Ü)\nZ0", "fanuc")[0] == "(OPERACION U)"


@pytest.mark.parametrize("target", ["linuxcnc", "fanuc", "sinumerik"])
def test_surface_speed_starts_with_the_maximum_of_the_following_g77(target: str) -> None:
    """The spindle never turns with the maximum of this lathe, 3500 rpm."""
    text = "G90G94F300G70G72\nT1\nG96M03S400\nG77S1200\nX1.Z.1\nG95F.01Z0\nM30\n"
    made = texts_of(text, target)
    assert not any("3500" in each for each in made)
    assert any("1200" in each for each in made)
    codes = {each.code for each in convert(text, "fanuc").findings}
    assert "maximum-speed-added" not in codes


def test_maximum_of_this_lathe_is_reported_if_g77_follows_too_late() -> None:
    text = "G90G94F300G70G72\nT1\nG96M03S400\nX1.Z.1\nG77S1200\nG95F.01Z0\nM30\n"
    found = [(each.line, each.code) for each in convert(text, "fanuc").findings]
    assert (3, "maximum-speed-added") in found


def test_surface_speed_of_a_fanuc_program_without_g50_is_limited() -> None:
    """A SINUMERIK control would retain LIMS of another program."""
    done = convert_to_sinumerik("G20G99\nT0101\nG96S400M03\nG00X2.Z.1\nG01Z0F.01\nM30\n")
    assert "G96 S400 LIMS=3500 M3" in [each.text for each in done.lines]
    assert [(each.line, each.code) for each in done.findings] == [(3, "maximum-speed-added")]


def test_coolant_is_repeated_after_a_tool_change() -> None:
    """A restart at the line of T runs with coolant."""
    body = "M08\nZ0\nT2\nG00X1.Z.1\nM09\nT3\nX1.Z.1"
    made = lines_of(body, "fanuc")
    assert made[made.index("T0202") :][:4] == ["T0202", "G97 S1000 M03", "M08", "G00 X1. Z.1"]
    assert "M08" not in made[made.index("T0303") :]
    assert lines_of("M08\nT2\nM09\nG00X1.Z.1", "linuxcnc")[1:4] == ["T2 M6 G43", "G97 S1000 M3", "M9"]


def test_fanuc_program_starts_spindle_and_coolant_again_after_a_stop() -> None:
    """M00 and M01 of many lathes with Fanuc controls stop both."""
    assert lines_of("M08\nM00\nZ0", "fanuc")[:5] == [
        "M08", "M00", "G97 S1000 M03", "M08", "G01 G99 Z0. F.01",
    ]  # fmt: skip
    assert lines_of("G77S2000\nG96S300\nM01\nZ0", "fanuc")[-4:-1] == ["M01", "G50 S2000", "G96 S300 M03"]
    assert lines_of("M08\nM00\nZ0", "linuxcnc")[:3] == ["M8", "M0", "G1 G95 Z0 F.01"]


@pytest.mark.parametrize(
    ("body", "made"),
    [
        ("M09\nM05\nM00\nG00Z.2", ["M09", "M05", "M00", "Z.2"]),
        ("M00\nM05\nG00Z.2", ["M00", "M05", "Z.2"]),
        ("M00\nM04S500\nG00Z.2", ["M00", "G97 S500 M04", "Z.2"]),
        ("M01\nT2\nG00X1.Z.2", ["M01", "T0202", "G97 S1000 M03", "G00 X1. Z.2"]),
    ],
)
def test_fanuc_program_does_not_start_what_the_next_lines_stop(body: str, made: list[str]) -> None:
    assert lines_of(body, "fanuc") == made


@pytest.mark.parametrize(("seconds", "made"), [("100.3333333", "G04 U100.333"), (".12345", "G04 U.123")])
def test_dwell_of_fanuc_has_three_decimal_places(seconds: str, made: str) -> None:
    """A Fanuc control rejects a number with more than eight digits."""
    assert made in lines_of(f"G04F{seconds}", "fanuc")
    assert not convert(f"{BEGIN}G04F{seconds}\nM30\n", "linuxcnc").errors


@pytest.mark.parametrize(("unit", "word"), [("G70", "G20"), ("G71", "G21")])
def test_unit_of_fanuc_is_alone_in_its_block(unit: str, word: str) -> None:
    """The manual of the control requires a block of its own at the beginning."""
    text = f"G90G94F3000{unit}G72\n" if unit == "G71" else f"G90G94F300{unit}G72\n"
    assert texts_of(f"{text}T1\nM03S500\nX1.Z.1\nM30\n", "fanuc")[2] == word


@pytest.mark.parametrize("target", ["linuxcnc", "fanuc"])
def test_arc_that_would_become_a_circle_is_rejected(target: str) -> None:
    """Its ends are at the same angle: radius .2 at its start and .19995 at its end."""
    assert error_of("G00X1.Z0\nG01\nG02X1.Z-.00005I0K-.2", target) == (3, "arc-short")


def test_arc_whose_rounded_ends_are_at_the_same_angle_is_rejected_for_fanuc() -> None:
    """Z.00005 and Z.0001 become Z.0001, so that only X differs: a sweep of .0001 rad becomes a circle."""
    body = "G00X1.Z.00005\nG01\nG03X1.0001Z.0001I-.5K0"
    assert error_of(body, "fanuc") == (3, "arc-short")
    assert lines_of(body, "linuxcnc")[-1] == "G2 G95 X1.0001 Z.0001 I-.5 K0 F.01"


@pytest.mark.parametrize(
    ("body", "made"),
    [
        ("G02X1.Z0I0K-.2", "G3 G95 X1 Z0 I0 K-.2 F.01"),  # a full circle
        ("G02X.6Z-.2I0K-.2", "G3 G95 X.6 Z-.2 I0 K-.2 F.01"),  # 270 degrees
        ("G02X1.Z-.00005R.5", "G3 G95 X1 Z-.00005 I-.5 K-.000025 F.01"),
    ],
)
def test_circle_large_arc_and_short_arc_are_converted(body: str, made: str) -> None:
    """The center of the short arc is half its chord, .000025 in, and almost .5 in from its start."""
    assert lines_of(f"G00X1.Z0\nG01\n{body}", "linuxcnc")[-1] == made


def test_arc_with_a_radius_that_linuxcnc_rejects_is_rejected() -> None:
    """LinuxCNC reports an arc of radius .00005 in as an arc without a radius."""
    assert error_of("G00X1.Z0\nG01\nG02X1.0001Z-.00005I0K-.00005") == (3, "arc-short")


@pytest.mark.parametrize(
    ("body", "is_reported"),
    [
        ("G00X-.4\nG01X.005", True),  # parting from the far side to a point beyond the spindle axis
        ("G00X-.4\nG01X0", True),
        ("G00X-.2\nG01Z-.5\nX-.4", True),
        ("G00X.4\nG01X-.06", False),  # facing; .03 in = 0.76 mm beyond the spindle axis
        ("G00X0\nG01Z-.5", False),  # a drill
        ("G00X-.4\nX.4\nG01X.1", False),  # only a rapid
    ],
)
def test_tool_on_the_far_side_is_reported(body: str, is_reported: bool) -> None:
    """The holder of a tool on the usual side would pass through the part."""
    text = f"G90G94F300G70G72\nT1\nM03S1000\nX0Z1.\nG95F.01\n{body}\nM30\n"
    codes = {each.code for each in convert(text, "fanuc").findings}
    assert ("far-side-tool" in codes) is is_reported


def test_finding_of_a_loop_is_reported_once() -> None:
    body = "LS3\nT2\nG00X1.Z.2\nG10Z-.1\nT1\nX1.Z.2\nLF"
    done = convert(complete(body), "linuxcnc")
    lines = [(each.line, each.code, str(each.message)) for each in done.findings]
    assert len(lines) == len(set(lines))
    assert {each[1] for each in lines} >= {"tool-change-place", "spindle-restarted", "shift-contained"}


@pytest.mark.parametrize(
    ("body", "made"),
    [
        # Z-.00005 and Z-.0001 are both Z-.0001
        ("Z0\nZ-.00005\nZ-.0001\nX1.9", ["G01 G99 Z0. F.01", "Z-.0001", "X1.9"]),
        # the mode of a move that is left out is written with the next move
        ("Z0\nZ-.00005\nG00Z-.0001\nX1.9", ["G01 G99 Z0. F.01", "Z-.0001", "G00 X1.9"]),
        ("Z-.00005\nG94F9.Z-.0001\nG01X1.9", ["G01 G99 Z-.0001 F.01", "G98 X1.9 F9."]),
        # T2 has another tip, so that its first move is never left out
        ("Z0\nT2\nG00X2.Z0", ["G01 G99 Z0. F.01", "T0202", "G97 S1000 M03", "G00 X2. Z0."]),
    ],
)
def test_move_below_the_resolution_of_fanuc_is_left_out(body: str, made: list[str]) -> None:
    """A program with such a move was not converted, because its line was empty."""
    assert lines_of(body, "fanuc")[: len(made)] == made


def test_corner_radius_below_the_resolution_of_fanuc_is_left_out() -> None:
    """The tangent length is R.tan(a/2) with tan(a) = .001 / .5: .008 * .001 = .000008 in."""
    body = "G00X1.Z0\nG01Z-.5R.008\nX1.002Z-1."
    assert lines_of(body, "fanuc")[-2:] == ["G01 G99 Z-.5 F.01", "X1.002 Z-1."]
    assert any(each.startswith("G2") for each in lines_of(body, "linuxcnc"))


@pytest.mark.parametrize(
    ("feed", "made"),
    [
        ("3000", "F118.11024"),  # 3000 / 25.4 = 118.1102362
        ("300", "F11.811024"),  # 300 / 25.4 = 11.8110236
    ],
)
def test_feed_of_fanuc_has_at_most_eight_digits(feed: str, made: str) -> None:
    """The feed is in mm/min, and the converted program is in inches."""
    assert lines_of(f"G71\nG94F{feed}Z0", "fanuc") == [f"G01 G98 Z0. {made}"]


@pytest.mark.parametrize(
    ("body", "is_reported"),
    [
        ("G00X0Z.3\nG41\nG01Z0D1\nX.8\nZ-.5\nG00X1.1\nG40\nZ.3", True),  # faces from X0
        ("G00X.9Z.2\nG41\nG01X.8D1\nZ-.5\nX1.1\nG00X1.2\nG40\nZ.3", True),  # turns from Z.2
        ("G00X.8Z.4\nG41\nG01Z.2D1\nZ-.5\nX1.1\nG00X1.2\nG40\nZ.3", False),  # in the line of the approach
        ("G00X.8Z.3\nG42\nG01Z0D1\nX1.8\nG00Z.5\nG40\nX2.", False),  # turns away from the nose
        ("G00X0Z.3\nG41\nG01Z0D1\nG02X.8Z-.4I0K-.4\nG01X1.1\nG00X1.2\nG40\nZ.3", True),  # starts along X
        ("G00X.8Z.4\nG41\nG01Z0D1\nG03X1.2Z-.2I.2K0\nG01X1.4\nG00X1.5\nG40\nZ.3", False),  # along Z
    ],
)
def test_start_of_nose_compensation_of_linuxcnc_is_reported(body: str, is_reported: bool) -> None:
    """Left of Z- is X+, so with G41 a contour from Z- to X+ turns toward the nose."""
    done = convert(complete(body), "linuxcnc")
    assert not done.errors, done.errors
    assert ("nose-start" in {each.code for each in done.findings}) is is_reported
    assert "nose-start" not in {each.code for each in convert(complete(body), "fanuc").findings}


def test_long_text_for_the_operator_is_not_cut_for_omniturn() -> None:
    plain = LONG.replace(";", ",")
    done = converted(f"{FANUC}G01Z0\nM00({plain})\nM30\n")
    assert f"M00({plain})" in [each.text for each in done.lines]


@pytest.mark.parametrize(
    ("body", "lines"),
    [
        ("G00X0Z.1\nG01G95F.05\nZ-.4\nM04\nG04F.5\nZ.1", [4]),
        ("G00X0Z.1\nG01G95F.05\nZ-.4\nM05\nM04S800\nZ.1", [5]),
        ("LS2\nG00X0Z.1\nG01G95F.05\nZ-.4\nM04\nZ.1\nM03\nLF", [5]),
        ("G00X0Z.1\nG01G95F.05\nZ-.4\nG00Z.1\nM04", []),  # a hole
        ("G00X1.Z.1\nG01G95F.05\nZ-.4\nM04\nZ-.8", []),  # turns on in the other direction
        ("G00X1.Z.1\nG01G95F.05\nZ-.4\nM04\nX1.1\nZ.1", []),
        ("G00X1.Z.1\nG01G95F.05\nZ-.4\nS800\nZ.1", []),  # the same direction
    ],
)
def test_tapping_with_a_reversal_is_reported(body: str, lines: list[int]) -> None:
    for target in ("linuxcnc", "fanuc"):
        done = convert(complete(body), target)
        assert not done.errors, done.errors
        assert [each.line - 5 for each in done.findings if each.code == "tapping"] == lines
