"""Rough passes are proposed by material, insert and machine; what the insert cannot take is refused."""

from __future__ import annotations

from dataclasses import replace

import pytest

import resources
from app.compose.machine.machine_files import parse_machine
from app.extras.shapes.shapes_setup import make_shop_data
from core.extras.shapes.contour import ContourPoint
from core.extras.shapes.cutting_data import (
    CUTTING_DATA,
    find_max_cutting_depth,
    propose_facing_depth,
    propose_finish_allowance,
    propose_roughing_depth,
)
from core.extras.shapes.editor_shape import ShapeInstance, make_shape_instance
from core.extras.shapes.shape_fields import FieldValue, ProgramSettings, ShopData
from core.extras.shapes.shape_table import CALCULATORS_BY_DIALECT, SHAPES_BY_DIALECT
from core.language.source import Dialect
from core.part.tool_shape import ToolKind, ToolShape
from tests.extras.shapes.hand import Programmer, bad, proved


def turning(insert: str, **more: float) -> ToolShape:
    return ToolShape(ToolKind.TURNING, tip=3, insert=insert, **more)  # type: ignore[arg-type]


BAR = ToolShape(ToolKind.BORING, tip=2, insert="CCMT060204", diameter=8.0, stick_out=60.0)
CNMG, VNMG = turning("CNMG120408"), turning("VNMG160404")


def setting(
    material: str = "STEEL", tools: dict[int, ToolShape] | None = None, rpm: float = 3500.0, **more: object
) -> ProgramSettings:
    shop = ShopData(max_rpm=rpm, tools=tools or {})
    return ProgramSettings(material=material, shop=shop, bar=1.0, **more)  # type: ignore[arg-type]


def one(
    key: str,
    typed: dict[str, FieldValue],
    now: ProgramSettings,
    rows: tuple[ContourPoint, ...] = (),
    *,
    helper: bool = False,
) -> ShapeInstance:
    return make_shape_instance(
        (CALCULATORS_BY_DIALECT if helper else SHAPES_BY_DIALECT)[now.dialect][key], typed, now, rows
    )


def refused(made: ShapeInstance, now: ProgramSettings) -> list[str]:
    return [each.field_name for each in made.find_errors(now)]


# --- the most that an insert takes; C 12 has a circle of 12.7 mm and an edge of 12.7 / sin 80 = 12.896 mm


@pytest.mark.parametrize(
    ("insert", "most"),
    [
        ("CNMG120408", 6.448),  # 80 degrees: 12.896 / 2
        ("DNMG150408", 5.168),  # 55 degrees: 12.7 / sin 55 / 3
        ("VNMG160404", 3.321),  # 35 degrees: 9.525 / sin 35 / 5
        ("TNMG160404", 5.499),  # 60 degrees: 9.525 x tan 60 / 3
        ("RCMT1204M0", 3.0),  # round: 12 / 4
        ("CCMT060204", 3.224),  # 6.35 / sin 80 / 2
        ("", 3.224),  # a small holder is assumed
    ],
)
def test_maximum_depth_depends_on_the_insert(insert: str, most: float) -> None:
    assert find_max_cutting_depth(setting(tools={1: turning(insert)}, metric=True), 1) == pytest.approx(
        most, abs=1e-3
    )


# --- the proposal is the least of three values, rounded down to .005 in or 0.1 mm


