"""The proof of the part: each check by a program that triggers it and a near twin that does not.

Programs are written with radii and inches in brackets, and read in all four of inch and metric, radius and
diameter.
"""

from __future__ import annotations

import math
import re

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.part_data import make_part_settings
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import ProgramSource
from core.part.stock import Clamping, Stock, make_bar_stock, make_tube_stock
from core.part.tool_shape import ToolKind, ToolShape
from core.proving import part_proof
from core.proving.assumed_tools import parse_edge_width
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings
from core.proving.proof_report import PartReport, ProofReport
from tests.texts import shows
from tests.texts import text as text_of
from tests.worked import FOLDER, worked

INCH = 25.4
TURNING = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.4, insert="DCMT11T304")
BLADE = ToolShape(ToolKind.PARTING, tip=3, width=2.0, stick_out=30.0)
DRILL = ToolShape(ToolKind.DRILL, diameter=6.0, point=118.0, length=20.0)
BORER = ToolShape(ToolKind.BORING, tip=2, nose_radius=0.4, insert="DCMT070204", diameter=8.0, stick_out=40.0)
TOOLS = {1: TURNING, 2: BLADE, 3: DRILL, 4: BORER}
WAYS = [(metric, diameter) for metric in (False, True) for diameter in (False, True)]


def text(lines: str, *, metric: bool = False, diameter: bool = False) -> str:
    """A program of these lines, in one of the four ways of writing lengths."""
    unit = INCH if metric else 1.0

    def number(found: re.Match[str]) -> str:
        scale = unit * (2.0 if diameter and found[1] == "X" else 1.0)
        return f"{found[1]}{float(found[2]) * scale:.5f}"

    body = re.sub(r"([XZFIKR])\[(-?[\d.]+)\]", number, lines)
    head = "G90G94F" + f"{300 * unit:.0f}" + ("G71" if metric else "") + ("G72" if diameter else "G73")
    return f"{head}\nM03S1500\n{body}\nM30\n"


def proved(
    program: str, stock: Stock | None = None, shapes: dict[int, ToolShape] | None = None
) -> tuple[ProofReport, PartReport]:
    machine = load_machine(None)
    tools = {n: ToolOffset(-12.7, -50.8) for n in range(1, 12)}
    setup = create_power_up_setup(
        machine, tool_offsets=tools, secondary_offsets={1: SecondaryOffset(-0.381, -0.381, 0.381)}
    )
    setting = PartSettings(stock, TOOLS if shapes is None else shapes)
    report, part = prove_program_and_part(ProgramSource("PART", program), setup, machine, setting)
    assert part is not None
    return report, part


def checks(part: PartReport) -> list[tuple[str, int]]:
    return [(each.check_name, each.line) for each in part.findings]


SOUND = """T1
X[.6]Z[.05]
G95F[.006]Z[0]
X[-.02]
G94F[300]Z[.05]
X[.4]
G95F[.004]Z[-.5]
X[.55]
G94F[300]X[.6]
Z[1]"""

BAR = make_bar_stock(2 * 0.5 * INCH, 0.02 * INCH, -2.0 * INCH)

