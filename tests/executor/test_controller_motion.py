"""Blocks in pieces for a controller that plans by itself: on their own line or circle, each short in time."""

from __future__ import annotations

import cmath
import math

import pytest

from core.block_ports import ArcOperation, BlockOperation, LineOperation, RapidOperation, ThreadOperation
from core.executor.job import ProgramPass, ReadAheadQueue
from core.executor.program_motion.controller_motion import (
    MAX_PART_DURATION_S,
    ControllerMotion,
    SpindleSpeed,
    split_block,
)
from core.executor.program_motion.path_section import SectionProgress
from core.executor.raised_alarm import AlarmError
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.machine_requirements import list_requirements, remove_repeated_requirements
from core.interpreter.shared.modal_state import ModalState
from tests.coded import raises_code
from tests.executor.played_controller import PlayedController, context_of, turn_feed_pot
from tests.texts import text

FULL = SpindleSpeed(1.0, 3500.0)


def block(kind: BlockKind, **words: object) -> Block:
    """From X 0, Z 0 of a frame that lies at X 1, Z 2 of the machine."""
    values: dict[str, object] = {
        **{"x0": 0.0, "z0": 0.0, "c0": 0.0, "x": 0.0, "z": 0.0, "c": 0.0, "offset_x": 1.0, "offset_z": 2.0},
        **{"n": 1, "line": 7, "text": "", "modal": ModalState(), "feed": 10.0, "kind": kind},
    }
    return Block(**{**values, **words})  # type: ignore[arg-type]


def test_line_is_split_into_pieces_of_200_ms() -> None:
    pieces = list(split_block(block(BlockKind.FEED, x=3.0, z=-4.0), FULL))  # 5 mm at 10 mm/s
    assert [piece.min_duration_s for piece in pieces] == pytest.approx([0.5 / 3] * 3)
    ops = [piece.operation for piece in pieces]
    assert all(isinstance(op, LineOperation) for op in ops)
    assert [(op.x, op.z) for op in ops] == [
        pytest.approx((2.0, 2.0 - 4.0 / 3)),
        pytest.approx((3.0, 2.0 - 8.0 / 3)),
        (4.0, -2.0),  # exactly the end of the block
    ]


def test_an_arc_stays_on_its_circle_and_ends_exactly() -> None:
    arc = block(BlockKind.ARC, x=10.0, z=-10.0, cx=10.0, cz=0.0, feed=20.0)  # a quarter of 15.7 mm, 0.79 s
    ops = [piece.operation for piece in split_block(arc, FULL)]
    assert len(ops) == 4
    before = (1.0, 2.0)
    for op in ops:
        assert isinstance(op, ArcOperation)
        assert (op.start_x, op.start_z) == before
        assert math.hypot(op.x - op.center_x, op.z - op.center_z) == pytest.approx(10.0)
        assert (op.center_x, op.center_z, op.is_clockwise) == (11.0, 2.0, False)
        before = (op.x, op.z)
    assert before == (11.0, -8.0)


def test_slow_controller_gets_shorter_pieces() -> None:
    rapid = block(BlockKind.RAPID, z=-100.0, feed=127.0)
    assert len(list(split_block(rapid, FULL))) == 4
    slow = list(split_block(rapid, FULL, lambda _: 10.0))
    assert len(slow) == 50
    assert all(piece.min_duration_s <= MAX_PART_DURATION_S + 1e-9 for piece in slow)
    assert isinstance(slow[0].operation, RapidOperation)


def test_thread_is_sent_as_one_piece() -> None:
    (piece,) = split_block(block(BlockKind.THREAD, z=-100.0, feed=1.5, per_rev=True, rpm=600.0), FULL)
    assert piece.operation == ThreadOperation(1.0, 2.0, 1.0, -98.0, 1.5)


def test_arc_is_split_into_pieces_below_half_a_revolution() -> None:
    """Three quarters of a turn about Z 0.1, 5 ms long: from behind the centre to X+ of it, by X-."""
    quick = block(BlockKind.ARC, x=0.1, z=0.1, cx=0.0, cz=0.1, clockwise=True, feed=100.0)
    ops = [piece.operation for piece in split_block(quick, FULL)]
    assert len(ops) == 2
    for op in ops:
        assert isinstance(op, ArcOperation)
        start, end = (
            complex(op.start_z - op.center_z, op.start_x - op.center_x),
            complex(op.z - op.center_z, op.x - op.center_x),
        )
        assert cmath.phase(end / start) == pytest.approx(3 * math.pi / 4)


