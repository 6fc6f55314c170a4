"""Cycles by hand: every way of the tool, and what is refused."""

from __future__ import annotations

import math

import pytest

from core.interpreter.actions import Dwell, SpindleRun, SpindleStop
from core.interpreter.elementary_blocks import Block, Kind
from tests.klartext.running import Ran, run

TOOL = "TOOL DEF 5 L+0 R+4\nTOOL CALL 5 Z S1000 F500\n"
HERE = "L X+10 Y+20 Z+50 R0 FMAX M3\n"
COMMON = "Q200=2\nQ203=1\nQ204=30\nQ206=150\nQ211=0\nQ210=0\nQ202=5\n"


def ran_of(text: str) -> Ran:
    return run(HERE + text, tool=TOOL)


def told(text: str) -> list[str]:
    """Each block behind the first move: F or R (rapid) with Z, or what else it does."""
    ran = ran_of(text)
    assert ran.codes == []
    return [_shown(block) for block in ran.blocks[:-1] if block.line > 4]


def _shown(block: Block) -> str:
    match block.action:
        case Dwell(seconds=seconds):
            return f"rest {seconds:g}"
        case SpindleRun(rpm=rpm):
            return f"turn {rpm:g}"
        case SpindleStop():
            return "stop"
        case None:
            assert block.swivel is not None
            letter = {Kind.RAPID: "R", Kind.FEED: "F", Kind.PLANE_ARC: "A"}[block.kind]
            return f"{letter} {round(block.swivel.end[2], 6):g}"
        case _:
            return "other"


def cycle(number: int, **q: float) -> str:
    lines = " ~\n".join(f"  Q{name[1:]}={value:+g} ;WHAT" for name, value in q.items())
    return f"{COMMON}CYCL DEF {number} NAME ~\n{lines}\nCYCL CALL M3\n"


def test_drilling_in_three_infeeds() -> None:
    """Surface 1, clearance 2: to 3; infeeds of 5 to 11 deep are 4, -1 ... from 1 down: -4, -9, -10."""
    assert told(cycle(200, q201=-11)) == [
        "turn 1000", "R 3", "F -4", "R 3", "R -2", "F -9", "R 3", "R -7", "F -10", "R 31",
    ]  # fmt: skip


def test_drilling_at_once_with_rests() -> None:
    assert told(cycle(200, q201=-11, q202=20, q211=1.5)) == ["turn 1000", "R 3", "F -10", "rest 1.5", "R 31"]
    assert told(cycle(200, q201=-6, q210=0.5))[3:6] == ["R 3", "rest 0.5", "R -2"]


def test_a_depth_of_nothing_only_goes_to_the_clearance() -> None:
    assert told(cycle(200, q201=0)) == ["turn 1000", "R 3"]


def test_reaming_goes_out_at_its_feed() -> None:
    assert told(cycle(201, q201=-8, q208=300)) == ["turn 1000", "R 3", "F -7", "F 3", "R 31"]


def test_boring_stops_the_spindle_and_goes_aside() -> None:
    found = told(cycle(202, q201=-8, q214=1, q208=0))
    assert found == ["turn 1000", "R 3", "F -7", "stop", "F -7", "R 31", "R 31", "turn 1000"]


def test_universal_drilling_breaks_chips_and_takes_less_each_time() -> None:
    """Infeeds 5, 4, 3 from the surface at 1, a chip break of .2 behind each but every second."""
    assert told(cycle(203, q201=-12, q212=1, q205=1, q213=1, q256=0.2, q208=0)) == [
        "turn 1000", "R 3", "F -4", "R -3.8", "F -8", "R 3", "R -6", "F -11", "R 31",
    ]  # fmt: skip


def test_deep_drilling_stops_before_the_chips() -> None:
    assert told(cycle(205, q201=-10, q258=0.5, q259=1.5, q253=750)) == [
        "turn 1000", "R 3", "F -4", "R 3", "R -3", "F -9", "R 31",
    ]  # fmt: skip


def test_tapping_turns_the_spindle_round() -> None:
    assert told(cycle(206, q201=-8)) == ["turn 1000", "R 3", "F -7", "turn -1000", "F 3", "turn 1000", "R 31"]
    ran = ran_of(cycle(207, q201=-8, q239=1.25))
    feeds = {round(block.feed * 60.0, 6) for block in ran.blocks if block.kind is Kind.FEED}
    assert feeds == {1250.0}


