"""Taps, work shifts and loops for several parts in the FreeCAD post."""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import pytest

from resources.posts import omniturn_post
from tests.cli.conftest import Turndesk
from tests.posts.test_freecad_post import Command, controller, operation

TURN: tuple[Command, ...] = (
    ("G0", {"Z": 2.0}),
    ("G0", {"X": 5.0}),
    ("G1", {"Z": -10.0, "F": 2.0}),
    ("G1", {"X": 7.0, "F": 2.0}),
    ("G0", {"Z": 2.0}),
)
TAP: Command = ("G84", {"X": 0.0, "Y": 0.0, "Z": -8.0, "R": 5.0, "S": 400.0, "F": 1.25})


def tap_job(*commands: Command, **properties: object) -> list[SimpleNamespace]:
    return [controller(4, 400.0), operation(("G0", {"Z": 6.0}), *commands, label="Tap", **properties)]


def test_right_hand_tap_feeds_reverses_and_feeds_out() -> None:
    """F of the command is not used: the pitch 1.25 mm is the feed per revolution in both directions."""
    text = omniturn_post.post(tap_job(TAP), "--pitch 4=1.25 --no-comments")
    assert text.splitlines()[1:-2] == [
        *("T4", "G97M03S400", "G00X0Z6", "Z5", "G95F1.25Z-8", "M04", "G04F.5", "G95F1.25Z5"),
        *("G97M03S400", "G00Z6"),
    ]


def test_left_hand_tap_in_inches_has_the_pitch_of_its_tool() -> None:
    """1.27 mm are .05 in; the tool bit of newer versions of FreeCAD has a property Pitch."""
    tool = SimpleNamespace(Pitch=SimpleNamespace(Value=1.27))
    parts = tap_job(
        ("M4", {"S": 400.0}),
        ("G74", {**TAP[1], "Z": -12.7, "R": 5.08, "P": 1.0}),
        ToolController=SimpleNamespace(Tool=tool),
        CoolantMode="None",
    )
    lines = omniturn_post.post(parts, "--inches --no-comments").splitlines()
    assert lines[5:10] == ["Z.2", "G95F.05Z-.5", "M03", "G04F1", "G95F.05Z.2"]


@pytest.mark.parametrize(
    ("command", "options", "reason"),
    [
        (TAP, "", "--pitch 4=PITCH"),
        (("G74", TAP[1]), "--pitch 4=1", "must turn with M4"),
        (("G84", {**TAP[1], "S": 500.0}), "--pitch 4=1", "S differs"),
        (("G84", {**TAP[1], "X": 3.0}), "--pitch 4=1", "not on the spindle axis"),
        (("G84", {**TAP[1], "Z": 6.0}), "--pitch 4=1", "not below R"),
        (TAP, "--pitch 4=5.1", "largest feed"),
        (TAP, "--pitch 4=0", "greater than 0"),
        (TAP, "--pitch 1.25", "invalid option"),
    ],
)
def test_taps_that_cannot_be_written_are_rejected(command: Command, options: str, reason: str) -> None:
    with pytest.raises(omniturn_post.PostError, match=reason):
        omniturn_post.post(tap_job(command), options)


def test_first_rapid_behind_the_face_moves_x_in_front_of_the_part() -> None:
    """From a drill on the axis, a line to X8 Z-6 would cross the part. The highest Z of the job is 6."""
    groove = operation(("G0", {"X": 8.0, "Z": -6.0}), ("G1", {"X": 5.0, "F": 1.0}), ("G0", {"X": 8.0}))
    lines = omniturn_post.post(
        [*tap_job(TAP), controller(2), groove], "--pitch 4=1 --no-comments"
    ).splitlines()
    start = lines.index("T2")
    assert lines[start + 2 : start + 5] == ["G00X16Z6", "Z-6", "G94F60X10"]


@pytest.mark.parametrize(
    ("command", "options"),
    [
        (("G1", {"X": 0.0, "Z": -2.0, "F": 1.0}), ""),
        (("G81", {"X": 0.0, "Y": 0.0, "Z": -8.0, "R": 5.0, "F": 1.0}), ""),
        (TAP, "--pitch 4=1"),
    ],
)
def test_cuts_after_a_spindle_stop_are_rejected(command: Command, options: str) -> None:
    job = tap_job(("G0", {"X": 0.0}), ("M5", {}), command)
    with pytest.raises(omniturn_post.PostError, match="spindle"):
        omniturn_post.post(job, options)


def fixture(name: str) -> SimpleNamespace:
    return operation((name, {}), ("G0", {"Z": 2.0}), label=name)


SHIFTED = [fixture("G54"), controller(1), operation(*TURN), fixture("G55"), controller(1), operation(*TURN)]