def test_feed_per_rev_follows_commanded_speed_override_and_limit() -> None:
    cut = block(BlockKind.FEED, z=-0.1, feed=0.1, per_rev=True, rpm=-1200.0)
    (piece,) = split_block(cut, SpindleSpeed(0.5, 3500.0))
    assert isinstance(piece.operation, LineOperation)
    assert piece.operation.feed == pytest.approx(0.1 * 1200 / 60 * 0.5)
    (piece,) = split_block(cut, SpindleSpeed(1.0, 600.0))
    assert isinstance(piece.operation, LineOperation)
    assert piece.operation.feed == pytest.approx(0.1 * 600 / 60)


def test_css_on_an_arc_uses_the_part_radius_not_the_machine_x() -> None:
    """400π mm/s at a radius of 20 mm are 10 turns a second; at the machine's X of 21 they would be 9.5."""
    at = {"x0": 10.0, "x": 20.0, "z": -10.0, "cx": 20.0, "feed": 0.1, "per_rev": True, "rpm": 600.0}
    arc = block(BlockKind.ARC, cz=0.0, css=400 * math.pi, modal=ModalState(min_css_rpm=0.0), **at)
    *_, last = split_block(arc, FULL)
    assert isinstance(last.operation, ArcOperation)
    assert (last.operation.x, last.operation.feed) == pytest.approx((21.0, 1.0))


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ({"c": 90.0}, text("executor.controller-x-z")),
        ({"x": 1.0, "feed": 0.0}, text("executor.line-no-feed", line=7)),
    ],
)
def test_unsupported_block_is_rejected(words: dict[str, object], expected: str) -> None:
    with raises_code(AlarmError, "program", expected):
        list(split_block(block(BlockKind.FEED, **words), FULL))


def test_requirements_are_listed_once_with_their_first_line() -> None:
    blocks = [
        block(BlockKind.ARC, x=1.0, z=-1.0, cx=1.0, line=3),
        block(BlockKind.ARC, x=1.0, z=-1.0, cx=1.0, line=4),
        block(BlockKind.THREAD, z=-1.0, line=5),
        block(BlockKind.THREAD, z=-1.0, line=6),
        block(BlockKind.FEED, z=-1.0, css=100.0, rpm=500.0, line=7),
    ]
    needs = remove_repeated_requirements(list_requirements(blocks))
    assert [(need.required_function, need.first_line) for need in needs] == [
        ("arc", 3),
        ("thread", 5),
        ("pull-out", 6),
        ("surface-speed", 7),
    ]


# --- handed over, piece by piece ----------------------------------------------------------------------------


PULL_OUT = block(BlockKind.RAPID, n=2, z0=-9.0, x=5.0, z=-9.0, feed=40.0)
THREAD = block(BlockKind.THREAD, z=-9.0, feed=1.5, per_rev=True, rpm=600.0)
CUT = block(BlockKind.FEED, x=3.0, z=-4.0)  # 5 mm at 10 mm/s: three pieces of a sixth of a second
NEXT = block(BlockKind.FEED, n=2, x0=3.0, z0=-4.0, x=3.0, z=-5.0, line=8)  # 1 mm, a tenth of a second: one


def motion_of(
    controller: PlayedController, *blocks: Block, feed: float = 1.0, single: bool = False
) -> ControllerMotion:
    """A path section that has begun."""
    context = context_of(controller)
    turn_feed_pot(context, feed)
    context.switches.single_block = single
    motion = ControllerMotion(context, controller)
    motion.start_path_section(list(blocks))
    return motion


def nothing_read() -> ReadAheadQueue:
    return ReadAheadQueue(ProgramPass(iter(()), list), context_of(None).machine)


def ends(ops: list[BlockOperation]) -> list[float]:
    return [op.z for op in ops]


