"""Cycles of other controls as moves, calculated by hand."""

from __future__ import annotations

from math import radians, sqrt, tan

import pytest

from tests.extras.convert.sources import FANUC, converted, lines_after, refused

# The tool is at X2. Z.1 before each cycle.


def test_turning_cycle_and_its_modal_line_are_converted() -> None:
    assert lines_after("G90X1.8Z-1.\nX1.6\nG00X3.") == [
        "X1.8", "G95F.01Z-1", "X2", "G00Z.1", "X1.6", "G95F.01Z-1", "X2", "G00Z.1", "X3",
    ]  # fmt: skip


def test_a_tapered_turning_cycle_starts_at_x_plus_twice_r() -> None:
    assert lines_after("G90X1.8Z-1.R-.1") == ["X1.6", "G95F.01X1.8Z-1", "X2", "G00Z.1"]


def test_facing_cycle_is_converted() -> None:
    assert lines_after("G94X0Z-.05\nZ-.1") == [
        "Z-.05", "G95F.01X0", "Z.1", "G00X2", "Z-.1", "G95F.01X0", "Z.1", "G00X2",
    ]  # fmt: skip


def test_system_b_single_cycles_use_other_codes() -> None:
    begin = "G20G40G90G95\nT0101\nG97S500M03\nG00X2.Z.1\nG01F.01\n"
    a = converted(f"{FANUC}G90X1.8Z-1.\nM30\n")
    b = converted(f"{begin}G77X1.8Z-1.\nM30\n", "fanuc-b")
    assert [each.text for each in a.lines] == [each.text for each in b.lines]
    thread = converted(f"{begin}G78X1.8Z-1.F.05\nM30\n", "fanuc-b")
    assert "G33X1.8Z-1I.0001K.05O" in [each.text for each in thread.lines]


def test_the_single_thread_cycle_has_one_g33_for_each_pass() -> None:
    assert lines_after("G92X1.9Z-1.F.05\nX1.88\nG00X3.") == [
        "X1.9997", "G33X1.9Z-1I.0001K.05O", "G33X1.88Z-1I.0001K.05O", "X3",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("control", "body"),
    [
        # X moves .3 per side and Z .4, so the path is .5 long: K along it is .04 along Z
        ("linuxcnc", "G00X1.2Z.4\nX1.\nG33X1.6Z0K.05\nG00X2.2\nZ.4"),
        # X moves .5 per side and Z .4: F along X is .04 along Z
        ("fanuc-a", "G00X1.2Z.4\nX.6\nG32X1.6Z0F.05\nG00X2.2\nZ.4"),
    ],
)
def test_lead_of_a_steep_taper_is_converted_to_the_lead_along_z(control: str, body: str) -> None:
    assert "K.04O" in lines_after(body, control)[-1]


def test_tapered_thread_uses_a() -> None:
    # R -.05 is a radius: the thread starts at X1.9 - .1 and grows by .1 of the diameter.
    assert lines_after("G92X1.9Z-1.R-.05F.05") == ["X1.8997", "G33X1.8Z-1I.0001A.1K.05O"]


def test_g71_roughs_to_the_contour_with_its_allowance() -> None:
    made = lines_after(
        "G71U.2R.05\nG71P10Q20U.02W.01F.02\nN10G00X1.\nG01Z-.5F.005\nX1.5Z-1.\nN20X2.\nG70P10Q20"
    )
    assert made == [
        "X2.02Z.11",
        "X1.62", "G95F.02Z-.99", "G00X1.72Z-.94", "Z.11",  # X1.62 is over the taper: the face at Z-.99
        "X1.22", "G95F.02Z-.69", "G00X1.32Z-.64", "Z.11",  # on the taper: Z-.49 - (1.22 - 1.02)
        "X1.02", "G95F.02Z-.49", "X1.52Z-.99", "X2.02",
        "G00X2Z.1",
        "X1", "G95F.005Z-.5", "X1.5Z-1", "X2", "G00Z.1",
    ]  # fmt: skip