@pytest.mark.parametrize(
    ("material", "tool", "across", "rpm", "depth"),
    [
        # By material: inch a side of the table; the insert would take 6.448 / 4 = 1.612 mm = .063 in.
        ("STEEL", CNMG, 0.5, 3500.0, 0.04),
        ("STAINLESS", CNMG, 0.5, 3500.0, 0.03),
        ("TITANIUM", CNMG, 0.5, 3500.0, 0.02),
        ("", CNMG, 0.5, 3500.0, 0.02),
        ("ALUMINIUM", CNMG, 0.5, 3500.0, 0.06),
        # By insert: 3.321 / 4 = 0.830 mm = .0327 in; without a sheet 3.224 / 4 = 0.806 mm = .0317 in.
        ("ALUMINIUM", VNMG, 0.5, 3500.0, 0.03),
        ("ALUMINIUM", turning(""), 0.5, 3500.0, 0.03),
        # By machine: 1500 W at 3500 rpm are 4.093 N m. On 2 in steel at .005 in/rev:
        # 4.093 / (2600 x 0.127 x 0.0254) = 0.488 mm = .0192 in; at 7000 rpm half of it, .0096 in.
        ("STEEL", CNMG, 2.0, 3500.0, 0.015),
        ("STEEL", CNMG, 2.0, 7000.0, 0.005),
        # A depth is proposed also where the rule would give less than one step.
        ("STEEL", CNMG, 20.0, 7000.0, 0.005),
    ],
)
def test_roughing_depth_depends_on_material_insert_and_machine(
    material: str, tool: ToolShape, across: float, rpm: float, depth: float
) -> None:
    assert propose_roughing_depth(setting(material, {1: tool}, rpm), 1, across) == pytest.approx(depth)


@pytest.mark.parametrize(
    ("stated", "depth"),
    [
        # 4.093 N m of 1.5 kW give 0.488 mm or .0192 in on 2 in steel; 3 kW give .0384 in, .75 kW .0096 in
        ("", 0.015), ("power_kw = 1.5", 0.015), ("power_kw = 3", 0.035), ("power_kw = 0.75", 0.005),
        ("power_kw = 30", 0.04),  # the material allows no more
    ],
)  # fmt: skip
def test_roughing_depth_depends_on_spindle_power(stated: str, depth: float) -> None:
    text = resources.read_machine_file("gt75.toml").replace("[spindle]\n", f"[spindle]\n{stated}\n", 1)
    shop = make_shop_data(parse_machine(text, "t"), {1: CNMG})
    now = replace(setting("STEEL"), shop=shop)
    assert propose_roughing_depth(now, 1, 2.0) == pytest.approx(depth)


def test_metric_facing_boring_and_finishing_values_are_proposed() -> None:
    """Steel .04 in = 1.016 mm; on 25 mm 4.093 / (2600 x 0.127 x 0.0125) = 0.992 mm; half of it for a bar."""
    now = setting(tools={1: CNMG, 2: BAR}, metric=True)
    assert propose_roughing_depth(now, 1, 25.0) == pytest.approx(0.9)
    assert propose_facing_depth(now, 1, 25.0) == pytest.approx(0.6)  # 3/4 of 0.9 = 0.675
    assert propose_roughing_depth(now, 2, 12.0, is_inside=True) == pytest.approx(0.4)  # 3.224 / 4 / 2 = 0.403
    assert propose_finish_allowance(now, 0.9) == 0.25
    assert propose_finish_allowance(now, 0.4) == pytest.approx(0.2)  # at most half a rough pass


@pytest.mark.parametrize("material", CUTTING_DATA)
@pytest.mark.parametrize("metric", [False, True])
def test_every_material_has_a_conservative_depth(material: str, metric: bool) -> None:
    """0.5 mm to 1.6 mm on small stock, and never more than the insert takes."""
    now = setting(material, {1: CNMG}, metric=metric)
    depth = propose_roughing_depth(now, 1, 8.0 if metric else 0.3)
    assert 0.5 <= depth * now.mm <= 1.6
    assert depth < find_max_cutting_depth(now, 1)
    assert 0.0 < propose_finish_allowance(now, depth) < depth


# --- the forms


