"""Threads by name against the published tables of their standards: inches and mm as printed there."""

from __future__ import annotations

import math

import pytest

from core.extras.shapes.editor_shape import ShapeInstance, make_shape_instance
from core.extras.shapes.shape_fields import ProgramSettings, ShopData
from core.extras.shapes.shape_table import SHAPES_BY_KEY
from core.extras.shapes.threads.thread_series import (
    METRIC_SERIES,
    ThreadLimits,
    ThreadSeries,
    calculate_thread_limits,
    find_thread_size,
    get_pipe_thread_length,
    list_tolerance_classes,
)
from core.interpreter.shared.elementary_blocks import BlockKind
from core.part.tool_shape import ToolKind, ToolShape
from tests.extras.shapes.test_ten_parts import blocks_of
from tests.texts import text as wording

# ASME B1.1, tables of limits: major, pitch (least, most); minor of internal threads.
OUTSIDE = [
    (ThreadSeries.UNC, "1/4-20", "2A", (0.2408, 0.2489), (0.2127, 0.2164)),
    (ThreadSeries.UNF, "10-32", "2A", (0.1831, 0.1891), (0.1658, 0.1688)),
    (ThreadSeries.UNC, "3/8", "2A", (0.3643, 0.3737), (0.3287, 0.3331)),
    (ThreadSeries.UNC, "3/4", "2A", (0.7353, 0.7482), (0.6773, 0.6832)),
    (ThreadSeries.UNF, "1", "2A", (0.9868, 0.9982), (0.9382, 0.9441)),
    (ThreadSeries.UNF, "#0", "2A", (0.0563, 0.0595), (0.0496, 0.0514)),
    (ThreadSeries.UNC, "1/2", "2A", (0.4876, 0.4985), (0.4435, 0.4485)),
    (ThreadSeries.UNC, "1/2", "3A", (0.4891, 0.5000), (0.4463, 0.4500)),
    (ThreadSeries.UNC, "1", "2A", (0.9830, 0.9980), (0.9100, 0.9168)),
    (ThreadSeries.M, "M6", "6g", (5.794, 5.974), (5.212, 5.324)),  # ISO 965-2
    (ThreadSeries.M, "M8", "6g", (7.760, 7.972), (7.042, 7.160)),
    (ThreadSeries.M, "M10", "6g", (9.732, 9.968), (8.862, 8.994)),
    (ThreadSeries.M, "M12", "6g", (11.701, 11.966), (10.679, 10.829)),
    (ThreadSeries.M, "M3", "6g", (2.874, 2.980), (2.580, 2.655)),
    (ThreadSeries.MF, "M5X0.5", "6g", (4.874, 4.980), (4.580, 4.655)),
    (ThreadSeries.M, "M36", "6g", (35.465, 35.940), (33.118, 33.342)),
    (ThreadSeries.M, "M48", "6g", (47.399, 47.929), (44.431, 44.681)),
    (ThreadSeries.BSP, "1/8", "A", (9.514, 9.728), (9.040, 9.147)),  # ISO 228-1
    (ThreadSeries.BSP, "1/2", "A", (20.671, 20.955), (19.651, 19.793)),
    (ThreadSeries.BSP, "1/2", "B", (20.671, 20.955), (19.509, 19.793)),
    (ThreadSeries.BSP, "1", "B", (32.889, 33.249), (31.410, 31.770)),
    (ThreadSeries.ACME, "1/2", "2G", (0.4950, 0.5000), (0.4306, 0.4443)),  # B1.5
    (ThreadSeries.ACME, "3/4", "2G", (0.7417, 0.7500), (0.6424, 0.6598)),
]
INSIDE = [
    (ThreadSeries.UNC, "1/4", "2B", (0.2175, 0.2224), (0.196, 0.207)),
    (ThreadSeries.UNF, "10", "2B", (0.1697, 0.1736), (0.156, 0.164)),
    (ThreadSeries.UNC, "3/8", "2B", (0.3344, 0.3401), (0.307, 0.321)),
    (ThreadSeries.UNC, "1/2", "2B", (0.4500, 0.4565), (0.417, 0.434)),
    (ThreadSeries.UNC, "1", "2B", (0.9188, 0.9276), (0.865, 0.890)),
    (ThreadSeries.M, "M6", "6H", (5.350, 5.500), (4.917, 5.153)),
    (ThreadSeries.M, "M8", "6H", (7.188, 7.348), (6.647, 6.912)),
    (ThreadSeries.M, "M10", "6H", (9.026, 9.206), (8.376, 8.676)),
    (ThreadSeries.M, "M12", "6H", (10.863, 11.063), (10.106, 10.441)),
    (ThreadSeries.M, "M3", "6H", (2.675, 2.775), (2.459, 2.599)),
    (ThreadSeries.M, "M48", "6H", (44.752, 45.087), (42.587, 43.297)),
    (ThreadSeries.BSP, "1/8", "", (9.147, 9.254), (8.566, 8.848)),
    (ThreadSeries.BSP, "1/4", "", (12.301, 12.426), (11.445, 11.890)),
    (ThreadSeries.BSP, "1/2", "", (19.793, 19.935), (18.631, 19.172)),
    (ThreadSeries.BSP, "1", "", (31.770, 31.950), (30.291, 30.931)),
    (ThreadSeries.ACME, "1/2", "2G", (0.4500, 0.4637), (0.400, 0.405)),
]


