"""The part at any time: what is replayed is what making it straight through gives, forwards and backwards."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from app.compose.machine.machine_files import load_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.interpreter.shared.job_setup import SecondaryOffset, ToolOffset
from core.language.source import ProgramSource
from core.part.picture.clamping_bodies import BodyMaterial, RoundBody
from core.part.picture.solid_bodies import SymmetryAxis
from core.part.stock import Clamping, make_bar_stock
from core.part.tool_shape import ToolKind, ToolShape
from core.proving import part_history, part_instant
from core.proving.part_history import PartHistory, ProgramSteps, StepCollector, find_polyline_fraction
from core.proving.part_instant import PartState
from core.proving.part_simulation import PartSimulation
from core.proving.program_tools import PartSettings, ProgramTools
from core.proving.prove_program import prove
from core.proving.tip_moves import LiveToolStep

INCH = 25.4
TURNING = ToolShape(ToolKind.TURNING, tip=3, nose_radius=0.0, insert="DCMT11T304")
BLADE = ToolShape(ToolKind.PARTING, tip=3, width=2.0, stick_out=30.0)
SETTING = PartSettings(make_bar_stock(INCH, 0.0, -2.0 * INCH), {1: TURNING, 2: BLADE})
HEAD = "G90G94F300\nM03S1500\nT1\n"
SHAFT = HEAD + "X.6Z.05\nX.4\nG95F.004Z-.5\nX.45Z-.6\nX.55\nG94F300Z.05\nX.3\nG95F.004Z-.3\nX.55\nM30\n"
RAPID = SHAFT.replace("G95F.004Z-.3", "G00Z-.3")


def moves(text: str, setting: PartSettings = SETTING) -> ProgramSteps | None:
    tools = {n: ToolOffset(-12.7, -50.8) for n in range(1, 4)}
    setup = create_power_up_setup(
        load_machine(None), tool_offsets=tools, secondary_offsets={1: SecondaryOffset()}
    )
    gathered = StepCollector(setting)
    prove(ProgramSource("PART", text), setup, load_machine(None), on_span=gathered.add_span)
    return gathered.make_program_steps()


def history(text: str, setting: PartSettings = SETTING) -> PartHistory:
    found = moves(text, setting)
    assert found is not None
    return PartHistory(found)


def straight_through(seen: PartHistory, blocks: int) -> PartSimulation:
    making = PartSimulation(ProgramTools(seen.steps, SETTING), seen.stock, SETTING)
    for step in seen.steps[:blocks]:
        making.apply_step(step)
    return making


@pytest.mark.parametrize("every", [1, 3, 16])
def test_part_at_any_block_equals_part_made_sequentially(every: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(part_instant, "_COPY_INTERVAL", every)
    seen = history(SHAFT)
    count = len(seen.steps)
    for block in [count, 3, 7, 2, count - 1, 0, 5, 5, 6, count]:
        instant, made = seen.at(block), straight_through(seen, block)
        assert made.part is not None
        assert instant.x_plus_half is not None
        np.testing.assert_array_equal(instant.x_plus_half.inner_radii, made.part.inner_radii)
        np.testing.assert_array_equal(instant.x_plus_half.outer_radii, made.part.outer_radii)
        assert instant.findings == made.findings.diagnostics


def test_half_executed_cut_removes_half_its_material() -> None:
    seen = history(SHAFT)
    turning = next(
        k for k, step in enumerate(seen.steps) if not isinstance(step, LiveToolStep) and step.line == 6
    )
    instant = seen.at(turning, 0.5)
    assert instant.x_plus_half is not None
    assert instant.tool is not None
    # from Z.05 to Z-.5 it is half way at Z-.225, and what lies behind is still a bar of 1 in
    z, r = instant.tool.control_point
    assert (z, r) == pytest.approx((-0.225 * INCH, 0.4 * INCH))
    edges, high = instant.x_plus_half.column_edges, instant.x_plus_half.outer_radii[0]
    there = (edges[1:] + edges[:-1]) / 2
    assert high[there > -0.2 * INCH] == pytest.approx(0.4 * INCH)  # beside the round of its nose
    assert high[there < -0.24 * INCH] == pytest.approx(0.5 * INCH)


def test_shown_instant_is_not_changed_by_later_steps() -> None:
    seen = history(SHAFT)
    before = seen.at(3)
    assert before.x_plus_half is not None
    high = before.x_plus_half.outer_radii.copy()
    seen.at(len(seen.steps))
    np.testing.assert_array_equal(before.x_plus_half.outer_radii, high)


def test_rapid_into_material_has_its_position() -> None:
    seen = history(RAPID)
    (hit,) = seen.at(len(seen.steps)).material_hits
    assert (hit.finding.check_name, hit.finding.line) == ("rapid-into-stock", 11)
    # from the face to Z-.3, between the radius of the rapid and that of the cut before
    assert hit.z_positions.max() == pytest.approx(0.0, abs=0.01)
    assert hit.z_positions.min() == pytest.approx(-0.3 * INCH, abs=0.02)
    assert hit.inner_radii[hit.z_positions > -0.28 * INCH] == pytest.approx(
        0.3 * INCH, abs=0.001
    )  # beside the round of its nose
    assert hit.outer_radii == pytest.approx(0.4 * INCH, abs=0.001)


def test_collision_is_not_shown_before_it_happens() -> None:
    seen = history(RAPID)
    seen.at(len(seen.steps))
    assert seen.at(4).material_hits == ()
    assert seen.at(4).findings == ()


def test_valid_program_has_no_collisions() -> None:
    seen = history(SHAFT)
    assert seen.at(len(seen.steps)).material_hits == ()


def test_parted_piece_is_removed() -> None:
    seen = history(SHAFT.replace("M30", "T2\nX.6Z-.2\nG95F.002X-.01\nG94F300X.6\nM30"))
    instant = seen.at(len(seen.steps))
    assert instant.parted_piece_count == 1
    assert instant.x_plus_half is not None
    edges, high = instant.x_plus_half.column_edges, instant.x_plus_half.outer_radii[0]
    assert not high[edges[1:] > -0.19 * INCH].any()


def test_copies_stay_within_their_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(part_instant, "_COPY_INTERVAL", 1)
    monkeypatch.setattr(part_instant, "_MAX_COPIES", 4)
    seen = history(SHAFT)
    seen.at(len(seen.steps))
    assert len(seen._kept._copies) <= 4
    instant, made = seen.at(7), straight_through(seen, 7)
    assert instant.x_plus_half is not None
    assert made.part is not None
    np.testing.assert_array_equal(instant.x_plus_half.outer_radii, made.part.outer_radii)


class _EnoughError(Exception):
    pass


def test_canceled_history_can_be_resumed() -> None:
    seen = history(SHAFT)

    def enough() -> None:
        raise _EnoughError

    with pytest.raises(_EnoughError):
        seen.at(len(seen.steps), 0.0, enough)
    instant, made = seen.at(len(seen.steps)), straight_through(seen, len(seen.steps))
    assert instant.x_plus_half is not None
    assert made.part is not None
    np.testing.assert_array_equal(instant.x_plus_half.outer_radii, made.part.outer_radii)


def test_too_long_program_has_no_history(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(part_history, "MAX_MOVES", 5)
    assert moves(SHAFT) is None


def test_program_without_blocks_has_no_history() -> None:
    assert StepCollector(SETTING).make_program_steps() is None


def test_program_without_cut_has_no_stock_or_part() -> None:
    seen = history(HEAD + "X2Z2\nM30\n", PartSettings())
    instant = seen.at(len(seen.steps))
    assert (instant.stock, instant.x_plus_half, instant.x_minus_half) == (None, None, None)


def test_no_tool_is_shown_before_first_move() -> None:
    assert history(SHAFT).at(0).tool is None


def test_unknown_block_has_zero_executed_fraction() -> None:
    assert history(SHAFT).find_executed_fraction(999, (0.0, 0.0)) == 0.0


def test_executed_fraction_follows_distance_to_end_of_block() -> None:
    seen = history(SHAFT)
    turning = (
        next(k for k, step in enumerate(seen.steps) if not isinstance(step, LiveToolStep) and step.line == 6)
        + 1
    )
    assert seen.find_executed_fraction(turning, (0.0, 0.0)) == pytest.approx(1.0)
    assert seen.find_executed_fraction(turning, (0.55 * INCH / 4, 0.0)) == pytest.approx(0.75)
    assert seen.find_executed_fraction(turning, (0.55 * INCH / 4, 0.02)) == pytest.approx(
        0.75
    )  # beside its path


def test_polyline_fraction_follows_corner() -> None:
    corner = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0)]
    assert find_polyline_fraction(corner, (1.0, -1.0)) == pytest.approx(0.25)
    assert find_polyline_fraction(corner, (5.0, 0.5)) == pytest.approx(3.5 / 4.0)
    assert find_polyline_fraction([(1.0, 1.0), (1.0, 1.0)], (0.0, 0.0)) == 0.0
    assert not math.isnan(find_polyline_fraction([(1.0, 1.0)], (0.0, 0.0)))


MILL = PartSettings(
    make_bar_stock(INCH, 0.0, -60.0),
    {1: TURNING, 6: ToolShape(ToolKind.END_MILL, tip=8, diameter=6.0, length=15.0)},
)
MILLED = HEAD + (
    "X.6Z.05\nX.45\nG95F.004Z-.5\nX.55\nG94F300X.6Z.1\nT6\nX.6Z-.4\nM05\nM15\nM19\nG04F3\nG94F4X.4\n"
    "Z-.8\nX.6\nG94F300X1\nM16\nM30\n"
)


def test_milling_is_replayed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(part_instant, "_COPY_INTERVAL", 2)
    seen = history(MILLED, MILL)
    count = len(seen.steps)
    for block in [count, 4, count - 4, count - 3, 0, count]:
        instant = seen.at(block)
        made = PartSimulation(ProgramTools(seen.steps, MILL), seen.stock, MILL)
        for step in seen.steps[:block]:
            made.apply_step(step)
        found = seen.make_solid(instant)
        assert found is not None
        if made.milling is None:
            assert found.inner_radii.shape[2] == 1
        else:
            np.testing.assert_array_equal(found.outer_radii, made.milling.updated_field.outer_radii)
    # the slot is on one side alone: .1 in deep from a radius of .5 at Z-.6
    assert instant.x_plus_half is not None
    assert instant.x_minus_half is not None
    depths = []
    for half in (instant.x_plus_half, instant.x_minus_half):
        there = int(np.searchsorted(half.column_edges, -0.6 * INCH)) - 1
        depths.append(half.outer_radii[:, there].max())
    assert sorted(depths) == pytest.approx([0.4 * INCH, 0.5 * INCH], abs=0.01)


def test_half_executed_milling_move_has_tool_halfway() -> None:
    seen = history(MILLED, MILL)
    along = next(k for k, step in enumerate(seen.steps) if part_history._line(step) == 16)
    instant = seen.at(along, 0.5)
    assert instant.tool is not None
    assert instant.tool.control_point == pytest.approx((-0.6 * INCH, 0.4 * INCH))


def depth_at(seen: PartHistory, instant: PartState, z: float) -> float:
    """The greatest radius on the side of the mill, inches."""
    assert instant.x_plus_half is not None
    assert instant.x_minus_half is not None
    heights = []
    for half in (instant.x_plus_half, instant.x_minus_half):
        there = int(np.searchsorted(half.column_edges, z * INCH)) - 1
        heights.append(half.outer_radii[:, there].max() / INCH)
    return float(min(heights))


def test_milled_material_is_removed_along_block() -> None:
    """The slot goes from Z-.4 to Z-.8 with a mill of .118 in radius: half way it ends at Z-.718."""
    seen = history(MILLED, MILL)
    along = next(k for k, step in enumerate(seen.steps) if part_history._line(step) == 16)
    for share, cut, left in (
        (0.25, -0.59, -0.66),
        (0.5, -0.69, -0.74),
        (0.75, -0.79, -0.84),
        (0.5, -0.69, -0.74),
    ):
        instant = seen.at(along, share)
        assert depth_at(seen, instant, cut) == pytest.approx(0.4, abs=0.001)
        assert depth_at(seen, instant, left) == pytest.approx(0.5, abs=0.001)
        found = seen.make_solid(instant)
        assert found is not None
        assert found.outer_radii.shape[2] > 1
    whole, again = seen.at(along + 1), history(MILLED, MILL).at(along + 1)
    assert whole.x_plus_half is not None
    assert again.x_plus_half is not None
    np.testing.assert_array_equal(
        whole.x_plus_half.outer_radii, again.x_plus_half.outer_radii
    )  # what was shown ahead leaves no trace


def test_live_tool_collision_in_rapid_has_its_position() -> None:
    seen = history(MILLED.replace("G94F4X.4", "G94F300X.4"), MILL)
    instant = seen.at(len(seen.steps))
    hit, along = instant.material_hits
    assert (hit.finding.code, hit.finding.line, along.finding.line) == ("rapid-into-stock", 15, 16)
    radius = 3.0 / INCH  # of the mill
    back, front = hit.z_positions[0] - hit.column_width_mm / 2, hit.z_positions[0] + hit.column_width_mm / 2
    assert (back / INCH, front / INCH) == pytest.approx((-0.4 - radius, -0.4 + radius), abs=0.01)
    assert (hit.inner_radii[0] / INCH, hit.outer_radii[0] / INCH) == pytest.approx((0.4, 0.5), abs=0.01)
    assert history(MILLED, MILL).at(len(seen.steps)).material_hits == ()


def test_copies_of_milled_part_share_unchanged_columns(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(part_instant, "_COPY_INTERVAL", 1)
    seen = history(MILLED, MILL)
    seen.at(len(seen.steps))
    kept = [field for _, field, _ in seen._kept._copies.values() if field is not None]
    assert len(kept) > 3
    one, other = kept[-2:]  # between them the tool goes away
    assert all(
        a is b for a, b in zip(one.radii_by_column.values(), other.radii_by_column.values(), strict=True)
    )
    alone = sum(column.nbytes for column in kept[-1].radii_by_column.values())
    assert seen._kept._total_bytes < 2.0 * alone + sum(m.nbytes for m, _, _ in seen._kept._copies.values())


def test_scene_has_tool_and_chuck_around_part() -> None:
    seen = history(MILLED, replace(MILL, clamping=Clamping(40.0, 30.0, 5.0, 30.0)))
    instant = seen.at(len(seen.steps))
    around = seen.make_scene_at(instant)
    chuck = [body for body in around.clamping if body.material is BodyMaterial.CHUCK]
    assert max(body.back_radius_mm for body in chuck if isinstance(body, RoundBody)) == 20.0
    assert max(body.front_z_mm for body in chuck) == -30.0
    assert around.tool is not None
    assert around.tool.symmetry_axis is SymmetryAxis.X
    assumed = history(MILLED, MILL).make_scene_at(instant).clamping
    assert any(body.material is BodyMaterial.JAW for body in assumed)


@pytest.mark.parametrize(
    ("program", "setting", "limits"),
    [(SHAFT, SETTING, [[-149.2, -87.3], [50.8, 22.7]]), (MILLED, MILL, [[-200.0, -100.0], [0.0, 10.0]])],
)
def test_machine_limits_are_converted_to_tip_positions(
    program: str, setting: PartSettings, limits: list[list[float]]
) -> None:
    """T1 stands at machine X-12.7 Z-50.8 with its tip on part zero; T6 has no offset."""
    seen = history(program, replace(setting, travel=((-100.0, 10.0), (-200.0, 0.0))))
    assert seen.at(0).tip_range is None
    reach = seen.at(len(seen.steps)).tip_range
    assert reach is not None
    assert np.array(reach) == pytest.approx(np.array(limits))
    assert history(program, setting).at(len(seen.steps)).tip_range is None


def test_chuck_collision_is_red_on_chuck_and_not_on_part() -> None:
    """The jaws' face stands at Z-10 mm, .394 in; T1 turns on to Z-.5."""
    held = Clamping(60.0, 10.0, 5.0, 40.0)
    seen = history(SHAFT, replace(SETTING, clamping=held))
    hits = {hit.finding.check_name: hit for hit in seen.at(len(seen.steps)).material_hits}
    hit = hits["into-chuck"]
    assert hit.z_positions.max() == pytest.approx(-10.0, abs=0.1)
    assert hit.z_positions.min() < -12.0
    assert hit.outer_radii[-1] == pytest.approx(20.0, abs=0.01)  # of the jaws
    assert set(hits) == {"into-chuck"}


def test_c_angle_is_interpolated_along_block() -> None:
    """From C0 to C90 with C locked: half way it is 45, and it stays at 90 behind it."""
    seen = history(MILLED.replace("Z-.8\nX.6\n", "C90\nX.6\n"), MILL)
    turning = next(k for k, step in enumerate(seen.steps) if part_history._line(step) == 16)
    assert seen.at(turning).c_angle_deg == pytest.approx(0.0)
    assert seen.at(turning, 0.5).c_angle_deg == pytest.approx(45.0)
    assert seen.at(turning + 2).c_angle_deg == pytest.approx(90.0)


THREADED = SHAFT.replace("M30", "X.5Z.2\nM05\nM03S600\nG33X.38Z-.4I.01K.05\nM30")


@pytest.mark.parametrize(("program", "is_helix"), [(THREADED, True), (SHAFT, False)])
def test_thread_is_a_helix_in_the_solid(program: str, is_helix: bool) -> None:
    seen = history(program)
    solid = seen.make_solid(seen.at(len(seen.steps)))
    assert solid is not None
    radii = solid.outer_radii[0]
    assert (radii.shape[1] > 1) is is_helix
    assert bool(np.ptp(radii, axis=1).max() > 0.1) is is_helix