def test_clear_without_a_path_section_sends_no_command() -> None:
    controller = PlayedController()
    motion = ControllerMotion(context_of(controller), controller)
    assert motion.update_progress(nothing_read()) is SectionProgress.DONE
    assert (motion.current_block, motion.following_block, motion.is_moving) == (None, None, False)
    motion.clear_path_section()
    assert controller.asked == []


def test_full_controller_gets_the_remaining_pieces_later() -> None:
    controller = PlayedController(room=1)
    motion = motion_of(controller, CUT)
    assert ends(controller.ops) == [pytest.approx(2 - 4 / 3)]
    controller.room = 9
    assert motion.update_progress(nothing_read()) is SectionProgress.MOVING
    assert ends(controller.ops) == pytest.approx([2 - 4 / 3, 2 - 8 / 3, -2.0])
    controller.finish()
    assert motion.update_progress(nothing_read()) is SectionProgress.DONE


@pytest.mark.parametrize(("ahead", "feed", "pieces"), [(0.1, 1.0, 2), (0.3, 1.0, 3), (0.3, 0.5, 2)])
def test_controller_gets_no_more_pieces_than_its_maximum_lead(ahead: float, feed: float, pieces: int) -> None:
    """Behind the piece that it moves: none, a sixth, two sixths of a second; twice that at half the feed."""
    controller = PlayedController(max_queued_motion_s=ahead)
    motion_of(controller, CUT, feed=feed)
    assert len(controller.ops) == pieces


def test_no_piece_is_sent_at_zero_override_until_it_is_raised() -> None:
    controller = PlayedController()
    context = context_of(controller)
    turn_feed_pot(context, 0.0)
    motion = ControllerMotion(context, controller)
    motion.start_path_section([CUT])
    assert (controller.asked, controller.ops) == (["hold"], [])
    assert motion.update_progress(nothing_read()) is SectionProgress.AT_REST
    motion.resume(None)
    assert (controller.asked, controller.ops) == (["hold"], [])
    turn_feed_pot(context, 1.0)
    motion.update_progress(nothing_read())
    assert controller.asked == ["hold", "resume"]
    assert len(controller.ops) == 3


def test_thread_ignores_zero_override() -> None:
    controller = PlayedController()
    motion_of(controller, THREAD, PULL_OUT, feed=0.0)
    assert controller.asked == []
    assert isinstance(controller.ops[0], ThreadOperation)


def test_hold_started_by_the_controller_is_reported() -> None:
    controller = PlayedController()
    motion = motion_of(controller, CUT)
    controller.held = True
    assert motion.update_progress(nothing_read()) is SectionProgress.IN_FEED_HOLD
    assert not motion.is_moving
    motion.resume(None)
    assert controller.asked == ["resume"]


def test_hold_stops_a_line_but_lets_a_thread_finish() -> None:
    controller = PlayedController(room=1)
    line = motion_of(controller, CUT)
    controller.room = 9
    line.stop_on_path()
    line.extend_queue()
    assert (controller.asked, len(controller.ops)) == (["hold"], 1)
    controller = PlayedController(room=1)
    thread = motion_of(controller, THREAD, PULL_OUT)
    controller.room = 2
    thread.stop_on_path()
    thread.extend_queue()
    assert controller.asked == []
    assert controller.ops[1:] == [RapidOperation(6.0, -7.0, 40.0)]


@pytest.mark.parametrize("hindrance", ["", "the controller is being reset"])
def test_thread_without_spindle_retracts_x_or_reports_why_not(hindrance: str) -> None:
    """From where the slides stand, home, to the X at which the pull-out would have ended."""
    controller = PlayedController(hindrance=hindrance)
    motion = motion_of(controller, THREAD, PULL_OUT)
    controller.ops.clear()
    motion.start_retract(THREAD)
    assert controller.asked == ["abort"]
    if hindrance:
        with raises_code(AlarmError, "thread-lost"):
            motion.continue_retract()
        return
    motion.continue_retract()
    assert controller.ops == [RapidOperation(6.0, 0.0, THREAD.modal.rapid_rate)]


def test_clearing_the_section_aborts_the_controller_motion() -> None:
    controller = PlayedController()
    motion = motion_of(controller, CUT)
    motion.clear_path_section()
    assert controller.asked == ["abort"]
    assert not motion.has_path_section
    assert motion.is_complete