CASES = {
    # G00 left on
    "rapid-into-stock": (SOUND.replace("G95F[.004]Z[-.5]", "G00Z[-.5]"), SOUND, BAR, 9),
    # the first line's F, a rapid of old programs
    "rapid-into-stock by F": (SOUND.replace("G95F[.004]Z[-.5]", "Z[-.5]"), SOUND, BAR, 9),
    # X4 for X.4
    "larger-than-stock": (SOUND.replace("X[.4]", "X[1.4]"), SOUND, BAR, 9),
    # Z.5 for Z-.5
    "unmade-cut": (SOUND.replace("Z[-.5]", "Z[.5]"), SOUND, BAR, 9),
    # the X0 and then Z0 habit: out of a bore across its wall
    "through-part": (
        "T3\nX[0]Z[.1]\nG95F[.004]Z[-.3]\nG94F[300]X[.4]\nZ[1]",
        "T3\nX[0]Z[.1]\nG95F[.004]Z[-.3]\nG94F[300]Z[.1]\nX[.4]", BAR, 6,
    ),
    "drill-too-deep": (
        "T3\nX[0]Z[.1]\nG95F[.004]Z[-.9]\nG94F[300]Z[.1]",
        "T3\nX[0]Z[.1]\nG95F[.004]Z[-.7]\nG94F[300]Z[.1]", BAR, 5,
    ),
    "wrong-spindle-direction": (
        "M05\nM04S1500\nT3\nX[0]Z[.1]\nG95F[.004]Z[-.3]\nG94F[300]Z[.1]",
        "M05\nM03S1500\nT3\nX[0]Z[.1]\nG95F[.004]Z[-.3]\nG94F[300]Z[.1]", BAR, 7,
    ),
    "chip-load": (SOUND.replace("F[.004]", "F[.014]"), SOUND.replace("F[.004]", "F[.012]"), BAR, 9),
    "cuts-air": (
        SOUND.replace("G94F[300]Z[1]", "").replace("\nG94F[300]X[.6]", "\nG94F[2]X[.9]\nF[300]"),
        SOUND, BAR, 11,
    ),
    "part-off-unsupported": (
        "T2\nX[.6]Z[.1]\nZ[-1.9]\nG95F[.002]X[-.01]\nG94F[300]X[.6]",
        "T2\nX[.6]Z[.1]\nZ[-.9]\nG95F[.002]X[-.01]\nG94F[300]X[.6]",
        make_bar_stock(8.0, 0.0, -2.5 * INCH), 6,
    ),
    # a bar of 8 mm does not go into a bore of 7
    "holder-into-stock": (
        "T4\nX[.137]Z[.1]\nZ[-.4]\nM00\nX[.13]\nZ[1]", "T4\nX[.2]Z[.1]\nZ[-.4]\nM00\nX[.19]\nZ[1]",
        make_tube_stock(25.4, 7.0, 0.0, -50.0), 5,
    ),
    "feed-into-holder": (
        "T4\nX[.142]Z[.1]\nG95F[.002]Z[-.4]\nX[.13]\nG94F[300]Z[1]",
        "T4\nX[.24]Z[.1]\nG95F[.002]Z[-.4]\nX[.22]\nG94F[300]Z[1]",
        make_tube_stock(25.4, 7.0, 0.0, -50.0), 5,
    ),
}  # fmt: skip


@pytest.mark.parametrize(("metric", "diameter"), WAYS)
@pytest.mark.parametrize("name", CASES)
def test_check_finds_its_error_and_accepts_valid_program(name: str, metric: bool, diameter: bool) -> None:
    wrong, sound, stock, line = CASES[name]
    stock_of_twin = make_tube_stock(25.4, 11.0, 0.0, -50.0) if "holder" in name else stock
    _, part = proved(text(wrong, metric=metric, diameter=diameter), stock)
    assert (name.split(maxsplit=1)[0], line) in checks(part)
    report, part = proved(text(sound, metric=metric, diameter=diameter), stock_of_twin)
    assert checks(part) == []
    assert report.errors == ()


@pytest.mark.parametrize("slip", [("G95F[.004]Z[-.5]", "G00Z[-.5]"), ("X[.4]", "X[4]"), ("Z[-.5]", "Z[.5]")])
def test_errors_are_warnings_with_assumed_stock_and_tools(slip: tuple[str, str]) -> None:
    _, part = proved(text(SOUND), None, {})
    assert checks(part) == []
    assert part.stock is not None
    by_moves = text_of("findings.by-its-moves")
    assert part.assumptions == (
        text_of("findings.treated-as", tool="T1", kind="a turning tool", why=by_moves),
    )
    _, part = proved(text(SOUND.replace(*slip)), None, {})
    (first, *_) = part.findings
    assert (first.line, first.severity, "stock" in first.assumptions) == (9, "warning", True)
    assert first.block_number > 0
    assert first.hint


def test_removed_volume_is_calculated() -> None:
    _, part = proved(text(SOUND), BAR)
    r, nose = 0.4 * INCH, 0.4
    face = math.pi * 12.7**2 * 0.508
    corner = (1.0 - math.pi / 4.0) * nose**2  # of the fillet that the nose leaves
    turned = math.pi * (12.7**2 - r**2) * 12.7 - math.tau * (r + 0.22 * nose) * corner
    assert part.removed_volume_mm3 == pytest.approx(face + turned, rel=1e-3)
    assert part.remaining_volume_mm3 == pytest.approx(
        part.stock_volume_mm3 - part.removed_volume_mm3, rel=1e-9
    )
    assert part.last_piece is not None
    assert part.last_piece.outside_profile[0] == (pytest.approx(0.0, abs=0.01), pytest.approx(r))


