"""Shapes found again in a text: whole, changed by hand, and what is never written over unasked."""

from __future__ import annotations

import pytest

from core.extras.shapes.contour import ContourPoint
from core.extras.shapes.editor_shape import ShapeInstance, make_shape_instance
from core.extras.shapes.shape_fields import FieldValue, ProgramSettings, ShopData
from core.extras.shapes.shape_pieces import (
    ProgramShape,
    find_active_settings,
    find_program_shapes,
    insert_shape,
    rewrite_program_shapes,
)
from core.extras.shapes.shape_table import SHAPES_BY_KEY
from core.part.tool_shape import ToolKind, ToolShape
from tests.extras.shapes.hand import Programmer, bad, proved
from tests.texts import shows
from tests.texts import text as wording

SHOP = ShopData(max_acceleration_mm_s2=3048.0)
PROFILE = (
    ContourPoint(0.0, 0.0),
    ContourPoint(0.5, chamfer=0.05),
    ContourPoint(z=-0.5),
    ContourPoint(0.7, -0.6, arc=0.2),
    ContourPoint(0.7, -0.9),
)
BORED = (
    ContourPoint(0.6, 0.0),
    ContourPoint(0.5, -0.05),
    ContourPoint(z=-0.4),
    ContourPoint(0.3),
    ContourPoint(z=-0.6),
)

Step = tuple[str, dict[str, FieldValue], tuple[ContourPoint, ...]]
STEPS: dict[str, list[Step]] = {
    "face and profile": [
        ("F", {"FROM": 0.75, "STOCK": 0.06}, ()),
        ("T", {"FROM": 0.75, "ROUGH": 0.05, "LEAVE": 0.01}, PROFILE),
    ],
    "profile in a bore": [
        ("D", {"DIA": 0.25, "DEEP": 1.0}, ()),
        ("T", {"SIDE": "BORE", "HOLE": 0.25, "ROUGH": 0.03}, BORED),
    ],
    "taper": [("A", {"FROM": 0.75, "SMALL": 0.4, "LONG": 0.5, "ANGLE": 10.0, "ROUGH": 0.05}, ())],
    "edge of a bore": [
        ("D", {"DIA": 0.25, "DEEP": 1.0}, ()),
        ("K", {"DIAM": 0.25, "EDGE": 0.04, "SIDE": "BORE", "KIND": "RADIUS"}, ()),
    ],
    "groove": [("G", {"TOP": 0.75, "BOTTOM": 0.5, "AT": 0.3, "WIDE": 0.062, "LONG": 0.25, "EDGE": 0.01}, ())],
    "groove with slanted walls behind a flange": [
        (
            "G",
            {
                "TOP": 0.75,
                "BOTTOM": 0.5,
                "AT": 0.3,
                "WIDE": 0.062,
                "LONG": 0.25,
                "FANGLE": 20.0,
                "CANGLE": 5.0,
                "OVER": 1.0,
            },
            (),
        )
    ],
    "thread": [
        (
            "T",
            {"FROM": 0.5},
            (ContourPoint(0.0, 0.0), ContourPoint(0.49, chamfer=0.05), ContourPoint(z=-0.8)),
        ),
        ("R", {"SIZE": "1/2", "LONG": 0.5}, ()),
    ],
    "pipe thread": [
        ("T", {"FROM": 0.6}, (ContourPoint(0.0, 0.0), ContourPoint(0.52, 0.0), ContourPoint(0.56, -0.6))),
        ("R", {"SERIES": "NPT", "SIZE": "1/4"}, ()),
    ],
    "three starts": [
        (
            "T",
            {"FROM": 0.5},
            (ContourPoint(0.0, 0.0), ContourPoint(0.49, chamfer=0.05), ContourPoint(z=-0.8)),
        ),
        ("R", {"SIZE": "1/2", "LONG": 0.5, "STARTS": 3.0}, ()),
    ],
    "part off": [
        ("P", {"FROM": 0.75, "LONG": 0.8, "WIDE": 0.08, "BACK": 0.03, "NEXT": 0.03, "SIDE": "REAR"}, ())
    ],
    "cross holes": [
        ("C", {"DIA": 0.125, "FROM": 0.75, "AT": 0.3, "DEEP": 0.3, "COUNT": 4.0, "ANGLE": 27.5}, ()),
    ],
    "hexagon": [
        ("F", {"FROM": 0.75}, ()),
        ("M", {"DIA": 0.25, "FROM": 0.75, "ACROSS": 0.65, "LONG": 0.2, "DEEP": 0.1}, ()),
    ],
    "two flats": [("M", {"DIA": 0.25, "FROM": 0.75, "ACROSS": 0.65, "LONG": 0.2, "FLATS": 2.0}, ())],
    "slots": [
        ("F", {"FROM": 0.75}, ()),
        (
            "S",
            {"DIA": 0.125, "FROM": 0.75, "AT": 0.2, "LONG": 0.5, "DEEP": 0.1, "PASS": 0.05, "COUNT": 3.0},
            (),
        ),
    ],
    "bar loop": [
        ("L", {"COUNT": 3.0, "LONG": 0.9}, ()),
        ("F", {"FROM": 0.75}, ()),
        (
            "T",
            {"FROM": 0.75},
            (ContourPoint(0.0, 0.0), ContourPoint(0.5), ContourPoint(z=-0.5), ContourPoint(0.75)),
        ),
        ("P", {"FROM": 0.75, "LONG": 0.8, "WIDE": 0.1}, ()),
    ],
}


