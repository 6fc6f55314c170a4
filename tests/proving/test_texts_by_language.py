"""Messages and remedies of the proof name no code of a language other than that of the program."""

from __future__ import annotations

import re
from typing import Any

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import ToolOffset
from core.language.diagnostics import Diagnostic
from core.language.source import ProgramSource
from core.part.stock import Clamping, Stock, make_bar_stock, make_tube_stock
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.checks.part_checks import PART_CHECKS
from core.proving.checks.thread_checks import DriveLimits
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings
from core.proving.prove_program import prove
from core.tool_edges import make_edge_row_number
from tests.proving import test_edge_checks, test_part_proof, test_thread_checks
from tests.proving.test_part_proof import text

LATHE = load_shipped_machine("sinumerik-modulo")
# Code words that one language has and another has not, or means something else by.
CODES = re.compile(r"\b(G(?!96\b)\d{2,3}\w*|M\d{1,3}|LIMS|L[SF]\d*|RF|TOOL CALL|CYCL\w*)\b")
OMNITURN = re.compile(r"\b(G(7[0-9]|10|0\d|3[1-6]|92)\w*|M0\d|M1[0-9]|L[SF]\d*\b|RF\b|secondary|collet)")
KLARTEXT = re.compile(r"\bTOOL CALL|\bCYCL DEF|\bFMAX|\bL [XZ]")
SINUMERIK = re.compile(r"\bLIMS|\bCYCLE\d|\bDIAM|\bT\d+ D\d|\bTRANS\b|\bG5[4-9]\b|\bMCALL")


@pytest.mark.parametrize("name", PART_CHECKS)
def test_part_check_remedies_contain_no_program_codes(name: str) -> None:
    """These checks serve every language of a lathe; S, X, Z, F, K and G96 are the same in all of them."""
    assert CODES.findall(PART_CHECKS[name].remedy) == []


def in_sinumerik(program: str) -> str:
    """The same program in SINUMERIK, as far as its words are the same; a thread is one pass."""
    told = program.replace("G94F300G73", "G94 G700 DIAMOF F300").strip()
    words = {"M03": "M3 ", "M04": "M4 ", "M05": "M5 ", "G00": "G0 ", "G01": "G1 ", "M19": "SPOS=0 "}
    for word, same in words.items():
        told = told.replace(word, same)
    told = re.sub(r"^T(\d+)$", r"T\1 D1", told, flags=re.MULTILINE)
    told = re.sub(r"G33X(\S+?)Z(\S+?)I\S+?K([.\d]+)P?$", r"G0 X\1\nG33 Z\2 K\3\nG1", told, flags=re.MULTILINE)
    return re.sub(r"(?<=\d)(?=[XZFKSMIG])", " ", told) + "\n"


def found(program: str, stock: Stock | None, shapes: dict[int, ToolShape], **said: Any) -> list[Diagnostic]:
    """Return what the proof finds in a SINUMERIK program; ``said`` are further fields of the setting."""
    keys = {make_edge_row_number(n, 1): shape for n, shape in shapes.items()}
    setup = create_power_up_setup(
        LATHE, tool_offsets=dict.fromkeys(keys, ToolOffset(-12.7, -50.8)), secondary_offsets={}
    )
    setting = PartSettings(stock, keys, **said)
    report, part = prove_program_and_part(ProgramSource("a.mpf", program), setup, LATHE, setting)
    assert part is not None
    return list(report.diagnostics)


def reads_as(found: Diagnostic, *others: re.Pattern[str]) -> bool:
    """Whether message and remedy have no word of the other languages."""
    return not any(each.search(f"{found.message} {found.hint}") for each in others)


SHAPES = {"part": test_part_proof.TOOLS, "edge": test_edge_checks.SHAPES, "thread": test_thread_checks.SHAPES}
SUITES = {"part": test_part_proof, "edge": test_edge_checks, "thread": test_thread_checks}
NOT_READ = {  # an arc, a lead, a lathe's plane and a pause that SINUMERIK writes in other words
    "contour-past-part-off", "unmade-cut, a thread", "unmade-cut of a live tool", "tap-reversal, too fast",
    "thread-in-air", "drill-without-limit",
}  # fmt: skip
TURNED = {
    f"{suite}: {name}": (in_sinumerik(text(wrong)), stock, SHAPES[suite], name)
    for suite, module in SUITES.items()
    for name, (wrong, _, stock, _) in module.CASES.items()
    if name not in NOT_READ
}


