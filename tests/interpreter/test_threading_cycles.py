"""G33, G34 and the coarse feeds: passes by figures worked out by hand, and what is refused."""

from __future__ import annotations

from math import radians, sqrt, tan
from pathlib import Path

import pytest

from core.interpreter.shared.elementary_blocks import Block, BlockKind
from core.interpreter.shared.job_setup import ControlLimits
from core.language.source import load_source
from tests.interpreter.programs import INCH, Pass, body, in_feed, lines, passed, setup

FOLDER = Path(__file__).parents[2].parent / "shared" / "conformance" / "omniturn"


def example(name: str) -> Pass:
    path = FOLDER / f"{name}.nc"
    if not path.exists():
        pytest.skip("the worked examples are not here")
    result = passed(load_source(path).text)
    assert result.errors == []
    return result


def threads(result: Pass) -> list[Block]:
    """The synchronous parts that are no pull-out."""
    return [b for b in result.moves if b.kind is BlockKind.THREAD and not b.text.endswith("P")]


def pull_outs(result: Pass) -> list[Block]:
    return [b for b in result.moves if b.kind is BlockKind.THREAD and b.text.endswith("P")]


def begin(block: Block) -> tuple[float, float]:
    return round(block.x0 / INCH, 5), round(block.z0 / INCH, 5)


def end(block: Block) -> tuple[float, float]:
    return round(block.x / INCH, 5), round(block.z / INCH, 5)


def unbroken(result: Pass) -> None:
    for before, after in zip(result.moves, result.moves[1:], strict=False):
        assert (after.x0, after.z0) == pytest.approx((before.x, before.z), abs=1e-9)


# --- the worked examples ------------------------------------------------------------------------------------


def test_external_thread_matches_manual_example() -> None:
    result = example("thread-external")
    cuts = threads(result)
    radii = [0.237, 0.23203, 0.22822, 0.225, 0.22217, 0.21961, 0.21725, 0.21506, 0.213, 0.212]
    assert [end(block)[0] for block in cuts] == radii
    assert {end(block)[1] for block in cuts} == {-0.5}
    assert [begin(block)[1] for block in cuts] == [
        pytest.approx(0.2 - (0.237 - r) * tan(radians(29)), abs=1e-5) for r in radii
    ]
    assert {round(in_feed(block), 9) for block in cuts} == {0.05}
    assert all(block.per_rev for block in cuts)
    outs = pull_outs(result)
    assert {end(block)[0] for block in outs} == {0.273}
    assert [end(block)[1] for block in outs] == [pytest.approx(-0.5 - (0.273 - r), abs=2e-5) for r in radii]
    assert end(result.moves[-2]) == (0.237, 0.2)  # back at S
    unbroken(result)


def test_internal_thread_stops_and_retracts_straight() -> None:
    result = example("thread-internal")
    cuts = threads(result)
    assert len(cuts) == 14
    assert [end(block)[0] for block in (cuts[0], cuts[1], cuts[-1])] == [0.4425, 0.44664, 0.46875]
    assert pull_outs(result) == []
    after = [result.moves[result.moves.index(block) + 1] for block in cuts]
    assert {(block.kind, *end(block)) for block in after} == {(BlockKind.RAPID, 0.4125, -0.75)}
    assert end(result.moves[-3]) == (0.4425, 0.2)


def test_clean_up_pass_is_single_pass() -> None:
    result = example("thread-cleanup")
    (cut,), (out,) = threads(result), pull_outs(result)
    assert end(cut) == (0.212, -0.5)
    assert end(out)[0] == 0.261


def test_three_start_thread_shifts_start_by_lead_thirds() -> None:
    result = example("thread-three-start")
    cuts = threads(result)
    starts = [begin(block)[1] for block in cuts]
    assert starts == [0.2] * 21 + [0.25] * 21 + [0.3] * 21
    assert {round(in_feed(block), 9) for block in cuts} == {0.15}  # a third of the lead apart: 120 degrees


def test_tapered_thread_matches_manual_example() -> None:
    result = example("thread-taper")
    cuts = threads(result)
    assert len(cuts) == 121
    assert (begin(cuts[0]), end(cuts[0])) == ((0.2075, 0.2), (0.225, -0.5))
    assert (begin(cuts[-1]), end(cuts[-1])) == ((0.1825, 0.2), (0.2, -0.5))
    assert (6, 1, "thread-passes") in result.warnings
    assert any("121 passes" in found.message for found in result.interpreter.diagnostics)
    # 3 I is .0075, and the cone's far end stands .0175 above S: a retract to .215 would cross it
    back = [b for b in result.moves if b.kind is BlockKind.RAPID and end(b)[1] == -0.5]
    assert {end(block)[0] for block in back} == {0.2325}


def test_four_start_coarse_thread_needs_g35() -> None:
    result = example("thread-coarse-four-start")
    assert sorted({begin(block)[1] for block in threads(result)}) == [0.2, 0.3, 0.4, 0.5]
    assert {round(in_feed(block), 9) for block in threads(result)} == {0.4}
    text = load_source(FOLDER / "thread-coarse-four-start.nc").text
    without = "\n".join(each for each in text.splitlines() if not each.startswith(("G35", "G36", "G92")))
    assert (6, 17, "thread-lead-range") in passed(without + "\n").errors


