"""Measured parts, tool life and trends at the lathe: keys alone, the product's desk, machine and store."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from threading import Event

import pytest
from pytestqt.qtbot import QtBot

from app.desk.pages.table_content import TableContent
from app.extras.quality.quality_setup import QualitySectionList
from app.extras.quality.quality_view import MeasuredPartsPage
from app.extras.quality.readings_section import ReadingsSection
from app.extras.quality.serial_gauge import GaugeReading, NoGauge
from app.production.parts_watch import ProductionMonitor
from core.executor.snapshot import MachineState
from tests.screen.day import Day, Key, begun
from tests.screen.yes import yes
from tests.texts import Pattern, begins, fragment, pattern, shows
from tests.texts import text as wording

PEG = "(PEG)\nG90G94F300G72\nT1\nM03S2000\nG00X.7Z.1\nX.5\nG01G94F60Z-.3\nX.7\nG00Z1\nM05\nM30\n"
NUMBER = Pattern(r"\d+")
FEATURES, READINGS, CHARTS, LIFE, TRENDS = "12345"


@pytest.fixture
def day(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Day]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    (tmp_path / "peg.nc").write_text(PEG)
    with begun(qtbot) as day:
        day.store.offsets.tool_offsets.change_row(1, "test", {"x": -12.7, "z": -50.8}).result(60)
        day.desk.offset_book.read_store()
        day.run(0.02)
        day.key(Key.Key_D)
        day.desk.program_choice.load_path(tmp_path / "peg.nc")
        day.sees(lambda: day.prompt.startswith(wording("screen.to-start")))
        yield day


def model(day: Day) -> QualitySectionList:
    found = day.desk.page_registry.find_model(QualitySectionList)
    assert found is not None
    return found


def section(day: Day, number: str) -> None:
    """The section of this number, from wherever the operator is."""
    day.key(Key.Key_F1)
    day.run(0.05)
    day.type("w")
    day.sees(lambda: day.page == "MEASURED PARTS")
    day.type(number)
    day.key(Key.Key_Return)
    day.run(0.05)


def settled(day: Day) -> bool:
    """What is known is what is kept."""
    watch = day.desk.page_registry.find_model(ProductionMonitor)
    assert watch is not None
    return watch.production_records.is_up_to_date


def sheet(day: Day) -> TableContent:
    day.window.refresh()
    return model(day).shown_function.make_table(day.shot)


def cells(day: Day) -> list[tuple[str, ...]]:
    return [row.cells for row in sheet(day).rows]


def texts(day: Day) -> dict[str, str]:
    """What stands beside each name, on a sheet of two columns."""
    return {name: text for name, text, *_ in cells(day)}


def feature(day: Day, *fields: str, name: str = "spigot") -> None:
    """Nominal, upper, lower, number, every, sample of a diameter that wear of a tool corrects."""
    nominal, upper, lower, number, every, sample = fields
    section(day, FEATURES)
    day.key(Key.Key_F2)
    day.enter(name)
    day.key(Key.Key_Down)
    day.enter(nominal, upper, lower)
    day.key(Key.Key_Down)
    day.enter(number)
    day.key(Key.Key_Down)
    day.enter(every, sample)
    day.key(Key.Key_F6)
    day.sees(lambda: bool(re.search(r"SAVED|REJECTED", day.prompt)))


def spigot(day: Day, every: str = "0", sample: str = "1") -> None:
    feature(day, ".5", ".001", "-.001", "1", every, sample)
    day.sees(lambda: len(cells(day)) == 1)


def has_made_more(day: Day, before: int) -> bool:
    return day.shot.parts > before


def parts(day: Day, count: int) -> None:
    """So many parts, one Cycle Start each."""
    day.key(Key.Key_F1)
    day.key(Key.Key_F2)
    day.run(0.1)
    day.key(Key.Key_Escape)
    for _ in range(count):
        before = day.shot.parts
        day.palms()
        day.until(partial(has_made_more, day, before))
        day.reaches(MachineState.IDLE)
    day.run(0.1)


def measured(day: Day, *sizes: str) -> None:
    """A part after the other, the last one the last that was made."""
    section(day, READINGS)
    for _ in range(len(sizes) - 1):
        day.key(Key.Key_F2)
    for number, size in enumerate(sizes):
        if number:
            day.key(Key.Key_F3)
        day.enter(size)
        day.sees(lambda: shows(day.prompt, "measure.reading-kept") and settled(day))


# --- features ---------------------------------------------------------------------------------------------


def test_a_feature_is_entered_once(day: Day) -> None:
    spigot(day, every="10")
    assert cells(day) == [("SPIGOT", "Ø 0.50000", "+0.00100  −0.00100", "T1 X", "every 10 parts", "1")]


@pytest.mark.parametrize(
    ("fields", "why"),
    [
        ((".5", ".001", ".001", "1", "0", "1"), fragment("measure.limits-crossed")),
        (("0", ".001", "-.001", "1", "0", "1"), fragment("measure.nominal-range")),
        ((".5", ".001", "-.001", "33", "0", "1"), fragment("measure.offsets-to", last=32, number=33)),
        ((".5", ".001", "-.001", "1", "0", "11"), "1 to 10 parts"),
    ],
)
def test_invalid_feature_is_rejected_and_stays_open_for_correction(
    day: Day, fields: tuple[str, ...], why: str
) -> None:
    feature(day, *fields)
    assert shows(day.prompt, "screen.refused")
    assert why in day.prompt
    assert sheet(day).title == "FEATURE"


def test_fractional_interval_is_rejected(day: Day) -> None:
    section(day, FEATURES)
    day.key(Key.Key_F2)
    day.enter("spigot")
    for _ in range(5):
        day.key(Key.Key_Down)
    day.enter("1.5")
    assert shows(day.prompt, "measure.no-whole-number")


def test_duplicate_feature_name_is_rejected(day: Day) -> None:
    spigot(day)
    feature(day, ".3", ".001", "-.001", "1", "0", "1")
    day.sees(lambda: shows(day.prompt, "measure.feature-exists"))


def test_a_feature_is_removed_after_asking(day: Day) -> None:
    spigot(day)
    day.key(Key.Key_Escape)
    day.key(Key.Key_F4)
    assert shows(day.prompt, "measure.measure-no-more", name="SPIGOT")
    day.key(Key.Key_Escape)
    assert len(cells(day)) == 1
    day.key(Key.Key_F4)
    yes(day.window)
    day.sees(lambda: cells(day) == [])


# --- readings and correction ------------------------------------------------------------------------------


def test_readings_are_stored_and_judged(day: Day) -> None:
    spigot(day)
    parts(day, 2)
    measured(day, ".5004", ".5012")
    day.sees(lambda: cells(day) == [("SPIGOT", "Ø 0.50000", "2", "Ø 0.50120", "+0.00120", "TOO LARGE")])


def test_size_far_from_nominal_asks_for_confirmation(day: Day) -> None:
    spigot(day)
    parts(day, 1)
    section(day, READINGS)
    day.enter("5.001")
    assert shows(day.prompt, "measure.far-off")
    day.key(Key.Key_Escape)
    assert cells(day)[0][3] == ""
    day.enter("-.001")
    assert shows(day.prompt, "measure.size-not-deviation")


def test_reading_can_be_removed(day: Day) -> None:
    spigot(day)
    parts(day, 1)
    measured(day, ".5004")
    day.key(Key.Key_Escape)
    day.key(Key.Key_F9)
    yes(day.window)
    day.sees(lambda: cells(day)[0][3] == "")


def test_correction_is_applied_like_a_typed_offset_and_can_be_undone(day: Day) -> None:
    """Mean Ø .5012: half of .0012 off as a diameter, .0003 at the offset; then undone."""
    spigot(day)
    parts(day, 2)
    measured(day, ".5012", ".5012")
    day.key(Key.Key_Escape)
    day.sees(lambda: cells(day)[0][2] == "2")
    day.key(Key.Key_F8)
    assert begins(day.prompt, "measure.correct", words="T1 X −0.00060: SPIGOT 0.50120 → 0.50060")
    assert day.store.offsets.tool_offsets.read_rows()[1].wear_x == 0.0, "nothing is changed unasked"
    yes(day.window)
    day.sees(lambda: not day.desk.offset_book.is_saving)
    assert day.store.offsets.tool_offsets.read_rows()[1].wear_x == pytest.approx(-0.0003 * 25.4)
    assert day.store.offsets.read_history(limit=1)[0].why == wording(
        "measure.reason-of-correction", name="SPIGOT", mean="0.50120", count=2, change="−0.00060"
    )
    day.key(Key.Key_F4)
    yes(day.window)
    day.sees(lambda: not day.desk.offset_book.is_saving)
    assert day.store.offsets.tool_offsets.read_rows()[1].wear_x == 0.0


def test_effect_of_a_correction_is_shown_before_it_is_applied(day: Day) -> None:
    """The peg's diameter is .5 as programmed; .0006 less of wear makes it .4994. Nothing is changed."""
    spigot(day)
    parts(day, 2)
    measured(day, ".5012", ".5012")
    day.key(Key.Key_Escape)
    day.sees(lambda: cells(day)[0][2] == "2")
    shown = model(day).shown_function
    assert isinstance(shown, ReadingsSection)
    assert (shown.chart_share, shown.make_chart().plots) == (0.0, ())
    day.key(Key.Key_F8)
    asked = day.prompt
    day.sees(lambda: sheet(day).title.startswith(wording("screen.effect-on-part")))
    (diameter,) = [row.cells for row in sheet(day).rows if row.is_lamp_lit]
    assert diameter[1:] == ("0.50000", "0.49940", "−0.00060")
    (plot,) = shown.make_chart().plots
    taken, now, then = plot.curves
    assert list(taken.values) == pytest.approx([0.5012, 0.5012])
    assert list(now.values) == pytest.approx([0.5012, 0.5012])
    assert list(then.values) == pytest.approx([0.5006, 0.5006])
    assert then.part_sequence_numbers[0] == taken.part_sequence_numbers[-1] + 1.0
    assert [each.value for each in plot.horizontal_lines] == pytest.approx([0.5, 0.499, 0.501])
    assert shown.chart_share > 0.0
    assert (day.prompt, day.store.offsets.tool_offsets.read_rows()[1].wear_x) == (asked, 0.0)
    day.key(Key.Key_Escape)
    assert cells(day)[0][0].upper() == "SPIGOT", "the readings are back"
    assert (shown.chart_share, shown.make_chart().plots) == (0.0, ())