def of(series: ThreadSeries, name: str, tolerance: str, *, inside: bool) -> ThreadLimits:
    found = find_thread_size(series, name)
    assert found is not None
    return calculate_thread_limits(series, found, tolerance, is_inside=inside)


def rounding(series: ThreadSeries) -> float:
    """Half of the last printed place, and what rounding on the way there adds."""
    if series in {ThreadSeries.UNC, ThreadSeries.UNF}:
        return 0.00002  # a diameter by number has three figures more
    return 0.00016 if series not in METRIC_SERIES else 0.001 if series is ThreadSeries.BSP else 0.0006


@pytest.mark.parametrize(("series", "name", "tolerance", "major", "pitch"), OUTSIDE)
def test_external_limits_match_the_table(
    series: ThreadSeries, name: str, tolerance: str, major: tuple[float, float], pitch: tuple[float, float]
) -> None:
    found = of(series, name, tolerance, inside=False)
    assert found.major_diameter == pytest.approx(major, abs=rounding(series))
    assert found.pitch_diameter == pytest.approx(pitch, abs=rounding(series))


@pytest.mark.parametrize(("series", "name", "tolerance", "pitch", "minor"), INSIDE)
def test_internal_limits_match_the_table(
    series: ThreadSeries, name: str, tolerance: str, pitch: tuple[float, float], minor: tuple[float, float]
) -> None:
    found = of(series, name, tolerance, inside=True)
    assert found.pitch_diameter == pytest.approx(pitch, abs=rounding(series))
    assert found.minor_diameter == pytest.approx(minor, abs=max(0.0006, rounding(series)))


def test_half_inch_13_class_3b_minor_diameter_matches_the_table() -> None:
    assert of(ThreadSeries.UNC, "1/2", "3B", inside=True).minor_diameter == pytest.approx(
        (0.4167, 0.4284), abs=0.0001
    )


def test_taper_pipe_thread_matches_b1_20_1_at_its_small_end() -> None:
    """B1.20.1: E0 and K0 of 1/4-18 and 1/2-14, and L2."""
    for name, pitch, minor, long in (("1/4", 0.47739, 0.4329, 0.4018), ("1/2", 0.75843, 0.7013, 0.5337)):
        found, known = of(ThreadSeries.NPT, name, "", inside=False), find_thread_size(ThreadSeries.NPT, name)
        assert known is not None
        assert found.pitch_diameter[0] == pytest.approx(pitch, abs=0.00002)
        assert found.root_diameter == pytest.approx(minor, abs=0.0001)
        assert get_pipe_thread_length(ThreadSeries.NPT, known) == pytest.approx(long, abs=0.0001)


