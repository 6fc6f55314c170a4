"""Shapes in SINUMERIK: good on the shipped lathe, opened again, and of the same metal as in OmniTurn."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from app.compose.machine.machine_setup import create_power_up_setup
from app.extras.shapes.shapes_model import ShapesModel
from core.extras.shapes.contour import ContourPoint
from core.extras.shapes.editor_shape import make_shape_instance
from core.extras.shapes.shape_fields import FieldValue, ProgramSettings, ShopData
from core.extras.shapes.shape_pieces import (
    find_active_settings,
    find_program_shapes,
    insert_shape,
    rewrite_program_shapes,
)
from core.extras.shapes.shape_table import SHAPES_BY_DIALECT
from core.interpreter.dialects import SharedProgram
from core.interpreter.shared.elementary_blocks import BlockKind
from core.interpreter.shared.job_setup import InterpreterSetup, ToolOffset
from core.language.source import Dialect, ProgramSource
from core.part.stock_spec import parse_stock_specification
from core.part.tool_shape import ToolKind, ToolShape
from core.proving.part_proof import prove_program_and_part
from core.proving.program_tools import PartSettings
from core.tool_edges import make_edge_row_number
from tests.extras.shapes.hand import machine, setup_of
from tests.sinumerik.lathe import LINEAR
from tests.texts import text

SHOP = ShopData(max_acceleration_mm_s2=3048.0)
OURS, THEIRS = Dialect.SINUMERIK, Dialect.OMNITURN
NEAR = 0.0001 * 25.4  # mm of a radius
PROFILE = (
    ContourPoint(0.0, 0.0),
    ContourPoint(12.0, chamfer=1.0),
    ContourPoint(z=-12.0, radius=1.0),
    ContourPoint(18.0),
    ContourPoint(z=-15.0),
    ContourPoint(22.0, -17.0, arc=4.0),
    ContourPoint(26.0, -19.0, arc=-3.0),
)
BORED = (
    ContourPoint(16.0, 0.0),
    ContourPoint(14.0, -1.0),
    ContourPoint(z=-8.0),
    ContourPoint(10.0, -10.0, arc=-2.0),
    ContourPoint(z=-15.0),
)

Step = tuple[str, dict[str, FieldValue], tuple[ContourPoint, ...]]
DRILLED: Step = ("D", {"DIA": 9.0, "DEEP": 40.0, "PECK": 9.0}, ())
STEPS: dict[str, list[Step]] = {
    "face": [("F", {"FROM": 30.0, "AT": -1.5, "STOCK": 1.5}, ())],
    "face by surface speed": [("F", {"FROM": 30.0, "AT": -0.5, "SURF": 90.0}, ())],
    "profile": [("T", {"FROM": 30.0, "ROUGH": 1.0, "LEAVE": 0.25}, PROFILE)],
    "profile with two allowances": [
        ("T", {"FROM": 30.0, "ROUGH": 1.0, "LEAVE": 0.25, "ZLEAVE": 0.1}, PROFILE[:5])
    ],
    "profile at one go": [("T", {"FROM": 30.0}, PROFILE)],
    "profile in a bore": [DRILLED, ("T", {"SIDE": "BORE", "HOLE": 9.0, "ROUGH": 0.5}, BORED)],
    "taper": [("A", {"FROM": 30.0, "SMALL": 10.0, "LONG": 12.0, "ANGLE": 10.0, "ROUGH": 1.0}, ())],
    "two roughed": [
        ("T", {"FROM": 30.0, "ROUGH": 1.0}, (*PROFILE[:2], ContourPoint(z=-12.0))),
        ("A", {"FROM": 12.0, "SMALL": 6.0, "LONG": 4.0, "LARGE": 10.0, "ROUGH": 0.5}, ()),
    ],
    "edge": [("K", {"DIAM": 30.0, "EDGE": 2.0, "KIND": "RADIUS"}, ())],
    "groove": [
        ("G", {"TOP": 30.0, "BOTTOM": 20.0, "AT": 10.0, "WIDE": 2.0, "LONG": 5.0, "EDGE": 0.5}, ()),
        ("G", {"TOP": 30.0, "BOTTOM": 26.0, "AT": 20.0, "WIDE": 2.0, "COUNT": 3.0, "PITCH": 4.0}, ()),
    ],
    "groove with leaning walls": [
        ("G", {"TOP": 30.0, "BOTTOM": 20.0, "AT": 9.0, "WIDE": 2.0, "LONG": 8.0, "FANGLE": 15.0}, ())
    ],
    "drill": [("D", {"DIA": 6.0, "DEEP": 15.0, "PECK": 0.0}, ())],
    "peck behind a hole": [
        ("D", {"DIA": 6.0, "DEEP": 20.0, "PECK": 4.0}, ()),
        ("D", {"DIA": 6.0, "DEEP": 35.0, "START": 20.0, "PECK": 4.0}, ()),
    ],
    "bore": [DRILLED, ("B", {"HOLE": 9.0, "DIAM": 12.0, "DEEP": 12.0, "EDGE": 1.0, "ROUGH": 0.5}, ())],
    "part off": [("P", {"FROM": 30.0, "LONG": 20.0, "WIDE": 3.0, "BACK": 1.0, "NEXT": 1.0}, ())],
    "part off in pecks": [("P", {"FROM": 30.0, "LONG": 20.0, "WIDE": 3.0, "PECK": 4.0, "SLOW": 8.0}, ())],
}  # fmt: skip


def written(steps: list[Step], dialect: Dialect, **head: FieldValue) -> list[str]:
    """The program of these shapes in a language, head first, in mm."""
    text, behind, new = list[str](), 0, ProgramSettings(dialect=dialect)
    for key, typed, rows in [("N", {"UNIT": "METRIC", **head}, ()), *steps]:
        setting = find_active_settings(text, behind, SHOP, new)
        one = make_shape_instance(SHAPES_BY_DIALECT[dialect][key], typed, setting, rows)
        assert not one.find_errors(setting), one.find_errors(setting)
        text, behind = insert_shape(text, behind, one, setting)
    return text


def source(text: list[str], dialect: Dialect) -> ProgramSource:
    return ProgramSource("x.mpf" if dialect is OURS else "x.nc", "\n".join(text) + "\n", dialect)


def setup_in(dialect: Dialect, nose: float = 0.0, *, right: bool = False) -> InterpreterSetup:
    """Tools at one place. In SINUMERIK D2 lies 2 mm from D1: to the face, of a ``right`` D1 to the chuck."""
    tools = {n: ToolOffset(50.0, 100.0, nose, 3) for n in range(1, 10)}
    edges = {make_edge_row_number(n, 2): ToolOffset(50.0, 102.0 if right else 98.0, nose, 4) for n in tools}
    return (
        create_power_up_setup(LINEAR, tool_offsets=tools | edges, secondary_offsets={})
        if dialect is OURS
        else setup_of()
    )


def tools_of(steps: list[Step]) -> dict[int, ToolShape]:
    """Drills and blades as their fields say; of the others only the tip cuts."""
    found = dict[int, ToolShape]()
    for number, (key, typed, _) in enumerate(steps, 1):
        if key == "D":
            found[number] = ToolShape(ToolKind.DRILL, diameter=float(typed["DIA"]), point=118.0, length=60.0)
        elif key in {"G", "P"}:
            kind = ToolKind.GROOVING if key == "G" else ToolKind.PARTING
            found[number] = ToolShape(kind, tip=3, width=float(typed["WIDE"]), length=20.0)
    return found


def metal(
    text: list[str],
    dialect: Dialect,
    tools: dict[int, ToolShape] | None = None,
    nose: float = 0.0,
    *,
    right: bool = False,
) -> tuple[np.ndarray, list[str]]:
    """Outer and inner radii of the proved part by Z, and what the proof says against the program."""
    lathe = LINEAR if dialect is OURS else machine()
    setting = PartSettings(stock=parse_stock_specification("bar:30mm:60mm"), shapes=tools or {})
    report, part = prove_program_and_part(
        source(text, dialect), setup_in(dialect, nose, right=right), lathe, setting
    )
    assert part is not None
    assert part.last_piece is not None
    at = np.arange(-30.0, -0.05, 0.0625) + 0.01
    sides = [
        np.array(side)[::-1]
        for side in (part.last_piece.outside_profile, part.last_piece.bore_profile)
        if side
    ]
    found = [np.interp(at, side[:, 0], side[:, 1]) for side in sides]
    said = [
        d.format_one_line("x") for d in report.diagnostics if d.check_name != "depth-of-cut"
    ]  # one pass, as typed
    return np.stack(found), said


@pytest.mark.parametrize("name", STEPS)
def test_shape_removes_the_same_stock_as_in_omniturn_and_is_recognized(name: str) -> None:
    ours, theirs = written(STEPS[name], OURS), written(STEPS[name], THEIRS)
    tools = tools_of(STEPS[name])
    (mine, said), (there, _) = metal(ours, OURS, tools), metal(theirs, THEIRS, tools)
    assert not said, ours
    assert mine.shape == there.shape
    assert np.quantile(np.abs(mine - there), 0.97) <= NEAR  # columns at a wall lie before or behind it
    found = find_program_shapes(ours, SHOP, ProgramSettings(dialect=OURS))
    assert [each.shape_instance.shape.name for each in found][1:] == [
        SHAPES_BY_DIALECT[OURS][key].name for key, _, _ in STEPS[name]
    ]
    for piece, (_, typed, rows) in zip(found[1:], STEPS[name], strict=True):
        assert (piece.edited_line, piece.adopted_field_names, len(piece.shape_instance.contour_points)) == (
            -1,
            (),
            len(rows),
        )
        assert {word: piece.shape_instance.field_values[word] for word in typed} == typed


@pytest.mark.parametrize(
    "typed",
    [
        {"AT": 10.0, "LONG": 5.0, "TOP": 30.0, "BOTTOM": 20.0},
        {"AT": 10.0, "LONG": 2.0, "TOP": 30.0, "BOTTOM": 24.0, "COUNT": 3.0, "PITCH": 5.0},
        {"AT": 10.0, "LONG": 5.0, "TOP": 26.0, "BOTTOM": 20.0, "OVER": 30.0, "CORNER": "RIGHT"},
    ],
)
def test_groove_cycle_equals_its_lines(typed: dict[str, FieldValue]) -> None:
    """The blade of 2 mm has D1 at the corner that was touched off, and D2."""
    turned: Step = (
        "T",
        {"FROM": 30.0},
        (ContourPoint(30.0, 0.0), ContourPoint(z=-9.0), ContourPoint(26.0), ContourPoint(z=-28.0)),
    )
    before = [turned] if "OVER" in typed else []
    steps = [*before, ("G", {"WIDE": 2.0, **typed}, ())]
    cycle = [*before, ("G", {"WIDE": 2.0, "DN": 2.0, **typed}, ())]
    text = written(cycle, OURS)
    assert sum(line.startswith("CYCLE93") for line in text) == typed.get("COUNT", 1.0)
    tools = tools_of(steps)
    if typed.get("CORNER") == "RIGHT":
        tools = {n: replace(each, tip=4) for n, each in tools.items()}
    mine, said = metal(text, OURS, tools, right="CORNER" in typed)
    there, _ = metal(written(steps, OURS), OURS, tools)
    assert not said, text
    assert np.quantile(np.abs(mine - there), 0.97) <= NEAR
    piece = find_program_shapes(text, SHOP, ProgramSettings(dialect=OURS))[-1]
    assert (piece.edited_line, piece.adopted_field_names, piece.shape_instance.field_values["DN"]) == (
        -1,
        (),
        2.0,
    )


@pytest.mark.parametrize(
    ("typed", "word"),
    [({"DN": 1.0}, "DN"), ({"SIDE": "REAR"}, "SIDE"), ({"EDGE": 0.5}, "EDGE"), ({"CANGLE": 10.0}, "FANGLE")],
)
def test_groove_beyond_the_cycle_is_rejected(typed: dict[str, FieldValue], word: str) -> None:
    setting = find_active_settings(written([], OURS), 1, SHOP, ProgramSettings(dialect=OURS))
    groove = {"TOP": 30.0, "BOTTOM": 20.0, "AT": 9.0, "WIDE": 2.0, "LONG": 8.0, "DN": 2.0, **typed}
    one = make_shape_instance(SHAPES_BY_DIALECT[OURS]["G"], groove, setting)
    assert [each.field_name for each in one.find_errors(setting)] == [word]


@pytest.mark.parametrize(
    "typed",
    [
        {"SERIES": "M", "SIZE": "12", "LONG": 12.0},
        {"SERIES": "M", "SIZE": "12", "LONG": 12.0, "SIDE": "BORE", "AT": 2.0},
        {"SERIES": "M", "SIZE": "20", "LONG": 16.0, "STARTS": 2.0},
        {"SERIES": "NPT", "SIZE": "1/4", "LONG": 12.0},
    ],
)
def test_thread_equals_the_omniturn_thread(typed: dict[str, FieldValue]) -> None:
    """The last pass is the thread: radius and Z at its end, its lead, its slope."""
    relief = {"RELIEF": 8.0}
    ours = written([("R", {**typed, **relief}, ())], OURS)
    theirs = written([("R", {**typed, **relief, "PULL": "NO"}, ())], THEIRS)
    last = []
    for program, dialect in ((ours, OURS), (theirs, THEIRS)):
        blocks = SharedProgram(source(program, dialect)).start_pass(setup_in(dialect)).generate_blocks()
        last.append([b for b in blocks if b.kind is BlockKind.THREAD][-1])
    mine, there = last
    assert (mine.x, mine.z, mine.feed) == pytest.approx((there.x, there.z, there.feed), abs=2 * NEAR)
    slopes = [(b.x - b.x0) / (b.z - b.z0) for b in last]
    assert slopes[0] == pytest.approx(slopes[1], abs=1e-3)
    piece = find_program_shapes(ours, SHOP, ProgramSettings(dialect=OURS))[-1]
    assert (piece.edited_line, piece.adopted_field_names) == (-1, ())


def test_generated_program_uses_one_move_per_line_and_cycle95() -> None:
    """One move a line, words apart, CYCLE95 on the contour that the finish runs along, G42 to the right."""
    typed: dict[str, float | str] = {
        "FROM": 30.0,
        "ROUGH": 2.0,
        "COMP": 1.0,
        "FEED": 0.1,
        "RFEED": 0.2,
        "RPM": 1200.0,
    }
    text = written([("T", typed, PROFILE[:4])], OURS, BAR=30.0)
    assert text[0].startswith("G54 G18 G90 G95 G710 DIAMON ; HEAD METRIC UNIT ")
    assert text[2].startswith("T1 D1 ; TURN OUTSIDE SIDE 30 FROM 2 ROUGH ")
    assert text[3:] == [
        "G95 S1200 M3", "G0 X31 Z25", "Z2.5",
        'CYCLE95("CONTOUR_1:CONTOUR_1_END", 2, , , 0.25, 0.2, 0.2, , 1)',
        "G0 X0 Z2.5", "G42", "CONTOUR_1:", "G1 X0 Z0 F0.1", "X12 CHR=1", "Z-12 RND=1", "X18", "X31",
        "CONTOUR_1_END:", "G40", "G0 Z25", "M30",
    ]  # fmt: skip
    assert not metal(text, OURS, nose=0.4)[1]


@pytest.mark.parametrize("head", [{"WORDS": "RADIUS"}, {"UNIT": "INCH"}])
def test_shapes_in_other_modes_are_recognized(head: dict[str, FieldValue]) -> None:
    scale = 1.0 if "WORDS" in head else 1.0 / 25.4
    typed: dict[str, FieldValue] = {"FROM": 30.0 * scale, "ROUGH": 1.0 * scale}
    rows = tuple(ContourPoint(x * scale, z * scale) for x, z in ((0.0, 0.0), (20.0, 0.0), (20.0, -10.0)))
    text = written([("T", typed, rows)], OURS, **head)
    assert text[0].startswith("G54 G18 G90 G95 G700 DIAMON" if scale < 1 else "G54 G18 G90 G95 G710 DIAMOF")
    found, said = metal(text, OURS)
    assert not said
    assert found[0].min() == pytest.approx(10.0, abs=NEAR)
    piece = find_program_shapes(text, SHOP, ProgramSettings(dialect=OURS))[-1]
    assert (piece.edited_line, len(piece.shape_instance.contour_points)) == (-1, 3)


def test_changed_value_is_adopted_and_inserted_line_is_reported() -> None:
    text = written([("D", {"DIA": 6.0, "DEEP": 15.0, "PECK": 0.0}, ())], OURS)
    (at,) = [n for n, line in enumerate(text) if line.startswith("CYCLE81")]
    assert text[at] == "CYCLE81(2.5, 0, 1.25, -15)"
    text[at] = "CYCLE81(2.5, 0, 1.25, -16)"
    piece = find_program_shapes(text, SHOP, ProgramSettings(dialect=OURS))[-1]
    assert (piece.edited_line, piece.adopted_field_names, piece.shape_instance.field_values["DEEP"]) == (
        -1,
        ("DEEP",),
        16.0,
    )
    text.insert(at, "G4 F1")
    assert find_program_shapes(text, SHOP, ProgramSettings(dialect=OURS))[-1].edited_line == at


def test_block_numbers_are_ignored_and_unit_change_converts() -> None:
    text = written([("D", {"DIA": 6.35, "DEEP": 12.7, "PECK": 0.0, "FEED": 0.1016}, ())], OURS)
    numbered = [f"N{10 * n} {line}" for n, line in enumerate(text, 1)]
    before = find_program_shapes(numbered, SHOP, ProgramSettings(dialect=OURS))
    assert [each.edited_line for each in before] == [-1, -1]
    new = ProgramSettings(dialect=OURS)
    head = make_shape_instance(
        SHAPES_BY_DIALECT[OURS]["N"], {"UNIT": "INCH"}, find_active_settings(text, 0, SHOP, new)
    )
    text, _ = insert_shape(text, 0, head, before[0].settings, before[0])
    text, stay = rewrite_program_shapes(text, SHOP, before)
    assert not stay
    assert "CYCLE81(0.1, 0, 0.05, -0.5)" in text


@pytest.mark.parametrize(
    ("key", "typed", "word"),
    [
        ("R", {"SERIES": "M", "SIZE": "12", "LONG": 12.0}, "RELIEF"),
        ("F", {"FROM": 10.0, "TO": 12.0}, "TO"),
        ("T", {"ROUGH": 1.0, "LABEL": 1.5}, "LABEL"),
        ("D", {"DIA": 2.0, "DEEP": 30.0, "PECK": 0.0}, "PECK"),
    ],
)
def test_invalid_value_is_rejected_at_its_field(key: str, typed: dict[str, FieldValue], word: str) -> None:
    setting = find_active_settings(written([], OURS), 1, SHOP, ProgramSettings(dialect=OURS))
    one = make_shape_instance(SHAPES_BY_DIALECT[OURS][key], typed, setting, PROFILE)
    assert [each.field_name for each in one.find_errors(setting)] == [word]


@pytest.fixture
def desk() -> Iterator[ShapesModel]:
    shapes = ShapesModel(lambda: SHOP, ProgramSettings(metric=True), shop_data=SHOP)
    yield shapes
    shapes.close()


def strike(shapes: ShapesModel, keys: str) -> None:
    for key in keys:
        if key == "§":
            shapes.write_form()
        else:
            assert shapes.handle_key({"⏎": "Enter", "↑": "Up"}.get(key, key)), (key, shapes.prompt_text())


def test_the_forms_write_the_language_of_the_program(desk: ShapesModel) -> None:
    """Head and a hole by keys into a program whose name says SINUMERIK; the hole is opened again from it."""
    assert desk.open_program_text("x.mpf", "M30\n", 1) == ""
    strike(desk, "n§d6⏎15§")
    lines = desk.text.splitlines()
    assert lines[0].startswith("G54 G18 G90 G95 G710 DIAMON ; HEAD ")
    assert lines[-3:] == ["G18", "G0 Z25", "M30"]
    assert desk.open_program_text("x.mpf", desk.text, lines.index("CYCLE81(2.5, 0, 1.25, -15)") + 1) == ""
    assert desk.form is not None
    assert desk.form.filled_shape.get_number("DEEP") == 15.0


def test_program_without_a_head_asks_for_one(desk: ShapesModel) -> None:
    assert desk.open_program_text("x.mpf", "%_N_X_MPF\nM30\n", 1) == ""
    strike(desk, "d")
    assert (desk.form, "PRESS N" in desk.notice_text) == (None, True)


def test_unsupported_language_is_rejected(desk: ShapesModel) -> None:
    for helpers in (False, True):
        assert desk.open_program_text("x.h", "", 1, lists_helpers=helpers) == text("shapes.other-language")
