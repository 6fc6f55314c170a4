"""Taps, live tools and bars in SINUMERIK: proved, opened again, held against figures."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import atan2, degrees, hypot

import pytest

from app.compose.machine.machine_files import load_shipped_machine
from app.compose.machine.machine_setup import create_power_up_setup
from core.extras.shapes.editor_shape import make_shape_instance
from core.extras.shapes.shape_fields import FieldValue, ProgramSettings, ShopData
from core.extras.shapes.shape_pieces import find_active_settings, find_program_shapes, insert_shape
from core.extras.shapes.shape_table import SINUMERIK_SHAPES
from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.actions import ColletSwitch, OutputSwitch
from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import ToolOffset
from core.language.diagnostics import Severity
from core.language.source import Dialect, ProgramSource
from core.machine.machine_model import Machine
from core.part.ray_cuts import make_plane_path
from core.proving.prove_program import prove
from tests.extras.shapes.hand import setup_of
from tests.extras.shapes.test_pieces import written as omniturn
from tests.sinumerik.lathe import LINEAR

LIVE = load_shipped_machine("sinumerik-live")
BARS = replace(LIVE, m_code_outputs={68: ("collet", True), 69: ("collet", False)})
SHOP = ShopData(max_acceleration_mm_s2=3000.0, max_c_axis_rpm=400.0, chuck_codes=(69, 68))
NEW = ProgramSettings(dialect=Dialect.SINUMERIK)

Typed = dict[str, FieldValue]
FACES: Typed = {"DIA": 6.0, "FROM": 20.0, "ACROSS": 17.0, "LONG": 5.0}
CROSS: Typed = {"DIA": 3.0, "FROM": 20.0, "AT": 8.0, "DEEP": 6.0, "COUNT": 4.0, "ANGLE": 27.5}
SLOT: Typed = {"DIA": 3.0, "FROM": 20.0, "AT": 5.0, "LONG": 12.0, "DEEP": 2.0, "PASS": 1.0, "COUNT": 3.0}
TAP: Typed = {"SERIES": "M", "SIZE": "6", "DEEP": 12.0}
LOOP: Typed = {"COUNT": 3.0, "LONG": 22.0}


def written(*steps: tuple[str, Typed], shop: ShopData = SHOP, **head: FieldValue) -> list[str]:
    """The program of these shapes, in mm, head first."""
    text, behind = list[str](), 0
    for key, typed in [("N", {"UNIT": "METRIC", **head}), *steps]:
        setting = find_active_settings(text, behind, shop, NEW)
        one = make_shape_instance(SINUMERIK_SHAPES[key], typed, setting)
        assert not one.find_errors(setting), one.find_errors(setting)
        text, behind = insert_shape(text, behind, one, setting)
    return text


def source(text: list[str]) -> ProgramSource:
    return ProgramSource("x.mpf", "\n".join(text) + "\n", Dialect.SINUMERIK)


def blocks(text: list[str], machine: Machine = LIVE) -> list[Block]:
    """Of a program that is proved without an error."""
    tools = {n: ToolOffset(50.0, 100.0, 0.0, 3) for n in range(1, 10)}
    around = create_power_up_setup(machine, tool_offsets=tools, secondary_offsets={})
    report = prove(source(text), around, machine)
    assert not report.errors, [each.format_one_line("x") for each in report.diagnostics]
    return list(SharedProgram(source(text)).start_pass(around).generate_blocks())


def cuts(text: list[str]) -> list[Block]:
    return [each for each in blocks(text) if each.plane is not None]


@pytest.mark.parametrize(
    ("key", "typed"),
    [
        ("O", TAP),
        ("O", {**TAP, "HAND": "LEFT"}),
        ("O", {**TAP, "HOLDER": "RIGID"}),
        ("C", CROSS),
        ("C", {**CROSS, "SIDE": "REAR", "COUNT": 1.0}),
        ("M", FACES),
        ("M", {**FACES, "DEEP": 2.0, "FLATS": 2.0}),
        ("M", {**FACES, "FLATS": 1.0}),
        ("S", SLOT),
        ("S", {**SLOT, "TURN": 90.0, "LONG": 0.0, "COUNT": 1.0}),
    ],
)
@pytest.mark.parametrize("head", [{}, {"WORDS": "RADIUS"}])
def test_live_shape_is_proved_and_reopened_from_its_text(key: str, typed: Typed, head: Typed) -> None:
    text = written((key, typed), shop=SHOP, **head)
    blocks(text)
    piece = find_program_shapes(text, SHOP, NEW)[-1]
    assert (piece.shape_instance.shape.name, piece.edited_line, piece.adopted_field_names) == (
        SINUMERIK_SHAPES[key].name,
        -1,
        (),
    )
    assert {word: piece.shape_instance.field_values[word] for word in typed} == typed


# --- taps


def test_compensating_holder_tap_feeds_by_pitch_and_reverses_out() -> None:
    """M6 has 1 mm a turn; the slide stops a pitch before the depth, as the spindle runs on."""
    text = written(("O", {**TAP, "RPM": 300.0, "DWELL": 0.5}))
    assert "CYCLE840(3, 0, 3, -11, , 0.5, 0, , 0, , 1)" in text
    tapped = [each for each in blocks(text) if each.follows_spindle]
    assert [(each.z, each.feed) for each in tapped] == [(-11.0, 1.0), (3.0, 1.0)]


def test_rigid_tap_reaches_full_depth_and_left_hand_tap_reverses() -> None:
    """15 mm from Z3 by 1 mm a turn are 15 turns of C."""
    ways = {}
    for hand in ("RIGHT", "LEFT"):
        text = written(("O", {**TAP, "HOLDER": "RIGID", "HAND": hand, "RPM": 200.0}))
        ways[hand] = next(each for each in blocks(text) if each.z == -12.0 and each.c != each.c0)
    assert ways["RIGHT"].c - ways["RIGHT"].c0 == pytest.approx(-(ways["LEFT"].c - ways["LEFT"].c0))
    assert abs(ways["LEFT"].c - ways["LEFT"].c0) == pytest.approx(15 * 360.0)


# --- live tools


def test_cross_holes_are_at_their_angles() -> None:
    """Feeds along X from 11.25 to 4 mm of radius, Z -8, C from 27.5 by 90 degrees, the spindle at rest."""
    text = written(("C", CROSS))
    drilled = [each for each in blocks(text) if each.kind is BlockKind.FEED]
    assert [(each.x0, each.x, each.z) for each in drilled] == [(11.25, 4.0, -8.0)] * 4
    assert [each.c % 360.0 for each in drilled] == pytest.approx([27.5, 117.5, 207.5, 297.5])
    assert not any(each.modal.spindle for each in drilled)
    assert all("live" in each.modal.outputs for each in drilled)


def test_c_axis_is_written_with_its_configured_name() -> None:
    named = replace(SHOP, third_axis_name="A1")
    assert "G0 A1=27.5" in written(("C", CROSS), shop=named)
    assert "G0 C27.5" in written(("C", CROSS))


@pytest.mark.parametrize(("many", "deep"), [(6.0, 5.0), (4.0, 2.0), (2.0, 2.0), (1.0, 5.0)])
def test_flats_are_milled_at_the_correct_distance_from_the_axis(many: float, deep: float) -> None:
    """Its centre keeps 8.5 + 3 mm from the axis at every depth, and touches that beside each flat."""
    faces = cuts(written(("M", {**FACES, "FLATS": many, "DEEP": deep})))
    milled = [each.plane for each in faces if each.plane and min(each.plane.start[2], each.plane.end[2]) < 0]
    near = {}
    for way in milled:
        for (x0, y0, _), (x1, y1, _) in pairwise([way.start, way.end]):
            share = max(
                0.0, min(1.0, -(x0 * (x1 - x0) + y0 * (y1 - y0)) / ((x1 - x0) ** 2 + (y1 - y0) ** 2 or 1))
            )
            x, y = x0 + share * (x1 - x0), y0 + share * (y1 - y0)
            assert hypot(x, y) >= 11.5 - 1e-3
            if hypot(x, y) < 11.5 + 1e-3:
                near[round(degrees(atan2(y, x))) % 360] = True
    assert len(near) == many


def test_two_flats_in_passes_do_not_cross_the_part_in_omniturn_either() -> None:
    """.65 across with a mill of .25: back to the first flat at Y-.525, where .375 + .125 are the part's."""
    inches: Typed = {"DIA": 0.25, "FROM": 0.75, "ACROSS": 0.65, "LONG": 0.2, "FLATS": 2.0, "DEEP": 0.1}
    text = omniturn([("M", inches, ())])
    assert text[text.index("(Z-.2F6)") - 2 : text.index("(Z-.2F6)")] == ["(X-.45Y-.525)", "(X.45Y-.525F50)"]