def test_a_refused_proposal_shows_no_effect(day: Day) -> None:
    spigot(day)
    parts(day, 1)
    measured(day, ".5001")
    day.key(Key.Key_Escape)
    day.key(Key.Key_F8)
    assert shows(day.prompt, "measure.dead-band")
    shown = model(day).shown_function
    assert isinstance(shown, ReadingsSection)
    assert not shown.correction_effect.is_question_open
    assert shown.make_chart().plots == ()


def test_parts_made_before_a_correction_do_not_propose_another(day: Day) -> None:
    spigot(day)
    parts(day, 1)
    measured(day, ".5012")
    day.key(Key.Key_Escape)
    day.key(Key.Key_F8)
    watch, read = day.desk.page_registry.find_model(ProductionMonitor), Event()
    assert watch is not None
    yes(day.window)
    watch.production_records.worker.enqueue_work(lambda: read.wait(60.0), lambda _read: None, day.desk.say)
    day.sees(lambda: not day.desk.offset_book.is_saving)
    day.key(Key.Key_Escape)
    day.key(Key.Key_F8)
    assert shows(day.prompt, "measure.still-reading"), "what is on its way would be proposed once more"
    read.set()
    day.sees(lambda: settled(day))
    day.key(Key.Key_F8)
    assert shows(day.prompt, "measure.none-since-change", what="T1 X")
    parts(day, 1)
    measured(day, ".5006")
    day.key(Key.Key_Escape)
    day.key(Key.Key_F8)
    assert day.prompt.startswith("T1 X −0.00030: SPIGOT 0.50060 → 0.50030")


