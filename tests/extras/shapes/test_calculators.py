"""Calculators, templates and the tap: figures by closed formulas and printed tables, in inch and mm."""

from __future__ import annotations

import itertools
import math

import pytest

from app.extras.shapes.shapes_model import ShapesModel
from core.extras.shapes.calculators import SPEED_CALCULATOR, TAPER_CALCULATOR, THREAD_CALCULATOR, solve_taper
from core.extras.shapes.editor_shape import ShapeInstance, make_shape_instance
from core.extras.shapes.shape_fields import FieldValue, ProgramSettings, ShopData
from core.extras.shapes.threads.tapping import TAPPING_SHAPE, find_tap_drill
from core.part.tool_shape import ToolKind, ToolShape
from tests.extras.shapes.hand import Programmer, bad, proved
from tests.texts import text as wording

INCH, MM = ProgramSettings(), ProgramSettings(metric=True)
TAPER: dict[str, FieldValue] = {
    "SMALL": 0.5,
    "LARGE": 1.0,
    "LONG": 1.0,
    "ANGLE": math.degrees(math.atan(0.25)),
}


def said(one: ShapeInstance, setting: ProgramSettings) -> list[str]:
    return [each.message for each in one.find_errors(setting)]


@pytest.mark.parametrize("three", list(itertools.combinations(TAPER, 3)))
def test_three_taper_values_give_the_fourth(three: tuple[str, ...]) -> None:
    found = solve_taper({word: TAPER[word] for word in three})
    assert found == pytest.approx(TAPER)


def test_taper_is_written_with_its_notes() -> None:
    """.5 to 1. over 1.: slope sqrt(1 + .0625), 1 : 2 on the diameter."""
    one = make_shape_instance(TAPER_CALCULATOR, {"SMALL": 0.5, "LARGE": 1.0, "LONG": 1.0}, INCH)
    assert not said(one, INCH)
    assert one.make_lines(INCH) == ["X.5Z0", "X1Z-1"]
    assert TAPER_CALCULATOR.make_notes(one, INCH) == (
        "slant length 1.0308",
        "included angle 28.0725°",
        wording("shapes.taper-ratio", ratio="1 : 2"),
    )


def test_impossible_triangle_is_rejected() -> None:
    assert (
        wording("shapes.value-missing", label="LENGTH")
        in said(make_shape_instance(TAPER_CALCULATOR, {"SMALL": 0.5, "LARGE": 1.0}, INCH), INCH)[0]
    )
    four = make_shape_instance(TAPER_CALCULATOR, {**TAPER, "ANGLE": 20.0}, INCH)
    assert said(four, INCH) == [wording("shapes.no-taper", angle=14.04)]
    through = make_shape_instance(TAPER_CALCULATOR, {"LARGE": 0.5, "LONG": 1.0, "ANGLE": 30.0}, INCH)
    assert "crosses the spindle centerline" in said(through, INCH)[0]


@pytest.mark.parametrize(
    ("typed", "rpm", "setting"),
    [
        ({"DIA": 1.0, "SURF": 300.0}, 1145, INCH),  # 300 * 12 / pi
        ({"DIA": 25.0, "SURF": 100.0}, 1273, MM),  # 100 * 1000 / (25 pi)
        ({"DIA": 0.1, "SURF": 900.0}, 3500, INCH),  # what the spindle has
    ],
)
def test_speed_is_calculated(typed: dict[str, FieldValue], rpm: float, setting: ProgramSettings) -> None:
    one = make_shape_instance(SPEED_CALCULATOR, typed, setting)
    assert one.get_number("RPM") == rpm
    assert not said(one, setting)


@pytest.mark.parametrize(
    ("work", "depth"), [("TURN", "0.03"), ("BORE", "0.015"), ("DRILL", ""), ("PART", "")]
)
def test_speed_calculator_notes_the_roughing_depth(work: str, depth: str) -> None:
    """An assumed CCMT 0602 takes 3.224 mm: a quarter is .0317 in, half of it .0159 in for a boring bar."""
    typed: dict[str, FieldValue] = {"MATERIAL": "STEEL", "WORK": work, "DIA": 0.5}
    words = [
        each
        for each in SPEED_CALCULATOR.make_notes(make_shape_instance(SPEED_CALCULATOR, typed, INCH), INCH)
        if "rough" in each
    ]
    assert words == ([f"roughing passes {depth.removeprefix('0')} deep per side"] if depth else [])