def test_taper_pipe_thread_length_matches_iso_7_1() -> None:
    """ISO 7-1, basic gauge length: 1/8, 1/2, 1 and 2."""
    for name, long in (("1/8", 6.5), ("1/2", 13.2), ("1", 16.8), ("2", 23.4)):
        known = find_thread_size(ThreadSeries.BSPT, name)
        assert known is not None
        assert get_pipe_thread_length(ThreadSeries.BSPT, known) == pytest.approx(long, abs=0.06)


@pytest.mark.parametrize(("side", "crest", "root"), [("OUTSIDE", 20.813, 18.560), ("BORE", 18.902, 21.026)])
def test_parallel_pipe_thread_is_cut_to_the_middle_of_its_limits(
    side: str, crest: float, root: float
) -> None:
    """G 1/2: major and minor in the middle, and the last pass a height of 1.162 from the middle pitch."""
    one = thread({"SERIES": "BSP", "SIZE": "1/2", "SIDE": side, "LONG": 15.0}, metric=True)
    assert (one.get_number("CREST"), one.get_number("ROOT")) == pytest.approx((crest, root), abs=0.002)
    assert not one.find_errors(ProgramSettings(metric=True))


def test_nose_radius_is_included_in_pipe_thread_depth() -> None:
    """G 1/2 class A, pitch 19.722: half of .9605 P behind the pitch line a point would end, and a nose of
    .2 lacks .2 (1 / sin 27.5 - 1) of that."""
    size = find_thread_size(ThreadSeries.BSP, "1/2")
    assert size is not None
    found = calculate_thread_limits(ThreadSeries.BSP, size, "A", is_inside=False, nose_radius=0.2)
    lack = 0.2 * (1.0 / math.sin(math.radians(27.5)) - 1.0)
    assert found.root_diameter == pytest.approx(19.722 - 0.960491 * 25.4 / 14 + 2 * lack, abs=0.001)


def test_thread_depth_includes_the_nose_radius() -> None:
    """Of a sharp V half of its height lies behind the pitch line, and a nose of radius r lacks r of that."""
    size = find_thread_size(ThreadSeries.UNC, "1/2")
    assert size is not None
    sharp = calculate_thread_limits(ThreadSeries.UNC, size, "2A", is_inside=False, nose_radius=1e-9)
    usual = calculate_thread_limits(ThreadSeries.UNC, size, "2A", is_inside=False)
    nosed = calculate_thread_limits(ThreadSeries.UNC, size, "2A", is_inside=False, nose_radius=0.005)
    assert sharp.root_diameter == pytest.approx(0.4460 - 0.866025 / 13, abs=0.0001)
    assert nosed.root_diameter - sharp.root_diameter == pytest.approx(0.010, abs=1e-6)
    assert sharp.root_diameter < nosed.root_diameter < usual.root_diameter


def test_common_spellings_of_thread_sizes_are_recognized() -> None:
    for name in ("1/2", "1/2-13", " 1/2-13 "):
        found = find_thread_size(ThreadSeries.UNC, name)
        assert found is not None
        assert found.diameter == 0.5
    ten = find_thread_size(ThreadSeries.UNF, "#10")
    assert ten is not None
    assert ten.diameter == pytest.approx(0.190)
    fine = find_thread_size(ThreadSeries.MF, "m10x1.25")
    assert fine is not None
    assert (fine.diameter, fine.pitch) == (10.0, 1.25)
    assert find_thread_size(ThreadSeries.UNC, "7/13") is None


def test_one_inch_differs_from_number_one() -> None:
    inch, number = find_thread_size(ThreadSeries.UNC, "1"), find_thread_size(ThreadSeries.UNC, "#1")
    assert inch is not None
    assert number is not None
    assert (inch.diameter, number.diameter) == (1.0, pytest.approx(0.073))