def test_offset_changed_elsewhere_is_not_undone(day: Day) -> None:
    spigot(day)
    parts(day, 1)
    measured(day, ".5012")
    day.key(Key.Key_Escape)
    day.key(Key.Key_F8)
    yes(day.window)
    day.sees(lambda: not day.desk.offset_book.is_saving)
    day.store.offsets.tool_offsets.change_row(1, "by hand", {"wear_z": 0.01}).result(60)
    day.key(Key.Key_F4)
    assert shows(day.prompt, "measure.another-change-after")
    assert day.store.offsets.tool_offsets.read_rows()[1].wear_z == 0.01


def test_readings_are_required_for_a_proposal(day: Day) -> None:
    spigot(day)
    section(day, READINGS)
    day.key(Key.Key_F8)
    assert shows(day.prompt, "measure.none-since-correction")
    day.key(Key.Key_F4)
    assert shows(day.prompt, "measure.no-correction-here")
    day.key(Key.Key_F5)
    assert shows(day.prompt, "measure.no-gauge")


def test_readings_are_exported_for_a_spreadsheet(day: Day, tmp_path: Path) -> None:
    spigot(day)
    parts(day, 1)
    measured(day, ".5004")
    day.key(Key.Key_F6)
    day.sees(lambda: begins(day.prompt, "screen.written"))
    head, line = (tmp_path / "home" / "parts" / "peg-readings.csv").read_text().splitlines()
    assert head.startswith("feature,part,value,unit,nominal,lower,upper,good")
    assert line.startswith("SPIGOT,1,0.5004,in,0.5,0.499,0.501,yes,")