@pytest.mark.parametrize("name", TURNED)
def test_sinumerik_mistakes_are_reported_in_sinumerik_terms(name: str) -> None:
    program, stock, shapes, check = TURNED[name]
    told = found(program, stock, shapes)
    assert check.split(maxsplit=1)[0].rstrip(",") in {each.check_name for each in told}
    assert [each for each in told if not reads_as(each, OMNITURN, KLARTEXT)] == []


HEAD = "G90 G94 G700 DIAMOF F300\nS1500 M3\n"
ROD, PIPE = make_bar_stock(25.4, 0.0, -60.0), make_tube_stock(25.4, 12.0, 0.0, -60.0)
CHUCK = Clamping(100.0, 40.0, 0.0, 60.0, max_rpm=1000.0)
CENTRE = Clamping(0.0, 0.0, quill_diameter=12.0, center_angle_deg=60.0, center_z_mm=-3.0)
PASS = "T{t} D1\nX.6 Z.05\nX.4\nG95 F.004 Z{z}\nX.6\nG94 F300 Z1\n"
HOLE = "T3 D1\nX{x} Z.1\nG95 F.004 Z{z}\nG94 F300 Z1\n"
ARC = "T1 D1\nX.6 Z.05\nX.4\nG95 F.004 Z-.6\nG3 X.425 Z-.625 CR=.025\nG1 X.6\nG94 F300 Z1\n"
OFF = "T2 D1\nX.6 Z-.58\nG95 F.002 X-.01\nG94 F300 X.6\n"
THREAD = "T8 D1\nX.6 Z.2\n" + "G0 X{r}\nG33 Z-.5 K.05\nG0 X.6\nZ.2\n" * 4 + "G1 Z1\n"
MORE: dict[str, tuple[str, Stock, dict[str, Any]]] = {
    "into-chuck": (PASS.format(t=2, z="-1.7"), ROD, {"clamping": CHUCK}),
    "near-chuck": (PASS.format(t=2, z="-1.57"), ROD, {"clamping": CHUCK}),
    "spindle-overspeed": (PASS.format(t=1, z="-.3"), ROD, {"clamping": CHUCK}),
    "into-tailstock": (PASS.format(t=1, z="-.3").replace("X.4", "X.03"), ROD, {"clamping": CENTRE}),
    "stock-whips": (
        PASS.format(t=1, z="-.3").replace("X.4", "X.08"), make_bar_stock(6.0, 0.0, -320.0),
        {"clamping": Clamping(100.0, 300.0, 10.0, 60.0)},
    ),
    "neighbour-tool": (PASS.format(t=1, z="-.5"), ROD, {"gang": {1: (-50.8, -12.7), 3: (-50.8, 2.3)}}),
    "tools-in-one-place": (PASS.format(t=1, z="-.5"), ROD, {"gang": {1: (0.0, 0.0), 5: (0.0, 0.0)}}),
    "drill-off-axis": (HOLE.format(x=".02", z="-.3"), ROD, {}),
    "past-stock": (HOLE.format(x="0", z="-2.9"), ROD, {}),
    "no-bore": (PASS.format(t=4, z="-.5").replace("X.6", "X.3").replace("X.4", "X.4"), ROD, {}),
    "contour-past-part-off": (ARC + OFF, make_bar_stock(25.4, 0.0, -80.0), {}),
    "thread-in-air": (THREAD.format(r=".55"), ROD, {}),
    "thread-run-up": (THREAD.format(r=".49").replace("Z.2", "Z.02"), ROD, {"drives": DriveLimits(20.0)}),
    "drill-without-limit": (
        HOLE.format(x="0", z="-.3").replace("D1", "D1\nG96 S90 F.004").replace("G95 F.004 ", ""), ROD, {},
    ),
    "cut-standing": (
        PASS.format(t=1, z="-.3").replace("G95 F.004", "M5\nF4"), ROD, {"live_codes": True}
    ),
    "hollow-at-edge": (
        ARC.replace("Z-.6\n", "Z0\n").replace("G3", "G2").replace("Z-.625", "Z-.025"), ROD, {}
    ),
    "arc-loop": (ARC.replace("CR=.025", "I.025 K0"), ROD, {}),
    "tap-no-hole": ("T10 D1\nX0 Z.1\nG95 F.05 Z-.4\nM5\nM4\nZ.1\n", ROD, {}),
}  # fmt: skip
TAP = ToolShape(ToolKind.TAP, diameter=6.35, pitch=1.27, length=25.0)