def test_zero_offset_becomes_a_work_shift_before_t() -> None:
    """The second part is 20 mm nearer the spindle, so the same Z of the tool change is Z 22 there.

    The first rapid of each part is at this Z, because a line to the part could cross the other part.
    """
    lines = omniturn_post.post(SHIFTED, "--shift G55=0,-20 --no-comments").splitlines()
    second = lines.index("G10X0Z-20")
    assert lines[second - 1] == "G00Z2"
    assert lines[second + 1 :] == [
        *("T1", "T1", "G97M03S1200", "G00X10Z22", "Z2", "G94F120Z-10", "X14", "G00Z2", "Z22", "M05", "M30"),
    ]


def test_return_to_the_first_zero_takes_the_shift_back() -> None:
    parts = [fixture("G55"), controller(1), operation(*TURN), fixture("G54"), operation(*TURN)]
    lines = omniturn_post.post(parts, "--shift G55=1.5,-20 --inches --no-comments").splitlines()
    assert [line for line in lines if line.startswith("G10")] == ["G10X.1181Z-.7874", "G10X-.1181Z.7874"]


def test_shifted_positions_are_those_of_the_machine(turndesk: Turndesk, tmp_path: Path) -> None:
    """X 5 Z -10 of the path is at Z -10 and, on the second part, at Z -30 of the machine."""
    path = tmp_path / "shifted.nc"
    omniturn_post.export(SHIFTED, str(path), "--shift G55=0,-20")
    proof = turndesk("prove", path)
    assert (proof.status, "error" in proof.out) == (0, False), proof.out + proof.err
    moves = [json.loads(line) for line in turndesk("expand", path, "--json").out.splitlines()]
    deep = [(move["mx"] * 25.4, move["mz"] * 25.4) for move in moves if move.get("kind") == "feed"]
    expected = [(5.0, -10.0), (7.0, -10.0), (5.0, -30.0), (7.0, -30.0)]
    for found, goal in zip(deep, expected, strict=True):
        assert found == pytest.approx(goal, abs=2e-3)


PART = [controller(1), operation(*TURN), controller(2), operation(*TURN)]


def test_loop_moves_the_zero_along_the_bar(turndesk: Turndesk, tmp_path: Path) -> None:
    text = omniturn_post.post(PART, "--parts 3 --part-length 12.5 --no-comments")
    lines = text.splitlines()
    assert lines[:7] == ["G90G94F7620G71G72", "LS3", "P1", "G10X0Z-12.5", "LF", "M30", "}1"]
    assert (lines[7], lines[-2:]) == ("T1", ["M05", "M99"])
    path = tmp_path / "bar.nc"
    path.write_text(text)
    moves = [json.loads(line) for line in turndesk("expand", path, "--json").out.splitlines()]
    ends = [round(move["mz"] * 25.4, 2) for move in moves if move.get("kind") == "feed"][::2]
    assert ends == [-10.0, -10.0, -22.5, -22.5, -35.0, -35.0]


def test_loop_feeds_the_bar_before_each_part(turndesk: Turndesk, tmp_path: Path) -> None:
    """The bar was cut off at Z 0.5 - 12.5 = -12; the stop pulls with 500 mm/min to Z 0.5."""
    text = omniturn_post.post(PART, "--parts 3 --part-length 12.5 --bar-stop 9 --facing-stock .5")
    assert text.splitlines()[1:13] == [
        *("LS3", "M05", "T9", "G00X0Z2", "G00Z-12", "M13", "G94F500Z.5", "M12", "G00Z2", "P1", "LF", "M30"),
    ]
    path = tmp_path / "bar.nc"
    path.write_text(text)
    proof = turndesk("prove", path)
    assert (proof.status, "error" in proof.out) == (0, False), proof.out + proof.err


def test_loop_takes_the_last_work_shift_back_before_the_next_part() -> None:
    lines = omniturn_post.post(SHIFTED, "--parts 2 --part-length 50 --shift G55=0,-20").splitlines()
    assert lines[-3:] == ["M05", "G10X0Z20", "M99"]


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ("--parts 0", "--parts"),
        ("--parts 2", "--part-length"),
        ("--part-length 5", "--parts"),
        ("--bar-stop 9", "--parts"),
        ("--parts 2 --part-length 5 --bar-stop 40", "T40"),
        ("--parts 2 --part-length 5 --facing-stock 5", "--facing-stock"),
        ("--parts 2 --part-length -5", "--part-length"),
        ("--parts 2.5 --part-length 5", "invalid option"),
        ("--shift G60=0,1", "invalid option"),
        ("--shift G54=0,1", "invalid option"),
        ("--shift G55=1", "invalid option"),
        ("--shift G55=nan,1", "invalid option"),
        ("--pitch 4=inf", "invalid option"),
        ("--change-z nan", "invalid option"),
        ("--rapid 1e9", "invalid option"),
        ("--parts 2 --part-length nan", "invalid option"),
        ("--change-z -5", "--change-z"),
        ("--parts 2 --part-length 12 --bar-stop 9 --facing-stock 2", "--change-z"),
    ],
)
def test_invalid_options_of_several_parts_are_rejected(options: str, reason: str) -> None:
    with pytest.raises(omniturn_post.PostError, match=reason):
        omniturn_post.post(PART, options)