def thread(typed: dict[str, float | str], *, metric: bool = False) -> ShapeInstance:
    return make_shape_instance(SHAPES_BY_KEY["R"], typed, ProgramSettings(metric=metric))


def test_size_missing_from_the_series_is_rejected() -> None:
    one = thread({"SIZE": "7/13", "LONG": 0.5, "PITCH": 0.05, "CREST": 0.5, "ROOT": 0.4, "RPM": 300.0})
    said = {each.field_name: each.message for each in one.find_errors(ProgramSettings())}
    assert said == {"SIZE": wording("shapes.no-such-size", series="UNC", size="7/13")}


def test_tolerance_class_of_the_other_side_is_rejected() -> None:
    one = thread({"SIZE": "1/2", "LONG": 0.5, "CLASS": "2B"})
    assert [each.message for each in one.find_errors(ProgramSettings())] == [
        wording("shapes.no-such-class", tolerance="2B", allowed="2A, 1A, 3A")
    ]
    assert list_tolerance_classes(ThreadSeries.UNC, is_inside=False) == ("2A", "1A", "3A")


def test_metric_thread_is_converted_in_an_inch_program() -> None:
    one = thread({"SERIES": "M", "SIZE": "M10", "LONG": 0.5})
    assert one.get_number("PITCH") == pytest.approx(1.5 / 25.4, abs=1e-6)
    assert one.get_number("CREST") * 25.4 == pytest.approx((9.968 + 9.732) / 2, abs=0.002)


def test_thread_without_relief_is_rejected() -> None:
    one = thread({"SIZE": "1/2", "LONG": 0.5, "PULL": "NO"})
    (said,) = one.find_errors(ProgramSettings())
    assert (said.field_name, said.message[:21]) == ("RELIEF", "Thread relief missing")


def test_lead_too_fast_for_the_axis_is_rejected() -> None:
    one = thread({"SIZE": "1/2", "LONG": 0.5, "STARTS": 4.0, "RPM": 1000.0, "RUNUP": 0.5})
    assert {each.field_name for each in one.find_errors(ProgramSettings())} == {"RPM"}


def test_thread_deeper_than_its_flanks_is_rejected() -> None:
    own: dict[str, float | str] = {
        "SERIES": "OWN",
        "PITCH": 0.05,
        "CREST": 0.5,
        "ROOT": 0.40,
        "LONG": 0.5,
        "RPM": 300.0,
    }
    assert [each.field_name for each in thread(own).find_errors(ProgramSettings())] == ["ROOT"]


FLANKS = [
    ("UNC", "1/2", 30.0),
    ("M", "M10", 30.0),
    ("BSP", "1/2", 27.5),
    ("NPT", "1/2", 30.0),
    ("ACME", "1/2", 14.5),
]


@pytest.mark.parametrize("side", ["OUTSIDE", "BORE"])
@pytest.mark.parametrize(("series", "size", "flank"), FLANKS)
def test_earlier_passes_stay_within_the_flank_of_the_last(
    series: str, size: str, flank: float, side: str
) -> None:
    """A pass that ends d before the last may stand d tan(flank) beside it, and no more."""
    typed: dict[str, float | str] = {"SERIES": series, "SIZE": size, "SIDE": side, "LONG": 0.5, "TAPER": 0.0}
    one = thread(typed)
    text = "\n".join(["G90G94F300G72", *one.make_lines(ProgramSettings()), "M30", ""])
    passes = [b for b in blocks_of(text) if b.kind is BlockKind.THREAD and b.x == b.x0]
    last = passes[-1]
    assert len(passes) == one.get_number("PASSES")
    for each in passes:
        assert abs(each.z0 - last.z0) <= abs(each.x - last.x) * math.tan(math.radians(flank)) + 1e-6
    assert abs(passes[0].z0 - last.z0) > 0.0