def test_feed_per_minute_and_per_rev_are_converted() -> None:
    """1000 rpm at .005 are 5 in/min; 6 in/min are .006."""
    one = make_shape_instance(SPEED_CALCULATOR, {"DIA": 1.0, "RPM": 1000.0, "FEED": 0.005}, INCH)
    assert one.get_number("RATE") == 5.0
    assert one.make_lines(INCH) == ["M03S1000", "G95F.005"]
    assert one.get_number("SURF") == pytest.approx(1000 * math.pi / 12, abs=0.05)
    assert (
        make_shape_instance(SPEED_CALCULATOR, {"DIA": 1.0, "RPM": 1000.0, "RATE": 6.0}, INCH).get_number(
            "FEED"
        )
        == 0.006
    )
    torn = make_shape_instance(
        SPEED_CALCULATOR, {"DIA": 1.0, "RPM": 1000.0, "FEED": 0.005, "RATE": 9.0}, INCH
    )
    assert said(torn, INCH) == ["1000 rpm at 0.005 per revolution is 5 per minute: clear one of the values."]
    fast = make_shape_instance(SPEED_CALCULATOR, {"DIA": 1.0, "RPM": 5000.0}, INCH)
    assert "more than the 3500 rpm" in said(fast, INCH)[0]


def test_thread_passes_follow_the_square_root_rule() -> None:
    """Depth h in n passes: the first h / sqrt(n), pass k at I sqrt(k); either of I and n gives the other."""
    own: dict[str, FieldValue] = {"PITCH": 0.05, "CREST": 0.5, "ROOT": 0.44, "LONG": 1.0}
    own["SERIES"] = next(c for c in THREAD_CALCULATOR.fields[0].choices if "OWN" in c.upper())
    one = make_shape_instance(THREAD_CALCULATOR, {**own, "PASSES": 9.0}, INCH)
    assert one.get_number("FIRST") == pytest.approx(0.01)
    assert one.make_lines(INCH) == ["G33X.44Z-1I.02K.05C"]
    told = THREAD_CALCULATOR.make_notes(one, INCH)
    assert told[:2] == (
        wording("shapes.thread-depth", depth=".03", first=".01"),
        wording("shapes.starts-at", value=".48"),
    )
    places = [f"{0.5 - 0.02 * math.sqrt(k):.4f}".rstrip("0").lstrip("0") for k in range(1, 10)]
    assert told[2] == wording("shapes.x-of-passes", positions=" ".join(places))
    assert make_shape_instance(THREAD_CALCULATOR, {**own, "FIRST": 0.01}, INCH).get_number(
        "PASSES"
    ) == pytest.approx(9.0)
    torn = make_shape_instance(THREAD_CALCULATOR, {**own, "FIRST": 0.01, "PASSES": 4.0}, INCH)
    assert wording("shapes.first-pass-given", count=4, depth=".015") == said(torn, INCH)[0]


# --- templates, in the editor


def written(keys: str, text: str = "") -> str:
    shapes = ShapesModel(shop_data=ShopData())
    assert shapes.open_program_text("x.nc", text, len(text.splitlines()), lists_helpers=True) == ""
    shapes.worker.wait_for_results(60.0)
    for key in keys:
        assert shapes.handle_key(key), (key, shapes.prompt_text())
    shapes.write_form()
    assert shapes.form is None, shapes.prompt_text()
    shapes.close()
    return shapes.text


def test_templates_make_a_valid_program() -> None:
    text = written("n")
    for key in "cg":
        text = written(key, text.replace("M30\n", "") + "")
    report, part = proved(text, {1: ToolShape(ToolKind.TURNING, tip=3)}, stock="bar:1:2")
    assert not report.errors, bad(report)
    assert "(" not in text  # nothing that would be opened again
    assert part.removed_volume_mm3 > 0.0


def test_thread_and_loop_are_made_by_template() -> None:
    text = written("b", "G90G94F300G72\n")
    assert text.splitlines()[-2:] == ["}1", "M99"]
    assert "LS10" in text
    text = written("d", "G90G94F300G72\n")
    assert "G33X.9387Z-.5I.0217K.05PC" in text  # 1 - 2 (.6134 x .05), and of that a side over the root of 8
    assert not proved(text, stock="bar:1:2")[0].errors


def test_a_shape_is_not_opened_from_the_calculators() -> None:
    head = (
        "G90G94F300G72(HEAD INCH UNIT DIAMETER WORDS STEEL MATERIAL ON COOLANT 1 CLEAR 300 RAPID)\nM08\nM30\n"
    )
    shapes = ShapesModel(shop_data=ShopData())
    shapes.open_program_text("x.nc", head, 1, lists_helpers=True)
    assert shapes.is_list_shown
    assert not shapes.listed_pieces
    assert not shapes.accepts_key("x")
    shapes.close()


# --- tap


def test_tap_enters_and_leaves_at_its_pitch() -> None:
    """1/4-20: pitch .05, to .05 before the depth of .5, back with M04; the proof finds nothing."""
    tap = ToolShape(ToolKind.TAP, diameter=6.35, pitch=1.27)
    hand = Programmer({4: tap}, "")
    text = hand.strike("n§o1/4-20⏎⏎⏎.5§").close()
    lines = [line.partition("(")[0] for line in text.splitlines()[2:]]
    assert lines.pop(1).startswith("M03S")
    assert lines == ["T4", "G00X0Z1", "Z.15", "G95F.05Z-.45", "M04", "G04F.5", "Z.15", "G00Z1", "M30"]
    report, _ = proved(text, {4: tap}, stock="tube:1:.2:2")
    assert not bad(report)
    assert [each.edited_line for each in hand.shapes.shape_pieces] == [-1, -1]