# --- the sample plan --------------------------------------------------------------------------------------


def test_measuring_plan_prompts_at_part_end_and_parts_continue(day: Day) -> None:
    spigot(day, every="2")
    parts(day, 1)
    assert not shows(day.prompt, "measure.measure-part")
    parts(day, 2)
    day.key(Key.Key_Escape)
    assert day.prompt.startswith(wording("measure.measure-part", part=2, names="SPIGOT · "))
    measured(day, ".5000")
    day.key(Key.Key_F1)
    day.key(Key.Key_F2)
    day.key(Key.Key_Escape)
    day.sees(lambda: not shows(day.prompt, "measure.measure-part"))


def test_parts_wait_for_the_measurement_if_the_plan_requires_it(day: Day) -> None:
    spigot(day, every="2")
    day.key(Key.Key_F5)
    day.key(Key.Key_F1)
    day.key(Key.Key_F2)
    day.run(0.1)
    day.key(Key.Key_Escape)
    day.type("c")
    day.palms()
    day.until(lambda: day.shot.parts == 2)
    day.reaches(MachineState.IDLE)
    day.run(1.0)
    assert day.shot.parts == 2
    day.palms()
    assert wording("measure.part-first", part=2, names="SPIGOT") in day.prompt
    assert day.shot.state is MachineState.IDLE
    measured(day, ".5000")
    day.sees(lambda: day.shot.next_barred == "")


# --- charts -----------------------------------------------------------------------------------------------


def test_the_chart_is_loaded_when_it_is_opened(day: Day) -> None:
    spigot(day)
    parts(day, 1)
    measured(day, ".5001")
    section(day, FEATURES)
    page = day.frame.current_page
    assert isinstance(page, MeasuredPartsPage)
    assert page.chart is None
    section(day, CHARTS)
    day.sees(lambda: page.chart is not None)
    assert page.chart is not None
    assert not page.chart.isHidden()
    assert "9 of 10" not in str(cells(day))
    assert shows(cells(day)[0][5], "measure.readings-for-cpk", count=1, needed=10)
    section(day, READINGS)
    assert page.chart.isHidden()


# --- tool life --------------------------------------------------------------------------------------------


def life(day: Day, limit: str, *, stops: bool = True) -> None:
    section(day, LIFE)
    day.enter(limit)
    day.sees(lambda: shows(day.prompt, "screen.saved"))
    if stops:
        day.sees(lambda: cells(day)[0][1] == limit)
        day.key(Key.Key_Escape)
        day.key(Key.Key_F3)
        day.sees(lambda: cells(day)[0][3] == "STOP")


def test_expired_tool_blocks_the_next_part_until_the_insert_is_changed(day: Day) -> None:
    life(day, "2")
    day.key(Key.Key_F1)
    day.key(Key.Key_F2)
    day.run(0.1)
    day.key(Key.Key_Escape)
    day.type("c")
    day.palms()
    day.until(lambda: day.shot.parts == 2)
    day.reaches(MachineState.IDLE)
    day.run(2.0)
    assert day.shot.parts == 2, "no other part begins"
    day.palms()
    assert (
        wording("measure.life-gone", number=1, words="2 of 2 parts", what="change the insert") in day.prompt
    )
    section(day, LIFE)
    assert cells(day)[0][4:] == ("0 parts", "2 of 2 parts")
    day.key(Key.Key_F4)
    yes(day.window)
    day.sees(lambda: cells(day)[0][5] == "0 of 2 parts")
    day.sees(lambda: day.shot.next_barred == "")
    with day.store.read() as connection:
        assert connection.execute("SELECT number, parts FROM insert_changes").fetchall() == [(1, 2)]


def test_expired_tool_without_the_stop_is_only_reported(day: Day) -> None:
    life(day, "1", stops=False)
    parts(day, 2)
    day.key(Key.Key_Escape)
    assert day.prompt.startswith(wording("measure.life-is-gone", number=1, words="2 of 1 parts · "))


