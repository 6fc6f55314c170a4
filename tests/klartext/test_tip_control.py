"""M128 and FUNCTION TCPM: every point of the way, against the kinematics reckoned apart."""

from __future__ import annotations

import numpy as np
import pytest

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from tests.klartext.running import Ran, run
from tests.klartext.table import AC, ORIGIN
from tests.klartext.test_chains import on_the_workpiece

TOOL = "TOOL DEF 5 L+60 R+4\nTOOL CALL 5 Z S1000 F500\n"
HERE = "L X+10 Y+20 Z+5 A+0 C+0 R0 FMAX M3\nM128\n"


def ran_of(text: str, begin: str = HERE) -> Ran:
    ran = run(begin + text, tool=TOOL)
    assert ran.codes == []
    return ran


def tips(block: Block, count: int = 9) -> np.ndarray:
    """Where the tip is on the workpiece along a block, by the tests' own matrices."""
    assert block.travel is not None
    assert block.travel.curved_move is not None
    rows = block.travel.curved_move.compute_machine_positions(np.linspace(0.0, 1.0, count))
    found = []
    for row in rows.tolist():
        at = dict(zip(AC.axis_names, row, strict=True))
        found.append(on_the_workpiece(AC, at, np.array((at["X"], at["Y"], at["Z"])), 60.0))
    return np.array(found)


def test_tool_tip_stays_in_place_while_table_turns() -> None:
    ran = ran_of("L A+30 C+50 F200")
    (move,) = (block for block in ran.blocks if block.kind is BlockKind.FEED)
    assert tips(move) == pytest.approx(np.tile((10.0, 20.0, 5.0), (9, 1)), abs=1e-9)
    assert move.has_angular_feed  # degrees are what the feed counts
    assert move.swivel is not None
    assert move.swivel.end == pytest.approx((10.0, 20.0, 5.0))


def test_the_tip_runs_straight_while_the_table_turns() -> None:
    ran = ran_of("L X+40 Y+0 Z+10 A+30 C+50 F200")
    (move,) = (block for block in ran.blocks if block.kind is BlockKind.FEED)
    share = np.linspace(0.0, 1.0, 9)[:, np.newaxis]
    straight = np.array((10.0, 20.0, 5.0)) + share * (
        np.array((40.0, 0.0, 10.0)) - np.array((10.0, 20.0, 5.0))
    )
    assert tips(move) == pytest.approx(straight, abs=1e-9)
    assert move.length == pytest.approx(np.linalg.norm((30.0, -20.0, 5.0)))
    assert not move.has_angular_feed


def test_moves_after_rotation_follow_rotated_workpiece() -> None:
    ran = ran_of("L A+30 C+50 F200\nL X+60 F300")
    last = [block for block in ran.blocks if block.kind is BlockKind.FEED][-1]
    at = ran.axes(last)
    slides = np.array((at["X"], at["Y"], at["Z"]))
    assert on_the_workpiece(AC, at, slides, 60.0) == pytest.approx((60.0, 20.0, 5.0))


def test_m129_restores_machine_coordinates() -> None:
    ran = ran_of("L A+30 FMAX\nM129\nL X+10 Y+20 Z+5 FMAX")
    last = [block for block in ran.blocks if block.moves][-1]
    assert last.swivel is not None
    assert last.swivel.machine_position == pytest.approx(np.add(ORIGIN, (10.0, 20.0, 5.0 + 60.0)))


def test_function_tcpm_is_m128() -> None:
    one = ran_of("L A+30 C+50 F200")
    other = ran_of("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS\nL A+30 C+50 F200", HERE.replace("M128\n", ""))
    assert one.axes(one.blocks[-2]) == pytest.approx(other.axes(other.blocks[-2]))
    ended = ran_of("FUNCTION RESET TCPM\nL A+30 F200")
    assert ended.state.linear_position == pytest.approx(np.add(ORIGIN, (10.0, 20.0, 65.0)))


@pytest.mark.parametrize("call", ["TOOL CALL S2857", "TOOL CALL Z S2857 F400", "TOOL CALL F400"])
def test_tool_call_with_speed_or_feed_is_accepted_under_m128(call: str) -> None:
    ran = run(f"L Z+50 R0 FMAX M3\nL M128\nL IA+5 R0 F500\n{call}\nL IA-5 R0 F500\nL M129")
    assert ran.codes == []
    assert ran.state.modal.rpm == (2857.0 if "S" in call else 3000.0)


@pytest.mark.parametrize(
    "call",
    ["TOOL CALL 2", "TOOL CALL 1 Z S100", "TOOL CALL DL+0.1", "TOOL CALL S100 DR-0.1", "TOOL CALL DR2:+0.1"],
)
def test_tool_call_with_tool_or_oversize_is_rejected_under_m128(call: str) -> None:
    assert run(f"L Z+50 R0 FMAX M3\nL M128\n{call}").codes == ["Not permitted with M128"]