def written(steps: list[Step], **head: FieldValue) -> list[str]:
    """The program of these shapes, head first."""
    text: list[str] = []
    behind = 0
    for key, typed, rows in [("N", head, ()), *steps]:
        setting = find_active_settings(text, behind, SHOP)
        one = make_shape_instance(SHAPES_BY_KEY[key], typed, setting, rows)
        assert not one.find_errors(setting), one.find_errors(setting)
        text, behind = insert_shape(text, behind, one, setting)
    return text


def only(text: list[str], name: str) -> ProgramShape:
    (found,) = [each for each in find_program_shapes(text, SHOP) if each.shape_instance.shape.name == name]
    return found


@pytest.mark.parametrize("name", STEPS)
def test_every_written_shape_proves_and_is_recognized_again(name: str) -> None:
    """Strict, as the original control takes it: no finding at all."""
    text = written(STEPS[name])
    report, _ = proved("\n".join(text) + "\n")
    assert not bad(report), (bad(report), text)
    found = find_program_shapes(text, SHOP)
    assert [each.shape_instance.shape.name for each in found] == [
        "HEAD",
        *(SHAPES_BY_KEY[key].name for key, _, _ in STEPS[name]),
    ]
    assert all(each.edited_line < 0 and not each.adopted_field_names for each in found)
    for piece, (_, typed, rows) in zip(found[1:], STEPS[name], strict=True):
        assert {word: piece.shape_instance.field_values[word] for word in typed} == typed
        assert len(piece.shape_instance.contour_points) == len(rows)


@pytest.mark.parametrize("head", [{"WORDS": "RADIUS"}, {"UNIT": "METRIC"}])
def test_shapes_in_other_modes_are_recognized(head: dict[str, FieldValue]) -> None:
    scale = 25.4 if "UNIT" in head else 1.0
    typed: dict[str, float | str] = {
        "FROM": 0.75 * scale,
        "LONG": 0.8 * scale,
        "WIDE": 0.08 * scale,
        "BACK": 0.03 * scale,
    }
    text = written([("P", typed, ())], **head)
    report, _ = proved("\n".join(text) + "\n")
    assert not bad(report)
    assert only(text, "PART OFF").shape_instance.field_values["FROM"] == pytest.approx(0.75 * scale)


def changed(text: list[str], before: str, after: str) -> list[str]:
    (at,) = [n for n, line in enumerate(text) if line == before]
    return [*text[:at], after, *text[at + 1 :]]


def test_manually_changed_feed_is_adopted() -> None:
    text = changed(written(STEPS["thread"][:1]), "G95F.003Z0", "G95F.002Z0")
    piece = only(text, "TURN")
    assert (piece.edited_line, piece.adopted_field_names, piece.shape_instance.field_values["FEED"]) == (
        -1,
        ("FEED",),
        0.002,
    )


def test_manually_changed_depth_and_speed_are_adopted() -> None:
    text = written([("D", {"DIA": 0.25, "DEEP": 0.6}, ())])
    (speed,) = [line for line in text if line.startswith("M03S")]
    (hole,) = [line for line in text if line.startswith("G81")]
    text = changed(changed(text, speed, "M03S900"), hole, hole.replace("Z-.6", "Z-.65"))
    piece = only(text, "DRILL")
    assert piece.edited_line == -1
    assert (piece.shape_instance.field_values["RPM"], piece.shape_instance.field_values["DEEP"]) == (
        900.0,
        0.65,
    )


def test_manually_changed_points_are_adopted() -> None:
    text = changed(written([("T", {"FROM": 0.5}, PROFILE[:3])]), "Z-.5", "Z-.55")
    piece = only(text, "TURN")
    assert piece.edited_line == -1
    assert piece.shape_instance.contour_points[2] == ContourPoint(z=-0.55)


