"""The setup person's morning: a program from nothing, two tools, a correction, a dry run, block by block."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from core.executor.snapshot import MachineState
from tests.screen import chapters
from tests.screen.chapters import (
    D1,
    ENDS,
    back_to_automatic,
    correct,
    drives_on,
    set_tools,
    stand_at,
    write_program,
)
from tests.screen.day import Day, Key, begun
from tests.texts import shows, text


@pytest.fixture
def day(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Day]:
    monkeypatch.setenv("TURNDESK_HOME", str(tmp_path))
    with begun(qtbot) as day:
        yield day


def shift_in_the_program(day: Day) -> None:
    """An inch towards the tailstock, as this control does it: G10 ahead of the T, in a version of its own."""
    chapters.open_editor(day)
    day.key(Key.Key_End, Key.Key_Return)
    day.type("G10Z1.")
    assert not [
        d for d in chapters.editor(day).finding_list.findings.diagnostics if d.severity.value == "error"
    ]
    day.key(Key.Key_F3)
    day.sees(lambda: day.prompt.startswith(text("screen.to-start")))


def shift_out_of_it(day: Day) -> None:
    """The version before the dry run is put back from the history."""
    day.until(lambda: abs(day.shot.rpm_actual) < 1)
    page = chapters.open_editor(day)
    day.key(Key.Key_F7)
    day.sees(lambda: len(page.version_history.rows) >= 2)
    while "G10" in page.text_field.toPlainText():
        day.key(Key.Key_F5)
        day.run(0.05)
        day.sees(lambda: not page.version_history.words())
        day.key(Key.Key_F2)
        day.sees(page.text_field.isVisible)
    assert page.text_field.toPlainText() == chapters.PROGRAM + "\n"
    day.key(Key.Key_F3)
    day.sees(lambda: day.prompt.startswith(text("screen.to-start")))


def dry_run(day: Day) -> None:
    """Every place an inch further out; the optional stop says what to do there."""
    shift_in_the_program(day)
    day.key(Key.Key_O)
    day.palms()
    day.reaches(MachineState.PROGRAM_STOP)
    day.run(0.1)
    assert day.frame.alarm_notice.isVisible()
    assert day.frame.alarm_notice.message == "GAUGE THE .9 AND CORRECT D1"
    stand_at(day, (ENDS[8][0], ENDS[8][1] + 1.0))
    day.key(Key.Key_O)
    day.palms()
    day.until(lambda: day.shot.line == 14 and day.shot.modal.tool == 2)  # lines are one further down
    day.until(lambda: day.slides[0] < ENDS[13][0] + 0.0005)
    assert day.slides[1] == pytest.approx(ENDS[13][1] + 1.0, abs=0.0005)
    day.reaches(MachineState.IDLE)
    shift_out_of_it(day)


def single_block_through(day: Day) -> None:
    """Each press of the palms is one block, and each block ends where it should."""
    day.key(Key.Key_S)
    ended: dict[int, tuple[float, float]] = {}
    for _ in range(40):
        day.palms()
        day.reaches(MachineState.SINGLE_BLOCK_STOP, MachineState.PROGRAM_STOP, MachineState.IDLE)
        if day.shot.state is MachineState.IDLE:
            break
        ended[day.shot.line] = day.slides
        assert day.frame.position_panel.isVisible()
    assert day.shot.state is MachineState.IDLE
    for line, place in ENDS.items():
        assert ended[line] == pytest.approx(place, abs=0.0005), f"line {line}"
    day.key(Key.Key_S)
    day.until(lambda: not day.shot.single_block)


def test_operator_starts_with_empty_folder_and_makes_first_good_part(day: Day) -> None:
    drives_on(day)
    write_program(day)
    day.sees(lambda: shows(day.prompt, "screen.no-offset-set", tools="T1, T2"))
    day.palms()
    assert day.shot.state is MachineState.IDLE  # a tool that nobody has set is not run
    set_tools(day)
    correct(day, ".5-.502", "2/2000")
    day.sees(lambda: text("screen.to-start") in day.prompt)  # a warning of the first move may come before it
    row = day.store.offsets.secondary_offsets.read_rows()[1]
    assert (row.x / 25.4, row.z / 25.4) == pytest.approx(D1, abs=1e-9)
    dry_run(day)
    assert day.count("part") == 1
    single_block_through(day)
    assert day.count("part") == 2
    versions = [version.why for version in day.journal.versions("pin9.nc")]
    assert len(versions) >= 3
    back_to_automatic(day)
