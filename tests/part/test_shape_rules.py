"""Shapes of tools that contradict themselves, each with a twin that does not; and texts of holders."""

from dataclasses import replace

import pytest

from core.part.insert_codes import ToolHolder, parse_holder
from core.part.shape_rules import FIELDS_BY_KIND, find_shape_mistakes
from core.part.tool_shape import ToolHand, ToolKind, ToolShape

STAR = ((0.0, 2.0), (2.0, 2.0), (0.5, 0.0), (1.0, 3.0), (1.5, 0.0))
SOUND = {
    "insert": ToolShape(tip=3, insert="CNMG432"),
    "nose_radius": ToolShape(ToolKind.GROOVING, width=2.0, nose_radius=0.4),
    "entry": ToolShape(tip=3, insert="SNMG432", entry=75.0),
    "tip": ToolShape(ToolKind.DRILL, tip=7),
    "length": ToolShape(ToolKind.DRILL, length=40.0, stick_out=60.0),
    "width": ToolShape(ToolKind.CENTER_DRILL, diameter=5.0, width=2.0),
    "pitch": ToolShape(ToolKind.TAP, diameter=6.0, pitch=1.0),
    "profile": ToolShape(ToolKind.FORM, profile=((0.0, 0.0), (2.0, 0.0), (1.0, 1.0))),
    "holder": ToolShape(tip=3, holder="0,10 20,10 20,50 0,50"),
}


@pytest.mark.parametrize(
    ("field", "value", "code"),
    [
        ("insert", "CNXG432", "unknown-character"),
        ("nose_radius", 1.1, "corners-too-wide"),
        ("entry", 95.0, "no-clearance"),
        ("tip", 3, "not-an-end"),
        ("length", 61.0, "too-long"),
        ("width", 5.0, "pilot-too-thick"),
        ("pitch", 3.0, "pitch-too-coarse"),
        ("profile", STAR, "crosses-itself"),
        ("profile", ((0.0, 0.0), (1.0, 1.0)), "too-few-points"),
        ("profile", ((0.0, 0.0), (1.0, 1.0), (2.0, 2.0)), "too-few-points"),
        ("holder", "0,0 4,4 4,0 0,5", "crosses-itself"),
    ],
)
def test_contradictory_field_is_reported_and_valid_one_is_not(field: str, value: object, code: str) -> None:
    assert find_shape_mistakes(SOUND[field]) == ()
    (mistake,) = find_shape_mistakes(replace(SOUND[field], **{field: value}))  # type: ignore[arg-type]
    assert (mistake.field_name, mistake.code) == (field, code)


def test_nose_radius_larger_than_insert_or_mill_is_reported() -> None:
    assert not find_shape_mistakes(ToolShape(tip=3, insert="CNMG432", nose_radius=6.3))
    assert (
        find_shape_mistakes(ToolShape(tip=3, insert="CNMG432", nose_radius=6.4))[0].field_name
        == "nose_radius"
    )
    assert not find_shape_mistakes(ToolShape(ToolKind.END_MILL, diameter=6.0, nose_radius=3.0))
    assert (
        find_shape_mistakes(ToolShape(ToolKind.END_MILL, diameter=6.0, nose_radius=3.1))[0].field_name
        == "nose_radius"
    )


@pytest.mark.parametrize(
    ("kind", "right", "wrong"),
    [(ToolKind.TURNING, 2, 3), (ToolKind.PARTING, 6, 8), (ToolKind.BORING, 3, 2)],
)
def test_tip_of_rear_tool_must_match_its_side(kind: ToolKind, right: int, wrong: int) -> None:
    assert find_shape_mistakes(ToolShape(kind, tip=right, rear=True)) == ()
    (mistake,) = find_shape_mistakes(ToolShape(kind, tip=wrong, rear=True))
    assert (mistake.field_name, mistake.code) == ("tip", "tool-in-front")
    assert find_shape_mistakes(ToolShape(kind, tip=wrong)) == ()


def test_entering_angle_of_holder_is_checked() -> None:
    assert find_shape_mistakes(ToolShape(tip=3, insert="SNMG432", holder="MSRNR 2020K12")) == ()
    assert (
        find_shape_mistakes(ToolShape(tip=3, insert="SNMG432", holder="MCLNR 2020K12"))[0].field_name
        == "entry"
    )