def test_manually_inserted_line_is_reported_and_not_adopted() -> None:
    text = written([("D", {"DIA": 0.25, "DEEP": 0.6}, ())])
    (at,) = [n for n, line in enumerate(text) if line.startswith("G81")]
    text.insert(at, "G04F1")
    piece = only(text, "DRILL")
    assert piece.edited_line == at
    assert piece.next_line == text.index("M30")


def test_unexplained_value_is_reported_as_edited() -> None:
    text = changed(written([("D", {"DIA": 0.25, "DEEP": 0.6}, ())]), "Z.05", "Z.75")
    assert only(text, "DRILL").edited_line >= 0


def test_lines_between_shapes_stay() -> None:
    text = written(STEPS["thread"])
    second = only(text, "THREAD")
    text[second.first_line : second.first_line] = ["M01(LOOK AT THE DIAMETER)"]
    found = find_program_shapes(text, SHOP)
    assert [each.edited_line for each in found] == [-1, -1, -1]
    again, _ = insert_shape(text, 0, found[1].shape_instance, found[1].settings, found[1])
    assert again == text


def test_unrelated_comments_are_not_shapes() -> None:
    assert not find_program_shapes(
        ["G90G94F300(HEAD OF THE LINE)", "T1(DRILL)", "T2(FACE 1 TWO)", "M30"], SHOP
    )


def test_unit_change_converts_written_shapes() -> None:
    """A drill of .25 in is one of 6.35 mm: no figure keeps its digits under another unit."""
    text = written([("D", {"DIA": 0.25, "DEEP": 0.6, "FEED": 0.004}, ())])
    before = find_program_shapes(text, SHOP)
    head = make_shape_instance(SHAPES_BY_KEY["N"], {"UNIT": "METRIC"}, find_active_settings(text, 0, SHOP))
    text, _ = insert_shape(text, 0, head, before[0].settings, before[0])
    text, stay = rewrite_program_shapes(text, SHOP, before)
    drill = only(text, "DRILL").shape_instance
    assert not stay
    assert (drill.field_values["DIA"], drill.field_values["DEEP"], drill.field_values["FEED"]) == (
        6.35,
        15.24,
        0.1016,
    )
    assert not bad(proved("\n".join(text) + "\n")[0])


def test_edited_shape_is_left_and_counted_on_unit_change() -> None:
    text = written([("D", {"DIA": 0.25, "DEEP": 0.6}, ())])
    text.insert(-2, "G04F1")
    before = find_program_shapes(text, SHOP)
    again, stay = rewrite_program_shapes(text, SHOP, before)
    assert (again, stay) == (text, 1)


def refused(key: str, typed: dict[str, FieldValue], rows: tuple[ContourPoint, ...] = ()) -> dict[str, str]:
    setting = find_active_settings(written([]), 1, SHOP)
    one: ShapeInstance = make_shape_instance(SHAPES_BY_KEY[key], typed, setting, rows)
    return {each.field_name: each.message for each in one.find_errors(setting)}