def test_looped_parts_are_parted_off_one_by_one() -> None:
    loop = "LS3\nT2\nX[.3]Z[.1]\nZ[-.4]\nG95F[.002]X[-.01]\nG94F[300]X[.3]\nG10X0Z[-.4]\nLF"
    _, part = proved(text(loop), make_bar_stock(10.0, 0.0, -60.0))
    each = math.pi * 25.0 * (0.4 * INCH - 2.0)
    assert [piece.volume_mm3 for piece in part.parted_pieces] == [pytest.approx(each, rel=2e-3)] * 3
    assert checks(part) == []


def test_fed_bar_starts_again_at_bar_stop() -> None:
    fed = "T5(BAR STOP)\nX0Z1\nZ[-.4]\nM13\nZ[.02]F[20]\nM12\nG94F[300]Z[1]\n"
    _, part = proved(text(fed + SOUND), None, {})
    assert checks(part) == []
    assert part.stock is not None
    assert part.stock.front_z_mm == pytest.approx(0.02 * INCH)
    assert "T5 is treated as a bar stop" in part.assumptions


def test_tool_comment_overrides_guess_from_moves() -> None:
    drilled = "T7(1/4 DRILL)\nX[0]Z[.1]\nG95F[.004]Z[-.5]\nG94F[300]Z[1]"
    _, part = proved(text(drilled), make_bar_stock(20.0, 0.0, -40.0), {})
    by_comment = text_of("findings.by-its-comment")
    assert part.assumptions == (
        text_of("findings.treated-as", tool="T7", kind="a drill, 0.250 in", why=by_comment),
    )
    assert part.last_piece is not None
    assert part.last_piece.bore_profile is not None
    assert part.last_piece.bore_profile[0][1] == pytest.approx(3.175, abs=0.001)


@pytest.mark.parametrize(
    "example", [path.stem for path in sorted(FOLDER.glob("*.nc"))] or ["linear-diameter"]
)
def test_worked_example_causes_no_false_finding(example: str) -> None:
    machine = load_machine(None)
    d = (-0.381, -0.381, 0.381)
    tools = {n: ToolOffset() for n in range(1, 33)}
    setup = create_power_up_setup(
        machine, tool_offsets=tools, secondary_offsets={n: SecondaryOffset(*d) for n in (1,)}
    )
    source = ProgramSource(example, worked(example).read_text(encoding="latin-1"))
    _, part = prove_program_and_part(
        source, setup, machine, PartSettings(drives=make_part_settings(machine, {}, {}).drives)
    )
    assert part is not None
    assert checks(part) == []


def test_six_flats_of_a_worked_example_have_their_volume() -> None:
    machine = load_machine(None)
    setup = create_power_up_setup(machine, tool_offsets={21: ToolOffset()}, secondary_offsets={})
    source = ProgramSource("SIX", worked("plane-xc-six-flats").read_text(encoding="latin-1"))
    _, part = prove_program_and_part(source, setup, machine, PartSettings())
    assert part is not None
    assert part.is_milled
    # The mill's axis goes round a hexagon of circumradius .38465 in, .1 deep: its .125 leave a hexagon of
    # this apothem, and at the middle of each side a segment of the bar beyond its outer side.
    assert part.stock is not None
    bar_r, apothem = part.stock.max_radius_mm, (0.38465 * math.cos(math.pi / 6) - 0.0625) * INCH
    outer = apothem + 0.125 * INCH
    segment = bar_r**2 * math.acos(outer / bar_r) - outer * math.sqrt(bar_r**2 - outer**2)
    area = math.pi * bar_r**2 - 2 * math.sqrt(3.0) * apothem**2 - 6.0 * segment
    assert part.removed_volume_mm3 == pytest.approx(area * 0.1 * INCH, rel=5e-3)
    assert part.remaining_volume_mm3 == pytest.approx(
        part.stock_volume_mm3 - part.removed_volume_mm3, rel=1e-3
    )


MILL = {6: ToolShape(ToolKind.END_MILL, tip=8, diameter=6.0, length=15.0)}
SLOT = "T6\nX[.6]Z[-.4]\nM05\nM15\nM19\nG04F3\nG94F[4]X[.4]\nZ[-.8]\nX[.6]\nG94F[300]X[1]\nM16"


