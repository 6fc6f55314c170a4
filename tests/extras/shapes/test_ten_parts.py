"""Parts of the control's worked examples made by forms alone: same metal, fewer keys than the text has."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.language.source import ProgramSource
from core.part.stock_spec import parse_stock_specification
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.part_history import PartHistory, StepCollector
from core.proving.program_timeline import MotionSpan, RestSpan
from core.proving.program_tools import PartSettings
from core.proving.prove_program import prove
from tests.extras.shapes.hand import Programmer, bad, machine, proved, setup_of
from tests.worked import worked

NEAR = 0.0001 * 25.4  # mm: of a radius
STEP = 0.002  # mm: of Z, so that a wall that is off by .0001 in is seen

TURNING = ToolShape(ToolKind.TURNING, tip=3, insert="VNMG160404", nose_radius=0.2)
DRILL = ToolShape(ToolKind.DRILL, diameter=0.2 * 25.4, point=118.0)
SMALL = ToolShape(ToolKind.DRILL, diameter=0.16 * 25.4, point=118.0)
NOTCH = ToolShape(ToolKind.GROOVING, tip=4, width=0.045 * 25.4)
BLADE = ToolShape(ToolKind.PARTING, tip=2, width=0.06 * 25.4, rear=True)
POINT = ToolShape(ToolKind.THREADING, tip=8, point=60.0)
FINE = ToolShape(ToolKind.THREADING, tip=6, point=60.0, diameter=5.0)


class Made(NamedTuple):
    """An example: the keys that make it, its stock, its tools by T. ``§`` is F2, ``⏎`` Return."""

    keys: str
    stock: str
    tools: dict[int, ToolShape]


PARTS = {
    "linear-diameter": Made("n§t.5⏎z-.5⏎.7⏎z-1.1⏎1§", "bar:1:2", {1: TURNING}),
    "linear-radius": Made("n§t.5⏎z-.5⏎.7⏎z-1.1⏎1§", "bar:1:2", {1: TURNING}),
    "arc-r-diameter-barrel": Made("n§t.4⏎z-.2⏎z-.5a.635⏎z-.7⏎.6§", "bar:.6:2", {1: TURNING}),
    "arc-r-radius-convex": Made("n§t.2⏎.5z-.15a.15⏎z-.3⏎.55§", "bar:.55:2", {1: TURNING}),
    "arc-ik-diameter": Made("n§t.2⏎.5z-.15a.15⏎.6§t.2⏎z-.3⏎.4z-.4a-.1⏎.5⏎z-.5⏎.6§", "bar:.6:2", {1: TURNING}),
    "rough-finish-g75-g78-two-tools": Made(
        "n§t.343c.125⏎z-.5⏎.406⏎z-.687a.0935⏎.375⏎z-1⏎.75↑↑↑↑↑↑↑↑↑↑↑↑.05§",
        "bar:.8:2",
        {1: TURNING, 2: TURNING},
    ),
    "css-facing": Made("n§f.5⏎0§d.5§", "bar:.5:1", {1: TURNING, 2: DRILL}),
    "drill-g81": Made("n§d.1§", "bar:.5:1", {1: DRILL}),
    "drill-peck-g83": Made("n§d.5⏎⏎.1§", "bar:.5:1", {1: DRILL}),
    "drill-peck-two-drills": Made("n§d.5⏎⏎.2§d.8⏎.4⏎.1§", "bar:.5:1", {1: DRILL, 2: SMALL}),
    "loop-notches": Made("n§g.5⏎.3⏎.035⏎⏎⏎⏎⏎16⏎.085§", "bar:.5:2", {1: NOTCH}),
}
"""Examples whose metal is compared, column by column."""


def sections(text: str, made: Made) -> np.ndarray:
    """Radii of the metal by column of Z when the program has ended: inside and outside."""
    setting = PartSettings(stock=parse_stock_specification(made.stock), shapes=made.tools, step=STEP)
    gathered = StepCollector(setting)

    def see(span: MotionSpan | RestSpan) -> None:
        gathered.add_span(span)

    prove(ProgramSource("x.nc", text), setup_of(), machine(), on_span=see)
    moves = gathered.make_program_steps()
    assert moves is not None
    history = PartHistory(moves)
    near = history.at(history.last_block_number, 0.0).x_plus_half
    assert near is not None
    return np.stack([near.inner_radii, near.outer_radii])


def made_by_hand(name: str, made: Made) -> tuple[str, str]:
    """The example's text, and ours: written by fewer keys, read and found good."""
    example = worked(name).read_text()
    hand = Programmer(made.tools)
    ours = hand.strike(made.keys).close()
    assert hand.strokes < len(example), (hand.strokes, len(example))
    told, there = (proved(text, stock=made.stock)[0] for text in (ours, example))
    assert not told.errors
    known = {
        each.code for each in there.diagnostics
    }  # a contour that falls again, and other truths of a part
    assert not [said for said in bad(told) if not any(f"[{code}]" in said for code in known)], ours
    return example, ours