# --- by hand ------------------------------------------------------------------------------------------------


def test_thread_passes_remove_equal_chip_area() -> None:
    # .3 in to .25 in in steps of .05 (sqrt k - 1): k = 4 lies .05 below S
    result = passed(body("X.3Z.1", "G33X.25Z-.5I.05K.05"))
    assert [end(block)[0] for block in threads(result)] == [
        0.3, round(0.3 - 0.05 * (sqrt(2) - 1), 5), round(0.3 - 0.05 * (sqrt(3) - 1), 5), 0.25,
    ]  # fmt: skip


@pytest.mark.parametrize(
    "head", [("G72", "X.6Z.1", "G33X.5Z-.5I.1K.05"), ("G73", "X.3Z.1", "G33X.25Z-.5I.05K.05")]
)
def test_i_is_diameter_in_diameter_mode(head: tuple[str, ...]) -> None:
    result = passed(body(*head))
    assert len(threads(result)) == 4
    assert end(threads(result)[1])[0] == pytest.approx(0.27929, abs=1e-5)


def test_thread_in_metric_mode() -> None:
    result = passed(lines("G90G94G71F5000", "M03S500", "X10Z2", "G33X9Z-20I.5K1.5PC", "M30"))
    assert result.errors == []
    first = threads(result)[0]
    assert (first.x0, first.z0, first.x, first.z, first.feed) == (10, 2, 10, -20, 1.5)
    assert {round(block.x, 9) for block in pull_outs(result)} == {11.5}


def test_thread_under_g91_matches_absolute_thread() -> None:
    absolute = passed(body("X.3Z.1", "G33X.25Z-.5I.05K.05"))
    relative = passed(body("X.3Z.1", "G91", "G33X-.05Z-.6I.05K.05"))
    assert [end(block) for block in threads(relative)] == [end(block) for block in threads(absolute)]


def test_tapered_thread_retains_slope_when_flank_shifts_start() -> None:
    result = passed(body("X.3Z.1", "G33X.25Z-.5I.05K.05A.06C30"))
    for block in threads(result):
        assert (block.x - block.x0) / (block.z - block.z0) == pytest.approx(-0.1, rel=1e-9)
    assert end(threads(result)[-1])[0] == 0.31
    assert begin(threads(result)[-1])[1] == pytest.approx(0.1 - 0.05 * tan(radians(30)), abs=1e-5)


def test_thread_toward_tailstock() -> None:
    result = passed(body("X.3Z-.5", "G33X.25Z.1I.05K.05PC"))
    assert begin(threads(result)[-1])[1] == pytest.approx(-0.5 + 0.05 * tan(radians(29)), abs=1e-5)
    assert end(pull_outs(result)[0]) == (0.45, 0.25)


@pytest.mark.parametrize(("i", "retract"), [("I.01", 0.33), ("I-.01", 0.27)])
def test_g34_makes_single_pass_at_current_diameter(i: str, retract: float) -> None:
    result = passed(body("X.3Z.1", f"G34Z-.5{i}K.05P"))
    (cut,), (out,) = threads(result), pull_outs(result)
    assert end(cut) == (0.3, -0.5)
    assert end(out) == (retract, -0.53)
    assert end(result.moves[-1]) == (0.3, 0.1)


def test_lead_is_not_rounded_to_resolution() -> None:
    # 13 threads an inch: .07692 rounded to .0769 would be .0003 wrong on an inch
    result = passed(body("X.3Z.1", "G33X.29Z-.5I.01K.07692"))
    assert in_feed(threads(result)[0]) == pytest.approx(0.07692, rel=1e-12)
    assert result.warnings == []


def test_short_run_up_warns() -> None:
    # 3000 rpm at .1 in: 5 in/s, and 120 in/s² need 25/240 = .104 in
    run = "M03S3000"
    assert (5, 1, "thread-run-up") in passed(body(run, "X.3Z.1", "G33X.29Z-.5I.01K.1")).warnings
    assert passed(body(run, "X.3Z.11", "G33X.29Z-.5I.01K.1")).warnings == []
    weak = setup(limits=ControlLimits(z_acceleration_mm_s2=60 * INCH))
    assert (5, 1, "thread-run-up") in passed(body(run, "X.3Z.11", "G33X.29Z-.5I.01K.1"), weak).warnings


def test_flank_infeed_shortens_run_up() -> None:
    result = passed(body("M03S3000", "X.3Z.11", "G33X.28Z-.5I.01K.1C"))
    assert (5, 1, "thread-run-up") in result.warnings  # .11 - .02 tan 29° = .099


def test_g35_halves_resolution_until_g36() -> None:
    result = passed(body("X.5Z.2", "G35", "G92X.5Z.2", "X.3003", "X.5Z.2", "G36", "G92X.5Z.2", "X.3003"))
    assert result.errors == []
    assert (6, 1, "finer-than-step") in result.warnings
    assert result.ends == [(0.5, 0.2), (0.30025, 0.2), (0.5, 0.2), (0.3003, 0.2)]