@pytest.mark.parametrize(("metric", "diameter"), WAYS)
def test_slot_is_milled_with_locked_spindle(metric: bool, diameter: bool) -> None:
    _, part = proved(text(SLOT, metric=metric, diameter=diameter), make_bar_stock(25.4, 0.0, -60.0), MILL)
    assert checks(part) == []
    depth, width, length = 0.1 * INCH, 6.0, 0.4 * INCH
    # a flat floor 2.54 under the crown of the bar: the depth at y is less by r - sqrt(r² - y²)
    r = 12.7
    strip = (
        r * r * math.asin(width / 2 / r) + width / 2 * math.sqrt(r * r - width**2 / 4) - width * (r - depth)
    )
    assert part.removed_volume_mm3 > strip * length
    assert part.removed_volume_mm3 < strip * (length + width)
    _, part = proved(text(SLOT.replace("G94F[4]X", "G94F[200]X"), metric=metric, diameter=diameter),
                     make_bar_stock(25.4, 0.0, -60.0), MILL)  # fmt: skip
    assert ("rapid-into-stock", 9) in checks(part)


def test_piece_parted_off_after_slot_has_smaller_volume() -> None:
    off = SLOT + "\nM05\nM03S900\nT2\nX[.6]Z[.1]\nZ[-1.2]\nG95F[.002]X[-.01]\nG94F[300]X[.6]"
    _, whole = proved(
        text("T2\nX[.6]Z[.1]\nZ[-1.2]\nG95F[.002]X[-.01]\nG94F[300]X[.6]"), make_bar_stock(25.4, 0.0, -60.0)
    )
    _, part = proved(text(off), make_bar_stock(25.4, 0.0, -60.0), {**TOOLS, **MILL})
    _, slot = proved(text(SLOT), make_bar_stock(25.4, 0.0, -60.0), MILL)
    (piece,), (full,) = part.parted_pieces, whole.parted_pieces
    assert piece.volume_mm3 == pytest.approx(full.volume_mm3 - slot.removed_volume_mm3, rel=1e-3)


def chucked(
    lines: str, clamping: Clamping, shapes: dict[int, ToolShape] = TOOLS, *, metric: bool = False,
    diameter: bool = False,
) -> PartReport:  # fmt: skip
    machine = load_machine(None)
    setup = create_power_up_setup(
        machine, tool_offsets={n: ToolOffset(-12.7, -50.8) for n in range(1, 12)}, secondary_offsets={}
    )
    setting = PartSettings(make_bar_stock(25.4, 0.0, -80.0), shapes, clamping=clamping)
    _, part = prove_program_and_part(
        ProgramSource("PART", text(lines, metric=metric, diameter=diameter)), setup, machine, setting
    )
    assert part is not None
    return part


CHUCK = Clamping(chuck_diameter=100.0, stick_out=1.2 * INCH, jaw_length=10.0, jaw_diameter=60.0)
PARTED = "T2\nX[.6]Z[.1]\nZ[-1]\nG95F[.002]X[-.01]\nG94F[300]X[.6]\nZ[1]"


def test_jaws_collision_is_found_only_for_tool_past_jaw_face() -> None:
    assert checks(chucked(PARTED, CHUCK)) == []
    deeper = PARTED.replace("Z[-1]", "Z[-1.3]")
    assert ("into-chuck", 5) in checks(chucked(deeper, CHUCK))
    assert checks(chucked(deeper, Clamping(100.0, 1.5 * INCH, 10.0, 60.0))) == []


def test_rapid_next_to_bar_clears_small_jaws() -> None:
    beside = "T2\nX[1.0]Z[.1]\nZ[-1.4]\nM00\nZ[1]"
    assert ("into-chuck", 5) in checks(chucked(beside, CHUCK))  # r 25.4 in jaws of r 30
    assert checks(chucked(beside, Clamping(100.0, 1.2 * INCH, 20.0, 48.0))) == []


CENTRE = Clamping(
    chuck_diameter=0.0, stick_out=0.0, quill_diameter=12.0, center_angle_deg=60.0, center_z_mm=-3.0
)