@pytest.mark.parametrize(
    ("key", "typed", "word"),
    [
        ("F", {"FROM": 0.5, "TO": 0.6}, "TO"),
        ("F", {"FROM": 0.5, "RPM": 9000.0}, "RPM"),
        ("F", {"FROM": 0.5, "FEED": 3.0}, "FEED"),
        ("F", {"FROM": 0.5, "T": 33.0}, "T"),
        ("F", {"FROM": 0.5, "T": 1.5}, "T"),
        ("F", {}, "FROM"),
        ("A", {"SMALL": 0.5, "LARGE": 0.4, "LONG": 1.0}, "LARGE"),
        ("K", {"DIAM": 0.5, "EDGE": 0.3}, "EDGE"),
        ("G", {"TOP": 0.5, "BOTTOM": 0.4, "AT": 0.1, "WIDE": 0.125, "LONG": 0.1}, "LONG"),
        ("G", {"TOP": 0.5, "BOTTOM": 0.6, "AT": 0.1, "WIDE": 0.06}, "BOTTOM"),
        ("G", {"TOP": 0.5, "BOTTOM": 0.4, "AT": 0.1, "WIDE": 0.06, "SIDE": "BORE"}, "BOTTOM"),
        ("G", {"TOP": 0.5, "BOTTOM": 0.4, "AT": 0.1, "WIDE": 0.06, "COUNT": 3.0, "PITCH": 0.05}, "PITCH"),
        ("G", {"TOP": 0.5, "BOTTOM": 0.4, "AT": 0.1, "WIDE": 0.06, "OVER": 0.45}, "OVER"),
        ("G", {"TOP": 0.5, "BOTTOM": 0.3, "AT": 0.1, "WIDE": 0.06, "LONG": 0.12, "FANGLE": 45.0}, "LONG"),
        ("G", {"TOP": 0.5, "BOTTOM": 0.4, "AT": 0.1, "WIDE": 0.06, "LONG": 0.2, "CANGLE": -5.0}, "CANGLE"),
        (
            "G",
            {"TOP": 0.5, "BOTTOM": 0.4, "AT": 0.1, "WIDE": 0.06, "LONG": 0.2, "FANGLE": 20.0, "EDGE": 0.01},
            "EDGE",
        ),
        ("P", {"FROM": 0.5, "LONG": 0.5, "WIDE": 0.06, "TO": 0.5}, "TO"),
        ("P", {"FROM": 0.5, "LONG": 0.5, "WIDE": 0.06, "BACK": 0.3}, "BACK"),
        ("D", {"DIA": 0.25, "DEEP": 0.5, "START": 0.6}, "START"),
        ("D", {"DIA": 0.1, "DEEP": 1.0, "PECK": 0.0}, "PECK"),
        ("B", {"HOLE": 0.5, "DIAM": 0.4, "DEEP": 0.5}, "HOLE"),
        ("B", {"HOLE": 0.3, "DIAM": 0.4, "DEEP": 0.1, "EDGE": 0.2}, "EDGE"),
        ("C", {"DIA": 0.1, "FROM": 0.5, "AT": 0.2, "DEEP": 0.6}, "DEEP"),
        ("C", {"DIA": 0.1, "FROM": 0.5, "AT": 0.2, "DEEP": 0.1, "COUNT": 5.0, "STEP": 90.0}, "STEP"),
        ("M", {"DIA": 0.25, "FROM": 0.5, "ACROSS": 0.5, "LONG": 0.2}, "ACROSS"),
        ("M", {"DIA": 0.25, "FROM": 0.5, "ACROSS": 0.45, "LONG": 0.2, "CORNERS": "SHARP"}, "ACROSS"),
        ("S", {"DIA": 0.1, "FROM": 0.5, "DEEP": 0.1}, "LONG"),
        ("S", {"DIA": 0.1, "FROM": 0.5, "LONG": 0.2, "DEEP": 0.3}, "DEEP"),
    ],
)
def test_invalid_value_is_rejected_at_its_field(key: str, typed: dict[str, FieldValue], word: str) -> None:
    said = refused(key, typed)
    assert list(said) == [word], said
    assert said[word][-1] in ".?"


@pytest.mark.parametrize(
    ("rows", "word"),
    [
        ((ContourPoint(0.0, 0.0),), "#2"),
        ((ContourPoint(0.5), ContourPoint(z=-0.5)), "#1"),
        ((ContourPoint(0.5, 0.0), ContourPoint(0.5)), "#2"),
        ((ContourPoint(0.4, 0.0), ContourPoint(1.0, 0.0, arc=0.1)), "#2"),
        ((ContourPoint(0.4, 0.0), ContourPoint(0.5, chamfer=0.2), ContourPoint(z=-0.1)), "#2"),
        ((ContourPoint(0.4, 0.0), ContourPoint(z=-0.5, radius=0.1)), "#2"),
        ((ContourPoint(0.4, 0.0), ContourPoint(-0.2), ContourPoint(z=-1.0)), "#2"),
    ],
)
def test_invalid_contour_is_rejected_at_its_point(rows: tuple[ContourPoint, ...], word: str) -> None:
    assert word in refused("T", {}, rows)


def test_unsuitable_tool_is_rejected_and_not_proposed() -> None:
    sheets = {1: ToolShape(ToolKind.TURNING, insert="CNMG432"), 3: ToolShape(ToolKind.DRILL, diameter=6.35)}
    setting = ProgramSettings(shop=ShopData(tools=sheets))
    thread = make_shape_instance(SHAPES_BY_KEY["R"], {"SIZE": "1/2", "LONG": 0.5}, setting)
    assert (thread.get_number("T"), thread.find_errors(setting)) == (2.0, [])
    drill = make_shape_instance(SHAPES_BY_KEY["D"], {"DEEP": 0.5}, setting)
    assert (drill.get_number("T"), drill.get_number("DIA")) == (3.0, 0.25)
    wrong = make_shape_instance(SHAPES_BY_KEY["R"], {"SIZE": "1/2", "LONG": 0.5, "T": 3.0}, setting)
    assert "T" in {each.field_name for each in wrong.find_errors(setting)}