def test_g71_cuts_a_pocket_from_its_edge() -> None:
    # A groove from Z-.3 to Z-.6 down to X1.2 in a diameter of X1.6; depth .1 per side, retract .05
    made = lines_after(
        "G71U.1R.05\nG71P1Q2U0W0F.02\nN1G00X1.6\nG01Z-.3\nX1.2Z-.4\nZ-.5\nX1.6Z-.6\nZ-1.\nN2X2."
    )
    assert made == [
        "X1.8", "G95F.02Z-1", "G00X1.9Z-.95", "Z.1",
        # X1.6 is the edge of the groove, and X1.4 is halfway down its flanks. The tool enters each time
        # from .05 above the pass before.
        "X2Z-.3", "X1.9", "G95F.02X1.6", "Z-.6", "G00X1.7Z-.55", "X2", "Z.1",
        "Z-.35", "X1.7", "G95F.02X1.4", "Z-.55", "G00X1.5Z-.5", "X2", "Z.1",
        "X1.6", "G95F.02Z-.3", "X1.2Z-.4", "Z-.5", "X1.6Z-.6", "Z-1", "X2", "G00Z.1",
    ]  # fmt: skip


def test_one_line_g71_has_its_depth_in_d() -> None:
    one = "G71P10Q20U0W0D.2F.02\nN10G00X1.6\nG01Z-.5\nN20X2."
    assert lines_after(one, "haas")[:4] == ["X1.6", "G95F.02Z-.5", "X2", "G00Z.1"][:4]


def test_g72_faces_in_steps_of_w() -> None:
    made = lines_after("G72W.1R.02\nG72P1Q2U0W0F.02\nN1G00Z-.3\nG01X1.\nN2Z.1")
    assert made == [
        "Z0", "G95F.02X1", "G00X1.04Z.02", "X2",
        "Z-.1", "G95F.02X1", "G00X1.04Z-.08", "X2",
        "Z-.2", "G95F.02X1", "G00X1.04Z-.18", "X2",
        "Z-.3", "G95F.02X1", "Z.1", "G00X2",
    ]  # fmt: skip


def test_g73_repeats_the_contour_from_its_relief() -> None:
    made = lines_after("G73U.1W0R2\nG73P1Q2U0W0F.02\nN1G00X1.\nG01Z-.5\nN2X2.")
    assert made == [
        "X2.2", "X1.2", "G95F.02Z-.5", "X2.2", "G00Z.1",
        "X2", "X1", "G95F.02Z-.5", "X2", "G00Z.1",
    ]  # fmt: skip


def test_g76_pass_depth_follows_the_square_root_of_the_pass_number() -> None:
    # Depth .05 per side to X1.9; first pass .03, then .03·√2, then the rest and one finishing pass.
    made = lines_after("G76P020000Q0R0\nG76X1.9Z-1.P500Q300F.05")
    depths = (0.03, 0.03 * sqrt(2), 0.05, 0.05)
    passes = [each for each in made if each.startswith("G33")]
    assert passes == [f"G33X{round(2.0 - 2 * d, 4):g}Z-1I.0001K.05O" for d in depths]


def test_g76_moves_the_start_along_the_flank() -> None:
    made = lines_after("G76P010060Q0R0\nG76X1.9Z-1.P500Q300F.05")
    second = 0.1 - 0.03 * (sqrt(2) - 1) * tan(radians(30))
    on_step = round(second / 0.00005) * 0.00005
    assert f"X2Z{on_step:.5f}".replace("Z0", "Z") in made


def test_g74_pecks_and_g75_grooves() -> None:
    assert lines_after("G00X0\nG74R.02\nG74Z-.5Q3000F.004") == [
        "X0", "G95F.004Z-.2", "G00Z-.18", "G95F.004Z-.5", "G00Z.1",
    ]  # fmt: skip
    assert lines_after("G00Z-.5\nG75R.02\nG75X1.8Z-.6P500Q1000F.004") == [
        "Z-.5", "G95F.004X1.9", "G00X1.94", "G95F.004X1.8", "G00X2", "Z-.6",
        "G95F.004X1.9", "G00X1.94", "G95F.004X1.8", "G00X2", "Z-.5",
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("line", "control", "word", "made"),
    [
        ("G75X1.8Z-.5P1000Q1000F.02", "fanuc-a", "Q1000", ["Z-.5", "G95F.02X1.8", "G00X2"]),
        ("G75X1.8P1000Q1000R0F.02", "fanuc-a", "Q1000", ["Z-.5", "G95F.02X1.8", "G00X2"]),
        ("G74X2.Z-.7P500Q2000F.02", "fanuc-a", "P500", ["Z-.5", "G95F.02Z-.7", "G00Z-.5"]),
        ("G75X1.8Z-.5I.1K.1F.02", "haas", "K.1", ["Z-.5", "G95F.02X1.8", "G00X2"]),
    ],
)
def test_step_without_a_distance_is_left_out(line: str, control: str, word: str, made: list[str]) -> None:
    """The depth is .1 per side or .2 in Z, so that each cut is one peck."""
    done = converted(f"{FANUC}G00Z-.5\n{line}\nM30\n", control)
    assert [each.text for each in done.lines][4:-1] == made
    (note,) = [each for each in done.findings if each.code == "no-change" and each.line == 7]
    assert (note.column, word in note.message) == (line.index(word) + 1, True)