@pytest.mark.parametrize(("metric", "diameter"), WAYS)
def test_tool_collides_with_tailstock_center_only_when_too_close(metric: bool, diameter: bool) -> None:
    """Tip at Z-3 mm, 60 degrees: at the face (Z0) the centre is 3 tan 30 = 1.73 mm (.068 in) of radius."""
    for r, hit in ((0.03, True), (0.12, False)):
        lines = f"T1\nX[.6]Z[0]\nG95F[.004]X[{r}]\nG94F[300]Z[.05]\nX[.7]"
        found = checks(chucked(lines, CENTRE, metric=metric, diameter=diameter))
        assert (("into-tailstock", 5) in found) is hit


def test_a_holder_runs_into_the_quill() -> None:
    """The quill begins where the cone is 6 mm of radius: Z -3 + 6 / tan 30 = 7.4 mm (.29 in)."""
    beside = "T2\nX[.6]Z[.05]\nG00Z[.6]\nX[{r}]\nX[.7]"
    assert ("into-tailstock", 6) in checks(chucked(beside.format(r=0.2), CENTRE))  # 5.08 mm
    assert checks(chucked(beside.format(r=0.3), CENTRE)) == []  # 7.62 mm


def test_drill_through_part_does_not_collide_with_chuck() -> None:
    through = "T3\nX[0]Z[.1]\nG95F[.004]Z[-1.8]\nG94F[300]Z[1]"
    long = {3: ToolShape(ToolKind.DRILL, diameter=6.0, point=118.0, length=60.0, stick_out=80.0)}
    assert checks(chucked(through, CHUCK, long)) == []


def test_spindle_speed_above_chuck_limit_is_reported() -> None:
    slow, fast = (Clamping(0.0, 0.0, max_rpm=rpm) for rpm in (1499.0, 1500.0))
    assert ("spindle-overspeed", 4) in checks(chucked(SOUND, slow))
    assert checks(chucked(SOUND, fast)) == []


def ganged(lines: str, apart: float) -> PartReport:
    """T1 turns, and a drill stands on the plate beside it, ``apart`` mm further along X."""
    machine = load_machine(None)
    places = {1: (-12.7, -50.8), 3: (-12.7 + apart, -50.8)}
    setup = create_power_up_setup(
        machine, tool_offsets={n: ToolOffset(*at) for n, at in places.items()}, secondary_offsets={}
    )
    setting = PartSettings(
        make_bar_stock(25.4, 0.0, -80.0), TOOLS, gang={n: (z, x) for n, (x, z) in places.items()}
    )
    _, part = prove_program_and_part(ProgramSource("PART", text(lines)), setup, machine, setting)
    assert part is not None
    return part


def test_neighboring_tool_collides_with_bar() -> None:
    turned = "T1\nX[.6]Z[.05]\nX[.4]\nG95F[.004]Z[-.5]\nX[.55]\nG94F[300]X[.6]\nZ[1]"
    # With T1 at r 10.16 the drill, 6 thick, has its axis at r -4.84 in a bar of r 12.7; at 40 it passes.
    assert ("neighbour-tool", 6) in checks(ganged(turned, 15.0))
    assert checks(ganged(turned, 40.0)) == []
    assert checks(ganged(turned, -40.0)) == []


def test_neighboring_tool_reaches_bar_only_as_far_as_tool_moves_in() -> None:
    short = "T1\nX[.6]Z[.05]\nG95F[.004]X[.4]\nG94F[300]X[.6]\nZ[1]"
    assert checks(ganged(short, 15.0)) == []


