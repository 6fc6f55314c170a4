"""The post-processor of FreeCAD: lines by hand, proved programs, and rejected commands.

The objects replace those of FreeCAD 0.20, 0.21 and 1.0, which have the same names: an operation has a Path
with Commands, and a command has a Name and Parameters in mm and mm/s.
"""

from __future__ import annotations

import json
from pathlib import Path
from types import SimpleNamespace

import pytest

from resources.posts import omniturn_post
from tests.cli.conftest import Turndesk

Command = tuple[str, dict[str, float]]


def operation(*commands: Command, label: str = "Profile", **properties: object) -> SimpleNamespace:
    made = [SimpleNamespace(Name=name, Parameters=values) for name, values in commands]
    return SimpleNamespace(Label=label, Path=SimpleNamespace(Commands=made), **properties)


def controller(number: int = 1, speed: float = 1200.0) -> SimpleNamespace:
    return operation(("(tool)", {}), ("M6", {"T": number}), ("M3", {"S": speed}), label="TC")


APPROACH: tuple[Command, ...] = (("G0", {"Z": 2.0}), ("G0", {"X": 5.0, "F": 0.0}))


def body(*commands: Command, options: str = "") -> list[str]:
    """Return the lines between the approach and the end of the program."""
    lines = omniturn_post.post([controller(), operation(*APPROACH, *commands)], options).splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith("G00"))
    return lines[first + 1 : -2]


def test_program_in_millimeters() -> None:
    """X is a diameter; 2 mm/s is 120 mm/min; the end retracts to the highest Z of the job."""
    text = omniturn_post.post(
        [
            controller(3),
            operation(
                *APPROACH, ("G1", {"Z": -10.0, "F": 2.0}), ("G1", {"X": 6.5, "F": 2.0}), label="Turn (1)"
            ),
        ]
    )
    assert text.splitlines() == [
        *("G90G94F7620G71G72", "T3(tool)", "G97M03S1200", "G00X10Z2(Turn  1)", "G94F120Z-10", "X13"),
        *("G00Z2", "M05", "M30"),
    ]


def test_inches_feed_per_revolution_and_no_comments() -> None:
    """25.4 mm are 1 in; 2.54 mm/s are 6 in/min, at 1200 rpm .005 in/rev."""
    parts = [controller(), operation(("G0", {"X": 12.7, "Z": 2.54}), ("G1", {"Z": -25.4, "F": 2.54}))]
    assert omniturn_post.post(parts, "--inches --per-rev --no-comments --rapid 200").splitlines() == [
        *("G90G94F200G70G72", "T1", "G97M03S1200", "G00X1Z.1", "G95F.005Z-1", "G00Z.1", "M05", "M30"),
    ]


def test_feed_is_modal() -> None:
    """A path typed in a Custom operation has the feed only where it changes."""
    lines = body(
        ("G1", {"Z": 0.0, "F": 2.0}), ("G1", {"X": 6.0}), ("G0", {"Z": 1.0, "F": 9.0}), ("G1", {"Z": 0.0})
    )
    assert lines == ["G94F120Z0", "X12", "G00Z1", "G94F120Z0", "G00Z2"]


@pytest.mark.parametrize(
    ("name", "center", "code"),
    [("G3", {"I": 0.0, "K": -3.0}, "G02"), ("G2", {"I": 3.0, "K": 0.0}, "G03")],
)
def test_arcs_are_seen_from_the_other_side(name: str, center: dict[str, float], code: str) -> None:
    """From X 5 Z 0 to X 8 Z -3: convex around X 5 Z -3, concave around X 8 Z 0."""
    lines = body(("G1", {"Z": 0.0, "F": 2.0}), (name, {"X": 8.0, "Z": -3.0, "F": 2.0, **center}))
    words = "I0K-3" if name == "G3" else "I3K0"
    assert lines[1] == f"{code}X16Z-3{words}"