@pytest.mark.parametrize(("series", "most"), [("BSP", 27), ("ACME", 14)])
def test_infeed_angle_flatter_than_the_flank_is_rejected(series: str, most: int) -> None:
    one = thread({"SERIES": series, "SIZE": "1/2", "LONG": 0.5, "INFEED": 29.0})
    (said,) = one.find_errors(ProgramSettings())
    assert said.field_name == "INFEED"
    assert said.message.endswith(f"so the first passes would cut into the flank. Enter {most} or less.")


def test_custom_thread_uses_the_angle_of_its_tool() -> None:
    """A trapezoidal insert of 30 degrees, which no series here has."""
    tool = ToolShape(ToolKind.THREADING, tip=8, point=30.0)
    setting = ProgramSettings(metric=True, shop=ShopData(tools={1: tool}))
    own: dict[str, float | str] = {"SERIES": "OWN", "PITCH": 3.0, "CREST": 20.0, "ROOT": 16.5, "LONG": 30.0}
    one = make_shape_instance(SHAPES_BY_KEY["R"], own, setting)
    assert one.get_number("INFEED") == 14.0
    assert not one.find_errors(setting)
    named = make_shape_instance(SHAPES_BY_KEY["R"], {"SERIES": "M", "SIZE": "M20", "LONG": 30.0}, setting)
    assert [each.message for each in named.find_errors(setting)] == [
        wording("shapes.thread-angle", tool="T1", point=30, angle=60)
    ]


def test_thread_measurement_limits_are_noted() -> None:
    """ASME B1.1, 1/2-13: 2A outside, 2B in a bore; M10 of 6g in mm (ISO 965-2)."""
    says = SHAPES_BY_KEY["R"].make_notes
    assert says(thread({"SIZE": "1/2", "LONG": 0.5}), ProgramSettings()) == (
        "major diameter .4876 to .4985, pitch diameter .4435 to .4485",
    )
    assert says(thread({"SIZE": "1/2", "SIDE": "BORE", "LONG": 0.5}), ProgramSettings()) == (
        "minor diameter .4167 to .4336, pitch diameter .45 to .4565",
    )
    (metric,) = says(
        thread({"SERIES": "M", "SIZE": "M10", "LONG": 12.0}, metric=True), ProgramSettings(metric=True)
    )
    assert metric == "major diameter 9.732 to 9.968, pitch diameter 8.862 to 8.994"


def test_cone_before_a_pipe_thread_is_noted() -> None:
    """1/2-14 NPT: E0 .7584 and .8 / 14 to the crest; 1 in 16 over the .5337 of L2 (B1.20.1)."""
    assert SHAPES_BY_KEY["R"].make_notes(thread({"SERIES": "NPT", "SIZE": "1/2"}), ProgramSettings()) == (
        wording("shapes.pitch-diameter", size=".7584"),
        wording("shapes.taper-before-thread", start=".8156", end=".849"),
    )


def test_custom_thread_has_no_notes() -> None:
    own: dict[str, float | str] = {"SERIES": "OWN", "PITCH": 0.05, "CREST": 0.5, "ROOT": 0.44, "LONG": 0.5}
    assert SHAPES_BY_KEY["R"].make_notes(thread(own), ProgramSettings()) == ()


def test_all_starts_of_a_tapered_thread_are_on_the_same_cone() -> None:
    one = thread({"SERIES": "NPT", "SIZE": "1/2", "STARTS": 2.0, "RPM": 200.0})
    text = "\n".join(["G90G94F300G72", *one.make_lines(ProgramSettings()), "M30", ""])
    cuts = [b for b in blocks_of(text) if b.kind is BlockKind.THREAD and b.z < b.z0 and b.travel is None]
    ends = [b for b in cuts if b.z == pytest.approx(-0.534 * 25.4, abs=0.01)]
    deepest = min(b.x for b in ends)
    assert sum(abs(b.x - deepest) < 0.003 for b in ends) == 2