@pytest.mark.parametrize("letter", list("CDEMSVTWPHO"))
def test_standard_holders_give_clearance_to_every_insert(letter: str) -> None:
    for kind, tip in ((ToolKind.TURNING, 3), (ToolKind.BORING, 2)):
        assert find_shape_mistakes(ToolShape(kind, tip=tip, insert=f"{letter}NMG432")) == ()


def test_every_tool_kind_has_valid_fields() -> None:
    assert set(FIELDS_BY_KIND) == set(ToolKind)
    for fields in FIELDS_BY_KIND.values():
        assert set(fields) <= set(ToolShape.__slots__)


@pytest.mark.parametrize(
    ("kind", "hand", "rear", "points"),
    [
        (ToolKind.TURNING, ToolHand.RIGHT, False, (-1, -1)),
        (ToolKind.TURNING, ToolHand.LEFT, False, (1, -1)),
        (ToolKind.TURNING, ToolHand.RIGHT, True, (-1, 1)),
        (ToolKind.BORING, ToolHand.RIGHT, False, (-1, 1)),
        (ToolKind.BORING, ToolHand.RIGHT, True, (-1, -1)),
        (ToolKind.THREADING, ToolHand.NEUTRAL, False, (0, -1)),
        (ToolKind.DRILL, ToolHand.RIGHT, False, (-1, 0)),
    ],
)
def test_kind_and_hand_set_tip_direction_without_quadrant(
    kind: ToolKind, hand: ToolHand, rear: bool, points: tuple[int, int]
) -> None:
    assert ToolShape(kind, hand, rear=rear).direction == points


@pytest.mark.parametrize(
    ("text", "width", "reach", "entry"),
    [
        ("20x20", 20.0, 25.0, 0.0),
        ("25x20 mm", 20.0, 25.0, 0.0),
        ('3/4"', 19.05, 25.4, 0.0),
        ("3/4", 19.05, 25.4, 0.0),
        (".5 in", 12.7, 15.875, 0.0),
        ("16mm", 16.0, 20.0, 0.0),
        ("MCLNR 2020K12", 20.0, 25.0, 95.0),
        ("DDJNL 2525M15", 25.0, 32.0, 93.0),
        ("SVVCN 2020K16", 20.0, 10.0, 72.5),
        ("MCLNR-124B", 19.05, 25.4, 95.0),
        ("MTJNR 16-3", 25.4, 31.75, 93.0),
    ],
)
def test_holder_is_parsed_from_size_or_code(text: str, width: float, reach: float, entry: float) -> None:
    """ISO 5608: shank 20 has f 25, 25 has 32; ANSI B212.5: 3/4 in has 1 in, 1 in has 1 1/4 in."""
    holder = parse_holder(text)
    assert holder is not None
    assert (holder.shank_width_mm, holder.reach_mm, holder.entering_angle_deg) == pytest.approx(
        (width, reach, entry)
    )


def test_boring_bar_is_parsed_from_code() -> None:
    assert parse_holder("S16R-SCLCR09") == ToolHolder(bar_diameter_mm=16.0, entering_angle_deg=95.0)
    assert parse_holder("A10-SCLCR2") == ToolHolder(bar_diameter_mm=15.875, entering_angle_deg=95.0), (
        "ten sixteenths of an inch"
    )
    assert parse_holder("S12M STFCR 11") == ToolHolder(bar_diameter_mm=12.0, entering_angle_deg=91.0)


@pytest.mark.parametrize(
    "text", ["", "20", "the old one", "3/0", "0x0", "1,2 3,4", "1..2,3 4,5 6,7", "999mm", "MCLNR"]
)
def test_other_texts_are_holder_names(text: str) -> None:
    assert parse_holder(text) is None


@pytest.mark.parametrize(
    ("kind", "tip", "rear", "behind"),
    [
        (ToolKind.TURNING, 3, False, False),
        (ToolKind.TURNING, 2, False, True),
        (ToolKind.TURNING, 0, True, True),
        (ToolKind.PARTING, 6, False, True),
        (ToolKind.BORING, 2, False, False),
        (ToolKind.BORING, 3, False, True),
        (ToolKind.DRILL, 7, False, False),
        (ToolKind.END_MILL, 6, False, True),
        (ToolKind.END_MILL, 8, False, False),
    ],
)
def test_tip_quadrant_sets_front_or_rear_side(kind: ToolKind, tip: int, rear: bool, behind: bool) -> None:
    assert ToolShape(kind, tip=tip, rear=rear).is_rear_tool is behind
