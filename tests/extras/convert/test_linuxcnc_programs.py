"""All OmniTurn programs, converted and executed by the interpreter of LinuxCNC without rounding."""

from __future__ import annotations

import json
import os
import re
import subprocess
from pathlib import Path

import pytest

from core.extras.convert.source_options import ConversionOptions, SourceControl, TargetControl
from core.extras.convert.targets.omniturn_steps import InterpretedProgram, interpret_source
from core.extras.convert.targets.target_conversion import convert_from_omniturn
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import ControlLimits
from tests.extras.convert.test_rs274 import INI, Move

PYTHON = "/usr/bin/python3"
HAS_INTERPRETER = (
    Path(PYTHON).exists()
    and subprocess.run([PYTHON, "-c", "import gcode"], check=False, capture_output=True).returncode == 0
)
"""Whether the package linuxcnc-uspace is installed, whose module gcode does not round."""

pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(not HAS_INTERPRETER, reason="the module gcode of LinuxCNC is not installed"),
]

ROOT = Path(__file__).parents[3]
FOLDERS = (
    ROOT / "resources" / "programs",
    ROOT / "tests" / "programs",
    ROOT.parent / "shared" / "conformance" / "omniturn",
    ROOT.parent / "shared" / "cases" / "proof",
)
OPTIONS = ConversionOptions(
    SourceControl.LINUXCNC, writes_comments=False, skipped_m_codes=frozenset(range(10, 90))
)
NEAR_IN = 1e-6  # in; the converted programs have six decimal places
MIN_MOVES = 1500  # the programs in the repository alone have 1842

EXECUTE = """
import gcode, json, sys

class Canon:
    def __init__(self, folder):
        self.parameter_file, self.moves = folder + "/gcode.var", []
        open(self.parameter_file, "w").close()

    def next_line(self, state):
        self.line = state.sequence_number

    def straight_traverse(self, x, y, z, *others):
        self.moves.append((self.line, "rapid", x, z))

    def straight_feed(self, x, y, z, *others):
        self.moves.append((self.line, "cut", x, z))

    def arc_feed(self, z, x, cz, cx, turn, *others):
        self.moves.append((self.line, "arc", x, z, cx, cz, turn))

    def get_tool(self, number):
        return (number, *[0.0] * 12, 2)

    def get_external_length_units(self):
        return 1 / 25.4

    def get_external_angular_units(self):
        return 1.0

    def get_axis_mask(self):
        return 0b101

    def get_block_delete(self):
        return 0

    def check_abort(self):
        return False

    def __getattr__(self, name):
        return lambda *values: None

found = []
for file in sys.argv[2:]:
    canon = Canon(sys.argv[1])
    result = gcode.parse(file, canon, "G20", "")[0]
    found.append((gcode.strerror(result) if result > gcode.MIN_ERROR else "", canon.moves))
print(json.dumps(found))
"""


def execute(texts: list[list[str]], folder: Path) -> list[list[Move]]:
    """Return the moves of each program without home moves, in inches with X as a radius.

    The programs have no tool changes, because the module has no tool table.
    """
    (folder / "lathe.ini").write_text(INI.format(folder=folder))
    files = [folder / f"{number}.ngc" for number in range(len(texts))]
    for file, lines in zip(files, texts, strict=True):
        kept = ["(T)" if re.match(r"T\d+ M6", each) else each for each in lines]
        file.write_text("\n".join(kept) + "\n")
    env = {**os.environ, "INI_FILE_NAME": str(folder / "lathe.ini")}
    words = [PYTHON, "-c", EXECUTE, str(folder), *map(str, files)]
    done = subprocess.run(words, env=env, capture_output=True, text=True, timeout=120, check=True)
    found = []
    for lines, (error, moves) in zip(texts, json.loads(done.stdout), strict=True):
        assert not error, error
        found.append([Move(*move) for line, *move in moves if "G30" not in lines[line - 1]])
    return found


def list_source_moves(program: InterpretedProgram) -> list[Move]:
    """Return the moves of the OmniTurn program without home moves, in inches with X as a radius."""
    moves = []
    for each in program.blocks:
        if not each.moves or not each.modal.tool:
            continue
        kind = {BlockKind.RAPID: "rapid", BlockKind.ARC: "arc"}.get(each.kind, "cut")
        center = (each.cx / 25.4, each.cz / 25.4) if kind == "arc" else (0.0, 0.0)
        turn = (1 if each.clockwise else -1) if kind == "arc" else 0
        moves.append(Move(kind, each.x / 25.4, each.z / 25.4, *center, turn))
    return moves


def drop_standstill(moves: list[Move]) -> list[Move]:
    """Return the moves without straight moves to the present position."""
    found = moves[:1]
    for each in moves[1:]:
        travel = max(abs(each.x - found[-1].x), abs(each.z - found[-1].z))
        if each.kind == "arc" or travel > 2 * NEAR_IN:
            found.append(each)
    return found


def has_same_moves(found: list[Move], wanted: list[Move]) -> bool:
    """Return whether the kinds, the directions and, within the tolerance, the coordinates are equal."""
    if [(each.kind, each.turn) for each in found] != [(each.kind, each.turn) for each in wanted]:
        return False
    pairs = zip(found, wanted, strict=True)
    return all(
        abs(a - b) <= NEAR_IN for one, other in pairs for a, b in zip(one[1:5], other[1:5], strict=True)
    )


def test_all_programs_move_the_same_in_linuxcnc(tmp_path: Path) -> None:
    texts, programs, names = [], [], []
    for path in sorted(each for folder in FOLDERS for each in folder.glob("*.nc")):
        source = path.read_text(errors="replace").splitlines()
        done = convert_from_omniturn(source, TargetControl.LINUXCNC, OPTIONS, ControlLimits(), path.name)
        if not done.errors:
            texts.append([each.text for each in done.lines])
            programs.append(interpret_source(source, OPTIONS, ControlLimits()))
            names.append(path.name)
    compared = 0
    for name, program, made in zip(names, programs, execute(texts, tmp_path), strict=True):
        wanted, found = drop_standstill(list_source_moves(program)), drop_standstill(made)
        assert has_same_moves(found, wanted), name
        compared += len(wanted)
    assert compared > MIN_MOVES


@pytest.mark.parametrize(
    ("line", "other"),
    [("Z0", "Z.000002"), ("G3 X1.2", "G2 X1.2"), ("I0 K-.1", "I.00001 K-.1"), ("G0 X1", "G1 X1")],
)
def test_comparison_detects_a_changed_line(line: str, other: str, tmp_path: Path) -> None:
    lines = ["G20 G18 G7 G90", "G94 F10", "G0 X1 Z.1", "G1 Z0", "G3 X1.2 Z-.1 I0 K-.1", "M2"]
    changed = [each.replace(line, other) for each in lines]
    first, second, same = execute([lines, changed, lines], tmp_path)
    assert not has_same_moves(first, second)
    assert has_same_moves(first, same)


def test_program_that_linuxcnc_rejects_is_reported(tmp_path: Path) -> None:
    with pytest.raises(AssertionError):
        execute([["G20 G18 G7 G90", "G94 F10", "G0 X1 Z0", "G2 X1.2 Z-.3 I0 K-.1", "M2"]], tmp_path)
