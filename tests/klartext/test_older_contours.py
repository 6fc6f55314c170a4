"""Cycles 6, 15 and 16, contour formulas and SEL CONTOUR: what is cleared, by closed formulas on a grid."""

from __future__ import annotations

import numpy as np
import pytest

from core.interpreter.elementary_blocks import Kind
from core.language.klartext.called_programs import called_programs
from core.language.source import Source
from tests.klartext.running import Ran, run, run_source, whole
from tests.klartext.test_contour_cycles import (
    DATA,
    ISLAND,
    OF,
    POCKET,
    TOOL,
    R,
    from_two,
    no_rapid_in_the_part,
    spots_of,
    told,
)
from tests.klartext.test_pocket_cycles import cuts, left_standing, rounded, way

# Called 2 mm over the surface at Z+1, as cycle 20 of the other tests says: depth 7, so the floor is at Z-6.
AT = "L Z+3 R0 FMAX\n"
CYCLES = {
    6: "CYCL DEF 6.0 ROUGH-OUT\nCYCL DEF 6.1 SET UP2 DEPTH-7\nCYCL DEF 6.2 PECKG3 F100 ALLOW+0.5\n"
       "CYCL DEF 6.3 ANGLE+0 F400\nCYCL CALL\n",
    15: "CYCL DEF 15.0 PILOT\nCYCL DEF 15.1 ABST-2 TIEFE-7\nCYCL DEF 15.2 ZUSTLG-3 F100 AUFM+0.5\n"
        "CYCL CALL\n",
    16: "CYCL DEF 16.0 MILLING\nCYCL DEF 16.1 SET UP2 DEPTH-7\nCYCL DEF 16.2 PECKG7 F100\n"
        "CYCL DEF 16.3 DR{0} F400\nCYCL CALL\n",
}  # fmt: skip
NAMED = "CYCL DEF 14.0 CONTOUR GEOMETRY\nCYCL DEF 14.1 CONTOUR LABEL 1/2\n"
CONTOURS = f"M30\nLBL 1\n{POCKET}\nLBL 0\nLBL 2\n{ISLAND}\nLBL 0"


def older(number: int, turn: str = "+", swap: tuple[str, str] = ("", "")) -> Ran:
    text = NAMED + AT + CYCLES[number].format(turn) + CONTOURS
    return run(text.replace(*swap) if swap[0] else text, tool=TOOL)


def test_rough_out_clears_the_pocket_to_its_allowance() -> None:
    ran = older(6)
    points = cuts(ran)
    deep = points[points[:, 2] < 1.0 - 1e-9][:, :2] - (30.0, 20.0)
    assert rounded(deep, 30, 20, 6).max() == pytest.approx(-R - 0.5, abs=1e-3)
    assert np.hypot(*deep.T).min() == pytest.approx(8.5 + R, abs=1e-3)
    assert points[:, 2].min() == pytest.approx(-6.0)
    spots = spots_of(60, 40)
    inside = (rounded(spots - (30.0, 20.0), 29.5, 19.5, 5.5) <= 0.0) & (
        np.hypot(*(spots - (30.0, 20.0)).T) >= 8.5
    )
    for z in (-2.0, -5.0, -6.0):
        level = points[np.abs(points[:, 2] - z) < 1e-6][:, :2]
        assert left_standing(level, spots[inside]) <= R + 0.05
    no_rapid_in_the_part(ran)


def test_pilot_holes_stay_inside_the_allowance_and_reach_the_floor() -> None:
    ran = older(15)
    holes = np.array([way(block)[-1] for block in ran.blocks if block.kind is Kind.FEED])
    assert holes[:, 2].min() == pytest.approx(-6.0)
    assert rounded(holes[:, :2] - (30.0, 20.0), 30, 20, 6).max() <= -R - 0.5 + 1e-3
    assert np.hypot(*(holes[:, :2] - (30.0, 20.0)).T).min() >= 8.5 + R - 1e-3


@pytest.mark.parametrize(("turn", "sense"), [("+", 1), ("-", -1)])
def test_contour_milling_follows_the_walls_in_its_sense(turn: str, sense: int) -> None:
    """DR+ goes round the pocket counter-clockwise."""
    ran = older(16, turn)
    points = cuts(ran)
    deep = points[points[:, 2] < -6.0 + 1e-6][:, :2] - (30.0, 20.0)
    assert rounded(deep, 30, 20, 6).max() == pytest.approx(-R, abs=1e-3)
    assert np.hypot(*deep.T).min() == pytest.approx(8.0 + R, abs=1e-3)
    walls = deep[rounded(deep, 30, 20, 6) > -R - 1e-3]
    turned = walls[:-1, 0] * walls[1:, 1] - walls[:-1, 1] * walls[1:, 0]
    assert np.sign(np.sum(turned[np.abs(turned) < 20.0])) == sense


@pytest.mark.parametrize(
    ("number", "swap", "code", "names"),
    [
        (6, ("CYCL DEF 6.2 PECKG3 F100 ALLOW+0.5\n", ""), "Cycle incomplete", "6.2"),
        (6, ("ALLOW+0.5", ""), "Cycle incomplete", "6.2"),
        (6, ("F400", "FMAX"), "Cycle incomplete", "rapid"),
        (15, (NAMED, ""), "Cycle incomplete", "No contour is defined for cycle 15"),
        (16, ("DEPTH-7", ""), "Cycle incomplete", "16.1"),
        (16, ("LABEL 1/2", "LABEL 9"), "Label not found", "LBL 9"),
    ],
)
def test_refused(number: int, swap: tuple[str, str], code: str, names: str) -> None:
    ran = older(number, swap=swap)
    assert ran.codes == [code]
    assert names in ran.errors[0].message