@pytest.mark.parametrize("name", PARTS)
def test_forms_remove_the_same_stock_with_fewer_keys(name: str) -> None:
    made = PARTS[name]
    example, ours = made_by_hand(name, made)
    theirs, mine = sections(example, made), sections(ours, made)
    assert theirs.shape == mine.shape
    assert float(np.abs(theirs - mine).max()) <= NEAR, ours


# --- threads, pieces off a bar, holes from the side: no section of a part at rest shows them


def blocks_of(text: str) -> list[Block]:
    """All elementary blocks of a program that move."""
    return list(SharedProgram(ProgramSource("x.nc", text)).start_pass(setup_of()).generate_blocks())


THREADS = {
    "thread-external": Made("n§r↑o⏎⏎.5⏎⏎⏎.05⏎⏎⏎.498⏎.424§", "bar:.498:2", {4: POINT}),
    "thread-internal": Made("n§r↑o⏎b⏎.75⏎⏎n⏎.2⏎.05⏎⏎⏎.865⏎.9375§", "tube:1.2:.865:2", {8: FINE}),
}


@pytest.mark.parametrize("name", THREADS)
def test_forms_make_the_same_thread_with_fewer_keys(name: str) -> None:
    """The last pass is the thread: its radius, its lead, where it ends; and it begins before the part."""
    example, ours = made_by_hand(name, THREADS[name])
    theirs, mine = ([b for b in blocks_of(text) if b.kind is BlockKind.THREAD] for text in (example, ours))
    theirs, mine = ([b for b in each if b.x == b.x0][-1:] for each in (theirs, mine))
    (last,), (made,) = theirs, mine
    assert (made.x, made.z, made.feed) == pytest.approx((last.x, last.z, last.feed), abs=NEAR)
    assert made.z0 > 0.0


def test_forms_make_the_same_bar_parts_with_fewer_keys() -> None:
    tools = {1: TURNING, 2: BLADE}
    made = Made("n§l3⏎.35⏎o§t.1z-.05⏎z-.15⏎.2§p↑r⏎.2⏎⏎.29§", "bar:.2:2", tools)
    example, ours = made_by_hand("workshift-bar-loop", made)
    theirs, mine = (proved(text, tools, stock=made.stock)[1].parted_pieces for text in (example, ours))
    assert len(theirs) == len(mine) == 3
    for there, here in zip(theirs, mine, strict=True):
        assert here.volume_mm3 == pytest.approx(there.volume_mm3, rel=1e-4)
        assert [r for _, r in here.outside_profile] == pytest.approx(
            [r for _, r in there.outside_profile], abs=NEAR
        )


def test_forms_make_the_same_cross_holes_with_fewer_keys() -> None:
    across = ToolShape(ToolKind.DRILL, tip=8, diameter=3.175, point=118.0)
    example, ours = made_by_hand("caxis-cross-drill", Made("n§c1.4⏎.3⏎.2⏎27.5⏎4§", "bar:1.4:2", {5: across}))
    theirs, mine = (
        sorted((b.x, b.z, b.c % 360.0) for b in blocks_of(text) if not b.rapid and abs(b.x) < abs(b.x0))
        for text in (example, ours)
    )
    assert len(theirs) == 4
    for there, here in zip(theirs, mine, strict=True):
        assert here == pytest.approx(there, abs=NEAR)