def test_tap_hole_diameter_matches_iso_limits() -> None:
    """M10: minor diameter of 6H from 8.376 to 8.676 (ISO 965-1); G 1/2: from 18.631 to 19.172 (ISO 228-1)."""
    one = make_shape_instance(TAPPING_SHAPE, {"SERIES": "M", "SIZE": "M10", "DEEP": 12.0}, MM)
    assert TAPPING_SHAPE.make_notes(one, MM) == (
        wording("shapes.hole-before-tapping", size="8.53", smallest="8.38", largest="8.68"),
        "tap drill: 8.5 mm",
    )
    assert one.get_number("PITCH") == 1.5
    pipe = make_shape_instance(TAPPING_SHAPE, {"SERIES": "BSP", "SIZE": "1/2", "DEEP": 15.0}, MM)
    limits = {"smallest": "18.63", "largest": "19.17"}
    assert TAPPING_SHAPE.make_notes(pipe, MM)[0] == wording(
        "shapes.hole-before-tapping", size="18.9", **limits
    )


DRILLS = {
    "UNC": {
        "#4": "#43",
        "#6": "#36",
        "#8": "#29",
        "#10": "#25",
        "1/4": "#7",
        "5/16": "F",
        "3/8": "5/16",
        "7/16": "U",
    }
    | {"1/2": "27/64", "5/8": "17/32", "3/4": "21/32", "1": "7/8"},
    "UNF": {"#10": "#21", "1/4": "#3", "5/16": "I", "3/8": "Q", "1/2": "29/64"},
    "M": {
        "M3": "2.5",
        "M4": "3.3",
        "M5": "4.2",
        "M6": "5",
        "M8": "6.8",
        "M10": "8.5",
        "M12": "10.2",
        "M16": "14",
    }
    | {"M20": "17.5"},
    "MF": {"M8X1": "7", "M10X1": "9", "M12X1.5": "10.5"},
}
"""Tap drills as charts have them."""


@pytest.mark.parametrize(
    ("series", "size"), [(series, size) for series, sizes in DRILLS.items() for size in sizes]
)
def test_tap_drill_matches_the_charts(series: str, size: str) -> None:
    setting = MM if series.startswith("M") else INCH
    told = TAPPING_SHAPE.make_notes(
        make_shape_instance(TAPPING_SHAPE, {"SERIES": series, "SIZE": size, "DEEP": 1.0}, setting), setting
    )[1]
    assert told.removeprefix("tap drill: ").split(" mm")[0].split(",")[0] == DRILLS[series][size]


def test_tap_drill_in_the_other_unit_shows_its_size() -> None:
    inch = TAPPING_SHAPE.make_notes(
        make_shape_instance(TAPPING_SHAPE, {"SERIES": "M", "SIZE": "M6", "DEEP": 0.5}, INCH), INCH
    )
    metric = TAPPING_SHAPE.make_notes(
        make_shape_instance(TAPPING_SHAPE, {"SERIES": "UNC", "SIZE": "1/4", "DEEP": 12.0}, MM), MM
    )
    assert (inch[1], metric[1]) == ("tap drill: 5 mm, .1969", "tap drill: #7, 5.105")


def test_size_without_a_standard_drill_has_no_tap_drill() -> None:
    assert find_tap_drill(0.2015, 0.2028, is_metric=False) is None
    assert find_tap_drill(60.0, 61.0, is_metric=True) is None


@pytest.mark.parametrize(
    ("typed", "says"),
    [
        ({"SERIES": "NPT", "SIZE": "1/4"}, "NPT threads cannot be tapped with this shape"),
        ({"SIZE": "9/7"}, wording("shapes.no-such-size", series="UNC", size="9/7")),
        ({"SIZE": "1/4-20", "SHORT": 0.5}, wording("shapes.tap-stops-short", short=0.5, depth=0.5)),
        (
            {"SIZE": "1/4-20", "T": 5.0},
            wording("shapes.pitch-of-thread", tool="T5", pitch=0.03937, needed=0.05),
        ),
        (
            {"SIZE": "1/4-20", "DEEP": 1.0, "T": 4.0},
            wording("shapes.beyond-flutes", depth=1, tool=4, length=0.7874),
        ),
    ],
)
def test_invalid_tapping_is_rejected(typed: dict[str, FieldValue], says: str) -> None:
    taps = {4: ToolShape(ToolKind.TAP, pitch=1.27, length=20.0), 5: ToolShape(ToolKind.TAP, pitch=1.0)}
    setting = ProgramSettings(shop=ShopData(tools=taps))
    base: dict[str, FieldValue] = {
        "T": 4.0,
        "SERIES": "UNC",
        "DEEP": 0.5,
        "DIA": 0.25,
        "PITCH": 0.05,
        "RPM": 500.0,
    }
    one = make_shape_instance(TAPPING_SHAPE, {**base, **typed}, setting)
    assert any(says in text for text in said(one, setting)), said(one, setting)