def test_slot_is_at_its_angle_and_programmed_depth() -> None:
    """Three slots of 12 mm at radius 8, 0, 120 and 240 degrees apart, on the part as C turns it."""
    ways = [each.plane for each in cuts(written(("S", SLOT))) if each.plane]
    paths = [make_plane_path(way) for way in ways]  # r, z and angle on the part
    bottom = [
        path for path in paths if path[0][0] == pytest.approx(8.0) and abs(path[0][1] - path[-1][1]) > 1
    ]
    assert [sorted((path[0][1], path[-1][1])) for path in bottom] == [pytest.approx([-17.0, -5.0])] * 3
    assert [b[0][2] - a[0][2] for a, b in pairwise(bottom)] == pytest.approx([-120.0] * 2, abs=1e-3)


def test_slot_angle_and_hole_c_angle_agree() -> None:
    """Both at 30 degrees: C stands at 30 when the slot's mill is there."""
    first = next(
        each for each in blocks(written(("S", {**SLOT, "ANGLE": 30.0, "COUNT": 1.0})))
        if each.plane and each.plane.start[2] == each.plane.end[2]
    )  # fmt: skip
    assert first.c % 360.0 == pytest.approx(30.0, abs=1e-3)


def test_circumferential_keyway_turns_as_in_omniturn() -> None:
    """A quarter turn, 2 mm deep in 20: at radius 8 from one angle on the part to that 90 degrees on."""
    typed: Typed = {**SLOT, "TURN": 90.0, "LONG": 0.0, "COUNT": 1.0, "PASS": 2.0}
    there = omniturn([("S", typed | {"DIA": 3.0}, ())], UNIT="METRIC")
    program = ProgramSource("x.nc", "\n".join(there) + "\n", Dialect.OMNITURN)
    theirs = [
        b.plane
        for b in SharedProgram(program).start_pass(setup_of()).generate_blocks()
        if b.plane is not None
    ]
    for way in ([b.plane for b in cuts(written(("S", typed))) if b.plane], theirs):
        paths = [p for p in map(make_plane_path, way) if abs(p[-1][2] - p[0][2]) > 1.0]
        (path,) = [p for p in paths if p[0][0] == pytest.approx(8.0)]
        assert path[-1][2] - path[0][2] == pytest.approx(90.0, abs=1e-2)


