"""Block search in Klartext and SINUMERIK: what follows a restart is what would have followed in the run."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.compose.machine.machine_files import load_named_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.dialects import SharedProgram
from core.interpreter.restart.program_search import RestartLineSearch, _is_uncut, _PassState
from core.interpreter.restart.restart_approach import (
    CurrentMachineState,
    OperatorChoices,
    make_lathe_pass_start,
    make_mill_pass_start,
)
from core.interpreter.restart.restart_point import Interruption, RestartPoint, RestartRejection
from core.interpreter.shared.actions import ProgramStop, SpindleRun, ToolChange
from core.interpreter.shared.checkpoint import Checkpoint, FunctionStep, MultiAxisLeg, PassStart
from core.interpreter.shared.elementary_blocks import Block
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset, ZeroOffset
from core.interpreter.shared.modal_state import ModalState
from core.language.source import ProgramSource
from core.tool_edges import make_edge_row_number
from tests.texts import text

PLATE = """\
0 BEGIN PGM PLATE MM
1 TOOL CALL 5 Z S3000 F400
2 L X+0 Y+0 Z+50 R0 FMAX M3
3 Q1 = 0
4 LBL 1
5 Q1 = Q1 + 10
6 L X+Q1 Y+5 FMAX
7 L Z+2 FMAX M8
8 L Z-3 F200
9 L Y+20 F400
10 L Z+50 FMAX M9
11 CALL LBL 1 REP2
12 TOOL CALL 6 Z S1500
13 L X+40 Y+40 Z+50 R0 FMAX M3
14 CYCL DEF 200 Q200=+2 Q201=-10 Q206=+150 Q202=+5 Q210=+0 Q203=+0 Q204=+50 Q211=+0
15 CYCL CALL
16 PLANE AXIAL A+20 C+0 TURN MB MAX FMAX
17 L X+10 Y+10 Z+30 FMAX
18 L Z+1 F300
19 L X+20 RL F200
20 L Y+30
21 L X+10 R0
22 L Z+60 FMAX
23 PLANE RESET TURN MB MAX FMAX
24 END PGM PLATE MM
"""
RING = """\
0 BEGIN PGM RING MM
1 TOOL CALL 5 Z S3000 F400
2 L X+0 Y+0 Z+50 R0 FMAX M3
3 L X+20 Y+0 FMAX
4 L Z+2 FMAX
5 L Z-3 F200
6 CC X+0 Y+0
7 C X+20 Y+0 DR+ F400
8 L Z+50 FMAX
9 L X+40 FMAX
10 M30
11 END PGM RING MM
"""
TURNED = """\
G18 G71 G90 G54 DIAMON
G94 S800 M3
G0 X60 Z5
R1=50
WHILE R1>40
X=R1
G1 Z-20 F100
G0 X70
Z5
R1=R1-4
ENDWHILE
G0 X100 Z50
M30
"""
TOOLS = {5: ToolOffset(z=80.0, nose_radius=6.0), 6: ToolOffset(z=95.0, nose_radius=4.0)}


def mill(program: str = PLATE) -> tuple[SharedProgram, InterpreterSetup]:
    return SharedProgram(ProgramSource("plate.h", program)), create_power_up_setup(
        load_named_machine("ac-table-mill"), tool_offsets=TOOLS, secondary_offsets={}
    )


def lathe(program: str = TURNED) -> tuple[SharedProgram, InterpreterSetup]:
    machine = load_named_machine("sinumerik-modulo")
    zero = {54: ZeroOffset(z=-300.0)}
    return SharedProgram(ProgramSource("shaft.mpf", program)), create_power_up_setup(
        machine, tool_offsets={}, secondary_offsets={}, zero_offsets=zero
    )


def searched(
    of: tuple[SharedProgram, InterpreterSetup], line: int, visit: int = 0, broken: Interruption | None = None
) -> RestartPoint | RestartRejection:
    reading, setup = of
    return RestartLineSearch(reading, setup, lambda _count: None).find_restart_point(line, visit, broken)


def refused(
    of: tuple[SharedProgram, InterpreterSetup], line: int, broken: Interruption | None = None
) -> RestartRejection:
    found = searched(of, line, broken=broken)
    assert isinstance(found, RestartRejection)
    return found


def good(of: tuple[SharedProgram, InterpreterSetup], line: int, visit: int = 0) -> RestartPoint:
    found = searched(of, line, visit)
    assert isinstance(found, RestartPoint), found
    return found


def told(block: Block) -> tuple[object, ...]:
    at = tuple(round(each, 9) for each in block.machine_end)
    return (
        block.n,
        block.line,
        block.kind,
        at,
        round(block.feed, 9),
        block.rpm,
        block.action,
        block.modal.tool,
    )


def whole(of: tuple[SharedProgram, InterpreterSetup]) -> list[Block]:
    return list(of[0].start_pass(of[1]).generate_blocks(stops_at_first_error=True))


def restarted(
    of: tuple[SharedProgram, InterpreterSetup], begin: PassStart, start: tuple[float, ...]
) -> list[Block]:
    run = of[0].start_pass(replace(of[1], start=start, begin=begin))
    blocks = list(run.generate_blocks(stops_at_first_error=True))
    assert not run.has_errors, run.diagnostics
    return blocks


STANDS = (-50.0, 30.0, -420.0, 0.0, 0.0)


def mill_begin(
    of: tuple[SharedProgram, InterpreterSetup], found: RestartPoint, now: CurrentMachineState | None = None
) -> PassStart:
    assert of[1].kinematics is not None
    return make_mill_pass_start(
        found, now or CurrentMachineState(STANDS, ModalState()), OperatorChoices(), of[1].kinematics
    )


# --- what follows ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "visit"),
    [
        (4, 0),
        (7, 1),
        (7, 2),
        (7, 3),
        (9, 2),
        (10, 3),
        (13, 0),
        (14, 0),
        (16, 0),
        (17, 0),
        (18, 0),
        (19, 0),
        (23, 0),
    ],
)
def test_mill_restart_continues_as_the_original_run(line: int, visit: int) -> None:
    of = mill()
    found = good(of, line, visit)
    begin = mill_begin(of, found)
    blocks, made = restarted(of, begin, STANDS), found.checkpoint.blocks
    assert blocks[len(begin.approach_steps) - 1].n == made
    rest = [told(each) for each in blocks[len(begin.approach_steps) :]]
    assert rest == [told(each) for each in whole(of) if each.n > made]
    assert rest


@pytest.mark.parametrize(("line", "visit"), [(4, 0), (6, 1), (6, 3), (9, 2), (12, 0)])
def test_lathe_restart_continues_as_the_original_run(line: int, visit: int) -> None:
    of = lathe()
    found = good(of, line, visit)
    now = CurrentMachineState((150.0, 100.0, 0.0), ModalState())
    begin = make_lathe_pass_start(found, now, OperatorChoices())
    blocks, made = restarted(of, begin, now.axis_positions), found.checkpoint.blocks
    rest = [told(each) for each in blocks[len(begin.approach_steps) :]]
    assert rest == [told(each) for each in whole(of) if each.n > made]


def test_the_passes_of_a_loop_are_counted() -> None:
    assert good(mill(), 7, 2).visit == (2, 3, ())
    assert good(lathe(), 6, 2).visit == (2, 3, ())


def test_interrupted_pass_is_the_default() -> None:
    second = [each for each in whole(mill()) if each.line == 10][1]
    broken = Interruption(second.n, 5, STANDS, second.n)
    found = searched(mill(), 9, broken=broken)
    assert isinstance(found, RestartPoint)
    assert found.visit.visit_number == 2


# --- the way --------------------------------------------------------------------------------------------


def test_mill_retracts_along_the_tool_repositions_and_feeds_in_last() -> None:
    of = mill()
    turned = CurrentMachineState((-50.0, 30.0, -420.0, 15.0, 200.0), ModalState())
    begin = mill_begin(of, good(of, 19), turned)
    legs = [step for step in begin.approach_steps if isinstance(step, MultiAxisLeg)]
    assert [leg.text for leg in legs] == ["Z", "Z", "A C", "X Y", "Z", "Z"]
    assert dict(legs[1].target_positions)["Z"] == pytest.approx(-0.01)  # the top of its travel
    assert dict(legs[2].target_positions) == pytest.approx({"A": 20.0, "C": 0.0})
    assert legs[-1].feed is not None
    assert all(leg.feed is None for leg in legs[1:-1])


def test_other_tool_is_requested_at_the_top_before_the_spindle_starts() -> None:
    of = mill()
    begin = mill_begin(
        of, good(of, 15), CurrentMachineState(STANDS, ModalState(tool=5, spindle=1, rpm=3000.0))
    )
    actions = [step.action for step in begin.approach_steps if isinstance(step, FunctionStep)]
    assert actions[1:] == [ToolChange(6), ProgramStop(optional=False, message="TOOL 6"), SpindleRun(1500.0)]


def test_axis_that_never_moved_is_not_moved() -> None:
    found = good(mill(), 10, 1)
    assert found.axis_positions[3:] == (None, None)
    goals = [
        dict(step.target_positions)
        for step in mill_begin(mill(), found).approach_steps
        if isinstance(step, MultiAxisLeg)
    ]
    assert not any("A" in goal or "C" in goal for goal in goals)


# --- refusals -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("line", "why"),
    [
        (0, "Line 0 does not exist"),
        (99, "Line 99 does not exist"),
        (3, "no axis has moved"),
        (21, "radius compensation is active"),
    ],
)
def test_invalid_mill_lines_are_rejected(line: int, why: str) -> None:
    of = mill()
    if line == 3:
        of = mill("0 BEGIN PGM A MM\n1 TOOL CALL 5 Z S99\n2 Q1 = 3\n3 L X+Q1 Y+0 Z+9 FMAX\n4 END PGM A MM\n")
    assert why in refused(of, line).why


def test_line_that_depends_on_the_start_position_is_rejected() -> None:
    text = (
        "0 BEGIN PGM A MM\n1 TOOL CALL 5 Z S99\n2 L IX+5 FMAX\n3 L Y+3 FMAX\n4 L Z+9 FMAX\n5 END PGM A MM\n"
    )
    assert (
        "the position of X at this line depends on its position at Cycle Start" in refused(mill(text), 5).why
    )


def test_line_in_uncut_material_is_rejected_and_one_above_it_warns() -> None:
    of = mill()
    first = next(each for each in whole(of) if each.line == 9)  # the plunge of the first pass
    assert first.travel is not None
    broken = Interruption(first.n, 5, first.travel.end, first.n)
    reading, setup = of
    search = RestartLineSearch(reading, setup, lambda _count: None)
    found = search.find_restart_point(10, 2, broken)
    assert isinstance(found, RestartRejection)
    assert found.why == text(
        "search.in-uncut-material", line=10, uncut=text("search.uncut-lines", first=9, last=10)
    )
    above = search.find_restart_point(7, 2, broken)
    assert isinstance(above, RestartPoint)
    assert above.skipped_lines == (10, 10)
    half_cut = search.find_restart_point(7, 2, broken._replace(machine_position=STANDS))
    assert isinstance(half_cut, RestartPoint)
    assert half_cut.skipped_lines == (9, 10)


def test_interrupted_full_circle_counts_as_uncut() -> None:
    of = mill(RING)
    circle = next(each for each in whole(of) if each.line == 8)
    assert circle.travel is not None
    found = searched(of, 10, broken=Interruption(circle.n, 5, circle.travel.end, circle.n))
    assert isinstance(found, RestartRejection)
    assert found.nearest_line_before == 8


@pytest.mark.parametrize("turn", [360.0, 720.0])
def test_interrupted_full_revolutions_count_as_uncut(turn: float) -> None:
    block = next(each for each in whole(mill(RING)) if each.line == 8)
    assert block.travel is not None
    start = (*block.travel.start[:3], 0.0, 0.0)
    end = (*block.travel.start[:3], 0.0, turn)
    travel = replace(block.travel, start=start, end=end, length=turn, curved_move=None)
    turned = block._replace(travel=travel) if hasattr(block, "_replace") else replace(block, travel=travel)
    assert _is_uncut(turned, Interruption(block.n, 5, start, block.n))


def test_lathe_restart_ignores_the_height_of_skipped_cuts() -> None:
    """Broken off in the cut of line 3; searched for is the line behind that of line 5."""
    of = lathe("G54 G90 G94 G71 DIAMON\nG0 X60 Z5\nG1 Z-20 F100\nG0 X70\nG1 Z-30 F100\nG0 X80\nZ5\nM30\n")
    cut = next(each for each in whole(of) if each.line == 3)
    found = searched(of, 7, broken=Interruption(cut.n, 1, (30.0, -10.0, 0.0), cut.n))
    assert isinstance(found, RestartPoint), found
    assert (found.line_number, found.checkpoint.x, found.checkpoint.z) == (7, 40.0, -30.0)


def test_comments_and_lines_after_the_end_have_separate_messages() -> None:
    text = PLATE.replace("3 Q1 = 0\n", "; a remark\n3 Q1 = 0\n")
    assert "a comment" in refused(mill(text), 4).why
    assert "The program ends on line 13, before line 14." in refused(lathe(TURNED + "G0 X1\n"), 14).why


def test_refusal_names_the_nearest_valid_lines() -> None:
    found = refused(mill(), 21)
    assert (found.nearest_line_before, found.nearest_line_after) == (20, 23)


def test_suggested_line_is_valid() -> None:
    """Outwards from the middle: the cuts of both lines lie in the work, with no way out of it."""
    of = lathe("G54 G90 G94 G71 DIAMON\nT1 D1\nG0 X0 Z1\nG1 Z-1 F600\nX6 F60\nZ1 F600\nM30\n")
    for line in (4, 5):
        found = refused(of, line)
        for each in (found.nearest_line_before, found.nearest_line_after):
            assert not each or good(of, each)


def test_outdated_search_is_canceled() -> None:
    class GivenUpError(Exception):
        pass

    def watch(_share: float) -> None:
        raise GivenUpError

    long = "G90 G54 G0 X10 Z10\n" + "G0 X20\nG0 X21\n" * 2000 + "M30\n"
    with pytest.raises(GivenUpError):
        RestartLineSearch(*lathe(long), watch).find_restart_point(3)


CONTOUR = """\
G18 G90 G54 DIAMON G94
T1 D2
S800 M3
G0 X60 Z5
G42 G1 X20 Z0 F100
Z-20
X40
G40 G0 X60 Z5
X62
M30
"""


def edged(program: str = CONTOUR) -> tuple[SharedProgram, InterpreterSetup]:
    reading, around = lathe(program)
    tools = {1: ToolOffset(30.0, 40.0, 0.8, 3), make_edge_row_number(1, 2): ToolOffset(31.0, 38.0, 0.4, 3)}
    return reading, replace(around, tools=tools)


@pytest.mark.parametrize("line", [6, 7, 8])
def test_line_within_a_g42_contour_is_rejected(line: int) -> None:
    assert "part of a G41 or G42 contour" in refused(edged(), line).why


@pytest.mark.parametrize("line", [5, 9])
def test_restart_on_the_next_pass_retains_cutting_edge_and_nose_radius(line: int) -> None:
    of = edged()
    found = good(of, line)
    begin = make_lathe_pass_start(
        found, CurrentMachineState((50.0, 60.0, 0.0), found.checkpoint.modal), OperatorChoices()
    )
    behind = [told(block) for block in restarted(of, begin, (50.0, 60.0, 0.0))]
    run = [told(block) for block in whole(of) if block.line >= line]
    assert [each[1:] for each in behind[-len(run) :]] == [each[1:] for each in run]


FLATS = """\
G18 G90 G54 DIAMOF G94
T1 D1
G0 X30 Z5
SPOS=0
S2=2000 M2=3
G17
TRANSMIT
G0 X25 Y-12
Z2
G1 Z-3 F300
Y12
G0 Z2
X-25
G1 X-20 RND=3 F200
Y-12
G0 Z5
TRAFOOF
M2=5
M30
"""


def milled(program: str = FLATS) -> tuple[SharedProgram, InterpreterSetup]:
    setup = create_power_up_setup(
        load_named_machine("sinumerik-live"),
        tool_offsets={1: ToolOffset(10.0, 20.0, 4.0)},
        secondary_offsets={},
    )
    return SharedProgram(ProgramSource("flats.mpf", program)), setup


@pytest.mark.parametrize("line", [9, 10, 12, 13, 14, 16])
def test_transmit_restart_turns_the_part_to_the_original_angle(line: int) -> None:
    """X, Z and C are where they would have been; C counts whole turns from where the part stands now."""
    of = milled()
    found = good(of, line)
    now = CurrentMachineState((150.0, 100.0, 725.0), ModalState())
    begin = make_lathe_pass_start(found, now, OperatorChoices())
    blocks = restarted(of, begin, now.axis_positions)[len(begin.approach_steps) :]
    run = [each for each in whole(of) if each.n > found.checkpoint.blocks]
    assert [told(each)[:3] for each in blocks] == [told(each)[:3] for each in run]
    for have, want in zip(blocks, run, strict=True):
        (x, z, c), (run_x, run_z, run_c) = have.machine_end, want.machine_end
        assert (x, z) == pytest.approx((run_x, run_z))
        assert (c - run_c + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=1e-7)
        assert abs(c - 725.0) < 360.0


def test_live_tool_and_locked_spindle_are_set_before_the_line() -> None:
    begin = make_lathe_pass_start(
        good(milled(), 10), CurrentMachineState((150.0, 100.0, 0.0), ModalState()), OperatorChoices()
    )
    told_of = [step.text for step in begin.approach_steps if isinstance(step, FunctionStep)]
    assert told_of == ["M89", "LIVE ON"]


HELD = """\
G18 G71 G90 G54 DIAMON G94
S800 M3
G0 X60 Z5
SPOS=90
G1 Z-20 F100
G0 Z5
M5
G1 Z-10 F100
M30
"""


@pytest.mark.parametrize(("line", "told_of"), [(5, ["M19 90"]), (6, ["M19 90"]), (8, [])])
def test_oriented_spindle_is_restored_to_its_angle(line: int, told_of: list[str]) -> None:
    of = lathe(HELD)
    found = good(of, line)
    now = CurrentMachineState((150.0, 100.0, 0.0), ModalState())
    begin = make_lathe_pass_start(found, now, OperatorChoices())
    assert [step.text for step in begin.approach_steps if isinstance(step, FunctionStep)] == told_of
    behind = [told(block) for block in restarted(of, begin, now.axis_positions)][len(begin.approach_steps) :]
    assert behind == [told(block) for block in whole(of) if block.n > found.checkpoint.blocks]


def test_line_on_a_corner_in_transmit_is_rejected() -> None:
    assert "part of a corner or a contour in TRANSMIT" in refused(milled(), 15).why


def test_deleted_block_is_rejected() -> None:
    reading, setup = milled(FLATS.replace("Z2\nG1", "/Z2\nG1"))
    deleted = refused((reading, replace(setup, block_delete=True)), 9)
    assert deleted.why == text("search.never-reached", line=9)
    assert good((reading, setup), 9).line_number == 9


@pytest.mark.parametrize(
    ("cutting", "turned", "good"), [(False, False, True), (True, False, False), (False, True, False)]
)
def test_only_a_rapid_with_a_fixed_table_is_above_skipped_cuts(
    cutting: bool, turned: bool, good: bool
) -> None:
    """Tip at 60 - 20 = 40 mm, the highest cut begins at 30."""
    stand = _PassState(is_cutting=cutting, moves_rotary_axes=turned, tool_length_mm=20.0, max_skipped_z=30.0)
    assert stand.is_above_skipped_cuts(Checkpoint(ModalState(), at=(0.0, 0.0, 60.0))) is good
    assert not stand.is_above_skipped_cuts(Checkpoint(ModalState(), at=(0.0, 0.0, 49.0)))
