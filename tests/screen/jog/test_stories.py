"""Setting up by keys alone: steps to a position, two tools by touch-off, homing, and what is refused."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QRectF
from PySide6.QtGui import QPixmap

from app.screen.screen_theme import ThemedPainter
from core.executor.snapshot import MachineState
from core.store.store_rows import ToolOffsetRow
from tests.screen.jog.bench import INCH, SHIFT, JogBench, Key
from tests.screen.yes import yes
from tests.texts import begins, shows, text


def step_to(jog: JogBench, key: Key, step: int, presses: int) -> None:
    """Choose a step by F2 and press so often."""
    while jog.page.model.jog_speeds.step_index != step:
        jog.key(Key.Key_F2)
    for _ in range(presses):
        jog.key(key)
        jog.run(0.02)
        jog.rests()


def test_steps_add_up_to_position(jog: JogBench) -> None:
    step_to(jog, Key.Key_Down, 0, 3)  # .3
    step_to(jog, Key.Key_Down, 1, 2)  # .02
    step_to(jog, Key.Key_Up, 2, 1)  # .001 back
    step_to(jog, Key.Key_Down, 3, 5)  # .0005
    step_to(jog, Key.Key_Left, 0, 1)
    assert jog.shot.demand[0] == pytest.approx(0.3195 * INCH, abs=1e-9)
    assert jog.shot.demand[1] == pytest.approx(-0.1 * INCH, abs=1e-9)
    assert jog.frame.readout_line.status is not None
    assert jog.frame.readout_line.status.position.axes[0].value == "0.31950"


def test_step_key_held_down_makes_one_step(jog: JogBench) -> None:
    jog.key(Key.Key_F2)
    jog.down(Key.Key_Left)
    for _ in range(40):
        jog.repeats(Key.Key_Left)
        jog.run(0.03)
    jog.up(Key.Key_Left)
    assert jog.shot.demand[1] == pytest.approx(-0.1 * INCH, abs=1e-9)


def test_page_change_interrupts_step_with_message(jog: JogBench) -> None:
    jog.key(Key.Key_F2)
    jog.key(Key.Key_Left)
    jog.run(0.1)
    jog.key(Key.Key_F8)
    jog.run(0.5)
    assert jog.shot.state is MachineState.IDLE
    assert jog.shot.demand[1] > -0.09 * INCH
    assert shows(jog.prompt, "jog.stopped-in-step")


def touch(jog: JogBench, key: str, answer: str) -> None:
    jog.type(key)
    jog.run(0.02)
    jog.enter(answer)
    jog.saved()


def test_two_tools_are_set_by_touch_off(jog: JogBench) -> None:
    """T1 at home, T2 1 in nearer in X and .5 in further in Z; the figures are worked out by hand."""
    jog.type("t")
    jog.enter("1")
    touch(jog, "x", ".5-.002")
    assert text("jog.touched-one-of-two", number=1, axis="Z") in jog.prompt
    assert jog.store.offsets.tool_offsets.read_rows() == {}
    touch(jog, "z", "0")
    assert jog.prompt == text("screen.saved", names="T1")
    # the tip stands at diameter .498 with the slide at home: part zero is .249 further in
    assert jog.store.offsets.tool_offsets.read_rows()[1].x == pytest.approx(-0.249 * INCH, abs=1e-9)
    assert jog.store.offsets.tool_offsets.read_rows()[1].z == 0.0
    step_to(jog, Key.Key_Up, 0, 10)
    step_to(jog, Key.Key_Right, 0, 5)
    jog.type("t")
    jog.enter("2")
    touch(jog, "x", ".75")
    touch(jog, "z", ".1")
    second = jog.store.offsets.tool_offsets.read_rows()[2]
    assert second.x == pytest.approx((-1.0 - 0.375) * INCH, abs=0.0013)
    assert second.z == pytest.approx((0.5 - 0.1) * INCH, abs=0.0013)
    assert jog.page.model.tool_setting.find_tip_position(jog.shot) == pytest.approx(
        (0.375 * INCH, 0.1 * INCH), abs=1e-9
    )
    assert [change.why for change in jog.store.offsets.read_history()] == [text("jog.touched-off")] * 2


def set_two(jog: JogBench) -> None:
    jog.store.offsets.tool_offsets.change_row(1, "x", {"x": -5.0, "z": -50.0, "wear_x": 0.1})
    jog.store.offsets.tool_offsets.change_row(2, "x", {"x": 3.0, "z": -40.0}).result(60)
    jog.desk.offset_book.read_store()
    jog.type("t")
    jog.enter("1")


def test_new_touch_shows_old_and_new_offset_and_can_be_undone(jog: JogBench) -> None:
    set_two(jog)
    jog.type("x")
    jog.type("1")
    jog.run(0.02)
    # radius .5 in; was −5 mm = −.19685 in
    change = jog.page.entry_panel.entry_texts.change_description
    assert change == "X R  −0.19685  →  −0.50000   WEAR X  +0.00787  →  +0.00000"  # .1 mm of radius
    jog.key(Key.Key_Return)
    jog.confirm()
    assert jog.store.offsets.tool_offsets.read_rows()[1].x == pytest.approx(-0.5 * INCH, abs=1e-9)
    assert jog.store.offsets.tool_offsets.read_rows()[1].wear_x == 0.0
    assert jog.store.offsets.tool_offsets.read_rows()[2].x == 3.0
    jog.key(Key.Key_F4)
    jog.confirm()
    assert jog.store.offsets.tool_offsets.read_rows()[1] == ToolOffsetRow(-5.0, -50.0, wear_x=0.1)


def test_master_moves_all_followers_or_is_set_alone(jog: JogBench) -> None:
    set_two(jog)
    jog.type("m")
    jog.confirm()
    jog.type("z")
    jog.run(0.02)
    assert shows(jog.page.entry_panel.entry_texts.footer_text, "jog.is-master", number=1, others="T2")
    jog.enter("1")
    jog.confirm()
    # the face was at −50 mm, it is at −25.4 mm now: 24.6 mm for everybody
    assert jog.store.offsets.tool_offsets.read_rows()[1].z == pytest.approx(-25.4, abs=1e-9)
    assert jog.store.offsets.tool_offsets.read_rows()[2].z == pytest.approx(-15.4, abs=1e-9)
    jog.run(0.02)
    # F5 is TOUCH X on this page: the list of changes is on the page of F8
    assert jog.page.model.tool_setting.describe_change() == text(
        "offsets.count-changed", count=2, keys="F8, F5"
    )
    jog.type("z")
    jog.type("l")
    jog.enter("0")
    jog.confirm()
    assert jog.store.offsets.tool_offsets.read_rows()[1].z == pytest.approx(0.0, abs=1e-9)
    assert jog.store.offsets.tool_offsets.read_rows()[2].z == pytest.approx(-15.4, abs=1e-9)


def test_touch_off_is_active_at_once_for_loaded_tool(jog: JogBench) -> None:
    """The position display goes by the new offset as soon as it is saved."""
    set_two(jog)
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F5)
    before = jog.executor.snapshot.modal
    jog.executor._control.status.modal_state = before._replace(
        tool=1, tool_offset_x=-5.0, tool_offset_z=-50.0
    )
    jog.run(0.05)
    touch(jog, "x", "1")
    jog.confirm()
    jog.run(0.05)
    assert jog.frame.readout_line.status is not None
    assert jog.frame.readout_line.status.position.axes[0].value == "0.50000"
    assert jog.frame.readout_line.status.tool_text == "T1"


def load(jog: JogBench, tool: int) -> None:
    """Another tool becomes active."""
    status = jog.executor._control.status
    status.modal_state = jog.executor.snapshot.modal._replace(tool=tool)
    jog.run(0.05)


def test_tool_that_is_changed_during_an_entry_is_selected_after_it(jog: JogBench) -> None:
    set_two(jog)
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F5)
    load(jog, 1)
    setting = jog.page.model.tool_setting
    jog.type("x1.2")
    load(jog, 2)
    assert setting.tool_number == 1  # the entry remains with its tool
    jog.key(Key.Key_Escape)
    jog.run(0.02)
    assert setting.tool_number == 2


def test_tool_number_that_is_typed_during_a_tool_change_is_selected(jog: JogBench) -> None:
    set_two(jog)
    jog.key(Key.Key_F1)
    jog.key(Key.Key_F5)
    load(jog, 1)
    jog.type("t")
    load(jog, 2)
    jog.enter("1")
    jog.run(0.02)
    assert jog.page.model.tool_setting.tool_number == 1


def test_tool_fields_are_entered_on_jog_page(jog: JogBench) -> None:
    set_two(jog)
    touch(jog, "n", ".4/25.4")
    touch(jog, "q", "3")
    touch(jog, "k", "Hardened END")
    touch(jog, "w", "-.001")
    assert jog.page.entry_panel.entry_texts.question_text == "T1  WEAR Z?"
    jog.enter("")
    row = jog.store.offsets.tool_offsets.read_rows()[1]
    assert row.nose_radius == pytest.approx(0.4)
    assert (row.quadrant, row.remark) == (3, "Hardened END")
    assert row.wear_x == pytest.approx(-0.0127)
    assert jog.shot.state is MachineState.IDLE  # H, E and D were letters of the remark


@pytest.mark.parametrize(
    ("key", "answer", "why"),
    [
        (
            "x",
            "1,5",
            text(
                "screen.refused",
                why=text("screen.no-number", what=",", entry="1,5", hint=text("screen.decimal-point")),
            ),
        ),
        ("x", "", text("screen.refused", why=text("screen.nothing-entered"))),
        ("x", "200", text("screen.refused", why=text("jog.out-of-range", axis="X"))),
        ("q", "11", text("screen.refused", why=text("screen.takes", field="tip quadrant", range="0…9"))),
        (
            "w",
            ".3",
            text(
                "screen.refused",
                why=text(
                    "screen.out-of-range", field="wear X", value="+0.30000", unit="in", low=-0.2, high=0.2
                ),
            ),
        ),
    ],
)
def test_invalid_value_is_rejected_and_question_stays_open(
    jog: JogBench, key: str, answer: str, why: str
) -> None:
    set_two(jog)
    before = jog.store.offsets.tool_offsets.read_rows()
    jog.type(key)
    jog.enter(answer)
    assert jog.prompt.startswith(why)
    jog.saved()
    assert jog.store.offsets.tool_offsets.read_rows() == before
    assert jog.page.model.tool_setting.question_name


def test_touch_off_without_tool_asks_for_tool(jog: JogBench) -> None:
    jog.type("x")
    assert jog.prompt == text("jog.which-tool")
    jog.type("t")
    jog.enter("33")
    assert begins(jog.prompt, "screen.refused", why=text("screen.no-such-tool", number=33))


# --- homing ------------------------------------------------------------------------------------------------


def test_homing_asks_once_and_homes_axes_in_order(lost: JogBench) -> None:
    assert lost.prompt == text("jog.not-homed-jog-slowly", axes="X AND Z")
    lost.key(Key.Key_Home)
    assert begins(lost.prompt, "jog.home", first="Z, THEN X")
    lost.run(0.5)
    assert lost.shot.state is MachineState.IDLE
    lost.key(Key.Key_Home)
    lost.run(0.05)
    assert lost.shot.state is MachineState.IDLE  # never the key that asked
    yes(lost.window, Key.Key_Return)
    lost.run(0.05)
    assert lost.shot.state is MachineState.HOMING
    seen = []

    def done() -> bool:
        seen.append(
            tuple(
                known.value
                for known in lost.page.model.homing_question.find_homing_states(lost.shot).values()
            )[:2]
        )
        return lost.shot.state is MachineState.IDLE

    lost.until(done)
    assert list(dict.fromkeys(seen)) == [("NOT HOMED", "HOMING"), ("HOMING", "HOMED"), ("HOMED", "HOMED")]
    lost.key(Key.Key_Home)
    assert lost.prompt == text("jog.nothing-to-home")


def test_single_axis_is_homed_alone(lost: JogBench) -> None:
    lost.key(Key.Key_Home)
    lost.type("x")  # sooner than anybody has read the question
    lost.run(0.2)
    assert lost.shot.state is MachineState.IDLE
    lost.key(Key.Key_Home)
    yes(lost.window, Key.Key_X)
    lost.until(lambda: lost.shot.homed[0])
    lost.rests()
    assert not lost.shot.homed[1]


def test_another_key_cancels_homing_question(lost: JogBench) -> None:
    lost.key(Key.Key_Home)
    lost.key(Key.Key_Escape)
    lost.key(Key.Key_Home)
    lost.down(Key.Key_Left)
    lost.run(0.3)
    assert lost.shot.demand[1] == 0.0  # the arrow took it back, and is pressed again to jog
    lost.up(Key.Key_Left)
    lost.run(0.5)
    assert lost.shot.state is MachineState.IDLE
    assert not any(lost.shot.homed[:2])


def test_an_unhomed_axis_is_jogged_slowly_and_not_touched_off(lost: JogBench) -> None:
    fastest = 0.0
    lost.down(Key.Key_Right, SHIFT)
    for _ in range(50):
        lost.run(0.01)
        fastest = max(fastest, lost.shot.velocity)
    lost.up(Key.Key_Right)
    assert fastest == pytest.approx(0.1 * 100 * INCH / 60, rel=0.06)
    lost.type("t")
    lost.enter("1")
    lost.rests()
    lost.type("x")
    assert lost.prompt == text("jog.position-means-nothing", axis="X")


def test_hold_ends_homing(lost: JogBench) -> None:
    lost.down(Key.Key_Left)
    lost.run(1.0)
    lost.up(Key.Key_Left)
    lost.rests()
    lost.key(Key.Key_Home)
    lost.key(Key.Key_Home)
    lost.run(0.05)
    lost.key(Key.Key_H)
    lost.run(0.5)
    assert lost.shot.state is MachineState.IDLE
    assert not lost.shot.homed[1]


@pytest.mark.parametrize(("units", "shown", "other"), [("MM", "12.7", "0.5"), ("INCH", "0.5", "12.7")])
def test_the_tip_is_shown_in_the_unit_of_the_readout(
    jog: JogBench, monkeypatch: pytest.MonkeyPatch, units: str, shown: str, other: str
) -> None:
    """The readout showed millimeters, and the tip next to it inches."""
    jog.store.offsets.tool_offsets.change_row(1, "test", {"x": 0.0, "z": -12.7}).result(60)
    jog.desk.offset_book.read_store()
    jog.desk.apply_setting("units", units)
    jog.type("t")
    jog.enter("1")
    jog.run(0.1)
    written: list[str] = []

    monkeypatch.setattr(ThemedPainter, "draw_text_line", lambda *values, **_more: written.append(values[2]))
    pixmap = QPixmap(400, 100)
    with ThemedPainter(pixmap, jog.page.theme) as painter:
        jog.page.tool_panel._stands(painter, QRectF(0, 0, 300, 60))
    assert [each for each in written if each.lstrip("-").startswith(shown)], written
    assert not [each for each in written if each.lstrip("-").startswith(other)], written
