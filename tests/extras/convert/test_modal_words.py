"""Words whose meaning depends on a code: travel limits, the maximum spindle speed, and F after a thread."""

from __future__ import annotations

import pytest

from tests.extras.convert.sources import converted, lines_after, refused

SYSTEM_B = "G20G40G90G95\nT0101\nG97S500M03\nG00X2.Z.1\nG01F.01\n"
THREAD = "G92X1.9Z-1.F.05\n"
CONTOUR = "N1G00X1.6\nG01Z-.5\nN2X2.\n"

# The tool is at X2. Z.1 before each body, and the feed is .01 in/rev.


@pytest.mark.parametrize("before", ["G00", "G01", "G90X1.8Z-1.", "G92X1.9Z-1.F.05"])
@pytest.mark.parametrize(
    "line", ["G22X0.Z-12.I-8.K-16.", "G22X-1.Z-12.", "G22", "G50.1X0Z0", "G50.1X0", "G23"]
)
def test_codes_that_are_left_out_do_not_move(before: str, line: str) -> None:
    assert lines_after(f"{before}\n{line}\nG00X1.5") == lines_after(f"{before}\nG00X1.5")


def test_finding_names_the_travel_limits() -> None:
    done = converted(f"{SYSTEM_B}G22X0.Z-12.I-8.K-16.\nG50.1X0\nM30\n", "fanuc-b")
    named = [(each.code, each.message) for each in done.findings if each.line in {6, 7}]
    assert [code for code, _ in named] == ["left-out", "no-change"]
    assert "G22 X0. Z-12. I-8. K-16." in named[0][1]
    assert "G50.1 X0" in named[1][1]


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("G22G00X1.Z-12.", (1, 1, "word-twice")),  # an end point, or limits
        ("G50.1G01X1.", (1, 1, "word-twice")),
        ("G22G28U0", (1, 4, "word-twice")),
        ("G22X1.W-1.", (1, 7, "code-unknown")),
        ("G22X1.R1.", (1, 7, "code-unknown")),
        ("G50.1X0I1.", (1, 8, "code-unknown")),
        ("G10P1X.1", (1, 1, "code-unknown")),
        ("G27X0", (1, 1, "code-unknown")),
        ("G51.1X0", (1, 1, "code-unknown")),
        ("G52X1.Z1.", (1, 1, "code-unknown")),
        ("G68X0Z0R1.", (1, 1, "code-unknown")),
    ],
)
def test_axis_words_of_other_codes_are_rejected(body: str, found: tuple[int, int, str]) -> None:
    assert refused(body) == found


@pytest.mark.parametrize("code", ["G50", "G92"])
def test_system_b_has_the_maximum_speed_in_g50_and_g92(code: str) -> None:
    # 500 rpm at diameter 2. needs 262 ft/min; the maximum applies to G96, and not to the 500 rpm of G97.
    done = converted(f"{SYSTEM_B}{code}S2000\nG96S262\nG01Z0\nM30\n", "fanuc-b")
    assert not done.errors
    lines = [each.text for each in done.lines]
    assert any("G77S2000" in each for each in lines)
    assert not any("G97" in each and "S2000" in each for each in lines)


@pytest.mark.parametrize(
    ("body", "control", "found"),
    [
        ("G50", "fanuc-b", (1, 1, "cycle-word")),
        ("G92", "fanuc-b", (1, 1, "cycle-word")),
        ("G92S2000", "linuxcnc", (1, 1, "cycle-word")),
        ("G50S-5", "fanuc-b", (1, 4, "spindle-negative")),
    ],
)
def test_preset_without_a_value_is_rejected(body: str, control: str, found: tuple[int, int, str]) -> None:
    if control == "fanuc-b":
        (error,) = converted(f"{SYSTEM_B}{body}\nM30\n", control).errors
        assert (error.line - 5, error.column, error.code) == found
    else:
        assert refused(body, control) == found


@pytest.mark.parametrize(
    ("line", "feed"),
    [
        ("G99F.02\nG01X1.5", "G95F.02X1.5"),
        ("G01X1.5F.02", "G95F.02X1.5"),
        ("G00X3.F.02\nG01X1.5", "G95F.02X1.5"),
        ("F.02\nG01X1.5", "G95F.02X1.5"),
        ("G71U.2R.05\nG71P1Q2U0W0F.02\n" + CONTOUR, "G95F.02Z-.5"),
        ("G75R.02\nG75X1.8P2000F.02", "G95F.02X1.8"),
        ("G00X0\nG74R.02\nG74Z-.2Q5000F.02", "G95F.02Z-.2"),
        ("G00X0\nG83Z-1.R0F.02\nG80", "G95F.02Z-1"),
        ("G94X1.8Z0F.02", "G95F.02X1.8"),
    ],
)
@pytest.mark.parametrize("thread", [THREAD, "G32Z-1.F.05\nG00X3.\nZ.1\nX2.\nG32Z-1.\nG00X3.\nZ.1\nX2.\n", ""])
def test_feed_after_a_thread_applies_to_the_cut(thread: str, line: str, feed: str) -> None:
    """F of the line is .02, and the lead of the thread before it is .05."""
    made = lines_after(thread + line)
    assert feed in made
    assert not any("F.05" in each for each in made)


def test_feed_in_the_line_of_a_thread_is_its_lead() -> None:
    made = lines_after(f"{THREAD}X1.88F.04\nG99X1.86F.03\nX1.84")
    assert [each.partition("K")[2] for each in made if "G33" in each] == [".05O", ".04O", ".03O", ".03O"]


@pytest.mark.parametrize("between", ["G01X1.9F.01\nG00X2.\nZ.1\nG92X1.88Z-1.", "F.01\nX1.88"])
def test_thread_after_another_feed_needs_its_lead(between: str) -> None:
    # On the Fanuc control, this thread would have a lead of .01.
    assert refused(f"{THREAD}{between}")[2] == "thread-lead"