def test_arc_of_more_than_half_a_turn_is_divided() -> None:
    """270° from X 5 Z 0 around X 5 Z -3, counterclockwise with X up; 135° are at X 7.1213 Z -5.1213."""
    lines = body(("G1", {"Z": 0.0, "F": 2.0}), ("G3", {"X": 2.0, "Z": -3.0, "I": 0.0, "K": -3.0, "F": 2.0}))
    assert lines[1:3] == ["G02X14.2426Z-5.1213I0K-3", "G02X4Z-3I-2.1213K2.1213"]


def test_full_circle_is_divided() -> None:
    """Around X 5 Z -3 from X 5 Z 0; the middle is at X 5 Z -6."""
    lines = body(("G1", {"Z": 0.0, "F": 2.0}), ("G3", {"X": 5.0, "Z": 0.0, "I": 0.0, "K": -3.0, "F": 2.0}))
    assert lines[1:3] == ["G02X10Z-6I0K-3", "G02X10Z0I0K3"]


@pytest.mark.parametrize("name", ["G2", "G3"])
@pytest.mark.parametrize(
    "end",
    [
        {"X": 5.0 + 1e-12, "Z": 0.0},  # rounding error of the CAM program
        {"X": 5.0 - 1e-12, "Z": 0.0},
        {"X": 5.0, "Z": 5e-7},
    ],
)
def test_arc_that_ends_at_its_start_is_not_a_full_circle(name: str, end: dict[str, float]) -> None:
    lines = body(("G1", {"Z": 0.0, "F": 2.0}), (name, {**end, "I": 0.0, "K": -3.0, "F": 2.0}))
    assert lines == ["G94F120Z0", "G00Z2"]


def test_arc_below_the_resolution_is_not_a_full_circle() -> None:
    """A chord of 0.00002 mm is less than the last decimal, so its ends have the same words."""
    short = ("G3", {"X": 5.00002, "Z": 0.0, "I": 0.0, "K": -3.0, "F": 2.0})
    assert body(("G1", {"Z": 0.0, "F": 2.0}), short) == ["G94F120Z0", "G00Z2"]


@pytest.mark.parametrize(
    ("cycle", "lines"),
    [
        (("G81", {"X": 0.0, "Z": -10.0, "R": 1.0, "F": 1.0}), ["G94F60G81Z-10", "G00Z2"]),
        (("G83", {"X": 0.0, "Z": -10.0, "R": 1.0, "Q": 3.0, "F": 1.0}), ["G94F60G83Z-10K3", "G00Z2"]),
        (("G73", {"X": 0.0, "Z": -10.0, "R": 1.0, "Q": 3.0, "F": 1.0}), ["G94F60G83Z-10K3", "G00Z2"]),
        (
            ("G82", {"X": 0.0, "Z": -10.0, "R": 1.0, "P": 0.5, "F": 1.0}),
            ["G94F60Z-10", "G04F.5", "G00Z1", "Z2"],
        ),
    ],
)
def test_drilling_cycles(cycle: Command, lines: list[str]) -> None:
    assert body(("G98", {}), cycle, ("G80", {})) == ["X0", "Z1", *lines]


def test_cycle_with_g99_stays_at_r() -> None:
    drilled = body(("G99", {}), ("G81", {"X": 0.0, "Y": 0.0, "Z": -10.0, "R": 1.0, "F": 1.0}))
    assert drilled == ["X0", "Z1", "G94F60G81Z-10", "G00Z2"]  # the last line is the end of the program


@pytest.mark.parametrize("state", ["G98", "G99"])
def test_tool_below_r_moves_to_r_in_z_before_it_moves_to_the_hole(state: str) -> None:
    """After a cut to Z -10 at X 5, the tool moves to R 1 at X 5. A diagonal to X 0 would cross the part."""
    cut, cycle = ("G1", {"Z": -10.0, "F": 1.0}), ("G81", {"X": 0.0, "Z": -8.0, "R": 1.0, "F": 1.0})
    lines = body(cut, (state, {}), cycle)
    assert lines == ["G94F60Z-10", "G00Z1", "X0", "G94F60G81Z-8", "G00Z2"]


