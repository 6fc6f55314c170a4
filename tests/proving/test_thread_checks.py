"""Threads and taps: each check by a program that triggers it and a near twin that does not, in four ways of
writing."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from app.compose.part_data import make_part_settings
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import ToolOffset
from core.interpreter.shared.modal_state import ModalState
from core.language.source import ProgramSource
from core.part.stock import Stock, make_bar_stock, make_tube_stock
from core.part.tool_shape import ToolHand, ToolKind, ToolShape
from core.proving.assumed_tools import find_groove_width, parse_tap_size
from core.proving.checks.thread_checks import DriveLimits
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings
from core.proving.tip_moves import TipMove
from tests.proving.test_part_proof import WAYS, text

TAP = ToolShape(ToolKind.TAP, diameter=6.35, pitch=1.27)
V = ToolShape(ToolKind.THREADING, tip=8, point=60.0, pitch=1.27)


def move(start: tuple[float, float], end: tuple[float, float], kind: BlockKind = BlockKind.THREAD) -> TipMove:
    """One of 1 mm a turn."""
    return TipMove(1, 1, kind, (start, end), 10.0, False, 1.0, 600.0, ModalState())


SHAPES = {4: TAP, 5: V}
ROD = make_bar_stock(12.7, 0.0, -60.0)
DRILLED = make_tube_stock(25.4, 5.1, 0.0, -60.0)


def findings(
    program: str, stock: Stock = ROD, drives: DriveLimits | None = None, shapes: dict[int, ToolShape] = SHAPES
) -> list[tuple[str, int]]:
    machine = load_machine(None)
    tools = {n: ToolOffset(-12.7, -50.8) for n in range(1, 12)}
    known = make_part_settings(machine, {}, shapes)
    setting = PartSettings(stock, shapes, drives=drives or known.drives)
    report, part = prove_program_and_part(
        ProgramSource("P", program),
        create_power_up_setup(machine, tool_offsets=tools, secondary_offsets={}),
        machine,
        setting,
    )
    assert part is not None
    assert report.errors == tuple(each for each in part.findings if each.severity == "error")
    return [(each.check_name, each.line) for each in part.findings]


TAPPED = "M05\nM03S1000\nT4\nX[0]Z[.1]\nG95F[.05]Z[-.4]\nM04\nG04F.5\nZ[.1]\nG94F[300]Z[1]"
THREAD = "M05\nM03S600\nT5\nX[.3]Z[.2]\nX[.247]\nG33X[.222]Z[-.5]I[.01]K[.05]{p}\nG94F[300]Z[1]"
CUT = THREAD.format(p="")

CASES = {
    "tap-reversal": (TAPPED.replace("M04\nG04F.5\n", ""), TAPPED, DRILLED, 8),
    "tap-reversal by a rapid": (TAPPED.replace("\nZ[.1]\nG94", "\nG00Z[.1]\nG94"), TAPPED, DRILLED, 10),
    "tap-reversal, stopped": (
        TAPPED.replace("M04", "M05").replace("G04F.5\nZ[.1]", "G04F.5\nG94F[20]Z[.1]"), TAPPED, DRILLED, 10,
    ),
    "tap-reversal, other feed": (TAPPED.replace("G04F.5\nZ[.1]", "F[.03]Z[.1]"), TAPPED, DRILLED, 9),
    # 3000 rpm, slowed by 2500 rpm a second: 34 turns of .05 in
    "tap-reversal, too fast": (TAPPED.replace("S1000", "S3000"), TAPPED, DRILLED, 10),
    "tap-pitch": (TAPPED.replace("F[.05]", "F[.0625]"), TAPPED, DRILLED, 7),
    "wrong-spindle-direction of a tap": (
        TAPPED.replace("M04", "M00").replace("M03", "M04").replace("M00", "M03"), TAPPED, DRILLED, 7,
    ),
    # a sharp V of .05 in is .0433 deep: X.2 for X.222 is .05 below a bar of .25
    "thread-form": (CUT.replace("X[.222]", "X[.2]"), CUT, ROD, 8),
    # I = .01: passes start at X.3, .2959, .2927, all outside a bar of .25
    "thread-in-air": (CUT.replace("X[.247]", "X[.3]"), CUT, ROD, 8),
    # I = .01: passes from X.3 to X.26, all outside a bar of .25; the last of the twin cuts to .24
    "thread-cuts-nothing": (
        CUT.replace("X[.247]\n", "X[.3]\n").replace("X[.222]", "X[.26]"),
        CUT.replace("X[.222]", "X[.24]"), ROD, 8,
    ),
    "thread-pitch": (CUT.replace("K[.05]", "K[.075]"), CUT, ROD, 8),
}  # fmt: skip


@pytest.mark.parametrize(("metric", "diameter"), WAYS)
@pytest.mark.parametrize("name", CASES)
def test_check_flags_faulty_program_and_accepts_sound_twin(name: str, metric: bool, diameter: bool) -> None:
    wrong, sound, stock, line = CASES[name]
    # I and A are diameters under G72
    double = [each.replace("I[.01]", "I[.02]") if diameter else each for each in (wrong, sound)]
    shown = findings(text(double[0], metric=metric, diameter=diameter), stock)
    assert (name.split(maxsplit=1)[0].rstrip(","), line) in shown
    assert findings(text(double[1], metric=metric, diameter=diameter), stock) == []


LEFT_HAND = "M05\nM03S600\nT6\nX[.3]Z[-.5]\nG95F[.002]X[.19]\nG94F[300]X[.3]\n"
LEFT_HAND += "T5\nX[.3]Z[-.43]\nX[.26]\nG33X[.222]Z[.2]I[.02]K[.05]\nG94F[300]X[.3]\nZ[1]"


@pytest.mark.parametrize(("metric", "diameter"), WAYS)
def test_rapid_into_narrow_groove_of_left_hand_thread_is_reported(metric: bool, diameter: bool) -> None:
    """The groove reaches from Z-.5 2 mm back, to Z-.421, the flanks of the thread at Z-.43 to Z-.414."""
    program = text(
        LEFT_HAND.replace("I[.02]", "I[.04]") if diameter else LEFT_HAND, metric=metric, diameter=diameter
    )
    groover = ToolShape(ToolKind.GROOVING, tip=3, stick_out=30.0)
    wide = replace(groover, width=2.0)
    assert ("rapid-into-stock", 12) in findings(program, shapes={**SHAPES, 6: wide})
    assert findings(program, shapes={**SHAPES, 6: groover}) == []
    assert findings(program) == []  # nobody has described it at all


def test_groove_of_unknown_width_is_2_mm_or_as_wide_as_thread_needs() -> None:
    def width(z0: float, z1: float, tip: int = 3) -> float:
        plunge = move((-10.0, 8.0), (-10.0, 5.0), BlockKind.FEED)
        return find_groove_width(
            ToolShape(ToolKind.GROOVING, tip=tip), [plunge], [move((z0, 6.0), (z1, 6.0))]
        )

    assert width(-8.0, 5.0) == pytest.approx(2.5)  # and half the lead of 1 mm
    assert width(-8.0, -9.0) == 2.0  # of a thread towards the chuck its end tells nothing
    assert width(-11.0, 5.0) == 2.0  # before the corner that is set
    assert width(-11.0, 5.0, tip=4) == 2.0
    assert width(-13.0, 5.0, tip=4) == pytest.approx(3.5)
    assert width(-8.0, 5.0, tip=8) == pytest.approx(5.0)  # set at its middle
    assert width(-1.0, 5.0) == 2.0  # no groove is as wide as that


def test_lead_of_several_pitches_is_accepted_as_multi_start() -> None:
    assert findings(text(CUT.replace("K[.05]", "K[.15]"))) == []


@pytest.mark.parametrize(("metric", "diameter"), WAYS)
def test_thread_start_ahead_of_part_zero_requires_run_up(metric: bool, diameter: bool) -> None:
    """.05 in at 600 rpm are 12.7 mm/s: with 20 mm/s² that is 4.03 mm. The bar stands .1 in before Z0."""
    lines = THREAD.format(p="P")
    lines = lines.replace("I[.01]", "I[.02]") if diameter else lines
    slow = DriveLimits(z_acceleration_mm_s2=20.0)
    program = text(lines, metric=metric, diameter=diameter)
    assert findings(program, make_bar_stock(12.7, 2.54, -60.0), slow) == [("thread-run-up", 8)]
    assert findings(program, make_bar_stock(12.7, 0.5, -60.0), slow) == []


def test_braking_in_material_longer_than_lead_is_reported() -> None:
    """12.7 mm/s and 50 mm/s² are 1.6 mm, more than the lead of 1.27; run-up is 5 mm."""
    slow = DriveLimits(z_acceleration_mm_s2=50.0)
    assert findings(text(CUT), drives=slow) == [("thread-run-up", 8)]
    assert findings(text(THREAD.format(p="P")), drives=slow) == []  # goes on while it pulls out
    relief = Stock(
        "", ((-60.0, 6.35), (-15.0, 6.35), (-14.99, 4.0), (-10.0, 4.0), (-9.99, 6.35), (0.0, 6.35))
    )
    assert findings(text(CUT), relief, slow) == []


def test_self_reversing_holder_feeds_out_without_spindle_reversal() -> None:
    out = TAPPED.replace("M04\nG04F.5\n", "")
    assert findings(text(out.replace("T4", "T4(1/4-20 TAP, TAPMATIC)")), DRILLED) == []


def test_comment_sets_pitch_of_undefined_tap() -> None:
    named = TAPPED.replace("T4", "T4(1/4-28 TAP)")
    assert findings(text(named), DRILLED, shapes={}) == [("tap-pitch", 7)]
    assert findings(text(named.replace("28", "20")), DRILLED, shapes={}) == []


def test_left_hand_tap_feeds_in_with_reversed_spindle() -> None:
    left = {4: ToolShape(ToolKind.TAP, ToolHand.LEFT, diameter=6.35, pitch=1.27)}
    assert ("wrong-spindle-direction", 7) in findings(text(TAPPED), DRILLED, shapes=left)
    turned = TAPPED.replace("M04", "M00").replace("M03", "M04").replace("M00", "M03")
    assert findings(text(turned), DRILLED, shapes=left) == []


@pytest.mark.parametrize(
    ("comment", "size"),
    [
        ("1/4-20 TAP", (6.35, 1.27)),
        ("10-32 TAP", (4.826, 0.79375)),
        ("#4-40 TAP", (2.8448, 0.635)),
        (".250-28 TAP", (6.35, 25.4 / 28)),
        ("TAP M6X1.0", (6.0, 1.0)),
        ("TAP M8", (8.0, 1.25)),
        ("TAP", (0.0, 0.0)),
    ],
)
def test_tap_size_is_parsed_from_comment(comment: str, size: tuple[float, float]) -> None:
    assert parse_tap_size(comment) == pytest.approx(size)