def test_part_of_very_long_program_is_made_when_stock_is_stated(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(part_proof, "MAX_MOVES", 5)
    _, part = proved(text(SOUND))
    assert (part.stock, part.removed_volume_mm3, part.findings) == (None, 0.0, ())
    assert shows(part.assumptions[0], "findings.no-part-without-stock")
    _, part = proved(text(SOUND), BAR)
    assert part.removed_volume_mm3 > 0.0


def test_thread_in_bore_removes_only_its_grooves() -> None:
    machine = load_machine(None)
    setup = create_power_up_setup(machine, tool_offsets={8: ToolOffset()}, secondary_offsets={})
    source = ProgramSource("THREAD", worked("thread-internal").read_text(encoding="latin-1"))
    _, part = prove_program_and_part(source, setup, machine, PartSettings())
    assert part is not None
    assert part.last_piece is not None
    assert part.last_piece.bore_profile is not None
    # Passes from r .4425 to .46875 in over .75 in of a lead of .05: at most half of that ring.
    ring = math.pi * (0.46875**2 - 0.43**2) * 0.8 * INCH**3
    assert 0.2 * ring < part.removed_volume_mm3 < 0.7 * ring
    assert max(r for _, r in part.last_piece.bore_profile) == pytest.approx(0.46875 * INCH, abs=0.02)


def test_cut_deeper_than_edge_length_is_reported() -> None:
    cut = "T1\nX[1.1]Z[.05]\nX[{r}]\nG95F[.004]Z[-.5]\nX[1.1]\nG94F[300]Z[1]"
    thick = make_bar_stock(50.8, 0.0, -60.0)
    _, part = proved(text(cut.format(r=0.3)), thick)  # .7 in; .5 of 11.2 mm is .22 in
    assert ("feed-into-holder", 6) in checks(part)
    _, part = proved(text(cut.format(r=0.9)), thick)
    assert checks(part) == []


def test_an_arc_into_a_shoulder_is_as_deep_as_the_shoulder_is_high() -> None:
    """60 degrees of a fillet of .15: .1 in of metal above it, of which each chord meets another slice."""
    cut = "T1\nX[.7]Z[.05]\nX[.3]\nG95F[.004]Z[-.4]\nG03X[.375]Z[-.5299]R.15\nX[.7]\nG94F[300]Z[1]"
    _, part = proved(text(cut), make_bar_stock(20.32, 0.0, -60.0))
    assert checks(part) == []


def test_slot_removed_by_turning_counts_once() -> None:
    turned = "M05\nM03S1500\nT1\nX[.6]Z[.1]\nX[.35]\nG95F[.004]Z[-1]\nX[.55]\nG94F[300]Z[1]"
    _, plain = proved(text(turned), make_bar_stock(25.4, 0.0, -60.0), TOOLS)
    _, slotted = proved(text(f"{SLOT}\n{turned}"), make_bar_stock(25.4, 0.0, -60.0), {**TOOLS, **MILL})
    assert slotted.is_milled
    assert slotted.removed_volume_mm3 == pytest.approx(plain.removed_volume_mm3, rel=2e-3)
    assert slotted.remaining_volume_mm3 == pytest.approx(plain.remaining_volume_mm3, rel=2e-3)


# --- what an assumed tool is taken for, and what stands still


@pytest.mark.parametrize(
    ("comment", "width"),
    [
        ("NOTCH TOOL 045 WIDE", 0.045 * INCH), ("GROOVE .062 WIDE", 0.062 * INCH), ("PART OFF 3MM WIDE", 3.0),
        ("GROOVE 2.5 MM WIDE", 2.5), ("GROOVE TOOL", 0.0), ("45 WIDE", 0.0), ("WIDE GROOVE 125", 0.0),
    ],
)  # fmt: skip
def test_edge_width_is_parsed_from_comment(comment: str, width: float) -> None:
    assert parse_edge_width(comment) == pytest.approx(width)


def test_stopped_spindle_turns_nothing_and_is_reported() -> None:
    """Turned to r .4, then fed in at r .2 with the spindle stopped: there is no groove, and that is told."""
    turned = "T1\nX[.55]Z[.1]\nX[.4]\nG95F.004Z[-.3]\nG94F300X[.55]\nZ[.1]\n"
    still = text(turned + "M05\nX[.2]\nG94F10Z[-.2]\nG00Z[.1]\nG01F300X[.6]\n")
    stock = make_bar_stock(INCH, 0.0, -2 * INCH)
    (_, alone), (report, part) = proved(text(turned), stock), proved(still, stock)
    assert part.removed_volume_mm3 == pytest.approx(alone.removed_volume_mm3)
    assert text_of("findings.cuts-stopped", tool="T1", line=11) in part.unchecked_data
    assert [each for each in report.errors if each.check_name] == []
    _, running = proved(still.replace("M05\n", ""), stock)
    assert running.removed_volume_mm3 > 1.5 * alone.removed_volume_mm3
    assert not any("stands" in words for words in running.unchecked_data)


def test_live_tool_in_zc_plane_is_radial() -> None:
    """A tool along the axis would cut a slot with its flank on the way out."""
    worked("plane-zc-figure-eight")
    path = FOLDER / "plane-zc-figure-eight.nc"
    _, part = proved(path.read_text(), make_bar_stock(0.98 * INCH, 0.0, -1.5 * INCH), {})
    assert part.last_piece is not None
    (shape,) = (each for each in part.tool_shapes.values() if each is not None)
    assert shape.direction[0] == 0