def test_boring_tool_is_proposed_for_a_bore() -> None:
    sheets = {1: ToolShape(ToolKind.TURNING), 2: ToolShape(ToolKind.BORING), 3: ToolShape(ToolKind.THREADING)}
    setting = ProgramSettings(shop=ShopData(tools=sheets))
    assert make_shape_instance(SHAPES_BY_KEY["T"], {}, setting).get_number("T") == 1.0
    assert make_shape_instance(SHAPES_BY_KEY["T"], {"SIDE": "BORE"}, setting).get_number("T") == 2.0
    assert make_shape_instance(SHAPES_BY_KEY["R"], {"SIZE": "1/2"}, setting).get_number("T") == 3.0
    assert (
        make_shape_instance(SHAPES_BY_KEY["R"], {"SIZE": "1/2", "SIDE": "BORE"}, setting).get_number("T")
        == 4.0
    )


@pytest.mark.parametrize(
    ("key", "typed", "sheet", "word"),
    [
        ("D", {"DIA": 0.25, "DEEP": 2.0, "PECK": 0.25}, ToolShape(ToolKind.DRILL, length=38.1), "DEEP"),
        ("D", {"DIA": 0.3, "DEEP": 0.5}, ToolShape(ToolKind.DRILL, diameter=6.35), "DIA"),
        ("B", {"HOLE": 0.3, "DIAM": 0.5, "DEEP": 0.5}, ToolShape(ToolKind.BORING, diameter=10.0), "T"),
        ("B", {"HOLE": 0.5, "DIAM": 0.6, "DEEP": 2.0}, ToolShape(ToolKind.BORING, stick_out=25.4), "DEEP"),
        (
            "G",
            {"TOP": 1.0, "BOTTOM": 0.2, "AT": 0.1},
            ToolShape(ToolKind.GROOVING, width=3.0, length=6.0),
            "BOTTOM",
        ),
        ("P", {"FROM": 1.0, "LONG": 0.5}, ToolShape(ToolKind.PARTING, width=2.0, length=10.0), "FROM"),
        ("R", {"SIZE": "1/2", "LONG": 0.5}, ToolShape(ToolKind.THREADING, point=55.0), "T"),
        ("R", {"SIZE": "1/2", "LONG": 0.5}, ToolShape(ToolKind.THREADING, pitch=1.5), "T"),
    ],
)
def test_operation_beyond_the_tool_is_rejected(
    key: str, typed: dict[str, FieldValue], sheet: ToolShape, word: str
) -> None:
    setting = ProgramSettings(shop=ShopData(tools={1: sheet}))
    said = make_shape_instance(SHAPES_BY_KEY[key], typed, setting).find_errors(setting)
    assert [each.field_name for each in said] == [word], said


def test_nose_compensation_in_a_bar_loop_is_refused() -> None:
    text = written(STEPS["bar loop"][:1])
    setting = find_active_settings(text, len(text) - 1, SHOP)
    assert setting.is_subroutine
    one = make_shape_instance(SHAPES_BY_KEY["T"], {"COMP": 1.0}, setting, PROFILE[:3])
    assert [each.field_name for each in one.find_errors(setting)] == ["COMP"]


DRILLED = "T1(DRILL 0P25 DIA 0P5 DEEP 0 PECK 0P004 FEED 1200 RPM)"


@pytest.mark.parametrize("line", [3, 6, 9])
@pytest.mark.parametrize(
    "spoilt",
    [DRILLED.replace("DEEP", "DEEPER"), DRILLED.replace(")", " BY JOE)"), DRILLED.removeprefix("T1")],
)
def test_damaged_shape_comment_is_reported_with_its_line(spoilt: str, line: int) -> None:
    text = Programmer().strike("n§d.25⏎.5§").close()
    assert DRILLED in text
    hand = Programmer(text=text)
    hand.open(text.replace(DRILLED, spoilt), line)
    assert hand.shapes.form is None
    assert hand.shapes.prompt_text() == wording("shapes.comment-edited", line=3, shape="DRILL")


@pytest.mark.parametrize(
    ("comment", "line"), [("(DRILL)", 3), ("(DRILL .25 DIA BY HAND)", 5), (DRILLED.removeprefix("T1"), 2)]
)
def test_foreign_comment_is_not_a_shape_comment(comment: str, line: int) -> None:
    """Of the last one the cursor stands in the head, which can be read."""
    text = Programmer().strike("n§d.25⏎.5§").close()
    hand = Programmer(text=text)
    hand.open(text.replace(DRILLED, f"T1{comment}" if line > 2 else comment), line)
    assert not shows(hand.shapes.prompt_text(), "shapes.comment-edited")