@pytest.mark.parametrize("check", MORE)
def test_workholding_checks_are_reported_in_sinumerik_terms(check: str) -> None:
    program, stock, said = MORE[check]
    shapes = {**test_edge_checks.SHAPES, 10: TAP}
    if "gang" in said:
        said = {"gang": {make_edge_row_number(n, 1): at for n, at in said["gang"].items()}}
    told = found(f"{HEAD}{program}M30\n", stock, shapes, **said)
    assert check in {each.check_name for each in told}
    assert [each for each in told if not reads_as(each, OMNITURN, KLARTEXT)] == []


def test_every_check_of_the_part_is_raised_in_sinumerik() -> None:
    raised = {name.split(maxsplit=1)[0].rstrip(",") for *_, name in TURNED.values()} | set(MORE)
    assert PART_CHECKS.keys() - raised == set()


FACE = "G90 G94 G71 DIAMOF F3000\nT1 D1\nG0 X20 Z2\n{limit}G96 S200 F.1 M3\nG1 Z0\nX0\nM30\n"
PROGRAMS = {
    # 200 m/min at the axis; a limit of the program, by one word or another, is one
    "no-speed-limit": (FACE.format(limit=""), "LIMS="),
    "no-tool": ("G90 G94 G71\nS900 M3\nG0 X20 Z2\nG1 Z-5 F100\nM30\n", "T"),
    "spindle-off": ("G90 G94 G71\nT1 D1\nS900\nG0 X20 Z2\nG1 Z-5 F100\nM30\n", "M3"),
    "soft-limit": ("G90 G94 G71\nT1 D1\nG0 X40 Z-9000\nM30\n", "G54"),
    # 1100 m/min at r 20 mm are 8754 rpm, over twice 3500
    "surface-speed": (
        "G90 G94 G71 DIAMOF\nT1 D1\nG0 X20 Z2\nLIMS=1500\nG96 S1100 F.1 M3\nG1 X4\nM30\n", "S",
    ),
}  # fmt: skip


@pytest.mark.parametrize("code", PROGRAMS)
def test_checks_without_stock_are_reported_in_sinumerik_terms(code: str) -> None:
    program, remedy = PROGRAMS[code]
    told = found(program, None, {1: test_edge_checks.RIGHT})
    (first,) = [each for each in told if each.code == code][:1]
    assert remedy in first.hint
    assert [each for each in told if not reads_as(each, OMNITURN, KLARTEXT)] == []


@pytest.mark.parametrize("limit", ["LIMS=2000\n", "G26 S2000\n"])
def test_limited_surface_speed_gives_no_finding_in_sinumerik(limit: str) -> None:
    assert found(FACE.format(limit=limit), None, {1: test_edge_checks.RIGHT}) == []


@pytest.mark.parametrize(
    "body", ["L Z+5 R0 FMAX\nL Z-5 F200\nTOOL CALL 1 Z S100\nL Z-9 M3", "TOOL CALL 1 Z S100\nL Z+9000 FMAX"]
)
def test_klartext_mistakes_are_reported_in_klartext_terms(body: str) -> None:
    mill = load_shipped_machine("ac-table-mill")
    setup = create_power_up_setup(mill, tool_offsets={1: ToolOffset()}, secondary_offsets={})
    told = prove(ProgramSource("a.h", f"BEGIN PGM A MM\n{body}\nEND PGM A MM\n"), setup, mill).diagnostics
    assert told
    assert [each for each in told if not reads_as(each, OMNITURN, SINUMERIK)] == []
