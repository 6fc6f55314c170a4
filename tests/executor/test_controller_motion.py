"""Blocks in pieces for a controller that plans by itself: on their own line or circle, each short in time."""

from __future__ import annotations

import cmath
import math

import pytest

from core.executor.controller_motion import LONGEST, Turning, parts_of
from core.executor.raised_alarm import AlarmError
from core.interpreter.elementary_blocks import Block, Kind
from core.interpreter.machine_requirements import first_needs, needs_of
from core.interpreter.modal_state import Modal
from core.ports import ArcOp, LineOp, RapidOp, ThreadOp

FULL = Turning(1.0, 3500.0)


def block(kind: Kind, **words: object) -> Block:
    """From X 0, Z 0 of a frame that lies at X 1, Z 2 of the machine."""
    values: dict[str, object] = {
        **{"x0": 0.0, "z0": 0.0, "c0": 0.0, "x": 0.0, "z": 0.0, "c": 0.0, "offset_x": 1.0, "offset_z": 2.0},
        **{"n": 1, "line": 7, "text": "", "modal": Modal(), "feed": 10.0, "kind": kind},
    }
    return Block(**{**values, **words})  # type: ignore[arg-type]


def test_a_line_goes_out_in_pieces_of_a_fifth_of_a_second() -> None:
    pieces = list(parts_of(block(Kind.FEED, x=3.0, z=-4.0), FULL))  # 5 mm at 10 mm/s
    assert [piece.seconds for piece in pieces] == pytest.approx([0.5 / 3] * 3)
    ops = [piece.op for piece in pieces]
    assert all(isinstance(op, LineOp) for op in ops)
    assert [(op.x, op.z) for op in ops] == [
        pytest.approx((2.0, 2.0 - 4.0 / 3)),
        pytest.approx((3.0, 2.0 - 8.0 / 3)),
        (4.0, -2.0),  # exactly the end of the block
    ]


def test_an_arc_stays_on_its_circle_and_ends_exactly() -> None:
    arc = block(Kind.ARC, x=10.0, z=-10.0, cx=10.0, cz=0.0, feed=20.0)  # a quarter of 15.7 mm, 0.79 s
    ops = [piece.op for piece in parts_of(arc, FULL)]
    assert len(ops) == 4
    before = (1.0, 2.0)
    for op in ops:
        assert isinstance(op, ArcOp)
        assert (op.x0, op.z0) == before
        assert math.hypot(op.x - op.cx, op.z - op.cz) == pytest.approx(10.0)
        assert (op.cx, op.cz, op.clockwise) == (11.0, 2.0, False)
        before = (op.x, op.z)
    assert before == (11.0, -8.0)


def test_a_slow_controller_makes_the_pieces_shorter() -> None:
    rapid = block(Kind.RAPID, z=-100.0, feed=127.0)
    assert len(list(parts_of(rapid, FULL))) == 4
    slow = list(parts_of(rapid, FULL, lambda _: 10.0))
    assert len(slow) == 50
    assert all(piece.seconds <= LONGEST + 1e-9 for piece in slow)
    assert isinstance(slow[0].op, RapidOp)


def test_a_thread_is_one_piece() -> None:
    (piece,) = parts_of(block(Kind.THREAD, z=-100.0, feed=1.5, per_rev=True, rpm=600.0), FULL)
    assert piece.op == ThreadOp(1.0, 2.0, 1.0, -98.0, 1.5)


def test_an_arc_goes_out_in_less_than_half_turns_however_quick_it_is() -> None:
    """Three quarters of a turn about Z 0.1, 5 ms long: from behind the centre to X+ of it, by X-."""
    quick = block(Kind.ARC, x=0.1, z=0.1, cx=0.0, cz=0.1, clockwise=True, feed=100.0)
    ops = [piece.op for piece in parts_of(quick, FULL)]
    assert len(ops) == 2
    for op in ops:
        assert isinstance(op, ArcOp)
        start, end = complex(op.z0 - op.cz, op.x0 - op.cx), complex(op.z - op.cz, op.x - op.cx)
        assert cmath.phase(end / start) == pytest.approx(3 * math.pi / 4)


def test_a_feed_per_turn_follows_the_commanded_speed_its_pot_and_its_limit() -> None:
    cut = block(Kind.FEED, z=-0.1, feed=0.1, per_rev=True, rpm=-1200.0)
    (piece,) = parts_of(cut, Turning(0.5, 3500.0))
    assert isinstance(piece.op, LineOp)
    assert piece.op.feed == pytest.approx(0.1 * 1200 / 60 * 0.5)
    (piece,) = parts_of(cut, Turning(1.0, 600.0))
    assert isinstance(piece.op, LineOp)
    assert piece.op.feed == pytest.approx(0.1 * 600 / 60)


@pytest.mark.parametrize(
    ("words", "expected"), [({"c": 90.0}, "X and Z only"), ({"x": 1.0, "feed": 0.0}, "no feed")]
)
def test_what_cannot_be_moved_is_refused(words: dict[str, object], expected: str) -> None:
    with pytest.raises(AlarmError, match=expected):
        list(parts_of(block(Kind.FEED, **words), FULL))


def test_needs_are_told_once_with_their_first_line() -> None:
    blocks = [
        block(Kind.ARC, x=1.0, z=-1.0, cx=1.0, line=3),
        block(Kind.ARC, x=1.0, z=-1.0, cx=1.0, line=4),
        block(Kind.THREAD, z=-1.0, line=5),
        block(Kind.THREAD, z=-1.0, line=6),
        block(Kind.FEED, z=-1.0, css=100.0, rpm=500.0, line=7),
    ]
    needs = first_needs(needs_of(blocks))
    assert [(need.what, need.line) for need in needs] == [
        ("arc", 3),
        ("thread", 5),
        ("pull-out", 6),
        ("surface-speed", 7),
    ]