def test_single_block_sends_one_block_and_the_next_on_resume() -> None:
    controller = PlayedController()
    motion = motion_of(controller, CUT, NEXT, single=True)
    assert len(controller.ops) == 3
    controller.finish()
    assert motion.update_progress(nothing_read()) is SectionProgress.BLOCK_END
    assert (motion.current_block, motion.following_block) == (CUT, NEXT)
    motion.resume(None)
    assert ends(controller.ops)[3:] == [-3.0]


def test_single_block_set_in_motion_stops_after_the_sent_blocks() -> None:
    controller = PlayedController(room=3)
    context = context_of(controller)
    motion = ControllerMotion(context, controller)
    motion.start_path_section([CUT, NEXT])
    context.switches.single_block, controller.room = True, 9
    motion.update_progress(nothing_read())
    assert len(controller.ops) == 3


def test_blocks_read_meanwhile_are_sent_after_the_pending_ones() -> None:
    controller = PlayedController()
    motion = motion_of(controller, CUT)
    feed = ReadAheadQueue(ProgramPass(iter([NEXT]), list), context_of(None).machine)
    feed.pending_blocks.append(NEXT)
    motion.update_progress(feed)
    assert not feed.pending_blocks
    assert ends(controller.ops)[3:] == [-3.0]


def test_motion_does_not_resume_automatically_after_the_host_was_away() -> None:
    controller = PlayedController(room=1)
    context = context_of(controller)
    motion = ControllerMotion(context, controller)
    motion.start_path_section([CUT])
    assert motion.starvation_time_s == math.inf
    context.now += 1.1
    controller.room = 9
    motion.update_progress(nothing_read())
    assert motion.starvation_time_s == -math.inf
    assert len(controller.ops) == 1


def test_arc_feed_is_limited_by_acceleration() -> None:
    """Radius .1 mm: the square root of .8 of 3048 mm/s² times .1 mm is 15.6154 mm/s."""
    controller = PlayedController()
    motion_of(controller, block(BlockKind.ARC, x=0.1, z=-0.1, cx=0.1, cz=0.0, feed=20.0))
    assert {round(op.feed, 4) for op in controller.ops if isinstance(op, ArcOperation)} == {15.6154}
    controller = PlayedController(fast=3.0)
    motion_of(controller, block(BlockKind.ARC, x=0.1, z=-0.1, cx=0.1, cz=0.0, feed=20.0))
    assert {op.feed for op in controller.ops if isinstance(op, ArcOperation)} == {3.0}


# --- constant surface speed of a spindle whose steps count from its last S ----------------------------------


def surface(n: int = 1, rpm: float = 600.0) -> Block:
    """At radius 10, 200π mm/s: ten turns a second, of .1 mm."""
    at = {"x0": 10.0, "x": 10.0, "z": -0.1, "feed": 0.1, "per_rev": True, "css": 200 * math.pi}
    return block(BlockKind.FEED, n=n, rpm=rpm, modal=ModalState(min_css_rpm=0.0), **at)


@pytest.mark.parametrize(("reach", "feed"), [(2000.0, 1.0), (300.0, 0.5)])
def test_motion_waits_until_the_spindle_is_set_up_for_css(reach: float, feed: float) -> None:
    """Seen in four looks, of which the start is the first; then by the speed that the spindle comes to."""
    controller = PlayedController(css_max_rpm=0.0)
    motion = motion_of(controller, surface())
    motion.update_progress(nothing_read())
    motion.update_progress(nothing_read())
    assert controller.ops == []
    motion.update_progress(nothing_read())
    assert controller.ops == []  # looked at often enough, but not laid out
    controller.css_max_rpm = reach
    motion.update_progress(nothing_read())
    (op,) = controller.ops
    assert isinstance(op, LineOperation)
    assert op.feed == pytest.approx(feed)


def test_css_is_not_set_up_until_previous_motion_is_at_rest() -> None:
    controller = PlayedController(css_max_rpm=2000.0)
    motion = motion_of(controller, CUT, surface(2))
    for _ in range(6):
        motion.update_progress(nothing_read())
    assert len(controller.ops) == 3
    controller.finish()
    for _ in range(4):
        assert len(controller.ops) == 3
        motion.update_progress(nothing_read())
    assert len(controller.ops) == 4