# --- bars


@pytest.mark.parametrize("feeds", ["EACH PART", "ONCE"])
def test_a_bar_loop_makes_its_parts(feeds: str) -> None:
    """Three parts of 22 mm: the chuck opens three times or once, at rest; the faces lie 22 mm apart."""
    face: tuple[str, Typed] = ("F", {"FROM": 20.0})
    text = written(("L", {**LOOP, "FEEDS": feeds}), face)
    assert text.index("M30") < text.index("%_N_PART_1_SPF") < text.index("M17")
    made = blocks(text, BARS)
    opened = [each for each in made if each.action == ColletSwitch(closed=False)]
    assert len(opened) == (3 if feeds == "EACH PART" else 1)
    assert not any(each.modal.spindle for each in opened)
    faced = [each.mz for each in made if each.kind is BlockKind.FEED and each.x < 0]
    step = 0.0 if feeds == "EACH PART" else -22.0
    assert faced == pytest.approx([faced[0] + k * step for k in range(3)])
    names = [
        (piece.shape_instance.shape.name, piece.edited_line) for piece in find_program_shapes(text, SHOP, NEW)
    ]
    assert names == [("HEAD", -1), ("BAR LOOP", -1), ("FACE", -1)]


def test_contour_in_a_sinumerik_bar_loop_may_be_compensated() -> None:
    text = written(("L", LOOP))
    setting = find_active_settings(text, len(text) - 1, SHOP, NEW)
    assert setting.is_subroutine
    one = make_shape_instance(
        SINUMERIK_SHAPES["A"], {"SMALL": 8.0, "LONG": 5.0, "LARGE": 9.0, "FROM": 20.0, "COMP": 1.0}, setting
    )
    assert not one.find_errors(setting)


