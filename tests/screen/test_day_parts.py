"""The operator's afternoon: five parts with a correction between, a stop, SEARCHTO, an E-stop, MDI."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.mdi.mdi_model import MdiModel
from app.mdi.mdi_view import MdiPage
from app.screen import page_table
from app.searchto.searchto_model import RestartModel
from core.executor.snapshot import MachineState
from tests.attached import attached
from tests.screen.chapters import (
    ENDS,
    NAME,
    T1,
    T2,
    back_to_automatic,
    correct,
    drives_on,
    set_tools,
    write_program,
)
from tests.screen.day import NEAR, Day, Key, begun
from tests.screen.yes import twist_out, yes
from tests.texts import begins, pattern, shows
from tests.texts import text as wording

TURNING = 6  # the line that turns the .9 diameter
PARTS = "pin9.nc"


@pytest.fixture
def day(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Day]:
    """Written, tools set, D1 entered: ready to run."""
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    with begun(qtbot) as day:
        drives_on(day)
        write_program(day)
        set_tools(day)
        correct(day, "-.002", ".001")
        day.sees(lambda: wording("screen.to-start") in day.prompt)
        yield day


def turning(day: Day) -> float:
    """Wait until the .9 is being turned; where X stands then."""
    day.until(lambda: day.shot.line == TURNING and day.slides[1] < -0.6)
    return day.slides[0]


def made(day: Day) -> str:
    """The count on the screen."""
    day.window.refresh()
    times = day.frame.times_panel.value
    assert isinstance(times, tuple)
    return str(dict(times)["PARTS"])


def target(day: Day, sum_: str) -> None:
    """F10, 2: stop at so many."""
    day.key(Key.Key_F10)
    day.enter("2", sum_)
    back_to_automatic(day)


def test_five_parts_are_made_with_wear_correction_between_them(day: Day) -> None:
    target(day, "2+3")
    assert made(day) == "0/5"
    day.key(Key.Key_C)
    day.palms()
    assert turning(day) == pytest.approx(0.45 - 0.001 + T1[0], abs=NEAR)
    day.until(lambda: made(day) == "2/5")
    assert day.shot.cycle_repeat
    day.key(Key.Key_O)
    day.reaches(MachineState.PROGRAM_STOP)  # the optional stop of the third part
    day.key(Key.Key_F1)
    day.run(0.05)
    assert day.frame.run_line.message_text == "GAUGE THE .9 AND CORRECT D1"  # on every page
    day.frame.run_line.grab()
    day.key(Key.Key_F2)
    correct(day, "-.001")
    day.key(Key.Key_O)
    day.palms()
    day.until(lambda: made(day) == "3/5")
    # .001 on the diameter more: half of it on the slide
    assert turning(day) == pytest.approx(0.45 - 0.0015 + T1[0], abs=NEAR / 2)
    day.reaches(MachineState.IDLE)
    assert made(day) == "5/5"
    assert not day.shot.cycle_repeat
    assert day.prompt == wording("screen.target-reached", count=5, target=5)
    assert day.count("part") == 5
    assert day.journal.runs.read_part_count(PARTS) == 5
    assert [change.why for change in day.store.offsets.read_history()][:2] == ["X -.001", "X -.002 Z .001"]


def test_correction_during_run_is_applied_without_stopping(day: Day) -> None:
    """Gauged beside the machine: D1 -.001 is typed while the second part is turned, the third one has it."""
    day.key(Key.Key_C)
    day.palms()
    day.until(lambda: made(day) == "1")
    correct(day, "-.001")
    assert turning(day) == pytest.approx(0.45 - 0.001 + T1[0], abs=NEAR / 2)  # this part as it was begun
    day.until(lambda: made(day) == "2")
    assert turning(day) == pytest.approx(0.45 - 0.0015 + T1[0], abs=NEAR / 2)
    day.sees(lambda: day.desk.program_loader.loaded_program.picture is not None)
    job = day.desk.program_loader.loaded_program.job
    assert job is not None
    assert job.digest == day.shot.job
    assert day.shot.cycle_repeat
    day.key(Key.Key_C)
    day.reaches(MachineState.IDLE)
    assert day.count("stop") == 0
    assert day.count("part") == 3


def test_correction_beyond_travel_stops_at_end_of_part(day: Day) -> None:
    """-9 typed for -.0009, and the slide would leave its travel: told while it can be taken back."""
    day.key(Key.Key_C)
    day.palms()
    day.until(lambda: made(day) == "1")
    day.key(Key.Key_F9)
    day.enter("1", "-9", "", "")
    yes(day.window)
    day.sees(lambda: begins(day.prompt, "screen.no-next-part"))
    day.key(Key.Key_Escape)  # pressed as the proof ends: it must not remove what nobody has read
    assert begins(day.prompt, "screen.no-next-part")
    day.reaches(MachineState.IDLE)
    day.sees(lambda: shows(day.prompt, "screen.will-not-run") or shows(day.prompt, "screen.no-repeat"))
    assert day.count("part") == 2
    day.palms()
    assert day.shot.state is MachineState.IDLE


def test_searchto_restarts_second_tool_after_stop(day: Day) -> None:
    day.palms()
    turning(day)
    day.key(Key.Key_H)
    day.reaches(MachineState.HOLD)
    day.run(0.1)
    stood = day.slides
    day.run(1.0)
    assert day.slides == pytest.approx(stood, abs=NEAR / 5)
    day.key(Key.Key_R)
    assert shows(day.prompt, "screen.give-up-program")
    yes(day.window)
    day.reaches(MachineState.IDLE)
    day.key(Key.Key_S)  # nobody lets the first restart of the day run through
    search(day, "X1.2", "11")
    restarts(day)
    ended = {}
    day.reaches(MachineState.SINGLE_BLOCK_STOP)
    while day.shot.state is MachineState.SINGLE_BLOCK_STOP:
        ended[day.shot.line] = day.slides
        day.palms()
        day.reaches(MachineState.SINGLE_BLOCK_STOP, MachineState.IDLE)
    assert [ended[line] for line in (11, 12, 13, 14)] == [
        pytest.approx(ENDS[line], abs=NEAR) for line in (11, 12, 13, 14)
    ]
    assert day.slides == pytest.approx(ENDS[15], abs=NEAR)
    # The rest of the turning was left out: no part, and that is said.
    assert (day.count("part"), day.count("uncounted")) == (0, 1)
    assert day.prompt.startswith(wording("screen.not-counted", why=wording("screen.restart-left-out")))


def search(day: Day, text: str, line: str) -> None:
    """F6, a text or nothing, Return to its state, F10 to take it."""
    day.key(Key.Key_F6)
    assert day.page == page_table.SEARCHTO_PAGE
    model = day.desk.page_registry.find_model(RestartModel)
    assert model is not None
    if text:
        day.type(text)
        day.key(Key.Key_Return)
    assert str(model.line_cursor.selected_line) == line
    day.key(Key.Key_Return)
    model.restart_finder.worker.wait_for_results(60.0)
    day.run(0.05)
    day.key(Key.Key_F10)
    model.restart_finder.worker.wait_for_results(60.0)
    day.run(0.05)


def restarts(day: Day) -> None:
    """What was found is proved and waits for the palms."""
    assert begins(day.prompt, "search.start-restart", start=pattern("screen.both-palms"))
    day.palms()


def test_part_is_finished_from_interrupted_line_after_estop(day: Day) -> None:
    day.palms()
    turning(day)
    day.key(Key.Key_E)
    day.reaches(MachineState.ESTOP)
    day.run(3.0)
    assert day.shot.rpm_actual == pytest.approx(0.0, abs=1.0)
    twist_out(day.window)
    day.reaches(MachineState.DISABLED)
    day.key(Key.Key_D)
    day.reaches(MachineState.IDLE)
    day.key(Key.Key_F6)
    assert begins(day.prompt, "search.broke-off", line=TURNING)
    day.key(Key.Key_F1, Key.Key_F2)
    search(day, "", str(TURNING))
    restarts(day)
    assert turning(day) == pytest.approx(0.45 - 0.001 + T1[0], abs=NEAR)
    day.reaches(MachineState.IDLE)
    assert day.slides == pytest.approx(ENDS[15], abs=NEAR)
    assert day.count("part") == 1


def test_mdi_between_two_parts_leaves_spindle_running(day: Day) -> None:
    day.key(Key.Key_F1, Key.Key_F4)
    mdi(day, "G90G72")
    mdi(day, "T2")
    mdi(day, "x1.5z.5g94f100")
    assert day.slides == pytest.approx((0.75 + T2[0], 0.5 + T2[1]), abs=NEAR)
    mdi(day, "M03S500")
    day.key(Key.Key_F1, Key.Key_F2)
    day.until(lambda: day.shot.rpm_actual == pytest.approx(500, abs=10))
    assert day.shot.rpm_command == 500
    day.key(Key.Key_F3)
    assert day.page == page_table.AUTOMATIC
    assert begins(day.prompt, "screen.spindle-on-no-edit")
    day.palms()
    assert turning(day) == pytest.approx(0.45 - 0.001 + T1[0], abs=NEAR)
    day.reaches(MachineState.IDLE)
    assert day.count("part") == 1
    assert day.frame.title_line.program_text == f"{NAME}.nc"


def mdi(day: Day, line: str) -> None:
    """One line of MDI to its end."""
    page = day.frame.current_page
    assert isinstance(page, MdiPage)
    day.type(line)
    day.key(Key.Key_Return)
    attached(day.desk, MdiModel).prepared_line.worker.wait_for_results(60.0)
    day.run(0.05)
    day.palms()
    day.reaches(MachineState.IDLE)
    day.run(0.05)