def test_tapping_with_chip_breaking() -> None:
    assert told(cycle(209, q201=-8, q239=1, q257=5, q256=0)) == [
        "turn 1000", "R 3", "F -4", "turn -1000", "F 3", "turn 1000",
        "F -7", "turn -1000", "F 3", "turn 1000", "R 31",
    ]  # fmt: skip


def test_bore_milling_is_a_helix_of_the_tools_way() -> None:
    """A tool of R 4 in a hole of 20 goes round on R 6; 13 mm down from 3 at 4 a turn, and once more."""
    ran = ran_of(cycle(208, q201=-11, q334=4, q335=20))
    assert ran.codes == []
    arcs = [block for block in ran.blocks if block.kind is Kind.PLANE_ARC]
    assert [round(block.swivel.end[2], 6) for block in arcs if block.swivel] == [
        -1.0,
        -5.0,
        -9.0,
        -10.0,
        -10.0,
    ]
    assert arcs[0].length == pytest.approx(math.hypot(12 * math.pi, 4.0))
    assert arcs[-1].length == pytest.approx(12 * math.pi)


def test_m99_calls_once_and_m89_until_m99() -> None:
    define = f"{COMMON}CYCL DEF 240 CENTRE ~\n Q343=+0 ;SELECT ~\n Q201=-1 ;DEPTH\n"
    ran = ran_of(f"{define}L X+0 FMAX M89\nL X+10 FMAX\nL X+20 FMAX M99\nL X+30 FMAX")
    assert ran.codes == []
    cut = [block.swivel.end[0] for block in ran.blocks if block.kind is Kind.FEED and block.swivel]
    assert cut == pytest.approx([0.0, 10.0, 20.0])


def test_a_pattern_on_a_circle() -> None:
    define = cycle(240, q343=0, q201=-1).replace("CYCL CALL M3\n", "")
    circle = "CYCL DEF 220 POLAR ~\n Q216=+50 ~\n Q217=+40 ~\n Q244=+20 ~\n Q245=+0 ~\n Q246=+360 ~\n"
    ran = ran_of(f"{define}{circle} Q247=+0 ~\n Q241=+4 ~\n Q301=+1")
    assert ran.codes == []
    cut = [block.swivel.end[:2] for block in ran.blocks if block.kind is Kind.FEED and block.swivel]
    assert cut == [pytest.approx(each) for each in ((60, 40), (50, 50), (40, 40), (50, 30))]


def test_a_pattern_in_rows_there_and_back() -> None:
    define = cycle(240, q343=0, q201=-1).replace("CYCL CALL M3\n", "")
    rows = "CYCL DEF 221 ROWS ~\n Q225=+5 ~\n Q226=+6 ~\n Q237=+10 ~\n Q238=+20 ~\n"
    ran = ran_of(f"{define}{rows} Q242=+2 ~\n Q243=+2 ~\n Q224=+0")
    cut = [block.swivel.end[:2] for block in ran.blocks if block.kind is Kind.FEED and block.swivel]
    assert cut == [pytest.approx(each) for each in ((5, 6), (15, 6), (15, 26), (5, 26))]


def test_old_pecking_begins_where_the_tool_stands() -> None:
    """Called 2 above the surface: to 10 deep in infeeds of 6, rapid to .6 before the chips."""
    text = (
        "CYCL DEF 1.0 PECKING\nCYCL DEF 1.1 SET UP 2\nCYCL DEF 1.2 DEPTH -10\nCYCL DEF 1.3 PECKG 6\n"
        "CYCL DEF 1.4 DWELL 0.5\nCYCL DEF 1.5 F80\nL Z+2 FMAX M99"
    )
    assert told(text) == ["R 2", "F -6", "R 2", "R -5.4", "F -10", "rest 0.5", "R 2"]


def test_old_circular_pocket_keeps_inside_its_radius() -> None:
    text = (
        "CYCL DEF 5.0 CIRCLE\nCYCL DEF 5.1 SET UP 2\nCYCL DEF 5.2 DEPTH -6\nCYCL DEF 5.3 PECKG 3 F100\n"
        "CYCL DEF 5.4 RADIUS 20\nCYCL DEF 5.5 F300 DR-\nL Z+2 FMAX M99"
    )
    ran = ran_of(text)
    assert ran.codes == []
    arcs = [block for block in ran.blocks if block.kind is Kind.PLANE_ARC]
    assert max(block.length for block in arcs) == pytest.approx(2 * math.pi * 16.0)
    assert {round(block.swivel.end[2], 6) for block in arcs if block.swivel} == {-3.0, -6.0}


