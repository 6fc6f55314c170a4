"""Jobs at the lathe: the queue by keys alone, counted by the store, the next one proved while one runs."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.extras.jobs.jobs_model import JobsModel
from app.extras.jobs.jobs_view import JobsPage
from app.extras.jobs.jobs_watch import JobWatch, ProvedJob
from app.programs.programs_view import ProgramsPage
from app.screen import page_table
from app.screen.window_layout import FINGERTIP_PX
from core.executor.snapshot import MachineState
from core.store.production import tool_lives
from core.store.production.tool_lives import ToolLifeRow
from core.store.store_rows import OffsetKind, get_utc_now_text
from tests.screen.day import SHIFT, Day, Key, begun
from tests.screen.yes import yes
from tests.texts import begins, pattern, shows
from tests.texts import text as wording

PEG = "(PEG)\nG90G94F300G72\nT1\nM03S2000\nG00X.7Z.1\nX.5\nG01G94F60Z-.3\nX.7\nG00Z1\nM05\nM30\n"
CAP = PEG.replace("(PEG)", "(CAP)").replace("T1", "T2")


@pytest.fixture
def day(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Day]:
    """PEG on the desk with T1 touched off; CAP in the folder, whose T2 nobody has set."""
    folder = tmp_path / "home" / "programs"
    folder.mkdir(parents=True)
    (folder / "cap.nc").write_text(CAP)
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path / "home"))
    with begun(qtbot, "peg.nc", PEG) as day:
        day.store.offsets.tool_offsets.change_row(
            1, "test", {"x": -12.7, "z": -50.8, "nose_radius": 0.4, "quadrant": 3}
        ).result(60)
        day.desk.offset_book.read_store()
        day.run(0.02)
        day.key(Key.Key_D)
        assert day.desk.program_choice.load_by_name("peg")
        day.sees(lambda: day.prompt.startswith(wording("screen.to-start")))
        yield day


def model(day: Day) -> JobsModel:
    found = day.desk.page_registry.find_model(JobsModel)
    assert found is not None
    return found


def watch(day: Day) -> JobWatch:
    return model(day).job_watch


def opened(day: Day) -> None:
    day.key(Key.Key_F6, modifier=SHIFT)
    day.sees(lambda: day.page == "JOBS")


def added(day: Day, program: str, parts: str) -> None:
    """From the list of programs."""
    before = len(watch(day).jobs)
    day.key(Key.Key_F1, Key.Key_F6)
    day.sees(lambda: day.page == page_table.PROGRAMS)
    day.type(program[:3])
    page = day.frame.current_page
    assert isinstance(page, ProgramsPage)
    day.sees(lambda: program in "".join(row.cells[0] for row in page.model.make_table().rows))
    day.key(Key.Key_F10)
    assert day.page == "JOBS"
    assert model(day).make_table(day.shot).entry_prompt == wording("screen.how-many-parts", program=program)
    day.enter(parts)
    day.sees(lambda: len(watch(day).jobs) == before + 1)


def rows(day: Day) -> list[tuple[str, ...]]:
    day.window.refresh()
    return [row.cells[1:3] for row in model(day).make_table(day.shot).rows]


def loaded(day: Day, program: str) -> None:
    """F2 on the marked job: it is on the desk, and nothing has moved."""

    def taken() -> bool:
        job = watch(day).active_job
        return (
            job is not None and job.program == program and not day.desk.program_loader.loaded_program.is_busy
        )

    day.key(Key.Key_F2)
    assert day.page == page_table.AUTOMATIC
    day.sees(taken)
    assert day.shot.state is MachineState.IDLE


def test_job_queue_is_completed_without_automatic_starts(day: Day) -> None:
    added(day, "peg.nc", "2")
    added(day, "cap.nc", "5")
    assert rows(day) == [("peg.nc\n", "0/2"), ("cap.nc\n", "0/5")]
    day.key(Key.Key_Up)
    loaded(day, "peg.nc")
    assert day.desk.program_runs.part_counter.part_count_text == "0/2"
    day.key(Key.Key_C)  # cycle repeat
    day.palms()
    day.reaches(MachineState.RUN)
    watch(day).proofs.clear_proofs()
    day.run(0.05)
    watch(day).proofs.worker.wait_for_results(
        60.0
    )  # the machine stands still in time meanwhile, in the middle of the peg
    assert isinstance(watch(day).proofs.find_proof("cap.nc", day.desk.offset_book.changes), ProvedJob)
    assert day.shot.state in {MachineState.RUN, MachineState.WAIT}
    day.until(
        lambda: day.shot.parts == 2 and day.shot.state is MachineState.IDLE
    )  # repeat ends with the last part
    day.sees(lambda: shows(day.prompt, "screen.job-done"))
    following = (
        f"{wording('screen.next-job', program='cap.nc', left=5)}, {wording('screen.missing', count=1)}"
    )
    assert day.prompt == f"{wording('screen.job-done', made=2, wanted=2, program='peg.nc')} {following}"
    day.run(3.0)
    assert (day.shot.state, day.shot.program, day.shot.parts) == (MachineState.IDLE, day.shot.program, 2)
    assert day.desk.program_loader.loaded_program.name == "peg.nc"
    row = day.desk.page_registry.find_notice(day.shot)
    assert row is not None
    assert row.values_text == following
    assert [each.parts_made for each in day.store.jobs.read_jobs()] == [2, 0]
    assert day.store.runs.read_part_count("peg.nc") == 2
    opened(day)
    day.key(Key.Key_Down)
    loaded(day, "cap.nc")
    assert day.desk.program_loader.loaded_program.name == "cap.nc"
    assert day.desk.program_runs.part_counter.part_count_text == "0/5"
    assert day.desk.page_registry.find_notice(day.shot) is None


def test_missing_tool_is_reported_in_the_queue(day: Day) -> None:
    added(day, "cap.nc", "50")

    def lacking() -> list[str]:
        day.window.refresh()
        return [
            cells[2] for cells in (r.cells for r in model(day).make_setup_table().rows) if cells[0] == "T2"
        ]

    day.sees(lambda: lacking() == [wording("screen.offset-missing")])
    day.desk.offset_book.change_fields(
        OffsetKind.TOOL, 2, {"x": -12.7, "z": -50.8, "nose_radius": 0.4, "quadrant": 3}, "touched off"
    )
    day.store.write(lambda c: tool_lives.save_tool_life_limits(c, ToolLifeRow(2, 40, stops=True))).result(60)
    day.store.write(lambda c: tool_lives.save_insert_use(c, 2, 28, 100.0)).result(60)
    watch(day).parts_watch.production_records.request_reload()
    day.sees(lambda: lacking() == [wording("screen.life-left", left=12, parts=50)])
    day.key(Key.Key_F4)
    day.enter("12")
    day.sees(lambda: lacking() == ["ready"])
    day.sees(lambda: wording("screen.tool-complete") in model(day).make_table(day.shot).rows[0].cells)


def test_tool_tip_changed_since_the_last_run_is_reported(day: Day) -> None:
    day.store.runs.record_run_start("peg.nc").result(60)
    started = day.store.runs.read_run_records()[0].started
    assert started is not None
    day.sees(lambda: get_utc_now_text() > started)  # of one millisecond are what was set and what ran with it
    day.desk.offset_book.change_fields(
        OffsetKind.TOOL, 1, {"nose_radius": 0.8, "quadrant": 2}, "another insert"
    )
    added(day, "peg.nc", "3")
    day.sees(lambda: len(model(day).make_setup_table().rows) > 1)
    told = next(r.cells[2] for r in model(day).make_setup_table().rows if r.cells[0] == "T1").replace(
        "\n", " "
    )
    tips = {"radius": "0.0315 in", "tip": "tip quadrant 2", "was": "0.0157 in", "was_tip": "tip quadrant 3"}
    assert re.fullmatch(pattern("screen.another-tip", **tips), told)


def test_job_is_moved_annotated_removed_and_cleared(day: Day) -> None:
    added(day, "peg.nc", "2")
    added(day, "cap.nc", "5")
    day.key(Key.Key_F5)
    day.sees(lambda: rows(day)[0][0].startswith("cap.nc"))
    day.key(Key.Key_F8)
    day.enter("order 12")
    day.sees(lambda: rows(day)[0][0] == "cap.nc\norder 12")
    day.key(Key.Key_F10)
    assert day.prompt == wording("screen.no-job-done")
    day.key(Key.Key_F9)
    assert begins(day.prompt, "screen.take-out-of-queue", program="cap.nc", made=0, wanted=5)
    day.key(Key.Key_Escape)
    assert len(rows(day)) == 2
    day.key(Key.Key_F9)
    yes(day.window)
    day.sees(lambda: rows(day) == [("peg.nc\n", "0/2")])


def test_note_is_typed_by_touch_on_the_smallest_screen(day: Day) -> None:
    day.window.resize(1024, 600)
    added(day, "peg.nc", "2")
    day.key(Key.Key_F8)
    assert day.window.frame is not None
    page = day.window.frame.current_page
    assert isinstance(page, JobsPage)
    day.sees(page.letter_pad.isVisible)
    page.grab()
    assert all(box.height() >= FINGERTIP_PX - 1 for box, *_ in page.letter_pad._places)
    assert page.table.geometry().bottom() < page.letter_pad.geometry().top()  # the question stays in sight
    letters = {
        key: press for key, (_, press, *_) in zip("qwertyuiop", page.letter_pad._places[10:20], strict=True)
    }
    for key in "prep":
        letters[key]()
    page.letter_pad._places[-1][1]()
    day.sees(lambda: rows(day)[0][0] == "peg.nc\nprep")


def test_job_is_not_loaded_while_a_program_runs(day: Day) -> None:
    added(day, "cap.nc", "5")
    day.key(Key.Key_Escape)
    day.palms()
    day.reaches(MachineState.RUN)
    opened(day)
    day.key(Key.Key_F2)
    assert day.page == "JOBS"
    assert day.prompt == wording("screen.program-runs-no-other")
    day.key(Key.Key_F8)
    assert begins(day.prompt, "screen.notes-between-cycles")
    day.key(Key.Key_F1, Key.Key_F2)  # the page closes, the part goes on
    day.until(lambda: day.shot.parts == 1)
    assert watch(day).active_job is None
    assert day.store.jobs.read_jobs()[0].parts_made == 0


@pytest.mark.parametrize("text", ["0", "1.5", "abc", "99999999"])
def test_invalid_part_count_is_rejected_and_asked_again(day: Day, text: str) -> None:
    opened(day)
    day.key(Key.Key_F3)
    day.enter(text)
    day.sees(lambda: day.desk.prompt_notice != "" and "TYPE" not in day.desk.prompt_notice)
    assert watch(day).jobs == ()


def test_part_counter_uses_the_count_of_the_job(day: Day) -> None:
    added(day, "peg.nc", "3")
    loaded(day, "peg.nc")
    day.key(Key.Key_F10)
    day.enter("2", "7")
    assert day.prompt == wording("screen.job-has-own-count")
    assert day.desk.program_runs.part_counter.effective_target_count == 3


def test_missing_job_program_is_reported(day: Day, tmp_path: Path) -> None:
    added(day, "cap.nc", "5")
    (tmp_path / "home" / "programs" / "cap.nc").unlink()
    day.key(Key.Key_F2)
    assert day.prompt == wording("screen.not-among-programs", name="cap.nc")
    assert watch(day).active_job is None


def test_queue_is_disabled_and_reports_why_without_a_store(day: Day) -> None:
    watch(day).parts_watch.production_records.switch_store(None, "THE DISK IS GONE")
    day.run(0.05)
    opened(day)
    day.key(Key.Key_F3)
    day.enter("4")
    assert day.prompt == wording("screen.not-kept", why="THE DISK IS GONE")
    assert model(day).make_table(day.shot).notes == ("THE DISK IS GONE",)


def test_job_program_that_is_not_loaded_is_proved_and_loaded(day: Day) -> None:
    added(day, "peg.nc", "3")
    loaded(day, "peg.nc")
    opened(day)
    assert model(day).make_table(day.shot).rows[0].cells[4] == "IN PROGRESS"
    day.key(Key.Key_F1, Key.Key_F2)
    assert day.desk.program_choice.load_by_name("cap")
    day.sees(lambda: not day.desk.program_loader.loaded_program.is_busy)
    opened(day)
    day.sees(lambda: model(day).make_table(day.shot).rows[0].cells[4] == wording("screen.tool-complete"))
    loaded(day, "peg.nc")
    day.sees(lambda: day.desk.program_runs.part_counter.part_count_text == "0/3")


def test_empty_queue_says_how_to_add_a_job(day: Day) -> None:
    opened(day)
    day.key(Key.Key_F4)
    assert begins(day.prompt, "screen.no-job-waits")


def test_open_job_prompt_must_be_completed_before_another_key_acts(day: Day) -> None:
    """F4 while the count of a new job is typed had asked for the count of the marked one."""
    added(day, "cap.nc", "5")
    day.key(Key.Key_F3)
    assert model(day).make_table(day.shot).entry_prompt == wording("screen.how-many-parts", program="peg.nc")
    assert model(day).make_function_keys() == {}
    day.key(Key.Key_F4)
    day.enter("2")
    day.sees(lambda: rows(day) == [("cap.nc\n", "0/5"), ("peg.nc\n", "0/2")])
