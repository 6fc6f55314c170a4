"""The reader of LinuxCNC programs against LinuxCNC's own interpreter, where it is installed."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path
from typing import NamedTuple

import pytest

from core.extras.convert.path_steps import MOVE_KINDS, StepKind
from core.extras.convert.source_options import ConversionOptions, SourceControl, TargetControl
from core.extras.convert.source_reader import SourceReader
from core.extras.convert.targets.omniturn_steps import interpret_source
from core.extras.convert.targets.target_conversion import convert_from_omniturn
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import ControlLimits

RS274 = shutil.which("rs274")
INI = "[RS274NGC]\nPARAMETER_FILE = {folder}/rs.var\nLATHE = 1\n[EMCIO]\nTOOL_TABLE = {folder}/rs.tbl\n"
CANON = re.compile(r"(STRAIGHT_TRAVERSE|STRAIGHT_FEED|ARC_FEED)\(([^)]*)\)")
NEAR = 0.00006  # rs274 prints four decimal places; lengths are in mm here

pytestmark = pytest.mark.skipif(RS274 is None, reason="rs274 of LinuxCNC is not installed")

CONTOUR = """\
G21 G18 G7 G95
T1 M6
G97 S500 M3
G0 X50 Z2
G1 Z-25 F.2
G2 X62 Z-31 R6
G3 X70 Z-35 I0 K-4
G8
G1 X40
G7
G91
G1 X-4 Z-3.3
G90
G0 X100
M2
"""
THREAD = """\
G21 G18 G7 G95
T1 M6
G97 S500 M3
G0 X30 Z4
G76 P1.5 Z-20 I-2.5 J.25 K1.9 R1.5 Q29.5 H2
G0 X40 Z4
X16
G76 P1.25 Z-15 I2 J.2 K1.2
G33 Z-10 K1.5
G0 X30
M2
"""
MACRO = """\
G21 G18 G8 G94
o100 sub
G1 X[#1] Z[0 - #2 * 2.5] F100
o100 endsub
G0 X40 Z2
#<depth> = 1
o101 while [#<depth> LE 3]
o100 call [40 - #<depth>] [#<depth>]
o102 if [#<depth> EQ 2]
G0 X45
o102 else
G0 X[44 + SIN[30]]
o102 endif
#<depth> = [#<depth> + 1]
o101 endwhile
o103 repeat [2]
G1 X[38 + ATAN[1]/[1] / 45]
G1 X37
o103 endrepeat
M2
"""


G7X_BEGIN = "G21 G18 G7 G94 F100\nT1 M6\nS500 M3\nG0 X50 Z5\n"
SHAFT = "G0 X10\nG1 Z-10\nX20 Z-15\nZ-20\nX44"
ROUNDED = "G0 X0 Z0\nG1 X10\nG3 X20 Z-5 K-5\nG1 Z-12\nG2 X26 Z-15 R3\nG1 X30\nX44 Z-20"
BORE = "G0 X40\nG1 Z-5\nX30 Z-10\nZ-20\nX18"
FACE = "G0 Z-10\nG1 X20\nZ-5\nX10 Z-2\nG2 X4 Z1 R3\nG1 X0\nZ2"
G7X = [
    (SHAFT, "G71 Q100 X42 Z1 D0.3 I2 R0.5"),
    (SHAFT, "G71.1 Q100 X42 Z1 D0 I3 R0"),
    (SHAFT, "G70 Q100 X42 Z1 D0.4 E0.1 P2"),
    (ROUNDED, "G71 Q100 X44 Z2 D0.3 I2 R0.5"),
    (ROUNDED, "G71 Q100 X44 Z2"),
    (ROUNDED, "G70 Q100 X44 Z2 D0.4 E0.1 P3"),
    (BORE, "G71 Q100 X18 Z2 D0.3 I2 R0.5"),
    (BORE, "G70 Q100 X18 Z2 D0.4 E0.1 P2"),
    (FACE, "G72 Q100 X44 Z2 D0.3 I2 R0.5"),
    (FACE, "G72.1 Q100 D0.1 I.7"),
]


OMNITURN = """\
G90G94F3000G71G72
T1
M03S500
X50Z2
G95F.2G01Z-25
G02X62Z-31R6
X70C1
Z-40
G00X80Z4
X32
G33X29Z-20I.5K1.5P
G33X28Z-20I.5A2K1.5C
G94F100X30Z0
G74X20Z-10I1U.2
G83Z-15K3F50
M30
"""
OMNITURN_RADIUS = """\
G90G94F3000G71G73
T1
M03S500
X25Z2
G95F.2G01Z-25
G02X31Z-31R6
X35C1
Z-40
M30
"""


class Move(NamedTuple):
    """A move in mm: X is a radius; the center is 0 for straight moves."""

    kind: str
    x: float
    z: float
    cx: float = 0.0
    cz: float = 0.0
    turn: int = 0


def canon(text: str, folder: Path, tool: str = "T1 P1 D0 X0 Z0") -> list[Move]:
    """Return the moves that LinuxCNC makes with this row of the tool table."""
    (folder / "lathe.ini").write_text(INI.format(folder=folder))
    (folder / "rs.var").write_text("")
    (folder / "rs.tbl").write_text(f"{tool}\n")
    (folder / "part.ngc").write_text(text)
    words = [RS274 or "rs274", "-g", "-i", "lathe.ini", "-t", "rs.tbl", "part.ngc"]
    out = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=60, check=True).stdout
    moves: list[Move] = []
    for name, values in CANON.findall(out):
        v = [float(each) for each in values.split(",")]
        if name == "ARC_FEED":
            moves.append(Move("arc", v[1], v[0], v[3], v[2], round(v[4])))
        else:
            moves.append(Move("rapid" if name == "STRAIGHT_TRAVERSE" else "cut", v[0], v[2]))
    return without_standstill(moves)


def ours(text: str) -> list[Move]:
    """Return the moves of our reader, without those whose position is unknown."""
    reader = SourceReader(text.splitlines(), ConversionOptions(SourceControl.LINUXCNC))
    reader.read_program()
    moves = []
    for step in reader.state.steps:
        if step.kind in MOVE_KINDS and step.x is not None and step.z is not None:
            kind = {StepKind.RAPID: "rapid", StepKind.ARC: "arc"}.get(step.kind, "cut")
            center = (step.cx, step.cz, 1 if step.clockwise else -1) if kind == "arc" else (0.0, 0.0, 0)
            moves.append(Move(kind, step.x, step.z, *center))
    return without_standstill(moves)


def without_standstill(moves: list[Move]) -> list[Move]:
    found = moves[:1]
    for each in moves[1:]:
        if max(abs(each.x - found[-1].x), abs(each.z - found[-1].z)) > NEAR:
            found.append(each)
    return found


@pytest.mark.parametrize("text", [CONTOUR, THREAD, MACRO], ids=["contour", "thread", "macro"])
def test_the_reader_moves_as_linuxcnc_does(text: str, tmp_path: Path) -> None:
    wanted = canon(text, tmp_path)
    assert_same_moves(ours(text), wanted)
    assert len(wanted) > 6


def assert_same_moves(made: list[Move], wanted: list[Move], near: float = NEAR) -> None:
    assert [(each.kind, each.turn) for each in made] == [(each.kind, each.turn) for each in wanted]
    for one, other in zip(made, wanted, strict=True):
        assert (one.x, one.z, one.cx, one.cz) == pytest.approx(
            (other.x, other.z, other.cx, other.cz), abs=near
        )


@pytest.mark.parametrize(("contour", "call"), G7X)
def test_contour_cycles_move_as_linuxcnc_does(contour: str, call: str, tmp_path: Path) -> None:
    text = f"{G7X_BEGIN}O100 SUB\n{contour}\nO100 ENDSUB\n{call}\nM2\n"
    wanted = canon(text, tmp_path)
    assert len(wanted) > 6
    assert_same_moves(ours(text), wanted)


@pytest.mark.parametrize(
    ("contour", "out", "call"),
    [
        ("G0 X10\nG1 Z-10\nX20 Z-20\nZ-30", "X44", "G71 Q100 X44 Z2 D0.3 I1.4"),
        ("G1 X50 Z0\nG1 X0", "Z1", "G72 Q100 X50 Z1 D0.03 I0.4 R0.5"),
        ("G0 X40\nG1 Z-5\nX30 Z-10\nZ-20", "X18", "G71 Q100 X18 Z2 D0.1 I1 R.5"),
    ],
)
def test_missing_way_out_is_added_as_newer_versions_do(
    contour: str, out: str, call: str, tmp_path: Path
) -> None:
    """Version 2.9.0 of rs274 does not add the move straight out, so it is written for rs274."""
    text = f"{G7X_BEGIN}O100 SUB\n{{}}\nO100 ENDSUB\n{call}\nM2\n"
    assert_same_moves(ours(text.format(contour)), canon(text.format(f"{contour}\n{out}"), tmp_path))


@pytest.mark.parametrize(("text", "count"), [(OMNITURN, 50), (OMNITURN_RADIUS, 6)])
def test_program_from_omniturn_moves_the_same_in_linuxcnc(text: str, count: int, tmp_path: Path) -> None:
    """The elementary blocks of the OmniTurn program and the moves of rs274 are equal."""
    texts = text.splitlines()
    options = ConversionOptions(SourceControl.LINUXCNC)
    program = interpret_source(texts, options, ControlLimits())
    wanted = []
    for each in program.blocks:
        if each.moves:
            kind = {BlockKind.RAPID: "rapid", BlockKind.ARC: "arc"}.get(each.kind, "cut")
            center = (each.cx, each.cz, 1 if each.clockwise else -1) if kind == "arc" else (0.0, 0.0, 0)
            wanted.append(Move(kind, each.x, each.z, *center))
    done = convert_from_omniturn(texts, TargetControl.LINUXCNC, options, ControlLimits(), "part.nc")
    assert not done.errors
    assert_same_moves(canon(done.text, tmp_path), without_standstill(wanted), 2 * NEAR)  # rounded twice
    assert len(wanted) >= count


def test_nose_compensation_from_omniturn_is_on_the_same_side_in_linuxcnc(tmp_path: Path) -> None:
    """The nose is outside the part, so the tip of orientation 2 touches X.8 at radius .4 and Z-.5.

    On the other side, the tip would be one nose diameter (.0312 in) inside the part.
    """
    text = "G90G94F300G70G72\nT1\nM03S1000\nX0Z.3\nG95F.004\nG41\nZ0D1\nX.8\nZ-.5\nX1.1\nG00Z.3\nG40\nM30\n"
    options = ConversionOptions(SourceControl.LINUXCNC)
    done = convert_from_omniturn(
        text.splitlines(), TargetControl.LINUXCNC, options, ControlLimits(), "part.nc"
    )
    moves = canon(done.text, tmp_path, "T1 P1 D.0312 Q2 X0 Z0")
    assert any((each.x, each.z) == pytest.approx((0.4, -0.5), abs=NEAR) for each in moves)


@pytest.mark.parametrize(
    ("start", "first"),
    [
        # the nose touches X0 and Z0, so that the face is cut from X.0156, and not from X0
        ("X0Z.3", (0.0, 0.0)),
        # in the line of the face, the center of the nose is at X0 and the tip at X-.0156
        ("X-.4Z0", (-0.0156, 0.0)),
    ],
)
def test_linuxcnc_does_not_cut_the_first_nose_radius_after_an_approach(
    start: str, first: tuple[float, float], tmp_path: Path
) -> None:
    words = start.replace("X", "G0 X").replace("Z", " Z")
    text = f"G20 G18 G7 G94 F10\nT1 M6 G43\n{words}\nG42 G1 X0 Z0\nX.8\nZ-.5\nG40 G0 X1.1\nM2\n"
    moves = canon(text, tmp_path, "T1 P1 D.0312 Q2 X0 Z0")
    assert (moves[1].x, moves[1].z) == pytest.approx(first, abs=NEAR)


def test_comparison_detects_a_difference(tmp_path: Path) -> None:
    wanted = canon(CONTOUR, tmp_path)
    assert abs(ours(CONTOUR.replace("R6", "R6.01"))[2].cx - wanted[2].cx) > NEAR
    assert ours(CONTOUR.replace("G2 X62", "G3 X62"))[2].turn != wanted[2].turn