# --- contour formulas: circles of R25 about X35 and X65, Y50

CIRCLE = "BEGIN PGM {0} MM\nCC X+{1} Y+50\nLP PR+25 PA+0\nCP IPA+360 DR+\nEND PGM {0} MM\n"
FILES = (Source("ONE.H", CIRCLE.format("ONE", 35)), Source("TWO.H", CIRCLE.format("TWO", 65)))
DECLARED = 'DECLARE CONTOUR QC1 = "ONE"\nDECLARE CONTOUR QC2 = "TWO.H"\n'


def joined(formula: str, more: tuple[Source, ...] = ()) -> Ran:
    cycle = f"{told(20, DATA)}\n{told(22, OF[22])}\nCYCL CALL\nM30"
    text = whole(TOOL + formula + "\n" + cycle)
    return run_source(Source("T.H", text, subprograms=(*FILES, *more)))


@pytest.mark.parametrize(
    ("formula", "inside"),
    [
        ("QC10 = QC1 | QC2", lambda a, b: (a <= 25.0) | (b <= 25.0)),
        ("QC10 = QC1 & QC2", lambda a, b: (a <= 25.0) & (b <= 25.0)),
        ("QC10 = QC1 \\ QC2", lambda a, b: (a <= 25.0) & (b >= 25.0)),
        ("QC10 = ( QC1 | QC2 ) \\ ( QC1 & QC2 )", lambda a, b: (a <= 25.0) != (b <= 25.0)),
        ("QC10 = QC1 ^ QC2", lambda a, b: (a <= 25.0) != (b <= 25.0)),
        ("QC3 = QC1 & QC2\nQC10 = QC1 \\ QC3", lambda a, b: (a <= 25.0) & (b >= 25.0)),
    ],
)
def test_a_formula_says_what_is_cleared(formula: str, inside) -> None:  # type: ignore[no-untyped-def]
    """Nothing outside is touched, and nothing the tool reaches is left standing."""
    ran = joined(DECLARED + formula)
    points = cuts(ran)
    floor = points[points[:, 2] < -6.0 + 1e-6][:, :2]
    turn = np.linspace(0.0, 2.0 * np.pi, 48)
    edge = (floor[::9, None, :] + (R - 3e-3) * np.stack([np.cos(turn), np.sin(turn)], axis=1)).reshape(-1, 2)
    assert inside(*from_two(edge)).all()
    spots = spots_of(100, 100, 1.1)
    round_about = spots[:, None, :] + 2.0 * R * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    reached = inside(*from_two(round_about.reshape(-1, 2))).reshape(len(spots), -1).all(axis=1)
    reached &= inside(*from_two(spots))
    if reached.any():
        assert left_standing(floor, spots[reached]) <= R + 0.05


def test_a_program_of_contours_is_selected() -> None:
    model = Source("MODEL.H", f"BEGIN PGM MODEL MM\n{DECLARED}QC10 = QC1 & QC2\nEND PGM MODEL MM\n")
    by_file = joined('SEL CONTOUR "MODEL"', (model,))
    assert np.allclose(cuts(by_file), cuts(joined(DECLARED + "QC10 = QC1 & QC2")))
    named = set(called_programs(Source("T.H", whole('SEL CONTOUR "MODEL"')))) | set(called_programs(model))
    assert named == {"MODEL.H", "ONE.H", "TWO.H"}


def test_contour_def_takes_programs_and_declared_contours() -> None:
    wanted = cuts(joined(DECLARED + "QC10 = QC1 \\ QC2"))
    assert np.allclose(cuts(joined('CONTOUR DEF P1 = "ONE" I2 = "TWO"')), wanted)
    assert np.allclose(cuts(joined(DECLARED + "CONTOUR DEF P1 = QC1 I2 = QC2")), wanted)


@pytest.mark.parametrize(
    ("formula", "code", "names"),
    [
        (DECLARED + "QC10 = QC1 | QC2 \\ QC1", "Syntax error", "without parentheses"),
        (DECLARED + "QC10 = QC1 + QC2", "Syntax error", "joins QC"),
        (DECLARED + "QC10 = QC1 | QC7", "Cycle incomplete", "QC7"),
        ('DECLARE CONTOUR QC1 = "NONE"\nQC10 = QC1 | QC1', "Program not found", "NONE"),
        ('DECLARE CONTOUR QC1 = "ONE" DEPTH5', "Not supported", "a separate depth"),
        ('SEL CONTOUR "NONE"', "Program not found", "NONE"),
        ('SEL CONTOUR "ONE"', "Cycle incomplete", "no contour formula"),
        (DECLARED + "QC10 = ( QC1 & QC2 ) \\ QC1", "Input value incorrect", "islands cover the pockets"),
        ("CONTOUR DEF P1 = QC4", "Cycle incomplete", "QC4"),
    ],
)
def test_a_formula_is_refused(formula: str, code: str, names: str) -> None:
    ran = joined(formula)
    assert ran.codes == [code]
    assert names in ran.errors[0].message