def test_thread() -> None:
    """Drive line X 10, crest at X 9 (I -1), first pass J 0.2, depth K 0.9: X 17.6, then X 16.2."""
    start = ("G0", {"X": 10.0, "Z": 5.0})
    values = {"Z": -15.0, "P": 1.5, "I": -1.0, "J": 0.2, "K": 0.9, "Q": 29.5, "H": 1}
    assert body(start, ("G76", values))[1:] == [
        *("X17.6", "G33X16.2Z-15I.4K1.5C29.5", "G33X16.2Z-15I.4K1.5O", "X20"),
    ]


def test_each_tool_begins_at_the_tool_change_with_coolant() -> None:
    drill = operation(
        ("G0", {"Z": 8.0}),
        ("G0", {"X": 0.0}),
        ("G1", {"Z": -1.0, "F": 1.0}),
        label="Drill",
        CoolantMode="Flood",
        ToolController=None,
    )
    turn = operation(*APPROACH, ("G1", {"Z": -1.0, "F": 1.0}))
    hidden = operation(("G999", {}), Active=False)
    group = SimpleNamespace(Group=[turn])
    text = omniturn_post.post([controller(1), group, hidden, controller(2), drill], "--no-comments")
    assert text.splitlines()[3:] == [
        *("G00X10Z2", "G94F60Z-1", "G00Z8", "T2", "G97M03S1200", "M08", "G00X0Z8", "G94F60Z-1"),
        *("G00Z8", "M09", "M05", "M30"),
    ]


def test_programs_are_proved(turndesk: Turndesk, tmp_path: Path) -> None:
    """A path with both arcs, a drilled hole and a thread, in both units."""
    profile = operation(
        ("G0", {"X": 0.0, "Z": 3.0}),
        ("G1", {"Z": 0.0, "F": 2.0}),
        ("G1", {"X": 5.0, "F": 2.0}),
        ("G3", {"X": 8.0, "Z": -3.0, "I": 0.0, "K": -3.0, "F": 2.0}),
        ("G1", {"Z": -12.0, "F": 2.0}),
        ("G2", {"X": 10.0, "Z": -14.0, "I": 2.0, "K": 0.0, "F": 2.0}),
        ("G0", {"X": 16.0}),
        ("G0", {"Z": 3.0}),
    )
    drill = operation(
        *APPROACH, ("G83", {"X": 0.0, "Z": -10.0, "R": 1.0, "Q": 3.0, "F": 1.0}), CoolantMode="Flood"
    )
    thread = operation(
        ("G0", {"X": 10.0, "Z": 6.0}),
        ("G76", {"Z": -9.0, "P": 1.0, "I": -2.0, "J": 0.2, "K": 0.6, "Q": 29.0}),
    )
    parts = [controller(1), profile, controller(2), drill, controller(3, 500.0), thread]
    for options in ("", "--inches", "--per-rev"):
        path = tmp_path / "part.nc"
        omniturn_post.export(parts, str(path), options)
        proof = turndesk("prove", path)
        assert (proof.status, "error" in proof.out) == (0, False), proof.out + proof.err


def test_interpreted_path_equals_the_path_of_freecad(turndesk: Turndesk, tmp_path: Path) -> None:
    """Compare ends, centers and directions: G3 is counterclockwise with X up, so clockwise with X down."""
    commands: tuple[Command, ...] = (
        ("G0", {"X": 0.0, "Z": 3.0}),
        ("G1", {"X": 0.0, "Z": 0.0, "F": 2.0}),
        ("G1", {"X": 5.0, "Z": 0.0, "F": 2.0}),
        ("G3", {"X": 8.0, "Z": -3.0, "I": 0.0, "K": -3.0, "F": 2.0}),
        ("G1", {"X": 8.0, "Z": -12.0, "F": 2.0}),
        ("G2", {"X": 10.0, "Z": -14.0, "I": 2.0, "K": 0.0, "F": 2.0}),
        ("G0", {"X": 16.0, "Z": -14.0}),
    )
    path = tmp_path / "part.nc"
    omniturn_post.export([controller(), operation(*commands)], str(path), "")
    lines = turndesk("expand", path, "--json").out.splitlines()
    moves = [each for line in lines if (each := json.loads(line)).get("kind") in {"rapid", "feed", "arc"}]
    start = (0.0, 0.0)
    for (name, values), move in zip(commands, moves, strict=False):
        assert move["kind"] == {"G0": "rapid", "G1": "feed"}.get(name, "arc")
        assert (move["x"] * 25.4, move["z"] * 25.4) == pytest.approx((values["X"], values["Z"]), abs=1e-3)
        if move["kind"] == "arc":
            center = start[0] + values["I"], start[1] + values["K"]
            assert (move["cx"] * 25.4, move["cz"] * 25.4) == pytest.approx(center, abs=1e-3)
            assert move["dir"] == {"G3": "cw", "G2": "ccw"}[name]
        start = values["X"], values["Z"]
    assert len(moves) == len(commands) + 1  # the retract at the end