def test_g35f2_permits_lead_over_one_inch() -> None:
    result = passed(body("M03S100", "X.5Z.2", "G35F2", "G92X.5Z.2", "G33X.49Z-2.I.02K1.5"))
    assert result.errors == []


# --- refused ------------------------------------------------------------------------------------------------

AT = ("X.3Z.1",)
REFUSED: list[tuple[tuple[str, ...], tuple[int, int, str]]] = [
    ((*AT, "G33X.25Z-.5I.05"), (4, 1, "thread-lead-missing")),
    ((*AT, "G33X.25Z-.5I.05F.05"), (4, 16, "thread-lead-missing")),
    ((*AT, "G33X.25Z-.5I.05K0"), (4, 16, "thread-lead-range")),
    ((*AT, "G33X.25Z-.5I.05K-.05"), (4, 16, "thread-lead-range")),
    ((*AT, "G33X.25Z-.5I.05K.2001"), (4, 16, "thread-lead-range")),
    ((*AT, "G35", "G92X.3Z.1", "G33X.25Z-.5I.05K1.001"), (6, 16, "thread-lead-range")),
    ((*AT, "G35F2", "G92X.3Z.1", "G33X.25Z-.5I.05K2.001"), (6, 16, "thread-lead-range")),
    (("M03S1600", *AT, "G33X.25Z-.5I.05K.2"), (5, 16, "feed-over-speed")),
    (("M05", *AT, "G33X.25Z-.5I.05K.05"), (5, 1, "spindle-stopped")),
    ((*AT, "G96S300", "G33X.25Z-.5I.05K.05"), (5, 1, "thread-under-css")),
    ((*AT, "G33X.3Z-.5I.05K.05"), (4, 4, "thread-side")),
    ((*AT, "G33X-.25Z-.5I.05K.05"), (4, 4, "thread-side")),
    ((*AT, "G33X.25Z.1I.05K.05"), (4, 8, "thread-length")),
    ((*AT, "G33X.25I.05K.05"), (4, 1, "word-missing")),
    ((*AT, "G33Z-.5I.05K.05"), (4, 1, "word-missing")),
    ((*AT, "G33X.25Z-.5K.05"), (4, 1, "thread-depth")),
    ((*AT, "G33X.25Z-.5I0K.05"), (4, 12, "thread-depth")),
    ((*AT, "G33X.25Z-.5I-.05K.05"), (4, 12, "thread-depth")),
    ((*AT, "G33X.25Z-.5I.0001K.05"), (4, 12, "thread-passes")),
    ((*AT, "G33X.25Z-.5I.05K.05C30.1"), (4, 20, "thread-angle")),
    ((*AT, "G33X.25Z-.5I.05K.05C-31"), (4, 20, "thread-angle")),
    ((*AT, "G33X.2Z.05I.05K.05C30"), (4, 19, "thread-angle")),
    ((*AT, "G33X.25Z-.5I.05K.05P5"), (4, 20, "thread-word")),
    ((*AT, "G33X.25Z-.5I.05K.05R.1"), (4, 20, "word-unused")),
    ((*AT, "G34X.25Z-.5I.05K.05"), (4, 4, "word-unused")),
    ((*AT, "G34Z-.5K.05"), (4, 1, "thread-depth")),
    (("T1", "G33X.25Z-.5I.05K.05"), (4, 0, "tool-first-move")),
    ((*AT, "G35", "X.3"), (4, 1, "coarse-preset")),
    ((*AT, "G35", "G92X.3Z.2"), (5, 4, "coarse-preset")),
    ((*AT, "G35", "G92X.3"), (4, 1, "coarse-preset")),
    ((*AT, "G35X.3", "G92X.3Z.1"), (4, 1, "not-alone")),
    ((*AT, "G35F1", "G92X.3Z.1"), (4, 4, "coarse-range")),
    ((*AT, "G36", "G92X.3Z.1"), (4, 1, "coarse-order")),
    ((*AT, "G35", "G92X.3Z.1", "G35F2", "G92X.3Z.1"), (6, 1, "coarse-order")),
    ((*AT, "G35", "G92X.3Z.1", "X.4", "G36", "G92X.4Z.1"), (7, 1, "coarse-place")),
    ((*AT, "G35", "G92X.3Z.1", "T1"), (6, 1, "coarse-tool")),
]


@pytest.mark.parametrize(("program", "error"), REFUSED, ids=[" ".join(program) for program, _ in REFUSED])
def test_invalid_thread_is_rejected(program: tuple[str, ...], error: tuple[int, int, str]) -> None:
    assert error in passed(body(*program)).errors


def test_feed_instead_of_lead_gets_k_suggestion() -> None:
    result = passed(body("X.3Z.1", "G33X.25Z-.5I.05F.05"))
    assert any("Did you mean K.05?" in found.hint for found in result.interpreter.diagnostics)


def test_rejected_thread_produces_no_blocks() -> None:
    assert threads(passed(body("X.3Z.1", "G33X.25Z-.5I.05K.05C40"))) == []