STEPPED = (ContourPoint(0.5, 0.0), ContourPoint(z=-0.5), ContourPoint(0.7, radius=0.1), ContourPoint(z=-1.1))
FORMS: dict[str, tuple[str, dict[str, FieldValue], tuple[ContourPoint, ...], float]] = {
    "turn": ("T", {"T": 1.0}, STEPPED, 0.035),  # 1 in steel: 0.976 mm = .0384 in by the machine
    "turn from the axis": (
        "T",
        {"T": 1.0},
        (ContourPoint(0.0, 0.0), ContourPoint(0.5), ContourPoint(z=-1.0)),
        0.035,
    ),
    "turn without a bar": ("T", {"T": 1.0, "FROM": 0.0}, STEPPED, 0.04),  # .1 in from .7 to .5
    "turn a bore": (
        "T",
        {"SIDE": "BORE", "T": 2.0, "HOLE": 0.4},
        (ContourPoint(0.6, 0.0), ContourPoint(z=-0.5)),
        0.015,
    ),
    "taper": ("A", {"T": 1.0, "SMALL": 0.5, "LARGE": 0.9, "LONG": 1.0}, (), 0.035),
    "bore": ("B", {"T": 2.0, "HOLE": 0.4, "DIAM": 0.6, "DEEP": 0.5}, (), 0.015),
}


@pytest.mark.parametrize("dialect", [Dialect.OMNITURN, Dialect.SINUMERIK])
@pytest.mark.parametrize("name", FORMS)
def test_every_contour_shape_is_roughed(name: str, dialect: Dialect) -> None:
    key, typed, rows, depth = FORMS[name]
    now = setting(tools={1: CNMG, 2: BAR}, dialect=dialect)
    made = one(key, typed, now, rows)
    assert not made.find_errors(now)
    assert (made.get_number("ROUGH"), made.get_number("LEAVE")) == pytest.approx(
        (depth, min(0.01, depth / 2))
    )
    code = {Dialect.OMNITURN: "G75I", Dialect.SINUMERIK: "CYCLE95("}[dialect]
    assert any(line.startswith(code) for line in made.make_lines(now))


@pytest.mark.parametrize(
    ("typed", "rows"),
    [
        ({"FROM": 0.52}, STEPPED[:2]),  # .01 in a side is left for finishing already
        ({"FROM": 1.0}, (ContourPoint(0.0, 0.0), ContourPoint(1.0))),  # along the face alone
        (
            {"FROM": 0.7},
            (ContourPoint(0.6, -1.0), ContourPoint(z=0.0)),
        ),  # to the face, which roughing does not
        ({"FROM": 0.0}, (ContourPoint(0.5, 0.0), ContourPoint(z=-1.0))),  # nothing is known of the stock
    ],
)
def test_roughing_is_not_proposed_without_stock_to_remove(
    typed: dict[str, FieldValue], rows: tuple[ContourPoint, ...]
) -> None:
    now = setting(tools={1: CNMG})
    made = one("T", {"T": 1.0, **typed}, now, rows)
    assert made.get_number("ROUGH") == 0.0
    assert not made.find_errors(now)


def test_the_templates_of_roughing_follow_the_same_rule() -> None:
    for dialect in (Dialect.OMNITURN, Dialect.SINUMERIK):
        now = setting("TITANIUM", {1: CNMG}, used=frozenset({1}), dialect=dialect)
        made = one("G", {"FROM": 0.5}, now, helper=True)
        assert (made.get_number("ROUGH"), made.get_number("LEAVE")) == pytest.approx((0.02, 0.01))
        assert made.get_number("FEED") == pytest.approx(0.004)  # .005 in/rev x 0.8 for titanium


# --- refusals: one error, at the field