def test_cycle_9_rests_and_cycle_19_tilts() -> None:
    ran = ran_of(
        "CYCL DEF 9.0 DWELL\nCYCL DEF 9.1 V.ZEIT 1.5\nCYCL DEF 19.0 PLANE\nCYCL DEF 19.1 A+45 B+0 C+0"
    )
    assert ran.codes == []
    assert [block.action for block in ran.blocks if isinstance(block.action, Dwell)] == [Dwell(1.5)]
    assert ran.state.q[120] == pytest.approx(45.0)
    assert ran.state.at["A"] == 0.0


DRILL = f"{COMMON}CYCL DEF 240 CENTRE ~\n Q343=+0 ~\n Q201=-1\n"


def test_call_at_a_place_goes_over_it_before_it_goes_down() -> None:
    """From 50 up the place is reached at 50; from below the clearance of 3 the tool goes up first."""
    ran = ran_of(f"{DRILL}CYCL CALL POS X+30 Y+40 Z+0 F2000\nL Z-5 FMAX\nCYCL CALL POS X+0 Y+0 Z+0")
    assert ran.codes == []
    at = [(b.kind, b.swivel.end) for b in ran.blocks if b.moves and b.line > 4 and b.swivel is not None]
    first, low, second = at[0], at[4], at[5:7]
    assert first == (Kind.FEED, pytest.approx((30.0, 40.0, 50.0)))
    assert low[1] == pytest.approx((30.0, 40.0, -5.0))
    assert [place for _, place in second] == [pytest.approx((30, 40, 3)), pytest.approx((0, 0, 3))]


def test_another_cycle_forgets_the_program_that_cycle_12_has_named() -> None:
    ran = ran_of(f"CYCL DEF 12.0 PGM CALL\nCYCL DEF 12.1 PGM HOLE\n{DRILL}L X+0 FMAX M99")
    assert ran.codes == []
    called = ran_of("CYCL DEF 12.0 PGM CALL\nCYCL DEF 12.1 PGM HOLE\nCYCL CALL")
    assert called.codes == ["Program not found"]


@pytest.mark.parametrize(
    ("text", "code"),
    [
        (cycle(207, q201=-8, q239=1.25), "tapping-uncoupled"),
        ("CYCL DEF 247 PRESET ~\n Q339=+2", "preset"),
    ],
)
def test_what_is_not_as_on_the_control_is_warned_of(text: str, code: str) -> None:
    assert ran_of(text).warned == [code]


@pytest.mark.parametrize("text", ["CYCL DEF 32.0 TOLERANCE", "CYCL DEF 13.0 ORIENTATION", "M97", "M120 LA5"])
def test_what_does_nothing_is_told(text: str) -> None:
    ran = ran_of(f"{text}\n{text}")
    assert [each.code for each in ran.diagnostics] == ["unheeded"]


@pytest.mark.parametrize(
    ("text", "code", "names"),
    [
        (f"{DRILL}CYCL CALL POS X+0 Y+0 Z-2", "Input value incorrect", "Q203"),
        ("CYCL CALL POS X+0 Y+0", "Cycle incomplete", "No machining cycle"),
        (cycle(200, q201=5), "Input value incorrect", "upwards"),
        (cycle(200, q202=2), "Cycle incomplete", "Q201"),
        (cycle(200, q201=-5, q206=0), "Input value incorrect", "Q206"),
        (cycle(207, q201=-5, q239=0), "Input value incorrect", "pitch"),
        (cycle(208, q201=-5, q334=1, q335=6), "Input value incorrect", "hole"),
        (cycle(240, q343=1, q201=-1), "Input value incorrect", "point"),
        (cycle(200, q201=-1000, q202=0.01), "Input value incorrect", "too many"),
        ("CYCL DEF 220 POLAR", "Cycle incomplete", "before it"),
        ("CYCL DEF 14.0 CONTOUR", "Not supported", "CYCL DEF 14"),
        ("CYCL DEF", "Syntax error", "number of a cycle"),
        ("CYCL DEF 1.0 PECKING\nL Z+2 FMAX M99", "Cycle incomplete", "1."),
        ("L Z+2 FMAX M99", "Cycle incomplete", "No machining cycle"),
        ("M5\n" + cycle(206, q201=-5).replace(" M3", ""), "Input value incorrect", "spindle"),
    ],
)
def test_refused(text: str, code: str, names: str) -> None:
    ran = ran_of(text)
    assert ran.codes[:1] == [code]
    assert names in ran.errors[0].message + ran.errors[0].hint
