"""G00 G01 G94 G95 F: what is a rapid, which feed is in force, and what looks like a slip."""

from __future__ import annotations

import pytest

from tests.interpreter.programs import INCH, body, lines, passed, setup


@pytest.mark.parametrize(
    ("program", "feeds"),
    [
        (("X1",), [("rapid", 300)]),
        (("X1F20", "X2"), [("feed", 20), ("feed", 20)]),
        (("X1F20", "X2F300"), [("feed", 20), ("rapid", 300)]),
        (("G95F.003X1", "X2"), [("feed", 0.003), ("feed", 0.003)]),
        (("X1F20", "G00X2", "X3"), [("feed", 20), ("rapid", 300), ("rapid", 300)]),
        (("X1F20", "X2G00"), [("feed", 20), ("rapid", 300)]),
        (("G95F.003X1", "G00X2", "G01X3"), [("feed", 0.003), ("rapid", 300), ("feed", 0.003)]),
        (("G95F.003X1", "G00X2", "F.004X3"), [("feed", 0.003), ("rapid", 300), ("feed", 0.004)]),
        (("G95F.003X1", "G00X2", "G94F8X3"), [("feed", 0.003), ("rapid", 300), ("feed", 8)]),
        (("G94F12X2", "G00X3", "G01X4"), [("feed", 12), ("rapid", 300), ("feed", 12)]),
        (("G95F.003X1", "G00X2", "G01F.004X3"), [("feed", 0.003), ("rapid", 300), ("feed", 0.004)]),
        (("G00", "G01F7X1"), [("feed", 7)]),
        (("F20", "G04F2", "X1"), [("feed", 20)]),
        (("G95F.2X1",), [("feed", 0.2)]),
        (("G95", "G94F30X1"), [("feed", 30)]),
    ],
)  # fmt: skip
def test_feed_and_feed_mode_in_force(program: tuple[str, ...], feeds: list[tuple[str, float]]) -> None:
    result = passed(body(*program))
    assert result.errors == []
    assert result.feeds == feeds


@pytest.mark.parametrize(
    ("first", "rate"),
    [("G90G94F200", 200.0), ("G90F150", 150.0), ("G90", 80.0), ("G90G95F.003", 80.0), ("G90G00F120", 120.0)],
)
def test_rapid_rate_is_feed_of_first_line_or_last_rapid(first: str, rate: float) -> None:
    result = passed(lines(first, "G00X1", "M30"), setup(last_rapid=80))
    assert result.feeds == [("rapid", rate)]


def test_metric_feeds_are_in_millimeters() -> None:
    result = passed(lines("G90G94G71F7620", "M03S1000", "X10", "F254X20", "G95F.0762X30", "M30"))
    assert result.feeds == [("rapid", 300), ("feed", 10), ("feed", 0.003)]


def test_feed_is_stored_in_mm_with_spindle_speed() -> None:
    block = passed(body("G95F.003X1")).moves[0]
    assert block.per_rev
    assert block.feed == pytest.approx(0.003 * INCH)
    assert block.rpm == 1000


def test_feed_per_rev_at_speed_limit_is_accepted() -> None:
    # .1 in/rev at 3000 rpm is 300 in/min, the most the slide does
    assert passed(body("S3000", "G95F.1X1")).errors == []


@pytest.mark.parametrize(
    ("program", "warnings"),
    [
        (("G95F.05X1",), []),
        (("G95F.051X1",), [(3, 4, "feed-high")]),
        (("G95F.0625Z-.5", "M04", "Z.1"), []),  # tapping
        (("G95", "Z-.5F.1", "G04F.5", "M04", "Z.1"), []),
        (("G95F.0625Z-.5", "M03", "Z.1"), [(3, 4, "feed-high")]),
        (("M05", "G95F.06", "M03", "X1"), [(4, 4, "feed-high")]),
        (("F.1X.04",), []),  # 24 s
        (("F.1X.06",), [(3, 0, "feed-low")]),  # 36 s
        (("G95F.00005X.1",), [(3, 0, "feed-low")]),  # .05 in/min
        (("F1", "X.5", "X1.01"), [(5, 0, "feed-low")]),
        (("F1X.1", "X.2", "Z9"), [(5, 0, "feed-low")]),
    ],
)
def test_suspicious_feeds_cause_warnings(
    program: tuple[str, ...], warnings: list[tuple[int, int, str]]
) -> None:
    result = passed(body(*program))
    assert result.errors == []
    assert result.warnings == warnings


@pytest.mark.parametrize(
    ("program", "warnings"),
    [
        (("G95F.003X1", "G00 (DRILL)", "X2"), [(5, 0, "title-rapid")]),
        (("G95F.003X1", "G00 (DRILL)", "T2", "X2Z1"), [(6, 0, "title-rapid")]),
        (("G95F.003X1", "G00 (DRILL)", "G01X2"), []),
        (("G95F.003X1", "G00 (DRILL)", "F.004X2"), []),
        (("G95F.003X1", "G00 (DRILL)", "G94F300X2"), []),
        (("G95F.003X1", "G00 (DRILL)", "G00X2"), []),
        (("G95F.003X1", "G00X2", "G00 (DRILL)", "X3"), []),
        (("G00 (DRILL)", "X2"), []),  # the feed before was the rapid too
    ],
)
def test_g00_with_title_only_warns_of_cuts_made_as_rapids(
    program: tuple[str, ...], warnings: list[tuple[int, int, str]]
) -> None:
    assert passed(body(*program)).warnings == warnings


def test_program_starts_with_power_up_state() -> None:
    modal = passed(lines("G90", "G00X1", "M30")).moves[0].modal
    assert (modal.per_rev, modal.metric, modal.diameter, modal.css) == (False, False, False, False)
    assert (modal.compensation_code, modal.coarse, modal.tool, modal.secondary, modal.spindle) == (
        40,
        0,
        0,
        0,
        0,
    )


@pytest.mark.parametrize(("text", "warned"), [("G90F10", True), ("G90G70F10", False), ("G90G71F250", False)])
def test_program_without_units_after_metric_job_causes_warning(text: str, warned: bool) -> None:
    result = passed(lines(text, "X1", "M30"), setup(metric=True))
    assert (1, 0, "units-unnamed") in result.warnings or not warned
    assert result.moves[0].modal.metric is not text.startswith("G90G70")
    assert bool(result.warnings) is warned