def test_file_name_minus_writes_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert omniturn_post.export([controller(), operation(*APPROACH)], "-", "").endswith("M30\n")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("command", "reason"),
    [
        (("G1", {"Z": -1.0}), "feed is 0"),
        (("G1", {"Z": -1.0, "Y": 1.0, "F": 1.0}), "Y is not 0"),
        (("G0", {"A": 90.0}), "A is not 0"),
        (("G2", {"X": 6.0, "Z": 1.0, "I": 5.0, "K": 0.0, "F": 1.0}), "not on its circle"),
        (("G2", {"X": 5.0, "Z": 2.0, "F": 1.0}), "not on its circle"),
        (("G2", {"X": 6.0, "Z": 1.0, "I": 1.0, "J": 1.0, "F": 1.0}), "not in the XZ plane"),
        (("G81", {"X": 3.0, "Z": -1.0, "R": 1.0, "F": 1.0}), "not on the spindle axis"),
        (("G81", {"Z": -1.0, "R": 1.0, "F": 1.0}), "not on the spindle axis"),
        (("G81", {"X": 0.0, "Z": -1.0, "F": 1.0}), "no Z or no R"),
        (("G81", {"X": 0.0, "Z": 1.0, "R": 1.0, "F": 1.0}), "not below R"),
        (("G83", {"X": 0.0, "Z": -1.0, "R": 1.0, "F": 1.0}), "peck depth"),
        (("G76", {"Z": -1.0, "P": 1.0, "I": -1.0, "J": 0.1}), "K"),
        (("G76", {"Z": -1.0, "P": 1.0, "I": -1.0, "J": 0.9, "K": 0.5}), "J <= K"),
        (("G76", {"Z": -1.0, "P": 1.0, "I": -1.0, "J": 0.1, "K": 0.5, "Q": 45.0}), "30 degrees"),
        (("G84", {"X": 0.0, "Z": -1.0, "R": 1.0}), "pitch is unknown"),
        (("G41", {"D": 1}), "nose radius"),
        (("G91", {}), "incremental"),
        (("G55", {}), "use --shift G55"),
        (("G85", {"X": 0.0, "Z": -1.0, "R": 1.0}), "does not exist"),
        (("M6", {"T": 33}), "T33"),
        (("M6", {"T": 1.5}), "T1.5"),
        (("M3", {"S": 0.0}), "speed is 0"),
    ],
)
def test_commands_without_an_equivalent_are_rejected(command: Command, reason: str) -> None:
    with pytest.raises(omniturn_post.PostError, match=reason) as raised:
        omniturn_post.post([controller(), operation(*APPROACH, command)])
    assert str(raised.value).startswith(f"Profile, {command[0]}: ")


@pytest.mark.parametrize("options", ["--metric", "--rapid fast", "--rapid -1", "--inches '"])
def test_invalid_options_are_rejected(options: str) -> None:
    with pytest.raises(omniturn_post.PostError, match="--rapid"):
        omniturn_post.post([controller(), operation(*APPROACH)], options)


def test_jobs_without_a_tool_or_a_position_are_rejected() -> None:
    with pytest.raises(omniturn_post.PostError, match="tool controller"):
        omniturn_post.post([operation(*APPROACH)])
    cut = operation(("G0", {"Z": 1.0}), ("G1", {"X": 1.0, "F": 1.0}))
    with pytest.raises(omniturn_post.PostError, match="position before"):
        omniturn_post.post([controller(), cut])