def test_tool_minutes_count_feed_time(day: Day) -> None:
    """.4 in of Z and .1 in of radius at 60 in/min are half a second."""
    parts(day, 2)
    section(day, LIFE)
    day.sees(lambda: cells(day)[0][5].startswith("2 parts"))
    day.saved()
    with day.store.read() as connection:
        ((number, made, seconds),) = connection.execute("SELECT number, parts, seconds FROM tool_lives")
    assert (number, made) == (1, 2)
    assert seconds == pytest.approx(2 * 0.5, abs=0.15)


@pytest.mark.parametrize(("limit", "why"), [("2.5", "whole number"), ("-1", "0 to 1000000 parts")])
def test_invalid_tool_life_limit_is_rejected(day: Day, limit: str, why: str) -> None:
    section(day, LIFE)
    day.enter(limit)
    assert why in day.prompt


# --- trends -----------------------------------------------------------------------------------------------


def test_trends_show_the_parts_made(day: Day, tmp_path: Path) -> None:
    parts(day, 3)
    section(day, TRENDS)
    day.sees(lambda: "3 parts" in cells(day)[0][1])
    rows = texts(day)
    last = day.shot.last_cycle
    assert begins(rows["CYCLE TIME"], "measure.cycle-times", last=f"{last:.1f} s", count=3)
    assert rows["WEAR"] == wording("measure.no-correction-yet")
    assert "BETWEEN CYCLES" in rows["STOPS"]
    assert re.fullmatch(pattern("measure.loads", last=NUMBER, highest=NUMBER), rows["SPINDLE LOAD"])
    for _ in range(4):
        day.key(Key.Key_Down)
        day.run(0.05)
    day.enter("25-3")
    assert shows(day.prompt, "measure.shift-hours")
    day.key(Key.Key_Delete)
    day.enter("0-24")
    day.run(0.05)
    ran = texts(day)["AVAILABILITY"]
    assert re.fullmatch(r"0–24: \d+ %, in cycle for \d:\d\d of .+", ran)
    # of the machine, whatever program is on the desk
    (tmp_path / "other.nc").write_text(PEG)
    day.desk.program_choice.load_path(tmp_path / "other.nc")
    day.sees(lambda: texts(day)["CYCLE TIME"] == wording("measure.no-part-made") and settled(day))
    assert texts(day)["AVAILABILITY"] >= ran  # the clock on the wall goes on


def test_reading_is_stored_only_while_the_readings_are_shown(day: Day) -> None:
    """Of which feature and part it is must be seen when it comes."""

    class Sent(NoGauge):
        def __init__(self) -> None:
            self.lines: list[GaugeReading | str] = [GaugeReading(0.5003, "in")]

        def fetch_readings(self) -> list[GaugeReading | str]:
            taken, self.lines = self.lines, []
            return taken

    spigot(day)
    parts(day, 1)
    section(day, CHARTS)
    readings = next(each for each in model(day).functions if isinstance(each, ReadingsSection))
    readings.gauge = Sent()
    day.run(0.05)
    assert shows(day.prompt, "measure.reading-not-shown")
    section(day, READINGS)
    assert cells(day)[0][3] == ""
    readings.gauge = Sent()
    day.run(0.05)
    day.sees(lambda: wording("measure.reading-kept", name="SPIGOT", part=1, size="0.50030") in day.prompt)


def test_a_secondary_offset_is_corrected_as_a_radius(day: Day) -> None:
    """Ø .0012 too large: half of it is .0006 of the diameter, .0003 of D4, which was never set."""
    section(day, FEATURES)
    day.key(Key.Key_F2)
    day.enter("groove")
    day.key(Key.Key_Down)
    day.enter(".5", ".001", "-.001")
    day.key(Key.Key_Return, Key.Key_Down)
    day.enter("4")
    day.key(Key.Key_F6)
    day.sees(lambda: shows(day.prompt, "measure.feature-kept"))
    parts(day, 1)
    measured(day, ".5012")
    day.key(Key.Key_Escape)
    day.key(Key.Key_F8)
    assert begins(day.prompt, "measure.correct", words="D4 X −0.00060: GROOVE 0.50120 → 0.50060")
    yes(day.window)
    day.sees(lambda: not day.desk.offset_book.is_saving)
    assert day.store.offsets.secondary_offsets.read_rows()[4].x == pytest.approx(-0.0003 * 25.4)
    day.sees(lambda: settled(day))
    day.key(Key.Key_F4)
    yes(day.window)
    day.sees(lambda: not day.desk.offset_book.is_saving)
    assert 4 not in day.store.offsets.secondary_offsets.read_rows()