@pytest.mark.parametrize(
    "line",
    [
        "G75X1.8Z-.6P1000F.02",
        "G75X1.8Z-.5P1000Q1000R.02F.02",
        "G75X1.8P1000R.02F.02",
        "G74X1.9Z-.7Q2000F.02",
        "G75X1.8Z-.6I.1F.02",
    ],
)
def test_distance_or_relief_without_a_step_is_rejected(line: str) -> None:
    assert refused(f"G00Z-.5\n{line}") == (2, 1, "cycle-sideways")


def test_drilling_and_tapping_are_converted() -> None:
    assert lines_after("G00X0\nG83Z-.5R-.05Q2500F.004\nG80\nG00X2.") == [
        "X0", "Z.05", "G95F.004Z-.2", "G00Z.05", "Z-.18", "G95F.004Z-.45", "G00Z.05", "Z-.43",
        "G95F.004Z-.5", "G00Z.1", "X2",
    ]  # fmt: skip
    assert lines_after("G00X0\nG84Z-.5F.05", "haas") == [
        "X0", "G95F.05Z-.5", "G97M04S500", "Z.1", "G97M03S500",
    ]  # fmt: skip


def test_subprograms_and_macros_are_evaluated() -> None:
    body = "#1=2.\n#2=0\nWHILE[#2LT2]DO1\nG01X[#1-#2*.25]\n#2=#2+1\nEND1\nIF[#2EQ2]GOTO50\nX9.\n"
    body += "N50M98P7L2\nM30\nO7\nG01W-.1\nM99"
    assert lines_after(body) == ["G95F.01X1.75", "Z0", "Z-.1"]


def test_m99_of_the_main_program_ends_with_a_warning() -> None:
    done = converted(f"{FANUC}G01Z0\nM99\n")
    assert [each.code for each in done.findings] == ["no-change", "repeat"]  # the first one is for G40
    assert done.lines[-1].text == "M30"


def test_nose_compensation_side_is_swapped() -> None:
    made = lines_after("G42G00X1.Z.1\nG01Z-1.\nX1.5\nG40G00X2.Z.1")
    assert made == ["G41", "X1D1", "G95F.01Z-1", "X1.5", "G00X2Z.1", "G40"]


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("G71U.1R.1\nG71P1Q2U0W0\nN1G00X1.\nG01Z-.4\nX1.2Z-.2\nX1.5\nN2X2.", (2, 1, "cycle-undercut")),
        ("G71U.1R.1\nG71P1Q9U0W0\nN1G00X1.\nN2G01Z-1.", (2, 1, "cycle-contour")),
        ("G71P1Q2U0W0\nN1G00X1.\nN2G01Z-1.", (1, 1, "cycle-word")),
        ("G71U.1R.1\nG71P1Q2U0W0\nN1G00X1.\nN2G00Z1.", (2, 1, "cycle-empty")),
        ("G76X1.9Z-1.P500F.05", (1, 1, "cycle-word")),
        ("G76P010060Q0R0\nG76X1.9Z-1.P500Q300", (2, 1, "thread-lead")),
        ("G92X1.9Z-1.", (1, 1, "thread-lead")),
        ("G83R-.1Q1000F.01", (1, 1, "cycle-word")),
        ("G90X1.8Z-1.C2.", (1, 12, "code-unknown")),
        ("WHILE[1EQ1]DO1\n#1=1\nEND1", (2, 1, "endless")),
    ],
)
def test_unconvertible_cycle_is_reported(body: str, found: tuple[int, int, str]) -> None:
    assert refused(body) == found