@pytest.mark.parametrize("dialect", [Dialect.OMNITURN, Dialect.SINUMERIK])
@pytest.mark.parametrize(
    ("key", "typed", "rows", "word"),
    [
        ("T", {"T": 9.0, "ROUGH": 0.0}, STEPPED, "ROUGH"),  # .25 in, and an assumed insert takes .127
        ("T", {"T": 9.0, "ROUGH": 0.2}, STEPPED, "ROUGH"),
        ("T", {"T": 3.0, "ROUGH": 0.14}, STEPPED, "ROUGH"),  # VNMG: .131
        (
            "T",
            {"SIDE": "BORE", "T": 2.0, "HOLE": 0.4, "ROUGH": 0.0},
            (ContourPoint(0.7, 0.0), ContourPoint(z=-0.5)),
            "ROUGH",
        ),
        ("A", {"T": 9.0, "SMALL": 0.5, "LARGE": 0.9, "LONG": 1.0, "ROUGH": 0.0}, (), "ROUGH"),
        ("B", {"T": 2.0, "HOLE": 0.4, "DIAM": 0.7, "DEEP": 0.5, "ROUGH": 0.0}, (), "ROUGH"),
        ("F", {"T": 9.0, "STOCK": 0.3, "DEEP": 0.2}, (), "DEEP"),
        ("K", {"T": 9.0, "DIAM": 1.0, "EDGE": 0.2}, (), "EDGE"),  # .2 x 0.707 = .141 in
    ],
)
def test_pass_deeper_than_the_insert_allows_is_one_error(
    key: str, typed: dict[str, FieldValue], rows: tuple[ContourPoint, ...], word: str, dialect: Dialect
) -> None:
    now = setting(tools={2: BAR, 3: VNMG}, dialect=dialect)
    assert refused(one(key, typed, now, rows), now) == [word]


@pytest.mark.parametrize(
    ("key", "typed", "rows"),
    [
        ("T", {"T": 1.0, "ROUGH": 0.0}, STEPPED),  # CNMG takes 6.448 mm = .2539 in
        ("T", {"T": 9.0, "ROUGH": 0.0, "FROM": 0.75}, STEPPED),  # .125 in
        ("T", {"T": 9.0, "ROUGH": 0.12}, STEPPED),
        ("F", {"T": 9.0, "STOCK": 0.1, "DEEP": 0.2}, ()),  # one pass of .1
        ("K", {"T": 9.0, "DIAM": 1.0, "EDGE": 0.15}, ()),
    ],
)
def test_pass_within_the_insert_limit_is_accepted(
    key: str, typed: dict[str, FieldValue], rows: tuple[ContourPoint, ...]
) -> None:
    now = setting(tools={1: CNMG})
    assert refused(one(key, typed, now, rows), now) == []


# --- the tool by its kind


def test_proposed_tool_suits_the_operation() -> None:
    rear = turning("CNMG120408", rear=True)
    now = setting(tools={1: BAR, 2: rear, 3: CNMG})
    assert one("T", {}, now, STEPPED).get_number("T") == 3.0
    assert one("F", {}, now).get_number("T") == 3.0
    assert one("T", {"SIDE": "BORE"}, now).get_number("T") == 1.0
    assert (
        one("T", {}, setting(tools={1: BAR}), STEPPED).get_number("T") == 2.0
    )  # a place that no sheet takes
    assert refused(one("T", {"T": 1.0}, now, STEPPED), now) == []  # a boring bar may turn where it is typed


# --- at the page, and its program on the bar


def test_form_entry_gives_roughing_passes_and_a_good_part() -> None:
    text = Programmer({1: CNMG}).strike("n↓↓↓1§f§t.5⏎z-.5⏎.7⏎z-1.1⏎1§").close()
    assert "G75I.035U.01F.005" in text
    report, _ = proved(text, {1: CNMG}, stock="bar:1.0:3.0")
    assert not bad(report), bad(report)


def test_a_depth_of_zero_is_reported_at_its_field() -> None:
    programmer = Programmer().strike("n↓↓↓1§t.5⏎z-.5⏎.7⏎z-1.1")
    form = programmer.shapes.form
    assert form is not None
    form.select_field_by_name("ROUGH")
    programmer.strike("0")
    assert list(programmer.troubles) == ["ROUGH"]
    programmer.strike("⌫")  # the proposal applies again
    assert programmer.troubles == {}
