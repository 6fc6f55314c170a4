"""Skim cut: cut, retract along the other axis, stop, measure, type. Before it is kept nothing changes."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from app.jog.skim_cut_and_setter import SkimCutStep
from core.executor.commands import JogByStep
from core.executor.snapshot import MachineState
from tests.screen.jog.bench import INCH, JogBench, Key
from tests.screen.jog.test_by_hand import by_estop, palms, proved
from tests.texts import shows, text

X, Z = 0, 1


def step(jog: JogBench) -> SkimCutStep:
    """What is to be done next."""
    jog.run(0.02)
    return jog.page.model.skim_cut.cut_step


def goes(jog: JogBench, key: Key, seconds: float = 1.0) -> None:
    """An arrow is held so long."""
    jog.down(key)
    jog.run(seconds)
    jog.up(key)
    jog.rests()


def spindle(jog: JogBench) -> None:
    hand = jog.page.model.manual_functions
    jog.type("1" if hand.is_panel_shown else "b1")
    if hand.is_asking_speed:
        jog.enter("200")
    proved(jog)
    palms(jog)
    jog.until(lambda: jog.shot.rpm_actual > 190.0 and jog.shot.state is MachineState.IDLE)


def begun(jog: JogBench, axis: str = "x") -> None:
    """T1 is to be set by a cut."""
    jog.type("t")
    jog.enter("1")
    jog.type("c" + axis)
    assert step(jog) is SkimCutStep.CUTTING


def cut(jog: JogBench) -> float:
    """A diameter is cut along Z; where X stood, machine mm."""
    begun(jog)
    spindle(jog)
    goes(jog, Key.Key_Down, 0.5)
    goes(jog, Key.Key_Left)
    jog.key(Key.Key_Return)
    assert step(jog) is SkimCutStep.RETRACT
    return jog.shot.actual[X]


def rows(jog: JogBench) -> dict[int, object]:
    jog.saved()
    return dict(jog.desk.offset_book.tool_offsets)


def test_skim_cut_measures_diameter(jog: JogBench) -> None:
    x = cut(jog)
    goes(jog, Key.Key_Right)
    assert step(jog) is SkimCutStep.RETRACT  # the spindle still turns
    jog.type("0")
    jog.until(lambda: jog.page.model.tool_setting.question_name != "")
    assert step(jog) is SkimCutStep.MEASURING
    jog.type(".5")
    jog.run(0.05)
    assert "→" in jog.page.entry_panel.entry_texts.change_description
    assert rows(jog) == {}
    jog.key(Key.Key_Return)
    assert shows(
        jog.page.model.tool_setting.make_note_text(), "jog.touched-one-of-two", axis="Z"
    )  # a new tool is kept with both axes
    assert step(jog) is SkimCutStep.OFF
    jog.key(Key.Key_F6)
    jog.enter("0")
    jog.saved()
    jog.run(0.1)
    row = jog.desk.offset_book.tool_offsets[1]
    assert row.x == pytest.approx(x - 0.25 * INCH, abs=1e-6)  # machine X less half of the diameter
    jog.key(Key.Key_F4)
    jog.confirm()
    assert rows(jog) == {}


def test_skim_cut_of_set_tool_shows_old_and_new_and_saves_reason(jog: JogBench) -> None:
    test_skim_cut_measures_diameter(jog)
    jog.key(Key.Key_F5)
    jog.enter(".4")
    jog.key(Key.Key_F6)
    jog.enter("0")
    jog.saved()
    x = cut(jog)
    jog.type("0")
    jog.until(lambda: jog.page.model.tool_setting.question_name != "")
    jog.type(".3")
    jog.key(Key.Key_Return)
    jog.confirm()
    jog.run(0.1)
    assert jog.desk.offset_book.tool_offsets[1].x == pytest.approx(x - 0.15 * INCH, abs=1e-6)
    assert jog.store.offsets.read_history(limit=1)[0].why == "skim cut Ø .3"


def test_skim_cut_measures_face(jog: JogBench) -> None:
    begun(jog, "z")
    spindle(jog)
    goes(jog, Key.Key_Left, 0.5)
    goes(jog, Key.Key_Up)
    jog.key(Key.Key_Return)
    z = jog.shot.actual[Z]
    goes(jog, Key.Key_Down)  # retract in X, Z is kept
    jog.type("0")
    jog.until(lambda: jog.page.model.tool_setting.question_name == "touch z")
    assert jog.page.model.tool_setting.touch_off.touch_position_mm == pytest.approx(z, abs=1e-6)


def test_x_motion_after_cut_cancels_skim_cut(jog: JogBench) -> None:
    cut(jog)
    goes(jog, Key.Key_Right)
    goes(jog, Key.Key_Down, 0.3)
    assert shows(jog.prompt, "jog.moved-since-cut", axis="X")
    assert step(jog) is SkimCutStep.CUTTING
    goes(jog, Key.Key_Up, 0.3)  # coming back is no cut either
    jog.type("0")
    jog.run(1.5)
    assert step(jog) is SkimCutStep.CUTTING
    jog.key(Key.Key_Return)
    assert text("jog.no-cut-spindle-stands") in jog.prompt
    assert rows(jog) == {}


def test_x_motion_during_size_question_cancels_skim_cut(jog: JogBench) -> None:
    cut(jog)
    jog.type("0")
    jog.until(lambda: jog.page.model.tool_setting.question_name != "")
    jog.type(".5")
    jog.key(Key.Key_Left)
    assert jog.shot.state is MachineState.IDLE  # an entry is open: no arrow moves anything
    jog.desk.post(JogByStep("X", 0.5, 5.0))  # whoever else moves it
    jog.run(4.5)  # the answer to the arrow is gone
    assert shows(jog.prompt, "jog.moved-since-cut", axis="X")
    jog.key(Key.Key_Return)
    assert rows(jog) == {}


def no_spindle(jog: JogBench) -> str:
    goes(jog, Key.Key_Left)
    return "SPINDLE STOPPED"


def x_last(jog: JogBench) -> str:
    spindle(jog)
    goes(jog, Key.Key_Left)
    goes(jog, Key.Key_Down, 0.3)
    return "X MOVED LAST"


def moving(jog: JogBench) -> str:
    spindle(jog)
    jog.down(Key.Key_Left)
    jog.run(0.5)
    return "STILL MOVING"


@pytest.mark.parametrize("how", [no_spindle, x_last, moving])
def test_invalid_skim_cut_is_rejected_with_reason(jog: JogBench, how: Callable[[JogBench], str]) -> None:
    begun(jog)
    said = how(jog)
    if how is moving:
        jog.page.model.skim_cut.finish_cut()
    else:
        jog.key(Key.Key_Return)
    assert said in jog.prompt
    assert step(jog) is SkimCutStep.CUTTING


def in_the_cut(jog: JogBench) -> None:
    begun(jog)


def away(jog: JogBench) -> None:
    cut(jog)


def measuring(jog: JogBench) -> None:
    cut(jog)
    jog.type("0")
    jog.until(lambda: jog.page.model.tool_setting.question_name != "")
    jog.type(".5")


@pytest.mark.parametrize("until", [in_the_cut, away, measuring])
def test_esc_cancels_skim_cut_without_changes(jog: JogBench, until: Callable[[JogBench], None]) -> None:
    until(jog)
    jog.key(Key.Key_Escape)
    assert step(jog) is SkimCutStep.OFF
    assert text("jog.skim-given-up") in jog.prompt
    jog.key(Key.Key_Return)
    assert rows(jog) == {}


@pytest.mark.parametrize("until", [away, measuring])
def test_estop_cancels_skim_cut(jog: JogBench, until: Callable[[JogBench], None]) -> None:
    until(jog)
    jog.desk.station_keys.press_estop()
    jog.run(0.3)
    assert step(jog) is SkimCutStep.OFF
    assert rows(jog) == {}


def test_leaving_page_cancels_skim_cut(jog: JogBench) -> None:
    cut(jog)
    jog.key(Key.Key_F8)
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F5)
    assert step(jog) is SkimCutStep.OFF
    assert rows(jog) == {}


def test_skim_cut_is_rejected_without_tool_or_home(lost: JogBench) -> None:
    lost.type("c")
    assert shows(lost.prompt, "jog.which-tool")
    lost.type("t")
    lost.enter("1")
    lost.type("c")
    assert shows(lost.prompt, "jog.position-means-nothing", axis="X")
    assert step(lost) is SkimCutStep.OFF


def test_the_size_is_not_asked_while_the_spindle_turns(jog: JogBench) -> None:
    cut(jog)
    goes(jog, Key.Key_Right)
    jog.run(1.0)
    assert jog.page.model.tool_setting.question_name == ""
    assert shows(jog.prompt, "jog.retract-along")
    by_estop(jog)