@pytest.mark.parametrize(
    ("text", "found"),
    [("S900 M3\nM69", "unclamp-turning"), ("S900 M3\nM5\nM69\nM3", "collet-open")],
)
def test_chuck_code_obeys_the_collet_interlocks(text: str, found: str) -> None:
    held = replace(
        BARS, interlocks=replace(BARS.interlocks, unclamp_while_turning=False, spindle_with_collet_open=False)
    )
    report = prove(
        source(["G54 G18 G90", *text.split("\n"), "M30"]),
        create_power_up_setup(held, tool_offsets={}, secondary_offsets={}),
        held,
    )
    assert [each.code for each in report.errors] == [found]


def test_chuck_codes_open_and_close_the_collet() -> None:
    made = blocks(["G54 G18 G90", "M5", "M69", "M68", "M30"], BARS)
    assert [each.action for each in made if isinstance(each.action, ColletSwitch | OutputSwitch)] == [
        ColletSwitch(closed=False), ColletSwitch(closed=True)
    ]  # fmt: skip


# --- refusals


@pytest.mark.parametrize(
    ("key", "typed", "shop", "word"),
    [
        ("O", {**TAP, "HOLDER": "RIGID"}, replace(SHOP, is_spindle_c_axis=False), "HOLDER"),
        ("O", {**TAP, "HOLDER": "RIGID", "RPM": 500.0}, SHOP, "RPM"),
        ("O", {**TAP, "SERIES": "NPT", "SIZE": "1/4"}, SHOP, "SERIES"),
        ("C", CROSS, replace(SHOP, has_live_output=False), "T"),
        ("C", CROSS, replace(SHOP, third_axis_name=""), "T"),
        ("C", {**CROSS, "DEEP": 21.0}, SHOP, "DEEP"),
        ("M", FACES, replace(SHOP, third_axis_name="Y"), "T"),
        ("M", {**FACES, "ACROSS": 20.0}, SHOP, "ACROSS"),
        ("S", {**SLOT, "DEEP": 11.0, "PASS": 1.0}, SHOP, "DEEP"),
        ("L", LOOP, replace(SHOP, chuck_codes=None), "FEEDS"),
    ],
)
def test_operation_beyond_the_machine_is_rejected_at_its_field(
    key: str, typed: Typed, shop: ShopData, word: str
) -> None:
    setting = find_active_settings(written(), 1, shop, NEW)
    one = make_shape_instance(SINUMERIK_SHAPES[key], typed, setting)
    assert [each.field_name for each in one.find_errors(setting)] == [word]


def test_bar_loop_inside_another_is_rejected() -> None:
    text = written(("L", LOOP))
    setting = find_active_settings(text, len(text) - 1, SHOP, NEW)
    assert [
        each.field_name
        for each in make_shape_instance(SINUMERIK_SHAPES["L"], LOOP, setting).find_errors(setting)
    ] == ["COUNT"]


def test_lathe_without_a_live_tool_is_reported_in_the_proof() -> None:
    report = prove(
        source(written(("C", CROSS))),
        create_power_up_setup(LINEAR, tool_offsets={}, secondary_offsets={}),
        LINEAR,
    )
    assert any(each.severity is Severity.ERROR and each.code == "one-spindle" for each in report.diagnostics)
