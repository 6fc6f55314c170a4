"""By hand on the Jog page: where screen and control do not see the same yet, and beside a question."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from app.jog.skim_cut_and_setter import SkimCutStep
from app.screen import page_table
from core.executor.commands import CycleStart
from core.executor.snapshot import MachineState, StartAction
from tests.screen.hands import LIMIT
from tests.screen.jog import bench
from tests.screen.jog.bench import JogBench, Key, opened
from tests.screen.jog.test_by_hand import chosen, palms, proved
from tests.texts import text as wording


@pytest.fixture
def mill(qtbot: QtBot, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[JogBench]:
    """A mill with the Jog page open."""

    def shipped(folder: Path, **_more: bool) -> str:
        text = files("resources").joinpath("machines", "ac-table-mill.toml").read_text(encoding="utf-8")
        path = folder / "mill.toml"
        path.write_text(text)
        return str(path)

    monkeypatch.setattr(bench, "shipped", shipped)
    built = bench.bench_on(tmp_path)
    qtbot.waitExposed(built.window, timeout=LIMIT)
    opened(built)
    yield built
    built.window.close_silently()
    built.desk.close()
    built.store.close()


def test_mill_spindle_starts_at_displayed_speed(mill: JogBench) -> None:
    """M3 has no S of its own: one that was typed and not run is not what the spindle gets."""
    hand = mill.page.model.manual_functions
    mill.type("b9")
    mill.enter("3000")
    proved(mill)
    palms(mill)
    mill.run(1.0)
    assert mill.shot.modal.rpm == 3000.0
    mill.type("9")
    mill.enter("200")
    proved(mill)
    mill.type("1")  # instead of the palms
    proved(mill)
    assert hand.start_speed_rpm == 3000.0
    assert "M3 (S3000)" in mill.prompt
    palms(mill)
    mill.run(2.0)
    assert mill.shot.rpm_command == hand.start_speed_rpm == 3000.0


def test_stop_acts_before_screen_sees_start(jog: JogBench) -> None:
    chosen(jog)
    jog.run(0.5)
    jog.executor.post(CycleStart())  # the palms, and 0 before another snapshot
    jog.key(Key.Key_0)
    jog.run(2.0)
    assert (jog.shot.rpm_command, jog.shot.state) == (0.0, MachineState.IDLE)


def test_program_begun_while_jog_page_opens_is_not_restarted(jog: JogBench, tmp_path: Path) -> None:
    part = tmp_path / "A.NC"
    part.write_text("G90G94F300\nX1Z.1\nM30\n")
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F2)
    jog.run(0.1)
    jog.desk.program_choice.load_path(part)
    jog.desk.program_loader.wait_until_loaded(60.0)
    jog.run(0.3)
    jog.executor.post(CycleStart())
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F5)
    jog.run(0.1)
    jog.until(lambda: jog.shot.state is MachineState.IDLE)
    assert jog.frame.current_page.NAME == page_table.JOG
    jog.run(0.3)
    assert jog.shot.starts is StartAction.MDI_LINE
    ends = jog.shot.ends
    jog.executor.post(CycleStart())
    jog.run(0.5)
    assert (jog.shot.state, jog.shot.ends) == (MachineState.IDLE, ends)
    assert jog.shot.start_refusal_reason == wording("jog.no-line-ready")


def test_palm_buttons_start_nothing_while_size_is_asked(jog: JogBench) -> None:
    """The operator has a micrometer on the part: the palms start nothing then."""
    jog.type("t")
    jog.enter("1")
    chosen(jog)
    palms(jog)
    jog.until(lambda: abs(jog.shot.rpm_actual) > 190 and jog.shot.state is MachineState.IDLE)
    jog.type("c")
    jog.type("x")
    for key, seconds in ((Key.Key_Left, 1.5), (Key.Key_Right, 0.6)):
        jog.down(key)
        jog.run(seconds)
        jog.up(key)
        jog.rests()
        if key == Key.Key_Left:
            jog.key(Key.Key_Return)
    model = jog.page.model
    assert model.skim_cut.cut_step is SkimCutStep.RETRACT
    jog.type("0")
    jog.type("1")
    jog.until(lambda: model.skim_cut.cut_step is SkimCutStep.MEASURING)
    jog.run(0.3)
    assert model.tool_setting.question_name
    assert (model.manual_functions.selected_function, model.manual_functions.prepared_line.ready_job) == (
        "",
        None,
    )
    palms(jog)
    jog.run(0.5)
    assert jog.shot.rpm_command == 0.0
